/* SPDX-License-Identifier: BSD-3-Clause */
/* check_fmu FOLDER RESULTS.csv: whether an unpacked mock-up unit keeps to the standard, and gives
 * at the times of a results file of `se3d run` what stands there. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "unit.h"

enum { ROWS_MAX = 4000, COLUMNS_MAX = 200 };

static description d;
static functions f;
static char resources[2000];
static double rows[ROWS_MAX][COLUMNS_MAX];
static size_t row_count, column_count;
static uint32_t references[COLUMNS_MAX]; /* of the columns */

/* ---- the results ----------------------------------------------------------------------------*/

static const variable *find_variable(const char *name)
{
    for (size_t k = 0; k < d.count; ++k) {
        if (strcmp(d.variables[k].name, name) == 0) {
            return &d.variables[k];
        }
    }
    return NULL;
}

static int read_header(char *line)
{
    int good = 1;
    for (char *name = strtok(line, ",\r\n"); name && column_count < COLUMNS_MAX;
         name = strtok(NULL, ",\r\n")) {
        const variable *v = find_variable(name);
        good = good && v;
        if (!v) {
            fprintf(stderr, "no variable for the column %s\n", name);
        }
        references[column_count++] = v ? v->reference : 0;
    }
    return good;
}

static int read_results(const char *path)
{
    static char line[100000];
    FILE *file = fopen(path, "r");
    int good = file && fgets(line, sizeof line, file) && read_header(line);
    while (good && row_count < ROWS_MAX && fgets(line, sizeof line, file)) {
        char *at = line;
        for (size_t k = 0; k < column_count; ++k) {
            rows[row_count][k] = strtod(at, &at);
            at += *at == ',';
        }
        ++row_count;
    }
    if (file) {
        fclose(file);
    }
    return good && row_count > 2;
}

/* ---- the description ------------------------------------------------------------------------*/

static int is(const char *a, const char *b)
{
    return strcmp(a, b) == 0;
}

static void description_lists_each_variable_once(void)
{
    size_t times = 0;
    CHECK(d.count > 1);
    for (size_t k = 0; k < d.count; ++k) {
        for (size_t i = 0; i < k; ++i) {
            CHECK(!is(d.variables[i].name, d.variables[k].name));
            CHECK(d.variables[i].reference != d.variables[k].reference);
        }
        times += is(d.variables[k].causality, "independent") ? 1 : 0;
    }
    CHECK(times == 1);
}

/* The table of causality and variability, and who has a start. */
static void description_has_the_right_kinds(void)
{
    for (size_t k = 0; k < d.count; ++k) {
        const variable *v = &d.variables[k];
        const int sets = is(v->causality, "input") || is(v->causality, "parameter");
        const int fixed = is(v->causality, "parameter") || is(v->causality, "calculatedParameter");
        CHECK(sets || fixed || is(v->causality, "output") || is(v->causality, "independent") ||
              is(v->causality, "local"));
        CHECK(is(v->variability, fixed ? "fixed" : "continuous") ||
              (is(v->causality, "input") && is(v->variability, "discrete")));
        CHECK(v->has_start == sets);
        CHECK(isfinite(v->start));
        int known = v->unit[0] == '\0';
        for (size_t i = 0; i < d.unit_count; ++i) {
            known = known || is(d.units[i], v->unit);
        }
        CHECK(known);
    }
}

/* A state or a derivative of one. */
static int is_integrated(size_t k)
{
    for (size_t i = 0; i < d.derivative_count; ++i) {
        if (k == d.derivatives[i] || k + 1 == d.variables[d.derivatives[i]].derivative) {
            return 1;
        }
    }
    return 0;
}

