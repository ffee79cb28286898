/* SPDX-License-Identifier: BSD-3-Clause */
/* The keys of the model file and of each type in it, and the search for what was meant. */
#include "io/document/keys.h"

#include <stdint.h>
#include <string.h>

static const char *const model_keys[] = {
    "se3d",   "title",    "parameters",  "gravity", "materials", "bodies",
    "joints", "drivers",  "constraints", "forces",  "contact",   "particles",
    "sinks",  "analysis", "events",      "output",  NULL};
static const char *const body_keys[] = {
    "name",    "fixed",    "held",        "mass",     "inertia",
    "density", "position", "orientation", "velocity", "angular_velocity",
    "shapes",  "markers",  NULL};
static const char *const orientation_keys[] = {"matrix", "euler_parameters", "axis", "angle", "rpy",
                                               NULL};
static const char *const shape_keys[] = {
    "name",  "group",  "mask",   "contact", "type",     "size",     "radius",      "length", "file",
    "scale", "convex", "normal", "density", "material", "position", "orientation", "color",  NULL};
static const char *const marker_keys[] = {"name", "position", "orientation", NULL};
static const char *const material_keys[] = {"name",        "density",          "friction",
                                            "restitution", "rolling_friction", "torsional_friction",
                                            "stiffness",   "tangential_ratio", "young",
                                            "poisson",     "cohesion",         "adhesion",
                                            NULL};
static const char *const contact_keys[] = {"law",      "step",  "threads", "skin",  "overlap_limit",
                                           "boundary", "lower", "upper",   "pairs", NULL};
static const char *const pair_keys[] = {
    "material_1",         "material_2", "friction", "restitution", "rolling_friction",
    "torsional_friction", "stiffness",  "cohesion", "adhesion",    NULL};
static const char *const particles_keys[] = {
    "material", "packing", "count",  "radius", "lower", "upper", "spacing", "jitter",
    "velocity", "seed",    "region", "axis",   "name",  "file",  "source",  NULL};
static const char *const source_keys[] = {"rate",  "mass_rate", "start", "stop",
                                          "count", "every",     NULL};
static const char *const sink_keys[] = {"name", "lower", "upper",  "region",
                                        "axis", "point", "normal", NULL};
static const char *const radius_keys[] = {"table", NULL};
static const char *const joint_keys[] = {
    "name",    "type",    "body_i", "body_j", "at",    "axis",   "ref",    "at_2",  "axis_2",
    "point_i", "point_j", "axis_i", "axis_j", "ref_i", "ref_j",  "angle0", "pitch", "distance",
    "joint_1", "joint_2", "ratio",  "pinion", "rack",  "radius", "terms",  "value", NULL};
static const char *const term_keys[] = {"joint", "coordinate", "ratio", NULL};
static const char *const driver_keys[] = {"name", "joint", "coordinate", "value", NULL};
static const char *const constraint_keys[] = {
    "name",  "type", "body_i", "body_j", "a_i",    "a_j",    "point_i", "point_j", "c",
    "value", "at",   "axis",   "axis_i", "axis_j", "axis_2", "at_2",    NULL};
static const char *const force_keys[] = {"name",
                                         "type",
                                         "body_i",
                                         "body_j",
                                         "point_i",
                                         "point_j",
                                         "k",
                                         "c",
                                         "l0",
                                         "h",
                                         "spring",
                                         "damper",
                                         "preload",
                                         "joint",
                                         "theta0",
                                         "axis",
                                         "ref",
                                         "axis_i",
                                         "ref_i",
                                         "ref_j",
                                         "angle0",
                                         "at",
                                         "orientation",
                                         "orientation_i",
                                         "orientation_j",
                                         "K",
                                         "C",
                                         "coordinate",
                                         "mu",
                                         "mu_static",
                                         "radius",
                                         "limit",
                                         "viscous",
                                         "presliding",
                                         "length",
                                         "width",
                                         "thrust_radius",
                                         "lower",
                                         "upper",
                                         "restitution",
                                         "body",
                                         "point",
                                         "frame",
                                         "value",
                                         NULL};
static const char *const spline_keys[] = {"spline", NULL};
static const char *const analysis_keys[] = {
    "type",    "formulation",     "method", "order",          "step",      "tolerance", "duration",
    "start",   "spectral_radius", "alpha",  "iterations_max", "steps_max", "file",      "inputs",
    "outputs", "frequencies",     NULL};
static const char *const modes_input_keys[] = {"body", "point", "direction", "torque", NULL};
static const char *const modes_output_keys[] = {"body", "point", "direction", "quantity", NULL};
static const char *const frequency_keys[] = {"from", "to", "count", NULL};
static const char *const event_keys[] = {"name",   "channel",    "value", "direction",
                                         "action", "hysteresis", NULL};
static const char *const output_keys[] = {"file",  "every", "channels", "particles", "contacts",
                                          "vtk",   "plot",  "from",     "x",         "fft",
                                          "scene", "video", "speed",    NULL};

#define FRAME  " at point_i point_j "
#define AXES   " axis axis_i axis_j "
#define ANGLE  " ref ref_i ref_j angle0 "
#define BODIES " body_i body_j "

