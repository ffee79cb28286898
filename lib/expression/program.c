/* SPDX-License-Identifier: BSD-3-Clause */
/* Building of bytecode: constants are folded by running the very code that would run later, so
 * that folding never changes a bit of a result. Jumps are relative, so that code may be moved. */
#include "expression/program.h"

#include "base/error.h"
#include "expression/functions.h"
#include "se3d/expression.h"

#include <math.h>
#include <string.h>

_Static_assert(SE3D_EXPRESSION_VARIABLE_MAX <= 16, "the masks of an instruction have 16 bits");
_Static_assert(SE3D_EXPRESSION_TEXT_MAX < UINT16_MAX, "and so has its jump");

void se3di_program_destroy(se3di_program *program)
{
    se3di_free(&program->allocator, program->code, program->capacity, sizeof *program->code);
    program->code = NULL;
    program->count = program->capacity = 0;
}

int se3di_program_is_constant(const se3di_program *program, se3di_operand operand)
{
    return program->count == operand.start + 1 &&
           program->code[operand.start].op == SE3DI_OP_CONSTANT;
}

static se3d_status append(se3di_program *program, se3di_instruction instruction)
{
    void *code = program->code;
    se3d_status status = se3di_array_reserve(&program->allocator, &code, &program->capacity,
                                             program->count + 1, sizeof *program->code);
    program->code = code;
    if (status == SE3D_OK) {
        program->code[program->count++] = instruction;
    }
    return status;
}

se3d_status se3di_program_push_constant(se3di_program *program, double value, se3di_operand *out)
{
    *out = (se3di_operand){program->count, 0};
    return append(program, (se3di_instruction){.value = value, .op = SE3DI_OP_CONSTANT});
}

se3d_status se3di_program_push_variable(se3di_program *program, size_t index, se3di_operand *out)
{
    unsigned mask = 1u << index;
    *out = (se3di_operand){program->count, mask};
    return append(program, (se3di_instruction){.op = SE3DI_OP_VARIABLE,
                                               .function = (uint8_t)index,
                                               .mask_a = (uint16_t)mask});
}

/* Reduce the code from `start` on, which needs no variables, to one number. */
static se3d_status fold(se3di_program *program, size_t start)
{
    double value;
    se3di_program_eval(program->code + start, program->count - start, NULL, 0, &value);
    program->count = start + 1;
    program->code[start] = (se3di_instruction){.value = value, .op = SE3DI_OP_CONSTANT};
    return isfinite(value) || program->dead ? SE3D_OK : SE3D_ERR_NOT_FINITE;
}

/* Append an operation on one operand. */
static se3d_status apply(se3di_program *program, se3di_instruction instruction, se3di_operand *a)
{
    int constant = se3di_program_is_constant(program, *a);
    SE3DI_TRY(append(program, instruction));
    return constant ? fold(program, a->start) : SE3D_OK;
}

se3d_status se3di_program_negate(se3di_program *program, se3di_operand *a)
{
    return apply(program, (se3di_instruction){.value = -1.0, .op = SE3DI_OP_SCALE}, a);
}

se3d_status se3di_program_unary(se3di_program *program, size_t function, se3di_operand *a)
{
    if (se3di_functions[function].flat) {
        a->mask = 0;
    }
    return apply(program,
                 (se3di_instruction){.op = SE3DI_OP_UNARY,
                                     .function = (uint8_t)function,
                                     .mask_a = (uint16_t)a->mask},
                 a);
}

/* a op c with a number c: drop c's instruction if one operation with a number does. */
static se3d_status apply_right_constant(se3di_program *program, se3di_op op, se3di_operand *a,
                                        double c, int *done)
{
    se3di_instruction instruction = {.value = c, .mask_a = (uint16_t)a->mask};
    *done = 1;
    switch (op) {
    case SE3DI_OP_ADD:
        instruction.op = SE3DI_OP_SHIFT;
        break;
    case SE3DI_OP_SUBTRACT:
        instruction.op = SE3DI_OP_SHIFT;
        instruction.value = -c;
        break;
    case SE3DI_OP_MULTIPLY:
        instruction.op = SE3DI_OP_SCALE;
        break;
    case SE3DI_OP_POWER:
        instruction.op = SE3DI_OP_POWER;
        break;
    default:
        *done = 0;
        return op == SE3DI_OP_DIVIDE && c == 0.0 && !program->dead ? SE3D_ERR_NOT_FINITE : SE3D_OK;
    }
    --program->count;
    return apply(program, instruction, a);
}

