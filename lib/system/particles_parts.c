/* SPDX-License-Identifier: BSD-3-Clause */
/* Materials and walls of particles; contacts as they are. */
#include "contact/restitution.h"
#include "math/quaternion.h"
#include "math/vec3.h"
#include "system/particles.h"

#include <math.h>
#include <string.h>

void se3d_material_def_init(se3d_material_def *def, size_t size)
{
    se3d_material_def defaults = {.struct_size = size,
                                  .friction = 0.5,
                                  .restitution = 0.5,
                                  .tangential_ratio = 2.0 / 7.0,
                                  .poisson = 0.3};
    se3di_def_init(def, size, &defaults, sizeof defaults);
}

void se3d_material_pair_def_init(se3d_material_pair_def *def, size_t size)
{
    se3d_material_pair_def defaults = {size, -1.0, -1.0, -1.0, -1.0, -1.0};
    se3di_def_init(def, size, &defaults, sizeof defaults);
}

void se3d_wall_def_init(se3d_wall_def *def, size_t size)
{
    se3d_wall_def defaults = {
        .struct_size = size, .normal = {0.0, 0.0, 1.0}, .orientation = {1.0, 0.0, 0.0, 0.0}};
    se3di_def_init(def, size, &defaults, sizeof defaults);
}

se3d_status se3di_find_material(se3d_particles *particles, const char *what, se3d_material material,
                                uint32_t *index)
{
    *index = se3di_slots_find(&particles->set.material_slots, material.index1, material.generation);
    if (*index != SE3DI_NO_INDEX) {
        return SE3D_OK;
    }
    return SE3DI_FAIL(particles->system, SE3D_ERR_STALE_HANDLE, "%s %s", what,
                      material.index1 == 0 ? "is the null handle" : "belongs to other particles");
}

static se3d_status check_material(se3d_particles *p, const se3d_material_def *def)
{
    const double least = 1e-30;
    const double most = 1e30;
    int hooke = p->set.law == SE3DI_LAW_HOOKE;
    SE3DI_TRY(se3di_check_range(p, "density", def->density, least, most));
    SE3DI_TRY(se3di_check_range(p, "friction", def->friction, 0.0, most));
    SE3DI_TRY(se3di_check_range(p, "restitution", def->restitution, SE3DI_RESTITUTION_MIN, 1.0));
    SE3DI_TRY(se3di_check_range(p, "rolling_friction", def->rolling_friction, 0.0, most));
    SE3DI_TRY(se3di_check_range(p, "torsional_friction", def->torsional_friction, 0.0, most));
    SE3DI_TRY(se3di_check_range(p, "stiffness", def->stiffness, hooke ? least : 0.0, most));
    SE3DI_TRY(se3di_check_range(p, "tangential_ratio", def->tangential_ratio, 0.0, 10.0));
    SE3DI_TRY(se3di_check_range(p, "young", def->young, hooke ? 0.0 : least, most));
    return se3di_check_range(p, "poisson", def->poisson, 0.0, 0.5);
}

se3d_status se3d_material_create(se3d_particles *particles, const se3d_material_def *def,
                                 se3d_material *material)
{
    if (material) {
        *material = (se3d_material){0, 0};
    }
    if (!particles) {
        return SE3D_ERR_NULL;
    }
    SE3DI_TRY(se3di_check_pointer(particles->system, "material", material));
    se3d_material_def full = se3d_material_def_default();
    SE3DI_TRY(se3di_check_def(particles->system, "material def", def, &full, sizeof full));
    SE3DI_TRY(check_material(particles, &full));
    se3di_material data = {.density = full.density,
                           .young = full.young,
                           .poisson = full.poisson,
                           .friction = full.friction,
                           .restitution = full.restitution,
                           .rolling_friction = full.rolling_friction,
                           .torsional_friction = full.torsional_friction,
                           .stiffness = full.stiffness,
                           .tangential_ratio = full.tangential_ratio};
    se3di_handle handle;
    if (se3di_particles_add_material(&particles->set, &data, &handle) < 0) {
        return SE3DI_FAIL(particles->system, SE3D_ERR_NO_MEMORY, "no memory for a material");
    }
    *material = (se3d_material){handle.index1, handle.generation};
    return SE3D_OK;
}

