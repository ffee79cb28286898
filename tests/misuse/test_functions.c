/* SPDX-License-Identifier: BSD-3-Clause */
/* One row for every public function: what is needed, and what happens where it is spoiled.
 *
 * The letters of `needs` say which arguments a case spoils, one at a time:
 *     S s  the system: NULL. S: not const, so that every failure records a message
 *     b m c d f F w r z
 *                  a handle (body, marker, joint, second joint, function, force, wheel, road,
 *                  state):
 *                  null, stale and of another system
 *     i<n> a vector of n numbers: NULL; NaN and infinity in every place
 *     j    a pointer to numbers that may hold anything: NULL     n  a number: NaN, infinity
 *     t    a text: NULL        x  an index: too large
 *     o<k> output k: NULL      h<k>  output k is a handle or owner: also nulled on failure
 *     D    a def: NULL, struct_size 0 and too large, and its fields
 *     v p k e  solver, snapshot, check, expression: NULL
 *
 * Every row must succeed unspoiled; a row whose call returns nothing checks itself. */
#include "misuse/element_defs.h"
#include "misuse/misuse_world.h"

#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct row {
    const char *name;
    se3d_status (*call)(arguments *a);
    const char *needs;
    void (*define)(arguments *a); /* fills a->storage */
    const field *fields;          /* NULL: no definition */
} row;

#define CALL(name, ...)                                                                            \
    static se3d_status call_##name(arguments *a)                                                   \
    {                                                                                              \
        return se3d_##name(__VA_ARGS__);                                                           \
    }

#include "misuse/misuse_calls.h"

typedef struct census {
    size_t bodies, markers, constraints, forces;
    uint64_t hash;
} census;

static census census_of(const se3d_system *s)
{
    return (census){se3d_system_count_bodies(s), se3d_system_count_markers(s),
                    se3d_system_count_constraints(s), se3d_system_count_forces(s),
                    se3d_system_hash(s)};
}

static int census_equal(const census *a, const census *b)
{
    return a->bodies == b->bodies && a->markers == b->markers && a->constraints == b->constraints &&
           a->forces == b->forces && a->hash == b->hash;
}

static void arguments_open(arguments *a, const misuse_world *w, const row *r)
{
    *a = (arguments){.use = w->live, .number = 1.0, .text = "taken"};
    CHECK(!se3d_system_clone(w->system, &a->system));
    a->vector[0] = 1.0;
    a->vector[4] = 1.0;
    a->in = a->vector;
    memset(a->out_storage, 0x5A, sizeof a->out_storage);
    for (int k = 0; k < 4; ++k) {
        a->out[k] = a->out_storage[k];
    }
    if (r->define) {
        r->define(a);
    }
    a->def = &a->storage;
    se3d_solver_def solver = se3d_solver_def_default();
    solver.analysis = SE3D_ANALYSIS_ASSEMBLY;
    CHECK(!se3d_solver_create(a->system, &solver, &a->solver));
    CHECK(!se3d_snapshot_create(a->system, &a->snapshot));
    CHECK(se3d_check_create(a->system, &a->check) >= 0);
    const char *const variable = "t";
    se3d_expression_def text = se3d_expression_def_default();
    text.text = "2*t";
    text.variables = &variable;
    text.variable_count = 1;
    CHECK(!se3d_expression_create(&text, &a->expression, NULL));
}

static void arguments_close(arguments *owned)
{
    se3d_expression_destroy(owned->expression);
    se3d_check_destroy(owned->check);
    se3d_snapshot_destroy(owned->snapshot);
    se3d_solver_destroy(owned->solver);
    se3d_system_destroy(owned->system);
}

/* What a case does to the arguments, and what must come of it. */
typedef struct spoiled {
    char what;
    size_t place;
    int variant; /* of handles: null, stale, foreign; of numbers: NaN, infinity */
    const field *member;
} spoiled;

