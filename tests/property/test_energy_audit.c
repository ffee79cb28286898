/* SPDX-License-Identifier: BSD-3-Clause */
/* The audit of energy closes on every example model under dynamics with dop853, in both
 * formulations:
 *
 *     kinetic + potential + dissipated - actuators - drivers = constant
 *
 * to 1e-8 of the largest of these at tolerance 1e-9, and to 1e-6 at the default tolerance. */
#define _POSIX_C_SOURCE 200809L

#include "support/examples.h"
#include "support/text_model.h"

enum { SAMPLES = 200 };

typedef struct audit {
    double balance, largest; /* [J] */
} audit;

static audit measure(const se3d_system *system)
{
    se3d_energy energy;
    se3d_work work;
    CHECK(!se3d_system_get_energy(system, &energy));
    CHECK(!se3d_system_get_work(system, &work));
    audit a = {.balance = energy.kinetic + energy.potential + work.dissipated - work.actuators -
                          work.drivers,
               .largest = fmax(fabs(energy.kinetic), fabs(energy.potential))};
    a.largest = fmax(a.largest, fmax(fabs(work.dissipated), fabs(work.actuators)));
    a.largest = fmax(a.largest, fabs(work.drivers));
    return a;
}

/* The largest gap of the balance over a run, relative to the largest part. */
static double audit_run(se3d_system *system, const se3d_solver_def *def, double duration)
{
    se3d_solver *solver = NULL;
    double gap = 0.0, largest = 1e-12, first = 0.0;
    CHECK(!se3d_solver_create(system, def, &solver));
    for (int k = 0; k <= SAMPLES; ++k) {
        se3d_status status = se3d_solver_run(solver, duration * k / SAMPLES);
        if (status < 0) {
            printf("%s\n", se3d_system_get_error(system));
        }
        CHECK(status >= 0);
        audit a = measure(system);
        first = k == 0 ? a.balance : first;
        gap = fmax(gap, fabs(a.balance - first));
        largest = fmax(largest, a.largest);
    }
    se3d_solver_destroy(solver);
    return gap / largest;
}

/* Run analysis `index` with a tolerance of its own. */
static double audit_analysis(const char *path, size_t index, int32_t formulation, double tolerance)
{
    se3d_model *model = NULL;
    se3d_model_error error;
    se3d_model_analysis analysis;
    se3d_solver_def def = se3d_solver_def_default();
    CHECK(!se3d_model_read_file(path, NULL, &model, &error));
    CHECK(!se3d_model_get_analysis(model, index, &analysis));
    CHECK(!se3d_model_get_solver(model, index, &def));
    def.formulation = formulation;
    def.method = SE3D_METHOD_DOP853;
    def.step = 0.0;
    def.tolerance = tolerance;
    double gap = audit_run(se3d_model_get_system(model), &def, analysis.duration);
    se3d_model_destroy(model);
    return gap;
}

static int audit_model(const char *path, const char *name)
{
    se3d_model *model = NULL;
    se3d_model_error error;
    int audited = 0;
    if (se3d_model_read_file(path, NULL, &model, &error) < 0) {
        return 0; /* no model of motion */
    }
    /* what particles do is in no audit, and their bodies move by verlet only; heaps: by convex */
    for (size_t k = 0; k < se3d_model_count_analyses(model); ++k) {
        se3d_model_analysis analysis;
        CHECK(!se3d_model_get_analysis(model, k, &analysis));
        if (strcmp(analysis.type, "dynamics") == 0 && !support_is_chaotic_example(model, k)) {
            double romega = audit_analysis(path, k, SE3D_FORMULATION_ROMEGA, 1e-9);
            /* contact at rest takes dop853 17 s for each */
            const int both = check_is_long() || strcmp(name, "incline.yaml") != 0;
            double rp = both ? audit_analysis(path, k, SE3D_FORMULATION_RP, 1e-9) : romega;
            double usual = audit_analysis(path, k, SE3D_FORMULATION_ROMEGA, 1e-6);
            printf("%-30s %.1e (rp %.1e, at the default tolerance %.1e)\n", name, romega, rp,
                   usual);
            CHECK(romega <= 1e-8);
            CHECK(rp <= 1e-8);
            CHECK(usual <= 1e-6);
            ++audited;
        }
    }
    se3d_model_destroy(model);
    return audited;
}

static void energy_audit_closes_on_every_example(void)
{
    CHECK(support_visit_examples(audit_model) >= 10);
}

#define CRANK(analysis, channels)                                                                  \
    "se3d: 1\nbodies:\n"                                                                           \
    "  - {name: crank, mass: 2, inertia: [0.1, 0.2, 0.3]}\n"                                       \
    "  - {name: block, mass: 0.5, inertia: [0.01, 0.02, 0.03], position: [0.3, 0, 0]}\n"           \
    "  - {name: yoke, mass: 4, inertia: [0.1, 0.2, 0.3], position: [0.3, 0, 0]}\njoints:\n"        \
    "  - {name: jc, type: revolute, body_i: ground, body_j: crank, at: [0, 0, 0], axis: [0, -1, "  \
    "0]}\n  - {name: pin, type: revolute, body_i: crank, body_j: block, at: [0.3, 0, 0], axis: "   \
    "[0, -1, 0]}\n  - {name: slot, type: prismatic, body_i: yoke, body_j: block, at: [0.3, 0, "    \
    "0], axis: [0, 0, 1]}\n  - {name: guide, type: prismatic, body_i: ground, body_j: yoke, at: "  \
    "[0.3, 0, 0], axis: [1, 0, 0]}\ndrivers: [{name: d, joint: jc, value: \"3*t + sin(t)\"}]\n"    \
    "forces: [{name: s, type: tsda, body_i: ground, body_j: yoke, point_i: [-1, 0, 0], l0: 1.2, "  \
    "k: 200, c: 30, h: \"10*sin(3*t)\"}]\n"                                                        \
    "analysis: {type: " analysis ", duration: 2, step: 0.1}\n"                                     \
    "output: [{file: r.csv, channels: [" channels "]}]\n"

