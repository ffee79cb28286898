/* SPDX-License-Identifier: BSD-3-Clause */
/* Rows of results: what one time asks of a system is computed once, however many columns of however
 * many files show it. Counted where forces and laws of contact are evaluated. */
#include <stdlib.h>

#include "check.h"
#include "se3d/io.h"
#include "se3d/se3d.h"

static size_t calls;

static se3d_status count_force(void *ctx, double t, const se3d_body_motion motion[2],
                               double wrench[12], double *K, double *D)
{
    (void)ctx;
    (void)K;
    (void)D;
    ++calls;
    wrench[8] = 3.0 * t - 2.0 * motion[1].v[2];
    return SE3D_OK;
}

static se3d_status count_law(void *ctx, const se3d_contact_input *in, se3d_contact_output *out)
{
    (void)ctx;
    ++calls;
    out->force = 1e4 * in->overlap;
    return SE3D_OK;
}

static void add_force(se3d_model *model)
{
    se3d_force_callback_def def = se3d_force_callback_def_default();
    se3d_system *system = se3d_model_get_system(model);
    se3d_force force;
    CHECK(se3d_system_get_body(system, 0, &def.body_i) == SE3D_OK);
    CHECK(se3d_system_get_body(system, 1, &def.body_j) == SE3D_OK);
    def.callback = count_force;
    CHECK(se3d_force_create_callback(system, &def, &force) == SE3D_OK);
}

static void set_law(se3d_model *model)
{
    se3d_contact_settings settings = se3d_contact_settings_default();
    settings.law = SE3D_CONTACT_LAW_CALLBACK;
    settings.callback = count_law;
    settings.step = 1e-4;
    CHECK(se3d_system_set_contact(se3d_model_get_system(model), &settings) == SE3D_OK);
}

/* The calls that a run of head + output takes. */
static size_t run(const char *head, const char *output, void (*prepare)(se3d_model *))
{
    char text[4000], folder[800];
    se3d_model *model = NULL;
    se3d_run *done = NULL;
    se3d_model_error error;
    se3d_run_options how = se3d_run_options_default();
    snprintf(folder, sizeof folder, "%s/io-rows", check_scratch());
    snprintf(text, sizeof text, "%s%s", head, output);
    how.directory = folder;
    se3d_status status = se3d_model_read_text(text, strlen(text), "m.yaml", NULL, &model, &error);
    calls = 0;
    if (status >= 0) {
        prepare(model);
        status = se3d_model_run(model, &how, &done, &error);
    }
    CHECK(status >= 0);
    if (status < 0) {
        fprintf(stderr, "%s\n", error.message);
    }
    se3d_run_destroy(done);
    se3d_model_destroy(model);
    return calls;
}

#define BALL "se3d: 1\nbodies: [{name: ball, mass: 1, inertia: [1, 1, 1]}]\n"
#define ALL_ENERGIES                                                                               \
    "[energy.total, energy.kinetic, energy.potential, energy.dissipated, energy.balance, "         \
    "work.actuators, work.drivers]"

/* Rows within the steps of a dense method and at their ends, in one file and in two. */
static void energies_of_a_row_take_no_evaluation_of_the_forces(void)
{
    static const char *const methods[] = {"dop853", "radau", "generalized_alpha", "rattle"};
    char head[500];
    for (size_t k = 0; k < sizeof methods / sizeof *methods; ++k) {
        snprintf(head, sizeof head,
                 BALL "analysis: {type: dynamics, duration: 0.2, step: 0.002, method: %s}\n",
                 methods[k]);
        const size_t none = run(
            head, "output: [{file: a.csv, every: 0.01, channels: [ball.position]}]\n", add_force);
        const size_t one = run(
            head, "output: [{file: a.csv, every: 0.01, channels: [energy.total]}]\n", add_force);
        const size_t all = run(
            head, "output: [{file: a.csv, every: 0.01, channels: " ALL_ENERGIES "}]\n", add_force);
        const size_t two = run(head,
                               "output:\n  - {file: a.csv, every: 0.01, channels: " ALL_ENERGIES
                               "}\n  - {file: b.csv, every: 0.02, channels: " ALL_ENERGIES "}\n",
                               add_force);
        CHECK_NEAR((double)one, (double)none, 0.0);
        CHECK_NEAR((double)all, (double)one, 0.0);
        CHECK_NEAR((double)two, (double)one, 0.0);
    }
}

/* The row of an event that stops the run is one more time. */
static void energies_at_an_event_take_one_evaluation_of_the_forces(void)
{
#define EVENT                                                                                      \
    BALL "analysis: {type: dynamics, duration: 1, step: 0.002}\n"                                  \
         "events: [{name: low, channel: ball.position.z, value: -1, action: stop}]\n"
    const size_t one =
        run(EVENT, "output: [{file: a.csv, every: 0.1, channels: [energy.total]}]\n", add_force);
    const size_t two = run(EVENT,
                           "output:\n  - {file: a.csv, every: 0.1, channels: " ALL_ENERGIES
                           "}\n  - {file: b.csv, every: 0.1, channels: " ALL_ENERGIES "}\n",
                           add_force);
    CHECK(one > 0);
    CHECK_NEAR((double)two, (double)one, 0.0);
}

#define PARTICLES                                                                                  \
    "se3d: 1\nmaterials: [{name: glass, density: 2500, stiffness: 1e4}]\n"                         \
    "particles: [{material: glass, radius: 0.01, count: 2, lower: [-0.05, -0.011, -0.0119], "      \
    "upper: [0.05, 0.011, 0.0101], velocity: [0, 0, 0]}]\n"                                        \
    "bodies: [{name: ground, shapes: [{type: plane, material: glass, position: [0, 0, "            \
    "-0.011]}]}]\n"                                                                                \
    "analysis: {type: dynamics, duration: 0.02, step: 0.0001}\n"

static void contacts_of_a_time_take_one_evaluation_of_the_forces(void)
{
    const size_t none = run(
        PARTICLES, "output: [{file: a.csv, every: 0.01, channels: [particles.count]}]\n", set_law);
    const size_t one =
        run(PARTICLES, "output: [{file: c.csv, every: 0.01, contacts: true}]\n", set_law);
    const size_t largest =
        run(PARTICLES, "output: [{file: a.csv, every: 0.01, channels: [contacts.force_max]}]\n",
            set_law);
    const size_t all = run(PARTICLES,
                           "output:\n  - {file: c.csv, every: 0.01, contacts: true}\n"
                           "  - {file: d.csv, every: 0.01, contacts: true}\n"
                           "  - {vtk: e.pvd, every: 0.01}\n"
                           "  - {file: a.csv, every: 0.01, channels: [contacts.count, "
                           "contacts.force_max]}\n",
                           set_law);
    CHECK(one > none);
    CHECK_NEAR((double)largest, (double)one, 0.0);
    CHECK_NEAR((double)all, (double)one, 0.0);
}

int main(void)
{
    RUN(energies_of_a_row_take_no_evaluation_of_the_forces);
    RUN(energies_at_an_event_take_one_evaluation_of_the_forces);
    RUN(contacts_of_a_time_take_one_evaluation_of_the_forces);
    return check_finish();
}
