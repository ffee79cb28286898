/* SPDX-License-Identifier: BSD-3-Clause */
/* What fails in one process only, a force or a function of the user's or a run that one of them
 * interrupts, ends the call in all, with its message, and they go on from the same state: nobody
 * waits. The one that fails is the last, at its first call, at the second, ...
 *
 * For test_together.sh on several processes; by itself there is one, which fails alone. */
#include <math.h>
#include <string.h>

#include "check.h"
#include "se3d/mpi.h"

enum { BY_FORCE, BY_GRAVITY, BY_DRIVER, BY_INTERRUPT, WAYS };

typedef struct trouble {
    int way;
    long calls, fail_at; /* -1: never */
} trouble;

static int fails(void *ctx, int way)
{
    trouble *of = ctx;
    return of->way == way && of->fail_at >= 0 && of->calls++ == of->fail_at;
}

static se3d_status push(void *ctx, double t, const se3d_body_motion motion[2], double wrench[12],
                        double *K, double *D)
{
    (void)t;
    (void)motion;
    (void)K;
    (void)D;
    wrench[6] = 0.5;
    return fails(ctx, BY_FORCE) ? SE3D_ERR_CALLBACK : SE3D_OK;
}

static se3d_status pull(void *ctx, const double *x, double jet[3], double *gradient)
{
    (void)gradient;
    jet[0] = -9.0 - sin(30.0 * x[0]);
    jet[1] = -30.0 * cos(30.0 * x[0]);
    jet[2] = 900.0 * sin(30.0 * x[0]);
    return fails(ctx, BY_GRAVITY) ? SE3D_ERR_CALLBACK : SE3D_OK;
}

static se3d_status lift(void *ctx, const double *x, double jet[3], double *gradient)
{
    (void)gradient;
    jet[0] = 0.01 * x[0] * x[0];
    jet[1] = 0.02 * x[0];
    jet[2] = 0.02;
    return fails(ctx, BY_DRIVER) ? SE3D_ERR_CALLBACK : SE3D_OK;
}

static int ask(void *ctx)
{
    return fails(ctx, BY_INTERRUPT);
}

static se3d_status add_function(se3d_system *system, se3d_function_callback callback, trouble *of,
                                se3d_function *function)
{
    se3d_function_def def = se3d_function_def_default();
    def.callback = callback;
    def.ctx = of;
    return se3d_function_create(system, &def, function);
}

/* A table on a spring, one that is lifted, and balls that fall on both. */
static void build(se3d_system *system, trouble *of, se3d_particles **set)
{
    se3d_material_def stuff = se3d_material_def_default();
    se3d_body_def body = se3d_body_def_default();
    se3d_shape_def box = se3d_shape_def_default();
    se3d_joint_def slide = se3d_joint_def_default();
    se3d_driver_def motor = se3d_driver_def_default();
    se3d_force_callback_def force = se3d_force_callback_def_default();
    se3d_material material;
    se3d_function function;
    se3d_shape shape;
    se3d_force element;
    se3d_constraint joint, driver;
    stuff.density = 2500.0;
    stuff.stiffness = 1e4;
    body.mass = body.inertia[0] = body.inertia[1] = body.inertia[2] = 1.0;
    CHECK(!se3d_material_create(system, &stuff, &material));
    box.size[0] = box.size[1] = 0.1;
    box.size[2] = 0.1;
    box.material = material;
    CHECK(!se3d_body_create(system, &body, &box.body));
    CHECK(!se3d_shape_create_box(system, &box, &shape));
    CHECK(!se3d_system_get_ground(system, &force.body_i));
    force.body_j = box.body;
    force.callback = push;
    force.ctx = of;
    CHECK(!se3d_force_create_callback(system, &force, &element));
    body.position[0] = 0.2;
    CHECK(!se3d_body_create(system, &body, &box.body));
    CHECK(!se3d_shape_create_box(system, &box, &shape));
    slide.body_i = force.body_i;
    slide.body_j = box.body;
    slide.point_i[0] = 0.2;
    CHECK(!se3d_joint_create_prismatic(system, &slide, &joint));
    CHECK(!add_function(system, lift, of, &function));
    motor.joint = joint;
    motor.coordinate = SE3D_JOINT_COORDINATE_DISPLACEMENT;
    motor.function = function;
    CHECK(!se3d_driver_create(system, &motor, &driver));
    CHECK(!add_function(system, pull, of, &function));
    const se3d_function down[3] = {{0, 0}, {0, 0}, function};
    CHECK(!se3d_system_set_gravity_function(system, down));
    const double r[9] = {0.0, 0.0, 0.06, 0.2, 0.0, 0.0605, 0.21, 0.005, 0.085};
    const double radius[3] = {0.01, 0.01, 0.01};
    CHECK(!se3d_particles_create(system, NULL, set));
    CHECK(!se3d_particles_add(*set, material, 3, r, radius, NULL, NULL, NULL));
}

static int is_same(uint64_t value)
{
    uint64_t least = value, most = value;
    MPI_Allreduce(MPI_IN_PLACE, &least, 1, MPI_UINT64_T, MPI_MIN, MPI_COMM_WORLD);
    MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_UINT64_T, MPI_MAX, MPI_COMM_WORLD);
    return least == most;
}

static uint64_t hash_of(const char *text)
{
    uint64_t hash = 1;
    for (; *text; ++text) {
        hash = 31 * hash + (unsigned char)*text;
    }
    return hash;
}

/* @return whether it came so far; *failures is counted: a few calls only look. */
static int try_at(int way, long fail_at, int *failures)
{
    int rank = 0, size = 1, failed;
    se3d_system *system = NULL;
    se3d_solver *solver = NULL;
    se3d_particles *set = NULL;
    trouble of = {.way = way, .fail_at = -1};
    se3d_solver_def how = se3d_solver_def_default();
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    how.method = SE3D_METHOD_VERLET;
    how.interrupt = ask;
    how.interrupt_ctx = &of;
    CHECK(!se3d_system_create(NULL, &system));
    build(system, &of, &set);
    CHECK(!se3d_mpi_attach(system, MPI_COMM_WORLD));
    CHECK(!se3d_solver_create(system, &how, &solver));
    of.fail_at = rank == size - 1 ? fail_at : -1;
    const se3d_status status = se3d_solver_run(solver, 0.01);
    failed = status < 0;
    CHECK(is_same((uint64_t)(-status)));
    CHECK(!failed || status == (way == BY_INTERRUPT ? SE3D_ERR_INTERRUPTED : SE3D_ERR_CALLBACK));
    CHECK(way == BY_INTERRUPT || is_same(hash_of(se3d_system_get_error(system))));
    CHECK(is_same(se3d_system_hash(system)));
    int reached = rank == size - 1 && of.calls > fail_at;
    MPI_Allreduce(MPI_IN_PLACE, &reached, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    *failures += failed;
    of.fail_at = -1;
    CHECK(se3d_solver_run(solver, 0.012) >= 0);
    CHECK(is_same(se3d_system_hash(system)) && is_same(se3d_particles_hash(set)));
    se3d_solver_destroy(solver);
    se3d_system_destroy(system);
    return reached;
}

static void who_fails_alone_fails_for_all(void)
{
    for (int way = 0; way < WAYS; ++way) {
        int failures = 0;
        for (long n = 0; try_at(way, n, &failures) && n < 100000;) {
            n += n < 6 ? 1 : n;
        }
        CHECK(failures > 3);
    }
}

int main(int argc, char **argv)
{
    MPI_Init(&argc, &argv);
    RUN(who_fails_alone_fails_for_all);
    MPI_Finalize();
    return check_finish();
}
