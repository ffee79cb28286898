/* SPDX-License-Identifier: BSD-3-Clause */
/* Code that a call on a system calls back must not pull the floor away: every public function, from
 * within every kind of callback, in every method. What is refused changes no bit of the run. */
#include "misuse/callback_world.h"

#include <ctype.h>
#include <fenv.h>
#include <stdio.h>
#include <stdlib.h>
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include "joint/joint.h"
#include "model/model.h"

#define DURATION 0.02

typedef enum effect { EDITS = 0, SETS = 1, READS = 2 } effect;

typedef struct row {
    const char *name;
    se3d_status (*call)(world *w);
    effect effect;
} row;

#define EDIT(name, ...)                                                                            \
    static se3d_status do_##name(world *w)                                                         \
    {                                                                                              \
        return se3d_##name(__VA_ARGS__);                                                           \
    }
#define SET EDIT
#define EDIT_VOID(name, ...)                                                                       \
    static se3d_status do_##name(world *w)                                                         \
    {                                                                                              \
        se3d_##name(__VA_ARGS__);                                                                  \
        return se3d_system_get_error_status(w->system);                                            \
    }
#define READ(name, ...)                                                                            \
    static se3d_status do_##name(world *w)                                                         \
    {                                                                                              \
        (void)se3d_##name(__VA_ARGS__);                                                            \
        return SE3D_OK;                                                                            \
    }
#define COPY(name)
#include "misuse/callback_rows.inc"
#undef COPY
#undef EDIT
#undef SET
#undef EDIT_VOID
#undef READ
static se3d_status do_nothing(world *w)
{
    (void)w;
    return SE3D_OK;
}
#define EDIT(name, ...)      {"se3d_" #name, do_##name, EDITS},
#define SET(name, ...)       {"se3d_" #name, do_##name, SETS},
#define EDIT_VOID(name, ...) {"se3d_" #name, do_##name, EDITS},
#define READ(name, ...)      {"se3d_" #name, do_##name, READS},
#define COPY(name)           {"se3d_" #name, do_nothing, READS},

static const row rows[] = {
#include "misuse/callback_rows.inc"
};
#define ROWS (sizeof rows / sizeof *rows)

/* Of particles if there are none. */
static int is_void(const row *r, const world *w)
{
    return !w->particles && strncmp(r->name, "se3d_particles_", 15) == 0 &&
           strcmp(r->name, "se3d_particles_create") != 0;
}

static void refuse_row(world *w, const row *r)
{
    const uint64_t hash = se3d_system_hash(w->system);
    const se3d_status status = r->call(w);
    if (status != SE3D_ERR_STATE || se3d_system_get_error_status(w->system) != SE3D_ERR_STATE ||
        !strstr(se3d_system_get_error(w->system), "not allowed in")) {
        fprintf(stderr, "%s in a %s: %s: %s\n", r->name, kind_names[w->kind],
                se3d_status_get_text(status), se3d_system_get_error(w->system));
        CHECK(status == SE3D_ERR_STATE);
    }
    CHECK(hash == se3d_system_hash(w->system));
}

/* Copies: of what a trial step has left, there are none. */
static void copy_state(world *w)
{
    const int of_event = w->kind == KIND_VALUE || w->kind == KIND_EVENT;
    se3d_system *copy = w->system;
    se3d_snapshot *snapshot = w->snapshot;
    CHECK(se3d_system_clone(w->system, &copy) == (of_event ? SE3D_OK : SE3D_ERR_STATE));
    CHECK(se3d_snapshot_create(w->system, &snapshot) == (of_event ? SE3D_OK : SE3D_ERR_STATE));
    CHECK((copy != NULL) == of_event && (snapshot != NULL) == of_event);
    CHECK(!copy || !se3d_system_is_busy(copy));
    se3d_system_destroy(copy);
    se3d_snapshot_destroy(snapshot);
}

/* Nothing of this may have an effect, nor come back to a callback. */
static void meddle_with_all(world *w)
{
    const int of_event = w->kind == KIND_VALUE || w->kind == KIND_EVENT;
    CHECK(se3d_system_is_busy(w->system) == 1);
    for (size_t k = 0; k < ROWS; ++k) {
        if (is_void(&rows[k], w)) {
            continue;
        }
        if (rows[k].effect == EDITS || (rows[k].effect == SETS && w->kind != KIND_EVENT)) {
            refuse_row(w, &rows[k]);
        }
        const int nested = w->nested;
        if (rows[k].effect == READS && rows[k].call(w) == SE3D_OK && w->nested > nested &&
            !of_event) {
            fprintf(stderr, "%s in a %s calls back\n", rows[k].name, kind_names[w->kind]);
            CHECK(0);
        }
    }
    copy_state(w);
    w->nested = 0;
}

