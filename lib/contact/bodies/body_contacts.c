/* SPDX-License-Identifier: BSD-3-Clause */
/* Contacts of bodies, evaluated and remembered. */
#include "contact/bodies/body_contacts.h"

#include "contact/bodies/broad.h"
#include "contact/bodies/law.h"
#include "contact/bodies/met.h"
#include "contact/bodies/parted.h"
#include "math/vec3.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define REST   1e-30 /* of places: no length, and no turn */
#define LANDED 1e-6  /* of R*: the overlap from which on the force over it is a stiffness */

/* The first point of a pair of shapes; the list is in order of the pairs. */
static size_t find_pair(const se3di_body_contact *list, size_t count, uint32_t i, uint32_t j)
{
    size_t low = 0, high = count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        const se3di_body_contact *c = &list[middle];
        if (c->shape_i < i || (c->shape_i == i && c->shape_j < j)) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

static const se3di_body_contact *find_memory(const se3di_body_contacts *contacts, size_t at,
                                             uint32_t i, uint32_t j, uint32_t feature)
{
    for (; at < contacts->count; ++at) {
        const se3di_body_contact *c = &contacts->list[at];
        if (c->shape_i != i || c->shape_j != j) {
            return NULL;
        }
        if (c->feature == feature) {
            return c;
        }
    }
    return NULL;
}

/* The points of a pair that are known: where they are in the list, and how many. */
static size_t find_known(const se3di_model *model, uint32_t i, uint32_t j,
                         const se3di_body_contact **known)
{
    const se3di_body_contacts *c = &model->contacts;
    const int is_frozen = se3di_contact_is_frozen(model, i, j);
    const se3di_body_contact *list = is_frozen ? c->list : c->followed;
    const size_t count = is_frozen ? c->count : c->followed_count;
    const size_t first = find_pair(list, count, i, j);
    size_t end = first;
    while (end < count && list[end].shape_i == i && list[end].shape_j == j) {
        ++end;
    }
    *known = list ? list + first : NULL;
    return end - first;
}

typedef struct visit {
    const se3di_model *model;
    double elapsed; /* since the state of what is remembered */
    se3di_contact_visitor visitor;
    void *ctx;
    se3di_pair_visitor keep; /* of a pair that stays; NULL: it is looked at as others are */
    se3di_model *noting;     /* the model, if what is found may be kept */
    int places_only;         /* no forces: those of the step under way are known without */
} visit;

/* What joints leave of places that are 0 is 0, so that those of a body at rest are the same. */
static void clear_rest(se3di_shape_pose *at)
{
    for (int k = 0; k < 9; ++k) {
        at->R[k] = fabs(at->R[k]) < REST ? 0.0 : at->R[k];
    }
    for (int k = 0; k < 3; ++k) {
        at->x[k] = fabs(at->x[k]) < REST ? 0.0 : at->x[k];
    }
}

/* The points in which two shapes touch. */
static void find_manifold(const visit *v, const uint32_t pair[2], se3di_manifold *manifold)
{
    const se3di_model *model = v->model;
    const se3di_shape *a = &model->shapes[pair[0]], *b = &model->shapes[pair[1]];
    se3di_shape_pose at[2];
    se3di_shape_place(a, &model->frames[a->body], &at[0]);
    se3di_shape_place(b, &model->frames[b->body], &at[1]);
    if (se3di_shape_is(a, SE3DI_SHAPE_IS_SURFACE) || se3di_shape_is(b, SE3DI_SHAPE_IS_SURFACE)) {
        clear_rest(&at[0]);
        clear_rest(&at[1]);
        if (se3di_met_find(model, pair, at, manifold)) {
            return;
        }
    }
    se3di_narrow_find(a, &at[0], b, &at[1], manifold);
    if (v->noting) {
        se3di_met_keep(v->noting, pair, at, manifold);
    }
}

/* Both shapes are near enough for a closer look. */
static se3d_status visit_pair(void *ctx, uint32_t i, uint32_t j)
{
    const visit *v = ctx;
    const se3di_model *model = v->model;
    const se3di_body_contact *known;
    if (v->keep && (se3di_contact_is_frozen(model, i, j) || find_known(model, i, j, &known) > 0)) {
        return v->keep(v->ctx, i, j);
    }
    const uint32_t pair[2] = {i, j};
    se3di_manifold manifold;
    se3di_encounter points[SE3DI_MANIFOLD_POINTS];
    find_manifold(v, pair, &manifold);
    size_t memory =
        manifold.count > 0 ? find_pair(model->contacts.list, model->contacts.count, i, j) : 0;
    for (uint32_t k = 0; k < manifold.count; ++k) {
        se3di_encounter *e = &points[k];
        *e = (se3di_encounter){
            .model = model, .at = &manifold.points[k], .shape_i = i, .shape_j = j};
        e->elapsed = v->elapsed;
        e->memory = find_memory(&model->contacts, memory, i, j, manifold.points[k].feature);
        se3di_encounter_place(e);
    }
    se3di_encounter_share(points, manifold.count);
    for (uint32_t k = 0; k < manifold.count; ++k) {
        if (!v->places_only) {
            se3di_encounter_eval(&points[k]);
        }
        SE3DI_TRY(v->visitor(v->ctx, &points[k]));
    }
    return SE3D_OK;
}

se3d_status se3di_contacts_visit(const se3di_model *model, double t, se3di_contact_visitor visitor,
                                 void *ctx)
{
    visit v = {model, t - model->contacts.time, visitor, ctx, NULL, NULL, 0};
    return se3di_broad_visit(model, visit_pair, &v);
}

/* The forces of the state are impulses of the step that led to it. */
static int are_stepped(const se3di_model *model)
{
    return model->contacts.count > 0 && model->contacts.list[0].kind != SE3DI_CONTACT_LAWFUL &&
           model->history_tag != 0;
}

static se3d_status look(void *ctx, uint32_t i, uint32_t j)
{
    const visit *v = ctx;
    const uint32_t pair[2] = {i, j};
    se3di_manifold manifold;
    if (se3di_met_is_kept(v->model, pair)) {
        find_manifold(v, pair, &manifold);
    }
    return SE3D_OK;
}

void se3di_contacts_look(se3di_model *model)
{
    visit v = {.model = model, .noting = model};
    if (model->contacts.met && !are_stepped(model)) {
        (void)se3di_broad_visit(model, look, &v);
    }
}

static se3d_status add_power(void *ctx, const se3di_encounter *e)
{
    double *sum = ctx;
    sum[0] += se3di_encounter_power(e);
    sum[1] += se3di_encounter_fed(e);
    return SE3D_OK;
}

typedef struct wrench_sums {
    double *wrench, *power; /* power NULL: not asked for */
} wrench_sums;

static se3d_status add_wrench(void *ctx, const se3di_encounter *e)
{
    const wrench_sums *sums = ctx;
    double both[12];
    se3di_encounter_wrench(e, both);
    for (int k = 0; k < 12; ++k) {
        sums->wrench[6 * (size_t)e->body[k / 6] + (size_t)(k % 6)] += both[k];
    }
    return sums->power ? add_power(sums->power, e) : SE3D_OK;
}

void se3di_contact_push(const se3di_frame *frame, const double arm[3], double share,
                        const double force[3], double wrench[6])
{
    double torque[3], turned[3];
    se3di_cross(arm, force, torque);
    se3di_mul_transposed(frame->A, torque, turned);
    se3di_add_scaled(share, force, wrench);
    se3di_add_scaled(share, turned, wrench + 3);
}

static void add_stepped_wrench(const se3di_model *model, const se3di_body_contact *c,
                               double *wrench)
{
    for (int k = 0; k < 2; ++k) {
        const uint32_t body = model->shapes[k ? c->shape_j : c->shape_i].body;
        const se3di_frame *frame = &model->frames[body];
        const double sign = k ? 1.0 : -1.0;
        double arm[3], turned[3];
        se3di_sub(c->point, frame->r, arm);
        se3di_contact_push(frame, arm, sign, c->force, wrench + 6 * (size_t)body);
        if (se3di_dot(c->torque, c->torque) > 0.0) { /* few do */
            se3di_mul_transposed(frame->A, c->torque, turned);
            se3di_add_scaled(sign, turned, wrench + 6 * (size_t)body + 3);
        }
    }
}

void se3di_contacts_add_wrenches(const se3di_model *model, double t, double *wrench,
                                 double power[2])
{
    wrench_sums sums = {wrench, power};
    if (power) {
        power[0] = power[1] = 0.0;
    }
    if (are_stepped(model)) {
        for (size_t k = 0; k < model->contacts.count; ++k) {
            const se3di_body_contact *c = &model->contacts.list[k];
            if (!se3di_contact_is_frozen(model, c->shape_i, c->shape_j)) {
                add_stepped_wrench(model, c, wrench);
            }
        }
        return;
    }
    (void)se3di_contacts_visit(model, t, add_wrench, &sums);
}

static se3d_status add_energy(void *ctx, const se3di_encounter *e)
{
    *(double *)ctx += se3di_encounter_energy(e);
    return SE3D_OK;
}

double se3di_contact_stiffness(const se3di_model *model, const se3di_body_contact *contact)
{
    const se3di_shape *i = &model->shapes[contact->shape_i], *j = &model->shapes[contact->shape_j];
    const se3di_pair *pair = se3di_pair_of(model, contact->shape_i, contact->shape_j);
    const double radius = se3di_shapes_contact_radius(i, j);
    switch (pair->law) {
    case SE3DI_LAW_HOOKE:
        return pair->kn;
    case SE3DI_LAW_HERTZ_MINDLIN:
        return 1.5 * pair->kn * sqrt(radius * contact->overlap);
    default: /* as it lands it has a force, and no overlap yet */
        return se3di_norm(contact->force) / fmax(contact->overlap, LANDED * radius);
    }
}

double se3di_contacts_potential(const se3di_model *model, double t)
{
    double sum = 0.0;
    if (are_stepped(model)) {
        for (size_t k = 0; k < model->contacts.count; ++k) {
            sum += model->contacts.list[k].energy;
        }
        return sum;
    }
    (void)se3di_contacts_visit(model, t, add_energy, &sum);
    return sum;
}

void se3di_contacts_power(const se3di_model *model, double t, double power[2])
{
    power[0] = power[1] = 0.0;
    if (!are_stepped(model)) { /* else the step has counted what its impulses did */
        (void)se3di_contacts_visit(model, t, add_power, power);
    }
}

void se3di_contacts_begin(se3di_model *model, double h, double weight, int jumps)
{
    model->contacts.step = h;
    model->contacts.weight = weight;
    model->contacts.jumps = jumps;
}

int se3di_contacts_changed(const se3di_model *model)
{
    return model->contacts.changed;
}

typedef struct preparation {
    se3di_model *model;
    double t;
    double overlap_limit;
    se3di_error *error;
} preparation;

const char *se3di_shape_describe(const se3di_model *model, uint32_t shape)
{
    const se3di_shape *s = &model->shapes[shape];
    const char *body = model->bodies[s->body].name;
    return s->name ? s->name : body ? body : "without a name";
}

void se3di_contacts_describe_depth(const se3di_model *model, const uint32_t shapes[2],
                                   double overlap, char text[SE3DI_DEPTH_SIZE])
{
    const double size = fmin(se3di_shape_contact_size(&model->shapes[shapes[0]]),
                             se3di_shape_contact_size(&model->shapes[shapes[1]]));
    snprintf(text, SE3DI_DEPTH_SIZE,
             "the shapes %.60s and %.60s overlap by %.3g m, at most %g of their size %.3g m is "
             "allowed",
             se3di_shape_describe(model, shapes[0]), se3di_shape_describe(model, shapes[1]),
             overlap, model->contact.overlap_limit, size);
}

static se3d_status check_overlap(const preparation *p, const se3di_encounter *e)
{
    const se3di_model *model = p->model;
    double size = fmin(se3di_shape_contact_size(&model->shapes[e->shape_i]),
                       se3di_shape_contact_size(&model->shapes[e->shape_j]));
    if (e->at->overlap <= p->overlap_limit * size) {
        return SE3D_OK;
    }
    const uint32_t shapes[2] = {e->shape_i, e->shape_j};
    char text[SE3DI_DEPTH_SIZE];
    se3di_contacts_describe_depth(model, shapes, e->at->overlap, text);
    const int moved = p->t > model->time || e->memory;
    se3di_error_set(p->error, SE3D_ERR_STEP_SIZE, "t = %g s: %s; %s", p->t, text,
                    moved ? "try a stiffer material, or a smaller step if one is given"
                          : "move them apart, or let groups say that they do not touch");
    if (p->error) {
        p->error->cause = moved ? SE3DI_CAUSE_OVERLAP : SE3DI_CAUSE_APART;
    }
    return SE3D_ERR_STEP_SIZE;
}

static se3d_status note(void *ctx, const se3di_encounter *e)
{
    const preparation *p = ctx;
    se3di_body_contacts *contacts = &p->model->contacts;
    void *next = contacts->next;
    SE3DI_TRY(check_overlap(p, e));
    if (e->failed) {
        return se3di_error_set(p->error, SE3D_ERR_CALLBACK,
                               "t = %g s: the law of contact failed for the shapes %.60s and %.60s",
                               p->t, se3di_shape_describe(p->model, e->shape_i),
                               se3di_shape_describe(p->model, e->shape_j));
    }
    se3d_status status = se3di_array_reserve(&p->model->allocator, &next, &contacts->next_capacity,
                                             contacts->next_count + 1, sizeof *contacts->next);
    contacts->next = next;
    if (status < 0) {
        return se3di_error_set(p->error, status, "t = %g s: no memory for %zu contacts", p->t,
                               contacts->next_count + 1);
    }
    contacts->kept += e->memory ? 1 : 0;
    se3di_body_contact *record = &contacts->next[contacts->next_count++];
    if (p->model->steps_apart) {
        se3di_encounter_record_place(e, record);
    } else {
        se3di_encounter_record(e, record);
    }
    return SE3D_OK;
}

/* The contacts of two bodies that stay go on as they are, those that are followed as is known. */
static se3d_status keep_pair(void *ctx, uint32_t i, uint32_t j)
{
    preparation *p = ctx;
    se3di_body_contacts *c = &p->model->contacts;
    const se3di_body_contact *known;
    const size_t count = find_known(p->model, i, j, &known);
    void *next = c->next;
    const se3d_status status = se3di_array_reserve(&p->model->allocator, &next, &c->next_capacity,
                                                   c->next_count + count, sizeof *c->next);
    c->next = next;
    if (status < 0) {
        return se3di_error_set(p->error, status, "t = %g s: no memory for %zu contacts", p->t,
                               c->next_count + count);
    }
    if (count > 0) {
        memcpy(c->next + c->next_count, known, count * sizeof *c->next);
    }
    c->next_count += count;
    c->kept += count;
    return SE3D_OK;
}

se3d_status se3di_contacts_reserve(se3di_model *model, double t, se3di_error *error)
{
    se3di_body_contacts *contacts = &model->contacts;
    void *next = contacts->next;
    if (model->shape_slots.count < 2) {
        return SE3D_OK;
    }
    se3d_status status = se3di_broad_update(model);
    if (status == SE3D_OK) {
        status = se3di_array_reserve(&model->allocator, &next, &contacts->next_capacity,
                                     2 * contacts->count + 16, sizeof *contacts->next);
        contacts->next = next;
    }
    return status < 0
               ? se3di_error_set(error, SE3D_ERR_NO_MEMORY, "t = %g s: no memory for contacts", t)
               : SE3D_OK;
}

static se3d_status note_all(se3di_model *model, double t, double overlap_limit, se3di_error *error)
{
    preparation p = {model, t, overlap_limit, error};
    model->contacts.next_count = 0;
    model->contacts.kept = 0;
    model->contacts.next_time = t;
    const int places_only = model->steps_apart;
    visit v = {model, t - model->contacts.time, note, &p, keep_pair, model, places_only};
    return model->shape_slots.count < 2 ? SE3D_OK : se3di_broad_visit(model, visit_pair, &v);
}

static se3d_status prepare(se3di_model *model, double t, double overlap_limit, se3di_error *error)
{
    if (model->shape_slots.count >= 2 && se3di_broad_update(model) < 0) {
        return se3di_error_set(error, SE3D_ERR_NO_MEMORY, "t = %g s: no memory for contacts", t);
    }
    return note_all(model, t, overlap_limit, error);
}

se3d_status se3di_contacts_prepare(se3di_model *model, double t, se3di_error *error)
{
    return prepare(model, t, model->contact.overlap_limit, error);
}

se3d_status se3di_contacts_prepare_any(se3di_model *model, double t, se3di_error *error)
{
    return prepare(model, t, HUGE_VAL, error);
}

/* What the contact does to one of its shapes, about the centre of its body. */
static void add_to_shape(se3di_model *model, const se3di_body_contact *c, uint32_t shape,
                         double sign)
{
    se3di_shape *s = &model->shapes[shape];
    double arm[3], torque[3];
    se3di_sub(c->point, model->frames[s->body].r, arm);
    se3di_cross(arm, c->force, torque);
    se3di_add(torque, c->torque, torque);
    se3di_add_scaled(sign, c->force, s->force);
    se3di_add_scaled(sign, torque, s->torque);
}

static void sum_shapes(se3di_model *model)
{
    for (size_t k = 0; k < model->shape_slots.count; ++k) {
        memset(model->shapes[k].force, 0, sizeof model->shapes[k].force);
        memset(model->shapes[k].torque, 0, sizeof model->shapes[k].torque);
    }
    for (size_t k = 0; k < model->contacts.count; ++k) {
        const se3di_body_contact *c = &model->contacts.list[k];
        add_to_shape(model, c, c->shape_i, -1.0);
        add_to_shape(model, c, c->shape_j, 1.0);
    }
}

static void swap_lists(se3di_model *model)
{
    se3di_body_contacts *c = &model->contacts;
    se3di_body_contact *list = c->list;
    const size_t count = c->count, capacity = c->capacity;
    const double time = c->time;
    c->list = c->next;
    c->time = c->next_time;
    c->next_time = time;
    c->count = c->next_count;
    c->capacity = c->next_capacity;
    c->next = list;
    c->next_count = count;
    c->next_capacity = capacity;
    sum_shapes(model);
}

void se3di_contacts_accept(se3di_model *model)
{
    se3di_body_contacts *c = &model->contacts;
    c->changed = c->kept < c->count || c->kept < c->next_count;
    swap_lists(model);
    c->next_count = 0;
    se3di_joints_part(model);
}

static se3d_status renew_force(void *ctx, const se3di_encounter *e)
{
    se3di_body_contacts *contacts = ctx;
    if (e->memory && !e->failed) {
        se3di_body_contact now;
        se3di_body_contact *record = &contacts->list[e->memory - contacts->list];
        se3di_encounter_record(e, &now);
        se3di_copy(now.force, record->force);
        se3di_copy(now.torque, record->torque);
    }
    return SE3D_OK;
}

void se3di_contacts_renew_forces(se3di_model *model)
{
    if (model->contacts.count > 0) {
        (void)se3di_contacts_visit(model, model->contacts.time, renew_force, &model->contacts);
        sum_shapes(model);
    }
}

se3d_status se3di_contacts_show(se3di_model *model, double t, se3di_error *error)
{
    SE3DI_TRY(note_all(model, t, model->contact.overlap_limit, error));
    swap_lists(model);
    return SE3D_OK;
}

void se3di_contacts_hide(se3di_model *model)
{
    swap_lists(model);
    model->contacts.next_count = 0;
}
