/* SPDX-License-Identifier: BSD-3-Clause */
/* The k-th allocation of reading and running a model fails, once or for ever, for every k until all
 * goes well: the failure is reported with a message and nothing leaks. */
#include <stdlib.h>

#include "check.h"
#include "se3d/io.h"
#include "support/counting.h"
#include "support/scratch.h"

#define MESH  "solid.obj"
#define TABLE "stiffness.csv"
#define HEAD                                                                                       \
    "se3d: 1\n"                                                                                    \
    "gravity: [0, \"0*t\", -9.81]\n"                                                               \
    "bodies:\n"                                                                                    \
    "  - {name: a, mass: 1, inertia: [1, 1, 1], position: [0.5, 0, 0], held: true}\n"              \
    "  - {name: b, density: 6, position: [1.5, 0, 0], shapes: [{type: mesh, file: " MESH ",\n"     \
    "     position: [-0.25, -0.25, -0.25]}]}\n"                                                    \
    "joints:\n"                                                                                    \
    "  - {name: pin, type: revolute, body_i: ground, body_j: a, at: [0, 0, 0], axis: [0, 1, 0]}\n" \
    "  - {name: slide, type: cylindrical, body_i: a, body_j: b, at: [1, 0, 0], axis: [1, 0, 0]}\n" \
    "forces:\n"                                                                                    \
    "  - {type: rsda, joint: pin, k: 100, c: 1}\n"                                                 \
    "  - {type: rsda, joint: slide, k: {spline: " TABLE "}, damper: 0.1*v}\n"                      \
    "  - {type: tsda, body_i: a, body_j: b, k: 50, c: 1, l0: 1, spring: 5*x^3, h: \"0*t\"}\n"      \
    "  - {type: bushing, body_i: ground, body_j: b, at: [1.5, 0, 0], K: [1, 1, 1, 1, 1, 1]}\n"     \
    "  - {type: effort, joint: pin, value: 1}\n"                                                   \
    "  - {type: effort, joint: slide, coordinate: angle, value: t - q}\n"                          \
    "  - {type: stop, joint: slide, coordinate: displacement, upper: 1, k: 1e3}\n"

#if defined(SE3D_HAS_ZLIB)
#define COMPRESSED ", compression: 6"
#else
#define COMPRESSED ""
#endif