static void description_lists_what_is_calculated(void)
{
    size_t outputs = 0;
    size_t unknowns = 0;
    for (size_t k = 0; k < d.count; ++k) {
        const int is_output = is(d.variables[k].causality, "output");
        if (is_output) {
            CHECK(outputs < d.output_count && d.outputs[outputs] == k);
            ++outputs;
        }
        if (is_output || is(d.variables[k].causality, "calculatedParameter") || is_integrated(k)) {
            CHECK(unknowns < d.unknown_count && d.unknowns[unknowns] == k);
            ++unknowns;
        }
    }
    CHECK(outputs == d.output_count);
    CHECK(unknowns == d.unknown_count);
    CHECK(d.can_save && d.can_serialize && d.has_derivatives);
    CHECK(d.category_count >= 3);
    CHECK(d.stop > d.start);
}

/* ---- lives ----------------------------------------------------------------------------------*/

static void *make(void)
{
    void *c = f.instantiate("unit", d.token, resources, 0);
    CHECK(c);
    if (!c) {
        fprintf(stderr, "%s\n", told_last);
        exit(1);
    }
    return c;
}

static void *begin(void)
{
    void *c = make();
    CHECK(f.setup(c, 0, 0.0, d.start, 1, d.stop) == GOOD);
    CHECK(f.enter(c) == GOOD);
    CHECK(f.leave(c) == GOOD);
    return c;
}

static void get_row(void *c, double *values)
{
    CHECK(f.get(c, references, column_count, values) == GOOD);
}

/* From row `from` to row `to`. */
static int go(void *c, size_t from, size_t to)
{
    int status = GOOD;
    double reached = 0.0;
    int ended = 0;
    for (size_t k = from; k < to && status == GOOD; ++k) {
        status = f.step(c, rows[k][0], rows[k + 1][0] - rows[k][0], &reached, &ended);
    }
    return status;
}

static int same_bits(const double *a, const double *b)
{
    return memcmp(a, b, column_count * sizeof *a) == 0;
}

static void outputs_are_those_of_a_run(void)
{
    void *c = begin();
    double values[COLUMNS_MAX];
    double reached = 0.0;
    int ended = 0;
    int status = GOOD;
    for (size_t k = 0; k < row_count && !ended; ++k) {
        get_row(c, values);
        for (size_t i = 0; i < column_count; ++i) {
            CHECK_NEAR(values[i], rows[k][i], 1e-9 * (1.0 + fabs(rows[k][i])));
        }
        if (k + 1 < row_count) {
            /* the last step may be cut by an event: it is asked for a little more */
            const double h = rows[k + 1][0] - rows[k][0];
            status = f.step(c, rows[k][0], h, &reached, &ended);
            CHECK(status == GOOD || (status == DISCARD && ended));
            CHECK_NEAR(reached, rows[k + 1][0], 1e-9);
        }
    }
    CHECK(f.terminate(c) == GOOD);
    f.free(c);
}

static void the_whole_run(double *last)
{
    void *c = begin();
    CHECK(go(c, 0, row_count - 2) == GOOD);
    get_row(c, last);
    f.free(c);
}

static void a_state_goes_on_with_the_same_bits(void)
{
    double expected[COLUMNS_MAX];
    double values[COLUMNS_MAX];
    void *state = NULL;
    void *read = NULL;
    size_t size = 0;
    const size_t half = row_count / 2;
    the_whole_run(expected);
    void *c = begin();
    CHECK(go(c, 0, half) == GOOD);
    CHECK(f.get_state(c, &state) == GOOD);
    CHECK(f.state_size(c, state, &size) == GOOD && size > 0);
    unsigned char *bytes = malloc(size + 1);
    CHECK(bytes && f.write_state(c, state, bytes, size) == GOOD);
    CHECK(go(c, half, row_count - 2) == GOOD);
    get_row(c, values);
    CHECK(same_bits(values, expected));
    for (int round = 0; round < 2; ++round) {
        CHECK(f.set_state(c, state) == GOOD);
        CHECK(go(c, half, row_count - 2) == GOOD);
        get_row(c, values);
        CHECK(same_bits(values, expected));
    }
    CHECK(f.free_state(c, &state) == GOOD && !state);
    f.free(c);
    c = make(); /* one that was never initialized */
    CHECK(f.read_state(c, bytes, size, &read) == GOOD);
    CHECK(f.set_state(c, read) == GOOD);
    CHECK(go(c, half, row_count - 2) == GOOD);
    get_row(c, values);
    CHECK(same_bits(values, expected));
    CHECK(f.free_state(c, &read) == GOOD);
    f.free(c);
    free(bytes);
}

