/* SPDX-License-Identifier: BSD-3-Clause */
/* Hosts that behave badly: that trap divisions, round another way, flush small numbers to zero,
 * have small stacks, write a comma for the point, catch signals, fork, or leave a callback by a
 * jump. */
#define _GNU_SOURCE
#include <fenv.h>
#include <pthread.h>
#include <setjmp.h>
#include <signal.h>
#include <stdio.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>
#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include "check.h"
#include "se3d/io.h"
#include "se3d/se3d.h"
#include "support/bed.h"
#include "support/comma_locale.h"
#include "support/mechanisms.h"
#include "support/methods.h"

static const char *const models[] = {"bar_rsda_tsda",
                                     "double_pendulum",
                                     "fourbar",
                                     "incline_friction",
                                     "pendulum",
                                     "pendulum_events",
                                     "quarter_car",
                                     "spatial_slider_crank",
                                     "planar_slider_crank",
                                     "bar_equilibrium",
                                     "tsda_mass",
                                     "flyball_governor",
                                     "pushed_grains",
                                     "landing_gear",
                                     "andrews"};
#define MODELS       (sizeof models / sizeof *models)
#define METHODS_MOST 16

/* What a run came to. */
typedef struct outcome {
    int ended;     /* analyses that came to their end */
    uint64_t hash; /* of the states at the end, of all analyses */
} outcome;

/* Analyses that came to their end, of the case at hand. */
static int runs;

/* Some need more steps than others. */
static double span(const char *model)
{
    return strcmp(model, "andrews") == 0 ? 0.002 : 0.02;
}

/* .02 s by a method, or as the file says (NULL). */
static outcome run(const char *model, const char *method, const char *formulation)
{
    char path[300];
    outcome all = {0, 0};
    se3d_model *read = NULL;
    se3d_model_error error;
    se3d_model_options how = se3d_model_options_default();
    how.duration = method ? "0.02" : NULL;
    how.method = method;
    how.tolerance = method ? "1e-6" : NULL; /* whatever the method: some are of low order */
    how.formulation = formulation;
    how.analysis = method ? "dynamics" : NULL;
    snprintf(path, sizeof path, "examples/models/%s.yaml", model);
    if (SE3D_FAILED(se3d_model_read_file(path, &how, &read, &error))) {
        CHECK(method != NULL); /* that one takes no such method */
        return all;
    }
    for (size_t k = 0; k < se3d_model_count_analyses(read); ++k) {
        se3d_solver *solver = NULL;
        se3d_solver_def def = se3d_solver_def_default();
        if (SE3D_FAILED(se3d_model_get_solver(read, k, &def)) ||
            SE3D_FAILED(se3d_solver_create(se3d_model_get_system(read), &def, &solver))) {
            continue;
        }
        double time = 0.0;
        se3d_system_get_time(se3d_model_get_system(read), &time);
        if (!SE3D_FAILED(se3d_solver_run(solver, time)) &&
            !SE3D_FAILED(se3d_solver_run(solver, time + span(model)))) {
            ++all.ended;
            all.hash = all.hash * 31u + se3d_system_hash(se3d_model_get_system(read));
        }
        se3d_solver_destroy(solver);
    }
    se3d_model_destroy(read);
    runs += all.ended;
    return all;
}

/* Every model by every method, and what it comes to in a host that behaves well. */
static outcome expected[MODELS][METHODS_MOST];

static const char *method_at(int32_t m)
{
    return m < method_count() ? se3d_method_get_name(m) : NULL;
}

static void run_and_compare(size_t k, int32_t m,
                            void (*compare)(const char *, const char *, outcome, outcome))
{
    const outcome found = run(models[k], method_at(m), "romega");
    if (compare) {
        compare(models[k], method_at(m), found, expected[k][m]);
    } else {
        expected[k][m] = found;
    }
}

/* Each model by every method; with `shift` >= 0 and not for long as its file says and by one
 * method, another one in each case. */
static void run_all(int32_t shift, void (*compare)(const char *, const char *, outcome, outcome))
{
    const int32_t methods = method_count();
    runs = 0;
    CHECK(methods < METHODS_MOST);
    for (size_t k = 0; k < MODELS; ++k) {
        for (int32_t m = 0; m < methods; ++m) {
            if (shift < 0 || check_is_long() || m == ((int32_t)k + shift) % methods) {
                run_and_compare(k, m, compare);
            }
        }
        run_and_compare(k, methods, compare);
    }
    CHECK(runs > 20);
}

