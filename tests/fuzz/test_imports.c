/* SPDX-License-Identifier: BSD-3-Clause */
/* The importers on damaged texts of each kind: they must come back with a model file that can be
 * read, or with a message, and never with a crash. Run under the sanitizers; SE3D_ITERATIONS=100000
 * tries more. */
#include <stdlib.h>

#include "check.h"
#include "se3d/import.h"
#include "se3d/io.h"
#include "support/damage.h"

enum { TEXT_MAX = 8192, ITERATIONS = 1200 };

typedef struct seed_text {
    const char *name, *path, *text; /* a file of the source folder, or the text itself */
} seed_text;

static const seed_text seeds[] = {
    {"x.adm", "tests/import/crank.adm", NULL},
    {"x.chrono.yaml", NULL,
     "chrono-version: 10.0\nmodel:\n  name: m\n  angle_degrees: true\n  bodies:\n"
     "    - {name: a, mass: 2, inertia: {moments: [1, 2, 3], products: [0.1, 0, 0]}, location: [1, "
     "0, 0], orientation: [0, 30, 0]}\n"
     "    - {name: g, fixed: true, location: [0, 0, 0]}\n"
     "  joints:\n    - {name: j, type: revolute, body1: a, body2: g, location: [0, 0, 0], axis: "
     "[0, "
     "0, 1]}\n"
     "  tsdas:\n    - {name: s, body1: a, body2: g, point1: [1, 0, 0], point2: [0, 0, 3], "
     "spring_coefficient: 50, damping_coefficient: 2, free_length: 1}\n"
     "  motors:\n    - {name: m, type: ROTATION, actuation_type: SPEED, body1: a, body2: g, "
     "location: [0, 0, 0], axis: [0, 0, 1], actuation_function: {type: SINE, amplitude: 2, "
     "frequency: 3, phase: 0.1}}\n"},
    {"x.mdl", NULL,
     "{\"name\": \"m\", \"gravity\": [0, 0, -9.81],\n \"bodies\": [{\"id\": 1, \"mass\": 2, "
     "\"jbar\": [1, 2, 2], \"q0\": [0, 1, 0, 1, 0, 0, 0], \"qd0\": [0, 0, 0, 0, 0, 0, 0]}],\n "
     "\"constraints\": [{\"type\": \"cons_dp1\", \"body1\": 1, \"body2\": \"ground\", \"aiBAR\": "
     "[1, 0, 0], \"ajBAR\": [0, 1, 0], \"fun\": \"@(t)(sin(t).*2)\"},\n {\"type\": \"CD\", "
     "\"body_i\": 0, \"body_j\": 1, \"si\": [0, 0, 1], \"c\": [0, 1, 0], \"f\": 1, \"df\": 2}]}\n"},
#if defined(SE3D_HAS_EXPAT)
    {"x.urdf", "tests/import/arm.urdf", NULL},
    {"x.sdf", "tests/import/loop.sdf", NULL},
    {"x.xml", NULL,
     "<mujoco model=\"m\"><compiler angle=\"degree\"/><default><joint damping=\"0.5\" "
     "armature=\"0.1\"/><default class=\"c\"><geom density=\"500\"/></default></default>\n"
     "<worldbody><body name=\"a\" pos=\"0 0 1\" euler=\"10 20 30\"><joint name=\"h\" axis=\"0 1 "
     "0\" "
     "range=\"-90 0\" ref=\"5\" stiffness=\"2\"/>\n<geom type=\"capsule\" fromto=\"0 0 0 0 0 1\" "
     "size=\"0.1\" class=\"c\"/><site name=\"s\" pos=\"0 0 1\"/>\n<body name=\"b\"><joint "
     "name=\"k\" type=\"slide\" axis=\"0 0 1\"/><inertial pos=\"0 0 0\" mass=\"1\" "
     "fullinertia=\"1 1 1 0 0 0\"/></body></body>\n<body name=\"f\"><freejoint/><geom "
     "type=\"box\" size=\"1 2 3\"/><site name=\"e\"/></body></worldbody>\n<equality><connect "
     "body1=\"b\" body2=\"f\" anchor=\"0 0 0\"/><joint joint1=\"h\" polycoef=\"0 1 0 0 "
     "0\"/></equality><actuator><motor joint=\"h\" gear=\"10\"/></actuator><tendon><spatial "
     "stiffness=\"5\"><site site=\"s\"/><site site=\"e\"/></spatial></tendon></mujoco>\n"},
#endif
};
enum { SEEDS = sizeof seeds / sizeof *seeds };

static size_t read_seed(const seed_text *s, char *text)
{
    const char *source = getenv("SE3D_SOURCE_DIR");
    char path[800];
    size_t length = 0;
    if (s->text) {
        length = strlen(s->text);
        memcpy(text, s->text, length);
        return length;
    }
    snprintf(path, sizeof path, "%s/%s", source ? source : ".", s->path);
    FILE *file = fopen(path, "rb");
    CHECK(file != NULL);
    if (file) {
        length = fread(text, 1, TEXT_MAX / 2, file);
        fclose(file);
    }
    return length;
}

