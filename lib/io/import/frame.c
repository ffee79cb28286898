/* SPDX-License-Identifier: BSD-3-Clause */
/* Frames and masses of a machine that is imported. */
#include "io/import/frame.h"

#include <math.h>
#include <string.h>

#include "io/base/elementary.h"
#include "io/base/rotation.h"

se3di_frame se3di_frame_identity(void)
{
    const se3di_frame frame = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}};
    return frame;
}

void se3di_turn(const double A[9], const double v[3], double out[3])
{
    const double u[3] = {v[0], v[1], v[2]};
    for (int k = 0; k < 3; ++k) {
        out[k] = A[3 * k] * u[0] + A[3 * k + 1] * u[1] + A[3 * k + 2] * u[2];
    }
}

void se3di_turn_back(const double A[9], const double v[3], double out[3])
{
    const double u[3] = {v[0], v[1], v[2]};
    for (int k = 0; k < 3; ++k) {
        out[k] = A[k] * u[0] + A[3 + k] * u[1] + A[6 + k] * u[2];
    }
}

void se3di_turn_multiply(const double A[9], const double B[9], double out[9])
{
    double C[9];
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            C[3 * i + j] = A[3 * i] * B[j] + A[3 * i + 1] * B[3 + j] + A[3 * i + 2] * B[6 + j];
        }
    }
    memcpy(out, C, sizeof C);
}

static void transpose(const double A[9], double out[9])
{
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            out[3 * i + j] = A[3 * j + i];
        }
    }
}

void se3di_frame_point(const se3di_frame *a, const double p[3], double out[3])
{
    double turned[3];
    se3di_turn(a->A, p, turned);
    for (int k = 0; k < 3; ++k) {
        out[k] = a->r[k] + turned[k];
    }
}

se3di_frame se3di_frame_of(const se3di_frame *a, const se3di_frame *b)
{
    se3di_frame c;
    se3di_frame_point(a, b->r, c.r);
    se3di_turn_multiply(a->A, b->A, c.A);
    return c;
}

se3di_frame se3di_frame_in(const se3di_frame *a, const se3di_frame *b)
{
    se3di_frame c;
    double T[9];
    double d[3];
    for (int k = 0; k < 3; ++k) {
        d[k] = b->r[k] - a->r[k];
    }
    se3di_turn_back(a->A, d, c.r);
    transpose(a->A, T);
    se3di_turn_multiply(T, b->A, c.A);
    return c;
}

void se3di_turn_from_rpy(const double rpy[3], double A[9])
{
    double p[4];
    se3di_rotation_from_rpy(rpy, p);
    se3di_rotation_to_matrix(p, A);
}

void se3di_turn_to_rpy(const double A[9], double rpy[3])
{
    const double cosine = io_hypot(A[0], A[3]);
    rpy[1] = io_atan2(-A[6], cosine);
    if (cosine > 1e-9) {
        rpy[0] = io_atan2(A[7], A[8]);
        rpy[2] = io_atan2(A[3], A[0]);
    } else {
        rpy[0] = io_atan2(-A[5], A[4]);
        rpy[2] = 0.0;
    }
}

void se3di_turn_about(const double axis[3], double angle, double A[9])
{
    double p[4];
    se3di_rotation_from_axis(axis, angle, p);
    se3di_rotation_to_matrix(p, A);
}

bool se3di_turn_from_parameters(const double p[4], double A[9])
{
    double unit[4];
    const double length = io_hypot(io_hypot(p[0], p[1]), io_hypot(p[2], p[3]));
    if (!(length > 0.0) || !isfinite(length)) {
        return false;
    }
    for (int k = 0; k < 4; ++k) {
        unit[k] = p[k] / length;
    }
    se3di_rotation_to_matrix(unit, A);
    return true;
}

double se3di_length(const double v[3])
{
    return io_hypot(io_hypot(v[0], v[1]), v[2]);
}

double se3di_distance(const double a[3], const double b[3])
{
    const double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    return se3di_length(d);
}

