/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles: spheres in bulk with penalty contact and friction (se3d/contact.h).
 *
 * A se3d_particles belongs to one system: it takes its gravity, its allocator, its materials, law
 * and shapes, and records failures there (se3d_system_get_error). Particles have ids, counted from
 * 0 in the order of creation and never used again; arrays are in ascending order of the ids of the
 * particles that are there.
 *
 * Threads: the rule of se3d/se3d.h; what needs a set for itself needs its system, too. */
#ifndef SE3D_PARTICLES_H
#define SE3D_PARTICLES_H

#include "se3d/contact.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The boundary of a domain at `lower` and `upper` along an axis. @since 0.1 */
typedef enum se3d_domain_boundary {
    SE3D_DOMAIN_BOUNDARY_OPEN = 0,
    SE3D_DOMAIN_BOUNDARY_PERIODIC = 1,
    SE3D_DOMAIN_BOUNDARY_SINK = 2 /* particles beyond it are removed and counted as lost */
} se3d_domain_boundary;

/* Particles carry a tag from 0 to this less 1 (default 0), by which they can be told apart: what is
 * a set to the user may be a tag here, so that all sets touch each other. @since 0.1 */
#define SE3D_PARTICLES_TAGS 256

/* The definition of a set of particles. @since 0.1 */
typedef struct se3d_particles_def {
    size_t struct_size;
    int32_t threads;           /* 1: default; results do not depend on it */
    int32_t portable;          /* not 0: kernels without vectors; the same bits, slower */
    int32_t boundary[3];       /* se3d_domain_boundary along x, y, z */
    int32_t audit;             /* not 0: where energy goes is added up, see
                          * se3d_particles_get_dissipation; steps take longer */
    double lower[3], upper[3]; /* of the domain [m]; if an open boundary has none: unbounded */
    double step;               /* [s]; 0: that of the system's contact settings */
    double skin;               /* of the neighbour list, over the mean diameter; default 0.1 */
    uint32_t group, mask;      /* as of se3d_shape_def */
    const char *name;          /* copied; NULL or unique among the sets of the system */
} se3d_particles_def;

