/* SPDX-License-Identifier: BSD-3-Clause */
/* The kinds of shapes of a model file, and its keys for them. Masses are those of solids of uniform
 * density whose centre is the origin, round ones about their z axis. */
#include "io/read/shape_kinds.h"

#include "io/document/fields.h"
#include "io/read/objects.h"

static const double pi = 3.14159265358979323846;

/* The kinds, X(KIND, name), in the order of the schema. */
#define KIND_LIST(X)                                                                               \
    X(SPHERE, sphere)                                                                              \
    X(BOX, box)                                                                                    \
    X(CAPSULE, capsule)                                                                            \
    X(CYLINDER, cylinder)                                                                          \
    X(PLANE, plane)                                                                                \
    X(MESH, mesh)                                                                                  \
    X(HEIGHTFIELD, heightfield)                                                                    \
    X(FUNNEL, funnel)                                                                              \
    X(ELLIPSOID, ellipsoid)

const char *const se3di_shape_styles[] = {[SE3DI_STYLE_PAINT] = "paint",
                                          [SE3DI_STYLE_STEEL] = "steel",
                                          [SE3DI_STYLE_RUBBER] = "rubber",
                                          [SE3DI_STYLE_GLASS] = "glass",
                                          [SE3DI_STYLE_SAND] = "sand",
                                          [SE3DI_STYLE_WIRE] = "wire",
                                          NULL};

const char *const se3di_shape_names[] = {
#define NAME(KIND, name) #name,
    KIND_LIST(NAME)
#undef NAME
        NULL};

const int32_t se3di_shape_types[] = {
#define TYPE(KIND, name) SE3D_SHAPE_##KIND,
    KIND_LIST(TYPE)
#undef TYPE
};

/* clang-format off */
static const se3di_key shape_keys[] = {
    {"name", SE3DI_KIND_NAME, .text = "for lists of contacts"},
    {"group", SE3DI_KIND_COUNT, .most = 4294967295.0, .standard = "1",
     .text = "bits: a and b touch if a.group & b.mask and b.group & a.mask are not zero"},
    {"mask", SE3DI_KIND_COUNT, .most = 4294967295.0, .standard = "4294967295, all groups",
     .text = "see group"},
    {"contact", SE3DI_KIND_BOOL, .standard = "true",
     .text = "false: nothing touches it, though it has a material"},
    {"type", SE3DI_KIND_TYPE, .required = true, .text = ""},
    {"size", SE3DI_KIND_VECTOR, .types = " box ", .text = "its edges [m], each > 0"},
    {"semi_axes", SE3DI_KIND_VECTOR, .types = " ellipsoid ",
     .text = "along its x, y, z [m], each > 0"},
    {"radius", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, .types = " sphere capsule cylinder ",
     .text = "[m]"},
    {"bottom_radius", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE, .types = " funnel ",
     .text = "at its lower end along z [m]; 0: a cone with its tip down"},
    {"top_radius", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE, .types = " funnel ",
     .text = "at its upper end [m]; 0: a cone with its tip up, as bottom_radius: a tube"},
    {"length", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, .types = " capsule cylinder funnel ",
     .text = "along its z [m]; of a capsule between the centres of its ends"},
    {"file", SE3DI_KIND_TEXT, .types = " mesh ",
     .text = "STL (binary, ASCII) or OBJ, relative to the model file"},
    {"file", SE3DI_KIND_TEXT, .types = " heightfield ",
     .text = "CSV, in place of heights: a row on each line, relative to the model file"},
    {"heights", SE3DI_KIND_HEIGHTS, .types = " heightfield ",
     .text = "along its z [m]: rows along x, one after the other along y; an expression in x and y "
             "needs rows and columns"},
    {"rows", SE3DI_KIND_COUNT, .most = 1000000.0, .types = " heightfield ",
     .text = "how many, of an expression"},
    {"columns", SE3DI_KIND_COUNT, .most = 1000000.0, .types = " heightfield ",
     .text = "how many, of an expression"},
    {"spacing", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, .types = " heightfield ",
     .text = "between columns, along x [m]; the origin is in the middle of the grid"},
    {"row_spacing", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, .types = " heightfield ",
     .standard = "spacing", .text = "between rows, along y [m]"},
    {"scale", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3d_model_shape, scale),
     .types = " mesh ", .standard = "1", .text = "factor, to metres"},
    {"convex", SE3DI_KIND_BOOL, SE3DI_INTO(se3di_shape_entry, convex), .types = " mesh ",
     .standard = "false", .text = "its convex hull touches in its place, also meshes"},
    {"normal", SE3DI_KIND_DIRECTION, .types = " plane ", .standard = "[0, 0, 1]",
     .text = "in place of an orientation"},
    {"density", SE3DI_KIND_NUMBER, SE3DI_POSITIVE,
     .types = " sphere box capsule cylinder mesh ellipsoid ",
     .text = "[kg/m^3], for bodies without mass; a mesh must be closed"},
    {"material", SE3DI_KIND_MATERIAL,
     .text = "if there is contact or particles, what has one touches"},
    {"surface_velocity", SE3DI_KIND_VECTOR, .standard = "[0, 0, 0]",
     .text = "of the surface on its body, as that of a belt, body frame [m/s]"},
    {"surface_spin", SE3DI_KIND_VECTOR, .standard = "[0, 0, 0]",
     .text = "how the surface turns on its body about the shape's centre, body frame [rad/s]"},
    {"position", SE3DI_KIND_VECTOR, SE3DI_INTO(se3d_model_shape, position),
     .standard = "[0, 0, 0]", .text = "centre, body frame [m]"},
    {"orientation", SE3DI_KIND_ORIENTATION, SE3DI_INTO(se3d_model_shape, orientation),
     .standard = "that of the body", .text = "shape -> body"},
    {"color", SE3DI_KIND_COLOR, .standard = "that of the body",
     .text = "red, green, blue and, of what is seen through, opacity: each 0 to 1, as on a screen"},
    {"style", SE3DI_KIND_WORD, SE3DI_INTO(se3di_shape_entry, style), .words = se3di_shape_styles,
     .standard = "paint", .text = "what it looks made of; wire: its edges alone"},
    {.key = NULL}};