static const char *const texts[] = {
    HEAD "  - {type: friction, joint: pin, limit: 0.1}\n"
         "analysis:\n"
         "  - {type: assembly}\n"
         "  - {type: dynamics, duration: 0.01, step: 0.005}\n"
         "  - {type: dynamics, duration: 0.01, method: generalized_alpha, step: 0.005}\n",
    HEAD
    "analysis:\n"
    "  - {type: equilibrium}\n"
    "  - {type: modes, inputs: [{body: b, direction: [0, 0, 1]}],\n"
    "     outputs: [{body: b, direction: [0, 0, 1]}], frequencies: {from: 1, to: 2, count: 3}}\n"
    "output:\n"
    "  - {file: state.csv, channels: [a.position, pin.angle, energy.balance]}\n"
    "  - {vtk: motion.pvd}\n"
    "  - {plot: state.svg, x: pin.angle, channels: [a.position.x]}\n"
    "  - {video: state.mp4, speed: 2}\n",
    /* A parallelogram that is flat at 1 s, where only the motion on both sides tells how it goes
       on. */
    "se3d: 1\n"
    "bodies:\n"
    "  - {name: crank, mass: 1, inertia: [1, 1, 1], position: [0, 0.5, 0]}\n"
    "  - {name: coupler, mass: 1, inertia: [1, 1, 1], position: [1, 1, 0]}\n"
    "  - {name: rocker, mass: 1, inertia: [1, 1, 1], position: [2, 0.5, 0]}\n"
    "joints:\n"
    "  - {name: O, type: revolute, body_i: ground, body_j: crank, at: [0, 0, 0], axis: [0, 0, 1]}\n"
    "  - {type: revolute, body_i: crank, body_j: coupler, at: [0, 1, 0], axis: [0, 0, 1]}\n"
    "  - {type: revolute, body_i: coupler, body_j: rocker, at: [2, 1, 0], axis: [0, 0, 1]}\n"
    "  - {type: revolute, body_i: ground, body_j: rocker, at: [2, 0, 0], axis: [0, 0, 1]}\n"
    "drivers: [{joint: O, coordinate: angle, value: pi/2*t}]\n"
    "analysis: {type: kinematics, duration: 1, step: 0.25}\n"
    "output: [{file: flat.csv, channels: [rocker.position]}]\n",
    "se3d: 1\nmaterials: [{name: m, density: 1, stiffness: 1e3}]\ncontact: {pairs: [{material_1: "
    "m, "
    "material_2: m, friction: 0.1}]}\nparticles: [{material: m, radius: 0.1, lower: [0, 0, 0], "
    "upper: "
    "[0.5, 0.5, 0.5]}]\nbodies: [{name: ground, shapes: [{type: plane, material: m}]}]\n"
    "analysis: {type: dynamics, duration: 0.01}\noutput: [{file: s.csv, every: 0.01, channels: "
    "[contacts.count]}, {file: g.csv, every: 0.01, particles: true}]\n",
    /* HDF5, and what particles do to a wall, for VTK, where it can be compressed. */
    "se3d: 1\nmaterials: [{name: m, density: 1, stiffness: 1e3}]\ncontact: {}\n"
    "particles: [{material: m, radius: 0.1, lower: [0, 0, 0], upper: [0.3, 0.3, 0.3]}]\n"
    "bodies: [{name: ground, shapes: [{name: tube, type: funnel, bottom_radius: 1, top_radius: 2,\n"
    "  length: 0.5, material: m}]}]\nanalysis: {type: dynamics, duration: 0.01}\noutput:\n"
    "  - {file: g.h5, every: 0.01, particles: true}\n  - {vtk: motion.vtkhdf, every: "
    "0.01" COMPRESSED "}\n  - {wall_map: w.vtp, shape: tube, every: 0.01" COMPRESSED "}\n"
    "  - {average: a.vtkhdf, every: 0.01, fields: {lower: [0, 0, 0], upper: [1, 1, 1],\n"
    "     cells: [2, 1, 1], width: 1}}\n",
    /* Bars and plates with their joints, mirrored; a table that repeats. */
    "se3d: 1\nmaterials: [{name: steel, density: 7850}]\nparts:\n  side:\n    bodies:\n"
    "      - {name: bar, from: [0, 0, 0], to: [1, 0, 0], radius: 0.1, material: steel, body_from: "
    "ground, body_to: web}\n      - {name: web, plate: [[1, 0, 0], [2, 0, 0], [1, 1, 0]], "
    "thickness: 0.1, density: 1}\n"
    "instances: [{part: side, prefix: l_}, {part: side, prefix: r_, mirror: y}]\n"
    "gravity: [0, 0, {akima: [[0, 1], [1, 2], [2, 1]], periodic: true}]\n"
    "analysis: {type: dynamics, duration: 0.01, step: 0.005}\n",
    /* Points, units and parts. */
    "se3d: 1\n"
    "units: {length: mm}\n"
    "parameters: {v: [0, 1 m, 2], n: 2}\n"
    "points: {p: \"mid(q, v)\", q: \"[0, norm(v), 30 mm]\"}\n"
    "parts:\n"
    "  side:\n"
    "    parameters: {m: 1}\n"
    "    points: {a: [0, 100, 0]}\n"
    "    bodies: [{name: b, density: 6, position: a, shapes: [{type: mesh, file: " MESH ",\n"
    "      position: [-250, -250, -250]}], markers: [{name: m, at: a}]}]\n"
    "    joints: [{name: pin, type: revolute, body_i: ground, body_j: b, at: a, axis: [1, 0, 0]}]\n"
    "    forces: [{name: f, type: force, body: b, at: a, value: [0, \"2 N/s*a.y/1 m*t\", 0]}]\n"
    "instances:\n"
    "  - {part: side, prefix: \"s{i}_\", repeat: n, when: i < 2, parameters: {a: p, m: 2}}\n"
    "  - {part: side, prefix: t_, mirror: y, position: q}\n"
    "analysis: {type: dynamics, duration: 0.01, method: hht, step: 0.005}\n"
    "output: [{file: parts.csv, channels: [s1_b.position, t_pin.angle]}]\n",
};

typedef struct attempt {
    se3d_status status;
    int reached; /* whether allocation k was asked for */
    size_t files;
} attempt;

/* The scene of where the run has ended. */
static se3d_status draw(se3d_model *model, const char *folder, se3d_scene **scene,
                        se3d_model_error *error)
{
    char path[900];
    snprintf(path, sizeof path, "%s/scene.glb", folder);
    snprintf(error->message, sizeof error->message, "no scene");
    const se3d_status status = se3d_scene_create(model, scene);
    return status < 0 ? status : se3d_scene_write(*scene, path, error);
}

