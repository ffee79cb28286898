/* SPDX-License-Identifier: BSD-3-Clause */
/* What bodies touch with: materials and shapes. Data only; see contact/. */
#ifndef SE3DI_MODEL_SHAPE_H
#define SE3DI_MODEL_SHAPE_H

#include "se3d/contact.h"

typedef enum se3di_contact_law {
    SE3DI_LAW_HOOKE = 0,
    SE3DI_LAW_HERTZ_MINDLIN = 1,
    SE3DI_LAW_CALLBACK = 2,
    SE3DI_LAW_MIXED = 3 /* of a set of particles: by their pairs, hooke or hertz_mindlin */
} se3di_contact_law;

typedef struct se3di_material {
    char *name; /* NULL: none */
    double density;
    double young, poisson; /* hertz_mindlin */
    double friction;
    double restitution;
    double rolling_friction, torsional_friction; /* times R*: the arm of the resisting moment */
    double stiffness, tangential_ratio;          /* hooke: kn of two spheres of it, kt/kn */
    double cohesion, adhesion;                   /* [J/m^3], [J/m^2] */
    double damping_ratio; /* 0: by restitution; these: 0 by the law, < 0 none */
    double damping_rate;  /* of particles; 0: by restitution, < 0 none */
    double tangential_ratio_hertz, tangential_damping, rolling_ratio, rolling_damping;
    double tangential_stiffness; /* [N/m], at any overlap; 0: by the ratio, < 0 none */
    double rolling_stiffness;    /* the same */
    uint32_t users;              /* shapes and sets of particles */
    uint32_t reserved;
} se3di_material;

#define SE3DI_RESTITUTION_MIN 0.01 /* below, the damping grows without bound */

/* What a user may say of a pair of materials, from the least to the most; negative: by the mixing
 * rules. */
#define SE3DI_OVERRIDE_LIST(X)                                                                     \
    X(friction, 0.0, 1e30)                                                                         \
    X(restitution, SE3DI_RESTITUTION_MIN, 1.0)                                                     \
    X(rolling_friction, 0.0, 1e30)                                                                 \
    X(torsional_friction, 0.0, 1e30)                                                               \
    X(stiffness, 1e-30, 1e30)                                                                      \
    X(cohesion, 0.0, 1e30)                                                                         \
    X(adhesion, 0.0, 1e30)                                                                         \
    X(damping_ratio, 0.0, 100.0)                                                                   \
    X(damping_rate, 0.0, 1e30)                                                                     \
    X(tangential_ratio, 0.0, 10.0)                                                                 \
    X(tangential_damping, 0.0, 10.0)                                                               \
    X(rolling_ratio, 0.0, 100.0)                                                                   \
    X(rolling_damping, 0.0, 10.0)                                                                  \
    X(young, 1e-30, 1e30)                                                                          \
    X(poisson, 0.0, 0.5)                                                                           \
    X(tangential_stiffness, 0.0, 1e30)                                                             \
    X(rolling_stiffness, 0.0, 1e30)

typedef struct se3di_override {
#define SE3DI_MEMBER(name, least, most) double name;
    SE3DI_OVERRIDE_LIST(SE3DI_MEMBER)
#undef SE3DI_MEMBER
    int32_t law; /* se3di_contact_law, HOOKE or HERTZ_MINDLIN; negative: the system's */
    int32_t reserved;
} se3di_override;

#define SE3DI_NONE_OF(name, least, most) .name = -1.0,
#define SE3DI_OVERRIDE_NONE                                                                        \
    {                                                                                              \
        SE3DI_OVERRIDE_LIST(SE3DI_NONE_OF).law = -1                                                \
    }

/* Coefficients of one pair of materials; with s = 1 (hooke) or sqrt(R* delta) (hertz_mindlin):
 *
 *     Fn = max(0, kn s delta - dn sqrt(m* s) vn)      Ft = -kt s xi - dt sqrt(m* s) vt
 *
 * with Ft = -kt xi - ... if kt is constant; if kr is, dr is, too.
 *
 * Of particles rn m* s and rt m* s stand in place of the two dampings, if rn is not below 0.
 *
 * kr, dr: of rolling and torsion, like kt and dt. Attraction, taken from Fn after friction has seen
 * it:
 *
 *     R* cohesion delta + 2 sqrt(R* pull_off kn s delta) */
