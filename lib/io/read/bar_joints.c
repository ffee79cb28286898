/* SPDX-License-Identifier: BSD-3-Clause */
/* The joints at the ends of bars: `body_from` and `body_to`. A bar has a ball at each end; the
 * first is a universal joint unless the bar may turn about itself. An arm has a pin through the
 * beginnings of its two bars, and a ball. */
#include <string.h>

#include "io/base/elementary.h"
#include "io/base/pool.h"
#include "io/document/document.h"
#include "io/document/fields.h"
#include "io/model/model.h"
#include "io/read/bars.h"
#include "io/read/bodies.h"
#include "io/read/elements.h"
#include "io/read/objects.h"
#include "math/vec3.h"

typedef struct end_joint {
    const char *key;    /* of the body that it joins the bar to */
    const char *suffix; /* of its name */
    const char *type;   /* as in `joints` */
    double at[3];       /* in the part, ground frame */
    double axis[3];
    double axis_2[3]; /* universal: that of the bar */
    se3d_status (*create)(se3d_system *system, const se3d_joint_def *def, se3d_constraint *joint);
} end_joint;

/* A map with a name and a type, as if it stood in `joints`. */
static const se3di_node *describe(se3di_reader *reader, const se3di_node *body,
                                  const end_joint *end)
{
    const se3di_node *name = se3di_node_get(body, "name");
    const size_t length = strlen(name->text);
    se3di_node *map = se3di_iopool_array(reader->pool, 3, sizeof *map);
    char *text = se3di_iopool_array(reader->pool, length + strlen(end->suffix) + 1, 1);
    if (!map || !text) {
        se3di_reader_fail_memory(reader);
        return NULL;
    }
    memcpy(text, name->text, length);
    memcpy(text + length, end->suffix, strlen(end->suffix) + 1);
    map[0] = *body;
    map[0].first = &map[1];
    map[0].last = &map[2];
    map[0].count = 2;
    map[1] = *name;
    map[1].text = text;
    map[1].next = &map[2];
    map[2] = *name;
    map[2].key = "type";
    map[2].text = end->type;
    map[2].next = NULL;
    return map;
}

static bool find_bodies(se3di_reader *reader, const se3di_node *body, const end_joint *end,
                        const se3di_body_entry *bodies[2])
{
    if (!se3di_read_key_body(reader, body, end->key, &bodies[0]) ||
        !se3di_read_key_body(reader, body, "name", &bodies[1])) {
        return false;
    }
    return bodies[0] != bodies[1] ||
           se3di_reader_fail_key(reader, body, end->key, "is the bar itself, must be another body");
}

static bool create_end(se3di_reader *reader, const se3di_node *body, const end_joint *end)
{
    const se3di_placement *place = &reader->part->place;
    const se3di_body_entry *bodies[2] = {NULL, NULL};
    se3di_element_entry *entry = NULL;
    se3d_joint_def def = se3d_joint_def_default();
    double at[3], axis[3], axis_2[3];
    if (!find_bodies(reader, body, end, bodies)) {
        return false;
    }
    const se3di_node *map = describe(reader, body, end);
    if (!map || !se3di_read_element(reader, map, SE3DI_ELEMENT_JOINT, &entry)) {
        return false;
    }
    memcpy(at, end->at, sizeof at);
    memcpy(axis, end->axis, sizeof axis);
    memcpy(axis_2, end->axis_2, sizeof axis_2);
    se3di_place_point(place, at);
    se3di_place_axial(place, axis);
    se3di_place_axial(place, axis_2);
    def.name = entry->name;
    def.body_i = bodies[0]->body;
    def.body_j = bodies[1]->body;
    se3d_status status = se3d_joint_def_set_frame(reader->system, &def, at, axis, NULL);
    if (status >= 0 && end->create == se3d_joint_create_universal &&
        !se3di_ground_to_body_direction(reader, def.body_j, axis_2, def.axis_j)) {
        return false;
    }
    status = status < 0 ? status : end->create(reader->system, &def, &entry->constraint);
    entry->body_i = def.body_i;
    entry->body_j = def.body_j;
    entry->drawn = end->create == se3d_joint_create_spherical ? 1 : 2;
    memcpy(entry->point_i, def.point_i, sizeof def.point_i);
    memcpy(entry->point_j, def.point_j, sizeof def.point_j);
    memcpy(entry->axis_j, def.axis_j, sizeof def.axis_j);
    return se3di_reader_check(reader, body, status);
}

