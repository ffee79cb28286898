/* SPDX-License-Identifier: BSD-3-Clause */
/* Models in 2D: spheres whose centres lie in a plane stay in it to the bit, in any of the three
 * planes of axes and between walls at any angle, given by normals or by orientations. */
#include "check.h"
#include "se3d/io.h"
#include "se3d/se3d.h"

#include <math.h>
#include <string.h>

#define TEXT 4000

/* A bed that falls into a hopper.
 * `across` is the axis that is left out, `up` the next one but one, `side` the third. */
static void write_model(char *text, int across, int by_orientation)
{
    static const double angles[4] = {0.0, 0.5, -0.7, 1.3};
    const int side = (across + 1) % 3, up = (across + 2) % 3;
    double down[3] = {0.0, 0.0, 0.0}, upper[3] = {0.0, 0.0, 0.0};
    size_t used = 0;
    down[up] = -9.81;
    upper[side] = 0.5;
    upper[up] = 0.6;
    used += (size_t)snprintf(text + used, TEXT - used,
                             "se3d: 1\ngravity: [%g, %g, %g]\nmaterials: [{name: m, density: 2500, "
                             "stiffness: 3e3, friction: 0.2}]\ncontact: {overlap_limit: 0.9}\n"
                             "bodies:\n  - name: ground\n    shapes:\n",
                             down[0], down[1], down[2]);
    for (int k = 0; k < 4; ++k) {
        double n[3] = {0.0, 0.0, 0.0}, at[3] = {0.0, 0.0, 0.0};
        n[side] = sin(angles[k]);
        n[up] = cos(angles[k]);
        at[side] = k == 2 ? 0.6 : -0.1;
        at[up] = k ? 0.0 : -0.3;
        used += (size_t)snprintf(text + used, TEXT - used,
                                 "      - {type: plane, material: m, position: [%g, %g, %g], ",
                                 at[0], at[1], at[2]);
        const double turn = acos(n[2]), axis = hypot(n[0], n[1]);
        if (by_orientation && axis > 0.0) {
            used += (size_t)snprintf(text + used, TEXT - used,
                                     "orientation: {axis: [%.17g, %.17g, 0], angle: %.17g}}\n",
                                     -n[1], n[0], turn);
        } else {
            used += (size_t)snprintf(text + used, TEXT - used, "normal: [%.17g, %.17g, %.17g]}\n",
                                     n[0], n[1], n[2]);
        }
    }
    (void)snprintf(text + used, TEXT - used,
                   "particles: [{material: m, radius: 0.01, lower: [0, 0, 0], upper: [%g, %g, %g], "
                   "spacing: 0.021}]\nanalysis: {type: dynamics, duration: 0.6}\noutput: [{file: "
                   "r.csv, channels: [particles.kinetic]}]\n",
                   upper[0], upper[1], upper[2]);
}

static void particles_in_a_plane_stay_in_it(void)
{
    for (int k = 0; k < 6; ++k) {
        static double r[3 * 1000], v[3 * 1000], w[3 * 1000];
        const int across = k % 3;
        char text[TEXT];
        se3d_model_error error;
        se3d_model *model = NULL;
        se3d_solver *solver = NULL;
        se3d_solver_def def = se3d_solver_def_default();
        se3d_particles *set = NULL;
        write_model(text, across, k / 3);
        CHECK(se3d_model_read_text(text, strlen(text), "2d.yaml", NULL, &model, &error) == SE3D_OK);
        if (!model) {
            fprintf(stderr, "%s\n", error.message);
            return;
        }
        se3d_system *system = se3d_model_get_system(model);
        CHECK(!se3d_model_get_solver(model, 0, &def));
        CHECK(!se3d_solver_create(system, &def, &solver));
        CHECK(se3d_solver_run(solver, 0.6) >= 0);
        CHECK(!se3d_system_get_particles(system, 0, &set));
        const size_t count = se3d_particles_count(set);
        CHECK(count > 600 && count <= 1000);
        CHECK(se3d_particles_count_contacts(set) > count);
        CHECK(!se3d_particles_get_all(set, count, r, v, w));
        double off = 0.0, spin = 0.0;
        for (size_t n = 0; n < count; ++n) {
            off = fmax(off, fabs(r[3 * n + (size_t)across]) + fabs(v[3 * n + (size_t)across]));
            spin = fmax(spin, fabs(w[3 * n + (size_t)((across + 1) % 3)]));
        }
        CHECK_NEAR(off, 0.0, 0.0);
        CHECK_NEAR(spin, 0.0, 0.0);
        se3d_solver_destroy(solver);
        se3d_model_destroy(model);
    }
}

int main(void)
{
    RUN(particles_in_a_plane_stay_in_it);
    return check_finish();
}
