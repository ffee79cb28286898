/* SPDX-License-Identifier: BSD-3-Clause */
/* Mock-up units in this process: what they refuse, with which words, and that a refusal changes
 * nothing; states as bytes, whole and damaged. */
#include <float.h>
#include <sys/stat.h>

#include "check.h"
#include "io/fmi/exchange.h"
#include "support/scratch.h"

static char told[2000];
static se3d_log_level told_level;

static void hear(void *ctx, se3d_log_level level, const char *message)
{
    (void)ctx;
    told_level = level;
    snprintf(told, sizeof told, "%.1900s", message);
}

#define RECIPE "se3d-fmu 1\nmodel life.yaml\n"
/* A block on a rail, pushed by an effort; its spring has a stiffness that may be set. */
#define HEAD                                                                                       \
    "se3d: 1\ngravity: [0, 0, 0]\nparameters: {m: 2, k: 50, twice: 2*k, place: 1/m}\n"             \
    "bodies: [{name: block, mass: m, inertia: [1, 1, 1], position: [0, 0, 0]}]\n"                  \
    "joints: [{name: rail, type: prismatic, body_i: ground, body_j: block, at: [0, 0, 0], axis: "  \
    "[1, 0, 0]}]\n"
#define FORCES                                                                                     \
    "forces:\n- {name: push, type: effort, joint: rail, value: 1}\n- {name: spring, type: tsda, "  \
    "body_i: ground, body_j: block, point_i: [-1, 0, 0], point_j: [0, 0, 0], k: k, l0: 1}\n"
#define ENDS   "output: [{file: a.csv, every: 0.1, channels: [rail.displacement, rail.rate]}]\n"
#define STATE  "state.rail.displacement"
#define MOTION "analysis: {type: dynamics, duration: 1, tolerance: 1e-8}\n"

static void write_file(const char *name, const char *text, size_t length)
{
    char path[900];
    snprintf(path, sizeof path, "%s/%s", check_scratch(), name);
    FILE *file = fopen(path, "wb");
    CHECK(file && fwrite(text, 1, length, file) == length && fclose(file) == 0);
}

static se3di_fmi_unit *make(const char *model, bool exchanges)
{
    write_file("se3d.txt", RECIPE, strlen(RECIPE));
    write_file("life.yaml", model, strlen(model));
    told[0] = '\0';
    return se3di_fmi_unit_create(check_scratch(), NULL, exchanges, hear, NULL);
}

static size_t find(const se3di_fmi_unit *u, const char *name)
{
    size_t k = 0;
    while (k < u->variables.count && strcmp(u->variables.list[k].name, name) != 0) {
        ++k;
    }
    CHECK(k < u->variables.count);
    return k;
}

static bool set(se3di_fmi_unit *u, const char *name, double value)
{
    const uint32_t at = (uint32_t)find(u, name);
    return se3di_fmi_unit_set(u, &at, 1, &value);
}

static double get(se3di_fmi_unit *u, const char *name)
{
    double value = (double)NAN;
    CHECK(se3di_fmi_unit_get(u, find(u, name), &value));
    return value;
}

static bool initialize(se3di_fmi_unit *u)
{
    return u && se3di_fmi_unit_enter(u) && se3di_fmi_unit_start(u);
}

#define REFUSED(call, words)                                                                       \
    do {                                                                                           \
        told[0] = '\0';                                                                            \
        CHECK(!(call));                                                                            \
        CHECK_CONTAINS(told, words);                                                               \
    } while (0)

/* ---- what it is made of ---------------------------------------------------------------------*/

