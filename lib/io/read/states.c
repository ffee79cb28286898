/* SPDX-License-Identifier: BSD-3-Clause */
/* `states`: numbers that a run integrates with the motion. Each becomes one or more states of the
 * system, made before the forces, whose laws may name them; what they depend on is read after the
 * forces, whose channels they may name.  docs/theory/states.md */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/base/number.h"
#include "io/base/pool.h"
#include "io/channel/law.h"
#include "io/document/document.h"
#include "io/document/fields.h"
#include "io/document/function.h"
#include "io/document/value.h"
#include "io/model/model.h"
#include "io/read/elements.h"
#include "io/read/entries.h"
#include "io/read/include.h"
#include "io/read/objects.h"
#include "io/read/sections.h"

enum { ORDER_MAX = 12, TERM_SIZE = SE3DI_NUMBER_SIZE + 8 };

static const char *const time_only[] = {"t", NULL};
static const char *const state_types[] = {"ode", "integrator", "lag", "transfer", "pid", NULL};

/* What its keys say. */
typedef struct state_values {
    double initial, size, gain, time_constant;
    double kp, ki, kd, filter_time, filter_initial, lower, upper, tracking_time;
} state_values;

/* clang-format off */
static const se3di_key state_keys[] = {
    {"name", SE3DI_KIND_NAME, .standard = "state1, state2, ...",
     .text = "unique among joints, drivers, constraints, forces and states"},
    {"when", SE3DI_KIND_CONDITION, .text = "it is there only if this holds"},
    {"type", SE3DI_KIND_TYPE, .required = true, .text = ""},
    {"rate", SE3DI_KIND_FUNCTION, .types = " ode ", .required = true,
     .text = "its derivative: a function of t and of [channels](#laws-of-channels), also of the "
         "state itself and of others"},
    {"output", SE3DI_KIND_FUNCTION, .types = " ode ", .standard = "the state itself",
     .text = "what `value` is: a function of t and of channels; `state` is the state itself"},
    {"input", SE3DI_KIND_FUNCTION, .types = " ode ",
     .text = "a number that rate and output may share: a function of t and of channels"},
    {"input", SE3DI_KIND_FUNCTION, .types = " integrator lag transfer pid ", .required = true,
     .text = "u: a function of t and of [channels](#laws-of-channels)"},
    {"gain", SE3DI_KIND_NUMBER, SE3DI_INTO(state_values, gain), .types = " integrator lag ",
     .standard = "1", .text = "times u"},
    {"time_constant", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(state_values, time_constant),
     .types = " lag ", .required = true, .text = "[s]"},
    {"numerator", SE3DI_KIND_NUMBERS, .types = " transfer ", .required = true,
     .text = "coefficients of the polynomial in s, the highest power first"},
    {"denominator", SE3DI_KIND_NUMBERS, .types = " transfer ", .required = true,
     .text = "the same, of a degree from 1 to 12 and not below that of the numerator"},
    {"kp", SE3DI_KIND_NUMBER, SE3DI_INTO(state_values, kp), .types = " pid ", .standard = "0",
     .text = "times u"},
    {"ki", SE3DI_KIND_NUMBER, SE3DI_INTO(state_values, ki), .types = " pid ", .standard = "0",
     .text = "times the integral of u"},
    {"kd", SE3DI_KIND_NUMBER, SE3DI_INTO(state_values, kd), .types = " pid ", .standard = "0",
     .text = "times the filtered derivative of u, s / (1 + filter_time s)"},
    {"filter_time", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(state_values, filter_time),
     .types = " pid ", .text = "of the derivative; must be given with kd [s]"},
    {"filter_initial", SE3DI_KIND_NUMBER, SE3DI_INTO(state_values, filter_initial),
     .types = " pid ", .standard = "0", .text = "the u from which the derivative begins"},
    {"lower", SE3DI_KIND_NUMBER, SE3DI_INTO(state_values, lower), .types = " pid ",
     .standard = "none", .text = "limit of the value"},
    {"upper", SE3DI_KIND_NUMBER, SE3DI_INTO(state_values, upper), .types = " pid ",
     .standard = "none", .text = "limit of the value"},
    {"tracking_time", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(state_values, tracking_time),
     .types = " pid ", .standard = "sqrt(kd / ki), kp / ki without kd",
     .text = "in which the integral gives way where the value is at a limit [s]"},
    {"initial", SE3DI_KIND_NUMBER, SE3DI_INTO(state_values, initial),
     .types = " ode integrator lag pid ", .standard = "0",
     .text = "at the start; of a pid: of the integral times ki"},
    {"size", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(state_values, size),
     .standard = "1e-3",
     .text = "errors are measured by the largest value so far, and at least by this"},
    {.key = NULL}};