/* c op b with a number c: the same for the operations that commute. */
static se3d_status apply_left_constant(se3di_program *program, se3di_op op, se3di_operand a,
                                       size_t b_size)
{
    se3di_instruction *place = program->code + a.start;
    double c = place->value;
    memmove(place, place + 1, b_size * sizeof *place);
    program->count -= 1;
    uint8_t commuted = op == SE3DI_OP_ADD ? SE3DI_OP_SHIFT : SE3DI_OP_SCALE;
    return append(program, (se3di_instruction){.value = c, .op = commuted});
}

se3d_status se3di_program_binary(se3di_program *program, se3di_op op, size_t function,
                                 se3di_operand *a, se3di_operand b)
{
    int a_constant = b.start == a->start + 1 && program->code[a->start].op == SE3DI_OP_CONSTANT;
    int b_constant = se3di_program_is_constant(program, b);
    if (b_constant) {
        int done;
        SE3DI_TRY(apply_right_constant(program, op, a, program->code[b.start].value, &done));
        if (done) {
            return SE3D_OK;
        }
    }
    se3di_instruction instruction = {.op = (uint8_t)(op == SE3DI_OP_POWER ? SE3DI_OP_BINARY : op),
                                     .function = (uint8_t)function,
                                     .mask_a = (uint16_t)a->mask,
                                     .mask_b = (uint16_t)b.mask};
    a->mask |= b.mask;
    if (a_constant && !b_constant && (op == SE3DI_OP_ADD || op == SE3DI_OP_MULTIPLY)) {
        return apply_left_constant(program, op, *a, program->count - b.start);
    }
    if (op == SE3DI_OP_BINARY && se3di_functions[function].flat) {
        a->mask = instruction.mask_a = instruction.mask_b = 0;
    }
    SE3DI_TRY(append(program, instruction));
    return a_constant && b_constant ? fold(program, a->start) : SE3D_OK;
}

se3d_status se3di_program_step(se3di_program *program, se3di_operand arguments[5])
{
    size_t start = arguments[0].start;
    int constant = program->count == start + 5;
    for (size_t k = 0; k < 5; ++k) {
        constant = constant && program->code[start + k].op == SE3DI_OP_CONSTANT;
        arguments[0].mask |= arguments[k].mask;
    }
    const se3di_instruction *x0 = program->code + arguments[1].start;
    const se3di_instruction *x1 = program->code + arguments[3].start;
    int known = arguments[2].start == arguments[1].start + 1 && x0->op == SE3DI_OP_CONSTANT &&
                arguments[4].start == arguments[3].start + 1 && x1->op == SE3DI_OP_CONSTANT;
    if (known && x0->value == x1->value && !program->dead) {
        return SE3D_ERR_NOT_FINITE;
    }
    SE3DI_TRY(append(program, (se3di_instruction){.op = SE3DI_OP_STEP}));
    return constant ? fold(program, start) : SE3D_OK;
}

se3d_status se3di_program_jump(se3di_program *program, se3di_op op, size_t *at)
{
    *at = program->count;
    return append(program, (se3di_instruction){.op = (uint8_t)op});
}

void se3di_program_land(se3di_program *program, size_t at)
{
    program->code[at].jump = (uint16_t)(program->count - at - 1);
}

size_t se3di_program_stack_size(const se3di_program *program)
{
    /* Values that an instruction leaves more than it takes; after a jump the other branch begins
     * without this branch's value. */
    static const int8_t change[] = {1, 1, -1, -1, -1, -1, 0, 0, 0, 0, -1, -1, -4, -1, -1};
    long size = 0, largest = 0;
    for (size_t k = 0; k < program->count; ++k) {
        size += change[program->code[k].op];
        largest = size > largest ? size : largest;
    }
    return (size_t)largest;
}
