/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/live/live.h"

#include <math.h>
#include <string.h>

#include "io/live/pull.h"
#include "io/live/session.h"
#include "io/model/tagged.h"
#include "io/run/run_particles.h"
#include "io/write/scene.h"

struct se3di_live {
    se3di_session_source from;
    se3di_iopool pool;
    se3di_session *now;
    se3di_pull pull;
    uint64_t readings;
};

static bool say(char *message, const char *text)
{
    snprintf(message, SE3DI_LIVE_MESSAGE_SIZE, "%s", text);
    return false;
}

static bool is_ended(const se3di_live *live)
{
    return live->from.interrupt(live->from.ctx) != 0;
}

/* A model that cannot go on where it is begins anew, and `message` says so. */
static se3di_session *begin_anew(se3di_live *live, char *message)
{
    char why[SE3DI_LIVE_MESSAGE_SIZE];
    se3di_session *s = se3di_session_make(&live->from, live->now, SE3DI_LIVE_RESET, why);
    if (s) {
        memcpy(why, message, sizeof why);
        snprintf(message, SE3DI_LIVE_MESSAGE_SIZE, "back at the start: %.1900s", why);
    }
    return s;
}

bool se3di_live_read(se3di_live *live, se3di_live_beginning beginning,
                     char message[SE3DI_LIVE_MESSAGE_SIZE])
{
    if (beginning == SE3DI_LIVE_GOING_ON) {
        (void)se3di_live_release(live);
    }
    message[0] = '\0';
    se3di_session *s = se3di_session_make(&live->from, live->now, beginning, message);
    if (s) {
        message[0] = '\0';
    } else if (beginning == SE3DI_LIVE_GOING_ON && !is_ended(live)) {
        s = begin_anew(live, message);
    }
    if (s && s != live->now) {
        se3di_pull_forget(&live->pull);
        se3di_session_destroy(live->now);
        live->now = s;
        ++live->readings;
    }
    return s != NULL;
}

uint64_t se3di_live_count_readings(const se3di_live *live)
{
    return live->readings;
}

void se3di_live_take_back(se3di_live *live)
{
    se3di_session *s = live->now;
    for (size_t k = 0; k < s->slider_count; ++k) {
        s->sliders[k].value = s->held[k];
        s->is_set[k] = s->held_is_set[k];
    }
}

se3di_live *se3di_live_create(const char *path, const se3d_model_options *options,
                              se3d_interrupt interrupt, void *ctx,
                              char message[SE3DI_LIVE_MESSAGE_SIZE])
{
    se3di_iopool pool;
    se3di_iopool_init(&pool, NULL);
    se3di_live *live = se3di_iopool_alloc(&pool, sizeof *live);
    char *copy = live ? se3di_iopool_copy(&pool, path, strlen(path)) : NULL;
    if (!copy) {
        se3di_iopool_destroy(&pool);
        say(message, "out of memory");
        return NULL;
    }
    live->pool = pool;
    live->from = (se3di_session_source){copy, options, interrupt, ctx};
    if (!se3di_live_read(live, SE3DI_LIVE_ANEW, message)) {
        se3di_live_destroy(live);
        return NULL;
    }
    return live;
}

void se3di_live_destroy(se3di_live *live)
{
    if (live) {
        se3di_iopool pool = live->pool;
        se3di_session_destroy(live->now);
        se3di_iopool_destroy(&pool);
    }
}

/* ---- what it is -----------------------------------------------------------------------------*/

const char *se3di_live_get_file(const se3di_live *live, size_t k)
{
    const se3d_model *model = live->now->model;
    if (k == 0) {
        return live->from.path;
    }
    for (const se3di_component *part = model->parts; part; part = part->next) {
        if (part->file && --k == 0) {
            return part->file;
        }
    }
    for (const se3di_attached_file *file = model->attached; file; file = file->next) {
        if (--k == 0) {
            return file->path;
        }
    }
    return NULL;
}

bool se3di_live_has_motion(const se3di_live *live)
{
    return live->now->solver != NULL;
}

double se3di_live_get_time(const se3di_live *live)
{
    double time = 0.0;
    (void)se3d_system_get_time(live->now->model->system, &time);
    return time;
}

/* ---- running --------------------------------------------------------------------------------*/

/* To a time, or an interrupt. Particles of analyses without dynamics go in short pieces after the
 * bodies, which an interrupt may have left on the way. */
static se3d_status run_all(const se3di_live *live, double time)
{
    const se3di_session *s = live->now;
    const se3di_tagged *particles = s->model->particles;
    const se3d_solver_def *def = &s->model->analyses[s->analysis].solver;
    se3d_status status = SE3D_OK;
    double now = 0.0;
    double step = 0.0;
    if (!particles || def->analysis == SE3D_ANALYSIS_DYNAMICS) {
        return se3d_solver_run(s->solver, time);
    }
    (void)se3d_particles_get_time(particles->set, &now);
    (void)se3d_particles_get_step(particles->set, &step);
    const double piece = step > 0.0 ? 20.0 * step : time - now;
    do {
        now = fmin(time, now + piece);
        status = se3di_tagged_advance(s->model, def, s->solver, now);
        (void)se3d_system_get_time(s->model->system, &now);
        if (status == SE3D_ERR_INTERRUPTED) {
            (void)se3d_particles_run(particles->set, now);
        }
    } while (status >= 0 && status != SE3D_INFO_EVENT && now < time && !is_ended(live));
    return status;
}

