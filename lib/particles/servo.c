/* SPDX-License-Identifier: BSD-3-Clause */
/* Servo walls. With the force F that presses the particles along the axis a, and what is wanted of
 * it, F0, in each step:
 *
 *     s' = gain (F0 - F), abs(s') <= speed_max,      s += h s',      gain = 1 / (20 K h + 2 C)
 *
 * K, C: stiffness and damping of all contacts that there can be before the lists are made anew,
 * under F0, and of bonds; forces answer a step late. A wall like that takes up what comes to it as
 * waves, and never gives more than F0 s'.                               docs/theory/servos.md */
#include "particles/servo.h"

#include "math/elementary.h"
#include "math/vec3.h"
#include "particles/share.h"

#include <math.h>
#include <string.h>

#define STEPS 20.0 /* in which springs would bring what is missing */
#define DAMPS 2.0  /* over the damping, with which a step answers the one before */

static int is_same(se3di_handle a, se3di_handle b)
{
    return a.index1 == b.index1 && a.generation == b.generation;
}

int32_t se3di_servos_find(const se3di_particles *set, se3di_handle shape)
{
    for (size_t k = 0; k < set->servo_count; ++k) {
        if (is_same(set->servos[k].shape, shape)) {
            return (int32_t)k + 1;
        }
    }
    return 0;
}

/* From where its body has it. */
static void displace(const se3di_servo *servo, se3di_wall *wall)
{
    se3di_copy(wall->home, wall->pose.x);
    se3di_copy(wall->home_v, wall->pose.v);
    se3di_add_scaled(servo->place, wall->slide, wall->pose.x);
    se3di_add_scaled(servo->speed, wall->slide, wall->pose.v);
}

void se3di_wall_place(const se3di_particles *set, se3di_wall *wall, const se3di_frame *frame)
{
    se3di_shape_place(&wall->shape, frame, &wall->pose);
    if (wall->servo > 0) {
        const se3di_servo *servo = &set->servos[wall->servo - 1];
        se3di_copy(wall->pose.x, wall->home);
        se3di_copy(wall->pose.v, wall->home_v);
        se3di_mul(frame->A, servo->axis, wall->slide);
        displace(servo, wall);
    }
}

se3d_status se3di_servos_aim(se3di_particles *set, const se3di_model *model, double h)
{
    for (size_t k = 0; k < set->servo_count; ++k) {
        se3di_servo *servo = &set->servos[k];
        double jet[3], t = set->time + 0.5 * h;
        if (servo->function.index1 != 0) {
            const uint32_t index = se3di_slots_find(&model->function_slots, servo->function.index1,
                                                    servo->function.generation);
            SE3DI_TRY(se3di_function_eval(&model->functions[index], &t, jet, NULL));
            servo->load = jet[0];
        }
    }
    return SE3D_OK;
}

double se3di_servo_force(const se3di_particles *set, const se3di_servo *servo)
{
    double force = 0.0;
    for (size_t k = 0; k < set->wall_count; ++k) {
        if (is_same(set->walls[k].handle, servo->shape)) {
            force -= se3di_dot(set->walls[k].force, set->walls[k].slide);
        }
    }
    return force;
}

double se3di_servo_wanted(const se3di_servo *servo)
{
    return servo->area > 0.0 ? servo->load * servo->area : servo->load;
}

/* Stiffness and damping of what presses a wall: its bonds and what may touch it. */
enum { BONDS_K, BONDS_C, HOOKE_K, HOOKE_C, HOOKE_RATE, HERTZ_K, HERTZ_C, HERTZ_RATE, TOTALS };

typedef struct totals {
    double sum[TOTALS];
    se3di_exact exact[TOTALS]; /* of a set that is spread, over all processes */
} totals;

static void add(const se3di_particles *set, int what, double value, totals *out)
{
    out->sum[what] += value;
    if (se3di_share_is_spread(set)) {
        se3di_exact_add(&out->exact[what], value);
    }
}

/* Once for all: each time all processes wait for each other. */
static void unite(const se3di_particles *set, totals *out)
{
    if (se3di_share_is_spread(set)) {
        se3di_share_add_exactly(set, TOTALS, out->exact);
        for (int k = 0; k < TOTALS; ++k) {
            out->sum[k] = se3di_exact_get(&out->exact[k]);
        }
    }
}

