/* SPDX-License-Identifier: BSD-3-Clause */
/* Shapes that touch: the time of contact of what moves there, from its energy,
 *
 *     T = pi sqrt(m* / kn)                                              hooke
 *     T = 2.943 d / v,  d = (5/4 m* v^2 / (kn sqrt R*))^(2/5)           hertz_mindlin
 *         v^2 = vn^2 + 2 U / m*, U the energy of the spring
 *
 * Shapes that are apart by a gap g, closing at the speed s under gravity: not before
 * g / (s + sqrt(2 a g)) do they touch. A step that long lands where contact begins, and the next
 * one is a small part of T: a contact is neither missed nor met too late.
 * docs/theory/body-contact.md */
#include "contact/bodies/pace.h"

#include "contact/bodies/broad.h"
#include "contact/bodies/law.h"
#include "contact/bodies/pace_stop.h"
#include "force/force.h"
#include "math/elementary.h"
#include "math/over.h"
#include "math/steps.h"
#include "math/vec3.h"

#include <math.h>

#define PARTS        64.0 /* steps in a time of contact where it is followed */
#define LAND_PARTS   16.0 /* if the error is controlled: no step over an event */
#define STABLE_PARTS 3.0  /* fewer are refused */
#define AT_REST      0.1  /* amplitude of a resting contact over the overlaps that are there */
#define PASSING      2.0  /* sizes of the smaller shape in a step: it may pass through */
#define SOFT         1e-6 /* of the smaller size: arrivals that move less in a contact's time */
#define SHORT        1e-6 /* a long step ends so much before contact begins */
#define FACE_POINTS  8.0  /* of shapes other than spheres, which may share a load */
#define AT_LIMIT     (1.0 - 1e-4) /* of the deepest overlap that is allowed */
#define ALL_PAIRS    64 /* up to so many shapes all pairs are looked at, beyond what is listed */

typedef struct pace {
    const se3di_model *model;
    se3di_pace_kind kind;
    int32_t checks; /* only what must not be */
    uint32_t i, j;  /* the shapes that limit it */
    double gravity;
    double step;
} pace;

static void limit(pace *p, double step, uint32_t i, uint32_t j)
{
    if (step < p->step) {
        p->step = step;
        p->i = i;
        p->j = j;
    }
}

/* Speed v without overlap. */
static double contact_time(const se3di_model *model, uint32_t i, uint32_t j, double inverse_mass,
                           double v)
{
    const se3di_pair *pair = se3di_pair_of(model, i, j);
    if (pair->law == SE3DI_LAW_HOOKE) {
        return se3di_over(3.14159265358979324, sqrt(pair->kn * inverse_mass));
    }
    double R = se3di_shapes_contact_radius(&model->shapes[i], &model->shapes[j]);
    if (!(v > 0.0)) {
        return HUGE_VAL;
    }
    return 2.943 * se3di_pow(se3di_over(1.25 * v * v, inverse_mass * pair->kn * sqrt(R)), 0.4) / v;
}

static void velocity_at(const se3di_frame *frame, const double point[3], double v[3])
{
    double w[3], arm[3];
    se3di_mul(frame->A, frame->w, w);
    se3di_sub(point, frame->r, arm);
    se3di_cross(w, arm, v);
    se3di_add(v, frame->v, v);
}

static void acceleration_at(const se3di_model *model, uint32_t body, const double point[3],
                            double out[3])
{
    const double *a = model->acceleration + 6 * (size_t)body;
    const se3di_frame *frame = &model->frames[body];
    double turn[3], arm[3], w[3], x[3];
    se3di_sub(point, frame->r, arm);
    se3di_mul(frame->A, a + 3, turn);
    se3di_cross(turn, arm, out);
    se3di_mul(frame->A, frame->w, w);
    se3di_cross(w, arm, x);
    se3di_cross(w, x, x);
    se3di_add(out, x, out);
    se3di_add(out, a, out);
}

static double parts_of(const pace *p)
{
    return p->kind == SE3DI_PACE_ADAPTIVE ? LAND_PARTS : PARTS;
}

/* Of body j relative to i at their contact, along its normal. */
static double normal_acceleration(const se3di_model *model, const uint32_t body[2],
                                  const se3di_body_contact *c)
{
    double a[2][3];
    for (int k = 0; k < 2; ++k) {
        acceleration_at(model, body[k], c->point, a[k]);
    }
    se3di_sub(a[1], a[0], a[1]);
    return se3di_dot(a[1], c->normal);
}

