/* SPDX-License-Identifier: BSD-3-Clause */
/* Between two rows a channel is taken for a straight line (io/channel/rows.h); a band or a time is
 * reached where the line reaches it. docs/theory/studies.md */
#include "io/study/tally.h"

#include <math.h>
#include <string.h>

#include "io/channel/rows.h"

void se3di_tally_begin(se3di_tally *tally, const se3di_study_measure *measure)
{
    const se3di_tally kept = *tally;
    memset(tally, 0, sizeof *tally);
    tally->measure = measure;
    tally->times = kept.times;
    tally->values = kept.values;
    tally->time_capacity = kept.time_capacity;
    tally->value_capacity = kept.value_capacity;
}

double se3di_tally_get_wanted(const se3di_study_measure *m, double x)
{
    size_t k = 1;
    while (k + 1 < m->point_count && x > m->x[k]) {
        ++k;
    }
    const double share = (x - m->x[k - 1]) / (m->x[k] - m->x[k - 1]);
    return m->y[k - 1] + share * (m->y[k] - m->y[k - 1]);
}

static bool keep(se3di_tally *t, se3di_iopool *pool, double time, double value)
{
    double *times =
        se3di_iopool_grow(pool, t->times, t->count, &t->time_capacity, sizeof *t->times);
    t->times = times ? times : t->times;
    double *values =
        se3di_iopool_grow(pool, t->values, t->count, &t->value_capacity, sizeof *t->values);
    t->values = values ? values : t->values;
    if (!times || !values) {
        return false;
    }
    t->times[t->count] = time;
    t->values[t->count++] = value;
    return true;
}

/* One more row of a channel that is to settle at `target`: `outside` is when it went in. */
static void settle(se3di_tally *t, double target, double time, double value)
{
    const double distance = fabs(value - target);
    const double before = fabs(t->last - target);
    const double band = t->measure->band;
    const bool was_in = t->is_in;
    t->is_in = distance <= band;
    if (!t->has_row) {
        t->outside = time;
    } else if (t->is_in && !was_in) {
        const double share = before > distance ? (before - band) / (before - distance) : 1.0;
        t->outside = t->time + share * (time - t->time);
    }
}

bool se3di_tally_add(se3di_tally *t, se3di_iopool *pool, double time, double value)
{
    const se3di_study_measure *m = t->measure;
    const double h = t->has_row ? time - t->time : 0.0;
    const double before = t->has_row ? t->last : value;
    if (!t->has_row) {
        t->start = time;
        t->first = t->most = t->least = value;
    }
    t->most = value > t->most || isnan(value) ? value : t->most;
    t->least = value < t->least || isnan(value) ? value : t->least;
    t->sum += se3di_rows_integral(h, before, value);
    t->squares += se3di_rows_squares(h, before, value);
    const double wanted = t->start + m->time;
    if (m->reduction == SE3DI_REDUCE_AT && !m->event && !t->has_found &&
        wanted <= time + 1e-9 * h) {
        t->found = h > 0.0 ? value + (before - value) * ((time - wanted) / h) : value;
        t->found = time - wanted <= 1e-9 * h ? value : t->found;
        t->has_found = true;
    }
    if (m->reduction == SE3DI_REDUCE_SETTLING) {
        if (m->has_target) {
            settle(t, m->target, time, value);
        } else if (!keep(t, pool, time, value)) {
            return false;
        }
    }
    t->time = time;
    t->last = value;
    t->has_row = true;
    return true;
}

void se3di_tally_find(se3di_tally *t, double value)
{
    if (!t->has_found) {
        t->found = value;
        t->has_found = true;
    }
}

static double get_settling(const se3di_tally *t, const char **problem)
{
    se3di_tally end = *t;
    if (!t->measure->has_target) {
        end.has_row = false;
        for (size_t k = 0; k < t->count; ++k) {
            settle(&end, t->last, t->times[k], t->values[k]);
            end.time = t->times[k];
            end.last = t->values[k];
            end.has_row = true;
        }
    }
    if (!end.is_in) {
        *problem = "has not settled at the end";
        return (double)NAN;
    }
    return end.outside - t->start;
}

static double get_found(const se3di_tally *t, const char **problem)
{
    if (!t->has_found) {
        *problem = t->measure->event        ? "the event did not happen"
                   : t->measure->mode > 0.0 ? "there are fewer modes"
                                            : "the time was not reached";
    }
    return t->has_found ? t->found : (double)NAN;
}

double se3di_tally_get(const se3di_tally *t, const char **problem)
{
    const double duration = t->time - t->start;
    switch (t->measure->reduction) {
    case SE3DI_REDUCE_MAX:
        return t->most;
    case SE3DI_REDUCE_MIN:
        return t->least;
    case SE3DI_REDUCE_RANGE:
        return t->most - t->least;
    case SE3DI_REDUCE_MEAN:
        return duration > 0.0 ? t->sum / duration : t->last;
    case SE3DI_REDUCE_RMS:
    case SE3DI_REDUCE_MISFIT:
        return duration > 0.0 ? sqrt(t->squares / duration) : fabs(t->last);
    case SE3DI_REDUCE_INTEGRAL:
        return t->sum;
    case SE3DI_REDUCE_INITIAL:
        return t->first;
    case SE3DI_REDUCE_SETTLING:
        return get_settling(t, problem);
    case SE3DI_REDUCE_AT:
    case SE3DI_REDUCE_TIME_OF:
    case SE3DI_REDUCE_FREQUENCY:
    case SE3DI_REDUCE_DAMPING:
        return get_found(t, problem);
    default:
        return t->last;
    }
}
