/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles of a model file: fall, bounce, walls that are driven, snapshots. */
#include <stdlib.h>

#include "check.h"
#include "se3d/io.h"

#define GLASS                                                                                      \
    "se3d: 1\nmaterials: [{name: glass, density: 2500, stiffness: 1e5, restitution: 0.8}]\n"       \
    "particles: [{material: glass, radius: 0.01, count: 1, lower: [-0.011, -0.011, 0.489], "       \
    "upper: "                                                                                      \
    "[0.011, 0.011, 0.511], velocity: [0, 0, 0]}]\n"

/* Run a model; its last output stays readable through the channels. */
static se3d_model *run_model(const char *text, const char *folder, se3d_status *status)
{
    se3d_model *model = NULL;
    se3d_run *run = NULL;
    se3d_model_error error;
    se3d_run_options how = se3d_run_options_default();
    how.directory = folder;
    *status = se3d_model_read_text(text, strlen(text), "m.yaml", NULL, &model, &error);
    if (*status >= 0) {
        *status = se3d_model_run(model, &how, &run, &error);
    }
    if (*status < 0) {
        fprintf(stderr, "%s\n", error.message);
    }
    se3d_run_destroy(run);
    return model;
}

static const char *results_folder(void)
{
    static char folder[800];
    const char *build = getenv("SE3D_BUILD_DIR");
    snprintf(folder, sizeof folder, "%s/io-particles", build ? build : "/tmp");
    return folder;
}

/* Number `column` of line `line` (0: the header) of grains.csv. */
static double grain(size_t line, size_t column)
{
    char text[1000] = "";
    snprintf(text, sizeof text, "%s/grains.csv", results_folder());
    FILE *file = fopen(text, "rb");
    for (size_t k = 0; file && k <= line; ++k) {
        if (!fgets(text, sizeof text, file)) {
            text[0] = '\0';
        }
    }
    if (file) {
        fclose(file);
    }
    const char *at = text;
    for (size_t k = 0; at && k < column; ++k) {
        at = strchr(at, ',');
        at = at ? at + 1 : NULL;
    }
    return at && *at ? strtod(at, NULL) : (double)NAN;
}

static double channel(const se3d_model *model, size_t k)
{
    double value[4] = {0.0, 0.0, 0.0, 0.0};
    size_t width = 0;
    CHECK(se3d_model_get_channel_value(model, 0, k, NULL, value, &width) == SE3D_OK);
    CHECK(width == 1);
    return value[0];
}

#define OUTPUT                                                                                     \
    "output:\n  - {file: s.csv, every: 0.05, channels: [contacts.count, particles.count, "         \
    "particles.lost, particles.energy]}\n  - {file: grains.csv, every: 0.1, particles: true}\n"

static void grain_falls_and_bounces_with_its_restitution(void)
{
    se3d_status status = SE3D_OK;
    se3d_model *model =
        run_model(GLASS "bodies: [{name: ground, shapes: [{type: plane, material: glass}]}]\n"
                        "analysis: {type: dynamics, duration: 0.5}\n" OUTPUT,
                  results_folder(), &status);
    CHECK(status >= 0);
    const double pi = acos(-1.0);
    const double mass = 2500.0 * 4.0 / 3.0 * pi * 1e-6;
    CHECK_NEAR(grain(1, 0), 0.0, 0.0);
    CHECK_NEAR(grain(1, 2), 0.01, 0.0);
    CHECK_NEAR(grain(1, 5), 0.5, 1e-12);
    CHECK_NEAR(grain(3, 0), 0.2, 1e-12);
    CHECK_NEAR(grain(3, 5), 0.5 - 0.5 * 9.81 * 0.04, 1e-9);
    CHECK_NEAR(grain(3, 8), -9.81 * 0.2, 1e-9);
    /* The energy of the second flight is e^2 of the first: heights above the touching centre. */
    const double energy = channel(model, 3);
    CHECK_NEAR(energy, mass * 9.81 * (0.01 + 0.64 * 0.49), 5e-3 * energy);
    CHECK_NEAR(channel(model, 0), 0.0, 0.0);
    CHECK_NEAR(channel(model, 1), 1.0, 0.0);
    CHECK_NEAR(channel(model, 2), 0.0, 0.0);
    se3d_model_destroy(model);
}

/* A piston at 2 m/s throws a grain at rest to (1 + e) 2 m/s, within what the automatic step keeps
 * of the restitution. */
static void driven_wall_throws_a_grain(void)
{
    se3d_status status = SE3D_OK;
    se3d_model *model = run_model(
        GLASS "gravity: [0, 0, 0]\n"
              "bodies: [{name: piston, position: [0, 0, 0.3], mass: 1, inertia: [1, 1, 1], shapes: "
              "[{type: box, size: [1, 1, 0.1], material: glass}]}]\n"
              "joints: [{name: rail, type: prismatic, body_i: ground, body_j: piston, at: [0, 0, "
              "0.3], axis: [0, 0, 1]}]\n"
              "drivers: [{joint: rail, value: 2*t}]\n"
              "analysis: {type: kinematics, duration: 0.2}\n" OUTPUT,
        results_folder(), &status);
    CHECK(status >= 0);
    CHECK_NEAR(grain(2, 8), 3.6, 8e-3);
    CHECK_NEAR(grain(3, 8), 3.6, 8e-3);
    /* It was touched when the piston's face, at 0.35, had gone 0.14 m: at 0.07 s. */
    CHECK_NEAR(grain(3, 5), 0.5 + 3.6 * 0.13, 4e-3);
    se3d_model_destroy(model);
}

static void grains_that_leave_through_a_sink_are_counted(void)
{
    se3d_status status = SE3D_OK;
    se3d_model *model =
        run_model(GLASS "contact: {boundary: [open, open, sink], lower: [0, 0, 0.2], upper: [0, 0, "
                        "1]}\nanalysis: {type: dynamics, duration: 0.5}\n" OUTPUT,
                  results_folder(), &status);
    CHECK(status >= 0);
    CHECK_NEAR(channel(model, 1), 0.0, 0.0);
    CHECK_NEAR(channel(model, 2), 1.0, 0.0);
    se3d_model_destroy(model);
}

int main(void)
{
    RUN(grain_falls_and_bounces_with_its_restitution);
    RUN(driven_wall_throws_a_grain);
    RUN(grains_that_leave_through_a_sink_are_counted);
    return check_finish();
}