bool se3di_live_run(se3di_live *live, double time, char message[SE3DI_LIVE_MESSAGE_SIZE])
{
    se3di_session *s = live->now;
    char what[100];
    message[0] = '\0';
    if (!s->solver) {
        return say(message, "the model has no analysis in which time passes");
    }
    se3d_status status =
        se3d_solver_set_shown(s->solver, s->shows_all ? SE3D_SHOWN_ALL : SE3D_SHOWN_MOTION);
    status = status < 0 ? status : run_all(live, time);
    se3di_session_renew(s);
    if (status >= 0 && status != SE3D_INFO_EVENT) {
        return true;
    }
    if (status == SE3D_ERR_INTERRUPTED) {
        return true;
    }
    if (status == SE3D_INFO_EVENT) {
        snprintf(message, SE3DI_LIVE_MESSAGE_SIZE,
                 "an event of the model has stopped it at t = %.9g s", se3di_live_get_time(live));
        return false;
    }
    snprintf(what, sizeof what, "it cannot go on at t = %.9g s", se3di_live_get_time(live));
    return se3di_session_say(message, s, what, status);
}

size_t se3di_live_count_sliders(const se3di_live *live)
{
    return live->now->slider_count;
}

const se3di_live_slider *se3di_live_get_slider(const se3di_live *live, size_t k)
{
    return &live->now->sliders[k];
}

bool se3di_live_set(se3di_live *live, size_t k, double value)
{
    se3di_session *s = live->now;
    if (k >= s->slider_count || !isfinite(value)) {
        return false;
    }
    if (!s->sliders[k].is_parameter && s->solver) {
        if (se3di_fmi_apply_input(s->model, &s->variables.list[s->slider_variables[k]], value) <
            0) {
            return false;
        }
        s->held[k] = value;
        s->held_is_set[k] = true;
    }
    s->sliders[k].value = value;
    s->is_set[k] = true;
    return true;
}

bool se3di_live_pull(se3di_live *live, size_t body, const double point[3], const double place[3])
{
    const se3d_model *model = live->now->model;
    return live->now->solver && body > 0 && body < model->body_count &&
           se3di_pull_set(&live->pull, model->system, model->bodies[body].body, point, place);
}

bool se3di_live_release(se3di_live *live)
{
    const bool pulled = live->pull.force.index1 != 0;
    se3di_pull_release(&live->pull, live->now->model->system);
    return pulled;
}

/* ---- what is shown --------------------------------------------------------------------------*/

bool se3di_live_put_scene(se3di_live *live, FILE *file)
{
    const se3di_session *s = live->now;
    se3d_scene *scene = NULL;
    if (se3d_scene_create(s->model, &scene) < 0) {
        return false;
    }
    const bool good = se3di_scene_put_at(scene, &s->start, file);
    se3d_scene_destroy(scene);
    return good;
}

size_t se3di_live_count_places(const se3di_live *live)
{
    const se3di_session *s = live->now;
    return SE3DI_POSE * s->model->body_count + 10 * s->between_count + s->rise_count;
}

void se3di_live_get_places(se3di_live *live, double *places)
{
    se3di_session *s = live->now;
    const se3d_model *model = s->model;
    (void)se3di_drawing_get_poses(model, s->poses);
    memcpy(places, s->poses, SE3DI_POSE * model->body_count * sizeof *places);
    places += SE3DI_POSE * model->body_count;
    for (size_t e = 0; e < model->element_count; ++e) {
        for (size_t w = 0; w < se3di_drawing_count_between(&model->elements[e]); ++w) {
            const se3di_part part = se3di_drawing_get_between(model, e, w, &s->sizes, s->poses);
            memcpy(places, part.position, sizeof part.position);
            memcpy(places + 3, part.orientation, sizeof part.orientation);
            memcpy(places + 7, part.scale, sizeof part.scale);
            places += 10;
        }
    }
    for (size_t k = 0; k < s->rise_count; ++k) {
        places[k] = se3di_rise_get(model, &s->rises[k], se3di_live_get_time(live));
    }
}

size_t se3di_live_count_particles(const se3di_live *live)
{
    const se3di_tagged *particles = live->now->model->particles;
    return particles ? se3d_particles_count(particles->set) : 0;
}

bool se3di_live_get_particles(const se3di_live *live, float *places)
{
    const size_t n = se3di_live_count_particles(live);
    se3di_iopool pool;
    se3di_iopool_init(&pool, NULL);
    double *numbers = se3di_iopool_array(&pool, 10 * n + 1, sizeof *numbers);
    const bool good = n > 0 && numbers && se3di_session_get_particles(live->now, numbers);
    for (size_t k = 0; good && k < n; ++k) {
        for (size_t i = 0; i < 3; ++i) {
            places[4 * k + i] = (float)numbers[n + 3 * k + i];
        }
        places[4 * k + 3] = (float)numbers[k];
    }
    se3di_iopool_destroy(&pool);
    return good;
}

bool se3di_live_get_particle_box(const se3di_live *live, double low[3], double high[3])
{
    const se3di_session *s = live->now;
    memcpy(low, s->particle_box[0], 3 * sizeof *low);
    memcpy(high, s->particle_box[1], 3 * sizeof *high);
    return s->model->particles != NULL;
}

size_t se3di_live_count_columns(const se3di_live *live)
{
    return live->now->column_count;
}

const char *se3di_live_get_column(const se3di_live *live, size_t k)
{
    return live->now->columns[k];
}

void se3di_live_get_values(se3di_live *live, double *values)
{
    se3di_session *s = live->now;
    size_t count = 0;
    for (size_t i = 0; s->output && count < s->column_count; ++i) {
        const se3di_channel *channel = &s->output->channels[i];
        double value[4] = {(double)NAN, (double)NAN, (double)NAN, (double)NAN};
        const bool good = se3di_channel_eval(channel, &s->sample, value) >= 0;
        for (size_t j = 0; j < se3di_channel_get_width(channel) && count < s->column_count; ++j) {
            values[count++] = good ? value[j] : (double)NAN;
        }
    }
}
