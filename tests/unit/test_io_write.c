/* SPDX-License-Identifier: BSD-3-Clause */
/* A system as a model file: what is read from it again is the same system to the bit, and is
 * written as the same text. */
#define _XOPEN_SOURCE 700
#include "check.h"
#include "se3d/io.h"

#include <dirent.h>
#include <stddef.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

static const char *source_folder(void)
{
    const char *source = getenv("SE3D_SOURCE_DIR");
    return source ? source : ".";
}

static const char *file_of(const char *name, char *path, size_t size)
{
    snprintf(path, size, "%s/%s", check_scratch(), name);
    return path;
}

/* The text of a model; NULL: it cannot be written. */
static char *text_of(const se3d_model *model, const se3d_write_options *how)
{
    size_t length = 0;
    size_t again = 0;
    se3d_model_error error;
    if (se3d_model_write_text(model, how, NULL, 0, &length, &error) < 0) {
        fprintf(stderr, "    %s\n", error.message);
        return NULL;
    }
    char *text = malloc(length + 1);
    CHECK(!se3d_model_write_text(model, how, text, length + 1, &again, &error));
    CHECK(again == length && strlen(text) == length);
    return text;
}

static se3d_model *read_again(const char *text, const char *name)
{
    se3d_model *model = NULL;
    se3d_model_error error;
    if (se3d_model_read_text(text, strlen(text), name, NULL, &model, &error) < 0) {
        fprintf(stderr, "    %s\n", error.message);
    }
    return model;
}

/* The state after a few steps of the first analysis that is a motion, by one formulation. */
static uint64_t run_a_little(se3d_model *model, const se3d_model *plan, int32_t formulation)
{
    uint64_t hash = 0;
    for (size_t k = 0; k < se3d_model_count_analyses(plan) && hash == 0; ++k) {
        se3d_solver_def def = se3d_solver_def_default();
        se3d_model_analysis analysis;
        se3d_solver *solver = NULL;
        double time = 0.0;
        CHECK(!se3d_model_get_analysis(plan, k, &analysis));
        if (analysis.duration <= 0.0 || se3d_model_get_solver(plan, k, &def) < 0) {
            continue;
        }
        def.formulation = formulation;
        se3d_system *system = se3d_model_get_system(model);
        CHECK(!se3d_system_get_time(system, &time));
        const double span = analysis.duration < 0.004 ? analysis.duration : 0.004;
        if (se3d_solver_create(system, &def, &solver) >= 0) {
            (void)se3d_solver_run(solver, time + span);
            hash = se3d_system_hash(system);
        }
        se3d_solver_destroy(solver);
    }
    return hash;
}

/* Whether the constraints stand in the order of a file: those of several parts do not. */
static int is_in_order(const se3d_system *system)
{
    int last = 0;
    for (size_t k = 0; k < se3d_system_count_constraints(system); ++k) {
        se3d_constraint constraint;
        se3d_coupler_def coupler = se3d_coupler_def_default();
        se3d_primitive_def primitive = se3d_primitive_def_default();
        se3d_driver_def driver = se3d_driver_def_default();
        CHECK(!se3d_system_get_constraint(system, k, &constraint));
        const int now = se3d_driver_get_def(system, constraint, &driver) >= 0         ? 3
                        : se3d_primitive_get_def(system, constraint, &primitive) >= 0 ? 2
                        : se3d_coupler_get_def(system, constraint, &coupler) >= 0     ? 1
                                                                                      : 0;
        if (now < last) {
            return 0;
        }
        last = now;
    }
    return 1;
}

