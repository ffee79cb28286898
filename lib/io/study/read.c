/* SPDX-License-Identifier: BSD-3-Clause */
/* The model of a study with other parameters, from the tree of its file. */
#include "io/document/document.h"
#include "io/read/mistakes.h"
#include "io/study/study.h"

se3d_status se3di_study_read(se3d_study *study, const se3di_named *values, size_t count,
                             se3d_model **model, se3d_model_error *error)
{
    const se3d_model *like = study->model;
    se3d_model *made = *model = se3di_model_create(&like->pool.allocator);
    if (!made) {
        se3di_document_report(error, "", 0, 0, "", "out of memory");
        return SE3D_ERR_NO_MEMORY;
    }
    made->file = like->file;
    made->name = like->name;
    made->root = like->root;
    se3di_attempt attempt = {.model = made,
                             .options = &study->entry->options,
                             .error = error,
                             .library = like->library,
                             .values = values,
                             .value_count = count,
                             .study = study->entry};
    return se3di_model_fill(&attempt);
}
