/* SPDX-License-Identifier: BSD-3-Clause */
/* Which curves go into which frame, and the gnuplot script that draws them. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "plot.h"
#include "process.h"

enum { POINTS_MAX = 4000 };

/* Without -y: these, as far as the file has them. */
static const char *const usual[] = {"position",     "velocity", "acceleration",     "angle",
                                    "displacement", "force",    "torque",           "effort",
                                    "length",       "energy",   "angular_velocity", NULL};

static int is_part(const char *name, const char *channel)
{
    const size_t length = strlen(channel);
    return strncmp(name, channel, length) == 0 && (name[length] == '\0' || name[length] == '.');
}

static void make_title(const plot *p, const char *name, char *title, size_t size)
{
    char quantity[400];
    char unit[60];
    table_get_quantity(name, quantity, sizeof quantity);
    for (char *c = quantity; *c; ++c) {
        *c = *c == '_' ? ' ' : *c;
    }
    const char *text = table_get_unit(&p->tables[0], name, unit, sizeof unit);
    snprintf(title, size, text[0] ? "%.90s [%.40s]" : "%.90s%s", quantity, text);
}

static void add_curve(plot *p, const char *name)
{
    char title[160];
    size_t k = 0;
    make_title(p, name, title, sizeof title);
    while (k < p->panel_count && strcmp(p->panels[k].title, title) != 0) {
        ++k;
    }
    if (k == PLOT_PANELS_MAX) {
        return;
    }
    plot_panel *panel = &p->panels[k];
    if (k == p->panel_count) {
        ++p->panel_count;
        strcpy(panel->title, title);
    }
    for (size_t i = 0; i < panel->count; ++i) {
        if (strcmp(panel->names[i], name) == 0) {
            return;
        }
    }
    if (panel->count == PLOT_CURVES_MAX) {
        ++panel->dropped;
    } else {
        panel->names[panel->count++] = name;
    }
}

static int choose_named(plot *p)
{
    const table *t = &p->tables[0];
    for (size_t c = 0; c < p->channel_count; ++c) {
        int found = 0;
        for (size_t k = 0; k < t->count; ++k) {
            if (is_part(t->names[k], p->channels[c])) {
                add_curve(p, t->names[k]);
                found = 1;
            }
        }
        if (!found) {
            fprintf(stderr, "se3d plot: %s has no channel `%s`, it has:", t->path, p->channels[c]);
            for (size_t k = 0; k < t->count; ++k) {
                fprintf(stderr, "%s %s", k > 0 ? "," : "", t->names[k]);
            }
            fputc('\n', stderr);
            return 0;
        }
    }
    return 1;
}

static void choose_usual(plot *p)
{
    const table *t = &p->tables[0];
    for (size_t q = 0; usual[q]; ++q) {
        for (size_t k = 1; k < t->count; ++k) {
            char quantity[400];
            table_get_quantity(t->names[k], quantity, sizeof quantity);
            if (strcmp(quantity, usual[q]) == 0) {
                add_curve(p, t->names[k]);
            }
        }
    }
    for (size_t k = 1; k < t->count && p->panel_count == 0; ++k) {
        add_curve(p, t->names[k]);
    }
}

int plot_choose(plot *p)
{
    const table *t = &p->tables[0];
    p->x = p->x ? p->x : t->names[0];
    if (table_find(t, p->x) == t->count) {
        fprintf(stderr, "se3d plot: %s has no column `%s` for -x\n", t->path, p->x);
        return 0;
    }
    make_title(p, p->x, p->x_title, sizeof p->x_title);
    if (strcmp(p->x, t->names[0]) != 0) {
        char unit[60];
        const char *text = table_get_unit(t, p->x, unit, sizeof unit);
        snprintf(p->x_title, sizeof p->x_title, text[0] ? "%.90s [%.40s]" : "%.90s%s", p->x, text);
    }
    if (p->channel_count > 0) {
        if (!choose_named(p)) {
            return 0;
        }
    } else {
        choose_usual(p);
    }
    if (p->panel_count == 0) {
        fprintf(stderr, "se3d plot: %s has no column but `%s`\n", t->path, t->names[0]);
        return 0;
    }
    for (size_t k = 0; k < p->panel_count && !p->quiet; ++k) {
        if (p->panels[k].dropped > 0) {
            fprintf(stderr, "se3d plot: %s: %zu more curves have no room, choose with -y\n",
                    p->panels[k].title, p->panels[k].dropped);
        }
    }
    return 1;
}

