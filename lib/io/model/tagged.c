/* SPDX-License-Identifier: BSD-3-Clause */
/* Sets and sinks by their names. */
#include "io/model/tagged.h"

#include <stdint.h>
#include <string.h>

static size_t find_name(const char *const *names, size_t count, const char *name)
{
    for (size_t k = 0; k < count; ++k) {
        if (names[k] && strcmp(names[k], name) == 0) {
            return k;
        }
    }
    return SIZE_MAX;
}

size_t se3di_tagged_find_set(const se3di_tagged *particles, const char *name)
{
    return particles ? find_name(particles->sets, particles->set_count, name) : SIZE_MAX;
}

size_t se3di_tagged_find_sink(const se3di_tagged *particles, const char *name)
{
    return particles ? find_name(particles->sinks, particles->sink_count, name) : SIZE_MAX;
}

size_t se3di_tagged_find_flow(const se3di_tagged *particles, const char *name)
{
    return particles ? find_name(particles->flows, particles->flow_count, name) : SIZE_MAX;
}

size_t se3di_tagged_find_servo(const se3di_tagged *particles, const char *name)
{
    return particles ? find_name(particles->servos, particles->servo_count, name) : SIZE_MAX;
}

size_t se3di_tagged_find_bond(const se3di_tagged *particles, const char *name)
{
    return particles ? find_name(particles->bonds, particles->bond_count, name) : SIZE_MAX;
}

size_t se3di_tagged_find_clump(const se3di_tagged *particles, const char *name)
{
    return particles ? find_name(particles->clumps, particles->clump_count, name) : SIZE_MAX;
}

size_t se3di_tagged_find_region(const se3di_tagged *particles, const char *name)
{
    for (size_t k = 0; particles && k < particles->region_count; ++k) {
        if (strcmp(particles->regions[k].name, name) == 0) {
            return k;
        }
    }
    return SIZE_MAX;
}
