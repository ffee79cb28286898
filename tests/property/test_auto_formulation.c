/* SPDX-License-Identifier: BSD-3-Clause */
/* `auto` integrates joint coordinates where friction needs no load and loops are few clear rows,
 * the coordinates of bodies elsewhere, and decides again when the structure has changed. */
#include "check.h"

#include "integrator/joint_projection.h"
#include "integrator/motion.h"
#include "math/vec3.h"
#include "nonlinear/equations.h"
#include "support/tree_world.h"
#include "support/world.h"

typedef struct arm {
    se3d_system *system;
    se3d_body links[3];
    se3d_constraint joints[3];
} arm;

static const double y[3] = {0.0, 1.0, 0.0};

static arm make_arm(void)
{
    static const double J[3] = {0.2, 0.3, 0.1}, gravity[3] = {1.0, 2.0, -9.81};
    static se3d_status (*const create[3])(se3d_system *, const se3d_joint_def *,
                                          se3d_constraint *) = {
        se3d_joint_create_revolute, se3d_joint_create_spherical, se3d_joint_create_prismatic};
    arm a;
    world_must(NULL, se3d_system_create(NULL, &a.system), "create");
    world_must(a.system, se3d_system_set_gravity(a.system, gravity), "gravity");
    se3d_body before;
    world_must(a.system, se3d_system_get_ground(a.system, &before), "ground");
    for (int k = 0; k < 3; ++k) {
        const double r[3] = {0.1, 0.0, k + 0.5}, at[3] = {0.0, 0.0, k};
        a.links[k] = world_add_body(a.system, 1.0 + k, J, r);
        a.joints[k] = world_join(a.system, create[k], NULL, before, a.links[k], at, y);
        before = a.links[k];
    }
    return a;
}

static const char *name_of(const se3d_solver *solver)
{
    const char *name = NULL;
    CHECK(!se3d_solver_get_formulation(solver, &name));
    return name ? name : "";
}

static int is_named(const se3d_solver *solver, const char *name)
{
    const int same = strcmp(name_of(solver), name) == 0;
    if (!same) {
        fprintf(stderr, "%s, not %s\n", name_of(solver), name);
    }
    return same;
}

/* What a new solver takes. */
static int takes(arm *a, int32_t method, int32_t formulation, const char *name)
{
    se3d_solver *solver = world_solver(a->system, SE3D_ANALYSIS_DYNAMICS, method, formulation, 0.0);
    double now;
    CHECK(!se3d_system_get_time(a->system, &now));
    CHECK(se3d_solver_run(solver, now + 1e-3) >= 0);
    const int same = is_named(solver, name);
    se3d_solver_destroy(solver);
    return same;
}

static void open_trees_are_integrated_in_joint_coordinates(void)
{
    static const int32_t explicit_methods[] = {
        SE3D_METHOD_AUTO, SE3D_METHOD_DOP853, SE3D_METHOD_RK45, SE3D_METHOD_RK4, SE3D_METHOD_GAUSS};
    arm a = make_arm();
    for (size_t k = 0; k < sizeof explicit_methods / sizeof *explicit_methods; ++k) {
        CHECK(takes(&a, explicit_methods[k], SE3D_FORMULATION_AUTO, "joint"));
        CHECK(takes(&a, explicit_methods[k], SE3D_FORMULATION_ROMEGA, "romega"));
        CHECK(takes(&a, explicit_methods[k], SE3D_FORMULATION_RP, "rp"));
    }
    CHECK(takes(&a, SE3D_METHOD_RADAU, SE3D_FORMULATION_AUTO, "romega"));
    CHECK(takes(&a, SE3D_METHOD_GENERALIZED_ALPHA, SE3D_FORMULATION_AUTO, "romega"));
    const se3d_solver_def def = se3d_solver_def_default();
    CHECK(def.formulation == SE3D_FORMULATION_AUTO);
    se3d_system_destroy(a.system);
}