const se3di_object se3di_object_state = {
    "state",
    "A number that is integrated with the motion.",
    state_keys, state_types,
    NULL};
/* clang-format on */

static bool fail_system(se3di_reader *reader, const se3di_node *node, se3d_status status)
{
    return status >= 0 || se3di_reader_fail_system(reader, node, status);
}

/* ---- making them ----------------------------------------------------------------------------*/

/* The states of the system that it takes. */
static bool count_order(se3di_reader *reader, const se3di_node *node, const char *type,
                        size_t *order)
{
    *order = 1;
    if (strcmp(type, "pid") == 0) {
        *order = se3di_node_get(node, "kd") ? 2 : 1;
    }
    if (strcmp(type, "transfer") != 0) {
        return true;
    }
    const se3di_node *list = NULL;
    if (!se3di_read_list(reader, node, "denominator", &list)) {
        return false;
    }
    if (!list || list->count < 2 || list->count > ORDER_MAX + 1) {
        return se3di_reader_fail_key(reader, node, "denominator",
                                     "must be a list of 2 to %d numbers, the highest power of s "
                                     "first",
                                     ORDER_MAX + 1);
    }
    *order = list->count - 1;
    return true;
}

static bool create_states(se3di_reader *reader, const se3di_node *node, se3di_element_entry *entry)
{
    state_values v = {.size = se3d_state_def_default().size};
    const char *type = se3di_node_get(node, "type")->text;
    if (!count_order(reader, node, type, &entry->order) ||
        !se3di_read_fields(reader, node, &se3di_object_state, type, "state_values", &v)) {
        return false;
    }
    entry->states = se3di_iopool_array(reader->pool, entry->order, sizeof *entry->states);
    if (!entry->states) {
        return se3di_reader_fail_memory(reader);
    }
    for (size_t k = 0; k < entry->order; ++k) {
        se3d_state_def def = se3d_state_def_default();
        def.name = k == 0 ? entry->name : NULL;
        def.initial = k == 0 ? v.initial : v.filter_initial;
        def.size = v.size;
        const se3d_status status = se3d_state_create(reader->system, &def, &entry->states[k]);
        if (!fail_system(reader, node, status)) {
            return false;
        }
    }
    return true;
}

static bool read_state(se3di_reader *reader, const se3di_node *node)
{
    const char *type = NULL;
    se3di_element_entry *entry = NULL;
    if (!se3di_read_type(reader, node, &se3di_object_state, &type) ||
        !se3di_read_element(reader, node, SE3DI_ELEMENT_STATE, &entry)) {
        return false;
    }
    return create_states(reader, node, entry);
}

bool se3di_read_states(se3di_reader *reader, const se3di_node *root)
{
    return se3di_read_each(reader, root, "states", read_state);
}

/* ---- what they depend on --------------------------------------------------------------------*/

