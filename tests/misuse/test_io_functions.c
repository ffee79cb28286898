/* SPDX-License-Identifier: BSD-3-Clause */
/* One row for every function of libse3d-io: what it does with NULL, a wrong index and what cannot
 * be written. A failure leaves outputs NULL and a message if there is one to leave. */
#include <stdlib.h>

#include "check.h"
#include "se3d/import.h"
#include "se3d/io.h"
#include "se3d/study.h"

static const char text[] =
    "se3d: 1\ntitle: A block\nparameters: {m: 2}\n"
    "bodies: [{name: block, mass: m, inertia: [1, 1, 1], shapes: [{type: sphere, radius: 1}]}]\n"
    "analysis: [{type: dynamics, duration: 0.01}, {type: modes}]\n"
    "events: [{name: low, channel: block.position.z, value: -1e-4}]\n"
    "output: [{file: a.csv, channels: [block.position]}, {plot: a.svg},\n"
    "  {summary: s.csv, channels: [block.position, {twice: 2*block.position.z}]}]\n";

/* A model that was read, and its run. */
typedef struct world {
    se3d_model *model;
    se3d_run *run;
    se3d_scene *scene;
    char folder[800];
} world;

static world open_world(void)
{
    world w = {NULL, NULL, NULL, ""};
    se3d_run_options how = se3d_run_options_default();
    snprintf(w.folder, sizeof w.folder, "%s/misuse", check_scratch());
    how.directory = w.folder;
    CHECK(se3d_model_read_text(text, strlen(text), "a.yaml", NULL, &w.model, NULL) == SE3D_OK);
    CHECK(se3d_scene_create(w.model, &w.scene) == SE3D_OK);
    CHECK(se3d_model_run(w.model, &how, &w.run, NULL) >= 0);
    return w;
}

static void close_world(world *w)
{
    se3d_scene_destroy(w->scene);
    se3d_run_destroy(w->run);
    se3d_model_destroy(w->model);
}

#define IS(call, status) CHECK((call) == (status))

/* From within a run neither the model nor the run can be begun again or taken away. */
static int meddle(void *ctx, size_t analysis, double time, double fraction)
{
    const world *w = ctx;
    se3d_run *run = NULL;
    (void)analysis, (void)time, (void)fraction;
    IS(se3d_model_run(w->model, NULL, &run, NULL), SE3D_ERR_STATE);
    CHECK(run == NULL);
    se3d_model_destroy(w->model);
    se3d_system_destroy(se3d_model_get_system(w->model));
    IS(se3d_system_get_error_status(se3d_model_get_system(w->model)), SE3D_ERR_STATE);
    se3d_scene_destroy(w->scene);
    IS(se3d_scene_record(w->scene), SE3D_OK);
    return 0;
}

static void a_run_keeps_its_model(void)
{
    world w = open_world();
    se3d_run *run = NULL;
    se3d_run_options how = se3d_run_options_default();
    how.directory = w.folder;
    how.progress = meddle;
    how.ctx = &w;
    how.scene = w.scene;
    IS(se3d_model_run(w.model, &how, &run, NULL), SE3D_OK);
    CHECK(se3d_run_count_analyses(run) == 2);
    se3d_run_destroy(run);
    close_world(&w);
}

static const char particle_text[] =
    "se3d: 1\nparticles: [{material: m, radius: 0.1, lower: [0, 0, 0], upper: [.3, .3, .3]}]\n"
    "materials: [{name: m, density: 1000, stiffness: 2e4}]\ncontact: {law: hooke}\n"
    "bodies: [{name: block, mass: 1, inertia: [1, 1, 1]}]\n"
    "analysis: {type: dynamics, duration: 1e-3}\n"
    "output: [{file: g.csv, particles: true}, {file: b.csv, channels: [block.position]}]\n";

