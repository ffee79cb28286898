/* SPDX-License-Identifier: BSD-3-Clause */
/* Looking up keys in the tables of objects. */
#include "io/document/keys.h"

#include <stdio.h>
#include <string.h>

bool se3di_keys_contain(const char *list, const char *word)
{
    const size_t length = strlen(word);
    for (const char *at = list; length > 0 && (at = strstr(at, word)) != NULL; ++at) {
        if (at > list && at[-1] == ' ' && at[length] == ' ') {
            return true;
        }
    }
    return false;
}

bool se3di_key_is_of(const se3di_key *key, const char *type)
{
    return !type || !key->types || se3di_keys_contain(key->types, type);
}

const se3di_key *se3di_object_find(const se3di_object *object, const char *type, const char *key)
{
    for (const se3di_key *row = object->keys; row->key; ++row) {
        if (strcmp(row->key, key) == 0 && se3di_key_is_of(row, type)) {
            return row;
        }
    }
    return NULL;
}

void se3di_object_list(const se3di_object *object, const char *type, const char *separator,
                       char *text, size_t size)
{
    size_t used = 0;
    text[0] = '\0';
    for (const se3di_key *row = object->keys; row->key && used + 1 < size; ++row) {
        if (!se3di_key_is_of(row, type) || se3di_object_find(object, type, row->key) != row) {
            continue; /* of another type, or a key of several rows */
        }
        snprintf(text + used, size - used, "%s%s", used > 0 ? separator : "", row->key);
        used += strlen(text + used);
    }
}

void se3di_key_list_words(const se3di_key *key, const char *words[SE3DI_WORDS_MAX + 1])
{
    size_t count = 0;
    while (count < SE3DI_WORDS_MAX && key->name_of && *key->name_of((int32_t)count)) {
        words[count] = key->name_of((int32_t)count);
        ++count;
    }
    for (size_t k = 0; count < SE3DI_WORDS_MAX && key->words && key->words[k]; ++k) {
        words[count++] = key->words[k];
    }
    words[count] = NULL;
}