static void a_state_before_the_start_starts_again(void)
{
    double expected[COLUMNS_MAX];
    double values[COLUMNS_MAX];
    void *state = NULL;
    the_whole_run(expected);
    void *c = make();
    CHECK(f.get_state(c, &state) == GOOD);
    CHECK(f.enter(c) == GOOD && f.leave(c) == GOOD);
    CHECK(go(c, 0, row_count / 2) == GOOD);
    CHECK(f.set_state(c, state) == GOOD);
    CHECK(f.leave(c) == BAD);
    CHECK(f.enter(c) == GOOD && f.leave(c) == GOOD);
    CHECK(go(c, 0, row_count - 2) == GOOD);
    get_row(c, values);
    CHECK(same_bits(values, expected));
    CHECK(f.free_state(c, &state) == GOOD);
    f.free(c);
}

static void reset_starts_again(void)
{
    double expected[COLUMNS_MAX];
    double values[COLUMNS_MAX];
    the_whole_run(expected);
    void *c = begin();
    CHECK(go(c, 0, row_count / 2) == GOOD);
    CHECK(f.reset(c) == GOOD);
    CHECK(f.setup(c, 0, 0.0, d.start, 1, d.stop) == GOOD);
    CHECK(f.enter(c) == GOOD && f.leave(c) == GOOD);
    CHECK(go(c, 0, row_count - 2) == GOOD);
    get_row(c, values);
    CHECK(same_bits(values, expected));
    CHECK(f.terminate(c) == GOOD);
    CHECK(f.reset(c) == GOOD);
    f.free(c);
}

static void instances_are_independent(void)
{
    double expected[COLUMNS_MAX];
    double values[COLUMNS_MAX];
    the_whole_run(expected);
    void *a = begin();
    CHECK(go(a, 0, 1) == GOOD);
    void *b = begin();
    for (size_t k = 1; k + 2 < row_count; ++k) {
        CHECK(go(a, k, k + 1) == GOOD);
        CHECK(go(b, k - 1, k) == GOOD);
    }
    get_row(a, values);
    CHECK(same_bits(values, expected));
    f.free(a);
    CHECK(go(b, row_count - 3, row_count - 2) == GOOD);
    get_row(b, values);
    CHECK(same_bits(values, expected));
    f.free(b);
}

/* ---- misuse ---------------------------------------------------------------------------------*/

/* The call has failed, and said why. */
#define REFUSED(call)                                                                              \
    do {                                                                                           \
        told_clear();                                                                              \
        CHECK((call) == BAD);                                                                      \
        CHECK(told_errors > 0 && told_last[0]);                                                    \
    } while (0)

static void wrong_instances_are_refused(void)
{
    told_clear();
    CHECK(!f.instantiate("unit", "{another}", resources, 0) && told_errors == 1);
    CHECK_CONTAINS(told_last, "{another}");
    told_clear();
    CHECK(!f.instantiate("unit", d.token, "/nowhere/100%s/#1", 0) && told_errors == 1);
    CHECK_CONTAINS(told_last, is(d.version, "3.0") ? "/nowhere/100%s/#1" : "/nowhere/100%s/##1");
    told_clear();
    CHECK(!f.instantiate("unit", d.token, NULL, 0) && told_errors == 1);
    CHECK(!f.instantiate("unit", NULL, resources, 0) && told_errors == 2);
    CHECK(!f.instantiate(NULL, d.token, resources, 0));
    CHECK(!f.instantiate("", d.token, resources, 0));
    f.free(NULL);
}

