/* SPDX-License-Identifier: BSD-3-Clause */
/* Rows of studies have the same bits with every compiler and on every machine: the hashes of all
 * layouts, distributions and measures, to be written anew only if a definition changes. */
#include "base/hash.h"
#include "check.h"
#include "se3d/study.h"

#define MODEL                                                                                      \
    "se3d: 1\nparameters: {a: 1, b: 2, c: 3, d: 4, e: 5, f: 6, g: 7, h: 8}\n"                      \
    "bodies: [{name: bar, mass: a, inertia: [b, b, b], position: [0.1*c, 0, 0]}]\n"                \
    "joints: [{name: pin, type: revolute, body_i: ground, body_j: bar, at: [0, 0, 0], axis: [0, "  \
    "1, 0]}]\n"                                                                                    \
    "drivers: [{joint: pin, coordinate: angle, value: \"0.1*d*sin(t) + 0.01*e*t\"}]\n"             \
    "analysis: {type: kinematics, duration: 1, step: 0.1}\n"                                       \
    "study:\n"                                                                                     \
    "  parameters:\n"                                                                              \
    "    a: uniform(1, 2)\n    b: normal(20, 1)\n    c: lognormal(0, 0.3)\n"                       \
    "    d: triangular(1, 2, 5)\n    e: exponential(2)\n    f: weibull(3, 1.5)\n"                  \
    "    g: [1, 2, 3]\n    h: {from: 5, to: 6}\n"                                                  \
    "  measures:\n"                                                                                \
    "    top: {max: pin.angle}\n    mean: {mean: bar.position.z}\n"                                \
    "    rms: {rms: bar.velocity.z}\n    sum: {integral: bar.position.x}\n"                        \
    "    then: {at: bar.velocity.x, time: 0.55}\n"                                                 \
    "    settled: {settling: pin.angle, band: 0.05}\n    all: top*f + g*mean + h\n"                \
    "  samples: 20\n  seed: 9007199254740991\n  method: "

static uint64_t hash_rows(const char *text)
{
    uint64_t hash = SE3DI_HASH_START;
    se3d_model *model = NULL;
    se3d_study *study = NULL;
    CHECK(se3d_model_read_text(text, strlen(text), "m.yaml", NULL, &model, NULL) == SE3D_OK);
    CHECK(se3d_study_create(model, &study, NULL) == SE3D_OK);
    for (uint64_t k = 0; k < se3d_study_count_samples(study); ++k) {
        const char *row = "";
        CHECK(se3d_study_run_sample(study, k, &row) == SE3D_OK);
        hash = se3di_hash_bytes(hash, row, strlen(row));
    }
    se3d_study_destroy(study);
    se3d_model_destroy(model);
    return hash;
}

static void rows_have_the_bits_they_always_had(void)
{
    static const struct {
        const char *text;
        uint64_t hash;
    } rows[] = {{MODEL "monte_carlo\n", UINT64_C(0xfe232184e8243215)},
                {MODEL "latin_hypercube\n", UINT64_C(0x5f3953f57bd938ed)},
                {MODEL "sobol\n", UINT64_C(0xa3aba43bd643db52)}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
        const uint64_t hash = hash_rows(rows[k].text);
        if (hash != rows[k].hash) {
            fprintf(stderr, "row %d: 0x%016llx\n", (int)k, (unsigned long long)hash);
        }
        CHECK(hash == rows[k].hash);
    }
}

int main(void)
{
    RUN(rows_have_the_bits_they_always_had);
    return check_finish();
}