static void resources_that_belong_to_no_unit_are_told(void)
{
    static const char *const recipes[] = {"",
                                          "se3d-fmu 2\nmodel a\n",
                                          "se3d-fmu 1",
                                          "se3d-fmu 1\n",
                                          "se3d-fmu 1\nmodel\n",
                                          "se3d-fmu 1\nmodel a\nset b\n",
                                          "se3d-fmu 1\nmodel a\nwhat b\n"};
    static char folder[5000];
    memset(folder, 'f', sizeof folder - 1);
    REFUSED(se3di_fmi_unit_create("nowhere", NULL, false, hear, NULL), "cannot be opened");
    REFUSED(se3di_fmi_unit_create(folder, NULL, false, hear, NULL), "cannot be opened");
    for (size_t k = 0; k < sizeof recipes / sizeof *recipes; ++k) {
        write_file("se3d.txt", recipes[k], strlen(recipes[k]));
        REFUSED(se3di_fmi_unit_create(check_scratch(), NULL, false, hear, NULL),
                "is not what the resources of this unit have");
    }
    write_file("se3d.txt", "se3d-fmu 1\nmodel a\0b\n", 21);
    REFUSED(se3di_fmi_unit_create(check_scratch(), NULL, false, hear, NULL), "is not what");
    CHECK(!se3di_fmi_unit_create(check_scratch(), NULL, false, NULL, NULL)); /* nobody to tell */
    REFUSED(make("se3d: 2\n", false), "must be 1");
    REFUSED(make(HEAD ENDS, false), "no analysis in which time passes");
    REFUSED(
        make(HEAD "forces: [{name: brake, type: friction, joint: rail, limit: 1}]\n" MOTION, true),
        "the unit is for co-simulation only: ");
    se3di_fmi_unit *u = make(HEAD FORCES MOTION ENDS, false);
    char token[SE3DI_FMI_TOKEN_SIZE];
    memcpy(token, u->token, sizeof token);
    se3di_fmi_unit_destroy(u);
    u = se3di_fmi_unit_create(check_scratch(), token, false, hear, NULL);
    CHECK(u != NULL);
    se3di_fmi_unit_destroy(u);
    token[1] ^= 1;
    REFUSED(se3di_fmi_unit_create(check_scratch(), token, false, hear, NULL),
            "do not belong together");
    se3di_fmi_unit_destroy(NULL);
}

/* ---- calls ----------------------------------------------------------------------------------*/

static void experiments_are_checked(void)
{
    se3di_fmi_unit *u = make(HEAD FORCES MOTION ENDS, false);
    const double never = (double)NAN, ever = (double)INFINITY;
    REFUSED(se3di_fmi_unit_begin(u, ever, never, never), "both finite");
    REFUSED(se3di_fmi_unit_begin(u, 0.0, ever, never), "both finite");
    REFUSED(se3di_fmi_unit_begin(u, 2.0, 1.0, never), "the end must not be before the start");
    REFUSED(se3di_fmi_unit_begin(u, 0.0, 1.0, 0.0), "the tolerance is 0");
    REFUSED(se3di_fmi_unit_begin(u, 0.0, 1.0, -1e-6), "must be finite and > 0");
    REFUSED(se3di_fmi_unit_begin(u, 0.0, 1.0, ever), "must be finite and > 0");
    CHECK(se3di_fmi_unit_begin(u, never, 3.0, never) && se3di_fmi_unit_get_time(u) == 0.0);
    CHECK(se3di_fmi_unit_begin(u, 5.0, never, 1e-30));
    CHECK(se3di_fmi_unit_get_time(u) == 5.0 && get(u, "time") == 5.0);
    REFUSED(se3di_fmi_unit_start(u), "ending the initialization is not allowed before the init");
    REFUSED(se3di_fmi_unit_terminate(u), "terminating is not allowed before the initialization");
    REFUSED(se3di_fmi_unit_step(u, 5.0, 0.1), "a step is not allowed before the initialization");
    double value = 0.0;
    REFUSED(se3di_fmi_unit_get(u, find(u, "rail.rate"), &value),
            "getting an output is not allowed");
    CHECK(se3di_fmi_unit_enter(u));
    REFUSED(se3di_fmi_unit_enter(u), "entering the initialization is not allowed in the init");
    REFUSED(se3di_fmi_unit_begin(u, 0.0, 1.0, never), "setting up the experiment is not allowed");
    CHECK(se3di_fmi_unit_start(u));
    REFUSED(set(u, "parameters.k", 1.0), "setting a parameter is not allowed between steps");
    CHECK(se3di_fmi_unit_step(u, 5.0, 0.1) && se3di_fmi_unit_get_time(u) == 5.1);
    CHECK(se3di_fmi_unit_terminate(u));
    REFUSED(se3di_fmi_unit_step(u, 5.1, 0.1), "a step is not allowed after it was terminated");
    CHECK(get(u, "rail.rate") > 0.0); /* the last one */
    CHECK(se3di_fmi_unit_reset(u) && se3di_fmi_unit_get_time(u) == 0.0);
    CHECK(se3di_fmi_unit_get_mode(u) == SE3DI_FMI_INSTANTIATED);
    se3di_fmi_unit_destroy(u);
}

