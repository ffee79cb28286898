/* SPDX-License-Identifier: BSD-3-Clause */
/* Any public function of libse3d with any arguments, from within callbacks too, with an allocator
 * that fails now and then. What must hold: statuses are those of the list; what fails gives no
 * object, and an edit that fails leaves the state; the host's rounding stays; the same calls give
 * the same statuses and outputs, also where the host rounds upwards and flushes small numbers to
 * zero; nothing is left behind. SE3D_FUZZ_TELL=1 tells each call, its status and what came of all
 * so far. */
#define _GNU_SOURCE
#include "functions.h"

#include <fenv.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include "se3d/se3d.h"

enum { PATIENCE = 400 };

unsigned functions_byte(functions *f)
{
    return f->at < f->end ? *f->at++ : 0;
}

void *functions_take(functions *f, size_t size)
{
    functions_block *block = calloc(1, sizeof *block);
    void *memory = calloc(1, size > 0 ? size : 1);
    FUZZ_MUST(block && memory);
    *block = (functions_block){f->blocks, memory};
    f->blocks = block;
    return memory;
}

static void note(functions *f, uint64_t value)
{
    f->trace = (f->trace ^ value) * UINT64_C(1099511628211);
}

static int is_named(const char *name, const char *const *words, size_t count)
{
    for (size_t k = 0; k < count; ++k) {
        if (strstr(name, words[k])) {
            return 1;
        }
    }
    return 0;
}

/* Those that nobody can interrupt, and that work for long. */
static int is_long(const char *name)
{
    static const char *const words[] = {
        "particles_fill_",    "particles_add_source", "particles_run", "particles_step",
        "particles_set_step", "particles_clone",      "batch_create"};
    return is_named(name, words, sizeof words / sizeof *words);
}

/* Functions that make or change something, runs, and all. */
static const layout_function *choose_any(functions *f)
{
    static const char *const changes[] = {"_create", "_add", "_set_"};
    static const char *const runs[] = {"se3d_solver_"};
    const unsigned class = functions_byte(f);
    const size_t wanted = functions_byte(f) << 8 | functions_byte(f);
    const char *const *words = class < 150 ? changes : runs;
    const size_t word_count = class < 150 ? 3 : class < 190 ? 1 : 0;
    size_t fitting = 0, found = layout_function_count;
    for (int pass = 0; pass < 2 && found == layout_function_count; ++pass) {
        size_t at = 0;
        for (size_t k = 0; k < layout_function_count; ++k) {
            const char *name = layout_functions[k].name;
            const int fits =
                !is_long(name) && (word_count == 0 || is_named(name, words, word_count));
            if (pass == 1 && fits && at == wanted % fitting) {
                found = k;
                break;
            }
            at += (size_t)fits;
        }
        fitting = at;
    }
    return &layout_functions[found];
}

/* Whether there is an object of the kind that it is called with. */
static int has_object(const functions *f, const layout_function *call)
{
    if (call->parameter_count == 0) {
        return 1;
    }
    const layout_item *first = &call->parameters[0];
    int has = first->kind != LAYOUT_OWNER || first->pointer;
    for (size_t k = 0; k < f->object_count && !has; ++k) {
        has |= f->objects[k].lives && f->objects[k].kind == first->number;
    }
    return has;
}

static const layout_function *choose(functions *f)
{
    const layout_function *call = choose_any(f);
    for (int k = 0; k < 8 && !has_object(f, call); ++k) {
        call = choose_any(f);
    }
    return call;
}

/* ------------------------------------------------------------------ what comes of a call */

static void bind(functions *f, size_t kind, void *pointer, size_t parent)
{
    for (size_t k = 0; k < f->object_count; ++k) {
        if (f->objects[k].lives && f->objects[k].pointer == pointer) {
            return;
        }
    }
    FUZZ_MUST(f->object_count < FUNCTIONS_OBJECTS);
    f->objects[f->object_count++] = (functions_object){pointer, kind, parent, 1};
}

static void keep(functions *f, const layout_item *item, const unsigned char *at)
{
    const size_t kind = item->number % FUNCTIONS_KINDS;
    memcpy(&f->handles[kind][f->handle_count[kind]++ % FUNCTIONS_KEPT], at, sizeof(uint64_t));
}

