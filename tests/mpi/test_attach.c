/* SPDX-License-Identifier: BSD-3-Clause */
/* What a system shares by itself, in one process. */
#include "check.h"
#include "se3d/mpi.h"

static se3d_status attached;

static se3d_status ask(void *ctx, const double *x, double jet[3], double *gradient)
{
    attached = se3d_mpi_attach(ctx, MPI_COMM_SELF);
    se3d_mpi_detach(ctx);
    jet[0] = x[0];
    jet[1] = 1.0;
    jet[2] = 0.0;
    (void)gradient;
    return SE3D_OK;
}

static void callbacks_attach_nothing(void)
{
    se3d_system *system = NULL;
    se3d_function function;
    double t = 2.0, jet[3];
    CHECK(!se3d_system_create(NULL, &system));
    se3d_function_def def = se3d_function_def_default();
    def.callback = ask;
    def.ctx = system;
    CHECK(!se3d_function_create(system, &def, &function));
    attached = SE3D_OK;
    CHECK(!se3d_function_eval(system, function, &t, jet) && jet[0] == 2.0);
    CHECK(attached == SE3D_ERR_STATE);
    CHECK_CONTAINS(se3d_system_get_error(system), "se3d_mpi_detach is not allowed");
    CHECK(!se3d_mpi_attach(system, MPI_COMM_SELF));
    se3d_mpi_detach(system);
    se3d_mpi_detach(NULL);
    CHECK(se3d_mpi_attach(NULL, MPI_COMM_SELF) == SE3D_ERR_NULL);
    se3d_system_destroy(system);
}

/* The first set has large spheres, the second small ones, which need a smaller step. A step that is
 * too large for one of them fails; the next call is judged anew. */
static void a_failure_of_one_of_two_sets_ends_with_its_call(void)
{
    const double r[2][3] = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}}, radius[2] = {0.1, 0.001};
    se3d_system *system = NULL;
    se3d_solver *solver = NULL;
    se3d_particles *sets[2];
    se3d_material material;
    se3d_material_def stuff = se3d_material_def_default();
    se3d_solver_def how = se3d_solver_def_default();
    stuff.density = 2500.0;
    stuff.stiffness = 1e4;
    how.method = SE3D_METHOD_VERLET;
    CHECK(!se3d_system_create(NULL, &system));
    CHECK(!se3d_material_create(system, &stuff, &material));
    for (int k = 0; k < 2; ++k) {
        CHECK(!se3d_particles_create(system, NULL, &sets[k]));
        CHECK(!se3d_particles_add(sets[k], material, 1, r[k], &radius[k], NULL, NULL, NULL));
        CHECK(!se3d_particles_set_step(sets[k], 2e-3));
    }
    CHECK(!se3d_mpi_attach(system, MPI_COMM_SELF));
    CHECK(!se3d_solver_create(system, &how, &solver));
    for (int k = 0; k < 2; ++k) {
        CHECK(se3d_solver_run(solver, 0.01) == SE3D_ERR_STEP_SIZE);
        CHECK_CONTAINS(se3d_system_get_error(system), "is too large, the contacts");
    }
    for (int k = 0; k < 2; ++k) {
        CHECK(!se3d_particles_set_step(sets[k], 1e-6));
    }
    CHECK(!se3d_solver_run(solver, 1e-5));
    CHECK(!se3d_particles_run(sets[1], 2e-5));
    se3d_solver_destroy(solver);
    se3d_system_destroy(system);
}

int main(int argc, char **argv)
{
    MPI_Init(&argc, &argv);
    RUN(callbacks_attach_nothing);
    RUN(a_failure_of_one_of_two_sets_ends_with_its_call);
    MPI_Finalize();
    return check_finish();
}