static void steps_are_checked(void)
{
    se3di_fmi_unit *u = make(HEAD FORCES MOTION ENDS, false);
    const double never = (double)NAN;
    CHECK(se3di_fmi_unit_begin(u, 1e6, 1e6 + 1.0, never) && initialize(u));
    REFUSED(se3di_fmi_unit_step(u, never, 0.1), "must be finite and at least 1e-15 s");
    REFUSED(se3di_fmi_unit_step(u, 1e6, 0.0), "by 0 s, must be finite");
    REFUSED(se3di_fmi_unit_step(u, 1e6, -0.1), "by -0.1 s, must be finite");
    REFUSED(se3di_fmi_unit_step(u, 1e6, never), "must be finite");
    REFUSED(se3di_fmi_unit_step(u, 1e6, DBL_MAX * 2.0), "must be finite");
    REFUSED(se3di_fmi_unit_step(u, 2e6, 0.1), "but the unit is at t = 1000000 s");
    REFUSED(se3di_fmi_unit_step(u, 1e6, 1.5), "beyond the end of the experiment");
    REFUSED(se3di_fmi_unit_step(u, 1e6, 1e-14), "is too short to be seen");
    CHECK(se3di_fmi_unit_step(u, 1e6, 1.0) && get(u, "time") == 1e6 + 1.0);
    se3di_fmi_unit_destroy(u);
}

static void values_are_checked(void)
{
    se3di_fmi_unit *u = make(HEAD FORCES MOTION ENDS, false);
    double value = 0.0;
    const uint32_t none = 1000;
    REFUSED(se3di_fmi_unit_get(u, none, &value), "the value reference 1000 is unknown");
    REFUSED(se3di_fmi_unit_set(u, &none, 1, &value), "the value reference 1000 is unknown");
    REFUSED(set(u, "rail.rate", 1.0), "rail.rate cannot be set: it is an output");
    REFUSED(set(u, "time", 1.0), "time cannot be set: it is the time");
    REFUSED(set(u, "parameters.twice", 1.0), "calculated from other parameters");
    REFUSED(set(u, STATE, 1.0), "of the integration");
    REFUSED(set(u, "push.input", (double)NAN), "push.input is set to nan, must be finite");
    REFUSED(set(u, "parameters.k", (double)INFINITY), "parameters.k is set to inf");
    const uint32_t pair[2] = {(uint32_t)find(u, "parameters.k"), none};
    const double values[2] = {7.0, 7.0};
    REFUSED(se3di_fmi_unit_set(u, pair, 2, values), "is unknown");
    CHECK(get(u, "parameters.k") == 50.0); /* all or none */
    CHECK(set(u, "parameters.k", 25.0) && get(u, "parameters.twice") == 50.0);
    CHECK(set(u, "parameters.m", 0.0));
    REFUSED(se3di_fmi_unit_get(u, find(u, "parameters.twice"), &value), "division by zero");
    CHECK(set(u, "parameters.m", -1.0) && se3di_fmi_unit_enter(u));
    REFUSED(se3di_fmi_unit_get(u, find(u, "rail.rate"), &value), "bodies[0].mass: is m = -1");
    REFUSED(se3di_fmi_unit_start(u), "bodies[0].mass: is m = -1");
    CHECK(se3di_fmi_unit_get_mode(u) == SE3DI_FMI_FAILED);
    REFUSED(se3di_fmi_unit_get(u, find(u, "rail.rate"), &value), "there is no state that it could");
    REFUSED(se3di_fmi_unit_step(u, 0.0, 0.1), "a step is not allowed after a failed step");
    CHECK(se3di_fmi_unit_reset(u) && initialize(u) && se3di_fmi_unit_step(u, 0.0, 0.1));
    CHECK(set(u, "push.input", 1.0) && set(u, "push.input", 1.0)); /* the same is no change */
    CHECK(!u->state_stale && set(u, "push.input", 2.0) && u->state_stale);
    se3di_fmi_unit_destroy(u);
}

