/* SPDX-License-Identifier: BSD-3-Clause */
#include "integrator/gauss_lanes.h"

#include <math.h>
#include <string.h>

/* Work for what finds the rest of it. */
#define OWN      ((sizeof(se3di_gauss_lanes) + sizeof(double) - 1) / sizeof(double))
#define ROUNDING 3e-16
#define LEAST    1e-4  /* pivot of single states, of a usual one */
#define NEAREST  1e-4  /* the least part of it, */
#define FARTHEST 100.0 /* and the largest */

/* Numbers per stage besides those of the tree: K, and those of a group. */
static size_t count_numbers(size_t state, size_t stages)
{
    return 5 * state + 3 * stages + SE3DI_GAUSS_FORMS + 3 + 1 + 1 + 4;
}

size_t se3di_gauss_work_count(const se3di_assembly *assembly)
{
    const size_t plain = se3di_explicit_work_count(assembly), bodies = assembly->body_count;
    if (assembly->formulation->id != SE3D_FORMULATION_JOINT) {
        return plain;
    }
    const size_t stages = SE3DI_GAUSS_MAX;
    return plain + OWN + SE3DI_LANES_ALIGN / sizeof(double) +
           stages * count_numbers(13 * bodies, stages) +
           se3di_lanes_room(bodies, 6 * bodies, bodies, stages);
}

/* ---- what can be done so ---- */

/* Nothing acts but gravity. */
static int is_bare(const se3di_model *model)
{
    return model->force_slots.count == 0 && model->shape_slots.count == 0;
}

int se3di_gauss_lanes_suit_loops(const se3di_equations *equations)
{
    return equations->lanes.rows.count > 0 && is_bare(equations->assembly.model) &&
           equations->tree->given_count == 0 && equations->assembly.timed_count == 0 &&
           equations->assembly.user_count == 0 && equations->friction.count == 0 &&
           equations->tree->foreign_armature < 0 &&
           se3di_tree_loops_need_links_only(&equations->loops) &&
           se3di_loop_system_is_regular(&equations->loops.system);
}

int se3di_gauss_lanes_take_loops(const se3di_explicit *m)
{
    return m->motion == &se3di_motion_joints && !se3di_model_gravity_varies(m->assembly->model) &&
           se3di_gauss_lanes_suit_loops(m->equations);
}

/* Open, and moved by nothing but gravity, of which the stages share one. */
static int is_bare_tree(const se3di_explicit *m)
{
    return m->motion == &se3di_motion_joints && m->equations->is_open_tree &&
           se3di_gauss_lanes_suit_model(m->assembly->model);
}

int se3di_gauss_lanes_suit(const se3di_explicit *m)
{
    return is_bare_tree(m) || se3di_gauss_lanes_take_loops(m);
}

int se3di_gauss_lanes_suit_model(const se3di_model *model)
{
    return is_bare(model) && !se3di_model_gravity_varies(model);
}

int se3di_gauss_lanes_suit_equations(const se3di_equations *equations)
{
    return se3di_motion_find(equations) == &se3di_motion_joints &&
           (equations->is_open_tree || se3di_gauss_lanes_suit_loops(equations));
}

/* The widest core that stages fill. */
static const se3di_lane_core *find_core(int stages)
{
    static const int32_t widths[] = {8, 4, 1};
    const se3di_lane_core *core = NULL;
    for (int k = 0; !core && k < 3; ++k) {
        core = stages % widths[k] == 0 ? se3di_lane_core_find(widths[k]) : NULL;
    }
    return core;
}

/* What does not change from step to step. */
static void fill_group(const se3di_gauss_group *own, const se3di_gauss_rule *rule, size_t first,
                       size_t w, const double gravity[3])
{
    const size_t s = (size_t)rule->stages;
    for (size_t lane = 0; lane < w; ++lane) {
        const size_t i = first + lane;
        for (size_t j = 0; j < s; ++j) {
            own->A[j * w + lane] = rule->A[i * s + j];
            own->values[j * w + lane] = rule->values[i * s + j];
        }
        for (size_t c = 0; c < 3; ++c) {
            own->gravity[c * w + lane] = gravity[c];
        }
    }
}