/* A contact at the last accepted state. */
static void touching(pace *p, const se3di_body_contact *c)
{
    const se3di_model *model = p->model;
    const uint32_t body[2] = {model->shapes[c->shape_i].body, model->shapes[c->shape_j].body};
    const se3di_pair *pair = se3di_pair_of(model, c->shape_i, c->shape_j);
    double v[2][3];
    for (int k = 0; k < 2; ++k) {
        velocity_at(&model->frames[body[k]], c->point, v[k]);
    }
    se3di_sub(v[1], v[0], v[1]);
    double vn = se3di_dot(v[1], c->normal);
    double potential = 0.5 * pair->kn * c->overlap * c->overlap;
    if (se3di_pair_is_hertz(pair)) {
        double R =
            se3di_shapes_contact_radius(&model->shapes[c->shape_i], &model->shapes[c->shape_j]);
        potential *= 0.8 * sqrt(R * c->overlap);
    }
    double energetic = sqrt(vn * vn + 2.0 * potential * c->inverse_mass);
    double time = contact_time(model, c->shape_i, c->shape_j, c->inverse_mass, energetic);
    double rate = se3di_over(3.14159265358979324, time);
    /* Of what slides and turns, an is not that of the gap: control of the error sees the force. */
    const double bent = p->kind == SE3DI_PACE_ADAPTIVE
                            ? 0.0
                            : se3di_over(normal_acceleration(model, body, c), rate * rate);
    int rests = se3di_hypot(se3di_over(vn, rate), bent) < AT_REST * c->overlap;
    if (p->kind == SE3DI_PACE_EXPLICIT || (!p->checks && !rests)) {
        limit(p, time / (p->checks ? STABLE_PARTS : parts_of(p)), c->shape_i, c->shape_j);
    }
}

/* The speed of a shape's centre, and what turning adds elsewhere. */
static double turning_speed(const se3di_model *model, uint32_t shape, double center[3], double v[3])
{
    const se3di_shape *s = &model->shapes[shape];
    const se3di_frame *frame = &model->frames[s->body];
    se3di_mul(frame->A, s->x, center);
    se3di_add(center, frame->r, center);
    velocity_at(frame, center, v);
    return se3di_shape_is(s, SE3DI_SHAPE_IS_BALL | SE3DI_SHAPE_IS_HALF_SPACE)
               ? 0.0
               : se3di_norm(frame->w) * s->bound;
}

static double inverse_mass(const se3di_model *model, uint32_t i, uint32_t j)
{
    double sum = 0.0;
    const uint32_t body[2] = {model->shapes[i].body, model->shapes[j].body};
    for (int k = 0; k < 2; ++k) {
        sum += model->bodies[body[k]].fixed ? 0.0 : 1.0 / model->bodies[body[k]].mass;
    }
    return sum;
}

/* The gap between two shapes and a bound on the speed at which it closes; 0 if they do not meet
 * within a step of h, or not at all, or touch. */
static int meet(const pace *p, uint32_t i, uint32_t j, double h, double *gap, double *closing)
{
    const se3di_model *model = p->model;
    const se3di_shape *s[2] = {&model->shapes[i], &model->shapes[j]};
    double x[2][3], v[2][3], n[3];
    if (s[0]->body == s[1]->body ||
        (model->bodies[s[0]->body].fixed && model->bodies[s[1]->body].fixed)) {
        return 0;
    }
    double turning = turning_speed(model, i, x[0], v[0]) + turning_speed(model, j, x[1], v[1]);
    for (int k = 0; k < 2; ++k) { /* a plane that turns: as fast as it does where the other is */
        if (se3di_shape_is(s[k], SE3DI_SHAPE_IS_HALF_SPACE)) {
            const se3di_frame *frame = &model->frames[s[k]->body];
            velocity_at(frame, x[1 - k], v[k]);
            turning += se3di_norm(frame->w) * s[1 - k]->bound;
        }
    }
    se3di_sub(v[1], v[0], v[1]);
    double speed = se3di_norm(v[1]) + turning;
    double bound = se3di_shapes_gap_bound(model, i, j);
    /* so far that gap > h (speed + sqrt(2 g gap)) */
    const double far = h * (2.0 * speed + 3.0 * p->gravity * h);
    if (!(bound < h * (speed + p->gravity * h)) || se3di_shapes_are_beyond(model, i, j, far) ||
        !se3di_shapes_may_touch(model, i, j)) {
        return 0;
    }
    *gap = se3di_shapes_gap(model, i, j, n);
    if (se3di_dot(n, n) > 0.0) {
        speed = fmax(0.0, -se3di_dot(v[1], n)) + turning;
    }
    *closing = speed + sqrt(2.0 * p->gravity * *gap);
    return *gap <= h * *closing;
}

