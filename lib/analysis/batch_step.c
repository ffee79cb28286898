/* SPDX-License-Identifier: BSD-3-Clause */
/* Batches: accelerations, efforts and steps of groups, shared by threads. Who does a group does not
 * change the bits.                                                      docs/theory/lanes.md */
#include "analysis/batch.h"

#include "base/floats.h"
#include "base/threads.h"
#include "force/force.h"

#include <math.h>
#include <string.h>

/* A group in the hands of a worker. */
typedef struct task {
    const se3di_batch *batch;
    se3di_batch_worker *worker;
    size_t group, width;
    const double *effort;
} task;

/* What is done with each group. */
typedef struct errand {
    void (*run)(const task *t, const struct errand *e);
    const se3di_rk_tableau *tableau;
    double h;
    uint64_t steps;
    const double *in; /* [count][velocities] */
    double *out;
    size_t first, count; /* states */
} errand;

/* ---- what acts ---- */

static int32_t *status_of(const task *t, size_t lane)
{
    return &t->batch->status[t->group * t->width + lane];
}

/* The state of a lane becomes that of the worker's model. */
static void show_lane(const task *t, const double *q, size_t lane)
{
    const se3di_batch *b = t->batch;
    se3di_batch_worker *w = t->worker;
    const size_t bodies = b->tree.body_count, size = sizeof(se3di_frame) / sizeof(double);
    se3di_frame *frames = w->frames + lane * bodies;
    se3di_angle *angles = w->angles + lane * b->model->angle_count;
    for (uint32_t k = 0; k < b->tree.count; ++k) {
        const se3di_tree_node *n = &b->tree.nodes[k];
        const double *from = w->lanes.frames + n->body * size * t->width + lane;
        double *to = (double *)(void *)&frames[n->body];
        for (size_t c = 0; c < size; ++c) {
            to[c] = from[c * t->width];
        }
        if (n->angle >= 0) {
            const size_t at = n->q + (n->type == SE3DI_TREE_PLANAR ? 2 : 0);
            angles[n->angle].theta = q[at * t->width + lane];
        }
        if (b->inertias) {
            w->model.bodies[n->body].mass =
                b->inertias[((t->group * b->tree.count + k) * 7) * t->width + lane];
        }
    }
    for (size_t c = 0; c < 3; ++c) {
        w->model.gravity[c] = b->gravity[(3 * t->group + c) * t->width + lane];
    }
}

/* Force elements state by state; one that fails makes its lane not a number. */
static void load_lane(const task *t, const double *q, double dt, size_t lane)
{
    const se3di_batch *b = t->batch;
    se3di_batch_worker *w = t->worker;
    se3di_model *model = &w->model;
    se3di_frame *frames = model->frames;
    se3di_angle *angles = model->angles;
    uint32_t failed;
    show_lane(t, q, lane);
    model->frames = w->frames + lane * b->tree.body_count;
    model->angles = w->angles + lane * b->model->angle_count;
    const double time = b->time[t->group * t->width + lane] + dt;
    const se3d_status status = se3di_forces_eval(model, time, w->scalars, &failed);
    model->frames = frames;
    model->angles = angles;
    if (status < 0 && *status_of(t, lane) >= 0) {
        *status_of(t, lane) = status;
    }
    for (size_t k = 0; k < 6 * (size_t)b->tree.body_count; ++k) {
        w->lanes.loads[k * t->width + lane] = status < 0 ? (double)NAN : w->scalars[k];
    }
}

static void load(const task *t, const double *q, double dt)
{
    const se3di_batch *b = t->batch;
    se3di_lanes *lanes = &t->worker->lanes;
    if (b->is_in_lanes) {
        se3di_lanes_load(lanes, b->gravity + 3 * t->group * t->width,
                         b->spring_count + b->load_count > 0);
        b->core->add_springs(lanes, b->springs, b->spring_count);
        b->core->add_loads(lanes, b->loads, b->load_count);
        return;
    }
    for (size_t lane = 0; lane < t->width && t->group * t->width + lane < b->count; ++lane) {
        if (*status_of(t, lane) >= 0) {
            load_lane(t, q, dt, lane);
        }
    }
    b->core->take_wrenches(lanes);
}

