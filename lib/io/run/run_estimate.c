/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/run/run_estimate.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/base/elementary.h"
#include "io/run/run_record.h"

#define MUCH        1e-3 /* of the largest values: the log is warned */
#define LOST        1.0  /* the two differ by as much as they move: no more is found */
#define RATIO_MOST  4.0  /* of the steps of the run to those of the copy, that orders hold for */
#define RATIO_LEAST 1.5
#define REST        1e-6 /* of the extent, or rad: what moves less is at rest */
#define MANY_STEPS  40.0 /* of the copy between two rows */
#define FEW_WORKS   1e-3 /* of the kinetic energy */

enum { PLACE, SPEED, SPIN, WORK, QUANTITIES };

struct se3di_estimate {
    const se3d_solver *solver; /* of the run */
    const se3d_system *system;
    se3d_solver *copy_solver;
    se3d_system *copy;
    size_t bodies, states;
    double *r0, *r, *v, *w;           /* of the run, [3 * bodies] */
    double *copy_r, *copy_v, *copy_w; /* of the copy */
    double *gap, *largest; /* differences and values, [QUANTITIES + states]: the largest so far */
    double step, order;    /* of the run [s], of its method */
    double start, met;     /* [s] */
    double extent;         /* of the bodies' centres at the start [m] */
    double ratio;          /* steps of the run to one of the copy, at the last comparison */
    double cpu;            /* [s] */
    bool is_convex;        /* of order 1, until something touches */
    bool waits;            /* the copy passes the next row */
    bool is_lost;          /* the two have nothing in common any more */
    char problem[200];     /* why the copy could not follow */
};