static double smaller_size(const se3di_model *model, uint32_t i, uint32_t j)
{
    return fmin(se3di_shape_contact_size(&model->shapes[i]),
                se3di_shape_contact_size(&model->shapes[j]));
}

/* Two shapes that do not touch, but may. */
static void approaching(pace *p, uint32_t i, uint32_t j)
{
    const se3di_model *model = p->model;
    double gap, closing;
    if (!meet(p, i, j, p->step, &gap, &closing)) {
        return;
    }
    double points = se3di_shape_is(&model->shapes[i], SE3DI_SHAPE_IS_BALL) ||
                            se3di_shape_is(&model->shapes[j], SE3DI_SHAPE_IS_BALL)
                        ? 1.0
                        : FACE_POINTS;
    double time = contact_time(model, i, j, points * inverse_mass(model, i, j), closing);
    double size = smaller_size(model, i, j);
    if (p->checks && closing * p->step > PASSING * size) {
        limit(p, PASSING * size / closing, i, j);
    } else if (!p->checks && closing * time > SOFT * size) {
        double deep = 0.5 * model->contact.overlap_limit * size / closing;
        limit(p, fmax((1.0 - SHORT) * gap / closing, fmin(time / parts_of(p), deep)), i, j);
    }
}

/* Shapes that are not listed are farther apart than half the margin of the list. */
static void unlisted(pace *p)
{
    const se3di_model *model = p->model;
    double fastest = 0.0, x[3], v[3];
    for (uint32_t k = 0; k < model->shape_slots.count; ++k) {
        if (!model->bodies[model->shapes[k].body].fixed) {
            (void)turning_speed(model, k, x, v);
            fastest = fmax(fastest, se3di_norm(v));
        }
    }
    double room = 0.25 * model->contacts.margin;
    limit(p, room / (fastest + sqrt(2.0 * p->gravity * room)), 0, 0);
}

static int is_touching(const se3di_model *model, size_t *at, uint32_t i, uint32_t j)
{
    const se3di_body_contacts *c = &model->contacts;
    while (*at < c->count &&
           (c->list[*at].shape_i < i || (c->list[*at].shape_i == i && c->list[*at].shape_j < j))) {
        ++*at;
    }
    return *at < c->count && c->list[*at].shape_i == i && c->list[*at].shape_j == j;
}

static void look_around(pace *p)
{
    const se3di_model *model = p->model;
    const se3di_body_contacts *c = &model->contacts;
    uint32_t shapes = (uint32_t)model->shape_slots.count;
    size_t at = 0;
    if (shapes > ALL_PAIRS) {
        unlisted(p);
        for (size_t k = 0; k < c->pair_count; ++k) {
            if (!is_touching(model, &at, c->pairs[2 * k], c->pairs[2 * k + 1])) {
                approaching(p, c->pairs[2 * k], c->pairs[2 * k + 1]);
            }
        }
        return;
    }
    for (uint32_t i = 0; i < shapes; ++i) {
        for (uint32_t j = i + 1; j < shapes; ++j) {
            if (!is_touching(model, &at, i, j)) {
                approaching(p, i, j);
            }
        }
    }
}

static void look(pace *p)
{
    const se3di_model *model = p->model;
    double g[3] = {0.0, 0.0, 0.0};
    if (model->shape_slots.count < 2) {
        return;
    }
    (void)se3di_gravity_eval(model, model->time, g, NULL);
    p->gravity = se3di_norm(g);
    for (size_t k = 0; k < model->contacts.count; ++k) {
        touching(p, &model->contacts.list[k]);
    }
    look_around(p);
}

double se3di_contacts_pace(const se3di_model *model, se3di_pace_kind kind, double h)
{
    pace p = {.model = model, .kind = kind, .step = h};
    look(&p);
    return se3di_stops_pace(model, kind, p.step);
}

double se3di_contacts_next_step(const se3di_model *model, se3di_pace_kind kind, double h,
                                double t_end)
{
    double rest = t_end - model->time;
    double step = rest / se3di_steps_count(rest, h, t_end);
    double paced = se3di_contacts_pace(model, kind, step);
    return paced < step && rest < 2.0 * paced ? 0.5 * rest : paced;
}

