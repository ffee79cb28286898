/* SPDX-License-Identifier: BSD-3-Clause */
/* Reading what has a place in a structure, by the table of an object. */
#include "io/document/fields.h"

#include <string.h>

#include "io/document/value.h"

static bool read_word(se3di_reader *reader, const se3di_node *node, const se3di_key *row,
                      int32_t *index)
{
    const char *words[SE3DI_WORDS_MAX + 1];
    size_t word = 0;
    se3di_key_list_words(row, words);
    if (!se3di_read_word(reader, node, words, &word)) {
        return false;
    }
    *index = (int32_t)word;
    return true;
}

static bool read_number(se3di_reader *reader, const se3di_node *map, const se3di_key *row,
                        double *value)
{
    return row->range == SE3DI_RESTITUTION
               ? se3di_read_key_restitution(reader, map, value)
               : se3di_read_key_number(reader, map, row->key, row->range, value);
}

static bool read_row(se3di_reader *reader, const se3di_node *map, const se3di_key *row, void *value)
{
    const se3di_node *node = se3di_node_get(map, row->key);
    if (!node) {
        return true;
    }
    switch (row->kind) {
    case SE3DI_KIND_NUMBER:
        return read_number(reader, map, row, value);
    case SE3DI_KIND_COUNT:
        return se3di_read_key_count(reader, map, row->key, row->most, value);
    case SE3DI_KIND_VECTOR:
        return se3di_read_vector(reader, node, 3, value);
    case SE3DI_KIND_DIRECTION:
        return se3di_read_key_direction(reader, map, row->key, value);
    case SE3DI_KIND_ORIENTATION:
        return se3di_read_orientation(reader, node, value);
    case SE3DI_KIND_BOOL:
        return se3di_read_bool(reader, node, value);
    case SE3DI_KIND_WORD:
        return read_word(reader, node, row, value);
    case SE3DI_KIND_TEXT:
        return se3di_read_text(reader, node, value);
    default:
        return se3di_read_name(reader, node, value);
    }
}

bool se3di_read_fields(se3di_reader *reader, const se3di_node *map, const se3di_object *object,
                       const char *type, const char *structure, void *target)
{
    for (const se3di_key *row = object->keys; row->key; ++row) {
        if (!row->structure || strcmp(row->structure, structure) != 0 ||
            !se3di_key_is_of(row, type)) {
            continue;
        }
        if (row->required && !se3di_node_get(map, row->key)) {
            return se3di_reader_fail_key(reader, map, row->key, "is missing: %s", row->text);
        }
        if (!read_row(reader, map, row, (char *)target + row->offset)) {
            return false;
        }
    }
    return true;
}

bool se3di_read_key(se3di_reader *reader, const se3di_node *map, const se3di_object *object,
                    const char *type, const char *key, void *value)
{
    return read_row(reader, map, se3di_object_find(object, type, key), value);
}
