/* SPDX-License-Identifier: BSD-3-Clause */
/* `optimize` of a study: parameters within bounds, a measure that is to be the least or the
 * greatest, measures that are limited. */
#include "io/read/study_goal.h"

#include <math.h>
#include <string.h>

#include "io/base/pool.h"
#include "io/document/document.h"
#include "io/document/fields.h"
#include "io/document/guess.h"
#include "io/document/value.h"
#include "io/model/model.h"
#include "io/read/objects.h"
#include "io/read/study_values.h"

enum { UNKNOWNS_MAX = 200 };
#define EVALUATIONS_MAX 1e7

enum { COBYLA, BOBYQA, SLSQP, MMA, CRS, DIRECT, ISRES };
static const char *const methods[] = {
    [COBYLA] = "cobyla", [BOBYQA] = "bobyqa", [SLSQP] = "slsqp", [MMA] = "mma",
    [CRS] = "crs",       [DIRECT] = "direct", [ISRES] = "isres", NULL};

/* clang-format off */
static const se3di_key goal_keys[] = {
    {"parameters", SE3DI_KIND_PARTS, .object = "unknown", .required = true,
     .text = "which parameters of the model are sought, and between what: {k: {from: 1, to: 2}}"},
    {"minimize", SE3DI_KIND_TEXT, .text = "the measure that is to be the least"},
    {"maximize", SE3DI_KIND_TEXT, .text = "in its place: the measure that is to be the greatest"},
    {"constraints", SE3DI_KIND_PARTS, .object = "limit",
     .text = "measures that are limited: {stroke: {to: 0.03}}"},
    {"method", SE3DI_KIND_WORD, SE3DI_INTO(se3di_study_goal, method), .words = methods,
     .standard = "cobyla",
     .text = "cobyla: linear models, no derivatives, any constraints; bobyqa: quadratic models, no "
         "constraints; slsqp: quadratic programs with derivatives, any constraints; mma: with "
         "derivatives, many parameters, no equal ones; crs, direct: global, no constraints; "
         "isres: global, any constraints"},
    {"evaluations", SE3DI_KIND_COUNT, .most = EVALUATIONS_MAX, .standard = "1000",
     .text = "how often the measures are asked for at most; derivatives are not counted"},
    {"tolerance", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3di_study_goal, tolerance),
     .standard = "1e-5",
     .text = "it ends when steps of all parameters are below this share of from ... to"},
    {.key = NULL}};
const se3di_object se3di_object_goal = {
    "goal",
    "Parameters for which a measure is the least or the greatest.",
    goal_keys, NULL,
    "\"oneOf\": [{\"required\": [\"minimize\"]}, {\"required\": [\"maximize\"]}]"};

static const se3di_key unknown_keys[] = {
    {"from", SE3DI_KIND_NUMBER, .required = true,
     .text = "least value, in the unit of the parameter"},
    {"to", SE3DI_KIND_NUMBER, .required = true, .text = "greatest value"},
    {"start", SE3DI_KIND_NUMBER, .standard = "the value in the model",
     .text = "the search begins there"},
    {.key = NULL}};
const se3di_object se3di_object_unknown = {
    "unknown",
    "A parameter that is sought.",
    unknown_keys, NULL,
    NULL};

static const se3di_key limit_keys[] = {
    {"from", SE3DI_KIND_NUMBER, .text = "least value, in the unit of the measure"},
    {"to", SE3DI_KIND_NUMBER, .text = "greatest value"},
    {"equal", SE3DI_KIND_NUMBER, .text = "in their place: the only value"},
    {.key = NULL}};
const se3di_object se3di_object_limit = {
    "limit",
    "What a measure may be.",
    limit_keys, NULL,
    "\"anyOf\": [{\"required\": [\"from\"]}, {\"required\": [\"to\"]}, {\"required\": "
    "[\"equal\"]}]"};
/* clang-format on */

const char *se3di_study_goal_get_method(int32_t method)
{
    const int32_t count = (int32_t)(sizeof methods / sizeof *methods) - 1;
    return method >= 0 && method < count ? methods[method] : "";
}

