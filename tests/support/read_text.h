/* SPDX-License-Identifier: BSD-3-Clause */
/* A model that a text of a model file gives. */
#ifndef SE3D_TESTS_SUPPORT_READ_TEXT_H
#define SE3D_TESTS_SUPPORT_READ_TEXT_H

#include "check.h"
#include "se3d/io.h"

static inline se3d_model *read_text(const char *text)
{
    se3d_model *model = NULL;
    se3d_model_error error = {0};
    if (SE3D_FAILED(se3d_model_read_text(text, strlen(text), "m", NULL, &model, &error))) {
        fprintf(stderr, "%s\n", error.message);
    }
    CHECK(model != NULL);
    return model;
}

#endif
