/* SPDX-License-Identifier: BSD-3-Clause */
/* Names of sets of particles, and of what counts them. */
#include "io/read/particle_names.h"

#include <stdint.h>

#include "io/document/document.h"
#include "io/document/keys.h"
#include "io/document/value.h"
#include "io/model/model.h"
#include "io/model/tagged.h"

bool se3di_check_free_name(se3di_reader *reader, const se3di_node *node, const char *name)
{
    static const char words[] =
        " particles contacts bonds cell dissipation energy violation work steps iterations ";
    const se3d_model *model = reader->model;
    bool taken = se3di_keys_contain(words, name) ||
                 se3di_ionames_find(&model->body_names, name, NULL) ||
                 se3di_ionames_find(&model->element_names, name, NULL);
    for (int kind = 0; kind < SE3DI_TAGGED_CLUMP && !taken; ++kind) {
        taken = se3di_tagged_find(model->particles, (se3di_tagged_kind)kind, name) != SIZE_MAX;
    }
    if (taken) {
        return se3di_reader_fail(reader, node, "`%.60s` is taken, must differ from other names",
                                 name);
    }
    return true;
}

bool se3di_read_shape_name(se3di_reader *reader, const se3di_node *node, se3d_shape *shape)
{
    const char *name = NULL;
    if (!se3di_read_text(reader, node, &name)) {
        return false;
    }
    if (se3d_shape_find(reader->system, name, shape) < 0) {
        return se3di_reader_fail(reader, node, "no shape that touches is named `%.60s`", name);
    }
    return true;
}

bool se3di_read_key_set(se3di_reader *reader, const se3di_node *map, const char *key, int32_t *tag)
{
    const se3di_node *set = se3di_node_get(map, key);
    const char *name = NULL;
    *tag = -1;
    if (!set) {
        return true;
    }
    if (!se3di_read_text(reader, set, &name)) {
        return false;
    }
    const size_t known = se3di_tagged_find(reader->model->particles, SE3DI_TAGGED_SET, name);
    if (known == SIZE_MAX) {
        return se3di_reader_fail(reader, set, "no `particles` are named `%.60s`", name);
    }
    *tag = (int32_t)known;
    return true;
}
