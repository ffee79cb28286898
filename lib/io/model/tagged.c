/* SPDX-License-Identifier: BSD-3-Clause */
/* Sets, sinks and what else particles have by name. */
#include "io/model/tagged.h"

#include <stdint.h>
#include <string.h>

static const char *get_name(const se3di_tagged *particles, se3di_tagged_kind kind, size_t k)
{
    switch (kind) {
    case SE3DI_TAGGED_SET:
        return particles->sets[k];
    case SE3DI_TAGGED_SINK:
        return particles->sinks[k];
    case SE3DI_TAGGED_REGION:
        return particles->regions[k].name;
    case SE3DI_TAGGED_FLOW:
        return particles->flows[k];
    case SE3DI_TAGGED_SERVO:
        return particles->servos[k];
    case SE3DI_TAGGED_BOND:
        return particles->bonds[k];
    case SE3DI_TAGGED_CLUMP:
        return particles->clumps[k];
    }
    return NULL;
}

size_t se3di_tagged_find(const se3di_tagged *particles, se3di_tagged_kind kind, const char *name)
{
    if (!particles) {
        return SIZE_MAX;
    }
    const size_t counts[] = {
#define SE3DI_TAGGED_COUNT(NAME, number, member) [number] = particles->member##_count,
        SE3DI_TAGGED_LIST(SE3DI_TAGGED_COUNT)
#undef SE3DI_TAGGED_COUNT
    };
    for (size_t k = 0; k < counts[kind]; ++k) {
        const char *own = get_name(particles, kind, k);
        if (own && strcmp(own, name) == 0) {
            return k;
        }
    }
    return SIZE_MAX;
}
