/* SPDX-License-Identifier: BSD-3-Clause */
/* A periodic cell with sides l_a that strains: mean velocities are L (x - c), with the rates e_a on
 * the diagonal of L and the shear rate g at (flow, gradient). With u = v - L (x - c):
 *
 *     m v' = F + m (L' + L^2) (x - c),  so that  m u' = F - m L u
 *     l_a' = e_a l_a,   s' = e_flow s + g l_gradient          s: offset across the gradient
 *     V stress = sum f l + sum m u u,   work' = - V stress:L
 *
 * In steps: the cell goes by (1 + h L), as what drifts with the mean velocities does. Those of the
 * middle of the step, seen from its end, are M = L (1 + h L)^-1: the images move with them while
 * the forces are evaluated, M becomes L in the half kick that ends a step, and the next L in that
 * which begins the next one. So a lattice that moves with the cell stays one, to rounding, and
 * sum m u stays zero.
 *
 * Servos: e = gain (stress - wanted), abs(e) <= most; by default e = (stress - wanted + C e_before)
 * / (4 K h + C), as the stress answers to a rate in a step: with springs K h, dampers C.
 *                                                                         docs/theory/cells.md */
#include "particles/cell.h"

#include "math/elementary.h"
#include "math/larger.h"

#include <math.h>
#include <string.h>

#define STEPS 4.0 /* in which springs would bring what is missing */

static double length_of(const se3di_particles *set, int axis)
{
    return set->upper[axis] - set->lower[axis];
}

double se3di_domain_volume(const se3di_particles *set)
{
    return length_of(set, 0) * length_of(set, 1) * length_of(set, 2);
}

static se3di_domain_map difference(const se3di_domain_map *a, const se3di_domain_map *b)
{
    se3di_domain_map out = {.shear = a->shear - b->shear};
    for (int k = 0; k < 3; ++k) {
        out.along[k] = a->along[k] - b->along[k];
    }
    return out;
}

se3di_strain se3di_domain_images(const se3di_particles *set)
{
    const se3di_domain *cell = &set->cell;
    se3di_strain s;
    memset(&s, 0, sizeof s);
    if (cell->count == 0) {
        return s;
    }
    s.across[cell->gradient] = 1.0 / length_of(set, cell->gradient);
    s.column[cell->gradient] = length_of(set, cell->gradient);
    s.column[cell->flow] = cell->offset;
    se3di_domain_map_eval(cell, &cell->field, s.column, s.jump);
    for (int a = 0; a < 3; ++a) {
        s.length_up[a] = cell->field.along[a] * length_of(set, a);
    }
    return s;
}

void se3di_domain_come_home(const se3di_particles *set, double x[3], double v[3])
{
    const se3di_domain *cell = &set->cell;
    const int g = cell->gradient;
    double way[3] = {0.0, 0.0, 0.0}, more[3];
    const double across = floor((x[g] - set->lower[g]) / length_of(set, g));
    way[g] = across * length_of(set, g);
    way[cell->flow] = across * cell->offset;
    for (int a = 0; a < 3; ++a) {
        const double length = length_of(set, a);
        way[a] += a == g ? 0.0 : length * floor((x[a] - way[a] - set->lower[a]) / length);
    }
    se3di_domain_map_eval(cell, &cell->field, way, more);
    se3di_sub(x, way, x);
    se3di_sub(v, more, v);
}

/* A bound of how fast a length changes, over it: of the symmetric part of L. */
static double strain_rate(const se3di_domain_map *rates)
{
    double sum = 0.5 * rates->shear * rates->shear;
    for (int a = 0; a < 3; ++a) {
        sum += rates->along[a] * rates->along[a];
    }
    return sqrt(sum);
}

double se3di_domain_speed(const se3di_particles *set, const se3di_particle *particle)
{
    const se3di_domain *cell = &set->cell;
    double at[3], mean[3], u[3];
    se3di_domain_place(cell, particle->x, at);
    se3di_domain_map_eval(cell, &cell->field, at, mean);
    se3di_sub(particle->v, mean, u);
    return se3di_norm(u) + strain_rate(&cell->rates) * (particle->radius + 2.0 * set->skin);
}

