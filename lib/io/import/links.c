/* SPDX-License-Identifier: BSD-3-Clause */
/* Links: adding them, and merging those without mass, or all on fixed joints, with their
 * neighbours. A group of merged links has a leader, which holds the mass of all. */
#include "io/import/links.h"

#include <string.h>

#include "io/import/inertia.h"
#include "io/import/links_parts.h"

se3di_link *se3di_links_add(se3di_links *links, const char *name, size_t line)
{
    se3di_link *grown =
        se3di_iopool_grow(links->m->pool, links->list, links->count, &links->room, sizeof *grown);
    if (!grown) {
        se3di_machine_fail_memory(links->m);
        return NULL;
    }
    links->list = grown;
    se3di_link *link = &grown[links->count];
    memset(link, 0, sizeof *link);
    link->name = name;
    link->line = line;
    link->frame = se3di_frame_identity();
    link->group = links->count++;
    return link;
}

bool se3di_links_add_shape(se3di_links *links, size_t link, const se3di_machine_shape *shape)
{
    se3di_machine_shape *added = se3di_parts_add_shape(links->m, &links->list[link].parts);
    if (added) {
        *added = *shape; /* the last of its list: it has no next */
    }
    return added != NULL;
}

bool se3di_links_read_shape(se3di_links *links, size_t link, const se3di_xml *geometry,
                            se3di_read_geometry *read, se3di_machine_shape *shape)
{
    bool good = false;
    if (geometry && geometry->first && !read(links->m, geometry->first, shape, &good)) {
        return false;
    }
    return !good || se3di_links_add_shape(links, link, shape);
}

se3di_link_joint *se3di_links_join(se3di_links *links, const char *name, size_t line)
{
    se3di_link_joint *grown = se3di_iopool_grow(links->m->pool, links->joints, links->joint_count,
                                                &links->joint_room, sizeof *grown);
    if (!grown) {
        se3di_machine_fail_memory(links->m);
        return NULL;
    }
    links->joints = grown;
    se3di_link_joint *joint = &grown[links->joint_count++];
    memset(joint, 0, sizeof *joint);
    joint->name = name;
    joint->line = line;
    joint->frame_i = joint->frame_j = se3di_frame_identity();
    return joint;
}

size_t se3di_links_leader(const se3di_links *links, size_t link)
{
    while (links->list[link].group != link) {
        /* halve the path */
        links->list[link].group = links->list[links->list[link].group].group;
        link = links->list[link].group;
    }
    return link;
}

static void merge(se3di_links *links, size_t a, size_t b)
{
    const bool first = links->list[a].mass.mass > 0.0 || !(links->list[b].mass.mass > 0.0);
    const size_t leader = first ? a : b;
    const size_t other = first ? b : a;
    se3di_link *to = &links->list[leader];
    se3di_link *from = &links->list[other];
    const se3di_frame in = se3di_frame_in(&to->frame, &from->frame);
    const se3di_mass mass = se3di_mass_of(&in, &from->mass); /* a rotor may have inertia alone */
    to->mass = se3di_mass_sum(&to->mass, &mass);
    to->anchored = to->anchored || from->anchored;
    from->group = leader;
}

/* A link that is held by the ground alone does not move: it needs no joint. */
static bool is_anchor(const se3di_links *links, const se3di_link_joint *joint)
{
    return joint->type == SE3DI_LINK_FIXED && links->list[joint->parent].is_ground;
}

/* Without mass, or with an inertia that only the sum with its neighbour's may make one: data that
 * was never meant to move alone. */
static bool is_no_body(const se3di_link *link)
{
    return !(link->mass.mass > 0.0) || !se3di_inertia_is_sound(link->mass.mass, link->mass.J);
}

void se3di_links_merge(se3di_links *links)
{
    const bool all = links->m->options->merge_fixed != 0;
    for (size_t k = 0; k < links->joint_count; ++k) {
        const se3di_link_joint *joint = &links->joints[k];
        if (is_anchor(links, joint)) {
            links->list[joint->child].anchored = true;
        }
    }
    for (size_t k = 0; k < links->joint_count; ++k) {
        const se3di_link_joint *joint = &links->joints[k];
        if (joint->type != SE3DI_LINK_FIXED || is_anchor(links, joint)) {
            continue;
        }
        const size_t a = se3di_links_leader(links, joint->parent);
        const size_t b = se3di_links_leader(links, joint->child);
        const bool light = is_no_body(&links->list[a]) || is_no_body(&links->list[b]);
        if (a != b && (all || light)) {
            merge(links, a, b);
        }
    }
}