typedef struct se3di_pair {
    double kn, kt, dn, dt;
    double friction, rolling, torsion, dr;
    double cohesion, pull_off, kr;
    double restitution;
    double rn, rt;
    int32_t law;         /* se3di_contact_law, not MIXED */
    int32_t kt_constant; /* of hertz_mindlin: at any overlap, */
    int32_t kr_constant; /* and this one */
    int32_t reserved;
} se3di_pair;

static inline int se3di_pair_is_hertz(const se3di_pair *pair)
{
    return pair->law == SE3DI_LAW_HERTZ_MINDLIN;
}

/* The law of lanes with such pairs: what is apart from the two laws is mixed. */
static inline int32_t se3di_pair_lanes(const se3di_pair *pair)
{
    return pair->kt_constant || pair->kr_constant ? (int32_t)SE3DI_LAW_MIXED : pair->law;
}

/* What kt is multiplied by: s of the law, or nothing. */
static inline double se3di_pair_tangent(const se3di_pair *pair, double s)
{
    return pair->kt_constant ? 1.0 : s;
}

/* The tangential stiffness where that of the law is kt s. */
static inline double se3di_pair_kt(const se3di_pair *pair, double s)
{
    return pair->kt * se3di_pair_tangent(pair, s);
}

/* What kr is multiplied by, and, with the root of s, dr. */
static inline double se3di_pair_turn(const se3di_pair *pair, double s)
{
    return pair->kr_constant ? 1.0 : s;
}

/* The stiffness of rolling and torsion where that of the law is kr s. */
static inline double se3di_pair_kr(const se3di_pair *pair, double s)
{
    return pair->kr * se3di_pair_turn(pair, s);
}

#define SE3DI_PAIR_SIZE 11 /* doubles in an se3di_pair that forces need, but rn and rt */

typedef struct se3di_contact_settings {
    int32_t law; /* se3di_contact_law */
    int32_t reserved;
    double step;          /* [s]; 0: automatic */
    double overlap_limit; /* of the smaller radius */
    se3d_contact_callback callback;
    void *ctx;
} se3di_contact_settings;

/* What a kind of shape is, for those who treat some kinds in a way of their own. */
#define SE3DI_SHAPE_IS_BALL       1u  /* looks the same from all sides of its origin */
#define SE3DI_SHAPE_IS_ROUND      2u  /* bends with `radius` where it is touched */
#define SE3DI_SHAPE_IS_SWEPT      4u  /* all within `radius` of a core: a point or a line along z */
#define SE3DI_SHAPE_HAS_RIMS      8u  /* two circles with `radius` at its ends along z */
#define SE3DI_SHAPE_IS_SURFACE    16u /* triangles with two sides, and nothing between them */
#define SE3DI_SHAPE_IS_HALF_SPACE 32u /* all that is below z = 0: without end */
#define SE3DI_SHAPE_IS_TURNED     64u /* a surface about z that particles know without triangles */
#define SE3DI_SHAPE_IS_SMOOTH     128u /* bends everywhere: what is convex touches it in a point */

/* The kinds of shapes, X(KIND, name, traits): each has a se3di_shape_class_<name> in the file of
 * this name in lib/contact/shape, and a SE3D_SHAPE_<KIND>. New ones go to the end. */
