/* SPDX-License-Identifier: BSD-3-Clause */
/* The same bits from every compiler and machine, level of instructions and number of threads: one
 * hash for each of a list of mechanisms, forces, methods, formulations, contacts and particles.
 *
 *     test_hashes            compares with tests/determinism/hashes.txt, at all levels there are
 *     test_hashes FILE       writes the hashes, one line for each run (tools/update_hashes.sh)
 *
 * The kernels of a level are chosen by the linker's --wrap: see tests/CMakeLists.txt. */
#include <stdlib.h>

#include "base/hash.h"
#include "check.h"
#include "force/tyre_lanes.h"
#include "integrator/sums.h"
#include "linsol/block_cg_core.h"
#include "linsol/kkt_internal.h"
#include "linsol/kkt_lanes_internal.h"
#include "linsol/mirrors.h"
#include "particles/set.h"
#include "tree/core.h"
#include "tree/lanes.h"
#include "tree/loop_core.h"

#include "support/analyses.h"
#include "support/avalanche.h"
#include "support/clump_mix.h"
#include "support/models.h"
#include "support/scene.h"

/* ---- levels ---- */

static int allowed = 2; /* 0: portable, 1: AVX2 too, 2: AVX-512 too */
static int levels = 1;  /* that this machine has */

/* The finder of kernels for processors of a level, which linking takes in the place of the own:
 * one for each SE3DI_TARGET_FINDER of lib, or the test does not link. */
#define AT_LEVEL(type, finder, level)                                                              \
    const type *__real_se3di_##finder(void);                                                       \
    const type *__wrap_se3di_##finder(void);                                                       \
    const type *__wrap_se3di_##finder(void)                                                        \
    {                                                                                              \
        return allowed >= (level) ? __real_se3di_##finder() : NULL;                                \
    }

AT_LEVEL(se3di_block_cg_core, block_cg_core_avx2, 1)
AT_LEVEL(se3di_kkt_core, kkt_core_avx2, 1)
AT_LEVEL(se3di_kkt_core, kkt_core_avx512, 2)
AT_LEVEL(se3di_kkt_lane_core, kkt_lane_core_avx2, 1)
AT_LEVEL(se3di_kkt_lane_core, kkt_lane_core_avx512, 2)
AT_LEVEL(se3di_kernels, particle_kernels_fma, 0)
AT_LEVEL(se3di_kernels, particle_kernels_avx2, 1)
AT_LEVEL(se3di_kernels, particle_kernels_avx512, 2)
AT_LEVEL(se3di_mirrors, mirrors_avx2, 1)
AT_LEVEL(se3di_sums, sums_avx2, 1)
AT_LEVEL(se3di_tyre_core, tyre_core_avx2, 1)
AT_LEVEL(se3di_tree_core, tree_core_avx2, 1)
AT_LEVEL(se3di_tree_core, tree_core_avx512, 2)
AT_LEVEL(se3di_loop_core, loop_core_avx2, 1)
AT_LEVEL(se3di_lane_core, lane_core_avx2, 1)
AT_LEVEL(se3di_lane_core, lane_core_avx512, 2)

/* ---- runs ---- */

typedef struct row {
    char name[96];
    uint64_t (*run)(const struct row *row, int32_t threads);
    support_analysis analysis;
    int32_t formulation, law, method;
    int threads_max;
} row;

static uint64_t hash_reactions(const support_model *model, uint64_t hash)
{
    for (int k = 0; k < model->joint_count; ++k) {
        double wrench[6];
        CHECK(!se3d_constraint_get_reaction(model->system, model->joints[k], wrench, wrench + 3));
        for (int c = 0; c < 6; ++c) {
            wrench[c] += 0.0; /* -0 is 0 */
        }
        hash = se3di_hash_numbers(hash, wrench, 6);
    }
    return hash;
}

static uint64_t run_mechanism(const row *r, int32_t threads)
{
    support_model model;
    se3d_solver *solver = NULL;
    (void)threads;
    support_model_make(&model, r->analysis.mechanism, r->analysis.count);
    CHECK(support_solver_create(model.system, &r->analysis, r->formulation, &solver) == SE3D_OK);
    CHECK(se3d_solver_run(solver, r->analysis.t_end) >= 0);
    uint64_t hash = se3d_system_hash(model.system);
    if (r->analysis.analysis >= SE3D_ANALYSIS_INVERSE_DYNAMICS) {
        hash = hash_reactions(&model, hash);
    }
    se3d_solver_destroy(solver);
    support_model_destroy(&model);
    return hash;
}

