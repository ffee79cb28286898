/* SPDX-License-Identifier: BSD-3-Clause */
/* The model in joint coordinates: a spanning tree of joints, whose freedoms are the coordinates.
 *
 * Every moving body is a node. Its parent is the body on the other side of its joint, or the ground
 * (all fixed bodies), to which bodies that no joint reaches are joined by six freedoms. Joints with
 * the most equations come first, then the nearest to the ground, then the oldest; if that leaves
 * out one with an armature, those with armatures come first of all. Parents have smaller numbers
 * than their children. Constraints that are not on the tree are loop constraints (tree/loops.h); a
 * driver of a joint with one freedom prescribes it.
 *
 *     a = X a_parent + c + S qddot         a: of the node's point, ground axes
 *     M qddot + h = S^T wrench + effort    without loops; bodies come from articulated inertias
 *
 * Positions q and velocities qdot have different counts: three rotations are a unit quaternion,
 * whose velocity is the relative angular velocity in the child's frame. The poses in the model are
 * the truth; q is read from them and moves them.                docs/theory/joint_coordinates.md */
#ifndef SE3DI_TREE_H
#define SE3DI_TREE_H

#include "force/force.h"

/* X(NAME, name, positions, velocities). Of the child relative to the parent. Angles and
 * displacements of revolute, prismatic, screw and cylindrical joints and the angle of a planar one
 * are those of the joint (j relative to i), whichever side is the parent.
 *
 *     free         r (3), p (4);  v of the centre of mass, ground frame (3), w in the body (3)
 *     carrier      x of the centre of mass, ground frame, where the carrier of a state slides
 *     fixed        none
 *     revolute     angle
 *     prismatic    displacement
 *     screw        angle
 *     cylindrical  angle, displacement
 *     universal    turn of the cross about the parent's axis, of the child about its own
 *     spherical    quaternion (4); w of the child relative to the parent, child's frame (3)
 *     planar       two displacements along the parent's directions in the plane, angle */
#define SE3DI_TREE_JOINT_LIST(X)                                                                   \
    X(FREE, free, 7, 6)                                                                            \
    X(CARRIER, carrier, 1, 1)                                                                      \
    X(FIXED, fixed, 0, 0)                                                                          \
    X(REVOLUTE, revolute, 1, 1)                                                                    \
    X(PRISMATIC, prismatic, 1, 1)                                                                  \
    X(SCREW, screw, 1, 1)                                                                          \
    X(CYLINDRICAL, cylindrical, 2, 2)                                                              \
    X(UNIVERSAL, universal, 2, 2)                                                                  \
    X(SPHERICAL, spherical, 4, 3)                                                                  \
    X(PLANAR, planar, 3, 3)

typedef enum se3di_tree_joint {
#define SE3DI_TREE_ENUM(NAME, name, positions, velocities) SE3DI_TREE_##NAME,
    SE3DI_TREE_JOINT_LIST(SE3DI_TREE_ENUM)
#undef SE3DI_TREE_ENUM
        SE3DI_TREE_JOINT_COUNT
} se3di_tree_joint;

/* What spares work in a node. */
#define SE3DI_TREE_ALIGNED_PARENT 1 /* the joint's directions on the parent are its triad */
#define SE3DI_TREE_ALIGNED_BODY   2 /* the triad is the body's frame, up to the sign of p */
#define SE3DI_TREE_DIAGONAL       4 /* the inertia about the joint point, in the triad */
#define SE3DI_TREE_GIVEN          8 /* the coordinate is prescribed */

/* A node: what does not change with the state. Its triad is fixed in the body, at the joint point,
 * its third direction along the axis. */
