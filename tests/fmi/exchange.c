/* SPDX-License-Identifier: BSD-3-Clause */
/* Model exchange: the checker integrates the states of a unit by a method of order 4 with events,
 * and compares with the run. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "unit.h"

enum { STATES_MAX = 300, SUBSTEPS = 20 };

static const run *r;
static size_t n; /* states */
static size_t m; /* indicators */

/* ---- the description ------------------------------------------------------------------------*/

static void derivatives_belong_to_states(void)
{
    const description *d = r->d;
    CHECK(n > 0);
    for (size_t k = 0; k < n; ++k) {
        const variable *derivative = &d->variables[d->derivatives[k]];
        const size_t state = derivative->derivative;
        CHECK(state > 0 && state <= d->count);
        CHECK(strcmp(derivative->causality, "local") == 0);
        CHECK(d->variables[state - 1].nominal > 0.0);
        CHECK(d->variables[state - 1].derivative == 0);
        for (size_t i = 0; i < k; ++i) {
            CHECK(d->variables[d->derivatives[i]].derivative != state);
        }
    }
}

/* ---- integration ----------------------------------------------------------------------------*/

static void *begin(void)
{
    int ends = 0;
    int moved = 0;
    int more = 1;
    unit_exchanges = 1;
    void *c = r->f->instantiate("unit", r->d->token, r->resources, 0);
    unit_exchanges = 0;
    CHECK(c);
    if (!c) {
        fprintf(stderr, "%s\n", told_last);
        exit(1);
    }
    CHECK(r->f->setup(c, 0, 0.0, r->d->start, 1, r->d->stop) == GOOD);
    CHECK(r->f->enter(c) == GOOD && r->f->leave(c) == GOOD);
    CHECK(r->f->update(c, &ends, &moved, &more) == GOOD && !more && !ends);
    CHECK(r->f->go_on(c) == GOOD);
    return c;
}

static int eval(void *c, double t, const double *x, double *dx)
{
    int status = r->f->set_time(c, t);
    status = status == GOOD ? r->f->set_states(c, x, n) : status;
    return status == GOOD ? r->f->get_derivatives(c, dx, n) : status;
}

/* The classical method of Runge and Kutta. */
static int step(void *c, double t, double h, double *x)
{
    static const double places[] = {0.0, 0.5, 0.5, 1.0};
    static const double weights[] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
    double slope[STATES_MAX] = {0.0};
    double trial[STATES_MAX];
    double sum[STATES_MAX] = {0.0};
    int status = GOOD;
    for (size_t stage = 0; stage < 4 && status == GOOD; ++stage) {
        for (size_t k = 0; k < n; ++k) {
            trial[k] = x[k] + places[stage] * h * slope[k];
        }
        status = eval(c, t + places[stage] * h, trial, slope);
        for (size_t k = 0; k < n; ++k) {
            sum[k] += weights[stage] * slope[k];
        }
    }
    for (size_t k = 0; k < n; ++k) {
        x[k] += h * sum[k];
    }
    status = status == GOOD ? r->f->set_time(c, t + h) : status;
    return status == GOOD ? r->f->set_states(c, x, n) : status;
}

/* In an event; *ended: the unit goes no further. */
static int event(void *c, double *x, int *ended)
{
    int moved = 0;
    int more = 0;
    int status = r->f->enter_event(c);
    status = status == GOOD ? r->f->update(c, ended, &moved, &more) : status;
    CHECK(!more);
    status = status == GOOD && moved ? r->f->get_states(c, x, n) : status;
    return status == GOOD ? r->f->go_on(c) : status;
}

static int changes(const double *before, const double *after)
{
    int found = 0;
    for (size_t k = 0; k < m; ++k) {
        found = found || before[k] * after[k] < 0.0;
    }
    return found;
}

