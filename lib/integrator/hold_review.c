/* SPDX-License-Identifier: BSD-3-Clause */
/* Friction that sticks at both ends of a step can have been loaded beyond its limit between them.
 * The forces n that hold, and the limits F, are found at PROBES places of the step, the state there
 * being that of cubics through both ends; of both excesses
 *
 *     e = n - F,  -n - F;   c(s) the quartic through all of them, p(s) the cubic without the first
 *
 * c + |c - p| > 0 is where the element may slip, at W (e + F - F_slip) (W: its leverage), so that
 * the step is too long if W h times the integral of that is above the tolerance. Whether anything
 * slips there is decided as at the ends of steps: other elements may hold what this one cannot.
 * docs/theory/friction.md */
#include "integrator/hold_review.h"

#include "force/friction.h"
#include "force/measure.h"
#include "math/larger.h"
#include "math/quaternion.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define PROBES  SE3DI_FRICTION_PROBES
#define GRID    64
#define LANDING 0.5 /* of what the tolerance allows: how far beyond the limit a step is aimed */
#define SHORTER 0.9 /* at least, where it is known; else */
#define REFINED 0.5 /* of a step that does not show what holds within it */

#define FOLLOWED 0.25 /* of the change of an excess: what its polynomials may differ by */

#define CALM        0.5 /* of a limit, loads that all places show, */
#define CALM_CHANGE 0.1 /* and their change, and that of the limit: no others are looked at */

static const double places[PROBES] = {0.0, 0.27, 0.52, 0.79, 1.0};

/* One element, against one direction. */
typedef struct excess {
    double e[PROBES]; /* [N], [N m] */
    double jump;      /* by which it falls when it slips */
    double weight;    /* of e over the whole step, relative to the tolerance */
} excess;

/* What all of them say of the step. */
typedef struct verdict {
    double doubt;   /* the most that may have been missed */
    double blurred; /* the most that a polynomial which does not follow the forces could miss */
    double sure;    /* and what has, as far as one element can tell, */
    double peak;    /* at most here, */
    double part;    /* in so much of the step as would do it at that rate; */
    double landing; /* where a step is aimed that ends where it begins */
    double since;   /* the same as `part` for the rate at the end */
} verdict;

/* The cubics of the positions, and their velocities. */
static void set_between(se3di_equations *equations, const se3di_memory_step *step, double s)
{
    se3di_assembly *assembly = &equations->assembly;
    const double h = step->h, a = s * s * (3.0 - 2.0 * s), b = s * (1.0 - s) * (1.0 - s) * h;
    const double c = s * s * (s - 1.0) * h, slope = 6.0 * s * (1.0 - s) / h;
    const double first = (1.0 - s) * (1.0 - 3.0 * s), last = s * (3.0 * s - 2.0);
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        se3di_frame *frame = &assembly->model->frames[assembly->free_body[k]];
        const se3di_frame *to = &equations->saved[assembly->free_body[k]];
        const double *y0 = step->begin + SE3DI_STATE_SIZE * (size_t)k;
        double y1[SE3DI_STATE_SIZE], rate[2][7], x[7], u[7];
        se3di_state_pack(to, y1);
        memcpy(rate[0], y0 + 7, 3 * sizeof *y0);
        memcpy(rate[1], y1 + 7, 3 * sizeof *y1);
        se3di_quat_rate(y0 + 3, y0 + 10, rate[0] + 3);
        se3di_quat_rate(y1 + 3, y1 + 10, rate[1] + 3);
        for (int i = 0; i < 7; ++i) {
            x[i] = y0[i] + a * (y1[i] - y0[i]) + b * rate[0][i] + c * rate[1][i];
            u[i] = slope * (y1[i] - y0[i]) + first * rate[0][i] + last * rate[1][i];
        }
        if (se3di_state_is_carrier(assembly, k)) { /* no position has this rate */
            frame->v[0] = y0[7] + s * (y1[7] - y0[7]);
            continue;
        }
        memcpy(frame->r, x, 3 * sizeof *x);
        se3di_quat_normalize(x + 3, frame->p);
        memcpy(frame->v, u, 3 * sizeof *u);
        se3di_quat_angular_velocity(x + 3, u + 3, frame->w);
        se3di_frame_update(frame);
    }
}

static se3di_force *element_of(const se3di_equations *equations, uint32_t k)
{
    return &equations->assembly.model->forces[equations->friction.element[k]];
}

