/* SPDX-License-Identifier: BSD-3-Clause */
/* The bytecode of an expression: a postfix program over a small stack of jets. */
#ifndef SE3DI_EXPRESSION_PROGRAM_H
#define SE3DI_EXPRESSION_PROGRAM_H

#include "expression/expression.h"

typedef enum se3di_op {
    SE3DI_OP_CONSTANT = 0,     /* push value */
    SE3DI_OP_VARIABLE = 1,     /* push x[function] */
    SE3DI_OP_ADD = 2,          /* a + b */
    SE3DI_OP_SUBTRACT = 3,     /* a - b */
    SE3DI_OP_MULTIPLY = 4,     /* a * b */
    SE3DI_OP_DIVIDE = 5,       /* a / b */
    SE3DI_OP_SHIFT = 6,        /* a + value */
    SE3DI_OP_SCALE = 7,        /* a * value */
    SE3DI_OP_POWER = 8,        /* a ^ value */
    SE3DI_OP_UNARY = 9,        /* functions[function](a) */
    SE3DI_OP_BINARY = 10,      /* functions[function](a, b) */
    SE3DI_OP_SELECT = 11,      /* a or b, as functions[function] says */
    SE3DI_OP_STEP = 12,        /* five operands */
    SE3DI_OP_JUMP = 13,        /* skip `jump` instructions */
    SE3DI_OP_JUMP_IF_ZERO = 14 /* pop; skip `jump` instructions if it is 0 */
} se3di_op;

typedef struct se3di_instruction {
    double value;
    uint8_t op;       /* se3di_op */
    uint8_t function; /* row of se3di_functions, or number of the variable */
    uint16_t mask_a;  /* bit k: the first operand depends on variable k ... */
    uint16_t mask_b;  /* ... and the second; derivatives of the others are exactly 0 */
    uint16_t jump;    /* texts have fewer characters than this can tell */
} se3di_instruction;

#define SE3DI_PROGRAM_STACK 128 /* values that may wait at one time */

/* Evaluate a checked program: result[0] = f, result[1 + k] = df/dx_k for k < variable_count.
 * With variable_count 0 it is the value alone, whatever variables the program reads. */
void se3di_program_eval(const se3di_instruction *code, size_t count, const double *x,
                        size_t variable_count, double *result);

/* Values at points side by side: x [variables][SE3DI_EXPRESSION_POINTS], the same bits as of
 * each. */
void se3di_program_eval_points(const se3di_instruction *code, size_t count, const double *x,
                               size_t variable_count, double values[SE3DI_EXPRESSION_POINTS]);

/* Evaluate f, f' and f'' with respect to variable 0. */
void se3di_program_eval_time(const se3di_instruction *code, size_t count, const double *x,
                             double jet[3]);

/* Evaluate f and its first and second derivative along a direction: components of the variables
 * whose bits are in the mask, 0 of the others. */
void se3di_program_eval_along(const se3di_instruction *code, size_t count, const double *x,
                              const double *direction, unsigned mask, double out[3]);

/* ---- building -------------------------------------------------------------------------------*/

typedef struct se3di_program {
    se3d_allocator allocator;
    se3di_instruction *code;
    size_t count, capacity;
    int dead; /* > 0 inside a branch that is never taken: constants may be anything */
} se3di_program;

/* A part of the program that leaves one value: code[start] up to the present end. */
typedef struct se3di_operand {
    size_t start;
    unsigned mask; /* variables that its derivatives depend on */
} se3di_operand;

void se3di_program_destroy(se3di_program *program);

/* True if `operand`, which must be the last one, is a known number; it is then code[start]. */
int se3di_program_is_constant(const se3di_program *program, se3di_operand operand);

se3d_status se3di_program_push_constant(se3di_program *program, double value, se3di_operand *out);
se3d_status se3di_program_push_variable(se3di_program *program, size_t index, se3di_operand *out);

/* Replace the last operand(s) by the result, which is written to the first. Constants are folded;
 * SE3D_ERR_NOT_FINITE if the result can never be finite. */
se3d_status se3di_program_negate(se3di_program *program, se3di_operand *a);
se3d_status se3di_program_unary(se3di_program *program, size_t function, se3di_operand *a);
se3d_status se3di_program_binary(se3di_program *program, se3di_op op, size_t function,
                                 se3di_operand *a, se3di_operand b);
se3d_status se3di_program_step(se3di_program *program, se3di_operand arguments[5]);

/* Append a jump whose length is set by se3di_program_land; returns its place in *at. */
se3d_status se3di_program_jump(se3di_program *program, se3di_op op, size_t *at);
void se3di_program_land(se3di_program *program, size_t at);

/* Largest number of values that wait at one time. */
size_t se3di_program_stack_size(const se3di_program *program);

#endif