/* Efforts that were set (NULL: none) and what follows laws, of the positions and velocities y. */
static const double *find_acting(const task *t, const double *effort, const double *y)
{
    const se3di_batch *b = t->batch;
    double *acting = t->worker->acting;
    const size_t count = b->tree.v_count * t->width;
    if (b->law_count == 0 && effort) {
        return effort;
    }
    for (size_t k = 0; k < count; ++k) {
        acting[k] = effort ? effort[k] : 0.0;
    }
    b->core->add_laws(b->laws, b->law_count, y, y + b->tree.q_count * t->width, acting);
    return acting;
}

/* ---- steps ---- */

/* y' at the time of the states and dt. */
static void evaluate(const task *t, const double *y, double dt, double *rates)
{
    const se3di_lane_core *core = t->batch->core;
    const se3di_lanes *lanes = &t->worker->lanes;
    const size_t positions = t->batch->tree.q_count * t->width;
    core->place(lanes, y, y + positions);
    load(t, y, dt);
    se3di_lanes_accelerate(lanes, find_acting(t, t->effort, y), rates + positions);
    core->find_rates(lanes, y, y + positions, rates);
}

/* out = y + h sum of coefficients times the rates of the first stages. */
static void combine(const task *t, const double *y, double h, const double *coefficients,
                    int stages, double *out)
{
    const se3di_batch_worker *w = t->worker;
    const size_t count = (size_t)t->batch->tree.q_count + t->batch->tree.v_count;
    const double *rates[SE3DI_BATCH_STAGES];
    double factors[SE3DI_BATCH_STAGES];
    int used = 0;
    for (int k = 0; k < stages; ++k) {
        if (coefficients[k] != 0.0) {
            factors[used] = h * coefficients[k];
            rates[used++] = w->rates + (size_t)k * count * t->width;
        }
    }
    t->batch->core->sum(count, y, used, factors, rates, out);
    t->batch->core->normalise(&w->lanes, out);
}

/* ---- loops ---- */

#define PASSES         2     /* of a step's end: the same for all lanes, whatever they need */
#define PASSES_SETTLED 8     /* of states that are set, each by factors of its own */
#define CLOSED         1e-10 /* m, m/s: else states that are set fail */
#define CLOSED_STEP    1e-8  /* m, m/s: else a step was too long */

/* Positions, or velocities, move by the least change that closes the loops, by the last factors; by
 * new ones if it renews. */
static void project(const task *t, double *y, int rates, int passes, int renews)
{
    const se3di_lane_core *core = t->batch->core;
    const se3di_lanes *lanes = &t->worker->lanes;
    const size_t positions = t->batch->tree.q_count, velocities = t->batch->tree.v_count;
    double *qdot = y + positions * t->width, *dq = t->worker->acting, *move = t->worker->y;
    for (int k = 0; k < passes; ++k) {
        if (renews) {
            core->factor(lanes, NULL);
            core->factor_rows(lanes);
        }
        core->find_gaps(lanes, rates, t->worker->verdict);
        core->correct(lanes, dq);
        if (rates) {
            core->add(velocities, qdot, 1.0, dq, qdot);
        } else {
            core->find_rates(lanes, y, dq, move);
            core->add(positions, y, 1.0, move, y);
            core->normalise(lanes, y);
        }
        core->place(lanes, y, qdot);
    }
}

/* Of the state that is placed. */
static void find_all_gaps(const task *t, double gaps[2][SE3DI_LANES_MAX])
{
    for (int rates = 0; rates < 2; ++rates) {
        t->batch->core->find_gaps(&t->worker->lanes, rates, t->worker->verdict);
        memcpy(gaps[rates], t->worker->verdict, t->width * sizeof *gaps[rates]);
    }
}

/* Of the state at the end of a step; what remains open of each lane's positions and velocities. */
static void close_loops(const task *t, double *y, double gaps[2][SE3DI_LANES_MAX])
{
    t->batch->core->place(&t->worker->lanes, y, y + t->batch->tree.q_count * t->width);
    t->batch->core->factor(&t->worker->lanes, NULL);
    t->batch->core->factor_rows(&t->worker->lanes);
    project(t, y, 0, PASSES, 0);
    project(t, y, 1, PASSES, 0);
    find_all_gaps(t, gaps);
}

