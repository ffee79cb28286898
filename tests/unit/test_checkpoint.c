/* SPDX-License-Identifier: BSD-3-Clause */
/* Checkpoints that were changed, with a checksum that fits: whatever is in one, to resume from it
 * ends with a message or with results, and soon; nothing is read that is not there. */
#include <sys/stat.h>

#include "base/hash.h"
#include "check.h"
#include "se3d/io.h"
#include "support/read_text.h"
#include "support/scratch.h"

enum { SIZE_MOST = 1 << 20, CALLS_MOST = 20000 };

static unsigned char bytes[SIZE_MOST];
static size_t size;
static char folder[800], path[900];
static int rows, rows_most, told, calls;

static const char text[] =
    "se3d: 1\ngravity: [0, 0, -10]\n"
    "bodies: [{name: arm, mass: 1, inertia: [0.1, 0.1, 0.1], position: [1, 0, 0]}, {name: weak, "
    "mass: "
    "1, inertia: [0.1, 0.1, 0.1], position: [5, 0, 0]}]\n"
    "joints: [{name: pin, type: revolute, body_i: ground, body_j: arm, at: [0, 0, 0], axis: [0, 1, "
    "0]}, {name: thread, type: spherical, body_i: ground, body_j: weak, at: [4, 0, 0], break: "
    "{force: "
    "15}}]\n"
    "states: [{name: lag, type: lag, input: pin.angle, time_constant: 0.1}]\n"
    "events: [{name: low, channel: arm.position.z, value: -0.1}, {name: back, channel: lag.value, "
    "value: 0.2, action: record}]\n"
    "analysis: [{type: modes, file: m.csv}, {type: dynamics, duration: 0.3}, {type: dynamics, "
    "start: "
    "0.3, duration: 1, step: 0.01, method: bdf, tolerance: 1e-5}]\n"
    "output: [{file: a.csv, every: 0.02, channels: [arm.position, pin.angle, lag.value]}, "
    "{summary: "
    "s.csv, channels: [pin.angle]}, {vtk: v.pvd, every: 0.2}]\n";

static void hear(void *ctx, se3d_log_level level, se3d_log_kind kind, const char *message)
{
    (void)ctx;
    (void)level;
    (void)message;
    told += kind == SE3D_LOG_CHECKPOINT;
}

static int end_at(void *ctx, size_t analysis, double time, double fraction)
{
    (void)ctx;
    (void)analysis;
    (void)time;
    (void)fraction;
    return ++rows >= rows_most;
}

/* Who waits for ever is ended, too, and counted. */
static int count_calls(void *ctx)
{
    (void)ctx;
    return ++calls >= CALLS_MOST;
}

static se3d_status run(int resume, int most, se3d_model_error *error)
{
    se3d_run *done = NULL;
    se3d_run_options how = se3d_run_options_default();
    se3d_model_options options = se3d_model_options_default();
    se3d_model *model = NULL;
    options.log = hear;
    how.directory = folder;
    how.progress = end_at;
    how.interrupt = count_calls;
    how.checkpoint = resume ? 1e9 : 1e-9;
    how.resume = resume;
    rows = calls = told = 0;
    rows_most = most;
    CHECK(!se3d_model_read_text(text, strlen(text), "m", &options, &model, error));
    const se3d_status status = se3d_model_run(model, &how, &done, error);
    se3d_run_destroy(done);
    se3d_model_destroy(model);
    return status;
}

static void read_bytes(void)
{
    FILE *file = fopen(path, "rb");
    size = file ? fread(bytes, 1, sizeof bytes, file) : 0;
    CHECK(file && size > 0 && size < sizeof bytes && fclose(file) == 0);
}

/* With its checksum, the last word, lowest byte first. */
static void write_bytes(size_t length, int mends)
{
    FILE *file = fopen(path, "wb");
    uint64_t sum = length >= 8 ? se3di_hash_bytes(SE3DI_HASH_START, bytes, length - 8) : 0;
    for (size_t k = 0; mends && k < 8 && length >= 8; ++k) {
        bytes[length - 8 + k] = (unsigned char)(sum >> 8 * k);
    }
    CHECK(file && fwrite(bytes, 1, length, file) == length && fclose(file) == 0);
}

static void leave_half_a_run(void)
{
    se3d_model_error error = {0};
    char command[1000];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    CHECK(system(command) == 0);
    CHECK(run(0, 60, &error) == SE3D_ERR_INTERRUPTED || !*error.message);
    read_bytes();
}

static void what_is_no_whole_checkpoint_is_refused(void)
{
    se3d_model_error error = {0};
    leave_half_a_run();
    const unsigned char last = bytes[size - 1];
    for (size_t length = 0; length < size; length += 1 + length / 4) {
        write_bytes(length, 0);
        CHECK(run(1, 1000, &error) == SE3D_ERR_STATE);
        CHECK_CONTAINS(error.message, "run.checkpoint: cannot be resumed: it is ");
    }
    bytes[size - 1] ^= 1;
    write_bytes(size, 0);
    CHECK(run(1, 1000, &error) == SE3D_ERR_STATE);
    CHECK_CONTAINS(error.message, "its checksum is another one");
    bytes[size - 1] = last;
    CHECK(remove(path) == 0 && mkdir(path, 0700) == 0);
    CHECK(run(1, 1000, &error) == SE3D_ERR_IO);
    CHECK_CONTAINS(error.message, "cannot be resumed: Is a directory");
    CHECK(remove(path) == 0);
    write_bytes(size, 1);
    CHECK(bytes[size - 1] == last && run(1, 1000, &error) >= 0);
}

static void words_that_were_changed_end_in_words(void)
{
    static const unsigned char changes[][8] = {
        {1}, {0, 0, 0, 0, 0, 0, 0xf0, 0x7f}, {0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff}};
    size_t refused = 0, tried = 0;
    leave_half_a_run();
    for (size_t k = 0; k + 16 <= size; k += 12) {
        for (size_t c = 0; c < sizeof changes / sizeof *changes; ++c) {
            se3d_model_error error = {0};
            for (size_t i = 0; i < 8; ++i) {
                bytes[k + i] ^= changes[c][i];
            }
            write_bytes(size, 1);
            for (size_t i = 0; i < 8; ++i) {
                bytes[k + i] ^= changes[c][i];
            }
            const se3d_status status = run(1, 1000, &error);
            ++tried;
            refused += status < 0;
            CHECK(status >= 0 || error.message[0]);
            CHECK(calls < CALLS_MOST);
            if (calls >= CALLS_MOST || status == SE3D_ERR_NO_CONVERGENCE) {
                fprintf(stderr, "byte %zu of %zu, change %zu: %d %s\n", k, size, c, (int)status,
                        error.message);
            }
        }
    }
    printf("%zu of %zu refused, %zu bytes\n", refused, tried, size);
    CHECK(refused > tried / 2);
}

int main(void)
{
    snprintf(folder, sizeof folder, "%s/checkpoint", check_scratch());
    snprintf(path, sizeof path, "%s/run.checkpoint", folder);
    RUN(what_is_no_whole_checkpoint_is_refused);
    RUN(words_that_were_changed_end_in_words);
    return check_finish();
}
