/* SPDX-License-Identifier: BSD-3-Clause */
/* The motion of clumps, in the step of the particles: half kicks by the sums over their spheres,
 * and between them a drift that is symplectic, reversible and keeps the angular momentum:
 *
 *     kick    v += h/2 (F/m + g),  L += h/2 A^T T          L in the principal axes
 *     drift   x += h v,  and turns about the principal axes by h L_k/I_k, one after the other:
 *             1 (h/2), 2 (h/2), 3 (h), 2 (h/2), 1 (h/2)
 *
 * (Dullweber, Leimkuhler and McLachlan, J. Chem. Phys. 107, 5840, 1997). A turn about axis k leaves
 * L_k, so that any function of it may stand for the angle: here its tangent is a polynomial.
 *                                                                         docs/theory/clumps.md */
#include "particles/clump.h"

#include "base/floats.h"
#include "math/larger.h"
#include "math/quaternion.h"

#include <math.h>

/* The other two axes. */
static const int second[3] = {1, 2, 0}, third[3] = {2, 0, 1};

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

/* Clumps that turn side by side: each operation waits for the one before, and those of one clump
 * leave the processor idle. */
#define LANES SE3DI_CLUMP_LANES

typedef struct top {
    double q[4][LANES], L[3][LANES];
    double by[LANES], inertia[3][LANES]; /* angle = by L / inertia */
} top;

/* Turn about principal axis k: q <- q (1, t e_k), not of unit length; L <- R^T L. */
static inline void turn(top *of, int k, double part)
{
    const int b = second[k], c = third[k];
    double *const q_0 = of->q[0], *const q_k = of->q[1 + k];
    double *const q_b = of->q[1 + b], *const q_c = of->q[1 + c];
    double *const L_k = of->L[k], *const L_b = of->L[b], *const L_c = of->L[c];
    for (int n = 0; n < LANES; ++n) {
        const double angle = part * of->by[n] * L_k[n] / of->inertia[k][n];
        const double u = 0.5 * angle, u2 = u * u;
        const double t = u * (1.0 + u2 * (1.0 / 3.0 + u2 * (2.0 / 15.0))); /* tan(angle/2) */
        const double scale = 1.0 / (1.0 + t * t);
        const double cosine = (1.0 - t * t) * scale, sine = 2.0 * t * scale;
        const double old_b = L_b[n], old_0 = q_0[n], turned_b = q_b[n];
        L_b[n] = cosine * old_b + sine * L_c[n];
        L_c[n] = cosine * L_c[n] - sine * old_b;
        q_0[n] -= t * q_k[n];
        q_k[n] += t * old_0;
        q_b[n] += t * q_c[n];
        q_c[n] -= t * turned_b;
    }
}

/* Clumps [0, count), at most LANES: lanes that are left over repeat the first. */
static void drift(const se3di_particles *set, se3di_clump *clumps, size_t count, double h)
{
    top of;
    for (size_t n = 0; n < LANES; ++n) {
        const se3di_clump *clump = &clumps[n < count ? n : 0];
        const se3di_clump_template *like = &set->templates[clump->template_index];
        of.by[n] = h / (clump->factor * clump->scale * clump->scale);
        for (int a = 0; a < 3; ++a) {
            of.L[a][n] = clump->spin[a];
            of.inertia[a][n] = like->inertia[a];
        }
        for (int a = 0; a < 4; ++a) {
            of.q[a][n] = clump->q[a];
        }
    }
    turn(&of, 0, 0.5);
    turn(&of, 1, 0.5);
    turn(&of, 2, 1.0);
    turn(&of, 1, 0.5);
    turn(&of, 0, 0.5);
    for (size_t n = 0; n < count; ++n) {
        se3di_clump *clump = &clumps[n];
        const double q[4] = {of.q[0][n], of.q[1][n], of.q[2][n], of.q[3][n]};
        se3di_add_scaled(h, clump->v, clump->x);
        for (int a = 0; a < 3; ++a) {
            clump->spin[a] = of.L[a][n];
        }
        (void)se3di_quat_normalize(q, clump->q);
        se3di_quat_to_matrix(clump->q, clump->A);
    }
}

static void kick(const se3di_particles *set, se3di_clump *clump,
                 const se3di_particle_motion *motion)
{
    const double half = 0.5 * motion->h, mobility = 1.0 / se3di_clump_mass(set, clump);
    double force[3], torque[3], turned[3];
    se3di_clump_loads(set, clump, force, torque);
    se3di_mul_transposed(clump->A, torque, turned);
    for (int a = 0; a < 3; ++a) {
        const double dv = half * (force[a] * mobility + set->gravity[a]);
        const double dL = half * turned[a];
        for (int n = 0; n < motion->kicks; ++n) {
            clump->v[a] += dv;
            clump->spin[a] += dL;
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

/* The image of x that is nearest to where the particle was: spheres of a clump may be on both sides
 * of a period. */
static void follow(const se3di_particles *set, const double before[3], double x[3])
{
    for (int a = 0; a < 3; ++a) {
        if (set->boundary[a] == SE3DI_BOUNDARY_PERIODIC) {
            const double length = set->upper[a] - set->lower[a];
            x[a] -= length * se3di_nearest((x[a] - before[a]) / length);
        }
    }
}

/* The spheres after a kick (drift 0) or a drift: how far each came is known exactly. */
static void carry(se3di_particles *set, const se3di_clump *clump, double drift, double *fastest,
                  double *hasty)
{
    const se3di_clump_template *of = &set->templates[clump->template_index];
    const double *wear = se3di_particles_wear(set);
    const double rate = drift != 0.0 ? 1.0 / (drift * drift) : 0.0;
    double w[3];
    get_turn_rate(set, clump, w);
    for (uint32_t k = 0; k < of->count; ++k) {
        const size_t index = set->index_of[clump->first + k];
        se3di_particle *particle = &set->particles[index];
        double x[3], way[3];
        place_ball(clump, &set->balls[of->begin + k], w, x, particle->v);
        se3di_copy(w, set->spins[index].w);
        if (drift == 0.0) {
            continue;
        }
        follow(set, particle->x, x);
        se3di_sub(x, particle->x, way);
        se3di_copy(x, particle->x);
        set->loads[index] = (se3di_load){{0.0}, {0.0}};
        const double v2 = se3di_dot(way, way) * rate, worn = v2 * wear[index];
        *fastest = se3di_larger(*fastest, v2);
        *hasty = se3di_larger(*hasty, worn);
    }
}

void se3di_clumps_move(se3di_particles *set, size_t begin, size_t end,
                       const se3di_particle_motion *motion, double *fastest, double *hasty)
{
    for (size_t first = begin; first < end; first += LANES) {
        const size_t count = end - first < LANES ? end - first : LANES;
        se3di_clump *clumps = set->clumps + first;
        for (size_t k = 0; k < count && motion->kicks > 0; ++k) {
            kick(set, &clumps[k], motion);
        }
        if (motion->drift != 0.0) {
            drift(set, clumps, count, motion->drift);
        }
        for (size_t k = 0; k < count; ++k) {
            carry(set, &clumps[k], motion->drift, fastest, hasty);
        }
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
