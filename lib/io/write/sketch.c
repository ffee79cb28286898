/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/write/sketch.h"

#include <math.h>

#include "io/write/sketch_sheet.h"

/* [px] */
#define WIDTH  760.0
#define HEIGHT 560.0

enum { ROWS_USUAL = 48, COLUMNS_MAX = 4 };

/* How many degrees of freedom there are, and what is wrong. */
static se3d_status tell_freedoms(se3di_sketch *s)
{
    se3d_check *check = NULL;
    se3d_check_summary sum = {.struct_size = sizeof sum};
    se3d_status status = se3d_check_create(s->model->system, &check);
    status = status < 0 ? status : se3d_check_get_summary(check, &sum);
    se3d_check_destroy(check);
    if (status >= 0) {
        se3di_sketch_add_line(s, "#Degrees of freedom: %zu", sum.freedoms);
        se3di_sketch_add_line(s, "6 x %zu bodies - %zu equations of rank %zu", sum.bodies,
                              sum.equations, sum.rank);
        if (sum.redundant > 0) {
            se3di_sketch_add_line(s, "%zu redundant, %zu inconsistent (see se3d check)",
                                  sum.redundant, sum.inconsistent);
        }
    }
    return status < 0 ? status : SE3D_OK;
}

/* How large the sheet is. The number of lines is known when all is listed: an upper bound of it
 * is enough. @return its width with the legend, of which a long one has several columns. */
static double lay_out(se3di_sketch *s)
{
    const size_t all = 16 + s->model->body_count + s->model->element_count;
    const size_t most = all < SE3DI_SKETCH_LINES ? all : SE3DI_SKETCH_LINES;
    size_t columns = 1;
    while (columns < COLUMNS_MAX &&
           columns * (columns > 1 ? columns * ROWS_USUAL / 2 : ROWS_USUAL) < most) {
        ++columns;
    }
    s->rows = (most + columns - 1) / columns;
    s->height = fmax(HEIGHT, 60.0 + (SE3DI_SKETCH_LINE + 2.0) * (double)s->rows);
    s->width = round(WIDTH / HEIGHT * s->height);
    return s->width + SE3DI_SKETCH_COLUMN * (double)columns;
}

static se3d_status prepare(se3di_sketch *s, const double view[2])
{
    const se3d_model *model = s->model;
    s->poses = se3di_iopool_array(&s->pool, model->body_count, SE3DI_POSE * sizeof *s->poses);
    s->joints = se3di_iopool_array(&s->pool, model->element_count + 1, sizeof *s->joints);
    s->lines = se3di_iopool_array(&s->pool, SE3DI_SKETCH_LINES, sizeof *s->lines);
    s->looks = se3di_iopool_array(&s->pool, model->body_count, sizeof *s->looks);
    if (!s->poses || !s->joints || !s->lines || !s->looks) {
        return SE3D_ERR_NO_MEMORY;
    }
    const se3d_status status = se3di_drawing_get_poses(model, s->poses);
    const se3di_poses poses = {s->poses, model->body_count, 1, NULL};
    if (status >= 0) {
        se3di_drawing_measure(model, &poses, &s->sizes);
        se3di_sketch_turn(&s->view, view, model, s->poses);
        se3di_sketch_list_looks(s);
        se3di_sketch_fit(s);
    }
    return status;
}

se3d_status se3di_sketch_put(se3d_model *model, const double view[2], FILE *file)
{
    se3di_sketch s = {.model = model, .file = file};
    const char *title = model->title[0] ? model->title : model->name;
    se3di_iopool_init(&s.pool, &model->pool.allocator);
    const double width = lay_out(&s);
    se3d_status status = prepare(&s, view);
    status = status < 0 ? status : tell_freedoms(&s);
    if (status >= 0) {
        se3di_svg_begin(file, width, s.height, title);
        se3di_svg_text(file, "title", (se3di_spot){16.0, 28.0}, title);
        se3di_sketch_put_bodies(&s);
        se3di_sketch_put_elements(&s);
        se3di_sketch_put_joints(&s);
        se3di_sketch_put_legend(&s);
        se3di_svg_end(file);
    }
    se3di_iopool_destroy(&s.pool);
    return status < 0 ? status : s.failed ? SE3D_ERR_NO_MEMORY : SE3D_OK;
}