bool se3di_turn_along_both(const double z[3], const double x[3], double A[9])
{
    double axes[3][3]; /* x, y, z */
    const double length = se3di_length(z);
    if (!(length > 0.0) || !isfinite(length)) {
        return false;
    }
    for (int k = 0; k < 3; ++k) {
        axes[2][k] = z[k] / length;
    }
    se3di_cross(axes[2], x, axes[1]);
    const double across = se3di_length(axes[1]);
    if (!(across > 1e-12 * se3di_length(x))) {
        return false;
    }
    for (int k = 0; k < 3; ++k) {
        axes[1][k] /= across;
    }
    se3di_cross(axes[1], axes[2], axes[0]);
    for (int k = 0; k < 9; ++k) {
        A[k] = axes[k % 3][k / 3];
    }
    return true;
}

bool se3di_turn_along(const double axis[3], double A[9])
{
    static const double units[3][3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
    /* x stays what it is for an axis along z, and is the next of the given axes for the others */
    const int next = fabs(axis[2]) >= 0.5 * se3di_length(axis)   ? 0
                     : fabs(axis[0]) >= 0.5 * se3di_length(axis) ? 1
                                                                 : 2;
    return se3di_turn_along_both(axis, units[next], A);
}

double se3di_turn_angle(const double A[9], const double B[9])
{
    const double x[3] = {B[0], B[3], B[6]};
    double in[3];
    se3di_turn_back(A, x, in);
    return io_atan2(in[1], in[0]);
}

/* B = A J A^T. */
static void turn_inertia(const double A[9], const double J[9], double B[9])
{
    double T[9];
    double C[9];
    transpose(A, T);
    se3di_turn_multiply(A, J, C);
    se3di_turn_multiply(C, T, B);
}

se3di_mass se3di_mass_of(const se3di_frame *frame, const se3di_mass *mass)
{
    se3di_mass out = {.mass = mass->mass};
    se3di_frame_point(frame, mass->centre, out.centre);
    turn_inertia(frame->A, mass->J, out.J);
    return out;
}

/* J of a mass about a point that is d away from its centre. */
static void add_shifted(double J[9], const se3di_mass *m, const double centre[3])
{
    const double d[3] = {m->centre[0] - centre[0], m->centre[1] - centre[1],
                         m->centre[2] - centre[2]};
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            J[3 * i + j] +=
                m->J[3 * i + j] + m->mass * ((i == j ? se3di_dot(d, d) : 0.0) - d[i] * d[j]);
        }
    }
}

se3di_mass se3di_mass_sum(const se3di_mass *a, const se3di_mass *b)
{
    se3di_mass sum = {.mass = a->mass + b->mass};
    for (int k = 0; k < 3; ++k) {
        sum.centre[k] = sum.mass > 0.0
                            ? (a->mass * a->centre[k] + b->mass * b->centre[k]) / sum.mass
                            : a->centre[k];
    }
    add_shifted(sum.J, a, sum.centre);
    add_shifted(sum.J, b, sum.centre);
    return sum;
}

/* The roots of the characteristic polynomial of a symmetric matrix, by turns in its planes of at
 * most 45 degrees: larger ones, which make the entry zero as well, may go round in circles. */
void se3di_mass_moments(const double J[9], double moments[3])
{
    double M[9];
    memcpy(M, J, sizeof M);
    for (int turn = 0; turn < 24; ++turn) {
        const int r = turn % 3;
        const int s = (turn + 1) % 3;
        double axis[3] = {0.0, 0.0, 0.0};
        double A[9];
        if (M[3 * r + s] == 0.0) {
            continue;
        }
        const double difference = M[4 * r] - M[4 * s];
        const double twice = difference < 0.0 ? -2.0 * M[3 * r + s] : 2.0 * M[3 * r + s];
        axis[3 - r - s] = 1.0;
        se3di_turn_about(axis, -0.5 * io_atan2(twice, fabs(difference)), A);
        turn_inertia(A, M, M);
    }
    for (int k = 0; k < 3; ++k) {
        moments[k] = M[4 * k];
    }
    for (int k = 0; k < 3; ++k) {
        const int at = k % 2; /* three exchanges of neighbours */
        if (moments[at] > moments[at + 1]) {
            const double swap = moments[at];
            moments[at] = moments[at + 1];
            moments[at + 1] = swap;
        }
    }
}
