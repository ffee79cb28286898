/* SPDX-License-Identifier: BSD-3-Clause */
#include "contact/bodies/crowd.h"

#include "contact/bodies/broad.h"
#include "contact/shape/shape.h"

#include <math.h>

#define NEAR 0.1 /* of the smaller shape's size */
#define MOST 64  /* bodies that are told apart */
#define EACH 8.0 /* triangles of the smaller one of two meshes take as long as all else of a step */

typedef struct crowd {
    const se3di_model *model;
    uint32_t bodies[MOST]; /* free ones, each once */
    size_t count;
} crowd;

static void add(crowd *c, uint32_t body)
{
    size_t k = 0;
    while (k < c->count && c->bodies[k] != body) {
        ++k;
    }
    if (k == c->count && c->count < MOST && !c->model->bodies[body].fixed) {
        c->bodies[c->count++] = body;
    }
}

static se3d_status add_if_near(void *ctx, uint32_t i, uint32_t j)
{
    crowd *c = ctx;
    const se3di_shape *a = &c->model->shapes[i], *b = &c->model->shapes[j];
    const double size = fmin(se3di_shape_contact_size(a), se3di_shape_contact_size(b));
    double normal[3];
    if (c->count < SE3DI_CROWD && se3di_shapes_gap(c->model, i, j, normal) <= NEAR * size) {
        add(c, a->body);
        add(c, b->body);
    }
    return SE3D_OK;
}

int se3di_bodies_crowd(const se3di_model *model)
{
    crowd c = {.model = model};
    (void)se3di_broad_visit(model, add_if_near, &c);
    return c.count >= SE3DI_CROWD;
}

size_t se3di_bodies_free(const se3di_model *model)
{
    size_t count = 0;
    for (size_t k = 0; k < model->body_slots.count; ++k) {
        count += !model->bodies[k].fixed;
    }
    return count;
}

static int are_balls(const se3di_model *model, const se3di_body_contact *contact)
{
    return model->shapes[contact->shape_i].kind == SE3DI_SHAPE_SPHERE &&
           model->shapes[contact->shape_j].kind == SE3DI_SHAPE_SPHERE;
}

size_t se3di_bodies_touching(const se3di_model *model)
{
    crowd c = {.model = model};
    for (size_t k = 0; k < model->contacts.count; ++k) {
        const se3di_body_contact *contact = &model->contacts.list[k];
        if (!are_balls(model, contact)) {
            add(&c, model->shapes[contact->shape_i].body);
            add(&c, model->shapes[contact->shape_j].body);
        }
    }
    return c.count;
}

int se3di_bodies_touch(const se3di_model *model)
{
    for (size_t k = 0; k < model->contacts.count; ++k) {
        if (!are_balls(model, &model->contacts.list[k])) {
            return 1;
        }
    }
    return 0;
}

static int is_mesh(const se3di_shape *shape)
{
    return se3di_shape_is(shape, SE3DI_SHAPE_IS_SURFACE) && shape->triangles;
}

typedef struct work {
    const se3di_model *model;
    double sum;
} work;

static se3d_status add_work(void *ctx, uint32_t i, uint32_t j)
{
    work *w = ctx;
    const se3di_shape *a = &w->model->shapes[i], *b = &w->model->shapes[j];
    if (is_mesh(a) && is_mesh(b)) {
        w->sum += fmin((double)a->triangle_count, (double)b->triangle_count) / EACH;
    }
    return SE3D_OK;
}

double se3di_bodies_work(const se3di_model *model)
{
    work w = {.model = model, .sum = 1.0};
    (void)se3di_broad_visit(model, add_work, &w);
    return w.sum;
}