static void check_model(const char *path, const se3d_model_options *options, int with_motion)
{
    se3d_model_error error;
    se3d_model *model = NULL;
    const int before = check_failures;
    if (se3d_model_read_file(path, options, &model, &error) < 0) {
        return; /* a part of a model */
    }
    se3d_write_options how = se3d_write_options_default();
    const se3d_status status = se3d_model_write_text(model, &how, NULL, 0, &(size_t){0}, &error);
    if (status == SE3D_ERR_UNSUPPORTED && strstr(error.message, "cannot be written: ")) {
        CHECK(strstr(error.message, "with units") || strstr(error.message, "study"));
        how.elements_only = 1;
    }
    char *first = text_of(model, &how);
    se3d_model *again = first ? read_again(first, path) : NULL;
    char *second = again ? text_of(again, &how) : NULL;
    CHECK(first && again && second);
    CHECK(!first || !second || strcmp(first, second) == 0);
    with_motion = with_motion && is_in_order(se3d_model_get_system(model));
    for (int32_t formulation = 0; again && with_motion && formulation < 2; ++formulation) {
        CHECK(run_a_little(model, model, formulation) == run_a_little(again, model, formulation));
    }
    if (check_failures > before) {
        fprintf(stderr, "    in %s\n", path);
        if (getenv("SE3D_WRITE_SHOW") && first) {
            fprintf(stderr, "%s\n=====\n%s\n", first, second ? second : "");
        }
    }
    free(first);
    free(second);
    se3d_model_destroy(again);
    se3d_model_destroy(model);
}

static int ends_with(const char *name, const char *end)
{
    const size_t a = strlen(name), b = strlen(end);
    return a > b && strcmp(name + a - b, end) == 0;
}

static void check_folder(const char *folder)
{
    char path[800];
    snprintf(path, sizeof path, "%s/%s", source_folder(), folder);
    DIR *directory = opendir(path);
    CHECK(directory != NULL);
    for (struct dirent *entry = directory ? readdir(directory) : NULL; entry;
         entry = readdir(directory)) {
        if (ends_with(entry->d_name, ".yaml")) {
            snprintf(path, sizeof path, "%.300s/%.200s/%.200s", source_folder(), folder,
                     entry->d_name);
            check_model(path, NULL, 1);
        }
    }
    if (directory) {
        closedir(directory);
    }
}

static void every_example_is_written_and_read_as_the_same_system(void)
{
    check_folder("examples/models");
    check_folder("examples/study");
    check_folder("examples/fsae");
}

/* Seconds, names and words are those of a file in SI units. */
static void sections_of_a_file_with_units_are_written_if_they_stay_the_same(void)
{
    static const char text[] =
        "se3d: 1\nunits: {length: mm, force: N, mass: kg, time: s, angle: deg}\n"
        "parameters: {T: 2, L: 30, u: 5 mm}\n"
        "bodies: [{name: a, mass: 1, inertia: [1, 1, 1], position: [L, u, 0]}]\n"
        "analysis: {type: dynamics, duration: T/2, step: 0.1, method: rk4}\n"
        "output: [{file: a.csv, every: 0.1, channels: [a.position, a.velocity.x]}]\n";
    se3d_model *model = read_again(text, "m.yaml");
    char *written = model ? text_of(model, NULL) : NULL;
    CHECK_CONTAINS(written ? written : "", "parameters:\n  T: 2\n\n");
    CHECK_CONTAINS(written ? written : "", "\nanalysis: {type: dynamics, duration: T/2, step: 0.1, "
                                           "method: rk4}\n");
    CHECK_CONTAINS(written ? written : "", "every: 0.1, channels: [a.position, a.velocity.x]");
    se3d_model *again = written ? read_again(written, "m.yaml") : NULL;
    CHECK(again && se3d_system_hash(se3d_model_get_system(model)) ==
                       se3d_system_hash(se3d_model_get_system(again)));
    free(written);
    se3d_model_destroy(again);
    se3d_model_destroy(model);
}

/* ---- what a file cannot say -------------------------------------------------------------------*/

