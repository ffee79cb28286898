/* SPDX-License-Identifier: BSD-3-Clause */
/* Road: how high it is, and the plane below a wheel (centre c, axis a, radius R) in its frame, with
 * derivatives by c, a and t.
 *
 * At a point: the plane that touches the road at (X, Y), where the wheel would touch the plane that
 * touches the road below its lowest point.
 *
 * Over obstacles: four discs of the radius R, a length L apart along the wheel's heading e and a
 * width W across it, f, each as high as it stands on the road:
 *
 *     w(X, Y) = max_s [h(X + s e_x, Y + s e_y) - R + sqrt(R^2 - s^2)],   |s| <= 0.95 R
 *     S_e = (w_front - w_rear)/L,  S_f = (w_left - w_right)/W,  n ~ (0, 0, 1) - S_e e - S_f f
 *     H   = mean w + R (1 - sqrt(1 + S_e^2))         on a slope that is h
 *
 * A disc's derivatives are those of h at the s that it stands on; on an edge that of the disc
 * itself, along e.                                                       docs/theory/road.md */
#include "force/road.h"

#include "expression/expression.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define STEP     1e-5 /* of differences of a callback's slopes [m], [s] */
#define REACH    0.95 /* of a disc, over its radius */
#define SAMPLES  25   /* places that are tried along a disc, */
#define CUTS     48   /* and steps between the best and its neighbours */
#define IN_PLANE 6u   /* bits of x and y among the variables t, x, y */
#define ROOM     (SAMPLES + SE3DI_EXPRESSION_POINTS)
#define TIGHT    1e-13
#define SMOOTH   1e-4 /* of what the disc drops by between samples: what a cubic may be off by */
#define NOISE    1e-6 /* of the slope of a disc where a smooth road carries it */
#define EDGE     1e-7 /* to both sides of an edge, over the radius */

typedef se3di_dual dual;
typedef se3di_road_height height;

/* ---- Height --------------------------------------------------------------------------------*/

static int is_known(const height *at)
{
    return isfinite(at->h) && isfinite(at->x) && isfinite(at->y) && isfinite(at->t);
}

static double known(double curvature)
{
    return isfinite(curvature) ? curvature : 0.0;
}

/* Second derivatives along two directions, and along both: the mixed one. */
static double mix(const se3d_expression *expression, const double at[3], const double way[3],
                  double first, double second)
{
    const unsigned mask =
        (way[0] > 0.0 ? 1u : 0u) | (way[1] > 0.0 ? 2u : 0u) | (way[2] > 0.0 ? 4u : 0u);
    double jet[3];
    se3di_expression_eval_along(expression, at, way, mask, jet);
    return known(0.5 * (jet[2] - first - second));
}

/* A road whose rate is 0 stands still. */
static void bend_expression(const se3d_expression *expression, const double at[3], height *out)
{
    static const double ways[6][3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0},
                                      {1.0, 1.0, 0.0}, {1.0, 0.0, 1.0}, {0.0, 1.0, 1.0}};
    const int moves = fabs(out->t) > 0.0;
    double jet[3][3];
    for (unsigned k = moves ? 0 : 1; k < 3; ++k) {
        se3di_expression_eval_along(expression, at, ways[k], 1u << k, jet[k]);
    }
    out->xx = known(jet[1][2]);
    out->yy = known(jet[2][2]);
    out->xy = mix(expression, at, ways[5], jet[1][2], jet[2][2]);
    if (moves) {
        out->xt = mix(expression, at, ways[3], jet[0][2], jet[1][2]);
        out->yt = mix(expression, at, ways[4], jet[0][2], jet[2][2]);
    }
}

static int is_plain(const se3di_function *function)
{
    return function->expression && !function->integral && function->variable_count == 3;
}

static se3d_status take_slopes(const se3di_function *function, const double at[3], height *out)
{
    double jet[3], gradient[3] = {0.0, 0.0, 0.0};
    if (is_plain(function)) {
        SE3DI_TRY(se3d_expression_eval_gradient(function->expression, at, jet, gradient));
    } else {
        SE3DI_TRY(se3di_function_eval(function, at, jet, gradient));
    }
    out->h = jet[0];
    out->t = gradient[0];
    out->x = gradient[1];
    out->y = gradient[2];
    return is_known(out) ? SE3D_OK : SE3D_ERR_NOT_FINITE;
}

