/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles: spheres in bulk, their walls, neighbours and contacts.        docs/theory/particles.md
 *
 * Particles are sorted by slab (a slice along the longest axis), size class and cell. A slab's
 * contacts touch particles of this and of the next slab only, so that all even slabs, then all odd
 * slabs, may be worked on at the same time: every particle receives its forces in the same order
 * for any number of threads.
 *
 * Two lists: `list`, per particle the partners nearer than the reaches of the two together; and
 * blocks of active pairs, those nearer than their small reaches, which carry the history of the
 * tangential springs beside the indices, and are what the force kernels read. A reach is how far a
 * particle (a wall) may move before the list or the blocks are made anew: more for fast ones. */
#ifndef SE3DI_PARTICLES_SET_H
#define SE3DI_PARTICLES_SET_H

#include "base/alloc.h"
#include "base/error.h"
#include "base/slots.h"
#include "contact/bodies/law.h"
#include "contact/shape/shape.h"
#include "math/exact.h"
#include "model/model.h"
#include "se3d/cell.h"
#include "se3d/particles.h"

#define SE3DI_PARTICLE_LANES     8  /* pairs of a block */
#define SE3DI_PARTICLE_CLASSES   12 /* size classes: each twice the radius of the one before */
#define SE3DI_PARTICLE_SLABS_MAX 64
#define SE3DI_PERIOD_LEAST       4.04 /* of the largest radius: least length along an axis */
#define SE3DI_ORIGIN_SIZE        5
#define SE3DI_EXACT_PARTS        3 /* of a number in sums without rounding: share.h */

/* One cache line: what nearly every pass reads. */
typedef struct se3di_particle {
    double x[3], radius;
    double v[3], inverse_mass; /* 0: fixed */
} se3di_particle;

typedef struct se3di_spin {
    double w[3]; /* ground frame: the same as the body frame for a sphere */
    uint16_t material;
    uint16_t tag; /* < SE3D_PARTICLES_TAGS */
    uint32_t id;
} se3di_spin;

typedef struct se3di_load {
    double force[4], torque[4]; /* [3]: 0 */
} se3di_load;

/* Pairs i, j (force on i along x_i - x_j); unused lanes are i = j = capacity, a particle that
 * nothing touches. Walls: j[0] is the wall. */
typedef struct se3di_particle_block {
    uint32_t i[SE3DI_PARTICLE_LANES], j[SE3DI_PARTICLE_LANES];
    double xi[3][SE3DI_PARTICLE_LANES]; /* displacement of i relative to j while touching */
} se3di_particle_block;

/* Rolling displacement [0..2] and twist [3], beside a block where a material resists rolling. */
typedef struct se3di_roll {
    double rho[4][SE3DI_PARTICLE_LANES];
} se3di_roll;

/* History on its way from one list to the next. */
typedef struct se3di_carry {
    uint32_t i, j; /* j >= SE3DI_CARRY_WALL: a wall */
    double xi[3];
} se3di_carry; /* of i, in a chain that starts at carry_first[i] */

/* Of an audited set: what the contacts of a particle do to it, by kinds, without the springs along
 * the normal; and its velocities before a kick. */
typedef struct se3di_audit_load {
    double damping[3], slide[3]; /* forces, */
    double turn[3];              /* torques of `slide`, */
    double roll[3], twist[3];    /* of rolling and torsional resistance */
    double v[3], w[3];
} se3di_audit_load;

#define SE3DI_AUDIT_KINDS 4 /* normal damping, sliding, rolling, torsion */

#define SE3DI_CARRY_WALL  0x80000000u
#define SE3DI_LIST_ACTIVE 0x80000000u /* in entries of the list: nearer than `near` */

/* What the set has taken from the model: a material of particles or walls. */
typedef struct se3di_stuff {
    se3di_material material;
    se3di_handle handle; /* null: no longer used */
    int32_t held;        /* particles are made of it: stays, and counts as a user */
    int32_t reserved;
} se3di_stuff;

