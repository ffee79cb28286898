/* SPDX-License-Identifier: BSD-3-Clause */
/* Averages over a box of volume V:
 *
 *     solid fraction   sum of the parts of spheres in the box / V
 *     kinetic stress   1/V sum m (v - u)(v - u)
 *     contact stress   1/V sum f l s       l: the branch, from the centre of the one to that of the
 *                                          other (from the point of contact, at a wall), f: force
 *                                          on the other, s: the part of the branch in the box
 *
 * Sums go by id, and by the list of contacts.                          docs/theory/averages.md */
#include "particles/average.h"

#include "base/floats.h"
#include "math/vec3.h"
#include "particles/clump.h"
#include "particles/contacts.h"
#include "particles/energy.h"
#include "particles/wall.h"

#include <math.h>
#include <string.h>

#define PI 3.1415926535897932384626433832795

typedef struct averaging {
    const se3di_particles *set;
    const se3di_average_box *box;
    se3d_average *out;
    double volume, contacts; /* those that a particle in the box has */
} averaging;

static int is_meant(const averaging *a, size_t k)
{
    return a->box->tag < 0 || a->set->spins[k].tag == a->box->tag;
}

/* The image of x that is nearest to the middle of the box. */
static void to_box(const averaging *a, double x[3])
{
    double d[3], middle[3];
    for (int k = 0; k < 3; ++k) {
        middle[k] = 0.5 * (a->box->lower[k] + a->box->upper[k]);
    }
    se3di_sub(x, middle, d);
    se3di_particles_wrap(a->set, d);
    se3di_add(middle, d, x);
}

static int is_inside(const averaging *a, const double x[3])
{
    int inside = 1;
    for (int k = 0; k < 3; ++k) {
        inside = inside && x[k] >= a->box->lower[k] && x[k] < a->box->upper[k];
    }
    return inside;
}

/* The part of a sphere of radius 1 below the plane x = h. */
static double cap(double h)
{
    if (!(h > -1.0)) {
        return 0.0;
    }
    return h < 1.0 ? 0.25 * (2.0 - h) * (1.0 + h) * (1.0 + h) : 1.0;
}

/* The part of a sphere between two planes, with all of its images along a periodic axis. */
static double part_along(const averaging *a, double x, double radius, int axis)
{
    const double low = a->box->lower[axis], high = a->box->upper[axis];
    const double length = a->set->upper[axis] - a->set->lower[axis];
    const int images = a->set->boundary[axis] == SE3DI_BOUNDARY_PERIODIC ? 1 : 0;
    double part = 0.0;
    for (int k = -images; k <= images; ++k) {
        const double at = x + k * length;
        part += cap((high - at) / radius) - cap((low - at) / radius);
    }
    return part;
}

double se3di_particles_volume(const se3di_particles *set, size_t k)
{
    const double R = set->particles[k].radius, own = 4.0 / 3.0 * PI * R * R * R;
    const se3di_clump *clump = se3di_clump_find(set, k);
    if (!clump) {
        return own;
    }
    const se3di_clump_template *of = &set->templates[clump->template_index];
    const double scale = clump->scale * clump->scale * clump->scale;
    double all = 0.0;
    for (uint32_t n = 0; n < of->count; ++n) {
        const double r = set->balls[of->begin + n].radius;
        all += 4.0 / 3.0 * PI * r * r * r * scale;
    }
    return own * of->volume * scale / all;
}

static double solid_part(const averaging *a, size_t k)
{
    const se3di_particle *particle = &a->set->particles[k];
    double x[3], part = 1.0;
    se3di_copy(particle->x, x);
    to_box(a, x);
    for (int axis = 0; axis < 3; ++axis) {
        part *= part_along(a, x[axis], particle->radius, axis);
    }
    return part > 0.0 ? part * se3di_particles_volume(a->set, k) : 0.0;
}

int se3di_particles_whole(const se3di_particles *set, size_t k, double *mass, double x[3],
                          double v[3])
{
    const se3di_clump *clump = se3di_clump_find(set, k);
    if (clump && clump->first != set->spins[k].id) {
        return 0;
    }
    *mass = clump ? se3di_clump_mass(set, clump) : se3di_particles_mass(set, k);
    se3di_copy(clump ? clump->x : set->particles[k].x, x);
    se3di_copy(clump ? clump->v : set->particles[k].v, v);
    return 1;
}

/* Whether particle k, or its clump, is one of those that count; its mass and velocity. */
static int counts(const averaging *a, size_t k, double *mass, double v[3])
{
    double x[3];
    if (!is_meant(a, k) || !se3di_particles_whole(a->set, k, mass, x, v)) {
        return 0;
    }
    to_box(a, x);
    return is_inside(a, x);
}