static const handles *variant_of(const misuse_world *w, int variant)
{
    return variant == 0 ? &w->none : variant == 1 ? &w->stale : &w->foreign;
}

static const double bad_numbers[3] = {(double)NAN, (double)INFINITY, -(double)INFINITY};

static void spoil_field(arguments *a, const misuse_world *w, const spoiled *s)
{
    char *place = (char *)&a->storage + s->member->offset;
    const handles *bad = variant_of(w, s->variant);
    const char *const taken = "taken";
    switch (s->member->kind) {
    case 'd':
        memcpy(place + s->place * sizeof(double), &bad_numbers[s->variant], sizeof(double));
        break;
    case 'b':
        memcpy(place, &bad->body, sizeof bad->body);
        break;
    case 'c':
        memcpy(place, &bad->pin, sizeof bad->pin);
        break;
    case 'f':
        memcpy(place + s->place * sizeof bad->function, &bad->function, sizeof bad->function);
        break;
    default:
        memcpy(place, &taken, sizeof taken);
        break;
    }
}

static void spoil_handle(arguments *a, const misuse_world *w, const spoiled *s)
{
    const handles *bad = variant_of(w, s->variant);
    switch (s->what) {
    case 'b':
        a->use.body = bad->body;
        break;
    case 'm':
        a->use.marker = bad->marker;
        break;
    case 'w':
        a->use.wheel = bad->wheel;
        break;
    case 'r':
        a->use.road = bad->road;
        break;
    case 'z':
        a->use.state = bad->state;
        break;
    case 'c':
        a->use.pin = bad->pin;
        a->use.driver = bad->driver;
        a->use.primitive = bad->primitive;
        break;
    case 'd':
        a->use.slide = bad->slide;
        break;
    case 'f':
        a->use.function = bad->function;
        break;
    default:
        a->use.force = bad->force;
        break;
    }
}

static se3d_status spoil_pointer(arguments *a, const spoiled *s)
{
    switch (s->what) {
    case 's':
    case 'S':
        a->system = NULL;
        break;
    case 'i':
    case 'j':
        a->in = NULL;
        break;
    case 't':
        a->text = NULL;
        break;
    case 'v':
        a->solver = NULL;
        break;
    case 'p':
        a->snapshot = NULL;
        break;
    case 'k':
        a->check = NULL;
        break;
    case 'e':
        a->expression = NULL;
        break;
    case 'D':
        a->def = NULL;
        break;
    default:
        a->out[s->place] = NULL;
        break;
    }
    return SE3D_ERR_NULL;
}

/* Returns the status to expect. */
static se3d_status spoil(arguments *a, const misuse_world *w, const spoiled *s)
{
    switch (s->what) {
    case 'M': /* a member of the def */
        spoil_field(a, w, s);
        return s->member->kind == 'd' || s->member->kind == 'N' ? SE3D_ERR_INVALID_ARGUMENT
                                                                : SE3D_ERR_STALE_HANDLE;
    case 'V':
        a->vector[s->place] = bad_numbers[s->variant];
        return SE3D_ERR_INVALID_ARGUMENT;
    case 'n':
        a->number = bad_numbers[s->variant];
        return SE3D_ERR_INVALID_ARGUMENT;
    case 'x':
        a->index = 1000000;
        return SE3D_ERR_INVALID_ARGUMENT;
    case 'Z': /* struct_size: none, or of a newer header that sets something new */
        a->storage.numbers[s->variant ? a->storage.struct_size / sizeof(double) : 1] = 1.0;
        a->storage.struct_size = s->variant ? a->storage.struct_size + sizeof(double) : 0;
        return SE3D_ERR_INVALID_ARGUMENT;
    case 'b':
    case 'm':
    case 'w':
    case 'r':
    case 'z':
    case 'c':
    case 'd':
    case 'f':
    case 'F':
        spoil_handle(a, w, s);
        return SE3D_ERR_STALE_HANDLE;
    default:
        return spoil_pointer(a, s);
    }
}

