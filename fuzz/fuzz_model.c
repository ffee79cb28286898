/* SPDX-License-Identifier: BSD-3-Clause */
/* Model files: the reader, with and without a report of all mistakes, and what runs of a model
 * that was accepted make of it. */
#include "fuzz.h"

#include "io/document/layout.h"

#include <string.h>

static void count_mistake(void *ctx, const se3d_model_error *error)
{
    size_t *count = ctx;
    FUZZ_MUST(error->message[0] != '\0');
    ++*count;
}

/* With a report of all mistakes the outcome is the same. */
static void read_all_mistakes(const char *text, size_t size, int accepted)
{
    se3d_model_options options = se3d_model_options_default();
    se3d_model *model = NULL;
    size_t count = 0;
    options.mass_optional = size % 2 == 0;
    options.report = count_mistake;
    options.report_ctx = &count;
    const se3d_status status = se3d_model_read_text(text, size, "x.yaml", &options, &model, NULL);
    FUZZ_MUST((status == SE3D_OK) == (model != NULL));
    FUZZ_MUST((status == SE3D_OK) == (accepted != 0));
    FUZZ_MUST((count > 0) == (status < 0) && count <= SE3D_MODEL_MISTAKES_MAX);
    se3d_model_destroy(model);
}

/* What was laid out stays as it is. */
static void lay_out(const char *text, size_t size)
{
    se3di_iopool pool;
    se3d_model_error error;
    char *made = NULL, *again = NULL;
    size_t length = 0, other = 0;
    se3di_iopool_init(&pool, NULL);
    if (se3di_layout_make(&pool, "x.yaml", text, size, &made, &length, &error) == SE3D_OK) {
        FUZZ_MUST(!se3di_layout_make(&pool, "x.yaml", made, length, &again, &other, &error));
        FUZZ_MUST(length == other && memcmp(made, again, length) == 0);
    }
    se3di_iopool_destroy(&pool);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const char *text = (const char *)data;
    se3d_model *model = fuzz_read_model(text, size);
    lay_out(text, size);
    if (size % 4 == 0) {
        read_all_mistakes(text, size, model != NULL);
    }
    if (model) {
        fuzz_run_model(model);
    }
    se3d_model_destroy(model);
    return 0;
}