static int is_held(const se3di_force *force)
{
    return se3di_friction_sticks(force) && force->state[SE3DI_FRICTION_SET] > 0.0;
}

static int holds_any(const se3di_equations *equations)
{
    int any = 0;
    for (uint32_t k = 0; k < equations->friction.count; ++k) {
        any |= is_held(element_of(equations, k));
    }
    return any;
}

/* Accelerations at the place, with the modes of the step. */
static se3d_status evaluate_at(se3di_equations *equations, const se3di_memory_step *step, double s)
{
    if (s < 1.0) {
        set_between(equations, step, s);
    } else {
        se3di_equations_restore(equations);
    }
    return se3di_state_evaluate(equations, step->t - (1.0 - s) * step->h);
}

/* friction.probes: [PROBES][count] of n, F, jump, leverage; a leverage of zero: it cannot hold. */
static se3d_status probe(se3di_equations *equations, const se3di_memory_step *step, size_t place)
{
    se3di_friction_system *friction = &equations->friction;
    double *row = friction->probes + 4 * place * friction->count;
    SE3DI_TRY(evaluate_at(equations, step, places[place]));
    memset(row, 0, 4 * friction->count * sizeof *row);
    for (uint32_t u = 0; u < friction->active; ++u) {
        const uint32_t k = friction->unknown[u];
        const se3di_force *force = element_of(equations, k);
        const double unit = -friction->W[(size_t)u * friction->active + u];
        if (is_held(force) && se3di_friction_system_can_hold(equations, k)) {
            row[4 * k] = friction->n[u];
            row[4 * k + 1] = se3di_friction_limit(force, 0);
            row[4 * k + 2] = row[4 * k + 1] - se3di_friction_limit(force, 1);
            row[4 * k + 3] = unit;
        }
    }
    return SE3D_OK;
}

/* Of element k towards `way`. @return whether it can be told */
static int get_excess(const se3di_equations *equations, const se3di_memory_step *step, uint32_t k,
                      double way, excess *x)
{
    const se3di_friction_system *friction = &equations->friction;
    const se3di_force *force = element_of(equations, k);
    const int turns = force->coordinate == SE3D_JOINT_COORDINATE_ANGLE;
    const double allowed = step->tolerance * (turns ? step->scale->spin : step->scale->speed);
    double most = 0.0;
    *x = (excess){.jump = 0.0};
    for (size_t p = 0; p < PROBES; ++p) {
        const double *of = friction->probes + 4 * (p * friction->count + k);
        if (!(of[3] > 0.0)) {
            return 0;
        }
        x->e[p] = way * of[0] - of[1];
        most = fmax(most, of[1]);
        x->jump = fmax(x->jump, of[2]);
        x->weight = fmax(x->weight, step->h * of[3] / allowed);
    }
    return most > 0.0; /* else it holds nothing, whatever it is asked to */
}

/* The polynomial through the probes from `from` on. */
static double eval_through(const excess *x, size_t from, double s)
{
    double sum = 0.0;
    for (size_t p = from; p < PROBES; ++p) {
        double part = x->e[p];
        for (size_t q = from; q < PROBES; ++q) {
            part *= q == p ? 1.0 : (s - places[q]) / (places[p] - places[q]);
        }
        sum += part;
    }
    return sum;
}

/* A step that is to end where what was held slips is aimed at the place where half of what the
 * tolerance allows is lost. */
static double find_landing(const excess *x, double begin)
{
    const double slope =
        fmax(0.0, (eval_through(x, 0, begin + 1.0 / GRID) - eval_through(x, 0, begin)) * GRID);
    const double wanted = 2.0 * LANDING / x->weight;
    const double root = x->jump + sqrt(x->jump * x->jump + wanted * slope);
    return root > 0.0 ? begin + wanted / root : begin + 1.0 / GRID;
}

/* The place between two of the grid at which c rises above 0. */
static double find_begin(const excess *x, double below, double above)
{
    for (int k = 0; k < 40; ++k) {
        const double middle = 0.5 * (below + above);
        if (eval_through(x, 0, middle) > 0.0) {
            above = middle;
        } else {
            below = middle;
        }
    }
    return above;
}

/* From a place of the grid to the next one, with the values a, b of a function: the integral of it
 * and of `jump` where it is above 0. */
