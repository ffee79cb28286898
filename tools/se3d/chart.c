/* SPDX-License-Identifier: BSD-3-Clause */
/* A frame of curves. Axes begin and end at round numbers, which are 1, 2 or 5 times a power of ten
 * apart. */
#include "chart.h"

#include <math.h>

#include "io/write/svg.h"

enum { WIDTH = 640, HEIGHT = 320, LEFT = 84, RIGHT = 16, TOP = 34, BOTTOM = 46, LABEL_SIZE = 40 };
enum { POINTS_MAX = 2000, SPOTS_MAX = 500, PIECE_MAX = 512 };

typedef struct axis {
    double from, to, step;
} axis;

/* A round number of about the size of `value`. */
static double get_round(double value)
{
    const double power = pow(10.0, floor(log10(value)));
    const double share = value / power;
    return power * (share < 1.5 ? 1.0 : share < 3.5 ? 2.0 : share < 7.5 ? 5.0 : 10.0);
}

static axis make_axis(double least, double most)
{
    const double size = fmax(fabs(least), fabs(most));
    if (!(least <= most)) {
        least = most = 0.0; /* no row is finite */
    }
    if (!(most - least > 1e-5 * size)) { /* a constant, but for errors */
        const double half = size > 0.0 ? 0.5 * size : 1.0;
        least -= half;
        most += half;
    }
    axis a = {.step = get_round((most - least) / 5.0)};
    a.from = a.step * floor(least / a.step + 1e-9);
    a.to = a.step * ceil(most / a.step - 1e-9);
    return a;
}

static void widen(double value, double *least, double *most)
{
    *least = isfinite(value) ? fmin(*least, value) : *least;
    *most = isfinite(value) ? fmax(*most, value) : *most;
}

static se3di_spot place(const axis *x, const axis *y, double a, double b)
{
    return (se3di_spot){LEFT + (WIDTH - LEFT - RIGHT) * ((a - x->from) / (x->to - x->from)),
                        HEIGHT - BOTTOM -
                            (HEIGHT - TOP - BOTTOM) * ((b - y->from) / (y->to - y->from))};
}

static void put_ticks(const axis *x, const axis *y, FILE *file)
{
    char text[LABEL_SIZE];
    const int columns = (int)lround((x->to - x->from) / x->step);
    const int rows = (int)lround((y->to - y->from) / y->step);
    for (int k = 0; k <= columns; ++k) {
        const double value = x->from + k * x->step;
        const se3di_spot foot = place(x, y, value, y->from);
        se3di_svg_line(file, "grid", foot, place(x, y, value, y->to));
        snprintf(text, sizeof text, "%.6g", fabs(value) < 1e-9 * x->step ? 0.0 : value);
        se3di_svg_text(file, "number", (se3di_spot){foot.x, foot.y + 16.0}, text);
    }
    for (int k = 0; k <= rows; ++k) {
        const double value = y->from + k * y->step;
        const se3di_spot foot = place(x, y, x->from, value);
        se3di_svg_line(file, "grid", foot, place(x, y, x->to, value));
        snprintf(text, sizeof text, "%.6g", fabs(value) < 1e-9 * y->step ? 0.0 : value);
        se3di_svg_text(file, "number", (se3di_spot){foot.x - 30.0, foot.y + 4.0}, text);
    }
}

/* In pieces, which end at rows that have no number. */
static void put_curve(const chart *c, size_t k, const axis *x, const axis *y, FILE *file)
{
    se3di_spot spots[PIECE_MAX];
    char kind[16];
    size_t used = 0;
    const size_t stride = c->count / POINTS_MAX + 1;
    snprintf(kind, sizeof kind, "thick b%zu", k);
    se3di_svg_open(file, "curve", c->names[k]);
    for (size_t i = 0; i < c->count; ++i) {
        if (i % stride != 0 && i + 1 < c->count) {
            continue;
        }
        const int has = isfinite(c->x[i]) && isfinite(c->y[k][i]);
        if (has) {
            spots[used++] = place(x, y, c->x[i], c->y[k][i]);
        }
        if (used == PIECE_MAX || (!has && used > 0)) {
            se3di_svg_path(file, kind, spots, used, false);
            spots[0] = spots[used - 1];
            used = has ? 1 : 0;
        }
    }
    if (used > 1) {
        se3di_svg_path(file, kind, spots, used, false);
    }
    se3di_svg_close(file);
}

static void put_spots(const chart *c, size_t k, const axis *x, const axis *y, FILE *file)
{
    const size_t stride = c->count / SPOTS_MAX + 1;
    char kind[16];
    snprintf(kind, sizeof kind, "spot b%zu", k);
    se3di_svg_open(file, "curve", c->names[k]);
    for (size_t i = 0; i < c->count; i += stride) {
        if (isfinite(c->x[i]) && isfinite(c->y[k][i])) {
            se3di_svg_circle(file, kind, place(x, y, c->x[i], c->y[k][i]), 2.5);
        }
    }
    se3di_svg_close(file);
}

static void put_legend(const chart *c, FILE *file)
{
    const double width = (double)(WIDTH - LEFT - RIGHT) / (double)c->curves;
    for (size_t k = 0; k < c->curves; ++k) {
        char kind[32];
        char name[LABEL_SIZE];
        const double left = LEFT + width * (double)k;
        const int letters = (int)((width - 30.0) / 6.5);
        snprintf(kind, sizeof kind, "thick b%zu", k);
        snprintf(name, sizeof name, "%.*s", letters, c->briefs[k] ? c->briefs[k] : c->names[k]);
        se3di_svg_line(file, kind, (se3di_spot){left, 20.0}, (se3di_spot){left + 18.0, 20.0});
        se3di_svg_text(file, "small", (se3di_spot){left + 22.0, 24.0}, name);
    }
}

void chart_put(const chart *c, FILE *file)
{
    double least[2] = {HUGE_VAL, HUGE_VAL};
    double most[2] = {-HUGE_VAL, -HUGE_VAL};
    for (size_t i = 0; i < c->count; ++i) {
        widen(c->x[i], &least[0], &most[0]);
        for (size_t k = 0; k < c->curves; ++k) {
            widen(c->y[k][i], &least[1], &most[1]);
        }
    }
    const axis x = make_axis(least[0], most[0]);
    const axis y = make_axis(least[1], most[1]);
    se3di_svg_begin(file, WIDTH, HEIGHT, c->title);
    put_ticks(&x, &y, file);
    for (size_t k = 0; k < c->curves; ++k) {
        (c->is_spots ? put_spots : put_curve)(c, k, &x, &y, file);
    }
    put_legend(c, file);
    se3di_svg_text(file, "number", (se3di_spot){LEFT + (WIDTH - LEFT - RIGHT) / 2.0, HEIGHT - 10.0},
                   c->x_label);
    se3di_svg_text(file, "small", (se3di_spot){6.0, 12.0}, c->y_label);
    se3di_svg_end(file);
}