/* A shape that the particles touch, with its pose. */
typedef struct se3di_wall {
    se3di_shape shape; /* name, vertices, triangles and tree are the model's */
    se3di_handle handle;
    se3di_handle body; /* the handle of shape.body */
    uint32_t material; /* in the set's table */
    int32_t loose;     /* nothing but forces moves the body: it gives way where it is hit */
    int32_t far;       /* the second wall of a funnel: what is beyond its axis */
    int32_t servo;     /* 1 + the servo that moves it on its body; 0: none */
    se3di_shape_pose pose;
    double home[3], home_v[3];   /* servo: where the body has it, its velocity, */
    double slide[3];             /* and the axis of the servo, ground frame */
    double inverse_mass;         /* of a body that gives way; 0: it moves as it is told */
    double turn[9];              /* its inverse inertia, ground frame */
    double old_x[3], old_R[9];   /* pose where the list was built, */
    double near_x[3], near_R[9]; /* and the active blocks */
    double reach, near_reach;    /* how far it may move before they are made anew, */
    double pace;                 /* and how far it is expected to move in a step */
    double force[3], torque[3];  /* on the body, about its centre of mass, last evaluation */
} se3di_wall;

/* The place where a particle touches a mesh. */
typedef struct se3di_mesh_touch {
    double normal[3]; /* mesh frame */
    double xi[3], rho[4];
} se3di_mesh_touch;

#define SE3DI_PARTICLE_FACES 6

/* A particle that may touch a wall before the list is built anew. */
typedef struct se3di_near_wall {
    uint32_t i, wall;                /* SE3DI_LIST_ACTIVE in i: nearer than `near` */
    uint32_t face_begin, face_count; /* in the set's faces: a mesh's triangles within reach */
} se3di_near_wall;

/* A particle near a mesh. */
typedef struct se3di_mesh_pair {
    uint32_t i, wall;
    uint32_t count, next;
    uint32_t face_begin, face_count; /* in the set's faces: triangles that it may touch */
    se3di_mesh_touch touches[SE3DI_PARTICLE_FACES];
} se3di_mesh_pair;

/* Distances and normals (towards the particles, ground frame) of the lanes of a block. */
typedef struct se3di_given {
    double normal[3][SE3DI_PARTICLE_LANES], distance[SE3DI_PARTICLE_LANES];
} se3di_given;

/* The touches of a few pairs with one mesh as they are now, for a kernel. */
typedef struct se3di_mesh_batch {
    _Alignas(64) se3di_particle_block block;
    _Alignas(64) se3di_given given;
    se3di_roll roll;
    double local[SE3DI_PARTICLE_LANES][3]; /* normals, mesh frame */
    uint32_t count, reserved;
} se3di_mesh_batch;

/* A user-defined law has failed for these. */
typedef struct se3di_law_failure {
    int32_t happened;
    int32_t wall; /* j is a wall */
    uint32_t i, j;
} se3di_law_failure;

typedef struct se3di_slab {
    uint32_t begin, end;                 /* particles */
    uint32_t pair_begin, pair_end;       /* blocks */
    uint32_t wall_begin, wall_end;       /* blocks of walls */
    uint32_t near_begin, near_end;       /* candidates of walls */
    size_t moved;                        /* springs that hold something */
    uint32_t mesh_begin, mesh_end;       /* pairs with meshes */
    double overlap;                      /* largest excess over what is allowed */
    double fastest;                      /* squared speed after the last motion, */
    double hasty;                        /* the same over the squared small reach */
    double virial[9];                    /* of its pairs, in a cell that strains: force x branch */
    double power[SE3DI_AUDIT_KINDS + 1]; /* of an audited set: as audit_power */
    uint64_t touching;
    se3di_law_failure failure;
    int32_t begun;  /* in this sweep somebody evaluates its forces, */
    int32_t done;   /* has evaluated them, */
    int32_t moving; /* moves it or has moved it */
    int32_t reserved;
} se3di_slab;

/* Memory with an address that is a multiple of 64. */
typedef struct se3di_aligned {
    void *data;
    void *raw;
    size_t bytes;
} se3di_aligned;

