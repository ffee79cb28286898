/* SPDX-License-Identifier: BSD-3-Clause */
/* MJCF: geoms, which are drawn, and weigh if their body has no mass of its own. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/base/elementary.h"
#include "io/import/inertia.h"
#include "io/import/material.h"
#include "io/import/mesh.h"
#include "io/import/mjcf.h"

#define PI 3.14159265358979323846

typedef struct geom {
    const char *type;
    double size[3]; /* as in the file: radius, half lengths */
    se3di_frame frame;
} geom;

/* The ends of the axis in place of pos and an orientation. */
static bool read_ends(se3di_mjcf *f, const se3di_mjcf_element *e, geom *g)
{
    double ends[6];
    double d[3];
    int count;
    if (!se3di_mjcf_numbers(f, e, "fromto", ends, 6, &count) || count == 0) {
        return count == 0 && f->links.m->status >= 0;
    }
    for (int k = 0; k < 3; ++k) {
        g->frame.r[k] = 0.5 * (ends[k] + ends[k + 3]);
        d[k] = ends[k + 3] - ends[k];
    }
    const bool flat = strcmp(g->type, "box") == 0 || strcmp(g->type, "ellipsoid") == 0;
    if (count != 6 || !se3di_turn_along(d, g->frame.A)) {
        return se3di_machine_fail(f->links.m, e->node->line, e->node->column,
                                  "fromto: must be two points that differ");
    }
    g->size[2] = flat ? 0.5 * se3di_length(d) : g->size[2];
    g->size[1] = flat ? g->size[0] : 0.5 * se3di_length(d);
    return true;
}

/* The shape with the same volume; its type is NULL if ours has no such shape. */
static se3di_machine_shape solid_of(const geom *g)
{
    se3di_machine_shape shape = {.scale = 1.0, .color = {-1.0, 0.0, 0.0}, .frame = g->frame};
    const double *s = g->size;
    if (strcmp(g->type, "box") == 0) {
        shape.type = "box";
        for (int k = 0; k < 3; ++k) {
            shape.size[k] = 2.0 * s[k];
        }
    } else if (strcmp(g->type, "ellipsoid") == 0) {
        shape.type = "ellipsoid";
        memcpy(shape.size, s, sizeof shape.size);
    } else if (strcmp(g->type, "sphere") == 0) {
        shape.type = "sphere";
        shape.radius = s[0];
    } else if (strcmp(g->type, "capsule") == 0 || strcmp(g->type, "cylinder") == 0) {
        shape.type = g->type;
        shape.radius = s[0];
        shape.length = 2.0 * s[1];
    } else if (strcmp(g->type, "plane") == 0) {
        shape.type = "plane";
    }
    return shape;
}

static bool weigh(se3di_mjcf *f, size_t link, const se3di_mjcf_element *e, const geom *g,
                  const se3di_machine_shape *shape)
{
    double density = 1000.0;
    double given = -1.0;
    if (!se3di_mjcf_number(f, e, "density", &density) || !se3di_mjcf_number(f, e, "mass", &given)) {
        return false;
    }
    if (se3di_mjcf_is(f, e, "shellinertia", "true")) {
        se3di_machine_note_of(f->links.m, SE3D_IMPORT_LOST, e->node->line,
                              "shellinertia: the geom weighs as a solid");
    }
    density = given >= 0.0 ? 1.0 : density;
    if (!shape->type && density > 0.0 && (given > 0.0 || given < 0.0)) {
        se3di_machine_note_of(f->links.m, SE3D_IMPORT_LOST, e->node->line,
                              "the mass of a geom of type %.40s: give the body <inertial>",
                              g->type);
    }
    if (!shape->type || strcmp(shape->type, "plane") == 0) {
        return true;
    }
    se3di_mass mass = se3di_solid_mass(shape, density);
    if (given >= 0.0 && mass.mass > 0.0) {
        for (int k = 0; k < 9; ++k) {
            mass.J[k] *= given / mass.mass;
        }
        mass.mass = given;
    }
    if (mass.mass > 0.0) {
        se3di_mass *whole = &f->links.list[link].mass;
        mass = se3di_mass_of(&g->frame, &mass);
        *whole = whole->mass > 0.0 ? se3di_mass_sum(whole, &mass) : mass;
    }
    return true;
}

