/* SPDX-License-Identifier: BSD-3-Clause */
/* Bytecode as text. The postfix program becomes a tree, and the tree a text with as few parentheses
 * as the grammar (parser.c) allows. Names of constants and parameters are numbers then. */
#include "expression/format.h"

#include "base/error.h"
#include "base/shortest.h"
#include "expression/functions.h"

#include <ctype.h>
#include <math.h>
#include <string.h>

/* How tightly a text holds together; operands of less go into parentheses. */
typedef enum tightness {
    COMPARISON = 0,
    SUM = 1,
    PRODUCT = 2,
    UNARY = 3,
    POWER = 4,
    PRIMARY = 5
} tightness;

typedef struct node {
    const se3di_instruction *in; /* of a condition: its first jump */
    uint32_t operand[5];
    uint32_t count;
} node;

typedef struct writer {
    const se3di_instruction *code;
    node *nodes; /* [one for each instruction] */
    uint32_t node_count;
    const char *const *names;
    char *text;
    size_t capacity, length;
} writer;

static uint32_t add_node(writer *w, const se3di_instruction *in, uint32_t *stack, size_t *depth,
                         uint32_t count)
{
    node *made = &w->nodes[w->node_count];
    *made = (node){.in = in, .count = count};
    *depth -= count;
    memcpy(made->operand, stack + *depth, count * sizeof *stack);
    return w->node_count++;
}

static uint32_t operand_count(const se3di_instruction *in)
{
    switch (in->op) {
    case SE3DI_OP_CONSTANT:
    case SE3DI_OP_VARIABLE:
        return 0;
    case SE3DI_OP_SHIFT:
    case SE3DI_OP_SCALE:
    case SE3DI_OP_POWER:
    case SE3DI_OP_UNARY:
        return 1;
    case SE3DI_OP_STEP:
        return 5;
    default:
        return 2;
    }
}

/* The tree of code[begin .. end), which leaves one value. */
static uint32_t build(writer *w, size_t begin, size_t end)
{
    uint32_t stack[SE3DI_PROGRAM_STACK + 1];
    size_t depth = 0;
    for (size_t k = begin; k < end; ++k) {
        const se3di_instruction *in = &w->code[k];
        if (in->op == SE3DI_OP_JUMP_IF_ZERO) {
            const size_t middle = k + in->jump; /* the jump over the second branch */
            const size_t last = middle + 1 + w->code[middle].jump;
            stack[depth++] = build(w, k + 1, middle);
            stack[depth++] = build(w, middle + 1, last);
            const uint32_t made = add_node(w, in, stack, &depth, 3);
            stack[depth++] = made;
            k = last - 1;
        } else {
            const uint32_t made = add_node(w, in, stack, &depth, operand_count(in));
            stack[depth++] = made;
        }
    }
    return stack[0];
}

static void put(writer *w, const char *text)
{
    const size_t size = strlen(text);
    for (size_t k = 0; k < size; ++k, ++w->length) {
        if (w->length + 1 < w->capacity) {
            w->text[w->length] = text[k];
        }
    }
}

static void put_number(writer *w, double value)
{
    char text[SE3DI_SHORTEST_SIZE];
    (void)se3di_shortest_format(value, text);
    put(w, text);
}

static int is_operator(size_t function)
{
    return !isalpha((unsigned char)se3di_functions[function].name[0]);
}

static tightness tightness_of(const se3di_instruction *in)
{
    switch (in->op) {
    case SE3DI_OP_CONSTANT:
        return signbit(in->value) ? UNARY : PRIMARY;
    case SE3DI_OP_ADD:
    case SE3DI_OP_SUBTRACT:
    case SE3DI_OP_SHIFT:
        return SUM;
    case SE3DI_OP_MULTIPLY:
    case SE3DI_OP_DIVIDE:
        return PRODUCT;
    case SE3DI_OP_SCALE:
        return in->value == -1.0 ? UNARY : PRODUCT;
    case SE3DI_OP_POWER:
        return POWER;
    case SE3DI_OP_BINARY:
        if (!is_operator(in->function)) {
            return PRIMARY;
        }
        return se3di_functions[in->function].name[0] == '^' ? POWER : COMPARISON;
    default:
        return PRIMARY;
    }
}

static void put_node(writer *w, uint32_t index);

