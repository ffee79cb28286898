/* SPDX-License-Identifier: BSD-3-Clause */
/* Which curves go into which frame, and the gnuplot script that draws them. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "file.h"
#include "outcome.h"
#include "plot.h"
#include "process.h"
#include "text.h"

enum { POINTS_MAX = 4000, ROWS_MAX = POINTS_MAX + 1 }; /* every so many rows, and the last */

/* Without -y: these, as far as the file has them. */
static const char *const usual[] = {"position",     "velocity", "acceleration",     "angle",
                                    "displacement", "force",    "torque",           "effort",
                                    "length",       "energy",   "angular_velocity", "gain",
                                    "phase",        NULL};

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

/* `asked`: the user has named it in full. */
static void add_curve(plot *p, const char *name, int asked)
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
        panel->asked[panel->count] = asked;
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
                add_curve(p, t->names[k], strcmp(t->names[k], p->channels[c]) == 0);
                found = 1;
            }
        }
        if (!found) {
            complain("se3d plot: %s has no channel `%s`, it has:", t->path, p->channels[c]);
            for (size_t k = 0; k < t->count; ++k) {
                complain("%s %s", k > 0 ? "," : "", t->names[k]);
            }
            complain("\n");
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
                add_curve(p, t->names[k], 0);
            }
        }
    }
    for (size_t k = 1; k < t->count && p->panel_count == 0; ++k) {
        add_curve(p, t->names[k], 0);
    }
}

/* Read one column of file k; texts that are no numbers and columns that it lacks are NaN. */
static void load_column(const plot *p, size_t k, const char *name, double *values)
{
    const table *t = &p->tables[k];
    const size_t stride = (t->rows + POINTS_MAX - 1) / POINTS_MAX;
    const size_t column = table_find(t, name);
    const size_t count =
        column < t->count ? table_read_column(t, column, stride, values, ROWS_MAX) : 0;
    for (size_t row = count; row < ROWS_MAX; ++row) {
        values[row] = (double)NAN;
    }
}

/* The largest absolute value of a column, of all files. */
static double find_largest(const plot *p, const char *name, double *values)
{
    double most = 0.0;
    for (size_t k = 0; k < p->file_count; ++k) {
        load_column(p, k, name, values);
        for (size_t row = 0; row < ROWS_MAX; ++row) {
            most = isfinite(values[row]) ? fmax(most, fabs(values[row])) : most;
        }
    }
    return most;
}

/* Leave out what is rounding: curves that stay below 1e-9 of the largest of their frame, unless the
 * user named them in full. A frame of which nothing else is left stays as it is. */
static void drop_of(const plot *p, plot_panel *panel, double *values, size_t *dropped)
{
    double most[PLOT_CURVES_MAX];
    double largest = 0.0;
    size_t kept = 0;
    for (size_t k = 0; k < panel->count; ++k) {
        most[k] = find_largest(p, panel->names[k], values);
        largest = fmax(largest, most[k]);
    }
    for (size_t k = 0; k < panel->count; ++k) {
        if (largest > 0.0 && most[k] <= 1e-9 * largest && !panel->asked[k]) {
            if (!p->quiet) {
                printf("%s%s", *dropped > 0 ? ", " : "left out, zero: ", panel->names[k]);
            }
            ++*dropped;
        } else {
            panel->asked[kept] = panel->asked[k];
            panel->names[kept++] = panel->names[k];
        }
    }
    panel->count = kept;
}

static int drop_zeros(plot *p)
{
    size_t dropped = 0;
    double *values = malloc(ROWS_MAX * sizeof *values);
    if (!values) {
        complain("se3d plot: out of memory\n");
        return 0;
    }
    for (size_t k = 0; k < p->panel_count; ++k) {
        drop_of(p, &p->panels[k], values, &dropped);
    }
    if (dropped > 0 && !p->quiet) {
        putchar('\n');
    }
    free(values);
    return 1;
}