double se3di_domain_shift(const se3di_particles *set, size_t k)
{
    const se3di_domain *cell = &set->cell;
    double now[3], then[3], led[3];
    se3di_domain_place(cell, set->particles[k].x, now);
    se3di_domain_place(cell, set->origin + 3 * k, then);
    se3di_domain_map_eval(cell, &cell->since, then, led);
    se3di_sub(now, led, now);
    return se3di_norm(now) +
           cell->strained * (set->particles[k].radius + se3di_particles_reach(set)[k]);
}

void se3di_domain_begin_list(se3di_particles *set)
{
    set->cell.since = (se3di_domain_map){{1.0, 1.0, 1.0}, 0.0};
    set->cell.strained = 0.0;
}

/* The sum force x branch + m u u, of which the volume times the stress is the symmetric part. */
static void get_sums(const se3di_domain *cell, double sums[9])
{
    static const int place[9] = {0, 3, 5, 3, 1, 4, 5, 4, 2};
    for (int k = 0; k < 9; ++k) {
        sums[k] = cell->virial[k] + cell->kinetic[place[k]];
    }
}

void se3di_domain_stress(const se3di_particles *set, double stress[6])
{
    static const int row[6] = {0, 1, 2, 0, 1, 0}, column[6] = {0, 1, 2, 1, 2, 2};
    const double volume = se3di_domain_volume(set);
    double sums[9];
    get_sums(&set->cell, sums);
    for (int k = 0; k < 6; ++k) {
        stress[k] = 0.5 * (sums[3 * row[k] + column[k]] + sums[3 * column[k] + row[k]]) / volume;
    }
}

/* Of half a step at the rates. */
static void add_work(se3di_domain *cell, double h)
{
    double sums[9];
    get_sums(cell, sums);
    double power = cell->rates.shear * sums[3 * cell->flow + cell->gradient];
    for (int a = 0; a < 3; ++a) {
        power += cell->rates.along[a] * sums[4 * a];
    }
    cell->work -= 0.5 * h * power;
}

se3di_domain_map se3di_domain_rest(const se3di_particles *set)
{
    return difference(&set->cell.rates, &set->cell.field);
}

void se3di_domain_close(se3di_particles *set, double h)
{
    set->cell.field = set->cell.rates;
    add_work(&set->cell, h);
}

static double clamp(double value, double most)
{
    return value < -most ? -most : value < most ? value : most; /* NaN becomes most */
}

/* The stage at a time, up to the last one that has begun. */
static void choose_stage(se3di_domain *cell, double time)
{
    const double early = 1e-9 * fabs(time);
    uint64_t next = cell->stage == SE3D_CELL_STAGES ? 0 : cell->stage + 1;
    while (next < cell->count && cell->stages[next].start <= time + early) {
        cell->stage = next++;
    }
}

/* The element of the stress that the shear works against. */
static double shear_stress(const se3di_domain *cell, const double stress[6])
{
    static const int place[4] = {0, 3, 5, 4}; /* xy, xz, yz by the sum of the axes */
    return stress[place[cell->flow + cell->gradient]];
}

/* So that the product of all 1 + h e is 1. */
static void keep_volume(const se3di_domain_stage *stage, double h, double rate[3])
{
    double product = 1.0;
    int free = 0;
    for (int a = 0; a < 3; ++a) {
        free += stage->volume[a] != 0;
        product *= stage->volume[a] ? 1.0 : 1.0 + h * rate[a];
    }
    for (int a = 0; a < 3 && h != 0.0; ++a) {
        if (stage->volume[a]) {
            rate[a] = ((free == 2 ? sqrt(1.0 / product) : 1.0 / product) - 1.0) / h;
        }
    }
}

/* What a stress answers to a rate of strain with in a step, over that [Pa s]; in sums times the
 * volume, or of a contact [N/m] and [N s/m]. */
typedef struct answer {
    double springs, dampers;
} answer;

/* The stiffest and the most damped of what a material's contacts of a law may be; held: of the kt
 * that are constant. */
typedef struct extremes {
    double kn, kt, dn, rn, held;
} extremes;

static extremes hardest(const se3di_particles *set, size_t material, int is_hertz)
{
    extremes out = {.kn = 0.0};
    for (size_t b = 0; b < set->stuff_count; ++b) {
        const se3di_pair *pair = &set->pairs[material * set->stuff_count + b];
        if (set->stuffs[b].held && se3di_pair_is_hertz(pair) == is_hertz) {
            out.kn = fmax(out.kn, pair->kn);
            out.kt = fmax(out.kt, pair->kt_constant ? 0.0 : pair->kt);
            out.held = fmax(out.held, pair->kt_constant ? pair->kt : 0.0);
            out.dn = fmax(out.dn, fmax(pair->dn, pair->dt));
            out.rn = fmax(out.rn, fmax(pair->rn, pair->rt));
        }
    }
    return out;
}

