/* SPDX-License-Identifier: BSD-3-Clause */
/* All objects of the model file. */
#include "io/read/objects.h"

const se3di_object *se3di_objects_get(size_t k)
{
#define OBJECT(name) &se3di_object_##name,
    static const se3di_object *const objects[] = {SE3DI_OBJECT_LIST(OBJECT)};
#undef OBJECT
    return k < sizeof objects / sizeof *objects ? objects[k] : NULL;
}
