/* SPDX-License-Identifier: BSD-3-Clause */
/* Inertias as other formats have them, and masses of solids. */
#include "io/import/inertia.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

/* What must be added to each moment of a body: the sum of two grows by twice as much as the third.
 * A point has no moments, but the equations of a body need some. */
static double missing(const double moments[3], double mass)
{
    const double triangle = moments[2] - moments[0] - moments[1];
    const double size = fmax(fabs(moments[0]), fabs(moments[2]));
    double add = triangle > 1e-10 * size ? triangle : 0.0;
    if (!(size > 1e-24 * mass)) {
        return 1e-6 * mass - moments[0];
    }
    if (moments[0] + add < 1e-12 * size) {
        add = 1e-9 * size - moments[0];
    }
    return add;
}

bool se3di_inertia_is_sound(double mass, const double J[9])
{
    double moments[3];
    se3di_mass_moments(J, moments);
    return missing(moments, mass) <= 0.0;
}

bool se3di_inertia_mend(se3di_machine *m, const char *body, size_t line, double mass, double J[9])
{
    double moments[3];
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < i; ++j) {
            J[3 * i + j] = J[3 * j + i] = 0.5 * (J[3 * i + j] + J[3 * j + i]);
        }
    }
    se3di_mass_moments(J, moments);
    const double add = missing(moments, mass);
    for (int k = 0; k < 9; ++k) {
        if (!(fabs(J[k]) <= 1e40)) {
            return se3di_machine_fail(m, line, 0, "the inertia of `%.80s` is not finite", body);
        }
    }
    if (add <= 0.0) {
        return true;
    }
    const bool small = moments[2] > 0.0 && add <= 1e-6 * moments[2];
    const bool point = fabs(moments[0]) + fabs(moments[2]) <= 1e-24 * mass;
    se3di_machine_note_of(m, small || point ? SE3D_IMPORT_CHANGED : SE3D_IMPORT_LOST, line,
                          "the inertia of `%.80s` has principal moments %g, %g, %g kg m^2, which "
                          "no body has; %g is added to each",
                          body, moments[0], moments[1], moments[2], add);
    for (int k = 0; k < 3; ++k) {
        J[4 * k] += add;
    }
    return true;
}

/* A ball cut in two, with a cylinder of length l between: r is the radius. */
static void capsule(double r, double l, double density, se3di_mass *mass)
{
    const double ball = density * 4.0 / 3.0 * PI * r * r * r;
    const double rod = density * PI * r * r * l;
    const double along = 0.4 * ball * r * r + 0.5 * rod * r * r;
    const double across =
        ball * (0.4 * r * r + 0.25 * l * l + 0.375 * r * l) + rod * (0.25 * r * r + l * l / 12.0);
    mass->mass = ball + rod;
    mass->J[0] = mass->J[4] = across;
    mass->J[8] = along;
}

se3di_mass se3di_solid_mass(const se3di_machine_shape *shape, double density)
{
    se3di_mass mass = {.mass = 0.0};
    const double r = shape->radius;
    const double l = shape->length;
    if (strcmp(shape->type, "box") == 0) {
        const double *s = shape->size;
        mass.mass = density * s[0] * s[1] * s[2];
        for (int k = 0; k < 3; ++k) {
            const double a = s[(k + 1) % 3];
            const double b = s[(k + 2) % 3];
            mass.J[4 * k] = mass.mass * (a * a + b * b) / 12.0;
        }
    } else if (strcmp(shape->type, "ellipsoid") == 0) {
        const double *s = shape->size;
        mass.mass = density * 4.0 / 3.0 * PI * s[0] * s[1] * s[2];
        for (int k = 0; k < 3; ++k) {
            const double a = s[(k + 1) % 3];
            const double b = s[(k + 2) % 3];
            mass.J[4 * k] = 0.2 * mass.mass * (a * a + b * b);
        }
    } else if (strcmp(shape->type, "sphere") == 0 || strcmp(shape->type, "capsule") == 0) {
        capsule(r, l, density, &mass);
    } else if (strcmp(shape->type, "cylinder") == 0) {
        mass.mass = density * PI * r * r * l;
        mass.J[0] = mass.J[4] = mass.mass * (0.25 * r * r + l * l / 12.0);
        mass.J[8] = 0.5 * mass.mass * r * r;
    }
    return mass;
}
