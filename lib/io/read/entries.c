/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/read/entries.h"

bool se3di_read_each(se3di_reader *reader, const se3di_node *root, const char *key,
                     bool (*read)(se3di_reader *reader, const se3di_node *node))
{
    const se3di_node *list = NULL;
    if (!se3di_read_list(reader, root, key, &list)) {
        return false;
    }
    for (const se3di_node *node = list ? list->first : NULL; node; node = node->next) {
        bool wanted = true;
        if (!se3di_reader_wants(reader, node)) {
            continue;
        }
        if (!se3di_read_when(reader, node, &wanted) || (wanted && !read(reader, node))) {
            return false;
        }
    }
    return true;
}

void *se3di_read_room(se3di_reader *reader, const se3di_node *list, size_t size)
{
    void *made = se3di_iopool_array(reader->pool, list ? list->count : 1, size);
    if (!made) {
        (void)se3di_reader_fail_memory(reader);
    }
    return made;
}

bool se3di_read_entries(se3di_reader *reader, const se3di_node *list,
                        bool (*read)(se3di_reader *reader, const se3di_node *node))
{
    for (const se3di_node *node = list ? list->first : NULL; node; node = node->next) {
        if (!read(reader, node)) {
            return false;
        }
    }
    return true;
}
