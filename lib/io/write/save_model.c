/* SPDX-License-Identifier: BSD-3-Clause */
/* Public layer: a system, or the model that it is of, as a model file. */
#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "base/floats.h"
#include "io/base/file.h"
#include "io/base/sized.h"
#include "io/document/document.h"
#include "io/write/save.h"
#include "io/write/save_source.h"

void se3d_write_options_init(se3d_write_options *options, size_t size)
{
    if (options && size >= sizeof options->struct_size) {
        memset(options, 0, size);
        options->struct_size = size;
    }
}

static se3d_status fail(se3d_model_error *error, se3d_status status, const char *place,
                        const char *text)
{
    if (error) {
        se3di_document_report(error, "", 0, 0, place, text);
    }
    return status;
}

static se3d_status fail_write(se3d_model_error *error, const char *path)
{
    char text[200];
    snprintf(text, sizeof text, "cannot be written: %.150s", se3di_file_get_text(errno));
    return fail(error, SE3D_ERR_IO, path, text);
}

static void save_all(se3di_save *s)
{
    if (!se3di_save_name_all(s)) {
        return;
    }
    se3di_save_head(s);
    se3di_save_materials(s);
    se3di_save_bodies(s);
    se3di_save_constraints(s);
    se3di_save_states(s);
    se3di_save_roads(s);
    se3di_save_forces(s);
    se3di_save_wheels(s);
    se3di_save_contact(s);
    if (s->wants_document) {
        se3di_save_document(s);
    }
    se3di_save_losses(s);
}

/* The text, in memory of `s`. */
static se3d_status make_text(se3di_save *s, const se3d_write_options *options,
                             se3d_model_error *error)
{
    se3d_write_options used = {.struct_size = sizeof used};
    if (options && !se3di_io_take(options, &used, sizeof used)) {
        return fail(error, SE3D_ERR_INVALID_ARGUMENT, "", "options: " SE3DI_IO_SIZE_TEXT);
    }
    s->partial = used.partial != 0;
    s->wants_document = used.elements_only == 0;
    const se3di_floats host = se3di_floats_set();
    save_all(s);
    se3di_floats_restore(host);
    if (s->status == SE3D_ERR_NO_MEMORY || s->pool.is_short) {
        s->status = SE3D_ERR_NO_MEMORY;
        return fail(error, s->status, "", "out of memory");
    }
    return s->status < 0 ? fail(error, s->status, "", s->problem) : SE3D_OK;
}

static se3d_status write_file(se3di_save *s, const char *path, const se3d_write_options *options,
                              se3d_model_error *error)
{
    se3d_status status = make_text(s, options, error);
    if (status < 0) {
        return status;
    }
    FILE *file = se3di_partial_open(path);
    if (!file) {
        return fail_write(error, path);
    }
    if (fwrite(s->out.text, 1, s->out.used, file) != s->out.used) {
        status = fail_write(error, path);
        se3di_partial_abandon(file, path);
        return status;
    }
    return se3di_partial_close(file, path) ? SE3D_OK : fail_write(error, path);
}

bool se3di_save_takes_source(const se3d_model *model, const char *path)
{
    bool takes = false;
    for (const se3di_component *part = model->parts; part && !takes; part = part->next) {
        takes = part->file && se3di_file_is_same(part->file, path);
    }
    for (const se3di_attached_file *f = model->attached; f && !takes; f = f->next) {
        takes = se3di_file_is_same(f->path, path);
    }
    return takes;
}

static void clear(se3d_model_error *error)
{
    if (error) {
        memset(error, 0, sizeof *error);
    }
}

se3d_status se3d_model_write(const se3d_model *model, const char *path,
                             const se3d_write_options *options, se3d_model_error *error)
{
    clear(error);
    if (!model || !path) {
        return fail(error, SE3D_ERR_NULL, "", "model or path is NULL");
    }
    se3di_save s = {.model = model, .system = model->system, .path = path};
    se3di_iopool_init(&s.pool, &model->pool.allocator);
    const se3d_status status = write_file(&s, path, options, error);
    se3di_iopool_destroy(&s.pool);
    return status;
}

se3d_status se3d_model_write_text(const se3d_model *model, const se3d_write_options *options,
                                  char *text, size_t capacity, size_t *length,
                                  se3d_model_error *error)
{
    clear(error);
    if (length) {
        *length = 0;
    }
    if (!model || !length) {
        return fail(error, SE3D_ERR_NULL, "", "model or length is NULL");
    }
    se3di_save s = {.model = model, .system = model->system};
    se3di_iopool_init(&s.pool, &model->pool.allocator);
    se3d_status status = make_text(&s, options, error);
    if (status >= 0) {
        *length = s.out.used;
        if (text && s.out.used < capacity) {
            memcpy(text, s.out.text, s.out.used);
            text[s.out.used] = '\0'; /* what was taken back may follow */
        } else if (text) {
            status = fail(error, SE3D_ERR_INVALID_ARGUMENT, "", "capacity is too small");
        }
    }
    se3di_iopool_destroy(&s.pool);
    return status;
}

se3d_status se3d_system_write(const se3d_system *system, const char *path,
                              const se3d_write_options *options, se3d_model_error *error)
{
    clear(error);
    if (!system || !path) {
        return fail(error, SE3D_ERR_NULL, "", "system or path is NULL");
    }
    se3di_save s = {.system = system, .path = path};
    se3di_iopool_init(&s.pool, NULL);
    const se3d_status status = write_file(&s, path, options, error);
    se3di_iopool_destroy(&s.pool);
    return status;
}