static void sections_that_cannot_be_written_are_named_or_left_out(void)
{
    static const char bodies[] = "bodies: [{name: a, mass: 1, inertia: [1, 1, 1]}]\n";
    static const struct {
        const char *text, *lost;
        int only; /* elements_only leaves it out */
    } rows[] = {
        {"units: {time: ms}\nanalysis: {type: dynamics, duration: 1, step: 0.1}\n"
         "output: [{file: a.csv, every: 1}]\n",
         ": analysis, output (of a file with units)", 1},
        {"units: {length: mm}\nanalysis: {type: dynamics, duration: 1, step: 0.1}\n"
         "output: [{file: a.csv, channels: [a.position.x - 5]}]\n",
         ": output (of a file with units)", 1},
        {"units: {length: mm}\ncontact: {step: 1e-4, threads: 2, skin: 1}\n",
         ": contact.threads, contact.skin (of a file with units)", 1},
        {"parameters: {L: 1}\nanalysis: {type: dynamics, duration: 1, step: 0.1}\n"
         "study: {parameters: {L: 'uniform(1, 2)'}, samples: 3, "
         "measures: {x: {max: a.position.x}}}\n",
         ": study", 1},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
        char text[1000];
        se3d_model_error error;
        size_t length = 0;
        se3d_write_options how = se3d_write_options_default();
        snprintf(text, sizeof text, "se3d: 1\n%s%s", bodies, rows[k].text);
        se3d_model *model = read_again(text, "m.yaml");
        CHECK(model != NULL);
        if (!model) {
            continue;
        }
        CHECK(se3d_model_write_text(model, NULL, NULL, 0, &length, &error) == SE3D_ERR_UNSUPPORTED);
        CHECK_CONTAINS(error.message, rows[k].lost);
        how.elements_only = 1;
        CHECK((se3d_model_write_text(model, &how, NULL, 0, &length, &error) >= 0) == rows[k].only);
        how.elements_only = 0;
        how.partial = 1;
        char *written = text_of(model, &how);
        CHECK_CONTAINS(written ? written : "", "# Left out");
        CHECK_CONTAINS(written ? written : "", rows[k].lost);
        se3d_model *again = written ? read_again(written, "m.yaml") : NULL;
        CHECK(again != NULL);
        se3d_model_destroy(again);
        free(written);
        se3d_model_destroy(model);
    }
}

/* ---- texts ------------------------------------------------------------------------------------*/

static void texts_are_read_again_as_they_were(void)
{
    static const char text[] =
        "se3d: 1\n"
        "title: \"a\\x7f b\\u0085 c\\u009f d\\u2028 e\\u2029 f\\ufeff g\\u00a0\\u00e9 h\\n\"\n"
        "parameters: {i: 2}\n"
        "materials: [{name: m, density: 1, stiffness: 1e6}]\n"
        "bodies: [{name: a, mass: 1, inertia: [1, 1, 1], shapes: [\n"
        "  {type: sphere, radius: 1, material: m, name: 's{i}', group: i + 1, mask: 2*i},\n"
        "  {type: sphere, radius: 1, material: m, name: 't{i}', mask: i, contact: false}]}]\n"
        "contact: {step: 1e-4}\n";
    se3d_shape shape = {0, 0};
    se3d_shape_def def = se3d_shape_def_default();
    se3d_model *model = read_again(text, "m.yaml");
    char *first = model ? text_of(model, NULL) : NULL;
    se3d_model *again = first ? read_again(first, "m.yaml") : NULL;
    CHECK(again != NULL);
    if (again) {
        const se3d_system *system = se3d_model_get_system(again);
        CHECK(strcmp(se3d_model_get_title(again), se3d_model_get_title(model)) == 0);
        CHECK(strlen(se3d_model_get_title(again)) > 20);
        CHECK(se3d_system_count_shapes(system) == 1);
        CHECK(!se3d_system_get_shape(system, 0, &shape));
        CHECK(!se3d_shape_get_def(system, shape, &def));
        CHECK_CONTAINS(def.name, "s2");
        CHECK(def.group == 3 && def.mask == 4);
        char *second = text_of(again, NULL);
        CHECK(second && strcmp(first, second) == 0);
        free(second);
    }
    se3d_model_destroy(again);
    free(first);
    se3d_model_destroy(model);
}

