/* SPDX-License-Identifier: BSD-3-Clause */
/* The motion of a model as a scene: recorded poses, and the nodes of a glTF file.  docs/scene.md
 *
 * glTF has y upwards: a root node turns our z to it. Every body is a node of its name; shapes,
 * joints (named as they are, at the point of body j) and markers are its children. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/base/elementary.h"
#include "io/base/file.h"
#include "io/base/pool.h"
#include "io/document/document.h"
#include "io/document/keys.h"
#include "io/model/model.h"
#include "io/write/drawing.h"
#include "io/write/drawing_part.h"
#include "io/write/glb.h"
#include "io/write/scene.h"

enum { SAMPLES_MAX = 1250 }; /* a page of 20 bodies stays below 1.5 MB */

#define POSES_SIZE (SAMPLES_MAX * SE3DI_POSE * sizeof(double)) /* of one body */

struct se3d_scene {
    se3di_iopool pool;
    se3d_model *model;
    double *times;
    se3di_poses poses;
    size_t stride; /* every so many records are kept */
    size_t skipped;
};

/* Positions, turns and scales of a node at all samples. */
typedef struct track {
    double *r, *q, *scale;
} track;

typedef struct drawing {
    se3d_scene *scene;
    se3di_glb glb;
    se3di_iobytes nodes;
    se3di_iobytes channels;
    se3di_iobytes samplers;
    se3di_iobytes rest;
    size_t node_count;
    size_t sampler_count;
    se3di_sizes sizes;
    track track; /* of one node after the other */
} drawing;

se3d_status se3d_scene_create(se3d_model *model, se3d_scene **out)
{
    se3di_iopool pool;
    if (out) {
        *out = NULL;
    }
    if (!model || !out) {
        return SE3D_ERR_NULL;
    }
    se3di_iopool_init(&pool, &model->pool.allocator);
    se3d_scene *scene = se3di_iopool_alloc(&pool, sizeof *scene);
    if (scene && model->body_count <= SIZE_MAX / 2 / POSES_SIZE) {
        scene->poses.bodies = model->body_count;
        scene->times = se3di_iopool_take(&pool, SAMPLES_MAX * sizeof *scene->times);
        scene->poses.values = se3di_iopool_take(&pool, model->body_count * POSES_SIZE);
    }
    if (!scene || !scene->times || !scene->poses.values) {
        se3di_iopool_destroy(&pool);
        return SE3D_ERR_NO_MEMORY;
    }
    scene->poses.times = scene->times;
    scene->model = model;
    scene->stride = 1;
    scene->pool = pool;
    *out = scene;
    return SE3D_OK;
}

void se3d_scene_destroy(se3d_scene *scene)
{
    if (scene && scene->model->kept != scene) {
        se3di_iopool pool = scene->pool; /* the scene itself lies in it */
        se3di_iopool_destroy(&pool);
    }
}

static double *pose_of(const se3d_scene *scene, size_t sample, size_t body)
{
    return scene->poses.values + (sample * scene->poses.bodies + body) * SE3DI_POSE;
}

static void thin_out(se3d_scene *scene)
{
    const size_t count = scene->poses.count;
    for (size_t k = 1; 2 * k < count; ++k) {
        scene->times[k] = scene->times[2 * k];
        memcpy(pose_of(scene, k, 0), pose_of(scene, 2 * k, 0),
               SE3DI_POSE * scene->poses.bodies * sizeof(double));
    }
    scene->poses.count = (count + 1) / 2;
    scene->stride *= 2;
}

se3d_status se3d_scene_record(se3d_scene *scene)
{
    double time = 0.0;
    if (!scene) {
        return SE3D_ERR_NULL;
    }
    const size_t count = scene->poses.count;
    se3d_status status = se3d_system_get_time(scene->model->system, &time);
    if (status < 0 || (count > 0 && !(time > scene->times[count - 1]))) {
        return status;
    }
    if (count > 0 && ++scene->skipped < scene->stride) {
        return SE3D_OK;
    }
    scene->skipped = 0;
    if (count == SAMPLES_MAX) {
        thin_out(scene);
    }
    scene->times[scene->poses.count] = time;
    status = se3di_drawing_get_poses(scene->model, pose_of(scene, scene->poses.count, 0));
    scene->poses.count += status >= 0;
    return status;
}