/* Stiffness and damping of a contact of two particles like this one that carry `load`. Of Hertz
 * s = (R* delta)^(1/2), where load = kn s delta. */
static answer contact_answer(const se3di_particles *set, const se3di_particle *particle,
                             double load, int is_hertz)
{
    const size_t material = set->spins[particle - set->particles].material;
    const extremes pair = hardest(set, material, is_hertz);
    double s = 1.0, normal = pair.kn;
    if (!(pair.kn > 0.0)) { /* a user-defined law, or no contact of this one */
        return (answer){0.0, 0.0};
    }
    if (is_hertz) {
        s = se3di_pow(0.5 * particle->radius * load / pair.kn, 1.0 / 3.0);
        normal *= 1.5;
    }
    const double damping = pair.dn * sqrt(0.5 * s / particle->inverse_mass);
    return (answer){fmax(s * fmax(normal, pair.kt), pair.held),
                    damping + pair.rn * 0.5 * s / particle->inverse_mass};
}

/* Contacts lie in all directions; each particle has as many, with others like it, and carries by
 * its area. */
static void add_contacts(const se3di_particles *set, double pressure, double h, answer *sum)
{
    const double contacts = set->cell.touching / (double)set->count;
    double size = 0.0;
    for (size_t k = 0; k < set->count; ++k) {
        const double R = set->particles[k].radius;
        size += R * R * R;
    }
    const double each = 1.5 * pressure * se3di_domain_volume(set) / (contacts * size);
    for (size_t k = 0; k < set->count; ++k) {
        const double area = set->particles[k].radius * set->particles[k].radius;
        const answer hooke = contact_answer(set, &set->particles[k], each * area, 0);
        const answer hertz = contact_answer(set, &set->particles[k], each * area, 1);
        sum->springs += 4.0 / 3.0 * area * contacts * h * fmax(hooke.springs, hertz.springs);
        sum->dampers += 4.0 / 3.0 * area * contacts * fmax(hooke.dampers, hertz.dampers);
    }
}

static answer cell_answer(const se3di_particles *set, const se3di_domain_stage *stage,
                          const double stress[6], double h)
{
    answer sum = {0.0, 0.0};
    double pressure = fabs(stress[0] + stress[1] + stress[2]) / 3.0;
    int asked = stage->shear_servo && !(stage->shear_gain > 0.0);
    pressure = asked ? fmax(pressure, fabs(stage->shear_stress)) : pressure;
    for (int a = 0; a < 3; ++a) {
        if (stage->servo[a] && !(stage->gain[a] > 0.0)) {
            pressure = fmax(pressure, fabs(stage->stress[a]));
            asked = 1;
        }
    }
    if (asked && set->cell.touching > 0.0 && set->count > 0) {
        add_contacts(set, pressure, fabs(h), &sum);
    }
    for (size_t k = 0; asked && k < set->bond_count; ++k) {
        const se3di_bond *bond = &set->bonds[k];
        const double part = bond->length * bond->length / 3.0;
        sum.springs += part * fabs(h) * fmax(bond->stiffness[0], bond->stiffness[1]);
        sum.dampers += part * fmax(bond->damping[0], bond->damping[1]);
    }
    const double volume = se3di_domain_volume(set);
    return (answer){sum.springs / volume, sum.dampers / volume};
}

/* The rate of a servo that is off by `excess`; to the rate before, the stress has answered. */
static double servo_rate(const answer *of, double excess, double wanted, double gain, double most,
                         double before)
{
    if (!(gain > 0.0) && of->springs > 0.0) {
        return clamp((excess + of->dampers * before) / (STEPS * of->springs + of->dampers), most);
    }
    return clamp((gain > 0.0 ? gain : most / fabs(wanted)) * excess, most);
}

