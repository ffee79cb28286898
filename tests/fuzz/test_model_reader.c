/* SPDX-License-Identifier: BSD-3-Clause */
/* The model reader on damaged, hostile and unusual texts: it must come back with a model or with a
 * message, and never with a crash. Run under the sanitizers. */
#include <stdlib.h>

#include "check.h"
#include "se3d/io.h"
#include "support/damage.h"

static const char *const models[] = {
    "pendulum",           "double_pendulum", "spatial_slider_crank", "planar_slider_crank",
    "fourbar_kinematics", "bar_rsda_tsda",   "me751_jacobian",       "fourbar"};
enum { MODELS = sizeof models / sizeof *models, TEXT_MAX = 65536, ITERATIONS = 5000 };

static char texts[MODELS][TEXT_MAX];
static size_t lengths[MODELS];

static void read_examples(void)
{
    const char *source = getenv("SE3D_SOURCE_DIR");
    for (size_t k = 0; k < MODELS; ++k) {
        char path[800];
        snprintf(path, sizeof path, "%s/examples/models/%s.yaml", source ? source : ".", models[k]);
        FILE *file = fopen(path, "rb");
        if (file) {
            lengths[k] = fread(texts[k], 1, TEXT_MAX / 2, file);
            fclose(file);
        }
        CHECK(lengths[k] > 0);
    }
}

static void count_mistake(void *ctx, const se3d_model_error *error)
{
    size_t *count = ctx;
    CHECK(strncmp(error->message, "x.yaml:", 7) == 0);
    ++*count;
}

/* Read a text; whatever happens must be one of the documented outcomes. */
static se3d_status read_text(const char *text, size_t length, se3d_model_error *error)
{
    se3d_model *model = NULL;
    se3d_model_options options = se3d_model_options_default();
    options.mass_optional = 1; /* one of the examples has no mass */
    const se3d_status status =
        se3d_model_read_text(text, length, "x.yaml", &options, &model, error);
    CHECK(status == SE3D_OK || status == SE3D_ERR_MODEL);
    CHECK((status == SE3D_OK) == (model != NULL));
    CHECK((status == SE3D_OK) == (error->message[0] == '\0'));
    CHECK(status == SE3D_OK || strncmp(error->message, "x.yaml:", 7) == 0);
    se3d_model_destroy(model);
    if (length % 4 == 0) { /* the same with all mistakes, some of the time */
        size_t count = 0;
        options.report = count_mistake;
        options.report_ctx = &count;
        CHECK(se3d_model_read_text(text, length, "x.yaml", &options, &model, error) == status);
        CHECK((count > 0) == (status < 0) && count <= SE3D_MODEL_MISTAKES_MAX);
        se3d_model_destroy(model);
    }
    return status;
}

static const char *const pieces[] = {
    "[",  "]",     "{",      "}",      ":",   "- ",           "\"",   "'",    "#",    "\n",
    "\t", "&a ",   "*a",     "!!int ", "|\n", ">\n",          "? ",   "---",  "...",  "%YAML",
    "1e", "1e999", "-1",     ".nan",   "~",   "null",         "\xff", "\xc3", "\r\n", "sin(",
    ")",  "^",     "ground", "<<: *a", "0x1", "\xEF\xBB\xBF", "\x01", ", ,",  "bar",  "t"};

static void damaged_models_never_crash_the_reader(void)
{
    static char text[TEXT_MAX];
    uint64_t seed = 20240611;
    size_t accepted = 0;
    read_examples();
    for (int k = 0; k < ITERATIONS; ++k) {
        se3d_model_error error;
        const size_t which = damage_pick(&seed, MODELS);
        size_t length = lengths[which];
        memcpy(text, texts[which], length);
        const size_t times = 1 + damage_pick(&seed, 4);
        for (size_t i = 0; i < times; ++i) {
            length =
                damage_text(text, length, TEXT_MAX, pieces, sizeof pieces / sizeof *pieces, &seed);
        }
        accepted += read_text(text, length, &error) == SE3D_OK;
    }
    /* Both outcomes occur, or the test would not test much. */
    CHECK(accepted > ITERATIONS / 100 && accepted < ITERATIONS);
}