void se3di_scene_pack(se3d_scene *scene, se3di_coder *coder)
{
    size_t bodies = scene->poses.bodies, count = scene->poses.count;
    se3di_code_size(coder, &bodies);
    se3di_code_size(coder, &count);
    se3di_code_size(coder, &scene->stride);
    se3di_code_size(coder, &scene->skipped);
    if (bodies != scene->poses.bodies || count > SAMPLES_MAX || scene->stride == 0) {
        scene->stride = 1;
        coder->failed = 1;
        return;
    }
    if (coder->in) {
        scene->poses.count = count;
    }
    se3di_code_numbers(coder, scene->times, count);
    se3di_code_numbers(coder, scene->poses.values, count * bodies * SE3DI_POSE);
}

static void put_list(drawing *d, const char *name, const double *values, size_t count)
{
    se3di_glb_put(&d->glb, &d->nodes, ",\"%s\":[", name);
    for (size_t k = 0; k < count; ++k) {
        se3di_glb_put(&d->glb, &d->nodes, k > 0 ? "," : "");
        se3di_glb_put_number(&d->glb, &d->nodes, values[k]);
    }
    se3di_glb_put(&d->glb, &d->nodes, "]");
}

/* Begin a node that draws nothing of its own, left open for its children. @return its number. */
static size_t open_node(drawing *d, const char *name, const double r[3], const double p[4])
{
    const double xyzw[4] = {p[1], p[2], p[3], p[0]};
    se3di_glb_put(&d->glb, &d->nodes, d->node_count > 0 ? ",{\"name\":" : "{\"name\":");
    se3di_glb_put_text(&d->glb, &d->nodes, name);
    put_list(d, "translation", r, 3);
    put_list(d, "rotation", xyzw, 4);
    return d->node_count++;
}

/* A node with a part, without children. @return its number. */
static size_t add_part(drawing *d, const se3di_part *part)
{
    const size_t node = open_node(d, part->name, part->position, part->orientation);
    put_list(d, "scale", part->scale, 3);
    se3di_glb_put(&d->glb, &d->nodes, ",\"mesh\":%zu", se3di_glb_add_mesh(&d->glb, part));
    if (part->element1 > 0) {
        se3di_glb_put(&d->glb, &d->nodes, ",\"extras\":{\"element\":%zu}", part->element1 - 1);
    } else if (part->rise) {
        se3di_glb_put(&d->glb, &d->nodes, ",\"extras\":{\"rise\":%zu}", part->rise->index);
    }
    se3di_glb_put(&d->glb, &d->nodes, "}");
    return node;
}

static void add_child(drawing *d, se3di_iobytes *children, size_t node)
{
    se3di_glb_put(&d->glb, children, children->count > 0 ? ",%zu" : "%zu", node);
}

static void add_channel(drawing *d, size_t node, const char *path, long output)
{
    const char *comma = d->sampler_count > 0 ? "," : "";
    se3di_glb_put(&d->glb, &d->samplers, "%s{\"input\":0,\"output\":%ld}", comma, output);
    se3di_glb_put(&d->glb, &d->channels,
                  "%s{\"sampler\":%zu,\"target\":{\"node\":%zu,\"path\":\"%s\"}}", comma,
                  d->sampler_count++, node, path);
}

static void make_track(drawing *d)
{
    const size_t size = d->scene->poses.count * sizeof *d->track.r;
    d->track.r = se3di_iopool_take(d->glb.pool, 3 * size);
    d->track.q = se3di_iopool_take(d->glb.pool, 4 * size);
    d->track.scale = se3di_iopool_take(d->glb.pool, 3 * size);
    d->glb.failed = d->glb.failed || !d->track.r || !d->track.q || !d->track.scale;
}

/* Quaternions (x, y, z, w) of neighbours are on one side, so that they can be interpolated. */
static void put_sample(const track *t, size_t sample, const double r[3], const double p[4])
{
    double dot = 0.0;
    double *now = t->q + 4 * sample;
    const double xyzw[4] = {p[1], p[2], p[3], p[0]};
    memcpy(t->r + 3 * sample, r, 3 * sizeof *r);
    for (int i = 0; i < 4 && sample > 0; ++i) {
        dot += xyzw[i] * now[i - 4];
    }
    for (int i = 0; i < 4; ++i) {
        now[i] = dot < 0.0 ? -xyzw[i] : xyzw[i];
    }
}

static void add_track(drawing *d, size_t node)
{
    const size_t n = d->scene->poses.count;
    add_channel(d, node, "translation",
                se3di_glb_add_floats(&d->glb, d->track.r, n, SE3DI_GLB_VEC3, 0));
    add_channel(d, node, "rotation", se3di_glb_add_rotations(&d->glb, d->track.q, n));
}