se3d_status se3di_shapes_check_step(const se3di_model *model, se3di_pace_kind kind, double h,
                                    se3di_error *error)
{
    pace p = {.model = model, .kind = kind, .checks = 1, .step = h};
    look(&p);
    if (!(p.step < h)) {
        return SE3D_OK;
    }
    return se3di_error_set(error, SE3D_ERR_STEP_SIZE,
                           "t = %g s: a step of %g s is too large for the contact of the shapes "
                           "%.60s and %.60s; try at most %.3g s, or a run that chooses its steps",
                           model->time, h, se3di_shape_describe(model, p.i),
                           se3di_shape_describe(model, p.j), p.step);
}

se3d_status se3di_contacts_check_step(const se3di_model *model, se3di_pace_kind kind, double h,
                                      se3di_error *error)
{
    SE3DI_TRY(se3di_shapes_check_step(model, kind, h, error));
    return se3di_stops_check_step(model, kind, h, error);
}

/* The pair that is nearest to each other. */
static void nearest_pair(pace *p, uint32_t i, uint32_t j)
{
    const se3di_model *model = p->model;
    double n[3];
    if (!(se3di_shapes_gap_bound(model, i, j) < p->step) || !se3di_shapes_may_touch(model, i, j)) {
        return;
    }
    limit(p, se3di_shapes_gap(model, i, j, n), i, j);
}

/* The pair with the largest force, or, if none touch, the nearest. */
static void find_culprits(pace *p)
{
    const se3di_body_contacts *c = &p->model->contacts;
    const uint32_t shapes = (uint32_t)p->model->shape_slots.count;
    for (size_t k = 0; k < c->count; ++k) {
        limit(p, -se3di_norm(c->list[k].force), c->list[k].shape_i, c->list[k].shape_j);
    }
    for (uint32_t i = 0; c->count == 0 && shapes <= ALL_PAIRS && i < shapes; ++i) {
        for (uint32_t j = i + 1; j < shapes; ++j) {
            nearest_pair(p, i, j);
        }
    }
    for (size_t k = 0; c->count == 0 && shapes > ALL_PAIRS && k < c->pair_count; ++k) {
        nearest_pair(p, c->pairs[2 * k], c->pairs[2 * k + 1]);
    }
}

/* The deepest contact, if it is as deep as is allowed but for a trace: steps shrink to that. */
static const se3di_body_contact *find_deepest(const se3di_model *model)
{
    const se3di_body_contacts *c = &model->contacts;
    const se3di_body_contact *deepest = NULL;
    double most = AT_LIMIT * model->contact.overlap_limit;
    for (size_t k = 0; k < c->count; ++k) {
        const double share =
            c->list[k].overlap / smaller_size(model, c->list[k].shape_i, c->list[k].shape_j);
        if (share > most) {
            most = share;
            deepest = &c->list[k];
        }
    }
    return deepest;
}

/* Steps shrink towards a depth that is not allowed: that alone is told, not the steps. */
static void blame_depth(const se3di_model *model, const se3di_body_contact *deepest,
                        se3di_error *error)
{
    const uint32_t shapes[2] = {deepest->shape_i, deepest->shape_j};
    char text[SE3DI_DEPTH_SIZE];
    se3di_contacts_describe_depth(model, shapes, deepest->overlap, text);
    (void)se3di_error_set(error, SE3D_ERR_STEP_SIZE, "%s; try a stiffer material", text);
    error->cause = SE3DI_CAUSE_OVERLAP;
}

void se3di_contacts_blame(const se3di_model *model, se3di_error *error)
{
    pace p = {.model = model, .step = HUGE_VAL};
    if (!error || error->status == SE3D_ERR_CALLBACK || error->status == SE3D_ERR_NO_MEMORY ||
        error->cause == SE3DI_CAUSE_OVERLAP || error->cause == SE3DI_CAUSE_APART) {
        return; /* no shape is to blame, or two are blamed */
    }
    const se3di_body_contact *deepest = find_deepest(model);
    if (deepest && error->status == SE3D_ERR_STEP_SIZE) {
        blame_depth(model, deepest, error);
        return;
    }
    find_culprits(&p);
    if (p.i != p.j) {
        se3di_error_append(error, "; the shapes %.60s and %.60s %s",
                           se3di_shape_describe(model, p.i), se3di_shape_describe(model, p.j),
                           model->contacts.count > 0 ? "have the largest contact force"
                                                     : "are about to touch");
    }
}