static const se3di_type_keys joint_types[] = {
    {"fixed", BODIES FRAME AXES ANGLE},
    {"revolute", BODIES FRAME AXES ANGLE},
    {"prismatic", BODIES FRAME AXES ANGLE},
    {"cylindrical", BODIES FRAME AXES ANGLE},
    {"spherical", BODIES FRAME AXES ANGLE},
    {"universal", BODIES FRAME AXES ANGLE " axis_2 "},
    {"planar", BODIES FRAME AXES ANGLE},
    {"screw", BODIES FRAME AXES ANGLE " pitch "},
    {"point_on_line", BODIES FRAME AXES ANGLE " at_2 "},
    {"point_on_plane", BODIES FRAME AXES ANGLE " at_2 "},
    {"distance", BODIES FRAME " at_2 distance "},
    {"revolute_spherical", BODIES FRAME AXES ANGLE " at_2 distance "},
    {"revolute_cylindrical", BODIES FRAME AXES ANGLE " at_2 axis_2 distance "},
    {"parallel", BODIES FRAME AXES ANGLE},
    {"perpendicular", BODIES FRAME AXES ANGLE " axis_2 "},
    {"orientation", BODIES FRAME AXES ANGLE},
    {"gear", " joint_1 joint_2 ratio "},
    {"rack_pinion", " pinion rack radius "},
    {"coupler", " terms value "},
    {NULL, NULL}};
static const se3di_type_keys constraint_types[] = {
    {"dp1", BODIES " a_i a_j value "},
    {"dp2", BODIES " a_i point_i point_j value "},
    {"d", BODIES " point_i point_j value "},
    {"cd", BODIES " c point_i point_j value "},
    {"perpendicular1", BODIES FRAME AXES " axis_2 "},
    {"perpendicular2", BODIES FRAME " axis axis_i at_2 "},
    {NULL, NULL}};
static const se3di_type_keys force_types[] = {
    {"tsda", BODIES " point_i point_j k c l0 h spring damper preload "},
    {"rsda",
     " joint " BODIES " axis ref axis_i ref_i ref_j angle0 k c theta0 h spring damper preload "},
    {"bushing", BODIES " at orientation point_i point_j orientation_i orientation_j K C "},
    {"friction", " joint coordinate mu mu_static radius limit viscous presliding length width "
                 "thrust_radius "},
    {"stop", " joint coordinate " BODIES " point_i point_j lower upper k restitution "},
    {"force", " body point frame value "},
    {"torque", " body frame value "},
    {NULL, NULL}};
#define TOUCH " material group mask contact "
static const se3di_type_keys shape_types[] = {{"sphere", " radius density" TOUCH},
                                              {"box", " size density" TOUCH},
                                              {"capsule", " radius length density" TOUCH},
                                              {"cylinder", " radius length density" TOUCH},
                                              {"plane", " normal" TOUCH},
                                              {"mesh", " file scale convex density" TOUCH},
                                              {NULL, NULL}};

static const se3di_object_keys objects[SE3DI_OBJECT_COUNT] = {
    {"model", model_keys, NULL, NULL, NULL},
    {"body", body_keys, NULL, NULL, NULL},
    {"orientation", orientation_keys, NULL, NULL, NULL},
    {"shape", shape_keys, shape_types, " type name position orientation color ", NULL},
    {"marker", marker_keys, NULL, NULL, NULL},
    {"material", material_keys, NULL, NULL, NULL},
    {"joint", joint_keys, joint_types, " name type ", NULL},
    {"term", term_keys, NULL, NULL, NULL},
    {"driver", driver_keys, NULL, NULL, NULL},
    {"constraint", constraint_keys, constraint_types, " name type ", NULL},
    {"force", force_keys, force_types, " name type ", NULL},
    {"spline", spline_keys, NULL, NULL, NULL},
    {"analysis", analysis_keys, NULL, NULL, NULL},
    {"output", output_keys, NULL, NULL, NULL},
    {"modes_input", modes_input_keys, NULL, NULL, NULL},
    {"modes_output", modes_output_keys, NULL, NULL, NULL},
    {"frequencies", frequency_keys, NULL, NULL, NULL},
    {"contact", contact_keys, NULL, NULL, NULL},
    {"pair", pair_keys, NULL, NULL, NULL},
    {"particles", particles_keys, NULL, NULL, NULL},
    {"radius", radius_keys, NULL, NULL, NULL},
    {"event", event_keys, NULL, NULL, NULL},
    {"source", source_keys, NULL, NULL, NULL},
    {"sink", sink_keys, NULL, NULL, NULL},
};

const se3di_object_keys *se3di_keys_get(se3di_object object)
{
    return &objects[object];
}

int se3di_keys_contain(const char *list, const char *word)
{
    const size_t length = strlen(word);
    for (const char *at = list; length > 0 && (at = strstr(at, word)) != NULL; ++at) {
        if (at > list && at[-1] == ' ' && at[length] == ' ') {
            return 1;
        }
    }
    return 0;
}
