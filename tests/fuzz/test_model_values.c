/* SPDX-License-Identifier: BSD-3-Clause */
/* Values of the example models made hostile one by one: the reader takes the
 * model or says where and why not, and what it takes is checked and moved two
 * steps without NaN or infinity. SE3D_FUZZ_ROUNDS multiplies the work,
 * SE3D_FUZZ_SEED begins elsewhere. */
#define _POSIX_C_SOURCE 200809L

#include <stdlib.h>

#include "check.h"
#include "se3d/io.h"
#include "se3d/se3d.h"
#include "support/examples.h"

enum { TEXT_MAX = 1 << 17, MODELS_MAX = 72, VALUES_MAX = 4000, TRIES = 600 };

typedef struct example {
    char path[900];
    char text[TEXT_MAX / 2];
    size_t length;
    size_t begin[VALUES_MAX], end[VALUES_MAX]; /* of its values */
    size_t count;
} example;

static example examples[MODELS_MAX];
static size_t example_count;

static const char *const hostile[] = {
    "nan",
    ".nan",
    "inf",
    "-inf",
    "1e400",
    "-1e400",
    "1e308",
    "-1e308",
    "5e-324",
    "-0",
    "0",
    "-1",
    "1",
    "3",
    "1e30",
    "1e-30",
    "1.5",
    "999999999999999999999",
    "''",
    "\"\"",
    "~",
    "true",
    "0x10",
    "1e",
    "--1",
    "[]",
    "{}",
    "[1]",
    "[0, 0, 0]",
    "[.nan, 1, 1]",
    "{spline: [[0, 0], [1e-320, 1e308]]}",
    "{spline: [[0, 0], [1, 1]]}",
    "t",
    "1/0",
    "0/0",
    "sqrt(-1)",
    "1/t",
    "\"pow(t, t)\"",
    "exp(1000*t)",
    "sin(1e300*t)",
    "abs(t-0.001)",
    "unknown",
    "ground",
    "\xC3\xA9\xE4\xB8\xAD\xF0\x9F\x98\x80",
    "\xEF\xBF\xBD",
    "\"\\u0000\"",
    "\"\\e[2J\"",
    "\"a\\nb\"",
    "'%s%n%x'",
    "/dev/zero",
    "../../../../../../etc/passwd",
    "plane",
    "sphere",
    "mesh",
    "verlet",
    "equilibrium",
    "modes",
};
#define HOSTILE (sizeof hostile / sizeof hostile[0])

static size_t pick(uint64_t *seed, size_t count)
{
    return (size_t)(0.5 * (check_random(seed) + 1.0) * (double)count) % count;
}

/* Values stand after `: `, `[`, `, ` and `- `, and end before a mark of flow
 * style or a line's. */
static void find_values(example *e)
{
    for (size_t k = 2; k < e->length && e->count < VALUES_MAX; ++k) {
        const char *at = e->text + k;
        const int begins =
            (at[-1] == ' ' && strchr(":,-", at[-2])) || at[-1] == '[' || at[-1] == '{';
        const size_t length = strcspn(at, ",]}\n#:");
        if (begins && length > 0 && at[length] != ':' && !strchr("[{ -", *at)) {
            e->begin[e->count] = k;
            e->end[e->count++] = k + length;
        }
    }
}

static int read_example(const char *path, const char *name)
{
    (void)name;
    CHECK(example_count < MODELS_MAX);
    example *e = &examples[example_count++];
    snprintf(e->path, sizeof e->path, "%s", path);
    FILE *file = fopen(path, "rb");
    e->length = file ? fread(e->text, 1, sizeof e->text - 1, file) : 0;
    CHECK(file && fclose(file) == 0);
    find_values(e);
    CHECK(e->count > 10);
    return 1;
}

/* Expressions, names and lists that are long and deep. */
static size_t put_long(char *to, uint64_t *seed)
{
    static const char *const pieces[] = {"(", "-", "sin(", "1+",      "t*",
                                         "x", "[", "{a: ", "\xC3\xA9"};
    const char *piece = pieces[pick(seed, sizeof pieces / sizeof *pieces)];
    const size_t times = 1 + pick(seed, 3000);
    size_t length = 0;
    for (size_t k = 0; k < times; ++k) {
        length += (size_t)sprintf(to + length, "%s", piece);
    }
    return length + (size_t)sprintf(to + length, "1");
}

/* The example with one value replaced, or a line of it twice. @return the
 * length */
