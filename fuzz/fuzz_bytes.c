/* SPDX-License-Identifier: BSD-3-Clause */
/* Snapshots and solvers as bytes. The input says which model, which method and whose bytes, and
 * then how the bytes of a run of it are changed; they get a right checksum, so that what is behind
 * it is reached. What is taken can be gone on with, and is finite where a step says that it went
 * well. */
#include "fuzz.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "base/hash.h"

enum { ROOM = 1 << 16, HEAD = 3, CHECKSUM = 8, WORD = 8 };

static const char *const models[] = {
    "se3d: 1\nbodies:\n  - {name: bar, mass: 1, inertia: [0.1, 0.2, 0.2], position: [0, 0, -1]}\n"
    "  - {name: rod, mass: 2, inertia: [0.1, 0.2, 0.2], position: [0, 0, -3]}\njoints:\n"
    "  - {name: pin, type: revolute, body_i: ground, body_j: bar, at: [0, 0, 0], axis: [1, 0, 0]}\n"
    "  - {name: ball, type: spherical, body_i: bar, body_j: rod, at: [0, 0, -2]}\nforces:\n"
    "  - {name: s, type: tsda, body_i: ground, body_j: rod, k: 100, c: 1, l0: 2}\n"
    "  - {name: rub, type: friction, joint: pin, coordinate: angle, mu: 0.2, radius: 0.05}\n"
    "  - {name: end, type: stop, joint: pin, coordinate: angle, upper: 0.1, k: 1000}\n",
    "se3d: 1\ncontact: {}\nmaterials: [{name: m, density: 1000, stiffness: 1e4}]\nbodies:\n"
    "  - {name: floor, fixed: true, shapes: [{type: plane, material: m}]}\n"
    "  - {name: a, position: [0, 0, 0.0995], shapes: [{type: sphere, radius: 0.1, material: m}]}\n"
    "  - {name: b, position: [0.2, 0, 0.1], shapes: [{type: box, size: [0.2, 0.2, 0.2], material: "
    "m}]}\n",
    "se3d: 1\ncontact: {}\nmaterials: [{name: m, density: 2500, stiffness: 1e4}]\nbodies:\n"
    "  - {name: floor, fixed: true, shapes: [{type: plane, material: m}]}\n"
    "  - {name: a, mass: 1, inertia: [1, 1, 1], position: [0, 0, 1]}\n"
    "particles: [{material: m, radius: 0.02, lower: [0, 0, 0], upper: [0.1, 0.1, 0.1]}]\n"};
enum { MODELS = sizeof models / sizeof *models };

typedef struct world {
    se3d_model *model;
    se3d_system *system;
    se3d_solver *solver;
    fuzz_patience patience;
} world;

static se3d_status height(void *ctx, const se3d_system *system, double *value)
{
    double r[3];
    se3d_body body;
    se3d_status status = se3d_system_get_body(system, 1, &body);
    (void)ctx;
    if (status >= 0) {
        status = se3d_body_get_position(system, body, r);
        *value = r[2];
    }
    return status;
}

static void open_world(world *w, size_t which, int32_t method)
{
    se3d_solver_def def = se3d_solver_def_default();
    se3d_event_def event = se3d_event_def_default();
    se3d_event made;
    w->patience.left = 200;
    w->model = fuzz_read_model(models[which], strlen(models[which]));
    FUZZ_MUST(w->model != NULL);
    w->system = se3d_model_get_system(w->model);
    def.method = which == MODELS - 1 ? SE3D_METHOD_VERLET : method;
    def.interrupt = fuzz_interrupt;
    def.interrupt_ctx = &w->patience;
    FUZZ_MUST(!se3d_solver_create(w->system, &def, &w->solver));
    event.value = height;
    event.level = -1.001;
    FUZZ_MUST(!se3d_event_create(w->solver, &event, &made));
}

static void close_world(world *w)
{
    se3d_solver_destroy(w->solver);
    se3d_model_destroy(w->model);
}

/* The bytes of a run, which are the same every time: kept for each model and method. */
static size_t write_bytes(size_t which, int32_t method, int of_solver, uint8_t *bytes)
{
    static uint8_t *kept[MODELS][16][2];
    static size_t sizes[MODELS][16][2];
    size_t *size = &sizes[which][method][of_solver];
    if (!kept[which][method][of_solver]) {
        world w;
        se3d_snapshot *snapshot = NULL;
        open_world(&w, which, method);
        w.patience.left = LONG_MAX;
        const se3d_status status = se3d_solver_run(w.solver, 0.02);
        FUZZ_MUST_SAY(status >= 0, se3d_system_get_error(w.system));
        FUZZ_MUST(!se3d_snapshot_create(w.system, &snapshot));
        FUZZ_MUST(!(of_solver ? se3d_solver_write(w.solver, bytes, ROOM, size)
                              : se3d_snapshot_write(snapshot, bytes, ROOM, size)));
        kept[which][method][of_solver] = malloc(*size);
        FUZZ_MUST(kept[which][method][of_solver] != NULL);
        memcpy(kept[which][method][of_solver], bytes, *size);
        se3d_snapshot_destroy(snapshot);
        close_world(&w);
    }
    memcpy(bytes, kept[which][method][of_solver], *size);
    return *size;
}