/* ---- files that a model names ----------------------------------------------------------------*/

static void put_file(const char *folder, const char *name, const char *text)
{
    char path[900];
    snprintf(path, sizeof path, "%.600s/%s", folder, name);
    FILE *file = fopen(path, "wb");
    CHECK(file && fputs(text, file) >= 0);
    CHECK(!file || fclose(file) == 0);
}

static void copy_file(const char *from, const char *folder, const char *name)
{
    char block[65536];
    FILE *file = fopen(from, "rb");
    const size_t used = file ? fread(block, 1, sizeof block - 1, file) : 0;
    CHECK(file && used > 0 && used < sizeof block - 1);
    block[used] = '\0';
    put_file(folder, name, block);
    if (file) {
        fclose(file);
    }
}

static const char *const named_files[] = {"m.yaml", "part.yaml", "a.tir", "stones.csv", "road.csv"};

static void make_named_files(const char *folder)
{
    char path[800];
    snprintf(path, sizeof path, "%.700s/examples/fsae/tyre.tir", source_folder());
    copy_file(path, folder, "a.tir");
    put_file(folder, "stones.csv", "x,y,z,radius\n0,0,5,0.1\n1,0,5,0.1\n");
    put_file(folder, "road.csv", "0,0,0\n0,0,0\n");
    put_file(folder, "part.yaml",
             "se3d: 1\nbodies:\n"
             "  - {name: hub, mass: 1, inertia: [1, 1, 1], position: [0, 0, 0.3],\n"
             "     shapes: [{type: heightfield, file: road.csv, spacing: 1}]}\n"
             "roads: [{name: path, type: heightfield, body: hub, at: [1, 0, 0.4], file: road.csv,"
             " spacing: 2}]\n"
             "forces: [{name: tyre, type: tyre, body: hub, axis: [0, 1, 0], file: a.tir}]\n");
    put_file(folder, "m.yaml",
             "se3d: 1\ninclude: [{file: part.yaml, prefix: p_}]\n"
             "materials: [{name: rock, density: 2000, stiffness: 1e6}]\n"
             "roads: [{name: field, type: heightfield, file: road.csv, spacing: 1}]\n"
             "contact: {step: 1e-4}\n"
             "particles: [{name: stones, material: rock, file: stones.csv}]\n");
}

static void files_that_a_model_names_are_found_from_another_place(void)
{
    static const char *const places[] = {"named/new.yaml", "named.new.yaml", "beside/new.yaml",
                                         "named/../beside/new.yaml"};
    char folder[800], beside[800], path[800];
    se3d_model_error error;
    se3d_model *model = NULL;
    (void)mkdir(file_of("named", folder, sizeof folder), 0700);
    (void)mkdir(file_of("beside", beside, sizeof beside), 0700);
    make_named_files(folder);
    CHECK(!se3d_model_read_file(file_of("named/m.yaml", path, sizeof path), NULL, &model, &error));
    CHECK(se3d_system_count_forces(se3d_model_get_system(model)) == 1);
    for (size_t k = 0; model && k < sizeof places / sizeof *places; ++k) {
        se3d_model *again = NULL;
        CHECK(!se3d_model_write(model, file_of(places[k], path, sizeof path), NULL, &error));
        const se3d_status status = se3d_model_read_file(path, NULL, &again, &error);
        if (status < 0) {
            fprintf(stderr, "    %s: %s\n", places[k], error.message);
        }
        CHECK(status >= 0);
        CHECK(!again || se3d_system_hash(se3d_model_get_system(again)) ==
                            se3d_system_hash(se3d_model_get_system(model)));
        se3d_model_destroy(again);
        remove(path);
    }
    se3d_model_destroy(model);
    for (size_t k = 0; k < sizeof named_files / sizeof *named_files; ++k) {
        snprintf(path, sizeof path, "%.700s/%s", folder, named_files[k]);
        CHECK(remove(path) == 0);
    }
    CHECK(rmdir(folder) == 0 && rmdir(beside) == 0);
}

