/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/read/forces_tyre.h"

#include <math.h>
#include <string.h>

#include "io/document/document.h"
#include "io/document/fields.h"
#include "io/document/guess.h"
#include "io/document/keys.h"
#include "io/read/bodies.h"
#include "io/read/objects.h"
#include "io/read/tir.h"

const char *const se3di_tyre_laws[] = {"brush", "fiala", "mf52", "mf61", NULL};
const char *const se3di_tyre_sides[] = {"left", "right", NULL};

static bool fail_unknown_road(se3di_reader *reader, const se3di_node *node, const char *name)
{
    const se3d_model *model = reader->model;
    se3di_guess guess = se3di_guess_begin(name);
    for (size_t k = 0; k < model->element_count; ++k) {
        if (model->elements[k].kind == SE3DI_ELEMENT_ROAD) {
            se3di_guess_offer(&guess, model->elements[k].name);
        }
    }
    for (size_t k = 0; k < model->body_count; ++k) {
        se3di_guess_offer(&guess, model->bodies[k].name);
    }
    const char *meant = se3di_guess_get(&guess);
    se3di_reader_fail(reader, node, "no road and no body is named `%.60s`%s%s%s", name,
                      meant ? ", did you mean `" : "", meant ? meant : "", meant ? "`?" : "");
    return se3di_reader_propose(reader, meant);
}

/* A road of `roads` (*body is NULL) or the body of a plane; the ground if nothing is said. */
static bool find_road(se3di_reader *reader, const se3di_node *node, const se3di_body_entry **body,
                      se3d_tyre_def *def)
{
    const se3d_model *model = reader->model;
    const se3di_node *road = se3di_node_get(node, "road");
    const char *name = "ground";
    size_t index = 0;
    *body = NULL;
    if (road && !se3di_read_reference(reader, road, &name)) {
        return false;
    }
    if (road && se3di_reader_find(reader, &model->element_names, name, &index) &&
        model->elements[index].kind == SE3DI_ELEMENT_ROAD) {
        def->surface = model->elements[index].road;
        return true;
    }
    index = 0;
    if (strcmp(name, "ground") != 0 &&
        !se3di_reader_find(reader, &model->body_names, name, &index)) {
        return fail_unknown_road(reader, road, name);
    }
    *body = &model->bodies[index];
    def->road = (*body)->body;
    return true;
}

static bool read_road(se3di_reader *reader, const se3di_node *node, bool is_local,
                      se3d_tyre_def *def)
{
    static const char *const of_planes[] = {"road_point", "normal"};
    static const char *const of_roads[] = {"envelope", "envelope_width"};
    double point[3] = {0.0, 0.0, 0.0}, normal[3] = {0.0, 0.0, 1.0};
    const se3di_body_entry *road = NULL; /* NULL: a road of `roads` */
    if (!find_road(reader, node, &road, def)) {
        return false;
    }
    for (size_t k = 0; k < 2; ++k) {
        const char *key = road ? of_roads[k] : of_planes[k];
        if (se3di_node_get(node, key)) {
            return se3di_reader_fail_key(reader, node, key,
                                         road ? "needs a road of `roads` under `road`"
                                              : "is of a plane, must not stand beside a road of "
                                                "`roads`, which has its own");
        }
    }
    if (!road) {
        return true;
    }
    if (is_local) {
        return se3di_read_key_point(reader, node, "road_point", road, def->point) &&
               se3di_read_key_body_direction(reader, node, "normal", road, false, def->normal);
    }
    return se3di_read_key_ground_point(reader, node, "road_point", point) &&
           se3di_read_key_ground_direction(reader, node, "normal", false, normal) &&
           se3di_ground_to_body(reader, def->road, point, def->point) &&
           se3di_ground_to_body_direction(reader, def->road, normal, def->normal);
}