static void the_motion_is_that_of_bodies(void)
{
    arm a = make_arm();
    se3d_system *other = NULL;
    CHECK(!se3d_system_clone(a.system, &other));
    se3d_solver_def def = se3d_solver_def_default();
    se3d_solver *one = NULL, *two = NULL;
    def.tolerance = 1e-10;
    CHECK(!se3d_solver_create(a.system, &def, &one));
    def.formulation = SE3D_FORMULATION_ROMEGA;
    CHECK(!se3d_solver_create(other, &def, &two));
    CHECK(is_named(one, "romega")); /* before the first run */
    for (int k = 1; k <= 10; ++k) {
        double r[2][12], v[2][12];
        CHECK(!se3d_solver_run(one, 0.1 * k) && !se3d_solver_run(two, 0.1 * k));
        CHECK(!se3d_body_get_all(a.system, 4, r[0], NULL, v[0], NULL));
        CHECK(!se3d_body_get_all(other, 4, r[1], NULL, v[1], NULL));
        for (int c = 0; c < 12; ++c) {
            CHECK_NEAR(r[0][c], r[1][c], 1e-8);
            CHECK_NEAR(v[0][c], v[1][c], 1e-7);
        }
    }
    CHECK(is_named(one, "joint") && is_named(two, "romega"));
    se3d_solver_destroy(one);
    se3d_solver_destroy(two);
    se3d_system_destroy(a.system);
    se3d_system_destroy(other);
}

/* One solver, while a loop, a driver and a friction come and go. */
static void it_is_chosen_again_when_the_structure_changes(void)
{
    arm a = make_arm();
    se3d_solver *solver = world_solver(a.system, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_AUTO,
                                       SE3D_FORMULATION_AUTO, 0.0);
    se3d_joint_def rod = se3d_joint_def_default();
    se3d_constraint loop, driver;
    se3d_force friction;
    CHECK(!se3d_solver_run(solver, 0.1) && is_named(solver, "joint"));
    rod.body_i = a.links[0];
    rod.body_j = a.links[2];
    double r[12], d[3];
    CHECK(!se3d_body_get_all(a.system, 4, r, NULL, NULL, NULL));
    se3di_sub(r + 9, r + 3, d);
    rod.distance = se3di_norm(d);
    CHECK(!se3d_joint_create_distance(a.system, &rod, &loop));
    CHECK(se3d_solver_run(solver, 0.2) >= 0 && is_named(solver, "joint"));
    CHECK(!se3d_constraint_destroy(a.system, loop));
    CHECK(!se3d_solver_run(solver, 0.3) && is_named(solver, "joint"));
    se3d_driver_def drive = se3d_driver_def_default();
    drive.joint = a.joints[0];
    CHECK(!se3d_joint_get_coordinate(a.system, a.joints[0], SE3D_JOINT_COORDINATE_ANGLE,
                                     &drive.value, NULL, NULL));
    CHECK(!se3d_driver_create(a.system, &drive, &driver));
    CHECK(se3d_solver_run(solver, 0.4) >= 0 && is_named(solver, "joint"));
    CHECK(!se3d_constraint_destroy(a.system, driver));
    CHECK(!se3d_solver_run(solver, 0.5) && is_named(solver, "joint"));
    se3d_friction_def rub = se3d_friction_def_default();
    rub.joint = a.joints[0];
    rub.mu = 0.1;
    rub.radius = 0.02;
    CHECK(!se3d_force_create_friction(a.system, &rub, &friction));
    CHECK(se3d_solver_run(solver, 0.6) >= 0 && is_named(solver, "romega"));
    CHECK(!se3d_force_destroy(a.system, friction));
    CHECK(!se3d_solver_run(solver, 0.7) && is_named(solver, "joint"));
    se3d_solver_destroy(solver);
    se3d_system_destroy(a.system);
}

