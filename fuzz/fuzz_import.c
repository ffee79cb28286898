/* SPDX-License-Identifier: BSD-3-Clause */
/* Models of other programs: each input as URDF or MJCF (by its first element), as an Adams data
 * set and as Chrono YAML. What is made of an import can be read, and is the same the second
 * time. */
#include "fuzz.h"

#include <string.h>

static se3d_model_import *import(const uint8_t *data, size_t size, const char *name, int options)
{
    se3d_model_import_options how = se3d_model_import_options_default();
    se3d_model_import *made = NULL;
    se3d_model_error error;
    how.merge_fixed = options & 1;
    how.free_base = options & 2;
    const se3d_status status =
        se3d_model_import_text((const char *)data, size, name, &how, &made, &error);
    FUZZ_MUST(status == SE3D_OK || status == SE3D_ERR_MODEL);
    FUZZ_MUST((status == SE3D_OK) == (made != NULL));
    FUZZ_MUST((status == SE3D_OK) == (error.message[0] == '\0'));
    return made;
}

static void read_notes(const se3d_model_import *made)
{
    size_t lost = 0;
    for (size_t k = 0; k < se3d_model_import_count_notes(made); ++k) {
        se3d_model_import_note note;
        FUZZ_MUST(!se3d_model_import_get_note(made, k, &note));
        FUZZ_MUST(note.message[0] != '\0');
        lost += note.kind == SE3D_IMPORT_LOST;
    }
    FUZZ_MUST(lost <= se3d_model_import_count_lost(made));
}

static void try_format(const uint8_t *data, size_t size, const char *name)
{
    const int options = (int)(size % 4);
    se3d_model_import *first = import(data, size, name, options);
    se3d_model_import *again = import(data, size, name, options);
    FUZZ_MUST((first != NULL) == (again != NULL));
    if (first) {
        size_t length = 0, other = 0;
        const char *text = se3d_model_import_get_text(first, &length);
        const char *same = se3d_model_import_get_text(again, &other);
        se3d_model *model = NULL;
        se3d_model_error error;
        FUZZ_MUST(length == other && memcmp(text, same, length) == 0);
        read_notes(first);
        (void)se3d_model_read_text(text, length, "made.yaml", NULL, &model, &error);
        FUZZ_MUST_SAY(model != NULL, error.message);
        fuzz_run_model(model);
        se3d_model_destroy(model);
    }
    se3d_model_import_destroy(again);
    se3d_model_import_destroy(first);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    try_format(data, size, "x.xml");
    try_format(data, size, "x.adm");
    try_format(data, size, "x.chrono.yaml");
    return 0;
}
