/* SPDX-License-Identifier: BSD-3-Clause */
/* The table of functions and operators: value and exact partial derivatives of each. */
#ifndef SE3DI_EXPRESSION_FUNCTIONS_H
#define SE3DI_EXPRESSION_FUNCTIONS_H

#include <stddef.h>
#include <stdint.h>

typedef enum se3di_function_kind {
    SE3DI_FUNCTION_UNARY = 0,
    SE3DI_FUNCTION_BINARY = 1,
    SE3DI_FUNCTION_SELECT = 2, /* two or more arguments, the result is one of them */
    SE3DI_FUNCTION_STEP = 3,
    SE3DI_FUNCTION_IF = 4
} se3di_function_kind;

/* f(a, b) and its partial derivatives. */
typedef struct se3di_partials {
    double f, a, b, aa, ab, bb;
} se3di_partials;

typedef struct se3di_named_function {
    const char *name;      /* as written in a text */
    const char *signature; /* for messages */
    uint8_t kind;          /* se3di_function_kind */
    uint8_t flat;          /* piecewise constant: the result depends on no variable */
    uint8_t min_arguments;
    uint8_t max_arguments;
    void (*unary)(double u, double d[3]); /* f, f', f'' at u */
    void (*binary)(double a, double b, se3di_partials *d);
} se3di_named_function;

extern const se3di_named_function se3di_functions[];
extern const size_t se3di_function_count;

#define SE3DI_FUNCTION_NONE SIZE_MAX

/* Index of the function or operator called `name` (not terminated), or SE3DI_FUNCTION_NONE. */
size_t se3di_function_find(const char *name, size_t length);

/* Whether it has derivatives wherever it has a value (abs, sqrt, asin, mod have not). */
int se3di_function_is_smooth(size_t function);
/* ... no jump, but for the angle of atan2 where it is half a turn. */
int se3di_function_is_continuous(size_t function);

/* Whether it has a finite value and finite rates for every finite argument. */
int se3di_function_is_total(size_t function);

/* u^c for a constant c: f, f', f''. Exact conventions at u = 0 and u < 0 for integer c. */
void se3di_function_power(double u, double c, double d[3]);
/* |u|, of which the derivative at zero is zero. */
void se3di_function_abs(double u, double d[3]);

/* The cubic 3 u^2 - 2 u^3 on 0 < u < 1: f, f', f''. */
void se3di_function_smooth_step(double u, double d[3]);

#endif
