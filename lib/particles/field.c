/* SPDX-License-Identifier: BSD-3-Clause */
/* Coarse-grained fields (I. Goldhirsch, Granular Matter 12, 239, 2010) with Lucy's kernel of radius
 * c, at the middles r of the cells of volume V:
 *
 *     phi = (1 + 3 d/c)(1 - d/c)^3,  d = |r - x| < c,  over its sum over the cells
 *     rho = sum m phi/V,  u = sum m v phi / sum m phi,  kinetic stress = sum m v v phi/V - rho u u
 *     contact stress = sum f l /V integral of phi along the branch l, by SAMPLES points
 *
 * As phi has the sum 1 for everything inside, sums over the cells are what there is. Sums go by id,
 * and by the list of contacts.                                         docs/theory/averages.md */
#include "particles/field.h"

#include "base/floats.h"
#include "math/vec3.h"
#include "particles/average.h"
#include "particles/clump.h"
#include "particles/contacts.h"
#include "particles/energy.h"
#include "particles/wall.h"

#include <math.h>
#include <string.h>

#define SAMPLES 5
enum { CLOUD = 512, ROW = 32 }; /* cells at once */

typedef struct gridding {
    const se3di_particles *set;
    const se3d_field_grid *grid;
    double *values;
    double step[3];
    double volume;    /* of a cell */
    int32_t wraps[3]; /* the grid spans a period */
} gridding;

/* Cells along an axis within reach of x: [begin, end); more than there are if it wraps. */
typedef struct span {
    int64_t begin[3], end[3];
} span;

static int is_meant(const gridding *g, size_t k)
{
    return g->grid->tag < 0 || g->set->spins[k].tag == g->grid->tag;
}

/* The image of x that is nearest to the middle of the grid; returns whether it is inside. */
static int to_grid(const gridding *g, double x[3])
{
    double d[3], middle[3];
    int inside = 1;
    for (int a = 0; a < 3; ++a) {
        middle[a] = 0.5 * (g->grid->lower[a] + g->grid->upper[a]);
    }
    se3di_sub(x, middle, d);
    se3di_particles_wrap(g->set, d);
    se3di_add(middle, d, x);
    for (int a = 0; a < 3; ++a) {
        inside = inside && (g->wraps[a] || (x[a] >= g->grid->lower[a] && x[a] < g->grid->upper[a]));
    }
    return inside;
}

static span reach_of(const gridding *g, const double x[3])
{
    span s;
    for (int a = 0; a < 3; ++a) {
        const double at = (x[a] - g->grid->lower[a]) / g->step[a], c = g->grid->width / g->step[a];
        const int64_t n = g->grid->cells[a], own = (int64_t)floor(at);
        const double most = (double)n;
        s.begin[a] = (int64_t)ceil(at - fmin(c, most) - 0.5);
        s.end[a] = (int64_t)floor(at + fmin(c, most) - 0.5) + 1;
        s.begin[a] = s.begin[a] < own ? s.begin[a] : own;
        s.end[a] = s.end[a] > own + 1 ? s.end[a] : own + 1;
        if (!g->wraps[a]) {
            s.begin[a] = s.begin[a] < 0 ? 0 : s.begin[a] >= n ? n - 1 : s.begin[a];
            s.end[a] = s.end[a] > n ? n : s.end[a] <= s.begin[a] ? s.begin[a] + 1 : s.end[a];
        }
    }
    return s;
}

/* Cells in reach of a place, one after the other along x, y, z, with Lucy's kernel there, without
 * its factor. */
typedef struct cloud {
    size_t count;
    size_t cell[CLOUD];
    double phi[CLOUD];
    double sum; /* of the kernel over all of them, also those that there was no room for */
    int is_whole;
} cloud;

/* Amounts that are to be given to cells, from their number `first` on. */
typedef struct gift {
    const double *amounts;
    int first, count;
    double factor;
} gift;

/* The squares of the distances become kernels. */
static void weigh(const gridding *g, cloud *c)
{
    const double width = g->grid->width;
    for (size_t k = 0; k < c->count; ++k) {
        const double part = sqrt(c->phi[k]) / width, rest = 1.0 - part;
        c->phi[k] = rest > 0.0 ? (1.0 + 3.0 * part) * rest * rest * rest : 0.0;
    }
    for (size_t k = 0; k < c->count; ++k) {
        c->sum += c->phi[k];
    }
}

/* With a count that the compiler knows. */
static inline void add_parts(double *restrict values, const double *restrict amounts, int count,
                             double part)
{
    for (int n = 0; n < count; ++n) {
        values[n] += part * amounts[n];
    }
}

