/* SPDX-License-Identifier: BSD-3-Clause */
/* Clumps: templates, bulk access. */
#include "particles/clump.h"

#include "base/sized.h"
#include "math/inertia.h"
#include "math/quaternion.h"
#include "particles/energy.h"
#include "particles/list.h"
#include "particles/piece.h"
#include "se3d/clump.h"
#include "system/particles.h"

#include <math.h>
#include <string.h>

#define SPHERES_MAX 10000
#define SIZE_MOST   1e30
#define SIZE_LEAST  1e-30

void se3d_clump_def_init(se3d_clump_def *def, size_t size)
{
    se3d_clump_def defaults = {.struct_size = size};
    se3di_def_init(def, size, &defaults, sizeof defaults);
}

static se3d_status check_spheres(se3d_particles *p, const se3d_clump_def *def)
{
    se3d_system *system = p->system;
    if (def->count < 1 || def->count > SPHERES_MAX) {
        return SE3DI_FAIL_OF(system, "count", SE3D_ERR_INVALID_ARGUMENT,
                             " = %zu spheres of a clump, must be at least 1 and at most %d",
                             def->count, SPHERES_MAX);
    }
    SE3DI_TRY(se3di_check_pointer(system, "r", def->r));
    SE3DI_TRY(se3di_check_pointer(system, "radius", def->radius));
    for (size_t k = 0; k < def->count; ++k) {
        SE3DI_TRY(se3di_check_range(system, "radius", def->radius[k], SIZE_LEAST, SIZE_MOST));
        for (size_t a = 0; a < 3; ++a) {
            SE3DI_TRY(se3di_check_range(system, "r", def->r[3 * k + a], -SIZE_MOST, SIZE_MOST));
        }
    }
    return SE3D_OK;
}

static se3d_status check_mass(se3d_particles *p, const se3d_clump_def *def)
{
    SE3DI_TRY(se3di_check_range(p->system, "mass", def->mass, 0.0, SIZE_MOST));
    SE3DI_TRY(se3di_check_finites(p->system, "centre", def->centre, 3));
    SE3DI_TRY(se3di_check_finites(p->system, "inertia", def->inertia, 6));
    if (def->mass > 0.0 && se3di_inertia_is_physical(def->inertia) != SE3DI_INERTIA_PHYSICAL) {
        return SE3DI_FAIL_OF(p->system, "inertia", SE3D_ERR_INVALID_ARGUMENT,
                             " = {%g, %g, %g, %g, %g, %g} is that of no body: principal moments "
                             "must be > 0 and none may exceed the sum of the others",
                             def->inertia[0], def->inertia[1], def->inertia[2], def->inertia[3],
                             def->inertia[4], def->inertia[5]);
    }
    return SE3D_OK;
}

/* The template of a definition, whose spheres come to `balls` [count]. */
static se3d_status weigh(se3d_particles *p, const se3d_clump_def *def, se3di_clump_template *out,
                         se3di_clump_ball *balls)
{
    *out = (se3di_clump_template){
        .count = (uint32_t)def->count, .given = def->mass > 0.0, .mass = def->mass};
    se3di_copy(def->centre, out->centre);
    for (size_t k = 0; k < def->count; ++k) {
        se3di_copy(def->r + 3 * k, balls[k].r);
        balls[k].radius = def->radius[k];
    }
    const se3d_status status = se3di_clump_weigh(&p->set.allocator, out, balls, def->inertia);
    if (status == SE3D_ERR_INVALID_ARGUMENT) {
        return SE3DI_FAIL_OF(p->system, "inertia", status,
                             " has a principal moment that is no part of the others, must be > 0");
    }
    const double numbers[] = {out->volume, out->mass, out->bound, out->most};
    for (size_t k = 0; status >= 0 && k < sizeof numbers / sizeof *numbers; ++k) {
        if (!(numbers[k] > 0.0 && isfinite(numbers[k]))) {
            return SE3DI_FAIL_OF(p->system, "radius", SE3D_ERR_INVALID_ARGUMENT,
                                 ": the spheres of a clump are too small or too large, their "
                                 "volume is %g m^3",
                                 out->volume);
        }
    }
    return status;
}

static se3d_status no_memory(se3d_particles *p)
{
    return SE3DI_FAIL(p->system, SE3D_ERR_NO_MEMORY, "no memory for clumps");
}

