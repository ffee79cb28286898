/* SPDX-License-Identifier: BSD-3-Clause */
/* The grammar, each rule a function that emits the code of what it reads:
 *
 *     comparison = sum [("<" | "<=" | ">" | ">=" | "==" | "!=") sum]
 *     sum        = product {("+" | "-") product}
 *     product    = unary {("*" | "/") unary}
 *     unary      = {"+" | "-"} power
 *     power      = primary ["^" unary]
 *     primary    = number | name | name "(" comparison {"," comparison} ")" | "(" comparison ")"
 */
#include "expression/parser.h"

#include "base/error.h"
#include "expression/functions.h"
#include "expression/names.h"

#include <string.h>

typedef struct parser {
    const se3d_expression_def *def;
    se3di_program *program;
    se3di_lexer lexer;
    int depth;
} parser;

static se3d_status parse_comparison(parser *p, se3di_operand *out);
static se3d_status parse_unary(parser *p, se3di_operand *out);

static se3d_status next(parser *p)
{
    return se3di_lexer_next(&p->lexer);
}

static int at_mark(const parser *p, char mark)
{
    return p->lexer.token.mark == mark;
}

static se3d_status fail_unexpected(const parser *p, const char *expected)
{
    char text[SE3DI_TOKEN_TEXT_SIZE];
    se3di_token_describe(&p->lexer.token, text);
    return se3di_lexer_fail(&p->lexer, SE3D_ERR_EXPRESSION, p->lexer.token.start,
                            "unexpected %s, expected %s", text, expected);
}

static se3d_status enter(parser *p)
{
    if (p->depth >= SE3D_EXPRESSION_DEPTH_MAX) {
        return se3di_lexer_fail(&p->lexer, SE3D_ERR_EXPRESSION, p->lexer.token.start,
                                "nested too deeply, at most %d levels are allowed",
                                SE3D_EXPRESSION_DEPTH_MAX);
    }
    ++p->depth;
    return SE3D_OK;
}

/* Pass the status of an operation on, with a message if its constants have no finite result. */
static se3d_status check_finite(const parser *p, const se3di_token *token, se3d_status status)
{
    if (status != SE3D_ERR_NOT_FINITE) {
        return status;
    }
    const char *reason = token->mark == '/' ? ": division by zero" : "";
    char text[SE3DI_TOKEN_TEXT_SIZE];
    se3di_token_describe(token, text);
    return se3di_lexer_fail(&p->lexer, SE3D_ERR_EXPRESSION, token->start,
                            "the constant result of %s is not finite%s", text, reason);
}

static se3d_status parse_name(parser *p, se3di_operand *out)
{
    const se3di_token name = p->lexer.token;
    se3di_name found = se3di_name_find(p->def, name.start, name.length);
    if (found.kind == SE3DI_NAME_VARIABLE) {
        SE3DI_TRY(se3di_program_push_variable(p->program, found.index, out));
    } else if (found.kind == SE3DI_NAME_NUMBER) {
        SE3DI_TRY(se3di_program_push_constant(p->program, found.value, out));
    } else {
        size_t function = se3di_function_find(name.start, name.length);
        if (function != SE3DI_FUNCTION_NONE) {
            return se3di_lexer_fail(
                &p->lexer, SE3D_ERR_EXPRESSION, name.start, "'%s' is a function, expected %s",
                se3di_functions[function].name, se3di_functions[function].signature);
        }
        return se3di_name_fail(p->def, &p->lexer, &name, 0);
    }
    return next(p);
}

static se3d_status fail_count(const parser *p, const se3di_named_function *function,
                              const se3di_token *name, size_t count)
{
    unsigned least = function->min_arguments;
    return se3di_lexer_fail(&p->lexer, SE3D_ERR_EXPRESSION, name->start,
                            "%s takes %s%u argument%s, found %zu", function->signature,
                            function->max_arguments > least ? "at least " : "", least,
                            least == 1 ? "" : "s", count);
}

/* After argument number `count`: step over ',' or fail. */
static se3d_status pass_comma(parser *p, const se3di_named_function *function,
                              const se3di_token *name, size_t count)
{
    if (at_mark(p, ',')) {
        return next(p);
    }
    return at_mark(p, ')') ? fail_count(p, function, name, count)
                           : fail_unexpected(p, "an operator, ',' or ')'");
}

/* One argument of if() in the branch that is taken (live) or that a constant condition excludes:
 * its code is dropped, its text is still checked. */
static se3d_status parse_branch(parser *p, int live, se3di_operand *out)
{
    size_t count = p->program->count;
    p->program->dead += !live;
    se3d_status status = parse_comparison(p, out);
    p->program->dead -= !live;
    if (!live) {
        p->program->count = count;
    }
    return status;
}