int plot_choose(plot *p)
{
    const table *t = &p->tables[0];
    p->x = p->x ? p->x : t->names[0];
    if (table_find(t, p->x) == t->count) {
        complain("se3d plot: %s has no column `%s` for -x\n", t->path, p->x);
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
        complain("se3d plot: %s has no column but `%s`\n", t->path, t->names[0]);
        return 0;
    }
    if (!drop_zeros(p)) {
        return 0;
    }
    for (size_t k = 0; k < p->panel_count && !p->quiet; ++k) {
        if (p->panels[k].dropped > 0) {
            complain("se3d plot: %s: there is no room for %zu more curves, choose with -y\n",
                     p->panels[k].title, p->panels[k].dropped);
        }
    }
    return 1;
}

static void put_text(FILE *file, const char *before, const char *text, const char *after)
{
    fputs(before, file);
    text_put_gnuplot(file, text);
    fputs(after, file);
}

/* A text that is drawn. gnuplot leaves "]]>" as it is in SVG, where it has a meaning. */
static void put_title(FILE *file, const char *before, const char *text, const char *after)
{
    char title[640];
    snprintf(title, sizeof title, "%s", text);
    for (char *at = strstr(title, "]]>"); at; at = strstr(at, "]]>")) {
        at[2] = ' ';
    }
    put_text(file, before, title, after);
}

/* The columns that are drawn of file k: x, then the curves of all panels. */
static size_t count_columns(const plot *p)
{
    size_t count = 1;
    for (size_t k = 0; k < p->panel_count; ++k) {
        count += p->panels[k].count;
    }
    return count;
}

/* The numbers that are drawn of file k: values[column * ROWS_MAX + row]. @return NULL: no memory */
static double *load(const plot *p, size_t k)
{
    double *values = malloc(count_columns(p) * ROWS_MAX * sizeof *values);
    double *to = values;
    if (!values) {
        return NULL;
    }
    load_column(p, k, p->x, to);
    for (size_t panel = 0; panel < p->panel_count; ++panel) {
        for (size_t curve = 0; curve < p->panels[panel].count; ++curve) {
            to += ROWS_MAX;
            load_column(p, k, p->panels[panel].names[curve], to);
        }
    }
    return values;
}

static size_t count_points(const table *t)
{
    const size_t stride = (t->rows + POINTS_MAX - 1) / POINTS_MAX;
    const size_t count = t->rows > 0 ? (t->rows - 1) / stride + 1 : 0;
    return count + (t->rows > 0 && (t->rows - 1) % stride != 0);
}

static void widen(const double *values, double range[2])
{
    for (size_t row = 0; row < ROWS_MAX; ++row) {
        if (isfinite(values[row])) {
            range[0] = fmin(range[0], values[row]);
            range[1] = fmax(range[1], values[row]);
        }
    }
}

/* The ranges of x and of every panel. */
static void find_ranges(plot *p, const double *values)
{
    const double *at = values + ROWS_MAX;
    widen(values, p->x_range);
    for (size_t panel = 0; panel < p->panel_count; ++panel) {
        for (size_t curve = 0; curve < p->panels[panel].count; ++curve, at += ROWS_MAX) {
            widen(at, p->panels[panel].range);
        }
    }
}

static void put_number(FILE *file, double value, char after)
{
    if (isfinite(value)) {
        fprintf(file, "%.15g%c", value, after);
    } else {
        fprintf(file, "NaN%c", after);
    }
}

/* The numbers of file k as the block $file<k + 1> of the script: no name of a file is an address.
 */
