/* SPDX-License-Identifier: BSD-3-Clause */
/* `flows`. */
#include "io/read/flows.h"
#include "io/read/entries.h"

#include "io/base/pool.h"
#include "io/document/document.h"
#include "io/document/fields.h"
#include "io/document/keys.h"
#include "io/document/value.h"
#include "io/model/model.h"
#include "io/model/tagged.h"
#include "io/read/objects.h"
#include "io/read/particle_names.h"
#include "se3d/flow.h"

/* clang-format off */
static const se3di_key flow_keys[] = {
    {"name", SE3DI_KIND_NAME, .required = true, .text = "for its channels"},
    {"point", SE3DI_KIND_VECTOR, SE3DI_INTO(se3d_flow_def, point), .standard = "[0, 0, 0]",
     .text = "of the plane, centre of the disk or rectangle [m]"},
    {"normal", SE3DI_KIND_DIRECTION, .required = true, SE3DI_INTO(se3d_flow_def, normal),
     .text = "what passes along it counts forward"},
    {"radius", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3d_flow_def, radius),
     .standard = "no end", .text = "of a disk [m]"},
    {"width", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, .standard = "no end",
     .text = "of a rectangle, along `along` [m]"},
    {"height", SE3DI_KIND_NUMBER, SE3DI_POSITIVE,
     .text = "of a rectangle, along normal x along [m]"},
    {"along", SE3DI_KIND_DIRECTION, SE3DI_INTO(se3d_flow_def, along),
     .text = "of a rectangle, which has width, height and along together"},
    {"window", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3d_flow_def, window),
     .standard = "0.1", .text = "over which rates are taken [s]"},
    {"set", SE3DI_KIND_TEXT, .standard = "all particles",
     .text = "a name of `particles`: only those"},
    {.key = NULL}};
const se3di_object se3di_object_flow = {
    "flow",
    "A plane, or a disk or rectangle in it: what passes through it is counted.",
    flow_keys, NULL,
    NULL};
/* clang-format on */

/* A rectangle has all three of its keys, a disk none. */
static bool read_rectangle(se3di_reader *reader, const se3di_node *node, se3d_flow_def *def)
{
    static const char *const keys[3] = {"width", "height", "along"};
    const char *given = NULL, *missing = NULL;
    for (int k = 0; k < 3; ++k) {
        given = se3di_node_get(node, keys[k]) ? keys[k] : given;
        missing = se3di_node_get(node, keys[k]) ? missing : keys[k];
    }
    if (given && missing) {
        return se3di_reader_fail_key(
            reader, node, given, "needs `%s`: a rectangle has width, height and along", missing);
    }
    if (given && se3di_node_get(node, "radius")) {
        return se3di_reader_fail_key(reader, node, "radius",
                                     "and `%s` exclude each other: a flow is a disk or a rectangle",
                                     given);
    }
    return se3di_read_key(reader, node, &se3di_object_flow, NULL, "width", &def->size[0]) &&
           se3di_read_key(reader, node, &se3di_object_flow, NULL, "height", &def->size[1]);
}

static bool read_flow(se3di_reader *reader, const se3di_node *node)
{
    se3di_tagged *particles = reader->model->particles;
    const se3di_node *name = se3di_node_get(node, "name");
    const char *text = NULL;
    se3d_flow_def def = se3d_flow_def_default();
    if (!se3di_read_keys(reader, node, &se3di_object_flow)) {
        return false;
    }
    if (!name || !se3di_node_get(node, "normal")) {
        return se3di_reader_fail(reader, node, "must have `name` and `normal`");
    }
    if (!se3di_read_name(reader, name, &text) || !se3di_check_free_name(reader, name, text) ||
        !se3di_read_fields(reader, node, &se3di_object_flow, NULL, "se3d_flow_def", &def) ||
        !read_rectangle(reader, node, &def) || !se3di_read_key_set(reader, node, "set", &def.tag)) {
        return false;
    }
    particles->flows[particles->flow_count++] = text;
    return se3di_reader_check(reader, node, se3d_particles_add_flow(particles->set, &def, NULL));
}

bool se3di_read_flows(se3di_reader *reader, const se3di_node *list)
{
    se3di_tagged *particles = reader->model->particles;
    particles->flows = se3di_read_room(reader, list, sizeof *particles->flows);
    return particles->flows && se3di_read_entries(reader, list, read_flow);
}