static void parameters_that_make_another_unit_are_refused(void)
{
    se3di_fmi_unit *u = make(
        HEAD
        "forces:\n- {name: push, type: effort, joint: rail, value: 1, when: k > 1}\n" MOTION ENDS,
        false);
    CHECK(u && set(u, "parameters.k", 0.5) && se3di_fmi_unit_enter(u));
    REFUSED(se3di_fmi_unit_start(u), "the model has other variables than the description");
    CHECK(se3di_fmi_unit_reset(u) && initialize(u));
    se3di_fmi_unit_destroy(u);
}

/* The two bars are 3 m long in all. */
static void a_beginning_that_fails_is_told(void)
{
    se3di_fmi_unit *u =
        make("se3d: 1\nparameters: {far: 2}\nbodies: [{name: a, mass: 1, inertia: [1, 1, 1], "
             "position: [1, "
             "0, 0]}]\njoints: [{name: p, type: spherical, body_i: ground, body_j: a, point_i: [0, "
             "0, 0], "
             "point_j: [-1, 0, 0]}, {name: q, type: distance, body_i: ground, body_j: a, point_i: "
             "[far, 3, "
             "0], point_j: [1, 0, 0], distance: 2}]\nanalysis: [{type: assembly}, {type: dynamics, "
             "duration: 1}]\n",
             false);
    CHECK(u && set(u, "parameters.far", 50.0) && se3di_fmi_unit_enter(u));
    REFUSED(se3di_fmi_unit_start(u), "the assembly analysis failed at t = 0 s: ");
    CHECK(se3di_fmi_unit_get_mode(u) == SE3DI_FMI_FAILED && told_level == SE3D_LOG_ERROR);
    CHECK(se3di_fmi_unit_reset(u) && initialize(u) && se3di_fmi_unit_step(u, 0.0, 0.1));
    se3di_fmi_unit_destroy(u);
}

/* ---- states as bytes ------------------------------------------------------------------------*/

typedef struct bytes {
    unsigned char *data;
    size_t size;
} bytes;

static bytes save(se3di_fmi_unit *u)
{
    bytes b = {NULL, 0};
    CHECK(se3di_fmi_unit_write(u, NULL, &b.size));
    b.data = malloc(b.size + 1);
    CHECK(b.data && se3di_fmi_unit_write(u, b.data, &b.size));
    return b;
}

static double go(se3di_fmi_unit *u)
{
    CHECK(se3di_fmi_unit_step(u, se3di_fmi_unit_get_time(u), 0.1));
    return get(u, "rail.displacement");
}

static void states_come_back_from_everywhere(void)
{
    se3di_fmi_unit *u = make(HEAD FORCES MOTION ENDS, false);
    bytes first = save(u); /* before the initialization, nothing set */
    CHECK(set(u, "parameters.k", 80.0) && initialize(u));
    const double one = go(u);
    bytes second = save(u);
    CHECK(set(u, "push.input", 3.0));
    bytes third = save(u); /* with an input that no step has seen */
    const double two = go(u);
    CHECK(se3di_fmi_unit_read(u, third.data, third.size) && go(u) == two);
    CHECK(se3di_fmi_unit_read(u, second.data, second.size) && get(u, "push.input") == 1.0);
    CHECK(get(u, "rail.displacement") == one && set(u, "push.input", 3.0) && go(u) == two);
    CHECK(se3di_fmi_unit_read(u, first.data, first.size) && get(u, "parameters.k") == 50.0);
    CHECK(se3di_fmi_unit_get_mode(u) == SE3DI_FMI_INSTANTIATED && initialize(u));
    const double soft = go(u);
    CHECK(soft > one);
    CHECK(se3di_fmi_unit_read(u, second.data, second.size) && get(u, "parameters.k") == 80.0);
    CHECK(set(u, "push.input", 3.0) && go(u) == two);
    CHECK(se3di_fmi_unit_reset(u) && se3di_fmi_unit_read(u, third.data, third.size));
    CHECK(go(u) == two);
    free(first.data);
    free(second.data);
    free(third.data);
    se3di_fmi_unit_destroy(u);
}