static const char *const pieces[] = {
    "1e308",   "-1e-320", "1e999", "nan",  "inf",  "-",     "0",     "\"",   "/>",
    "<a>",     "&#0;",    "&lt;",  "<!--", "\n",   "\t",    ",",     "=",    "/",
    "(",       ")",       "[",     "]",    "{",    "}",     ": ",    "\xff", "\xc3",
    "1/0",     "9999",    "IF(",   "**",   "name", "world", "a",     "99D",  "PART/",
    "MARKER/", "CM=21",   "\\",    "!",    "-1",   "0 0 0", "1 1 1", "x y z"};

/* @return whether a model was made, which must be one that can be read. */
static int try_text(const char *name, const char *text, size_t length)
{
    se3d_model_import *import = NULL;
    se3d_model *model = NULL;
    se3d_model_error error;
    const se3d_status status = se3d_model_import_text(text, length, name, NULL, &import, &error);
    CHECK(status == SE3D_OK || status == SE3D_ERR_MODEL);
    CHECK((status == SE3D_OK) == (import != NULL));
    CHECK((status == SE3D_OK) == (error.message[0] == '\0'));
    if (import) {
        size_t size = 0;
        const char *made = se3d_model_import_get_text(import, &size);
        const se3d_status read =
            se3d_model_read_text(made, size, "made.yaml", NULL, &model, &error);
        CHECK(read == SE3D_OK);
        if (read != SE3D_OK) {
            fprintf(stderr, "%s: %s\n---- from\n%.*s\n----\n", name, error.message, (int)length,
                    text);
        }
        se3d_model_destroy(model);
    }
    se3d_model_import_destroy(import);
    return status == SE3D_OK;
}

static void undamaged_texts_are_imported(void)
{
    static char text[TEXT_MAX];
    for (size_t k = 0; k < SEEDS; ++k) {
        CHECK(try_text(seeds[k].name, text, read_seed(&seeds[k], text)));
    }
}

static void damaged_texts_never_crash_an_importer(void)
{
    static char text[TEXT_MAX];
    const char *asked = getenv("SE3D_ITERATIONS");
    const long iterations = asked ? strtol(asked, NULL, 10) : ITERATIONS;
    uint64_t seed = 20250117;
    long accepted = 0;
    for (long k = 0; k < iterations && check_failures == 0; ++k) {
        const seed_text *s = &seeds[damage_pick(&seed, SEEDS)];
        size_t length = read_seed(s, text);
        const size_t times = 1 + damage_pick(&seed, 3);
        for (size_t i = 0; i < times; ++i) {
            length =
                damage_text(text, length, TEXT_MAX, pieces, sizeof pieces / sizeof *pieces, &seed);
        }
        accepted += try_text(s->name, text, length);
    }
    CHECK(accepted > iterations / 100 && accepted < iterations);
}

/* The length of the word or number at the beginning. */
static size_t word_length(const char *text)
{
    return strspn(text, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.+-");
}

/* Another word in place of the one of `size` at `at`. */
static size_t put_word(const char *text, size_t length, size_t at, size_t size, const char *word,
                       char *out)
{
    const size_t more = strlen(word);
    memcpy(out, text, at);
    memcpy(out + at, word, more);
    memcpy(out + at + more, text + at + size, length - at - size);
    return length - size + more;
}

/* Each word of each text, in turn: it is missing, no number, of the wrong sign, zero, too large,
 * two, a list. SE3D_LONG: each of them all. */
static void every_word_may_be_wrong(void)
{
    static const char *const words[] = {"", "x", "-1", "0", "1e40", "1 2", "[]", "nan"};
    enum { WORDS = sizeof words / sizeof *words };
    static char text[TEXT_MAX], out[TEXT_MAX + 8];
    size_t tried = 0, turn = 0, accepted = 0;
    for (size_t k = 0; k < SEEDS; ++k) {
        const size_t length = read_seed(&seeds[k], text);
        text[length] = '\0';
        for (size_t at = 0; at < length;) {
            const size_t size = word_length(text + at);
            for (size_t w = 0; size > 0 && w < (check_is_long() ? WORDS : 2); ++w) {
                const size_t made =
                    put_word(text, length, at, size, words[(turn + 3 * w) % WORDS], out);
                accepted += (size_t)try_text(seeds[k].name, out, made);
                ++tried;
            }
            turn += size > 0;
            at += size > 0 ? size : 1;
        }
    }
    CHECK(tried > 1000 && accepted > tried / 20 && accepted < tried);
}

int main(void)
{
    RUN(undamaged_texts_are_imported);
    RUN(damaged_texts_never_crash_an_importer);
    RUN(every_word_may_be_wrong);
    return check_finish();
}
