/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbers (expressions over the parameters), vectors, orientations and functions. */
#include "io/document/value.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/base/elementary.h"
#include "io/base/number.h"
#include "io/base/rotation.h"
#include "io/document/amount.h"
#include "io/document/document.h"
#include "io/document/guess.h"
#include "io/document/reader.h"
#include "math/vec3.h"

/* Beyond these the squares and products of mechanics leave what doubles hold. */
#define LARGEST  1e40
#define SMALLEST 1e-40

static const char *const range_texts[] = {"finite", "finite and > 0", "finite and >= 0"};

/* The identifier that begins at `text`, in `word`. */
static bool identifier_at(const char *text, char *word, size_t size)
{
    size_t length = 0;
    while (length + 1 < size &&
           (text[length] == '_' || (text[length] >= '0' && text[length] <= '9') ||
            (text[length] >= 'a' && text[length] <= 'z') ||
            (text[length] >= 'A' && text[length] <= 'Z'))) {
        word[length] = text[length];
        ++length;
    }
    word[length] = '\0';
    return se3di_text_is_identifier(word);
}

/* What the name at the error was meant to be, among the parameters and variables. */
static const char *guess_symbol(const se3d_expression_def *def, size_t column, char word[64])
{
    if (column == 0 || column > strlen(def->text) ||
        !identifier_at(def->text + column - 1, word, 64)) {
        return NULL;
    }
    se3di_guess guess = se3di_guess_begin(word);
    for (size_t k = 0; k < def->symbol_count; ++k) {
        se3di_guess_offer(&guess, def->symbols[k].name);
    }
    for (size_t k = 0; k < def->variable_count; ++k) {
        se3di_guess_offer(&guess, def->variables[k]);
    }
    return guess.distance > 0 ? se3di_guess_get(&guess) : NULL;
}

/* A plain text in a flow list or map ends at a comma: hypot(a, b) becomes two values. */
static bool is_cut(const se3di_node *node)
{
    int open = 0;
    for (const char *c = node->text; *c; ++c) {
        open += (*c == '(') - (*c == ')');
    }
    return node->plain && open != 0;
}

static bool fail_expression(se3di_reader *reader, const se3di_node *node,
                            const se3d_expression_def *def, const se3d_expression_error *why)
{
    char word[64];
    char hint[96] = "";
    const char *other = NULL; /* what the expression itself takes it for */
    se3di_node place = *node;
    const char *meant = guess_symbol(def, why->column, word);
    if (is_cut(node)) {
        snprintf(hint, sizeof hint,
                 " (inside [ ] and { } an expression with a comma needs quotes)");
    } else if (meant) {
        snprintf(hint, sizeof hint, ", did you mean `%.63s`?", meant);
        other = strstr(why->message, ", did you mean");
    }
    if (node->one_line && why->column > 0) {
        place.column += why->column - 1 + (node->plain ? 0 : 1);
    }
    const size_t length = other ? (size_t)(other - why->message) : strlen(why->message);
    return se3di_reader_fail(reader, &place, "`%.120s`: %.*s%s", node->text, (int)length,
                             why->message, hint);
}

bool se3di_check_expression(se3di_reader *reader, const se3di_node *node)
{
    if (node->kind != SE3DI_NODE_SCALAR || se3di_node_is_null(node)) {
        return se3di_reader_fail(reader, node, "is %s, must be a number or an expression",
                                 se3di_node_describe(node));
    }
    if (!se3di_check_whole(reader, node)) {
        return false;
    }
    static const char *const special[] = {".nan", ".NaN",  ".NAN",  "nan",      "NaN",      "NAN",
                                          ".inf", "-.inf", "+.inf", ".Inf",     "-.Inf",    ".INF",
                                          "inf",  "-inf",  "+inf",  "Infinity", "-Infinity"};
    const char first = node->text[strspn(node->text, "+-.")];
    const bool may_be = first && strchr("niNI", first);
    for (size_t k = 0; may_be && k < sizeof special / sizeof *special; ++k) {
        if (strcmp(node->text, special[k]) == 0) {
            return se3di_reader_fail(reader, node, "is %s, must be a finite number", node->text);
        }
    }
    return true;
}

bool se3di_read_compile(se3di_reader *reader, const se3di_node *node, se3d_expression_def *def,
                        se3d_expression **expression)
{
    se3d_expression_error why;
    if (!se3di_check_expression(reader, node)) {
        return false;
    }
    def->text = def->text ? def->text : node->text; /* the node's has names of channels */
    def->allocator = def->allocator ? def->allocator : se3di_iopool_lend(reader->pool);
    if (!def->symbols) {
        def->symbols = reader->scope->symbols;
        def->symbol_count = reader->scope->symbol_count;
    }
    const se3d_status status = se3d_expression_create(def, expression, &why);
    if (status == SE3D_ERR_NO_MEMORY) {
        return se3di_reader_fail_memory(reader);
    }
    return status < 0 ? fail_expression(reader, node, def, &why) : true;
}

