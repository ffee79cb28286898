/* SPDX-License-Identifier: BSD-3-Clause */
/* `drivers`: joint coordinates that follow a function of time, or of other positions. */
#include "io/channel/law.h"
#include "io/document/fields.h"
#include "io/document/function.h"
#include "io/model/model.h"
#include "io/read/elements.h"
#include "io/read/objects.h"
#include "io/read/sections.h"

/* clang-format off */
static const se3di_key driver_keys[] = {
    {"name", SE3DI_KIND_NAME, .standard = "driver1, driver2, ...",
     .text = "unique among joints, drivers, constraints and forces"},
    {"when", SE3DI_KIND_CONDITION, .text = "it is there only if this holds"},
    {"joint", SE3DI_KIND_JOINT, .required = true, .text = ""},
    {"coordinate", SE3DI_KIND_WORD, .words = se3di_coordinates,
     .text = "may be left out if the joint has one only"},
    {"value", SE3DI_KIND_FUNCTION, .text = "a number or a function of t [m, rad]"},
    {"rate", SE3DI_KIND_FUNCTION,
     .text = "in place of value: its rate, a number or a function of t or of channels [m/s, "
             "rad/s], such as 600 rpm; the coordinate is start plus the integral of it"},
    {"start", SE3DI_KIND_NUMBER, .standard = "as at the given pose",
     .text = "with rate: the coordinate at t = 0 [m, rad]"},
    {.key = NULL}};
const se3di_object se3di_object_driver = {
    "driver",
    "A joint coordinate that follows a function of time, or of other positions.",
    driver_keys, NULL,
    NULL};
/* clang-format on */

/* A rate that names channels. */
static bool read_followed_rate(se3di_reader *reader, const se3di_node *node, const se3di_node *rate,
                               se3d_driver_def *def)
{
    const se3di_node *start = se3di_node_get(node, "start");
    def->is_rate = 1;
    return (!start || se3di_reader_fail(reader, start,
                                        "is for a rate of t alone: where the rate follows channels "
                                        "the coordinate starts as at the given pose")) &&
           se3di_read_followed_rate(reader, rate, &def->function);
}

/* What the coordinate follows, from its rate. */
static bool read_rate(se3di_reader *reader, const se3di_node *node, se3d_driver_def *def,
                      se3di_element_entry *entry)
{
    const se3di_node *rate = se3di_node_get(node, "rate");
    double start = 0.0;
    bool is_number = false;
    if (se3di_node_get(node, "value")) {
        return se3di_reader_fail(reader, rate, "stands beside value, must be one of them");
    }
    const se3d_status status = se3d_joint_get_coordinate(
        reader->system, def->joint, (se3d_joint_coordinate)def->coordinate, &start, NULL, NULL);
    if (status < 0) {
        return se3di_reader_fail_system(reader, rate, status);
    }
    if (se3di_is_followed(reader, rate)) {
        return read_followed_rate(reader, node, rate, def);
    }
    if (!se3di_read_key(reader, node, &se3di_object_driver, NULL, "start", &start) ||
        !se3di_read_rate(reader, rate, start, &entry->value[0], &is_number, &def->function)) {
        return false;
    }
    entry->settable = is_number;
    entry->rate = def->function;
    return true;
}

static bool read_value(se3di_reader *reader, const se3di_node *node, se3d_driver_def *def,
                       se3di_element_entry *entry)
{
    const se3di_node *value = se3di_node_get(node, "value");
    const se3di_node *start = se3di_node_get(node, "start");
    if (se3di_node_get(node, "rate")) {
        return read_rate(reader, node, def, entry);
    }
    if (start && !node->incomplete) { /* else its rate was wrong */
        return se3di_reader_fail(reader, start, "is for a driver with a rate");
    }
    if (!value) {
        return se3di_reader_fail_key(reader, node, "value",
                                     "is missing, must be a number, an expression in t or "
                                     "{spline: [[t, value], ...]}; or give its rate");
    }
    if (!(se3di_is_followed(reader, value)
              ? se3di_read_followed(reader, value, &def->function)
              : se3di_read_prescribed(reader, value, &def->value, &def->function))) {
        return false;
    }
    entry->settable = def->function.index1 == 0;
    entry->value[0] = def->value;
    return true;
}

static bool read_driver(se3di_reader *reader, const se3di_node *node)
{
    se3d_driver_def def = se3d_driver_def_default();
    se3di_element_entry *entry = NULL;
    if (!se3di_read_keys(reader, node, &se3di_object_driver) ||
        !se3di_read_element(reader, node, SE3DI_ELEMENT_DRIVER, &entry) ||
        !se3di_read_key_joint(reader, node, "joint", &def.joint) ||
        !se3di_read_key_coordinate(reader, node, def.joint, &def.coordinate) ||
        !read_value(reader, node, &def, entry)) {
        return false;
    }
    def.name = entry->name;
    entry->coordinate = def.coordinate;
    entry->driven = def.joint;
    const se3d_status status = se3d_driver_create(reader->system, &def, &entry->constraint);
    const se3di_node *law = se3di_node_get(node, def.is_rate ? "rate" : "value");
    return status < 0 ? se3di_reader_fail_system(
                            reader, se3di_is_followed(reader, law) ? law : node, status)
                      : true;
}

/* Those that follow the time alone; positions, whose channels have to be there; or, by their rates,
 * any channel, also those of states, whose laws have to be there. */
typedef enum follows { FOLLOWS_TIME, FOLLOWS_POSITIONS, FOLLOWS_RATES } follows;

static follows find_follows(const se3di_reader *reader, const se3di_node *node)
{
    const bool is_map = node->kind == SE3DI_NODE_MAP;
    if (is_map && se3di_is_followed(reader, se3di_node_get(node, "value"))) {
        return FOLLOWS_POSITIONS;
    }
    return is_map && se3di_is_followed(reader, se3di_node_get(node, "rate")) ? FOLLOWS_RATES
                                                                             : FOLLOWS_TIME;
}

static bool read_drivers(se3di_reader *reader, const se3di_node *root, follows which)
{
    const se3di_node *list = NULL;
    if (!se3di_read_list(reader, root, "drivers", &list)) {
        return false;
    }
    for (const se3di_node *node = list ? list->first : NULL; node; node = node->next) {
        bool wanted = true;
        if (!se3di_reader_wants(reader, node) || find_follows(reader, node) != which) {
            continue;
        }
        if (!se3di_read_when(reader, node, &wanted) || (wanted && !read_driver(reader, node))) {
            return false;
        }
    }
    return true;
}

bool se3di_read_drivers(se3di_reader *reader, const se3di_node *root)
{
    return read_drivers(reader, root, FOLLOWS_TIME);
}

bool se3di_read_followers(se3di_reader *reader, const se3di_node *root)
{
    return read_drivers(reader, root, FOLLOWS_POSITIONS);
}

bool se3di_read_rate_followers(se3di_reader *reader, const se3di_node *root)
{
    return read_drivers(reader, root, FOLLOWS_RATES);
}
