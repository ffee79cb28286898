/* SPDX-License-Identifier: BSD-3-Clause */
/* Elements that are defined again by their names: what is made of a joint does not stay behind. */
#include "check.h"
#include "se3d/se3d.h"
#include "support/mechanisms.h"

typedef struct driven {
    world w;
    se3d_body bars[2];
    se3d_constraint pin, drive;
} driven;

static se3d_joint_def define_pin(const driven *d, int bar, double x)
{
    const double at[3] = {x, 0.0, 0.0}, axis[3] = {0.0, 0.0, 1.0};
    se3d_joint_def def = se3d_joint_def_default();
    def.name = "pin";
    def.body_i = d->w.ground;
    def.body_j = d->bars[bar];
    CHECK(!se3d_joint_def_set_frame(d->w.system, &def, at, axis, NULL));
    return def;
}

/* A bar that is driven about a point x of it, and another one. */
static driven create(double x)
{
    const double from[2] = {0.0, 0.0}, other[2] = {0.0, 3.0};
    driven d = {.w = world_create()};
    d.bars[0] = add_bar(&d.w, "bar", from, 0.0, 1.0, 1.0);
    d.bars[1] = add_bar(&d.w, "other", other, 0.0, 1.0, 1.0);
    se3d_joint_def def = define_pin(&d, 0, x);
    MUST(&d.w, se3d_joint_create_revolute(d.w.system, &def, &d.pin));
    d.drive = add_driver(&d.w, "drive", d.pin, SE3D_JOINT_COORDINATE_ANGLE, "0.2*sin(3*t)");
    return d;
}

static se3d_status move_pin(driven *d, int bar, double x)
{
    se3d_constraint pin;
    const se3d_joint_def def = define_pin(d, bar, x);
    const se3d_status status = se3d_joint_create_revolute(d->w.system, &def, &pin);
    CHECK(status < 0 || memcmp(&pin, &d->pin, sizeof pin) == 0);
    return status;
}

static void define_driver_again(driven *d)
{
    se3d_driver_def def = se3d_driver_def_default();
    se3d_constraint same;
    MUST(&d->w, se3d_driver_get_def(d->w.system, d->drive, &def));
    MUST(&d->w, se3d_driver_create(d->w.system, &def, &same));
    CHECK(memcmp(&same, &d->drive, sizeof same) == 0);
}

static void a_driver_is_defined_again_after_its_joint(void)
{
    driven d = create(0.0), fresh = create(0.25);
    MUST(&d.w, se3d_system_set_replacing(d.w.system, 1));
    MUST(&d.w, move_pin(&d, 0, 0.0));
    MUST(&d.w, se3d_system_set_replacing(d.w.system, 0)); /* it is where it was */
    MUST(&d.w, se3d_system_set_replacing(d.w.system, 1));
    MUST(&d.w, move_pin(&d, 0, 0.25));
    CHECK(se3d_system_set_replacing(d.w.system, 0) == SE3D_ERR_STATE);
    CHECK_CONTAINS(se3d_system_get_error(d.w.system), "'drive'");
    use_solver(&d.w, SE3D_ANALYSIS_DYNAMICS, SE3D_FORMULATION_ROMEGA);
    CHECK(se3d_solver_run(d.w.solver, 0.1) == SE3D_ERR_STATE);
    CHECK_CONTAINS(se3d_system_get_error(d.w.system), "'drive'");
    define_driver_again(&d);
    MUST(&d.w, se3d_system_set_replacing(d.w.system, 0));
    use_solver(&d.w, SE3D_ANALYSIS_DYNAMICS, SE3D_FORMULATION_ROMEGA);
    use_solver(&fresh.w, SE3D_ANALYSIS_DYNAMICS, SE3D_FORMULATION_ROMEGA);
    MUST(&d.w, se3d_solver_run(d.w.solver, 0.3));
    MUST(&fresh.w, se3d_solver_run(fresh.w.solver, 0.3));
    CHECK(se3d_system_hash(d.w.system) == se3d_system_hash(fresh.w.system));
    world_destroy(&d.w);
    world_destroy(&fresh.w);
}

/* Nor does a joint go to other bodies from under what is on it. */
static void a_joint_that_is_used_keeps_its_bodies(void)
{
    driven d = create(0.0);
    se3d_rsda_def spring = se3d_rsda_def_default();
    se3d_force made;
    spring.joint = d.pin;
    MUST(&d.w, se3d_system_set_replacing(d.w.system, 1));
    const uint64_t before = se3d_system_hash(d.w.system);
    CHECK(move_pin(&d, 1, 0.0) == SE3D_ERR_IN_USE);
    CHECK_CONTAINS(se3d_system_get_error(d.w.system), "on other bodies");
    CHECK(se3d_system_hash(d.w.system) == before);
    MUST(&d.w, se3d_constraint_destroy(d.w.system, d.drive));
    MUST(&d.w, se3d_force_create_rsda(d.w.system, &spring, &made));
    CHECK(move_pin(&d, 1, 0.0) == SE3D_ERR_IN_USE);
    MUST(&d.w, se3d_force_destroy(d.w.system, made));
    MUST(&d.w, move_pin(&d, 1, 0.0));
    MUST(&d.w, se3d_system_set_replacing(d.w.system, 0));
    world_destroy(&d.w);
}

int main(void)
{
    RUN(a_driver_is_defined_again_after_its_joint);
    RUN(a_joint_that_is_used_keeps_its_bodies);
    return check_finish();
}
