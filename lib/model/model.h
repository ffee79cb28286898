/* SPDX-License-Identifier: BSD-3-Clause */
/* The model: bodies, markers, functions of time, constraints and force elements with their state,
 * in dense arrays in creation order. Data only: nothing here knows an equation of motion.
 *
 * A constraint (primitive, joint or driver) owns consecutive equations (rows), a row owns
 * consecutive terms:
 *
 *     Phi_row = sum_k coefficient_k * value(term_k) - f(t)
 *
 * Dense indices move down when an element before them is destroyed; the owner of every index held
 * here is counted in `users`, so that nothing in use can be destroyed. */
#ifndef SE3DI_MODEL_H
#define SE3DI_MODEL_H

#include "base/alloc.h"
#include "base/error.h"
#include "base/slots.h"
#include "model/body_contact.h"
#include "model/road.h"
#include "model/shape.h"
#include "model/term.h"
#include "model/tyre.h"
#include "model/wheel.h"
#include "se3d/constraint.h"
#include "se3d/expression.h"
#include "se3d/force.h"
#include "se3d/function.h"
#include "se3d/joint.h"

#define SE3DI_NODE_BODIES_MAX 8 /* bodies of one constraint: a coupler of four joints */

typedef struct se3di_body {
    char *name;     /* NULL: none */
    double mass;    /* [kg] */
    double J[6];    /* about the centre of mass, body frame: xx yy zz xy yz xz */
    int32_t fixed;  /* the ground is */
    uint32_t users; /* markers, constraints, forces on it */
    int32_t held;   /* the assembly analysis leaves its pose and velocity alone */
    int32_t state; /* 1 + the index of the state that it carries (model/state.h), 0: it is a body */
} se3di_body;

typedef struct se3di_marker {
    char *name;
    uint32_t body;
    uint32_t users;
    double s[3]; /* body frame */
    double p[4]; /* marker -> body */
} se3di_marker;

/* A number of the state, see se3d_signal. */
typedef struct se3di_signal {
    int32_t kind, component;
    uint32_t body;  /* dense, as the others; 0 if the kind has none */
    uint32_t joint; /* constraint, SE3DI_NO_INDEX: none */
    uint32_t force; /* or state; SE3DI_NO_INDEX: none */
    uint32_t reserved;
    double point[3];
} se3di_signal;

typedef struct se3di_function {
    se3d_expression *expression; /* NULL: another kind */
    se3d_function_callback callback;
    void *ctx;
    double *table; /* x [n], y [n], m [n], see model/spline.h */
    size_t table_count;
    int32_t table_kind, table_periodic;
    double constant;
    uint32_t variable_count;
    uint32_t users;
    se3di_signal *signals; /* [signal_count] the last of its variables; NULL: none */
    uint32_t signal_count;
    uint32_t reserved;
    struct se3di_integral *integral; /* NULL: it is what the members above say; else their integral
                                        over the time (model/integral.h) */
} se3di_function;

typedef struct se3di_row {
    const char *name; /* static: "cd_x" */
    uint32_t term_begin, term_count;
    int32_t function; /* dense index, -1: `value` */
    int32_t wrap;     /* 1: one angle; Phi is taken modulo 2 pi into (-pi, pi] */
    double value;     /* f if there is no function */
    int32_t left_out; /* not 0: not among the equations, SE3DI_ROW_DEPENDENT or _BROKEN */
    int32_t reserved;
} se3di_row;

/* Why a row is left out: it depends on others (nonlinear/ranks.h), or its joint broke. */
/* PARTED, of a broken one: its bodies have been apart since, and may touch. */
enum { SE3DI_ROW_DEPENDENT = 1, SE3DI_ROW_BROKEN = 2, SE3DI_ROW_PARTED = 4 };
#define SE3DI_ROW_BREAKS (SE3DI_ROW_BROKEN | SE3DI_ROW_PARTED)

