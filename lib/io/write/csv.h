/* SPDX-License-Identifier: BSD-3-Clause */
/* One results file: written under a temporary name, buffered, renamed when complete. */
#ifndef SE3D_IO_CSV_H
#define SE3D_IO_CSV_H

#include <stdio.h>

#include "io/base/pack.h"
#include "io/base/pool.h"

typedef struct se3di_csv {
    const char *path;
    FILE *file;
    char *buffer;
    size_t used;
    size_t columns;
    uint64_t rows;
    double *pending; /* the last row, not written yet */
    bool has_pending;
    int failure;      /* errno of the first failure, 0 for none */
    uint64_t written; /* bytes on disk */
    uint64_t whole;   /* of them, bytes of whole lines */
    uint64_t lines;   /* that are whole */
    uint64_t hash;    /* of what is on disk, if it is kept */
    bool keeps_hash;  /* set before the first flush: the file may be marked */
} se3di_csv;

/* How far a file has come: it can be gone on with from there. */
typedef struct se3di_csv_mark {
    uint64_t bytes, lines, rows, hash;
} se3di_csv_mark;

/* Open for `columns` numbers a row. @return OK, IO, NO_MEMORY. */
se3d_status se3di_csv_open(se3di_csv *csv, se3di_iopool *pool, const char *path, size_t columns);
/* Go on with a file that was open before, at a mark: the header is there. @return OK, IO,
 * NO_MEMORY; on failure what is there stays. */
se3d_status se3di_csv_continue(se3di_csv *csv, se3di_iopool *pool, const char *path, size_t columns,
                               const se3di_csv_mark *mark);
/* Write what is there, with `sync` so that it survives a machine that stops, and say how far it is,
 * of a file that keeps its hash.
 * @return false: that failed. */
bool se3di_csv_mark_here(se3di_csv *csv, bool sync, se3di_csv_mark *mark);
/* The last row, which may still be replaced: the same for each file of as many columns. */
void se3di_csv_pack_pending(se3di_csv *csv, se3di_coder *coder);
/* Close for those who continue. */
void se3di_csv_leave(se3di_csv *csv);
/* Write one name of the header; the last one ends the line. */
void se3di_csv_put_name(se3di_csv *csv, const char *name, bool last);
/* Write one row; row[0] is the time. A row at the time of the one before takes its place. */
void se3di_csv_put_row(se3di_csv *csv, const double *row);
/* A number, or a text without commas and quotes. */
typedef struct se3di_csv_cell {
    const char *text; /* NULL: the number */
    double number;
} se3di_csv_cell;

/* Write one row as it is, whatever its time. */
void se3di_csv_put_cells(se3di_csv *csv, const se3di_csv_cell *cells, size_t count);
/* Let others see the rows so far, but for the last one. A failure is reported at the end. */
void se3di_csv_flush(se3di_csv *csv);
/* Complete the file and give it its name. @return OK, or IO: then the rows that are whole on the
 * disk are kept, and `rows` is their number; if there is none nothing is left, and a file of
 * that name stays as it was. */
se3d_status se3di_csv_close(se3di_csv *csv);
/* Close without keeping anything. */
void se3di_csv_abandon(se3di_csv *csv);

#endif
