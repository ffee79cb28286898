/* SPDX-License-Identifier: BSD-3-Clause */
/* Contacts that steps of convex follow keep to their law (docs/theory/contact-laws.md): with
 * shorter steps, impacts with friction come to what dop853 has. */
#include "support/text_model.h"

#include <stdio.h>
#include <string.h>

/* A ball of 7 kg that meets a plane at 1 m/s, for 7 ms; the spring across the plane is stretched on
 * the way in, and held by its damper beyond what friction alone would on the way out. */
static void leave(int32_t method, double step, double friction, double restitution, double slide,
                  double spin, double left[2])
{
    char text[1000];
    (void)snprintf(text, sizeof text,
                   "se3d: 1\ngravity: [0, 0, 0]\nmaterials: [{name: s, density: 1000, stiffness: "
                   "1.0e+6, friction: %g, restitution: %g}]\ncontact: {}\nbodies: [{name: ground, "
                   "shapes: [{type: plane, material: s}]}, {name: b, mass: 7, inertia: [0.03, "
                   "0.03, 0.03], position: [0, 0, 0.1001], velocity: [%g, 0, -1], "
                   "angular_velocity: [0, %g, 0], shapes: [{type: sphere, radius: 0.1, material: "
                   "s}]}]\nanalysis: {type: dynamics, duration: 1, tolerance: 1.0e-9}\n"
                   "output: [{file: r.csv, channels: [b.velocity, b.angular_velocity]}]\n",
                   friction, restitution, slide, spin);
    text_model m = text_model_open(text, method, SE3D_FORMULATION_AUTO, step);
    CHECK(text_model_run(&m, 0.01));
    left[0] = text_model_get(&m, 0, 0);
    left[1] = text_model_get(&m, 1, 1);
    text_model_close(&m);
}

static void springs_of_friction_are_shortened_as_the_law_says(void)
{
    static const double cases[][4] = {/* friction, restitution, slide, spin */
                                      {0.3, 0.5, 0.5, 0.0}, {0.3, 0.5, 2.0, 0.0},
                                      {0.3, 0.5, 0.2, 0.0}, {3.0, 0.5, 0.5, 0.0},
                                      {0.3, 0.5, 0.0, 5.0}, {0.3, 0.2, 0.5, 0.0}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        const double *c = cases[k];
        double left[2], other[2];
        leave(SE3D_METHOD_DOP853, 0.0, c[0], c[1], c[2], c[3], other);
        leave(SE3D_METHOD_CONVEX, 4e-6, c[0], c[1], c[2], c[3], left);
        CHECK_NEAR(left[0], other[0], 3e-4);
        CHECK_NEAR(left[1], other[1], 8e-3);
    }
}

int main(void)
{
    RUN(springs_of_friction_are_shortened_as_the_law_says);
    return check_finish();
}