static void null_is_refused(void)
{
    double value = 0.0;
    int ended = 0;
    void *state = NULL;
    size_t size = 0;
    const uint32_t vr = 0;
    CHECK(f.setup(NULL, 0, 0.0, 0.0, 0, 0.0) == BAD);
    CHECK(f.enter(NULL) == BAD && f.leave(NULL) == BAD && f.terminate(NULL) == BAD);
    CHECK(f.reset(NULL) == BAD && f.get(NULL, &vr, 1, &value) == BAD);
    CHECK(f.set(NULL, &vr, 1, &value) == BAD && f.step(NULL, 0.0, 1.0, &value, &ended) == BAD);
    CHECK(f.get_state(NULL, &state) == BAD && f.set_state(NULL, NULL) == BAD);
    void *c = begin();
    REFUSED(f.get(c, NULL, 1, &value));
    REFUSED(f.get(c, &vr, 1, NULL));
    REFUSED(f.set(c, NULL, 1, &value));
    REFUSED(f.set_state(c, NULL));
    REFUSED(f.state_size(c, NULL, &size));
    REFUSED(f.get_state(c, NULL));
    REFUSED(f.read_state(c, NULL, 10, &state));
    CHECK(f.free_state(c, &state) == GOOD && f.free_state(c, NULL) == GOOD);
    CHECK(f.get(c, NULL, 0, NULL) == GOOD && f.set(c, NULL, 0, NULL) == GOOD);
    f.free(c);
}

static void calls_out_of_order_are_refused(void)
{
    double value = 0.0;
    int ended = 0;
    void *c = make();
    REFUSED(f.step(c, d.start, 0.01, &value, &ended));
    REFUSED(f.leave(c));
    REFUSED(f.terminate(c));
    REFUSED(f.get(c, &references[1], 1, &value));
    REFUSED(f.setup(c, 0, 0.0, (double)NAN, 0, 0.0));
    REFUSED(f.setup(c, 0, 0.0, (double)INFINITY, 0, 0.0));
    REFUSED(f.setup(c, 0, 0.0, 1.0, 1, 0.0));
    REFUSED(f.setup(c, 1, -1.0, 0.0, 0, 0.0));
    CHECK(f.enter(c) == GOOD);
    REFUSED(f.enter(c));
    REFUSED(f.step(c, d.start, 0.01, &value, &ended));
    CHECK(f.get(c, &references[1], 1, &value) == GOOD);
    CHECK(f.leave(c) == GOOD);
    REFUSED(f.leave(c));
    REFUSED(f.enter(c));
    CHECK(f.terminate(c) == GOOD);
    REFUSED(f.terminate(c));
    REFUSED(f.step(c, d.start, 0.01, &value, &ended));
    CHECK(f.get(c, &references[1], 1, &value) == GOOD);
    f.free(c);
}

