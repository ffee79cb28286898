/* SPDX-License-Identifier: BSD-3-Clause */
/* Several states of one tree side by side: the recursions of tree/core.inc with the lanes of a
 * vector register for numbers. Every number is an array of `width` doubles, one for each state, so
 * that q is [positions][width] and so on. A state has the same bits in every lane, at every width
 * and alone.                                                             docs/theory/lanes.md */
#ifndef SE3DI_TREE_LANES_H
#define SE3DI_TREE_LANES_H

#include "tree/tree.h"

#define SE3DI_LANES_MAX   8
#define SE3DI_LANES_ALIGN 64 /* bytes */

typedef struct se3di_lanes se3di_lanes;

/* What acts along a coordinate: -(preload + k (q - rest) + c qdot). */
typedef struct se3di_lane_law {
    uint32_t q, v; /* the coordinate among positions and velocities */
    double k, c, rest, preload;
} se3di_lane_law;

/* A point of a node, from its joint point in its triad; node -1: of the ground, from its origin. */
typedef struct se3di_lane_point {
    int32_t node, reserved;
    double at[3];
} se3di_lane_point;

/* Points that attract each other with preload + k (l - rest) + c ldot, l their distance; not
 * a number if that is zero and the direction matters. */
typedef struct se3di_lane_spring {
    se3di_lane_point i, j;
    double k, c, rest, preload;
} se3di_lane_spring;

/* A force at a point and a torque, with components in the ground frame or in the triad. */
typedef struct se3di_lane_load {
    se3di_lane_point point;
    int32_t in_triad, reserved;
    double force[3], torque[3];
} se3di_lane_load;

/* A node of a tree that moves in planes (lane_plane.inc), in the plane of its root: from the
 * parent's point to its own at the parent's angle zero, and from there to the centre of mass. */
typedef struct se3di_lane_plane {
    double d[2], s[2];
    double turn, sense; /* its angle, less the parent's, is turn + sense q */
    double J, mass;     /* about the joint point */
    double axes[6];     /* of the plane, of a root */
} se3di_lane_plane;

struct se3di_tree_loops;

/* A row of a loop. */
typedef struct se3di_lane_row {
    int32_t loop, kept; /* its direction among the loop's */
    int32_t from, to;   /* velocities between which its numbers stand */
    int32_t first;      /* the first row that shares some of these, or that is beyond one, */
    int32_t entry;      /* and where the row's part of L begins, */
    int32_t value;      /* and that of Y */
    double least;       /* least of a pivot over the row's weight */
} se3di_lane_row;

/* Loops whose rows come from the links alone (tree/loop_points.c), the same for all lanes. */
typedef struct se3di_lane_loops {
    const struct se3di_tree_loops *loops;
    se3di_lane_row *rows;
    int32_t count, reserved;
    size_t entry_count, value_count, path_max;
} se3di_lane_loops;

/* Compiled once for each width. All arrays are aligned to SE3DI_LANES_ALIGN. */
typedef struct se3di_lane_core {
    int32_t width;
    /* Links, S and biases of the states; frames of the bodies if the lanes have any. */
    void (*place)(const se3di_lanes *lanes, const double *q, const double *qdot);
    /* Wrenches of springs and loads are added; what laws say along coordinates, to effort
     * [velocities]. Springs need points. */
    void (*add_springs)(const se3di_lanes *lanes, const se3di_lane_spring *springs, size_t count);
    void (*add_loads)(const se3di_lanes *lanes, const se3di_lane_load *loads, size_t count);
    void (*add_laws)(const se3di_lane_law *laws, size_t count, const double *q, const double *qdot,
                     double *effort);
    /* What acts on the bodies in lanes->loads, with weights, as se3di_tree_take_wrenches. */
    void (*take_wrenches)(const se3di_lanes *lanes);
    /* Articulated inertias; effort [velocities], NULL: none. */
    void (*factor)(const se3di_lanes *lanes, const double *effort);
    /* After it: accelerations [velocities]; not a number if a coordinate has no inertia. */
    void (*accelerate)(const se3di_lanes *lanes, double *qddot);
    /* Efforts [velocities] that give accelerations [velocities] against the wrenches. */
    void (*find_efforts)(const se3di_lanes *lanes, const double *qddot, double *effort);
    /* Rates of the positions. */
    void (*find_rates)(const se3di_lanes *lanes, const double *q, const double *qdot,
                       double *rates);
    /* Quaternions among the positions get unit length. */
    void (*normalise)(const se3di_lanes *lanes, double *q);
    /* out = base + factor x: [count] numbers each; out may be either. */
    void (*add)(size_t count, const double *base, double factor, const double *x, double *out);
    /* out = base + sum of factors[k] x[k], k < used: [count] numbers each; out may be base. */
    void (*sum)(size_t count, const double *base, int used, const double *factors,
                const double *const *x, double *out);
    /* out = base [count doubles] + sum of x[.][k] weights[k], k < terms: x [count][terms] doubles,
     * weights [terms]. */
    void (*combine)(size_t count, const double *base, size_t terms, const double *weights,
                    const double *x, double *out);
    /* The same with the terms in rows, rows[k * row + c] weights[k]; numbers of out are `stride`
     * doubles apart. */
    void (*extend)(size_t count, const double *base, size_t terms, const double *weights,
                   const double *rows, size_t row, double *out, size_t stride);
    /* Rates of positions of which quaternions are not unit ones. */
    void (*find_free_rates)(const se3di_lanes *lanes, const double *q, const double *qdot,
                            double *rates);
    /* The size of a small change of q and qdot [positions + velocities] at the state that was
     * placed: by the largest ways of centres of mass, turns and changes of velocities of all
     * bodies, relative to a length, a speed and a spin. */
    void (*measure)(const se3di_lanes *lanes, const double *q, const double *change,
                    const double scale[3], double *sizes);
    /* The same where q does not change. */
    void (*measure_rates)(const se3di_lanes *lanes, const double *change, const double scale[3],
                          double *sizes);
    /* change = factor (next - x), x = next: [count] numbers each, those of x `stride` doubles
     * apart. */
    void (*replace)(size_t count, double factor, const double *next, size_t stride, double *x,
                    double *change);
    /* With loops, after factor(): their rows and the factors, not numbers where rows are not clear
     * of each other; */
    void (*factor_rows)(const se3di_lanes *lanes);
    /* before accelerate(): what the loops add; */
    void (*close)(const se3di_lanes *lanes);
    /* how far points of loops are apart at the state that was placed, or how fast they part, into
     * lanes->c, and the largest; the least change, weighed by the masses, that closes them. */
    void (*find_gaps)(const se3di_lanes *lanes, int rates, double *largest);
    void (*correct)(const se3di_lanes *lanes, double *dq);
    /* The largest squares, over all bodies, of velocities of centres of mass and angular ones, and
     * of accelerations of both, by the accelerations that were found last; wants points, with
     * gravity. */
    void (*survey)(const se3di_lanes *lanes, double *squares);
    /* Accelerations of a tree that moves in planes, after place(), by gravity and effort
     * [velocities], NULL: none. */
    void (*fall_in_plane)(const se3di_lanes *lanes, const double *effort, double *qddot);
    /* 1.0 if all [count] numbers are finite, else not a number. */
    void (*check)(size_t count, const double *x, double *verdict);
} se3di_lane_core;

