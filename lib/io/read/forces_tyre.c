/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/read/forces_tyre.h"

#include <math.h>
#include <string.h>

#include "io/document/document.h"
#include "io/document/fields.h"
#include "io/document/keys.h"
#include "io/read/bodies.h"
#include "io/read/objects.h"
#include "io/read/tir.h"

const char *const se3di_tyre_laws[] = {"brush", "fiala", "mf52", "mf61", NULL};
const char *const se3di_tyre_sides[] = {"left", "right", NULL};

/* In a part that is mirrored the left side is on the right. */
static bool is_mirrored(const double M[9])
{
    return M[0] * (M[4] * M[8] - M[5] * M[7]) - M[1] * (M[3] * M[8] - M[5] * M[6]) +
               M[2] * (M[3] * M[7] - M[4] * M[6]) <
           0.0;
}

static bool read_road(se3di_reader *reader, const se3di_node *node, se3d_tyre_def *def)
{
    double point[3] = {0.0, 0.0, 0.0}, normal[3] = {0.0, 0.0, 1.0};
    const se3di_body_entry *road = NULL;
    if (se3di_node_get(node, "road")) {
        if (!se3di_read_key_body(reader, node, "road", &road)) {
            return false;
        }
        def->road = road->body;
    } else if (SE3D_FAILED(se3d_system_get_ground(reader->system, &def->road))) {
        return se3di_reader_fail_memory(reader);
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

bool se3di_read_tyre(se3di_reader *reader, const se3di_node *node, se3di_element_entry *entry)
{
    const se3di_body_entry *body = NULL;
    se3d_tyre_def def = se3d_tyre_def_default();
    double axis[3] = {0.0, 1.0, 0.0};
    double coefficients[SE3D_TYRE_COEFFICIENTS];
    if (!se3di_read_key_body(reader, node, "body", &body) ||
        !read_file(reader, node, coefficients, &def) ||
        !se3di_read_key_place(reader, node, "point", "at", body, def.center) ||
        !se3di_read_key_ground_direction(reader, node, "axis", false, axis) ||
        !se3di_ground_to_body_direction(reader, body->body, axis, def.axis) ||
        !read_road(reader, node, &def) ||
        !se3di_read_fields(reader, node, &se3di_object_force, "tyre", "se3d_tyre_def", &def) ||
        !check_given(reader, node, &def)) {
        return false;
    }
    if (is_mirrored(reader->part->place.M)) {
        def.side = def.side == SE3D_TYRE_LEFT ? SE3D_TYRE_RIGHT : SE3D_TYRE_LEFT;
    }
    def.name = entry->name;
    def.wheel = body->body;
    entry->body = def.wheel;
    memcpy(entry->point, def.center, sizeof entry->point);
    const se3d_status status = se3d_force_create_tyre(reader->system, &def, &entry->force);
    return status < 0 ? se3di_reader_fail_system(reader, node, status) : true;
}
