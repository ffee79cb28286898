/* SPDX-License-Identifier: BSD-3-Clause */
/* Servo walls. */
#include "particles/servo.h"

#include "base/sized.h"
#include "math/vec3.h"
#include "se3d/servo.h"
#include "system/particles.h"

#define MOST 1e30

void se3d_servo_def_init(se3d_servo_def *def, size_t size)
{
    se3d_servo_def defaults = {.struct_size = size};
    se3di_def_init(def, size, &defaults, sizeof defaults);
}

static se3d_status check_numbers(se3d_system *system, const se3d_servo_def *def)
{
    SE3DI_TRY(se3di_check_finites(system, "axis", def->axis, 3));
    SE3DI_TRY(se3di_check_range(system, "load", def->load, -MOST, MOST));
    SE3DI_TRY(se3di_check_range(system, "area", def->area, 0.0, MOST));
    SE3DI_TRY(se3di_check_range(system, "speed_max", def->speed_max, 1e-30, MOST));
    SE3DI_TRY(se3di_check_range(system, "gain", def->gain, 0.0, MOST));
    SE3DI_TRY(se3di_check_range(system, "start", def->start, -MOST, MOST));
    const double length = se3di_norm(def->axis);
    if (!(length > 1e-100 && length < 1e100)) {
        return SE3DI_FAIL_OF(system, "axis", SE3D_ERR_INVALID_ARGUMENT,
                             " = (%g, %g, %g), must be a direction", def->axis[0], def->axis[1],
                             def->axis[2]);
    }
    return SE3D_OK;
}

static se3d_status check_servo(se3d_particles *particles, const se3d_servo_def *def,
                               int32_t *function)
{
    se3d_system *system = particles->system;
    uint32_t wall;
    SE3DI_TRY(se3di_particles_find_wall(particles, def->shape, &wall));
    SE3DI_TRY(check_numbers(system, def));
    SE3DI_TRY(se3di_find_function(system, "function", def->function, 1, function));
    if (se3di_servos_find(&particles->set,
                          (se3di_handle){def->shape.index1, def->shape.generation}) > 0) {
        return SE3DI_FAIL_OF(system, "shape", SE3D_ERR_INVALID_ARGUMENT,
                             " is a servo wall of this set already");
    }
    if (particles->set.servo_count == SE3D_PARTICLES_SERVOS) {
        return SE3DI_FAIL(system, SE3D_ERR_INVALID_ARGUMENT,
                          "the set has %d servo walls, which is the most", SE3D_PARTICLES_SERVOS);
    }
    return SE3D_OK;
}

se3d_status se3d_particles_add_servo(se3d_particles *particles, const se3d_servo_def *def,
                                     uint32_t *out)
{
    SE3DI_EDIT_OF(particles);
    se3d_system *system = particles->system;
    se3di_particles *set = &particles->set;
    se3d_servo_def full = se3d_servo_def_default();
    int32_t function = -1;
    SE3DI_TRY(se3di_check_def(system, "servo def", def, &full, sizeof full));
    SE3DI_TRY(check_servo(particles, &full, &function));
    void *memory = set->servos;
    const se3d_status status = se3di_array_reserve(&set->allocator, &memory, &set->servo_capacity,
                                                   set->servo_count + 1, sizeof *set->servos);
    set->servos = memory;
    if (status < 0) {
        return SE3DI_FAIL(system, SE3D_ERR_NO_MEMORY, "no memory for a servo wall");
    }
    se3di_servo servo = {.shape = {full.shape.index1, full.shape.generation},
                         .load = full.load,
                         .area = full.area,
                         .gain = full.gain,
                         .speed_max = full.speed_max,
                         .start = full.start};
    se3di_scale(1.0 / se3di_norm(full.axis), full.axis, servo.axis);
    if (function >= 0) {
        servo.function = (se3di_handle){full.function.index1, full.function.generation};
        ++system->model.functions[function].users;
    }
    set->servos[set->servo_count] = servo;
    if (out) {
        *out = (uint32_t)set->servo_count;
    }
    ++set->servo_count;
    ++system->model.topology_version; /* walls look for their servos */
    return SE3D_OK;
}

se3d_status se3d_particles_get_servo_sized(const se3d_particles *particles, uint32_t servo,
                                           se3d_servo_state *state, size_t size)
{
    if (!particles || !state) {
        return SE3D_ERR_NULL;
    }
    if (servo >= particles->set.servo_count) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    const se3di_servo *s = &particles->set.servos[servo];
    const se3di_floats host = se3di_floats_set();
    const double force = se3di_servo_force(&particles->set, s);
    const se3d_servo_state full = {.position = s->place,
                                   .speed = s->speed,
                                   .force = force,
                                   .wanted = se3di_servo_wanted(s),
                                   .work = s->work + s->half * force};
    se3di_floats_restore(host);
    return se3di_sized_give(state, size, &full, sizeof full);
}