/* A new solver of a clone, in the middle of a step, goes on with the same bits. */
static void clones_continue_bit_by_bit(void)
{
    arm a = make_arm();
    se3d_system *other = NULL;
    se3d_solver_def def = se3d_solver_def_default();
    se3d_solver *one = NULL, *two = NULL;
    double r[2][12], v[2][12];
    CHECK(!se3d_solver_create(a.system, &def, &one));
    CHECK(!se3d_solver_run(one, 0.3337));
    CHECK(!se3d_system_clone(a.system, &other));
    CHECK(!se3d_solver_create(other, &def, &two));
    CHECK(!se3d_solver_run(one, 2.0) && !se3d_solver_run(two, 2.0));
    CHECK(is_named(one, "joint") && is_named(two, "joint"));
    CHECK(!se3d_body_get_all(a.system, 4, r[0], NULL, v[0], NULL));
    CHECK(!se3d_body_get_all(other, 4, r[1], NULL, v[1], NULL));
    CHECK(memcmp(r[0], r[1], sizeof r[0]) == 0 && memcmp(v[0], v[1], sizeof v[0]) == 0);
    se3d_solver_destroy(one);
    se3d_solver_destroy(two);
    se3d_system_destroy(a.system);
    se3d_system_destroy(other);
}

static se3d_system *make_empty(const se3d_allocator *allocator)
{
    static const double gravity[3] = {0.0, -9.81, 0.0};
    se3d_system_def def = se3d_system_def_default();
    se3d_system *system = NULL;
    def.allocator = allocator;
    world_must(NULL, se3d_system_create(&def, &system), "create");
    world_must(system, se3d_system_set_gravity(system, gravity), "gravity");
    return system;
}

/* A ring from `base` over `count` revolutes back to it, by a joint at at[count]. */
static void add_ring_on(se3d_system *system, se3d_body base, int count, const double at[][3],
                        const double axis[][3], joint_create close)
{
    static const double J[3] = {0.1, 0.1, 0.1};
    se3d_body before = base;
    for (int k = 0; k < count; ++k) {
        double r[3];
        se3di_add(at[k], at[k + 1], r);
        se3di_scale(0.5, r, r);
        const se3d_body link = world_add_body(system, 1.0, J, r);
        world_join(system, se3d_joint_create_revolute, NULL, before, link, at[k], axis[k]);
        before = link;
    }
    world_join(system, close, NULL, before, base, at[count], axis[count]);
}

static void add_ring(se3d_system *system, int count, const double at[][3], const double axis[][3],
                     joint_create close)
{
    se3d_body ground;
    world_must(system, se3d_system_get_ground(system, &ground), "ground");
    add_ring_on(system, ground, count, at, axis, close);
}

/* Four links in a plane closed by a ball; axes lean by `lean`, each otherwise. */
static se3d_system *make_five_bar(double lean)
{
    static const double at[5][3] = {{0, 0, 0}, {0, 1, 0}, {1, 2, 0}, {2, 1, 0}, {2, 0, 0}};
    const double axis[5][3] = {{0, 0, 1},
                               {lean, -0.7 * lean, 1},
                               {-0.4 * lean, 0.9 * lean, 1},
                               {0.3 * lean, 0.5 * lean, 1},
                               {0, 0, 1}};
    se3d_system *system = make_empty(NULL);
    add_ring(system, 4, at, axis, se3d_joint_create_spherical);
    return system;
}

/* Positions after 1 s. */
static void run_five_bar(double lean, int32_t formulation, const char *name, double r[15])
{
    se3d_system *system = make_five_bar(lean);
    se3d_solver *solver =
        world_solver(system, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_DOP853, formulation, 0.0);
    CHECK(se3d_solver_run(solver, 1.0) >= 0 && is_named(solver, name));
    CHECK(!se3d_body_get_all(system, 5, r, NULL, NULL, NULL));
    se3d_solver_destroy(solver);
    se3d_system_destroy(system);
}