/* By central differences. */
static se3d_status bend_callback(const se3di_function *function, const double at[3], height *out)
{
    height low = {.h = 0.0}, high = {.h = 0.0};
    for (int k = 1; k < 3; ++k) {
        double before[3] = {at[0], at[1], at[2]}, after[3] = {at[0], at[1], at[2]};
        before[k] -= STEP;
        after[k] += STEP;
        SE3DI_TRY(take_slopes(function, before, &low));
        SE3DI_TRY(take_slopes(function, after, &high));
        *(k == 1 ? &out->xx : &out->yy) =
            k == 1 ? 0.5 * (high.x - low.x) / STEP : 0.5 * (high.y - low.y) / STEP;
        *(k == 1 ? &out->xt : &out->yt) = 0.5 * (high.t - low.t) / STEP;
        if (k == 2) {
            out->xy = 0.5 * (high.x - low.x) / STEP;
        }
    }
    return SE3D_OK;
}

se3d_status se3di_road_eval(const se3di_model *model, const se3di_road *road, const double at[3],
                            int wants_curvature, height *out)
{
    memset(out, 0, sizeof *out);
    if (road->kind == SE3DI_ROAD_PLANE) {
        return SE3D_OK;
    }
    if (road->kind != SE3DI_ROAD_FUNCTION) {
        se3di_road_eval_surface(road, at, out);
        return SE3D_OK;
    }
    const se3di_function *function = &model->functions[road->function];
    SE3DI_TRY(take_slopes(function, at, out));
    if (!wants_curvature || function->variable_count < 2) {
        return SE3D_OK;
    }
    if (is_plain(function)) {
        bend_expression(function->expression, at, out);
        return SE3D_OK;
    }
    return bend_callback(function, at, out);
}

/* The expression of its height; NULL: that comes otherwise. */
static const se3d_expression *get_formula(const se3di_model *model, const se3di_road *road)
{
    const int is_one =
        road->kind == SE3DI_ROAD_FUNCTION && is_plain(&model->functions[road->function]);
    return is_one ? model->functions[road->function].expression : NULL;
}

/* The height alone. */
static se3d_status eval_height(const se3di_model *model, const se3di_road *road, const double at[3],
                               double *h)
{
    height out;
    const se3d_expression *formula = get_formula(model, road);
    if (formula) {
        return se3d_expression_eval(formula, at, h);
    }
    SE3DI_TRY(se3di_road_eval(model, road, at, 0, &out));
    *h = out.h;
    return SE3D_OK;
}

/* ---- Numbers with derivatives --------------------------------------------------------------*/

/* f with these slopes by x, y and t. */
static dual chain3(double f, const double slope[3], const dual at[2])
{
    dual out = se3di_dual_chain2(f, slope[0], at[0], slope[1], at[1]);
    out.d[SE3DI_ROAD_TIME] += slope[2];
    return out;
}

static dual dot3(const dual a[3], const dual b[3])
{
    const dual part = se3di_dual_add(se3di_dual_mul(a[0], b[0]), se3di_dual_mul(a[1], b[1]));
    return se3di_dual_add(part, se3di_dual_mul(a[2], b[2]));
}

/* u + s v */
static dual along(dual u, dual s, dual v)
{
    return se3di_dual_add(u, se3di_dual_mul(s, v));
}

/* Of the slopes along x and y; the normal. */
static void erect(dual slope_x, dual slope_y, dual normal[3])
{
    const dual square = along(se3di_dual_mul(slope_x, slope_x), slope_y, slope_y);
    const dual size = se3di_dual_sqrt(se3di_dual_line(1.0, 1.0, square));
    normal[2] = se3di_dual_div(se3di_dual_of(1.0), size);
    normal[0] = se3di_dual_scale(-1.0, se3di_dual_mul(slope_x, normal[2]));
    normal[1] = se3di_dual_scale(-1.0, se3di_dual_mul(slope_y, normal[2]));
}

typedef struct seat {
    dual center[3], axis[3];
} seat;

