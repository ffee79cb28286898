/* SPDX-License-Identifier: BSD-3-Clause */
#include "analysis/crowd.h"

#include "analysis/stiffness.h"
#include "contact/bodies/crowd.h"
#include "force/driver_rate.h"

#define BOUNCY 0.8 /* restitution above which impacts by convex may give energy */
#define ANGLE  0.5 /* of spins and oscillations in a step [rad] */

static int has_element(const se3di_model *model, int32_t type)
{
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        if (model->forces[k].type == type) {
            return 1;
        }
    }
    return 0;
}

int se3di_crowd_may_touch(const se3di_model *model)
{
    return model->shape_slots.count > 0 && !se3di_model_gravity_varies(model) && !model->sets &&
           model->state_count == 0 && model->contact.law != SE3DI_LAW_CALLBACK &&
           se3di_find_driver_rate(model) == SE3DI_NO_INDEX &&
           !has_element(model, SE3DI_FORCE_TYRE); /* they touch by themselves */
}

int se3di_crowd_suits(const se3di_model *model)
{
    return model->constraint_slots.count == 0 && model->force_slots.count == 0 &&
           se3di_crowd_may_touch(model);
}

/* Shapes of two such materials may touch. */
static int is_used(const se3di_model *model, int32_t material)
{
    for (size_t k = 0; k < model->shape_slots.count; ++k) {
        if (model->shapes[k].material == material) {
            return 1;
        }
    }
    return 0;
}

static int bounces(const se3di_model *model)
{
    const int32_t count = (int32_t)model->material_slots.count;
    for (int32_t i = 0; i < count; ++i) {
        for (int32_t j = 0; j <= i; ++j) {
            if (model->pairs[i * count + j].restitution > BOUNCY && is_used(model, i) &&
                is_used(model, j)) {
                return 1;
            }
        }
    }
    return 0;
}

int se3di_crowd_bears(const se3di_model *model, double h)
{
    return se3di_stiffness_spin(model) * h <= ANGLE && se3di_stiffness_angle(model, h) <= ANGLE &&
           !bounces(model) && !has_element(model, SE3DI_FORCE_CALLBACK);
}

static int may_lie_on(const se3di_model *model, const se3di_shape *mesh, const se3di_shape *s)
{
    return mesh->body != s->body && se3di_shapes_meet(mesh, s) &&
           !(model->bodies[mesh->body].fixed && model->bodies[s->body].fixed) &&
           !se3di_shape_is(s, SE3DI_SHAPE_IS_BALL | SE3DI_SHAPE_IS_HALF_SPACE);
}

int se3di_crowd_has_mesh(const se3di_model *model)
{
    const se3di_shape *shapes = model->shapes;
    for (size_t k = 0; k < model->shape_slots.count; ++k) {
        if (!se3di_shape_is(&shapes[k], SE3DI_SHAPE_IS_SURFACE)) {
            continue;
        }
        for (size_t other = 0; other < model->shape_slots.count; ++other) {
            if (may_lie_on(model, &shapes[k], &shapes[other])) {
                return 1;
            }
        }
    }
    return 0;
}

/* Shapes follow each other body by body, or a body counts once more; what no group and mask lets
 * touch anything does not count. */
int se3di_crowd_has(const se3di_model *model, size_t least)
{
    uint32_t last = UINT32_MAX, groups = 0, masks = 0;
    size_t count = 0;
    for (size_t k = 0; k < model->shape_slots.count; ++k) {
        const se3di_shape *shape = &model->shapes[k];
        groups |= shape->material >= 0 ? shape->group : 0;
        masks |= shape->material >= 0 ? shape->mask : 0;
    }
    for (size_t k = 0; k < model->shape_slots.count && count < least; ++k) {
        const se3di_shape *shape = &model->shapes[k];
        const se3di_body *body = &model->bodies[shape->body];
        const int meets = shape->material >= 0 && (shape->mask & groups) && (shape->group & masks);
        if (meets && !body->fixed && body->state == 0 && shape->body != last) {
            last = shape->body;
            ++count;
        }
    }
    return count >= least;
}