static void settle_group(const task *t, const errand *e)
{
    const se3di_batch *b = t->batch;
    const size_t count = (size_t)b->tree.q_count + b->tree.v_count;
    double *y = b->states + t->group * count * t->width, *end = t->worker->end;
    double gaps[2][SE3DI_LANES_MAX];
    const size_t begin = t->group * t->width;
    if (begin >= e->first + e->count || begin + t->width <= e->first) {
        return;
    }
    memcpy(end, y, count * t->width * sizeof *y);
    se3di_lanes_load(&t->worker->lanes, NULL, 0);
    b->core->place(&t->worker->lanes, end, end + b->tree.q_count * t->width);
    project(t, end, 0, PASSES_SETTLED, 1);
    project(t, end, 1, PASSES, 1);
    find_all_gaps(t, gaps);
    for (size_t lane = 0; lane < t->width; ++lane) {
        if (begin + lane < e->first || begin + lane >= e->first + e->count) {
            continue;
        }
        const int fine = gaps[0][lane] <= CLOSED && gaps[1][lane] <= CLOSED;
        for (size_t k = 0; fine && k < count; ++k) {
            y[k * t->width + lane] = end[k * t->width + lane];
        }
        *status_of(t, lane) = fine ? SE3D_OK : SE3D_ERR_NO_CONVERGENCE;
    }
}

/* ---- steps of all ---- */

/* worker->end: y after a step. */
static void make_step(const task *t, const double *y, const errand *e,
                      double gaps[2][SE3DI_LANES_MAX])
{
    const se3di_rk_tableau *tableau = e->tableau;
    se3di_batch_worker *w = t->worker;
    const size_t count = (size_t)t->batch->tree.q_count + t->batch->tree.v_count;
    evaluate(t, y, 0.0, w->rates);
    for (int k = 1; k < tableau->stages; ++k) {
        combine(t, y, e->h, tableau->a[k], k, w->y);
        evaluate(t, w->y, e->h * tableau->c[k], w->rates + (size_t)k * count * t->width);
    }
    combine(t, y, e->h, tableau->a[tableau->stages], tableau->stages, w->end);
    if (t->batch->has_loops) {
        close_loops(t, w->end, gaps);
    }
    t->batch->core->check(count, w->end, w->verdict);
}

/* Lanes whose step is finite, with loops that are closed, take it. */
static void accept(const task *t, double *y, double gaps[2][SE3DI_LANES_MAX], const double *begin,
                   double elapsed)
{
    const se3di_batch_worker *w = t->worker;
    const size_t count = (size_t)t->batch->tree.q_count + t->batch->tree.v_count;
    int fine = 1;
    for (size_t lane = 0; lane < t->width; ++lane) {
        int32_t *status = status_of(t, lane);
        if (*status >= 0 && w->verdict[lane] != 1.0) {
            *status = SE3D_ERR_NOT_FINITE;
        } else if (*status >= 0 &&
                   !(gaps[0][lane] <= CLOSED_STEP && gaps[1][lane] <= CLOSED_STEP)) {
            *status = SE3D_ERR_NO_CONVERGENCE;
        }
        fine &= *status >= 0;
        if (*status >= 0) {
            t->batch->time[t->group * t->width + lane] = begin[lane] + elapsed;
        }
    }
    if (fine && count > 0) {
        memcpy(y, w->end, count * t->width * sizeof *y);
        return;
    }
    for (size_t k = 0; k < count * t->width; ++k) {
        y[k] = *status_of(t, k % t->width) >= 0 ? w->end[k] : y[k];
    }
}

static void step_group(const task *t, const errand *e)
{
    const se3di_batch *b = t->batch;
    const size_t count = (size_t)b->tree.q_count + b->tree.v_count;
    double *y = b->states + t->group * count * t->width;
    double begin[SE3DI_LANES_MAX], gaps[2][SE3DI_LANES_MAX] = {{0.0}};
    memcpy(begin, b->time + t->group * t->width, t->width * sizeof *begin);
    for (uint64_t k = 0; k < e->steps; ++k) {
        make_step(t, y, e, gaps);
        accept(t, y, gaps, begin, (double)(k + 1) * e->h);
    }
}