static void take_seat(const se3di_road_wheel *wheel, seat *s)
{
    for (int k = 0; k < 3; ++k) {
        s->center[k] = se3di_dual_seed(wheel->center[k], SE3DI_ROAD_CENTER + k, 1.0);
        s->axis[k] = se3di_dual_seed(wheel->axis[k], SE3DI_ROAD_AXIS + k, 1.0);
    }
}

/* The place where the wheel touches a plane, or, radius > 0, is lowest over z = 0: X, Y. */
static void find_foot(const seat *s, const dual normal[3], const dual point[3], double radius,
                      dual foot[2])
{
    const dual sine = dot3(s->axis, normal);
    const dual cosine = se3di_dual_sqrt(se3di_dual_square(1.0, 0.0, -1.0, sine));
    dual length = se3di_dual_of(radius);
    if (!(radius > 0.0)) {
        dual gap[3];
        for (int k = 0; k < 3; ++k) {
            gap[k] = se3di_dual_sub(s->center[k], point[k]);
        }
        length = se3di_dual_div(dot3(normal, gap), cosine);
    }
    const dual share = se3di_dual_div(length, cosine);
    for (int k = 0; k < 2; ++k) {
        const dual down = se3di_dual_sub(se3di_dual_mul(sine, s->axis[k]), normal[k]);
        foot[k] = along(s->center[k], share, down);
    }
}

/* ---- At a point ----------------------------------------------------------------------------*/

/* The plane that touches the road there. */
static se3d_status touch(const se3di_model *model, const se3di_road *road, double time,
                         const dual foot[2], se3di_road_plane *plane)
{
    const double at[3] = {time, foot[0].v, foot[1].v};
    height out;
    SE3DI_TRY(se3di_road_eval(model, road, at, 1, &out));
    const double slope[3] = {out.x, out.y, out.t}, of_x[3] = {out.xx, out.xy, out.xt};
    const double of_y[3] = {out.xy, out.yy, out.yt}, of_t[3] = {out.xt, out.yt, 0.0};
    plane->point[0] = foot[0];
    plane->point[1] = foot[1];
    plane->point[2] = chain3(out.h, slope, foot);
    erect(chain3(out.x, of_x, foot), chain3(out.y, of_y, foot), plane->normal);
    plane->rise = chain3(out.t, of_t, foot);
    return SE3D_OK;
}

static se3d_status find_point_plane(const se3di_model *model, const se3di_road *road,
                                    const se3di_road_wheel *wheel, se3di_road_plane *plane)
{
    const dual up[3] = {{.v = 0.0}, {.v = 0.0}, {.v = 1.0}}, origin[3] = {{.v = 0.0}};
    seat s;
    dual foot[2];
    take_seat(wheel, &s);
    find_foot(&s, up, origin, wheel->radius, foot);
    SE3DI_TRY(touch(model, road, wheel->time, foot, plane));
    const dual sine = dot3(s.axis, plane->normal);
    if (!(sine.v * sine.v < 1.0 - 1e-6)) {
        return SE3D_OK; /* it lies on its side */
    }
    find_foot(&s, plane->normal, plane->point, 0.0, foot);
    return touch(model, road, wheel->time, foot, plane);
}

/* ---- Over obstacles ------------------------------------------------------------------------*/

/* A disc that stands on the road. */
typedef struct disc {
    const se3di_model *model;
    const se3di_road *road;
    double time, radius;
    double at[2], ahead[2]; /* its middle and heading */
    se3d_status status;
} disc;

static void note(disc *d, se3d_status status)
{
    d->status = d->status < 0 ? d->status : status;
}

/* Time and place of a point of it. */
static void find_place(const disc *d, double s, double at[3])
{
    at[0] = d->time;
    at[1] = d->at[0] + s * d->ahead[0];
    at[2] = d->at[1] + s * d->ahead[1];
}

static void look(disc *d, double s, height *out)
{
    double at[3];
    find_place(d, s, at);
    note(d, se3di_road_eval(d->model, d->road, at, 0, out));
}

static double drop(const disc *d, double s)
{
    return d->radius - sqrt(d->radius * d->radius - s * s);
}

/* How high a point of the disc has to be to stand on the road. */
static double lift(disc *d, double s)
{
    double at[3], h = 0.0;
    find_place(d, s, at);
    note(d, eval_height(d->model, d->road, at, &h));
    return h - drop(d, s);
}