static void give(const gridding *g, const cloud *c, const gift *given)
{
    double *values = g->values + given->first;
    for (size_t k = 0; k < c->count; ++k) {
        double *of_cell = values + c->cell[k] * SE3D_FIELD_VALUES;
        const double part = c->phi[k] * given->factor;
        switch (given->count) {
        case SE3D_FIELD_VALUES - SE3D_FIELD_CONTACT_STRESS:
            add_parts(of_cell, given->amounts, SE3D_FIELD_VALUES - SE3D_FIELD_CONTACT_STRESS, part);
            break;
        case SE3D_FIELD_CONTACT_STRESS:
            add_parts(of_cell, given->amounts, SE3D_FIELD_CONTACT_STRESS, part);
            break;
        default:
            add_parts(of_cell, given->amounts, given->count, part);
            break;
        }
    }
}

/* There is no room for more cells. */
static void pass_on(const gridding *g, cloud *c, const gift *given)
{
    weigh(g, c);
    if (given) {
        give(g, c, given);
    }
    c->is_whole = 0;
    c->count = 0;
}

/* The square of the distance of x from the middle of a cell, along an axis. */
static double square_of(const gridding *g, const double x[3], int axis, int64_t cell)
{
    const double d = g->grid->lower[axis] + ((double)cell + 0.5) * g->step[axis] - x[axis];
    return d * d;
}

static size_t wrap_cell(const gridding *g, int axis, int64_t cell)
{
    const int64_t n = g->grid->cells[axis];
    return (size_t)(cell >= 0 && cell < n ? cell : (cell % n + n) % n);
}

/* The cells of a row from `begin` on, so many that there is room. */
static void add_row(const gridding *g, const double x[3], int64_t begin, int64_t end, size_t row,
                    const double squares[2], cloud *c)
{
    const double width = g->grid->width, reach = width * width;
    const double lower = g->grid->lower[0], step = g->step[0], at = x[0];
    const int is_inside = begin >= 0 && end <= g->grid->cells[0];
    double middle = (double)begin + 0.5;
    size_t count = c->count;
    for (int64_t k = begin; k < end; ++k) {
        const double d = lower + middle * step - at, square = d * d + squares[0] + squares[1];
        c->phi[count] = square;
        c->cell[count] = row + (is_inside ? (size_t)k : wrap_cell(g, 0, k));
        count += square < reach;
        middle += 1.0;
    }
    c->count = count;
}

/* The cells in reach of x and, if there are more than fit, give them the gift, if there is one. */
static void gather(const gridding *g, const double x[3], const gift *given, cloud *c)
{
    const span s = reach_of(g, x);
    const double reach = 1.0000001 * g->grid->width * g->grid->width;
    double squares[2];
    c->count = 0;
    c->sum = 0.0;
    c->is_whole = 1;
    for (int64_t z = s.begin[2]; z < s.end[2]; ++z) {
        squares[1] = square_of(g, x, 2, z);
        const size_t layer = wrap_cell(g, 2, z) * (size_t)g->grid->cells[1];
        for (int64_t y = s.begin[1]; y < s.end[1]; ++y) {
            squares[0] = square_of(g, x, 1, y);
            if (squares[0] + squares[1] > reach) {
                continue;
            }
            const size_t row = (layer + wrap_cell(g, 1, y)) * (size_t)g->grid->cells[0];
            for (int64_t k = s.begin[0]; k < s.end[0]; k += ROW) {
                if (c->count > CLOUD - ROW) {
                    pass_on(g, c, given);
                }
                const int64_t end = s.end[0] - k > ROW ? k + ROW : s.end[0];
                add_row(g, x, k, end, row, squares, c);
            }
        }
    }
    weigh(g, c);
}

/* The cell that x is in. */
static void choose_own(const gridding *g, const double x[3], cloud *c)
{
    size_t index = 0;
    for (int a = 2; a >= 0; --a) {
        const double k = floor((x[a] - g->grid->lower[a]) / g->step[a]);
        const int64_t own = (int64_t)fmin(k, g->grid->cells[a] - 1.0);
        index = index * (size_t)g->grid->cells[a] + wrap_cell(g, a, own);
    }
    c->cell[0] = index;
    c->phi[0] = c->sum = 1.0;
    c->count = 1;
    c->is_whole = 1;
}

/* Spread amounts at x over the cells, to their numbers from `first` on; all to the cell that x is
 * in if the kernel reaches no middle. */
static void spread(const gridding *g, const double x[3], int first, int count,
                   const double *amounts)
{
    cloud c;
    double at[3];
    se3di_copy(x, at);
    if (!to_grid(g, at)) {
        return;
    }
    gather(g, at, NULL, &c);
    if (!(c.sum > 1e-12)) {
        choose_own(g, at, &c);
    }
    const gift all = {amounts, first, count, 1.0 / (c.sum * g->volume)};
    if (!c.is_whole) {
        gather(g, at, &all, &c);
    }
    give(g, &c, &all);
}