bool se3di_read_constant(se3di_reader *reader, const se3di_node *node,
                         const se3d_expression *expression, double *value)
{
    static const double nowhere[SE3D_FUNCTION_VARIABLES_MAX] = {0.0};
    const se3d_status status = se3d_expression_eval(expression, nowhere, value);
    if (status < 0 || !isfinite(*value)) {
        return se3di_reader_fail(reader, node, "`%.120s` is %g, must be a finite number",
                                 node->text, *value);
    }
    return true;
}

/* Of a number, not of names such as `e` or `E1`, whose values may change. */
static bool is_literal(const char *text)
{
    double value;
    return se3di_number_parse(text, &value);
}

/* A number that is written out is compiled once, however often the tree is read. */
static void keep_number(const se3di_node *node, double value)
{
    se3di_node *kept = (se3di_node *)(uintptr_t)node; /* the tree is the reader's */
    kept->number = value;
    kept->number_text = node->text;
}

static bool read_plain(se3di_reader *reader, const se3di_node *node, double *value)
{
    if (node->number_text == node->text && node->text) {
        *value = node->number;
        return true;
    }
    se3d_expression_def def = se3d_expression_def_default();
    se3d_expression *expression = NULL;
    if (!se3di_read_compile(reader, node, &def, &expression)) {
        return false;
    }
    const bool good = se3di_read_constant(reader, node, expression, value);
    se3d_expression_destroy(expression);
    if (good && is_literal(node->text)) {
        *value = *value == 0.0 && node->text[0] == '-' ? -0.0 : *value; /* as it was written */
        keep_number(node, *value);
    }
    return good;
}

bool se3di_read_amount(se3di_reader *reader, const se3di_node *node, se3di_amount *value)
{
    if (!se3di_check_expression(reader, node)) {
        return false;
    }
    if (se3di_amount_is_needed(reader, node->text)) {
        return se3di_amount_eval(reader, node, NULL, value);
    }
    *value = (se3di_amount){.rank = 1};
    return read_plain(reader, node, &value->v[0]);
}

/* "-1", or "2*q = -1" if the text is not the number itself. */
static void format_value(const se3di_node *node, double value, char *text, size_t size)
{
    if (is_literal(node->text)) {
        snprintf(text, size, "%.60s", node->text);
    } else {
        snprintf(text, size, "%.120s = %g", node->text, value);
    }
}

bool se3di_check_number(se3di_reader *reader, const se3di_node *node, se3di_range range,
                        double value)
{
    if (fabs(value) > LARGEST || (range == SE3DI_POSITIVE && value > 0.0 && value < SMALLEST)) {
        char text[200];
        format_value(node, value, text, sizeof text);
        return se3di_reader_fail(reader, node, "is %s, must be %s%g in magnitude", text,
                                 fabs(value) > LARGEST ? "at most " : "at least ",
                                 fabs(value) > LARGEST ? LARGEST : SMALLEST);
    }
    if ((range == SE3DI_POSITIVE && !(value > 0.0)) ||
        (range == SE3DI_NOT_NEGATIVE && !(value >= 0.0))) {
        char text[200];
        format_value(node, value, text, sizeof text);
        return se3di_reader_fail(reader, node, "is %s, must be %s", text, range_texts[range]);
    }
    return true;
}

static bool read_single(se3di_reader *reader, const se3di_node *node, se3di_amount *q)
{
    return se3di_read_amount(reader, node, q) &&
           (q->rank == 1 ||
            se3di_reader_fail(reader, node, "`%.120s` is a vector, must be a number", node->text));
}

bool se3di_read_number(se3di_reader *reader, const se3di_node *node, se3di_range range,
                       double *value)
{
    se3di_amount q;
    if (!read_single(reader, node, &q) || !se3di_amount_take(reader, node, node, &q)) {
        return false;
    }
    *value = q.v[0];
    return se3di_check_number(reader, node, range, *value);
}

bool se3di_read_pair_of(se3di_reader *reader, const se3di_node *node, const char *variable,
                        const se3di_node *key, double pair[2])
{
    se3di_amount x;
    se3di_amount y;
    if (node->kind != SE3DI_NODE_LIST || node->count != 2) {
        return se3di_read_vector(reader, node, 2, pair); /* says why not */
    }
    if (!read_single(reader, node->first, &x) || !read_single(reader, node->last, &y) ||
        !(variable ? se3di_amount_take_variable(reader, node->first, variable, &x)
                   : se3di_amount_take(reader, node->first, key, &x)) ||
        (variable && !se3di_amount_take(reader, node->last, key, &y))) {
        return false;
    }
    pair[0] = x.v[0];
    pair[1] = y.v[0];
    return se3di_check_number(reader, node->first, SE3DI_ANY, pair[0]) &&
           se3di_check_number(reader, node->last, SE3DI_ANY, pair[1]);
}

