/* SPDX-License-Identifier: BSD-3-Clause */
/* What shapes of an imported machine touch with. Materials with the same numbers are one; what two
 * of them have together follows a rule of the program that they come from, and is written as
 * `pairs`. */
#ifndef SE3D_IO_IMPORT_MATERIAL_H
#define SE3D_IO_IMPORT_MATERIAL_H

#include "io/import/machine.h"

/* How many materials may be written with all their pairs. */
enum { SE3DI_MATERIALS_MAX = 24 };

/* The rule of two values. */
typedef enum se3di_mixing {
    SE3DI_MIXING_LEAST,
    SE3DI_MIXING_LARGEST,
    SE3DI_MIXING_PRODUCT
} se3di_mixing;

typedef struct se3di_machine_material {
    const char *name;
    double friction, restitution;
    double stiffness;      /* [N/m]; 0: not said */
    double young, poisson; /* [Pa]; young 0: not said */
    struct se3di_machine_material *next;
} se3di_machine_material;

/* The name of a material of these numbers, whose own name is only a wish. NULL: no memory. A
 * restitution below what a model file takes becomes the least; more materials than may be have the
 * last one's. */
const char *se3di_machine_material_name(se3di_machine *m, const se3di_machine_material *wanted,
                                        size_t line);
/* A stiffness [N/m] under which what the machine weighs sinks in by 0.1 mm, a power of ten. */
double se3di_machine_stiffness(const se3di_machine *m);

#endif