static bool find_measure(se3di_reader *reader, const se3di_node *place, const char *name,
                         const se3di_study_entry *entry, size_t *index)
{
    se3di_guess guess = se3di_guess_begin(name);
    for (size_t k = 0; k < entry->measure_count; ++k) {
        if (strcmp(entry->measures[k].name, name) == 0) {
            *index = k;
            return true;
        }
        se3di_guess_offer(&guess, entry->measures[k].name);
    }
    const char *meant = se3di_guess_get(&guess);
    return se3di_reader_fail(reader, place, "no measure is named `%.60s`%s%s%s", name,
                             meant ? ", did you mean `" : "; list it under `measures`",
                             meant ? meant : "", meant ? "`?" : "");
}

static bool check_map(se3di_reader *reader, const se3di_node *map, size_t most, const char *like)
{
    return (map->kind == SE3DI_NODE_MAP && map->count > 0 && map->count <= most) ||
           se3di_reader_fail(reader, map, "is %s, must be a map of 1 to %zu such as %s",
                             map->kind != SE3DI_NODE_MAP ? se3di_node_describe(map)
                             : map->count == 0           ? "empty"
                                                         : "too long",
                             most, like);
}

/* ---- parameters ------------------------------------------------------------------------------*/

static bool read_unknown(se3di_reader *reader, const se3di_node *node, se3di_study_unknown *u)
{
    static const char *const keys[3] = {"from", "to", "start"};
    u->name = node->key;
    if (!se3di_check_study_parameter(reader, node, node->key) ||
        !se3di_read_keys(reader, node, &se3di_object_unknown)) {
        return false;
    }
    const se3di_amount own = *se3di_scope_find(reader->scope, node->key);
    se3di_amount values[3] = {own, own, own};
    for (size_t k = 0; k < 2; ++k) {
        if (!se3di_node_get(node, keys[k])) {
            return se3di_reader_fail_key(reader, node, keys[k], "is missing");
        }
    }
    if (!se3di_read_study_amounts(reader, node, keys, 3, values)) {
        return false;
    }
    u->from = values[0].v[0];
    u->to = values[1].v[0];
    u->start = values[2].v[0];
    u->shape = values[0];
    if (!(u->from < u->to)) {
        return se3di_reader_fail(reader, node, "goes from %g to %g, `from` must be less", u->from,
                                 u->to);
    }
    return (u->start >= u->from && u->start <= u->to) ||
           se3di_reader_fail_key(reader, node, "start",
                                 "is %g, must be from %g to %g; without it, it is the value in the "
                                 "model",
                                 u->start, u->from, u->to);
}

static bool read_unknowns(se3di_reader *reader, const se3di_node *map, se3di_study_goal *goal)
{
    if (!check_map(reader, map, UNKNOWNS_MAX, "{k: {from: 1, to: 2}}")) {
        return false;
    }
    goal->unknowns = se3di_iopool_array(reader->pool, map->count, sizeof *goal->unknowns);
    if (!goal->unknowns) {
        return se3di_reader_fail_memory(reader);
    }
    for (const se3di_node *node = map->first; node; node = node->next) {
        if (!read_unknown(reader, node, &goal->unknowns[goal->unknown_count++])) {
            return false;
        }
    }
    return true;
}

/* ---- constraints -----------------------------------------------------------------------------*/

static bool read_limit(se3di_reader *reader, const se3di_node *node, const se3di_study_entry *entry,
                       se3di_study_limit *limit)
{
    double equal = (double)NAN;
    limit->from = -HUGE_VAL;
    limit->to = HUGE_VAL;
    if (!find_measure(reader, node, node->key, entry, &limit->measure) ||
        !se3di_read_keys(reader, node, &se3di_object_limit)) {
        return false;
    }
    reader->alternative = -1; /* the unit of the measure, whatever that is */
    if (!se3di_read_key(reader, node, &se3di_object_limit, NULL, "from", &limit->from) ||
        !se3di_read_key(reader, node, &se3di_object_limit, NULL, "to", &limit->to) ||
        !se3di_read_key(reader, node, &se3di_object_limit, NULL, "equal", &equal)) {
        return false;
    }
    const bool has_range = limit->from > -HUGE_VAL || limit->to < HUGE_VAL;
    if (has_range == !isnan(equal)) {
        return se3di_reader_fail(reader, node, "must have `from`, `to` or both, or `equal`");
    }
    if (!has_range) {
        limit->from = limit->to = equal;
    }
    return limit->from < limit->to || !has_range ||
           se3di_reader_fail(reader, node, "goes from %g to %g, `from` must be less", limit->from,
                             limit->to);
}