/* What a model has handed out is destroyed with it, and not before. */
static int take_away(void *ctx, size_t analysis, double time, double fraction)
{
    se3d_system *system = ctx;
    se3d_particles *set = NULL;
    (void)analysis, (void)time, (void)fraction;
    IS(se3d_system_get_particles(system, 0, &set), SE3D_OK);
    se3d_particles_destroy(set);
    CHECK_CONTAINS(se3d_system_get_error(system), "se3d_particles_destroy is not allowed");
    se3d_system_destroy(system);
    CHECK_CONTAINS(se3d_system_get_error(system), "se3d_system_destroy is not allowed");
    return 0;
}

static void a_model_keeps_its_system(void)
{
    se3d_run_options how = se3d_run_options_default();
    se3d_model_error error = {.message = ""};
    se3d_model *model = NULL;
    se3d_system *copy = NULL;
    se3d_particles *own = NULL;
    se3d_run *run = NULL;
    char folder[800];
    snprintf(folder, sizeof folder, "%s/misuse", check_scratch());
    IS(se3d_model_read_text(particle_text, strlen(particle_text), "g.yaml", NULL, &model, &error),
       SE3D_OK);
    fprintf(stderr, "%s", error.message);
    se3d_system *system = se3d_model_get_system(model);
    how.directory = folder;
    how.progress = take_away;
    how.ctx = system;
    IS(se3d_model_run(model, &how, &run, &error), SE3D_OK);
    CHECK(take_away(system, 0, 0.0, 0.0) == 0); /* nor outside of a run */
    IS(se3d_particles_create(system, NULL, &own), SE3D_OK);
    se3d_particles_destroy(own); /* who made it may */
    CHECK(se3d_system_count_particles(system) == 1);
    IS(se3d_system_clone(system, &copy), SE3D_OK);
    se3d_system_destroy(copy);
    se3d_run_destroy(run);
    se3d_model_destroy(model);
}

static void model_read_file(const world *w)
{
    se3d_model *model = w->model;
    se3d_model_error error;
    IS(se3d_model_read_file(NULL, NULL, &model, &error), SE3D_ERR_NULL);
    CHECK(model == NULL && error.message[0]);
    IS(se3d_model_read_file("a.yaml", NULL, NULL, &error), SE3D_ERR_NULL);
    model = w->model;
    IS(se3d_model_read_file("/no/such/file", NULL, &model, &error), SE3D_ERR_IO);
    CHECK(model == NULL);
    CHECK_CONTAINS(error.message, "/no/such/file: No such file");
    IS(se3d_model_read_file("/", NULL, &model, NULL), SE3D_ERR_IO);
}

static void model_read_text(const world *w)
{
    se3d_model *model = w->model;
    se3d_model_error error;
    se3d_model_options options = se3d_model_options_default();
    IS(se3d_model_read_text(NULL, 1, "a", NULL, &model, &error), SE3D_ERR_NULL);
    CHECK(model == NULL && error.message[0]);
    IS(se3d_model_read_text(text, 8, NULL, NULL, &model, &error), SE3D_ERR_NULL);
    IS(se3d_model_read_text(text, 8, "a", NULL, NULL, &error), SE3D_ERR_NULL);
    options.setting_count = 1; /* and settings NULL */
    IS(se3d_model_read_text(text, 8, "a", &options, &model, NULL), SE3D_ERR_NULL);
    options.settings = &(se3d_model_setting){NULL, "1"};
    IS(se3d_model_read_text(text, 8, "a", &options, &model, NULL), SE3D_ERR_NULL);
    options.settings = &(se3d_model_setting){"title", NULL};
    IS(se3d_model_read_text(text, 8, "a", &options, &model, NULL), SE3D_ERR_NULL);
    model = w->model;
    IS(se3d_model_read_text(text, 0, "a", NULL, &model, &error), SE3D_ERR_MODEL);
    CHECK(model == NULL && error.message[0]);
}

static void model_options_init(const world *w)
{
    se3d_model_options options = {.setting_count = 9};
    (void)w;
    se3d_model_options_init(NULL, sizeof options);
    se3d_model_options_init(&options, 0);
    CHECK(options.setting_count == 9);
    se3d_model_options_init(&options, sizeof options);
    CHECK(options.struct_size == sizeof options && options.setting_count == 0);
}

