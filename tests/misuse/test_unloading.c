/* SPDX-License-Identifier: BSD-3-Clause */
/* Programs that load the library, use it with threads, and close it, as plug-ins do: the threads
 * that wait for more must not lose their code. */
#define _POSIX_C_SOURCE 200809L
#include "check.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "se3d/io.h"

#if defined(SE3D_IO_FILE)
static const char heap[] =
    "se3d: 1\ncontact: {law: hooke, threads: 2}\n"
    "materials: [{name: m, density: 2500, stiffness: 2e4}]\n"
    "particles: [{material: m, radius: 0.01, packing: lattice, lower: [0, 0, 0], upper: [0.2, 0.2, "
    "0.2]}]\n"
    "bodies: [{name: ground, shapes: [{type: plane, material: m}]}]\n"
    "analysis: {type: dynamics, duration: 0.001}\n"
    "output: [{file: unloading.csv, every: 0.001, channels: [particles.count]}]\n";

typedef se3d_status (*run_file)(const char *path, const char *directory, se3d_model_error *error);

static void load_run_and_close(const char *library, const char *path, const char *directory)
{
    const struct timespec moment = {0, 50000000};
    void *object = dlopen(library, RTLD_NOW | RTLD_LOCAL);
    run_file run = NULL;
    if (!object) {
        fprintf(stderr, "%s\n", dlerror());
    }
    CHECK(object != NULL);
    void *found = object ? dlsym(object, "se3d_model_run_file") : NULL;
    memcpy(&run, &found, sizeof run);
    CHECK(run && run(path, directory, NULL) >= 0);
    CHECK(object && dlclose(object) == 0);
    nanosleep(&moment, NULL);
}

static void threads_outlive_the_library(void)
{
    char path[900];
    snprintf(path, sizeof path, "%s/unloading.yaml", check_scratch());
    FILE *file = fopen(path, "wb");
    CHECK(file && fputs(heap, file) >= 0 && fclose(file) == 0);
    for (int k = 0; k < 3; ++k) {
        load_run_and_close(SE3D_IO_FILE, path, check_scratch());
    }
    remove(path);
}
#endif

int main(void)
{
#if defined(SE3D_IO_FILE)
    RUN(threads_outlive_the_library);
#else
    CHECK(1); /* sanitizers, or no library that could be loaded */
#endif
    return check_finish();
}