/* A row that is made of what axes are off is never solved as if it were clear: the mechanism would
 * lose a freedom. */
static void rows_that_nearly_depend_at_every_pose_are_not_clear(void)
{
    static const struct {
        double lean;
        const char *name;
    } rows[] = {{0.0, "joint"}, {2e-9, "romega"}, {5e-9, "romega"}, {1e-6, "romega"}};
    double flat[15], r[15];
    run_five_bar(0.0, SE3D_FORMULATION_ROMEGA, "romega", flat);
    for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
        for (int picks = 0; picks < 2; ++picks) {
            run_five_bar(rows[k].lean, picks ? SE3D_FORMULATION_AUTO : SE3D_FORMULATION_JOINT,
                         picks ? rows[k].name : "joint", r);
            for (int c = 0; c < 15; ++c) {
                CHECK_NEAR(r[c], flat[c], 2e-4);
            }
        }
    }
}

/* What a new solver takes under `method`, and at its first step. */
static int chooses(se3d_system *system, int32_t method, const char *name)
{
    se3d_solver *solver =
        world_solver(system, SE3D_ANALYSIS_DYNAMICS, method, SE3D_FORMULATION_AUTO, 0.0);
    double now;
    CHECK(!se3d_system_get_time(system, &now));
    CHECK(se3d_solver_run(solver, now + 1e-3) >= 0);
    const int same = is_named(solver, name);
    se3d_solver_destroy(solver);
    return same;
}

/* Links in a plane that leans, closed by a pin or a ball; on the ground, or on a body that swings
 * about an axis of its own. */
static se3d_system *make_leaning_bars(int on_body, joint_create close)
{
    static const double flat[5][3] = {{0, 0, 0}, {0, 1, 0}, {1, 2, 0}, {2, 1, 0}, {2, 0, 0}};
    static const double turn[4] = {0.83, 0.31, -0.37, 0.28}, J[3] = {0.4, 0.3, 0.2};
    double at[5][3], axis[5][3], p[4], A[9];
    se3d_system *system = make_empty(NULL);
    se3d_body base;
    se3di_quat_normalize(turn, p);
    se3di_quat_to_matrix(p, A);
    for (int k = 0; k < 5; ++k) {
        const double z[3] = {0.0, 0.0, 1.0};
        se3di_mul(A, flat[k], at[k]);
        se3di_mul(A, z, axis[k]);
    }
    world_must(system, se3d_system_get_ground(system, &base), "ground");
    if (on_body) {
        const double point[3] = {-0.5, 0.3, 0.2}, about[3] = {0.6, 0.0, 0.8};
        const se3d_body swing = world_add_body(system, 2.0, J, at[0]);
        world_join(system, se3d_joint_create_revolute, NULL, base, swing, point, about);
        base = swing;
    }
    add_ring_on(system, base, 4, (const double(*)[3])at, (const double(*)[3])axis, close);
    return system;
}

/* r [15] and v [15] of the last bodies after 1 s. */
static void run_leaning_bars(int on_body, joint_create close, int32_t formulation, const char *name,
                             double r[30])
{
    se3d_system *system = make_leaning_bars(on_body, close);
    se3d_solver_def def = se3d_solver_def_default();
    se3d_solver *solver = NULL;
    double all[2][18];
    def.method = SE3D_METHOD_DOP853;
    def.formulation = formulation;
    def.tolerance = 1e-9;
    const size_t bodies = on_body ? 6 : 5;
    CHECK(!se3d_solver_create(system, &def, &solver));
    CHECK(se3d_solver_run(solver, 1.0) >= 0 && is_named(solver, name));
    CHECK(!se3d_body_get_all(system, bodies, all[0], NULL, all[1], NULL));
    memcpy(r, all[0] + 3 * (bodies - 5), 15 * sizeof *r);
    memcpy(r + 15, all[1] + 3 * (bodies - 5), 15 * sizeof *r);
    se3d_solver_destroy(solver);
    se3d_system_destroy(system);
}