typedef struct se3di_tree_node {
    uint32_t body; /* dense index */
    uint32_t parent_body;
    int32_t parent;      /* node, -1: the ground */
    int32_t type;        /* se3di_tree_joint */
    int32_t constraint;  /* the joint, -1: free */
    int32_t is_reversed; /* the child is body i of the joint */
    int32_t angle;       /* turn counter, -1: none */
    int32_t driver;      /* the constraint that prescribes the coordinate, -1: none */
    uint32_t q, v;       /* the first of the node's */
    int32_t q_count, v_count;
    int32_t flags;
    int32_t branch;    /* where children other than the next node add up, -1: there are none */
    int32_t child;     /* the last one, -1: none; children in turn by `before`, to the first one */
    int32_t before;    /* the child of the same parent before this one, -1: none */
    int32_t is_driven; /* it, or a node between it and the ground, has a driver */
    int32_t reserved;
    double zero;       /* the triads coincide at this angle */
    double sigma;      /* axis_i . axis_j of a revolute: 1 or -1 */
    double lead, base; /* screw: displacement = base + lead angle */
    double C[4], T[9]; /* triad at angle zero -> parent's triad: quaternion and matrix */
    double r[3];       /* the parent's point -> the joint point on it, parent's triad */
    double B[4];       /* body -> triad */
    double s[3];       /* joint point -> centre of mass, triad */
    double mass;
    double J[6]; /* about the joint point, triad: xx yy zz xy xz yz */
} se3di_tree_node;

/* A node at a state, in ground axes. */
typedef struct se3di_tree_link {
    double W[9]; /* triad -> ground */
    double d[3]; /* from the parent's point to P, the joint point on the child */
    double s[3]; /* from P to the centre of mass */
    double w[3]; /* angular velocity */
    double c[6]; /* acceleration at qddot = 0, less what the parent's gives: angular, of P */
    double a[6]; /* acceleration: angular, of P, less gravity that pulls at the tree */
    /* where the frames of bodies were placed, too: */
    double t[4]; /* triad -> ground: quaternion */
    double P[3]; /* joint point on the child */
    double v[3]; /* velocity of P */
} se3di_tree_link;

/* Articulated inertia [I G^T; G M] and bias p: moments and forces from accelerations, about P. I
 * and M: xx yy zz xy xz yz. */
typedef struct se3di_tree_inertia {
    double I[6], G[9], M[6], p[6];
    double none; /* 0: four by four */
} se3di_tree_inertia;

/* Four nodes that stand side by side in lanes: as deep in the tree, with joints of one type and the
 * same flags; if there are three the last one stands twice. Their constants, lane by lane. */
#define SE3DI_TREE_PACK 4

typedef struct se3di_tree_pack {
    uint32_t node[SE3DI_TREE_PACK];
    int32_t type, flags;
    int32_t is_rooted; /* their parents are the ground */
    int32_t factors;   /* inertias, too, take the same operations in all lanes: */
    int32_t is_plain;  /* balls without armatures */
    int32_t reserved;
    double zero[SE3DI_TREE_PACK], lead[SE3DI_TREE_PACK], base[SE3DI_TREE_PACK];
    double C[4 * SE3DI_TREE_PACK], T[9 * SE3DI_TREE_PACK], r[3 * SE3DI_TREE_PACK];
    double B[4 * SE3DI_TREE_PACK], s[3 * SE3DI_TREE_PACK];
    double mass[SE3DI_TREE_PACK], J[6 * SE3DI_TREE_PACK], armature[6 * SE3DI_TREE_PACK];
} se3di_tree_pack;

struct se3di_tree_core;