static int put_data(plot *p, FILE *file, size_t k)
{
    const size_t columns = count_columns(p);
    const size_t points = count_points(&p->tables[k]);
    double *values = load(p, k);
    if (!values) {
        return 0;
    }
    find_ranges(p, values);
    put_text(file, "# Of ", path_get_name(p->tables[k].path), "\n");
    fprintf(file, "$file%zu << END_OF_DATA\n", k + 1);
    for (size_t row = 0; row < points; ++row) {
        for (size_t c = 0; c < columns; ++c) {
            put_number(file, values[c * ROWS_MAX + row], c + 1 < columns ? ' ' : '\n');
        }
    }
    fputs("END_OF_DATA\n", file);
    free(values);
    return 1;
}

/* What a channel is of: "bar" of bar.position.x, "bar.tip" of bar.tip.velocity. */
static size_t get_owner(const char *name)
{
    char quantity[400];
    const size_t whole = strlen(name);
    table_get_quantity(name, quantity, sizeof quantity);
    const size_t length = strlen(quantity);
    for (size_t k = whole > length ? whole - length : 0; k > 0; --k) {
        if (name[k - 1] == '.' && strncmp(name + k, quantity, length) == 0) {
            return k - 1;
        }
    }
    return 0;
}

/* Whether all curves of a frame are of one body, joint or force. */
static int has_one_owner(const plot_panel *panel)
{
    const size_t length = get_owner(panel->names[0]);
    for (size_t k = 1; k < panel->count; ++k) {
        if (get_owner(panel->names[k]) != length ||
            strncmp(panel->names[0], panel->names[k], length) != 0) {
            return 0;
        }
    }
    return length > 0;
}

/* A name without what the title of the axis says: its owner and its component. */
static void shorten(const plot_panel *panel, const char *name, char *text, size_t size)
{
    char quantity[400];
    const size_t owner = get_owner(name);
    table_get_quantity(name, quantity, sizeof quantity);
    const char *part = name + owner + (owner > 0) + strlen(quantity);
    part += *part == '.';
    if (has_one_owner(panel)) {
        snprintf(text, size, "%.200s", *part ? part : quantity);
    } else if (owner > 0) {
        snprintf(text, size, *part ? "%.*s %.90s" : "%.*s%.90s", (int)(owner < 200 ? owner : 200),
                 name, part);
    } else {
        snprintf(text, size, "%.290s", name);
    }
}

/* The title of the axis; with whose it is if all curves are of one. */
static void entitle(const plot_panel *panel, char *text, size_t size)
{
    const size_t owner = panel->count > 0 && has_one_owner(panel) ? get_owner(panel->names[0]) : 0;
    snprintf(text, size, owner > 0 ? "%.*s: %s" : "%.*s%s", (int)(owner < 60 ? owner : 60),
             owner > 0 ? panel->names[0] : "", panel->title);
}

/* Curve number `column` of all. */
static void put_curve(const plot *p, FILE *file, const plot_panel *panel, size_t curve,
                      size_t column, size_t k)
{
    /* Those of the scene (Okabe and Ito), the yellow darker, and black. */
    static const char *const colors[PLOT_CURVES_MAX] = {"#0072b2", "#d55e00", "#009e73",
                                                        "#e69f00", "#cc79a7", "#56b4e9",
                                                        "#b8a800", "#000000", "#777777"};
    const table *t = &p->tables[k];
    const char *name = panel->names[curve];
    char title[600];
    char brief[300];
    if (table_find(t, p->x) == t->count || table_find(t, name) == t->count) {
        return;
    }
    if (p->file_count > 1) {
        char of[240];
        path_cut(path_get_name(p->files[k]), ".csv", of, sizeof of);
        shorten(panel, name, brief, sizeof brief);
        snprintf(title, sizeof title, panel->count > 1 ? "%s%s%.200s" : "%.0s%.0s%.200s", brief,
                 ", ", of);
    } else {
        shorten(panel, name, title, sizeof title);
    }
    fprintf(file, "        $file%zu using 1:%zu with %s lw %s dt %zu lc rgb '%s' title ", k + 1,
            column, t->rows == 1 ? "points pt 7" : "lines", p->paper ? "1" : "1.6", k + 1,
            colors[curve]);
    put_title(file, "", title, ", \\\n");
}