se3di_domain_map se3di_domain_open(se3di_particles *set, double h)
{
    se3di_domain *cell = &set->cell;
    const se3di_domain_map before = cell->field;
    choose_stage(cell, set->time);
    if (cell->stage < SE3D_CELL_STAGES) {
        const se3di_domain_stage *stage = &cell->stages[cell->stage];
        double stress[6];
        se3di_domain_stress(set, stress);
        const answer of = cell_answer(set, stage, stress, h);
        cell->rates = stage->rates;
        for (int a = 0; a < 3; ++a) {
            if (stage->servo[a]) {
                const double excess = stress[a] - stage->stress[a];
                cell->rates.along[a] = servo_rate(&of, excess, stage->stress[a], stage->gain[a],
                                                  stage->most[a], before.along[a]);
            }
        }
        if (stage->shear_servo) {
            const double excess = shear_stress(cell, stress) - stage->shear_stress;
            cell->rates.shear = servo_rate(&of, excess, stage->shear_stress, stage->shear_gain,
                                           stage->shear_most, before.shear);
        }
        keep_volume(stage, h, cell->rates.along);
    }
    cell->field = cell->rates;
    add_work(cell, h);
    return difference(&cell->rates, &before);
}

/* By (1 + h L). */
static void step_map(const se3di_domain *cell, double h, se3di_domain_map *map)
{
    const se3di_domain_map *L = &cell->rates;
    map->shear =
        (1.0 + h * L->along[cell->flow]) * map->shear + h * L->shear * map->along[cell->gradient];
    for (int a = 0; a < 3; ++a) {
        map->along[a] *= 1.0 + h * L->along[a];
    }
}

void se3di_domain_drift(se3di_particles *set, double h)
{
    se3di_domain *cell = &set->cell;
    const se3di_domain_map *L = &cell->rates;
    se3di_domain_map sides = {.shear = cell->offset};
    for (int a = 0; a < 3; ++a) {
        sides.along[a] = length_of(set, a);
    }
    step_map(cell, h, &sides);
    step_map(cell, h, &cell->since);
    for (int a = 0; a < 3; ++a) {
        set->lower[a] = cell->centre[a] - 0.5 * sides.along[a];
        set->upper[a] = cell->centre[a] + 0.5 * sides.along[a];
        cell->field.along[a] = L->along[a] / (1.0 + h * L->along[a]);
    }
    const double period = length_of(set, cell->flow);
    cell->offset = sides.shear - period * floor(sides.shear / period + 0.5);
    cell->field.shear =
        L->shear / ((1.0 + h * L->along[cell->flow]) * (1.0 + h * L->along[cell->gradient]));
    cell->shear += h * L->shear;
    cell->strained += h * strain_rate(L);
}

void se3di_domain_move(se3di_particles *set, size_t begin, size_t end,
                       const se3di_particle_motion *motion, const se3di_domain_map *change,
                       se3di_domain_sums *sums)
{
    static const int row[6] = {0, 1, 2, 0, 1, 0}, column[6] = {0, 1, 2, 1, 2, 2};
    const se3di_domain *cell = &set->cell;
    const double half = 0.5 * motion->h, drift = motion->drift;
    const double *wear = se3di_particles_wear(set);
    const double strain = strain_rate(&cell->rates);
    for (size_t k = begin; k < end; ++k) {
        se3di_particle *particle = &set->particles[k];
        se3di_spin *spin = &set->spins[k];
        se3di_load *load = &set->loads[k];
        const double mobility = particle->inverse_mass;
        const double turn = 2.5 * mobility / (particle->radius * particle->radius);
        double at[3], more[3], mean[3], u[3];
        se3di_domain_place(cell, particle->x, at);
        se3di_domain_map_eval(cell, change, at, more);
        se3di_domain_map_eval(cell, &cell->rates, at, mean);
        for (int a = 0; a < 3; ++a) {
            particle->v[a] += half * (load->force[a] * mobility + set->gravity[a]) + more[a];
            spin->w[a] += half * (load->torque[a] * turn);
            u[a] = particle->v[a] - mean[a];
        }
        for (int c = 0; c < 6 && drift == 0.0; ++c) { /* of the end of a step */
            sums->kinetic[c] += u[row[c]] * u[column[c]] / mobility;
        }
        if (drift != 0.0) {
            const double speed = se3di_norm(u) + strain * (particle->radius + 2.0 * set->skin);
            sums->fastest = se3di_larger(sums->fastest, speed * speed);
            sums->hasty = se3di_larger(sums->hasty, speed * speed * wear[k]);
            se3di_add_scaled(drift, particle->v, particle->x);
            *load = (se3di_load){{0.0}, {0.0}};
        }
    }
}