bool se3di_read_key_number(se3di_reader *reader, const se3di_node *map, const char *key,
                           se3di_range range, double *value)
{
    const se3di_node *node = se3di_node_get(map, key);
    return !node || se3di_read_number(reader, node, range, value);
}

bool se3di_read_key_restitution(se3di_reader *reader, const se3di_node *map, double *value)
{
    double read = 1.0;
    if (!se3di_read_key_number(reader, map, "restitution", SE3DI_ANY, &read)) {
        return false;
    }
    if (!(read >= 0.01 && read <= 1.0)) {
        return se3di_reader_fail_key(reader, map, "restitution", "is %g, must be from 0.01 to 1",
                                     read);
    }
    if (se3di_node_get(map, "restitution")) {
        *value = read;
    }
    return true;
}

bool se3di_read_count(se3di_reader *reader, const se3di_node *node, double least, double largest,
                      double *value)
{
    if (!se3di_read_number(reader, node, SE3DI_ANY, value)) {
        return false;
    }
    return (*value >= least && *value <= largest && !(floor(*value) < *value)) ||
           se3di_reader_fail(reader, node, "is %g, must be a whole number from %g to %g", *value,
                             least, largest);
}

bool se3di_read_key_count(se3di_reader *reader, const se3di_node *map, const char *key,
                          double largest, double *value)
{
    const se3di_node *node = se3di_node_get(map, key);
    return !node || se3di_read_count(reader, node, 0.0, largest, value);
}

/* A point or vector in one text: its name, or an expression. */
static bool read_vector_text(se3di_reader *reader, const se3di_node *node, double value[3])
{
    se3di_amount q;
    if (!se3di_amount_eval(reader, node, NULL, &q)) {
        return false;
    }
    if (q.rank != 3) {
        return se3di_reader_fail(reader, node,
                                 "is a single value, must be a list of 3 numbers or a point");
    }
    if (!se3di_amount_take(reader, node, node, &q)) {
        return false;
    }
    for (size_t k = 0; k < 3; ++k) {
        if (!se3di_check_number(reader, node, SE3DI_ANY, q.v[k])) {
            return false;
        }
        value[k] = q.v[k];
    }
    return true;
}

bool se3di_read_vector(se3di_reader *reader, const se3di_node *node, size_t size, double *value)
{
    if (node->kind == SE3DI_NODE_SCALAR && size == 3 && !se3di_node_is_null(node)) {
        return read_vector_text(reader, node, value);
    }
    if (node->kind != SE3DI_NODE_LIST) {
        return se3di_reader_fail(reader, node, "is %s, must be a list of %zu numbers",
                                 se3di_node_describe(node), size);
    }
    if (node->count != size) {
        for (const se3di_node *child = node->first; child; child = child->next) {
            if (child->text && is_cut(child)) {
                return se3di_reader_fail(reader, child,
                                         "`%.80s` was cut at a comma: inside [ ] an expression "
                                         "with a comma needs quotes",
                                         child->text);
            }
        }
        return se3di_reader_fail(reader, node, "has %zu entries, must be a list of %zu numbers",
                                 node->count, size);
    }
    size_t k = 0;
    for (const se3di_node *child = node->first; child; child = child->next) {
        if (!se3di_read_number(reader, child, SE3DI_ANY, &value[k++])) {
            return false;
        }
    }
    return true;
}

bool se3di_read_key_vector(se3di_reader *reader, const se3di_node *map, const char *key,
                           double value[3])
{
    const se3di_node *node = se3di_node_get(map, key);
    return !node || se3di_read_vector(reader, node, 3, value);
}

static bool is_direction(const double v[3])
{
    const double length = io_hypot(io_hypot(v[0], v[1]), v[2]);
    return isfinite(length) && length > 1e-100;
}

bool se3di_read_key_direction(se3di_reader *reader, const se3di_node *map, const char *key,
                              double value[3])
{
    const se3di_node *node = se3di_node_get(map, key);
    if (!node) {
        return true;
    }
    if (!se3di_read_vector(reader, node, 3, value)) {
        return false;
    }
    if (!is_direction(value)) {
        return se3di_reader_fail(reader, node, "is [%g, %g, %g], must be a direction: not zero",
                                 value[0], value[1], value[2]);
    }
    return true;
}

