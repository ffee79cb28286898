/* SPDX-License-Identifier: BSD-3-Clause */
/* What bonds do. With the unit vector e and the length l from one centre to the other, the length L
 * without load, and the axes a, b, c of the bond as they are fixed in either end:
 *
 *     U = kn/2 (l - L)^2 + C1 (2 - e.a1 - e.a2) + C2 (1 - a1.a2)
 *         + kt/2 (1 + a1.a2 - b1.b2 - c1.c2),       C1 = ks L^2/2,  C2 = kb - ks L^2/4
 *     F2 = - kn (l - L) e + C1/l (1 - e e^T) (a1 + a2)
 *     T1 = C1 a1 x e + (C2 - kt) a1 x a2 + 2 kt p0 p
 *     T2 = C1 a2 x e - (C2 - kt) a1 x a2 - 2 kt p0 p
 *
 * so that T1 + T2 + l e x F2 = 0; (p0, p) are the Euler parameters of the turn that makes the axes
 * of the first end those of the second, so that a1 x a2 + b1 x b2 + c1 x c2 = 4 p0 p and a1.a2 +
 * b1.b2 + c1.c2 = 3 - 4 p.p. For small motions that is a beam: ks acts on what moves across at the
 * middle, kb on the bending, kt on the twist. Dampers act beside the four springs, on the motion of
 * half a step ago; what they turn to heat is their work over both half kicks. A bond that breaks
 * acts for the half kick that ends the step, so that the energy that it had is what it took.
 *                                                                        docs/theory/bonds.md */
#include "particles/bond.h"

#include "math/quaternion.h"
#include "particles/cell.h"
#include "particles/clump.h"
#include "particles/share.h"
#include "particles/slabs.h"
#include "particles/wall.h"

#include <math.h>
#include <string.h>

#define PI 3.1415926535897932384626433832795

/* An end as it is now. */
typedef struct end_state {
    double x[3], v[3], w[3];
    double q[4], a[3]; /* its turn, and the axis of the bond as it has it */
} end_state;

static void get_end(const se3di_particles *set, const se3di_bond *bond, int n, end_state *out)
{
    const se3di_bond_end *end = &set->bond_ends[bond->end[n]];
    se3di_bond_end_turn(set, end, out->q);
    se3di_quat_turn(out->q, bond->axis[n], out->a);
    if (end->id == SE3DI_NO_INDEX) {
        const se3di_shape_pose *pose = &set->walls[end->wall].pose;
        double lever[3], turned[3];
        se3di_mul(pose->R, end->point, out->x);
        se3di_add(pose->x, out->x, out->x);
        se3di_sub(out->x, pose->c, lever);
        se3di_cross(pose->w, lever, turned);
        se3di_add(pose->v, turned, out->v);
        se3di_copy(pose->w, out->w);
        return;
    }
    const size_t k = set->index_of[end->id];
    se3di_copy(set->particles[k].x, out->x);
    se3di_copy(set->particles[k].v, out->v);
    se3di_copy(set->spins[k].w, out->w);
}

/* 1 - a.b of unit vectors, without the loss of digits. */
static double apart(const double a[3], const double b[3])
{
    double d[3];
    se3di_sub(a, b, d);
    return 0.5 * se3di_dot(d, d);
}

/* Of what bends and twists; the energy. */
static double bend(const se3di_bond *bond, const end_state *one, const end_state *two,
                   const double e[3], double length, double force[3], double torque[2][3])
{
    const double *k = bond->stiffness, *a1 = one->a, *a2 = two->a;
    const double C1 = 0.5 * k[1] * bond->length * bond->length, C2 = k[2] - 0.5 * C1 - k[3];
    double sum[3], cross[3], back[4], p[4];
    se3di_quat_inverse(one->q, back);
    se3di_quat_mul(bond->turn, back, p);
    se3di_quat_mul(two->q, p, p);
    const double *u = p + 1, turn = 2.0 * k[3] * p[0];
    se3di_add(a1, a2, sum);
    se3di_cross(a1, a2, cross);
    se3di_cross(a1, e, torque[0]);
    se3di_cross(a2, e, torque[1]);
    const double along = se3di_dot(e, sum), shear = C1 / length;
    for (int n = 0; n < 3; ++n) {
        const double twist = C2 * cross[n] + turn * u[n];
        force[n] = shear * (sum[n] - along * e[n]);
        torque[0][n] = C1 * torque[0][n] + twist;
        torque[1][n] = C1 * torque[1][n] - twist;
    }
    return C1 * (apart(e, a1) + apart(e, a2)) + C2 * apart(a1, a2) + 2.0 * k[3] * se3di_dot(u, u);
}