/* Nothing of it changes where the unit goes. */
static void wrong_numbers_are_refused(void)
{
    double expected[COLUMNS_MAX];
    double values[COLUMNS_MAX];
    double value = 0.0;
    int ended = 0;
    void *state = NULL;
    unsigned char garbage[200];
    const uint32_t unknown[] = {(uint32_t)d.count, 123456789U, UINT32_MAX};
    the_whole_run(expected);
    void *c = begin();
    for (size_t k = 0; k < 3; ++k) {
        REFUSED(f.get(c, &unknown[k], 1, &value));
        REFUSED(f.set(c, &unknown[k], 1, &value));
    }
    for (size_t k = 0; k < d.count; ++k) {
        const variable *v = &d.variables[k];
        const double nan = (double)NAN;
        REFUSED(f.set(c, &v->reference, 1, &nan));
        if (!is(v->causality, "input")) {
            REFUSED(f.set(c, &v->reference, 1, &v->start));
        }
    }
    const double steps[] = {0.0, -0.01, (double)NAN, (double)INFINITY, 1e300, 1e-300};
    for (size_t k = 0; k < sizeof steps / sizeof *steps; ++k) {
        REFUSED(f.step(c, rows[0][0], steps[k], &value, &ended));
    }
    REFUSED(f.step(c, rows[2][0], 0.01, &value, &ended));
    REFUSED(f.step(c, (double)NAN, 0.01, &value, &ended));
    memset(garbage, 7, sizeof garbage);
    CHECK(f.read_state(c, garbage, sizeof garbage, &state) == GOOD);
    REFUSED(f.set_state(c, state));
    CHECK(f.free_state(c, &state) == GOOD);
    REFUSED(f.other_type(c, 1));
    CHECK(f.other_type(c, 0) == GOOD);
    const double one = 1.0;
    REFUSED(f.directional(c, &d.variables[0].reference, 1, unknown, 1, &one, &value));
    REFUSED(f.directional(c, &references[1], 1, &references[1], 1, &one, &value));
    REFUSED(f.logging(c, "no such category"));
    CHECK(f.logging(c, "logAll") == GOOD);
    CHECK(go(c, 0, row_count - 2) == GOOD);
    get_row(c, values);
    CHECK(same_bits(values, expected));
    f.free(c);
}

static void *meddled; /* the instance whose logger calls it */

static void meddle(void)
{
    double value = 0.0;
    int ended = 0;
    void *state = NULL;
    const uint32_t vr = d.variables[d.outputs[0]].reference;
    CHECK(f.get(meddled, &vr, 1, &value) == BAD && f.set(meddled, &vr, 1, &value) == BAD);
    CHECK(f.step(meddled, rows[1][0], 0.01, &value, &ended) == BAD);
    CHECK(f.reset(meddled) == BAD && f.terminate(meddled) == BAD);
    CHECK(f.get_state(meddled, &state) == BAD && !state);
    CHECK(f.logging(meddled, "logAll") == BAD);
    f.free(meddled);
}

/* Nothing of it has an effect, nor is it told of. */
static void a_logger_does_not_come_back_in(void)
{
    double expected[COLUMNS_MAX];
    double values[COLUMNS_MAX];
    void *c = begin();
    CHECK(go(c, 0, 2) == GOOD);
    get_row(c, expected);
    f.free(c);
    meddled = begin();
    CHECK(go(meddled, 0, 1) == GOOD);
    told_meddle = meddle;
    told_clear();
    CHECK(f.logging(meddled, "no such category") == BAD && told_errors == 1);
    CHECK(f.get(meddled, NULL, 1, values) == BAD && told_errors == 2);
    told_meddle = NULL;
    CHECK(go(meddled, 1, 2) == GOOD);
    get_row(meddled, values);
    CHECK(same_bits(values, expected));
    f.free(meddled);
}

/* A state cut anywhere, or changed, is refused or fails, and the instance can be started again. */
static void damaged_states_are_refused(void)
{
    void *state = NULL;
    void *read = NULL;
    size_t size = 0;
    void *c = begin();
    CHECK(go(c, 0, 2) == GOOD);
    CHECK(f.get_state(c, &state) == GOOD && f.state_size(c, state, &size) == GOOD);
    unsigned char *bytes = malloc(size);
    CHECK(bytes && f.write_state(c, state, bytes, size) == GOOD);
    REFUSED(f.write_state(c, state, bytes, size - 1));
    for (size_t k = 1; k <= 20; ++k) {
        CHECK(f.read_state(c, bytes, size * k / 21, &read) == GOOD);
        REFUSED(f.set_state(c, read));
    }
    bytes[size - 40] ^= 0x55;
    CHECK(f.read_state(c, bytes, size, &read) == GOOD);
    if (f.set_state(c, read) != GOOD) {
        CHECK(f.set_state(c, state) == GOOD);
    }
    CHECK(f.reset(c) == GOOD && f.enter(c) == GOOD && f.leave(c) == GOOD);
    CHECK(f.free_state(c, &read) == GOOD && f.free_state(c, &state) == GOOD);
    f.free(c);
    free(bytes);
}