/* One step, shortened by halves to the first change of a sign. */
static int step_to_event(void *c, double *t, double h, double *x, int *ended)
{
    double before[STATES_MAX];
    double after[STATES_MAX];
    double start[STATES_MAX];
    double low = 0.0;
    double high = h;
    int asks = 0;
    int ends = 0;
    memcpy(start, x, n * sizeof *x);
    int status = r->f->get_indicators(c, before, m);
    status = status == GOOD ? step(c, *t, h, x) : status;
    status = status == GOOD ? r->f->get_indicators(c, after, m) : status;
    const int found = status == GOOD && changes(before, after);
    for (int k = 0; k < 40 && found && status == GOOD; ++k) {
        const double middle = 0.5 * (low + high);
        memcpy(x, start, n * sizeof *x);
        status = step(c, *t, middle, x);
        status = status == GOOD ? r->f->get_indicators(c, after, m) : status;
        *(changes(before, after) ? &high : &low) = middle;
    }
    if (found && status == GOOD) {
        memcpy(x, start, n * sizeof *x);
        status = step(c, *t, high, x);
    }
    *t += high;
    status = status == GOOD ? r->f->complete(c, &asks, &ends) : status;
    CHECK(!ends);
    return status == GOOD && (asks || found) ? event(c, x, ended) : status;
}

/* From row `from` to row `to`. */
static int go(void *c, size_t from, size_t to, double *x, int *ended)
{
    int status = GOOD;
    *ended = 0;
    for (size_t k = from; k < to && status == GOOD && !*ended; ++k) {
        double t = r->rows[k * r->stride];
        const double end = r->rows[(k + 1) * r->stride];
        const double h = (end - t) / SUBSTEPS;
        while (status == GOOD && !*ended && end - t > 1e-9 * h) {
            status = step_to_event(c, &t, fmin(h, end - t), x, ended);
        }
    }
    return status;
}

static double largest(size_t column)
{
    double most = 0.0;
    for (size_t k = 0; k < r->row_count; ++k) {
        most = fmax(most, fabs(r->rows[k * r->stride + column]));
    }
    return most;
}

/* The error of the checker's method and of the run are below this part of the largest value. */
#define TOLERANCE 2e-5

static void outputs_are_those_of_a_run(void)
{
    double x[STATES_MAX];
    double value = 0.0;
    int ended = 0;
    void *c = begin();
    const size_t last = r->row_count < 62 ? r->row_count - 1 : 61;
    CHECK(r->f->get_states(c, x, n) == GOOD);
    for (size_t k = 0; k <= last && !ended; ++k) {
        for (size_t i = 1; i < r->column_count; ++i) {
            CHECK(r->f->get(c, &r->references[i], 1, &value) == GOOD);
            CHECK_NEAR(value, r->rows[k * r->stride + i], TOLERANCE * (1e-3 + largest(i)));
        }
        if (k < last) {
            CHECK(go(c, k, k + 1, x, &ended) == GOOD);
        }
    }
    CHECK(r->f->terminate(c) == GOOD);
    r->f->free(c);
}

/* A caller may find the zero itself: the event is there, once. */
static void an_event_at_zero_is_found_once(void)
{
    double x[STATES_MAX];
    double values[STATES_MAX];
    int ended = 0;
    void *c = begin();
    CHECK(r->f->get_states(c, x, n) == GOOD);
    x[0] = 0.3125;
    CHECK(r->f->set_states(c, x, n) == GOOD && r->f->get_indicators(c, values, m) == GOOD);
    CHECK_NEAR(values[0], 0.0, 0.0);
    CHECK(event(c, x, &ended) == GOOD && ended);
    CHECK(event(c, x, &ended) == GOOD && !ended);
    x[0] = 0.5;
    CHECK(r->f->set_states(c, x, n) == GOOD && event(c, x, &ended) == GOOD && !ended);
    r->f->free(c);
}

/* ---- derivatives ----------------------------------------------------------------------------*/