/* The row out of a plane that leans or moves is implied by the tree as that of any other. */
static void loops_in_planes_of_their_own_are_clear(void)
{
    static const joint_create closes[2] = {se3d_joint_create_revolute, se3d_joint_create_spherical};
    for (int k = 0; k < 4; ++k) {
        double r[30], expected[30];
        run_leaning_bars(k / 2, closes[k % 2], SE3D_FORMULATION_ROMEGA, "romega", expected);
        run_leaning_bars(k / 2, closes[k % 2], SE3D_FORMULATION_AUTO, "joint", r);
        for (int c = 0; c < 30; ++c) {
            CHECK_NEAR(r[c], expected[c], 1e-6);
        }
    }
}

/* Accelerations and multipliers that are shown, against the equations of the bodies there. */
static void compare_shown(tree_world *w)
{
    se3di_model *model = &w->system->model;
    se3di_equations e;
    double a[6 * (TREE_BODIES_MAX + 1)], lambda[12 * TREE_BODIES_MAX];
    const size_t bodies = 6 * model->body_slots.count, rows = model->row_count;
    double largest[2] = {0.0, 0.0};
    memcpy(a, model->acceleration, bodies * sizeof *a);
    memcpy(lambda, model->lambda, rows * sizeof *lambda);
    CHECK(!se3di_equations_init(&e, model, &se3di_formulation_romega, 1, NULL));
    CHECK(!se3di_acceleration_solve(&e, model->time));
    for (size_t k = 0; k < bodies; ++k) {
        largest[0] = fmax(largest[0], fabs(model->acceleration[k]));
    }
    for (size_t k = 0; k < rows; ++k) {
        largest[1] = fmax(largest[1], fabs(model->lambda[k]));
    }
    for (size_t k = 0; k < bodies; ++k) {
        CHECK_NEAR(a[k], model->acceleration[k], 1e-11 * (1.0 + largest[0]));
    }
    for (size_t k = 0; k < rows; ++k) {
        CHECK_NEAR(lambda[k], model->lambda[k], 1e-11 * (1.0 + largest[1]));
    }
    se3di_equations_destroy(&e);
}

/* The recursions find all that is shown: no equations of the bodies are factored for a row. */
static void what_loops_show_is_what_the_bodies_have(void)
{
    enum { ROWS = 20 };
    int tried = 0;
    for (uint64_t seed = 0; seed < 40; ++seed) {
        tree_world w;
        tree_world_init(&w, seed, 4 + (int)(seed % 4), (int)(seed % 3));
        se3d_solver *solver = world_solver(w.system, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_DOP853,
                                           SE3D_FORMULATION_JOINT, 0.0);
        se3d_solver_stats before, after;
        if (se3d_solver_run(solver, 0.01) == SE3D_OK) {
            CHECK(!se3d_solver_get_stats(solver, &before));
            se3d_status status = SE3D_OK;
            for (int k = 1; k <= ROWS && status == SE3D_OK; ++k) {
                status = se3d_solver_run(solver, 0.01 + 1e-5 * k);
            }
            CHECK(!se3d_solver_get_stats(solver, &after));
            if (status == SE3D_OK) {
                compare_shown(&w);
                CHECK(after.factorizations - before.factorizations < ROWS + 10);
                ++tried;
            }
        }
        se3d_solver_destroy(solver);
        tree_world_destroy(&w);
    }
    CHECK(tried > 25);
}

