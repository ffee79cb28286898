/* SPDX-License-Identifier: BSD-3-Clause */
/* Outputs lie within steps at whose ends joints begin to stick or to slip: what they show is of
 * before that change. */
#include "support/text_model.h"

#define LINKS   4
#define OUTPUTS 200
#define STEP    2.5e-3
#define RATE    LINKS /* channels: forces, then rates, then energy and its balance */
#define ENERGY  (2 * LINKS)

/* A chain in a plane that swings out and comes to rest. */
#define LINK(k, x, y, spin)                                                                        \
    "  - {name: b" k ", mass: 1, inertia: [0.02, 0.02, 0.02], position: [" x ", " y ", 0], "       \
    "angular_velocity: [0, 0, " spin "]}\n"
#define PIN(k, i, j, x, y)                                                                         \
    "  - {name: j" k ", type: revolute, body_i: " i ", body_j: " j ", at: [" x ", " y ", 0], "     \
    "axis: [0, 0, 1]}\n"
#define FRICTION(k)                                                                                \
    "  - {name: f" k ", type: friction, joint: j" k ", mu: 0.3, mu_static: 0.4, radius: 0.05}\n"
static const char *const chain =
    "se3d: 1\ngravity: [0, -9.81, 0]\nbodies:\n" LINK("1", "0.1", "-0.2", "0")
        LINK("2", "0.1", "-0.6", "0") LINK("3", "0.1", "-1", "0")
            LINK("4", "0.1", "-1.4", "4") "joints:\n" PIN("1", "ground", "b1", "0", "0")
                PIN("2", "b1", "b2", "0.2", "-0.4") PIN("3", "b2", "b3", "0", "-0.8")
                    PIN("4", "b3", "b4", "0.2", "-1.2") "forces:\n" FRICTION("1") FRICTION("2")
                        FRICTION("3")
                            FRICTION("4") "analysis: {type: dynamics, duration: 1}\n"
                                          "output: [{file: r.csv, channels: [f1.force, f2.force, "
                                          "f3.force, f4.force, j1.rate, j2.rate, "
                                          "j3.rate, j4.rate, energy.total, energy.balance]}]\n";

static text_model open_chain(int32_t method, int32_t formulation, double tolerance)
{
    text_model m = text_model_open(chain, method, formulation, 0.0);
    se3d_solver_def def = se3d_solver_def_default();
    se3d_solver_destroy(m.solver);
    def.method = method;
    def.formulation = formulation;
    def.tolerance = tolerance;
    CHECK(!se3d_solver_create(m.system, &def, &m.solver));
    return m;
}

static const struct {
    int32_t method;
    int32_t reserved;
    double tolerance, gain, accuracy;
} methods[] = {
    {SE3D_METHOD_DOP853, 0, 1e-8, 1e-8, 1e-7},
    {SE3D_METHOD_RK45, 0, 1e-7, 1e-7, 1e-6},
    {SE3D_METHOD_RADAU, 0, 1e-7, 1e-7, 5e-5},
    {SE3D_METHOD_BDF, 0, 1e-7, 1e-7, 5e-5},
    {SE3D_METHOD_GENERALIZED_ALPHA, 0, 1e-6, 1e-6, 1e-2},
    {SE3D_METHOD_HHT, 0, 1e-6, 1e-6, 1e-2},
};
enum { METHODS = sizeof methods / sizeof *methods };

static void energy_never_grows_from_output_to_output(void)
{
    for (size_t k = 0; k < 2 * METHODS; ++k) {
        text_model m =
            open_chain(methods[k / 2].method, (int32_t)(k % 2), methods[k / 2].tolerance);
        double before = HUGE_VAL, gain = 0.0;
        for (int n = 0; n <= OUTPUTS && text_model_run(&m, STEP * n); ++n) {
            const double energy = text_model_get(&m, ENERGY, 0);
            gain = fmax(gain, energy - before);
            before = energy;
        }
        CHECK(gain <= methods[k / 2].gain);
        text_model_close(&m);
    }
}

/* Rates at outputs against those of dop853 at 1e-11. */
static void states_at_outputs_are_those_of_a_fine_run(void)
{
    static double rates[OUTPUTS + 1][LINKS];
    for (int k = -1; k < METHODS; ++k) {
        text_model m = k < 0 ? open_chain(SE3D_METHOD_DOP853, 0, 1e-11)
                             : open_chain(methods[k].method, 0, methods[k].tolerance);
        double error = 0.0;
        for (int n = 0; n <= OUTPUTS && text_model_run(&m, STEP * n); ++n) {
            for (size_t c = 0; c < LINKS; ++c) {
                const double rate = text_model_get(&m, RATE + c, 0);
                rates[n][c] = k < 0 ? rate : rates[n][c];
                error = fmax(error, fabs(rate - rates[n][c]));
            }
        }
        CHECK(k < 0 || error <= methods[k].accuracy);
        text_model_close(&m);
    }
}

static uint64_t run_on(text_model *m, double t)
{
    CHECK(text_model_run(m, t));
    return se3d_system_hash(m->system);
}

static uint64_t run_clone(const text_model *m, size_t k, double t)
{
    se3d_solver_def def = se3d_solver_def_default();
    text_model clone = {NULL, NULL, NULL};
    def.method = methods[k].method;
    def.formulation = 0;
    def.tolerance = methods[k].tolerance;
    CHECK(!se3d_system_clone(m->system, &clone.system));
    CHECK(!se3d_solver_create(clone.system, &def, &clone.solver));
    const uint64_t hash = run_on(&clone, t);
    se3d_solver_destroy(clone.solver);
    se3d_system_destroy(clone.system);
    return hash;
}

/* What is remembered of the end of a step is not lost where a state before it is shown. */
static void outputs_snapshots_and_clones_change_no_bit_of_what_follows(void)
{
    for (size_t k = 0; k < METHODS; ++k) {
        text_model often = open_chain(methods[k].method, 0, methods[k].tolerance);
        text_model rarely = open_chain(methods[k].method, 0, methods[k].tolerance);
        for (int n = 0; n <= OUTPUTS; ++n) {
            const double later = STEP * (n + 5);
            se3d_snapshot *snapshot = NULL;
            CHECK(text_model_run(&often, STEP * n));
            if (n % 8 == 0) {
                CHECK(text_model_run(&rarely, STEP * n));
                CHECK(se3d_system_hash(often.system) == se3d_system_hash(rarely.system));
            }
            if (n % 16 == 1) {
                CHECK(!se3d_snapshot_create(often.system, &snapshot));
                const uint64_t clone = run_clone(&often, k, later);
                CHECK(run_on(&often, later) == clone);
                CHECK(!se3d_snapshot_restore(snapshot, often.system));
                CHECK(run_on(&often, later) == clone);
                CHECK(!se3d_snapshot_restore(snapshot, often.system));
            }
            se3d_snapshot_destroy(snapshot);
        }
        text_model_close(&often);
        text_model_close(&rarely);
    }
}

int main(void)
{
    RUN(energy_never_grows_from_output_to_output);
    RUN(states_at_outputs_are_those_of_a_fine_run);
    RUN(outputs_snapshots_and_clones_change_no_bit_of_what_follows);
    return check_finish();
}