/* ---- roads ----------------------------------------------------------------------------------*/

#define DECK                                                                                       \
    "se3d: 1\n"                                                                                    \
    "bodies: [{name: deck, mass: 1, inertia: [1, 1, 1], position: [1, 2, 3],"                      \
    " orientation: {rpy: [0.3, -0.2, 0.7]},"                                                       \
    " markers: [{name: bow, position: [0.5, 0.25, 0]}]},"                                          \
    " {name: rim, mass: 1, inertia: [1, 1, 1], position: [1, 2, 3.3]}]\n"

static void roads_on_bodies_are_written_as_they_are_defined(void)
{
    static const double at[3][2] = {{0.25, 0.5}, {-0.75, 0.125}, {1.5, -1.0}};
    static const char text[] =
        DECK "parameters: {h: 0.1}\n"
             "roads:\n"
             "- {name: flat, type: plane, body: deck, at: [1, 2, 3], normal: [0.1, 0.2, 1]}\n"
             "- {name: wave, type: height, body: deck, point: bow, frame: body,"
             " forward: [1, 1, 0], height: h*sin(2*x + t) + h*y}\n"
             "- {name: dam, type: heightfield, body: deck, spacing: 1, row_spacing: 2,"
             " heights: [[0, h, 0], [h, 0.2, 0.3]]}\n"
             "- {name: still, type: height, at: [0, 0, 1], height: 0.5}\n"
             "forces: [{name: tyre, type: tyre, body: rim, road: wave, radius: 0.3, k: 1e5, mu: 1,"
             " slip_stiffness: 1e4, cornering_stiffness: 1e4, envelope: 0.1}]\n";
    se3d_write_options how = se3d_write_options_default();
    se3d_model *model = read_again(text, "deck.yaml");
    char *first = model ? text_of(model, &how) : NULL;
    se3d_model *again = first ? read_again(first, "deck.yaml") : NULL;
    char *second = again ? text_of(again, &how) : NULL;
    CHECK(second && strcmp(first, second) == 0);
    CHECK(model && se3d_system_count_roads(se3d_model_get_system(model)) == 4);
    for (size_t k = 0; again && k < 4; ++k) {
        const se3d_system *systems[2] = {se3d_model_get_system(model),
                                         se3d_model_get_system(again)};
        se3d_road_def def[2];
        se3d_road road[2];
        for (int i = 0; i < 2; ++i) {
            def[i] = se3d_road_def_default();
            CHECK(!se3d_system_get_road(systems[i], k, &road[i]));
            CHECK(!se3d_road_get_def(systems[i], road[i], &def[i]));
        }
        CHECK(strcmp(def[0].name, def[1].name) == 0);
        for (int c = 0; c < 3; ++c) {
            CHECK_NEAR(def[0].point[c], def[1].point[c], 0.0);
            CHECK_NEAR(def[0].normal[c], def[1].normal[c], 1e-15);
            CHECK_NEAR(def[0].forward[c], def[1].forward[c], 1e-15);
        }
        for (size_t n = 0; n < sizeof at / sizeof *at; ++n) {
            double h[2][4];
            CHECK(!se3d_road_get_height(systems[0], road[0], at[n][0], at[n][1], h[0]));
            CHECK(!se3d_road_get_height(systems[1], road[1], at[n][0], at[n][1], h[1]));
            CHECK(memcmp(h[0], h[1], sizeof h[0]) == 0);
        }
    }
    se3d_model_destroy(model);
    se3d_model_destroy(again);
    free(first);
    free(second);
}

/* Lengths of the road and the shape that a file of another unit of length names, and of a road that
 * calls have given other heights since. */