/* Numbers without the sign and content of what is not a number. */
static void note_numbers(functions *f, const layout_item *item, const unsigned char *at,
                         size_t count)
{
    for (size_t k = 0; k < count; ++k) {
        double value = 0.0;
        uint64_t bits = 0;
        memcpy(&bits, at + k * item->size, item->size < 8 ? item->size : 8);
        memcpy(&value, &bits, sizeof value);
        note(f, item->is_real && value != value ? 1 : bits);
    }
}

/* Parents: the first object that was passed. */
static size_t parent_of(const functions *f, const layout_function *call, void *const *arguments)
{
    for (size_t k = 0; k < call->parameter_count; ++k) {
        const layout_item *item = &call->parameters[k];
        void *pointer = NULL;
        if (item->kind == LAYOUT_OWNER && !item->pointer) {
            memcpy(&pointer, arguments[k], sizeof pointer);
        }
        for (size_t n = 0; pointer && n < f->object_count; ++n) {
            if (f->objects[n].lives && f->objects[n].pointer == pointer) {
                return n + 1;
            }
        }
    }
    return 0;
}

/* Without an object it is arithmetic of the caller's thread, and rounds as that does. */
static int has_owner(const layout_function *call)
{
    int has = 0;
    for (size_t k = 0; k < call->parameter_count; ++k) {
        has |= call->parameters[k].kind == LAYOUT_OWNER;
    }
    return has;
}

static void take_output(functions *f, const layout_item *item, const unsigned char *at,
                        size_t count, size_t parent, int failed)
{
    void *object = NULL;
    switch (item->kind) {
    case LAYOUT_OWNER:
        memcpy(&object, at, sizeof object);
        FUZZ_MUST(!failed || !object);
        if (object) {
            bind(f, item->number, object, parent);
        }
        break;
    case LAYOUT_HANDLE:
        for (size_t k = 0; !failed && k < count; ++k) {
            keep(f, item, at + k * item->size);
        }
        break;
    case LAYOUT_BYTES:
        note_numbers(f, item, at, failed ? 0 : count);
        break;
    default:
        break;
    }
}

static void take_outputs(functions *f, const layout_function *call, void *const *arguments,
                         size_t parent, int failed)
{
    for (size_t k = 0; k < call->parameter_count; ++k) {
        const layout_item *item = &call->parameters[k];
        const unsigned char *at = NULL;
        if (item->pointer && item->way == LAYOUT_OUT) {
            memcpy(&at, arguments[k], sizeof at);
        }
        if (at && (item->kind != LAYOUT_BYTES || has_owner(call))) {
            const size_t room = layout_count(&f->walk, item, arguments, 1);
            const size_t count = layout_count(&f->walk, item, arguments, 0);
            take_output(f, item, at, count < room ? count : room, parent, failed);
        }
    }
}

static void take_result(functions *f, const layout_function *call, const unsigned char *result)
{
    int32_t status = 0;
    const char *text = NULL;
    if (call->has_status) {
        memcpy(&status, result, sizeof status);
        FUZZ_MUST_SAY(strcmp(se3d_status_get_text(status), "unknown status") != 0, call->name);
        note(f, (uint64_t)(int64_t)status);
    } else if (call->result && call->result->kind == LAYOUT_TEXT) {
        memcpy(&text, result, sizeof text);
        note(f, text ? strlen(text) : 0);
    } else if (call->result && call->result->kind == LAYOUT_BYTES && !call->result->pointer &&
               has_owner(call)) {
        note_numbers(f, call->result, result, 1);
    }
}

/* ------------------------------------------------------------------ calls */

/* An object may go if nothing lives that was made of it; particles go with their system. */
static int may_go(functions *f, const void *pointer)
{
    size_t index = 0;
    for (size_t k = 0; k < f->object_count; ++k) {
        index = f->objects[k].lives && f->objects[k].pointer == pointer ? k + 1 : index;
    }
    int may = index > 0 && f->depth == 0;
    for (size_t k = 0; k < f->object_count; ++k) {
        may &= !(f->objects[k].lives && f->objects[k].parent == index);
    }
    if (may) {
        f->objects[index - 1].lives = 0;
    }
    return may;
}