/* The core for `width` states (1, 4 or 8), NULL: this processor has none. */
const se3di_lane_core *se3di_lane_core_find(int32_t width);
/* The widest one. */
const se3di_lane_core *se3di_lane_core_widest(void);

const se3di_lane_core *se3di_lane_core_portable(void);
const se3di_lane_core *se3di_lane_core_avx2(void);   /* NULL: not here */
const se3di_lane_core *se3di_lane_core_avx512(void); /* the same */

/* Work of the recursions for one group of states. */
struct se3di_lanes {
    const se3di_tree *tree; /* structure and constants */
    const se3di_lane_core *core;
    double *links, *S, *U, *D, *R, *e, *V, *k; /* as in se3di_tree; */
    double *given, *wrench, *branches, *joint;
    double *frames;         /* [bodies] se3di_frame, NULL: not wanted; */
    double *loads;          /* [bodies * 6] what acts on them, as force/force.h has it */
    const double *inertias; /* [nodes * 7] mass and J of each state's own; NULL: the tree's */
    const double *gravity;  /* [3] of each state, NULL: none but in the wrenches; */
    int32_t acts;           /* wrenches are read: see se3di_lanes_load */
    int32_t wants_points;   /* points of links and their velocities, even without frames */
    double *memory;         /* all of it, as allocated */
    size_t memory_count;
    const se3di_lane_loops *loops; /* NULL: there are none, or nobody closes them */
    double *K, *Y, *L, *pivot, *c, *z;
    const se3di_lane_plane *plane; /* [nodes], NULL: all moves in space; */
    double *planes;                /* memory for them */
};

/* Memory for `core`; with frames and loads of bodies if wanted. @return OK, NO_MEMORY */
se3d_status se3di_lanes_init(se3di_lanes *lanes, const se3di_tree *tree,
                             const se3di_lane_core *core, int wants_frames);
void se3di_lanes_destroy(se3di_lanes *lanes);
/* The same without frames in memory that somebody else has, aligned, of se3di_lanes_room doubles
 * for a tree of so many nodes, velocities and branches. Nothing has to be destroyed. */
void se3di_lanes_lay_out(se3di_lanes *lanes, const se3di_tree *tree, const se3di_lane_core *core,
                         double *memory);
size_t se3di_lanes_room(size_t nodes, size_t velocities, size_t branches, size_t width);

/* Gravity [3] pulls at all links (NULL: it does not), and if something else acts, it is added to
 * wrenches that are zero now. At first there are wrenches and no gravity. */
void se3di_lanes_load(se3di_lanes *lanes, const double *gravity, int acts);

/* Find out how rows stand, of loops that need links only, which stay. @return OK, NO_MEMORY */
se3d_status se3di_lane_loops_init(se3di_lane_loops *lane_loops,
                                  const struct se3di_tree_loops *loops);
void se3di_lane_loops_destroy(se3di_lane_loops *lane_loops);
/* Take the least pivots of single states as they are now, or a part of them. */
void se3di_lane_loops_take_least(se3di_lane_loops *lane_loops, double part);
/* Numbers of a state that their work takes, in memory that somebody else has, aligned. */
size_t se3di_lane_loops_room(const se3di_lane_loops *lane_loops);
void se3di_lanes_take_loops(se3di_lanes *lanes, const se3di_lane_loops *lane_loops, double *memory);

/* Whether all that moves, moves in planes: the joints of a tree are revolutes about parallel axes
 * without inertia of their own. */
int se3di_tree_is_planar(const se3di_tree *tree);
/* If so, the lanes place, accelerate, find efforts and measure by the three freedoms that links
 * have in a plane, for lanes on which nothing but gravity and efforts act. */
void se3di_lanes_take_plane(se3di_lanes *lanes);

/* Accelerations of the states, with lanes->wrench as it is; effort may be NULL. */
void se3di_lanes_accelerate(const se3di_lanes *lanes, const double *effort, double *qddot);

/* An aligned array within memory that has SE3DI_LANES_ALIGN bytes more. */
double *se3di_lanes_align(double *memory);

#endif
