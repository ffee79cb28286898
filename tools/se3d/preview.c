/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles before their run: how many there are, their step beside the one that the materials ask
 * for, and the pace of the first steps. */
#include "preview.h"

#include <math.h>
#include <se3d/contact.h>
#include <se3d/solver.h>
#include <se3d/system.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define LOOK_AT    0.25 /* s of the clock: what the first steps take, if two runs do not */
#define FIRST_RUN  4.0  /* steps of the first run; */
#define LATER_RUNS 2.0  /* each run after it is so many times as long */

/* The step that the set would choose, whatever is given. */
static double automatic_step(se3d_system *system, se3d_particles *set)
{
    se3d_contact_settings given = se3d_contact_settings_default(), chosen;
    double in_use = 0.0, step = 0.0, left = 0.0;
    if (SE3D_FAILED(se3d_system_get_contact(system, &given)) ||
        SE3D_FAILED(se3d_particles_get_step(set, &in_use))) {
        return 0.0;
    }
    chosen = given;
    chosen.step = 0.0;
    if (!SE3D_FAILED(se3d_system_set_contact(system, &chosen)) &&
        !SE3D_FAILED(se3d_particles_set_step(set, 0.0))) {
        (void)se3d_particles_get_step(set, &step);
    }
    (void)se3d_system_set_contact(system, &given);
    (void)se3d_particles_get_step(set, &left);
    if (left < in_use || left > in_use) { /* it was the set's own */
        (void)se3d_particles_set_step(set, in_use);
    }
    return step;
}

static int measure_sizes(const se3d_particles *set, preview *out)
{
    const size_t count = se3d_particles_count(set);
    double *radii = count > 0 ? malloc(count * sizeof *radii) : NULL;
    if (count > 0 && (!radii || SE3D_FAILED(se3d_particles_get_radii(set, count, radii)))) {
        free(radii);
        return 0;
    }
    for (size_t k = 0; k < count; ++k) {
        out->radius_min = k > 0 ? fmin(out->radius_min, radii[k]) : radii[k];
        out->radius_max = fmax(out->radius_max, radii[k]);
    }
    free(radii);
    return 1;
}

/* The first dynamics analysis; `all`: how long all of them are. @return the number of analyses if
 * there is none */
static size_t find_dynamics(const se3d_model *model, double *duration, double *all)
{
    const size_t count = se3d_model_count_analyses(model);
    size_t at = count;
    *all = *duration = 0.0;
    for (size_t k = 0; k < count; ++k) {
        se3d_model_analysis analysis;
        if (!SE3D_FAILED(se3d_model_get_analysis(model, k, &analysis)) &&
            strcmp(analysis.type, "dynamics") == 0) {
            *duration = at == count ? analysis.duration : *duration;
            *all += analysis.duration;
            at = at == count ? k : at;
        }
    }
    return at;
}

/* What the first dynamics analysis makes of the step of a set. */
static double step_in_use(const se3d_model *model, double step)
{
    double duration, all;
    se3d_solver_def def = se3d_solver_def_default();
    const size_t at = find_dynamics(model, &duration, &all);
    const int given = at < se3d_model_count_analyses(model) &&
                      !SE3D_FAILED(se3d_model_get_solver(model, at, &def)) && def.step > 0.0;
    return given ? fmin(step, def.step) : step;
}

int preview_look(const se3d_model *model, size_t index, preview *out)
{
    se3d_system *system = se3d_model_get_system(model);
    se3d_particles *set = NULL;
    se3d_particles_stats stats;
    memset(out, 0, sizeof *out);
    if (SE3D_FAILED(se3d_system_get_particles(system, index, &set)) ||
        SE3D_FAILED(se3d_particles_get_name(set, &out->name)) ||
        SE3D_FAILED(se3d_particles_get_stats(set, &stats)) || !measure_sizes(set, out)) {
        return 0;
    }
    out->count = se3d_particles_count(set);
    out->clumps = stats.clumps;
    out->bytes = stats.bytes;
    (void)se3d_particles_get_step(set, &out->step);
    out->step = step_in_use(model, out->step);
    out->automatic = automatic_step(system, set);
    if (!soft_look(system, set, &out->held)) {
        out->held.speed = HUGE_VAL;
    }
    return 1;
}

