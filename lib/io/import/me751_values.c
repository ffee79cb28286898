/* SPDX-License-Identifier: BSD-3-Clause */
/* ME751: members by their many names, numbers, bodies and functions of time. */
#include <math.h>
#include <string.h>

#include "io/import/me751.h"
#include "io/import/scan.h"
#include "se3d/expression.h"

const se3di_me751_member se3di_me751_body_names[2] = {{{"body1", "bodyi", "i"}},
                                                      {{"body2", "bodyj", "j"}}};
const se3di_me751_member se3di_me751_direction_names[2] = {
    {{"aibar", "ai", "abari", "a1", "a1bar", "ap1"}},
    {{"ajbar", "aj", "abarj", "a2", "a2bar", "ap2"}}};
const se3di_me751_member se3di_me751_point_names[2] = {
    {{"spibar", "si", "sbari", "s1", "sibar", "spi", "s1bar", "sp1"}},
    {{"sqjbar", "sj", "sbarj", "s2", "sjbar", "sqj", "s2bar", "sp2"}}};
const se3di_me751_member se3di_me751_value_names = {{"fun", "f", "function"}};
static const se3di_me751_member value_rate_names[2] = {{{"df", "fdot", "ft"}},
                                                       {{"ddf", "fddot", "ftt"}}};

void se3di_me751_plain_text(const char *text, char plain[SE3DI_ME751_KEY_MAX])
{
    size_t used = 0;
    for (; *text && used + 1 < SE3DI_ME751_KEY_MAX; ++text) {
        const bool is_upper = *text >= 'A' && *text <= 'Z';
        if (is_upper || (*text >= 'a' && *text <= 'z') || (*text >= '0' && *text <= '9')) {
            plain[used++] = (char)(is_upper ? *text - 'A' + 'a' : *text);
        }
    }
    plain[used] = '\0';
}

const se3di_node *se3di_me751_find(const se3di_node *map, const se3di_me751_member *wanted)
{
    for (const se3di_node *at = map->first; at && map->kind == SE3DI_NODE_MAP; at = at->next) {
        char plain[SE3DI_ME751_KEY_MAX];
        se3di_me751_plain_text(at->key, plain);
        for (size_t k = 0; k < SE3DI_ME751_NAMES_MAX && wanted->names[k]; ++k) {
            if (strcmp(plain, wanted->names[k]) == 0) {
                return at;
            }
        }
    }
    return NULL;
}

bool se3di_me751_expect(se3di_machine *m, const se3di_node *node, const char *what)
{
    char path[200];
    se3di_node_format_path(node, path, sizeof path);
    return se3di_machine_fail(m, node->line, node->column, "%s must be %s", path, what);
}

bool se3di_me751_read_number(se3di_machine *m, const se3di_node *node, double *value)
{
    const char *text = node->kind == SE3DI_NODE_SCALAR ? node->text : "";
    const size_t length = se3di_scan_number(text, false, value);
    return (length > 0 && !text[length]) || se3di_me751_expect(m, node, "a number of at most 1e40");
}

bool se3di_me751_read_numbers(se3di_machine *m, const se3di_node *node, double *values,
                              size_t count)
{
    if (node->kind != SE3DI_NODE_LIST || node->count != count) {
        char what[40] = "0 numbers";
        what[0] = (char)('0' + count % 10);
        return se3di_me751_expect(m, node, what);
    }
    for (const se3di_node *at = node->first; at; at = at->next) {
        if (!se3di_me751_read_number(m, at, values++)) {
            return false;
        }
    }
    return true;
}

bool se3di_me751_read_member(se3di_machine *m, const se3di_node *map,
                             const se3di_me751_member *wanted, double *values, size_t count)
{
    const se3di_node *node = se3di_me751_find(map, wanted);
    return !node || se3di_me751_read_numbers(m, node, values, count);
}

const char *se3di_me751_text_of(const se3di_node *node)
{
    return node && node->kind == SE3DI_NODE_SCALAR ? node->text : NULL;
}

bool se3di_me751_find_body(se3di_me751_reader *r, const se3di_node *map,
                           const se3di_me751_member *wanted, size_t *body)
{
    const se3di_node *node = se3di_me751_find(map, wanted);
    const char *id = se3di_me751_text_of(node);
    if (!id) {
        return se3di_machine_fail(r->m, map->line, map->column, "this has no member `%s`",
                                  wanted->names[0]);
    }
    size_t index = 0;
    if (se3di_ionames_find(&r->ids, id, &index)) {
        *body = r->bodies[index];
        return true;
    }
    *body = SE3DI_GROUND;
    return se3di_scan_equal(id, "ground") || strcmp(id, "0") == 0 ||
           se3di_machine_fail(r->m, node->line, node->column, "there is no body %.60s", id);
}

