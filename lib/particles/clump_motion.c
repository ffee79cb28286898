/* SPDX-License-Identifier: BSD-3-Clause */
/* What acts on a clump, its motion as others ask for it or set it, and what its spheres have of
 * that, one clump at a time. Steps are in clumps.inc.                    docs/theory/clumps.md */
#include "particles/clump.h"

#include "math/quaternion.h"

#include <math.h>

void se3di_clump_loads(const se3di_particles *set, const se3di_clump *clump, double force[3],
                       double torque[3])
{
    const se3di_clump_template *of = &set->templates[clump->template_index];
    for (int a = 0; a < 3; ++a) {
        force[a] = torque[a] = 0.0;
    }
    for (uint32_t k = 0; k < of->count; ++k) {
        const se3di_load *load = &set->loads[set->index_of[clump->first + k]];
        double lever[3], turned[3];
        se3di_mul(clump->A, set->balls[of->begin + k].r, lever);
        se3di_scale(clump->scale, lever, lever);
        se3di_cross(lever, load->force, turned);
        for (int a = 0; a < 3; ++a) {
            force[a] += load->force[a];
            torque[a] += load->torque[a] + turned[a];
        }
    }
}

static void get_turn_rate(const se3di_particles *set, const se3di_clump *clump, double w[3])
{
    const se3di_clump_template *of = &set->templates[clump->template_index];
    const double by = 1.0 / (clump->factor * clump->scale * clump->scale);
    double local[3];
    for (int a = 0; a < 3; ++a) {
        local[a] = by * clump->spin[a] / of->inertia[a];
    }
    se3di_mul(clump->A, local, w);
}

/* The place of a sphere now, and its velocity. */
static void place_ball(const se3di_clump *clump, const se3di_clump_ball *ball, const double w[3],
                       double x[3], double v[3])
{
    double lever[3], turned[3];
    se3di_mul(clump->A, ball->r, lever);
    se3di_scale(clump->scale, lever, lever);
    se3di_cross(w, lever, turned);
    se3di_add(clump->x, lever, x);
    se3di_add(clump->v, turned, v);
}

void se3di_clump_place(se3di_particles *set, const se3di_clump *clump, int poses)
{
    const se3di_clump_template *of = &set->templates[clump->template_index];
    double w[3];
    get_turn_rate(set, clump, w);
    for (uint32_t k = 0; k < of->count; ++k) {
        const size_t index = set->index_of[clump->first + k];
        se3di_particle *particle = &set->particles[index];
        double x[3];
        place_ball(clump, &set->balls[of->begin + k], w, x, particle->v);
        se3di_copy(poses ? x : particle->x, particle->x);
        se3di_copy(w, set->spins[index].w);
    }
}

double se3di_clump_mobility(const se3di_particles *set, uint32_t id, const double n[3],
                            double alone)
{
    const uint32_t index = id < set->id_count ? set->clump_of[id] : SE3DI_NO_INDEX;
    if (index == SE3DI_NO_INDEX) {
        return alone;
    }
    const se3di_clump *clump = &set->clumps[index];
    const se3di_clump_template *of = &set->templates[clump->template_index];
    const double *M = set->balls[of->begin + (id - clump->first)].mobility;
    double e[3];
    se3di_mul_transposed(clump->A, n, e);
    return (M[0] * e[0] * e[0] + M[1] * e[1] * e[1] + M[2] * e[2] * e[2] +
            2.0 * (M[3] * e[0] * e[1] + M[4] * e[1] * e[2] + M[5] * e[0] * e[2])) /
           clump->factor;
}

void se3di_clump_get(const se3di_particles *set, const se3di_clump *clump, double q[4], double w[3])
{
    const double *p = set->templates[clump->template_index].axes;
    const double back[4] = {p[0], -p[1], -p[2], -p[3]};
    se3di_quat_mul(clump->q, back, q);
    get_turn_rate(set, clump, w);
}

void se3di_clump_set(const se3di_particles *set, se3di_clump *clump, const double *q,
                     const double *w)
{
    const se3di_clump_template *of = &set->templates[clump->template_index];
    double rate[3], local[3];
    get_turn_rate(set, clump, rate);
    if (q) {
        double unit[4];
        (void)se3di_quat_normalize(q, unit);
        se3di_quat_mul(unit, of->axes, clump->q);
        se3di_quat_to_matrix(clump->q, clump->A);
    }
    se3di_mul_transposed(clump->A, w ? w : rate, local);
    for (int a = 0; a < 3; ++a) {
        clump->spin[a] = clump->factor * clump->scale * clump->scale * of->inertia[a] * local[a];
    }
}

void se3di_clump_energy(const se3di_particles *set, const se3di_clump *clump, double energy[2])
{
    const se3di_clump_template *of = &set->templates[clump->template_index];
    const double by = 0.5 / (clump->factor * clump->scale * clump->scale);
    energy[0] = 0.5 * se3di_clump_mass(set, clump) * se3di_dot(clump->v, clump->v);
    energy[1] = 0.0;
    for (int a = 0; a < 3; ++a) {
        energy[1] += by * clump->spin[a] * clump->spin[a] / of->inertia[a];
    }
}
