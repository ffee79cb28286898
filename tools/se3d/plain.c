/* SPDX-License-Identifier: BSD-3-Clause */
#include "plain.h"

#include <string.h>

/* The ']' of the link that begins here, NULL: none does. */
static const char *link_end(const char *text)
{
    const char *end = text + strcspn(text, "]");
    return *text == '[' && strncmp(end, "](", 2) == 0 ? end : NULL;
}

void plain_copy(const char *text, char *out, size_t size)
{
    size_t used = 0;
    const char *end = NULL;
    while (*text && used + 1 < size) {
        if (text == end) {
            text += strcspn(text, ")");
            text += *text != '\0';
        } else if (link_end(text)) {
            end = link_end(text++);
        } else {
            out[used++] = *text++;
        }
    }
    out[used] = '\0';
}
