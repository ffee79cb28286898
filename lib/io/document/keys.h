/* SPDX-License-Identifier: BSD-3-Clause */
/* The keys of the model file: one table, against which docs/se3d.schema.json is tested. */
#ifndef SE3D_IO_KEYS_H
#define SE3D_IO_KEYS_H

#include <stddef.h>

typedef enum se3di_object {
    SE3DI_OBJECT_MODEL = 0,
    SE3DI_OBJECT_BODY = 1,
    SE3DI_OBJECT_ORIENTATION = 2,
    SE3DI_OBJECT_SHAPE = 3,
    SE3DI_OBJECT_MARKER = 4,
    SE3DI_OBJECT_MATERIAL = 5,
    SE3DI_OBJECT_JOINT = 6,
    SE3DI_OBJECT_TERM = 7,
    SE3DI_OBJECT_DRIVER = 8,
    SE3DI_OBJECT_CONSTRAINT = 9,
    SE3DI_OBJECT_FORCE = 10,
    SE3DI_OBJECT_SPLINE = 11,
    SE3DI_OBJECT_ANALYSIS = 12,
    SE3DI_OBJECT_OUTPUT = 13,
    SE3DI_OBJECT_MODES_INPUT = 14,
    SE3DI_OBJECT_MODES_OUTPUT = 15,
    SE3DI_OBJECT_FREQUENCIES = 16,
    SE3DI_OBJECT_CONTACT = 17,
    SE3DI_OBJECT_PAIR = 18,
    SE3DI_OBJECT_PARTICLES = 19,
    SE3DI_OBJECT_RADIUS = 20,
    SE3DI_OBJECT_EVENT = 21,
    SE3DI_OBJECT_SOURCE = 22,
    SE3DI_OBJECT_SINK = 23,
    SE3DI_OBJECT_COUNT = 24
} se3di_object;

/* Keys of a type that not all objects of its kind have. */
typedef struct se3di_type_keys {
    const char *type;
    const char *keys; /* separated by spaces, with one at each end */
} se3di_type_keys;

typedef struct se3di_object_keys {
    const char *name;             /* as in the schema's $defs */
    const char *const *keys;      /* NULL at the end */
    const se3di_type_keys *types; /* NULL: the object has no types; type NULL at the end */
    const char *common;           /* keys that every type has */
    const char *const *values;    /* not NULL: the allowed values of `type`, where no table */
} se3di_object_keys;

const se3di_object_keys *se3di_keys_get(se3di_object object);

/* True where `word` is one of the space-separated words of `list` (a space at each end). */
int se3di_keys_contain(const char *list, const char *word);

#endif
