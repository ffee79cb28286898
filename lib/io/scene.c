/* SPDX-License-Identifier: BSD-3-Clause */
/* The motion of a model as a scene: recorded poses, and the nodes of a glTF file.  docs/scene.md
 *
 * glTF has y upwards: a root node turns our z to it. Every body is a node of its name; shapes,
 * joints (named as they are, at the point of body j) and markers are its children. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/glb.h"
#include "io/model.h"
#include "io/rotation.h"

enum { SAMPLES_MAX = 2048 };

struct se3d_scene {
    se3di_iopool pool;
    se3d_model *model;
    double *times;
    double *poses; /* [sample][body][7]: r, p */
    size_t bodies;
    size_t count;
    size_t stride; /* every so many records are kept */
    size_t skipped;
};

typedef struct drawing {
    se3d_scene *scene;
    se3di_glb glb;
    se3di_bytes nodes;
    se3di_bytes channels;
    se3di_bytes samplers;
    se3di_bytes rest;
    size_t node_count;
    size_t sampler_count;
    double extent; /* half the size of what is seen */
} drawing;

static const double palette[][3] = {{0.20, 0.47, 0.72}, {0.85, 0.37, 0.27}, {0.25, 0.60, 0.42},
                                    {0.90, 0.62, 0.20}, {0.52, 0.38, 0.70}, {0.20, 0.62, 0.68},
                                    {0.60, 0.44, 0.32}};

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
    if (scene) {
        scene->bodies = model->body_count;
        scene->times = se3di_iopool_array(&pool, SAMPLES_MAX, sizeof *scene->times);
        scene->poses =
            se3di_iopool_array(&pool, SAMPLES_MAX * model->body_count, 7 * sizeof *scene->poses);
    }
    if (!scene || !scene->times || !scene->poses) {
        se3di_iopool_destroy(&pool);
        return SE3D_ERR_NO_MEMORY;
    }
    scene->model = model;
    scene->stride = 1;
    scene->pool = pool;
    *out = scene;
    return SE3D_OK;
}

void se3d_scene_destroy(se3d_scene *scene)
{
    if (scene) {
        se3di_iopool pool = scene->pool; /* the scene itself lies in it */
        se3di_iopool_destroy(&pool);
    }
}

static void thin_out(se3d_scene *scene)
{
    const size_t size = 7 * scene->bodies;
    for (size_t k = 1; 2 * k < scene->count; ++k) {
        scene->times[k] = scene->times[2 * k];
        memcpy(scene->poses + k * size, scene->poses + 2 * k * size, size * sizeof(double));
    }
    scene->count = (scene->count + 1) / 2;
    scene->stride *= 2;
}

se3d_status se3d_scene_record(se3d_scene *scene)
{
    double time = 0.0;
    if (!scene) {
        return SE3D_ERR_NULL;
    }
    const se3d_system *system = scene->model->system;
    se3d_status status = se3d_system_get_time(system, &time);
    if (status < 0 || (scene->count > 0 && !(time > scene->times[scene->count - 1]))) {
        return status;
    }
    if (scene->count > 0 && ++scene->skipped < scene->stride) {
        return SE3D_OK;
    }
    scene->skipped = 0;
    if (scene->count == SAMPLES_MAX) {
        thin_out(scene);
    }
    double *pose = scene->poses + scene->count * 7 * scene->bodies;
    for (size_t k = 0; k < scene->bodies && status >= 0; ++k, pose += 7) {
        const se3d_body body = scene->model->bodies[k].body;
        status = se3d_body_get_position(system, body, pose);
        if (status >= 0) {
            status = se3d_body_get_orientation(system, body, pose + 3);
        }
    }
    scene->times[scene->count] = time;
    scene->count += status >= 0;
    return status;
}

static const double *pose_of(const se3d_scene *scene, size_t sample, size_t body)
{
    return scene->poses + (sample * scene->bodies + body) * 7;
}

static void to_ground(const double pose[7], const double local[3], double ground[3])
{
    double A[9];
    se3di_rotation_to_matrix(pose + 3, A);
    for (int i = 0; i < 3; ++i) {
        ground[i] =
            pose[i] + A[3 * i] * local[0] + A[3 * i + 1] * local[1] + A[3 * i + 2] * local[2];
    }
}