se3d_status se3d_particles_add_clump_template(se3d_particles *particles, const se3d_clump_def *def,
                                              uint32_t *index)
{
    SE3DI_EDIT_OF(particles);
    se3di_particles *set = &particles->set;
    se3d_clump_def full = se3d_clump_def_default();
    se3di_clump_template out;
    SE3DI_TRY(se3di_check_def(particles->system, "clump def", def, &full, sizeof full));
    SE3DI_TRY(check_spheres(particles, &full));
    SE3DI_TRY(check_mass(particles, &full));
    se3di_clump_ball *balls = se3di_alloc(&set->allocator, full.count, sizeof *balls);
    if (!balls) {
        return no_memory(particles);
    }
    se3d_status status = weigh(particles, &full, &out, balls);
    status = status < 0 ? status : se3di_clumps_add_template(set, &out, balls);
    se3di_free(&set->allocator, balls, full.count, sizeof *balls);
    if (status < 0) {
        return status == SE3D_ERR_NO_MEMORY ? no_memory(particles) : status;
    }
    if (index) {
        *index = (uint32_t)set->template_count - 1;
    }
    ++particles->system->model.topology_version;
    return SE3D_OK;
}

/* R diag(moments) R^T, {xx, yy, zz, xy, yz, xz}. */
static void inertia_of(const se3di_clump_template *of, double J[6])
{
    static const int row[6] = {0, 1, 2, 0, 1, 0}, column[6] = {0, 1, 2, 1, 2, 2};
    double R[9];
    se3di_quat_to_matrix(of->axes, R);
    for (int k = 0; k < 6; ++k) {
        J[k] = 0.0;
        for (int a = 0; a < 3; ++a) {
            J[k] += R[3 * row[k] + a] * of->inertia[a] * R[3 * column[k] + a];
        }
    }
}

se3d_status se3d_particles_get_clump_template_sized(const se3d_particles *particles, uint32_t index,
                                                    se3d_clump_template_info *info, size_t size)
{
    if (!particles || !info) {
        return SE3D_ERR_NULL;
    }
    if (index >= particles->set.template_count) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    const se3di_clump_template *of = &particles->set.templates[index];
    se3d_clump_template_info full = {.volume = of->volume, .mass = of->mass, .radius = of->bound};
    se3di_copy(of->centre, full.centre);
    inertia_of(of, full.inertia);
    return se3di_sized_give(info, size, &full, sizeof full);
}

static se3d_status check_finite(se3d_particles *p, const char *what, const double *values,
                                size_t count)
{
    for (size_t k = 0; values && k < count; ++k) {
        if (!isfinite(values[k])) {
            return SE3DI_FAIL_OF(p->system, what, SE3D_ERR_INVALID_ARGUMENT,
                                 "[%zu] = %g, must be finite", k, values[k]);
        }
    }
    return SE3D_OK;
}

/* States that are given. */
static se3d_status check_states(se3d_particles *p, size_t count, const double *r, const double *e,
                                const double *v, const double *w)
{
    SE3DI_TRY(check_finite(p, "r", r, 3 * count));
    SE3DI_TRY(check_finite(p, "v", v, 3 * count));
    SE3DI_TRY(check_finite(p, "w", w, 3 * count));
    for (size_t k = 0; e && k < count; ++k) {
        double unit[4];
        SE3DI_TRY(se3di_check_orientation(p->system, "e", e + 4 * k, unit));
    }
    return SE3D_OK;
}

se3d_status se3di_check_template(se3d_particles *p, const char *what, uint32_t index)
{
    if (index >= p->set.template_count) {
        return SE3DI_FAIL_OF(p->system, what, SE3D_ERR_INVALID_ARGUMENT,
                             " = %u, must be less than the number of templates, %zu", index,
                             p->set.template_count);
    }
    return SE3D_OK;
}

se3d_status se3di_clumps_make_room(se3d_particles *p, uint32_t clump, size_t count)
{
    const size_t spheres = clump > 0 ? p->set.templates[clump - 1].count : 1;
    if (count > SE3DI_CARRY_WALL / spheres) {
        return SE3DI_FAIL_OF(p->system, "count", SE3D_ERR_INVALID_ARGUMENT,
                             " = %zu, at most 2^31 particles can be made", count);
    }
    SE3DI_TRY(se3di_particles_make_room(p, count * spheres));
    if (clump > 0 && se3di_clumps_reserve(&p->set, p->set.id_count + count * spheres, count) < 0) {
        return no_memory(p);
    }
    return SE3D_OK;
}

se3d_status se3d_particles_add_clumps(se3d_particles *particles, uint32_t index,
                                      se3d_material material, size_t count, const double *r,
                                      const double *e, const double *v, const double *w)
{
    static const double straight[4] = {1.0, 0.0, 0.0, 0.0};
    SE3DI_EDIT_OF(particles);
    se3di_clump_made made = {.template_index = index, .scale = 1.0};
    SE3DI_TRY(se3di_check_template(particles, "index", index));
    SE3DI_TRY(se3di_check_pointer(particles->system, "r", r));
    SE3DI_TRY(check_states(particles, count, r, e, v, w));
    SE3DI_TRY(se3di_check_period(particles, particles->set.templates[index].bound));
    SE3DI_TRY(se3di_particles_use(particles, material, &made.material));
    SE3DI_TRY(se3di_clumps_make_room(particles, index + 1, count));
    for (size_t k = 0; k < count; ++k) {
        se3di_copy(r + 3 * k, made.x);
        memcpy(made.q, e ? e + 4 * k : straight, sizeof made.q);
        made.v = v ? v + 3 * k : NULL;
        made.w = w ? w + 3 * k : NULL;
        (void)se3di_clumps_append(&particles->set, &made);
    }
    return SE3D_OK;
}

