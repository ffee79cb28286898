/* SPDX-License-Identifier: BSD-3-Clause */
/* How a misuse row fills its definition. */
#ifndef SE3D_TESTS_MISUSE_FIELDS_H
#define SE3D_TESTS_MISUSE_FIELDS_H

#include "misuse/element_defs.h"
#include "misuse/misuse_world.h"

/* Copy `def` into the arguments' storage. */
#define STORE(def) memcpy(&a->storage, &(def), sizeof(def))

static se3d_body ground_of(const arguments *a)
{
    se3d_body ground;
    CHECK(!se3d_system_get_ground(a->system, &ground));
    return ground;
}

static site site_of(const arguments *a)
{
    return (site){.ground = ground_of(a), .body = a->use.body, .pin = a->use.pin};
}

#endif