/* A function of the input u and the values x1, x2, ... of the states of one entry. */
static bool make_function(se3di_reader *reader, const se3di_node *node,
                          const se3di_element_entry *entry, const char *text,
                          se3d_function *function)
{
    static const char *const names[] = {"t",  "u",  "x1", "x2", "x3",  "x4",  "x5",
                                        "x6", "x7", "x8", "x9", "x10", "x11", "x12"};
    se3d_signal signals[ORDER_MAX + 1];
    se3d_function_def def = se3d_function_def_default();
    memset(signals, 0, sizeof signals);
    for (size_t k = 0; k <= entry->order; ++k) {
        signals[k].kind = SE3D_SIGNAL_STATE;
        signals[k].component = k == 0 ? SE3D_STATE_INPUT : SE3D_STATE_VALUE;
        signals[k].state = entry->states[k == 0 ? 0 : k - 1];
    }
    def.expression = text;
    def.variables = names;
    def.variable_count = entry->order + 2;
    def.signals = signals;
    def.signal_count = entry->order + 1;
    return fail_system(reader, node, se3d_function_create(reader->system, &def, function));
}

static bool set_rate(se3di_reader *reader, const se3di_node *node, const se3di_element_entry *entry,
                     size_t k, const char *text)
{
    se3d_function function;
    return make_function(reader, node, entry, text, &function) &&
           fail_system(reader, node,
                       se3d_state_set_rate(reader->system, entry->states[k], function));
}

static bool set_output(se3di_reader *reader, const se3di_node *node,
                       const se3di_element_entry *entry, const char *text)
{
    se3d_function function;
    return make_function(reader, node, entry, text, &function) &&
           fail_system(reader, node,
                       se3d_state_set_output(reader->system, entry->states[0], function));
}

/* The function under `key`, also if it is a number. */
static bool read_law(se3di_reader *reader, const se3di_node *node, const char *key,
                     se3d_function *function)
{
    const se3di_node *child = se3di_node_get(node, key);
    se3d_function_def def = se3d_function_def_default();
    *function = (se3d_function){0, 0};
    if (!child) {
        return se3di_reader_fail_key(reader, node, key,
                                     "is missing, must be a number, or an expression of t and "
                                     "channels");
    }
    reader->alternative = -1;
    if (!se3di_read_law(reader, child, time_only, &def.constant, function)) {
        return false;
    }
    return function->index1 != 0 ||
           fail_system(reader, child, se3d_function_create(reader->system, &def, function));
}

static bool set_input(se3di_reader *reader, const se3di_node *node,
                      const se3di_element_entry *entry)
{
    se3d_function function;
    return read_law(reader, node, "input", &function) &&
           fail_system(reader, node,
                       se3d_state_set_input(reader->system, entry->states[0], function));
}

/* Add "+ factor * name". */
static void add_term(char *text, size_t size, double factor, const char *name)
{
    const size_t used = strlen(text);
    if (factor != 0.0) {
        char number[SE3DI_NUMBER_SIZE];
        (void)se3di_number_format(factor, number);
        snprintf(text + used, size - used, "%s%s*%s", used > 0 ? "+" : "", number, name);
    }
}

static bool read_lag(se3di_reader *reader, const se3di_node *node, const se3di_element_entry *entry,
                     const state_values *v)
{
    char text[3 * TERM_SIZE] = "";
    const bool lags = v->time_constant > 0.0;
    if (!lags && strcmp(se3di_node_get(node, "type")->text, "lag") == 0) {
        return se3di_reader_fail_key(reader, node, "time_constant",
                                     "is missing, must be a number > 0 [s]");
    }
    add_term(text, sizeof text, lags ? v->gain / v->time_constant : v->gain, "u");
    if (lags) {
        add_term(text, sizeof text, -1.0 / v->time_constant, "x1");
    }
    return set_rate(reader, node, entry, 0, text[0] ? text : "0*u");
}