/* Fill `def`, of `size` bytes, with the defaults: see se3d_particles_def_default. @since 0.1 */
SE3D_API void se3d_particles_def_init(se3d_particles_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_particles_def se3d_particles_def_default(void)
{
    se3d_particles_def def;
    se3d_particles_def_init(&def, sizeof def);
    return def;
}

/* Create an empty set of particles. Clones, snapshots and hashes of the system include it, the
 * method `verlet` moves it, and se3d_system_destroy destroys it. `def` may be NULL. @return OK,
 * NULL, INVALID_ARGUMENT, NO_MEMORY. @since 0.1 */
SE3D_API se3d_status se3d_particles_create(se3d_system *system, const se3d_particles_def *def,
                                           se3d_particles **out);

/* Destroy a set of particles; NULL is fine. Within a callback of its system nothing is
 * destroyed, and a message (STATE) says so. @since 0.1 */
SE3D_API void se3d_particles_destroy(se3d_particles *particles);

/* Find a set of particles by its name.
 * @param[in] name  UTF-8
 * @return OK, NULL, INVALID_ARGUMENT (no such name).
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_find(const se3d_system *system, const char *name,
                                         se3d_particles **particles);

/* Get the name of a set of particles.
 * @param[out] name  "" if it has none; lives as long as the set
 * @return OK, NULL.
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_get_name(const se3d_particles *particles, const char **name);

/* Count the sets of particles of a system. @return the number; 0 for NULL. @since 0.1 */
SE3D_API size_t se3d_system_count_particles(const se3d_system *system);

/* Get a set of particles of a system, in the order of creation. This is how the sets of a clone are
 * reached.
 * @param[in] index  from 0, below se3d_system_count_particles
 * @return OK, NULL, INVALID_ARGUMENT (index).
 * @since 0.1 */
SE3D_API se3d_status se3d_system_get_particles(const se3d_system *system, size_t index,
                                               se3d_particles **particles);

/* Make an independent copy of a set, beside the sets of the same system: no step of the system
 * moves it. It continues with the same bits as the original, and ids are valid on both. Once the
 * system is destroyed, the copy can only be read and destroyed. Exclusive (the system keeps a
 * list of copies). @return OK, NULL, NO_MEMORY. @since 0.1 */
SE3D_API se3d_status se3d_particles_clone(const se3d_particles *particles, se3d_particles **out);

/* Make a set equal to `saved`, a clone of it. @return OK, NULL, STATE (the clone is of another
 * system), NO_MEMORY (nothing changed). @since 0.1 */
SE3D_API se3d_status se3d_particles_restore(se3d_particles *particles, const se3d_particles *saved);

/* Get what the particles of a set did to a body in the last step: the sum over its shapes.
 * @param[out] force   ground frame [N]
 * @param[out] torque  about the centre of mass, ground frame [N m]
 * @return OK, NULL, STATE (the system is gone), STALE_HANDLE.
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_get_wrench(const se3d_particles *particles, se3d_body body,
                                               double force[3], double torque[3]);

/* Add particles.
 * @param[in] count   their number
 * @param[in] r       [count * 3] centres, ground frame [m]
 * @param[in] radius  [count] [m] > 0
 * @param[in] v       [count * 3] velocities, ground frame [m/s]; NULL: at rest
 * @param[in] w       [count * 3] angular velocities, ground frame [rad/s]; NULL: none
 * @param[out] first  they get the ids *first, *first + 1, ...; NULL: not wanted
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT, NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_add(se3d_particles *particles, se3d_material material,
                                        size_t count, const double *r, const double *radius,
                                        const double *v, const double *w, uint32_t *first);

/* The shape of a region within its box: the whole box, the cylinder along an axis with the box's
 * height, or the sphere about its centre; both have the largest radius that fits. @since 0.1 */
typedef enum se3d_fill_region {
    SE3D_FILL_REGION_BOX = 0,
    SE3D_FILL_REGION_CYLINDER = 1,
    SE3D_FILL_REGION_SPHERE = 2
} se3d_fill_region;

/* A region filled with particles. @since 0.1 */
typedef struct se3d_fill_def {
    size_t struct_size;
    se3d_material material;        /* of the particles */
    size_t count;                  /* lattice: at most; 0: all that fit */
    double lower[3], upper[3];     /* region: no part of a particle is outside; if the two are
                                    * the same along an axis, no centre [m] */
    double radius_min, radius_max; /* uniformly distributed [m] */
    double spacing;                /* lattice [m]; 0: 1.1 times the largest diameter */
    double jitter;                 /* lattice: largest displacement along each axis [m] */
    double velocity[3];            /* [m/s] */
    uint64_t seed;                 /* of the random numbers */
    int32_t region;                /* se3d_fill_region, in the box from lower to upper */
    int32_t axis;                  /* of a cylinder: 0, 1 or 2 */
    const double *radii;           /* [radius_count] radii to draw from instead of the range [m], */
    const double *weights;         /* [radius_count] with frequencies like these; NULL: all alike */
    size_t radius_count;           /* of `radii`; 0: the range */
    uint32_t tag;                  /* of the particles, below SE3D_PARTICLES_TAGS */
    uint32_t clump;                /* 0: spheres; else clumps of template clump - 1 (se3d/clump.h):
                                    * a radius is that of the sphere about the centre of mass that
                                    * holds a clump, all 0: as the template says */
    double orientation[4];         /* of clumps: template -> ground, Euler parameters, unit to 1e-6;
                                    * all 0: at random */
} se3d_fill_def;

/* Fill `def`, of `size` bytes, with the defaults: see se3d_fill_def_default. @since 0.1 */
SE3D_API void se3d_fill_def_init(se3d_fill_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_fill_def se3d_fill_def_default(void)
{
    se3d_fill_def def;
    se3d_fill_def_init(&def, sizeof def);
    return def;
}

/* Fill a region with a cubic lattice, layer by layer along z, from the lower corner.
 * @param[out] added  the number of new particles; NULL: not wanted
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT, NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_fill_lattice(se3d_particles *particles,
                                                 const se3d_fill_def *def, size_t *added);

/* Fill a region at random, without overlaps, also with particles that are there. @return OK,
 * NULL, STALE_HANDLE, INVALID_ARGUMENT, NO_MEMORY, NO_CONVERGENCE (there was no room for all;
 * nothing changed). @since 0.1 */
SE3D_API se3d_status se3d_particles_fill_random(se3d_particles *particles,
                                                const se3d_fill_def *def);

/* A source of particles: where and of what is said by `fill` (copied; lower, upper, region, axis,
 * radius_min, radius_max, radii, weights, velocity, material, seed and tag; count is the largest
 * number, 0: no limit). The rate is a constant or a function of time, negative values count as 0.
 * @since 0.1 */
typedef struct se3d_particles_source_def {
    size_t struct_size;
    const se3d_fill_def *fill; /* required */
    double rate;               /* particles [1/s] or mass [kg/s], >= 0 */
    se3d_function function;    /* null: `rate` */
    double start, stop;        /* [s]; stop 0: never */
    double every;     /* least time between insertions [s]; each rebuilds neighbour lists */
    int32_t per_mass; /* not 0: the rate is [kg/s] */
    int32_t reserved;
} se3d_particles_source_def;

/* Fill `def`, of `size` bytes, with the defaults: see
 * se3d_particles_source_def_default. @since 0.1 */
SE3D_API void se3d_particles_source_def_init(se3d_particles_source_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_particles_source_def se3d_particles_source_def_default(void)
{
    se3d_particles_source_def def;
    se3d_particles_source_def_init(&def, sizeof def);
    return def;
}

/* Add a source. During steps it inserts what is due if it overlaps with nothing; what finds no
 * place waits.
 * @param[out] source  its number, from 0; NULL: not wanted
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT, NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_add_source(se3d_particles *particles,
                                               const se3d_particles_source_def *def,
                                               uint32_t *source);

/* Counters of a source. @since 0.1 */
typedef struct se3d_particles_source_stats {
    uint64_t inserted; /* particles so far */
    uint64_t deferred; /* of all so far, those that had to wait for room */
    double mass;       /* inserted [kg] */
    double waiting;    /* what is owed now: particles, or [kg] */
} se3d_particles_source_stats;

/* As se3d_particles_get_source_stats, told the size of *stats in bytes. @return as
 * se3d_particles_get_source_stats, and INVALID_ARGUMENT (size). @since 0.1 */
SE3D_API se3d_status se3d_particles_get_source_stats_sized(const se3d_particles *particles,
                                                           uint32_t source,
                                                           se3d_particles_source_stats *stats,
                                                           size_t size);

/* Get what a source has done.
 * @param[in] source  its number
 * @return OK, NULL, INVALID_ARGUMENT (no such source).
 * @since 0.1 */
static inline se3d_status se3d_particles_get_source_stats(const se3d_particles *particles,
                                                          uint32_t source,
                                                          se3d_particles_source_stats *stats)
{
    return se3d_particles_get_source_stats_sized(particles, source, stats, sizeof *stats);
}

/* Stop a source for good. The numbers of the others stay.
 * @param[in] source  its number
 * @return OK, NULL, INVALID_ARGUMENT (no such source).
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_remove_source(se3d_particles *particles, uint32_t source);

/* A sink: particles whose centre is in the region, or behind the plane, are removed and counted as
 * lost, at the latest when they have moved by the skin. @since 0.1 */
typedef struct se3d_particles_sink_def {
    size_t struct_size;
    double lower[3], upper[3]; /* [m], without a plane */
    int32_t region;            /* se3d_fill_region */
    int32_t axis;              /* of a cylinder: 0, 1 or 2 */
    double point[3];           /* of the plane [m] */
    double normal[3];          /* direction, of the plane; zero: the region */
} se3d_particles_sink_def;

/* Fill `def`, of `size` bytes, with the defaults: see
 * se3d_particles_sink_def_default. @since 0.1 */
SE3D_API void se3d_particles_sink_def_init(se3d_particles_sink_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_particles_sink_def se3d_particles_sink_def_default(void)
{
    se3d_particles_sink_def def;
    se3d_particles_sink_def_init(&def, sizeof def);
    return def;
}

/* Add a sink.
 * @param[out] sink  its number, from 0; NULL: not wanted
 * @return OK, NULL, INVALID_ARGUMENT, NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_add_sink(se3d_particles *particles,
                                             const se3d_particles_sink_def *def, uint32_t *sink);

/* Get how many particles a sink has removed.
 * @param[in] sink    its number
 * @param[out] count  removed so far
 * @return OK, NULL, INVALID_ARGUMENT (no such sink).
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_get_sink_count(const se3d_particles *particles, uint32_t sink,
                                                   uint64_t *count);

/* Stop a sink for good. The numbers of the others stay.
 * @param[in] sink  its number
 * @return OK, NULL, INVALID_ARGUMENT (no such sink).
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_remove_sink(se3d_particles *particles, uint32_t sink);

/* Give particles a tag; the spheres of a clump have one.
 * @param[in] count  of ids
 * @param[in] ids    [count] of the particles
 * @param[in] tag    below SE3D_PARTICLES_TAGS
 * @return OK, NULL, INVALID_ARGUMENT (an id of no particle, or the tag; nothing changed).
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_set_tags(se3d_particles *particles, size_t count,
                                             const uint32_t *ids, uint32_t tag);

/* Fix particles: they go on with the velocities that they have, whatever acts on them, as those of
 * a rough wall do; or let them go. Fixed ones do not touch each other, are for others like a wall
 * that does not give way, and have no energy. Spheres of clumps cannot be fixed, nor those of a
 * domain that strains.
 * @param[in] count  of ids
 * @param[in] ids    [count] of the particles
 * @param[in] fixed  0: let go
 * @return OK, NULL, INVALID_ARGUMENT (an id of no particle, or of one of a clump), STATE (the
 *         domain strains), NO_MEMORY; nothing changed.
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_set_fixed(se3d_particles *particles, size_t count,
                                              const uint32_t *ids, int32_t fixed);

/* The particles of a tag. @since 0.1 */
typedef struct se3d_particles_tally {
    uint64_t count;   /* that are there */
    uint64_t lost;    /* removed by sinks */
    uint64_t outside; /* of those that are there: beyond the domain; if there is none: below
                         everything, falling without end */
    double mass;      /* of those that are there [kg] */
    double energy;    /* kinetic and potential of those [J] */
    double kinetic;   /* of that the kinetic one, of translation and rotation [J], */
    double rotation;  /* and of this that of rotation [J] */
} se3d_particles_tally;

/* As se3d_particles_get_tally, told the size of *tally in bytes. @return as
 * se3d_particles_get_tally, and INVALID_ARGUMENT (size). @since 0.1 */
SE3D_API se3d_status se3d_particles_get_tally_sized(const se3d_particles *particles, uint32_t tag,
                                                    se3d_particles_tally *tally, size_t size);

/* Get the numbers, mass and energy of the particles of a tag.
 * @param[in] tag  below SE3D_PARTICLES_TAGS
 * @return OK, NULL, INVALID_ARGUMENT (tag), CALLBACK, NOT_FINITE (functions of gravity).
 * @since 0.1 */
static inline se3d_status se3d_particles_get_tally(const se3d_particles *particles, uint32_t tag,
                                                   se3d_particles_tally *tally)
{
    return se3d_particles_get_tally_sized(particles, tag, tally, sizeof *tally);
}

/* Remove particles. With a sphere of a clump its clump goes.
 * @param[in] count  of ids
 * @param[in] ids    [count] of the particles
 * @return OK, NULL, INVALID_ARGUMENT (an id of no particle; nothing changed), NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_remove(se3d_particles *particles, size_t count,
                                           const uint32_t *ids);

/* Count the particles of a set. @return the number; 0 for NULL. @since 0.1 */
SE3D_API size_t se3d_particles_count(const se3d_particles *particles);

/* Get the ids of the particles, in ascending order: the order of all arrays of particles.
 * @param[in] count  must be se3d_particles_count
 * @param[out] ids   [count]
 * @return OK, NULL, INVALID_ARGUMENT (count).
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_get_ids(const se3d_particles *particles, size_t count,
                                            uint32_t *ids);

/* Get the tags of the particles.
 * @param[in] count  must be se3d_particles_count
 * @param[out] tags  [count]
 * @return OK, NULL, INVALID_ARGUMENT (count).
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_get_tags(const se3d_particles *particles, size_t count,
                                             uint32_t *tags);

/* Get the materials of the particles.
 * @param[in] count       must be se3d_particles_count
 * @param[out] materials  [count]
 * @return OK, NULL, INVALID_ARGUMENT (count).
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_get_materials(const se3d_particles *particles, size_t count,
                                                  se3d_material *materials);

/* Get the radii of the particles.
 * @param[in] count    must be se3d_particles_count
 * @param[out] radius  [count] [m]
 * @return OK, NULL, INVALID_ARGUMENT (count).
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_get_radii(const se3d_particles *particles, size_t count,
                                              double *radius);

/* Get the states of the particles. NULL arrays are skipped.
 * @param[in] count  must be se3d_particles_count
 * @param[out] r     [count * 3] centres, ground frame [m]
 * @param[out] v     [count * 3] ground frame [m/s]
 * @param[out] w     [count * 3] ground frame [rad/s]
 * @return OK, NULL, INVALID_ARGUMENT (count).
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_get_all(const se3d_particles *particles, size_t count,
                                            double *r, double *v, double *w);

/* Set the states of the particles. Arrays that are NULL leave their quantity alone. Spheres of
 * clumps stay with their clump: se3d_particles_set_clumps.
 * @param[in] count  must be se3d_particles_count
 * @param[in] r      [count * 3] centres, ground frame [m]
 * @param[in] v      [count * 3] ground frame [m/s]
 * @param[in] w      [count * 3] ground frame [rad/s]
 * @return OK, NULL, INVALID_ARGUMENT (count, not finite), NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_set_all(se3d_particles *particles, size_t count,
                                            const double *r, const double *v, const double *w);

/* Get what contacts did to the particles in the last step, without gravity. It is zero from an edit
 * of particles, materials or walls to the next step. NULL arrays are skipped.
 * @param[in] count    must be se3d_particles_count
 * @param[out] force   [count * 3] ground frame [N]
 * @param[out] torque  [count * 3] about the centres, ground frame [N m]
 * @return OK, NULL, INVALID_ARGUMENT (count).
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_get_forces(const se3d_particles *particles, size_t count,
                                               double *force, double *torque);

/* A contact as it is now. @since 0.1 */
typedef struct se3d_particles_contact {
    uint32_t i, j;    /* ids of the particles */
    se3d_shape shape; /* null: with particle j */
    double point[3];  /* ground frame [m] */
    double force[3];  /* on i, ground frame [N] */
    double normal[3]; /* unit vector towards i, ground frame */
    double overlap;   /* [m] > 0 */
} se3d_particles_contact;

/* Count the contacts of the last step. @return the number; 0 for NULL. @since 0.1 */
SE3D_API size_t se3d_particles_count_contacts(const se3d_particles *particles);

/* As se3d_particles_get_contacts, told the size of an element in bytes. @return as
 * se3d_particles_get_contacts, and INVALID_ARGUMENT (size). @since 0.1 */
SE3D_API se3d_status se3d_particles_get_contacts_sized(const se3d_particles *particles,
                                                       size_t count,
                                                       se3d_particles_contact *contacts,
                                                       size_t size);

/* List the contacts of the last step.
 * @param[in] count      must be se3d_particles_count_contacts
 * @param[out] contacts  [count]
 * @return OK, NULL, STATE (the system is gone), INVALID_ARGUMENT (count).
 * @since 0.1 */
static inline se3d_status se3d_particles_get_contacts(const se3d_particles *particles, size_t count,
                                                      se3d_particles_contact *contacts)
{
    return se3d_particles_get_contacts_sized(particles, count, contacts, sizeof *contacts);
}

/* Advance by steps of velocity Verlet; bodies stay where the system has them. A step that ends with
 * an overlap beyond the limit is complete, and the last one; the run may go on from there with a
 * smaller step or a larger limit. A state that is not finite cannot be repaired: restore a clone.
 * @param[in] steps  their number
 * @return OK, NULL, INVALID_ARGUMENT, STEP_SIZE (an overlap beyond the limit or a step beyond
 *         stability: the message names the particle and the time), NOT_FINITE, NO_MEMORY (lists
 *         could not grow: they are made shorter, the step is complete, and the run may go on),
 *         CALLBACK (of a source, gravity or law), UNSUPPORTED.
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_step(se3d_particles *particles, size_t steps);

/* Advance to a time in equal steps, none longer than the step.
 * @param[in] time  not before that of the set [s]
 * @return as se3d_particles_step, and INVALID_ARGUMENT (time), STEP_COUNT.
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_run(se3d_particles *particles, double time);

/* Get the step: the one that was set, or the automatic one.
 * @param[out] step  [s]; 0 if there is nothing to resolve
 * @return OK, NULL, STATE (the system is gone).
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_get_step(const se3d_particles *particles, double *step);

/* Set the step of a set of particles.
 * @param[in] step  [s]; 0: that of the system's contact settings
 * @return OK, NULL, INVALID_ARGUMENT.
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_set_step(se3d_particles *particles, double step);

/* Get the time of a set of particles.
 * @param[out] time  [s]
 * @return OK, NULL.
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_get_time(const se3d_particles *particles, double *time);

/* Energies [J]; potential: of gravity, zero at the ground origin. @since 0.1 */
typedef struct se3d_particles_energy {
    double translation; /* kinetic */
    double rotation;    /* kinetic */
    double potential;   /* of gravity */
} se3d_particles_energy;

/* As se3d_particles_get_energy, told the size of *energy in bytes. @return as
 * se3d_particles_get_energy, and INVALID_ARGUMENT (size). @since 0.1 */
SE3D_API se3d_status se3d_particles_get_energy_sized(const se3d_particles *particles,
                                                     se3d_particles_energy *energy, size_t size);

/* What contacts have turned to heat since the set was made, by kinds [J]: kinetic energy, potential
 * energy of gravity, what contacts and bonds store and all that was dissipated change together by
 * the work of walls. Springs of contacts that end hold what is dissipated then. @since 0.1 */
typedef struct se3d_particles_dissipation {
    double normal;     /* by damping along the normal, */
    double tangential; /* sliding, */
    double rolling;    /* rolling */
    double torsion;    /* and torsional resistance; */
    double bonds;      /* by bonds */
    double elastic;    /* stored in contacts now [J] */
    double wall_work;  /* of walls on particles [J] */
} se3d_particles_dissipation;

/* As se3d_particles_get_dissipation, told the size of *out in bytes. @return as
 * se3d_particles_get_dissipation, and INVALID_ARGUMENT (size). @since 0.1 */
SE3D_API se3d_status se3d_particles_get_dissipation_sized(const se3d_particles *particles,
                                                          se3d_particles_dissipation *out,
                                                          size_t size);

/* Get what a set has dissipated; a law of contact of the user's own is not audited: steps then are
 * UNSUPPORTED.
 * @return OK, NULL, STATE (the set was made without `audit`).
 * @since 0.1 */
static inline se3d_status se3d_particles_get_dissipation(const se3d_particles *particles,
                                                         se3d_particles_dissipation *out)
{
    return se3d_particles_get_dissipation_sized(particles, out, sizeof *out);
}

/* Get the energy of the particles of a set. @return OK, NULL, STATE (the system is gone),
 * CALLBACK, NOT_FINITE (functions of gravity). @since 0.1 */
static inline se3d_status se3d_particles_get_energy(const se3d_particles *particles,
                                                    se3d_particles_energy *energy)
{
    return se3d_particles_get_energy_sized(particles, energy, sizeof *energy);
}

/* Counters of a set of particles. @since 0.1 */
typedef struct se3d_particles_stats {
    uint64_t steps;    /* of verlet so far */
    uint64_t rebuilds; /* of the neighbour list */
    uint64_t contacts; /* at the last step */
    uint64_t lost;     /* particles that left through a sink */
    uint64_t bytes;    /* memory held */
    uint64_t threads;  /* that worked on the last step: 1 if the library knows no OpenMP */
    uint64_t left;     /* lost, and those that are there but outside, as in se3d_particles_tally */
    uint64_t clumps;   /* that are there (se3d/clump.h) */
} se3d_particles_stats;

/* As se3d_particles_get_stats, told the size of *stats in bytes. @return as
 * se3d_particles_get_stats, and INVALID_ARGUMENT (size). @since 0.1 */
SE3D_API se3d_status se3d_particles_get_stats_sized(const se3d_particles *particles,
                                                    se3d_particles_stats *stats, size_t size);

/* Get the counters of a set of particles. @return OK, NULL. @since 0.1 */
static inline se3d_status se3d_particles_get_stats(const se3d_particles *particles,
                                                   se3d_particles_stats *stats)
{
    return se3d_particles_get_stats_sized(particles, stats, sizeof *stats);
}

/* Compute a hash of time, positions and velocities: equal bits, equal hash. @return the hash; 0
 * for NULL. @since 0.1 */
SE3D_API uint64_t se3d_particles_hash(const se3d_particles *particles);

#ifdef __cplusplus
}
#endif
#endif