/* The dampers, on the second end and both torques. */
static void brake(se3di_bond *bond, const end_state *one, const end_state *two, const double v[3],
                  const double e[3], double length)
{
    const double *c = bond->damping;
    double sum[3], turned[3], spin[3], across[3], lever[3];
    se3di_add(one->w, two->w, sum);
    se3di_sub(two->w, one->w, spin);
    se3di_cross(sum, e, turned);
    for (int a = 0; a < 3; ++a) {
        across[a] = v[a] - 0.5 * length * turned[a];
    }
    const double normal = se3di_dot(across, e), twist = se3di_dot(spin, e);
    se3di_add_scaled(-normal, e, across);
    se3di_cross(e, across, lever);
    for (int a = 0; a < 3; ++a) {
        const double moment = c[2] * (spin[a] - twist * e[a]) + c[3] * twist * e[a];
        const double shear = 0.5 * length * c[1] * lever[a];
        bond->drag[a] = -c[0] * normal * e[a] - c[1] * across[a];
        bond->brake[0][a] = shear + moment;
        bond->brake[1][a] = shear - moment;
    }
}

/* Half of what the dampers do in a step at these velocities. */
static double half_work(const se3di_bond *bond, const end_state *one, const end_state *two,
                        const double v[3], double h)
{
    return -0.5 * h *
           (se3di_dot(bond->drag, v) + se3di_dot(bond->brake[0], one->w) +
            se3di_dot(bond->brake[1], two->w));
}

/* What of it is across e. */
static double size_across(const double moment[3], const double e[3])
{
    double part[3];
    se3di_copy(moment, part);
    se3di_add_scaled(-se3di_dot(moment, e), e, part);
    return se3di_norm(part);
}

/* The bending moment of the worse end, or of the middle. */
static double find_moment(const se3di_bond_group *group, const se3di_bond *bond, const double e[3])
{
    double middle[3];
    if (group->middle) {
        se3di_sub(bond->torque[1], bond->torque[0], middle);
        return 0.5 * size_across(middle, e);
    }
    const double first = size_across(bond->torque[0], e), second = size_across(bond->torque[1], e);
    return first > second ? first : second;
}

/* Tension and shear of the outermost fibre. */
static void find_stress(const se3di_bond_group *group, se3di_bond *bond, const double e[3],
                        double tension, const double shear[3])
{
    const double most = find_moment(group, bond, e);
    const double twist = fabs(se3di_dot(bond->torque[1], e)), size = se3di_norm(shear);
    if (group->springs) {
        bond->stress[0] = tension / group->limits[0] + most / group->limits[2];
        bond->stress[1] = size / group->limits[1] + twist / group->limits[3];
        return;
    }
    const double r = bond->radius, area = PI * r * r;
    bond->stress[0] = tension / area + 4.0 * most / (area * r);
    bond->stress[1] = size / area + 2.0 * twist / (area * r);
}

/* What the stress makes of the bond. */
static se3di_bond_fate find_fate(const se3di_bond_group *group, const double stress[2])
{
    if (group->springs) {
        return stress[0] + stress[1] <= 1.0 ? SE3DI_BOND_HOLDS
               : stress[0] >= stress[1]     ? SE3DI_BOND_TORN
                                            : SE3DI_BOND_SHEARED;
    }
    if (group->tension > 0.0 && stress[0] > group->tension) {
        return SE3DI_BOND_TORN;
    }
    return group->shear > 0.0 && stress[1] > group->shear ? SE3DI_BOND_SHEARED : SE3DI_BOND_HOLDS;
}

/* What a bond with a smooth end has less, as a part of all that it does: s^4 of the share s. */
static double find_less(const se3di_bond_group *group, const se3di_bond *bond)
{
    const double share = bond->stress[0] + bond->stress[1];
    return !group->smooth || share < 0.0 ? 0.0 : share > 1.0 ? 1.0 : share * share * share * share;
}

/* The same of the energy U of the springs, if the load has grown in proportion: U s^4/3, as the
 * share is linear in it. What the way there makes of it is the work of the dampers. `held` of that
 * was so already. */