/* Each elementary function at many arguments. */
static uint64_t run_elementary(const row *r, int32_t threads)
{
    uint64_t seed = 17, hash = SE3DI_HASH_START;
    (void)r;
    (void)threads;
    for (int n = 0; n < 300; ++n) {
        const double scale = n % 3 == 0 ? 1.0 : n % 3 == 1 ? 30.0 : 1e-6;
        const double x = scale * check_random(&seed), y = scale * check_random(&seed);
        for (int32_t f = SE3D_ELEMENTARY_SIN; f <= SE3D_ELEMENTARY_POW; ++f) {
            double value = se3d_elementary_eval(f, x, y);
            value = isnan(value) ? 0.0 : value; /* of which there are many */
            hash = se3di_hash_numbers(hash, &value, 1);
        }
    }
    return hash;
}

static void add_forces(const support_model *model)
{
    se3d_force force;
    se3d_friction_def friction = se3d_friction_def_default();
    friction.joint = model->joints[0];
    friction.coordinate = SE3D_JOINT_COORDINATE_ANGLE;
    friction.mu = 0.2;
    friction.radius = 0.05;
    friction.limit = 0.1;
    friction.viscous = 0.02;
    CHECK(se3d_force_create_friction(model->system, &friction, &force) == SE3D_OK);
    se3d_stop_def stop = se3d_stop_def_default();
    stop.joint = model->joints[1];
    stop.coordinate = SE3D_JOINT_COORDINATE_ANGLE;
    stop.lower = -0.2;
    stop.upper = 0.2;
    stop.k = 500.0;
    stop.restitution = 0.6;
    CHECK(se3d_force_create_stop(model->system, &stop, &force) == SE3D_OK);
    se3d_tsda_def tsda = se3d_tsda_def_default();
    tsda.body_i = model->ground;
    tsda.body_j = model->bodies[1];
    tsda.point_i[0] = 0.7;
    tsda.point_i[2] = 1.1;
    tsda.k = 40.0;
    tsda.c = 0.5;
    tsda.l0 = 0.6;
    CHECK(se3d_function_create_expression(model->system, "3*sin(7*t)+exp(-t)*(1+t)^1.5", &tsda.h) ==
          SE3D_OK);
    CHECK(se3d_force_create_tsda(model->system, &tsda, &force) == SE3D_OK);
    se3d_bushing_def bushing = se3d_bushing_def_default();
    bushing.body_i = model->bodies[0];
    bushing.body_j = model->bodies[1];
    for (int k = 0; k < 6; ++k) {
        bushing.K[7 * k] = 0.3 + 0.1 * k;
        bushing.C[7 * k] = 0.01;
    }
    CHECK(se3d_force_create_bushing(model->system, &bushing, &force) == SE3D_OK);
}

static uint64_t run_forces(const row *r, int32_t threads)
{
    support_model model;
    scene s = {0};
    (void)threads;
    support_model_make(&model, "double_pendulum", 1);
    add_forces(&model);
    s.system = model.system;
    scene_solve(&s, r->method, r->formulation, 0.002, 0.0);
    (void)scene_run(&s, 0.3);
    uint64_t hash = hash_reactions(&model, se3d_system_hash(model.system));
    se3d_solver_destroy(s.solver);
    support_model_destroy(&model);
    return hash;
}

static const double slope[3] = {0.2, 0.1, 1.0};

static void lay_plane(scene *s)
{
    se3d_shape_def def = scene_shape(s, scene_ground(s));
    se3d_shape shape;
    memcpy(def.normal, slope, sizeof slope);
    CHECK(se3d_shape_create_plane(s->system, &def, &shape) == SE3D_OK);
}

/* The slope with waves, whose surface moves as a belt and turns. */
static void lay_belt(scene *s)
{
    enum { LINES = 31 };
    static double heights[LINES * LINES];
    se3d_shape_def def = scene_shape(s, scene_ground(s));
    se3d_shape shape;
    for (int k = 0; k < LINES * LINES; ++k) {
        const double x = 0.1 * (k % LINES - 15), y = 0.1 * (k / LINES - 15);
        heights[k] = -slope[0] * x - slope[1] * y + 0.01 * (k % 3);
    }
    def.heights = heights;
    def.row_count = def.column_count = LINES;
    def.spacing[0] = def.spacing[1] = 0.1;
    def.surface_velocity[0] = 0.5;
    def.surface_spin[2] = -0.4;
    CHECK(se3d_shape_create_heightfield(s->system, &def, &shape) == SE3D_OK);
}

