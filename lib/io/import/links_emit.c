/* SPDX-License-Identifier: BSD-3-Clause */
/* Links become bodies: their origins at the centre of mass, their axes those of the link. */
#include <string.h>

#include "io/import/inertia.h"
#include "io/import/links_parts.h"

/* A body between moving joints must have some mass; this much changes no result that is rounded to
 * eight digits. */
#define LIGHT    1e-9
#define LIGHTEST 1e-12 /* the other format has no body there at all */

static double total_mass(const se3di_links *links)
{
    double sum = 0.0;
    for (size_t k = 0; k < links->count; ++k) {
        if (links->list[k].group == k) {
            sum += links->list[k].mass.mass;
        }
    }
    return sum > 0.0 ? sum : 1.0;
}

static bool give_mass(se3di_links *links, se3di_link *link, const char *name, double total)
{
    se3di_machine *m = links->m;
    if (!(link->mass.mass > 0.0)) {
        link->mass.mass = (link->between ? LIGHTEST : LIGHT) * total;
        memset(link->mass.J, 0, sizeof link->mass.J);
        link->mass.J[0] = link->mass.J[4] = link->mass.J[8] = link->mass.mass * 1e-2;
        if (link->between) {
            return true;
        }
        se3di_machine_note_of(m, SE3D_IMPORT_CHANGED, link->line,
                              "`%.80s` moves and has no mass; it gets %g kg, 1e-9 of all", name,
                              link->mass.mass);
        return true;
    }
    return se3di_inertia_mend(m, name, link->line, link->mass.mass, link->mass.J);
}

static bool make_body(se3di_links *links, se3di_link *link, double total)
{
    se3di_machine *m = links->m;
    double out[3];
    double cross[3];
    if (link->is_ground) {
        link->body = SE3DI_GROUND;
        return true;
    }
    const char *name = se3di_machine_name_body(m, link->name, "body", link->line);
    if (!name || (!link->anchored && !give_mass(links, link, name, total))) {
        return false;
    }
    link->body = m->body_count;
    se3di_machine_body *body = se3di_machine_add_body(m, name);
    if (!body) {
        return false;
    }
    body->comment = link->comment;
    body->fixed = link->anchored;
    body->mass = link->mass.mass;
    memcpy(body->J, link->mass.J, sizeof body->J);
    body->frame = link->frame;
    se3di_frame_point(&link->frame, link->mass.centre, body->frame.r);
    if (link->anchored) {
        body->frame = link->frame;
        return true;
    }
    se3di_turn(link->frame.A, link->mass.centre, out);
    se3di_cross(link->w, out, cross);
    for (int k = 0; k < 3; ++k) {
        body->v[k] = link->v[k] + cross[k];
    }
    se3di_turn_back(body->frame.A, link->w, body->w);
    return true;
}

/* A marker for the link's frame, unless the body has the same. */
static bool put_origin(se3di_links *links, size_t k)
{
    se3di_machine *m = links->m;
    const se3di_link *link = &links->list[k];
    const size_t body = link->body;
    const se3di_frame in = se3di_frame_in(&se3di_machine_body_at(m, body)->frame, &link->frame);
    const bool merged = link->group != k;
    if (link->is_ground || (!merged && !(se3di_length(in.r) > 0.0))) {
        return true;
    }
    return se3di_machine_add_marker(m, body, merged ? link->name : "origin", &in) != NULL;
}

static bool put_parts(se3di_links *links, size_t k)
{
    se3di_machine *m = links->m;
    se3di_link *link = &links->list[k];
    link->body = links->list[se3di_links_leader(links, k)].body;
    const se3di_frame in =
        se3di_frame_in(&se3di_machine_body_at(m, link->body)->frame, &link->frame);
    if (!put_origin(links, k)) {
        return false;
    }
    for (const se3di_machine_marker *from = link->parts.markers; from; from = from->next) {
        const se3di_frame frame = se3di_frame_of(&in, &from->frame);
        if (!se3di_machine_add_marker(m, link->body, from->name, &frame)) {
            return false;
        }
    }
    for (const se3di_machine_shape *from = link->parts.shapes; from; from = from->next) {
        se3di_machine_shape *to = se3di_machine_add_shape(m, link->body);
        if (!to) {
            return false;
        }
        se3di_machine_shape *next = to->next;
        *to = *from;
        to->next = next;
        to->frame = se3di_frame_of(&in, &from->frame);
    }
    return true;
}

bool se3di_links_emit(se3di_links *links)
{
    se3di_links_merge(links);
    const double total = total_mass(links);
    for (size_t k = 0; k < links->count; ++k) {
        if (links->list[k].group == k && !make_body(links, &links->list[k], total)) {
            return false;
        }
    }
    for (size_t k = 0; k < links->count; ++k) {
        if (!put_parts(links, k)) {
            return false;
        }
    }
    return se3di_links_emit_joints(links) && links->m->status >= 0;
}
