/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/names.h"

#include <string.h>

/* FNV-1a, mixed so that all bits matter for the low ones. */
static size_t hash(uint32_t owner, const char *text)
{
    uint64_t h = 14695981039346656037u ^ owner;
    for (; *text; ++text) {
        h = (h ^ (unsigned char)*text) * 1099511628211u;
    }
    h = (h ^ (h >> 32)) * 0x9E3779B97F4A7C15u;
    return (size_t)(h ^ (h >> 29));
}

/* The entry of a name, or the free one where it would be. */
static size_t locate(const se3di_names *names, uint32_t owner, const char *text)
{
    size_t at = hash(owner, text) & (names->capacity - 1);
    while (names->entries[at].text &&
           (names->entries[at].owner != owner || strcmp(names->entries[at].text, text) != 0)) {
        at = (at + 1) & (names->capacity - 1);
    }
    return at;
}

void se3di_names_destroy(se3di_names *names, const se3d_allocator *allocator)
{
    se3di_free(allocator, names->entries, names->capacity, sizeof *names->entries);
    *names = (se3di_names){NULL, 0, 0};
}

se3d_status se3di_names_reserve(se3di_names *names, const se3d_allocator *allocator, size_t count)
{
    se3di_names grown = {NULL, 16, names->count};
    while (grown.capacity / 2 < count) {
        grown.capacity *= 2;
    }
    if (grown.capacity <= names->capacity) {
        return SE3D_OK;
    }
    grown.entries = se3di_alloc(allocator, grown.capacity, sizeof *grown.entries);
    if (!grown.entries) {
        return SE3D_ERR_NO_MEMORY;
    }
    for (size_t k = 0; k < names->capacity; ++k) {
        const se3di_names_entry *entry = &names->entries[k];
        if (entry->text) {
            grown.entries[locate(&grown, entry->owner, entry->text)] = *entry;
        }
    }
    se3di_free(allocator, names->entries, names->capacity, sizeof *names->entries);
    *names = grown;
    return SE3D_OK;
}

void se3di_names_add(se3di_names *names, uint32_t owner, const char *text, uint32_t slot)
{
    names->entries[locate(names, owner, text)] = (se3di_names_entry){text, owner, slot};
    ++names->count;
}

/* Entries behind the gap that could stand in it move up, so that no search ends too early. */
void se3di_names_remove(se3di_names *names, uint32_t owner, const char *text)
{
    if (names->count == 0) {
        return;
    }
    const size_t mask = names->capacity - 1;
    size_t gap = locate(names, owner, text);
    if (!names->entries[gap].text) {
        return;
    }
    for (size_t at = (gap + 1) & mask; names->entries[at].text; at = (at + 1) & mask) {
        const se3di_names_entry *entry = &names->entries[at];
        const size_t home = hash(entry->owner, entry->text) & mask;
        if (((at - home) & mask) >= ((at - gap) & mask)) {
            names->entries[gap] = *entry;
            gap = at;
        }
    }
    names->entries[gap] = (se3di_names_entry){NULL, 0, 0};
    --names->count;
}

uint32_t se3di_names_find(const se3di_names *names, uint32_t owner, const char *text)
{
    if (names->count == 0) {
        return SE3DI_NO_INDEX;
    }
    const se3di_names_entry *entry = &names->entries[locate(names, owner, text)];
    return entry->text ? entry->slot : SE3DI_NO_INDEX;
}
