/* SPDX-License-Identifier: BSD-3-Clause */
/* Balls above a body, and a callback, which may fail, so that the particles are kept before each
 * step, over as many processes as there are; the second one has memory for so many allocations less
 * one once the run begins: test_mpi_memory NUMBER. For test_starved.sh; alone it has all memory. */
#include <stdio.h>
#include <stdlib.h>

#include "se3d/mpi.h"
#include "support/counting.h"

static se3d_status push(void *ctx, const double *x, double jet[3], double *gradient)
{
    (void)ctx;
    (void)x;
    (void)gradient;
    jet[0] = 1.0;
    jet[1] = jet[2] = 0.0;
    return SE3D_OK;
}

static se3d_status build(se3d_system *system)
{
    const double r[6] = {0.0, 0.0, 0.06, 0.3, 0.0, 0.06}, radius[2] = {0.01, 0.01};
    se3d_material_def stuff = se3d_material_def_default();
    se3d_function_def def = se3d_function_def_default();
    se3d_body_def body = se3d_body_def_default();
    se3d_shape_def box = se3d_shape_def_default();
    se3d_material material;
    se3d_function function;
    se3d_shape shape;
    se3d_particles *set;
    stuff.density = 2500.0;
    stuff.stiffness = 1e4;
    body.mass = body.inertia[0] = body.inertia[1] = body.inertia[2] = 1.0;
    def.callback = push;
    se3d_status status = se3d_material_create(system, &stuff, &material);
    status = status < 0 ? status : se3d_function_create(system, &def, &function);
    status = status < 0 ? status : se3d_body_create(system, &body, &box.body);
    box.size[0] = box.size[1] = 1.0;
    box.size[2] = 0.1;
    box.material = material;
    status = status < 0 ? status : se3d_shape_create_box(system, &box, &shape);
    status = status < 0 ? status : se3d_particles_create(system, NULL, &set);
    return status < 0 ? status : se3d_particles_add(set, material, 2, r, radius, NULL, NULL, NULL);
}

int main(int argc, char **argv)
{
    support_counting counting = {0};
    const se3d_allocator allocator = support_counting_allocator(&counting);
    se3d_system_def def = se3d_system_def_default();
    se3d_solver_def how = se3d_solver_def_default();
    se3d_system *system = NULL;
    se3d_solver *solver = NULL;
    size_t before;
    int rank = 0;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    def.allocator = &allocator;
    how.method = SE3D_METHOD_VERLET;
    if (se3d_system_create(&def, &system) < 0 || build(system) < 0 ||
        se3d_mpi_attach(system, MPI_COMM_WORLD) < 0 ||
        se3d_solver_create(system, &how, &solver) < 0) {
        fprintf(stderr, "%s\n", se3d_system_get_error(system));
        MPI_Abort(MPI_COMM_WORLD, 3);
    }
    before = counting.calls;
    if (rank == 1 && argc > 1) {
        counting.fail_at = counting.calls + strtoul(argv[1], NULL, 10);
        counting.for_ever = 1;
    }
    const se3d_status status = se3d_solver_run(solver, 0.05);
    if (status < 0) {
        fprintf(stderr, "process %d: %s\n", rank, se3d_system_get_error(system));
        MPI_Abort(MPI_COMM_WORLD, 4);
    }
    if (rank == 1) {
        printf("%zu allocations\n", counting.calls - before);
    }
    se3d_solver_destroy(solver);
    se3d_system_destroy(system);
    MPI_Finalize();
    return 0;
}