static attempt try_with(const char *text, support_counting counting)
{
    const se3d_allocator allocator = support_counting_allocator(&counting);
    char folder[800];
    se3d_model *model = NULL;
    se3d_scene *scene = NULL;
    se3d_run *run = NULL;
    se3d_model_error error = {0, 0, ""};
    se3d_model_options options = se3d_model_options_default();
    se3d_run_options how = se3d_run_options_default();
    snprintf(folder, sizeof folder, "%s/out-of-memory", check_scratch());
    options.allocator = &allocator;
    how.directory = folder;
    how.estimate = 1;
    attempt a = {SE3D_OK, 0, 0};
    a.status =
        se3d_model_read_text(text, strlen(text), scratch_path("m.yaml"), &options, &model, &error);
    if (a.status >= 0) {
        a.status = se3d_model_run(model, &how, &run, &error);
        a.files = se3d_run_count_files(run);
    }
    if (a.status >= 0) {
        a.status = draw(model, folder, &scene, &error);
    }
    if (a.status >= 0) {
        size_t length = 0;
        se3d_write_options partial = se3d_write_options_default();
        partial.partial = 1; /* a mesh that is mirrored has no file */
        snprintf(error.message, sizeof error.message, "not written");
        a.status = se3d_model_write_text(model, &partial, NULL, 0, &length, &error);
    }
    a.reached = counting.failed > 0;
    if (a.status < 0) {
        CHECK(error.message[0] != '\0');
        if (a.status != SE3D_ERR_NO_MEMORY) {
            fprintf(stderr, "allocation %zu: %s\n", counting.fail_at, error.message);
        }
    }
    se3d_scene_destroy(scene);
    se3d_run_destroy(run);
    se3d_model_destroy(model);
    CHECK(counting.live == 0 && counting.bytes == 0 && counting.wrong == 0);
    return a;
}

static attempt try_once(const char *text, size_t k, int for_ever)
{
    return try_with(text, (support_counting){.fail_at = k, .for_ever = for_ever});
}

/* Seldom enough that many attempts come far, where several allocations may fail one after the
 * other. */
static void survive_failures_by_chance(const char *text, size_t files)
{
    size_t failures = 0;
    for (uint64_t seed = 1; seed <= 60; ++seed) {
        const support_counting counting = {.seed = seed, .one_in = 20u << seed % 6};
        const attempt a = try_with(text, counting);
        failures += a.status < 0 ? 1 : 0;
        CHECK(a.status == SE3D_ERR_NO_MEMORY || (a.status >= 0 && a.files == files && !a.reached));
    }
    CHECK(failures > 20);
}

static void reading_and_running_survives_every_failed_allocation(void)
{
    FILE *table = fopen(scratch_path(TABLE), "wb");
    CHECK(table && fputs("x,force\n-1,-9\n1,9\n", table) >= 0);
    CHECK(!table || fclose(table) == 0);
    FILE *mesh = fopen(scratch_path(MESH), "wb");
    CHECK(mesh && fputs("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n",
                        mesh) >= 0);
    if (mesh) {
        fclose(mesh);
    }
    for (size_t m = 0; m < sizeof texts / sizeof *texts; ++m) {
        const attempt whole = try_once(texts[m], 0, 0);
        CHECK(whole.status >= 0 && whole.files > 0);
        for (int for_ever = 0; for_ever < 2; ++for_ever) {
            size_t k = 1;
            attempt a = {SE3D_OK, 1, 0};
            for (; k < 5000 && a.reached; ++k) {
                a = try_once(texts[m], k, for_ever);
                const int done = a.status >= 0 && a.files == whole.files;
                CHECK(a.status == SE3D_ERR_NO_MEMORY || (done && !a.reached));
            }
            CHECK(k > 50 && k < 5000);
            CHECK(a.files == whole.files);
        }
        survive_failures_by_chance(texts[m], whole.files);
    }
    scratch_remove(MESH);
    scratch_remove(TABLE);
}

static const char swing[] =
    "se3d: 1\nbodies: [{name: a, mass: 1, inertia: [0.01, 0.1, 0.1], position: [0.5, 0, 0]}]\n"
    "joints: [{name: s, type: revolute, body_i: ground, body_j: a, at: [0, 0, 0], axis: [0, 1, 0]}]"
    "\nevents: [{name: e, channel: a.position.x, value: 0.4}]\n"
    "analysis: [{type: equilibrium}, {type: dynamics, duration: 0.05}]\n"
    "output: [{file: r.csv, every: 0.01, channels: [a.position]},\n"
    "  {summary: s.csv, every: 0.01, channels: [a.position]}]\n";