typedef struct se3di_joint_frames {
    double point_i[3], point_j[3];          /* body frames */
    double axis_i[3], ref_i[3], third_i[3]; /* right-handed orthonormal: ref, third, axis */
    double axis_j[3], ref_j[3], third_j[3];
} se3di_joint_frames;

/* What the rows of a constraint are together, if they can be evaluated in one pass
 * (assembly/fused.h). */
typedef enum se3di_row_pattern {
    SE3DI_PATTERN_NONE = 0,
    SE3DI_PATTERN_POINT = 1, /* three CD along the ground axes: the joint points coincide */
    SE3DI_PATTERN_HINGE = 2  /* and two DP1 with the same direction on body j */
} se3di_row_pattern;

typedef struct se3di_constraint {
    char *name;
    const char *type; /* static: "dp1", "revolute", "driver" */
    uint32_t row_begin, row_count;
    uint32_t term_begin, term_count;
    uint32_t body_count;                    /* that take part, fixed ones included; >= 2 */
    uint32_t bodies[SE3DI_NODE_BODIES_MAX]; /* dense; 0: body i, 1: body j */
    uint32_t users;
    int32_t joints[SE3D_COUPLER_TERMS_MAX]; /* constraints this one refers to, -1: none */
    int32_t angle;                          /* index of its turn counter, -1: no angle */
    int32_t has_displacement;
    se3di_joint_frames frames; /* joints: axes; all: the points where reactions are reported */
    double angle0;
    double pitch, distance;            /* joints: of the definition, the distance resolved */
    se3d_constraint_callback callback; /* user constraints; their rows have no terms */
    void *ctx;
    const struct se3di_user_class *law_class; /* the same of a driver whose value is a function of
                                                 signals (force/driver_law.h); NULL: none */
    int32_t law;                              /* that function, dense index; -1: none */
    int32_t coordinate;                       /* and the coordinate of joints[0] that follows it */
    uint32_t user_first;                      /* the callback's bodies begin here in `bodies` */
    int32_t has_value;                        /* one row, whose prescribed value is the user's */
    int32_t pattern;                          /* se3di_row_pattern */
    double break_limit[2]; /* joints: of the reaction force [N] and moment [N m]; 0: none */
    int32_t is_stale;      /* 1: made of a joint that was defined again at another place since */
} se3di_constraint;

/* The first callback of a user constraint that failed since an analysis began. */
typedef struct se3di_user_failure {
    double time;
    int32_t status; /* se3d_status; 0: none */
    uint32_t constraint;
} se3di_user_failure;

/* The constraint is a joint that broke, or acts on one. */
static inline int se3di_is_broken(const se3di_constraint *constraint, const se3di_row *rows)
{
    return constraint->row_count > 0 &&
           (rows[constraint->row_begin].left_out & SE3DI_ROW_BROKEN) != 0;
}

/* The turn counter of a joint angle. */
typedef struct se3di_angle {
    se3di_term term; /* ANGLE; value + offset is the joint angle up to whole turns */
    double offset;   /* [rad] */
    double theta;    /* joint angle of the last accepted state, counts turns */
} se3di_angle;

/* The types of force elements, X(TYPE, name): each has a se3di_force_class_<name> in lib/force. New
 * ones go to the end: the numbers are part of what a run's bits depend on. */
#define SE3DI_ELEMENT_LIST(X)                                                                      \
    X(TSDA, tsda)                                                                                  \
    X(RSDA, rsda)                                                                                  \
    X(LOAD, load)                                                                                  \
    X(TORQUE, torque)                                                                              \
    X(BUSHING, bushing)                                                                            \
    X(FRICTION, friction)                                                                          \
    X(STOP, stop)                                                                                  \
    X(CALLBACK, callback)                                                                          \
    X(EFFORT, effort)                                                                              \
    X(TYRE, tyre)                                                                                  \
    X(ARMATURE, armature)