size_t se3d_particles_count_clumps(const se3d_particles *particles)
{
    return particles ? particles->set.clump_count : 0;
}

static se3d_status check_count(const se3d_particles *particles, size_t count)
{
    if (!particles) {
        return SE3D_ERR_NULL;
    }
    return count == particles->set.clump_count ? SE3D_OK : SE3D_ERR_INVALID_ARGUMENT;
}

se3d_status se3d_particles_get_clump_ids(const se3d_particles *particles, size_t count,
                                         uint32_t *ids, uint32_t *templates, double *mass)
{
    SE3DI_TRY(check_count(particles, count));
    for (size_t k = 0; k < count; ++k) {
        const se3di_clump *clump = &particles->set.clumps[k];
        if (ids) {
            ids[k] = clump->first;
        }
        if (templates) {
            templates[k] = clump->template_index;
        }
        if (mass) {
            mass[k] = se3di_clump_mass(&particles->set, clump);
        }
    }
    return SE3D_OK;
}

se3d_status se3d_particles_get_clump_of(const se3d_particles *particles, size_t count,
                                        uint32_t *clumps)
{
    if (!particles || !clumps) {
        return SE3D_ERR_NULL;
    }
    if (count != particles->set.count) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    size_t id = 0;
    for (size_t k = 0; k < count; ++k) {
        const se3di_clump *clump =
            se3di_clump_find(&particles->set, se3di_particles_next(&particles->set, &id));
        clumps[k] = clump ? clump->first : UINT32_MAX;
    }
    return SE3D_OK;
}

se3d_status se3d_particles_get_clumps(const se3d_particles *particles, size_t count, double *r,
                                      double *e, double *v, double *w)
{
    SE3DI_TRY(check_count(particles, count));
    const se3di_floats host = se3di_floats_set();
    for (size_t k = 0; k < count; ++k) {
        const se3di_clump *clump = &particles->set.clumps[k];
        double q[4], rate[3];
        se3di_clump_get(&particles->set, clump, q, rate);
        if (r) {
            se3di_copy(clump->x, r + 3 * k);
        }
        if (e) {
            memcpy(e + 4 * k, q, sizeof q);
        }
        if (v) {
            se3di_copy(clump->v, v + 3 * k);
        }
        if (w) {
            se3di_copy(rate, w + 3 * k);
        }
    }
    se3di_floats_restore(host);
    return SE3D_OK;
}

se3d_status se3d_particles_set_clumps(se3d_particles *particles, size_t count, const double *r,
                                      const double *e, const double *v, const double *w)
{
    SE3DI_SET_OF(particles);
    se3di_particles *set = &particles->set;
    if (count != set->clump_count) {
        return SE3DI_FAIL_OF(particles->system, "count", SE3D_ERR_INVALID_ARGUMENT,
                             " = %zu, must be the number of clumps, %zu", count, set->clump_count);
    }
    SE3DI_TRY(check_states(particles, count, r, e, v, w));
    if ((r || e) && se3di_particles_collect(set) < 0) {
        return SE3DI_FAIL(particles->system, SE3D_ERR_NO_MEMORY, "no memory to move clumps");
    }
    for (size_t k = 0; k < count; ++k) {
        se3di_clump *clump = &set->clumps[k];
        if (r) {
            se3di_copy(r + 3 * k, clump->x);
        }
        if (v) {
            se3di_copy(v + 3 * k, clump->v);
        }
        if (e || w) {
            se3di_clump_set(set, clump, e ? e + 4 * k : NULL, w ? w + 3 * k : NULL);
        }
        se3di_clump_place(set, clump, r != NULL || e != NULL);
    }
    set->force_valid = 0;
    return SE3D_OK;
}

se3d_status se3d_particles_get_clump_forces(const se3d_particles *particles, size_t count,
                                            double *force, double *torque)
{
    SE3DI_TRY(check_count(particles, count));
    const se3di_floats host = se3di_floats_set();
    for (size_t k = 0; k < count; ++k) {
        double F[3] = {0.0}, T[3] = {0.0};
        if (particles->set.list_valid) { /* after an edit there are no forces yet */
            se3di_clump_loads(&particles->set, &particles->set.clumps[k], F, T);
        }
        if (force) {
            se3di_copy(F, force + 3 * k);
        }
        if (torque) {
            se3di_copy(T, torque + 3 * k);
        }
    }
    se3di_floats_restore(host);
    return SE3D_OK;
}
