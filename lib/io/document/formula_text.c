/* SPDX-License-Identifier: BSD-3-Clause */
/* Texts for the compiler of the core. */
#include "io/document/formula_text.h"

#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "io/base/number.h"
#include "io/base/pool.h"
#include "math/over.h"

bool se3di_formula_fail(se3di_formula *f, const char *place, const char *format, ...)
{
    char text[480];
    se3di_node node = *f->node;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    const uintptr_t from = (uintptr_t)f->text;
    const uintptr_t at = (uintptr_t)place; /* of another text: of a function made of others */
    if (node.one_line && at >= from && at - from <= strlen(f->text)) {
        node.column += (size_t)(at - from) + (node.plain ? 0 : 1);
    }
    const char *written = f->reader->measured.written;
    const bool same = written && strlen(written) == strlen(f->text);
    return se3di_reader_fail(f->reader, &node, "`%.120s`: %s", same ? written : f->text, text);
}

se3di_amount se3di_formula_part(const se3di_amount *a, size_t k)
{
    se3di_amount part = *a;
    part.rank = 1;
    part.v[0] = a->v[k];
    part.text[0] = a->text[k];
    part.text[1] = part.text[2] = NULL;
    return part;
}

/* An operand: its text, or the number with all its digits. */
static const char *operand(const se3di_amount *a, char number[SE3DI_NUMBER_SIZE])
{
    if (a->text[0]) {
        return a->text[0];
    }
    number[se3di_number_format(a->v[0], number)] = '\0';
    return number;
}

static char *new_text(se3di_formula *f, size_t length)
{
    if (length > SE3D_EXPRESSION_TEXT_MAX) {
        se3di_formula_fail(f, f->text,
                           "the function is too long with its vectors written out: "
                           "more than %d characters",
                           SE3D_EXPRESSION_TEXT_MAX);
        return NULL;
    }
    char *text = se3di_iopool_array(f->reader->pool, length + 1, 1);
    if (!text) {
        se3di_reader_fail_memory(f->reader);
    }
    return text;
}

bool se3di_formula_join(se3di_formula *f, const char *mark, const se3di_amount *a,
                        const se3di_amount *b, se3di_amount *out)
{
    const double x = a->v[0];
    const double y = b->v[0];
    if (!a->text[0] && !b->text[0]) {
        *out = (se3di_amount){.rank = 1};
        out->v[0] = *mark == '+'   ? x + y
                    : *mark == '-' ? x - y
                    : *mark == '*' ? x * y
                                   : se3di_over(x, y);
        return true;
    }
    char left[SE3DI_NUMBER_SIZE];
    char right[SE3DI_NUMBER_SIZE];
    const char *l = operand(a, left);
    const char *r = operand(b, right);
    const size_t length = strlen(l) + strlen(r) + 7;
    char *text = new_text(f, length);
    if (!text) {
        return false;
    }
    snprintf(text, length + 1, "((%s)%s(%s))", l, mark, r);
    *out = (se3di_amount){.rank = 1, .text = {text}};
    return true;
}

bool se3di_formula_compile(se3di_formula *f, const char *place, const char *text,
                           const se3d_expression_symbol *symbols, size_t count, se3di_amount *out)
{
    se3d_expression_def def = se3d_expression_def_default();
    se3d_expression *expression = NULL;
    se3d_expression_error why;
    def.text = text;
    def.symbols = symbols;
    def.symbol_count = count;
    def.allocator = se3di_iopool_lend(f->reader->pool);
    const se3d_status status = se3d_expression_create(&def, &expression, &why);
    if (status == SE3D_ERR_NO_MEMORY) {
        return se3di_reader_fail_memory(f->reader);
    }
    if (status < 0) {
        return se3di_formula_fail(f, place, "%s", why.message);
    }
    double value = 0.0;
    const se3d_status done = se3d_expression_eval(expression, NULL, &value);
    se3d_expression_destroy(expression);
    if (done < 0) {
        return se3di_formula_fail(f, place, "is %g, must be a finite number", value);
    }
    out->rank = 1;
    out->v[0] = value;
    out->text[0] = out->text[1] = out->text[2] = NULL;
    return true;
}

/* Constants become symbols, so that they keep their bits. */
static bool apply_constants(se3di_formula *f, const char *place, const char *const pieces[3],
                            const se3di_amount *arguments, size_t count, se3di_amount *out)
{
    static const char *const names[SE3DI_FORMULA_ARGUMENTS] = {
        "a0", "a1", "a2",  "a3",  "a4",  "a5",  "a6",  "a7",
        "a8", "a9", "a10", "a11", "a12", "a13", "a14", "a15"};
    se3d_expression_symbol symbols[SE3DI_FORMULA_ARGUMENTS];
    char text[300];
    size_t used = (size_t)snprintf(text, sizeof text, "%.100s", pieces[0]);
    for (size_t k = 0; k < count; ++k) {
        symbols[k] = (se3d_expression_symbol){names[k], arguments[k].v[0]};
        used += (size_t)snprintf(text + used, sizeof text - used, "%s%s", k > 0 ? pieces[1] : "",
                                 names[k]);
    }
    snprintf(text + used, sizeof text - used, "%s", pieces[2]);
    return se3di_formula_compile(f, place, text, symbols, count, out);
}

bool se3di_formula_apply(se3di_formula *f, const char *place, const char *const pieces[3],
                         const se3di_amount *arguments, size_t count, se3di_amount *out)
{
    size_t length = strlen(pieces[0]) + strlen(pieces[2]) + 2;
    bool constant = true;
    for (size_t k = 0; k < count; ++k) {
        const char *text = arguments[k].text[0];
        constant = constant && !text;
        length += (text ? strlen(text) : SE3DI_NUMBER_SIZE) + strlen(pieces[1]) + 2;
    }
    if (constant) {
        return apply_constants(f, place, pieces, arguments, count, out);
    }
    char *text = new_text(f, length);
    if (!text) {
        return false;
    }
    size_t used = (size_t)snprintf(text, length + 1, "(%s", pieces[0]);
    for (size_t k = 0; k < count; ++k) {
        char number[SE3DI_NUMBER_SIZE];
        used += (size_t)snprintf(text + used, length + 1 - used, "%s(%s)", k > 0 ? pieces[1] : "",
                                 operand(&arguments[k], number));
    }
    snprintf(text + used, length + 1 - used, "%s)", pieces[2]);
    out->rank = 1;
    out->text[0] = text;
    out->text[1] = out->text[2] = NULL;
    return true;
}