static double integrate_above(double a, double b, double jump)
{
    const double part = a > 0.0 && b > 0.0 ? 1.0
                        : a > 0.0          ? a / (a - b)
                        : b > 0.0          ? b / (b - a)
                                           : 0.0;
    return part / GRID * (jump + 0.5 * (fmax(a, 0.0) + fmax(b, 0.0)));
}

/* The quartic and the cubic differ by so much that neither follows what happens between the probes,
 * as if a step spans a period of a force. What such a step could miss at most: all that the forces
 * change by, in all of it. */
static double find_blurred(const excess *x, double apart)
{
    double least = x->e[0], most = x->e[0];
    for (size_t p = 1; p < PROBES; ++p) {
        least = fmin(least, x->e[p]);
        most = fmax(most, x->e[p]);
    }
    const double range = most - least;
    return apart > FOLLOWED * range && most + range > 0.0 ? x->weight * range : 0.0;
}

static void judge(const excess *x, verdict *all)
{
    double c = eval_through(x, 0, 0.0), worst = c + fabs(c - eval_through(x, 1, 0.0));
    double doubt = 0.0, sure = 0.0, begin = c > 0.0 ? 0.0 : -1.0;
    double most = fmax(0.0, c), peak = 0.0, apart = worst - c;
    for (int k = 1; k <= GRID; ++k) {
        const double s = (double)k / GRID, c0 = c, worst0 = worst;
        c = eval_through(x, 0, s);
        worst = c + fabs(c - eval_through(x, 1, s));
        apart = fmax(apart, worst - c);
        doubt += integrate_above(worst0, worst, x->jump);
        sure += integrate_above(c0, c, x->jump);
        peak = c > most ? s : peak;
        most = fmax(most, c);
        begin = c > 0.0 && begin < 0.0 ? find_begin(x, s - 1.0 / GRID, s) : begin;
    }
    all->doubt = se3di_larger(all->doubt, x->weight * doubt);
    all->blurred = fmax(all->blurred, find_blurred(x, apart));
    all->since = c > 0.0 ? fmax(all->since, sure / (c + x->jump)) : all->since;
    if (x->weight * sure > all->sure) {
        all->sure = x->weight * sure;
        all->part = sure / (most + x->jump);
        all->peak = peak;
        all->landing = find_landing(x, begin);
    }
}

static void judge_all(const se3di_equations *equations, const se3di_memory_step *step, verdict *all)
{
    *all = (verdict){.peak = 1.0, .landing = 1.0};
    for (uint32_t k = 0; k < equations->friction.count; ++k) {
        for (int way = -1; way <= 1; way += 2) {
            excess x;
            if (get_excess(equations, step, k, way, &x)) {
                judge(&x, all);
            }
        }
    }
}

double se3di_hold_change(const se3di_equations *equations, const double *before, double h,
                         const se3di_state_scale *scale)
{
    double largest = 0.0;
    for (size_t k = 0; k < equations->assembly.unknown_count; k += 6) {
        double change[6];
        for (size_t c = 0; c < 6; ++c) {
            change[c] = h * (equations->x[k + c] - before[k + c]);
        }
        const double part =
            se3di_norm(change) / scale->speed + se3di_norm(change + 3) / scale->spin;
        largest = se3di_larger(largest, part);
    }
    return largest;
}

/* Whether anything is held with more than it can be. */
static int is_exceeded(const se3di_equations *equations)
{
    int any = 0;
    for (uint32_t k = 0; k < equations->friction.count; ++k) {
        const se3di_force *force = element_of(equations, k);
        any |= is_held(force) && se3di_friction_system_can_hold(equations, k) &&
               fabs(se3di_friction_get(equations->assembly.model, force)) >
                   se3di_friction_limit(force, 0);
    }
    return any;
}

/* *change of the velocities by what slips from the place on, over the whole step; < 0: what was
 * taken for too much there is not. */
static se3d_status decide_at(se3di_equations *equations, const se3di_memory_step *step, double s,
                             double *change)
{
    *change = -1.0;
    SE3DI_TRY(evaluate_at(equations, step, s));
    if (!is_exceeded(equations)) {
        return SE3D_OK;
    }
    memcpy(step->work, equations->x, equations->assembly.unknown_count * sizeof *step->work);
    for (uint32_t k = 0; k < equations->friction.count; ++k) {
        equations->friction.rests[k] = is_held(element_of(equations, k));
    }
    SE3DI_TRY(se3di_friction_system_decide(equations, step->t - (1.0 - s) * step->h));
    SE3DI_TRY(se3di_state_evaluate(equations, step->t - (1.0 - s) * step->h));
    *change = se3di_hold_change(equations, step->work, step->h, step->scale);
    return SE3D_OK;
}