static se3d_status parse_if(parser *p, const se3di_named_function *function,
                            const se3di_token *name, se3di_operand *out)
{
    se3di_operand condition, a, b;
    size_t over_a = 0, over_b = 0;
    SE3DI_TRY(parse_comparison(p, &condition));
    SE3DI_TRY(pass_comma(p, function, name, 1));
    int constant = se3di_program_is_constant(p->program, condition);
    int chosen = constant ? p->program->code[condition.start].value != 0.0 : 0;
    if (constant) {
        p->program->count = condition.start;
    } else {
        SE3DI_TRY(se3di_program_jump(p->program, SE3DI_OP_JUMP_IF_ZERO, &over_a));
    }
    SE3DI_TRY(parse_branch(p, !constant || chosen, &a));
    SE3DI_TRY(pass_comma(p, function, name, 2));
    if (!constant) {
        SE3DI_TRY(se3di_program_jump(p->program, SE3DI_OP_JUMP, &over_b));
        se3di_program_land(p->program, over_a);
    }
    SE3DI_TRY(parse_branch(p, !constant || !chosen, &b));
    if (constant) {
        *out = chosen ? a : b;
    } else {
        se3di_program_land(p->program, over_b);
        *out = (se3di_operand){condition.start, a.mask | b.mask};
    }
    return at_mark(p, ',') ? fail_count(p, function, name, 4) : SE3D_OK;
}

static se3d_status parse_arguments(parser *p, size_t function, const se3di_token *name,
                                   se3di_operand *out)
{
    const se3di_named_function *row = &se3di_functions[function];
    se3di_operand arguments[5];
    size_t count = 0;
    for (;;) {
        se3di_operand argument;
        SE3DI_TRY(parse_comparison(p, &argument));
        ++count;
        if (row->kind == SE3DI_FUNCTION_SELECT && count > 1) {
            SE3DI_TRY(se3di_program_binary(p->program, SE3DI_OP_SELECT, function, &arguments[0],
                                           argument));
        } else if (count <= 5) {
            arguments[count - 1] = argument;
        }
        if (!at_mark(p, ',')) {
            break;
        }
        SE3DI_TRY(next(p));
    }
    if (!at_mark(p, ')')) {
        return fail_unexpected(p, "an operator, ',' or ')'");
    }
    if (count < row->min_arguments ||
        (count > row->max_arguments && row->kind != SE3DI_FUNCTION_SELECT)) {
        return fail_count(p, row, name, count);
    }
    se3d_status status = SE3D_OK;
    if (row->kind == SE3DI_FUNCTION_UNARY) {
        status = se3di_program_unary(p->program, function, &arguments[0]);
    } else if (row->kind == SE3DI_FUNCTION_BINARY) {
        status = se3di_program_binary(p->program, SE3DI_OP_BINARY, function, &arguments[0],
                                      arguments[1]);
    } else if (row->kind == SE3DI_FUNCTION_STEP) {
        status = se3di_program_step(p->program, arguments);
    }
    *out = arguments[0];
    return check_finite(p, name, status);
}

/* The present token is '(' after `name`. */
static se3d_status parse_call(parser *p, const se3di_token *name, se3di_operand *out)
{
    size_t function = se3di_function_find(name->start, name->length);
    if (function == SE3DI_FUNCTION_NONE) {
        if (se3di_name_find(p->def, name->start, name->length).kind != SE3DI_NAME_UNKNOWN) {
            char text[SE3DI_TOKEN_TEXT_SIZE];
            se3di_token_describe(name, text);
            return se3di_lexer_fail(&p->lexer, SE3D_ERR_EXPRESSION, p->lexer.token.start,
                                    "%s is not a function, expected an operator before '('", text);
        }
        return se3di_name_fail(p->def, &p->lexer, name, 1);
    }
    const se3di_named_function *row = &se3di_functions[function];
    SE3DI_TRY(enter(p));
    SE3DI_TRY(next(p));
    if (at_mark(p, ')')) {
        return fail_count(p, row, name, 0);
    }
    if (row->kind == SE3DI_FUNCTION_IF) {
        SE3DI_TRY(parse_if(p, row, name, out));
    } else {
        SE3DI_TRY(parse_arguments(p, function, name, out));
    }
    if (!at_mark(p, ')')) {
        return fail_unexpected(p, "an operator or ')'");
    }
    --p->depth;
    return next(p);
}

static se3d_status parse_primary(parser *p, se3di_operand *out)
{
    const se3di_token token = p->lexer.token;
    if (token.kind == SE3DI_TOKEN_NUMBER) {
        SE3DI_TRY(se3di_program_push_constant(p->program, token.number, out));
        return next(p);
    }
    if (token.kind == SE3DI_TOKEN_NAME) {
        const char *after = p->lexer.at + strspn(p->lexer.at, " \t\n\r");
        if (*after != '(') {
            return parse_name(p, out);
        }
        SE3DI_TRY(next(p)); /* unreached: a failure, as there is a '(' */
        return parse_call(p, &token, out);
    }
    if (!at_mark(p, '(')) {
        return fail_unexpected(p, "a number, a name, a function or '('");
    }
    SE3DI_TRY(enter(p));
    SE3DI_TRY(next(p));
    SE3DI_TRY(parse_comparison(p, out));
    if (!at_mark(p, ')')) {
        return fail_unexpected(p, "an operator or ')'");
    }
    --p->depth;
    return next(p);
}