/* Handle and owner outputs: an owner is a pointer, a handle two words; both start with 8 bytes. */
static void check_outputs_nulled(const row *r, const arguments *a)
{
    for (const char *n = strchr(r->needs, 'h'); n; n = strchr(n + 1, 'h')) {
        const void *out = a->out[n[1] - '0'];
        static const unsigned char zero[8] = {0};
        if (out && memcmp(out, zero, sizeof zero) != 0) {
            fprintf(stderr, "%s: output %c is not nulled\n", r->name, n[1]);
            CHECK(0);
        }
    }
}

static void check_message(const row *r, const arguments *owned, const spoiled *s,
                          se3d_status status)
{
    if (!strchr(r->needs, 'S') || s->what == 'S') {
        return;
    }
    const char *message = se3d_system_get_error(owned->system);
    int is_number = s->what == 'V' || s->what == 'n' || (s->what == 'M' && s->member->kind == 'd');
    if (se3d_system_get_error_status(owned->system) != status || !message[0]) {
        fprintf(stderr, "%s (%c): no message\n", r->name, s->what);
        CHECK(0);
    }
    if (is_number) {
        CHECK_CONTAINS(message, s->variant == 0 ? "nan" : "inf");
    }
    const char *about = se3d_system_get_error_field(owned->system);
    if (strncmp(message, about, strlen(about)) != 0 || (is_number && !about[0])) {
        fprintf(stderr, "%s (%c): `%s` is about '%s'\n", r->name, s->what, message, about);
        CHECK(0);
    }
}

static void run_case(const misuse_world *w, const row *r, const spoiled *s)
{
    arguments owned, a;
    arguments_open(&owned, w, r);
    a = owned;
    a.in = a.vector;
    a.def = &a.storage;
    for (int k = 0; k < 4; ++k) {
        a.out[k] = a.out_storage[k];
    }
    census before = census_of(owned.system);
    se3d_status expected = spoil(&a, w, s);
    se3d_status status = r->call(&a);
    if (status != expected) {
        fprintf(stderr, "%s (%c%s, place %zu, variant %d): %s, expected %s: %s\n", r->name, s->what,
                s->member ? (char[2]){s->member->kind, 0} : "", s->place, s->variant,
                se3d_status_get_text(status), se3d_status_get_text(expected),
                se3d_system_get_error(owned.system));
        CHECK(status == expected);
    } else {
        CHECK(status < 0);
        check_message(r, &owned, s, status);
        check_outputs_nulled(r, &a);
    }
    census after = census_of(owned.system);
    if (!census_equal(&before, &after)) {
        fprintf(stderr, "%s (%c): a failing call changed the system\n", r->name, s->what);
        CHECK(0);
    }
    arguments_close(&owned);
}

static void run_variants(const misuse_world *w, const row *r, spoiled s, int variants)
{
    for (s.variant = 0; s.variant < variants; ++s.variant) {
        run_case(w, r, &s);
    }
}

static void run_def_cases(const misuse_world *w, const row *r)
{
    run_case(w, r, &(spoiled){.what = 'D'});
    run_variants(w, r, (spoiled){.what = 'Z'}, 2);
    for (const field *f = r->fields; f && f->name; ++f) {
        const int is_tried = strchr("dbcfN", f->kind) != NULL;
        for (size_t k = 0; is_tried && k < f->count; ++k) {
            spoiled s = {.what = 'M', .place = k, .member = f};
            if (f->kind == 'f') { /* null is allowed */
                for (s.variant = 1; s.variant < 3; ++s.variant) {
                    run_case(w, r, &s);
                }
            } else {
                run_variants(w, r, s, f->kind == 'N' ? 1 : 3);
            }
        }
    }
}