/* The same with the rates of states (model/state.h). */
#define SE3DI_FORCE_LIST(X)                                                                        \
    SE3DI_ELEMENT_LIST(X)                                                                          \
    X(STATE, state)

typedef enum se3di_force_type {
#define SE3DI_FORCE_ENUM(TYPE, name) SE3DI_FORCE_##TYPE,
    SE3DI_FORCE_LIST(SE3DI_FORCE_ENUM)
#undef SE3DI_FORCE_ENUM
        SE3DI_FORCE_COUNT
} se3di_force_type;

#define SE3DI_FORCE_FUNCTIONS                                                                      \
    5 /* h or the components of a load (0, 1, 2), spring (3), damper (4);                          \
         of a state: rate (0), output (3), input (4) */
#define SE3DI_FORCE_OUTPUT 3 /* and input, the next one */
#define SE3DI_FORCE_STATES                                                                         \
    16 /* what an element remembers of the accepted states: of the last one, */
#define SE3DI_FORCE_BEFORE 8 /* and from here on, of the way there from the one before */

typedef struct se3di_force {
    char *name;
    int32_t type;
    int32_t in_body_frame;   /* loads */
    int32_t has_jacobian;    /* callbacks */
    uint32_t body_i, body_j; /* loads: body_j */
    double s_i[3], s_j[3];
    double k, c, rest;                       /* stiffness, damping, l0 or theta0; a state's size */
    double preload;                          /* of springs: value at rest */
    int32_t function[SE3DI_FORCE_FUNCTIONS]; /* -1: none */
    int32_t joint;      /* rsda, friction, stop, effort, armature: whose coordinate; -1: none */
    int32_t angle;      /* its turn counter; -1: none */
    int32_t owns_angle; /* the turn counter is the element's own */
    int32_t coordinate; /* of the joint: se3d_joint_coordinate, or SE3DI_FORCE_LENGTH;
                           a state of a tyre: 0 of the slip ratio, 1 of the slip angle */
    int32_t tyre_index; /* a state: the tyre whose slip it is; -1: it is the user's */
    uint32_t users;
    double value[3];    /* loads; effort, armature: [0] */
    double low, high;   /* stop: free between; infinite: none */
    double restitution; /* stop */
    double mu, mu_static, radius, limit, viscous, presliding; /* friction, */
    double length, width, thrust_radius;                      /* of what carries its load */
    double p_i[4], p_j[4];                                    /* bushing: frames -> bodies */
    double K[36], C[36];                                      /* bushing, in frame i */
    se3d_force_callback callback;
    se3d_force_energy_callback energy; /* of a callback; NULL: none is stored */
    void *ctx;
    se3di_tyre *tyre;                 /* owned; NULL: no tyre */
    double state[SE3DI_FORCE_STATES]; /* friction, stop: see their files */
    int32_t released;                 /* 1: its joint broke, it does nothing */
    int32_t reserved;
} se3di_force;

#define SE3DI_FORCE_LENGTH 2 /* se3di_force.coordinate */

enum { SE3DI_SETTLED = 1, SE3DI_LACKING = 2 }; /* bits of se3di_model.settled */

/* Of se3di_model.work. */
enum se3di_work_state {
    SE3DI_WORK_LEFT = -2, /* what was done before the state was changed; the next run begins anew */
    SE3DI_WORK_UNKNOWN = -1, /* the last analysis (kinematics) computes none */
    SE3DI_WORK_NONE = 0,
    SE3DI_WORK_VALID = 1 /* and `power` belongs to the present state */
};

