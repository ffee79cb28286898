/* SPDX-License-Identifier: BSD-3-Clause */
/* A document but for some of its values: what was changed only in these has the same hash. */
#ifndef SE3D_IO_OMITTED_H
#define SE3D_IO_OMITTED_H

#include "io/document/document.h"

enum { SE3DI_DURATIONS_MAX = 64 };

/* Hash a document without the durations of its analyses, the first SE3DI_DURATIONS_MAX of them. */
uint64_t se3di_hash_without_durations(const char *text, size_t length, const se3di_node *root);
/* Whether a setting by path is that of such a duration. */
bool se3di_setting_is_duration(const se3d_model_setting *setting);

#endif