const se3di_object se3di_object_shape = {
    "shape",
    "What a body looks like, weighs and touches with.",
    shape_keys, se3di_shape_names,
    NULL};
/* clang-format on */

static void set(double out[3], double a, double b, double c)
{
    out[0] = a;
    out[1] = b;
    out[2] = c;
}

static se3di_look look_of(se3di_look_unit unit, double a, double b, double c)
{
    const se3di_look look = {unit, 0.0, {a, b, c}, 1.0};
    return look;
}

static double ball_mass(const se3d_model_shape *s, double density)
{
    return density * 4.0 / 3.0 * pi * (s->radius * s->radius) * s->radius;
}

static double tube_mass(const se3d_model_shape *s, double density)
{
    return density * pi * (s->radius * s->radius) * s->length;
}

static double tube_inertia(const se3d_model_shape *s, double mass)
{
    return mass * (3.0 * (s->radius * s->radius) + s->length * s->length) / 12.0;
}

static void weigh_sphere(const se3d_model_shape *s, double density, double *mass, double J[3])
{
    const double about = 0.4 * ball_mass(s, density) * (s->radius * s->radius);
    *mass = ball_mass(s, density);
    set(J, about, about, about);
}

static void enclose_sphere(const se3d_model_shape *s, double half[3])
{
    set(half, s->radius, s->radius, s->radius);
}

static int draw_sphere(const se3d_model_shape *s, double extent, se3di_look looks[SE3DI_LOOKS])
{
    (void)extent;
    looks[0] = look_of(SE3DI_LOOK_SPHERE, s->radius, s->radius, s->radius);
    return 1;
}

static void weigh_box(const se3d_model_shape *s, double density, double *mass, double J[3])
{
    const double *size = s->size;
    const double part = density * size[0] * size[1] * size[2] / 12.0;
    *mass = 12.0 * part;
    set(J, part * (size[1] * size[1] + size[2] * size[2]),
        part * (size[2] * size[2] + size[0] * size[0]),
        part * (size[0] * size[0] + size[1] * size[1]));
}

static void enclose_box(const se3d_model_shape *s, double half[3])
{
    set(half, 0.5 * s->size[0], 0.5 * s->size[1], 0.5 * s->size[2]);
}

static int draw_box(const se3d_model_shape *s, double extent, se3di_look looks[SE3DI_LOOKS])
{
    (void)extent;
    looks[0] = look_of(SE3DI_LOOK_BOX, s->size[0], s->size[1], s->size[2]);
    return 1;
}

/* A hemisphere's centre of mass is 3/8 r from its flat face. */
static void weigh_capsule(const se3d_model_shape *s, double density, double *mass, double J[3])
{
    const double r2 = s->radius * s->radius;
    const double ball = ball_mass(s, density);
    const double tube = tube_mass(s, density);
    const double across = tube_inertia(s, tube);
    const double end =
        ball * (0.4 * r2 + 0.25 * s->length * s->length + 0.375 * s->length * s->radius);
    *mass = tube + ball;
    set(J, across + end, across + end, 0.5 * tube * r2 + 0.4 * ball * r2);
}

static void enclose_capsule(const se3d_model_shape *s, double half[3])
{
    set(half, s->radius, s->radius, 0.5 * s->length + s->radius);
}

static int draw_capsule(const se3d_model_shape *s, double extent, se3di_look looks[SE3DI_LOOKS])
{
    (void)extent;
    looks[0] = look_of(SE3DI_LOOK_CYLINDER, s->radius, s->radius, s->length);
    looks[1] = looks[2] = look_of(SE3DI_LOOK_SPHERE, s->radius, s->radius, s->radius);
    looks[1].z = -0.5 * s->length;
    looks[2].z = 0.5 * s->length;
    return 3;
}