/* ---- what can be set ------------------------------------------------------------------------*/

static void parameters_change_the_model(void)
{
    double expected[COLUMNS_MAX];
    double values[COLUMNS_MAX];
    double got = 0.0;
    size_t changed = 0;
    size_t count = 0;
    const size_t part = row_count < 20 ? row_count - 2 : 18; /* the model is read often */
    void *plain = begin();
    CHECK(go(plain, 0, part) == GOOD);
    get_row(plain, expected);
    f.free(plain);
    for (size_t k = 0; k < d.count; ++k) {
        const variable *v = &d.variables[k];
        const double more = 1.001 * v->start;
        if (!is(v->causality, "parameter") || !(fabs(v->start) > 0.0)) {
            continue;
        }
        ++count;
        void *c = make();
        CHECK(f.get(c, &v->reference, 1, &got) == GOOD);
        CHECK_NEAR(got, v->start, 0.0);
        CHECK(f.set(c, &v->reference, 1, &v->start) == GOOD);
        CHECK(f.enter(c) == GOOD && f.leave(c) == GOOD && go(c, 0, part) == GOOD);
        get_row(c, values);
        CHECK(same_bits(values, expected));
        CHECK(f.reset(c) == GOOD && f.enter(c) == GOOD);
        CHECK(f.set(c, &v->reference, 1, &more) == GOOD);
        CHECK(f.get(c, &v->reference, 1, &got) == GOOD);
        CHECK_NEAR(got, more, 0.0);
        if (f.leave(c) == GOOD && go(c, 0, part) == GOOD) {
            get_row(c, values);
            changed += !same_bits(values, expected);
        } else {
            ++changed; /* the model does not go together any more, and says so */
        }
        f.free(c);
    }
    CHECK(count == 0 || changed > 0);
}

/* With inputs that change a state goes on with the same bits, too, and they come back with it. */
static void inputs_act_and_are_restored(void)
{
    double values[3][COLUMNS_MAX];
    double got = 0.0;
    const size_t third = row_count / 3;
    for (size_t k = 0; k < d.count; ++k) {
        const variable *v = &d.variables[k];
        const double other = v->start + 0.125;
        void *state = NULL;
        if (!is(v->causality, "input")) {
            continue;
        }
        void *c = begin();
        CHECK(go(c, 0, third) == GOOD);
        CHECK(f.get_state(c, &state) == GOOD);
        CHECK(go(c, third, 2 * third) == GOOD);
        get_row(c, values[0]);
        CHECK(f.set_state(c, state) == GOOD);
        CHECK(f.set(c, &v->reference, 1, &other) == GOOD);
        CHECK(f.get(c, &v->reference, 1, &got) == GOOD);
        CHECK_NEAR(got, other, 0.0);
        CHECK(go(c, third, 2 * third) == GOOD);
        get_row(c, values[1]);
        CHECK(!same_bits(values[0], values[1]));
        CHECK(f.set_state(c, state) == GOOD);
        CHECK(f.get(c, &v->reference, 1, &got) == GOOD);
        CHECK_NEAR(got, v->start, 0.0);
        CHECK(go(c, third, 2 * third) == GOOD);
        get_row(c, values[2]);
        CHECK(same_bits(values[0], values[2]));
        CHECK(f.free_state(c, &state) == GOOD);
        f.free(c);
    }
}

/* An input that is set after outputs were read in the initialization acts on the analyses before
 * as one that is set at once. */
