/* SPDX-License-Identifier: BSD-3-Clause */
/* Frames and masses of a machine that is imported: what is turned, moved and joined before a model
 * file is written of it. Matrices are row-major and map the frame to what it is given in. */
#ifndef SE3D_IO_IMPORT_FRAME_H
#define SE3D_IO_IMPORT_FRAME_H

#include "math/vec3.h"
#include <stdbool.h>

typedef struct se3di_frame {
    double r[3]; /* its origin [m] */
    double A[9]; /* its axes, as columns */
} se3di_frame;

se3di_frame se3di_frame_identity(void);
/* b, which is given in a, in what a is given in. */
se3di_frame se3di_frame_of(const se3di_frame *a, const se3di_frame *b);
/* b in a, both given in the same frame. */
se3di_frame se3di_frame_in(const se3di_frame *a, const se3di_frame *b);
/* A point of a frame in what the frame is given in. */
void se3di_frame_point(const se3di_frame *a, const double p[3], double out[3]);

void se3di_turn(const double A[9], const double v[3], double out[3]);      /* A v */
void se3di_turn_back(const double A[9], const double v[3], double out[3]); /* A^T v */
void se3di_turn_multiply(const double A[9], const double B[9], double out[9]);
/* Turns about fixed axes: roll about x, pitch about y, yaw about z. */
void se3di_turn_from_rpy(const double rpy[3], double A[9]);
/* The same angles of a matrix; yaw is 0 where roll and yaw turn about one axis. */
void se3di_turn_to_rpy(const double A[9], double rpy[3]);
void se3di_turn_about(const double axis[3], double angle, double A[9]);
/* Euler parameters of any length but 0, scalar first. @return false: their length is 0. */
bool se3di_turn_from_parameters(const double p[4], double A[9]);
/* Axes with z along `axis` and x perpendicular to it, next to the given axes. @return false: the
 * axis has no length. */
bool se3di_turn_along(const double axis[3], double A[9]);
/* Axes with z along `z` and x towards `x`. @return false: the two are parallel. */
bool se3di_turn_along_both(const double z[3], const double x[3], double A[9]);
/* The angle about z from the axes A to the axes B whose z is the same. */
double se3di_turn_angle(const double A[9], const double B[9]);

double se3di_length(const double v[3]);
double se3di_distance(const double a[3], const double b[3]);

/* A mass with its centre and its inertia about the centre, in one frame. */
typedef struct se3di_mass {
    double mass;
    double centre[3];
    double J[9];
} se3di_mass;

/* The same in what `frame` is given in. */
se3di_mass se3di_mass_of(const se3di_frame *frame, const se3di_mass *mass);
/* Both as one; two without mass have the centre of the first. */
se3di_mass se3di_mass_sum(const se3di_mass *a, const se3di_mass *b);
/* The principal moments in ascending order. */
void se3di_mass_moments(const double J[9], double moments[3]);

#endif