static size_t spoil(const example *e, char *text, uint64_t *seed)
{
    const size_t which = pick(seed, e->count);
    const size_t kind = pick(seed, 12);
    size_t length = e->begin[which];
    memcpy(text, e->text, length);
    if (kind == 0) { /* the key again: the part of the line from its beginning */
        size_t line = length;
        while (line > 0 && e->text[line - 1] != '\n') {
            --line;
        }
        const size_t size = strcspn(e->text + line, "\n") + 1;
        memcpy(text, e->text, line + size);
        memcpy(text + line + size, e->text + line, e->length - line);
        return e->length + size;
    }
    if (kind == 1) {
        length += put_long(text + length, seed);
    } else {
        length += (size_t)sprintf(text + length, "%s", hostile[pick(seed, HOSTILE)]);
    }
    memcpy(text + length, e->text + e->end[which], e->length - e->end[which]);
    return length + e->length - e->end[which];
}

static int is_finite(const se3d_system *system)
{
    int finite = 1;
    for (size_t k = 0; k < se3d_system_count_bodies(system); ++k) {
        se3d_body body = {0, 0};
        double r[3], v[3];
        se3d_system_get_body(system, k, &body);
        se3d_body_get_position(system, body, r);
        se3d_body_get_velocity(system, body, v);
        for (int i = 0; i < 3; ++i) {
            finite = finite && isfinite(r[i]) && isfinite(v[i]);
        }
    }
    return finite;
}

static void check_and_move(se3d_model *model)
{
    se3d_system *system = se3d_model_get_system(model);
    se3d_check *check = NULL;
    se3d_solver *solver = NULL;
    se3d_solver_def how = se3d_solver_def_default();
    const se3d_status checked = se3d_check_create(system, &check);
    CHECK(checked >= 0 || se3d_system_get_error(system)[0] != '\0');
    se3d_check_destroy(check);
    how.method = SE3D_METHOD_GENERALIZED_ALPHA;
    how.step = 1e-4;
    if (se3d_solver_create(system, &how, &solver) >= 0) {
        const se3d_status status = se3d_solver_run(solver, 2e-4);
        CHECK(status >= 0 || se3d_system_get_error(system)[0] != '\0');
    }
    CHECK(is_finite(system));
    se3d_solver_destroy(solver);
}

/* Nothing in a message may move a cursor; it begins with the place, in the file
 * or in one that it includes. */
static int is_message(const char *text, const char *path)
{
    const char *slash = strrchr(path, '/');
    const size_t folder = slash ? (size_t)(slash - path) + 1 : 0;
    int printable =
        strncmp(text, path, strlen(path)) == 0 ||
        (strncmp(text, path, folder) == 0 && strstr(text, "; included at ") && strstr(text, path));
    for (const char *c = text; *c; ++c) {
        printable = printable && (unsigned char)*c >= ' ' && *c != 0x7F;
    }
    return printable;
}

/* @return whether the reader took it */
static int try_text(const example *e, const char *text, size_t length)
{
    se3d_model *model = NULL;
    se3d_model_error error = {0, 0, ""};
    const int failures = check_failures;
    const se3d_status status = se3d_model_read_text(text, length, e->path, NULL, &model, &error);
    CHECK(status == SE3D_OK || status == SE3D_ERR_MODEL || status == SE3D_ERR_NO_MEMORY);
    CHECK((status == SE3D_OK) == (model != NULL));
    CHECK(status != SE3D_ERR_MODEL || is_message(error.message, e->path));
    if (model) {
        check_and_move(model);
    }
    if (check_failures > failures) {
        fprintf(stderr, "  %s\n%.*s\n", error.message, (int)length, text);
    }
    se3d_model_destroy(model);
    return status == SE3D_OK;
}

static long get_number(const char *name, long otherwise)
{
    const char *text = getenv(name);
    return text ? atol(text) : otherwise;
}

static void hostile_values_are_refused_or_harmless(void)
{
    static char text[TEXT_MAX];
    uint64_t seed = (uint64_t)get_number("SE3D_FUZZ_SEED", 20260101);
    const long tries = TRIES * get_number("SE3D_FUZZ_ROUNDS", 1);
    long taken = 0;
    support_visit_examples(read_example);
    for (long k = 0; k < tries; ++k) {
        const example *e = &examples[pick(&seed, example_count)];
        const size_t length = spoil(e, text, &seed);
        taken += try_text(e, text, length);
    }
    CHECK(taken > tries / 100 && taken < tries);
}

static size_t line_of(const char *text, size_t at)
{
    size_t line = 1;
    for (size_t k = 0; k < at; ++k) {
        line += text[k] == '\n';
    }
    return line;
}

/* A list of lists, or a map with an unknown key, is the value of few keys: it
 * is refused in its line. */
