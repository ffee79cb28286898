/* SPDX-License-Identifier: BSD-3-Clause */
/* Runs with error control and steps by the caller in turn: each goes on from the state that the
 * other left, which a method that steps ahead has passed already. */
#include "check.h"
#include "se3d/se3d.h"

#include <math.h>

typedef struct chain {
    se3d_system *system;
    se3d_solver *solver;
} chain;

/* `links` bars of 1 m from the horizontal, on spherical joints where `ball`. */
static chain open_chain(int links, int ball, const se3d_solver_def *def)
{
    chain c = {NULL, NULL};
    se3d_body before;
    CHECK(se3d_system_create(NULL, &c.system) == SE3D_OK);
    CHECK(se3d_system_get_ground(c.system, &before) == SE3D_OK);
    for (int k = 0; k < links; ++k) {
        const double at[3] = {k, 0.0, 0.0}, axis[3] = {0.0, 1.0, 0.0};
        se3d_body_def body = se3d_body_def_default();
        se3d_joint_def joint = se3d_joint_def_default();
        se3d_constraint pin;
        body.mass = 1.0;
        body.inertia[0] = 1e-2;
        body.inertia[1] = body.inertia[2] = 1.0 / 12.0;
        body.position[0] = k + 0.5;
        CHECK(se3d_body_create(c.system, &body, &joint.body_j) == SE3D_OK);
        joint.body_i = before;
        CHECK(se3d_joint_def_set_frame(c.system, &joint, at, axis, NULL) == SE3D_OK);
        CHECK((ball ? se3d_joint_create_spherical : se3d_joint_create_revolute)(c.system, &joint,
                                                                                &pin) == SE3D_OK);
        before = joint.body_j;
    }
    CHECK(se3d_solver_create(c.system, def, &c.solver) == SE3D_OK);
    return c;
}

/* The pendulum's energy, which begins with 0, after `calls` calls in turn: lengths above 0 are
 * steps, below 0 runs. */
static double energy_after(const se3d_solver_def *def, const chain *c, const double *lengths,
                           int calls)
{
    double time = 0.0;
    se3d_energy energy;
    for (int k = 0; k < calls; ++k) {
        const double h = lengths[k % 4];
        CHECK(se3d_system_get_time(c->system, &time) == SE3D_OK);
        const se3d_status status =
            h > 0.0 ? se3d_solver_step(c->solver, h) : se3d_solver_run(c->solver, time - h);
        if (status < 0) {
            fprintf(stderr, "method %d, call %d: %s\n", (int)def->method, k,
                    se3d_system_get_error(c->system));
            CHECK(status >= 0);
            return HUGE_VAL;
        }
    }
    CHECK(se3d_system_get_energy(c->system, &energy) == SE3D_OK);
    return energy.total;
}

static void check_energy(int32_t method, double most)
{
    static const double patterns[][4] = {
        {-5e-3, 1e-3, -5e-3, 1e-3}, {1e-3, -5e-3, 1e-3, -5e-3}, {-5e-3, 5e-3, 5e-3, 5e-3},
        {-1e-4, 1e-3, 2e-3, -1e-2}, {-0.05, 1e-3, -0.05, 1e-5},
    };
    for (size_t k = 0; k < sizeof patterns / sizeof *patterns; ++k) {
        for (int links = 1; links <= 2; ++links) {
            for (int ball = 0; ball < 2; ++ball) {
                se3d_solver_def def = se3d_solver_def_default();
                def.method = method;
                def.formulation = (int32_t)(k % 2);
                chain c = open_chain(links, ball, &def);
                const double energy = energy_after(&def, &c, patterns[k], 200);
                if (!(fabs(energy) <= most)) {
                    fprintf(stderr, "method %d, pattern %d, %d links: %g J\n", (int)method, (int)k,
                            links, energy);
                }
                CHECK_NEAR(energy, 0.0, most);
                se3d_solver_destroy(c.solver);
                se3d_system_destroy(c.system);
            }
        }
    }
}

static void explicit_methods_go_on_from_each_other(void)
{
    check_energy(SE3D_METHOD_DOP853, 2e-6);
    check_energy(SE3D_METHOD_RK45, 1e-5);
    check_energy(SE3D_METHOD_AUTO, 2e-6);
}

static void radau_goes_on(void)
{
    check_energy(SE3D_METHOD_RADAU, 2e-5);
}

/* Its steps of a new length are as accurate as those of a run. */
static void bdf_goes_on(void)
{
    check_energy(SE3D_METHOD_BDF, 2e-4);
}

int main(void)
{
    RUN(explicit_methods_go_on_from_each_other);
    RUN(radau_goes_on);
    RUN(bdf_goes_on);
    return check_finish();
}