static void add_motion(averaging *a)
{
    se3d_average *out = a->out;
    size_t id = 0;
    for (size_t n = 0; n < a->set->count; ++n) {
        const size_t k = se3di_particles_next(a->set, &id);
        double mass, v[3];
        if (is_meant(a, k)) {
            out->solid_fraction += solid_part(a, k) / a->volume;
        }
        if (counts(a, k, &mass, v)) {
            ++out->count;
            out->mass += mass;
            se3di_add_scaled(mass / a->volume, v, out->mass_flux);
        }
    }
    if (out->mass > 0.0) {
        se3di_scale(a->volume / out->mass, out->mass_flux, out->velocity);
    }
}

/* About the mean. */
static void add_fluctuation(averaging *a)
{
    se3d_average *out = a->out;
    size_t id = 0;
    for (size_t n = 0; n < a->set->count; ++n) {
        const size_t k = se3di_particles_next(a->set, &id);
        double mass, v[3];
        if (counts(a, k, &mass, v)) {
            se3di_sub(v, out->velocity, v);
            out->temperature += se3di_dot(v, v) / 3.0;
            for (int c = 0; c < 6; ++c) {
                out->kinetic_stress[c] +=
                    mass * v[se3di_stress_row[c]] * v[se3di_stress_column[c]] / a->volume;
            }
        }
    }
    out->temperature /= out->count > 0 ? (double)out->count : 1.0;
}

/* The part of the way from x to x + l that is in the box. */
static double part_of_branch(const averaging *a, const double x[3], const double l[3])
{
    double from = 0.0, to = 1.0;
    for (int k = 0; k < 3; ++k) {
        const double low = a->box->lower[k] - x[k], high = a->box->upper[k] - x[k];
        if (!(fabs(l[k]) > 0.0)) {
            to = low <= 0.0 && high > 0.0 ? to : from;
            continue;
        }
        from = fmax(from, fmin(low / l[k], high / l[k]));
        to = fmin(to, fmax(low / l[k], high / l[k]));
    }
    return to > from ? to - from : 0.0;
}

/* The whole of particle k: its centre, and whether it counts. */
static int get_centre(const averaging *a, size_t k, double x[3])
{
    const se3di_clump *clump = se3di_clump_find(a->set, k);
    double here[3];
    se3di_copy(clump ? clump->x : a->set->particles[k].x, x);
    se3di_copy(x, here);
    to_box(a, here);
    return is_meant(a, k) && is_inside(a, here);
}

/* The stress of a force on what is at the end of a branch; in a period, of all images of it. */
static void add_branch(averaging *a, const double x[3], const double l[3], const double force[3])
{
    int images[3];
    for (int k = 0; k < 3; ++k) {
        images[k] = a->set->boundary[k] == SE3DI_BOUNDARY_PERIODIC ? 1 : 0;
    }
    double part = 0.0;
    for (int n = 0; n < 27; ++n) {
        const int of[3] = {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
        double at[3];
        int is_one = 1;
        for (int k = 0; k < 3; ++k) {
            at[k] = x[k] + of[k] * (a->set->upper[k] - a->set->lower[k]);
            is_one = is_one && (of[k] == 0 || images[k]);
        }
        part += is_one ? part_of_branch(a, at, l) : 0.0;
    }
    for (int c = 0; c < 6; ++c) { /* of rolling moments it is not symmetric: the mean */
        a->out->contact_stress[c] += 0.5 * part *
                                     (force[se3di_stress_row[c]] * l[se3di_stress_column[c]] +
                                      force[se3di_stress_column[c]] * l[se3di_stress_row[c]]) /
                                     a->volume;
    }
}

static void add_contact(void *ctx, const se3d_particles_contact *contact)
{
    averaging *a = ctx;
    const se3di_particles *set = a->set;
    const size_t i = set->index_of[contact->i], j = set->index_of[contact->j];
    const int wall = contact->shape.index1 != 0;
    double x[3], from[3], l[3];
    int has = get_centre(a, i, x);
    const int meant = is_meant(a, i) || (!wall && is_meant(a, j));
    a->contacts += has;
    if (wall) {
        se3di_copy(contact->point, from);
    } else {
        has = get_centre(a, j, from);
        a->contacts += has;
    }
    se3di_sub(x, from, l);
    se3di_particles_wrap(set, l);
    se3di_sub(x, l, from);
    to_box(a, from);
    if (meant) {
        add_branch(a, from, l, contact->force);
    }
}

void se3di_particles_average(const se3di_particles *set, const se3di_average_box *box,
                             se3d_average *average)
{
    averaging a = {.set = set, .box = box, .out = average, .volume = 1.0};
    memset(average, 0, sizeof *average);
    for (int k = 0; k < 3; ++k) {
        a.volume *= box->upper[k] - box->lower[k];
    }
    add_motion(&a);
    add_fluctuation(&a);
    if (box->contacts) {
        se3di_particles_visit_contacts(set, add_contact, &a);
    }
    average->coordination = average->count > 0 ? a.contacts / (double)average->count : 0.0;
}
