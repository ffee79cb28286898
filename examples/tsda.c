/* SPDX-License-Identifier: BSD-3-Clause */
/* A mass of 1 kg on a slide along x, held by a spring-damper (k = 100 N/m, c = 2 N s/m): its free
 * oscillation from 20 mm against the closed form, its eigenvalue, and where it rests under a load.
 */
#include <se3d/se3d.h>

#include <math.h>
#include <stdio.h>

#define TRY(call)                                                                                  \
    do {                                                                                           \
        if (SE3D_FAILED(call)) {                                                                   \
            fprintf(stderr, "%s: %s\n", #call, se3d_system_get_error(sys));                        \
            return 1;                                                                              \
        }                                                                                          \
    } while (0)

static int build(se3d_system *sys, se3d_body *mass, se3d_constraint *slide, se3d_force *spring)
{
    const double at[3] = {0.0, 0.0, 0.0};
    const double axis[3] = {1.0, 0.0, 0.0};
    se3d_body ground;
    TRY(se3d_system_get_ground(sys, &ground));
    se3d_body_def body = se3d_body_def_default();
    body.name = "mass";
    body.mass = 1.0;
    body.inertia[0] = body.inertia[1] = body.inertia[2] = 0.01;
    body.position[0] = 0.02;
    TRY(se3d_body_create(sys, &body, mass));
    se3d_joint_def joint = se3d_joint_def_default();
    joint.body_i = ground;
    joint.body_j = *mass;
    TRY(se3d_joint_def_set_frame(sys, &joint, at, axis, NULL));
    joint.point_j[0] = 0.0; /* the displacement counts from the ground's origin */
    TRY(se3d_joint_create_prismatic(sys, &joint, slide));
    se3d_tsda_def tsda = se3d_tsda_def_default();
    tsda.name = "spring";
    tsda.body_i = ground;
    tsda.body_j = *mass;
    tsda.point_i[0] = -1.0;
    tsda.k = 100.0;
    tsda.c = 2.0;
    tsda.l0 = 1.0;
    TRY(se3d_force_create_tsda(sys, &tsda, spring));
    return 0;
}

static int oscillate(se3d_system *sys, se3d_constraint slide, se3d_force spring, double *worst)
{
    const double b = 1.0; /* c / (2 m) */
    const double w = sqrt(100.0 - b * b);
    se3d_solver *solver = NULL;
    se3d_solver_def def = se3d_solver_def_default();
    def.method = SE3D_METHOD_DOP853;
    def.tolerance = 1e-11;
    TRY(se3d_solver_create(sys, &def, &solver));
    printf("    t [s]      x [m]      f [N]      error\n");
    for (int k = 0; k <= 10; ++k) {
        double t = 0.1 * k;
        double x, xdot, xddot, l, ldot, f;
        TRY(se3d_solver_run(solver, t));
        TRY(se3d_joint_get_coordinate(sys, slide, SE3D_JOINT_COORDINATE_DISPLACEMENT, &x, &xdot,
                                      &xddot));
        TRY(se3d_force_get_state(sys, spring, &l, &ldot, &f));
        double exact = 0.02 * exp(-b * t) * (cos(w * t) + b / w * sin(w * t));
        *worst = fmax(*worst, fabs(x - exact));
        printf("%9.1f %10.6f %10.5f %10.1e\n", t, x, f, fabs(x - exact));
    }
    se3d_solver_destroy(solver);
    return 0;
}

/* Eigenvalue and rest under 5 N along x. */
static int rest(se3d_system *sys, se3d_body mass, se3d_constraint slide, double *worst)
{
    se3d_force load;
    se3d_load_def push = se3d_load_def_default();
    se3d_modes *modes = NULL;
    se3d_eigenvalue value;
    double x, xdot, xddot;
    push.body = mass;
    push.value[0] = 5.0;
    TRY(se3d_force_create_load(sys, &push, &load));
    se3d_solver *solver = NULL;
    se3d_solver_def def = se3d_solver_def_default();
    def.analysis = SE3D_ANALYSIS_EQUILIBRIUM;
    TRY(se3d_solver_create(sys, &def, &solver));
    TRY(se3d_solver_run(solver, 1.0));
    se3d_solver_destroy(solver);
    TRY(se3d_joint_get_coordinate(sys, slide, SE3D_JOINT_COORDINATE_DISPLACEMENT, &x, &xdot,
                                  &xddot));
    TRY(se3d_modes_create(sys, NULL, &modes));
    TRY(se3d_modes_get_eigenvalue(modes, 0, &value));
    printf("rest under 5 N: x = %.9f m; %.6f Hz, damping ratio %.6f\n", x, value.frequency,
           value.damping);
    *worst = fmax(*worst, fmax(fabs(x - 0.05), fabs(value.damping - 0.1)));
    se3d_modes_destroy(modes);
    return 0;
}

int main(void)
{
    se3d_system *sys = NULL;
    se3d_body mass;
    se3d_constraint slide;
    se3d_force spring;
    double worst = 0.0;
    if (SE3D_FAILED(se3d_system_create(NULL, &sys))) {
        return 1;
    }
    int failed = build(sys, &mass, &slide, &spring) || oscillate(sys, slide, spring, &worst) ||
                 rest(sys, mass, slide, &worst);
    printf("largest error: %.1e\n", worst);
    se3d_system_destroy(sys);
    return failed || !(worst < 1e-9);
}