typedef struct se3di_model {
    se3d_allocator allocator;
    double gravity[3];
    int32_t gravity_function[3]; /* of time, -1: `gravity` */
    int32_t work_valid;          /* se3di_work_state */
    double time;
    double time_rest, rest_time; /* what rounding took from the steps of a caller's on the way to
                                    rest_time [s] */
    double work[3];            /* done since the start: dissipated, by actuators, by drivers [J] */
    double power[3];           /* the same, of the last accepted state [W] */
    uint64_t topology_version; /* changes when elements come, go or change */
    uint64_t inputs_version;   /* changes when values of elements, masses or gravity change, or what
                                  callbacks compute: what acts on the state, not the state itself */
    uint64_t contact_version;  /* changes when materials or the law of contact do */
    uint64_t masses_version;   /* changes when a mass or an inertia does */
    uint64_t poses_version;    /* changes when a state is set; not when an analysis moves it */
    uint64_t values_version;   /* changes when prescribed values do: positions have to follow */
    int32_t settled;         /* SE3DI_SETTLED: the state is an analysis' own, nothing was set since;
                                  SE3DI_LACKING: without accelerations and multipliers */
    int32_t remembers;       /* an analysis may have left something in forces, shapes, contacts */
    int32_t ranks_known;     /* which rows are left out was decided; 0 after edits, new poses */
    uint32_t left_out_count; /* rows that are */
    uint32_t broken_count;   /* those of them whose joint broke */
    uint64_t break_version;  /* changes when joints break or are whole again */
    double left_out_gap;     /* the largest violation of those in an accepted state, relative, */
    uint32_t left_out_row;   /* its row; 0 after it was told */
    int32_t shows_before;    /* 1: the halves of what force elements remember are exchanged, see
                                  se3di_forces_show */
    int32_t replaces;        /* 1: what is added takes the place of what has its name, see
                                  se3d_system_set_replacing; not copied by se3di_model_clone */
    uint32_t target;         /* not 0: what is added takes the place of this one - 1 of its kind,
                                  whatever its name is; the same */

    se3di_slots body_slots; /* count = bodies, [0] the ground */
    se3di_body *bodies;
    se3di_frame *frames;  /* state of the bodies */
    double *acceleration; /* [bodies * 6]: a (ground frame), wdot (body frame) */
    size_t body_capacity, frame_capacity, acceleration_capacity;

    se3di_slots marker_slots;
    se3di_marker *markers;
    size_t marker_capacity;

    se3di_slots function_slots;
    se3di_function *functions;
    size_t function_capacity;

    se3di_slots constraint_slots;
    se3di_constraint *constraints;
    size_t constraint_capacity;
    se3di_row *rows;
    size_t row_count, row_capacity;
    se3di_term *terms;
    size_t term_count, term_capacity;
    se3di_angle *angles;
    size_t angle_count, angle_capacity;
    double *lambda; /* [rows] multipliers of the last analysis */
    size_t lambda_capacity;

    se3di_slots force_slots;
    se3di_force *forces;
    size_t force_capacity;
    int32_t steps_apart; /* 1: sums leave out stops and friction, which are contacts of the step */
    size_t state_count;  /* of the user's states: so many bodies and forces are no others */

    se3di_contact_settings contact;
    se3di_slots material_slots;
    se3di_material *materials;
    se3di_override *overrides; /* [materials * materials], symmetric */
    se3di_pair *pairs;         /* the same: what they give, see contact/bodies/law.h */
    size_t material_capacity, override_capacity, pair_capacity;
    se3di_slots shape_slots;
    se3di_shape *shapes;
    size_t shape_capacity;

    se3di_slots wheel_slots;
    se3di_wheel *wheels;
    size_t wheel_capacity;

    se3di_slots road_slots;
    se3di_road *roads;
    size_t road_capacity;

    se3di_body_contacts contacts;

    double *history; /* what an integrator carries from step to step */
    size_t history_count, history_capacity;
    int64_t history_redundant;               /* not 0: on the way rows were dependent */
    uint64_t history_tag;                    /* who wrote it; 0: nobody */
    uint64_t history_stamp;                  /* changes when it does other than by steps forward */
    uint64_t history_inputs, history_values; /* the versions that it belongs to */

    se3di_user_failure user_failure; /* see assembly/user.h */

    struct se3di_particles *sets;  /* particle sets in creation order, see particles/sets.h;
                                     not copied by se3di_model_clone */
    struct se3di_busy *busy;       /* of the system, see base/busy.h; NULL: no system */
    struct se3di_pending *pending; /* the same, see base/pending.h: accelerations, multipliers,
                                      powers and what the history has of them */
    struct se3di_shelf *shelf;     /* of the system and its clones, see base/shelf.h */
} se3di_model;