/* Whatever of it is another bit or missing: refused in words, and a good one is taken then. */
static void damaged_states_are_refused(bool exchanges)
{
    se3di_fmi_unit *u =
        make(HEAD FORCES "states: [{name: lag, type: lag, input: rail.displacement, "
                         "time_constant: 0.1}]\n" MOTION ENDS,
             exchanges);
    CHECK(initialize(u));
    bytes b = save(u);
    size_t small = b.size - 1;
    REFUSED(se3di_fmi_unit_write(u, b.data, &small), "the state cannot be saved");
    CHECK(se3di_fmi_unit_write(u, b.data, &b.size));
    const double is = get(u, "rail.rate");
    for (size_t k = 0; k < b.size; ++k) {
        b.data[k] ^= 0x10;
        REFUSED(se3di_fmi_unit_read(u, b.data, b.size), "state");
        b.data[k] ^= 0x10;
    }
    for (size_t size = 0; size < b.size; size += size < 300 ? 1 : 17) {
        REFUSED(se3di_fmi_unit_read(u, b.data, size), "state");
    }
    REFUSED(se3di_fmi_unit_read(u, b.data, b.size + 1), "not a whole state");
    CHECK(se3di_fmi_unit_read(u, b.data, b.size) && get(u, "rail.rate") == is);
    free(b.data);
    se3di_fmi_unit_destroy(u);
}

static void damaged_states_of_steps_are_refused(void)
{
    damaged_states_are_refused(false);
}

static void damaged_states_of_exchange_are_refused(void)
{
    damaged_states_are_refused(true);
}

/* ---- model exchange -------------------------------------------------------------------------*/

