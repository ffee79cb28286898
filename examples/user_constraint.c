/* SPDX-License-Identifier: BSD-3-Clause */
/* A constraint of one's own: a bead slides without friction on the parabola z = k x^2 in the plane
 * y = 0. The callback gives the equations, their Jacobian, and what their second derivative in time
 * leaves beside the accelerations. The bead's energy and the force of the wire at the bottom are
 * known: N = m (g + 2 k v^2). */
#include "se3d/se3d.h"

#include <math.h>
#include <stdio.h>

static se3d_status parabola(void *ctx, double t, const se3d_body_motion *bead, double *phi,
                            double *jacobian, double *nu, double *gamma)
{
    double k = *(const double *)ctx;
    (void)t;
    (void)nu; /* the wire is at rest: nu stays zero */
    if (phi) {
        phi[0] = bead->r[2] - k * bead->r[0] * bead->r[0];
        phi[1] = bead->r[1];
    }
    if (jacobian) { /* [2 equations][1 body][dr, dtheta] */
        jacobian[0] = -2.0 * k * bead->r[0];
        jacobian[2] = 1.0;
        jacobian[6 + 1] = 1.0;
    }
    if (gamma) { /* zdd - 2 k x xdd - 2 k xd^2 = 0 */
        gamma[0] = 2.0 * k * bead->v[0] * bead->v[0];
    }
    return SE3D_OK;
}

static int report(const se3d_system *system, const char *what)
{
    fprintf(stderr, "%s: %s\n", what, se3d_system_get_error(system));
    return 1;
}

/* Run until the bead has crossed the bottom; returns the error of the wire's force there. */
static int run(se3d_system *system, se3d_solver *solver, se3d_body bead, se3d_constraint wire,
               double k)
{
    double r[3], v[3], force[3], torque[3];
    double before = 1.0;
    se3d_energy start, end;
    se3d_system_get_energy(system, &start);
    for (int step = 1; step <= 400; ++step) {
        if (SE3D_FAILED(se3d_solver_run(solver, 0.005 * step))) {
            return report(system, "run");
        }
        se3d_body_get_position(system, bead, r);
        if (before > 0.0 && r[0] <= 0.0) {
            se3d_body_get_velocity(system, bead, v);
            se3d_constraint_get_reaction(system, wire, force, torque);
            printf("t = %.3f s: x = %+.4f m, v = %.4f m/s, wire %.4f N, m (g + 2 k v^2) %.4f N\n",
                   0.005 * step, r[0], -v[0], force[2], 0.5 * (9.81 + 2.0 * k * v[0] * v[0]));
        }
        before = r[0];
    }
    se3d_system_get_energy(system, &end);
    printf("z - k x^2 = %.1e m, energy off by %.1e J\n", r[2] - k * r[0] * r[0],
           end.total - start.total);
    return fabs(end.total - start.total) > 1e-6 || fabs(r[2] - k * r[0] * r[0]) > 1e-8;
}

int main(void)
{
    double k = 0.8; /* 1/m */
    se3d_system *system = NULL;
    se3d_solver *solver = NULL;
    if (SE3D_FAILED(se3d_system_create(NULL, &system))) {
        return 1;
    }
    se3d_body_def body = se3d_body_def_default();
    body.name = "bead";
    body.mass = 0.5;
    body.inertia[0] = body.inertia[1] = body.inertia[2] = 1e-4;
    body.position[0] = 1.0;
    body.position[2] = k;
    se3d_user_constraint_def wire = se3d_user_constraint_def_default();
    wire.name = "wire";
    wire.callback = parabola;
    wire.ctx = &k;
    wire.equation_count = 2;
    se3d_constraint constraint;
    if (SE3D_FAILED(se3d_body_create(system, &body, &wire.bodies[0])) ||
        SE3D_FAILED(se3d_user_constraint_create(system, &wire, &constraint))) {
        return report(system, "model");
    }
    se3d_solver_def def = se3d_solver_def_default();
    def.tolerance = 1e-10;
    if (SE3D_FAILED(se3d_solver_create(system, &def, &solver))) {
        return report(system, "solver");
    }
    int failed = run(system, solver, wire.bodies[0], constraint, k);
    se3d_solver_destroy(solver);
    se3d_system_destroy(system);
    return failed;
}