static double now(void)
{
    struct timespec t = {0};
    return timespec_get(&t, TIME_UTC) == TIME_UTC ? (double)t.tv_sec + 1e-9 * (double)t.tv_nsec
                                                  : 0.0;
}

/* Steps of all sets so far. */
static uint64_t count_steps(const se3d_system *system)
{
    uint64_t most = 0;
    for (size_t k = 0; k < se3d_system_count_particles(system); ++k) {
        se3d_particles *set = NULL;
        se3d_particles_stats stats;
        if (!SE3D_FAILED(se3d_system_get_particles(system, k, &set)) &&
            !SE3D_FAILED(se3d_particles_get_stats(set, &stats)) && stats.steps > most) {
            most = stats.steps;
        }
    }
    return most;
}

/* The smallest step of a set; 0 if no set knows one. */
static double least_step(const se3d_system *system)
{
    double least = 0.0;
    for (size_t k = 0; k < se3d_system_count_particles(system); ++k) {
        se3d_particles *set = NULL;
        double step = 0.0;
        if (!SE3D_FAILED(se3d_system_get_particles(system, k, &set)) &&
            !SE3D_FAILED(se3d_particles_get_step(set, &step)) && step > 0.0) {
            least = least > 0.0 ? fmin(least, step) : step;
        }
    }
    return least;
}

/* What a run takes from where the system is. */
typedef struct lap {
    double time, seconds;
    uint64_t steps;
} lap;

/* On to `end`. @return 0, after a message, if that fails */
static int run_lap(se3d_system *system, se3d_solver *solver, double end, lap *sum, char *message,
                   size_t size)
{
    double t = 0.0;
    const uint64_t before = count_steps(system);
    const double begin = now();
    (void)se3d_system_get_time(system, &t);
    if (SE3D_FAILED(se3d_solver_run(solver, end))) {
        snprintf(message, size, "%s", se3d_system_get_error(system));
        return 0;
    }
    sum->seconds += now() - begin;
    sum->steps += count_steps(system) - before;
    sum->time += end - t;
    return 1;
}

/* Runs that are longer and longer, until the clock has moved enough. The first one, in which lists
 * are made, counts for nothing if it is not all. */
static void time_steps(se3d_system *system, se3d_solver *solver, double length, double duration,
                       preview_pace *out)
{
    double t = 0.0, run = FIRST_RUN * length;
    lap first = {0}, later = {0};
    (void)se3d_system_get_time(system, &t);
    const double end = t + duration;
    int goes_on =
        run_lap(system, solver, fmin(t + run, end), &first, out->message, sizeof out->message);
    t += run;
    while (goes_on && t < end && (later.steps == 0 || first.seconds + later.seconds < LOOK_AT)) {
        run *= LATER_RUNS;
        goes_on =
            run_lap(system, solver, fmin(t + run, end), &later, out->message, sizeof out->message);
        t += run;
    }
    const lap *sum = later.steps > 0 ? &later : &first;
    out->is_known = goes_on && sum->steps > 0 && sum->time > 0.0;
    if (out->is_known) {
        out->step = sum->time / (double)sum->steps;
        out->seconds = sum->seconds / (double)sum->steps;
    }
}

void preview_try(const se3d_model *model, preview_pace *out)
{
    se3d_system *system = se3d_model_get_system(model);
    const double length = least_step(system);
    double duration, all;
    const size_t at = find_dynamics(model, &duration, &all);
    se3d_solver_def def = se3d_solver_def_default();
    se3d_solver *solver = NULL;
    memset(out, 0, sizeof *out);
    if (at == se3d_model_count_analyses(model) || !(length > 0.0) ||
        SE3D_FAILED(se3d_model_get_solver(model, at, &def))) {
        return;
    }
    if (SE3D_FAILED(se3d_solver_create(system, &def, &solver))) {
        snprintf(out->message, sizeof out->message, "%s", se3d_system_get_error(system));
        return;
    }
    time_steps(system, solver, length, duration, out);
    se3d_solver_destroy(solver);
    out->steps = out->is_known ? ceil(all / out->step) : 0.0;
    out->seconds *= out->steps;
}