static void heights_are_written_as_they_are_now(void)
{
    static const char *const units[] = {"", "units: {length: mm}\n"};
    char path[800], table[800];
    put_file(file_of("", path, sizeof path), "hills.csv", "0,1\n2,3\n");
    file_of("hills.csv", table, sizeof table);
    for (size_t k = 0; k < 4; ++k) {
        char text[2400];
        double h[2][4];
        se3d_write_options how = se3d_write_options_default();
        se3d_road_def def = se3d_road_def_default();
        se3d_road road;
        snprintf(text, sizeof text,
                 "se3d: 1\n%sroads: [{name: way, type: heightfield, spacing: 1, file: '%.700s'}]\n"
                 "bodies: [{name: hill, mass: 1, inertia: [1, 1, 1], shapes: [{type: heightfield, "
                 "spacing: 1, file: '%.700s'}]}]\n",
                 units[k % 2], table, table);
        se3d_model *model = read_again(text, "m.yaml");
        se3d_system *system = se3d_model_get_system(model);
        CHECK(!se3d_road_find(system, "way", &road));
        CHECK(!se3d_road_get_def(system, road, &def));
        if (k > 1) {
            const double other[4] = {0.5, 0.25, 0.125, 0.75};
            def.heights = other;
            CHECK(!se3d_road_set_def(system, road, &def));
        }
        CHECK(!se3d_road_get_height(system, road, 0.0001, 0.0002, h[0]) && h[0][0] > 0.0);
        how.elements_only = 1;
        char *first = text_of(model, &how);
        CHECK(first && (strstr(first, "hills.csv") != NULL) == (k % 2 == 0));
        se3d_model *again = read_again(first ? first : "", "m.yaml");
        CHECK(again && !se3d_road_find(se3d_model_get_system(again), "way", &road));
        CHECK(!se3d_road_get_height(se3d_model_get_system(again), road, 0.0001, 0.0002, h[1]));
        CHECK_NEAR(h[0][0], h[1][0], 1e-15);
        free(first);
        se3d_model_destroy(model);
        se3d_model_destroy(again);
    }
    CHECK(remove(table) == 0);
}

static void a_road_of_triangles_without_a_file_is_refused(void)
{
    static const double corners[9] = {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0};
    static const uint32_t triangle[3] = {0, 1, 2};
    se3d_system *system = NULL;
    se3d_road_def def = se3d_road_def_default();
    se3d_road road;
    se3d_model_error error;
    char path[800];
    CHECK(!se3d_system_create(NULL, &system));
    CHECK(!se3d_system_get_ground(system, &def.body));
    def.name = "ramp";
    def.vertices = corners;
    def.vertex_count = 3;
    def.triangles = triangle;
    def.triangle_count = 1;
    CHECK(!se3d_road_create(system, &def, &road));
    CHECK(se3d_system_write(system, file_of("ramp.yaml", path, sizeof path), NULL, &error) ==
          SE3D_ERR_UNSUPPORTED);
    CHECK_CONTAINS(error.message, "road ramp is a mesh that no file has");
    se3d_system_destroy(system);
}

/* ---- systems that were made by calls --------------------------------------------------------*/

static se3d_status push_nothing(void *ctx, double t, const se3d_body_motion motion[2],
                                double wrench[12], double *K, double *D)
{
    (void)ctx, (void)t, (void)motion, (void)wrench, (void)K, (void)D;
    return SE3D_OK;
}

typedef struct machine {
    se3d_system *system;
    se3d_body arm, tip;
    se3d_constraint pin, slide;
    se3d_force spring;
} machine;