/* The same bits, whatever was asked before. */
static void derivatives_are_a_function_of_states(void)
{
    double x[STATES_MAX];
    double far[STATES_MAX];
    double first[STATES_MAX];
    double second[STATES_MAX];
    double nominals[STATES_MAX];
    void *c = begin();
    const double t = r->d->start;
    CHECK(r->f->get_states(c, x, n) == GOOD && r->f->get_nominals(c, nominals, n) == GOOD);
    for (size_t k = 0; k < n; ++k) {
        far[k] = x[k] + 1e-3 * nominals[k] * sin(1.0 + (double)k);
    }
    CHECK(eval(c, t, x, first) == GOOD);
    CHECK(eval(c, t + 0.1, far, second) == GOOD);
    CHECK(memcmp(first, second, n * sizeof *first) != 0);
    CHECK(eval(c, t, x, second) == GOOD);
    CHECK(memcmp(first, second, n * sizeof *first) == 0);
    r->f->free(c);
}

/* Directional derivatives of derivatives are what a difference of another width shows; asking
 * changes nothing; a seed of several states adds up. */
static void directional_derivatives_are_those_of_differences(void)
{
    double x[STATES_MAX];
    double at[STATES_MAX];
    double low[STATES_MAX];
    double high[STATES_MAX];
    double again[STATES_MAX];
    double slopes[STATES_MAX];
    uint32_t knowns[STATES_MAX];
    uint32_t unknowns[STATES_MAX];
    double seed[STATES_MAX];
    const description *d = r->d;
    void *c = begin();
    const double t = d->start;
    const double h = 1e-5;
    for (size_t k = 0; k < n; ++k) {
        unknowns[k] = d->variables[d->derivatives[k]].reference;
        knowns[k] = d->variables[d->variables[d->derivatives[k]].derivative - 1].reference;
        seed[k] =
            cos((double)k) * d->variables[d->variables[d->derivatives[k]].derivative - 1].nominal;
    }
    CHECK(r->f->get_states(c, x, n) == GOOD);
    CHECK(eval(c, t, x, low) == GOOD);
    CHECK(r->f->directional(c, unknowns, n, knowns, n, seed, slopes) == GOOD);
    CHECK(r->f->get_derivatives(c, again, n) == GOOD);
    CHECK(memcmp(low, again, n * sizeof *low) == 0);
    for (int side = -1; side <= 1; side += 2) {
        for (size_t k = 0; k < n; ++k) {
            at[k] = x[k] + side * h * seed[k];
        }
        CHECK(eval(c, t, at, side < 0 ? low : high) == GOOD);
    }
    double most = 0.0;
    for (size_t k = 0; k < n; ++k) {
        most = fmax(most, fabs(slopes[k]));
    }
    for (size_t k = 0; k < n; ++k) {
        CHECK_NEAR(slopes[k], (high[k] - low[k]) / (2.0 * h), 1e-5 * (1.0 + most));
        if (d->constants[k] > 0) { /* exactly */
            const uint32_t state = d->variables[d->constants[k] - 1].reference;
            for (size_t i = 0; i < n; ++i) {
                if (knowns[i] == state) {
                    CHECK_NEAR(slopes[k], seed[i], 0.0);
                }
            }
        }
    }
    r->f->free(c);
}

/* ---- states ---------------------------------------------------------------------------------*/

static void a_state_goes_on_with_the_same_bits(void)
{
    double x[3][STATES_MAX];
    void *state = NULL;
    void *read = NULL;
    size_t size = 0;
    int ended = 0;
    void *c = begin();
    CHECK(r->f->get_states(c, x[0], n) == GOOD && go(c, 0, 1, x[0], &ended) == GOOD);
    CHECK(r->f->get_state(c, &state) == GOOD && r->f->state_size(c, state, &size) == GOOD);
    unsigned char *bytes = malloc(size + 1);
    CHECK(bytes && r->f->write_state(c, state, bytes, size) == GOOD);
    memcpy(x[1], x[0], sizeof x[0]);
    CHECK(go(c, 1, 2, x[0], &ended) == GOOD);
    CHECK(r->f->set_state(c, state) == GOOD);
    CHECK(r->f->get_states(c, x[2], n) == GOOD);
    CHECK(memcmp(x[1], x[2], n * sizeof **x) == 0);
    CHECK(go(c, 1, 2, x[2], &ended) == GOOD);
    CHECK(memcmp(x[0], x[2], n * sizeof **x) == 0);
    CHECK(r->f->free_state(c, &state) == GOOD);
    r->f->free(c);
    c = begin(); /* another one */
    CHECK(r->f->read_state(c, bytes, size, &read) == GOOD && r->f->set_state(c, read) == GOOD);
    CHECK(go(c, 1, 2, x[1], &ended) == GOOD);
    CHECK(memcmp(x[0], x[1], n * sizeof **x) == 0);
    CHECK(r->f->free_state(c, &read) == GOOD);
    r->f->free(c);
    c = r->f->instantiate("unit", r->d->token, r->resources, 0); /* that makes steps of its own */
    CHECK(c && r->f->read_state(c, bytes, size, &read) == GOOD);
    CHECK(r->f->set_state(c, read) == BAD);
    CHECK(r->f->free_state(c, &read) == GOOD);
    r->f->free(c);
    free(bytes);
}