/* clang-format off */
static const se3di_key orientation_keys[] = {
    {"matrix", SE3DI_KIND_MATRIX3,
     .text = "rotation matrix body -> ground, by rows; right-handed"},
    {"euler_parameters", SE3DI_KIND_EULER_PARAMETERS,
     .text = "unit Euler parameters e0 e1 e2 e3, scalar first"},
    {"axis", SE3DI_KIND_VECTOR, .text = "axis of the rotation, with angle"},
    {"angle", SE3DI_KIND_NUMBER, .text = "angle about axis [rad]"},
    {"rpy", SE3DI_KIND_VECTOR,
     .text = "roll about x, then pitch about y, then yaw about z, fixed axes [rad]"},
    {.key = NULL}};
const se3di_object se3di_object_orientation = {
    "orientation",
    "Exactly one way: matrix, euler_parameters, axis with angle, rpy.",
    orientation_keys, NULL,
    NULL};
/* clang-format on */

static bool read_matrix(se3di_reader *reader, const se3di_node *node, double p[4])
{
    double A[9]; /* row-major, body -> ground */
    if (node->kind != SE3DI_NODE_LIST || node->count != 3) {
        return se3di_reader_fail(reader, node, "must be a list of 3 rows of 3 numbers");
    }
    size_t row = 0;
    for (const se3di_node *child = node->first; child; child = child->next) {
        if (!se3di_read_vector(reader, child, 3, &A[3 * row++])) {
            return false;
        }
    }
    const double error = se3di_rotation_matrix_error(A);
    if (!(error <= 1e-6)) {
        return se3di_reader_fail(
            reader, node,
            "is not a rotation: A^T A differs from the identity by %.3g, its "
            "columns must be unit vectors perpendicular to each other (to 1e-6)",
            error);
    }
    if (se3di_rotation_matrix_determinant(A) < 0.0) {
        return se3di_reader_fail(reader, node,
                                 "is a reflection (determinant -1), must be right-handed: "
                                 "determinant 1");
    }
    se3di_rotation_from_matrix(A, p);
    return true;
}

static bool read_euler_parameters(se3di_reader *reader, const se3di_node *node, double p[4])
{
    if (!se3di_read_vector(reader, node, 4, p)) {
        return false;
    }
    const double length = io_hypot(io_hypot(p[0], p[1]), io_hypot(p[2], p[3]));
    if (!(fabs(length - 1.0) <= 1e-6)) {
        return se3di_reader_fail(
            reader, node, "has the length %.9g, must be unit Euler parameters (to 1e-6)", length);
    }
    const bool is_unit = se3di_is_unit(p, 4);
    for (int k = 0; k < 4 && !is_unit; ++k) {
        p[k] /= length;
    }
    return true;
}

static bool read_axis_angle(se3di_reader *reader, const se3di_node *map, double p[4])
{
    double axis[3] = {0.0, 0.0, 1.0};
    double angle = 0.0;
    if (!se3di_node_get(map, "axis") || !se3di_node_get(map, "angle")) {
        return se3di_reader_fail_key(reader, map, se3di_node_get(map, "axis") ? "angle" : "axis",
                                     "is missing, `axis` and `angle` go together");
    }
    if (!se3di_read_key_direction(reader, map, "axis", axis) ||
        !se3di_read_key_number(reader, map, "angle", SE3DI_ANY, &angle)) {
        return false;
    }
    se3di_rotation_from_axis(axis, angle, p);
    return true;
}

bool se3di_read_key_orientation(se3di_reader *reader, const se3di_node *map, double p[4])
{
    return se3di_read_orientation(reader, se3di_node_get(map, "orientation"), p);
}

bool se3di_read_orientation(se3di_reader *reader, const se3di_node *node, double p[4])
{
    if (!node) {
        return true;
    }
    if (!se3di_read_keys(reader, node, &se3di_object_orientation)) {
        return false;
    }
    const se3di_node *matrix = se3di_node_get(node, "matrix");
    const se3di_node *euler = se3di_node_get(node, "euler_parameters");
    const se3di_node *rpy = se3di_node_get(node, "rpy");
    const bool axis = se3di_node_get(node, "axis") || se3di_node_get(node, "angle");
    if ((matrix != NULL) + (euler != NULL) + (rpy != NULL) + axis != 1) {
        return se3di_reader_fail(reader, node,
                                 "must have exactly one of matrix, euler_parameters, axis with "
                                 "angle, rpy");
    }
    if (matrix) {
        return read_matrix(reader, matrix, p);
    }
    if (euler) {
        return read_euler_parameters(reader, euler, p);
    }
    if (rpy) {
        double angles[3];
        if (!se3di_read_vector(reader, rpy, 3, angles)) {
            return false;
        }
        se3di_rotation_from_rpy(angles, p);
        return true;
    }
    return read_axis_angle(reader, node, p);
}