static void run_row(const misuse_world *w, const row *r)
{
    for (const char *n = r->needs; *n; ++n) {
        size_t digit = n[1] >= '0' && n[1] <= '9' ? (size_t)(n[1] - '0') : 0;
        spoiled s = {.what = *n, .place = digit};
        if (*n >= '0' && *n <= '9') {
            continue;
        }
        if (*n == 'D') {
            run_def_cases(w, r);
        } else if (strchr("bmcdfFwrzn", *n)) {
            run_variants(w, r, s, 3);
        } else {
            run_case(w, r, &s);
        }
        for (size_t k = 0; *n == 'i' && k < digit; ++k) {
            run_variants(w, r, (spoiled){.what = 'V', .place = k}, 3);
        }
    }
}

static void every_function_rejects_every_bad_argument(void)
{
    misuse_world w;
    misuse_world_open(&w);
    for (size_t k = 0; k < sizeof rows / sizeof rows[0]; ++k) {
        arguments a;
        arguments_open(&a, &w, &rows[k]);
        se3d_status status = rows[k].call(&a);
        if (status < 0) {
            fprintf(stderr, "%s: %s: %s\n", rows[k].name, se3d_status_get_text(status),
                    se3d_system_get_error(a.system));
        }
        CHECK(status >= 0);
        arguments_close(&a);
        run_row(&w, &rows[k]);
    }
    misuse_world_close(&w);
}

static void a_newer_header_is_taken_where_it_sets_nothing_new(void)
{
    misuse_world w;
    int count = 0;
    misuse_world_open(&w);
    for (size_t k = 0; k < sizeof rows / sizeof rows[0]; ++k) {
        arguments a;
        if (!strchr(rows[k].needs, 'D')) {
            continue;
        }
        arguments_open(&a, &w, &rows[k]);
        a.storage.struct_size += 64;
        const se3d_status status = rows[k].call(&a);
        if (status < 0) {
            fprintf(stderr, "%s: %s\n", rows[k].name, se3d_system_get_error(a.system));
        }
        CHECK(status >= 0);
        a.storage.numbers[a.storage.struct_size / sizeof(double) - 1] = 1.0;
        CHECK(rows[k].call(&a) == SE3D_ERR_INVALID_ARGUMENT);
        CHECK_CONTAINS(se3d_system_get_error(a.system), "newer header");
        ++count;
        arguments_close(&a);
    }
    CHECK(count > 20);
    misuse_world_close(&w);
}

/* `f_sized` is called by the header's `f`. */
static int has_row(const char *name)
{
    const char *sized = strstr(name, "_sized");
    const size_t length = sized ? (size_t)(sized - name) : strlen(name);
    for (size_t k = 0; k < sizeof rows / sizeof rows[0]; ++k) {
        if (strncmp(rows[k].name, name, length) == 0 && !rows[k].name[length]) {
            return 1;
        }
    }
    return 0;
}

/* The map lists every public function: a test of its own compares it with headers and exports. */
static void every_public_function_has_a_row(void)
{
    const char *folder = getenv("SE3D_SOURCE_DIR");
    char path[1024], line[256];
    int count = 0;
    snprintf(path, sizeof path, "%s/lib/se3d.map", folder ? folder : ".");
    FILE *map = fopen(path, "r");
    CHECK(map != NULL);
    while (map && fgets(line, sizeof line, map)) {
        char *name = strstr(line, "se3d_");
        char *end = name ? strchr(name, ';') : NULL;
        if (!end) {
            continue;
        }
        *end = 0;
        ++count;
        if (!has_row(name)) {
            fprintf(stderr, "%s has no row in tests/misuse\n", name);
            CHECK(0);
        }
    }
    CHECK(count > 100);
    if (map) {
        fclose(map);
    }
}

int main(void)
{
    RUN(every_public_function_has_a_row);
    RUN(every_function_rejects_every_bad_argument);
    RUN(a_newer_header_is_taken_where_it_sets_nothing_new);
    return check_finish();
}
