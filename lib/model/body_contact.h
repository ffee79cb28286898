/* SPDX-License-Identifier: BSD-3-Clause */
/* What contacts between bodies remember of the last accepted state. Data only; see
 * contact/bodies/body_contacts.h. */
#ifndef SE3DI_MODEL_BODY_CONTACT_H
#define SE3DI_MODEL_BODY_CONTACT_H

#include <stddef.h>
#include <stdint.h>

/* What the force and the springs of a contact are. */
enum {
    SE3DI_CONTACT_LAWFUL = 0,  /* those of the law at the state */
    SE3DI_CONTACT_NEW = 1,     /* none yet: it begins with the next step, */
    SE3DI_CONTACT_STEPPED = 2, /* the impulse of the last step over its length (method convex) */
    SE3DI_CONTACT_PARTING = 3  /* none more: an impact of one step has parted the two */
};

/* A point of contact, named by (shape_i, shape_j, feature). */
typedef struct se3di_body_contact {
    uint32_t shape_i, shape_j; /* dense, i < j */
    uint32_t feature;
    int32_t kind;                    /* SE3DI_CONTACT_ */
    double anchor_i[3], anchor_j[3]; /* body frames; j's minus i's is the stretch of the spring */
    double roll[3], twist;           /* R* times the angle of rolling (ground frame), of torsion */
    double turn[4];                  /* orientation of body j in body i */
    double point[3], normal[3];      /* ground frame, the normal from i to j */
    double overlap;
    double inverse_mass;        /* 1/m* along the normal, of the points that share the load */
    double force[3], torque[3]; /* on j: at the point, of rolling and torsion; ground frame */
    double energy;              /* of its springs [J], if it is not lawful */
    double spin[2];             /* of the surfaces about the normal [rad/s] */
    /* Of stepped contacts: how their velocity changes as the point wanders [m/s^2], how far the
     * bodies have moved since the shapes were looked at [m]. */
    double wander[3], moved;
} se3di_body_contact;

typedef struct se3di_body_contacts {
    se3di_body_contact *list; /* of the last accepted state, by shapes and as found */
    size_t count, capacity;
    se3di_body_contact *next; /* of the state that is about to be accepted */
    size_t next_count, next_capacity;
    /* Pairs of shapes that may touch as long as no shape has moved by more than `margin` / 2 from
     * `reference`; of edit `version` of the model. */
    uint32_t *pairs; /* [2 * pairs], ascending */
    size_t pair_count, pair_capacity;
    double *reference;   /* [3 * shapes] */
    uint32_t *order;     /* [shapes] by their lower ends along an axis */
    double *swept;       /* [4 * shapes] in that order: centre, bound; while the list is made */
    uint32_t *joints;    /* constraints of body 0, 1, ...; while the list is made */
    size_t *joint_begin; /* [bodies + 2] where those of a body begin */
    size_t reference_capacity, order_capacity, swept_capacity, joints_capacity, begin_capacity;
    double margin;
    double time, next_time; /* of the states of `list` and `next` */
    uint64_t version;       /* 0: none */
    double step;            /* of a method under way that meets contacts within it; 0: not known */
    double weight;          /* of forces at the end of a step of it, see se3di_contacts_begin */
    int32_t jumps;          /* its equations may have jumps */
    int32_t changed;        /* what touches, at the last accepted state */
    size_t kept;            /* contacts of `next` that are in `list` */
    const uint8_t *frozen;  /* [bodies] they stay where they are in the step under way, and so do
                               the contacts of two of them; NULL: none */
    const struct se3di_body_contact *followed; /* the same of pairs of shapes whose contacts are */
    size_t followed_count; /* known at the end of the step under way without a look at them */
    void *met;             /* what was found of pairs of shapes, see contact/bodies/met.h */
    size_t met_bytes;
} se3di_body_contacts;

#endif
