/* SPDX-License-Identifier: BSD-3-Clause */
/* Characters are classified here and not by <ctype.h>, whose answers depend on the locale. */
#include "expression/lexer.h"

#include "base/error.h"

#include <locale.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define NUMBER_SIZE 512 /* longest number, with room for any decimal point */

static int is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static int is_name_start(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

static int is_space(char c)
{
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

se3d_status se3di_lexer_fail(const se3di_lexer *lexer, se3d_status status, const char *at,
                             const char *format, ...)
{
    se3d_expression_error *error = lexer->error;
    if (error) {
        va_list arguments;
        va_start(arguments, format);
        vsnprintf(error->message, sizeof error->message, format, arguments);
        va_end(arguments);
        error->column = at ? (size_t)(at - lexer->text) + 1 : 0;
    }
    return status;
}

void se3di_token_describe(const se3di_token *token, char text[SE3DI_TOKEN_TEXT_SIZE])
{
    if (token->kind == SE3DI_TOKEN_END) {
        snprintf(text, SE3DI_TOKEN_TEXT_SIZE, "the end of the text");
    } else if (token->length > 40) {
        snprintf(text, SE3DI_TOKEN_TEXT_SIZE, "'%.37s...'", token->start);
    } else {
        snprintf(text, SE3DI_TOKEN_TEXT_SIZE, "'%.*s'", (int)token->length, token->start);
    }
}

int se3di_lexer_is_identifier(const char *name)
{
    if (!is_name_start(*name)) {
        return 0;
    }
    while (is_name_start(*name) || is_digit(*name)) {
        ++name;
    }
    return *name == '\0';
}

static const char *skip_digits(const char *c)
{
    while (is_digit(*c)) {
        ++c;
    }
    return c;
}

/* Convert start..end, checked to be a decimal number, in any locale: strtod wants its own point. */
static double convert(const char *start, const char *end)
{
    const char *point = localeconv()->decimal_point;
    char buffer[NUMBER_SIZE + 1];
    size_t size = 0;
    for (const char *c = start; c < end; ++c) {
        if (*c == '.') {
            /* unreached: a longer number, which was refused */
            for (const char *p = point; *p && size < NUMBER_SIZE; ++p) {
                buffer[size++] = *p;
            }
        } else if (size < NUMBER_SIZE) { /* unreached: the same */
            buffer[size++] = *c;
        }
    }
    buffer[size] = '\0';
    return strtod(buffer, NULL);
}

static se3d_status read_number(se3di_lexer *lexer)
{
    const char *start = lexer->at, *end = skip_digits(start);
    size_t digits = (size_t)(end - start);
    if (*end == '.') {
        const char *fraction = end + 1;
        end = skip_digits(fraction);
        digits += (size_t)(end - fraction);
    }
    if (digits == 0) {
        return se3di_lexer_fail(lexer, SE3D_ERR_EXPRESSION, start,
                                "'.' without digits, expected a number such as 0.5 or .5");
    }
    if (*end == 'e' || *end == 'E') {
        const char *exponent = end + 1 + (end[1] == '+' || end[1] == '-');
        end = skip_digits(exponent);
        if (end == exponent) {
            return se3di_lexer_fail(lexer, SE3D_ERR_EXPRESSION, start,
                                    "the exponent of '%.*s' has no digits, expected as in 1e-3",
                                    (int)(end - start > 40 ? 40 : end - start), start);
        }
    }
    if (end - start > NUMBER_SIZE - 16) {
        return se3di_lexer_fail(lexer, SE3D_ERR_EXPRESSION, start,
                                "a number of %zu characters, at most %d are allowed",
                                (size_t)(end - start), NUMBER_SIZE - 16);
    }
    double number = convert(start, end);
    if (!isfinite(number)) {
        return se3di_lexer_fail(lexer, SE3D_ERR_EXPRESSION, start,
                                "the number '%.*s' is too large, at most about 1.7e308 is allowed",
                                (int)(end - start > 40 ? 40 : end - start), start);
    }
    lexer->token = (se3di_token){SE3DI_TOKEN_NUMBER, 0, start, (size_t)(end - start), number};
    return SE3D_OK;
}

/* Length of the character at c if it is well-formed UTF-8 of more than one byte, else 0. */
static int utf8_length(const char *c)
{
    unsigned lead = (unsigned char)*c;
    int length = lead >= 0xF0 && lead < 0xF5 ? 4 : lead >= 0xE0 ? 3 : lead >= 0xC2 ? 2 : 0;
    if (lead >= 0xF5) {
        return 0;
    }
    for (int k = 1; k < length; ++k) {
        if (((unsigned char)c[k] & 0xC0u) != 0x80u) {
            return 0;
        }
    }
    return length;
}

static se3d_status fail_character(const se3di_lexer *lexer)
{
    static const char allowed[] = "allowed are numbers, names, + - * / ^ ( ) , and < <= > >= == !=";
    const char *c = lexer->at;
    int length = utf8_length(c);
    if (*c == '=' || *c == '!') {
        return se3di_lexer_fail(lexer, SE3D_ERR_EXPRESSION, c,
                                "unexpected '%c', did you mean '%c='?", *c, *c);
    }
    if (length == 0 && (*c <= ' ' || *c >= 0x7F)) {
        return se3di_lexer_fail(lexer, SE3D_ERR_EXPRESSION, c, "unexpected byte 0x%02X; %s",
                                (unsigned)(unsigned char)*c, allowed);
    }
    return se3di_lexer_fail(lexer, SE3D_ERR_EXPRESSION, c, "unexpected character '%.*s'; %s",
                            length == 0 ? 1 : length, c, allowed);
}

/* Length of the comparison at c, 0 if there is none. */
static size_t comparison_length(const char *c)
{
    if (c[0] == '<' || c[0] == '>') {
        return c[1] == '=' ? 2 : 1;
    }
    return (c[0] == '=' || c[0] == '!') && c[1] == '=' ? 2 : 0;
}

se3d_status se3di_lexer_next(se3di_lexer *lexer)
{
    while (is_space(*lexer->at)) {
        ++lexer->at;
    }
    const char *start = lexer->at;
    size_t comparison = comparison_length(start);
    if (*start == '\0') {
        lexer->token = (se3di_token){.kind = SE3DI_TOKEN_END, .start = start};
    } else if (is_digit(*start) || *start == '.') {
        SE3DI_TRY(read_number(lexer));
    } else if (is_name_start(*start)) {
        const char *end = start;
        while (is_name_start(*end) || is_digit(*end)) {
            ++end;
        }
        lexer->token = (se3di_token){SE3DI_TOKEN_NAME, 0, start, (size_t)(end - start), 0.0};
    } else if (comparison > 0) {
        lexer->token = (se3di_token){SE3DI_TOKEN_COMPARISON, 0, start, comparison, 0.0};
    } else if (strchr("+-*/^(),", *start)) {
        lexer->token = (se3di_token){SE3DI_TOKEN_MARK, *start, start, 1, 0.0};
    } else {
        return fail_character(lexer);
    }
    lexer->at = start + lexer->token.length;
    return SE3D_OK;
}
