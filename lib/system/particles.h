/* SPDX-License-Identifier: BSD-3-Clause */
/* What the files of the public layer of particles share. */
#ifndef SE3DI_SYSTEM_PARTICLES_H
#define SE3DI_SYSTEM_PARTICLES_H

#include "particles/sets.h"
#include "system/system_internal.h"

struct se3d_particles {
    se3di_particles set;  /* first: a set of the model is the particles it lies in */
    se3d_system *system;  /* NULL: a clone whose system was destroyed */
    se3d_particles *next; /* a clone: the next one of the system */
    int32_t is_copy;      /* a clone, which no step of the system moves */
    int32_t kept;         /* the owner of the system has it, too */
};

/* The index of a material in the set's table, which it gets and is counted in if it has none. */
se3d_status se3di_particles_use(se3d_particles *particles, se3d_material material, uint32_t *index);

/* Particles of this radius do not meet themselves across a period. */
se3d_status se3di_check_period(se3d_particles *particles, double radius);
se3d_status se3di_check_tag(se3d_particles *particles, uint32_t tag);
/* particles_fill.c: the def, checked, with the range of its radii. */
se3d_status se3di_check_fill(se3d_particles *particles, const se3d_fill_def *def,
                             se3d_fill_def *full, uint32_t *material);
se3d_status se3di_check_region(se3d_particles *particles, const double lower[3],
                               const double upper[3], int32_t region, int32_t axis, double size);
/* particles_bond.c: the set's wall of a shape, where it is now. */
se3d_status se3di_particles_find_wall(se3d_particles *particles, se3d_shape shape, uint32_t *wall);
/* Gravity at the set's time. */
se3d_status se3di_particles_gravity(const se3d_particles *particles, double g[3]);
/* `name` is well formed and free among the sets; NULL always is. */
se3d_status se3di_check_particles_name(se3d_system *system, const char *name);

/* particle_sets.c: take out of the system; what it owns, destroyed or copied for its clone `copy`,
 * which may hold some on failure. */
void se3di_owner_unlink(se3d_particles *particles);
void se3di_owners_destroy(se3di_model *model);
se3d_status se3di_owners_clone(const se3d_system *system, se3d_system *copy);
/* The sets of the system are its owner's, or nobody's any more. */
void se3di_owners_keep(se3d_system *system, int32_t kept);
/* `system` goes: calls of the clones of its sets are refused from now on. */
void se3di_copies_orphan(se3d_system *system);

/* clump.c: a template of this number; room for `count` more spheres (clump 0) or clumps of template
 * clump - 1. */
se3d_status se3di_check_template(se3d_particles *particles, const char *what, uint32_t index);
se3d_status se3di_clumps_make_room(se3d_particles *particles, uint32_t clump, size_t count);

/* particles_parts.c: the walls are the model's shapes as they are: it was not edited since the last
 * step. */
int se3di_particles_are_current(const se3d_particles *particles);

/* Room for `count` more particles. */
se3d_status se3di_particles_make_room(se3d_particles *particles, size_t count);

#endif
