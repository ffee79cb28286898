/* SPDX-License-Identifier: BSD-3-Clause */
/* Operations on numbers and vectors with dimensions; the parser is in quantity.c. Each returns
 * false after it has reported why; `place` is where in the text. */
#ifndef SE3D_IO_FORMULA_H
#define SE3D_IO_FORMULA_H

#include "io/document/reader.h"
#include "io/document/scope.h"

enum { SE3DI_FORMULA_ARGUMENTS = 16 };

typedef struct se3di_formula {
    se3di_reader *reader;
    const se3di_node *node;
    const char *text;
    const char *at;
    const char *const *variables; /* NULL at the end; NULL: none */
    int depth;
} se3di_formula;

SE3DI_IO_FORMAT(3, 4)
bool se3di_formula_fail(se3di_formula *f, const char *place, const char *format, ...);

/* The number that the core reads at `text`. */
bool se3di_formula_number(se3di_formula *f, const char *text, size_t length, double *value);
bool se3di_formula_variable(se3di_formula *f, const char *name, se3di_amount *out);
/* The dimension of a variable by its name, and by the coordinate that the reader is at. */
se3di_dimension se3di_formula_variable_dimension(const se3di_reader *reader, const char *name);

/* Give both the same dimension: what has none takes that of the other. */
bool se3di_formula_unify(se3di_formula *f, const char *place, se3di_amount *a, se3di_amount *b);
/* a * times / over */
bool se3di_formula_scale(se3di_formula *f, se3di_amount *a, double times, double over);

/* The result takes the place of `a`. */
bool se3di_formula_negate(se3di_formula *f, se3di_amount *a);
bool se3di_formula_add(se3di_formula *f, const char *mark, se3di_amount *a, se3di_amount *b);
bool se3di_formula_multiply(se3di_formula *f, const char *mark, se3di_amount *a, se3di_amount *b);
bool se3di_formula_power(se3di_formula *f, const char *mark, se3di_amount *a,
                         const se3di_amount *b);
bool se3di_formula_compare(se3di_formula *f, const char *mark, size_t length, se3di_amount *a,
                           se3di_amount *b);

/* Functions, with their arguments. */
bool se3di_formula_is_vector_function(const char *name);
bool se3di_formula_call(se3di_formula *f, const char *place, const char *name,
                        se3di_amount *arguments, size_t count, se3di_amount *out);

#endif