/* Two balls and a box thrown onto the ground. */
static uint64_t run_on(const row *r, void (*lay_ground)(scene *s))
{
    static const double size[3] = {0.2, 0.3, 0.1};
    scene s = scene_begin(r->law, 0.4, 0.5, 1e5);
    lay_ground(&s);
    for (int k = 0; k < 2; ++k) {
        const double at[3] = {0.15 * k, 0.05, 0.3 + 0.25 * k}, v[3] = {0.4, 0.1 * k, -1.0};
        (void)scene_ball(&s, 0.1, 2.0 + k, at, v);
    }
    const double at[3] = {-0.6, 0.2, 0.4}, v[3] = {0.3, -0.2, -1.0}, J[3] = {0.03, 0.02, 0.04};
    se3d_body box = scene_body(&s, 3.0, J, at, v);
    (void)scene_box_on(&s, box, size, scene_zero);
    const double axis[3] = {0.6, 0.0, 0.8};
    scene_turn(&s, box, axis, 0.7);
    scene_solve(&s, r->method, r->formulation, r->method == SE3D_METHOD_DOP853 ? 0.02 : 5e-4, 0.0);
    (void)scene_run(&s, 0.25);
    uint64_t hash = se3d_system_hash(s.system);
    scene_end(&s);
    return hash;
}

static uint64_t run_scene(const row *r, int32_t threads)
{
    (void)threads;
    return run_on(r, lay_plane);
}

static uint64_t run_belt(const row *r, int32_t threads)
{
    (void)threads;
    return run_on(r, lay_belt);
}

/* Particles on the same ground. */
static uint64_t run_carried(const row *r, int32_t threads)
{
    enum { COUNT = 20 };
    const se3d_particles_def def = se3d_particles_def_default();
    scene s = scene_begin(r->law, 0.4, 0.5, 1e5);
    se3d_particles *set = NULL;
    double x[3 * COUNT], radius[COUNT];
    (void)threads;
    for (int k = 0; k < COUNT; ++k) {
        x[3 * k] = 0.2 * (k % 5) - 0.4;
        x[3 * k + 1] = 0.2 * (k / 5) - 0.3;
        x[3 * k + 2] = 0.06 - slope[0] * x[3 * k] - slope[1] * x[3 * k + 1];
        radius[k] = 0.04 + 0.0005 * k;
    }
    lay_belt(&s);
    CHECK(se3d_particles_create(s.system, &def, &set) == SE3D_OK);
    CHECK(se3d_particles_add(set, s.material, COUNT, x, radius, NULL, NULL, NULL) == SE3D_OK);
    CHECK(se3d_particles_step(set, 400) == SE3D_OK);
    CHECK(se3d_particles_count_contacts(set) > 0);
    const uint64_t hash = se3d_particles_hash(set);
    scene_end(&s);
    return hash;
}

/* The particles of a bed meet at once. */
static const double strong[3] = {-300.0, 0.0, -400.0};

static uint64_t run_bed(const row *r, int32_t threads)
{
    bed b;
    avalanche_open(&b, threads, 0, r->law);
    CHECK(se3d_system_set_gravity(b.system, strong) == SE3D_OK);
    CHECK(se3d_particles_step(b.particles, 600) == SE3D_OK);
    CHECK(se3d_particles_count_contacts(b.particles) > 100);
    uint64_t hash = se3d_particles_hash(b.particles);
    bed_destroy(&b);
    return hash;
}

/* Clumps of different numbers of spheres that meet, across periods, too. */
static uint64_t run_clumps(const row *r, int32_t threads)
{
    bed b;
    clump_mix_open(&b, threads, 0, r->law);
    CHECK(se3d_particles_step(b.particles, 2000) == SE3D_OK);
    CHECK(se3d_particles_count_contacts(b.particles) > 30);
    const uint64_t hash = se3d_particles_hash(b.particles);
    bed_destroy(&b);
    return hash;
}

