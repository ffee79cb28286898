/* SPDX-License-Identifier: BSD-3-Clause */
/* Bytes of particles: what is cut, changed or of another model is refused; bytes that were made up
 * with a right checksum do no harm. */
#include <stdlib.h>
#include <string.h>

#include "base/hash.h"
#include "check.h"
#include "support/particle_worlds.h"

typedef struct world {
    se3d_system *system;
    se3d_solver *solver;
    unsigned char *bytes, *changed; /* [size] */
    size_t size;
} world;

static void open_world(world *w, int kind)
{
    se3d_solver_def def = se3d_solver_def_default();
    se3d_snapshot *snapshot = NULL;
    w->system = particle_world(kind, 1);
    def.method = SE3D_METHOD_VERLET;
    CHECK(!se3d_solver_create(w->system, &def, &w->solver));
    CHECK(se3d_solver_run(w->solver, 0.06) >= 0);
    CHECK(!se3d_snapshot_create(w->system, &snapshot));
    CHECK(!se3d_snapshot_write(snapshot, NULL, 0, &w->size));
    w->bytes = malloc(w->size);
    w->changed = malloc(w->size);
    CHECK(w->bytes && w->changed);
    CHECK(!se3d_snapshot_write(snapshot, w->bytes, w->size, &w->size));
    se3d_snapshot_destroy(snapshot);
}

static void close_world(world *w)
{
    se3d_solver_destroy(w->solver);
    se3d_system_destroy(w->system);
    free(w->bytes);
    free(w->changed);
}

/* The checksum that these bytes ought to have. */
static void sign(unsigned char *bytes, size_t size)
{
    const uint64_t sum = se3di_hash_bytes(SE3DI_HASH_START, bytes, size - 8);
    for (int k = 0; k < 8; ++k) {
        bytes[size - 8 + (size_t)k] = (unsigned char)(sum >> (8 * k));
    }
}

static void put_word(unsigned char *at, uint64_t word)
{
    for (int k = 0; k < 8; ++k) {
        at[k] = (unsigned char)(word >> (8 * k));
    }
}

static int is_refused(world *w, size_t size)
{
    se3d_snapshot *snapshot = NULL;
    const se3d_status status = se3d_snapshot_read(w->system, w->changed, size, &snapshot);
    return status == SE3D_ERR_INVALID_ARGUMENT && !snapshot;
}

static size_t parts(size_t some, size_t all)
{
    return check_is_long() ? all : some;
}

/* Also where the checksum is right: what is cut is too short everywhere. */
static void cut_and_changed_bytes_are_refused(void)
{
    for (int kind = 0; kind < PARTICLES_WORLDS; ++kind) {
        world w;
        open_world(&w, kind);
        for (size_t k = 0; k < w.size; k += 1 + w.size / parts(60, 200)) {
            memcpy(w.changed, w.bytes, w.size);
            CHECK(is_refused(&w, k));
            w.changed[k] ^= 0x10;
            CHECK(is_refused(&w, w.size));
            memcpy(w.changed, w.bytes, w.size);
            const size_t words = k - k % 8 < 24 ? 24 : k - k % 8;
            sign(w.changed, words);
            CHECK(is_refused(&w, words));
        }
        close_world(&w);
    }
}

static void other_sets_are_refused(void)
{
    for (int kind = 0; kind < PARTICLES_WORLDS; ++kind) {
        world w;
        open_world(&w, kind);
        for (int other = 0; other < PARTICLES_WORLDS; ++other) {
            se3d_system *system = particle_world(other, 1);
            se3d_snapshot *snapshot = NULL;
            const se3d_status status = se3d_snapshot_read(system, w.bytes, w.size, &snapshot);
            /* planes below and one set in both: the same elements */
            CHECK(kind == other ? status >= 0 : status == SE3D_ERR_STATE || !snapshot || kind == 0);
            CHECK(kind == other || (snapshot == NULL) == (strstr(se3d_system_get_error(system),
                                                                 "of another model") != NULL));
            se3d_snapshot_destroy(snapshot);
            se3d_system_destroy(system);
        }
        close_world(&w);
    }
}

static const uint64_t words[] = {0,
                                 1,
                                 UINT64_C(0x0000000200000003),
                                 UINT64_C(0x7FF8000000000000),
                                 UINT64_C(0x4014000000000000),
                                 UINT64_C(0x43E0000000000000),
                                 UINT64_C(0xBFF0000000000000),
                                 UINT64_C(0xFFFFFFFF),
                                 UINT64_C(0x8000000080000001),
                                 UINT64_MAX};

/* Whatever one word says, nothing is read or written that is not there, and what is taken can be
 * gone on with: the run ends well or with a message. */
static void made_up_words_do_no_harm(void)
{
    for (int kind = 0; kind < PARTICLES_WORLDS; ++kind) {
        size_t taken = 0, refused = 0;
        world w;
        open_world(&w, kind);
        for (size_t at = 16; at + 16 <= w.size; at += 8 * (1 + w.size / parts(2400, 8000))) {
            const uint64_t word = words[(at / 8) % (sizeof words / sizeof *words)];
            se3d_snapshot *snapshot = NULL;
            memcpy(w.changed, w.bytes, w.size);
            put_word(w.changed + at, word);
            sign(w.changed, w.size);
            const se3d_status status = se3d_snapshot_read(w.system, w.changed, w.size, &snapshot);
            CHECK((status >= 0) == (snapshot != NULL));
            refused += status < 0;
            taken += status >= 0;
            if (status >= 0 && taken % 4 == 0) {
                CHECK(!se3d_snapshot_restore(snapshot, w.system));
                (void)se3d_solver_step(w.solver, 1e-5);
                (void)se3d_solver_step(w.solver, 1e-5);
            }
            se3d_snapshot_destroy(snapshot);
        }
        CHECK(taken > parts(20, 80) && refused > parts(10, 80));
        close_world(&w);
    }
}

int main(void)
{
    RUN(cut_and_changed_bytes_are_refused);
    RUN(other_sets_are_refused);
    RUN(made_up_words_do_no_harm);
    return check_finish();
}
