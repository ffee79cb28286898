/* SPDX-License-Identifier: BSD-3-Clause */
/* What was found of surfaces is used again at exactly the same places of the same model, and
 * nowhere else. */
#include "contact/bodies/body_contacts.h"
#include "contact/bodies/met.h"
#include "contact/shape/shape.h"
#include "support/scene.h"
#include "system/system_internal.h"

#include <string.h>

/* A plate below a funnel, into whose mouth it reaches. */
static scene begin(se3d_body *plate)
{
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.3, 0.5, 1e5);
    se3d_shape_def funnel = scene_shape(&s, scene_ground(&s));
    const double J[3] = {1e-4, 1e-4, 1e-4}, r[3] = {0.0, 0.0, 0.13805};
    *plate = scene_body(&s, 0.1, J, r, scene_zero);
    se3d_shape_def box = scene_shape(&s, *plate);
    se3d_shape made;
    funnel.bottom_radius = 0.02;
    funnel.top_radius = 0.1;
    funnel.length = 0.12;
    funnel.position[2] = 0.2;
    CHECK(se3d_shape_create_funnel(s.system, &funnel, &made) == SE3D_OK);
    box.size[0] = box.size[1] = 0.06;
    box.size[2] = 0.004;
    CHECK(se3d_shape_create_box(s.system, &box, &made) == SE3D_OK);
    scene_solve(&s, SE3D_METHOD_VERLET, SE3D_FORMULATION_ROMEGA, 1e-5, 0.0);
    return s;
}

/* As the pair 0, 1 of the model is placed. */
static int find(const se3di_model *model, se3di_manifold *known, se3di_manifold *fresh)
{
    const uint32_t pair[2] = {0, 1};
    se3di_shape_pose at[2];
    for (int k = 0; k < 2; ++k) {
        const se3di_shape *shape = &model->shapes[k];
        se3di_shape_place(shape, &model->frames[shape->body], &at[k]);
    }
    memset(fresh, 0, sizeof *fresh);
    se3di_narrow_find(&model->shapes[0], &at[0], &model->shapes[1], &at[1], fresh);
    return se3di_met_find(model, pair, at, known);
}

static void surfaces_are_known_where_a_step_has_looked(void)
{
    se3d_body plate;
    scene s = begin(&plate);
    const se3di_model *model = &s.system->model;
    se3di_manifold known, fresh;
    memset(&known, 0, sizeof known);
    CHECK(scene_run(&s, 3e-5));
    CHECK(find(model, &known, &fresh));
    CHECK(known.count > 0 && known.count == fresh.count);
    CHECK(memcmp(known.points, fresh.points, known.count * sizeof *known.points) == 0);
    double r[3];
    CHECK(se3d_body_get_position(s.system, plate, r) == SE3D_OK);
    const double back[3] = {r[0], r[1], r[2]};
    r[0] += 1e-12;
    CHECK(se3d_body_set_position(s.system, plate, r) == SE3D_OK);
    CHECK(!find(model, &known, &fresh)); /* elsewhere */
    CHECK(se3d_body_set_position(s.system, plate, back) == SE3D_OK);
    CHECK(find(model, &known, &fresh));
    se3d_shape_def ball = scene_shape(&s, plate);
    se3d_shape made;
    ball.radius = 0.001;
    CHECK(se3d_shape_create_sphere(s.system, &ball, &made) == SE3D_OK);
    CHECK(!find(model, &known, &fresh)); /* of a model that was edited */
    scene_end(&s);
}

static void without_surfaces_nothing_is_kept(void)
{
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.3, 0.5, 1e5);
    const double r[3] = {0.0, 0.0, 0.1};
    scene_floor(&s, 0.0);
    (void)scene_ball(&s, 0.1, 1.0, r, scene_zero);
    scene_solve(&s, SE3D_METHOD_VERLET, SE3D_FORMULATION_ROMEGA, 1e-5, 0.0);
    CHECK(scene_run(&s, 1e-3));
    CHECK(s.system->model.contacts.met == NULL);
    scene_end(&s);
}

int main(void)
{
    RUN(surfaces_are_known_where_a_step_has_looked);
    RUN(without_surfaces_nothing_is_kept);
    return check_finish();
}