/* A turned box and a ball that fall into a bed: walls that give way. */
static uint64_t run_pushed(const row *r, int32_t threads)
{
    static const double size[3] = {0.05, 0.02, 0.03}, J[3] = {1e-4, 2e-4, 1.5e-4};
    static const double at[2][3] = {{0.08, 0.03, 0.15}, {0.16, 0.03, 0.15}},
                        v[3] = {0.5, 0.0, -2.0};
    static const double axis[3] = {0.6, 0.0, 0.8};
    bed b;
    avalanche_open(&b, threads, 0, r->law);
    CHECK(se3d_system_set_gravity(b.system, strong) == SE3D_OK);
    scene s = {.system = b.system};
    se3d_material_def stuff = scene_stuff(0.4, 0.5, 2e4);
    CHECK(se3d_material_create(s.system, &stuff, &s.material) == SE3D_OK);
    se3d_body box = scene_body(&s, 0.1, J, at[0], v);
    (void)scene_box_on(&s, box, size, scene_zero);
    scene_turn(&s, box, axis, 0.7);
    (void)scene_ball(&s, 0.02, 0.1, at[1], v);
    scene_solve(&s, SE3D_METHOD_VERLET, r->formulation, 1e-4, 0.0);
    (void)scene_run(&s, 0.005);
    CHECK(se3d_particles_count_contacts(b.particles) > 50);
    const uint64_t hash =
        se3di_hash_word(se3d_system_hash(s.system), se3d_particles_hash(b.particles));
    se3d_solver_destroy(s.solver);
    bed_destroy(&b);
    return hash;
}

/* ---- table ---- */

static const support_analysis more[] = {
    {"four_bar", 3, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_GENERALIZED_ALPHA, 0.005, 0.1},
    {"chain_revolute", 40, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_HHT, 0.005, 0.05},
    {"slider_crank", 1, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_RK45, 0.01, 0.5},
    {"slider_crank", 1, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_GAUSS, 0.01, 0.5},
    {"driven_pendulum", 1, SE3D_ANALYSIS_INVERSE_DYNAMICS, SE3D_METHOD_AUTO, 0.01, 1.0},
};
#define MORE (sizeof more / sizeof more[0])

static const support_analysis in_joints[] = {
    {"chain_ball", 4, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_DOP853, 0.0, 0.3},
    {"four_bar", 3, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_DOP853, 0.0, 0.4},
    {"chain_revolute", 8, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_GAUSS, 0.0, 0.3},
    {"four_bar", 3, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_GAUSS, 0.0, 0.4},
};

#define ROWS_MAX 128
static row rows[ROWS_MAX];
static size_t row_count;

static row *add(const char *what, int law, int method, int formulation)
{
    row *r = &rows[row_count++];
    CHECK(row_count <= ROWS_MAX);
    (void)snprintf(r->name, sizeof r->name, "%s/law-%d/method-%d/formulation-%d", what, law, method,
                   formulation);
    r->law = law;
    r->method = method;
    r->formulation = formulation;
    r->threads_max = 1;
    return r;
}

static void add_mechanism(const support_analysis *what, int formulation)
{
    char name[64];
    (void)snprintf(name, sizeof name, "%s-%d/analysis-%d", what->mechanism, what->count,
                   what->analysis);
    row *r = add(name, 0, what->method, formulation);
    r->run = run_mechanism;
    r->analysis = *what;
}