typedef enum se3di_boundary {
    SE3DI_BOUNDARY_OPEN = 0,
    SE3DI_BOUNDARY_PERIODIC = 1,
    SE3DI_BOUNDARY_SINK = 2
} se3di_boundary;

typedef struct se3di_kernels se3di_kernels;

/* A box, and what of it is meant: all, or the largest cylinder or sphere in it. */
typedef struct se3di_region {
    double lower[3], upper[3];
    int32_t kind; /* se3d_fill_region */
    int32_t axis; /* of a cylinder */
} se3di_region;

/* Radii to draw from: uniformly in a range, or from a table. */
typedef struct se3di_radii {
    double smallest, largest;
    const double *radii, *weights; /* [count]; weights NULL: all alike */
    size_t count;                  /* 0: the range */
} se3di_radii;

/* Inserts particles during a run.                                               flow.c */
typedef struct se3di_source {
    se3di_region region;
    se3di_radii radii; /* in `table` */
    double *table;     /* [2 * radii.count]; NULL: none */
    double velocity[3];
    uint32_t material; /* in the set's table */
    uint32_t tag;
    se3di_handle function; /* null: `rate` */
    double rate;           /* [1/s] or [kg/s], of the step under way */
    int32_t per_mass;
    int32_t stopped; /* by the user, or 0 */
    double start, stop, every;
    uint64_t maximum;
    /* what it has done */
    uint64_t seed; /* state of the random numbers */
    double owed;   /* particles or kilograms that are due */
    double next;   /* radius of the next one; 0: not drawn */
    double due;    /* no insertion before */
    uint64_t inserted, deferred;
    double mass;     /* inserted */
    int32_t waiting; /* the next one was put off already */
    uint32_t clump;  /* 1 + template; 0: spheres */
    double turn[4];  /* orientation of clumps; all 0: at random */
    uint64_t turns;  /* seed of that */
} se3di_source;

/* Removes particles whose centre is in it. */
typedef struct se3di_sink {
    se3di_region region;
    double point[3], normal[3]; /* a plane: what is behind it */
    int32_t plane;
    int32_t stopped;
    uint64_t count;
} se3di_sink;

/* What has passed through a plane, net but for the numbers. */
typedef struct se3di_flow_sum {
    uint64_t forward, backward;
    double mass, momentum[3];
} se3di_flow_sum;

typedef struct se3di_flow_rates {
    double count, mass, momentum[3];
} se3di_flow_rates;

/* Counts what passes through a plane, or a disk or rectangle in it.             passage.c */
typedef struct se3di_flow {
    double point[3], normal[3];
    double along[3], across[3], half[2]; /* of a rectangle; half 0: none */
    double radius;                       /* of a disk; 0: none */
    double window;
    int32_t tag; /* -1: all */
    int32_t has_rates;
    /* what it has seen */
    double begun;                 /* time at the beginning of the window, */
    se3di_flow_sum before, total; /* what had passed then, and now */
    se3di_flow_rates rates;       /* of the last whole window */
    /* of a set that is spread, which adds it to `total` when it is whole again: share.h */
    uint64_t forward, backward;
    se3di_exact seen[4]; /* mass, momentum */
} se3di_flow;

/* A sphere of a template: place in the principal axes, from the centre of mass. */
typedef struct se3di_clump_ball {
    double r[3], radius; /* at scale 1 */
    double mobility[6]; /* {xx, yy, zz, xy, yz, xz}: n.M n is what a unit force along n moves it by,
                          * for the mass of the template [1/kg] */
    double most;        /* the largest of these */
} se3di_clump_ball;

/* Moves a shape on its body.                                                     servo.c */
typedef struct se3di_servo {
    se3di_handle shape;
    se3di_handle function;   /* null: `load` */
    double axis[3];          /* frame of the body, unit */
    double load;             /* wanted in the step under way: [N], or with an area [Pa] */
    double area, gain;       /* 0: none */
    double speed_max, start; /* [s] */
    /* what it has done */
    double place, speed;
    double work; /* up to the last forces but for */
    double half; /* this way times the last one */
} se3di_servo;