/* The same at all samples, from behind to ahead: of a formula several points at a time. */
static void lift_samples(disc *d, double step, double value[ROOM])
{
    const int middle = SAMPLES / 2;
    const se3d_expression *formula = get_formula(d->model, d->road);
    for (int k = 0; k < SAMPLES && !formula; ++k) {
        value[k] = lift(d, (k - middle) * step);
    }
    for (int begin = 0; begin < SAMPLES && formula; begin += SE3DI_EXPRESSION_POINTS) {
        double at[3], all[3][SE3DI_EXPRESSION_POINTS];
        for (int k = 0; k < SE3DI_EXPRESSION_POINTS; ++k) {
            find_place(d, ((begin + k) % SAMPLES - middle) * step, at);
            for (int c = 0; c < 3; ++c) {
                all[c][k] = at[c];
            }
        }
        note(d, se3di_expression_eval_points(formula, all[0], value + begin));
    }
    for (int k = 0; k < SAMPLES && formula; ++k) {
        value[k] -= drop(d, (k - middle) * step);
    }
}

/* d lift / ds; *curve: its own derivative, NaN if it is not known. */
static double climb(disc *d, double s, double *curve)
{
    const se3d_expression *formula = get_formula(d->model, d->road);
    const double ahead[3] = {0.0, d->ahead[0], d->ahead[1]};
    const double square = d->radius * d->radius - s * s, root = sqrt(square);
    double at[3], jet[3];
    height out;
    if (!formula) {
        look(d, s, &out);
        *curve = (double)NAN;
        return out.x * d->ahead[0] + out.y * d->ahead[1] - s / root;
    }
    find_place(d, s, at);
    se3di_expression_eval_along(formula, at, ahead, IN_PLANE, jet);
    note(d, isfinite(jet[0]) && isfinite(jet[1]) ? SE3D_OK : SE3D_ERR_NOT_FINITE);
    *curve = jet[2] - d->radius * d->radius / (square * root);
    return jet[1] - s / root;
}

/* The best of samples, from the middle on. */
static double sample(disc *d, double step, double value[ROOM], double *best)
{
    const int middle = SAMPLES / 2;
    double s = 0.0;
    lift_samples(d, step, value);
    *best = value[middle];
    for (int k = 1; k <= middle; ++k) {
        for (int side = -1; side < 2; side += 2) {
            const double found = value[middle + side * k];
            if (found > *best) {
                *best = found;
                s = side * k * step;
            }
        }
    }
    return s;
}

/* The place where the slope goes through 0 or jumps over it, between low, where it rises, and high,
 * where it falls: by Newton's steps while they stay between and halve, else by secants. */
static double find_top(disc *d, double low, double high, double rise, double fall)
{
    double s = 0.5 * (low + high), step = high - low, newton = (double)NAN;
    for (int k = 0; k < CUTS && high - low > TIGHT * d->radius; ++k) {
        const double secant =
            k % 3 == 2 ? 0.5 * (low + high) : (low * fall - high * rise) / (fall - rise);
        const int takes = newton > low && newton < high && fabs(newton - s) < 0.5 * fabs(step);
        const double next = takes ? newton : secant;
        double curve;
        step = next - s;
        s = next;
        if (takes && fabs(step) < TIGHT * d->radius) {
            return s;
        }
        const double slope = climb(d, s, &curve);
        newton = s - slope / curve;
        if (slope > 0.0) {
            low = s;
            rise = slope;
            fall *= 0.5;
        } else if (slope < 0.0) {
            high = s;
            fall = slope;
            rise *= 0.5;
        } else {
            return s;
        }
    }
    return s;
}

/* By golden sections, as the road has a wall there. */
static double find_brink(disc *d, double low, double high, double s, double *best)
{
    const double golden = 0.61803398874989485;
    double a = high - golden * (high - low), b = low + golden * (high - low);
    double at_a = lift(d, a), at_b = lift(d, b);
    for (int k = 0; k < CUTS; ++k) {
        const int left = at_a > at_b;
        if ((left ? at_a : at_b) > *best) {
            *best = left ? at_a : at_b;
            s = left ? a : b;
        }
        if (left) {
            high = b;
            b = a;
            at_b = at_a;
            a = high - golden * (high - low);
            at_a = lift(d, a);
        } else {
            low = a;
            a = b;
            at_a = at_b;
            b = low + golden * (high - low);
            at_b = lift(d, b);
        }
    }
    return s;
}

