/* SPDX-License-Identifier: BSD-3-Clause */
/* What passes through planes in a step. The side of a centre is the sign of n.(x - p), computed
 * from the same bits at the end of a step and at the beginning of the next: so no passage is missed
 * and none counts twice. Sums are made in the order of the particles, by one thread: they do not
 * depend on the number of threads, nor on how a run is cut.           docs/theory/averages.md */
#include "particles/passage.h"

#include "math/vec3.h"
#include "particles/clump.h"
#include "particles/share.h"
#include "particles/wall.h"

#include <math.h>
#include <string.h>

#define SEAM 0.499 /* of a period away from the point: its other image may be as near */

/* From the point of the flow to the image of x that is nearest to it. A place in the period and its
 * image beyond a border, before it comes home, give the same bits. */
static void get_way(const se3di_particles *set, const se3di_flow *flow, const double x[3],
                    double d[3])
{
    se3di_copy(x, d);
    se3di_particles_come_home(set, d);
    se3di_sub(d, flow->point, d);
    se3di_particles_wrap(set, d);
}

static int is_in_front(const se3di_flow *flow, const double d[3])
{
    return se3di_dot(flow->normal, d) >= 0.0;
}

/* The planes in front of which x is, by bits. */
static uint32_t sides_of(const se3di_particles *set, const double x[3])
{
    uint32_t sides = 0;
    for (size_t f = 0; f < set->flow_count; ++f) {
        double d[3];
        get_way(set, &set->flows[f], x, d);
        sides |= (uint32_t)is_in_front(&set->flows[f], d) << f;
    }
    return sides;
}

void se3di_flows_mark(se3di_particles *set, size_t begin, size_t end)
{
    for (size_t k = begin; k < end; ++k) {
        set->key[k] = sides_of(set, set->particles[k].x);
    }
}

void se3di_flows_mark_clumps(se3di_particles *set, size_t begin, size_t end)
{
    for (size_t k = begin; k < end; ++k) {
        set->order[k] = sides_of(set, set->clumps[k].x);
    }
}

/* Whether the line that leads to d, from the point, with velocity v met the opening. */
static int is_within(const se3di_flow *flow, const double d[3], const double v[3])
{
    const double speed = se3di_dot(flow->normal, v);
    const double back = speed != 0.0 ? -se3di_dot(flow->normal, d) / speed : 0.0;
    double at[3];
    se3di_copy(d, at);
    se3di_add_scaled(back, v, at);
    if (flow->radius > 0.0) {
        return se3di_dot(at, at) <= flow->radius * flow->radius;
    }
    return !(flow->half[0] > 0.0) || (fabs(se3di_dot(at, flow->along)) <= flow->half[0] &&
                                      fabs(se3di_dot(at, flow->across)) <= flow->half[1]);
}

/* Something has moved to x with velocity v. */
typedef struct passer {
    const double *x, *v;
    double mass, drift;
    int32_t tag;
    uint32_t before; /* its sides */
    int spread;      /* others see to other passers */
} passer;

static void pass_flow(se3di_flow *flow, const passer *p, const double d[3], int forward)
{
    const double sign = forward ? 1.0 : -1.0;
    if ((flow->tag >= 0 && flow->tag != p->tag) || !is_within(flow, d, p->v)) {
        return;
    }
    if (p->spread) {
        flow->forward += (uint64_t)forward;
        flow->backward += (uint64_t)!forward;
        se3di_exact_add(&flow->seen[0], sign * p->mass);
        for (int a = 0; a < 3; ++a) {
            se3di_exact_add(&flow->seen[1 + a], sign * p->mass * p->v[a]);
        }
        return;
    }
    flow->total.forward += (uint64_t)forward;
    flow->total.backward += (uint64_t)!forward;
    flow->total.mass += sign * p->mass;
    se3di_add_scaled(sign * p->mass, p->v, flow->total.momentum);
}

/* Whether the ends of a drift to d may be nearest to the point in two images, with sides that
 * differ. */
static int meets_seam(const se3di_particles *set, const se3di_flow *flow, const passer *p,
                      const double d[3])
{
    int meets = 0;
    for (int a = 0; a < 3; ++a) {
        meets |= set->boundary[a] == SE3DI_BOUNDARY_PERIODIC && fabs(flow->normal[a]) > 0.0 &&
                 fabs(d[a]) + fabs(p->drift * p->v[a]) > SEAM * (set->upper[a] - set->lower[a]);
    }
    return meets;
}