static se3d_status parse_power(parser *p, se3di_operand *out)
{
    SE3DI_TRY(parse_primary(p, out));
    if (!at_mark(p, '^')) {
        return SE3D_OK;
    }
    const se3di_token sign = p->lexer.token;
    se3di_operand exponent;
    SE3DI_TRY(enter(p));
    SE3DI_TRY(next(p));
    SE3DI_TRY(parse_unary(p, &exponent));
    --p->depth;
    return check_finite(p, &sign,
                        se3di_program_binary(p->program, SE3DI_OP_POWER,
                                             se3di_function_find("^", 1), out, exponent));
}

static se3d_status parse_unary(parser *p, se3di_operand *out)
{
    int negative = 0;
    while (at_mark(p, '+') || at_mark(p, '-')) {
        negative ^= at_mark(p, '-');
        SE3DI_TRY(next(p));
    }
    SE3DI_TRY(parse_power(p, out));
    return negative ? se3di_program_negate(p->program, out) : SE3D_OK;
}

/* The sign at hand and what stands to its right, joined to what stands to its left. */
static se3d_status parse_right(parser *p, se3d_status (*parse)(parser *, se3di_operand *),
                               se3di_op op, se3di_operand *out)
{
    const se3di_token sign = p->lexer.token;
    se3di_operand right;
    SE3DI_TRY(next(p));
    SE3DI_TRY(parse(p, &right));
    return check_finite(p, &sign, se3di_program_binary(p->program, op, 0, out, right));
}

/* Operands that `parse` reads, joined from left to right by the one sign or the other. */
static se3d_status parse_chain(parser *p, se3d_status (*parse)(parser *, se3di_operand *),
                               const char marks[2], const se3di_op ops[2], se3di_operand *out)
{
    SE3DI_TRY(parse(p, out));
    while (at_mark(p, marks[0]) || at_mark(p, marks[1])) {
        SE3DI_TRY(parse_right(p, parse, ops[at_mark(p, marks[0]) ? 0 : 1], out));
    }
    return SE3D_OK;
}

static se3d_status parse_product(parser *p, se3di_operand *out)
{
    static const se3di_op ops[2] = {SE3DI_OP_MULTIPLY, SE3DI_OP_DIVIDE};
    return parse_chain(p, parse_unary, "*/", ops, out);
}

static se3d_status parse_sum(parser *p, se3di_operand *out)
{
    static const se3di_op ops[2] = {SE3DI_OP_ADD, SE3DI_OP_SUBTRACT};
    return parse_chain(p, parse_product, "+-", ops, out);
}

static se3d_status parse_comparison(parser *p, se3di_operand *out)
{
    SE3DI_TRY(parse_sum(p, out));
    const se3di_token sign = p->lexer.token;
    if (sign.kind != SE3DI_TOKEN_COMPARISON) {
        return SE3D_OK;
    }
    se3di_operand right;
    SE3DI_TRY(next(p));
    SE3DI_TRY(parse_sum(p, &right));
    if (p->lexer.token.kind == SE3DI_TOKEN_COMPARISON) {
        return fail_unexpected(p, "parentheses around the first comparison");
    }
    return check_finite(p, &sign,
                        se3di_program_binary(p->program, SE3DI_OP_BINARY,
                                             se3di_function_find(sign.start, sign.length), out,
                                             right));
}

se3d_status se3di_expression_parse(const se3d_expression_def *def, se3di_program *program,
                                   se3d_expression_error *error)
{
    parser p = {.def = def, .program = program};
    p.lexer = (se3di_lexer){.text = def->text, .at = def->text, .error = error};
    se3di_operand result;
    SE3DI_TRY(next(&p));
    if (p.lexer.token.kind == SE3DI_TOKEN_END) {
        return se3di_lexer_fail(&p.lexer, SE3D_ERR_EXPRESSION, def->text,
                                "the expression is empty, expected a number, a name, a function "
                                "or '('");
    }
    SE3DI_TRY(parse_comparison(&p, &result));
    if (at_mark(&p, ')')) {
        return fail_unexpected(&p, "an operator or the end: no '(' is open");
    }
    if (p.lexer.token.kind != SE3DI_TOKEN_END) {
        return fail_unexpected(&p, "an operator (+ - * / ^ < <= > >= == !=) or the end");
    }
    if (se3di_program_stack_size(program) > SE3DI_PROGRAM_STACK) {
        return se3di_lexer_fail(&p.lexer, SE3D_ERR_EXPRESSION, def->text,
                                "more than %d operands are pending: simplify the expression",
                                SE3DI_PROGRAM_STACK);
    }
    return SE3D_OK;
}