/* What a tyre cannot do without, which its file may have. */
static bool check_given(se3di_reader *reader, const se3di_node *node, const se3d_tyre_def *def)
{
    const bool is_magic = def->law == SE3D_TYRE_MF52 || def->law == SE3D_TYRE_MF61;
    const struct {
        const char *key, *what;
        double value;
        bool of_all;
    } needed[] = {
        {"radius", "the radius without load [m] > 0", def->radius, true},
        {"k", "the vertical stiffness [N/m] > 0", def->k, true},
        {"mu", "the coefficient of friction > 0", def->mu, false},
        {"slip_stiffness", "dFx / d(slip ratio) [N] > 0", def->slip_stiffness, false},
        {"cornering_stiffness", "-dFy / d(slip angle) [N] > 0", def->cornering_stiffness, false}};
    if (is_magic && !def->coefficients) {
        return se3di_reader_fail_key(reader, node, "file",
                                     "is missing, a Magic Formula needs a file of coefficients");
    }
    if (!is_magic && def->coefficients) {
        return se3di_reader_fail_key(reader, node, "model",
                                     "has no file, only mf52 and mf61 have one");
    }
    for (size_t k = 0; k < sizeof needed / sizeof *needed; ++k) {
        if ((needed[k].of_all || !is_magic) && !(fabs(needed[k].value) > 0.0)) {
            return se3di_reader_fail_key(reader, node, needed[k].key, "is missing, a tyre needs %s",
                                         needed[k].what);
        }
    }
    return true;
}

static bool read_file(se3di_reader *reader, const se3di_node *node, double *coefficients,
                      se3d_tyre_def *def)
{
    const se3di_node *file = se3di_node_get(node, "file");
    const char *name = NULL;
    return !file || (se3di_read_text(reader, file, &name) &&
                     se3di_read_tir(reader, node, name, coefficients, def));
}

static bool read_axis(se3di_reader *reader, const se3di_node *node, bool is_local,
                      const se3di_body_entry *body, se3d_tyre_def *def)
{
    double axis[3] = {0.0, 1.0, 0.0};
    if (is_local) {
        return se3di_read_key_body_direction(reader, node, "axis", body, false, def->axis);
    }
    return se3di_read_key_ground_direction(reader, node, "axis", false, axis) &&
           se3di_ground_to_body_direction(reader, body->body, axis, def->axis);
}

bool se3di_read_tyre(se3di_reader *reader, const se3di_node *node, se3di_element_entry *entry)
{
    const se3di_body_entry *body = NULL;
    se3d_tyre_def def = se3d_tyre_def_default();
    int32_t is_local = 0;
    double coefficients[SE3D_TYRE_COEFFICIENTS];
    if (!se3di_read_key_body(reader, node, "body", &body) ||
        !read_file(reader, node, coefficients, &def) ||
        !se3di_read_key_place(reader, node, "point", "at", body, def.center) ||
        !se3di_read_key(reader, node, &se3di_object_force, "tyre", "frame", &is_local) ||
        !read_axis(reader, node, is_local != 0, body, &def) ||
        !read_road(reader, node, is_local != 0, &def) ||
        !se3di_read_fields(reader, node, &se3di_object_force, "tyre", "se3d_tyre_def", &def) ||
        !check_given(reader, node, &def)) {
        return false;
    }
    if (se3di_placement_is_reflected(&reader->part->place)) { /* the left side is on the right */
        def.side = def.side == SE3D_TYRE_LEFT ? SE3D_TYRE_RIGHT : SE3D_TYRE_LEFT;
    }
    def.name = entry->name;
    def.wheel = body->body;
    entry->body = def.wheel;
    memcpy(entry->point, def.center, sizeof entry->point);
    entry->road = def.surface;
    entry->body_i = def.road;
    memcpy(entry->point_i, def.point, sizeof entry->point_i);
    memcpy(entry->axis_i, def.normal, sizeof entry->axis_i);
    return se3di_reader_check(reader, node,
                              se3d_force_create_tyre(reader->system, &def, &entry->force));
}
