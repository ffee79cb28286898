/* SPDX-License-Identifier: BSD-3-Clause */
/* With E the elastic force, the overlap d and the energies at d of docs/theory/contact-laws.md,
 *
 *     hooke          E = k d               U = k d^2/2,          adhesion 4/3 sqrt(Fc k) d^1.5
 *     hertz_mindlin  E = k sqrt(R*) d^1.5  U = 2/5 E d,          adhesion 8/7 sqrt(Fc E) d
 *
 * an impact of v reaches the overlap d if m* v^2/2 = U - adhesion - pi R* cohesion d^2. */
#include "soft.h"

#include <math.h>
#include <se3d/contact.h>
#include <se3d/material.h>
#include <se3d/system.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.1415926535897932384626433832795

/* Of two of one material. */
typedef struct stuff {
    int is_hertz;
    double density, k, adhesion, cohesion, limit;
} stuff;

static double choose(double given, double mixed)
{
    return given < 0.0 ? mixed : given;
}

static int stuff_read(const se3d_system *system, se3d_material material, stuff *out)
{
    se3d_contact_settings contact = se3d_contact_settings_default();
    se3d_material_def def = se3d_material_def_default();
    se3d_material_pair_def pair = se3d_material_pair_def_default();
    if (SE3D_FAILED(se3d_system_get_contact(system, &contact)) ||
        SE3D_FAILED(se3d_material_get(system, material, &def)) ||
        SE3D_FAILED(se3d_material_get_pair(system, material, material, &pair))) {
        return 0;
    }
    *out = (stuff){.is_hertz =
                       (pair.law < 0 ? contact.law : pair.law) == SE3D_CONTACT_LAW_HERTZ_MINDLIN,
                   .density = def.density,
                   .adhesion = choose(pair.adhesion, def.adhesion),
                   .cohesion = choose(pair.cohesion, def.cohesion),
                   .limit = contact.overlap_limit};
    const double nu = choose(pair.poisson, def.poisson);
    out->k = out->is_hertz ? 2.0 / 3.0 * choose(pair.young, def.young) / (1.0 - nu * nu)
                           : choose(pair.stiffness, def.stiffness);
    return contact.law != SE3D_CONTACT_LAW_CALLBACK;
}

/* At which a sphere meets one like it (share 1/2), or a wall (1): R* and m* over R and m. */
static double speed_of(const stuff *s, double radius, double share)
{
    const double depth = s->limit * radius, reduced = share * radius;
    const double mass = share * s->density * 4.0 / 3.0 * PI * pow(radius, 3.0);
    const double force = s->is_hertz ? s->k * sqrt(reduced) * pow(depth, 1.5) : s->k * depth;
    const double pull = sqrt(1.5 * PI * s->adhesion * reduced * force);
    const double left = (s->is_hertz ? 0.4 : 0.5) * force * depth -
                        (s->is_hertz ? 8.0 / 7.0 : 4.0 / 3.0) * pull * depth -
                        PI * reduced * s->cohesion * depth * depth;
    return left > 0.0 ? sqrt(2.0 * left / mass) : 0.0;
}

static int look(const se3d_system *system, size_t count, const se3d_material *materials,
                const double *radii, soft *out)
{
    stuff s = {0};
    for (size_t k = 0; k < count; ++k) {
        if ((k == 0 || memcmp(&materials[k], &materials[k - 1], sizeof *materials) != 0) &&
            !stuff_read(system, materials[k], &s)) {
            return 0;
        }
        out->limit = s.limit;
        out->speed =
            fmin(out->speed, fmin(speed_of(&s, radii[k], 0.5), speed_of(&s, radii[k], 1.0)));
    }
    return 1;
}

int soft_look(const se3d_system *system, const se3d_particles *set, soft *out)
{
    const size_t count = se3d_particles_count(set);
    se3d_material *materials = count > 0 ? malloc(count * sizeof *materials) : NULL;
    double *radii = count > 0 ? malloc(count * sizeof *radii) : NULL;
    *out = (soft){.speed = HUGE_VAL};
    const int read = materials && radii &&
                     !SE3D_FAILED(se3d_particles_get_materials(set, count, materials)) &&
                     !SE3D_FAILED(se3d_particles_get_radii(set, count, radii)) &&
                     look(system, count, materials, radii, out);
    free(materials);
    free(radii);
    return read;
}
