/* SPDX-License-Identifier: BSD-3-Clause */
/* The scenes of bench/touch.h by MuJoCo:
 *
 *     mujoco_touch SCENE N STEP DURATION TIMECONST SOLVER [REPEATS]
 *
 * TIMECONST: of its contacts (solref), over the step, 2 is its safe least; SOLVER: Newton, CG or
 * PGS; elliptic cones. */
#define _POSIX_C_SOURCE 200809L
#include "../touch.h"

#include <mujoco/mujoco.h>
#include <stdio.h>
#include <stdlib.h>

static size_t write_box(const bench_box *box, char *text, size_t room)
{
    const double *s = box->size, *p = box->at, *e = box->turn;
    size_t at = (size_t)snprintf(text, room,
                                 "<body pos='%.17g %.17g %.17g' quat='%.17g %.17g %.17g %.17g'>"
                                 "<freejoint/>",
                                 p[0], p[1], p[2], e[0], e[1], e[2], e[3]);
    at += box->ball > 0.0 ? (size_t)snprintf(text + at, room - at,
                                             "<geom type='sphere' size='%.17g'/></body>", box->ball)
                          : (size_t)snprintf(text + at, room - at,
                                             "<geom type='box' size='%.17g %.17g %.17g'/></body>",
                                             0.5 * s[0], 0.5 * s[1], 0.5 * s[2]);
    return at;
}

static mjModel *load(const bench_box *boxes, int n, char **argv)
{
    static char error[256];
    static mjVFS files;
    const size_t room = 4096 + 512 * (size_t)n;
    char *text = malloc(room);
    if (!text) {
        exit(1);
    }
    const double step = atof(argv[3]);
    size_t at = (size_t)snprintf(
        text, room,
        "<mujoco><size njmax='%d' nconmax='%d' nstack='%d'/><option gravity='0 0 %g' timestep='%g' "
        "solver='%s' cone='elliptic'/><default><geom density='%g' friction='%g .005 .0001' "
        "solref='%g 1' condim='3'/></default><worldbody><geom type='plane' size='0 0 1'/>",
        30 * n + 300, 10 * n + 100, 4000000 + 80 * n * n, -BENCH_TOUCH_GRAVITY, step, argv[6],
        BENCH_TOUCH_DENSITY, BENCH_TOUCH_FRICTION, atof(argv[5]) * step);
    for (int k = 0; k < n; ++k) {
        at += write_box(&boxes[k], text + at, room - at);
    }
    (void)snprintf(text + at, room - at, "</worldbody></mujoco>");
    mj_defaultVFS(&files);
    mj_makeEmptyFileVFS(&files, "scene.xml", (int)strlen(text));
    memcpy(files.filedata[mj_findFileVFS(&files, "scene.xml")], text, strlen(text));
    mjModel *model = mj_loadXML("scene.xml", &files, error, sizeof error);
    if (!model) {
        fprintf(stderr, "%s\n", error);
        exit(1);
    }
    mj_deleteVFS(&files);
    free(text);
    return model;
}

static void show(const mjData *data, double seconds, double iterations)
{
    double deepest = 0.0, mean = 0.0;
    int count = 0;
    for (int k = 0; k < data->ncon; ++k) {
        const double overlap = -data->contact[k].dist;
        deepest = fmax(deepest, overlap);
        mean += fmax(overlap, 0.0);
        count += overlap > 0.0;
    }
    printf("CPU %8.4g s, %5d contacts, overlap %.3g mm (deepest %.3g); %.3g iterations a "
           "step\n",
           seconds, count, count > 0 ? 1e3 * mean / count : 0.0, 1e3 * deepest, iterations);
}

int main(int argc, char **argv)
{
    static bench_box boxes[BENCH_TOUCH_MOST];
    const int n = argc > 6 ? atoi(argv[2]) : 0;
    if (n < 1 || n > BENCH_TOUCH_MOST || !bench_touch_make(argv[1], n, boxes)) {
        fprintf(stderr, "mujoco_touch SCENE N STEP DURATION TIMECONST SOLVER [REPEATS]\n");
        return 2;
    }
    mjModel *model = load(boxes, n, argv);
    mjData *data = mj_makeData(model);
    const int repeats = argc > 7 ? atoi(argv[7]) : 1;
    const long steps = (long)ceil(atof(argv[4]) / atof(argv[3]) - 1e-6);
    double least = HUGE_VAL, iterations = 0.0;
    for (int r = 0; r < repeats; ++r) {
        mj_resetData(model, data);
        for (int k = 0; k < n; ++k) {
            data->qvel[6 * k] = boxes[k].speed;
        }
        iterations = 0.0;
        const double start = bench_clock();
        for (long k = 0; k < steps; ++k) {
            mj_step(model, data);
            iterations += (double)data->solver_iter / (double)steps;
        }
        least = fmin(least, bench_clock() - start);
    }
    printf("MuJoCo %-8s %4d, step %g s, %s: ", argv[1], n, atof(argv[3]), argv[6]);
    show(data, least, iterations);
    for (int k = 0; k < mjNWARNING; ++k) {
        if (data->warning[k].number > 0) {
            printf("  %d: %s\n", data->warning[k].number, mju_warningText(k, 0));
        }
    }
    mj_deleteData(data);
    mj_deleteModel(model);
    return 0;
}
