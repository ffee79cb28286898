/* SPDX-License-Identifier: BSD-3-Clause */
/* What `se3d plot` draws, and the gnuplot script for it. */
#ifndef SE3D_TOOL_PLOT_H
#define SE3D_TOOL_PLOT_H

#include "table.h"

enum { PLOT_FILES_MAX = 8, PLOT_CHANNELS_MAX = 64, PLOT_PANELS_MAX = 6, PLOT_CURVES_MAX = 9 };

/* Curves of one unit and quantity, in one frame. */
typedef struct plot_panel {
    char title[160]; /* of the y axis, with its unit */
    const char *names[PLOT_CURVES_MAX];
    int asked[PLOT_CURVES_MAX]; /* named in full: drawn also if it is zero */
    size_t count;
    size_t dropped;  /* curves that had no room */
    double range[2]; /* of all its numbers */
} plot_panel;

typedef struct plot {
    table tables[PLOT_FILES_MAX];
    const char *files[PLOT_FILES_MAX];
    size_t file_count;
    const char *channels[PLOT_CHANNELS_MAX];
    size_t channel_count;
    const char *x;
    const char *output;
    plot_panel panels[PLOT_PANELS_MAX];
    size_t panel_count;
    char x_title[160];
    double x_range[2];
    char base[4096];                    /* of the files written, without extension */
    char spectra[PLOT_FILES_MAX][4200]; /* files of --fft, or of gains and phases */
    char csv[PLOT_FILES_MAX][4096];     /* results of models that were run */
    int paper;                          /* --style paper: for print */
    double width;                       /* of the picture [mm]; 0: as it comes */
    int fft;
    int difference; /* of the second file to the first */
    int bode;       /* gains and phases over frequency */
    int quiet;
    int help;
    int done; /* the model's own plots are drawn */
} plot;

/* Choose the curves of every panel. @return false after a message. */
int plot_choose(plot *p);
/* Replace the tables by their amplitude spectra, in files beside the picture. */
int plot_transform(plot *p);
/* Replace two tables by the second one less the first one, in a file beside the picture. */
int plot_subtract(plot *p);
/* Replace tables of transfer functions by gains and phases, in files beside the picture. */
int plot_make_bode(plot *p);

/* Numbers of the curves that are drawn. */
typedef struct plot_curves {
    const char *first_name; /* of what they are over */
    const double *first;    /* [rows] */
    const double *values;   /* values[curve * stride + row] */
    size_t stride, rows;
    int digits;
} plot_curves;
size_t plot_count_curves(const plot *p);
/* Write them to a file. @return false: errno says why. */
int plot_write_curves(const plot *p, const plot_curves *c, const char *path);
/* Draw the files p->spectra, which are written, of the same curves; `what` of them goes into the
 * titles. @return false after a message. */
int plot_take_files(plot *p, const char *what);

/* Write the script. @return false: errno says why. */
int plot_write_script(plot *p, const char *path);

#endif
