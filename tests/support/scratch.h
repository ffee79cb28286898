/* SPDX-License-Identifier: BSD-3-Clause */
/* Files that a test writes for models to read, and models that look for files beside them. */
#ifndef SE3D_TESTS_SUPPORT_SCRATCH_H
#define SE3D_TESTS_SUPPORT_SCRATCH_H

#include "check.h"
#include "se3d/io.h"

/* @return the path, valid until the next call */
static inline const char *scratch_path(const char *name)
{
    static char path[1000];
    snprintf(path, sizeof path, "%s/%s", check_scratch(), name);
    return path;
}

static inline void scratch_write(const char *name, const void *bytes, size_t size)
{
    FILE *file = fopen(scratch_path(name), "wb");
    CHECK(file && fwrite(bytes, 1, size, file) == size);
    if (file) {
        fclose(file);
    }
}

static inline void scratch_remove(const char *name)
{
    remove(scratch_path(name));
}

/* A model as if it lay in the folder. @return NULL after a failure, with its message */
static inline se3d_model *scratch_read_model(const char *text, se3d_model_error *error)
{
    se3d_model *model = NULL;
    const se3d_status status = se3d_model_read_text(
        text, strlen(text), scratch_path("se3d_test.yaml"), NULL, &model, error);
    CHECK((status == SE3D_OK) == (model != NULL));
    return model;
}

#endif