/* Of the present state, or of the one before it was changed. */
static inline int se3di_has_work(const se3di_model *model)
{
    return model->work_valid == SE3DI_WORK_VALID || model->work_valid == SE3DI_WORK_LEFT;
}

/* The bodies of two shapes stay in the step under way. */
static inline int se3di_contact_is_frozen(const se3di_model *model, uint32_t i, uint32_t j)
{
    const uint8_t *frozen = model->contacts.frozen;
    return frozen && frozen[model->shapes[i].body] && frozen[model->shapes[j].body];
}

/* A constraint under construction: joints and primitives fill it, se3di_model_add_constraint copies
 * it. */
#define SE3DI_DRAFT_ROWS  8
#define SE3DI_DRAFT_TERMS 8
typedef struct se3di_draft {
    se3di_constraint constraint;      /* its ranges are set by se3di_model_add_constraint */
    se3di_row rows[SE3DI_DRAFT_ROWS]; /* term_begin counts from the first term of the draft */
    se3di_term terms[SE3DI_DRAFT_TERMS];
    uint32_t row_count, term_count;
    int32_t has_angle; /* a turn counter is made from `angle` */
    se3di_angle angle;
} se3di_draft;

/* Give an element a copy of its own of its tyre; on failure it has none. */
se3d_status se3di_force_own(const se3d_allocator *allocator, se3di_force *force);
void se3di_force_release(const se3d_allocator *allocator, se3di_force *force);

/* Initialise an empty model with the ground; on failure nothing is held. */
se3d_status se3di_model_init(se3di_model *model, const se3d_allocator *allocator, uint32_t salt);
void se3di_model_destroy(se3di_model *model);
/* Deep copy into the uninitialised `copy`; on failure nothing is held. */
se3d_status se3di_model_clone(const se3di_model *model, se3di_model *copy);

/* Add an element; names are copied. Either everything or nothing happens. NO_MEMORY is the only
 * failure: the caller has validated. */
se3d_status se3di_model_add_body(se3di_model *model, const se3di_body *body,
                                 const se3di_frame *frame, se3di_handle *handle);
se3d_status se3di_model_add_marker(se3di_model *model, const se3di_marker *marker,
                                   se3di_handle *handle);
se3d_status se3di_model_add_function(se3di_model *model, const se3di_function *function,
                                     se3di_handle *handle); /* takes over expression and table */
se3d_status se3di_model_add_constraint(se3di_model *model, const se3di_draft *draft,
                                       se3di_handle *handle);
/* STATE, with its name, if a driver or coupler has not been defined again after its joint. */
se3d_status se3di_model_check_stale(const se3di_model *model, se3di_error *error);
se3d_status se3di_model_add_force(se3di_model *model, const se3di_force *force,
                                  se3di_handle *handle);

/* Name, vertices, triangles and tree are copied. */
se3d_status se3di_model_add_shape(se3di_model *model, const se3di_shape *shape,
                                  se3di_handle *handle);
se3d_status se3di_model_add_material(se3di_model *model, const se3di_material *material,
                                     se3di_handle *handle);

se3d_status se3di_model_add_wheel(se3di_model *model, const se3di_wheel *wheel,
                                  se3di_handle *handle);

/* What an addition takes the place of: by model->target, or by its name; SE3DI_NO_INDEX: nothing,
 * it is new. */
uint32_t se3di_model_find_replaced(const se3di_model *model, const se3di_slots *slots,
                                   uint32_t owner, const char *name);

