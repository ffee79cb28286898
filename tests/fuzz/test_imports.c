/* SPDX-License-Identifier: BSD-3-Clause */
/* The importers on damaged texts of each kind: they must come back with a model file that can be
 * read, or with a message, and never with a crash. Run under the sanitizers; SE3D_ITERATIONS=100000
 * tries more. */
#include <stdlib.h>

#include "check.h"
#include "se3d/import.h"
#include "se3d/io.h"
#include "support/damage.h"

enum { TEXT_MAX = 16384, ITERATIONS = 1200 };

/* Files of fuzz/seeds/import, which have all that importers look at. */
static const char *const seeds[] = {
    "chrono_bodies.yaml", "chrono_guides.yaml",  "chrono_joints.yaml", "chrono_loads.yaml",
    "chrono_motors.yaml", "chrono_springs.yaml", "chrono_stops.yaml",  "couplings.adm",
    "crank.adm",          "forces.mdl",          "functions.adm",      "gforce.adm",
    "joints.adm",         "kinds.mdl",           "loads.mdl",          "lost.adm",
    "lost.mdl",           "machine.yaml",        "oscillator.adm",
#if defined(SE3D_HAS_EXPAT)
    "arm.urdf",           "expressed.sdf",       "loop.sdf",           "lost.sdf",
    "machine.xml",        "mjcf_bodies.xml",     "mjcf_loops.xml",     "mjcf_lost.xml",
    "mjcf_materials.xml", "mjcf_touching.xml",   "same.urdf",          "surface.sdf",
#endif
};
enum { SEEDS = sizeof seeds / sizeof *seeds };

static size_t read_seed(const char *name, char *text)
{
    const char *source = getenv("SE3D_SOURCE_DIR");
    char path[800];
    size_t length = 0;
    snprintf(path, sizeof path, "%s/fuzz/seeds/import/%s", source ? source : ".", name);
    FILE *file = fopen(path, "rb");
    CHECK(file != NULL);
    if (file) {
        length = fread(text, 1, TEXT_MAX / 2, file);
        fclose(file);
    }
    CHECK(length > 0 && length < TEXT_MAX / 2);
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
        CHECK(try_text(seeds[k], text, read_seed(seeds[k], text)));
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
        const char *s = seeds[damage_pick(&seed, SEEDS)];
        size_t length = read_seed(s, text);
        const size_t times = 1 + damage_pick(&seed, 3);
        for (size_t i = 0; i < times; ++i) {
            length =
                damage_text(text, length, TEXT_MAX, pieces, sizeof pieces / sizeof *pieces, &seed);
        }
        accepted += try_text(s, text, length);
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
        const size_t length = read_seed(seeds[k], text);
        text[length] = '\0';
        for (size_t at = 0; at < length;) {
            const size_t size = word_length(text + at);
            for (size_t w = 0; size > 0 && w < (check_is_long() ? WORDS : 2); ++w) {
                const size_t made =
                    put_word(text, length, at, size, words[(turn + 3 * w) % WORDS], out);
                accepted += (size_t)try_text(seeds[k], out, made);
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