/* An arm with a slide, neither of which has a name. */
static machine make_machine(double angle)
{
    static const double at[3] = {0.1, 0.2, 0.3}, axis[3] = {0.3, -0.5, 0.9};
    machine m = {NULL, {0, 0}, {0, 0}, {0, 0}, {0, 0}, {0, 0}};
    se3d_body_def body = se3d_body_def_default();
    se3d_joint_def joint = se3d_joint_def_default();
    se3d_tsda_def spring = se3d_tsda_def_default();
    se3d_rsda_def twist = se3d_rsda_def_default();
    se3d_force made;
    CHECK(!se3d_system_create(NULL, &m.system));
    body.mass = 1.0 / 3.0;
    body.inertia[0] = body.inertia[1] = body.inertia[2] = 0.1;
    body.inertia[4] = 0.01;
    body.orientation[0] = cos(0.35);
    body.orientation[2] = sin(0.35);
    body.position[0] = 0.7;
    CHECK(!se3d_body_create(m.system, &body, &m.arm));
    body.position[0] = 1.3;
    body.orientation[0] = sin(0.2);
    body.orientation[2] = -cos(0.2);
    body.name = "the tip";
    CHECK(!se3d_body_create(m.system, &body, &m.tip));
    CHECK(!se3d_system_get_ground(m.system, &joint.body_i));
    joint.body_j = m.arm;
    joint.angle0 = angle;
    CHECK(!se3d_joint_def_set_frame(m.system, &joint, at, axis, NULL));
    CHECK(!se3d_joint_create_revolute(m.system, &joint, &m.pin));
    joint.body_i = m.arm;
    joint.body_j = m.tip;
    CHECK(!se3d_joint_def_set_frame(m.system, &joint, at, axis, at));
    CHECK(!se3d_joint_create_cylindrical(m.system, &joint, &m.slide));
    spring.body_i = m.arm;
    spring.body_j = m.tip;
    spring.point_j[1] = 0.4;
    spring.k = 10.0;
    CHECK(!se3d_force_create_tsda(m.system, &spring, &m.spring));
    twist.joint = m.pin;
    twist.k = 0.3;
    CHECK(!se3d_force_create_rsda(m.system, &twist, &made));
    return m;
}

static uint64_t run_system(se3d_system *system)
{
    se3d_solver_def def = se3d_solver_def_default();
    se3d_solver *solver = NULL;
    def.step = 1e-3;
    CHECK(!se3d_solver_create(system, &def, &solver));
    CHECK(se3d_solver_run(solver, 0.02) >= 0);
    se3d_solver_destroy(solver);
    return se3d_system_hash(system);
}

static void what_calls_have_made_and_set_is_in_the_file(void)
{
    char path[800];
    se3d_model *model = NULL;
    se3d_model_error error;
    machine m = make_machine(2.0);
    double angle = 0.0;
    const double g[3] = {0.0, -1.25, 0.0};
    CHECK(!se3d_force_set_parameter(m.system, m.spring, SE3D_FORCE_PARAMETER_K, 12.5));
    CHECK(!se3d_system_set_gravity(m.system, g));
    CHECK(!se3d_system_write(m.system, file_of("by_calls.yaml", path, sizeof path), NULL, &error));
    CHECK(!se3d_model_read_file(path, NULL, &model, &error));
    se3d_system *again = se3d_model_get_system(model);
    se3d_constraint pin;
    CHECK(!se3d_constraint_find(again, "joint1", &pin));
    CHECK(!se3d_joint_get_coordinate(again, pin, SE3D_JOINT_COORDINATE_ANGLE, &angle, NULL, NULL));
    CHECK_NEAR(angle, 2.0, 1e-14);
    CHECK(run_system(m.system) == run_system(again));
    remove(path);
    se3d_model_destroy(model);
    se3d_system_destroy(m.system);
}

static void turns_are_in_the_file(void)
{
    char path[800];
    se3d_model *model = NULL;
    se3d_model_error error;
    machine m = make_machine(-20.0);
    se3d_constraint pin;
    double angle = 0.0;
    CHECK(!se3d_system_write(m.system, file_of("turns.yaml", path, sizeof path), NULL, &error));
    CHECK(!se3d_model_read_file(path, NULL, &model, &error));
    CHECK(!se3d_constraint_find(se3d_model_get_system(model), "joint1", &pin));
    CHECK(!se3d_joint_get_coordinate(se3d_model_get_system(model), pin, SE3D_JOINT_COORDINATE_ANGLE,
                                     &angle, NULL, NULL));
    CHECK_NEAR(angle, -20.0, 1e-13);
    remove(path);
    se3d_model_destroy(model);
    se3d_system_destroy(m.system);
}

