/* SPDX-License-Identifier: BSD-3-Clause */
/* Recordings of calls (record/format.h): the first byte says whether they are compared. Whatever
 * they hold, they are played to an end or refused with a message, with arguments that are there and
 * objects that live, and nothing is left behind. */
#include "fuzz.h"

#include <string.h>

#include "player.h"

enum { INTERRUPTS = 300, LARGEST = 1 << 20, CALLS = 3000 };

/* Not what would work for hours: runs that nobody can interrupt, and many particles or states. */
static int allows(void *ctx, const char *name, void *const *arguments)
{
    static const char *const long_ones[] = {
        "se3d_particles_fill_lattice", "se3d_particles_fill_random", "se3d_particles_add_source",
        "se3d_particles_run",          "se3d_particles_step",        "se3d_particles_create",
        "se3d_batch_create",           "se3d_particles_set_step",    "se3d_particles_clone"};
    long *calls = ctx;
    int is_long = --*calls < 0;
    for (size_t k = 0; k < sizeof long_ones / sizeof *long_ones; ++k) {
        is_long |= strcmp(name, long_ones[k]) == 0;
    }
    if (strcmp(name, "se3d_solver_create") == 0) { /* without a definition there is no interrupt */
        const void *def;
        memcpy(&def, arguments[1], sizeof def);
        is_long |= !def;
    }
    return !is_long;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    long calls = CALLS;
    player_report report;
    const player_options options = {.is_free = size > 0 && data[0] & 1,
                                    .interrupts = INTERRUPTS,
                                    .largest = LARGEST,
                                    .allows = allows,
                                    .ctx = &calls};
    if (size > 0) {
        const player_verdict verdict = player_play(data + 1, size - 1, &options, &report);
        FUZZ_MUST(verdict == PLAYER_SAME || report.message[0]);
    }
    return 0;
}