/* What clumps are made like: spheres that are held together, at scale 1, of density 1 unless the
 * mass is given.                                                               clump_mass.c */
typedef struct se3di_clump_template {
    uint32_t begin, count; /* of its balls */
    int32_t given;         /* mass and inertia are: no density counts */
    int32_t reserved;
    double volume; /* of the union */
    double mass, inertia[3];
    double centre[3]; /* of mass, in the frame of the definition */
    double axes[4];   /* principal axes -> frame of the definition */
    double bound;     /* radius about the centre of mass that holds all */
    double smallest;  /* radius of a ball, */
    double most;      /* mobility of one */
} se3di_clump_template;

/* A rigid body whose spheres are particles of the set. The kernels take it in rows of four. */
typedef struct se3di_clump {
    double x[3], scale;  /* centre of mass; of lengths, */
    double v[3], factor; /* and of masses, over those of the template */
    double q[4], A[9];   /* principal axes -> ground, the same as a matrix */
    double spin[3];      /* angular momentum, in the principal axes */
    uint32_t first;      /* id of its first sphere; the others follow */
    uint32_t template_index;
} se3di_clump;

/* A linear map of a cell: axes are stretched, and `flow` is sheared by `gradient`. */
typedef struct se3di_domain_map {
    double along[3], shear;
} se3di_domain_map;

typedef struct se3di_domain_stage {
    double start;
    se3di_domain_map rates; /* without the axes of servo and volume */
    int32_t servo[3], shear_servo;
    int32_t volume[3], reserved;
    double stress[3], most[3], gain[3];
    double shear_stress, shear_most, shear_gain;
} se3di_domain_stage;

/* How the domain strains.                                                        cell.c */
typedef struct se3di_domain {
    size_t count; /* of the stages; 0: it stays as it is */
    se3di_domain_stage stages[SE3D_CELL_STAGES];
    int32_t flow, gradient;     /* axes of shear */
    double centre[3], first[3]; /* of the domain; its first lengths */
    /* what it has done */
    uint64_t stage;         /* under way; SE3D_CELL_STAGES: none yet */
    double offset;          /* along `flow`, of the image beyond the upper side along `gradient` */
    double shear;           /* strain */
    se3di_domain_map rates; /* of the step under way */
    se3di_domain_map
        field; /* mean velocities are this map of x - centre: `rates`, but in the second
                           * half of a step those of its middle, at places of its end */
    se3di_domain_map since; /* the map from the places where the list was built */
    double strained;        /* the sum of the largest strains of the steps since then */
    double virial[9];       /* of the last forces, */
    double touching;        /* how many contacts there were, */
    double kinetic[6];      /* and the sum m u u of the last step: xx, yy, zz, xy, yz, xz */
    double work;
} se3di_domain;

/* What holds a bond: a sphere, or a point of a wall.                              bond.c */
typedef struct se3di_bond_end {
    uint32_t id;           /* of the particle; SE3DI_NO_INDEX: a wall, */
    uint32_t wall;         /* which is this one of the set, */
    se3di_handle shape;    /* of this handle, */
    double point[3];       /* in its frame */
    double q[4];           /* turn of a free sphere since it got its first bond */
    uint32_t begin, count; /* of what its bonds do to it, in bond_places */
    uint32_t number;       /* in the whole of a set that is spread: share.h */
    uint32_t reserved;
} se3di_bond_end;

/* Bonds that were made together, and what became of them. */
typedef struct se3di_bond_group {
    int32_t touches;        /* what is bonded touches, too */
    int32_t middle;         /* stresses are those of the middle, not of the worse end */
    double tension, shear;  /* strengths [Pa]; 0: it does not break */
    int32_t springs;        /* stresses are shares of the limits, which may be infinite */
    int32_t smooth;         /* what it does is less by the fourth power of the share */
    double limits[4];       /* [N], [N], [N m], [N m] */
    double damping;         /* part of the critical one of each spring, */
    double dampers[4];      /* and what is beside it [N s/m], [N m s] */
    uint64_t made;          /* so far, */
    uint64_t torn, sheared; /* of those broken by tension, by shear, */
    uint64_t lost;          /* and gone with a particle or shape */
    double dissipated;      /* by those that are gone [J]; those that are there have their own */
    double released;        /* stored in bonds when they went [J] */
} se3di_bond_group;