/* Coefficients of a polynomial, the highest power first, into those of s^0, s^1, ... */
static bool read_polynomial(se3di_reader *reader, const se3di_node *node, const char *key,
                            size_t most, double *coefficients)
{
    const se3di_node *list = NULL;
    if (!se3di_read_list(reader, node, key, &list)) {
        return false;
    }
    if (!list || list->count == 0 || list->count > most) {
        return se3di_reader_fail_key(reader, node, key,
                                     "must be a list of 1 to %zu numbers: its degree must not be "
                                     "above that of the denominator",
                                     most);
    }
    size_t k = list->count;
    for (const se3di_node *number = list->first; number; number = number->next) {
        if (!se3di_read_number(reader, number, SE3DI_ANY, &coefficients[--k])) {
            return false;
        }
    }
    return true;
}

/* x_k' = x_{k+1}, x_n' = u - sum a_k x_{k+1}, y = sum (b_k - b_n a_k) x_{k+1} + b_n u, a_n = 1 */
static bool read_transfer(se3di_reader *reader, const se3di_node *node,
                          const se3di_element_entry *entry)
{
    const size_t n = entry->order;
    double a[ORDER_MAX + 1] = {0.0};
    double b[ORDER_MAX + 1] = {0.0};
    char rate[(ORDER_MAX + 1) * TERM_SIZE] = "";
    char output[(ORDER_MAX + 1) * TERM_SIZE] = "";
    if (!read_polynomial(reader, node, "denominator", n + 1, a) ||
        !read_polynomial(reader, node, "numerator", n + 1, b)) {
        return false;
    }
    const se3di_node *first = se3di_node_get(node, "denominator")->first;
    if (!(fabs(a[n]) > 0.0)) {
        return se3di_reader_fail(reader, first, "is 0, must not be: it is the coefficient of s^%zu",
                                 n);
    }
    if (!se3di_check_number(reader, first, SE3DI_POSITIVE, fabs(a[n]))) {
        return false; /* others over it would not be finite */
    }
    add_term(rate, sizeof rate, 1.0, "u");
    add_term(output, sizeof output, b[n] / a[n], "u");
    for (size_t k = 0; k < n; ++k) {
        char name[24];
        snprintf(name, sizeof name, "x%zu", k + 1);
        add_term(rate, sizeof rate, -a[k] / a[n], name);
        add_term(output, sizeof output, (b[k] - b[n] * (a[k] / a[n])) / a[n], name);
        if (k > 0 && !set_rate(reader, node, entry, k - 1, name)) {
            return false;
        }
    }
    return set_rate(reader, node, entry, n - 1, rate) &&
           set_output(reader, node, entry, output[0] ? output : "0*u");
}

/* Whether all that it needs is there. */
static bool check_pid(se3di_reader *reader, const se3di_node *node, state_values *v)
{
    const bool limited = se3di_node_get(node, "lower") || se3di_node_get(node, "upper");
    if (se3di_node_get(node, "kd") && !se3di_node_get(node, "filter_time")) {
        return se3di_reader_fail_key(reader, node, "filter_time",
                                     "is missing, must be a number > 0 [s] where there is a `kd`");
    }
    if (!(v->lower < v->upper)) {
        return se3di_reader_fail_key(reader, node, "lower", "is %g, must be below `upper` = %g",
                                     v->lower, v->upper);
    }
    if (!limited || se3di_node_get(node, "tracking_time") || !(fabs(v->ki) > 0.0)) {
        return true;
    }
    const double square = v->kd / v->ki;
    v->tracking_time = square > 0.0 && isfinite(square) ? sqrt(square) : v->kp / v->ki;
    return (v->tracking_time > 0.0 && isfinite(v->tracking_time)) ||
           se3di_reader_fail_key(reader, node, "tracking_time",
                                 "is missing, must be a number > 0 [s]: kp and ki tell none");
}

/* I' = ki u + (y - w) / Tt, x2' = (u - x2) / T, w = kp u + I + kd (u - x2) / T, y = w in its
 * limits. */
