/* SPDX-License-Identifier: BSD-3-Clause */
/* `cell`. */
#include "io/read/cell.h"

#include "io/document/document.h"
#include "io/document/fields.h"
#include "io/document/keys.h"
#include "io/document/value.h"
#include "io/model/model.h"
#include "io/model/tagged.h"
#include "io/read/entries.h"
#include "io/read/objects.h"
#include "se3d/cell.h"

static const char *const axes[] = {"x", "y", "z", NULL};

/* clang-format off */
static const se3di_key stage_keys[] = {
    {"start", SE3DI_KIND_NUMBER, SE3DI_INTO(se3d_cell_def, start), .standard = "0",
     .text = "[s], after that of the stage before"},
    {"rate", SE3DI_KIND_VECTOR, SE3DI_INTO(se3d_cell_def, rate), .standard = "[0, 0, 0]",
     .text = "of the lengths along x, y, z, over them [1/s]"},
    {"shear_rate", SE3DI_KIND_NUMBER, SE3DI_INTO(se3d_cell_def, shear_rate), .standard = "0",
     .text = "of the velocity along `flow`, by the place along `gradient` [1/s]"},
    {"flow", SE3DI_KIND_WORD, SE3DI_INTO(se3d_cell_def, flow), .words = axes, .standard = "x",
     .text = "the axis along which the cell is sheared"},
    {"gradient", SE3DI_KIND_WORD, SE3DI_INTO(se3d_cell_def, gradient), .words = axes,
     .standard = "z", .text = "another axis, the same two in all stages that shear"},
    {"servo", SE3DI_KIND_TEXT, .standard = "no axis",
     .text = "the axes whose length keeps `stress`: x, y, z, or several as in xyz"},
    {"stress", SE3DI_KIND_VECTOR, SE3DI_INTO(se3d_cell_def, stress), .standard = "[0, 0, 0]",
     .text = "of servo: normal stress, positive where particles press [Pa]"},
    {"rate_max", SE3DI_KIND_VECTOR, SE3DI_INTO(se3d_cell_def, rate_max), .standard = "[1, 1, 1]",
     .text = "of servo: the largest rate [1/s]"},
    {"gain", SE3DI_KIND_VECTOR, SE3DI_INTO(se3d_cell_def, gain),
     .standard = "by the stiffness of contacts",
     .text = "of servo: rate over excess of stress [1/(Pa s)]"},
    {"volume", SE3DI_KIND_TEXT, .standard = "no axis",
     .text = "the axes whose length keeps the volume, as of servo: one or two"},
    {"shear_stress", SE3DI_KIND_NUMBER, SE3DI_INTO(se3d_cell_def, shear_stress),
     .text = "that the shear keeps, in place of shear_rate: < 0 where a positive one is resisted "
         "[Pa]"},
    {"shear_rate_max", SE3DI_KIND_NUMBER, SE3DI_POSITIVE,
     SE3DI_INTO(se3d_cell_def, shear_rate_max), .standard = "1",
     .text = "of shear_stress: the largest rate [1/s]"},
    {"shear_gain", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE, SE3DI_INTO(se3d_cell_def, shear_gain),
     .standard = "by the stiffness of contacts",
     .text = "of shear_stress: rate over excess of stress [1/(Pa s)]"},
    {.key = NULL}};
const se3di_object se3di_object_stage = {
    "stage",
    "A part of the motion of the periodic cell, until the next one starts.",
    stage_keys, NULL,
    NULL};
/* clang-format on */

/* Axes as in `xz`. */
static bool read_axes(se3di_reader *reader, const se3di_node *node, const char *key,
                      int32_t chosen[3])
{
    const se3di_node *child = se3di_node_get(node, key);
    const char *text = "";
    if (child && !se3di_read_text(reader, child, &text)) {
        return false;
    }
    for (const char *c = text; *c; ++c) {
        const int axis = *c - 'x';
        if (axis < 0 || axis > 2 || chosen[axis]) {
            return se3di_reader_fail(reader, child,
                                     "is `%.20s`, must be axes of x, y and z, each once", text);
        }
        chosen[axis] = 1;
    }
    return true;
}

/* shear_stress is what makes the shear a servo. */
static bool read_shear(se3di_reader *reader, const se3di_node *node, se3d_cell_def *def)
{
    static const char *const keys[2] = {"shear_rate_max", "shear_gain"};
    def->shear_servo = se3di_node_get(node, "shear_stress") != NULL;
    for (int k = 0; k < 2 && !def->shear_servo; ++k) {
        if (se3di_node_get(node, keys[k])) {
            return se3di_reader_fail_key(reader, node, keys[k],
                                         "has no effect without `shear_stress`");
        }
    }
    return true;
}

static bool read_stage(se3di_reader *reader, const se3di_node *node)
{
    static const char *const keys[3] = {"stress", "rate_max", "gain"};
    se3di_tagged *particles = reader->model->particles;
    se3d_cell_def def = se3d_cell_def_default();
    if (!se3di_read_keys(reader, node, &se3di_object_stage) ||
        !se3di_read_fields(reader, node, &se3di_object_stage, NULL, "se3d_cell_def", &def) ||
        !read_axes(reader, node, "servo", def.servo) ||
        !read_axes(reader, node, "volume", def.volume) || !read_shear(reader, node, &def)) {
        return false;
    }
    for (int k = 0; k < 3 && !se3di_node_get(node, "servo"); ++k) {
        if (se3di_node_get(node, keys[k])) {
            return se3di_reader_fail_key(reader, node, keys[k],
                                         "has no effect without `servo`, the axes that it is for");
        }
    }
    particles->cell = true;
    return se3di_reader_check(reader, node,
                              se3d_particles_add_cell_stage(particles->set, &def, NULL));
}

bool se3di_read_cell(se3di_reader *reader, const se3di_node *list)
{
    return se3di_read_entries(reader, list, read_stage);
}