/* Off its loops and its driver, a tree is as far as its bodies are from all their rows. */
static void gaps_of_trees_are_those_of_the_bodies(void)
{
    const se3di_state_scale scale = {.length = 1.3, .speed = 2.0, .spin = 3.0};
    int tried = 0;
    for (uint64_t seed = 0; seed < 40; ++seed) {
        tree_world w;
        se3di_equations e;
        double state[16 * TREE_BODIES_MAX], own, all;
        se3d_driver_def drive = se3d_driver_def_default();
        se3d_constraint driver;
        tree_world_init(&w, seed, 5, 1 + (int)(seed % 2));
        CHECK(!se3d_function_create_expression(w.system, "3 + 2*t", &drive.function));
        drive.joint = w.joints[0];
        const int drives = w.joint_count > 0 && se3d_driver_create(w.system, &drive, &driver) >= 0;
        CHECK(!se3di_equations_init(&e, &w.system->model, &se3di_formulation_joint, 1, NULL));
        const size_t count = (size_t)e.tree->q_count + e.tree->v_count;
        CHECK(count + SE3DI_STATE_WORK < sizeof state / sizeof *state);
        se3di_motion_joints.get(&e, state);
        for (size_t k = 0; k < count; ++k) {
            state[k] += tree_uniform(&w, -1e-3, 1e-3);
        }
        se3di_motion_joints.set(&e, state);
        CHECK(!se3di_joint_measure_gap(&e, 0.1, &scale, &own));
        CHECK(!se3di_state_measure_gap(&e, 0.1, &scale, &all));
        CHECK_NEAR(own, all, 1e-11 * (1.0 + all));
        tried += own > 1e-4 && drives;
        se3di_equations_destroy(&e);
        tree_world_destroy(&w);
    }
    CHECK(tried > 10);
}

/* A spring is not computed in lanes. */
static void gauss_moves_the_bodies_of_loops_that_lanes_do_not_take(void)
{
    se3d_system *system = make_five_bar(0.0);
    se3d_tsda_def spring = se3d_tsda_def_default();
    se3d_force force;
    CHECK(chooses(system, SE3D_METHOD_GAUSS, "joint"));
    CHECK(!se3d_system_get_ground(system, &spring.body_i));
    CHECK(!se3d_system_get_body(system, 1, &spring.body_j));
    spring.point_i[0] = -1.0;
    spring.k = 1.0;
    CHECK(!se3d_force_create_tsda(system, &spring, &force));
    CHECK(chooses(system, SE3D_METHOD_GAUSS, "romega"));
    CHECK(chooses(system, SE3D_METHOD_RK45, "joint"));
    se3d_system_destroy(system);
}