#define SE3DI_SHAPE_LIST(X)                                                                        \
    X(SPHERE, sphere, SE3DI_SHAPE_IS_BALL | SE3DI_SHAPE_IS_ROUND | SE3DI_SHAPE_IS_SWEPT)           \
    X(BOX, box, 0u)                                                                                \
    X(CAPSULE, capsule, SE3DI_SHAPE_IS_ROUND | SE3DI_SHAPE_IS_SWEPT)                               \
    X(CYLINDER, cylinder, SE3DI_SHAPE_IS_ROUND | SE3DI_SHAPE_HAS_RIMS)                             \
    X(PLANE, plane, SE3DI_SHAPE_IS_HALF_SPACE)                                                     \
    X(MESH, mesh, SE3DI_SHAPE_IS_SURFACE)                                                          \
    X(HULL, hull, 0u)                                                                              \
    X(HEIGHTFIELD, heightfield, SE3DI_SHAPE_IS_SURFACE)                                            \
    X(FUNNEL, funnel, SE3DI_SHAPE_IS_SURFACE | SE3DI_SHAPE_IS_TURNED)                              \
    X(ELLIPSOID, ellipsoid, SE3DI_SHAPE_IS_ROUND | SE3DI_SHAPE_IS_SMOOTH)

typedef enum se3di_shape_kind {
#define SE3DI_SHAPE_ENUM(KIND, name, traits) SE3DI_SHAPE_##KIND,
    SE3DI_SHAPE_LIST(SE3DI_SHAPE_ENUM)
#undef SE3DI_SHAPE_ENUM
        SE3DI_SHAPE_COUNT
} se3di_shape_kind;

typedef struct se3di_shape {
    char *name; /* NULL: none */
    int32_t kind;
    uint32_t body;
    int32_t material; /* -1: nothing touches it */
    uint32_t group, mask;
    uint32_t users;
    double x[3];                /* origin, body frame */
    double A[9];                /* shape -> body, row-major */
    double p[4];                /* the same as Euler parameters */
    double half[3];             /* box: half lengths; ellipsoid: semi-axes */
    double radius, half_length; /* round ones, along z; capsule: of its cylinder; ellipsoid: R* */
    double top_radius;          /* funnel, at z = half_length; `radius` is that at the other end */
    double bound;               /* radius about the origin that holds it; infinite: plane */
    double *vertices;           /* mesh, hull, heightfield, funnel: [3 * vertex_count], own frame */
    uint32_t *triangles;        /* [3 * triangle_count]; hull: its faces, seen from outside */
    double *planes; /* hull: [4 * triangle_count], unit normals and offsets of its faces */
    size_t vertex_count, triangle_count;
    void *tree; /* mesh: bounding volumes, see contact/shape/mesh.h */
    size_t tree_bytes;
    struct se3di_shape *pieces; /* mesh: hulls that make it up, see contact/shape/pieces.h */
    size_t piece_count;         /* 0: it is open or convex, or they would be too many */
    int32_t closed; /* mesh: 1 with its triangles counter-clockwise seen from outside, -1 clockwise,
                       0 open or not of one sense */
    int32_t convex; /* mesh: closed, and the hull of its vertices */
    int32_t oriented; /* mesh: in one piece, its triangles of one sense */
    int32_t reserved;
    uint32_t rows, columns; /* heightfield: of heights, see contact/shape/grid.h; else 0 */
    double spacing[2];      /* of its columns (along x) and rows (along y) */
    /* its surface moves on the body: at its origin; about it; body frame */
    double surface_velocity[3], surface_spin[3];
    double force[3], torque[3]; /* of bodies, on its body about the centre of mass, last accepted */
} se3di_shape;

/* Whether materials, groups and masks let two shapes touch. */
static inline int se3di_shapes_meet(const se3di_shape *a, const se3di_shape *b)
{
    return a->material >= 0 && b->material >= 0 && (a->group & b->mask) && (b->group & a->mask);
}

/* Whether a shape is of a kind with one of these traits. Of a constant the compiler makes a mask of
 * kinds, so that it costs as much as to compare the kind. */
static inline int se3di_shape_is(const se3di_shape *shape, uint32_t traits)
{
#define SE3DI_SHAPE_MASK(KIND, name, has) | (((has)&traits) != 0) << SE3DI_SHAPE_##KIND
    const uint32_t kinds = (uint32_t)(0 SE3DI_SHAPE_LIST(SE3DI_SHAPE_MASK));
#undef SE3DI_SHAPE_MASK
    return (int)(kinds >> shape->kind & 1u);
}

#endif