static void functions_of_the_other_kind_are_refused(void)
{
    double x[8] = {0.0};
    bool flag = false, moved = false;
    se3di_fmi_unit *u = make(HEAD FORCES MOTION ENDS, false);
    const size_t state = find(u, STATE);
    CHECK(initialize(u));
    REFUSED(se3di_fmi_unit_set_time(u, 0.0), "setting the time is for model exchange");
    REFUSED(se3di_fmi_unit_set_states(u, x, 2), "setting states is for model exchange");
    REFUSED(se3di_fmi_unit_get_states(u, x, 2), "getting states is for model exchange");
    REFUSED(se3di_fmi_unit_get_nominals(u, x, 2), "nominal values is for model exchange");
    REFUSED(se3di_fmi_unit_get_derivatives(u, x, 2), "is for model exchange");
    REFUSED(se3di_fmi_unit_complete_step(u, &flag), "completing a step is for model exchange");
    REFUSED(se3di_fmi_unit_enter_event(u), "entering an event is for model exchange");
    REFUSED(se3di_fmi_unit_update_event(u, &flag, &moved), "an event is for model exchange");
    REFUSED(se3di_fmi_unit_enter_continuous(u), "leaving an event is for model exchange");
    REFUSED(se3di_fmi_unit_get(u, state, x), STATE " is for model exchange");
    se3di_fmi_unit_destroy(u);
    u = make(HEAD FORCES MOTION ENDS, true);
    REFUSED(se3di_fmi_unit_get_states(u, x, 2), "getting states is not allowed before the init");
    REFUSED(se3di_fmi_unit_get_nominals(u, x, 2), "is not allowed before the initialization");
    CHECK(initialize(u));
    const size_t n = se3di_fmi_unit_count_states(u);
    CHECK(n == 2 && se3di_fmi_unit_get_mode(u) == SE3DI_FMI_EVENT);
    REFUSED(se3di_fmi_unit_step(u, 0.0, 0.1), "a step is not allowed in an event");
    REFUSED(se3di_fmi_unit_get_states(u, x, 3), "there is room for 3 states, there are 2");
    REFUSED(se3di_fmi_unit_get_states(u, NULL, 2), "there is room for 0 states, there are 2");
    REFUSED(se3di_fmi_unit_set_states(u, x, 1), "there is room for 1 states");
    REFUSED(se3di_fmi_unit_get_nominals(u, NULL, 2), "there is room for 0 states");
    REFUSED(se3di_fmi_unit_get_indicators(u, x, 1), "there is room for 1 indicators, there are 0");
    CHECK(se3di_fmi_unit_get_indicators(u, NULL, 0));
    REFUSED(se3di_fmi_unit_complete_step(u, &flag), "completing a step is not allowed in an event");
    REFUSED(se3di_fmi_unit_set_time(u, (double)NAN), "the time is nan s, must be finite");
    x[1] = (double)NAN;
    REFUSED(se3di_fmi_unit_set_states(u, x, 2), "is set to nan, must be finite");
    x[1] = 0.5;
    CHECK(se3di_fmi_unit_set_time(u, 0.25) && se3di_fmi_unit_set_states(u, x, 2));
    CHECK(se3di_fmi_unit_set_time(u, 0.25) && get(u, "time") == 0.25);
    CHECK(get(u, "rail.rate") == 0.5 && get(u, STATE) == 0.0);
    CHECK(se3di_fmi_unit_get_derivatives(u, x, 2) && x[0] == 0.5);
    CHECK_NEAR(x[1], 0.5, 1e-12); /* 1 N on 2 kg */
    CHECK(se3di_fmi_unit_enter_continuous(u));
    REFUSED(se3di_fmi_unit_enter_continuous(u), "leaving an event is not allowed while time goes");
    REFUSED(se3di_fmi_unit_update_event(u, &flag, &moved), "an event is not allowed while time");
    CHECK(se3di_fmi_unit_complete_step(u, &flag) && !flag);
    CHECK(se3di_fmi_unit_enter_event(u) && se3di_fmi_unit_enter_event(u));
    CHECK(se3di_fmi_unit_terminate(u));
    REFUSED(se3di_fmi_unit_get_indicators(u, NULL, 0), "is not allowed after it was terminated");
    REFUSED(se3di_fmi_unit_enter_event(u), "entering an event is not allowed after it was term");
    se3di_fmi_unit_destroy(u);
}

/* Put the block somewhere at a speed, in an event. @return whether an event ended it */
static bool place(se3di_fmi_unit *u, double at, double speed)
{
    const double x[2] = {at, speed};
    bool ends = false, moved = false;
    told[0] = '\0';
    CHECK(se3di_fmi_unit_enter_event(u) && se3di_fmi_unit_set_states(u, x, 2));
    CHECK(se3di_fmi_unit_update_event(u, &ends, &moved) && !moved);
    return ends;
}

/* An event counts in its direction; a stop keeps the speed with which it was met, on both ends. */
static void events_and_stops_are_those_of_the_model(void)
{
    double x[2];
    se3di_fmi_unit *u = make(
        HEAD "forces:\n- {name: end, type: stop, joint: rail, lower: -1, upper: 1, k: 1e3, "
             "restitution: 0.5}\n"
             "events:\n- {name: up, channel: rail.displacement, value: 0.25, direction: rising, "
             "action: record}\n- {name: down, channel: rail.displacement, value: -0.25, direction: "
             "falling, action: stop}\n" MOTION ENDS,
        true);
    CHECK(initialize(u) && se3di_fmi_unit_count_indicators(u) >= 2);
    CHECK(!place(u, 0.5, 1.0));
    CHECK_CONTAINS(told, "event up");
    CHECK(!place(u, 0.0, 1.0) && !told[0]);
    CHECK(place(u, -0.5, 1.0));
    CHECK_CONTAINS(told, "event down");
    CHECK(!place(u, 0.0, 1.0) && !told[0]);
    for (int side = -1; side <= 1; side += 2) {
        place(u, side * 1.0000001, side * 2.0);
        const double impact = u->exchange->signs[u->variables.indicators];
        CHECK_NEAR(impact, 2.0, 1e-12);
        place(u, side * 1.0000002, side * 1.0); /* it goes on */
        CHECK_NEAR(u->exchange->signs[u->variables.indicators], impact, 1e-12);
        CHECK(se3di_fmi_unit_get_derivatives(u, x, 2) && side * x[1] < 0.0);
        place(u, 0.0, 0.0);
    }
    se3di_fmi_unit_destroy(u);
}

