/* SPDX-License-Identifier: BSD-3-Clause */
/* Texts, truths and whole blocks as bytes, beside the numbers of base/coder.h. */
#ifndef SE3D_IO_PACK_H
#define SE3D_IO_PACK_H

#include "base/coder.h"
#include "io/base/pool.h"

void se3di_pack_flag(se3di_coder *coder, bool *flag);
/* Bytes as they are; reading: where they lie, without a copy. */
void se3di_pack_bytes(se3di_coder *coder, const unsigned char **bytes, size_t *size);
/* A text with its length; reading: a copy in the pool. NULL becomes "". */
void se3di_pack_text(se3di_coder *coder, se3di_iopool *pool, const char **text);

#endif
