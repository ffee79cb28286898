/* SPDX-License-Identifier: BSD-3-Clause */
#include "contact/bodies/met.h"

#include <stddef.h>
#include <string.h>

#define PAIRS 16 /* that are kept: a power of 2 */

typedef struct met {
    uint32_t pair[2]; /* shapes, ascending; both 0: none */
    uint64_t version; /* of the topology of the model */
    double at[2][12]; /* x, R */
    se3di_manifold manifold;
} met;

static int is_surface(const se3di_model *model, uint32_t shape)
{
    return se3di_shape_is(&model->shapes[shape], SE3DI_SHAPE_IS_SURFACE);
}

se3d_status se3di_met_reserve(se3di_model *model)
{
    se3di_body_contacts *c = &model->contacts;
    int any = 0;
    for (uint32_t k = 0; k < model->shape_slots.count && c->met_bytes == 0; ++k) {
        any = any || is_surface(model, k);
    }
    if (!any) {
        return SE3D_OK;
    }
    const se3d_status status =
        se3di_array_reserve(&model->allocator, &c->met, &c->met_bytes, PAIRS * sizeof(met), 1);
    if (status >= 0) {
        memset(c->met, 0, c->met_bytes);
    }
    return status;
}

static met *place_of(const se3di_model *model, const uint32_t pair[2])
{
    met *list = model->contacts.met;
    const int is_kept = list && (is_surface(model, pair[0]) || is_surface(model, pair[1]));
    return is_kept ? &list[(31 * pair[0] + pair[1]) & (PAIRS - 1)] : NULL;
}

int se3di_met_is_kept(const se3di_model *model, const uint32_t pair[2])
{
    return place_of(model, pair) != NULL;
}

static void get_place(const se3di_shape_pose *at, double out[12])
{
    memcpy(out, at->x, sizeof at->x);
    memcpy(out + 3, at->R, sizeof at->R);
}

int se3di_met_find(const se3di_model *model, const uint32_t pair[2], const se3di_shape_pose at[2],
                   se3di_manifold *manifold)
{
    const met *known = place_of(model, pair);
    double here[2][12];
    if (!known || memcmp(known->pair, pair, sizeof known->pair) != 0 ||
        known->version != model->topology_version) {
        return 0;
    }
    get_place(&at[0], here[0]);
    get_place(&at[1], here[1]);
    if (memcmp(known->at, here, sizeof here) != 0) {
        return 0;
    }
    memcpy(manifold, &known->manifold,
           offsetof(se3di_manifold, points) +
               known->manifold.count * sizeof *known->manifold.points);
    return 1;
}

void se3di_met_keep(se3di_model *model, const uint32_t pair[2], const se3di_shape_pose at[2],
                    const se3di_manifold *manifold)
{
    met *known = place_of(model, pair);
    if (!known) {
        return;
    }
    memcpy(known->pair, pair, sizeof known->pair);
    known->version = model->topology_version;
    get_place(&at[0], known->at[0]);
    get_place(&at[1], known->at[1]);
    memcpy(&known->manifold, manifold,
           offsetof(se3di_manifold, points) + manifold->count * sizeof *manifold->points);
}