/* The host's rounding and flags of small numbers. */
static unsigned environment(void)
{
#if defined(__SSE2__)
    return _mm_getcsr() & 0xffc0u;
#else
    return (unsigned)fegetround();
#endif
}

static unsigned enter_environment(int is_odd)
{
#if defined(__SSE2__)
    const unsigned before = _mm_getcsr();
    _mm_setcsr(is_odd ? (before & ~0x6000u) | 0xc040u : before);
    return before;
#else
    return (unsigned)is_odd;
#endif
}

static void leave_environment(unsigned before)
{
#if defined(__SSE2__)
    _mm_setcsr(before);
#else
    (void)before;
#endif
}

/* What is set or made may be rounded as the host does (docs/determinism.md). */
static int is_edit(const char *name)
{
    static const char *const words[] = {"_create", "_set_", "_add", "_init", "_fill"};
    return is_named(name, words, sizeof words / sizeof *words);
}

static int has_system(const layout_function *call)
{
    const layout_item *item = &call->parameters[0];
    return call->has_status && item->kind == LAYOUT_OWNER && !item->pointer &&
           strcmp(layout_owners[item->number], "se3d_system") == 0;
}

/* The state, if it fails. */
static int must_leave(const layout_function *call)
{
    return is_edit(call->name) && has_system(call) &&
           strcmp(call->name, "se3d_modes_create") != 0; /* computes accelerations */
}

void functions_call(functions *f)
{
    const layout_function *call = choose(f);
    const size_t index = (size_t)(call - layout_functions);
    void *arguments[LAYOUT_PARAMETERS_MAX];
    _Alignas(16) unsigned char result[256] = {0};
    const void *definition = f->walk.definition;
    if (f->calls >= FUNCTIONS_CALLS || f->object_count + 4 >= FUNCTIONS_OBJECTS) {
        return;
    }
    ++f->calls;
    functions_make_arguments(f, call, arguments);
    const size_t parent = parent_of(f, call, arguments);
    const void *first = NULL;
    if (call->parameter_count > 0 && call->parameters[0].kind == LAYOUT_OWNER) {
        memcpy(&first, arguments[0], sizeof first);
    }
    if (call->destroys && first && !may_go(f, first)) {
        return;
    }
    if (strcmp(call->name, "se3d_solver_create") == 0) { /* without one there is no interrupt */
        const void *def = NULL;
        memcpy(&def, arguments[1], sizeof def);
        if (!def) {
            return;
        }
    }
    const unsigned fails = functions_byte(f);
    f->allocations = fails >= 235 ? fails % 8 : f->allocations;
    const int changes = first && must_leave(call);
    const uint64_t state = changes ? se3d_system_hash(first) : 0;
    const unsigned host = enter_environment(f->is_odd && !is_edit(call->name));
    const unsigned before = environment();
    player_calls[index](arguments, result);
    FUZZ_MUST_SAY(environment() == before, call->name);
    leave_environment(host);
    f->allocations = f->depth > 0 ? f->allocations : -1;
    int32_t status = 0;
    memcpy(&status, result, call->has_status ? sizeof status : 0);
    FUZZ_MUST_SAY(!changes || status >= 0 || se3d_system_hash(first) == state, call->name);
    take_result(f, call, result);
    take_outputs(f, call, arguments, parent, status < 0);
    if (getenv("SE3D_FUZZ_TELL")) {
        fprintf(stderr, "%*s%s: %d %016llx\n", 2 * f->depth, "", call->name, (int)status,
                (unsigned long long)f->trace);
    }
    f->walk.definition = definition;
}

/* An allocation may fail; sizes of arrays of variables are at most what is made. */
static size_t recall(const layout_walk *walk, const void *key, size_t size)
{
    (void)walk;
    (void)key;
    (void)size;
    return FUNCTIONS_LONGEST;
}

static size_t find_owner(const char *name)
{
    size_t k = 0;
    while (strcmp(layout_owners[k], name) != 0) {
        ++k;
    }
    return k;
}