typedef struct stop {
    int rows, asked;
} stop;

/* The user ends the run after some rows. */
static int end_after(void *ctx, size_t analysis, double time, double fraction)
{
    stop *s = ctx;
    (void)analysis, (void)time, (void)fraction;
    return s->rows > 0 && ++s->asked >= s->rows;
}

/* A run with checkpoints, of which allocation k fails; `rows`: it is ended then, 0: never. */
static attempt resume_once(size_t k, int resume, int rows)
{
    support_counting counting = {.fail_at = 0};
    const se3d_allocator allocator = support_counting_allocator(&counting);
    char folder[800];
    se3d_model *model = NULL;
    se3d_run *run = NULL;
    se3d_scene *scene = NULL;
    se3d_model_error error = {0, 0, ""};
    se3d_model_options options = se3d_model_options_default();
    se3d_run_options how = se3d_run_options_default();
    stop s = {rows, 0};
    snprintf(folder, sizeof folder, "%s/out-of-memory-resume", check_scratch());
    options.allocator = &allocator;
    how.directory = folder;
    how.checkpoint = 1e-9;
    how.resume = resume;
    how.progress = end_after;
    how.ctx = &s;
    CHECK(!se3d_model_read_text(swing, strlen(swing), "m.yaml", &options, &model, &error));
    CHECK(!se3d_scene_create(model, &scene));
    how.scene = scene;
    counting.calls = 0;
    counting.fail_at = k;
    attempt a = {SE3D_OK, 0, 0};
    a.status = se3d_model_run(model, &how, &run, &error);
    a.files = se3d_run_count_files(run);
    a.reached = counting.failed > 0;
    CHECK(a.status >= 0 || error.message[0] != '\0');
    se3d_scene_destroy(scene);
    se3d_run_destroy(run);
    se3d_model_destroy(model);
    CHECK(counting.live == 0 && counting.bytes == 0 && counting.wrong == 0);
    return a;
}

/* Writing a checkpoint may fail, and the run goes on; going on with one fails or succeeds. */
static void checkpoints_survive_failed_allocations(void)
{
    const size_t files = resume_once(0, 0, 0).files;
    for (int resume = 0; resume < 2; ++resume) {
        attempt a = {SE3D_OK, 1, 0};
        size_t k = 1;
        for (; a.reached; k += 1 + k / 40) {
            CHECK(!resume || resume_once(0, 0, 2).status >= 0);
            a = resume_once(k, resume, 0);
            CHECK(a.status == SE3D_ERR_NO_MEMORY || (resume && a.status == SE3D_ERR_STATE) ||
                  (a.status >= 0 && a.files == files));
        }
        CHECK(k > 30);
        CHECK(a.status >= 0);
    }
}

static void count_mistake(void *ctx, const se3d_model_error *error)
{
    size_t *count = ctx;
    *count += error->message[0] != '\0';
}

/* Without memory for a further reading, the mistakes that are known by then are reported. */
static void mistakes_are_reported_with_any_memory(void)
{
    static const char text[] = "se3d: 1\nbodies: [{name: a, mas: -1}, {name: b, mass: x}]\n"
                               "joints: [{name: j, type: hinge, body1: a, body2: b}]\n";
    size_t most = 0;
    int failed = 1;
    for (size_t k = 1; failed; ++k) {
        support_counting counting = {.fail_at = k, .for_ever = 0};
        const se3d_allocator allocator = support_counting_allocator(&counting);
        se3d_model_options options = se3d_model_options_default();
        se3d_model_error error;
        se3d_model *model = NULL;
        size_t count = 0;
        options.allocator = &allocator;
        options.report = count_mistake;
        options.report_ctx = &count;
        const se3d_status status = se3d_model_read_text(text, strlen(text), scratch_path("m.yaml"),
                                                        &options, &model, &error);
        CHECK(status == SE3D_ERR_NO_MEMORY || (status == SE3D_ERR_MODEL && count > 0));
        CHECK(model == NULL && counting.live == 0 && counting.bytes == 0 && counting.wrong == 0);
        failed = counting.failed > 0;
        most = count;
    }
    CHECK(most >= 5);
}

int main(void)
{
    RUN(checkpoints_survive_failed_allocations);
    RUN(reading_and_running_survives_every_failed_allocation);
    RUN(mistakes_are_reported_with_any_memory);
    return check_finish();
}
