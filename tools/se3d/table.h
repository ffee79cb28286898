/* SPDX-License-Identifier: BSD-3-Clause */
/* A results file: its columns, what they mean, and their numbers on demand. */
#ifndef SE3D_TOOL_TABLE_H
#define SE3D_TOOL_TABLE_H

#include <stddef.h>

typedef struct table {
    const char *path;
    char **names; /* of the columns */
    size_t count; /* of columns */
    size_t rows;
    char *header; /* the memory of the names */
    char *remark; /* a first line that begins with #, or NULL */
    char *scene;  /* the description in scene.glb beside the file, or NULL */
} table;

/* Read the header and count the rows. @return true, or false after a message that begins with
 * "se3d <command>: ". */
int table_read(table *t, const char *command, const char *path);
void table_destroy(table *t);

/* The number of a column, or `count` if there is none of that name. */
size_t table_find(const table *t, const char *name);

/* Read one column, at most `size` numbers, every `stride`-th row and the last. @return how many. */
size_t table_read_column(const table *t, size_t column, size_t stride, double *values, size_t size);
/* Read all columns of every `stride`-th row and the last: values[row * count + column]. @return
 * rows. */
size_t table_read_rows(const table *t, size_t stride, double *values, size_t rows);

/* What a column is: "position", "effort", ...; its last word but the component. */
void table_get_quantity(const char *column, char *quantity, size_t size);
/* The unit of a column: "m/s"; "" if it has none. Some depend on the model: they are looked up
 * in the scene beside the file. */
const char *table_get_unit(const table *t, const char *column, char *buffer, size_t size);

#endif