/* What a method can do with limits. */
static bool check_limit(se3di_reader *reader, const se3di_node *node, const se3di_study_goal *goal,
                        const se3di_study_limit *limit)
{
    const bool takes = goal->method == COBYLA || goal->method == SLSQP || goal->method == ISRES;
    const bool is_equal = !(limit->from < limit->to);
    if (goal->method == MMA && is_equal) {
        return se3di_reader_fail(reader, node,
                                 "mma has no constraints with `equal`: give the "
                                 "`method` slsqp, cobyla or isres");
    }
    return takes || goal->method == MMA ||
           se3di_reader_fail(reader, node,
                             "%s has no constraints: give the `method` cobyla, slsqp, "
                             "mma or isres",
                             methods[goal->method]);
}

static bool read_limits(se3di_reader *reader, const se3di_node *map, const se3di_study_entry *entry,
                        se3di_study_goal *goal)
{
    if (!check_map(reader, map, SE3DI_STUDY_MEASURES_MAX, "{stroke: {to: 0.03}}")) {
        return false;
    }
    goal->limits = se3di_iopool_array(reader->pool, map->count, sizeof *goal->limits);
    if (!goal->limits) {
        return se3di_reader_fail_memory(reader);
    }
    for (const se3di_node *node = map->first; node; node = node->next) {
        se3di_study_limit *limit = &goal->limits[goal->limit_count++];
        if (!read_limit(reader, node, entry, limit) || !check_limit(reader, node, goal, limit)) {
            return false;
        }
    }
    return true;
}

/* ---- the whole -------------------------------------------------------------------------------*/

static bool read_aim(se3di_reader *reader, const se3di_node *map, const se3di_study_entry *entry,
                     se3di_study_goal *goal)
{
    const se3di_node *least = se3di_node_get(map, "minimize");
    const se3di_node *greatest = se3di_node_get(map, "maximize");
    const se3di_node *node = least ? least : greatest;
    const char *name = NULL;
    if (!least == !greatest) {
        return se3di_reader_fail(reader, map, "must have `minimize` or `maximize`, one of them");
    }
    goal->greatest = greatest != NULL;
    return se3di_read_text(reader, node, &name) &&
           find_measure(reader, node, name, entry, &goal->measure);
}

bool se3di_read_study_goal(se3di_reader *reader, const se3di_node *map, se3di_study_entry *entry)
{
    const se3di_object *object = &se3di_object_goal;
    if (!map || se3di_node_is_null(map)) {
        return true;
    }
    se3di_study_goal *goal = se3di_iopool_alloc(reader->pool, sizeof *goal);
    if (!goal) {
        return se3di_reader_fail_memory(reader);
    }
    goal->evaluations = 1000.0;
    goal->tolerance = 1e-5;
    if (!se3di_read_keys(reader, map, object) ||
        !se3di_read_fields(reader, map, object, NULL, "se3di_study_goal", goal) ||
        !se3di_read_key(reader, map, object, NULL, "evaluations", &goal->evaluations) ||
        !read_aim(reader, map, entry, goal)) {
        return false;
    }
    const se3di_node *parameters = se3di_node_get(map, "parameters");
    const se3di_node *limits = se3di_node_get(map, "constraints");
    if (!parameters) {
        return se3di_reader_fail_key(reader, map, "parameters",
                                     "is missing: which are sought? {k: {from: 1, to: 2}}");
    }
    if (!(goal->evaluations > 0.0)) {
        return se3di_reader_fail_key(reader, map, "evaluations", "is 0, must be at least 1");
    }
    entry->goal = goal;
    return read_unknowns(reader, parameters, goal) &&
           (!limits || read_limits(reader, limits, entry, goal));
}