typedef enum se3di_bond_fate {
    SE3DI_BOND_HOLDS = 0,
    SE3DI_BOND_TORN = 1,
    SE3DI_BOND_SHEARED = 2,
    SE3DI_BOND_LOST = 3
} se3di_bond_fate;

/* A beam from the centre of one sphere to that of another one, or to a wall. Forces and torques are
 * on the second end; the first gets the opposite force. */
typedef struct se3di_bond {
    uint32_t end[2]; /* of the set's bond_ends */
    uint32_t group;
    int32_t fate;    /* se3di_bond_fate; those that do not hold go after the step */
    uint32_t number; /* in the whole of a set that is spread: share.h */
    uint32_t reserved;
    double span;         /* its length at the last forces */
    double length;       /* without load */
    double radius;       /* of its section */
    double stiffness[4]; /* normal, shear [N/m], bending, twisting [N m] */
    double damping[4];   /* the same [N s/m], [N m s] */
    double axis[2][3];   /* along the bond without load, fixed in the ends */
    double turn[4];      /* without load, of the first end as the second sees it */
    double place[3];     /* of the second end, beside the first */
    /* of the last forces */
    double force[3], torque[2][3]; /* all of them, */
    double drag[3], brake[2][3];   /* and what of them is damping */
    double stress[2];              /* tension, shear [Pa], or shares of limits */
    double energy, dissipated;
} se3di_bond;

typedef struct se3di_particles_kept se3di_particles_kept;

