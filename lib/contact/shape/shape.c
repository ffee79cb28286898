/* SPDX-License-Identifier: BSD-3-Clause */
/* What all kinds of shapes have, by their classes.                        docs/theory/shapes.md */
#include "contact/shape/shape.h"

#include "math/elementary.h"
#include "math/vec3.h"

#include <assert.h>
#include <math.h>
#include <string.h>

static const se3di_shape_class *const classes[SE3DI_SHAPE_COUNT] = {
#define ROW(KIND, name, traits) [SE3DI_SHAPE_##KIND] = &se3di_shape_class_##name,
    SE3DI_SHAPE_LIST(ROW)
#undef ROW
};

#define SAME(KIND, name, traits)                                                                   \
    static_assert((int)SE3D_SHAPE_##KIND == (int)SE3DI_SHAPE_##KIND,                               \
                  "the kinds of se3d/shape.h are those of the list");
SE3DI_SHAPE_LIST(SAME)
#undef SAME

const se3di_shape_class *se3di_shape_class_of(const se3di_shape *shape)
{
    return classes[shape->kind];
}

static se3d_status read_dimension(const se3d_shape_def *def, const se3di_dimension *dimension,
                                  se3di_shape *shape, se3di_error *error)
{
    const char *from = (const char *)def + dimension->from;
    char *to = (char *)shape + dimension->to;
    for (uint32_t k = 0; k < dimension->count; ++k) {
        double value, own;
        memcpy(&value, from + k * sizeof value, sizeof value);
        if (!isfinite(value) || value < 0.0 || (value == 0.0 && !dimension->may_be_zero)) {
            return se3di_error_set_of(error, dimension->name, SE3D_ERR_INVALID_ARGUMENT,
                                      " = %g m, must be finite and %s 0", value,
                                      dimension->may_be_zero ? ">=" : ">");
        }
        own = dimension->factor * value;
        memcpy(to + k * sizeof own, &own, sizeof own);
    }
    return SE3D_OK;
}

se3d_status se3di_shape_define(const se3d_shape_def *def, const se3d_allocator *allocator,
                               se3di_shape *shape, se3di_error *error)
{
    const se3di_shape_class *kind = classes[shape->kind];
    for (const se3di_dimension *d = kind->dimensions; d && d->name; ++d) {
        SE3DI_TRY(read_dimension(def, d, shape, error));
    }
    if (kind->define) {
        SE3DI_TRY(kind->define(def, allocator, shape, error));
    }
    shape->bound = se3di_shape_bound(shape);
    return SE3D_OK;
}

void se3di_shape_place(const se3di_shape *shape, const se3di_frame *frame, se3di_shape_pose *pose)
{
    se3di_mul(frame->A, shape->x, pose->x);
    se3di_add(frame->r, pose->x, pose->x);
    se3di_mat_mul(frame->A, shape->A, pose->R);
    se3di_copy(frame->v, pose->v);
    se3di_mul(frame->A, frame->w, pose->w);
    se3di_copy(frame->r, pose->c);
    memset(pose->u, 0, sizeof pose->u);
    memset(pose->spin, 0, sizeof pose->spin);
    pose->moves = se3di_surface_moves(shape);
    if (pose->moves) {
        const double centre[3] = {0.0, 0.0, 0.0};
        se3di_surface_velocity(shape, frame->A, centre, pose->u, pose->spin);
    }
}

int se3di_surface_moves(const se3di_shape *s)
{
    return se3di_dot(s->surface_velocity, s->surface_velocity) > 0.0 ||
           se3di_dot(s->surface_spin, s->surface_spin) > 0.0;
}

void se3di_surface_velocity(const se3di_shape *s, const double A[9], const double r[3],
                            double velocity[3], double spin[3])
{
    double origin[3], arm[3], turned[3];
    se3di_mul(A, s->surface_spin, spin);
    se3di_mul(A, s->surface_velocity, velocity);
    se3di_mul(A, s->x, origin);
    se3di_sub(r, origin, arm);
    se3di_cross(spin, arm, turned);
    se3di_add(velocity, turned, velocity);
}

