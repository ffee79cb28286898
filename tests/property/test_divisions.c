/* SPDX-License-Identifier: BSD-3-Clause */
/* Mechanisms at positions where pivots vanish, by every method: what is found to be singular is
 * found without a division by zero, which hosts may trap: check.h looks at the processor's flag. */
#include "check.h"
#include "se3d/se3d.h"
#include "support/mechanisms.h"
#include "support/methods.h"

#define FORMULATIONS 3

/* All bars of a parallelogram, or of a kite, on one line; gravity across it. */
static world create_flat(double crank, double coupler, double rocker)
{
    static const double origin[2] = {0.0, 0.0};
    const double elbow[2] = {crank, 0.0}, base = crank + coupler - rocker;
    const double pivot[2] = {base, 0.0};
    world w = world_create();
    const se3d_body a = add_bar(&w, "crank", origin, 0.0, crank, 1.0);
    const se3d_body b = add_bar(&w, "coupler", elbow, 0.0, coupler, 1.0);
    const se3d_body c = add_bar(&w, "rocker", pivot, 0.0, rocker, 1.0);
    add_pin(&w, "O", w.ground, a, 0.0, 0.0);
    add_pin(&w, "A", a, b, crank, 0.0);
    add_pin(&w, "B", b, c, crank + coupler, 0.0);
    add_pin(&w, "Q", w.ground, c, base, 0.0);
    return w;
}

static world create_parallelogram(void)
{
    return create_flat(1.0, 2.0, 1.0);
}

static world create_change_point(void)
{
    return create_flat(1.0, 2.0, 0.5);
}

static world create_row_of_windows(void)
{
    return create_windows(2, se3d_joint_create_revolute);
}

static world create_row_of_planar_windows(void)
{
    return create_windows(2, se3d_joint_create_spherical);
}

/* Two pins of one bar on the ground, and a pin twice. */
static world create_held_twice(void)
{
    static const double origin[2] = {0.0, 0.0};
    world w = world_create();
    const se3d_body a = add_bar(&w, "a", origin, 0.0, 1.0, 1.0);
    const se3d_body b = add_bar(&w, "b", origin, 0.5, 1.0, 1.0);
    add_pin(&w, "O", w.ground, a, 0.0, 0.0);
    add_pin(&w, "P", w.ground, a, 1.0, 0.0);
    add_pin(&w, "Q", w.ground, b, 0.0, 0.0);
    add_pin(&w, "R", w.ground, b, 0.0, 0.0);
    return w;
}

static world (*const create[])(void) = {create_parallelogram, create_change_point,
                                        create_row_of_windows, create_row_of_planar_windows,
                                        create_held_twice};

/* A failure is an answer, too. */
static void run(size_t k, int32_t analysis, int32_t method, int32_t formulation)
{
    world w = create[k]();
    se3d_solver_def def = se3d_solver_def_default();
    def.analysis = analysis;
    def.method = method;
    def.formulation = formulation;
    if (!SE3D_FAILED(se3d_solver_create(w.system, &def, &w.solver))) {
        const se3d_status status = se3d_solver_run(w.solver, 0.02);
        CHECK(!SE3D_FAILED(status) || *se3d_system_get_error(w.system));
    }
    world_destroy(&w);
}

static void singular_positions_by_every_method(void)
{
    for (size_t k = 0; k < sizeof create / sizeof *create; ++k) {
        for (int32_t m = 0; m < method_count(); ++m) {
            for (int32_t f = 0; f < FORMULATIONS; ++f) {
                run(k, SE3D_ANALYSIS_DYNAMICS, m, f);
            }
        }
    }
}

static void singular_positions_in_every_analysis(void)
{
    for (size_t k = 0; k < sizeof create / sizeof *create; ++k) {
        for (int32_t f = 0; f < FORMULATIONS; ++f) {
            run(k, SE3D_ANALYSIS_ASSEMBLY, SE3D_METHOD_AUTO, f);
            run(k, SE3D_ANALYSIS_KINEMATICS, SE3D_METHOD_AUTO, f);
            run(k, SE3D_ANALYSIS_INVERSE_DYNAMICS, SE3D_METHOD_AUTO, f);
            run(k, SE3D_ANALYSIS_EQUILIBRIUM, SE3D_METHOD_AUTO, f);
        }
    }
}

int main(void)
{
    RUN(singular_positions_by_every_method);
    RUN(singular_positions_in_every_analysis);
    return check_finish();
}