se3d_status se3d_material_set_pair(se3d_particles *particles, se3d_material a, se3d_material b,
                                   const se3d_material_pair_def *def)
{
    if (!particles) {
        return SE3D_ERR_NULL;
    }
    uint32_t index_a, index_b;
    SE3DI_TRY(se3di_find_material(particles, "material a", a, &index_a));
    SE3DI_TRY(se3di_find_material(particles, "material b", b, &index_b));
    se3d_material_pair_def full = se3d_material_pair_def_default();
    SE3DI_TRY(se3di_check_def(particles->system, "pair def", def, &full, sizeof full));
    const double values[5] = {full.friction, full.restitution, full.rolling_friction,
                              full.torsional_friction, full.stiffness};
    static const char *const names[5] = {"friction", "restitution", "rolling_friction",
                                         "torsional_friction", "stiffness"};
    for (int k = 0; k < 5; ++k) {
        const double least = k == 1 ? SE3DI_RESTITUTION_MIN : k == 4 ? 1e-30 : 0.0;
        if (!(values[k] < 0.0)) {
            SE3DI_TRY(
                se3di_check_range(particles, names[k], values[k], least, k == 1 ? 1.0 : 1e30));
        }
    }
    const se3di_override over = {full.friction, full.restitution, full.rolling_friction,
                                 full.torsional_friction, full.stiffness};
    if (se3di_particles_set_override(&particles->set, index_a, index_b, &over) < 0) {
        return SE3DI_FAIL(particles->system, SE3D_ERR_NO_MEMORY, "no memory to change a pair");
    }
    return SE3D_OK;
}

/* A frame whose third axis is the unit vector n: columns of R. */
static void frame_about(const double n[3], double R[9])
{
    int least = fabs(n[0]) <= fabs(n[1]) && fabs(n[0]) <= fabs(n[2]) ? 0
                : fabs(n[1]) <= fabs(n[2])                           ? 1
                                                                     : 2;
    double e[3] = {least == 0 ? 1.0 : 0.0, least == 1 ? 1.0 : 0.0, least == 2 ? 1.0 : 0.0};
    double s[3], t[3];
    se3di_cross(n, e, s);
    se3di_scale(1.0 / se3di_norm(s), s, s);
    se3di_cross(n, s, t);
    for (int a = 0; a < 3; ++a) {
        R[3 * a] = s[a];
        R[3 * a + 1] = t[a];
        R[3 * a + 2] = n[a];
    }
}

static se3d_status wall_body(se3d_particles *particles, se3d_body given, se3di_wall *wall)
{
    se3d_body body = given;
    if (body.index1 == 0 && body.generation == 0) {
        SE3DI_TRY(se3d_system_get_ground(particles->system, &body));
    }
    wall->body_index1 = body.index1;
    wall->body_generation = body.generation;
    return se3di_find_body(particles->system, "body", body, &wall->body);
}

static se3d_status wall_shape(se3d_particles *particles, const se3d_wall_def *def, se3di_wall *wall)
{
    if (wall->kind == SE3DI_WALL_PLANE) {
        double normal[3];
        SE3DI_TRY(se3di_check_direction(particles->system, "normal", def->normal, normal));
        frame_about(normal, wall->A);
        return SE3D_OK;
    }
    double p[4];
    SE3DI_TRY(se3di_check_orientation(particles->system, "orientation", def->orientation, p));
    se3di_quat_to_matrix(p, wall->A);
    for (int a = 0; a < 3; ++a) {
        SE3DI_TRY(se3di_check_range(particles, "size", def->size[a], 1e-30, 1e30));
        wall->half[a] = 0.5 * def->size[a];
    }
    return SE3D_OK;
}

static se3d_status create_wall(se3d_particles *particles, const se3d_wall_def *def,
                               se3di_wall_kind kind, se3d_wall *out)
{
    if (out) {
        *out = (se3d_wall){0, 0};
    }
    if (!particles) {
        return SE3D_ERR_NULL;
    }
    SE3DI_TRY(se3di_check_pointer(particles->system, "wall", out));
    se3d_wall_def full = se3d_wall_def_default();
    se3di_wall wall = {.kind = (int32_t)kind};
    SE3DI_TRY(se3di_check_def(particles->system, "wall def", def, &full, sizeof full));
    SE3DI_TRY(wall_body(particles, full.body, &wall));
    SE3DI_TRY(se3di_find_material(particles, "material", full.material, &wall.material));
    SE3DI_TRY(se3di_check_finites(particles->system, "point", full.point, 3));
    SE3DI_TRY(wall_shape(particles, &full, &wall));
    se3di_copy(full.point, wall.point);
    se3di_handle handle;
    if (se3di_particles_add_wall(&particles->set, &wall, &handle) < 0) {
        return SE3DI_FAIL(particles->system, SE3D_ERR_NO_MEMORY, "no memory for a wall");
    }
    ++particles->system->model.bodies[wall.body].users;
    *out = (se3d_wall){handle.index1, handle.generation};
    return SE3D_OK;
}