/* Digits that tell the marks of an axis apart. */
static int count_digits(const double range[2])
{
    const double size = fmax(fabs(range[0]), fabs(range[1]));
    const double width = range[1] - range[0];
    const int more = width > 0.0 && isfinite(width) ? (int)ceil(log10(size / width)) : 0;
    return more < 1 ? 4 : more < 11 ? 3 + more : 14;
}

/* How many letters a mark of an axis has. */
static int count_letters(const double range[2])
{
    const double size = fmax(fabs(range[0]), fabs(range[1]));
    const int has_exponent = size > 0.0 && (size < 2e-4 || size >= 1e4);
    return 2 + count_digits(range) + (has_exponent ? 2 : 0);
}

static int is_constant(const double range[2])
{
    return range[1] - range[0] <= 1e-14 * fabs(range[0]);
}

/* Whether what changes is rounding, or an error of the method, beside its size, and nobody asked
 * for just that. */
static int is_nearly_constant(const plot_panel *panel)
{
    const double size = fmax(fabs(panel->range[0]), fabs(panel->range[1]));
    int asked = 0;
    for (size_t k = 0; k < panel->count; ++k) {
        asked = asked || panel->asked[k];
    }
    return !asked && !is_constant(panel->range) && panel->range[1] - panel->range[0] < 1e-5 * size;
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

/* `column`: of its first curve. */
static void put_panel(const plot *p, FILE *file, const plot_panel *panel, size_t column, int last)
{
    char title[300];
    const double middle = 0.5 * (panel->range[0] + panel->range[1]);
    const double still[2] = {middle, middle};
    const int is_still = is_nearly_constant(panel);
    const double *range = is_still ? still : panel->range;
    put_range(file, "y", range);
    fprintf(file, "    set format y '%%.%dg'\n    unset label\n", count_digits(range));
    if (is_still) { /* as it is seen beside its size; how much it changes in words */
        fprintf(file, "    set label 'varies by %.2g' at graph 0.02, graph 0.92 noenhanced\n",
                panel->range[1] - panel->range[0]);
    }
    entitle(panel, title, sizeof title);
    put_title(file, "    set ylabel ", title, "\n");
    fputs(panel->count > 1 || p->file_count > 1 ? "    set key\n" : "    unset key\n", file);
    if (last) {
        put_title(file, "    set xlabel ", p->x_title, "\n");
    } else {
        fputs("    unset xlabel\n", file);
    }
    fputs("    plot \\\n", file);
    for (size_t curve = 0; curve < panel->count; ++curve) {
        for (size_t k = 0; k < p->file_count; ++k) {
            put_curve(p, file, panel, curve, column + curve, k);
        }
    }
    fputs("        NaN notitle\n", file);
}

/* What comes before every frame: margins that all share. */
static void put_margins(const plot *p, FILE *file)
{
    int letters = 6;
    for (size_t k = 0; k < p->panel_count; ++k) {
        const double end = p->panels[k].range[1];
        const double still[2] = {end, end};
        const int needed =
            count_letters(is_nearly_constant(&p->panels[k]) ? still : p->panels[k].range);
        letters = needed > letters ? needed : letters;
    }
    put_range(file, "x", p->x_range);
    fprintf(file, "    set lmargin %d\n    set rmargin 3\n%s", letters + 5,
            p->fft || p->bode ? "    set logscale x\n" : "");
}

/* What comes first: how to use the script, the numbers. @return false: no memory. */
static int put_head(plot *p, FILE *file)
{
    int good = 1;
    p->x_range[0] = HUGE_VAL;
    p->x_range[1] = -HUGE_VAL;
    for (size_t k = 0; k < p->panel_count; ++k) {
        p->panels[k].range[0] = HUGE_VAL;
        p->panels[k].range[1] = -HUGE_VAL;
    }
    fputs(
        "# Written by `se3d plot`. Change what comes after the numbers, and run it by gnuplot: it\n"
        "# makes an SVG, a PNG and a PDF in the folder in which it is run.\n",
        file);
    for (size_t k = 0; k < p->file_count && good; ++k) {
        good = put_data(p, file, k);
    }
    char name[4300];
    snprintf(name, sizeof name, "./%.4200s", path_get_name(p->base)); /* no pipe */
    put_text(file, "if (!exists('base')) base = ", name, "\n");
    return good;
}

/* Size and letters of every picture: of a screen in its points, of paper in millimetres. PNG has 96
 * or 300 points in an inch. */
static void put_terminals(const plot *p, FILE *file, size_t rows, size_t columns)
{
    const double inch = 25.4;
    const double screen_wide = p->width > 0.0 ? p->width / inch * 96.0 : columns == 2 ? 1280 : 760;
    const double mm = p->width > 0.0 ? p->width : 85.0;
    const double wide = p->paper ? mm / inch * 96.0 : screen_wide; /* at 96 points in an inch */
    const double high = p->paper ? (rows == 1 ? 0.68 : 0.46 * (double)rows) * wide
                                 : (rows == 1 ? 440.0 : 270.0 * (double)rows);
    const double fine = p->paper ? 300.0 / 96.0 : 1.0;
    const int letters = p->paper ? 8 : 10; /* as printed, in points of 1/72 inch */
    fprintf(
        file,
        "    if (picture eq 'svg') {\n"
        "        set terminal svg noenhanced size %.0f,%.0f dynamic font 'sans-serif,%d' "
        "background rgb 'white'\n"
        "    } else { if (picture eq 'png') {\n"
        "        set terminal pngcairo noenhanced size %.0f,%.0f font 'sans,%d' fontscale %.4g "
        "linewidth %.4g background rgb 'white'\n"
        "    } else {\n"
        "        set terminal pdfcairo noenhanced size %.4fin,%.4fin font 'sans,%d' fontscale 1 "
        "background rgb 'white'\n"
        "    } }\n",
        wide, high, p->paper ? 11 : 13, wide * fine, high * fine, letters + (p->paper ? 0 : 1),
        fine, fine, wide / 96.0, high / 96.0, letters);
}

static void put_look(const plot *p, FILE *file, size_t rows, size_t columns)
{
    fputs("set encoding utf8\n", file);
    fputs(p->paper ? "unset grid\n" : "set grid lc rgb '#d8d8d8' lt 1\n", file);
    fputs("set key noenhanced outside center top horizontal samplen 1.5 spacing 1.1\n"
          "set border lc rgb '#404040'\n"
          "set xlabel noenhanced\nset ylabel noenhanced\n"
          "set tics nomirror out\n"
          "set offsets 0, 0, graph 0.05, graph 0.05\n"
          "do for [picture in 'svg png pdf'] {\n",
          file);
    put_terminals(p, file, rows, columns);
    fprintf(file,
            "    set output base.'.'.picture\n"
            "    set multiplot layout %zu,%zu columnsfirst\n",
            rows, columns);
}

int plot_write_script(plot *p, const char *path)
{
    const size_t columns = p->panel_count > 3 && !p->paper ? 2 : 1;
    const size_t rows = (p->panel_count + columns - 1) / columns;
    size_t column = 2;
    errno = 0;
    FILE *file = se3di_partial_open(path);
    if (!file) {
        return 0;
    }
    const int good = put_head(p, file);
    put_look(p, file, rows, columns);
    put_margins(p, file);
    for (size_t k = 0; k < p->panel_count; ++k) {
        const int last = k + 1 == p->panel_count || (k + 1) % rows == 0;
        put_panel(p, file, &p->panels[k], column, last);
        column += p->panels[k].count;
    }
    fputs("    unset multiplot\n    unset output\n}\n", file);
    return file_end(file, path, good);
}