/* States without finite derivatives are put aside, and others tried: a warning, not a failure. */
static void states_that_are_too_far_away_are_discarded(void)
{
    double x[20], good[20];
    se3di_fmi_unit *u = make(
        "se3d: 1\nbodies: [{name: a, mass: 1, inertia: [1, 1, 1], position: [1, 0, 0]}, {name: b, "
        "mass: 1, inertia: [1, 1, 1], position: [1, 3, 0]}]\njoints:\n- {name: p, type: revolute, "
        "body_i: ground, body_j: a, at: [0, 0, 0], axis: [0, 0, 1]}\n- {name: q, type: revolute, "
        "body_i: ground, body_j: b, at: [0, 3, 0], axis: [0, 0, 1]}\n- {name: rod, type: distance, "
        "body_i: a, body_j: b, point_i: [0, 0, 0], point_j: [0, 0, 0], distance: 3}\noutput: "
        "[{file: a.csv, every: 0.1, channels: [p.angle]}]\n" MOTION,
        true);
    CHECK(initialize(u) && se3di_fmi_unit_enter_continuous(u));
    const size_t n = se3di_fmi_unit_count_states(u);
    CHECK(n == 4 && se3di_fmi_unit_get_states(u, good, n));
    memcpy(x, good, sizeof x);
    x[2] = 1e200;
    x[3] = -1e200;
    CHECK(se3di_fmi_unit_set_states(u, x, n));
    REFUSED(se3di_fmi_unit_get_derivatives(u, x, n), "no derivatives at t = 0 s");
    CHECK(se3di_fmi_unit_discards(u) && told_level == SE3D_LOG_WARNING);
    bool event = false;
    REFUSED(se3di_fmi_unit_complete_step(u, &event), "no derivatives at t = 0 s");
    CHECK(se3di_fmi_unit_set_states(u, good, n) && !se3di_fmi_unit_discards(u));
    CHECK(se3di_fmi_unit_get_derivatives(u, x, n) && se3di_fmi_unit_complete_step(u, &event));
    /* what is off the constraint by much is brought back in an event */
    memcpy(x, good, sizeof x);
    x[0] += 0.01;
    bool ends = false, moved = false;
    CHECK(se3di_fmi_unit_set_states(u, x, n) && se3di_fmi_unit_complete_step(u, &event) && event);
    CHECK(se3di_fmi_unit_enter_event(u) && se3di_fmi_unit_update_event(u, &ends, &moved) && moved);
    CHECK(se3di_fmi_unit_get_states(u, good, n) && fabs(good[0] - x[0]) > 1e-4);
    se3di_fmi_unit_destroy(u);
}

int main(void)
{
    RUN(resources_that_belong_to_no_unit_are_told);
    RUN(experiments_are_checked);
    RUN(steps_are_checked);
    RUN(values_are_checked);
    RUN(parameters_that_make_another_unit_are_refused);
    RUN(a_beginning_that_fails_is_told);
    RUN(states_come_back_from_everywhere);
    RUN(damaged_states_of_steps_are_refused);
    RUN(damaged_states_of_exchange_are_refused);
    RUN(functions_of_the_other_kind_are_refused);
    RUN(events_and_stops_are_those_of_the_model);
    RUN(states_that_are_too_far_away_are_discarded);
    return check_finish();
}