static void undamaged_examples_are_accepted(void)
{
    for (size_t k = 0; k < MODELS; ++k) {
        se3d_model_error error;
        const se3d_status status = read_text(texts[k], lengths[k], &error);
        if (status != SE3D_OK) {
            fprintf(stderr, "%s: %s\n", models[k], error.message);
        }
        CHECK(status == SE3D_OK);
    }
}

static void fill(char *text, size_t count, const char *piece)
{
    const size_t size = strlen(piece);
    for (size_t k = 0; k < count; ++k) {
        memcpy(text + k * size, piece, size);
    }
    text[count * size] = '\0';
}

static void depth_bombs_are_refused(void)
{
    static const char *const openings[] = {"[", "{a: ", "- ", "a:\n", "? ", "[{a: ", "(", "!!"};
    static char text[400000];
    for (size_t k = 0; k < sizeof openings / sizeof *openings; ++k) {
        se3d_model_error error;
        fill(text, 50000, openings[k]);
        CHECK(read_text(text, strlen(text), &error) == SE3D_ERR_MODEL);
    }
    se3d_model_error error;
    strcpy(text, "se3d: 1\nparameters: {a: ");
    fill(text + strlen(text), 2000, "(");
    strcat(text, "1}\n");
    CHECK(read_text(text, strlen(text), &error) == SE3D_ERR_MODEL);
    CHECK_CONTAINS(error.message, "parameters.a");
}

static void huge_texts_are_refused_with_the_limit(void)
{
    const size_t size = 3000000;
    char *text = malloc(size + 64);
    se3d_model_error error;
    CHECK(text != NULL);
    if (!text) {
        return;
    }
    strcpy(text, "se3d: 1\ntitle: ");
    memset(text + 15, 'x', size);
    text[15 + size] = '\0';
    CHECK(read_text(text, strlen(text), &error) == SE3D_ERR_MODEL);
    CHECK_CONTAINS(error.message, "at most 65536");
    strcpy(text, "se3d: 1\nbodies: [");
    fill(text + 17, 1100000, "1,");
    CHECK(read_text(text, strlen(text), &error) == SE3D_ERR_MODEL);
    CHECK_CONTAINS(error.message, "more than 1000000 values");
    strcpy(text, "se3d: 1\nparameters:\n");
    for (size_t k = 0, used = strlen(text); k < 5000; ++k) {
        used += (size_t)snprintf(text + used, 32, "  p%zu: %zu\n", k, k);
    }
    CHECK(read_text(text, strlen(text), &error) == SE3D_ERR_MODEL);
    CHECK_CONTAINS(error.message, "more than 4096 keys");
    free(text);
}

static void long_chains_of_parameters_need_no_recursion(void)
{
    static char text[200000];
    se3d_model_error error;
    size_t used = (size_t)snprintf(text, sizeof text, "se3d: 1\nparameters:\n");
    for (int k = 0; k < 4000; ++k) {
        used += (size_t)snprintf(text + used, sizeof text - used, "  p%d: p%d + 1\n", k, k + 1);
    }
    snprintf(text + used, sizeof text - used, "  p4000: 1\n");
    CHECK(read_text(text, strlen(text), &error) == SE3D_OK);
}

static void nul_bytes_bad_utf8_and_control_characters_are_refused(void)
{
    static const struct {
        const char *text;
        size_t length;
    } cases[] = {{"se3d: 1\ntitle: a\0b\n", 19},
                 {"\0", 1},
                 {"se3d: 1\ntitle: \x80\n", 17},
                 {"se3d: 1\ntitle: \xed\xa0\x80\n", 19},
                 {"se3d: 1\ntitle: \xf8\x88\x80\x80\n", 20},
                 {"se3d: 1\ntitle: \x07\n", 17},
                 {"\xff\xfe"
                  "s\0e\0",
                  6},
                 {"se3d: 1\ntitle: \xc3", 16}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        se3d_model_error error;
        CHECK(read_text(cases[k].text, cases[k].length, &error) == SE3D_ERR_MODEL);
    }
}