/* Of a scotch yoke with a spring, a damper and an actuator; with few steps of order 6. */
static void inverse_dynamics_closes_the_balance(void)
{
    double off[2];
    for (int run = 0; run < 4; ++run) {
        text_model m = text_model_open(CRANK("inverse_dynamics",
                                             "energy.balance, energy.dissipated, work.actuators, "
                                             "work.drivers"),
                                       SE3D_METHOD_AUTO, run % 2, run / 2 ? 0.025 : 0.05);
        CHECK(text_model_run(&m, 0.0));
        const double before = text_model_get(&m, 0, 0);
        CHECK(text_model_run(&m, 2.0));
        off[run / 2] = fabs(text_model_get(&m, 0, 0) - before);
        CHECK(text_model_get(&m, 1, 0) > 5.0);
        CHECK(fabs(text_model_get(&m, 2, 0)) > 1.0);
        CHECK(text_model_get(&m, 3, 0) > 5.0);
        text_model_close(&m);
    }
    CHECK(off[0] < 1e-6);
    CHECK_NEAR(off[0] / off[1], 64.0, 20.0);
}

static void kinematics_has_no_works_and_says_so(void)
{
    const char *const text = CRANK("kinematics", "work.drivers");
    se3d_model *model = NULL;
    se3d_model_error error = {0};
    CHECK(se3d_model_read_text(text, strlen(text), "m.yaml", NULL, &model, &error) < 0);
    CHECK_CONTAINS(error.message, "`work.drivers` is not computed by kinematics");
    text_model m = text_model_open(CRANK("kinematics", "d.effort"), SE3D_METHOD_AUTO, 0, 0.1);
    se3d_work work;
    CHECK(!se3d_system_get_work(m.system, &work));
    CHECK(text_model_run(&m, 0.5));
    CHECK(se3d_system_get_work(m.system, &work) == SE3D_ERR_STATE);
    se3d_solver_def def = se3d_solver_def_default();
    se3d_solver *next = NULL;
    CHECK(!se3d_solver_create(m.system, &def, &next)); /* dynamics begins a new audit */
    CHECK(se3d_solver_run(next, 0.6) >= 0);
    CHECK(!se3d_system_get_work(m.system, &work));
    CHECK(work.drivers > 0.1 && work.drivers < 10.0);
    se3d_solver_destroy(next);
    text_model_close(&m);
}

/* Drivers prescribe all of the motion: only the works can be wrong, and steps follow them. */
static const char driven[] =
    "se3d: 1\ngravity: [0, 0, -9.81]\n"
    "bodies:\n"
    "  - {name: crank, mass: 2, inertia: [0.02, 0.03, 0.03], position: [0.1, 0, 0]}\n"
    "  - {name: rod, mass: 1, inertia: [0.01, 0.03, 0.03], position: [0.4, 0.02, 0]}\n"
    "  - {name: slider, mass: 3, inertia: [0.01, 0.01, 0.01], position: [0.7, 0, 0]}\n"
    "joints:\n"
    "  - {name: q, type: revolute, body_i: ground, body_j: crank, at: [0, 0, 0], axis: [0, 1, 0]}\n"
    "  - {type: universal, body_i: crank, body_j: rod, at: [0.2, 0, 0], axis: [0, 1, 0], axis_2: "
    "[0, 0, 1]}\n"
    "  - {type: spherical, body_i: rod, body_j: slider, at: [0.7, 0, 0]}\n"
    "  - {type: prismatic, body_i: ground, body_j: slider, at: [0.7, 0, 0], axis: [1, 0, 0]}\n"
    "drivers: [{joint: q, value: \"4*t^3+0.3*sin(9*t)-2.7*t\"}]\n"
    "analysis: {type: dynamics, duration: 1}\n";

static void steps_of_a_driven_motion_follow_its_works(void)
{
    static const int32_t methods[] = {SE3D_METHOD_RADAU, SE3D_METHOD_BDF, SE3D_METHOD_DOP853,
                                      SE3D_METHOD_RK45, SE3D_METHOD_GAUSS};
    for (size_t k = 0; k < sizeof methods / sizeof *methods; ++k) {
        text_model m = text_model_open(driven, methods[k], -1, 0.0);
        se3d_energy energy;
        se3d_work work;
        double first = 0.0, worst = 0.0, size = 0.0;
        for (int row = 1; row <= 20; ++row) {
            CHECK(se3d_solver_run(m.solver, 0.05 * row) >= 0);
            CHECK(!se3d_system_get_energy(m.system, &energy));
            CHECK(!se3d_system_get_work(m.system, &work));
            const double balance = energy.total + work.dissipated - work.actuators - work.drivers;
            first = row == 1 ? balance : first;
            worst = fmax(worst, fabs(balance - first));
            size = fmax(size, fabs(energy.kinetic));
        }
        if (!(worst < 1e-4 * size)) {
            fprintf(stderr, "%s: %g J of %g J\n", se3d_method_get_name(methods[k]), worst, size);
        }
        CHECK(worst < 1e-4 * size);
        text_model_close(&m);
    }
}

int main(void)
{
    RUN(energy_audit_closes_on_every_example);
    RUN(inverse_dynamics_closes_the_balance);
    RUN(kinematics_has_no_works_and_says_so);
    RUN(steps_of_a_driven_motion_follow_its_works);
    return check_finish();
}
