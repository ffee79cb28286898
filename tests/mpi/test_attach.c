/* SPDX-License-Identifier: BSD-3-Clause */
/* Callbacks cannot share the particles of the system that asks them. */
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

int main(int argc, char **argv)
{
    MPI_Init(&argc, &argv);
    RUN(callbacks_attach_nothing);
    MPI_Finalize();
    return check_finish();
}