/* Bricard's mechanism has as many rows as freedoms: what else moves does not make it clear. */
static void loops_apart_are_counted_apart(void)
{
    static const double at[6][3] = {{0, 0, 0},  {1, 0, 0},  {1, -1, 0},
                                    {1, -1, 1}, {0, -1, 1}, {0, 0, 1}};
    static const double axis[6][3] = {{0, 1, 0}, {0, 0, 1}, {1, 0, 0},
                                      {0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
    static const double J[3] = {0.1, 0.1, 0.1}, pin[3] = {5.0, 0.0, 0.0}, r[3] = {5.5, 0.0, 0.0};
    se3d_system *system = make_empty(NULL);
    se3d_body ground;
    add_ring(system, 5, at, axis, se3d_joint_create_revolute);
    CHECK(chooses(system, SE3D_METHOD_DOP853, "romega"));
    CHECK(!se3d_system_get_ground(system, &ground));
    world_join(system, se3d_joint_create_revolute, NULL, ground, world_add_body(system, 1.0, J, r),
               pin, axis[1]);
    CHECK(chooses(system, SE3D_METHOD_DOP853, "romega"));
    se3d_system_destroy(system);
    system = make_five_bar(0.0);
    CHECK(!se3d_system_get_ground(system, &ground));
    world_join(system, se3d_joint_create_revolute, NULL, ground, world_add_body(system, 1.0, J, r),
               pin, axis[1]);
    CHECK(chooses(system, SE3D_METHOD_DOP853, "joint"));
    se3d_system_destroy(system);
}

typedef struct room {
    size_t now, most; /* bytes */
} room;

static void *room_alloc(void *ctx, size_t size)
{
    room *r = ctx;
    r->now += size;
    r->most = r->now > r->most ? r->now : r->most;
    return malloc(size);
}

static void room_free(void *ctx, void *memory, size_t size)
{
    room *r = ctx;
    r->now -= memory ? size : 0;
    free(memory);
}

static void *room_realloc(void *ctx, void *memory, size_t old_size, size_t new_size)
{
    void *copy = room_alloc(ctx, new_size);
    if (copy && memory) {
        memcpy(copy, memory, old_size < new_size ? old_size : new_size);
        room_free(ctx, memory, old_size);
    }
    return copy;
}

/* A lift of `stages` crossed pairs of arms: every loop closes over all arms below it. */
static void add_lift(se3d_system *system, int stages)
{
    static const double J[3] = {0.1, 0.1, 0.1}, z[3] = {0, 0, 1}, x[3] = {1, 0, 0};
    const joint_create pin = se3d_joint_create_revolute;
    const double feet[2][3] = {{0, 0, 0}, {1, 0, 0}};
    se3d_body ground, below[2];
    world_must(system, se3d_system_get_ground(system, &ground), "ground");
    const se3d_body slide = world_add_body(system, 1.0, J, feet[1]);
    world_join(system, se3d_joint_create_prismatic, NULL, ground, slide, feet[1], x);
    below[0] = ground;
    below[1] = slide;
    for (int k = 0; k < stages; ++k) {
        const double left[3] = {0, k, 0}, right[3] = {1, k, 0}, mid[3] = {0.5, k + 0.5, 0};
        const se3d_body a = world_add_body(system, 1.0, J, mid);
        const se3d_body b = world_add_body(system, 1.0, J, mid);
        world_join(system, pin, NULL, below[0], a, left, z);
        world_join(system, pin, NULL, below[1], b, right, z);
        world_join(system, pin, NULL, a, b, mid, z);
        below[0] = b; /* it ends on the left */
        below[1] = a;
    }
}

/* The most memory that building takes and its first step. */
static size_t room_of_lift(int stages, int32_t formulation)
{
    room r = {0};
    const se3d_allocator allocator = {room_alloc, room_realloc, room_free, &r};
    se3d_system *system = make_empty(&allocator);
    add_lift(system, stages);
    se3d_solver *solver =
        world_solver(system, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_DOP853, formulation, 0.0);
    CHECK(se3d_solver_run(solver, 1e-5) >= 0 && is_named(solver, "romega"));
    se3d_solver_destroy(solver);
    se3d_system_destroy(system);
    CHECK(r.now == 0);
    return r.most;
}

/* Loops that stand on each other are left before their equations are built. */
static void nothing_large_is_built_to_be_left(void)
{
    const size_t bodies = room_of_lift(80, SE3D_FORMULATION_ROMEGA);
    const size_t tried = room_of_lift(80, SE3D_FORMULATION_AUTO);
    CHECK((double)tried < 1.02 * (double)bodies);
}

int main(void)
{
    RUN(open_trees_are_integrated_in_joint_coordinates);
    RUN(the_motion_is_that_of_bodies);
    RUN(it_is_chosen_again_when_the_structure_changes);
    RUN(clones_continue_bit_by_bit);
    RUN(rows_that_nearly_depend_at_every_pose_are_not_clear);
    RUN(loops_in_planes_of_their_own_are_clear);
    RUN(what_loops_show_is_what_the_bodies_have);
    RUN(gaps_of_trees_are_those_of_the_bodies);
    RUN(gauss_moves_the_bodies_of_loops_that_lanes_do_not_take);
    RUN(loops_apart_are_counted_apart);
    RUN(nothing_large_is_built_to_be_left);
    return check_finish();
}