static void run_options_init(const world *w)
{
    se3d_run_options options = {.directory = "here"};
    (void)w;
    se3d_run_options_init(NULL, sizeof options);
    se3d_run_options_init(&options, 1);
    CHECK(options.directory != NULL);
    se3d_run_options_init(&options, sizeof options);
    CHECK(options.struct_size == sizeof options && options.directory == NULL);
}

static void destroyers(const world *w)
{
    (void)w;
    se3d_model_destroy(NULL);
    se3d_run_destroy(NULL);
    se3d_scene_destroy(NULL);
}

static void model_texts(const world *w)
{
    CHECK(se3d_model_get_system(NULL) == NULL && se3d_model_get_system(w->model) != NULL);
    CHECK_CONTAINS(se3d_model_get_name(w->model), "a");
    CHECK(se3d_model_get_name(NULL)[0] == '\0' && se3d_model_get_title(NULL)[0] == '\0');
    CHECK_CONTAINS(se3d_model_get_title(w->model), "A block");
}

static void counters(const world *w)
{
    CHECK(se3d_model_count_analyses(NULL) == 0 && se3d_model_count_analyses(w->model) == 2);
    CHECK(se3d_model_count_outputs(NULL) == 0 && se3d_model_count_outputs(w->model) == 2);
    CHECK(se3d_model_count_pictures(NULL) == 0 && se3d_model_count_pictures(w->model) == 1);
    CHECK(se3d_model_count_shapes(NULL) == 0 && se3d_model_count_shapes(w->model) == 1);
    CHECK(se3d_run_count_analyses(NULL) == 0 && se3d_run_count_analyses(w->run) == 2);
    CHECK(se3d_run_count_files(NULL) == 0 && se3d_run_count_files(w->run) >= 2);
    CHECK(se3d_run_count_particles(NULL) == 0 && se3d_run_count_particles(w->run) == 0);
    CHECK(se3d_run_count_summaries(NULL) == 0 && se3d_run_count_summaries(w->run) == 4);
    CHECK(se3d_run_count_events(NULL) == 0 && se3d_run_count_events(w->run) == 1);
}

static void model_get_parameter(const world *w)
{
    double value = 0.0;
    IS(se3d_model_get_parameter(NULL, "m", &value), SE3D_ERR_NULL);
    IS(se3d_model_get_parameter(w->model, NULL, &value), SE3D_ERR_NULL);
    IS(se3d_model_get_parameter(w->model, "m", NULL), SE3D_ERR_NULL);
    IS(se3d_model_get_parameter(w->model, "n", &value), SE3D_ERR_INVALID_ARGUMENT);
    IS(se3d_model_get_parameter(w->model, "m", &value), SE3D_OK);
    const size_t count = se3d_model_count_parameters(w->model);
    CHECK(count > 0 && se3d_model_count_parameters(NULL) == 0);
    CHECK(!se3d_model_get_parameter_name(NULL, 0)[0]);
    CHECK(!se3d_model_get_parameter_name(w->model, count)[0]);
    CHECK(!se3d_model_get_parameter_text(NULL, 0)[0]);
    CHECK(!se3d_model_get_parameter_text(w->model, SIZE_MAX)[0]);
    CHECK(se3d_model_get_parameter_name(w->model, 0)[0] &&
          se3d_model_get_parameter_text(w->model, 0)[0]);
    CHECK_NEAR(value, 2.0, 0.0);
}