/* Volume is where the sphere is, all else where the particle or clump is. */
static void add_motion(const gridding *g)
{
    size_t id = 0;
    for (size_t n = 0; n < g->set->count; ++n) {
        const size_t k = se3di_particles_next(g->set, &id);
        double mass, x[3], v[3], amounts[SE3D_FIELD_CONTACT_STRESS] = {0.0};
        if (!is_meant(g, k)) {
            continue;
        }
        amounts[SE3D_FIELD_SOLID_FRACTION] = se3di_particles_volume(g->set, k);
        const int is_whole = se3di_particles_whole(g->set, k, &mass, x, v);
        if (!is_whole || se3di_clump_find(g->set, k)) {
            spread(g, g->set->particles[k].x, SE3D_FIELD_SOLID_FRACTION, 1,
                   amounts + SE3D_FIELD_SOLID_FRACTION);
            amounts[SE3D_FIELD_SOLID_FRACTION] = 0.0;
        }
        if (is_whole) {
            const double p[3] = {mass * v[0], mass * v[1], mass * v[2]};
            amounts[SE3D_FIELD_DENSITY] = mass;
            se3di_copy(p, amounts + SE3D_FIELD_VELOCITY);
            for (int c = 0; c < 6; ++c) {
                amounts[SE3D_FIELD_KINETIC_STRESS + c] =
                    p[se3di_stress_row[c]] * v[se3di_stress_column[c]];
            }
            spread(g, x, 0, SE3D_FIELD_CONTACT_STRESS, amounts);
        }
    }
}

/* The place of a particle, or of its clump. */
static const double *centre_of(const se3di_particles *set, size_t k)
{
    const se3di_clump *clump = se3di_clump_find(set, k);
    return clump ? clump->x : set->particles[k].x;
}

static void add_contact(void *ctx, const se3d_particles_contact *contact)
{
    const gridding *g = ctx;
    const se3di_particles *set = g->set;
    const size_t i = set->index_of[contact->i];
    const int wall = contact->shape.index1 != 0;
    const size_t j = wall ? i : set->index_of[contact->j];
    const double *x = centre_of(set, i);
    double l[3], at[3], stress[6];
    if (!is_meant(g, i) && !is_meant(g, j)) {
        return;
    }
    se3di_sub(x, wall ? contact->point : centre_of(set, j), l);
    se3di_particles_wrap(set, l);
    for (int c = 0; c < 6; ++c) { /* of rolling moments it is not symmetric: the mean */
        stress[c] = 0.5 / SAMPLES *
                    (contact->force[se3di_stress_row[c]] * l[se3di_stress_column[c]] +
                     contact->force[se3di_stress_column[c]] * l[se3di_stress_row[c]]);
    }
    for (int k = 0; k < SAMPLES; ++k) {
        se3di_copy(x, at);
        se3di_add_scaled(-(k + 0.5) / SAMPLES, l, at);
        spread(g, at, SE3D_FIELD_CONTACT_STRESS, 6, stress);
    }
}

/* Sums become means. */
static void finish_cell(double *values)
{
    const double rho = values[SE3D_FIELD_DENSITY];
    double *u = values + SE3D_FIELD_VELOCITY, *kinetic = values + SE3D_FIELD_KINETIC_STRESS;
    if (!(rho > 0.0)) {
        return;
    }
    se3di_scale(1.0 / rho, u, u);
    for (int c = 0; c < 6; ++c) {
        kinetic[c] -= rho * u[se3di_stress_row[c]] * u[se3di_stress_column[c]];
        kinetic[c] = c < 3 && kinetic[c] < 0.0 ? 0.0 : kinetic[c]; /* rounding */
    }
    values[SE3D_FIELD_TEMPERATURE] = (kinetic[0] + kinetic[1] + kinetic[2]) / (3.0 * rho);
}

void se3di_particles_fields(const se3di_particles *set, const se3d_field_grid *grid, int contacts,
                            double *values)
{
    gridding g = {.set = set, .grid = grid, .values = values, .volume = 1.0};
    size_t count = 1;
    for (int a = 0; a < 3; ++a) {
        const double length = grid->upper[a] - grid->lower[a];
        const double period = set->upper[a] - set->lower[a];
        g.step[a] = length / grid->cells[a];
        g.volume *= g.step[a];
        g.wraps[a] =
            set->boundary[a] == SE3DI_BOUNDARY_PERIODIC && fabs(length - period) <= 1e-9 * period;
        count *= (size_t)grid->cells[a];
    }
    memset(values, 0, count * SE3D_FIELD_VALUES * sizeof *values);
    add_motion(&g);
    if (contacts) {
        se3di_particles_visit_contacts(set, add_contact, &g);
    }
    for (size_t k = 0; k < count; ++k) {
        finish_cell(values + k * SE3D_FIELD_VALUES);
    }
}