static void weigh_cylinder(const se3d_model_shape *s, double density, double *mass, double J[3])
{
    const double across = tube_inertia(s, tube_mass(s, density));
    *mass = tube_mass(s, density);
    set(J, across, across, 0.5 * *mass * (s->radius * s->radius));
}

static void enclose_cylinder(const se3d_model_shape *s, double half[3])
{
    set(half, s->radius, s->radius, 0.5 * s->length);
}

static int draw_cylinder(const se3d_model_shape *s, double extent, se3di_look looks[SE3DI_LOOKS])
{
    (void)extent;
    looks[0] = look_of(SE3DI_LOOK_CYLINDER, s->radius, s->radius, s->length);
    return 1;
}

static void weigh_ellipsoid(const se3d_model_shape *s, double density, double *mass, double J[3])
{
    const double *e = s->semi_axes;
    *mass = density * 4.0 / 3.0 * pi * e[0] * e[1] * e[2];
    for (int a = 0; a < 3; ++a) {
        const double b = e[(a + 1) % 3], c = e[(a + 2) % 3];
        J[a] = 0.2 * *mass * (b * b + c * c);
    }
}

static void enclose_ellipsoid(const se3d_model_shape *s, double half[3])
{
    set(half, s->semi_axes[0], s->semi_axes[1], s->semi_axes[2]);
}

static int draw_ellipsoid(const se3d_model_shape *s, double extent, se3di_look looks[SE3DI_LOOKS])
{
    (void)extent;
    looks[0] = look_of(SE3DI_LOOK_SPHERE, s->semi_axes[0], s->semi_axes[1], s->semi_axes[2]);
    return 1;
}

static void enclose_funnel(const se3d_model_shape *s, double half[3])
{
    const double wide = s->bottom_radius > s->top_radius ? s->bottom_radius : s->top_radius;
    set(half, wide, wide, 0.5 * s->length);
}

static int draw_plane(const se3d_model_shape *s, double extent, se3di_look looks[SE3DI_LOOKS])
{
    (void)s;
    looks[0] = look_of(SE3DI_LOOK_BOX, 4.0 * extent, 4.0 * extent, 0.002 * extent);
    looks[0].opacity = 0.4;
    return 1;
}

static const se3di_shape_row rows[] = {
    [SE3D_SHAPE_SPHERE] = {.create = se3d_shape_create_sphere,
                           .keys = SE3DI_SHAPE_NEEDS_RADIUS,
                           .weigh = weigh_sphere,
                           .enclose = enclose_sphere,
                           .draw = draw_sphere},
    [SE3D_SHAPE_BOX] = {.create = se3d_shape_create_box,
                        .keys = SE3DI_SHAPE_NEEDS_SIZE,
                        .weigh = weigh_box,
                        .enclose = enclose_box,
                        .draw = draw_box},
    [SE3D_SHAPE_CAPSULE] = {.create = se3d_shape_create_capsule,
                            .keys = SE3DI_SHAPE_NEEDS_RADIUS | SE3DI_SHAPE_NEEDS_LENGTH,
                            .weigh = weigh_capsule,
                            .enclose = enclose_capsule,
                            .draw = draw_capsule},
    [SE3D_SHAPE_CYLINDER] = {.create = se3d_shape_create_cylinder,
                             .keys = SE3DI_SHAPE_NEEDS_RADIUS | SE3DI_SHAPE_NEEDS_LENGTH,
                             .weigh = weigh_cylinder,
                             .enclose = enclose_cylinder,
                             .draw = draw_cylinder},
    [SE3D_SHAPE_PLANE] = {.create = se3d_shape_create_plane,
                          .keys = SE3DI_SHAPE_HAS_NORMAL,
                          .draw = draw_plane},
    [SE3D_SHAPE_MESH] = {.create = se3d_shape_create_mesh, .keys = SE3DI_SHAPE_NEEDS_FILE},
    [SE3D_SHAPE_HEIGHTFIELD] = {.create = se3d_shape_create_heightfield,
                                .keys = SE3DI_SHAPE_HAS_HEIGHTS},
    [SE3D_SHAPE_FUNNEL] = {.create = se3d_shape_create_funnel,
                           .keys = SE3DI_SHAPE_NEEDS_LENGTH | SE3DI_SHAPE_NEEDS_ENDS,
                           .enclose = enclose_funnel},
    [SE3D_SHAPE_ELLIPSOID] = {.create = se3d_shape_create_ellipsoid,
                              .keys = SE3DI_SHAPE_NEEDS_AXES,
                              .weigh = weigh_ellipsoid,
                              .enclose = enclose_ellipsoid,
                              .draw = draw_ellipsoid},
};

const se3di_shape_row *se3di_shape_row_of(const se3d_model_shape *shape)
{
    return &rows[shape->type];
}