static void put_word(uint8_t *at, uint64_t word)
{
    for (int k = 0; k < WORD; ++k) {
        at[k] = (uint8_t)(word >> (8 * k));
    }
}

/* One change: where (2 bytes, in words or bytes), how, and with what. */
static size_t change(uint8_t *bytes, size_t size, const uint8_t edit[4])
{
    static const uint64_t words[] = {0,
                                     1,
                                     UINT64_C(0x7FF8000000000000),
                                     UINT64_C(0x7FF0000000000000),
                                     UINT64_C(0x4014000000000000),
                                     UINT64_C(0xBFF0000000000000),
                                     UINT64_C(0x7FEFFFFFFFFFFFFF),
                                     UINT64_C(0x43E0000000000000),
                                     UINT64_C(0xFFFFFFFF),
                                     UINT64_C(0x8000000000000000),
                                     UINT64_MAX};
    const size_t place = (size_t)edit[0] | (size_t)edit[1] << 8;
    const size_t body = size - CHECKSUM;
    const size_t at = place % (body / WORD) * WORD;
    switch (edit[2] % 4) {
    case 0:
        put_word(bytes + at, words[edit[3] % (sizeof words / sizeof *words)]);
        return size;
    case 1:
        bytes[place % body] = edit[3];
        return size;
    case 2:
        memmove(bytes + at, bytes + edit[3] % (body / WORD) * WORD, WORD);
        return size;
    default: /* a word less, or cut */
        if (edit[3] % 2 == 0 || at < 2 * WORD) {
            memmove(bytes + at, bytes + at + WORD, size - at - WORD);
            return size - WORD > 4 * WORD ? size - WORD : size;
        }
        return at + CHECKSUM;
    }
}

/* Within the last step, if there is one, and two steps from what was taken. */
static void go_on(world *w)
{
    double now = 0.0;
    FUZZ_MUST(!se3d_system_get_time(w->system, &now));
    for (int k = 0; k < 3; ++k) {
        const se3d_status status =
            k == 0 ? se3d_solver_run(w->solver, now + 1e-5) : se3d_solver_step(w->solver, 1e-3);
        if (status >= 0) {
            fuzz_check_finite(w->system, "after going on from bytes");
        } else {
            FUZZ_MUST(se3d_system_get_error(w->system)[0]);
        }
    }
}

static void try_snapshot(world *w, const uint8_t *bytes, size_t size)
{
    se3d_snapshot *snapshot = NULL;
    const uint64_t before = se3d_system_hash(w->system);
    const se3d_status status = se3d_snapshot_read(w->system, bytes, size, &snapshot);
    FUZZ_MUST((status >= 0) == (snapshot != NULL));
    FUZZ_MUST(se3d_system_hash(w->system) == before);
    if (snapshot) {
        FUZZ_MUST(!se3d_snapshot_restore(snapshot, w->system));
        go_on(w);
    }
    se3d_snapshot_destroy(snapshot);
}

static void try_solver(world *w, const uint8_t *bytes, size_t size)
{
    const uint64_t before = se3d_system_hash(w->system);
    const se3d_status status = se3d_solver_read(w->solver, bytes, size);
    FUZZ_MUST(se3d_system_hash(w->system) == before || status >= 0);
    go_on(w);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const int32_t methods[] = {
        SE3D_METHOD_DOP853, SE3D_METHOD_BDF,    SE3D_METHOD_RADAU, SE3D_METHOD_GENERALIZED_ALPHA,
        SE3D_METHOD_RATTLE, SE3D_METHOD_CONVEX, SE3D_METHOD_GAUSS, SE3D_METHOD_HHT};
    static uint8_t bytes[ROOM];
    world w;
    if (size < HEAD) {
        return 0;
    }
    const int32_t method = methods[data[1] % (sizeof methods / sizeof *methods)];
    const size_t all = data[0] % MODELS;
    const size_t which = method == SE3D_METHOD_CONVEX && all == 0 ? 1 : all; /* it has friction */
    const int of_solver = data[2] % 2;
    size_t length = write_bytes(which, method, of_solver, bytes);
    for (size_t at = HEAD; at + 4 <= size; at += 4) {
        length = change(bytes, length, data + at);
    }
    put_word(bytes + length - CHECKSUM,
             se3di_hash_bytes(SE3DI_HASH_START, bytes, length - CHECKSUM));
    open_world(&w, which, method);
    if (of_solver) {
        try_solver(&w, bytes, length);
    } else {
        try_snapshot(&w, bytes, length);
    }
    close_world(&w);
    return 0;
}