static void keep_made(functions *f, const char *create, const void *handle)
{
    keep(f, &layout_functions[layout_find(create)].parameters[2], handle);
}

/* Two bodies, one on a hinge, and a ball. */
static void begin_elements(functions *f, se3d_system *system)
{
    static const char *const names[] = {"a", "b"};
    se3d_joint_def joint = se3d_joint_def_default();
    se3d_material_def stuff = se3d_material_def_default();
    se3d_shape_def shape = se3d_shape_def_default();
    se3d_constraint pin;
    se3d_shape ball;
    FUZZ_MUST(!se3d_system_get_ground(system, &joint.body_i));
    keep_made(f, "se3d_body_create", &joint.body_i);
    for (int k = 0; k < 2; ++k) {
        se3d_body_def def = se3d_body_def_default();
        def.name = names[k];
        def.mass = 1.0 + k;
        def.position[0] = k;
        def.inertia[0] = def.inertia[1] = def.inertia[2] = 0.1;
        FUZZ_MUST(!se3d_body_create(system, &def, &joint.body_j));
        keep_made(f, "se3d_body_create", &joint.body_j);
    }
    joint.point_i[2] = 1.0;
    joint.point_j[0] = -1.0;
    FUZZ_MUST(!se3d_joint_create_revolute(system, &joint, &pin));
    keep_made(f, "se3d_joint_create_revolute", &pin);
    stuff.density = 1000.0;
    stuff.stiffness = 1e4;
    FUZZ_MUST(!se3d_material_create(system, &stuff, &shape.material));
    keep_made(f, "se3d_material_create", &shape.material);
    shape.body = joint.body_j;
    shape.radius = 0.1;
    FUZZ_MUST(!se3d_shape_create_sphere(system, &shape, &ball));
    keep_made(f, "se3d_shape_create_sphere", &ball);
}

static void begin(functions *f)
{
    se3d_system *system = NULL;
    se3d_solver *solver = NULL;
    se3d_solver_def how = se3d_solver_def_default();
    se3d_system_def def = se3d_system_def_default();
    def.allocator = functions_allocator(f);
    FUZZ_MUST(!se3d_system_create(&def, &system));
    bind(f, find_owner("se3d_system"), system, 0);
    begin_elements(f, system);
    how.interrupt = fuzz_interrupt;
    how.interrupt_ctx = &f->left;
    FUZZ_MUST(!se3d_solver_create(system, &how, &solver));
    bind(f, find_owner("se3d_solver"), solver, 1);
}

static void end(functions *f)
{
    f->allocations = -1;
    for (int systems = 0; systems < 2; ++systems) {
        for (size_t k = f->object_count; k-- > 0;) {
            functions_object *o = &f->objects[k];
            const int is_system = strcmp(layout_owners[o->kind], "se3d_system") == 0;
            for (size_t n = 0; o->lives && is_system == systems && n < layout_function_count; ++n) {
                if (layout_functions[n].destroys &&
                    layout_functions[n].parameters[0].number == o->kind) {
                    void *arguments[] = {&o->pointer};
                    if (is_system) {
                        se3d_system_set_kept(o->pointer, 0);
                    }
                    player_calls[n](arguments, NULL);
                    o->lives = 0;
                }
            }
        }
    }
    while (f->blocks) {
        functions_block *next = f->blocks->next;
        free(f->blocks->memory);
        free(f->blocks);
        f->blocks = next;
    }
    FUZZ_MUST(f->live == 0);
}

static uint64_t play(const uint8_t *data, size_t size, int is_odd)
{
    functions *f = calloc(1, sizeof *f);
    FUZZ_MUST(f);
    f->walk.recall = recall;
    f->at = data;
    f->end = data + size;
    f->left.left = PATIENCE;
    f->allocations = -1;
    f->is_odd = is_odd;
    begin(f);
    while (f->at < f->end && f->calls < FUNCTIONS_CALLS) {
        functions_call(f);
        ++f->calls;
    }
    end(f);
    const uint64_t trace = f->trace;
    free(f);
    return trace;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const uint64_t trace = play(data, size, 0), other = play(data, size, 1);
    FUZZ_MUST(trace == other);
    return 0;
}