const char *se3di_me751_expression_of(se3di_machine *m, const char *text)
{
    static const char *const heads[] = {"@(t)", "lambda t:", "np.", "numpy.", "math.", "()"};
    char *out = se3di_iopool_array(m->pool, strlen(text) + 1, 1);
    size_t used = 0;
    while (out && *text) {
        size_t skip = 0;
        for (size_t k = 0; k < sizeof heads / sizeof *heads; ++k) {
            const size_t length = strlen(heads[k]);
            skip = skip == 0 && strncmp(text, heads[k], length) == 0 ? length : skip;
        }
        if (skip == 0 && (*text == '.' && text[1] && strchr("*/^", text[1]))) {
            skip = 1;
        }
        if (skip == 0 && text[0] == '*' && text[1] == '*') {
            out[used++] = '^';
            skip = 2;
        } else if (skip == 0) {
            out[used++] = *text;
            skip = 1;
        }
        text += skip;
    }
    if (!out) {
        se3di_machine_fail_memory(m);
    }
    return out;
}

bool se3di_me751_compiles(const char *text)
{
    static const char *const time[] = {"t"};
    se3d_expression_def def = se3d_expression_def_default();
    se3d_expression *expression = NULL;
    def.text = text;
    def.variables = time;
    def.variable_count = 1;
    const double start = 0.0;
    double value = 0.0;
    bool good = !SE3D_FAILED(se3d_expression_create(&def, &expression, NULL));
    if (se3d_expression_is_constant(expression)) { /* may be larger than a model takes */
        good = !SE3D_FAILED(se3d_expression_eval(expression, &start, &value)) &&
               fabs(value) <= SE3DI_SCAN_LARGEST;
    }
    se3d_expression_destroy(expression);
    return good;
}

bool se3di_me751_read_value(se3di_machine *m, const se3di_node *map, const char *name,
                            const char **value)
{
    const se3di_node *node = se3di_me751_find(map, &se3di_me751_value_names);
    const char *text = se3di_me751_text_of(node);
    double f = 0.0;
    double rates[2] = {0.0, 0.0};
    *value = NULL;
    if (!node || (text && (!text[0] || se3di_scan_equal(text, "none")))) {
        return true;
    }
    if (!text) {
        return se3di_me751_expect(m, node, "a number or a function of t");
    }
    const size_t length = se3di_scan_number(text, false, &f);
    if (length == 0 || text[length]) {
        const char *expression = se3di_me751_expression_of(m, text);
        if (expression && !se3di_me751_compiles(expression)) {
            se3di_machine_note_of(m, SE3D_IMPORT_LOST, node->line,
                                  "the function `%.100s` of `%.80s` is no expression in t: it is 0",
                                  text, name);
            return true;
        }
        *value = expression ? se3di_machine_quote(m, expression) : NULL;
        return m->status >= 0;
    }
    for (int k = 0; k < 2; ++k) {
        const se3di_node *rate = se3di_me751_find(map, &value_rate_names[k]);
        if (rate && !se3di_me751_read_number(m, rate, &rates[k])) {
            return false;
        }
    }
    const bool moves = rates[0] != 0.0 || rates[1] != 0.0;
    const char *number = se3di_machine_number(m, f);
    *value = moves ? se3di_machine_text(m, "'%s + (%s)*t + (%s)/2*t^2'", number,
                                        se3di_machine_number(m, rates[0]),
                                        se3di_machine_number(m, rates[1]))
                   : number;
    return m->status >= 0;
}

bool se3di_me751_lose(se3di_machine *m, const se3di_node *node, const char *why)
{
    char path[200];
    se3di_node_format_path(node, path, sizeof path);
    se3di_machine_note_of(m, SE3D_IMPORT_LOST, node->line, "`%.120s` is not carried: %s", path,
                          why);
    return m->status >= 0;
}

bool se3di_me751_put_vector(se3di_machine *m, const se3di_node *map,
                            const se3di_me751_member *wanted, const char *key, bool needed,
                            se3di_entry *entry)
{
    double v[3] = {0.0, 0.0, 0.0};
    if (needed && !se3di_me751_find(map, wanted)) {
        return se3di_machine_fail(m, map->line, map->column, "this has no member `%s`",
                                  wanted->names[0]);
    }
    if (!se3di_me751_read_member(m, map, wanted, v, 3)) {
        return false;
    }
    if (needed && !(se3di_length(v) > 0.0)) {
        return se3di_me751_expect(m, se3di_me751_find(map, wanted), "a direction that is not 0");
    }
    se3di_entry_put_vector(m, entry, key, v);
    return m->status >= 0;
}