static double *take_group(se3di_gauss_lanes *g, const se3di_explicit *m,
                          const se3di_gauss_rule *rule, size_t index, double *at)
{
    const size_t w = g->width, state = w * (g->positions + g->velocities);
    const se3di_loop_lanes *loops = &m->equations->lanes;
    const se3di_tree *tree = m->equations->tree;
    se3di_gauss_group *own = &g->groups[index];
    own->Y = at;
    own->closed = own->Y + state;
    own->next = own->closed + state;
    own->change = own->next + state;
    own->A = own->change + state;
    own->weights = own->A + w * g->stages;
    own->values = own->weights + w * g->stages;
    own->forms = own->values + w * g->stages;
    own->gravity = own->forms + w * SE3DI_GAUSS_FORMS;
    own->sizes = own->gravity + 3 * w;
    own->verdict = own->sizes + w;
    own->squares = own->verdict + w;
    fill_group(own, rule, index * w, w, m->assembly->model->gravity);
    se3di_lanes_lay_out(&own->lanes, tree, g->core, own->squares + 4 * w);
    se3di_lanes_load(&own->lanes, own->gravity, 0);
    if (m->equations->is_open_tree) {
        se3di_lanes_take_plane(&own->lanes);
    }
    if (g->has_loops) {
        se3di_lanes_take_loops(&own->lanes, &loops->rows,
                               loops->memory + index * w * se3di_lane_loops_room(&loops->rows));
    }
    return own->squares + 4 * w +
           se3di_lanes_room(tree->count, tree->v_count, tree->branch_count, w);
}

/* What is closed may come nearer to a singular position than single states do, as far as rounding,
 * which grows with the inverse of a pivot, allows. */
static void take_least(se3di_explicit *m)
{
    const double rounding = ROUNDING / (LEAST * m->tolerance);
    se3di_lane_loops_take_least(&m->equations->lanes.rows, fmin(FARTHEST, fmax(NEAREST, rounding)));
}

static void lay_out(se3di_gauss_lanes *g, se3di_explicit *m, const se3di_gauss_rule *rule,
                    double *at)
{
    const se3di_tree *tree = m->equations->tree;
    g->positions = tree->q_count;
    g->velocities = tree->v_count;
    g->stages = (size_t)rule->stages;
    g->width = (size_t)g->core->width;
    g->K = se3di_lanes_align(at);
    at = g->K + g->stages * (g->positions + g->velocities);
    for (size_t k = 0; k < g->stages / g->width; ++k) {
        at = take_group(g, m, rule, k, at);
    }
    if (g->has_loops) {
        take_least(m);
    }
}

/* Nothing that they are laid out by changes within a call, but for the stages and whether loops can
 * be computed so. */
se3di_gauss_lanes *se3di_gauss_lanes_find(se3di_explicit *m, const se3di_gauss_rule *rule)
{
    double *work = m->step.integration->work + se3di_explicit_work_count(m->assembly);
    se3di_gauss_lanes *g = (se3di_gauss_lanes *)(void *)work;
    if (m->is_bare && m->laid_out == rule->stages) {
        return g;
    }
    const se3di_lane_core *core = find_core(rule->stages);
    const int has_loops = se3di_gauss_lanes_take_loops(m);
    if (!has_loops && !is_bare_tree(m)) {
        return NULL;
    }
    if (m->laid_out != rule->stages || g->has_loops != has_loops) {
        g->core = core;
        g->has_loops = has_loops;
        lay_out(g, m, rule, work + OWN);
        m->laid_out = rule->stages;
    }
    return g;
}

/* ---- states and derivatives ---- */

void se3di_gauss_lanes_begin(se3di_gauss_lanes *g, const se3di_explicit *m, double h,
                             const se3di_gauss_prediction *prediction)
{
    const size_t s = g->stages, w = g->width, terms = (size_t)prediction->forms;
    const se3di_state_scale scale = se3di_explicit_measure_both_by(m);
    g->scale[0] = scale.length;
    g->scale[1] = scale.speed;
    g->scale[2] = scale.spin;
    for (size_t i = 0; i < s / w; ++i) {
        const se3di_gauss_group *own = &g->groups[i];
        for (size_t k = 0; k < s * w; ++k) {
            own->weights[k] = h * own->A[k];
        }
        for (size_t k = 0; k < terms; ++k) {
            memcpy(own->forms + k * w, prediction->weights + k * SE3DI_GAUSS_MAX + i * w,
                   w * sizeof *own->forms);
        }
        g->core->extend(g->positions + g->velocities, m->f1, terms, own->forms, m->forms + m->count,
                        m->count, g->K + i * w, s);
    }
}

/* Numbers first to first + count of the states of all stages. */
static void combine(const se3di_gauss_lanes *g, const double *y, size_t first, size_t count)
{
    for (size_t k = 0; k < g->stages / g->width; ++k) {
        const se3di_gauss_group *own = &g->groups[k];
        g->core->combine(count, y + first, g->stages, own->weights, g->K + first * g->stages,
                         own->Y + first * g->width);
    }
}