/* A text in single quotes, as gnuplot reads it. */
static void put_text(FILE *file, const char *before, const char *text, const char *after)
{
    fputs(before, file);
    fputc('\'', file);
    for (const char *c = text; *c; ++c) {
        fputs(*c == '\'' ? "''" : (char[2]){*c, '\0'}, file);
    }
    fputc('\'', file);
    fputs(after, file);
}

/* The data file as it is called from the folder of the script. */
static void put_data(const plot *p, FILE *file, size_t k)
{
    char folder[2][4096];
    char full[4200];
    const char *path = p->tables[k].path;
    path_get_folder(path, folder[0], sizeof folder[0]);
    path_get_folder(p->base, folder[1], sizeof folder[1]);
    const int same = strcmp(folder[0], folder[1]) == 0;
    const int found = !same && path_get_absolute(path, full, sizeof full);
    put_text(file, "", same ? path_get_name(path) : found ? full : path, "");
}

static void put_curve(const plot *p, FILE *file, const plot_panel *panel, size_t curve, size_t k)
{
    static const char *const colors[PLOT_CURVES_MAX] = {"#1f6fb4", "#d1495b", "#2e8b57",
                                                        "#e08e0b", "#7b4fa3", "#17a2b8",
                                                        "#8c5a3c", "#c2185b", "#555555"};
    const table *t = &p->tables[k];
    const size_t x = table_find(t, p->x);
    const size_t y = table_find(t, panel->names[curve]);
    char title[600];
    if (x == t->count || y == t->count) {
        return;
    }
    const size_t stride = (t->rows + POINTS_MAX - 1) / POINTS_MAX;
    if (p->file_count > 1) {
        char name[240];
        path_cut(path_get_name(p->files[k]), ".csv", name, sizeof name);
        snprintf(title, sizeof title, "%.300s (%.200s)", panel->names[curve], name);
    } else {
        snprintf(title, sizeof title, "%.300s", panel->names[curve]);
    }
    fputs("        ", file);
    put_data(p, file, k);
    fprintf(file, " every %zu using %zu:%zu with %s lw 1.6 dt %zu lc rgb '%s' title ", stride,
            x + 1, y + 1, t->rows == 1 ? "points pt 7" : "lines", k + 1, colors[curve]);
    put_text(file, "", title, ", \\\n");
}

/* The least and the largest number of a column, widened. */
static void widen(const table *t, size_t column, double range[2])
{
    const size_t stride = (t->rows + POINTS_MAX - 1) / POINTS_MAX;
    double *values = malloc((POINTS_MAX + 1) * sizeof *values);
    const size_t count = values && column < t->count
                             ? table_read_column(t, column, stride, values, POINTS_MAX + 1)
                             : 0;
    for (size_t k = 0; k < count; ++k) {
        if (isfinite(values[k])) {
            range[0] = fmin(range[0], values[k]);
            range[1] = fmax(range[1], values[k]);
        }
    }
    free(values);
}

static void find_range(const plot *p, plot_panel *panel)
{
    panel->range[0] = HUGE_VAL;
    panel->range[1] = -HUGE_VAL;
    for (size_t k = 0; k < p->file_count; ++k) {
        for (size_t curve = 0; curve < panel->count; ++curve) {
            widen(&p->tables[k], table_find(&p->tables[k], panel->names[curve]), panel->range);
        }
    }
}

/* Digits that tell the marks of an axis apart. */
static int count_digits(const double range[2])
{
    const double size = fmax(fabs(range[0]), fabs(range[1]));
    const double width = range[1] - range[0];
    const int more = width > 0.0 && isfinite(width) ? (int)ceil(log10(size / width)) : 0;
    return more < 1 ? 4 : more < 11 ? 3 + more : 14;
}

static int is_constant(const double range[2])
{
    return range[1] - range[0] <= 1e-14 * fabs(range[0]);
}

/* What is constant, or a single point, has no width of its own to draw. */
static void put_range(FILE *file, const char *axis, const double range[2])
{
    if (is_constant(range) && isfinite(range[0])) {
        const double around = range[0] < 0.0 || range[0] > 0.0 ? 0.1 * fabs(range[0]) : 1.0;
        fprintf(file, "    set %srange [%.15g:%.15g]\n", axis, range[0] - around,
                range[0] + around);
    } else {
        fprintf(file, "    set autoscale %s%s\n", axis, axis[0] == 'x' ? "fix" : "");
    }
}