static void smooth(const se3di_bond_group *group, se3di_bond *bond, double held)
{
    const double less = find_less(group, bond), energy = bond->energy * less / 3.0;
    for (int a = 0; a < 3; ++a) {
        bond->drag[a] -= less * (bond->force[a] + bond->drag[a]);
        bond->brake[0][a] -= less * (bond->torque[0][a] + bond->brake[0][a]);
        bond->brake[1][a] -= less * (bond->torque[1][a] + bond->brake[1][a]);
    }
    bond->energy -= energy;
    bond->dissipated += energy - held;
}

static void evaluate(const se3di_particles *set, se3di_bond *bond, double h)
{
    const se3di_bond_group *group = &set->bond_groups[bond->group];
    end_state one, two;
    double d[3], v[3], e[3];
    get_end(set, bond, 0, &one);
    get_end(set, bond, 1, &two);
    se3di_sub(two.x, one.x, d);
    se3di_sub(two.v, one.v, v);
    se3di_particles_nearest(set, d, v);
    const double distance = se3di_norm(d), length = distance > 0.0 ? distance : 1e-300;
    const double less = find_less(group, bond), held = bond->energy * less / (3.0 - less);
    bond->span = length;
    se3di_scale(1.0 / length, d, e);
    se3di_add(one.x, d, bond->place);
    bond->dissipated += half_work(bond, &one, &two, v, h); /* of the last step's second half */
    bond->energy = bend(bond, &one, &two, e, length, bond->force, bond->torque);
    const double stretch = length - bond->length, tension = bond->stiffness[0] * stretch;
    bond->energy += 0.5 * tension * stretch;
    find_stress(group, bond, e, tension, bond->force);
    if (h > 0.0) {
        bond->fate = (int32_t)find_fate(group, bond->stress);
    }
    se3di_add_scaled(-tension, e, bond->force);
    brake(bond, &one, &two, v, e, length);
    if (group->smooth) {
        smooth(group, bond, held);
    }
    bond->dissipated += half_work(bond, &one, &two, v, h);
    const double part = bond->fate == SE3DI_BOND_HOLDS ? 1.0 : 0.5;
    for (int a = 0; a < 3; ++a) {
        bond->force[a] = part * (bond->force[a] + bond->drag[a]);
        bond->torque[0][a] = part * (bond->torque[0][a] + bond->brake[0][a]);
        bond->torque[1][a] = part * (bond->torque[1][a] + bond->brake[1][a]);
    }
}

/* What a bond does to the sphere at its end n. */
static void load_by(se3di_particles *set, const se3di_bond_end *end, const se3di_bond *bond, int n)
{
    se3di_load *load = &set->loads[set->index_of[end->id]];
    se3di_add_scaled(n > 0 ? 1.0 : -1.0, bond->force, load->force);
    se3di_add(load->torque, bond->torque[n], load->torque);
}

/* All that its bonds do to a sphere, in the order in which they were made. */
static void load_end(se3di_particles *set, const se3di_bond_end *end)
{
    for (uint32_t k = end->begin; end->id != SE3DI_NO_INDEX && k < end->begin + end->count; ++k) {
        const uint32_t place = set->bond_places[k];
        load_by(set, end, &set->bonds[place / 2], (int)(place % 2));
    }
}

static void turn(const se3di_particles *set, se3di_bond_end *end, double h)
{
    if (end->id == SE3DI_NO_INDEX) {
        return;
    }
    if (se3di_share_is_ghost(set, set->index_of[end->id])) {
        return; /* its owner tells */
    }
    const double *w = set->spins[set->index_of[end->id]].w;
    const double u2 = 0.25 * h * h * se3di_dot(w, w);
    const double t = 0.5 * h * (1.0 + u2 * (1.0 / 3.0 + u2 * (2.0 / 15.0))); /* of tan(h w/2)/w */
    const double by[4] = {1.0, t * w[0], t * w[1], t * w[2]};
    double q[4];
    se3di_quat_mul(by, end->q, q);
    (void)se3di_quat_normalize(q, end->q);
}

static void evaluate_range(se3di_particles *set, size_t begin, size_t end, double h)
{
    for (size_t k = begin; k < end; ++k) {
        evaluate(set, &set->bonds[k], h);
    }
}