/* Both ends of a drift to d as images of one period: that in which its middle is nearest. */
static void share_image(const se3di_particles *set, const passer *p, double begin[3], double d[3])
{
    double middle[3], there[3];
    for (int a = 0; a < 3; ++a) {
        middle[a] = there[a] = d[a] - 0.5 * p->drift * p->v[a];
    }
    se3di_particles_wrap(set, there);
    for (int a = 0; a < 3; ++a) {
        d[a] += there[a] - middle[a];
        begin[a] = d[a] - p->drift * p->v[a];
    }
}

static void pass_all(se3di_particles *set, const passer *p)
{
    for (size_t f = 0; f < set->flow_count; ++f) {
        se3di_flow *flow = &set->flows[f];
        double begin[3], d[3];
        int before = (int)(p->before >> f & 1u);
        get_way(set, flow, p->x, d);
        const int is_at_seam = meets_seam(set, flow, p, d);
        if (is_at_seam || is_in_front(flow, d) != before) {
            share_image(set, p, begin, d);
            before = is_at_seam ? is_in_front(flow, begin) : before;
            if (is_in_front(flow, d) != before) {
                pass_flow(flow, p, d, !before);
            }
        }
    }
}

void se3di_flows_count(se3di_particles *set, double drift)
{
    const int spread = se3di_share_is_spread(set);
    for (size_t k = 0; k < set->count; ++k) {
        const se3di_particle *g = &set->particles[k];
        const passer p = {
            g->x,        g->v,  se3di_particles_mass(set, k), drift, set->spins[k].tag,
            set->key[k], spread};
        if (!se3di_clump_find(set, k) && !se3di_share_is_ghost(set, k)) {
            pass_all(set, &p);
        }
    }
    for (size_t k = 0; k < se3di_share_clumps(set); ++k) {
        const se3di_clump *clump = &set->clumps[k];
        const size_t first = set->index_of[clump->first];
        const passer p = {
            clump->x,      clump->v, se3di_clump_mass(set, clump), drift, set->spins[first].tag,
            set->order[k], spread};
        pass_all(set, &p);
    }
}

/* What all processes have seen, with what had passed before the set was spread. */
static se3di_flow_sum total_of(const se3di_particles *set, const se3di_flow *flow)
{
    struct {
        se3di_exact seen[4];
        double counts[2];
    } all = {.counts = {(double)flow->forward, (double)flow->backward}};
    se3di_flow_sum total = flow->total;
    if (!se3di_share_is_spread(set)) {
        return total;
    }
    memcpy(all.seen, flow->seen, sizeof all.seen);
    se3di_share_add_exactly(set, 4, all.seen);
    set->share->add(set, 2, all.counts);
    total.forward += (uint64_t)all.counts[0];
    total.backward += (uint64_t)all.counts[1];
    total.mass += se3di_exact_get(&all.seen[0]);
    for (int a = 0; a < 3; ++a) {
        total.momentum[a] += se3di_exact_get(&all.seen[1 + a]);
    }
    return total;
}

void se3di_flows_unite(se3di_particles *set)
{
    for (size_t f = 0; f < set->flow_count; ++f) {
        se3di_flow *flow = &set->flows[f];
        flow->total = total_of(set, flow);
        flow->forward = flow->backward = 0;
        memset(flow->seen, 0, sizeof flow->seen);
    }
}

static se3di_flow_rates rates_between(const se3di_flow_sum *a, const se3di_flow_sum *b, double span)
{
    const double by = span > 0.0 ? 1.0 / span : 0.0;
    se3di_flow_rates rates = {
        .count = by * ((double)(b->forward - a->forward) - (double)(b->backward - a->backward)),
        .mass = by * (b->mass - a->mass)};
    for (int k = 0; k < 3; ++k) {
        rates.momentum[k] = by * (b->momentum[k] - a->momentum[k]);
    }
    return rates;
}

void se3di_flows_tick(se3di_particles *set)
{
    for (size_t f = 0; f < set->flow_count; ++f) {
        se3di_flow *flow = &set->flows[f];
        if (set->time - flow->begun >= flow->window * (1.0 - 1e-9)) {
            const se3di_flow_sum total = total_of(set, flow);
            flow->rates = rates_between(&flow->before, &total, set->time - flow->begun);
            flow->has_rates = 1;
            flow->before = total;
            flow->begun = set->time;
        }
    }
}

se3di_flow_rates se3di_flow_rates_since(const se3di_flow *flow, double time)
{
    return rates_between(&flow->before, &flow->total, time - flow->begun);
}