static void put_panel(const plot *p, FILE *file, const plot_panel *panel, int last)
{
    put_range(file, "y", panel->range);
    fprintf(file, "    set format y '%%.%dg'\n", count_digits(panel->range));
    put_text(file, "    set ylabel ", panel->title, "\n");
    if (last) {
        put_text(file, "    set xlabel ", p->x_title, "\n");
    } else {
        fputs("    unset xlabel\n", file);
    }
    fputs("    plot \\\n", file);
    for (size_t curve = 0; curve < panel->count; ++curve) {
        for (size_t k = 0; k < p->file_count; ++k) {
            put_curve(p, file, panel, curve, k);
        }
    }
    fputs("        NaN notitle\n", file);
}

/* The longest name in a key, so that all frames have one width. */
static size_t key_width(const plot *p)
{
    size_t width = 0;
    size_t file = 0;
    for (size_t k = 0; k < p->panel_count; ++k) {
        for (size_t i = 0; i < p->panels[k].count; ++i) {
            const size_t length = strlen(p->panels[k].names[i]);
            width = length > width ? length : width;
        }
    }
    for (size_t k = 0; k < p->file_count && p->file_count > 1; ++k) {
        const size_t length = strlen(path_get_name(p->files[k]));
        file = length > file ? length : file;
    }
    return width + file;
}

/* What comes before every frame: margins that all share. */
static void put_margins(const plot *p, FILE *file)
{
    int digits = 4;
    double range[2] = {HUGE_VAL, -HUGE_VAL};
    for (size_t k = 0; k < p->panel_count; ++k) {
        const int needed = count_digits(p->panels[k].range);
        digits = needed > digits ? needed : digits;
    }
    for (size_t k = 0; k < p->file_count; ++k) {
        widen(&p->tables[k], table_find(&p->tables[k], p->x), range);
    }
    put_range(file, "x", range);
    fprintf(file, "    set lmargin %d\n    set rmargin %zu\n%s", digits + 7, key_width(p) + 6,
            p->fft ? "    set logscale x\n" : "");
}

int plot_write_script(plot *p, const char *path)
{
    const size_t columns = p->panel_count > 3 ? 2 : 1;
    const size_t rows = (p->panel_count + columns - 1) / columns;
    const size_t key = 8 * (key_width(p) + 6);
    const int width = (int)(columns * ((columns == 2 ? 480 : 600) + (key < 1000 ? key : 1000)));
    const int height = (int)(rows == 1 ? 440 : 270 * rows);
    char partial[4300];
    snprintf(partial, sizeof partial, "%s.partial", path);
    for (size_t k = 0; k < p->panel_count; ++k) {
        find_range(p, &p->panels[k]);
    }
    errno = 0;
    FILE *file = fopen(partial, "w");
    if (!file) {
        return 0;
    }
    fputs("# Written by `se3d plot`; change it and run, in this folder:\n", file);
    fprintf(file, "#     gnuplot '%s'\n", path_get_name(path));
    fputs("if (!exists('partial')) partial = ''\n", file);
    put_text(file, "base = ", path_get_name(p->base), "\n");
    fputs("set datafile separator ','\n"
          "set encoding utf8\n"
          "set grid lc rgb '#d8d8d8' lt 1\n"
          "set key noenhanced outside right top vertical samplen 1.5 spacing 1.1\n"
          "set border lc rgb '#404040'\n"
          "set xlabel noenhanced\nset ylabel noenhanced\n"
          "set tics nomirror out\n"
          "set offsets 0, 0, graph 0.05, graph 0.05\n"
          "do for [picture in 'svg png'] {\n",
          file);
    fprintf(file,
            "    if (picture eq 'svg') {\n"
            "        set terminal svg size %d,%d dynamic font 'sans-serif,13' "
            "background rgb 'white'\n"
            "    } else {\n"
            "        set terminal pngcairo size %d,%d font 'sans,11' background rgb 'white'\n"
            "    }\n"
            "    set output base.'.'.picture.partial\n"
            "    set multiplot layout %zu,%zu columnsfirst\n",
            width, height, width, height, rows, columns);
    put_margins(p, file);
    for (size_t k = 0; k < p->panel_count; ++k) {
        const int last = k + 1 == p->panel_count || (k + 1) % rows == 0;
        put_panel(p, file, &p->panels[k], last);
    }
    fputs("    unset multiplot\n    unset output\n}\n", file);
    const int bad = ferror(file);
    if (fclose(file) != 0 || bad || rename(partial, path) != 0) {
        remove(partial);
        return 0;
    }
    return 1;
}