static uint64_t run_with(int32_t method, kind which, void (*meddle)(world *w), int *happened)
{
    world w;
    const se3d_status good = which == KIND_LOG ? SE3D_INFO_REDUNDANT : SE3D_OK;
    world_open_with(&w, method, which == KIND_LOG);
    w.kind = which;
    w.at = which == KIND_EVENT || which == KIND_LOG ? 1 : 3;
    w.meddle = meddle;
    const se3d_status status = se3d_solver_run(w.solver, DURATION);
    if (status != good) {
        fprintf(stderr, "method %d, meddling in a %s: %s\n", (int)method, kind_names[which],
                se3d_system_get_error(w.system));
    }
    CHECK(status == good && !se3d_system_is_busy(w.system));
    *happened = w.calls[which] >= w.at;
    const uint64_t hash = se3d_system_hash(w.system);
    world_close(&w);
    return hash;
}

/* As code that was built with -ffast-math, or another library that was called, may leave it. */
static void leave_rounding_upwards(world *w)
{
    (void)w;
#if defined(FE_UPWARD)
    CHECK(fesetround(FE_UPWARD) == 0);
#endif
#if defined(__SSE2__)
    _mm_setcsr(_mm_getcsr() | 0x8040u);
#endif
}

static const int32_t methods[] = {
    SE3D_METHOD_DOP853, SE3D_METHOD_RADAU,  SE3D_METHOD_BDF,  SE3D_METHOD_GENERALIZED_ALPHA,
    SE3D_METHOD_RATTLE, SE3D_METHOD_VERLET, SE3D_METHOD_GAUSS};

static void no_callback_changes_what_is_being_solved(void)
{
    for (size_t m = 0; m < sizeof methods / sizeof *methods; ++m) {
        int happened;
        const uint64_t hash = run_with(methods[m], KIND_FORCE, NULL, &happened);
        const uint64_t redundant = run_with(methods[m], KIND_LOG, NULL, &happened);
        for (int k = 0; k < KIND_COUNT; ++k) {
            CHECK(run_with(methods[m], (kind)k, meddle_with_all, &happened) ==
                  (k == KIND_LOG ? redundant : hash));
            if (!happened) {
                fprintf(stderr, "method %d calls no %s\n", (int)methods[m], kind_names[k]);
                CHECK(0);
            }
            if (run_with(methods[m], (kind)k, leave_rounding_upwards, &happened) !=
                (k == KIND_LOG ? redundant : hash)) {
                fprintf(stderr, "method %d: rounding of a %s stays\n", (int)methods[m],
                        kind_names[k]);
                CHECK(0);
            }
            CHECK(fegetround() == FE_TONEAREST);
        }
    }
}

static const row *one_setter;

static void set_one(world *w)
{
    if (!is_void(one_setter, w)) {
        CHECK(one_setter->call(w) == SE3D_OK);
    }
}

/* What the callback of an event may do; the run goes on from what it left. */
static void set_all(world *w)
{
    for (size_t k = 0; k < ROWS; ++k) {
        if (rows[k].effect == SETS && !is_void(&rows[k], w)) {
            const se3d_status status = rows[k].call(w);
            if (status != SE3D_OK) {
                fprintf(stderr, "%s in the callback of an event: %s\n", rows[k].name,
                        se3d_system_get_error(w->system));
                CHECK(0);
            }
        }
    }
}

static void the_callback_of_an_event_may_set_values(void)
{
    for (size_t m = 0; m < sizeof methods / sizeof *methods; ++m) {
        for (size_t k = 0; k <= ROWS; ++k) { /* each setter alone, then all */
            world w;
            if (k < ROWS && rows[k].effect != SETS) {
                continue;
            }
            world_open(&w, methods[m]);
            w.kind = KIND_EVENT;
            w.at = 1;
            w.time = 0.001;
            one_setter = k < ROWS ? &rows[k] : NULL;
            w.meddle = k < ROWS ? set_one : set_all;
            const se3d_status status = se3d_solver_run(w.solver, DURATION);
            if (status != SE3D_OK) {
                fprintf(stderr, "method %d, %s in the callback of an event: %s\n", (int)methods[m],
                        k < ROWS ? rows[k].name : "all", se3d_system_get_error(w.system));
                CHECK(0);
            }
            CHECK(w.calls[KIND_EVENT] > 0);
            world_close(&w);
        }
    }
}

