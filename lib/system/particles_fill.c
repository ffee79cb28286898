/* SPDX-License-Identifier: BSD-3-Clause */
/* Regions filled with particles: definitions, checked. */
#include "particles/draw.h"
#include "particles/fill.h"
#include "system/particles.h"

#include <math.h>

#define POINTS_MAX 2e8 /* of a lattice that are looked at */

void se3d_fill_def_init(se3d_fill_def *def, size_t size)
{
    se3d_fill_def defaults = {.struct_size = size};
    se3di_def_init(def, size, &defaults, sizeof defaults);
}

/* The template of clumps, whose size they have if no radius is given. */
static se3d_status check_clump(se3d_particles *p, se3d_fill_def *def)
{
    if (def->clump == 0) {
        return SE3D_OK;
    }
    SE3DI_TRY(se3di_check_template(p, "clump - 1", def->clump - 1));
    double unit[4], *e = def->orientation;
    if (e[0] != 0.0 || e[1] != 0.0 || e[2] != 0.0 || e[3] != 0.0) {
        SE3DI_TRY(se3di_check_orientation(p->system, "orientation", e, unit));
    }
    if (def->radius_count == 0 && def->radius_min == 0.0 && def->radius_max == 0.0) {
        def->radius_min = def->radius_max = p->set.templates[def->clump - 1].bound;
    }
    return SE3D_OK;
}

/* The range of the radii of a table. */
static se3d_status check_radii(se3d_particles *p, se3d_fill_def *def)
{
    double sum = 0.0;
    SE3DI_TRY(se3di_check_pointer(p->system, "radii", def->radii));
    def->radius_min = HUGE_VAL;
    def->radius_max = 0.0;
    for (size_t k = 0; k < def->radius_count; ++k) {
        double weight = def->weights ? def->weights[k] : 1.0;
        SE3DI_TRY(se3di_check_range(p->system, "radii", def->radii[k], 1e-30, 1e30));
        SE3DI_TRY(se3di_check_range(p->system, "weights", weight, 0.0, 1e30));
        sum += weight;
        if (weight > 0.0) {
            def->radius_min = fmin(def->radius_min, def->radii[k]);
            def->radius_max = fmax(def->radius_max, def->radii[k]);
        }
    }
    return se3di_check_range(p->system, "sum of the weights", sum, 1e-30, 1e300);
}

se3d_status se3di_check_region(se3d_particles *p, const double lower[3], const double upper[3],
                               int32_t region, int32_t axis, double size)
{
    if (region < SE3D_FILL_REGION_BOX || region > SE3D_FILL_REGION_SPHERE) {
        return SE3DI_FAIL_OF(p->system, "region", SE3D_ERR_INVALID_ARGUMENT,
                             " = %d, must be an se3d_fill_region", region);
    }
    if (axis < 0 || axis > 2) {
        return SE3DI_FAIL_OF(p->system, "axis", SE3D_ERR_INVALID_ARGUMENT,
                             " = %d, must be 0, 1 or 2", axis);
    }
    for (int a = 0; a < 3; ++a) {
        const int may_be_flat =
            region == SE3D_FILL_REGION_BOX || (region == SE3D_FILL_REGION_CYLINDER && a == axis);
        const double least = lower[a] + size - se3di_region_slack(lower[a], size);
        SE3DI_TRY(se3di_check_range(p->system, "lower", lower[a], -1e30, 1e30));
        if (!(may_be_flat && upper[a] >= lower[a] && upper[a] <= lower[a])) {
            SE3DI_TRY(se3di_check_range(p->system, "upper", upper[a], least, 1e30));
        }
    }
    return SE3D_OK;
}

se3d_status se3di_check_fill(se3d_particles *p, const se3d_fill_def *def, se3d_fill_def *full,
                             uint32_t *material)
{
    SE3DI_TRY(se3di_check_def(p->system, "fill def", def, full, sizeof *full));
    SE3DI_TRY(se3di_check_finites(p->system, "velocity", full->velocity, 3));
    SE3DI_TRY(check_clump(p, full));
    if (full->radius_count > 0) {
        SE3DI_TRY(check_radii(p, full));
    }
    SE3DI_TRY(se3di_check_range(p->system, "radius_min", full->radius_min, 1e-30, 1e30));
    SE3DI_TRY(se3di_check_range(p->system, "radius_max", full->radius_max, full->radius_min, 1e30));
    SE3DI_TRY(se3di_check_range(p->system, "jitter", full->jitter, 0.0, 1e30));
    SE3DI_TRY(se3di_check_range(p->system, "spacing", full->spacing, 0.0, 1e30));
    SE3DI_TRY(se3di_check_region(p, full->lower, full->upper, full->region, full->axis,
                                 2.0 * full->radius_max));
    SE3DI_TRY(se3di_check_period(p, full->radius_max));
    SE3DI_TRY(se3di_check_tag(p, full->tag));
    return se3di_particles_use(p, full->material, material);
}

se3d_status se3d_particles_fill_lattice(se3d_particles *particles, const se3d_fill_def *def,
                                        size_t *added)
{
    SE3DI_EDIT_OF(particles);
    uint32_t material;
    size_t points;
    se3d_fill_def full = se3d_fill_def_default();
    SE3DI_TRY(se3di_check_fill(particles, def, &full, &material));
    double looked_at = se3di_lattice_count(&full);
    if (full.count > 0 && full.region == SE3D_FILL_REGION_BOX) { /* the first ones are taken */
        looked_at = fmin(looked_at, (double)full.count);
    }
    SE3DI_TRY(se3di_check_range(particles->system, "points of the lattice from lower to upper",
                                looked_at, 0.0, POINTS_MAX));
    const size_t wanted = se3di_lattice_measure(&full, &points);
    SE3DI_TRY(se3di_clumps_make_room(particles, full.clump, wanted));
    se3di_lattice_fill(&particles->set, &full, material, points);
    if (added) {
        *added = wanted;
    }
    return SE3D_OK;
}

/* Far too many are found before there is memory for them. */
static se3d_status check_volume(se3d_particles *p, const se3d_fill_def *def)
{
    const double most = se3di_fill_most(&p->set, def);
    if ((double)def->count > most) {
        return SE3DI_FAIL_OF(p->system, "count", SE3D_ERR_NO_CONVERGENCE,
                             " = %zu, the region has the volume of %.3g particles only", def->count,
                             most);
    }
    return SE3D_OK;
}

se3d_status se3d_particles_fill_random(se3d_particles *particles, const se3d_fill_def *def)
{
    SE3DI_EDIT_OF(particles);
    uint32_t material;
    size_t placed;
    se3d_fill_def full = se3d_fill_def_default();
    SE3DI_TRY(se3di_check_fill(particles, def, &full, &material));
    SE3DI_TRY(check_volume(particles, &full));
    SE3DI_TRY(se3di_clumps_make_room(particles, full.clump, full.count));
    const se3d_status status = se3di_random_fill(&particles->set, &full, material, &placed);
    if (status == SE3D_ERR_NO_CONVERGENCE) {
        return SE3DI_FAIL(particles->system, status,
                          "only %zu of %zu particles found room at random; use a larger region or "
                          "a lattice",
                          placed, full.count);
    }
    if (status < 0) {
        return SE3DI_FAIL(particles->system, status, "no memory to pack %zu particles", full.count);
    }
    return status;
}