static void inputs_act_on_the_beginning(void)
{
    double values[2][COLUMNS_MAX];
    for (size_t k = 0; k < d.count; ++k) {
        const variable *v = &d.variables[k];
        const double other = v->start + 0.125;
        if (!is(v->causality, "input")) {
            continue;
        }
        for (int reads = 0; reads < 2; ++reads) {
            void *c = make();
            CHECK(f.enter(c) == GOOD);
            if (reads) {
                get_row(c, values[1]);
            }
            CHECK(f.set(c, &v->reference, 1, &other) == GOOD);
            CHECK(f.leave(c) == GOOD);
            get_row(c, values[reads]);
            f.free(c);
        }
        CHECK(same_bits(values[0], values[1]));
    }
}

/* No step goes beyond the end of the experiment. */
static void the_end_of_the_experiment_holds(void)
{
    double value = 0.0;
    int ended = 0;
    void *c = make();
    const double stop = rows[2][0];
    CHECK(f.setup(c, 1, 1e-7, d.start, 1, stop) == GOOD);
    CHECK(f.enter(c) == GOOD && f.leave(c) == GOOD);
    CHECK(go(c, 0, 1) == GOOD);
    REFUSED(f.step(c, rows[1][0], 10.0 * (stop - rows[1][0]), &value, &ended));
    CHECK(go(c, 1, 2) == GOOD);
    CHECK(f.terminate(c) == GOOD);
    f.free(c);
}

/* What the derivative tells of a small change of an input is what setting it shows; asking has no
 * effect. */
static void derivatives_of_outputs_are_those_of_steps(void)
{
    double values[3][COLUMNS_MAX];
    double slopes[COLUMNS_MAX];
    const double one = 1.0;
    for (size_t k = 0; k < d.count; ++k) {
        const variable *v = &d.variables[k];
        if (!is(v->causality, "input")) {
            continue;
        }
        void *c = begin();
        CHECK(go(c, 0, 2) == GOOD);
        get_row(c, values[0]);
        for (size_t i = 1; i < column_count; ++i) {
            CHECK(f.directional(c, &references[i], 1, &v->reference, 1, &one, &slopes[i]) == GOOD);
        }
        get_row(c, values[1]);
        CHECK(same_bits(values[0], values[1]));
        for (int side = 0; side < 2; ++side) {
            const double other = v->start + (side ? 1e-4 : -1e-4);
            CHECK(f.set(c, &v->reference, 1, &other) == GOOD);
            get_row(c, values[1 + side]);
        }
        for (size_t i = 1; i < column_count; ++i) {
            const double slope = (values[2][i] - values[1][i]) / 2e-4;
            CHECK_NEAR(slopes[i], slope, 1e-6 * (1.0 + fabs(slope) + 10.0 * fabs(values[0][i])));
        }
        f.free(c);
    }
}

/* The unknowns of the initialization with one value changed. */
static int begin_with(const uint32_t *unknowns, size_t count, uint32_t known, double value,
                      double *values)
{
    void *c = make();
    const int good = f.enter(c) == GOOD && f.set(c, &known, 1, &value) == GOOD &&
                     f.get(c, unknowns, count, values) == GOOD;
    f.free(c);
    return good;
}

/* How what the initialization calculates depends on one input or parameter. */
static void check_beginning(const uint32_t *unknowns, size_t count, const variable *v)
{
    static double values[2][VARIABLES_MAX];
    static double slopes[VARIABLES_MAX];
    const double one = 1.0;
    const double size = is(v->causality, "parameter") && v->start != 0.0 ? fabs(v->start) : 1.0;
    const double h = 2e-4 * size;
    if (!begin_with(unknowns, count, v->reference, v->start - h, values[0]) ||
        !begin_with(unknowns, count, v->reference, v->start + h, values[1])) {
        return; /* the model cannot be so */
    }
    void *c = make();
    CHECK(f.enter(c) == GOOD);
    CHECK(f.directional(c, unknowns, count, &v->reference, 1, &one, slopes) == GOOD);
    for (size_t i = 0; i < count; ++i) {
        const double slope = (values[1][i] - values[0][i]) / (2.0 * h);
        const double most = fmax(fabs(values[0][i]), fabs(values[1][i]));
        CHECK_NEAR(slopes[i], slope, 2e-6 * (fabs(slope) + (1.0 + most) / size));
    }
    CHECK(f.leave(c) == GOOD);
    get_row(c, values[0]);
    f.free(c);
    c = make();
    CHECK(f.enter(c) == GOOD && f.leave(c) == GOOD);
    get_row(c, values[1]);
    CHECK(same_bits(values[0], values[1]));
    f.free(c);
}

