/* SPDX-License-Identifier: BSD-3-Clause */
/* What all fuzz targets share. A target is one file fuzz_<name>.c with the entry below; libFuzzer
 * calls it with inputs that it makes up (tools/check_fuzz.sh), replay.c with files (the tests
 * fuzz.replay_<name>). A property that does not hold ends the program. */
#ifndef SE3D_FUZZ_FUZZ_H
#define SE3D_FUZZ_FUZZ_H

#include <stddef.h>
#include <stdint.h>

#include "se3d/import.h"
#include "se3d/io.h"

/* Try one input. @return 0 */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Print what does not hold, and abort. */
void fuzz_fail(const char *file, int line, const char *what, const char *why);

#define FUZZ_MUST(condition) FUZZ_MUST_SAY(condition, "")
#define FUZZ_MUST_SAY(condition, why)                                                              \
    do {                                                                                           \
        if (!(condition)) {                                                                        \
            fuzz_fail(__FILE__, __LINE__, #condition, (why));                                      \
        }                                                                                          \
    } while (0)

/* Put an input into a file of that name, in a folder that is this process's alone and goes with it.
 * @return its path, until the next call */
const char *fuzz_write_file(const char *name, const uint8_t *data, size_t size);

/* How often a call may ask whether it is to end, before it is told so. */
typedef struct fuzz_patience {
    long left;
} fuzz_patience;

/* se3d_interrupt with a fuzz_patience. */
int fuzz_interrupt(void *patience);

/* Read a model from a text as if it lay in the folder of fuzz_write_file: the outcome is a model
 * or a message that begins with the file that is to blame. @return NULL: refused */
se3d_model *fuzz_read_model(const char *text, size_t size);

/* Run what a model asks for, cut short: a run that ends well leaves finite states. */
void fuzz_run_model(se3d_model *model);

/* The state of a system is finite; `when` tells when, if not. */
void fuzz_check_finite(const se3d_system *system, const char *when);

#endif