static void animate_body(drawing *d, size_t k, size_t node)
{
    for (size_t s = 0; s < d->scene->poses.count; ++s) {
        const double *pose = pose_of(d->scene, s, k);
        put_sample(&d->track, s, pose, pose + 3);
    }
    add_track(d, node);
}

/* What moves on its body. */
static void animate_part(drawing *d, const se3di_part *part, size_t node)
{
    const size_t count = d->scene->poses.count;
    double *r = d->track.r;
    for (size_t k = 0; k < 3 * count; ++k) {
        r[k] = part->position[k % 3] + part->lift[k / 3] * part->along[k % 3];
    }
    add_channel(d, node, "translation", se3di_glb_add_floats(&d->glb, r, count, SE3DI_GLB_VEC3, 0));
}

/* The children of a body: its parts and markers. */
static void add_children(drawing *d, size_t k, se3di_iobytes *children)
{
    static const double identity[4] = {1.0, 0.0, 0.0, 0.0};
    const se3d_model *model = d->scene->model;
    se3di_parts parts = {NULL, 0, 0};
    if (!se3di_drawing_list(model, k, &d->sizes, &d->scene->poses, d->glb.pool, &parts)) {
        d->glb.failed = 1;
    }
    for (size_t i = 0; i < parts.count; ++i) {
        const size_t node = add_part(d, &parts.list[i]);
        add_child(d, children, node);
        if (parts.list[i].lift) {
            animate_part(d, &parts.list[i], node);
        }
    }
    for (size_t m = 0; m < model->marker_count; ++m) {
        if (model->markers[m].body == k) {
            add_child(d, children,
                      open_node(d, model->markers[m].name, model->markers[m].position, identity));
            se3di_glb_put(&d->glb, &d->nodes, "}");
        }
    }
}

static void put_children(drawing *d, const se3di_iobytes *children)
{
    if (children->count > 0) {
        se3di_glb_put(&d->glb, &d->nodes, ",\"children\":[");
        se3di_glb_put_bytes(&d->glb, &d->nodes, children->data, children->count);
        se3di_glb_put(&d->glb, &d->nodes, "]");
    }
}

static void add_body(drawing *d, size_t k, se3di_iobytes *roots)
{
    const se3d_model *model = d->scene->model;
    const double *pose = pose_of(d->scene, 0, k);
    se3di_iobytes children = {NULL, 0, 0};
    double mass = 0.0;
    int32_t fixed = 0;
    add_children(d, k, &children);
    const size_t node = open_node(d, model->bodies[k].name, pose, pose + 3);
    put_children(d, &children);
    se3di_glb_put(&d->glb, &d->nodes, ",\"extras\":{\"body\":%zu", k);
    if (k > 0 &&
        !SE3D_FAILED(se3d_body_get_mass(model->system, model->bodies[k].body, &mass, NULL))) {
        se3di_glb_put(&d->glb, &d->nodes, ",\"mass\":");
        se3di_glb_put_number(&d->glb, &d->nodes, mass);
    }
    se3di_glb_put(&d->glb, &d->nodes, "}}");
    add_child(d, roots, node);
    se3d_body_get_fixed(model->system, model->bodies[k].body, &fixed);
    if (k > 0 && !fixed && d->scene->poses.count > 1) {
        animate_body(d, k, node);
    }
}

/* What an element has between two bodies: it moves and stretches. */
static void add_between(drawing *d, size_t element, size_t which, se3di_iobytes *roots)
{
    const se3d_scene *scene = d->scene;
    const se3di_part first =
        se3di_drawing_get_between(scene->model, element, which, &d->sizes, pose_of(scene, 0, 0));
    const size_t node = add_part(d, &first);
    add_child(d, roots, node);
    if (scene->poses.count < 2) {
        return;
    }
    for (size_t s = 0; s < scene->poses.count; ++s) {
        const se3di_part now = se3di_drawing_get_between(scene->model, element, which, &d->sizes,
                                                         pose_of(scene, s, 0));
        put_sample(&d->track, s, now.position, now.orientation);
        memcpy(d->track.scale + 3 * s, now.scale, sizeof now.scale);
    }
    add_track(d, node);
    add_channel(
        d, node, "scale",
        se3di_glb_add_floats(&d->glb, d->track.scale, scene->poses.count, SE3DI_GLB_VEC3, 0));
}