typedef struct se3di_particles {
    struct se3di_particles *next; /* of the model's sets */
    char *name;                   /* NULL: none; a clone has none */
    se3d_allocator allocator;
    se3di_contact_law law;
    int32_t threads;
    int32_t team; /* threads that evaluated the last forces */
    int32_t boundary[3];
    int32_t rolling;     /* any material resists */
    int32_t cohesive;    /* any pair attracts */
    int32_t rated;       /* any pair has a damping rate */
    int32_t list_valid;  /* the lists belong to the particles */
    int32_t force_valid; /* the forces belong to the state */
    double lower[3], upper[3];
    double skin_ratio;    /* of the mean diameter */
    double overlap_limit; /* of the smaller radius */
    double step;          /* 0: automatic */
    double time;
    double gravity[3];

    uint64_t topology_version; /* of the model whose materials and shapes these are; 0: none */
    uint64_t contact_version;  /* of them and of the law */
    uint32_t group, mask;
    se3di_stuff *stuffs;
    size_t stuff_count, stuff_capacity;
    se3di_pair *pairs; /* [stuffs * stuffs] */
    size_t pair_capacity;
    se3di_wall *walls;
    size_t wall_count, wall_capacity;

    size_t count, capacity; /* capacity + 1 records: the last is the unused lane's partner */
    se3di_aligned particle_memory, spin_memory, load_memory;
    se3di_particle *particles;
    se3di_spin *spins;
    se3di_load *loads;  /* hold nothing while list_valid is 0 */
    double *origin;     /* [SE3DI_ORIGIN_SIZE * capacity] positions where the list was built, then
                         * se3di_particles_reach(), se3di_particles_wear() */
    uint32_t *index_of; /* id -> index, SE3DI_NO_INDEX: gone */
    size_t id_count, index_capacity;
    se3di_clump_template *templates;
    size_t template_count, template_capacity;
    se3di_clump_ball *balls; /* of the templates */
    size_t ball_count, ball_capacity;
    se3di_clump *clumps;
    size_t clump_count, clump_capacity;
    uint32_t *clump_of; /* id -> clump, SE3DI_NO_INDEX: a free sphere; NULL without templates */
    size_t clump_of_capacity;
    uint32_t *order; /* [capacity] scratch of sorting */
    uint32_t *key;   /* [capacity] */

    /* grid and lists */
    double skin;            /* reach of two slow particles together, and the most of one */
    double stretch;         /* largest reach of one */
    double low[3], high[3]; /* the box of all centres where the list was built */
    uint32_t *cells;        /* first particle of each cell, over all slabs and classes */
    size_t cell_capacity;
    uint32_t *first; /* [count + 1] into list */
    size_t first_capacity;
    uint32_t *list;
    size_t list_count, list_capacity;
    se3di_slab slabs[SE3DI_PARTICLE_SLABS_MAX];
    uint32_t slab_count;
    se3di_aligned block_memory, roll_memory;
    se3di_particle_block *blocks;
    se3di_roll *rolls;
    uint32_t block_count;
    se3di_near_wall *near_walls; /* by slab and wall */
    size_t near_count, near_capacity;
    uint32_t *faces; /* triangles of meshes, see se3di_near_wall */
    size_t face_count, face_capacity;
    se3di_carry *carry; /* in the memory of the loads, while list_valid is 0 */
    double *carry_roll; /* [4 * carry] if rolling */
    uint32_t *carry_next;
    size_t carry_count, carry_roll_capacity, carry_next_capacity;
    int32_t carry_rolling;       /* carry_roll has been filled */
    int32_t uniform;             /* all particles are of one material and radius, none is fixed */
    int32_t fixed;               /* some may be */
    uint32_t single;             /* 1 + that of all particles; 0: several, or it is not known */
    se3di_mesh_pair *mesh_pairs; /* active, by slab */
    size_t mesh_count, mesh_capacity;
    se3di_mesh_pair *mesh_old; /* their history while list_valid is 0 */
    size_t mesh_old_count, mesh_old_capacity;
    double *wall_sums; /* [slabs * walls * 6] */
    size_t wall_sum_capacity;

    /* motion since the lists were built */
    double pace;         /* largest distance of the last drift, */
    double drift;        /* how long it was [s] */
    double worn;         /* part of its small reach that a particle may have moved since the active
                          * blocks were made */
    uint64_t steps_near; /* steps when they were made */

    /* what is told */
    int32_t audits; /* it is told where the energy goes */
    int32_t audits_reserved;
    se3di_audit_load *audit; /* [capacity + 1] */
    size_t audit_capacity;
    double audit_work[SE3DI_AUDIT_KINDS];      /* taken by contacts so far, */
    double wall_work;                          /* given by walls [J] */
    double audit_power[SE3DI_AUDIT_KINDS + 1]; /* of the last forces on particles with the velocity
                                                * of walls or images; [4]: of all [W] */
    /* since the set was spread (share.h): taken, and given by fixed particles */
    se3di_exact audit_seen[SE3DI_AUDIT_KINDS + 1];
    uint64_t steps, rebuilds, refreshes, lost;
    uint64_t lost_of[SE3D_PARTICLES_TAGS];
    double home_low[3], home_high[3]; /* the box of all places where particles were added */
    se3di_source *sources;
    size_t source_count, source_capacity;
    se3di_sink *sinks;
    size_t sink_count, sink_capacity;
    se3di_flow *flows;
    size_t flow_count, flow_capacity;
    se3di_servo *servos;
    size_t servo_count, servo_capacity;
    se3di_domain cell;
    se3di_bond *bonds; /* that hold, in the order in which they were made */
    size_t bond_count, bond_capacity;
    se3di_bond_end *bond_ends;
    size_t bond_end_count, bond_end_capacity;
    se3di_bond_group *bond_groups;
    size_t bond_group_count, bond_group_capacity;
    uint32_t *bond_places; /* by end: twice the bond, and 1 for its second end */
    size_t bond_place_capacity;
    uint32_t *bond_end_of; /* id -> end, SE3DI_NO_INDEX: none; ids beyond it have none */
    size_t bond_end_of_capacity;
    int32_t bonds_changed; /* pairs that may touch are others than in the list */
    int32_t bonds_reserved;
    size_t bonds_gone; /* since the set was spread: share.h */
    uint64_t touching;
    int32_t starved;       /* memory was missing in the last evaluation of the forces */
    int32_t failed_placed; /* the overlap was there before any step was made */
    uint32_t failed;       /* id of the particle that a failure names, */
    uint32_t failed_with;  /* of the one that it overlaps with, or */
    uint32_t failed_wall;  /* the wall; SE3DI_NO_INDEX: none */
    double failed_amount;  /* its overlap over the smaller radius, */
    double failed_time;    /* then */
    const se3di_kernels *kernels;
    se3d_contact_callback callback; /* SE3DI_LAW_CALLBACK */
    void *ctx;
    se3di_law_failure law_failure;
    se3di_particles_kept *kept; /* of the step under way; NULL: none was needed yet */
    struct se3di_share *share;  /* over processes; NULL: none */
} se3di_particles;