/* ---- queries ---- */

/* The lanes' numbers to their states; zero, with a status, where they are not finite. */
static void hand_out(const task *t, const double *values, double *out)
{
    const se3di_batch *b = t->batch;
    const size_t count = b->tree.v_count;
    b->core->check(count, values, t->worker->verdict);
    for (size_t lane = 0; lane < t->width; ++lane) {
        const size_t state = t->group * t->width + lane;
        int32_t *status = status_of(t, lane);
        if (*status >= 0 && t->worker->verdict[lane] != 1.0) {
            *status = SE3D_ERR_NOT_FINITE;
        }
        const int fine = *status >= 0;
        for (size_t k = 0; state < b->count && k < count; ++k) {
            out[state * count + k] = fine ? values[k * t->width + lane] : 0.0;
        }
    }
}

static const double *place_group(const task *t)
{
    const se3di_batch *b = t->batch;
    const size_t count = (size_t)b->tree.q_count + b->tree.v_count;
    const double *y = b->states + t->group * count * t->width;
    b->core->place(&t->worker->lanes, y, y + b->tree.q_count * t->width);
    load(t, y, 0.0);
    return y;
}

static void accelerate_group(const task *t, const errand *e)
{
    double *out = t->worker->rates;
    const double *y = place_group(t);
    se3di_lanes_accelerate(&t->worker->lanes, find_acting(t, t->effort, y), out);
    hand_out(t, out, e->out);
}

static void find_group_efforts(const task *t, const errand *e)
{
    const se3di_batch *b = t->batch;
    double *in = t->worker->effort, *out = t->worker->rates;
    const size_t count = b->tree.v_count;
    const double *y = place_group(t);
    for (size_t k = 0; k < count * t->width; ++k) {
        const size_t state = t->group * t->width + k % t->width;
        in[k] = e->in && state < b->count ? e->in[state * count + k / t->width] : 0.0;
    }
    b->core->find_efforts(&t->worker->lanes, in, out);
    b->core->add(count, out, -1.0, find_acting(t, NULL, y), out);
    hand_out(t, out, e->out);
}

/* ---- threads ---- */

static void run_group(const se3di_batch *b, int32_t worker, size_t group, const errand *e)
{
    const size_t width = (size_t)b->core->width;
    task t = {.batch = b,
              .worker = &b->workers[worker],
              .group = group,
              .width = width,
              .effort = b->efforts + group * b->tree.v_count * width};
    t.worker->lanes.inertias = b->inertias ? b->inertias + group * b->tree.count * 7 * width : NULL;
    const se3di_floats host = se3di_floats_set();
    e->run(&t, e);
    se3di_floats_restore(host);
}

static void run_all(const se3di_batch *b, const errand *e)
{
#ifdef _OPENMP
    if (b->worker_count > 1) {
#pragma omp parallel for num_threads(b->worker_count) schedule(static)
        for (size_t group = 0; group < b->groups; ++group) {
            run_group(b, se3di_threads_get_own(), group, e);
        }
        return;
    }
#endif
    for (size_t group = 0; group < b->groups; ++group) {
        run_group(b, 0, group, e);
    }
}

void se3di_batch_step(se3di_batch *batch, const se3di_rk_tableau *tableau, double h, uint64_t steps)
{
    const errand e = {.run = step_group, .tableau = tableau, .h = h, .steps = steps};
    run_all(batch, &e);
}

void se3di_batch_accelerate(se3di_batch *batch, double *qddot)
{
    const errand e = {.run = accelerate_group, .out = qddot};
    run_all(batch, &e);
}

void se3di_batch_find_efforts(se3di_batch *batch, const double *qddot, double *effort)
{
    const errand e = {.run = find_group_efforts, .in = qddot, .out = effort};
    run_all(batch, &e);
}

void se3di_batch_settle(se3di_batch *batch, size_t first, size_t count)
{
    const errand e = {.run = settle_group, .first = first, .count = count};
    if (batch->has_loops) {
        run_all(batch, &e);
    }
}
