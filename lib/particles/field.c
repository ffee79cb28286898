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

/* Lucy's kernel without its factor, at the middle of a cell. */
static double kernel(const gridding *g, const double x[3], const int64_t cell[3])
{
    double square = 0.0;
    for (int a = 0; a < 3; ++a) {
        const double d = g->grid->lower[a] + ((double)cell[a] + 0.5) * g->step[a] - x[a];
        square += d * d;
    }
    const double part = sqrt(square) / g->grid->width, rest = 1.0 - part;
    return rest > 0.0 ? (1.0 + 3.0 * part) * rest * rest * rest : 0.0;
}

static double *cell_of(const gridding *g, const int64_t cell[3])
{
    size_t index = 0;
    for (int a = 2; a >= 0; --a) {
        const int64_t n = g->grid->cells[a], k = (cell[a] % n + n) % n;
        index = index * (size_t)n + (size_t)k;
    }
    return g->values + index * SE3D_FIELD_VALUES;
}

/* The sum of the kernel over the cells (amounts NULL), or give each its part of the amounts. */
static double visit(const gridding *g, const double x[3], double factor, const double *amounts,
                    int first, int count)
{
    const span s = reach_of(g, x);
    double sum = 0.0;
    int64_t cell[3];
    for (cell[2] = s.begin[2]; cell[2] < s.end[2]; ++cell[2]) {
        for (cell[1] = s.begin[1]; cell[1] < s.end[1]; ++cell[1]) {
            for (cell[0] = s.begin[0]; cell[0] < s.end[0]; ++cell[0]) {
                const double phi = kernel(g, x, cell);
                double *values = cell_of(g, cell) + first;
                sum += phi;
                for (int k = 0; amounts && k < count; ++k) {
                    values[k] += phi * factor * amounts[k];
                }
            }
        }
    }
    return sum;
}

/* Spread amounts at x over the cells, to their numbers from `first` on; all to the cell that x is
 * in if the kernel reaches no middle. */
static void spread(const gridding *g, const double x[3], int first, int count,
                   const double *amounts)
{
    double at[3];
    se3di_copy(x, at);
    if (!to_grid(g, at)) {
        return;
    }
    const double sum = visit(g, at, 0.0, NULL, 0, 0);
    if (sum > 1e-12) {
        (void)visit(g, at, 1.0 / (sum * g->volume), amounts, first, count);
        return;
    }
    int64_t cell[3];
    for (int a = 0; a < 3; ++a) {
        const double k = floor((at[a] - g->grid->lower[a]) / g->step[a]);
        cell[a] = (int64_t)fmin(k, g->grid->cells[a] - 1.0);
    }
    double *values = cell_of(g, cell) + first;
    for (int k = 0; k < count; ++k) {
        values[k] += amounts[k] / g->volume;
    }
}

static void add_motion(const gridding *g)
{
    size_t id = 0;
    for (size_t n = 0; n < g->set->count; ++n) {
        const size_t k = se3di_particles_next(g->set, &id);
        double mass, x[3], v[3];
        if (!is_meant(g, k)) {
            continue;
        }
        const double volume = se3di_particles_volume(g->set, k);
        spread(g, g->set->particles[k].x, SE3D_FIELD_SOLID_FRACTION, 1, &volume);
        if (se3di_particles_whole(g->set, k, &mass, x, v)) {
            const double p[3] = {mass * v[0], mass * v[1], mass * v[2]};
            double flux[6];
            for (int c = 0; c < 6; ++c) {
                flux[c] = p[se3di_stress_row[c]] * v[se3di_stress_column[c]];
            }
            spread(g, x, SE3D_FIELD_DENSITY, 1, &mass);
            spread(g, x, SE3D_FIELD_VELOCITY, 3, p);
            spread(g, x, SE3D_FIELD_KINETIC_STRESS, 6, flux);
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