/* The images of a cell that strains: one period along `gradient` is `column`. */
typedef struct se3di_strain {
    double across[3];    /* inverse length along the gradient, at its place; else 0 */
    double column[3];    /* the way to the image across it, */
    double jump[3];      /* the velocity that this one has more, */
    double length_up[3]; /* and those along the other axes */
} se3di_strain;

/* What a force kernel works on. */
typedef struct se3di_force_task {
    const se3di_particle *particles;
    const se3di_spin *spins;
    se3di_load *loads;
    se3di_particle_block *blocks;
    se3di_roll *rolls; /* NULL: no rolling resistance */
    const se3di_pair *pairs;
    const se3di_wall *walls;
    const se3di_given *given;       /* walls: of every block, instead of the shape; NULL: none */
    const se3di_particles *clumped; /* whose clumps some particles are of; NULL: none */
    uint32_t materials;
    uint32_t material;   /* of all particles; SE3DI_NO_INDEX: several, or it is not known */
    uint32_t begin, end; /* blocks */
    int32_t law, periodic, uniform, cohesive, rated, reserved;
    double h;                            /* what the springs advance by */
    double length[3], rate[3];           /* of the period and its inverse; 0: none */
    const se3di_strain *strain;          /* of a cell that strains; NULL: none */
    double virial[9];                    /* out: force x branch of its pairs, added to */
    double limit;                        /* allowed overlap over the smaller radius */
    double overlap;                      /* out: largest excess, starts at the caller's value */
    uint64_t touching;                   /* out: added to */
    double *wall_sums;                   /* walls: [walls * 6], added to */
    double *exact;                       /* the same without rounding; NULL: no; share.h */
    const double *exact_steps;           /* [SE3DI_EXACT_PARTS] */
    se3di_audit_load *audit;             /* of an audited set, added to; NULL: no */
    double power[SE3DI_AUDIT_KINDS + 1]; /* the same, out: added to, */
    se3di_exact *exact_power;            /* or, without rounding, to these; NULL: no */
    int32_t in_turn;                     /* loads are added to i and j pair by pair */
    uint32_t unused;                     /* the index in lanes that nobody uses */
    const se3di_stuff *stuffs;           /* of a user-defined law, as the next three */
    se3d_contact_callback callback;
    void *ctx;
    se3di_law_failure failure; /* out: the first one */
} se3di_force_task;

struct se3di_sift; /* sift.h */

/* `kicks` half kicks (0, 1 or 2) of h/2 from the loads and gravity, then a drift. */
typedef struct se3di_particle_motion {
    int kicks;
    double h;
    double drift; /* 0: none; else the loads become zero */
} se3di_particle_motion;

