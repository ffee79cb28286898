/* SPDX-License-Identifier: BSD-3-Clause */
/* What is written, with which channels. */
#ifndef SE3D_IO_OUTPUT_H
#define SE3D_IO_OUTPUT_H

#include "io/channel/channel.h"
#include "io/model/model.h"
#include "se3d/field.h"

typedef struct se3di_output_entry {
    const char *file;
    bool particles;              /* snapshots of them, no channels */
    bool contacts;               /* lists of them, no channels */
    int32_t set;                 /* of whose particles; -1: all */
    bool vtk;                    /* a series for ParaView, no channels */
    bool summary;                /* of the channels over the run, in place of rows, */
    bool average;                /* of `grid`, or else of `wall`, over the run, no channels, */
    double start, stop;          /* between these times [s] */
    const se3d_field_grid *grid; /* of a series or average: fields of the particles; NULL: none */
    se3d_shape wall;             /* the surface whose patches are averaged */
    double every;                /* 0: the analysis's step */
    double compression;          /* 1 ... 9 of what is not CSV; 0: none */
    se3di_channel *channels;
    size_t count;
    const se3di_node *node; /* NULL: the default output */
} se3di_output_entry;

/* What a file that has rows becomes when they are all there, by the ending of its name: HDF5 of .h5
 * or .hdf5; averages VTK of .vtp, .vti, .vtkhdf; else it stays CSV. */
typedef enum se3di_output_format {
    SE3DI_OUTPUT_CSV = 0,
    SE3DI_OUTPUT_HDF5 = 1,
    SE3DI_OUTPUT_VTK = 2
} se3di_output_format;

se3di_output_format se3di_output_get_format(const se3di_output_entry *output);

/* How many rows an output has in an analysis beside the first, *every [s] apart: its own `every`,
 * else the step, else a 500th of the duration. */
double se3di_output_count_rows(const se3di_output_entry *output,
                               const se3di_analysis_entry *analysis, double *every);

#endif