typedef struct se3di_tree {
    se3di_model *model;
    uint64_t topology_version, break_version; /* of the model this was built for */
    uint32_t count;                           /* nodes */
    uint32_t q_count, v_count;
    uint32_t branch_count;
    uint32_t body_count;  /* dense */
    uint32_t given_count; /* nodes whose coordinate is prescribed */
    se3di_tree_node *nodes;
    uint32_t pack_count, pack_max; /* of nodes side by side (tree/packs.h), 0: none */
    uint32_t step_count;
    se3di_tree_pack *packs;
    uint32_t *steps;  /* [step_count]: nodes, or count + a pack, parents before their children */
    int32_t *keys;    /* [nodes * 4]: scratch of what finds packs */
    int32_t *node_of; /* [bodies] -1: fixed */
    int32_t *tree_of; /* [constraints]: node of a joint or driver, -1: a loop's */
    uint32_t constraint_count;
    uint32_t force_count; /* elements */
    int32_t *along;       /* [elements]: velocity of the coordinate that an effort acts on, or -1 */
    int32_t *counted;     /* [angle_count]: place in q of what a turn counter counts, or -1 */
    int32_t has_efforts;  /* some effort acts on a coordinate of the tree, */
    int32_t has_others;   /* and some on none */
    int32_t moves_states; /* carriers of states may be nodes, */
    int32_t has_states;   /* and some are */
    int32_t acts;         /* wrenches are read, */
    int32_t reserved;
    double pull[3]; /* and gravity pulls at all links: see se3di_tree_pull */
    /* at the state that was placed last: */
    se3di_tree_link *links;
    double *S;                /* [velocities * 6]: angular, of P; ground axes */
    double *U;                /* [velocities * 6]: articulated inertia times S */
    double *D, *R, *e;        /* [velocities]: S^T U, its inverse; what acts on the coordinate */
    double *V, *k;            /* revolutes: U / D about the parent's point; U . c / D */
                              /* balls: V[j] of a turn is U . S_j / D of those before it */
    double *given;            /* [velocities]: prescribed accelerations */
    double *effort;           /* [velocities]: of the elements in `along`, at the last sums */
    double *effort_before;    /* [velocities]: of the caller, to come back to */
    double *armature;         /* [velocities]: inertia that turns with the coordinate alone */
    int32_t foreign_armature; /* a force element: armature on no coordinate of the tree; -1: none */
    int32_t keeps_turns;      /* q is integrated: see se3di_tree_match_turns */
    uint32_t angle_count;     /* turn counters of the model */
    double *wrench;           /* [nodes * 6]: what acts on each: moment about P, force; ground */
    double *q, *qdot, *qddot; /* scratch of the caller */
    se3di_tree_inertia *branches;
    se3di_tree_inertia *passed; /* [nodes]: to their parents, if there are packs */
    double *scratch;            /* [nodes * 12] */
    se3di_frame *frames;        /* [bodies]: scratch */
    const struct se3di_tree_core *core;
} se3di_tree;

/* The constraint is a loop's: neither on the tree nor broken. */
static inline int se3di_tree_leaves(const se3di_tree *tree, uint32_t constraint)
{
    const se3di_model *model = tree->model;
    return tree->tree_of[constraint] < 0 &&
           !se3di_is_broken(&model->constraints[constraint], model->rows);
}

/* Build the tree of a model; on failure nothing is held. Coordinates can be read at once.
 * @return OK, NO_MEMORY */
se3d_status se3di_tree_init(se3di_tree *tree, se3di_model *model, int moves_states,
                            se3di_error *error);
void se3di_tree_destroy(se3di_tree *tree);

/* Take masses, the poses of fixed bodies, and which of the poses that satisfy a joint (half turns)
 * is meant, from the model: after setters, and where a run begins. */
void se3di_tree_refresh(se3di_tree *tree);

/* The place of a joint's coordinate (se3d_joint_coordinate) among its node's, -1: it is none. */
int32_t se3di_tree_component(const se3di_tree_node *node, int32_t coordinate);

/* Moments of inertia about a node's joint point, in its triad, of a body with `own` ones about the
 * centre of mass: xx yy zz xy xz yz each, but `own` as the body's. */
void se3di_tree_inertia_of(const se3di_tree_node *node, double mass, const double own[6],
                           double moments[6]);

/* A direction of the body's frame in its node's triad. */
void se3di_tree_to_triad(const se3di_tree_node *node, const double local[3], double x[3]);

/* Coordinates of the model's frames; refreshed. NULL: not wanted. */
void se3di_tree_get(se3di_tree *tree, double *q, double *qdot);

