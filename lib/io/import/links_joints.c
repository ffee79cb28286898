/* SPDX-License-Identifier: BSD-3-Clause */
/* Joints of links, and what acts along them: stops, springs, dampers, friction, armatures. */
#include <math.h>
#include <string.h>

#include "io/import/links_parts.h"

static const struct {
    const char *type;
    const char *coordinate; /* along which things act; NULL: none */
    bool several;           /* it must be named */
} kinds[] = {[SE3DI_LINK_FIXED] = {"fixed", NULL, false},
             [SE3DI_LINK_REVOLUTE] = {"revolute", "angle", false},
             [SE3DI_LINK_PRISMATIC] = {"prismatic", "displacement", false},
             [SE3DI_LINK_CYLINDRICAL] = {"cylindrical", "angle", true},
             [SE3DI_LINK_SPHERICAL] = {"spherical", NULL, false},
             [SE3DI_LINK_UNIVERSAL] = {"universal", NULL, false},
             [SE3DI_LINK_PLANAR] = {"planar", NULL, false},
             [SE3DI_LINK_SCREW] = {"screw", "angle", true},
             [SE3DI_LINK_FREE] = {"", NULL, false}};

static bool is_linear(const se3di_link_joint *joint)
{
    return joint->type == SE3DI_LINK_PRISMATIC;
}

static se3di_entry *add_force(se3di_machine *m, const se3di_link_joint *joint, const char *suffix,
                              const char *type)
{
    const char *wanted = se3di_machine_extend(m, joint->made, suffix);
    const char *name = wanted ? se3di_machine_name(m, wanted, "force", joint->line) : NULL;
    se3di_entry *entry = se3di_machine_add_force(m, name, type);
    if (!entry) {
        return NULL;
    }
    se3di_entry_put_text(m, entry, "joint", joint->made);
    if (kinds[joint->type].several) {
        se3di_entry_put(m, entry, "coordinate", kinds[joint->type].coordinate);
    }
    return entry;
}

/* The formats know no stiffness of their limits: it is a parameter that a person can set. */
static void add_stop(se3di_machine *m, const se3di_link_joint *joint)
{
    if (!joint->has_lower && !joint->has_upper) {
        return;
    }
    if (joint->has_lower && joint->has_upper && !(joint->lower < joint->upper)) {
        const bool none = joint->lower == 0.0 && joint->upper == 0.0; /* left at its default */
        se3di_machine_note_of(m, none ? SE3D_IMPORT_NOTE : SE3D_IMPORT_LOST, joint->line,
                              "the range of `%.80s`, %g to %g, is empty: it gets no stop",
                              joint->made, joint->lower, joint->upper);
        return;
    }
    const char *k = is_linear(joint) ? "stop_k_length" : "stop_k_angle";
    se3di_machine_parameter(m, k,
                            is_linear(joint) ? "1e6 # of the ends of ranges [N/m]"
                                             : "1e4 # of the ends of ranges [N m/rad]");
    se3di_entry *entry = add_force(m, joint, "_stop", "stop");
    if (joint->has_lower) {
        se3di_entry_put_number(m, entry, "lower", joint->lower);
    }
    if (joint->has_upper) {
        se3di_entry_put_number(m, entry, "upper", joint->upper);
    }
    se3di_entry_put(m, entry, "k", k);
}

static void add_spring(se3di_machine *m, const se3di_link_joint *joint)
{
    const bool spring = joint->stiffness != 0.0;
    const bool damper = joint->damping != 0.0;
    if (!spring && !damper) {
        return;
    }
    se3di_entry *entry = add_force(m, joint, spring ? "_spring" : "_damping", "effort");
    const char *k = se3di_machine_number(m, joint->stiffness);
    const char *rest = se3di_machine_number(m, joint->rest);
    const char *c = se3di_machine_number(m, joint->damping);
    if (!k || !rest || !c) {
        return;
    }
    const char *value = !spring ? se3di_machine_text(m, "'-(%s)*qdot'", c)
                        : damper
                            ? se3di_machine_text(m, "'-(%s)*(q - (%s)) - (%s)*qdot'", k, rest, c)
                            : se3di_machine_text(m, "'-(%s)*(q - (%s))'", k, rest);
    se3di_entry_put(m, entry, "value", value);
}

static void add_friction(se3di_machine *m, const se3di_link_joint *joint)
{
    if (joint->friction > 0.0) {
        se3di_entry *entry = add_force(m, joint, "_friction", "friction");
        se3di_entry_put_number(m, entry, "limit", joint->friction);
    }
}

static void add_armature(se3di_machine *m, const se3di_link_joint *joint)
{
    if (joint->armature > 0.0) {
        se3di_entry *entry = add_force(m, joint, "_armature", "armature");
        se3di_entry_put_number(m, entry, "inertia", joint->armature);
    }
}

static bool emit(se3di_links *links, se3di_link_joint *joint)
{
    se3di_machine *m = links->m;
    const size_t i = links->list[joint->parent].body;
    const size_t j = links->list[joint->child].body;
    const bool still = links->list[se3di_links_leader(links, joint->parent)].anchored &&
                       links->list[se3di_links_leader(links, joint->child)].anchored;
    const bool merged =
        i == j || joint->type == SE3DI_LINK_FREE ||
        (joint->type == SE3DI_LINK_FIXED &&
         (still || (links->list[joint->parent].is_ground &&
                    links->list[se3di_links_leader(links, joint->child)].anchored)));
    if (merged) {
        if (i == j && joint->type != SE3DI_LINK_FIXED && joint->type != SE3DI_LINK_FREE) {
            se3di_machine_note_of(m, SE3D_IMPORT_LOST, joint->line,
                                  "both links of `%.80s` are one body", joint->name);
        }
        return true;
    }
    joint->made = se3di_machine_name(m, joint->name, "joint", joint->line);
    const se3di_machine_joint out = {.name = joint->made,
                                     .type = kinds[joint->type].type,
                                     .body_i = i,
                                     .body_j = j,
                                     .frame_i = joint->frame_i,
                                     .frame_j = joint->frame_j,
                                     .angle0 = joint->angle0};
    se3di_entry *entry = joint->made ? se3di_machine_add_joint(m, &out) : NULL;
    if (!entry) {
        return false;
    }
    entry->comment = joint->comment;
    if (joint->type == SE3DI_LINK_SCREW) {
        se3di_entry_put_number(m, entry, "pitch", joint->pitch);
    }
    if (kinds[joint->type].coordinate) {
        add_stop(m, joint);
        add_spring(m, joint);
        add_friction(m, joint);
        add_armature(m, joint);
        return m->status >= 0;
    }
    if (joint->damping != 0.0 || joint->friction != 0.0 || joint->stiffness != 0.0 ||
        joint->armature != 0.0) {
        se3di_machine_note_of(m, SE3D_IMPORT_LOST, joint->line,
                              "damping, friction, stiffness or armature of `%.80s`, which has no "
                              "single coordinate",
                              joint->made);
    }
    return m->status >= 0;
}

bool se3di_links_emit_joints(se3di_links *links)
{
    for (size_t k = 0; k < links->joint_count; ++k) {
        if (!emit(links, &links->joints[k])) {
            return false;
        }
    }
    return true;
}
