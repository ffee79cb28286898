/* SPDX-License-Identifier: BSD-3-Clause */
/* The search for what was meant: edit distances. */
#include "io/document/guess.h"

#include <stdint.h>
#include <string.h>

enum { GUESS_LENGTH_MAX = 63 };

static size_t smallest(size_t a, size_t b, size_t c)
{
    const size_t ab = a < b ? a : b;
    return ab < c ? ab : c;
}

/* Edit distance with swaps of neighbours counted as one; both texts at most GUESS_LENGTH_MAX. */
static size_t edit_distance(const char *a, size_t na, const char *b, size_t nb)
{
    size_t rows[3][GUESS_LENGTH_MAX + 1];
    for (size_t j = 0; j <= nb; ++j) {
        rows[0][j] = j;
        rows[1][j] = j;
        rows[2][j] = j;
    }
    for (size_t i = 1; i <= na; ++i) {
        size_t *now = rows[i % 3];
        const size_t *above = rows[(i + 2) % 3];
        const size_t *before = rows[(i + 1) % 3];
        now[0] = i;
        for (size_t j = 1; j <= nb; ++j) {
            now[j] = smallest(above[j] + 1, now[j - 1] + 1, above[j - 1] + (a[i - 1] != b[j - 1]));
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] &&
                before[j - 2] + 1 < now[j]) {
                now[j] = before[j - 2] + 1;
            }
        }
    }
    return rows[na % 3][nb];
}

se3di_guess se3di_guess_begin(const char *word)
{
    const se3di_guess guess = {word, NULL, SIZE_MAX};
    return guess;
}

void se3di_guess_offer(se3di_guess *guess, const char *candidate)
{
    const size_t na = strlen(guess->word);
    const size_t nb = strlen(candidate);
    if (na > GUESS_LENGTH_MAX || nb > GUESS_LENGTH_MAX || na == 0) {
        return;
    }
    const size_t distance = edit_distance(guess->word, na, candidate, nb);
    if (distance < guess->distance) {
        guess->distance = distance;
        guess->best = candidate;
    }
}

const char *se3di_guess_get(const se3di_guess *guess)
{
    const size_t length = strlen(guess->word);
    const size_t allowed = length <= 3 ? 1 : length <= 6 ? 2 : length / 3;
    return guess->best && guess->distance <= allowed ? guess->best : NULL;
}
