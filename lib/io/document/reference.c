/* SPDX-License-Identifier: BSD-3-Clause */
/* Names with numbers in them, "link{i - 1}", and conditions. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/base/pool.h"
#include "io/document/amount.h"
#include "io/document/reader.h"
#include "io/document/value.h"

enum { NAME_SIZE = 400 };

/* The whole number that an expression in braces is. */
static bool read_number(se3di_reader *reader, const se3di_node *node, const char *text,
                        size_t length, double *value)
{
    se3di_node part = *node;
    se3di_amount q;
    part.text = se3di_iopool_copy(reader->pool, text, length);
    part.column += node->one_line ? (size_t)(text - node->text) + (node->plain ? 0 : 1) : 0;
    if (!part.text) {
        return se3di_reader_fail_memory(reader);
    }
    if (!se3di_amount_eval(reader, &part, NULL, &q)) {
        return false;
    }
    if (q.rank != 1 || q.hard || !(fabs(q.v[0]) < 1e9) || q.v[0] != floor(q.v[0])) {
        return se3di_reader_fail(reader, &part, "`{%.60s}` must be a whole number without a unit",
                                 part.text);
    }
    *value = q.v[0];
    return true;
}

bool se3di_read_reference(se3di_reader *reader, const se3di_node *node, const char **name)
{
    char made[NAME_SIZE] = "";
    size_t used = 0;
    if (!se3di_read_text(reader, node, name) || !strchr(*name, '{')) {
        return reader->status == 0;
    }
    const char *at = *name;
    for (const char *open = strchr(at, '{'); open; open = strchr(at, '{')) {
        const char *close = strchr(open, '}');
        double value = 0.0;
        if (!close || used + (size_t)(open - at) + 20 > NAME_SIZE) {
            return true; /* no name: told when it is looked at */
        }
        if (!read_number(reader, node, open + 1, (size_t)(close - open - 1), &value)) {
            return false;
        }
        used += (size_t)snprintf(made + used, NAME_SIZE - used, "%.*s%.0f", (int)(open - at), at,
                                 value == 0.0 ? 0.0 : value);
        at = close + 1;
    }
    if (used + strlen(at) >= NAME_SIZE) {
        return true;
    }
    snprintf(made + used, NAME_SIZE - used, "%s", at);
    *name = se3di_iopool_copy(reader->pool, made, strlen(made));
    return *name || se3di_reader_fail_memory(reader);
}

bool se3di_read_when(se3di_reader *reader, const se3di_node *map, bool *wanted)
{
    const se3di_node *node = se3di_node_get(map, "when");
    se3di_amount q;
    *wanted = true;
    if (!node) {
        return true;
    }
    if (node->text && (strcmp(node->text, "true") == 0 || strcmp(node->text, "false") == 0)) {
        *wanted = node->text[0] == 't';
        return true;
    }
    if (!se3di_read_amount(reader, node, &q)) {
        return false;
    }
    if (q.rank != 1 || q.hard) {
        return se3di_reader_fail(
            reader, node, "`%.120s` must be true, false, a comparison or a number", node->text);
    }
    *wanted = !(q.v[0] == 0.0);
    return true;
}