static void add_grid(drawing *d, se3di_iobytes *roots)
{
    const double height = d->sizes.floor;
    const double least = d->sizes.extent / 5.0;
    const double ten = io_pow(10.0, floor(io_log10(least)));
    const double step = least <= ten         ? ten
                        : least <= 2.0 * ten ? 2.0 * ten
                        : least <= 5.0 * ten ? 5.0 * ten
                                             : 10.0 * ten; /* 1, 2 or 5 */
    const se3di_part grid = {.name = "grid",
                             .unit = SE3DI_UNIT_GRID,
                             .position = {0.0, 0.0, step * floor(height / step)},
                             .orientation = {1.0, 0.0, 0.0, 0.0},
                             .scale = {step, step, step},
                             .color = {0.55, 0.58, 0.62, 1.0}};
    add_child(d, roots, add_part(d, &grid));
}

/* ',"<element>.<channel>":"<unit>"'. */
static void put_unit(drawing *d, const se3di_element_entry *entry, const char *channel,
                     const char *unit)
{
    char name[500];
    snprintf(name, sizeof name, "%.400s.%s", entry->name, channel);
    se3di_glb_put(&d->glb, &d->rest, ",");
    se3di_glb_put_text(&d->glb, &d->rest, name);
    se3di_glb_put(&d->glb, &d->rest, ":\"%s\"", unit);
}

/* Units of the channels whose names do not tell them: those of angles and displacements. */
static void put_units(drawing *d)
{
    const se3d_model *model = d->scene->model;
    se3di_glb_put(&d->glb, &d->rest, "{\"length\":\"m\",\"time\":\"s\"");
    for (size_t k = 0; k < model->element_count; ++k) {
        const se3di_element_entry *entry = &model->elements[k];
        const se3di_node *type = se3di_node_get(entry->node, "type");
        const char *text = type ? type->text : "";
        bool turns = entry->coordinate == SE3D_JOINT_COORDINATE_ANGLE;
        if (entry->kind == SE3DI_ELEMENT_DRIVER) {
            put_unit(d, entry, "value", turns ? "rad" : "m");
            put_unit(d, entry, "effort", turns ? "N m" : "N");
        } else if (entry->kind == SE3DI_ELEMENT_JOINT) {
            turns = se3di_joint_has(model->system, entry->constraint, SE3D_JOINT_COORDINATE_ANGLE);
        } else if (se3di_keys_contain(" friction stop ", text)) {
            put_unit(d, entry, "coordinate", turns ? "rad" : "m");
            put_unit(d, entry, "force", turns ? "N m" : "N");
        } else if (se3di_keys_contain(" dp2 cd ", text)) {
            put_unit(d, entry, "value", "m");
            put_unit(d, entry, "effort", "N");
        } else if (entry->kind == SE3DI_ELEMENT_FORCE) {
            turns = strcmp(text, "rsda") == 0;
        }
        if (entry->kind == SE3DI_ELEMENT_JOINT || entry->kind == SE3DI_ELEMENT_FORCE) {
            put_unit(d, entry, "rate", turns ? "rad/s" : "m/s");
        }
    }
    se3di_glb_put(&d->glb, &d->rest, "}");
}

/* Name, type and bodies of every element, in the order that nodes refer to. */
static void put_elements(drawing *d)
{
    const se3d_model *model = d->scene->model;
    for (size_t k = 0; k < model->element_count; ++k) {
        const se3di_element_entry *entry = &model->elements[k];
        const se3di_node *type = se3di_node_get(entry->node, "type");
        se3di_glb_put(&d->glb, &d->rest, k > 0 ? ",{\"name\":" : "{\"name\":");
        se3di_glb_put_text(&d->glb, &d->rest, entry->name);
        se3di_glb_put(&d->glb, &d->rest, ",\"type\":");
        se3di_glb_put_text(&d->glb, &d->rest, type && type->text ? type->text : "");
        if (entry->drawn > 0) {
            se3di_glb_put(&d->glb, &d->rest, ",\"bodies\":[%zu,%zu]",
                          se3di_drawing_find_body(model, entry->body_i),
                          se3di_drawing_find_body(model, entry->body_j));
        }
        se3di_glb_put(&d->glb, &d->rest, "}");
    }
}