static void each_value_of_each_example_is_refused_in_its_line(void)
{
    static char text[TEXT_MAX];
    static const char *const words[] = {"[[x]]", "{x: 1}"};
    size_t tried = 0, refused = 0, there = 0;
    for (size_t n = 0; n < example_count; ++n) {
        const example *e = &examples[n];
        for (size_t k = 0; k < e->count; ++k) {
            const char *wrong = words[(n + k) % 2];
            const size_t size = strlen(wrong);
            se3d_model *model = NULL;
            se3d_model_error error;
            memcpy(text, e->text, e->begin[k]);
            memcpy(text + e->begin[k], wrong, size);
            memcpy(text + e->begin[k] + size, e->text + e->end[k], e->length - e->end[k]);
            const size_t length = e->length - (e->end[k] - e->begin[k]) + size;
            const se3d_status status =
                se3d_model_read_text(text, length, e->path, NULL, &model, &error);
            CHECK(status == SE3D_OK || (status == SE3D_ERR_MODEL && error.message[0]));
            ++tried;
            refused += status == SE3D_ERR_MODEL;
            there += status == SE3D_ERR_MODEL && error.line == line_of(e->text, e->begin[k]);
            se3d_model_destroy(model);
        }
    }
    CHECK(tried > 2000);
    CHECK(refused > tried - tried / 10 && there > refused - refused / 10);
}

/* The end of a value of flow style that begins at `at`. */
static size_t end_of_value(const char *text, size_t at)
{
    size_t depth = 0;
    for (char quote = '\0'; text[at]; ++at) {
        const char c = text[at];
        if (quote) {
            quote = c == quote ? '\0' : quote;
        } else if (c == '"' || c == '\'') {
            quote = c;
        } else if (strchr("[{", c)) {
            ++depth;
        } else if (depth > 0 && strchr("]}", c)) {
            --depth;
        } else if (depth == 0 && strchr(",]}\n", c)) {
            break;
        }
    }
    return at;
}

/* The end of the lines that are deeper than a key at `column`. */
static size_t end_of_block(const char *text, size_t at, size_t column)
{
    while (text[at] == '\n' && text[at + 1]) {
        const size_t indent = strspn(text + at + 1, " ");
        const char first = text[at + 1 + indent];
        if (first != '\n' && indent <= column && !(indent == column && first == '-')) {
            break;
        }
        at += 1 + strcspn(text + at + 1, "\n");
    }
    return at;
}

/* The key that begins at `at`, with its value and a comma. @return its end, `at`: there is none. */
static size_t end_of_entry(const char *text, size_t at)
{
    static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";
    const size_t length = strspn(text + at, letters);
    size_t line = at;
    if (length == 0 || (at > 0 && !strchr("\n {", text[at - 1])) || text[at + length] != ':' ||
        !strchr(" \n", text[at + length + 1])) {
        return at;
    }
    while (line > 0 && text[line - 1] != '\n') {
        --line;
    }
    const size_t value = at + length + 1 + strspn(text + at + length + 1, " ");
    const size_t end =
        text[value] == '\n' ? end_of_block(text, value, at - line) : end_of_value(text, value);
    return end + (text[end] == ',' ? 1 + strspn(text + end + 1, " ") : 0);
}

static void count_mistakes(void *ctx, const se3d_model_error *error)
{
    *(size_t *)ctx += error->message[0] != '\0';
}

/* Each third key of a model, or with SE3D_LONG each one, with its value taken away; all mistakes
 * are looked for. @return how many */
static size_t take_away(const example *e)
{
    static char text[TEXT_MAX];
    size_t tried = 0, found = 0;
    for (size_t at = 0; at < e->length; ++at) {
        const size_t end = end_of_entry(e->text, at);
        found += end > at;
        if (end > at && (check_is_long() || found % 3 == 0)) {
            se3d_model *model = NULL;
            se3d_model_error error;
            size_t mistakes = 0;
            se3d_model_options options = se3d_model_options_default();
            options.report = count_mistakes;
            options.report_ctx = &mistakes;
            memcpy(text, e->text, at);
            memcpy(text + at, e->text + end, e->length - end);
            const se3d_status status = se3d_model_read_text(text, e->length - (end - at), e->path,
                                                            &options, &model, &error);
            CHECK(status == SE3D_OK ? mistakes == 0
                                    : status == SE3D_ERR_MODEL && mistakes > 0 &&
                                          is_message(error.message, e->path));
            se3d_model_destroy(model);
            ++tried;
        }
    }
    return tried;
}

static void no_key_is_missed(void)
{
    static const char *const seeds[] = {"contact", "forces",         "guests", "joints",
                                        "states",  "study_optimize", "study"};
    const char *root = getenv("SE3D_SOURCE_DIR");
    char path[900];
    size_t tried = 0;
    for (size_t k = 0; k < sizeof seeds / sizeof *seeds; ++k) {
        snprintf(path, sizeof path, "%.500s/fuzz/seeds/model/%s.yaml", root ? root : ".", seeds[k]);
        read_example(path, seeds[k]);
    }
    for (size_t n = 0; n < example_count; ++n) {
        tried += take_away(&examples[n]);
    }
    CHECK(tried > (check_is_long() ? 4000 : 1300));
}

int main(void)
{
    RUN(hostile_values_are_refused_or_harmless);
    RUN(each_value_of_each_example_is_refused_in_its_line);
    RUN(no_key_is_missed);
    return check_finish();
}
