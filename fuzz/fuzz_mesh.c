/* SPDX-License-Identifier: BSD-3-Clause */
/* Meshes: each input is read as STL and as OBJ, for a hollow shape to touch a ball and for the
 * mass of a solid, and a distance to it is asked for. */
#include "fuzz.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char *const endings[] = {"stl", "obj"};

/* Whatever it is: its surface has a nearest point, or a message says why not. */
static void ask_distance(const se3d_system *system)
{
    static const double from[3] = {0.3, 0.8, 1.25};
    double point[3], normal[3], distance;
    se3d_shape shape;
    FUZZ_MUST(!se3d_shape_find(system, "s", &shape));
    if (!se3d_shape_get_nearest(system, shape, from, point, normal, &distance)) {
        FUZZ_MUST(isfinite(distance) && isfinite(point[0]) && isfinite(normal[0]));
    }
}

static void read_mesh(const char *before, const char *ending, const char *after)
{
    char text[800];
    const int length = snprintf(text, sizeof text, "%sfile: a.%s}]%s", before, ending, after);
    se3d_model *model = fuzz_read_model(text, (size_t)length);
    if (model) {
        ask_distance(se3d_model_get_system(model));
        fuzz_run_model(model);
    }
    se3d_model_destroy(model);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char hollow[] =
        "se3d: 1\ncontact: {}\nmaterials: [{name: m, density: 1, stiffness: 1000}]\n"
        "bodies:\n  - {name: ball, position: [0.3, 0.3, 1.05], shapes: [{type: sphere, radius: "
        "0.1, "
        "material: m}]}\n  - {name: b, fixed: true, shapes: [{type: mesh, name: s, material: m, "
        "scale: 0.5, ";
    static const char fall[] =
        "}\nanalysis: {type: dynamics, duration: 0.01, method: verlet, step: 0.001}\n";
    static const char solid[] = "se3d: 1\ncontact: {}\nmaterials: [{name: m, density: 1000, "
                                "stiffness: 1000}]\nbodies: [{name: b, shapes: [{type: mesh, name: "
                                "s, material: m, ";
    for (size_t k = 0; k < sizeof endings / sizeof *endings; ++k) {
        char name[16];
        snprintf(name, sizeof name, "a.%s", endings[k]);
        (void)fuzz_write_file(name, data, size);
        read_mesh(hollow, endings[k], fall);
        read_mesh(solid, endings[k], "}]\n");
    }
    return 0;
}