/* Line ends and a byte order mark change nothing, positions of errors included. */
static void crlf_and_byte_order_mark_are_accepted(void)
{
    static char text[TEXT_MAX];
    se3d_model_error error;
    size_t used = 3;
    memcpy(text, "\xEF\xBB\xBF", 3);
    for (size_t k = 0; k < lengths[0]; ++k) {
        if (texts[0][k] == '\n') {
            text[used++] = '\r';
        }
        text[used++] = texts[0][k];
    }
    CHECK(read_text(text, used, &error) == SE3D_OK);
    static const char bad[] = "\xEF\xBB\xBFse3d: 1\r\ngravity: x\r\n";
    CHECK(read_text(bad, sizeof bad - 1, &error) == SE3D_ERR_MODEL);
    CHECK(error.line == 2 && error.column == 10);
}

static void json_is_accepted(void)
{
    static const char text[] =
        "{\"se3d\": 1, \"parameters\": {\"m\": 2.5e0},\n"
        " \"bodies\": [{\"name\": \"b\", \"mass\": \"2*m\", \"inertia\": [1, 1, 1], \"fixed\": "
        "false}],\n \"analysis\": {\"type\": \"dynamics\", \"duration\": 1}}\n";
    se3d_model_error error;
    CHECK(read_text(text, sizeof text - 1, &error) == SE3D_OK);
}

/* An allocator that fails at the k-th call, once or from then on. */
typedef struct failing {
    long countdown;
    int for_ever;
    long live;
} failing;

static int fails(failing *f)
{
    const long left = f->countdown--;
    return left == 0 || (left < 0 && f->for_ever);
}

static void *failing_alloc(void *ctx, size_t size)
{
    failing *f = ctx;
    void *memory = fails(f) ? NULL : malloc(size);
    f->live += memory != NULL;
    return memory;
}

static void *failing_realloc(void *ctx, void *memory, size_t old_size, size_t new_size)
{
    failing *f = ctx;
    (void)old_size;
    void *grown = fails(f) ? NULL : realloc(memory, new_size);
    f->live += grown != NULL && memory == NULL;
    return grown;
}

static void failing_free(void *ctx, void *memory, size_t size)
{
    failing *f = ctx;
    (void)size;
    f->live -= memory != NULL;
    free(memory);
}

static void every_failed_allocation_is_reported_and_nothing_leaks(void)
{
    for (int for_ever = 0; for_ever < 2; ++for_ever) {
        se3d_status status = SE3D_ERR_NO_MEMORY;
        long k = 0;
        for (; status == SE3D_ERR_NO_MEMORY && k < 20000; ++k) {
            failing state = {k, for_ever, 0};
            const se3d_allocator allocator = {failing_alloc, failing_realloc, failing_free, &state};
            se3d_model_options options = se3d_model_options_default();
            se3d_model *model = NULL;
            se3d_model_error error;
            options.allocator = &allocator;
            status = se3d_model_read_text(texts[5], lengths[5], "m", &options, &model, &error);
            CHECK(status == SE3D_OK || status == SE3D_ERR_NO_MEMORY);
            if (status != SE3D_OK && status != SE3D_ERR_NO_MEMORY) {
                fprintf(stderr, "allocation %ld: %d %s\n", k, (int)status, error.message);
            }
            se3d_model_destroy(model);
            CHECK(state.live == 0);
        }
        CHECK(status == SE3D_OK && k > 10);
    }
}

int main(void)
{
    RUN(damaged_models_never_crash_the_reader);
    RUN(undamaged_examples_are_accepted);
    RUN(depth_bombs_are_refused);
    RUN(huge_texts_are_refused_with_the_limit);
    RUN(long_chains_of_parameters_need_no_recursion);
    RUN(nul_bytes_bad_utf8_and_control_characters_are_refused);
    RUN(crlf_and_byte_order_mark_are_accepted);
    RUN(json_is_accepted);
    RUN(every_failed_allocation_is_reported_and_nothing_leaks);
    return check_finish();
}
