/* SPDX-License-Identifier: BSD-3-Clause */
/* What rolls without slip by a finite angle stretches no spring: marks on surfaces that bend, in
 * closed form. */
#include "check.h"
#include "contact/bodies/body_contacts.h"
#include "math/quaternion.h"
#include "math/vec3.h"
#include "support/scene.h"
#include "system/system_internal.h"

enum { STIFF = 10000 };

/* A ball or a cylinder of radius R, about y. */
static se3di_frame *add_round(scene *s, int kind, double R, const double r[3])
{
    const double J[3] = {0.01, 0.01, 0.01}, about_x[3] = {1.0, 0.0, 0.0};
    const se3d_body body = scene_body(s, 1.0, J, r, scene_zero);
    se3d_shape_def def = scene_shape(s, body);
    se3d_shape shape;
    def.radius = R;
    def.length = 0.5;
    if (kind == SE3DI_SHAPE_SPHERE) {
        CHECK(se3d_shape_create_sphere(s->system, &def, &shape) == SE3D_OK);
    } else {
        scene_turn(s, body, about_x, 0.5 * PI);
        CHECK(se3d_shape_create_cylinder(s->system, &def, &shape) == SE3D_OK);
    }
    return &s->system->model
                .frames[s->system->model.shapes[s->system->model.shape_slots.count - 1].body];
}

static void remember(scene *s)
{
    se3di_error ignored = {0};
    CHECK(se3di_contacts_prepare(&s->system->model, 0.0, &ignored) == SE3D_OK);
    se3di_contacts_accept(&s->system->model);
    CHECK(s->system->model.contacts.count > 0);
}

/* Turn a body by a rotation vector, ground frame, and move it. */
static void roll(se3di_frame *frame, const double turn[3], const double way[3])
{
    double local[3], p[4];
    se3di_mul_transposed(frame->A, turn, local);
    se3di_quat_rotate(frame->p, local, p);
    memcpy(frame->p, p, sizeof p);
    se3di_add(frame->r, way, frame->r);
    se3di_frame_update(frame);
}

static se3d_status take_largest(void *ctx, const se3di_encounter *e)
{
    double *largest = ctx;
    *largest = fmax(*largest, se3di_norm(e->xi));
    return SE3D_OK;
}

/* The largest stretch of what touches, `t` after what is remembered. */
static double stretch_at(scene *s, double t)
{
    double largest = -1.0;
    CHECK(se3di_contacts_visit(&s->system->model, t, take_largest, &largest) == SE3D_OK);
    CHECK(largest >= 0.0);
    return largest;
}

static void balls_and_cylinders_roll_on_a_plane(void)
{
    const double R = 0.3, depth = 1e-3;
    for (int kind = SE3DI_SHAPE_SPHERE; kind <= SE3DI_SHAPE_CYLINDER;
         kind += SE3DI_SHAPE_CYLINDER) {
        for (int k = -4; k <= 4; ++k) {
            const double angle = 0.3 * k, r[3] = {0.1, 0.2, R - depth};
            const double turn[3] = {0.0, angle, 0.0}, way[3] = {(R - depth) * angle, 0.0, 0.0};
            scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.5, 0.5, STIFF);
            scene_floor(&s, 0.0);
            se3di_frame *frame = add_round(&s, kind, R, r);
            remember(&s);
            roll(frame, turn, way);
            CHECK(stretch_at(&s, 0.1) <= 1e-14);
            scene_end(&s);
        }
    }
}

/* On another one below, up to a polar angle: the point is half way between the surfaces. */
static void balls_and_cylinders_roll_on_each_other(void)
{
    const double R = 0.3, below = 0.5, depth = 1e-3;
    for (int kind = SE3DI_SHAPE_SPHERE; kind <= SE3DI_SHAPE_CYLINDER;
         kind += SE3DI_SHAPE_CYLINDER) {
        for (int k = -3; k <= 3; ++k) {
            const double polar = 0.2 * k, arm = R - 0.5 * depth, other = below - 0.5 * depth;
            const double r[3] = {0.0, 0.0, arm + other};
            const double turn[3] = {0.0, polar * (other / arm + 1.0), 0.0};
            const double way[3] = {(arm + other) * sin(polar), 0.0,
                                   (arm + other) * (cos(polar) - 1.0)};
            scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.5, 0.5, STIFF);
            (void)add_round(&s, kind, below, scene_zero);
            se3di_frame *frame = add_round(&s, kind, R, r);
            remember(&s);
            roll(frame, turn, way);
            CHECK(stretch_at(&s, 0.1) <= 1e-14);
            scene_end(&s);
        }
    }
}

/* A ball that spins about the vertical, too, and goes straight on: to the way to the fifth. */
static void a_ball_spins_as_it_rolls(void)
{
    const double R = 0.3, depth = 1e-3, arm = R - depth, r[3] = {0.0, 0.0, arm};
    double before = 0.0;
    for (int k = 0; k < 3; ++k) {
        const double t = 0.1 / (1 << k), w[3] = {0.0, 2.0, 3.0};
        double turn[3], way[3] = {arm * w[1] * t, 0.0, 0.0};
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.5, 0.5, STIFF);
        scene_floor(&s, 0.0);
        se3di_frame *frame = add_round(&s, SE3DI_SHAPE_SPHERE, R, r);
        se3di_copy(w, frame->w);
        se3di_frame_update(frame);
        remember(&s);
        se3di_scale(t, w, turn);
        roll(frame, turn, way);
        const double stretch = stretch_at(&s, t);
        CHECK(stretch < 2e-6);
        CHECK(k == 0 || stretch < before / 28.0);
        before = stretch;
        scene_end(&s);
    }
}

/* What is stretched when it is remembered is stretched as much then, on whatever it is. */
static void marks_keep_the_stretch(void)
{
    const double R = 0.3, depth = 1e-3;
    for (int kind = SE3DI_SHAPE_SPHERE; kind <= SE3DI_SHAPE_CYLINDER;
         kind += SE3DI_SHAPE_CYLINDER) {
        const double r[3] = {0.0, 0.0, R - depth}, slip[3] = {0.02, 0.01, 0.0};
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 100.0, 0.5, STIFF);
        scene_floor(&s, 0.0);
        se3di_frame *frame = add_round(&s, kind, R, r);
        remember(&s);
        roll(frame, scene_zero, slip);
        const double stretch = stretch_at(&s, 0.1);
        CHECK_NEAR(stretch, se3di_norm(slip), 1e-4);
        remember(&s);
        CHECK_NEAR(stretch_at(&s, 0.0), stretch, 1e-15);
        scene_end(&s);
    }
}

int main(void)
{
    RUN(balls_and_cylinders_roll_on_a_plane);
    RUN(balls_and_cylinders_roll_on_each_other);
    RUN(a_ball_spins_as_it_rolls);
    RUN(marks_keep_the_stretch);
    return check_finish();
}