static bool read_pid(se3di_reader *reader, const se3di_node *node, const se3di_element_entry *entry,
                     state_values *v)
{
    char sum[5 * TERM_SIZE] = "";
    char least[7 * TERM_SIZE];
    char output[9 * TERM_SIZE];
    char rate[20 * TERM_SIZE] = "";
    char number[SE3DI_NUMBER_SIZE];
    const bool is_limited = isfinite(v->lower) || isfinite(v->upper);
    if (!check_pid(reader, node, v)) {
        return false;
    }
    const bool filters = entry->order > 1;
    add_term(sum, sizeof sum, filters ? v->kp + v->kd / v->filter_time : v->kp, "u");
    add_term(sum, sizeof sum, 1.0, "x1");
    if (filters) {
        char filter[3 * TERM_SIZE] = "";
        add_term(sum, sizeof sum, -v->kd / v->filter_time, "x2");
        add_term(filter, sizeof filter, 1.0 / v->filter_time, "u");
        add_term(filter, sizeof filter, -1.0 / v->filter_time, "x2");
        if (!set_rate(reader, node, entry, 1, filter)) {
            return false;
        }
    }
    (void)se3di_number_format(v->upper, number);
    snprintf(least, sizeof least, isfinite(v->upper) ? "min(%s,%s)" : "%s", sum, number);
    (void)se3di_number_format(v->lower, number);
    snprintf(output, sizeof output, isfinite(v->lower) ? "max(%s,%s)" : "%s", least, number);
    add_term(rate, sizeof rate, v->ki, "u");
    if (is_limited && v->ki != 0.0) {
        const size_t used = strlen(rate);
        (void)se3di_number_format(v->tracking_time, number);
        snprintf(rate + used, sizeof rate - used, "+(%s-(%s))/%s", output, sum, number);
    }
    return set_output(reader, node, entry, output) &&
           set_rate(reader, node, entry, 0, rate[0] ? rate : "0*u");
}

/* Output and input of an ode, which it may have. */
static bool read_parts(se3di_reader *reader, const se3di_element_entry *entry)
{
    const se3di_node *node = entry->node;
    se3d_function function;
    if (se3di_node_get(node, "input") && !set_input(reader, node, entry)) {
        return false;
    }
    return !se3di_node_get(node, "output") ||
           (read_law(reader, node, "output", &function) &&
            fail_system(reader, node,
                        se3d_state_set_output(reader->system, entry->states[0], function)));
}

static bool read_dependence(se3di_reader *reader, const se3di_element_entry *entry)
{
    const se3di_node *node = entry->node;
    const char *type = se3di_node_get(node, "type")->text;
    state_values v = {.gain = 1.0, .lower = -HUGE_VAL, .upper = HUGE_VAL};
    se3d_function function;
    if (strcmp(type, "ode") == 0) {
        return read_law(reader, node, "rate", &function) &&
               fail_system(reader, node,
                           se3d_state_set_rate(reader->system, entry->states[0], function)) &&
               read_parts(reader, entry);
    }
    if (!se3di_read_fields(reader, node, &se3di_object_state, type, "state_values", &v) ||
        !set_input(reader, node, entry)) {
        return false;
    }
    if (strcmp(type, "pid") == 0) {
        return read_pid(reader, node, entry, &v);
    }
    return strcmp(type, "transfer") == 0 ? read_transfer(reader, node, entry)
                                         : read_lag(reader, node, entry, &v);
}

bool se3di_read_state_laws(se3di_reader *reader)
{
    const se3d_model *model = reader->model;
    bool good = true;
    for (size_t k = 0; k < model->element_count && good; ++k) {
        if (model->elements[k].kind == SE3DI_ELEMENT_STATE) {
            se3di_reader_enter(reader, model->elements[k].part);
            good = read_dependence(reader, &model->elements[k]);
        }
    }
    se3di_reader_enter(reader, model->parts);
    return good;
}