/* All that comes after the nodes. */
static void put_rest(drawing *d, size_t root)
{
    const se3d_model *model = d->scene->model;
    se3di_glb_put(&d->glb, &d->rest, ",\"scene\":0,\"scenes\":[{\"name\":");
    se3di_glb_put_text(&d->glb, &d->rest, model->title[0] ? model->title : model->name);
    se3di_glb_put(&d->glb, &d->rest, ",\"extras\":{\"units\":");
    put_units(d);
    se3di_glb_put(&d->glb, &d->rest, ",\"elements\":[");
    put_elements(d);
    se3di_glb_put(&d->glb, &d->rest, "]},\"nodes\":[%zu]}],\"nodes\":[", root);
    se3di_glb_put_bytes(&d->glb, &d->rest, d->nodes.data, d->nodes.count);
    se3di_glb_put(&d->glb, &d->rest, "]");
    if (d->sampler_count > 0) {
        se3di_glb_put(&d->glb, &d->rest, ",\"animations\":[{\"name\":\"motion\",\"channels\":[");
        se3di_glb_put_bytes(&d->glb, &d->rest, d->channels.data, d->channels.count);
        se3di_glb_put(&d->glb, &d->rest, "],\"samplers\":[");
        se3di_glb_put_bytes(&d->glb, &d->rest, d->samplers.data, d->samplers.count);
        se3di_glb_put(&d->glb, &d->rest, "]}]");
    }
}

static void draw(drawing *d)
{
    static const double origin[3] = {0.0, 0.0, 0.0};
    static const double upright[4] = {0.70710678118654752, -0.70710678118654752, 0.0, 0.0};
    const se3d_scene *scene = d->scene;
    const se3d_model *model = scene->model;
    se3di_iobytes roots = {NULL, 0, 0};
    make_track(d);
    if (d->glb.failed) {
        return;
    }
    se3di_drawing_measure(model, &scene->poses, &d->sizes);
    if (scene->poses.count > 1) {
        se3di_glb_add_floats(&d->glb, scene->times, scene->poses.count, SE3DI_GLB_SCALAR, 0);
    }
    add_grid(d, &roots);
    for (size_t k = 0; k < model->body_count; ++k) {
        add_body(d, k, &roots);
    }
    for (size_t e = 0; e < model->element_count; ++e) {
        for (size_t w = 0; w < se3di_drawing_count_between(&model->elements[e]); ++w) {
            add_between(d, e, w, &roots);
        }
    }
    const size_t root = open_node(d, "scene", origin, upright);
    put_children(d, &roots);
    se3di_glb_put(&d->glb, &d->nodes, "}");
    put_rest(d, root);
}

bool se3di_scene_put(se3d_scene *scene, FILE *file)
{
    drawing d = {.scene = scene};
    se3di_iopool pool;
    se3di_iopool_init(&pool, &scene->model->pool.allocator);
    se3di_glb_init(&d.glb, &pool);
    draw(&d);
    const bool good = se3di_glb_write(&d.glb, &d.rest, file);
    const int why = errno;
    se3di_iopool_destroy(&pool);
    errno = why;
    return good;
}

bool se3di_scene_put_at(se3d_scene *scene, const se3di_poses *poses, FILE *file)
{
    memcpy(scene->poses.values, poses->values,
           SE3DI_POSE * scene->poses.bodies * sizeof *poses->values);
    scene->poses.count = 1;
    scene->times[0] = poses->times[0];
    return se3di_scene_put(scene, file);
}

static bool write_file(se3d_scene *scene, const char *path)
{
    FILE *file = se3di_partial_open(path);
    if (!file) {
        return false;
    }
    if (se3di_scene_put(scene, file)) {
        return se3di_partial_close(file, path);
    }
    const int why = errno;
    se3di_partial_abandon(file, path);
    errno = why;
    return false;
}

se3d_status se3d_scene_write(se3d_scene *scene, const char *path, se3d_model_error *error)
{
    char text[800];
    if (error) {
        memset(error, 0, sizeof *error);
    }
    if (!scene || !path) {
        return SE3D_ERR_NULL;
    }
    if (scene->poses.count == 0) {
        const se3d_status status = se3d_scene_record(scene);
        if (status < 0) {
            se3di_document_report(error, "", 0, 0, "", se3d_status_get_text(status));
            return status;
        }
    }
    errno = 0;
    if (!write_file(scene, path)) {
        const int why = errno;
        snprintf(text, sizeof text, "%.500s: cannot be written: %s", path,
                 se3di_file_get_text(why));
        se3di_document_report(error, "", 0, 0, "", text);
        return why == ENOMEM ? SE3D_ERR_NO_MEMORY : SE3D_ERR_IO;
    }
    return SE3D_OK;
}