static double distance(const double *a, const double *b)
{
    return io_hypot(io_hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

/* Largest distance of two places in one direction. */
static double measure_extent(const double *r, size_t count)
{
    double extent = 0.0;
    for (size_t c = 0; c < 3; ++c) {
        double least = HUGE_VAL, most = -HUGE_VAL;
        for (size_t k = 0; k < count; ++k) {
            least = fmin(least, r[3 * k + c]);
            most = fmax(most, r[3 * k + c]);
        }
        extent = fmax(extent, most - least);
    }
    return extent;
}

/* Equal steps whose error nobody controls, of a method that has an order. */
static bool is_wanted(const se3di_runner *r, const se3di_analysis_entry *entry)
{
    double step = 0.0, tolerance = 0.0;
    const se3d_model *model = r->model;
    return r->options->estimate && !r->watch && !(r->options->checkpoint > 0.0) &&
           !r->options->resume && r->solver && !r->guests && model->guest_count == 0 &&
           !model->particles && entry->solver.analysis == SE3D_ANALYSIS_DYNAMICS &&
           entry->solver.step > 0.0 && se3d_solver_get_step(r->solver, &step) >= 0 && step > 0.0 &&
           se3d_solver_get_tolerance(r->solver, &tolerance) >= 0 && !(tolerance > 0.0);
}

static double get_order(const se3di_estimate *e, const char *method, int32_t order)
{
    const bool is_fourth = order == 4 && strcmp(method, "rattle") == 0;
    return e->is_convex ? 1.0 : is_fourth ? 4.0 : 2.0;
}

static bool reserve(se3di_runner *r, se3di_estimate *e)
{
    e->bodies = se3d_system_count_bodies(e->system);
    e->states = se3d_system_count_states(e->system);
    const size_t n = 3 * e->bodies, quantities = QUANTITIES + e->states;
    double *numbers = se3di_iopool_array(&r->run->pool, 7 * n + 2 * quantities, sizeof *numbers);
    double **const arrays[9] = {&e->r0,     &e->r,      &e->v,   &e->w,      &e->copy_r,
                                &e->copy_v, &e->copy_w, &e->gap, &e->largest};
    if (!numbers) {
        return false;
    }
    for (size_t k = 0; k < 9; ++k) {
        *arrays[k] = numbers;
        numbers += k < 7 ? n : quantities;
    }
    return true;
}

static void leave(se3di_estimate *e)
{
    se3d_solver_destroy(e->copy_solver);
    se3d_system_destroy(e->copy);
    e->copy_solver = NULL;
    e->copy = NULL;
}

/* Why there are no more steps of the copy. */
static void note_problem(se3di_estimate *e, se3d_status status)
{
    if (status == SE3D_ERR_INTERRUPTED) {
        snprintf(e->problem, sizeof e->problem, "the run was interrupted");
        return;
    }
    const char *why = se3d_system_get_error(e->copy ? e->copy : e->system);
    snprintf(e->problem, sizeof e->problem, "steps of %g s fail: %.150s", 2.0 * e->step,
             why[0] ? why : se3d_status_get_text(status));
    size_t used = 0, length = 0;
    while ((length = se3d_text_get_character(e->problem + used)) > 0) {
        used += length;
    }
    e->problem[used] = '\0'; /* the last character may be cut */
}

static se3d_status copy_system(const se3di_runner *r, const se3di_analysis_entry *entry,
                               se3di_estimate *e)
{
    se3d_solver_def def = entry->solver;
    def.step = 2.0 * entry->solver.step;
    def.interrupt = r->options->interrupt;
    def.interrupt_ctx = r->options->interrupt_ctx;
    se3d_status status = se3d_system_clone(e->system, &e->copy);
    status = status < 0 ? status : se3d_system_set_log(e->copy, NULL, NULL);
    status = status < 0 ? status : se3d_solver_create(e->copy, &def, &e->copy_solver);
    return status < 0 ? status : se3d_solver_set_shown(e->copy_solver, SE3D_SHOWN_MOTION);
}

/* The state that both begin with. */
static void note_start(se3di_estimate *e)
{
    se3d_system_get_time(e->system, &e->start);
    e->met = e->start;
    se3d_body_get_all(e->system, e->bodies, e->r0, NULL, NULL, NULL);
    e->extent = measure_extent(e->r0, e->bodies);
    for (size_t k = 0; k < e->states; ++k) {
        se3d_state state;
        se3d_state_def def = se3d_state_def_default();
        if (se3d_system_get_state(e->system, k, &state) >= 0 &&
            se3d_state_get_def(e->system, state, &def) >= 0) {
            e->largest[QUANTITIES + k] = def.size;
        }
    }
}

se3d_status se3di_estimate_begin(se3di_runner *r, const se3di_analysis_entry *entry)
{
    const char *method = "";
    r->estimate = NULL;
    if (!is_wanted(r, entry)) {
        return SE3D_OK;
    }
    se3di_estimate *e = se3di_iopool_alloc(&r->run->pool, sizeof *e);
    if (!e) {
        return SE3D_ERR_NO_MEMORY;
    }
    se3d_solver_get_method(r->solver, &method);
    e->solver = r->solver;
    e->system = r->model->system;
    e->step = entry->solver.step;
    e->is_convex = strcmp(method, "convex") == 0;
    e->order = get_order(e, method, entry->solver.order);
    const se3d_status status = reserve(r, e) ? copy_system(r, entry, e) : SE3D_ERR_NO_MEMORY;
    if (status == SE3D_ERR_NO_MEMORY) {
        leave(e);
        return status;
    }
    if (status < 0) {
        note_problem(e, status);
        leave(e);
    }
    note_start(e);
    r->estimate = e;
    return SE3D_OK;
}

static void grow(se3di_estimate *e, size_t quantity, double gap, double value)
{
    e->gap[quantity] = fmax(e->gap[quantity], gap);
    e->largest[quantity] = fmax(e->largest[quantity], value);
}

static void compare_states(se3di_estimate *e)
{
    for (size_t k = 0; k < e->states; ++k) {
        se3d_state state;
        double z = 0.0, copied = 0.0;
        if (se3d_system_get_state(e->system, k, &state) >= 0 &&
            se3d_state_get_value(e->system, state, SE3D_STATE_VALUE, &z) >= 0 &&
            se3d_state_get_value(e->copy, state, SE3D_STATE_VALUE, &copied) >= 0) {
            grow(e, QUANTITIES + k, fabs(z - copied), fabs(z));
        }
    }
}

/* Steps of the run to one of the copy. */
static double get_ratio(const se3di_estimate *e)
{
    se3d_solver_stats own, copied;
    se3d_solver_get_stats(e->solver, &own);
    se3d_solver_get_stats(e->copy_solver, &copied);
    return copied.steps > 0 ? (double)own.steps / (double)copied.steps : 0.0;
}

static void compare_works(se3di_estimate *e)
{
    se3d_work own, copied;
    se3d_energy energy;
    if (se3d_system_get_work(e->system, &own) < 0 || se3d_system_get_work(e->copy, &copied) < 0 ||
        se3d_system_get_energy(e->system, &energy) < 0) {
        return;
    }
    const double size = FEW_WORKS * energy.kinetic;
    grow(e, WORK, fabs(own.dissipated - copied.dissipated), fmax(fabs(own.dissipated), size));
    grow(e, WORK, fabs(own.actuators - copied.actuators), fabs(own.actuators));
    grow(e, WORK, fabs(own.drivers - copied.drivers), fabs(own.drivers));
}

/* What moves in a system, into r, v, w, and how much. */
static void note_motion(se3di_estimate *e, const se3d_system *system, double *r, double *v,
                        double *w)
{
    static const double zero[3] = {0.0, 0.0, 0.0};
    se3d_body_get_all(system, e->bodies, r, NULL, v, w);
    for (size_t k = 0; k < 3 * e->bodies; k += 3) {
        grow(e, PLACE, 0.0, distance(r + k, e->r0 + k));
        grow(e, SPEED, 0.0, distance(v + k, zero));
        grow(e, SPIN, 0.0, distance(w + k, zero));
    }
}

/* Both are at `time`, the run was seen there. */
static void compare(se3di_estimate *e, double time)
{
    note_motion(e, e->copy, e->copy_r, e->copy_v, e->copy_w);
    for (size_t k = 0; k < 3 * e->bodies; k += 3) {
        grow(e, PLACE, distance(e->r + k, e->copy_r + k), 0.0);
        grow(e, SPEED, distance(e->v + k, e->copy_v + k), 0.0);
        grow(e, SPIN, distance(e->w + k, e->copy_w + k), 0.0);
    }
    compare_states(e);
    compare_works(e);
    e->ratio = get_ratio(e);
    e->met = time;
}

/* The largest value of a quantity, or what is taken for rest. */
static double size_of(const se3di_estimate *e, size_t quantity)
{
    const double time = fmax(e->met - e->start, 1e-12);
    const double rest = quantity == PLACE   ? REST * e->extent
                        : quantity == SPEED ? REST * e->extent / time
                        : quantity == SPIN  ? REST / time
                                            : 0.0;
    return fmax(fmax(e->largest[quantity], rest), 1e-12);
}

/* The copy, to `time`. All rows may be alike, as those at which a swing turns back. So how fast
 * things move is seen between them, too, at whole steps. */
static se3d_status run_copy(se3di_estimate *e, double time)
{
    static const double places[2] = {0.382, 0.764};
    const double begin = e->met, step = 2.0 * e->step, count = (time - begin) / step;
    for (size_t k = 0; k < 2 && count > MANY_STEPS; ++k) {
        const se3d_status status =
            se3d_solver_run(e->copy_solver, begin + floor(places[k] * count) * step);
        if (status < 0) {
            return status;
        }
        note_motion(e, e->copy, e->copy_r, e->copy_v, e->copy_w);
    }
    return se3d_solver_run(e->copy_solver, time);
}

/* @return OK, NO_MEMORY; whatever else the copy fails by ends the estimate */
static se3d_status follow(se3di_estimate *e, double time)
{
    const se3d_status status = run_copy(e, time);
    if (status < 0) {
        note_problem(e, status);
        leave(e);
        return status == SE3D_ERR_NO_MEMORY ? status : SE3D_OK;
    }
    compare(e, time);
    if (e->gap[PLACE] > LOST * size_of(e, PLACE) || e->gap[SPEED] > LOST * size_of(e, SPEED)) {
        e->is_lost = true;
        leave(e);
    }
    return SE3D_OK;
}

/* By convex, what touches a step later has another velocity for a step: no matter of orders. */
static bool touches(const se3di_estimate *e)
{
    return e->is_convex && se3d_system_count_contacts(e->system) > 0;
}

se3d_status se3di_estimate_meet(se3di_estimate *e, double time, bool ends)
{
    if (!e || !e->copy || !(time > e->met)) {
        return SE3D_OK;
    }
    se3d_status status = SE3D_OK;
    if (touches(e)) {
        snprintf(e->problem, sizeof e->problem, "convex is compared until bodies touch");
        leave(e);
        return status;
    }
    note_motion(e, e->system, e->r, e->v, e->w);
    e->waits = !e->waits; /* rows as close as the steps would halve those of the copy */
    if (!e->waits || ends) {
        const clock_t begin = clock();
        status = follow(e, time);
        e->cpu += (double)(clock() - begin) / (double)CLOCKS_PER_SEC;
    }
    return status;
}

double se3di_estimate_get_time(const se3di_estimate *e)
{
    return e ? e->cpu : 0.0;
}

/* The errors of the run as far as the copy has come. */
static void conclude(const se3di_estimate *e, se3d_run_analysis *done)
{
    const double divisor = io_pow(fmin(e->ratio, RATIO_MOST), e->order) - 1.0;
    double *const errors[QUANTITIES] = {&done->error_position, &done->error_velocity,
                                        &done->error_angular_velocity, &done->error_work};
    for (size_t q = 0; q < QUANTITIES; ++q) {
        *errors[q] = e->gap[q] / size_of(e, q) / divisor;
    }
    for (size_t q = QUANTITIES; q < QUANTITIES + e->states; ++q) {
        done->error_state = fmax(done->error_state, e->gap[q] / size_of(e, q) / divisor);
    }
    done->estimated_to = e->met;
}

/* The largest of them, and of what. */
static double find_worst(const se3d_run_analysis *done, const char **what)
{
    const double errors[] = {done->error_position, done->error_velocity,
                             done->error_angular_velocity, done->error_work, done->error_state};
    static const char *const names[] = {"travel", "velocity", "angular velocity", "work", "state"};
    size_t worst = 0;
    for (size_t q = 1; q < sizeof errors / sizeof *errors; ++q) {
        worst = errors[q] > errors[worst] ? q : worst;
    }
    *what = names[worst];
    return errors[worst];
}

static void warn(const se3di_runner *r, const se3di_estimate *e, const se3d_run_analysis *done)
{
    char text[400];
    const char *what;
    const double worst = find_worst(done, &what);
    if (!(worst > MUCH) || !r->model->log) {
        return;
    }
    snprintf(text, sizeof text,
             "t = %.9g s: equal steps of %g s err by about %.2g%s of the largest %s, as steps of "
             "%g s show: take shorter ones, or a `tolerance` in place of `step`",
             e->met, e->step, worst, e->is_lost ? " or more" : "", what, 2.0 * e->step);
    r->model->log(r->model->log_ctx, SE3D_LOG_WARNING, SE3D_LOG_STEP, text);
}

void se3di_estimate_end(se3di_runner *r, se3d_run_analysis *done)
{
    se3di_estimate *e = r->estimate;
    done->unestimated = "";
    done->estimated_to = (double)NAN;
    if (!e) {
        return;
    }
    if (e->ratio > RATIO_LEAST) {
        conclude(e, done);
        warn(r, e, done);
    }
    if (e->problem[0]) {
        done->unestimated = se3di_run_copy_text(r, e->problem);
    }
    leave(e);
    r->estimate = NULL;
}