/* The mesh of an asset: by its name, or by its file without the ending. */
static const se3di_xml *find_mesh(const se3di_mjcf *f, const char *wanted)
{
    for (const se3di_xml *asset = se3di_xml_child(f->root, "asset"); asset;
         asset = se3di_xml_again(asset)) {
        for (const se3di_xml *at = se3di_xml_child(asset, "mesh"); at; at = se3di_xml_again(at)) {
            const char *name = se3di_xml_get(at, "name");
            const char *file = se3di_xml_get(at, "file");
            const char *base = file && strrchr(file, '/') ? strrchr(file, '/') + 1 : file;
            const char *dot = base ? strrchr(base, '.') : NULL;
            const size_t length = dot ? (size_t)(dot - base) : 0;
            if (name ? strcmp(name, wanted) == 0
                     : length == strlen(wanted) && strncmp(base, wanted, length) == 0) {
                return at;
            }
        }
    }
    return NULL;
}

static bool take_mesh(se3di_mjcf *f, const se3di_mjcf_element *e, se3di_machine_shape *shape)
{
    const char *name = se3di_mjcf_get(f, e, "mesh");
    const se3di_xml *mesh = name ? find_mesh(f, name) : NULL;
    const char *file = mesh ? se3di_xml_get(mesh, "file") : NULL;
    double scale[3] = {1.0, 1.0, 1.0};
    int count;
    if (!file) {
        se3di_machine_note_of(f->links.m, SE3D_IMPORT_NOTE, e->node->line,
                              "the mesh `%.80s` has no file: it is not drawn", name ? name : "");
        return f->links.m->status >= 0;
    }
    const se3di_mjcf_element of = {.node = mesh};
    if (!se3di_mjcf_numbers(f, &of, "scale", scale, 3, &count)) {
        return false;
    }
    se3di_mesh_take(f->links.m, mesh->line, f->mesh_folder, file, scale, shape);
    return f->links.m->status >= 0;
}

static bool read_geom(se3di_mjcf *f, const se3di_mjcf_element *e, geom *g)
{
    const char *type = se3di_mjcf_get(f, e, "type");
    int count;
    g->type = type ? type : se3di_mjcf_get(f, e, "mesh") ? "mesh" : "sphere";
    return se3di_mjcf_numbers(f, e, "size", g->size, 3, &count) &&
           se3di_mjcf_frame(f, e, &g->frame) && read_ends(f, e, g);
}

/* Bits of a whole number, 1 without it. */
static bool read_bits(se3di_mjcf *f, const se3di_mjcf_element *e, const char *name, uint32_t *bits)
{
    double value = 1.0;
    if (!se3di_mjcf_number(f, e, name, &value)) {
        return false;
    }
    if (!(fabs(value) < 4294967296.0) || value != floor(value)) {
        return se3di_machine_fail(f->links.m, e->node->line, e->node->column,
                                  "%s must be a whole number of 32 bits", name);
    }
    *bits = (uint32_t)(int64_t)value;
    return true;
}

/* The bit of what a geom may touch in `group` of its shape. */
static bool take_touch(se3di_mjcf *f, const se3di_mjcf_element *e, se3di_machine_shape *shape)
{
    se3di_mjcf_touch touch = {1, 1};
    size_t k = 0;
    if (!read_bits(f, e, "contype", &touch.type) ||
        !read_bits(f, e, "conaffinity", &touch.affinity)) {
        return false;
    }
    if (f->disabled.contact) {
        touch = (se3di_mjcf_touch){0, 0};
    }
    f->touching += touch.type != 0 || touch.affinity != 0 ? 1 : 0;
    while (k < f->kind_count &&
           (f->kinds[k].type != touch.type || f->kinds[k].affinity != touch.affinity)) {
        ++k;
    }
    if (k == SE3DI_MJCF_KINDS_MAX) {
        f->has_more_kinds = true;
        return true;
    }
    f->kinds[k] = touch;
    f->kind_count = k == f->kind_count ? k + 1 : f->kind_count;
    shape->group = 1u << k;
    return true;
}

/* Bits of the kinds that kind `k` touches. */
static uint32_t mask_of(const se3di_mjcf *f, size_t k)
{
    uint32_t mask = 0;
    for (size_t j = 0; j < f->kind_count; ++j) {
        const bool touches = (f->kinds[k].type & f->kinds[j].affinity) != 0 ||
                             (f->kinds[j].type & f->kinds[k].affinity) != 0;
        mask |= touches ? 1u << j : 0u;
    }
    return mask;
}