static void wrong_calls_are_refused(void)
{
    double x[STATES_MAX] = {0.0};
    int flag = 0;
    int moved = 0;
    int more = 0;
    double reached = 0.0;
    void *c = begin();
    CHECK(r->f->get_states(c, x, n) == GOOD);
    CHECK(r->f->get_states(c, x, n + 1) == BAD && r->f->set_states(c, x, n - 1) == BAD);
    CHECK(r->f->set_states(c, NULL, n) == BAD && r->f->get_derivatives(c, NULL, n) == BAD);
    CHECK(r->f->get_indicators(c, x, m + 1) == BAD && r->f->get_nominals(c, x, 0) == BAD);
    x[0] = (double)NAN;
    CHECK(r->f->set_states(c, x, n) == BAD && r->f->set_time(c, x[0]) == BAD);
    CHECK(r->f->go_on(c) == BAD && r->f->update(c, &flag, &moved, &more) == BAD);
    CHECK(r->f->step(c, r->d->start, 0.01, &reached, &flag) == BAD);
    CHECK(r->f->enter_event(c) == GOOD && r->f->complete(c, &flag, &moved) == BAD);
    CHECK(r->f->go_on(c) == GOOD && r->f->complete(c, &flag, &moved) == GOOD);
    CHECK(r->f->terminate(c) == GOOD && r->f->set_time(c, 0.0) == BAD);
    r->f->free(c);
    c = r->f->instantiate("unit", r->d->token, r->resources, 0);
    CHECK(r->f->enter(c) == GOOD && r->f->leave(c) == GOOD);
    CHECK(r->f->get_states(c, x, n) == BAD && r->f->set_time(c, 0.0) == BAD);
    CHECK(r->f->enter_event(c) == BAD && r->f->get_derivatives(c, x, n) == BAD);
    r->f->free(c);
    CHECK(r->f->set_time(NULL, 0.0) == BAD && r->f->get_states(NULL, x, n) == BAD);
}

static void it_is_refused(void)
{
    unit_exchanges = 1;
    CHECK(!r->f->instantiate("unit", r->d->token, r->resources, 0));
    unit_exchanges = 0;
    CHECK_CONTAINS(told_last, "co-simulation only");
}

int exchange_check(const run *results)
{
    r = results;
    n = r->d->derivative_count;
    m = r->d->indicator_count;
    if (!r->d->exchanges) {
        RUN(it_is_refused);
        return check_finish();
    }
    CHECK(n <= STATES_MAX && m <= STATES_MAX);
    if (n > STATES_MAX || m > STATES_MAX) {
        return check_finish();
    }
    RUN(derivatives_belong_to_states);
    RUN(outputs_are_those_of_a_run);
    if (strcmp(r->d->model, "level") == 0) {
        RUN(an_event_at_zero_is_found_once);
    }
    RUN(derivatives_are_a_function_of_states);
    RUN(directional_derivatives_are_those_of_differences);
    RUN(a_state_goes_on_with_the_same_bits);
    RUN(wrong_calls_are_refused);
    return check_finish();
}
