/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/base/pack.h"

#include <string.h>

enum { WORD = 8 };

static bool has_room(const se3di_pack *pack, size_t size)
{
    return pack->at <= pack->size && pack->size - pack->at >= size;
}

static void put_word(unsigned char *at, uint64_t word)
{
    for (int k = 0; k < WORD; ++k) {
        at[k] = (unsigned char)(word >> (8 * k));
    }
}

static uint64_t get_word(const unsigned char *at)
{
    uint64_t word = 0;
    for (int k = 0; k < WORD; ++k) {
        word |= (uint64_t)at[k] << (8 * k);
    }
    return word;
}

void se3di_pack_word(se3di_pack *pack, uint64_t *word)
{
    const bool fits = has_room(pack, WORD);
    if (pack->in) {
        *word = fits ? get_word(pack->in + pack->at) : 0;
    } else if (pack->out && fits) {
        put_word(pack->out + pack->at, *word);
    }
    pack->failed = pack->failed || !fits;
    pack->at += WORD;
}

void se3di_pack_size(se3di_pack *pack, size_t *size)
{
    uint64_t word = *size;
    se3di_pack_word(pack, &word);
    pack->failed = pack->failed || word > SIZE_MAX;
    if (pack->in) {
        *size = (size_t)word;
    }
}

void se3di_pack_int(se3di_pack *pack, int32_t *value)
{
    uint64_t word = (uint32_t)*value;
    se3di_pack_word(pack, &word);
    pack->failed = pack->failed || word > UINT32_MAX;
    if (pack->in) {
        *value = (int32_t)(uint32_t)word;
    }
}

void se3di_pack_flag(se3di_pack *pack, bool *flag)
{
    uint64_t word = *flag;
    se3di_pack_word(pack, &word);
    pack->failed = pack->failed || word > 1;
    if (pack->in) {
        *flag = word != 0;
    }
}

void se3di_pack_numbers(se3di_pack *pack, double *values, size_t count)
{
    for (size_t k = 0; k < count; ++k) {
        uint64_t word = 0;
        memcpy(&word, &values[k], sizeof word);
        se3di_pack_word(pack, &word);
        if (pack->in) {
            memcpy(&values[k], &word, sizeof word);
        }
    }
}

void se3di_pack_bytes(se3di_pack *pack, const unsigned char **bytes, size_t *size)
{
    se3di_pack_size(pack, size);
    const bool fits = has_room(pack, *size);
    if (pack->in) {
        *bytes = fits ? pack->in + pack->at : NULL;
        *size = fits ? *size : 0;
    } else if (pack->out && fits && *size > 0) {
        memcpy(pack->out + pack->at, *bytes, *size);
    }
    pack->failed = pack->failed || !fits;
    pack->at += *size;
}

void se3di_pack_text(se3di_pack *pack, const char **text)
{
    const unsigned char *bytes = (const unsigned char *)(*text ? *text : "");
    size_t size = pack->in ? 0 : strlen((const char *)bytes);
    se3di_pack_bytes(pack, &bytes, &size);
    if (pack->in) {
        const char *copy = bytes ? se3di_iopool_copy(pack->pool, (const char *)bytes, size) : NULL;
        pack->failed = pack->failed || !copy;
        *text = copy ? copy : "";
    }
}

void se3di_pack_count(se3di_pack *pack, size_t *count)
{
    se3di_pack_size(pack, count);
    if (pack->in && (pack->failed || *count > (pack->size - pack->at) / WORD)) {
        pack->failed = true;
        *count = 0;
    }
}