/* Rates of positions are velocities, and are where the lanes find them. */
static int is_direct(const se3di_gauss_lanes *g)
{
    return !g->has_loops && g->positions == g->velocities && g->stages == g->width;
}

/* Velocities, and rates of positions from them; those of quaternions need the quaternions, by the
 * derivatives as they are. */
static void renew(const se3di_gauss_lanes *g, const double *y)
{
    const size_t s = g->stages, w = g->width, at = g->positions * w;
    if (is_direct(g)) {
        g->core->combine(g->velocities, y + g->positions, s, g->groups[0].weights,
                         g->K + g->positions * s, g->K);
        return;
    }
    combine(g, y, g->positions, g->velocities);
    if (g->positions > g->velocities) {
        combine(g, y, 0, g->positions);
    }
    for (size_t k = 0; k < s / w; ++k) {
        const se3di_gauss_group *own = &g->groups[k];
        double *rates = s == w ? g->K : own->next;
        g->core->find_free_rates(&own->lanes, own->Y, own->Y + at, rates);
        for (size_t c = 0; s != w && c < g->positions; ++c) {
            memcpy(g->K + c * s + k * w, rates + c * w, w * sizeof *rates);
        }
    }
}

/* As one after the other: the root of the mean square. */
static double size_of(const se3di_gauss_lanes *g, const se3di_gauss_rule *rule)
{
    const size_t w = g->width;
    double sum = 0.0;
    for (size_t k = 0; k < g->stages / w; ++k) {
        const double *sizes = g->groups[k].sizes, *b = rule->b + k * w;
        for (size_t lane = 0; lane < w; ++lane) {
            sum += b[lane] * sizes[lane] * sizes[lane];
        }
    }
    return sqrt(sum);
}

static int are_finite(const se3di_gauss_lanes *g, const se3di_gauss_group *own, size_t count,
                      const double *next)
{
    int fine = 1;
    g->core->check(count, next, own->verdict);
    for (size_t lane = 0; lane < g->width; ++lane) {
        fine &= own->verdict[lane] == 1.0;
    }
    return fine;
}

/* ---- loops ---- */

/* Positions, or velocities, that are placed move by the least change that closes the loops, by the
 * last factors of the same stages. */
static void close(const se3di_gauss_lanes *g, const se3di_gauss_group *own, int rates)
{
    double *q = own->closed, *qdot = q + g->positions * g->width, *dq = own->next;
    g->core->find_gaps(&own->lanes, rates, own->verdict);
    g->core->correct(&own->lanes, dq);
    if (rates) {
        g->core->add(g->velocities, qdot, 1.0, dq, qdot);
    } else {
        g->core->find_rates(&own->lanes, q, dq, own->change);
        g->core->add(g->positions, q, 1.0, own->change, q);
        g->core->normalise(&own->lanes, q);
    }
    g->core->place(&own->lanes, q, qdot);
}

/* Links at the states of the stages; those of loops have them closed. */
static const double *place(const se3di_gauss_lanes *g, const se3di_gauss_group *own, int k)
{
    const size_t at = g->positions * g->width;
    g->core->normalise(&own->lanes, own->Y);
    g->core->place(&own->lanes, own->Y, is_direct(g) ? g->K : own->Y + at);
    if (!g->has_loops) {
        return own->Y;
    }
    memcpy(own->closed, own->Y, (at + g->velocities * g->width) * sizeof *own->Y);
    if (k == 0) {
        g->core->factor(&own->lanes, NULL);
        g->core->factor_rows(&own->lanes);
    }
    close(g, own, 0);
    close(g, own, 1);
    return own->closed;
}

/* Of links that are placed: derivatives, what they change by, and its size. */
static int find_change(se3di_gauss_lanes *g, size_t group, const double *placed, double h)
{
    const se3di_gauss_group *own = &g->groups[group];
    const size_t state = g->positions + g->velocities, at = g->positions * g->width;
    g->core->find_rates(&own->lanes, own->Y, own->Y + at, own->next);
    if (!are_finite(g, own, state, own->next)) {
        return 0;
    }
    g->core->replace(state, h, own->next, g->stages, g->K + group * g->width, own->change);
    g->core->measure(&own->lanes, placed, own->change, g->scale, own->sizes);
    return 1;
}

/* The same without quaternions: rates of positions are the velocities, as renew() has left them. */
static int find_plain_change(se3di_gauss_lanes *g, size_t group, double h)
{
    const se3di_gauss_group *own = &g->groups[group];
    const size_t at = g->positions * g->width;
    if (!are_finite(g, own, g->velocities, own->next + at)) {
        return 0;
    }
    g->core->replace(g->velocities, h, own->next + at, g->stages,
                     g->K + g->positions * g->stages + group * g->width, own->change + at);
    g->core->measure_rates(&own->lanes, own->change, g->scale, own->sizes);
    return 1;
}

