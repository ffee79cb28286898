/* SPDX-License-Identifier: BSD-3-Clause */
/* Texts for the compiler of the core, and what it computes of them. */
#ifndef SE3D_IO_FORMULA_TEXT_H
#define SE3D_IO_FORMULA_TEXT_H

#include "io/document/formula.h"

/* The k-th component as a number. */
se3di_amount se3di_formula_part(const se3di_amount *a, size_t k);
/* a mark b, one of + - * /; computed if both are constants. */
bool se3di_formula_join(se3di_formula *f, const char *mark, const se3di_amount *a,
                        const se3di_amount *b, se3di_amount *out);
/* What the core makes of head, argument, middle, argument, ..., tail, which are `pieces`. `out`
 * keeps its dimension. */
bool se3di_formula_apply(se3di_formula *f, const char *place, const char *const pieces[3],
                         const se3di_amount *arguments, size_t count, se3di_amount *out);
/* The value of a text over symbols; its errors are reported at `place`. */
bool se3di_formula_compile(se3di_formula *f, const char *place, const char *text,
                           const se3d_expression_symbol *symbols, size_t count, se3di_amount *out);

#endif