/* Between the best sample and its neighbours. */
static double refine(disc *d, double step, double s, double *best)
{
    const double reach = REACH * d->radius;
    const double low = fmax(-reach, s - step), high = fmin(reach, s + step);
    double curve;
    const double here = climb(d, s, &curve);
    if (!(fabs(here) > 0.0)) {
        return s;
    }
    const double rise = here > 0.0 ? here : climb(d, low, &curve);
    const double fall = here < 0.0 ? here : climb(d, high, &curve);
    if (rise > 0.0 && fall < 0.0) {
        const double top = find_top(d, here > 0.0 ? s : low, here < 0.0 ? s : high, rise, fall);
        const double value = lift(d, top);
        if (value >= *best) {
            *best = value;
            return top;
        }
    }
    return find_brink(d, low, high, s, best);
}

/* Whether the lift between two samples is that of the cubic with their slopes, and so without a
 * wall; then its best place, if that is between them, replaces what is lower. */
static int takes_smooth(disc *d, const double end[2], const double value[2], double *s,
                        double *best)
{
    double curve;
    const double step = end[1] - end[0], middle = 0.5 * (end[0] + end[1]);
    const double slope[2] = {climb(d, end[0], &curve), climb(d, end[1], &curve)};
    const double cubic = 0.5 * (value[0] + value[1]) + 0.125 * step * (slope[0] - slope[1]);
    if (!(fabs(lift(d, middle) - cubic) < SMOOTH * step * step / d->radius)) {
        return 0;
    }
    const int is_known = *s > end[0] && *s < end[1];
    if (!is_known && slope[0] > 0.0 && slope[1] < 0.0) {
        const double top = find_top(d, end[0], end[1], slope[0], slope[1]);
        const double found = lift(d, top);
        *s = found > *best ? top : *s;
        *best = fmax(*best, found);
    }
    return 1;
}

/* The place s that the disc stands on, and how high it does. Between two samples the road may be as
 * high as the higher one up to the place of the other: a wall. */
static double find_support(disc *d, double *best)
{
    const double step = 2.0 * REACH * d->radius / (SAMPLES - 1);
    double value[ROOM];
    double s = refine(d, step, sample(d, step, value, best), best);
    for (int k = 0; k + 1 < SAMPLES; ++k) {
        const int from_middle = k - SAMPLES / 2;
        const double low = from_middle * step, end[2] = {low, low + step};
        const double drops[2] = {drop(d, end[0]), drop(d, end[1])};
        const double top = fmax(value[k] + drops[0], value[k + 1] + drops[1]);
        if (top - fmin(drops[0], drops[1]) > *best + TIGHT * d->radius &&
            !takes_smooth(d, end, value + k, &s, best)) {
            s = find_brink(d, end[0], end[1], s, best);
        }
    }
    return s;
}

/* Slopes of w by x, y and t where the disc stands: those of the road a little behind and ahead of
 * it, so mixed that along the heading they are the disc's own. */
static void find_slopes(disc *d, double s, double slope[3])
{
    const double step = EDGE * d->radius, root = sqrt(d->radius * d->radius - s * s);
    height back, front;
    look(d, s - step, &back);
    look(d, s + step, &front);
    const double *e = d->ahead;
    const double along_back = back.x * e[0] + back.y * e[1];
    const double along_front = front.x * e[0] + front.y * e[1];
    const double own = s / root, change = along_front - along_back;
    double share = 0.5;
    if (fabs(change) > 1e-12) {
        share = fmin(1.0, fmax(0.0, (own - along_back) / change));
    }
    slope[0] = back.x + share * (front.x - back.x);
    slope[1] = back.y + share * (front.y - back.y);
    slope[2] = back.t + share * (front.t - back.t);
    const double lacks = own - (slope[0] * e[0] + slope[1] * e[1]);
    if (fabs(s) < (REACH - 1e-6) * d->radius && fabs(lacks) > NOISE) { /* on the brink of a wall */
        slope[0] += lacks * e[0];
        slope[1] += lacks * e[1];
    }
}