void se3di_solid_to_ground(const se3di_solid *solid, const double local[3], double out[3])
{
    se3di_mul(solid->at->R, local, out);
    se3di_add(solid->at->x, out, out);
}

void se3di_solid_to_local(const se3di_solid *solid, const double x[3], double local[3])
{
    double d[3];
    se3di_sub(x, solid->at->x, d);
    se3di_mul_transposed(solid->at->R, d, local);
}

double se3di_shape_bound(const se3di_shape *shape)
{
    return classes[shape->kind]->bound(shape);
}

void se3di_solid_bend(const se3di_solid *solid, const double local[3], se3di_bend *bend)
{
    const se3di_shape_class *kind = classes[solid->shape->kind];
    double u[3];
    if (kind->bend && kind->bend(solid->shape, local, u, bend->r)) {
        se3di_mul(solid->at->R, u, bend->u);
    }
}

double se3di_shape_contact_radius(const se3di_shape *shape)
{
    return se3di_shape_is(shape, SE3DI_SHAPE_IS_ROUND) ? shape->radius : HUGE_VAL;
}

double se3di_shape_contact_size(const se3di_shape *shape)
{
    return classes[shape->kind]->size(shape);
}

double se3di_core_radius(const se3di_shape *shape)
{
    return se3di_shape_is(shape, SE3DI_SHAPE_IS_SWEPT) ? shape->radius : 0.0;
}

void se3di_core_support(const se3di_solid *solid, const double d[3], double point[3])
{
    double local_d[3], local[3] = {0.0, 0.0, 0.0};
    const se3di_shape_class *kind = classes[solid->shape->kind];
    se3di_mul_transposed(solid->at->R, d, local_d);
    if (kind->support) {
        kind->support(solid->shape, local_d, local);
    }
    se3di_solid_to_ground(solid, local, point);
}

void se3di_face_find(const se3di_solid *solid, const double d[3], se3di_face *face)
{
    double local[3];
    const se3di_shape_class *kind = classes[solid->shape->kind];
    if (kind->face) {
        se3di_mul_transposed(solid->at->R, d, local);
        kind->face(solid, local, face);
        return;
    }
    face->count = 1;
    face->id = 0;
    se3di_copy(d, face->normal);
    se3di_core_support(solid, d, face->corner[0]);
}

void se3di_face_set_line(const se3di_solid *solid, const double d[3], double radius,
                         se3di_face *face)
{
    double rho = se3di_hypot(d[0], d[1]);
    double n[3] = {rho > 0.0 ? d[0] / rho : 1.0, rho > 0.0 ? d[1] / rho : 0.0, 0.0};
    radius = rho > 0.0 ? radius / rho : 0.0;
    se3di_mul(solid->at->R, n, face->normal);
    face->count = 2;
    face->id = 2;
    for (int k = 0; k < 2; ++k) {
        const double half = solid->shape->half_length;
        double local[3] = {radius * d[0], radius * d[1], k ? half : -half};
        se3di_solid_to_ground(solid, local, face->corner[k]);
    }
}

void se3di_shape_nearest(const se3di_shape *shape, const double local[3], double point[3],
                         double normal[3], double *distance)
{
    classes[shape->kind]->nearest(shape, local, point, normal, distance);
}

void se3di_shape_nearest_swept(const double core[3], double radius, const double local[3],
                               double point[3], double normal[3], double *distance)
{
    double d[3];
    se3di_sub(local, core, d);
    double length = se3di_norm(d);
    if (length > 0.0) {
        se3di_scale(1.0 / length, d, normal);
    } else {
        normal[0] = 1.0;
        normal[1] = normal[2] = 0.0;
    }
    *distance = length - radius;
    se3di_copy(core, point);
    se3di_add_scaled(radius, normal, point);
}
