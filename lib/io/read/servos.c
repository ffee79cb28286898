/* SPDX-License-Identifier: BSD-3-Clause */
/* `servos`. */
#include "io/read/servos.h"
#include "io/read/entries.h"

#include "io/base/pool.h"
#include "io/document/document.h"
#include "io/document/fields.h"
#include "io/document/function.h"
#include "io/document/keys.h"
#include "io/document/value.h"
#include "io/model/model.h"
#include "io/model/tagged.h"
#include "io/read/objects.h"
#include "io/read/particle_names.h"
#include "se3d/servo.h"

/* clang-format off */
static const se3di_key servo_keys[] = {
    {"name", SE3DI_KIND_NAME, .required = true, .text = "for its channels"},
    {"shape", SE3DI_KIND_TEXT, .required = true,
     .text = "the name of the shape that moves, also of the ground's"},
    {"axis", SE3DI_KIND_DIRECTION, .required = true, SE3DI_INTO(se3d_servo_def, axis),
     .text = "along which it presses, in the frame of its body"},
    {"force", SE3DI_KIND_FUNCTION, .text = "on the particles [N], may be an expression in t"},
    {"stress", SE3DI_KIND_FUNCTION, .text = "in place of force, on `area` [Pa]"},
    {"area", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3d_servo_def, area),
     .text = "of `stress` [m^2]"},
    {"speed_max", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, .required = true,
     SE3DI_INTO(se3d_servo_def, speed_max), .text = "the largest speed [m/s]"},
    {"gain", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3d_servo_def, gain),
     .standard = "by the stiffness of contacts",
     .text = "speed over missing force [m/(N s)]"},
    {"start", SE3DI_KIND_NUMBER, SE3DI_INTO(se3d_servo_def, start), .standard = "0",
     .text = "at rest before [s]"},
    {.key = NULL}};
const se3di_object se3di_object_servo = {
    "servo",
    "A shape that moves on its body so that particles press it with a given force or stress.",
    servo_keys, NULL,
    "\"oneOf\": [{\"required\": [\"force\"]}, {\"required\": [\"stress\", \"area\"]}]"};
/* clang-format on */

/* force, or stress and area. */
static bool read_load(se3di_reader *reader, const se3di_node *node, se3d_servo_def *def)
{
    static const char *const variables[] = {"t", NULL};
    const se3di_node *force = se3di_node_get(node, "force");
    const se3di_node *stress = se3di_node_get(node, "stress");
    if (!force == !stress) {
        return se3di_reader_fail(reader, node,
                                 "must have either `force` [N] or `stress` [Pa] with `area`");
    }
    if (!stress != !se3di_node_get(node, "area")) {
        return se3di_reader_fail_key(reader, node, stress ? "stress" : "area",
                                     "needs `%s` beside it", stress ? "area" : "stress");
    }
    return se3di_read_function(reader, force ? force : stress, variables, &def->load,
                               &def->function);
}

static bool read_servo(se3di_reader *reader, const se3di_node *node)
{
    static const char *const needed[] = {"name", "shape", "axis", "speed_max"};
    se3di_tagged *particles = reader->model->particles;
    const se3di_node *name = se3di_node_get(node, "name");
    const char *text = NULL;
    se3d_servo_def def = se3d_servo_def_default();
    if (!se3di_read_keys(reader, node, &se3di_object_servo)) {
        return false;
    }
    for (size_t k = 0; k < sizeof needed / sizeof *needed; ++k) {
        if (!se3di_node_get(node, needed[k])) {
            return se3di_reader_fail(reader, node, "must have `%s`", needed[k]);
        }
    }
    if (!se3di_read_name(reader, name, &text) || !se3di_check_free_name(reader, name, text) ||
        !se3di_read_shape_name(reader, se3di_node_get(node, "shape"), &def.shape) ||
        !se3di_read_fields(reader, node, &se3di_object_servo, NULL, "se3d_servo_def", &def) ||
        !read_load(reader, node, &def)) {
        return false;
    }
    particles->servos[particles->servo_count++] = text;
    const se3d_status status = se3d_particles_add_servo(particles->set, &def, NULL);
    return status < 0 ? se3di_reader_fail_system(reader, node, status) : true;
}

bool se3di_read_servos(se3di_reader *reader, const se3di_node *list)
{
    se3di_tagged *particles = reader->model->particles;
    particles->servos = se3di_read_room(reader, list, sizeof *particles->servos);
    return particles->servos && se3di_read_entries(reader, list, read_servo);
}
