/* SPDX-License-Identifier: BSD-3-Clause */
/* What a model file became. */
#ifndef SE3D_IO_MODEL_H
#define SE3D_IO_MODEL_H

#include "io/document/document.h"
#include "io/document/part.h"
#include "io/document/scope.h"
#include "io/model/mesh.h"
#include "io/model/tagged.h"

typedef struct se3di_body_entry {
    const char *name;
    const se3di_node *node;      /* NULL: the ground */
    const se3di_component *part; /* that has it */
    se3d_body body;
    se3di_ionames markers; /* to indices of se3d_model.markers */
} se3di_body_entry;

typedef struct se3di_marker_entry {
    const char *name;
    size_t body; /* index of the body's entry */
    se3d_marker marker;
    double position[3]; /* body frame */
} se3di_marker_entry;

typedef enum se3di_element_kind {
    SE3DI_ELEMENT_JOINT = 0,
    SE3DI_ELEMENT_CONSTRAINT = 1,
    SE3DI_ELEMENT_DRIVER = 2,
    SE3DI_ELEMENT_FORCE = 3,
    SE3DI_ELEMENT_WHEEL = 4,
    SE3DI_ELEMENT_STATE = 5,
    SE3DI_ELEMENT_ROAD = 6,
    SE3DI_ELEMENT_KINDS = 7
} se3di_element_kind;

/* A joint, constraint, driver, force, wheel, state or road: their names are unique together. */
typedef struct se3di_element_entry {
    const char *name;
    const se3di_node *node;
    se3di_element_kind kind;
    se3d_constraint constraint;
    se3d_force force;
    se3d_wheel wheel;
    se3d_road road;
    se3d_state *states; /* [order], the first with input and output */
    size_t order;
    const se3di_component *part; /* that has it */
    se3d_body body;              /* bushing, force, torque: the body acted on, */
    double point[3];             /* where */
    /* How it is drawn: a pair with points (1), also with an axis (2), a spring (3); 0: not. */
    int32_t drawn;
    bool is_turned;         /* mirrored joint whose angle counts the other way round */
    bool is_paired;         /* wheel that has an opposite one */
    int32_t coordinate;     /* se3d_joint_coordinate of a driver, friction or stop */
    uint32_t settable;      /* bit k: component k of a load, effort or driver is a number, */
    double value[3];        /* this one */
    se3d_function rate;     /* driver whose number is a rate; null: it is a value */
    se3d_constraint driven; /* the joint of a driver */
    se3d_body body_i;
    se3d_body body_j;
    double point_i[3]; /* body frames. Road, or tyre on a plane: origin and normal are those of i */
    double point_j[3];
    double axis_i[3]; /* 0: it has none */
    double axis_j[3];
    const char *break_channel; /* joint with limits: the channel that tells whether it broke */
    se3d_function height;      /* road: over (t, x, y); null: none */
    const se3di_mesh *surface; /* road: its triangles; NULL: none */
    const double *heights;     /* road: those of its grid, as read; NULL: none */
    size_t row_count, column_count;
} se3di_element_entry;

/* What `modes` writes. */
typedef struct se3di_modes_entry {
    const char *file; /* NULL: the analysis is another one */
    se3d_modes_input *inputs;
    size_t input_count;
    se3d_modes_output *outputs;
    size_t output_count;
    double from, to; /* frequencies of the transfer functions [Hz] */
    size_t frequency_count;
    double count; /* of the lowest modes; 0: all */
} se3di_modes_entry;

typedef struct se3di_analysis_entry {
    se3d_model_analysis analysis;
    se3d_solver_def solver;
    se3di_modes_entry modes;
    const se3di_node *node;
} se3di_analysis_entry;

/* Whether the analysis that it asks for has a duration. */
bool se3di_solver_takes_time(const se3d_solver_def *solver);
/* Whether time passes in it, so that there can be events. */
bool se3di_analysis_has_motion(const se3di_analysis_entry *entry);

/* What a shape looks made of, as se3di_shape_styles names it. */
typedef enum se3di_style {
    SE3DI_STYLE_PAINT = 0,
    SE3DI_STYLE_STEEL = 1,
    SE3DI_STYLE_RUBBER = 2,
    SE3DI_STYLE_GLASS = 3,
    SE3DI_STYLE_SAND = 4,
    SE3DI_STYLE_WIRE = 5
} se3di_style;

typedef struct se3di_shape_entry {
    se3d_model_shape shape;
    const se3di_mesh *mesh; /* NULL: the shape is another one */
    const se3di_node *node;
    const se3di_component *part; /* that has it */
    int32_t convex;              /* mesh: its hull touches */
    int32_t style;               /* se3di_style */
    double opacity;
    se3d_shape made; /* of the system; null: nothing touches it */
} se3di_shape_entry;

struct se3d_model {
    se3di_iopool pool;
    se3d_system *system;
    int32_t running; /* runs of it, and samples of its studies, that are at work */
    int32_t reserved;
    const se3d_scene *kept; /* which that run keeps in its checkpoints; NULL: none */
    const char *file;
    const char *name;
    const char *title;
    se3di_node *root;
    se3di_component *parts;   /* the first is the model's file, then all that it is made of */
    const se3di_scope *scope; /* parameters and points */
    se3di_body_entry *bodies; /* [0] is the ground */
    size_t body_count, body_capacity;
    se3di_ionames body_names;
    se3di_marker_entry *markers;
    size_t marker_count, marker_capacity;
    se3di_element_entry *elements;
    size_t element_count, element_capacity;
    se3di_ionames element_names;
    se3di_shape_entry *shapes;
    size_t shape_count, shape_capacity;
    se3di_mesh *meshes; /* that have been read */
    se3di_analysis_entry *analyses;
    size_t analysis_count;
    se3d_material *materials;           /* in the order of the file; null: not needed yet */
    bool moving_shapes;                 /* some shape that touches is on a body that is not fixed */
    se3di_tagged *particles;            /* NULL: no particles */
    struct se3di_output_entry *outputs; /* io/channel/output.h */
    size_t output_count;
    struct se3di_event_entry *events; /* io/channel/event.h */
    size_t event_count;
    struct se3di_guest_entry *guests; /* io/channel/guest.h */
    size_t guest_count;
    se3d_model_picture *pictures;
    size_t picture_count;
    struct se3di_library *library;   /* io/read/include.h: files that it includes */
    struct se3di_study_entry *study; /* io/channel/study.h; NULL: none */
    struct se3di_study_measure
        *measures; /* [study->measure_count] with the numbers of the sample that it
                                           * was read for */
    struct se3di_study_channel *measured; /* [study->source_count] of it, or of the study that the
                                             model is a sample of */
    se3d_model_channel *listed;           /* [listed_count]; NULL: not asked for yet */
    size_t listed_count;
    const se3di_attached_file *attached; /* files that were read beside its own, the last first */
    uint64_t content;                    /* hash of the bytes of all its files, */
    uint64_t asked;                      /* of the options that it was read with, */
    uint64_t timeless[2];                /* and of both without the durations of analyses */
    se3d_log_callback log;               /* the user's; NULL: none */
    void *log_ctx;
};

/* Whether a joint has such a coordinate, also if it has no value at the pose of now. */
bool se3di_joint_has(const se3d_system *system, se3d_constraint joint, se3d_joint_coordinate which);

#endif