se3d_status se3d_wall_create_plane(se3d_particles *particles, const se3d_wall_def *def,
                                   se3d_wall *wall)
{
    return create_wall(particles, def, SE3DI_WALL_PLANE, wall);
}

se3d_status se3d_wall_create_box(se3d_particles *particles, const se3d_wall_def *def,
                                 se3d_wall *wall)
{
    return create_wall(particles, def, SE3DI_WALL_BOX, wall);
}

static uint32_t find_wall(const se3d_particles *particles, se3d_wall wall)
{
    return se3di_slots_find(&particles->set.wall_slots, wall.index1, wall.generation);
}

se3d_status se3d_wall_destroy(se3d_particles *particles, se3d_wall wall)
{
    if (!particles) {
        return SE3D_ERR_NULL;
    }
    uint32_t index = find_wall(particles, wall);
    if (index == SE3DI_NO_INDEX) {
        return SE3DI_FAIL(particles->system, SE3D_ERR_STALE_HANDLE, "wall %s",
                          wall.index1 == 0 ? "is the null handle"
                                           : "was destroyed or belongs to other particles");
    }
    se3di_wall gone = particles->set.walls[index];
    if (se3di_particles_remove_wall(&particles->set, index) < 0) {
        return SE3DI_FAIL(particles->system, SE3D_ERR_NO_MEMORY, "no memory to destroy a wall");
    }
    se3di_model *model = &particles->system->model;
    --model->bodies[se3di_slots_find(&model->body_slots, gone.body_index1, gone.body_generation)]
          .users;
    return SE3D_OK;
}

se3d_status se3d_wall_get_force(const se3d_particles *particles, se3d_wall wall, double force[3],
                                double torque[3])
{
    if (!particles || !force || !torque) {
        return SE3D_ERR_NULL;
    }
    uint32_t index = find_wall(particles, wall);
    if (index == SE3DI_NO_INDEX) {
        return SE3D_ERR_STALE_HANDLE;
    }
    se3di_copy(particles->set.walls[index].force, force);
    se3di_copy(particles->set.walls[index].torque, torque);
    return SE3D_OK;
}

se3d_status se3d_particles_get_wrench(const se3d_particles *particles, se3d_body body,
                                      double force[3], double torque[3])
{
    if (!particles || !force || !torque) {
        return SE3D_ERR_NULL;
    }
    const se3di_model *model = &particles->system->model;
    if (se3di_slots_find(&model->body_slots, body.index1, body.generation) == SE3DI_NO_INDEX) {
        return SE3D_ERR_STALE_HANDLE;
    }
    memset(force, 0, 3 * sizeof *force);
    memset(torque, 0, 3 * sizeof *torque);
    for (size_t k = 0; k < particles->set.wall_slots.count; ++k) {
        const se3di_wall *wall = &particles->set.walls[k];
        if (wall->body_index1 == body.index1 && wall->body_generation == body.generation) {
            se3di_add(force, wall->force, force);
            se3di_add(torque, wall->torque, torque);
        }
    }
    return SE3D_OK;
}

size_t se3d_particles_count_contacts(const se3d_particles *particles)
{
    size_t count = 0;
    (void)se3di_particles_contacts(particles ? &particles->set : NULL, SIZE_MAX, NULL, &count);
    return count;
}

se3d_status se3d_particles_get_contacts(const se3d_particles *particles, size_t count,
                                        se3d_contact *contacts)
{
    if (!particles || !contacts) {
        return SE3D_ERR_NULL;
    }
    size_t found = 0;
    (void)se3di_particles_contacts(&particles->set, SIZE_MAX, NULL, &found);
    if (found != count) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    return se3di_particles_contacts(&particles->set, count, contacts, &found);
}
