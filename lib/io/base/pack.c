/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/base/pack.h"

void se3di_pack_flag(se3di_coder *coder, bool *flag)
{
    int32_t value = *flag;
    se3di_code_flag(coder, &value);
    *flag = value == 1;
}

void se3di_pack_bytes(se3di_coder *coder, const unsigned char **bytes, size_t *size)
{
    se3di_code_size(coder, size);
    const bool fits = coder->at <= coder->size && coder->size - coder->at >= *size;
    if (coder->in) {
        *bytes = fits ? coder->in + coder->at : NULL;
        *size = fits ? *size : 0;
    } else if (coder->out && fits && *size > 0) {
        memcpy(coder->out + coder->at, *bytes, *size);
    }
    coder->failed |= !fits;
    coder->at += *size;
}

void se3di_pack_text(se3di_coder *coder, se3di_iopool *pool, const char **text)
{
    const unsigned char *bytes = (const unsigned char *)(*text ? *text : "");
    size_t size = coder->in ? 0 : strlen((const char *)bytes);
    se3di_pack_bytes(coder, &bytes, &size);
    if (coder->in) {
        const char *copy = bytes ? se3di_iopool_copy(pool, (const char *)bytes, size) : NULL;
        coder->failed |= !copy;
        *text = copy ? copy : "";
    }
}