/* The same sums, of one thread: no sphere waits for all of its bonds. */
static void evaluate_loading(se3di_particles *set, size_t begin, size_t end, double h)
{
    for (size_t k = begin; k < end; ++k) {
        se3di_bond *bond = &set->bonds[k];
        evaluate(set, bond, h);
        for (int n = 0; n < 2; ++n) {
            const se3di_bond_end *at = &set->bond_ends[bond->end[n]];
            if (at->id != SE3DI_NO_INDEX) {
                load_by(set, at, bond, n);
            }
        }
    }
}

static void load_range(se3di_particles *set, size_t begin, size_t end, double h)
{
    (void)h;
    for (size_t k = begin; k < end; ++k) {
        load_end(set, &set->bond_ends[k]);
    }
}

static void turn_range(se3di_particles *set, size_t begin, size_t end, double h)
{
    for (size_t k = begin; k < end; ++k) {
        turn(set, &set->bond_ends[k], h);
    }
}

/* Force x branch, as that of contacts: of the first end, along the way from the second to it. */
static void add_virial(se3di_particles *set)
{
    for (size_t k = 0; k < set->bond_count; ++k) {
        const se3di_bond *bond = &set->bonds[k];
        const uint32_t i = set->index_of[set->bond_ends[bond->end[0]].id];
        const uint32_t j = set->index_of[set->bond_ends[bond->end[1]].id];
        double d[3];
        se3di_sub(set->particles[i].x, set->particles[j].x, d);
        se3di_particles_wrap(set, d);
        for (int n = 0; n < 9; ++n) {
            set->cell.virial[n] -= bond->force[n / 3] * d[n % 3];
        }
    }
}

void se3di_bonds_forces(se3di_particles *set, double h)
{
    if (set->bond_count == 0) {
        return;
    }
    if (se3di_particles_team(set) == 1) {
        se3di_particles_each_range(set, set->bond_count, evaluate_loading, h);
    } else {
        se3di_particles_each_range(set, set->bond_count, evaluate_range, h);
        se3di_particles_each_range(set, set->bond_end_count, load_range, h);
    }
    if (se3di_domain_strains(set)) {
        add_virial(set);
    }
}

static void push_wall(se3di_particles *set, const se3di_bond_end *end, const se3di_bond *bond)
{
    se3di_wall *wall = &set->walls[end->wall];
    double lever[3], moment[3];
    se3di_mul(wall->pose.R, end->point, lever);
    se3di_add(lever, wall->pose.x, lever);
    se3di_sub(lever, wall->pose.c, lever);
    se3di_cross(lever, bond->force, moment);
    if (se3di_share_is_spread(set)) {
        se3di_add(moment, bond->torque[1], moment);
        se3di_share_add_to_wall(set, end->wall, bond->force, moment);
        return;
    }
    se3di_add(wall->force, bond->force, wall->force);
    se3di_add(wall->torque, moment, wall->torque);
    se3di_add(wall->torque, bond->torque[1], wall->torque);
}

/* Each by one process: that of the sphere, which is always the first end. Ends on walls, of one
 * bond each, are in the order of their bonds. */
void se3di_bonds_push_walls(se3di_particles *set)
{
    for (size_t k = 0; k < set->bond_end_count; ++k) {
        const se3di_bond_end *end = &set->bond_ends[k];
        for (uint32_t n = 0; end->id == SE3DI_NO_INDEX && n < end->count; ++n) {
            const se3di_bond *bond = &set->bonds[set->bond_places[end->begin + n] / 2];
            if (!se3di_share_is_ghost(set, set->index_of[set->bond_ends[bond->end[0]].id])) {
                push_wall(set, end, bond);
            }
        }
    }
}

void se3di_bonds_finish(se3di_particles *set)
{
    int broken = 0;
    for (size_t k = 0; k < set->bond_count; ++k) {
        broken = broken || set->bonds[k].fate != SE3DI_BOND_HOLDS;
    }
    if (broken) {
        se3di_bonds_keep(set);
        (void)se3di_bonds_index(set);
    }
}

void se3di_bonds_turn(se3di_particles *set, double h)
{
    if (set->bond_end_count > 0) {
        se3di_particles_each_range(set, set->bond_end_count, turn_range, h);
    }
}