static size_t body_index(const se3d_model *model, se3d_body body)
{
    for (size_t k = 0; k < model->body_count; ++k) {
        if (model->bodies[k].body.index1 == body.index1) {
            return k;
        }
    }
    return 0;
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

/* What a node looks like; mesh < 0: nothing of its own. */
typedef struct thing {
    const char *name;
    long mesh;
    double position[3];
    double orientation[4];
    double scale[3];
} thing;

static thing make_thing(const char *name, long mesh, double a, double b, double c)
{
    const thing t = {name, mesh, {0.0, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}, {a, b, c}};
    return t;
}

/* Begin a node, left open for its children. @return its number. */
static size_t open_node(drawing *d, const thing *t)
{
    const double *p = t->orientation;
    const double xyzw[4] = {p[1], p[2], p[3], p[0]};
    se3di_glb_put(&d->glb, &d->nodes, d->node_count > 0 ? ",{\"name\":" : "{\"name\":");
    se3di_glb_put_text(&d->glb, &d->nodes, t->name);
    put_list(d, "translation", t->position, 3);
    put_list(d, "rotation", xyzw, 4);
    put_list(d, "scale", t->scale, 3);
    if (t->mesh >= 0) {
        se3di_glb_put(&d->glb, &d->nodes, ",\"mesh\":%ld", t->mesh);
    }
    return d->node_count++;
}

static void add_leaf(drawing *d, const thing *t, se3di_bytes *children)
{
    se3di_glb_put(&d->glb, children, children->count > 0 ? ",%zu" : "%zu", open_node(d, t));
    se3di_glb_put(&d->glb, &d->nodes, "}");
}

/* A turn from z to `v`. @return |v|. */
static double turn_to(const double v[3], double p[4])
{
    const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    const double axis[3] = {-v[1], v[0], 0.0};
    const double side = sqrt(v[0] * v[0] + v[1] * v[1]);
    const double identity[4] = {v[2] < 0.0 ? 0.0 : 1.0, v[2] < 0.0 ? 1.0 : 0.0, 0.0, 0.0};
    if (side <= 1e-12 * length || !(length > 0.0)) {
        memcpy(p, identity, sizeof identity);
    } else {
        se3di_rotation_from_axis(axis, atan2(side, v[2]), p);
    }
    return length;
}

static void add_bar(drawing *d, const char *name, const double ends[2][3], double radius,
                    const double color[4], se3di_bytes *children)
{
    double v[3];
    thing t = make_thing(name, 0, radius, radius, 1.0);
    for (int i = 0; i < 3; ++i) {
        v[i] = ends[1][i] - ends[0][i];
        t.position[i] = 0.5 * (ends[0][i] + ends[1][i]);
    }
    t.scale[2] = turn_to(v, t.orientation);
    if (t.scale[2] > 1e-9 * d->extent) {
        t.mesh = (long)se3di_glb_add_mesh(&d->glb, SE3DI_GLB_CYLINDER, color);
        add_leaf(d, &t, children);
    }
}

static void add_capsule(drawing *d, const se3d_model_shape *s, const double color[4], thing t,
                        se3di_bytes *children)
{
    double A[9];
    const double center[3] = {t.position[0], t.position[1], t.position[2]};
    t.mesh = (long)se3di_glb_add_mesh(&d->glb, SE3DI_GLB_CYLINDER, color);
    t.scale[2] = s->length;
    add_leaf(d, &t, children);
    t.mesh = (long)se3di_glb_add_mesh(&d->glb, SE3DI_GLB_SPHERE, color);
    t.scale[2] = s->radius;
    se3di_rotation_to_matrix(s->orientation, A);
    for (int side = -1; side <= 1; side += 2) {
        for (int i = 0; i < 3; ++i) {
            t.position[i] = center[i] + 0.5 * side * s->length * A[3 * i + 2];
        }
        add_leaf(d, &t, children);
    }
}

static void add_shape(drawing *d, const se3d_model_shape *s, const double usual[3],
                      se3di_bytes *children)
{
    static const se3di_glb_mesh meshes[] = {SE3DI_GLB_SPHERE, SE3DI_GLB_BOX, SE3DI_GLB_CYLINDER,
                                            SE3DI_GLB_CYLINDER, SE3DI_GLB_BOX};
    const double *c = s->color[0] < 0.0 ? usual : s->color;
    const double color[4] = {c[0], c[1], c[2], s->type == SE3D_SHAPE_PLANE ? 0.4 : 1.0};
    thing t = make_thing("shape", 0, s->radius, s->radius, s->radius);
    memcpy(t.position, s->position, sizeof t.position);
    memcpy(t.orientation, s->orientation, sizeof t.orientation);
    if (s->type == SE3D_SHAPE_MESH) {
        return; /* see docs/scene.md */
    }
    if (s->type == SE3D_SHAPE_CAPSULE) {
        add_capsule(d, s, color, t, children);
        return;
    }
    if (s->type == SE3D_SHAPE_BOX) {
        memcpy(t.scale, s->size, sizeof t.scale);
    } else if (s->type == SE3D_SHAPE_CYLINDER) {
        t.scale[2] = s->length;
    } else if (s->type == SE3D_SHAPE_PLANE) {
        t.scale[0] = t.scale[1] = 4.0 * d->extent;
        t.scale[2] = 0.002 * d->extent;
    }
    t.mesh = (long)se3di_glb_add_mesh(&d->glb, meshes[s->type], color);
    add_leaf(d, &t, children);
}

/* Joints at body `k`: as body j they carry the joint's name and axis; without shapes the body is
 * drawn as bars from its origin to its joints. */
static void add_joints(drawing *d, size_t k, bool bare, const double color[4],
                       se3di_bytes *children)
{
    static const double pin_color[4] = {0.35, 0.37, 0.40, 1.0};
    const se3d_model *model = d->scene->model;
    const double r = 0.02 * d->extent;
    for (size_t e = 0; e < model->element_count; ++e) {
        const se3di_element_entry *entry = &model->elements[e];
        const bool is_j = entry->drawn > 0 && body_index(model, entry->body_j) == k;
        const bool is_i = entry->drawn > 0 && body_index(model, entry->body_i) == k;
        if (!is_i && !is_j) {
            continue;
        }
        const double *point = is_j ? entry->point_j : entry->point_i;
        if (bare) {
            const double ends[2][3] = {{0.0, 0.0, 0.0}, {point[0], point[1], point[2]}};
            add_bar(d, "link", ends, 0.8 * r, color, children);
        }
        if (is_j && entry->drawn < 3) {
            const bool axis = entry->drawn == 2;
            thing t = make_thing(entry->name, 0, r, r, axis ? 6.0 * r : r);
            t.mesh = (long)se3di_glb_add_mesh(&d->glb, axis ? SE3DI_GLB_CYLINDER : SE3DI_GLB_SPHERE,
                                              pin_color);
            memcpy(t.position, point, sizeof t.position);
            if (axis) {
                turn_to(entry->axis_j, t.orientation);
            }
            add_leaf(d, &t, children);
        }
    }
}

static void add_channel(drawing *d, size_t node, const char *path, long output)
{
    const char *comma = d->sampler_count > 0 ? "," : "";
    se3di_glb_put(&d->glb, &d->samplers, "%s{\"input\":0,\"output\":%ld}", comma, output);
    se3di_glb_put(&d->glb, &d->channels,
                  "%s{\"sampler\":%zu,\"target\":{\"node\":%zu,\"path\":\"%s\"}}", comma,
                  d->sampler_count++, node, path);
}

/* Quaternions (x, y, z, w) of neighbours on one side, so that they can be interpolated. */
static void put_turn(double *out, size_t sample, const double p[4])
{
    double dot = 0.0;
    double *now = out + 4 * sample;
    const double xyzw[4] = {p[1], p[2], p[3], p[0]};
    for (int i = 0; i < 4 && sample > 0; ++i) {
        dot += xyzw[i] * now[i - 4];
    }
    for (int i = 0; i < 4; ++i) {
        now[i] = dot < 0.0 ? -xyzw[i] : xyzw[i];
    }
}

static void animate_body(drawing *d, size_t k, size_t node)
{
    const se3d_scene *scene = d->scene;
    double *r = se3di_iopool_array(d->glb.pool, scene->count, 3 * sizeof *r);
    double *q = se3di_iopool_array(d->glb.pool, scene->count, 4 * sizeof *q);
    if (!r || !q) {
        d->glb.failed = true;
        return;
    }
    for (size_t s = 0; s < scene->count; ++s) {
        memcpy(r + 3 * s, pose_of(scene, s, k), 3 * sizeof *r);
        put_turn(q, s, pose_of(scene, s, k) + 3);
    }
    add_channel(d, node, "translation",
                se3di_glb_add_floats(&d->glb, r, scene->count, SE3DI_GLB_VEC3, 0));
    add_channel(d, node, "rotation", se3di_glb_add_rotations(&d->glb, q, scene->count));
}

static void add_body(drawing *d, size_t k, se3di_bytes *roots)
{
    const se3d_model *model = d->scene->model;
    const double *pose = pose_of(d->scene, 0, k);
    const double *usual = palette[(k + 6) % 7];
    const double color[4] = {usual[0], usual[1], usual[2], 1.0};
    se3di_bytes children = {NULL, 0, 0};
    bool bare = k > 0;
    int32_t fixed = 0;
    for (size_t s = 0; s < model->shape_count; ++s) {
        if (body_index(model, model->shapes[s].body) == k) {
            add_shape(d, &model->shapes[s], usual, &children);
            bare = bare && model->shapes[s].type == SE3D_SHAPE_MESH;
        }
    }
    add_joints(d, k, bare, color, &children);
    if (bare) {
        const double r = 0.04 * d->extent;
        thing t = make_thing("center", 0, r, r, r);
        t.mesh = (long)se3di_glb_add_mesh(&d->glb, SE3DI_GLB_SPHERE, color);
        add_leaf(d, &t, &children);
    }
    for (size_t m = 0; m < model->marker_count; ++m) {
        if (model->markers[m].body == k) {
            thing t = make_thing(model->markers[m].name, -1, 1.0, 1.0, 1.0);
            memcpy(t.position, model->markers[m].position, sizeof t.position);
            add_leaf(d, &t, &children);
        }
    }
    thing t = make_thing(model->bodies[k].name, -1, 1.0, 1.0, 1.0);
    memcpy(t.position, pose, 3 * sizeof *pose);
    memcpy(t.orientation, pose + 3, 4 * sizeof *pose);
    const size_t node = open_node(d, &t);
    if (children.count > 0) {
        se3di_glb_put(&d->glb, &d->nodes, ",\"children\":[");
        se3di_glb_put_bytes(&d->glb, &d->nodes, children.data, children.count);
        se3di_glb_put(&d->glb, &d->nodes, "]");
    }
    se3di_glb_put(&d->glb, &d->nodes, ",\"extras\":{\"body\":%zu}}", k);
    se3di_glb_put(&d->glb, roots, ",%zu", node);
    se3d_body_get_fixed(model->system, model->bodies[k].body, &fixed);
    if (k > 0 && !fixed && d->scene->count > 1) {
        animate_body(d, k, node);
    }
}

static void add_spring(drawing *d, const se3di_element_entry *entry, se3di_bytes *roots)
{
    static const double color[4] = {0.75, 0.55, 0.10, 1.0};
    const se3d_scene *scene = d->scene;
    const size_t i = body_index(scene->model, entry->body_i);
    const size_t j = body_index(scene->model, entry->body_j);
    double *r = se3di_iopool_array(d->glb.pool, scene->count, 3 * sizeof *r);
    double *q = se3di_iopool_array(d->glb.pool, scene->count, 4 * sizeof *q);
    double *scale = se3di_iopool_array(d->glb.pool, scene->count, 3 * sizeof *scale);
    thing first = make_thing(entry->name, 0, 1.0, 1.0, 1.0);
    if (!r || !q || !scale) {
        d->glb.failed = true;
        return;
    }
    for (size_t s = 0; s < scene->count; ++s) {
        double a[3];
        double b[3];
        double p[4];
        to_ground(pose_of(scene, s, i), entry->point_i, a);
        to_ground(pose_of(scene, s, j), entry->point_j, b);
        for (int c = 0; c < 3; ++c) {
            r[3 * s + (size_t)c] = 0.5 * (a[c] + b[c]);
            b[c] -= a[c];
        }
        const double length = turn_to(b, p);
        put_turn(q, s, p);
        scale[3 * s] = scale[3 * s + 1] = 0.05 * d->extent;
        scale[3 * s + 2] = length;
        if (s == 0) {
            memcpy(first.orientation, p, sizeof p);
            memcpy(first.position, r, sizeof first.position);
            memcpy(first.scale, scale, sizeof first.scale);
        }
    }
    first.mesh = (long)se3di_glb_add_mesh(&d->glb, SE3DI_GLB_SPRING, color);
    const size_t node = open_node(d, &first);
    se3di_glb_put(&d->glb, &d->nodes, "}");
    se3di_glb_put(&d->glb, roots, ",%zu", node);
    if (scene->count > 1) {
        const size_t n = scene->count;
        add_channel(d, node, "translation", se3di_glb_add_floats(&d->glb, r, n, SE3DI_GLB_VEC3, 0));
        add_channel(d, node, "rotation", se3di_glb_add_rotations(&d->glb, q, n));
        add_channel(d, node, "scale", se3di_glb_add_floats(&d->glb, scale, n, SE3DI_GLB_VEC3, 0));
    }
}

/* Half the diagonal of the box around all points, and how low it reaches. */
static double measure(const se3d_scene *scene, double *floor_height)
{
    double low[3] = {0.0, 0.0, 0.0};
    double high[3] = {0.0, 0.0, 0.0};
    const se3d_model *model = scene->model;
    for (size_t s = 0; s < scene->count; s += 1 + scene->count / 64) {
        for (size_t e = 0; e < model->element_count + scene->bodies; ++e) {
            double at[3];
            if (e < model->element_count) {
                const se3di_element_entry *entry = &model->elements[e];
                if (entry->drawn == 0) {
                    continue;
                }
                to_ground(pose_of(scene, s, body_index(model, entry->body_j)), entry->point_j, at);
            } else {
                memcpy(at, pose_of(scene, s, e - model->element_count), sizeof at);
            }
            for (int i = 0; i < 3; ++i) {
                low[i] = fmin(low[i], at[i]);
                high[i] = fmax(high[i], at[i]);
            }
        }
    }
    double sum = 0.0;
    for (int i = 0; i < 3; ++i) {
        sum += (high[i] - low[i]) * (high[i] - low[i]);
    }
    const double extent = 0.5 * sqrt(sum);
    *floor_height = low[2] - 0.3 * extent;
    return extent > 1e-9 ? extent : 1.0;
}

static void add_grid(drawing *d, double height, se3di_bytes *roots)
{
    static const double color[4] = {0.55, 0.58, 0.62, 1.0};
    const double least = d->extent / 5.0;
    const double ten = pow(10.0, floor(log10(least)));
    const double step = least <= ten         ? ten
                        : least <= 2.0 * ten ? 2.0 * ten
                        : least <= 5.0 * ten ? 5.0 * ten
                                             : 10.0 * ten; /* 1, 2 or 5 */
    thing t = make_thing("grid", 0, step, step, step);
    t.position[2] = step * floor(height / step);
    t.mesh = (long)se3di_glb_add_mesh(&d->glb, SE3DI_GLB_GRID, color);
    const size_t node = open_node(d, &t);
    se3di_glb_put(&d->glb, &d->nodes, "}");
    se3di_glb_put(&d->glb, roots, "%zu", node);
}

static void draw(drawing *d)
{
    double height = 0.0;
    se3d_scene *scene = d->scene;
    se3di_bytes roots = {NULL, 0, 0};
    d->extent = measure(scene, &height);
    if (scene->count > 1) {
        se3di_glb_add_floats(&d->glb, scene->times, scene->count, SE3DI_GLB_SCALAR, 0);
    }
    add_grid(d, height, &roots);
    for (size_t k = 0; k < scene->bodies; ++k) {
        add_body(d, k, &roots);
    }
    for (size_t e = 0; e < scene->model->element_count; ++e) {
        if (scene->model->elements[e].drawn == 3) {
            add_spring(d, &scene->model->elements[e], &roots);
        }
    }
    thing root = make_thing("scene", -1, 1.0, 1.0, 1.0);
    root.orientation[0] = 0.70710678118654752;
    root.orientation[1] = -0.70710678118654752;
    const size_t node = open_node(d, &root);
    se3di_glb_put(&d->glb, &d->nodes, ",\"children\":[");
    se3di_glb_put_bytes(&d->glb, &d->nodes, roots.data, roots.count);
    se3di_glb_put(&d->glb, &d->nodes, "]}");
    const char *title = scene->model->title;
    se3di_glb_put(&d->glb, &d->rest, ",\"scene\":0,\"scenes\":[{\"name\":");
    se3di_glb_put_text(&d->glb, &d->rest, title[0] ? title : scene->model->name);
    se3di_glb_put(&d->glb, &d->rest,
                  ",\"extras\":{\"units\":{\"length\":\"m\",\"time\":\"s\"}},\"nodes\":[%zu]}],"
                  "\"nodes\":[",
                  node);
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

se3d_status se3d_scene_write(se3d_scene *scene, const char *path, se3d_model_error *error)
{
    char text[800];
    drawing d = {.scene = scene};
    se3di_iopool pool;
    if (error) {
        memset(error, 0, sizeof *error);
    }
    if (!scene || !path) {
        return SE3D_ERR_NULL;
    }
    if (scene->count == 0) {
        const se3d_status status = se3d_scene_record(scene);
        if (status < 0) {
            return status;
        }
    }
    se3di_iopool_init(&pool, &scene->model->pool.allocator);
    se3di_glb_init(&d.glb, &pool);
    draw(&d);
    errno = 0;
    const bool good = se3di_glb_write(&d.glb, &d.rest, path);
    const int why = errno;
    se3di_iopool_destroy(&pool);
    if (!good) {
        snprintf(text, sizeof text, "%.500s: cannot be written: %s", path, strerror(why));
        se3di_document_report(error, "", 0, 0, "", text);
        return why == ENOMEM ? SE3D_ERR_NO_MEMORY : SE3D_ERR_IO;
    }
    return SE3D_OK;
}
