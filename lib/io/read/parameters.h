/* SPDX-License-Identifier: BSD-3-Clause */
/* `parameters` and `points` of a part. */
#ifndef SE3D_IO_PARAMETERS_H
#define SE3D_IO_PARAMETERS_H

#include "io/document/reader.h"

/* What the entry that includes a part gives in place of the part's own values. */
typedef struct se3di_given {
    const se3di_node *node; /* the map of their names; NULL: none */
    se3di_amount *values;   /* in its order */
    size_t count;
    const char *index; /* name of the number that counts the parts; NULL: none */
    se3di_amount i;
} se3di_given;

/* A number, a text, or a list of three numbers. */
bool se3di_read_value(se3di_reader *reader, const se3di_node *node, se3di_amount *value);
/* Make the scope of a part, which the reader stands in; given NULL: of the model itself, with the
 * settings of the options. */
bool se3di_read_parameters(se3di_reader *reader, se3di_component *part, const se3di_given *given);

/* Give a parameter or point of the part where the reader stands, which has its scope, its value
 * anew: that of its entry, or `given`, if it is not NULL. Nothing else follows. */
bool se3di_read_parameter_again(se3di_reader *reader, se3di_scope *scope, const se3di_node *node,
                                bool is_point, const se3di_amount *given);

#endif