struct se3di_kernels {
    const char *name;
    void (*pairs)(se3di_force_task *task);
    void (*walls)(se3di_force_task *task);
    /* Which of the first `count` pairs of spheres and triangles of a mesh touch. */
    void (*sift)(const se3di_wall *wall, size_t count, struct se3di_sift *pairs);
    /* Move clumps [begin, end) with their spheres; *fastest, *hasty: the largest squared speed of a
     * sphere, and the same over its squared small reach; larger ones stay. */
    void (*clumps)(se3di_particles *set, size_t begin, size_t end,
                   const se3di_particle_motion *motion, double *fastest, double *hasty);
    /* The same for spheres [begin, end), which are no clump's. */
    void (*spheres)(se3di_particles *set, size_t begin, size_t end,
                    const se3di_particle_motion *motion, double *fastest, double *hasty);
};

/* For a user-defined law. */
const se3di_kernels *se3di_particle_kernels_callback(void);
/* NULL if the machine lacks these instructions. */
const se3di_kernels *se3di_particle_kernels_portable(void); /* never NULL */
const se3di_kernels *se3di_particle_kernels_fma(void);
const se3di_kernels *se3di_particle_kernels_avx2(void);
const se3di_kernels *se3di_particle_kernels_avx512(void);
/* The fastest of the machine's; the portable ones if that is wanted. */
const se3di_kernels *se3di_particle_kernels_choose(int32_t portable);

/* Threads that have something to do. One number for everything: a pool whose size changes is made
 * anew each time. */
static inline int32_t se3di_particles_team(const se3di_particles *set)
{
    const int32_t slabs = (int32_t)set->slab_count;
    return slabs < 1 ? 1 : set->threads < slabs ? set->threads : slabs;
}

/* What evaluates the forces of a set. */
static inline const se3di_kernels *se3di_particles_get_kernels(const se3di_particles *set)
{
    return set->law == SE3DI_LAW_CALLBACK ? se3di_particle_kernels_callback() : set->kernels;
}

/* [count] How far each particle may move before the list is built anew. */
static inline double *se3di_particles_reach(const se3di_particles *set)
{
    return set->origin ? set->origin + 3 * set->capacity : NULL;
}

/* [count] The inverse square of the same for the active blocks; while they are being made, the
 * distance itself. */
static inline double *se3di_particles_wear(const se3di_particles *set)
{
    return set->origin ? set->origin + 4 * set->capacity : NULL;
}

/* It goes on at its velocities whatever acts on it. */
static inline int se3di_particle_is_fixed(const se3di_particle *particle)
{
    return !(particle->inverse_mass > 0.0);
}

/* Life time and editing: all-or-nothing; NO_MEMORY is the only failure. */
void se3di_particles_init(se3di_particles *set, const se3d_allocator *allocator);
void se3di_particles_destroy(se3di_particles *set);
/* Deep copy into the uninitialised `copy`; on failure nothing is held. */
se3d_status se3di_particles_clone(const se3di_particles *set, se3di_particles *copy);
/* Take over what `other` holds; name and place in the model stay. */
void se3di_particles_replace(se3di_particles *set, const se3di_particles *other);
se3d_status se3di_particles_reserve(se3di_particles *set, size_t count);
/* Append; room must have been reserved. Returns the id. */
uint32_t se3di_particles_append(se3di_particles *set, uint32_t material, double radius,
                                const double x[3], const double v[3], const double w[3]);
/* The mass of a solid sphere of a material. */
double se3di_particles_weigh(const se3di_particles *set, uint32_t material, double radius);
/* The mass of a sphere, also of a fixed one; of a clump's, what it counts with in contacts. */
double se3di_particles_mass(const se3di_particles *set, size_t k);
/* Fix a live particle that is no clump's, or let it go. The history must have been collected. */
void se3di_particles_fix(se3di_particles *set, uint32_t id, int fixed);
/* Remove those with keep[index] 0; the order of the others stays. The history must have been
 * collected. */
void se3di_particles_filter(se3di_particles *set, const unsigned char *keep);
/* Remove `count` live particles by their ids, and with one of a clump the others. */
se3d_status se3di_particles_remove(se3di_particles *set, size_t count, const uint32_t *ids);
size_t se3di_particles_memory(const se3di_particles *set);

#endif