/* User code that a query calls, from outside of any run. */
static void edit_and_ask(world *w)
{
    const uint64_t hash = se3d_system_hash(w->system);
    double jet[3] = {0.0}, x = 0.0;
    CHECK(se3d_system_is_busy(w->system) == 1);
    CHECK(se3d_body_set_position(w->system, w->ball, w->r) == SE3D_ERR_STATE);
    CHECK(se3d_function_destroy(w->system, w->value) == SE3D_ERR_STATE);
    CHECK(se3d_solver_run(w->solver, 1.0) == SE3D_ERR_STATE);
    CHECK(se3d_function_eval(w->system, w->value, &x, jet) == SE3D_ERR_STATE);
    CHECK(!se3d_body_get_position(w->system, w->ball, jet));
    CHECK(se3d_system_hash(w->system) == hash);
}

static void a_query_that_calls_back_is_guarded_too(void)
{
    world w;
    double jet[3] = {0.0}, x = 0.25;
    world_open(&w, SE3D_METHOD_DOP853);
    w.kind = KIND_FUNCTION;
    w.at = 1;
    w.calls[KIND_FUNCTION] = 0;
    w.meddle = edit_and_ask;
    CHECK(!se3d_function_eval(w.system, w.value, &x, jet));
    CHECK(w.calls[KIND_FUNCTION] == 1 && w.nested == 0);
    CHECK_NEAR(jet[0], 0.2 * sin(7.5), 1e-15);
    CHECK(!se3d_system_is_busy(w.system));
    CHECK(!se3d_body_set_position(w.system, w.ball, w.r));
    world_close(&w);
}

/* Reports and linearisations call back as runs do. */
static void analyses_without_a_solver_are_guarded(void)
{
    for (int k = 0; k < 2; ++k) {
        world w;
        se3d_check *check = NULL;
        se3d_modes *modes = NULL;
        world_open(&w, SE3D_METHOD_DOP853);
        w.kind = KIND_CONSTRAINT;
        w.at = 1;
        w.calls[KIND_CONSTRAINT] = 0;
        w.meddle = meddle_with_all;
        CHECK((k == 0 ? se3d_check_create(w.system, &check)
                      : se3d_modes_create(w.system, NULL, &modes)) != SE3D_ERR_STATE);
        CHECK(w.calls[KIND_CONSTRAINT] > 0 && !se3d_system_is_busy(w.system));
        se3d_check_destroy(check);
        se3d_modes_destroy(modes);
        world_close(&w);
    }
}

static void particles_that_run_alone_are_guarded(void)
{
    uint64_t hash[2];
    for (int k = 0; k < 2; ++k) {
        world w;
        world_open(&w, SE3D_METHOD_VERLET);
        w.kind = KIND_LAW;
        w.at = 1;
        w.meddle = k == 0 ? NULL : meddle_with_all;
        CHECK(!se3d_particles_run(w.particles, DURATION) && !se3d_system_is_busy(w.system));
        CHECK(w.calls[KIND_LAW] > 0);
        hash[k] = se3d_particles_hash(w.particles);
        world_close(&w);
    }
    CHECK(hash[0] == hash[1]);
}

/* `f_sized` is called by the header's `f`. */
static int has_row(const char *name)
{
    const char *sized = strstr(name, "_sized");
    const size_t length = sized ? (size_t)(sized - name) : strlen(name);
    for (size_t k = 0; k < ROWS; ++k) {
        if (strncmp(rows[k].name, name, length) == 0 && !rows[k].name[length]) {
            return 1;
        }
    }
    return 0;
}

/* Whether a declaration has a parameter of this type, `const` or not. */
static int takes(const char *declaration, const char *type)
{
    for (const char *at = strstr(declaration, type); at; at = strstr(at + 1, type)) {
        const size_t n = strlen(type);
        if ((at[-1] == '(' || at[-1] == ' ') && strncmp(at + n, " *", 2) == 0 && at[n + 2] != '*') {
            return 1;
        }
    }
    return 0;
}