/* Elements do not depend on where their bodies are when they are written. */
static void a_joint_is_the_same_after_a_run(void)
{
    char path[800];
    se3d_model *model = NULL;
    se3d_model_error error;
    se3d_joint_def before = se3d_joint_def_default(), after = before;
    machine m = make_machine(2.0);
    se3d_constraint slide;
    CHECK(!se3d_joint_get_def(m.system, m.slide, &before));
    (void)run_system(m.system);
    CHECK(!se3d_system_write(m.system, file_of("moved.yaml", path, sizeof path), NULL, &error));
    CHECK(!se3d_model_read_file(path, NULL, &model, &error));
    CHECK(!se3d_constraint_find(se3d_model_get_system(model), "joint2", &slide));
    CHECK(!se3d_joint_get_def(se3d_model_get_system(model), slide, &after));
    const size_t first = offsetof(se3d_joint_def, point_i); /* all that is not a handle */
    CHECK(memcmp((const char *)&before + first, (const char *)&after + first,
                 sizeof before - first) == 0);
    remove(path);
    se3d_model_destroy(model);
    se3d_system_destroy(m.system);
}

static void a_callback_is_named_or_left_out(void)
{
    char path[800];
    se3d_model *model = NULL;
    se3d_model_error error;
    machine m = make_machine(2.0);
    se3d_force_callback_def push = se3d_force_callback_def_default();
    se3d_write_options partial = se3d_write_options_default();
    se3d_force made;
    push.name = "gust";
    push.body_i = m.arm;
    push.body_j = m.tip;
    push.callback = push_nothing;
    CHECK(!se3d_force_create_callback(m.system, &push, &made));
    file_of("callback.yaml", path, sizeof path);
    CHECK(se3d_system_write(m.system, path, NULL, &error) == SE3D_ERR_UNSUPPORTED);
    CHECK_CONTAINS(error.message, "force gust is a callback");
    partial.partial = 1;
    CHECK(!se3d_system_write(m.system, path, &partial, &error));
    CHECK(!se3d_model_read_file(path, NULL, &model, &error));
    CHECK(model && se3d_system_count_forces(se3d_model_get_system(model)) == 2);
    remove(path);
    se3d_model_destroy(model);
    se3d_system_destroy(m.system);
}

/* No key of a file says corners of a shape. */
static void a_plate_that_touches_is_not_written_without_its_corners(void)
{
    static const char text[] =
        "se3d: 1\nmaterials: [{name: m, density: 1000, stiffness: 1e5}]\ncontact: {}\n"
        "bodies: [{name: p, plate: [[0, 0, 0], [1, 0, 0], [0, 0, 1]], thickness: 0.1, "
        "material: m}]\n";
    se3d_model_error error;
    se3d_model *model = read_again(text, "m.yaml");
    CHECK(model != NULL);
    CHECK(se3d_model_write_text(model, NULL, NULL, 0, &(size_t){0}, &error) ==
          SE3D_ERR_UNSUPPORTED);
    CHECK_CONTAINS(error.message, "a plate that touches has no file");
    se3d_model_destroy(model);
}

int main(void)
{
    RUN(a_plate_that_touches_is_not_written_without_its_corners);
    RUN(every_example_is_written_and_read_as_the_same_system);
    RUN(sections_of_a_file_with_units_are_written_if_they_stay_the_same);
    RUN(sections_that_cannot_be_written_are_named_or_left_out);
    RUN(texts_are_read_again_as_they_were);
    RUN(files_that_a_model_names_are_found_from_another_place);
    RUN(roads_on_bodies_are_written_as_they_are_defined);
    RUN(heights_are_written_as_they_are_now);
    RUN(a_road_of_triangles_without_a_file_is_refused);
    RUN(what_calls_have_made_and_set_is_in_the_file);
    RUN(turns_are_in_the_file);
    RUN(a_joint_is_the_same_after_a_run);
    RUN(a_callback_is_named_or_left_out);
    return check_finish();
}
