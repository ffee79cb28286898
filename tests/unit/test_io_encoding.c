/* SPDX-License-Identifier: BSD-3-Clause */
/* Texts as editors of other systems leave them (a byte order mark, CR LF), and files that are not
 * what a model takes them for: little of them is shown. */
#include "check.h"
#include "se3d/io.h"
#include "se3d/se3d.h"
#include "support/scratch.h"

#define MARK "\xEF\xBB\xBF"
#define MODEL(shapes, entry)                                                                       \
    "se3d: 1\ncontact: {}\nmaterials: [{name: m, density: 1, stiffness: 1e4}]\n"                   \
    "bodies: [{name: b, fixed: true, shapes: [" shapes "]}]\n" entry
#define PARTICLES(file) MODEL("", "particles: [{material: m, file: " file "}]\n")
#define MESH(file)      MODEL("{type: mesh, material: m, file: " file "}", "")

/* `text` with a mark and CR LF in place of LF. @return its length */
static size_t as_elsewhere(const char *text, char *to, size_t size)
{
    size_t length = strlen(MARK);
    memcpy(to, MARK, length + 1);
    for (const char *c = text; *c && length + 3 < size; ++c) {
        if (*c == '\n') {
            to[length++] = '\r';
        }
        to[length++] = *c;
    }
    to[length] = '\0';
    return length;
}

static void write_as_elsewhere(const char *name, const char *text)
{
    char changed[2000];
    scratch_write(name, changed, as_elsewhere(text, changed, sizeof changed));
}

static void models_with_a_mark_and_crlf_are_the_same_models(void)
{
    static const char text[] = "se3d: 1\ntitle: >\n  two\n  words\nparameters: {m: 2}\n"
                               "bodies:\n  - name: b # a comment\n    mass: m\n"
                               "    inertia: [1, 1,\n      1]\n";
    char changed[2000];
    uint64_t hash[2] = {0, 1};
    for (int k = 0; k < 2; ++k) {
        se3d_model_error error = {0, 0, ""};
        as_elsewhere(text, changed, sizeof changed);
        se3d_model *model = scratch_read_model(k == 0 ? text : changed, &error);
        CHECK(model != NULL);
        CHECK(model && strcmp(se3d_model_get_title(model), "two words\n") == 0);
        hash[k] = model ? se3d_system_hash(se3d_model_get_system(model)) : 0;
        se3d_model_destroy(model);
    }
    CHECK(hash[0] == hash[1]);
}

static void errors_of_such_models_have_the_same_places(void)
{
    char changed[2000];
    se3d_model_error error = {0, 0, ""};
    as_elsewhere("se3d: 1\nbodies: []\nbodys: []\n", changed, sizeof changed);
    CHECK(!scratch_read_model(changed, &error));
    CHECK(error.line == 3 && error.column == 1);
    as_elsewhere("sed: 1\n", changed, sizeof changed);
    CHECK(!scratch_read_model(changed, &error));
    CHECK(error.line == 1 && error.column == 1);
}

static void tables_and_meshes_with_a_mark_and_crlf_are_read(void)
{
    static const char *const models[] = {PARTICLES("se3d_test.csv"), MESH("se3d_test.stl"),
                                         MESH("se3d_test.obj")};
    write_as_elsewhere("se3d_test.csv", "x,y,z,radius,material\n0,0,0,0.1,m\n\n1,0,0,0.1,m\n");
    write_as_elsewhere("se3d_test.stl",
                       "solid part\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 2\n"
                       "   vertex 2 0 2\n   vertex 0 2 2\n  endloop\n endfacet\nendsolid part\n");
    write_as_elsewhere("se3d_test.obj", "v 0 0 2\nv 2 0 2\nv 2 2 2\nf 1 2 3\n");
    for (size_t k = 0; k < sizeof models / sizeof *models; ++k) {
        se3d_model_error error = {0, 0, ""};
        se3d_model *model = scratch_read_model(models[k], &error);
        CHECK(model != NULL);
        if (!model) {
            fprintf(stderr, "%s\n", error.message);
        }
        se3d_model_destroy(model);
    }
    scratch_remove("se3d_test.csv");
    scratch_remove("se3d_test.stl");
    scratch_remove("se3d_test.obj");
}

/* Such as /etc/passwd: the first words of a line are shown, and nothing that moves a cursor. */
static void little_of_another_file_is_shown(void)
{
    static const char *const models[] = {PARTICLES("se3d_test.csv"), MESH("se3d_test.stl"),
                                         MESH("se3d_test.obj")};
    static const char secret[] = "root:\x1b[2J:0:0:a-long-line-with-a-secret:/root\nmore-secret\n";
    scratch_write("se3d_test.csv", secret, sizeof secret - 1);
    scratch_write("se3d_test.stl", secret, sizeof secret - 1);
    scratch_write("se3d_test.obj", secret, sizeof secret - 1);
    for (size_t k = 0; k < sizeof models / sizeof *models; ++k) {
        se3d_model_error error = {0, 0, ""};
        CHECK(!scratch_read_model(models[k], &error));
        CHECK_CONTAINS(error.message, "se3d_test.");
        CHECK(!strstr(error.message, "secret") && !strchr(error.message, '\x1b'));
    }
    scratch_remove("se3d_test.csv");
    scratch_remove("se3d_test.stl");
    scratch_remove("se3d_test.obj");
}

static void what_is_no_plain_file_is_refused_and_not_waited_for(void)
{
    static const char *const models[] = {PARTICLES("/dev/zero"), PARTICLES("."), MESH("/dev/null")};
    for (size_t k = 0; k < sizeof models / sizeof *models; ++k) {
        se3d_model_error error = {0, 0, ""};
        CHECK(!scratch_read_model(models[k], &error));
        CHECK_CONTAINS(error.message, "a folder, a pipe or a device");
    }
}

int main(void)
{
    RUN(models_with_a_mark_and_crlf_are_the_same_models);
    RUN(errors_of_such_models_have_the_same_places);
    RUN(tables_and_meshes_with_a_mark_and_crlf_are_read);
    RUN(little_of_another_file_is_shown);
    RUN(what_is_no_plain_file_is_refused_and_not_waited_for);
    return check_finish();
}