static void fill_table(void)
{
    for (size_t k = 0; k < 2 * (SUPPORT_ANALYSES + MORE); ++k) {
        add_mechanism(k / 2 < SUPPORT_ANALYSES ? &support_analyses[k / 2]
                                               : &more[k / 2 - SUPPORT_ANALYSES],
                      (int)(k % 2));
    }
    for (size_t k = 0; k < sizeof in_joints / sizeof *in_joints; ++k) {
        add_mechanism(&in_joints[k], SE3D_FORMULATION_JOINT);
    }
    static const int32_t with_forces[] = {SE3D_METHOD_DOP853, SE3D_METHOD_GENERALIZED_ALPHA,
                                          SE3D_METHOD_RADAU, SE3D_METHOD_RATTLE,
                                          SE3D_METHOD_CONVEX};
    for (int k = 0; k < 10; ++k) {
        add("forces", 0, with_forces[k / 2], k % 2)->run = run_forces;
    }
    add("elementary", 0, 0, 0)->run = run_elementary;
    static const int32_t methods[] = {SE3D_METHOD_VERLET, SE3D_METHOD_DOP853,
                                      SE3D_METHOD_GENERALIZED_ALPHA, SE3D_METHOD_CONVEX};
    static const int32_t laws[] = {SE3D_CONTACT_LAW_HOOKE, SE3D_CONTACT_LAW_HERTZ_MINDLIN};
    for (int k = 0; k < 8; ++k) {
        add("contacts", laws[k % 2], methods[k / 2], k % 2)->run = run_scene;
    }
    for (int k = 0; k < 4; ++k) {
        add("belt", laws[k % 2], k / 2 ? SE3D_METHOD_CONVEX : SE3D_METHOD_VERLET, k % 2)->run =
            run_belt;
    }
    for (int k = 0; k < 2; ++k) {
        add("carried", laws[k], 0, 0)->run = run_carried;
    }
    for (int k = 0; k < 4; ++k) {
        row *r = add(k / 2 ? "pushed-bed" : "bed", laws[k % 2], 0, k % 2);
        r->run = k / 2 ? run_pushed : run_bed;
        r->threads_max = 4;
    }
    for (int k = 0; k < 2; ++k) {
        row *r = add("clumps", laws[k], 0, 0);
        r->run = run_clumps;
        r->threads_max = 4;
    }
}

static void count_levels(void)
{
    levels = 1;
    if (__real_se3di_kkt_core_avx2() && __real_se3di_particle_kernels_avx2()) {
        levels = __real_se3di_kkt_core_avx512() && __real_se3di_particle_kernels_avx512() ? 3 : 2;
    }
    printf("%d of the levels portable, AVX2, AVX-512\n", levels);
}

/* ---- comparison ---- */

static const char *const advice =
    "Results changed. If they were meant to, run `sh tools/update_hashes.sh` and say in the "
    "commit\n"
    "which and why (CONTRIBUTING.md); if not, the difference is between compilers or machines.\n";

/* The expected hash of a row; 0 if the table has none. */
static uint64_t expected(const char *name)
{
    const char *source = getenv("SE3D_SOURCE_DIR");
    char path[1024], line[256], found[128];
    unsigned long long hash, out = 0;
    (void)snprintf(path, sizeof path, "%s/tests/determinism/hashes.txt", source ? source : ".");
    FILE *file = fopen(path, "r");
    while (file && fgets(line, sizeof line, file)) {
        if (sscanf(line, "%16llx %127s", &hash, found) == 2 && strcmp(found, name) == 0) {
            out = hash;
        }
    }
    if (file) {
        (void)fclose(file);
    }
    return out;
}

static void compare(const row *r)
{
    const uint64_t want = expected(r->name);
    for (allowed = levels - 1; allowed >= 0; --allowed) {
        const int32_t threads = r->threads_max > 1 ? 4 - allowed : 1;
        const uint64_t hash = r->run(r, threads);
        if (hash != want) {
            fprintf(stderr, "%s: %016llx at level %d with %d threads, expected %016llx\n", r->name,
                    (unsigned long long)hash, allowed, threads, (unsigned long long)want);
        }
        CHECK(hash == want);
    }
    if (r->threads_max > 1) {
        allowed = levels - 1;
        CHECK(r->run(r, 1) == want);
    }
}

static void every_compiler_machine_level_and_number_of_threads_gives_the_same_bits(void)
{
    const int before = check_failures;
    for (size_t k = 0; k < row_count; ++k) {
        compare(&rows[k]);
    }
    if (check_failures > before) {
        fprintf(stderr, "%s", advice);
    }
}

static int write_hashes(const char *path)
{
    FILE *file = fopen(path, "w");
    if (!file) {
        return 1;
    }
    allowed = levels - 1;
    for (size_t k = 0; k < row_count; ++k) {
        fprintf(file, "%016llx %s\n", (unsigned long long)rows[k].run(&rows[k], 1), rows[k].name);
    }
    return fclose(file) != 0 || check_failures > 0;
}

int main(int argc, char **argv)
{
    count_levels();
    fill_table();
    if (argc > 1) {
        return write_hashes(argv[1]);
    }
    RUN(every_compiler_machine_level_and_number_of_threads_gives_the_same_bits);
    return check_finish();
}