void se3di_bond_end_mass(const se3di_particles *set, const se3di_bond_end *end, double *mass,
                         double *inertia)
{
    *mass = *inertia = 0.0;
    if (end->id == SE3DI_NO_INDEX ||
        se3di_particle_is_fixed(&set->particles[set->index_of[end->id]])) {
        return;
    }
    const size_t k = set->index_of[end->id];
    const se3di_clump *clump = se3di_clump_find(set, k);
    const double radius = set->particles[k].radius;
    *mass = 1.0 / set->particles[k].inverse_mass;
    *inertia = 0.4 * *mass * radius * radius;
    if (clump) {
        const double *J = set->templates[clump->template_index].inertia;
        *mass = se3di_clump_mass(set, clump);
        *inertia = clump->factor * clump->scale * clump->scale * fmin(J[0], fmin(J[1], J[2]));
    }
}

/* Of two masses; one that is 0 does not move. */
static double reduce(double a, double b)
{
    return a > 0.0 && b > 0.0 ? a * b / (a + b) : a + b;
}

void se3di_bond_damp(const se3di_particles *set, se3di_bond *bond)
{
    const se3di_bond_group *group = &set->bond_groups[bond->group];
    double mass[2], inertia[2];
    for (int n = 0; n < 2; ++n) {
        se3di_bond_end_mass(set, &set->bond_ends[bond->end[n]], &mass[n], &inertia[n]);
    }
    for (int k = 0; k < 4; ++k) {
        const double m = k < 2 ? reduce(mass[0], mass[1]) : reduce(inertia[0], inertia[1]);
        bond->damping[k] = group->dampers[k] + 2.0 * group->damping * sqrt(bond->stiffness[k] * m);
    }
}

void se3di_bonds_damp(se3di_particles *set, uint32_t id)
{
    const uint32_t own = id < set->bond_end_of_capacity ? set->bond_end_of[id] : SE3DI_NO_INDEX;
    for (uint32_t k = 0; own != SE3DI_NO_INDEX && k < set->bond_ends[own].count; ++k) {
        se3di_bond_damp(set, &set->bonds[set->bond_places[set->bond_ends[own].begin + k] / 2]);
    }
}

/* As se3di_bond_end_mass, but of one sphere's part of its clump where it moves most easily. */
static void least_mass(const se3di_particles *set, const se3di_bond_end *end, double *mass,
                       double *inertia)
{
    se3di_bond_end_mass(set, end, mass, inertia);
    const se3di_clump *clump = *mass > 0.0 ? se3di_clump_find(set, set->index_of[end->id]) : NULL;
    if (clump) {
        const se3di_clump_template *of = &set->templates[clump->template_index];
        *mass = clump->factor / (of->most * of->count);
        *inertia /= of->count;
    }
}

/* By Rayleigh's quotient no frequency is above the largest of the sums over the bonds of one sphere
 * of 2 max(kn, 2 ks)/m and (ks L^2 + 2 max(kb, kt))/J. Dampers that are given for themselves count
 * as the springs that they would be critical for. Of a clump all spheres count as if they were
 * bonded like this one. */
double se3di_bonds_step(const se3di_particles *set)
{
    double most = 0.0;
    for (size_t k = 0; k < set->bond_end_count; ++k) {
        const se3di_bond_end *end = &set->bond_ends[k];
        double mass, inertia, shift = 0.0, turns = 0.0, slows[2] = {0.0, 0.0};
        least_mass(set, end, &mass, &inertia);
        for (uint32_t n = 0; mass > 0.0 && n < end->count; ++n) {
            const se3di_bond *bond = &set->bonds[set->bond_places[end->begin + n] / 2];
            const double *s = bond->stiffness;
            shift += 2.0 * fmax(s[0], 2.0 * s[1]);
            turns += s[1] * bond->length * bond->length + 2.0 * fmax(s[2], s[3]);
            if (set->bond_groups[bond->group].springs) {
                const double *c = bond->damping;
                slows[0] += fmax(c[0], 2.0 * c[1]);
                slows[1] += 0.5 * c[1] * bond->length * bond->length + fmax(c[2], c[3]);
            }
        }
        if (mass > 0.0) {
            const double rate = fmax(slows[0] / mass, slows[1] / inertia);
            most = fmax(most, fmax(fmax(shift / mass, turns / inertia), rate * rate));
        }
    }
    return most > 0.0 ? 2.0 / (SE3DI_BONDS_STABLE * sqrt(most)) : HUGE_VAL;
}