/* w of a disc at a place that has derivatives, with its heading. */
static se3d_status stand(disc *d, const dual at[2], const dual ahead[2], dual *w, dual *rise)
{
    double best, slope[3];
    dual touched[2];
    for (int k = 0; k < 2; ++k) {
        d->at[k] = at[k].v;
        d->ahead[k] = ahead[k].v;
    }
    const double s = find_support(d, &best);
    find_slopes(d, s, slope);
    for (int k = 0; k < 2; ++k) {
        touched[k] = along(at[k], se3di_dual_of(s), ahead[k]);
    }
    *w = chain3(best, slope, touched);
    *rise = se3di_dual_add(*rise, se3di_dual_of(0.25 * slope[2]));
    return d->status;
}

static se3d_status find_disc_plane(const se3di_model *model, const se3di_road *road,
                                   const se3di_road_wheel *wheel, se3di_road_plane *plane)
{
    const dual up[3] = {{.v = 0.0}, {.v = 0.0}, {.v = 1.0}}, origin[3] = {{.v = 0.0}};
    disc d = {.model = model, .road = road, .time = wheel->time, .radius = wheel->radius};
    seat s;
    dual foot[2], w[2][2]; /* front, rear; left, right */
    take_seat(wheel, &s);
    find_foot(&s, up, origin, wheel->radius, foot);
    const dual size =
        se3di_dual_sqrt(along(se3di_dual_mul(s.axis[0], s.axis[0]), s.axis[1], s.axis[1]));
    const dual e[2] = {se3di_dual_div(s.axis[1], size),
                       se3di_dual_scale(-1.0, se3di_dual_div(s.axis[0], size))};
    plane->rise = se3di_dual_of(0.0);
    for (int k = 0; k < 4; ++k) {
        const double ahead = k < 2 ? 0.5 : -0.5, left = k % 2 ? -0.5 : 0.5;
        const dual at[2] = {
            se3di_dual_add(
                foot[0],
                se3di_dual_chain2(ahead * wheel->length * e[0].v - left * wheel->width * e[1].v,
                                  ahead * wheel->length, e[0], -left * wheel->width, e[1])),
            se3di_dual_add(
                foot[1],
                se3di_dual_chain2(ahead * wheel->length * e[1].v + left * wheel->width * e[0].v,
                                  ahead * wheel->length, e[1], left * wheel->width, e[0]))};
        SE3DI_TRY(stand(&d, at, e, &w[k / 2][k % 2], &plane->rise));
    }
    const dual front = se3di_dual_add(w[0][0], w[0][1]), rear = se3di_dual_add(w[1][0], w[1][1]);
    const dual left = se3di_dual_add(w[0][0], w[1][0]), right = se3di_dual_add(w[0][1], w[1][1]);
    const dual S_e = se3di_dual_scale(0.5 / wheel->length, se3di_dual_sub(front, rear));
    const dual S_f = se3di_dual_scale(0.5 / wheel->width, se3di_dual_sub(left, right));
    const dual secant = se3di_dual_sqrt(se3di_dual_square(1.0, 0.0, 1.0, S_e));
    erect(se3di_dual_sub(se3di_dual_mul(S_e, e[0]), se3di_dual_mul(S_f, e[1])),
          along(se3di_dual_mul(S_e, e[1]), S_f, e[0]), plane->normal);
    plane->point[0] = foot[0];
    plane->point[1] = foot[1];
    plane->point[2] = se3di_dual_add(se3di_dual_scale(0.25, se3di_dual_add(front, rear)),
                                     se3di_dual_line(wheel->radius, -wheel->radius, secant));
    return SE3D_OK;
}

/* It rises and falls as a whole: discs stand on it as the wheel does at a point. */
static int is_level(const se3di_model *model, const se3di_road *road)
{
    const se3d_expression *formula = get_formula(model, road);
    return formula && !se3di_expression_reads(formula, IN_PLANE);
}

se3d_status se3di_road_find_plane(const se3di_model *model, const se3di_road *road,
                                  const se3di_road_wheel *wheel, se3di_road_plane *plane)
{
    memset(plane, 0, sizeof *plane);
    return wheel->length > 0.0 && !is_level(model, road)
               ? find_disc_plane(model, road, wheel, plane)
               : find_point_plane(model, road, wheel, plane);
}