int se3di_gauss_lanes_sweep(se3di_gauss_lanes *g, se3di_explicit *m, const se3di_gauss_rule *rule,
                            int k, double h, double *change)
{
    renew(g, m->y1);
    combine(g, m->y1, 0, g->positions);
    for (size_t i = 0; i < g->stages / g->width; ++i) {
        const se3di_gauss_group *own = &g->groups[i];
        const double *placed = place(g, own, k);
        se3di_lanes_accelerate(&own->lanes, NULL, own->next + g->positions * g->width);
        const int is_fine = g->positions == g->velocities ? find_plain_change(g, i, h)
                                                          : find_change(g, i, placed, h);
        if (!is_fine) {
            return 0;
        }
    }
    *change = size_of(g, rule);
    m->equations->counters.evaluations += (uint64_t)rule->stages;
    return 1;
}

void se3di_gauss_lanes_end(se3di_gauss_lanes *g, const se3di_explicit *m, double *forms)
{
    const size_t s = g->stages, w = g->width, state = g->positions + g->velocities;
    renew(g, m->y1);
    memset(m->sum, 0, state * sizeof *m->sum);
    for (size_t i = 0; i < s / w; ++i) {
        const se3di_gauss_group *own = &g->groups[i];
        g->core->combine(state, m->sum, s, own->values, g->K, own->Y);
        for (size_t lane = 0; lane < w; ++lane) {
            double *to = forms + (i * w + lane) * m->count;
            for (size_t c = 0; c < state; ++c) {
                to[c] = own->Y[c * w + lane];
            }
            memset(to + state, 0, SE3DI_STATE_WORK * sizeof *to);
        }
    }
}

/* ---- the end of a step ---- */

/* The coordinates are all the angles that are counted. */
static int has_its_angles(const se3di_tree *tree, const se3di_model *model)
{
    uint32_t k = 0;
    while (k < tree->angle_count && tree->counted[k] >= 0) {
        ++k;
    }
    return k == model->angle_count && tree->angle_count == model->angle_count;
}

int se3di_gauss_lanes_are_bare(const se3di_explicit *m)
{
    const se3di_assembly *assembly = m->assembly;
    const se3di_model *model = assembly->model;
    return is_bare_tree(m) && !m->equations->tree->has_states && !assembly->push &&
           assembly->timed_count == 0 && assembly->user_count == 0 && model->broken_count == 0 &&
           model->left_out_count == 0 && has_its_angles(m->equations->tree, model);
}

/* One state in all lanes of the first group. */
int se3di_gauss_lanes_differentiate(se3di_gauss_lanes *g, se3di_explicit *m, double t,
                                    double *derivative, double squares[4])
{
    const se3di_gauss_group *own = &g->groups[0];
    const size_t w = g->width, state = g->positions + g->velocities, at = g->positions * w;
    se3di_lanes lanes = own->lanes;
    lanes.wants_points = 1;
    g->core->extend(state, m->y, 0, own->weights, m->y, 0, own->Y, w);
    g->core->normalise(&lanes, own->Y);
    g->core->place(&lanes, own->Y, own->Y + at);
    se3di_lanes_accelerate(&lanes, NULL, own->next + at);
    g->core->find_rates(&lanes, own->Y, own->Y + at, own->next);
    g->core->survey(&lanes, own->squares);
    m->equations->assembly.time = t;
    ++m->equations->counters.evaluations;
    for (size_t c = 0; c < state; ++c) {
        derivative[c] = own->next[c * w];
    }
    memset(derivative + state, 0, SE3DI_STATE_WORK * sizeof *derivative);
    for (size_t k = 0; k < 4; ++k) {
        squares[k] = own->squares[k * w];
    }
    return are_finite(g, own, state, own->next);
}

void se3di_gauss_lanes_sizes(const se3di_gauss_lanes *g, const double *const change[2],
                             double size[2])
{
    const se3di_gauss_group *own = &g->groups[0];
    const size_t w = g->width, state = g->positions + g->velocities;
    for (size_t first = 0; first < 2; first += w) {
        g->core->extend(state, change[1], 0, own->weights, change[1], 0, own->change, w);
        for (size_t c = 0; first == 0 && c < state; ++c) {
            own->change[c * w] = change[0][c];
        }
        g->core->measure(&own->lanes, own->Y, own->change, g->scale, own->sizes);
        for (size_t lane = 0; lane < w && first + lane < 2; ++lane) {
            size[first + lane] = own->sizes[lane];
        }
    }
}
