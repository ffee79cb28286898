/* SPDX-License-Identifier: BSD-3-Clause */
/* A model from a text with a solver for its first analysis, for tests of mechanics. */
#ifndef SE3D_TESTS_SUPPORT_TEXT_MODEL_H
#define SE3D_TESTS_SUPPORT_TEXT_MODEL_H

#include "check.h"
#include "se3d/io.h"

#include <stdlib.h>

typedef struct text_model {
    se3d_model *model;
    se3d_system *system;
    se3d_solver *solver;
} text_model;

/* Method and formulation instead of the text's (negative: the text's). */
static inline text_model text_model_open(const char *text, int32_t method, int32_t formulation,
                                         double step)
{
    text_model m = {NULL, NULL, NULL};
    se3d_model_error error = {0};
    se3d_solver_def def = se3d_solver_def_default();
    if (SE3D_FAILED(se3d_model_read_text(text, strlen(text), "m.yaml", NULL, &m.model, &error))) {
        fprintf(stderr, "%s\n", error.message);
    }
    CHECK(m.model != NULL);
    if (!m.model) {
        exit(check_finish());
    }
    m.system = se3d_model_get_system(m.model);
    CHECK(!se3d_model_get_solver(m.model, 0, &def));
    def.method = method >= 0 ? method : def.method;
    def.formulation = formulation >= 0 ? formulation : def.formulation;
    def.step = step > 0.0 ? step : def.step;
    CHECK(!se3d_solver_create(m.system, &def, &m.solver));
    return m;
}

static inline void text_model_close(text_model *m)
{
    se3d_solver_destroy(m->solver);
    se3d_model_destroy(m->model);
}

/* Run to t; a failure counts as one and is shown. */
static inline int text_model_run(text_model *m, double t)
{
    int runs = se3d_solver_run(m->solver, t) >= 0;
    CHECK(runs);
    if (!runs) {
        fprintf(stderr, "%s\n", se3d_system_get_error(m->system));
    }
    return runs;
}

/* Part `part` of channel `k` of the first output. */
static inline double text_model_get(const text_model *m, size_t k, size_t part)
{
    double value[4] = {0.0, 0.0, 0.0, 0.0};
    size_t width = 0;
    CHECK(!se3d_model_get_channel_value(m->model, 0, k, NULL, value, &width));
    CHECK(part < width);
    return value[part];
}

#endif
