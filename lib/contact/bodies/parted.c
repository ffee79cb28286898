/* SPDX-License-Identifier: BSD-3-Clause */
/* When bodies of a joint that broke begin to touch: once they have been apart.
 *                                                                    docs/theory/body-contact.md */
#include "contact/bodies/parted.h"

#include "contact/bodies/broad.h"
#include "contact/bodies/joined.h"
#include "contact/narrow/narrow.h"

static int overlap(const se3di_model *model, uint32_t i, uint32_t j)
{
    const se3di_shape *a = &model->shapes[i], *b = &model->shapes[j];
    se3di_shape_pose at_a, at_b;
    se3di_manifold manifold;
    if (!(se3di_shapes_gap_bound(model, i, j) < 0.0)) {
        return 0;
    }
    se3di_shape_place(a, &model->frames[a->body], &at_a);
    se3di_shape_place(b, &model->frames[b->body], &at_b);
    se3di_narrow_find(a, &at_a, b, &at_b, &manifold);
    return manifold.count > 0;
}

static int is_of(const se3di_constraint *c, uint32_t body)
{
    uint32_t k = 0;
    while (k < c->body_count && c->bodies[k] != body) {
        ++k;
    }
    return k < c->body_count;
}

/* All that would touch but for the joint. Of many shapes only those of its bodies meet the rest. */
static int are_apart(const se3di_model *model, const se3di_constraint *c)
{
    const uint32_t shapes = (uint32_t)model->shape_slots.count;
    for (uint32_t i = 0; i < shapes; ++i) {
        const se3di_shape *a = &model->shapes[i];
        for (uint32_t j = i + 1; is_of(c, a->body) && j < shapes; ++j) {
            const se3di_shape *b = &model->shapes[j];
            if (b->body != a->body && se3di_shapes_meet(a, b) &&
                se3di_joint_keeps_apart(model, c, a, b) && overlap(model, i, j)) {
                return 0;
            }
        }
    }
    return 1;
}

void se3di_joints_part(se3di_model *model)
{
    for (size_t k = 0; model->broken_count > 0 && k < model->constraint_slots.count; ++k) {
        const se3di_constraint *c = &model->constraints[k];
        if (!se3di_is_broken(c, model->rows) ||
            (model->rows[c->row_begin].left_out & SE3DI_ROW_PARTED) || !are_apart(model, c)) {
            continue;
        }
        for (uint32_t r = 0; r < c->row_count; ++r) {
            model->rows[c->row_begin + r].left_out |= SE3DI_ROW_PARTED;
        }
        model->contacts.version = 0; /* others may touch */
    }
}
