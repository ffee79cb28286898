/* SPDX-License-Identifier: BSD-3-Clause */
/* Settings whose name is a path in the document, as in "bodies.bar.mass". */
#ifndef SE3D_IO_SETTING_H
#define SE3D_IO_SETTING_H

#include "io/document/document.h"

/* Whether a setting names a place in the document; else it names a parameter. */
bool se3di_setting_is_path(const se3d_model_setting *setting);
/* Put the value, a text in YAML, where the path leads: in the place of what stands there, or as a
 * new key of a map. An entry of a list is named by its `name` or as [k], from 0.
 * @return OK, MODEL (no such place, no value), NO_MEMORY, with `error` filled. */
se3d_status se3di_setting_apply(se3di_iopool *pool, se3di_node *root,
                                const se3d_model_setting *setting, se3d_model_error *error);

#endif