/* In the initialization outputs, calculated parameters, and in model exchange states and their
 * derivatives, depend on inputs and parameters; asking has no effect. */
static void derivatives_are_there_in_the_initialization(void)
{
    static uint32_t unknowns[VARIABLES_MAX];
    const double one = 1.0;
    double out = 0.0;
    for (unit_exchanges = 0; unit_exchanges <= d.exchanges; ++unit_exchanges) {
        size_t count = 0;
        size_t asked = 0;
        for (size_t k = 0; k < d.unknown_count; ++k) {
            if (unit_exchanges || !is_integrated(d.unknowns[k])) {
                unknowns[count++] = d.variables[d.unknowns[k]].reference;
            }
        }
        for (size_t k = 0; k < d.count && asked < 3; ++k) {
            if (is(d.variables[k].causality, "input") ||
                is(d.variables[k].causality, "parameter")) {
                check_beginning(unknowns, count, &d.variables[k]);
                ++asked;
            }
        }
        void *c = make();
        CHECK(f.enter(c) == GOOD);
        REFUSED(f.directional(c, unknowns, 1, unknowns, 1, &one, &out)); /* not known */
        f.free(c);
    }
    unit_exchanges = 0;
}

int main(int argc, char **argv)
{
    char path[3000];
    if (argc != 3) {
        fputs("check_fmu FOLDER RESULTS.csv\n", stderr);
        return 2;
    }
    snprintf(path, sizeof path, "%s/modelDescription.xml", argv[1]);
    snprintf(resources, sizeof resources, "%s/resources", argv[1]);
    if (!description_read(path, &d) || !read_results(argv[2])) {
        fprintf(stderr, "%s or %s cannot be read\n", path, argv[2]);
        return 1;
    }
    const int new = is(d.version, "3.0");
    snprintf(path, sizeof path, "%s/binaries/%s/%s.so", argv[1], new ? "x86_64-linux" : "linux64",
             d.identifier);
    const int missing = new ? functions_load_3(&f, path) : functions_load_2(&f, path);
    CHECK(missing == 0);
    if (missing < 0) {
        return 1;
    }
    RUN(description_lists_each_variable_once);
    RUN(description_has_the_right_kinds);
    RUN(description_lists_what_is_calculated);
    RUN(outputs_are_those_of_a_run);
    RUN(a_state_goes_on_with_the_same_bits);
    RUN(a_state_before_the_start_starts_again);
    RUN(reset_starts_again);
    RUN(instances_are_independent);
    RUN(wrong_instances_are_refused);
    RUN(null_is_refused);
    RUN(calls_out_of_order_are_refused);
    RUN(wrong_numbers_are_refused);
    RUN(a_logger_does_not_come_back_in);
    RUN(damaged_states_are_refused);
    RUN(parameters_change_the_model);
    RUN(inputs_act_and_are_restored);
    RUN(inputs_act_on_the_beginning);
    RUN(the_end_of_the_experiment_holds);
    RUN(derivatives_of_outputs_are_those_of_steps);
    RUN(derivatives_are_there_in_the_initialization);
    const run results = {&d,          &f,        resources,  &rows[0][0],
                         COLUMNS_MAX, row_count, references, column_count};
    const int exchanges_badly = exchange_check(&results);
    return check_finish() || exchanges_badly;
}