static void expect_same(const char *model, const char *method, outcome found, outcome good)
{
    if (found.ended != good.ended || found.hash != good.hash) {
        fprintf(stderr, "%s by %s: other bits\n", model, method ? method : "default");
    }
    CHECK(found.ended == good.ended && found.hash == good.hash);
}

/* feenableexcept: nothing divides by zero if all is well, in any analysis and method. */
static void divisions_are_not_by_zero(void)
{
#if defined(__GLIBC__) && defined(FE_DIVBYZERO)
    CHECK(feenableexcept(FE_DIVBYZERO) >= 0);
    run_all(-1, expect_same);
    run("fourbar", "radau", "rp");
    fedisableexcept(FE_DIVBYZERO);
#endif
}

/* NaN, what is too large and what is too small are values inside. */
static void traps_change_nothing(void)
{
#if defined(__GLIBC__) && defined(__SSE2__)
    const int traps = FE_INVALID | FE_OVERFLOW | FE_UNDERFLOW;
    CHECK(feenableexcept(traps) >= 0);
    run_all(2, expect_same);
    CHECK((fegetexcept() & traps) == traps);
    fedisableexcept(traps);
#endif
}

static void other_roundings_change_nothing(void)
{
#if defined(FE_UPWARD) && defined(FE_DOWNWARD) && defined(FE_TOWARDZERO)
    static const int modes[] = {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO};
    for (size_t k = 0; k < (check_is_long() ? 3 : 1); ++k) {
        CHECK(fesetround(modes[k]) == 0);
        run_all(3 + (int32_t)k, expect_same);
        fesetround(FE_TONEAREST);
    }
#endif
}

/* As programs built with -ffast-math do for all that they load. */
static void zeros_for_small_numbers_change_nothing(void)
{
#if defined(__SSE2__)
    const unsigned int before = _mm_getcsr();
    _mm_setcsr(before | 0x8040u); /* flush to zero, denormals are zero */
    run_all(6, expect_same);
    _mm_setcsr(before);
#endif
}

static void *run_all_in_a_thread(void *data)
{
    (void)data;
    run_all(8, expect_same);
    return NULL;
}

#if defined(__SANITIZE_ADDRESS__)
#define STACK ((size_t)512 << 10) /* what it adds to frames */
#else
#ifdef __OPTIMIZE__
#define STACK ((size_t)64 << 10)
#else
#define STACK ((size_t)256 << 10) /* each variable has a place of its own */
#endif
#endif

static void stacks_of_64_kilobytes_suffice(void)
{
    pthread_attr_t attributes;
    pthread_t thread;
    CHECK(pthread_attr_init(&attributes) == 0);
    CHECK(pthread_attr_setstacksize(&attributes, STACK) == 0);
    CHECK(pthread_create(&thread, &attributes, run_all_in_a_thread, NULL) == 0);
    CHECK(pthread_join(thread, NULL) == 0);
    pthread_attr_destroy(&attributes);
}

static void a_comma_for_the_point_changes_nothing(void)
{
    const int found = comma_locale_set(LC_ALL);
    printf("locale with a decimal comma: %s\n", found ? "tested" : "SKIPPED, there is none");
    run_all(10, expect_same);
    setlocale(LC_ALL, "C");
}

static volatile sig_atomic_t signals;
static volatile double heat;

/* Uses numbers and rounding as handlers may. */
static void note_signal(int number)
{
    (void)number;
    const int before = fegetround();
    fesetround(FE_DOWNWARD);
    heat = 1.0 / (3.0 + heat);
    fesetround(before);
    ++signals;
}

/* A timer rings all the time, and calls to the system are not begun anew after it. */
static void signals_change_nothing(void)
{
    const struct itimerval often = {{0, 500}, {0, 500}}, never = {{0, 0}, {0, 0}};
    struct sigaction action, before;
    memset(&action, 0, sizeof action);
    action.sa_handler = note_signal;
    CHECK(sigaction(SIGALRM, &action, &before) == 0);
    CHECK(setitimer(ITIMER_REAL, &often, NULL) == 0);
    run_all(12, expect_same);
    CHECK(setitimer(ITIMER_REAL, &never, NULL) == 0);
    CHECK(sigaction(SIGALRM, &before, NULL) == 0);
    CHECK(signals > 20);
}

