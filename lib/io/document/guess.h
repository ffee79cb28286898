/* SPDX-License-Identifier: BSD-3-Clause */
/* What a word that is not known was probably meant to be. */
#ifndef SE3D_IO_GUESS_H
#define SE3D_IO_GUESS_H

#include <stddef.h>

/* The candidate that `word` was probably meant to be, or NULL. */
typedef struct se3di_guess {
    const char *word;
    const char *best;
    size_t distance;
} se3di_guess;

se3di_guess se3di_guess_begin(const char *word);
void se3di_guess_offer(se3di_guess *guess, const char *candidate);
/* The best one, or NULL if none is near enough. */
const char *se3di_guess_get(const se3di_guess *guess);
/* What a type is one of, "a type of `joints`", also a key of the model; NULL: of nothing. */
const char *se3di_guess_place(const char *word);

#endif