/* The axes of a cross at the end of a bar along z: horizontal, and perpendicular to both, so that
 * nothing turns about z. */
static void cross_axes(const double z[3], end_joint *end)
{
    const double across = io_hypot(z[0], z[1]);
    const bool upright = across <= 1e-9 * io_hypot(across, z[2]);
    end->axis[0] = upright ? 1.0 : 0.0 - z[1] / across;
    end->axis[1] = upright ? 0.0 : z[0] / across;
    end->axis[2] = 0.0;
    se3di_cross(z, end->axis, end->axis_2);
}

static bool read_first(se3di_reader *reader, const se3di_node *body, const se3di_bar *bar,
                       bool turns)
{
    end_joint end = {"body_from", "_from", "spherical", .axis = {0.0, 0.0, 1.0},
                     .create = se3d_joint_create_spherical};
    double z[3];
    for (int k = 0; k < 3; ++k) {
        const double other = bar->leg_count == 2 ? bar->from[1][k] : bar->to[k];
        z[k] = other - bar->from[0][k];
        end.at[k] = bar->from[0][k];
    }
    if (bar->leg_count == 2) {
        end.type = "revolute";
        end.create = se3d_joint_create_revolute;
        for (int k = 0; k < 3; ++k) {
            end.at[k] += 0.5 * z[k];
            end.axis[k] = z[k];
        }
    } else if (!turns) {
        end.type = "universal";
        end.create = se3d_joint_create_universal;
        cross_axes(z, &end);
    }
    if (!(io_hypot(io_hypot(z[0], z[1]), z[2]) > 0.0)) {
        return se3di_reader_fail_key(reader, body, "from_2",
                                     "is where `from` is, the pin through both has no direction");
    }
    return create_end(reader, body, &end);
}

static bool read_ends(se3di_reader *reader, const se3di_node *body)
{
    static const char *const words[] = {"removed", "kept", NULL};
    const se3di_node *spin = se3di_node_get(body, "spin");
    const bool has_first = se3di_node_get(body, "body_from") != NULL;
    const bool has_last = se3di_node_get(body, "body_to") != NULL;
    size_t kept = 0;
    se3di_bar bar;
    if (!se3di_read_bar(reader, body, &bar) ||
        (spin && !se3di_read_word(reader, spin, words, &kept))) {
        return false;
    }
    if (spin && (bar.leg_count == 2 || !has_first)) {
        return se3di_reader_fail(reader, spin,
                                 "has no effect here: it is of a bar with `body_from`, the body at "
                                 "its beginning, and without `from_2`");
    }
    if (has_first && !read_first(reader, body, &bar, kept == 1)) {
        return false;
    }
    end_joint end = {"body_to", "_to", "spherical", .axis = {0.0, 0.0, 1.0},
                     .create = se3d_joint_create_spherical};
    memcpy(end.at, bar.to, sizeof end.at);
    return !has_last || create_end(reader, body, &end);
}

bool se3di_read_bar_joints(se3di_reader *reader, const se3di_node *root)
{
    const se3di_node *list = NULL;
    if (!se3di_read_list(reader, root, "bodies", &list)) {
        return false;
    }
    for (const se3di_node *body = list ? list->first : NULL; body; body = body->next) {
        bool wanted = true;
        if (!se3di_node_get(body, "from")) {
            continue;
        }
        if (!se3di_read_when(reader, body, &wanted) || (wanted && !read_ends(reader, body))) {
            return false;
        }
    }
    return true;
}
