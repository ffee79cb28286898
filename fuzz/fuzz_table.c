/* SPDX-License-Identifier: BSD-3-Clause */
/* Tables beside a model: each input is read as points, as particles, as the coefficients of a tyre
 * and as a file that is included. */
#include "fuzz.h"

#include <string.h>

static const char *const models[] = {
    "se3d: 1\npoint_table: a.csv\nunits: {length: mm}\nbodies: [{name: b, mass: 1, inertia: [1, 1, "
    "1], position: p}]\n",
    "se3d: 1\ncontact: {}\nmaterials: [{name: m, density: 2500, stiffness: 1e4}]\n"
    "particles: [{material: m, file: a.csv}]\n"
    "analysis: {type: dynamics, duration: 0.001, step: 0.0001}\n",
    "se3d: 1\nbodies: [{name: rim, mass: 10, inertia: [1, 1, 1], position: [0, 0, 0.29], velocity: "
    "[20, -1, 0], angular_velocity: [0, 70, 0]}]\n"
    "forces: [{name: t, type: tyre, body: rim, file: a.csv}]\n"
    "analysis: {type: dynamics, duration: 0.01}\n",
    "se3d: 1\ninclude: [{file: a.csv, prefix: left_}, {file: a.csv, prefix: right_, mirror: y}]\n"
    "analysis: {type: dynamics, duration: 0.01}\n"};

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    (void)fuzz_write_file("a.csv", data, size);
    for (size_t k = 0; k < sizeof models / sizeof *models; ++k) {
        se3d_model *model = fuzz_read_model(models[k], strlen(models[k]));
        if (model) {
            fuzz_run_model(model);
        }
        se3d_model_destroy(model);
    }
    return 0;
}