/* Name, heights and mesh are copied. */
se3d_status se3di_model_add_road(se3di_model *model, const se3di_road *road, se3di_handle *handle);

/* The same with a turn counter of its own. */
se3d_status se3di_model_add_force_with_angle(se3di_model *model, const se3di_force *force,
                                             const se3di_angle *angle, se3di_handle *handle);

/* Remove an element that has no users. */
void se3di_model_remove_body(se3di_model *model, uint32_t body);
void se3di_model_remove_marker(se3di_model *model, uint32_t marker);
void se3di_model_remove_function(se3di_model *model, uint32_t function);
void se3di_model_remove_constraint(se3di_model *model, uint32_t constraint);
void se3di_model_remove_force(se3di_model *model, uint32_t force);
void se3di_model_remove_shape(se3di_model *model, uint32_t shape);
void se3di_model_remove_wheel(se3di_model *model, uint32_t wheel);
void se3di_model_remove_road(se3di_model *model, uint32_t road);
void se3di_model_remove_material(se3di_model *model, uint32_t material);

/* -1: none. */
void se3di_model_set_shape_material(se3di_model *model, uint32_t shape, int32_t material);

/* What holds between two materials, and for all contacts. */
void se3di_model_set_override(se3di_model *model, uint32_t a, uint32_t b,
                              const se3di_override *over);
void se3di_model_set_contact(se3di_model *model, const se3di_contact_settings *settings);

/* Give a shape copies of its own of all that it points to; on failure it points to nothing. */
se3d_status se3di_shape_own(const se3d_allocator *allocator, se3di_shape *shape);
void se3di_shape_release(const se3d_allocator *allocator, se3di_shape *shape);

/* Whether any part of gravity follows a function of time. */
static inline int se3di_model_gravity_varies(const se3di_model *model)
{
    const int32_t *function = model->gravity_function;
    return function[0] >= 0 || function[1] >= 0 || function[2] >= 0;
}

/* Whose name a marker's is: names of markers are unique on their body. */
static inline uint32_t se3di_model_owner(const se3di_model *model, uint32_t body)
{
    return se3di_slots_handle(&model->body_slots, body).index1;
}

/* Keep, put back what force elements remember: memory [forces * SE3DI_FORCE_STATES]. */
void se3di_model_save_memory(const se3di_model *model, double *memory);
void se3di_model_restore_memory(se3di_model *model, const double *memory);
/* The structure has changed. */
void se3di_model_touch(se3di_model *model);
/* The user has set a state: nothing that an integrator or solver remembers of it holds. */
void se3di_model_touch_state(se3di_model *model);

/* The user has set poses: ranks may be others, too. */
void se3di_model_touch_poses(se3di_model *model);
/* No row is left out of the equations; which ones are has to be decided. */
void se3di_model_take_all_rows(se3di_model *model);

/* A joint breaks (1) or is whole again (0), and with it what prescribes or couples its coordinates:
 * their rows are left out, or not; the state stays, what steps remember of it does not hold. */
void se3di_model_break(se3di_model *model, uint32_t joint, int32_t broken);
/* Which rows are left out was set: count them, and tell the force elements of broken joints. */
void se3di_model_follow_breaks(se3di_model *model);

/* Other things act on the state from here on; what is remembered of it stays. */
void se3di_model_touch_inputs(se3di_model *model);
/* The same of prescribed values: the state has to follow. */
void se3di_model_touch_values(se3di_model *model);
/* The same of contacts. */
void se3di_model_touch_contact(se3di_model *model);

/* Complete a frame (A, pdot) from r, p, v, w. */
void se3di_frame_update(se3di_frame *frame);
/* What callbacks see of it. */
void se3di_frame_get_motion(const se3di_frame *frame, se3d_body_motion *motion);

/* Jet {f, f', f''} of a function at x (variable 0 is time); gradient [variable_count] or NULL. */
se3d_status se3di_function_eval(const se3di_function *function, const double *x, double jet[3],
                                double *gradient);

#endif