/* Particles that two threads work on. */
static se3d_solver *open_particles(bed *b)
{
    static const double down[3] = {0.0, 0.0, -9.81}, origin[3] = {0.0, 0.0, 0.0};
    se3d_particles_def set = se3d_particles_def_default();
    se3d_material_def stuff = se3d_material_def_default();
    se3d_solver_def how = se3d_solver_def_default();
    se3d_solver *solver = NULL;
    const double up[3] = {0.0, 0.0, 1.0};
    set.threads = 2;
    stuff.density = 2500.0;
    stuff.stiffness = 2e4;
    bed_open(b, SE3D_CONTACT_LAW_HOOKE, down, &set, &stuff);
    bed_add_plane(b, origin, up);
    for (int k = 0; k < 4000; ++k) {
        const double r[3] = {.021 * (k % 20), .021 * (k / 20 % 20), .01 + .021 * (k / 400)};
        bed_add(b, r, .01, origin, origin);
    }
    how.method = SE3D_METHOD_VERLET;
    CHECK(!SE3D_FAILED(se3d_solver_create(b->system, &how, &solver)));
    return solver;
}

/* A child goes on with the same bits, also where the parent's threads do not exist in it. */
static void a_child_of_fork_goes_on(void)
{
    bed b;
    se3d_solver *solver = open_particles(&b);
    CHECK(!SE3D_FAILED(se3d_solver_run(solver, 1e-3)));
    const pid_t child = fork();
    if (child == 0) {
        alarm(20);
        const int ended = !SE3D_FAILED(se3d_solver_run(solver, 2e-3));
        const outcome bars = run("fourbar", NULL, "romega");
        const int same = bars.hash == expected[2][method_count()].hash;
        _exit(ended && same ? (int)(se3d_system_hash(b.system) % 100u) : 100);
    }
    CHECK(!SE3D_FAILED(se3d_solver_run(solver, 2e-3)));
    const int hash = (int)(se3d_system_hash(b.system) % 100u);
    se3d_solver_destroy(solver);
    bed_close(&b);
    int status = -1;
    CHECK(child > 0 && waitpid(child, &status, 0) == child);
    CHECK(WIFEXITED(status) && WEXITSTATUS(status) == hash);
}

static jmp_buf away;

static se3d_status jump(void *ctx, double t, const se3d_body_motion motion[2], double wrench[12],
                        double *K, double *D)
{
    (void)ctx;
    (void)t;
    (void)motion;
    (void)wrench;
    (void)K;
    (void)D;
    longjmp(away, 1);
}

/* Kept, as it cannot be destroyed: nobody can know that the run does not go on. */
static world left;

static void a_system_whose_callback_jumped_away_refuses_all(void)
{
    const double from[2] = {0.0, 0.0};
    se3d_force_callback_def def = se3d_force_callback_def_default();
    se3d_solver_def how = se3d_solver_def_default();
    se3d_force force;
    se3d_system *copy = NULL;
    left = world_create();
    def.callback = jump;
    def.body_j = left.ground;
    def.body_i = add_bar(&left, "bar", from, 0.0, 1.0, 1.0);
    MUST(&left, se3d_force_create_callback(left.system, &def, &force));
    MUST(&left, se3d_solver_create(left.system, &how, &left.solver));
    if (setjmp(away) == 0) {
        se3d_solver_run(left.solver, 1.0);
        CHECK(0); /* the callback was not called */
    }
    CHECK(se3d_solver_run(left.solver, 1.0) == SE3D_ERR_STATE);
    CHECK(se3d_solver_step(left.solver, 1e-3) == SE3D_ERR_STATE);
    CHECK(se3d_system_clone(left.system, &copy) == SE3D_ERR_STATE && copy == NULL);
    CHECK(se3d_system_set_time(left.system, 0.0) == SE3D_ERR_STATE);
    se3d_solver_destroy(left.solver);
    se3d_system_destroy(left.system);
    CHECK(se3d_system_count_bodies(left.system) == 2);
    CHECK(run("fourbar", NULL, "romega").hash == expected[2][method_count()].hash);
}

int main(void)
{
    run_all(-1, NULL);
    RUN(divisions_are_not_by_zero);
    RUN(traps_change_nothing);
    RUN(other_roundings_change_nothing);
    RUN(zeros_for_small_numbers_change_nothing);
    RUN(stacks_of_64_kilobytes_suffice);
    RUN(a_comma_for_the_point_changes_nothing);
    RUN(signals_change_nothing);
    RUN(a_child_of_fork_goes_on);
    RUN(a_system_whose_callback_jumped_away_refuses_all);
    return check_finish();
}