void se3di_mjcf_sort_shapes(se3di_mjcf *f)
{
    const bool is_plain = f->has_more_kinds || (f->kind_count == 1 && mask_of(f, 0) != 0);
    for (size_t link = 0; link < f->links.count; ++link) {
        for (se3di_machine_shape *at = f->links.list[link].parts.shapes; at; at = at->next) {
            size_t k = 0;
            while (at->group > 1u << k) {
                ++k;
            }
            at->mask = at->group > 0 ? mask_of(f, k) : 0;
            at->passes = at->group > 0 && at->mask == 0;
            at->group = is_plain || at->passes ? 0 : at->group;
        }
    }
    if (f->has_more_kinds) {
        se3di_machine_note_of(
            f->links.m, SE3D_IMPORT_LOST, 0,
            "contype and conaffinity: geoms have more than %d different ones, all "
            "of them may touch",
            SE3DI_MJCF_KINDS_MAX);
    }
}

/* A damping ratio z of a spring and damper makes a restitution, one below 1 of
 * exp(-pi z / sqrt(1 - z^2)). `solref`: time constant and z, or what is negative. */
static double restitution_of(const double solref[2])
{
    const double z = solref[1];
    if (!(z >= 0.0 && z < 1.0 && solref[0] > 0.0)) {
        return 0.01;
    }
    return io_exp(-3.14159265358979323846 * z / sqrt(1.0 - z * z));
}

/* What it touches with. MuJoCo's stiffness goes with the masses and is none of a material. */
static bool take_material(se3di_mjcf *f, const se3di_mjcf_element *e, se3di_machine_shape *shape)
{
    se3di_machine_material material = {.friction = 1.0, .poisson = 0.3};
    double friction[3] = {1.0, 0.005, 0.0001};
    double solref[2] = {0.02, 1.0};
    char name[40];
    int count;
    if (f->disabled.contact ||
        (se3di_mjcf_is(f, e, "contype", "0") && se3di_mjcf_is(f, e, "conaffinity", "0"))) {
        return true;
    }
    if (!se3di_mjcf_numbers(f, e, "friction", friction, 3, &count) ||
        !se3di_mjcf_numbers(f, e, "solref", solref, 2, &count)) {
        return false;
    }
    material.friction = friction[0];
    material.restitution = restitution_of(solref);
    snprintf(name, sizeof name, "friction_%.4g", material.friction);
    for (char *at = name; *at; ++at) {
        *at = *at == '.' ? '_' : *at;
    }
    material.name = name;
    shape->material = se3di_machine_material_name(f->links.m, &material, e->node->line);
    return shape->material != NULL;
}

static void color(se3di_mjcf *f, const se3di_mjcf_element *e, se3di_machine_shape *shape)
{
    double rgba[4];
    int count;
    if (se3di_mjcf_numbers(f, e, "rgba", rgba, 4, &count) && count >= 3) {
        for (int k = 0; k < 3; ++k) {
            shape->color[k] = rgba[k] < 0.0 ? 0.0 : rgba[k] > 1.0 ? 1.0 : rgba[k];
        }
    }
}

static bool has_size(const se3di_machine_shape *shape)
{
    if (strcmp(shape->type, "box") == 0 || strcmp(shape->type, "ellipsoid") == 0) {
        return shape->size[0] > 0.0 && shape->size[1] > 0.0 && shape->size[2] > 0.0;
    }
    if (strcmp(shape->type, "capsule") == 0 || strcmp(shape->type, "cylinder") == 0) {
        return shape->radius > 0.0 && shape->length > 0.0;
    }
    return strcmp(shape->type, "plane") == 0 || shape->file || shape->radius > 0.0;
}

bool se3di_mjcf_geom(se3di_mjcf *f, size_t link, const se3di_mjcf_element *e,
                     const se3di_frame *around, bool weighs)
{
    geom g = {.size = {0.0, 0.0, 0.0}};
    if (!read_geom(f, e, &g)) {
        return false;
    }
    g.frame = se3di_frame_of(around, &g.frame);
    se3di_machine_shape shape = solid_of(&g);
    if (weighs && !weigh(f, link, e, &g, &shape)) {
        return false;
    }
    if (!take_touch(f, e, &shape) || !take_material(f, e, &shape)) {
        return false;
    }
    if (strcmp(g.type, "mesh") == 0 && !take_mesh(f, e, &shape)) {
        return false;
    }
    if (shape.type && !has_size(&shape) && !se3di_mjcf_get(f, e, "mesh")) {
        return se3di_machine_fail(f->links.m, e->node->line, e->node->column,
                                  "size: of a %s, must be numbers > 0", g.type);
    }
    if (!shape.type || !has_size(&shape)) {
        return true; /* nothing that can be drawn */
    }
    color(f, e, &shape);
    se3di_machine_shape *to = se3di_parts_add_shape(f->links.m, &f->links.list[link].parts);
    if (to) {
        *to = shape; /* the last of its list: it has no next */
    }
    return to != NULL;
}
