/* SPDX-License-Identifier: BSD-3-Clause */
#include "integrator/gauss_lanes.h"

#include <math.h>
#include <string.h>

/* Numbers per stage besides those of the tree: K, Y, next, change; weights, gravity, parts,
 * verdict. */
static size_t count_numbers(size_t state, size_t stages)
{
    return 4 * state + stages + 3 + 4 + 1;
}

size_t se3di_gauss_work_count(const se3di_assembly *assembly)
{
    const size_t plain = se3di_explicit_work_count(assembly), bodies = assembly->body_count;
    if (assembly->formulation->id != SE3D_FORMULATION_JOINT) {
        return plain;
    }
    const size_t stages = SE3DI_GAUSS_MAX;
    return plain + SE3DI_LANES_ALIGN / sizeof(double) +
           stages * count_numbers(13 * bodies, stages) +
           se3di_lanes_room(bodies, 6 * bodies, bodies, stages);
}

/* Nothing acts but gravity that does not change, and nothing constrains but the tree. */
static int is_bare(const se3di_explicit *m)
{
    const se3di_model *model = m->assembly->model;
    int found = model->force_slots.count > 0 || model->shape_slots.count > 0;
    for (int c = 0; c < 3; ++c) {
        found |= model->gravity_function[c] >= 0;
    }
    return m->motion == &se3di_motion_joints && m->equations->is_open_tree && !found;
}

int se3di_gauss_lanes_init(se3di_gauss_lanes *g, se3di_explicit *m, const se3di_gauss_rule *rule)
{
    const se3di_lane_core *core = is_bare(m) ? se3di_lane_core_find(rule->stages) : NULL;
    if (!core) {
        return 0;
    }
    const se3di_tree *tree = m->equations->tree;
    const size_t w = (size_t)rule->stages, state = (size_t)tree->q_count + tree->v_count;
    double *at = m->step.integration->work + se3di_explicit_work_count(m->assembly);
    g->positions = tree->q_count;
    g->velocities = tree->v_count;
    g->K = se3di_lanes_align(at);
    g->Y = g->K + w * state;
    g->next = g->Y + w * state;
    g->change = g->next + w * state;
    g->weights = g->change + w * state;
    g->gravity = g->weights + w * w;
    g->parts = g->gravity + 3 * w;
    g->verdict = g->parts + 4 * w;
    se3di_lanes_lay_out(&g->lanes, tree, core, g->verdict + w);
    se3di_lanes_load(&g->lanes, g->gravity, 0);
    return 1;
}

void se3di_gauss_lanes_begin(se3di_gauss_lanes *g, const se3di_explicit *m,
                             const se3di_gauss_rule *rule, double h)
{
    const size_t w = (size_t)rule->stages, state = g->positions + g->velocities;
    for (size_t i = 0; i < w; ++i) {
        for (size_t c = 0; c < state; ++c) {
            g->K[c * w + i] = m->K[i * m->count + c];
        }
        for (size_t j = 0; j < w; ++j) {
            g->weights[j * w + i] = h * rule->A[i * w + j];
        }
        for (size_t c = 0; c < 3; ++c) {
            g->gravity[c * w + i] = m->assembly->model->gravity[c];
        }
    }
}

/* Rates of positions from velocities of the derivatives as they are; then the states. */
static void renew(const se3di_gauss_lanes *g, const double *y)
{
    const se3di_lane_core *core = g->lanes.core;
    const size_t state = g->positions + g->velocities, w = (size_t)core->width;
    core->combine(state, y, g->weights, g->K, g->Y);
    core->find_free_rates(&g->lanes, g->Y, g->Y + g->positions * w, g->K);
}

/* As one after the other: the root of the mean square. */
static double size_of(const se3di_gauss_lanes *g, const se3di_explicit *m,
                      const se3di_gauss_rule *rule)
{
    static const double none[SE3DI_STATE_WORK] = {0.0};
    const size_t w = (size_t)rule->stages;
    double sum = 0.0;
    for (size_t i = 0; i < w; ++i) {
        const double parts[4] = {g->parts[i], g->parts[w + i], g->parts[2 * w + i],
                                 g->parts[3 * w + i]};
        const double size = se3di_explicit_size_of(m, parts, none);
        sum += rule->b[i] * size * size;
    }
    return sqrt(sum);
}

static int is_finite(const se3di_gauss_lanes *g)
{
    const int w = g->lanes.core->width;
    int fine = 1;
    g->lanes.core->check(g->positions + g->velocities, g->next, g->verdict);
    for (int i = 0; i < w; ++i) {
        fine &= g->verdict[i] == 1.0;
    }
    return fine;
}

int se3di_gauss_lanes_sweep(se3di_gauss_lanes *g, se3di_explicit *m, const se3di_gauss_rule *rule,
                            double h, double *change)
{
    const se3di_lane_core *core = g->lanes.core;
    const size_t state = g->positions + g->velocities, at = g->positions * (size_t)core->width;
    renew(g, m->y1);
    core->combine(state, m->y1, g->weights, g->K, g->Y);
    core->normalise(&g->lanes, g->Y);
    core->place(&g->lanes, g->Y, g->Y + at);
    se3di_lanes_accelerate(&g->lanes, NULL, g->next + at);
    core->find_rates(&g->lanes, g->Y, g->Y + at, g->next);
    if (!is_finite(g)) {
        return 0;
    }
    core->replace(state, h, g->next, g->K, g->change);
    core->measure(&g->lanes, g->Y, g->change, g->parts);
    *change = size_of(g, m, rule);
    m->equations->counters.evaluations += (uint64_t)rule->stages;
    return 1;
}

void se3di_gauss_lanes_end(se3di_gauss_lanes *g, se3di_explicit *m)
{
    const size_t w = (size_t)g->lanes.core->width, state = g->positions + g->velocities;
    renew(g, m->y1);
    for (size_t i = 0; i < w; ++i) {
        double *to = m->K + i * m->count;
        for (size_t c = 0; c < state; ++c) {
            to[c] = g->K[c * w + i];
        }
        memset(to + state, 0, SE3DI_STATE_WORK * sizeof *to);
    }
}