/* The probes show next to no load, and no change of it or of the limit: nothing is
 * expected between. */
static int is_calm(const se3di_equations *equations)
{
    const se3di_friction_system *friction = &equations->friction;
    int calm = 1;
    for (uint32_t k = 0; k < friction->count; ++k) {
        double largest = 0.0, least = HUGE_VAL, most = 0.0, from = HUGE_VAL, to = -HUGE_VAL;
        for (size_t p = 0; p < PROBES; ++p) {
            const double *of = friction->probes + 4 * (p * friction->count + k);
            largest = fmax(largest, fabs(of[0]));
            least = fmin(least, of[1]);
            most = fmax(most, of[1]);
            from = fmin(from, of[0]);
            to = fmax(to, of[0]);
        }
        calm &= largest <= CALM * least && to - from <= CALM_CHANGE * least &&
                most - least <= CALM_CHANGE * least;
    }
    return calm;
}

static void refuse(se3di_memory_end *end, double error, double fraction)
{
    end->error = se3di_larger(end->error, error);
    end->fraction = end->fraction > 0.0 ? fmin(end->fraction, fraction) : fraction;
}

static se3d_status review(se3di_equations *equations, const se3di_memory_step *step,
                          se3di_memory_end *end, double *since)
{
    verdict all;
    double change = -1.0;
    for (size_t p = 0; p < PROBES; ++p) {
        SE3DI_TRY(probe(equations, step, p));
    }
    if (is_calm(equations)) {
        return SE3D_OK;
    }
    judge_all(equations, step, &all);
    *since = all.since > 0.0 ? all.since : 1.0;
    if (all.blurred > 1.0 && !(all.sure > 1.0)) {
        refuse(end, all.blurred, REFINED);
        return SE3D_OK;
    }
    if (all.doubt <= 1.0) {
        return SE3D_OK;
    }
    if (all.sure > 1.0) {
        SE3DI_TRY(decide_at(equations, step, all.peak, &change));
    }
    if (change < 0.0) {
        refuse(end, all.doubt, REFINED);
    } else if (change * all.part > step->tolerance) {
        refuse(end, change * all.part / step->tolerance, fmin(all.landing, SHORTER));
    }
    return SE3D_OK;
}

/* Whether a failure within the step is the caller's, too; else the step is only not looked into. */
static int must_tell(se3d_status status)
{
    return status == SE3D_ERR_INTERRUPTED || status == SE3D_ERR_NO_MEMORY ||
           status == SE3D_ERR_CALLBACK;
}

int se3di_hold_is_exceeded(const se3di_equations *equations, uint32_t k, int *is_known)
{
    const se3di_friction_system *friction = &equations->friction;
    const double *of = friction->probes + 4 * ((PROBES - 1) * friction->count + k);
    *is_known = friction->has_end && of[3] > 0.0;
    return *is_known && fabs(of[0]) > of[1];
}

se3d_status se3di_hold_review(se3di_equations *equations, const se3di_memory_step *step,
                              se3di_memory_end *end, double *since)
{
    se3di_friction_system *friction = &equations->friction;
    se3di_error *const error = equations->error, inner = {0};
    const int32_t is_rigid = friction->is_rigid;
    *since = 1.0;
    friction->has_end = 0;
    if (!isfinite(step->tolerance) || friction->count == 0 || !holds_any(equations)) {
        return SE3D_OK;
    }
    se3di_equations_save(equations);
    equations->error = &inner;
    friction->is_rigid = SE3DI_FRICTION_LOOKS;
    const se3d_status status = review(equations, step, end, since);
    friction->has_end = status >= 0;
    friction->is_rigid = is_rigid;
    equations->error = error;
    se3di_equations_restore(equations);
    se3di_model_restore_memory(equations->assembly.model, step->memory);
    SE3DI_TRY(se3di_assembly_eval_functions(&equations->assembly, step->t, error));
    return must_tell(status) ? se3di_error_set(error, status, "%s", inner.message) : SE3D_OK;
}