/* What is bonded to the wall, in whatever direction. */
static void add_bonds(const se3di_particles *set, const se3di_servo *servo, totals *out)
{
    for (size_t k = 0; k < set->bond_count; ++k) {
        const se3di_bond *bond = &set->bonds[k];
        const se3di_bond_end *end = &set->bond_ends[bond->end[1]];
        const uint32_t sphere = set->bond_ends[bond->end[0]].id;
        if (end->id == SE3DI_NO_INDEX && is_same(end->shape, servo->shape) &&
            !se3di_share_is_ghost(set, set->index_of[sphere])) {
            add(set, BONDS_K, fmax(bond->stiffness[0], bond->stiffness[1]), out);
            add(set, BONDS_C, fmax(bond->damping[0], bond->damping[1]), out);
        }
    }
}

/* All particles that are near. */
static void add_touches(const se3di_particles *set, const se3di_servo *servo, totals *out)
{
    for (size_t k = 0; set->list_valid && k < set->near_count; ++k) {
        const uint32_t i = set->near_walls[k].i & ~SE3DI_LIST_ACTIVE;
        const se3di_wall *wall = &set->walls[set->near_walls[k].wall];
        const se3di_particle *g = &set->particles[i];
        if (is_same(wall->handle, servo->shape) && !se3di_particle_is_fixed(g)) {
            const se3di_pair *pair =
                &set->pairs[set->spins[i].material * set->stuff_count + wall->material];
            const int hertz = se3di_pair_is_hertz(pair);
            const double root = hertz ? sqrt(g->radius) : 1.0;
            add(set, hertz ? HERTZ_K : HOOKE_K, pair->kn * root, out);
            add(set, hertz ? HERTZ_C : HOOKE_C, pair->dn * sqrt(root / g->inverse_mass), out);
            add(set, hertz ? HERTZ_RATE : HOOKE_RATE, pair->rn * root / g->inverse_mass, out);
        }
    }
}

/* How much the force grows with the speed in a step, if all these carry it. */
static double resistance(const se3di_particles *set, const se3di_servo *servo, double force,
                         double h)
{
    totals of = {{0.0}, {{{0.0}}}};
    add_bonds(set, servo, &of);
    add_touches(set, servo, &of);
    unite(set, &of);
    const double K = of.sum[HERTZ_K], C = of.sum[HERTZ_C], rate = of.sum[HERTZ_RATE];
    double sum = STEPS * h * of.sum[BONDS_K] + DAMPS * of.sum[BONDS_C];
    if (K > 0.0) { /* F = K d^(3/2), C d^(1/4), rate d^(1/2) */
        const double root = se3di_pow(force / K, 1.0 / 3.0);
        sum = sum + STEPS * h * 1.5 * K * root + DAMPS * (C * sqrt(root) + rate * root);
    }
    return sum + STEPS * h * of.sum[HOOKE_K] + DAMPS * (of.sum[HOOKE_C] + of.sum[HOOKE_RATE]);
}

static double choose_speed(const se3di_particles *set, const se3di_servo *servo, double h)
{
    const double force = se3di_servo_force(set, servo), wanted = se3di_servo_wanted(servo);
    const double missing = wanted - force;
    if (!(fabs(missing) > 0.0) || set->time + 1e-9 * fabs(set->time) < servo->start) {
        return 0.0;
    }
    double gain = servo->gain;
    if (!(gain > 0.0)) {
        const double most = fmax(fabs(wanted), fabs(force));
        gain = 1.0 / fmax(resistance(set, servo, most, fabs(h)), 1e-300);
    }
    return fmax(-servo->speed_max, fmin(servo->speed_max, gain * missing));
}

static int has_wall(const se3di_particles *set, const se3di_servo *servo)
{
    int has = 0;
    for (size_t k = 0; k < set->wall_count; ++k) {
        has = has || is_same(set->walls[k].handle, servo->shape);
    }
    return has;
}

void se3di_servos_rest(se3di_particles *set)
{
    for (size_t k = 0; k < set->servo_count; ++k) {
        se3di_servo *servo = &set->servos[k];
        servo->work += servo->half * se3di_servo_force(set, servo);
        servo->speed = servo->half = 0.0;
    }
}

void se3di_servos_drift(se3di_particles *set, double h)
{
    for (size_t k = 0; k < set->servo_count && se3di_share_total(set) > 0; ++k) {
        se3di_servo *servo = &set->servos[k];
        const double force = se3di_servo_force(set, servo);
        servo->work += servo->half * force;
        servo->speed = has_wall(set, servo) ? choose_speed(set, servo, h) : 0.0;
        servo->half = 0.5 * h * servo->speed;
        servo->work += servo->half * force;
        servo->place += h * servo->speed;
    }
    for (size_t k = 0; k < set->wall_count; ++k) {
        se3di_wall *wall = &set->walls[k];
        if (wall->servo > 0) {
            displace(&set->servos[wall->servo - 1], wall);
        }
    }
}
