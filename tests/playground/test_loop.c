/* SPDX-License-Identifier: BSD-3-Clause */
/* The playground but for its page: what the worker says, and the texts that it takes. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "playground.h"

static char path[400];

static void write_model(double stiffness, const char *joint)
{
    FILE *file = fopen(path, "w");
    CHECK(file != NULL);
    if (!file) {
        return;
    }
    fprintf(file,
            "se3d: 1\n"
            "parameters: {k: %g}\n"
            "gravity: [0, 0, 0]\n"
            "bodies: [{name: block, mass: 1, inertia: [1, 1, 1], position: [0.3, 0, 0]}]\n"
            "joints: [{name: rail, type: %s, body_i: ground, body_j: block, at: [0, 0, 0],\n"
            "          axis: [1, 0, 0]}]\n"
            "forces: [{name: spring, type: tsda, body_i: ground, body_j: block, k: k, l0: 0.1}]\n"
            "analysis: {type: dynamics, duration: 1}\n"
            "output: [{file: x.csv, channels: [block.position.x], every: 0.01}]\n",
            stiffness, joint);
    fclose(file);
}

/* A number of the last state, behind its name. */
static double read_number(const char *state, const char *name)
{
    const char *at = strstr(state, name);
    return at ? strtod(at + strlen(name), NULL) : (double)NAN;
}

/* Turn until nothing is to be done. @return the last state. */
static const char *turn_until_quiet(void)
{
    static char state[4000];
    for (int k = 0; k < 100; ++k) {
        const double rest = se3d_play_turn();
        const char *now = se3d_play_take_state();
        if (*now) {
            snprintf(state, sizeof state, "%s", now);
        }
        if (rest < 0.0) {
            break;
        }
    }
    return state;
}

static void check_opening(void)
{
    CHECK(se3d_play_turn() < 0.0);
    CHECK(*se3d_play_take_state() == '\0');
    write_model(50.0, "prismatik");
    CHECK_CONTAINS(se3d_play_open(path), "model.yaml:5:");
    CHECK(se3d_play_turn() < 0.0);
    write_model(50.0, "prismatic");
    CHECK(*se3d_play_open(path) == '\0');
    CHECK_CONTAINS(se3d_play_take_scene(), "\"glb\"");
    CHECK(*se3d_play_take_scene() == '\0');
    CHECK_CONTAINS(se3d_play_take_state(), "\"running\":true");
}

/* x'' = -k (x - 0.1), x(0) = 0.3 */
static void check_motion(double stiffness, const char *state)
{
    const double t = read_number(state, "\"t\":");
    const double x = 0.1 + 0.2 * cos(sqrt(stiffness) * t);
    CHECK(t > 0.0);
    CHECK_NEAR(read_number(state, "\"values\":["), x, 1e-6);
}

static void check_orders(void)
{
    CHECK(se3d_play_say("pause"));
    CHECK_CONTAINS(turn_until_quiet(), "\"running\":false");
    CHECK(se3d_play_say("reset"));
    CHECK(read_number(turn_until_quiet(), "\"t\":") <= 0.0);
    CHECK(se3d_play_say("step") && se3d_play_say("step"));
    const char *state = turn_until_quiet();
    CHECK_NEAR(read_number(state, "\"t\":"), 2.0 / 60.0, 1e-9);
    check_motion(50.0, state);
    CHECK(se3d_play_say("run"));
    se3d_play_watch(0);
    CHECK(se3d_play_turn() < 0.0);
    se3d_play_watch(1);
    CHECK(se3d_play_turn() >= 0.0);
    CHECK(se3d_play_say("pause"));
    check_motion(50.0, turn_until_quiet());
}

static void check_saving(void)
{
    write_model(50.0, "prismatik");
    se3d_play_save();
    CHECK_CONTAINS(turn_until_quiet(), "prismatik");
    write_model(80.0, "prismatic");
    se3d_play_save();
    CHECK_CONTAINS(turn_until_quiet(), "\"trouble\":\"\"");
    CHECK(se3d_play_say("step"));
    check_motion(80.0, turn_until_quiet());
}

/* Particles beside a body that follows a driver on one joint too many: a step is one turn. */
static void check_particles(void)
{
    FILE *file = fopen(path, "w");
    CHECK(file != NULL);
    if (!file) {
        return;
    }
    fputs("se3d: 1\n"
          "materials: [{name: glass, density: 2500, stiffness: 2e4}]\n"
          "contact: {law: hooke}\n"
          "particles: [{material: glass, radius: 0.01, packing: lattice, lower: [0, 0, 1],\n"
          "             upper: [0.05, 0.05, 1.05]}]\n"
          "bodies: [{name: blade, mass: 1, inertia: [1, 1, 1], position: [2, 0, 0]}]\n"
          "joints:\n"
          "  - {name: rail, type: prismatic, body_i: ground, body_j: blade, at: [2, 0, 0],\n"
          "     axis: [1, 0, 0]}\n"
          "  - {name: other, type: prismatic, body_i: ground, body_j: blade, at: [2, 0, 1],\n"
          "     axis: [1, 0, 0]}\n"
          "drivers: [{name: way, joint: rail, value: 0.5*t}]\n"
          "analysis: {type: kinematics, duration: 1}\n",
          file);
    fclose(file);
    CHECK(*se3d_play_open(path) == '\0');
    CHECK(se3d_play_say("pause") && se3d_play_say("reset"));
    (void)turn_until_quiet();
    CHECK(se3d_play_say("step"));
    (void)se3d_play_turn();
    const char *state = se3d_play_take_state();
    CHECK_NEAR(read_number(state, "\"t\":"), 1.0 / 60.0, 1e-9);
    CHECK_CONTAINS(state, "\"grains\":\"");
}

/* The particle models in the list of the page run, and show their particles. */
static void check_examples(void)
{
    static const char *const names[] = {"bucket",        "cantilever",    "chute",     "hopper",
                                        "oedometer",     "pebbles",       "shear_box", "silo",
                                        "pushed_grains", "rotating_drum", "triaxial"};
    for (size_t k = 0; k < sizeof names / sizeof *names; ++k) {
        char name[100];
        snprintf(name, sizeof name, "examples/models/%s.yaml", names[k]);
        CHECK(*se3d_play_open(name) == '\0');
        CHECK_CONTAINS(se3d_play_take_scene(), "\"glb\"");
        CHECK(se3d_play_turn() >= 0.0);
        const char *state = se3d_play_take_state();
        CHECK_CONTAINS(state, "\"trouble\":\"\"");
        CHECK_CONTAINS(state, "\"grains\":\"");
        CHECK(read_number(state, "\"t\":") > 0.0);
    }
}

static void check_refusals(void)
{
    char words[300];
    memset(words, 'a', sizeof words - 1);
    words[sizeof words - 1] = '\0';
    CHECK(!se3d_play_say(words));
    int taken = 0;
    while (taken < 1000 && se3d_play_say("set 1 0 nan")) {
        ++taken;
    }
    CHECK(taken == 64);
    (void)turn_until_quiet();
    CHECK(se3d_play_say("pause"));
    (void)turn_until_quiet();
    CHECK_CONTAINS(se3d_play_open("/nowhere/model.yaml"), "No such file");
    CHECK(se3d_play_turn() < 0.0);
}

int main(void)
{
    snprintf(path, sizeof path, "%s/playground_model.yaml", check_scratch());
    check_opening();
    check_orders();
    check_saving();
    check_particles();
    check_examples();
    check_refusals();
    remove(path);
    return check_finish();
}