/* Place tree->frames by q, as it was got. If the tree keeps turns, universal joints are given
 * those of 2 pi in q with which the bodies that they carry have the model's sign of p:
 * it goes on from there. The turns of a revolute are counted, and the sign is its body's. */
void se3di_tree_match_turns(se3di_tree *tree, double *q);

/* Coordinates -> frames [dense bodies], those of fixed bodies are left alone; links, S and biases
 * follow. `frames` may be the model's. NULL: not wanted; accelerations need none. */
void se3di_tree_place(se3di_tree *tree, const double *q, const double *qdot, se3di_frame *frames);
/* The same frames alone: links, S and biases are those of no state. */
void se3di_tree_show(se3di_tree *tree, const double *q, const double *qdot, se3di_frame *frames);

/* With tree->q and tree->qdot those of the model's frames: place them in tree->frames; from now on
 * such coordinates give a body the Euler parameters that it has, not their opposite. */
void se3di_tree_match_signs(se3di_tree *tree);

/* Rates of the positions. */
void se3di_tree_rates(const se3di_tree *tree, const double *q, const double *qdot, double *rates);
/* out = q moved by the displacement dq [velocities]; out may be q. */
void se3di_tree_move(const se3di_tree *tree, const double *q, const double *dq, double *out);

/* For se3di_forces_sum at the velocities `qdot` of the state that is placed: efforts along
 * coordinates of the tree go to tree->effort, where they stay until the next sums. */
se3di_force_sums se3di_tree_sums(se3di_tree *tree);
/* The same with the efforts of the last sums, whatever elements say now; `power` is without
 * theirs. */
se3di_force_sums se3di_tree_sums_again(se3di_tree *tree);
/* tree->effort, NULL: no element acts along a coordinate. */
static inline const double *se3di_tree_effort(const se3di_tree *tree)
{
    return tree->has_efforts ? tree->effort : NULL;
}

/* With the state placed: take what acts on bodies, [dense bodies * 6] force (ground) and torque
 * (body) as force/force.h has it; frames as placed. */
void se3di_tree_take_wrenches(se3di_tree *tree, const se3di_frame *frames, const double *wrench);
/* Nothing acts but gravity that does not change and efforts on coordinates of the tree, which are
 * numbers; contact there cannot be. */
int se3di_tree_falls(const se3di_tree *tree);
/* A bound of the angular velocity of any body, and of any to any other, from the rates of the
 * coordinates; of what their second rates give of an acceleration. */
double se3di_tree_sum_turns(const se3di_tree *tree, const double *rates);
/* Their sums, to tree->effort, as se3di_tree_sums has them. */
void se3di_tree_sum_efforts(se3di_tree *tree);
/* Gravity g alone pulls at the links, as if the ground accelerated by -g. */
void se3di_tree_pull(se3di_tree *tree, const double g[3]);
/* Articulated inertias with the wrenches taken and efforts [velocities] (NULL: zero): U, D, e.
 * `given` holds accelerations of prescribed coordinates. @return OK, SINGULAR (D <= 0) */
se3d_status se3di_tree_factor(se3di_tree *tree, const double *effort);
/* Accelerations qddot [velocities] and those of all links, from U, D and e. */
void se3di_tree_accelerate(se3di_tree *tree, const double *e, double *qddot);
/* Accelerations of links that qddot gives, less gravity that pulls. */
void se3di_tree_propagate(se3di_tree *tree, const double *qddot);
/* Accelerations of links -> bodies, [dense bodies * 6] a (ground), wdot (body); fixed: zero. */
void se3di_tree_get_accelerations(const se3di_tree *tree, const se3di_frame *frames,
                                  double *acceleration);
/* The same of the body of one node, in its frame. */
void se3di_tree_link_acceleration(const se3di_tree *tree, uint32_t node, const se3di_frame *frame,
                                  double out[6]);

#endif
