/* SPDX-License-Identifier: BSD-3-Clause */
/* A joint of two frames as an entry: by a point and an axis in the ground frame where the frames
 * agree, which a person can read, else by the frames in both bodies. */
#include <math.h>
#include <string.h>

#include "io/import/machine.h"

static void axis_of(const se3di_frame *frame, int k, double axis[3])
{
    for (int i = 0; i < 3; ++i) {
        axis[i] = frame->A[3 * i + k];
    }
}

static bool is_one_of(const char *type, const char *const *list)
{
    for (; *list; ++list) {
        if (strcmp(type, *list) == 0) {
            return true;
        }
    }
    return false;
}

/* Rounding of data may move the second frame onto the first; more than that may not be lost. */
static bool agree(const se3di_machine_joint *joint)
{
    static const char *const one_axis[] = {"revolute", "prismatic", "cylindrical",
                                           "planar",   "screw",     NULL};
    const double size = 1.0 + se3di_length(joint->frame_i.r);
    double a[3];
    double b[3];
    axis_of(&joint->frame_i, 2, a);
    axis_of(&joint->frame_j, 2, b);
    const bool same = se3di_distance(joint->frame_i.r, joint->frame_j.r) < 1e-14 * size;
    return is_one_of(joint->type, one_axis) && same && se3di_distance(a, b) < 1e-14;
}

static void put_side(se3di_machine *m, se3di_entry *entry, const char *side, size_t body,
                     const se3di_frame *frame, const char *const *keys)
{
    const se3di_frame in = se3di_frame_in(&se3di_machine_body_at(m, body)->frame, frame);
    double axis[3];
    (void)side;
    se3di_entry_put_vector(m, entry, keys[0], in.r);
    if (keys[1]) {
        axis_of(&in, 2, axis);
        se3di_entry_put_vector(m, entry, keys[1], axis);
    }
    if (keys[2]) {
        axis_of(&in, 0, axis);
        se3di_entry_put_vector(m, entry, keys[2], axis);
    }
}

/* The keys that a type takes: the point, the axis, the zero direction. */
static void put_frames(se3di_machine *m, se3di_entry *entry, const se3di_machine_joint *joint)
{
    static const char *const points[] = {"spherical", "distance", NULL};
    static const char *const line[] = {"point_on_line", "point_on_plane", "revolute_spherical",
                                       NULL};
    static const char *const axes[] = {"universal", "parallel", "perpendicular", NULL};
    const bool point_only = is_one_of(joint->type, points);
    const bool one = is_one_of(joint->type, line);
    const bool no_ref = is_one_of(joint->type, axes);
    const char *i[3] = {"point_i", point_only ? NULL : "axis_i",
                        point_only || one || no_ref ? NULL : "ref_i"};
    const char *j[3] = {"point_j", point_only || one ? NULL : "axis_j",
                        point_only || one || no_ref ? NULL : "ref_j"};
    put_side(m, entry, "i", joint->body_i, &joint->frame_i, i);
    put_side(m, entry, "j", joint->body_j, &joint->frame_j, j);
}

se3di_entry *se3di_machine_add_joint(se3di_machine *m, const se3di_machine_joint *joint)
{
    se3di_entry *entry = se3di_machine_add(m, SE3DI_SECTION_JOINTS);
    double axis[3];
    se3di_entry_put_text(m, entry, "name", joint->name);
    se3di_entry_put(m, entry, "type", joint->type);
    se3di_entry_put_text(m, entry, "body_i", se3di_machine_body_name(m, joint->body_i));
    se3di_entry_put_text(m, entry, "body_j", se3di_machine_body_name(m, joint->body_j));
    if (!agree(joint)) {
        put_frames(m, entry, joint);
        if (joint->angle0 != 0.0) {
            se3di_entry_put_number(m, entry, "angle0", joint->angle0);
        }
        return entry;
    }
    const double angle = joint->angle0 + se3di_turn_angle(joint->frame_i.A, joint->frame_j.A);
    axis_of(&joint->frame_i, 2, axis);
    se3di_entry_put_vector(m, entry, "at", joint->frame_i.r);
    se3di_entry_put_vector(m, entry, "axis", axis);
    if (fabs(angle) > 1e-15) {
        se3di_entry_put_number(m, entry, "angle0", angle);
    }
    return entry;
}
