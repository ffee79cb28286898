/* SPDX-License-Identifier: BSD-3-Clause */
/* `units`: what the numbers of a file are in. */
#include "io/read/units.h"

#include <stdio.h>
#include <string.h>

#include "io/document/document.h"
#include "io/read/objects.h"

/* clang-format off */
static const se3di_key units_keys[] = {
    {"length", SE3DI_KIND_TEXT, .standard = "m", .text = "such as mm"},
    {"mass", SE3DI_KIND_TEXT, .standard = "kg", .text = "such as g, tonne"},
    {"time", SE3DI_KIND_TEXT, .standard = "s", .text = "such as ms"},
    {"angle", SE3DI_KIND_TEXT, .standard = "rad", .text = "such as deg"},
    {"force", SE3DI_KIND_TEXT, .standard = "N",
     .text = "such as kN; also of stiffness, torque, pressure"},
    {.key = NULL}};
const se3di_object se3di_object_units = {
    "units",
    "What numbers without a unit are in.",
    units_keys, NULL,
    NULL};
/* clang-format on */

static bool read_unit(se3di_reader *reader, const se3di_node *map, const char *key,
                      se3di_measure *unit)
{
    const se3di_node *node = se3di_node_get(map, key);
    const char *text = NULL;
    se3di_measure found;
    char is[80];
    char must[80];
    if (!node) {
        return true;
    }
    if (!se3di_read_text(reader, node, &text)) {
        return false;
    }
    const size_t length = se3di_unit_parse(text, true, &found);
    if (length == 0 || text[length]) {
        return se3di_reader_fail(reader, node,
                                 "`%.60s` is no unit, must be one such as mm, kg, s, "
                                 "deg, N",
                                 text);
    }
    if (memcmp(&found.dimension, &unit->dimension, sizeof found.dimension) != 0) {
        se3di_dimension_describe(found.dimension, is, sizeof is);
        se3di_dimension_describe(unit->dimension, must, sizeof must);
        return se3di_reader_fail(reader, node, "`%.60s` is %s, must be %s", text, is, must);
    }
    *unit = found;
    return true;
}

bool se3di_read_units(se3di_reader *reader, const se3di_node *root, se3di_units *units)
{
    const se3di_node *map = se3di_node_get(root, "units");
    if (!map) {
        return true;
    }
    units->are_si = false;
    return se3di_read_keys(reader, map, &se3di_object_units) &&
           read_unit(reader, map, "length", &units->length) &&
           read_unit(reader, map, "mass", &units->mass) &&
           read_unit(reader, map, "time", &units->time) &&
           read_unit(reader, map, "angle", &units->angle) &&
           read_unit(reader, map, "force", &units->force);
}