/* In parentheses unless it holds together as tightly as it has to. */
static void put_operand(writer *w, uint32_t index, tightness least)
{
    const int loose = tightness_of(w->nodes[index].in) < least;
    put(w, loose ? "(" : "");
    put_node(w, index);
    put(w, loose ? ")" : "");
}

static void put_infix(writer *w, const node *n, const char *sign, tightness left, tightness right)
{
    put_operand(w, n->operand[0], left);
    put(w, sign);
    put_operand(w, n->operand[1], right);
}

static void put_call(writer *w, const node *n, const char *name)
{
    put(w, name);
    for (uint32_t k = 0; k < n->count; ++k) {
        put(w, k == 0 ? "(" : ", ");
        put_node(w, n->operand[k]);
    }
    put(w, ")");
}

static void put_shift(writer *w, const node *n)
{
    const double value = n->in->value;
    put_operand(w, n->operand[0], SUM);
    put(w, signbit(value) ? " - " : " + ");
    put_number(w, signbit(value) ? -value : value);
}

static void put_scale(writer *w, const node *n)
{
    const double value = n->in->value;
    if (value == -1.0) {
        put(w, "-");
        put_operand(w, n->operand[0], POWER);
        return;
    }
    put_number(w, value);
    put(w, "*");
    put_operand(w, n->operand[0], UNARY);
}

static void put_power(writer *w, const node *n)
{
    const double value = n->in->value;
    put_operand(w, n->operand[0], PRIMARY);
    put(w, signbit(value) ? "^(" : "^");
    put_number(w, value);
    put(w, signbit(value) ? ")" : "");
}

static void put_binary(writer *w, const node *n)
{
    const char *name = se3di_functions[n->in->function].name;
    if (!is_operator(n->in->function)) {
        put_call(w, n, name);
    } else if (name[0] == '^') {
        put_infix(w, n, "^", PRIMARY, PRIMARY);
    } else {
        put_operand(w, n->operand[0], SUM);
        put(w, " ");
        put(w, name);
        put(w, " ");
        put_operand(w, n->operand[1], SUM);
    }
}

static void put_node(writer *w, uint32_t index)
{
    const node *n = &w->nodes[index];
    switch (n->in->op) {
    case SE3DI_OP_CONSTANT:
        put_number(w, n->in->value);
        break;
    case SE3DI_OP_VARIABLE:
        put(w, w->names[n->in->function]);
        break;
    case SE3DI_OP_ADD:
        put_infix(w, n, " + ", SUM, PRODUCT);
        break;
    case SE3DI_OP_SUBTRACT:
        put_infix(w, n, " - ", SUM, PRODUCT);
        break;
    case SE3DI_OP_MULTIPLY:
        put_infix(w, n, "*", PRODUCT, POWER);
        break;
    case SE3DI_OP_DIVIDE:
        put_infix(w, n, "/", PRODUCT, POWER);
        break;
    case SE3DI_OP_SHIFT:
        put_shift(w, n);
        break;
    case SE3DI_OP_SCALE:
        put_scale(w, n);
        break;
    case SE3DI_OP_POWER:
        put_power(w, n);
        break;
    case SE3DI_OP_BINARY:
        put_binary(w, n);
        break;
    case SE3DI_OP_STEP:
        put_call(w, n, "step");
        break;
    case SE3DI_OP_JUMP_IF_ZERO:
        put_call(w, n, "if");
        break;
    default: /* UNARY, SELECT */
        put_call(w, n, se3di_functions[n->in->function].name);
        break;
    }
}

se3d_status se3di_program_format(const se3d_allocator *allocator, const se3di_instruction *code,
                                 size_t count, const char *const *names, char *text,
                                 size_t capacity, size_t *length)
{
    writer w = {.code = code, .names = names, .text = text, .capacity = text ? capacity : 0};
    w.nodes = se3di_alloc(allocator, count, sizeof *w.nodes);
    if (!w.nodes) {
        return SE3D_ERR_NO_MEMORY;
    }
    put_node(&w, build(&w, 0, count));
    if (w.capacity > 0) {
        text[w.length < w.capacity ? w.length : w.capacity - 1] = '\0';
    }
    *length = w.length;
    se3di_free(allocator, w.nodes, count, sizeof *w.nodes);
    return SE3D_OK;
}