/* A declaration that begins at SE3D_API, on one line. @return its end */
static const char *read_declaration(const char *from, char *text, size_t size)
{
    size_t n = 0;
    for (; *from && *from != ';'; ++from) {
        if (n + 1 < size && !(isspace((unsigned char)*from) && n > 0 && text[n - 1] == ' ')) {
            text[n++] = isspace((unsigned char)*from) ? ' ' : *from;
        }
    }
    text[n] = '\0';
    return from;
}

/* Owners that are a part of a system, or work on one. */
static const char *const owners[] = {"se3d_system", "se3d_solver", "se3d_particles",
                                     "se3d_coordinates"};
/* Those that have nothing of a system any more once they were made, or one of their own
 * (property.batch has their rows; those of libse3d-io are in misuse.io_functions). */
static const char *const others[] = {"se3d_batch", "se3d_check", "se3d_expression",
                                     "se3d_model", "se3d_modes", "se3d_snapshot",
                                     "se3d_run",   "se3d_scene"};
#define COUNT(list) (sizeof(list) / sizeof *(list))

static int takes_owner(const char *declaration)
{
    int does = 0;
    for (size_t k = 0; k < COUNT(owners); ++k) {
        does |= takes(declaration, owners[k]);
    }
    return does;
}

static int is_listed(const char *name, const char *const *list, size_t count)
{
    int is = 0;
    for (size_t k = 0; k < count; ++k) {
        is |= strcmp(name, list[k]) == 0;
    }
    return is;
}

static int check_functions(const char *text)
{
    int count = 0;
    char declaration[1024];
    for (text = strstr(text, "\nSE3D_API "); text; text = strstr(text, "\nSE3D_API ")) {
        text = read_declaration(text + 1, declaration, sizeof declaration);
        char *open = strchr(declaration, '(');
        if (!open || !takes_owner(open)) {
            continue;
        }
        *open = '\0';
        const char *name = strrchr(declaration, ' ');
        name = name ? strstr(name, "se3d_") : NULL;
        ++count;
        if (!name || !has_row(name)) {
            fprintf(stderr, "%s has no row in callback_rows.inc\n", name ? name : declaration);
            CHECK(0);
        }
    }
    return count;
}

/* Every type that is only declared: "typedef struct x x;". */
static int check_owners(const char *text)
{
    int count = 0;
    char name[64], again[64], end[2];
    for (text = strstr(text, "\ntypedef struct "); text; text = strstr(text, "\ntypedef struct ")) {
        text += 1;
        if (sscanf(text, "typedef struct %63[a-z0-9_] %63[a-z0-9_]%1[;]", name, again, end) == 3) {
            ++count;
            if (!is_listed(name, owners, COUNT(owners)) &&
                !is_listed(name, others, COUNT(others))) {
                fprintf(stderr, "%s is neither in `owners` nor in `others`\n", name);
                CHECK(0);
            }
        }
    }
    return count;
}

static void read_header(const char *name, char *text, size_t size)
{
    char path[1024];
    const char *folder = getenv("SE3D_SOURCE_DIR");
    snprintf(path, sizeof path, "%s/include/%s", folder ? folder : ".", name);
    FILE *file = fopen(path, "r");
    CHECK(file != NULL);
    text[file ? fread(text, 1, size - 1, file) : 0] = '\0';
    if (file) {
        fclose(file);
    }
}

/* In the headers that se3d.h includes. */
static void every_public_function_on_a_system_has_a_row(void)
{
    static char all[20000], text[200000];
    char name[100];
    int headers = 0, functions = 0, types = 0;
    read_header("se3d/se3d.h", all, sizeof all);
    for (const char *at = strstr(all, "\n#include \""); at; at = strstr(at + 1, "\n#include \"")) {
        if (sscanf(at, "\n#include \"%99[^\"]", name) == 1) {
            read_header(name, text, sizeof text);
            ++headers;
            functions += check_functions(text);
            types += check_owners(text);
        }
    }
    CHECK(headers > 20 && functions > 200 && types == COUNT(owners) + COUNT(others));
}

int main(void)
{
    RUN(every_public_function_on_a_system_has_a_row);
    RUN(no_callback_changes_what_is_being_solved);
    RUN(the_callback_of_an_event_may_set_values);
    RUN(a_query_that_calls_back_is_guarded_too);
    RUN(analyses_without_a_solver_are_guarded);
    RUN(particles_that_run_alone_are_guarded);
    return check_finish();
}
