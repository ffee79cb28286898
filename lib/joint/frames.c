/* SPDX-License-Identifier: BSD-3-Clause */
/* Joint frames: the triads (ref, third, axis) on both bodies, and the start of the joint angle. */
#include "joint/joint.h"

#include "base/floats.h"
#include "math/elementary.h"
#include "math/over.h"
#include "math/vec3.h"
#include "primitive/primitive.h"

#include <math.h>

#define TWO_PI             6.283185307179586476925286766559
#define PARALLEL_TOLERANCE 1e-6    /* sine of the angle between ref and axis */
#define ROUNDING           0x1p-50 /* cosine of a right angle */
#define ALIGNED_COSINE     0.1     /* below, the axes of the bodies say nothing about the angle */

int se3di_joint_triad_build(const double axis[3], const double *ref, double ref_out[3],
                            double third[3])
{
    if (ref) {
        double length = se3di_norm(ref);
        se3di_scale(se3di_over(1.0, length), ref, ref_out);
        se3di_add_scaled(-se3di_dot(axis, ref_out), axis, ref_out);
        double sine = se3di_norm(ref_out);
        if (!(sine > PARALLEL_TOLERANCE)) {
            return 0;
        }
        /* the second pass removes what cancellation left along the axis */
        se3di_add_scaled(-se3di_dot(axis, ref_out), axis, ref_out);
        se3di_scale(1.0 / se3di_norm(ref_out), ref_out, ref_out);
    } else {
        se3di_perpendicular(axis, ref_out);
    }
    se3di_cross(axis, ref_out, third);
    return 1;
}

int se3di_joint_triad_take(const double axis[3], const double *ref, double ref_out[3],
                           double third[3])
{
    if (!ref || !se3di_is_unit(ref, 3) || fabs(se3di_dot(axis, ref)) > ROUNDING) {
        return se3di_joint_triad_build(axis, ref, ref_out, third);
    }
    se3di_copy(ref, ref_out);
    se3di_cross(axis, ref_out, third);
    return 1;
}

void se3di_joint_ref_match(const se3di_joint_frames *frames, double angle, const se3di_frame *i,
                           const se3di_frame *j, double ref_j[3])
{
    double e_i[3], e[3], axis[3], a_i[3];
    double sine, cosine;
    se3di_sincos(angle, &sine, &cosine);
    se3di_scale(cosine, frames->ref_i, e_i);
    se3di_add_scaled(sine, frames->third_i, e_i);
    se3di_mul(i->A, e_i, e);
    se3di_mul(i->A, frames->axis_i, a_i);
    se3di_mul_transposed(j->A, a_i, axis); /* axis_i in body j */
    double e_j[3];
    se3di_mul_transposed(j->A, e, e_j);
    double along = se3di_dot(axis, frames->axis_j);
    if (fabs(along) > ALIGNED_COSINE) {
        /* e + alpha axis_i is perpendicular to axis_j and has the direction e seen along axis_i:
         * the angle is exact also if the axes are not yet aligned */
        se3di_add_scaled(-se3di_dot(e_j, frames->axis_j) / along, axis, e_j);
    }
    double third[3];
    if (!se3di_joint_triad_build(frames->axis_j, e_j, ref_j, third)) {
        se3di_perpendicular(frames->axis_j, ref_j);
    }
}

void se3di_joint_angle_init(const se3di_joint_frames *frames, const uint32_t bodies[2],
                            double offset, se3di_angle *angle)
{
    *angle = (se3di_angle){.offset = offset};
    se3di_term *term = &angle->term;
    term->type = SE3DI_PRIMITIVE_ANGLE;
    term->angle = -1;
    term->coefficient = 1.0;
    term->body_i = bodies[0];
    term->body_j = bodies[1];
    se3di_copy(frames->ref_i, term->a_i);
    se3di_copy(frames->ref_j, term->a_j);
    se3di_copy(frames->axis_i, term->b_i);
}

double se3di_joint_angle_start(const se3di_angle *angle, const se3di_frame *i, const se3di_frame *j,
                               double near)
{
    double principal =
        angle->offset + se3di_primitives[SE3DI_PRIMITIVE_ANGLE].value(&angle->term, i, j);
    return principal + TWO_PI * se3di_nearest((near - principal) / TWO_PI);
}
