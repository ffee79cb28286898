/* SPDX-License-Identifier: BSD-3-Clause */
/* How a misuse row lists the members of its definition. */
#ifndef SE3D_TESTS_MISUSE_FIELDS_H
#define SE3D_TESTS_MISUSE_FIELDS_H

#include "misuse/misuse_world.h"

#define MEMBER(kind, type, name, count)                                                            \
    {                                                                                              \
        (kind), offsetof(type, name), (count)                                                      \
    }
#define END                                                                                        \
    {                                                                                              \
        0, 0, 0                                                                                    \
    }

/* Copy `def` into the arguments' storage. */
#define STORE(def) memcpy(&a->storage, &(def), sizeof(def))

static se3d_body ground_of(const arguments *a)
{
    se3d_body ground;
    CHECK(!se3d_system_get_ground(a->system, &ground));
    return ground;
}

#endif