/* Getters (owner, index, out): NULL of both, an index that is too large, and one that is right. */
#define GETTER(function, owner, type, count)                                                       \
    static void check_##function(const world *w)                                                   \
    {                                                                                              \
        type out;                                                                                  \
        memset(&out, 0, sizeof out);                                                               \
        IS(se3d_##function(NULL, 0, &out), SE3D_ERR_NULL);                                         \
        IS(se3d_##function(w->owner, 0, NULL), SE3D_ERR_NULL);                                     \
        IS(se3d_##function(w->owner, (count), &out), SE3D_ERR_INVALID_ARGUMENT);                   \
        IS(se3d_##function(w->owner, SIZE_MAX, &out), SE3D_ERR_INVALID_ARGUMENT);                  \
        IS(se3d_##function(w->owner, 0, &out), SE3D_OK);                                           \
    }

GETTER(model_get_analysis, model, se3d_model_analysis, 2)
GETTER(model_get_output, model, se3d_model_output, 2)
GETTER(model_get_picture, model, se3d_model_picture, 1)
GETTER(model_get_shape, model, se3d_model_shape, 1)
GETTER(run_get_analysis, run, se3d_run_analysis, 2)
GETTER(run_get_file, run, se3d_run_file, se3d_run_count_files(w->run))
GETTER(run_get_event, run, se3d_run_event, 1)
GETTER(run_get_summary, run, se3d_run_summary, 4)

/* The model has none. */
static void check_run_get_particles(const world *w)
{
    se3d_run_particles out;
    IS(se3d_run_get_particles(NULL, 0, &out), SE3D_ERR_NULL);
    IS(se3d_run_get_particles(w->run, 0, NULL), SE3D_ERR_NULL);
    IS(se3d_run_get_particles(w->run, 0, &out), SE3D_ERR_INVALID_ARGUMENT);
    IS(se3d_run_get_particles(w->run, SIZE_MAX, &out), SE3D_ERR_INVALID_ARGUMENT);
}

static void model_create_event(const world *w)
{
    se3d_solver_def how = se3d_solver_def_default();
    se3d_event_def def = se3d_event_def_default();
    se3d_event event = {7, 7};
    se3d_solver *solver = NULL;
    se3d_model_error error;
    const char *channel = "block.velocity.z";
    IS(se3d_solver_create(se3d_model_get_system(w->model), &how, &solver), SE3D_OK);
    IS(se3d_model_create_event(NULL, solver, channel, &def, &event, &error), SE3D_ERR_NULL);
    CHECK(event.index1 == 0 && error.message[0]);
    IS(se3d_model_create_event(w->model, NULL, channel, &def, &event, &error), SE3D_ERR_NULL);
    IS(se3d_model_create_event(w->model, solver, NULL, &def, &event, &error), SE3D_ERR_NULL);
    IS(se3d_model_create_event(w->model, solver, channel, NULL, &event, &error), SE3D_ERR_NULL);
    IS(se3d_model_create_event(w->model, solver, channel, &def, NULL, NULL), SE3D_ERR_NULL);
    const char *const wrong[] = {"blok.velocity.z", "block.velocity", "block.speed", "steps", ""};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k) {
        IS(se3d_model_create_event(w->model, solver, wrong[k], &def, &event, &error),
           SE3D_ERR_INVALID_ARGUMENT);
        CHECK(event.index1 == 0 && error.message[0]);
    }
    def.direction = 5;
    IS(se3d_model_create_event(w->model, solver, channel, &def, &event, &error),
       SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(error.message, "direction = 5");
    def = se3d_event_def_default();
    def.struct_size = 4096;
    IS(se3d_model_create_event(w->model, solver, channel, &def, &event, &error),
       SE3D_ERR_INVALID_ARGUMENT);
    def = se3d_event_def_default();
    IS(se3d_model_create_event(w->model, solver, channel, &def, &event, &error), SE3D_OK);
    CHECK(event.index1 != 0 && !error.message[0]);
    se3d_solver_destroy(solver);
}

static void model_get_solver(const world *w)
{
    se3d_solver_def def = se3d_solver_def_default();
    IS(se3d_model_get_solver(NULL, 0, &def), SE3D_ERR_NULL);
    IS(se3d_model_get_solver(w->model, 0, NULL), SE3D_ERR_NULL);
    IS(se3d_model_get_solver(w->model, 2, &def), SE3D_ERR_INVALID_ARGUMENT);
    IS(se3d_model_get_solver(w->model, 1, &def), SE3D_ERR_UNSUPPORTED);
    IS(se3d_model_get_solver(w->model, 0, &def), SE3D_OK);
    def.struct_size = 0;
    IS(se3d_model_get_solver(w->model, 0, &def), SE3D_ERR_INVALID_ARGUMENT);
}

static void model_get_channel(const world *w)
{
    const char *name = NULL;
    IS(se3d_model_get_channel(NULL, 0, 0, &name), SE3D_ERR_NULL);
    IS(se3d_model_get_channel(w->model, 0, 0, NULL), SE3D_ERR_NULL);
    IS(se3d_model_get_channel(w->model, 2, 0, &name), SE3D_ERR_INVALID_ARGUMENT);
    IS(se3d_model_get_channel(w->model, 0, 1, &name), SE3D_ERR_INVALID_ARGUMENT);
    IS(se3d_model_get_channel(w->model, 0, 0, &name), SE3D_OK);
    CHECK_CONTAINS(name, "block.position");
}

static void model_write(const world *w)
{
    se3d_write_options options = se3d_write_options_default();
    se3d_write_options larger[4];
    se3d_model_error error;
    se3d_system *system = se3d_model_get_system(w->model);
    char small[8];
    size_t length = 9;
    se3d_write_options_init(NULL, sizeof options);
    se3d_write_options_init(&options, 1);
    IS(se3d_model_write(NULL, "a.yaml", NULL, &error), SE3D_ERR_NULL);
    IS(se3d_model_write(w->model, NULL, NULL, &error), SE3D_ERR_NULL);
    IS(se3d_model_write(w->model, "/dev/null/a.yaml", NULL, &error), SE3D_ERR_IO);
    CHECK(error.message[0]);
    IS(se3d_model_write(w->model, "/dev/null/a.yaml", NULL, NULL), SE3D_ERR_IO);
    IS(se3d_system_write(NULL, "a.yaml", NULL, &error), SE3D_ERR_NULL);
    IS(se3d_system_write(system, NULL, NULL, &error), SE3D_ERR_NULL);
    IS(se3d_system_write(system, "/dev/null/a.yaml", NULL, NULL), SE3D_ERR_IO);
    IS(se3d_model_write_text(NULL, NULL, small, sizeof small, &length, &error), SE3D_ERR_NULL);
    CHECK(length == 0);
    IS(se3d_model_write_text(w->model, NULL, small, sizeof small, NULL, &error), SE3D_ERR_NULL);
    IS(se3d_model_write_text(w->model, NULL, small, sizeof small, &length, &error),
       SE3D_ERR_INVALID_ARGUMENT);
    CHECK(length > sizeof small);
    IS(se3d_model_write_text(w->model, NULL, NULL, 0, &length, NULL), SE3D_OK);
    memset(larger, 1, sizeof larger);
    larger[0].struct_size = sizeof larger;
    IS(se3d_model_write_text(w->model, larger, NULL, 0, &length, &error),
       SE3D_ERR_INVALID_ARGUMENT);
}

static void model_list_channels(const world *w)
{
    size_t count = 0;
    se3d_model_channel c = {.name = NULL};
    IS(se3d_model_list_channels(NULL, &count), SE3D_ERR_NULL);
    IS(se3d_model_list_channels(w->model, NULL), SE3D_ERR_NULL);
    IS(se3d_model_list_channels(w->model, &count), SE3D_OK);
    const size_t again = count;
    IS(se3d_model_list_channels(w->model, &count), SE3D_OK);
    CHECK(count == again && count > 10);
    IS(se3d_model_get_listed_channel(NULL, 0, &c), SE3D_ERR_NULL);
    IS(se3d_model_get_listed_channel(w->model, 0, NULL), SE3D_ERR_NULL);
    IS(se3d_model_get_listed_channel(w->model, count, &c), SE3D_ERR_INVALID_ARGUMENT);
    IS(se3d_model_get_listed_channel(w->model, SIZE_MAX, &c), SE3D_ERR_INVALID_ARGUMENT);
    IS(se3d_model_get_listed_channel(w->model, 0, &c), SE3D_OK);
    CHECK_CONTAINS(c.name, "block.position");
    CHECK_CONTAINS(c.unit, "m");
    CHECK(c.width == 3);
}

static void model_get_channel_value(const world *w)
{
    double value[4];
    size_t width = 0;
    IS(se3d_model_get_channel_value(NULL, 0, 0, NULL, value, &width), SE3D_ERR_NULL);
    IS(se3d_model_get_channel_value(w->model, 0, 0, NULL, NULL, &width), SE3D_ERR_NULL);
    IS(se3d_model_get_channel_value(w->model, 0, 0, NULL, value, NULL), SE3D_ERR_NULL);
    IS(se3d_model_get_channel_value(w->model, 2, 0, NULL, value, &width),
       SE3D_ERR_INVALID_ARGUMENT);
    IS(se3d_model_get_channel_value(w->model, 0, 1, NULL, value, &width),
       SE3D_ERR_INVALID_ARGUMENT);
    IS(se3d_model_get_channel_value(w->model, 0, 0, NULL, value, &width), SE3D_OK);
    CHECK(width == 3);
}

static void model_run(const world *w)
{
    se3d_run *run = w->run;
    se3d_model_error error;
    se3d_run_options how = se3d_run_options_default();
    IS(se3d_model_run(NULL, NULL, &run, &error), SE3D_ERR_NULL);
    CHECK(run == NULL && error.message[0]);
    IS(se3d_model_run(w->model, NULL, NULL, &error), SE3D_ERR_NULL);
    how.directory = "/dev/null/folder";
    IS(se3d_model_run(w->model, &how, &run, &error), SE3D_ERR_IO);
    CHECK_CONTAINS(error.message, "/dev/null/folder/a.csv: cannot be written");
    CHECK(se3d_run_count_files(run) == 0);
    se3d_run_destroy(run);
}

static void model_run_file(const world *w)
{
    const char *source = getenv("SE3D_SOURCE_DIR");
    se3d_model_error error;
    char path[800];
    IS(se3d_model_run_file(NULL, w->folder, &error), SE3D_ERR_NULL);
    CHECK(error.message[0]);
    IS(se3d_model_run_file("/nowhere/a.yaml", w->folder, NULL), SE3D_ERR_IO);
    IS(se3d_model_run_file("/nowhere/a.yaml", w->folder, &error), SE3D_ERR_IO);
    CHECK_CONTAINS(error.message, "/nowhere/a.yaml");
    snprintf(path, sizeof path, "%s/examples/models/tsda_mass.yaml", source ? source : ".");
    IS(se3d_model_run_file(path, "/dev/null/folder", &error), SE3D_ERR_IO);
    CHECK_CONTAINS(error.message, "cannot be written");
    IS(se3d_model_run_file(path, w->folder, &error), SE3D_OK);
    CHECK(error.message[0] == '\0');
}

static void scene_create(const world *w)
{
    se3d_scene *scene = w->scene;
    IS(se3d_scene_create(NULL, &scene), SE3D_ERR_NULL);
    CHECK(scene == NULL);
    IS(se3d_scene_create(w->model, NULL), SE3D_ERR_NULL);
}

static void scene_record(const world *w)
{
    IS(se3d_scene_record(NULL), SE3D_ERR_NULL);
    IS(se3d_scene_record(w->scene), SE3D_OK);
    IS(se3d_scene_record(w->scene), SE3D_OK); /* the same time again */
}

static void scene_write(const world *w)
{
    char path[900];
    se3d_model_error error;
    IS(se3d_scene_write(NULL, "a.glb", &error), SE3D_ERR_NULL);
    IS(se3d_scene_write(w->scene, NULL, &error), SE3D_ERR_NULL);
    IS(se3d_scene_write(w->scene, "/dev/null/a.glb", &error), SE3D_ERR_IO);
    CHECK_CONTAINS(error.message, "/dev/null/a.glb: cannot be written");
    IS(se3d_scene_write(w->scene, "/dev/null/a.glb", NULL), SE3D_ERR_IO);
    snprintf(path, sizeof path, "%s/a.glb", w->folder);
    IS(se3d_scene_write(w->scene, path, &error), SE3D_OK);
    CHECK(error.message[0] == '\0');
}

static void model_import_file(const world *w)
{
    se3d_model_import *import = NULL;
    se3d_model_import_options how = se3d_model_import_options_default();
    se3d_model_error error;
    (void)w;
    IS(se3d_model_import_file(NULL, NULL, &import, &error), SE3D_ERR_NULL);
    IS(se3d_model_import_file("a.urdf", NULL, NULL, &error), SE3D_ERR_NULL);
    IS(se3d_model_import_file("/dev/null", NULL, &import, &error), SE3D_ERR_IO);
    CHECK_CONTAINS(error.message, "/dev/null");
    IS(se3d_model_import_file("/none/a.urdf", NULL, &import, NULL), SE3D_ERR_IO);
    how.struct_size = 1;
    IS(se3d_model_import_file("a.urdf", &how, &import, &error), SE3D_ERR_INVALID_ARGUMENT);
    CHECK(import == NULL);
}

static void model_import_text(const world *w)
{
    se3d_model_import *import = NULL;
    se3d_model_import_options how = se3d_model_import_options_default();
    se3d_model_error error;
    (void)w;
    IS(se3d_model_import_text(NULL, 0, "a", NULL, &import, &error), SE3D_ERR_NULL);
    IS(se3d_model_import_text("", 0, NULL, NULL, &import, &error), SE3D_ERR_NULL);
    IS(se3d_model_import_text("", 0, "a", NULL, NULL, &error), SE3D_ERR_NULL);
    IS(se3d_model_import_text("nothing", 7, "a", NULL, &import, NULL), SE3D_ERR_MODEL);
    how.format = "dwg";
    IS(se3d_model_import_text("nothing", 7, "a", &how, &import, &error), SE3D_ERR_MODEL);
    CHECK_CONTAINS(error.message, "`dwg` is not known");
    how.struct_size = 100000;
    IS(se3d_model_import_text("", 0, "a", &how, &import, &error), SE3D_ERR_INVALID_ARGUMENT);
    CHECK(import == NULL);
}

static void model_import_nothing(const world *w)
{
    se3d_model_import_note note;
    size_t length = 1;
    (void)w;
    se3d_model_import_options_init(NULL, 8);
    CHECK(se3d_model_import_count_notes(NULL) == 0);
    CHECK(se3d_model_import_count_lost(NULL) == 0);
    CHECK(se3d_model_import_get_text(NULL, &length)[0] == '\0' && length == 0);
    CHECK(se3d_model_import_get_text(NULL, NULL)[0] == '\0');
    CHECK(se3d_model_import_get_format(NULL)[0] == '\0');
    IS(se3d_model_import_get_note(NULL, 0, &note), SE3D_ERR_NULL);
    se3d_model_import_destroy(NULL);
}

#include "misuse/misuse_studies.h"

static const struct {
    const char *names; /* with a blank at each end */
    void (*check)(const world *w);
} rows[] = {
    {" se3d_model_read_file ", model_read_file},
    {" se3d_model_read_text ", model_read_text},
    {" se3d_model_import_file ", model_import_file},
    {" se3d_model_import_text ", model_import_text},
    {" se3d_model_import_options_init se3d_model_import_count_notes se3d_model_import_count_lost "
     "se3d_model_import_get_text se3d_model_import_get_format se3d_model_import_get_note "
     "se3d_model_import_destroy ",
     model_import_nothing},
    {" se3d_model_write se3d_model_write_text se3d_system_write se3d_write_options_init ",
     model_write},
    {" se3d_model_options_init ", model_options_init},
    {" se3d_run_options_init ", run_options_init},
    {" se3d_model_destroy se3d_run_destroy se3d_scene_destroy ", destroyers},
    {" se3d_model_get_system se3d_model_get_name se3d_model_get_title ", model_texts},
    {" se3d_model_count_analyses se3d_model_count_outputs se3d_model_count_pictures "
     "se3d_model_count_shapes se3d_run_count_analyses se3d_run_count_files se3d_run_count_events "
     "se3d_run_count_particles se3d_run_count_summaries ",
     counters},
    {" se3d_model_get_parameter se3d_model_count_parameters se3d_model_get_parameter_name "
     "se3d_model_get_parameter_text ",
     model_get_parameter},
    {" se3d_model_get_analysis ", check_model_get_analysis},
    {" se3d_model_get_output ", check_model_get_output},
    {" se3d_model_get_picture ", check_model_get_picture},
    {" se3d_model_get_shape ", check_model_get_shape},
    {" se3d_run_get_analysis ", check_run_get_analysis},
    {" se3d_run_get_file ", check_run_get_file},
    {" se3d_run_get_particles ", check_run_get_particles},
    {" se3d_run_get_event ", check_run_get_event},
    {" se3d_run_get_summary ", check_run_get_summary},
    {" se3d_model_create_event ", model_create_event},
    {" se3d_model_get_solver ", model_get_solver},
    {" se3d_model_get_channel ", model_get_channel},
    {" se3d_model_list_channels se3d_model_get_listed_channel ", model_list_channels},
    {" se3d_model_get_channel_value ", model_get_channel_value},
    {" se3d_model_run ", model_run},
    {" se3d_model_run_file ", model_run_file},
    {" se3d_scene_create ", scene_create},
    {" se3d_scene_record ", scene_record},
    {" se3d_scene_write ", scene_write},
    {" se3d_study_create se3d_study_destroy ", study_create},
    {" se3d_study_count_samples se3d_study_count_parameters se3d_study_count_measures "
     "se3d_study_get_parameter_name se3d_study_get_measure_name se3d_study_get_sample ",
     study_getters},
    {" se3d_study_eval se3d_study_run_sample se3d_study_answer se3d_study_set_interrupt ",
     study_runs},
    {" se3d_study_count_sensitivities se3d_study_get_sensitivity_name se3d_study_eval_nominal "
     "se3d_study_eval_sensitivity ",
     study_sensitivities},
    {" se3d_study_get_goal se3d_study_get_goal_sized se3d_study_count_unknowns "
     "se3d_study_get_unknown_name "
     "se3d_study_get_unknown se3d_study_write_unknown se3d_study_count_limits "
     "se3d_study_get_limit se3d_study_eval_unknowns ",
     study_goals},
    {" se3d_study_table_def_init se3d_study_table_open ", study_table_definitions},
    {" se3d_study_table_append se3d_study_table_has se3d_study_table_count_failed "
     "se3d_study_table_close ",
     study_tables},
    {" se3d_study_merge se3d_study_merge_options_init ", study_merge},
};

static void every_function_rejects_bad_arguments(void)
{
    world w = open_world();
    for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
        rows[k].check(&w);
    }
    close_world(&w);
}

static void every_function_of_the_map_has_a_row(void)
{
    const char *folder = getenv("SE3D_SOURCE_DIR");
    char path[1024];
    char line[256];
    int count = 0;
    snprintf(path, sizeof path, "%s/lib/io/se3d-io.map", folder ? folder : ".");
    FILE *map = fopen(path, "r");
    CHECK(map != NULL);
    while (map && fgets(line, sizeof line, map)) {
        char word[260];
        const char *name = strstr(line, "se3d_");
        char *end = name ? strchr(name, ';') : NULL;
        int found = 0;
        if (!end) {
            continue;
        }
        *end = '\0';
        char *sized = strstr(line, "_sized"); /* called by the header's function */
        if (sized) {
            *sized = '\0';
        }
        snprintf(word, sizeof word, " %s ", name);
        for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
            found = found || strstr(rows[k].names, word) != NULL;
        }
        if (!found) {
            fprintf(stderr, "%s has no row in tests/misuse\n", name);
        }
        CHECK(found);
        ++count;
    }
    CHECK(count >= 30);
    if (map) {
        fclose(map);
    }
}

static void a_sample_keeps_its_study(void)
{
    world w = open_world();
    study_keeps_its_sample(&w);
    study_keeps_its_neighbours(&w);
    close_world(&w);
}

int main(void)
{
    RUN(a_run_keeps_its_model);
    RUN(a_model_keeps_its_system);
    RUN(a_sample_keeps_its_study);
    RUN(every_function_of_the_map_has_a_row);
    RUN(every_function_rejects_bad_arguments);
    return check_finish();
}
