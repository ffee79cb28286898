/* SPDX-License-Identifier: BSD-3-Clause */
/* Heights over a grid: touched as the mesh of the same triangles is, found by cells; balls roll in
 * a trough as the closed form says; the same in a model file by numbers, a CSV file, an
 * expression. */
#include "contact/narrow/narrow.h"
#include "contact/shape/mesh.h"
#include "contact/shape/shape.h"
#include "math/quaternion.h"
#include "math/vec3.h"
#include "se3d/io.h"
#include "support/scene.h"

#define ROWS    9
#define COLUMNS 12
#define FACES   (2 * (ROWS - 1) * (COLUMNS - 1))

static const double spacing[2] = {0.2, 0.25};

/* Heights, and the same as points and triangles. */
typedef struct terrain {
    double heights[ROWS * COLUMNS], points[3 * ROWS * COLUMNS];
    uint32_t faces[3 * FACES];
} terrain;

static void fill(double amplitude, terrain *t)
{
    uint32_t *face = t->faces;
    for (uint32_t k = 0; k < ROWS * COLUMNS; ++k) {
        double *p = t->points + 3 * (size_t)k;
        p[0] = ((double)(k % COLUMNS) - 0.5 * (COLUMNS - 1)) * spacing[0];
        p[1] = ((double)(k / COLUMNS) - 0.5 * (ROWS - 1)) * spacing[1];
        p[2] = t->heights[k] = amplitude * sin(3.0 * p[0]) * cos(2.0 * p[1]);
    }
    for (uint32_t c = 0; c < (ROWS - 1) * (COLUMNS - 1); ++c, face += 6) {
        const uint32_t a = c / (COLUMNS - 1) * COLUMNS + c % (COLUMNS - 1), b = a + COLUMNS;
        const uint32_t cell[6] = {a, a + 1, b + 1, a, b + 1, b};
        memcpy(face, cell, sizeof cell);
    }
}

static void set_heights(const double *heights, size_t rows, size_t columns, se3d_shape_def *def)
{
    def->heights = heights;
    def->row_count = rows;
    def->column_count = columns;
    memcpy(def->spacing, spacing, sizeof def->spacing);
}

static void define(int kind, const se3d_shape_def *def, se3di_shape *shape)
{
    const se3d_allocator allocator = se3di_alloc_default();
    se3di_error error = {0};
    memset(shape, 0, sizeof *shape);
    shape->kind = kind;
    CHECK(se3di_shape_define(def, &allocator, shape, &error) == SE3D_OK);
}

static void release(se3di_shape *shape)
{
    const se3d_allocator allocator = se3di_alloc_default();
    se3di_shape_release(&allocator, shape);
}

static void define_both(double amplitude, se3di_shape *field, se3di_shape *mesh)
{
    terrain t;
    se3d_shape_def def = se3d_shape_def_default();
    fill(amplitude, &t);
    set_heights(t.heights, ROWS, COLUMNS, &def);
    def.vertices = t.points;
    def.vertex_count = ROWS * COLUMNS;
    def.triangles = t.faces;
    def.triangle_count = FACES;
    define(SE3DI_SHAPE_HEIGHTFIELD, &def, field);
    define(SE3DI_SHAPE_MESH, &def, mesh);
}

static void place_randomly(uint64_t *seed, se3di_shape_pose *pose)
{
    double p[4];
    memset(pose, 0, sizeof *pose);
    for (int k = 0; k < 4; ++k) {
        p[k] = check_random(seed);
    }
    se3di_quat_normalize(p, p);
    se3di_quat_to_matrix(p, pose->R);
    pose->x[0] = 1.2 * check_random(seed);
    pose->x[1] = 1.1 * check_random(seed);
    pose->x[2] = 0.25 + 0.15 * check_random(seed);
}

/* The point of another manifold nearest to this one; -1: none. */
static int match(const se3di_contact_point *p, const se3di_manifold *other)
{
    int found = -1;
    double least = HUGE_VAL;
    for (uint32_t k = 0; k < other->count; ++k) {
        const se3di_contact_point *q = &other->points[k];
        double d[3], n[3];
        se3di_sub(p->point, q->point, d);
        se3di_sub(p->normal, q->normal, n);
        const double apart = se3di_norm(d) + se3di_norm(n) + fabs(p->overlap - q->overlap);
        if (apart < least) {
            least = apart;
            found = (int)k;
        }
    }
    return least < 1e-9 ? found : -1;
}

static double deepest(const se3di_manifold *m)
{
    double most = 0.0;
    for (uint32_t k = 0; k < m->count; ++k) {
        most = fmax(most, m->points[k].overlap);
    }
    return most;
}

static void solids_touch_heights_as_they_touch_the_same_mesh(void)
{
    static const double corners[24] = {-0.2, -0.2, -0.2, 0.2,  -0.2, -0.2, -0.2, 0.2,
                                       -0.2, 0.2,  0.2,  -0.2, -0.1, 0.0,  0.2,  0.1,
                                       0.0,  0.2,  0.0,  0.1,  0.2,  0.0,  -0.1, 0.2};
    static const int kinds[5] = {SE3DI_SHAPE_SPHERE, SE3DI_SHAPE_BOX, SE3DI_SHAPE_CAPSULE,
                                 SE3DI_SHAPE_CYLINDER, SE3DI_SHAPE_HULL};
    const se3di_shape_pose ground = {.R = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}};
    uint64_t seed = 5;
    int touched = 0;
    se3di_shape field, mesh, solid;
    define_both(0.15, &field, &mesh);
    CHECK(field.bound <= mesh.bound && field.bound >= mesh.bound);
    for (int trial = 0; trial < 1500; ++trial) {
        se3d_shape_def def = se3d_shape_def_default();
        se3di_shape_pose pose;
        se3di_manifold a, b;
        def.radius = 0.2;
        def.length = 0.3;
        def.size[0] = def.size[1] = def.size[2] = 0.3;
        def.vertices = corners;
        def.vertex_count = 8;
        define(kinds[trial % 5], &def, &solid);
        place_randomly(&seed, &pose);
        se3di_narrow_find(&solid, &pose, &field, &ground, &a);
        se3di_narrow_find(&solid, &pose, &mesh, &ground, &b);
        /* deep in many faces those count that are met first */
        const int is_deep = fmax(deepest(&a), deepest(&b)) > 0.03;
        CHECK(a.count == b.count || is_deep);
        for (uint32_t k = 0; k < a.count && !is_deep; ++k) {
            CHECK(match(&a.points[k], &b) >= 0);
        }
        touched += a.count > 0 && !is_deep;
        release(&solid);
    }
    CHECK(touched > 150);
    release(&field);
    release(&mesh);
}

static void note(void *ctx, uint32_t triangle)
{
    (void)triangle;
    ++*(int *)ctx;
}

static void places_near_and_far_are_found_as_in_the_same_mesh(void)
{
    uint64_t seed = 11;
    se3di_shape field, mesh;
    define_both(0.15, &field, &mesh);
    for (int trial = 0; trial < 2000; ++trial) {
        const double reach = trial % 4 == 0 ? 30.0 : 1.4;
        double x[3], to[3], at[2][3], distance[2];
        int count[2] = {0, 0};
        for (int k = 0; k < 3; ++k) {
            x[k] = reach * check_random(&seed);
            to[k] = check_random(&seed);
        }
        const double radius = 0.1 + 0.4 * fabs(check_random(&seed));
        (void)se3di_mesh_nearest(&field, x, at[0], &distance[0]);
        (void)se3di_mesh_nearest(&mesh, x, at[1], &distance[1]);
        CHECK_NEAR(distance[0], distance[1], 1e-14 * reach);
        se3di_mesh_visit(&field, x, radius, note, &count[0]);
        se3di_mesh_visit(&mesh, x, radius, note, &count[1]);
        CHECK(count[0] == count[1]);
        CHECK(se3di_mesh_crosses(&field, x, to) == se3di_mesh_crosses(&mesh, x, to));
        CHECK(se3di_mesh_is_clear(&field, x, radius) == se3di_mesh_is_clear(&mesh, x, radius));
    }
    release(&field);
    release(&mesh);
}

/* A ball of radius r that rolls in a trough with curvature 1/R at its bottom swings about it with
 * w^2 = 5/7 g / (R - r); small swings in a parabola. The facets are chords of it. */
static void a_ball_rolls_in_a_parabolic_trough_at_the_frequency_of_the_closed_form(void)
{
    enum { LINES = 401 };
    static const int32_t methods[2] = {SE3D_METHOD_CONVEX, SE3D_METHOD_VERLET};
    const double R = 1.0, r = 0.05, start = 0.04, w = sqrt(5.0 / 7.0 * G / (R - r));
    static double heights[2 * LINES];
    for (int k = 0; k < 2 * LINES; ++k) {
        const double x = (k % LINES - 0.5 * (LINES - 1)) * 5e-4;
        heights[k] = 0.5 * x * x / R;
    }
    for (int m = 0; m < 2; ++m) {
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 1.0, 0.2, 2e5);
        se3d_shape_def def = scene_shape(&s, scene_ground(&s));
        se3d_shape shape;
        const double at[3] = {start, 0.0, 0.5 * start * start / R + r / sqrt(1.0 - start * start)};
        double x[3];
        set_heights(heights, 2, LINES, &def);
        def.spacing[0] = 5e-4;
        def.spacing[1] = 2.0;
        CHECK(se3d_shape_create_heightfield(s.system, &def, &shape) == SE3D_OK);
        se3d_body ball = scene_ball(&s, r, 1.0, at, scene_zero);
        scene_solve(&s, methods[m], SE3D_FORMULATION_ROMEGA, m ? 0.0 : 5e-4, 0.0);
        CHECK(scene_run(&s, 0.5 * PI / w)); /* a quarter */
        CHECK(se3d_body_get_position(s.system, ball, x) == SE3D_OK);
        CHECK_NEAR(x[0], 0.0, 0.03 * start);
        CHECK(scene_run(&s, PI / w)); /* a half: on the other side */
        CHECK(se3d_body_get_position(s.system, ball, x) == SE3D_OK);
        CHECK_NEAR(x[0], -start, 0.05 * start);
        CHECK_NEAR(x[1], 0.0, 1e-9);
        scene_end(&s);
    }
}

/* On a body, which carries it along. */
static void heights_move_with_their_body(void)
{
    const double heights[4] = {0.0, 0.0, 0.0, 0.0}, size[3] = {0.1, 0.1, 0.1};
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.5, 0.2, 1e5);
    const double at[3] = {0.0, 0.0, 0.05}, below[3] = {0.0, 0.0, -1.0}, up[3] = {0.0, 0.0, 1.0};
    const double J[3] = {1.0, 1.0, 1.0}, no_gravity[3] = {0.0, 0.0, 0.0};
    double x[3];
    CHECK(se3d_system_set_gravity(s.system, no_gravity) == SE3D_OK);
    se3d_body cart = scene_body(&s, 1e6, J, below, up);
    se3d_shape_def def = scene_shape(&s, cart);
    se3d_shape shape;
    set_heights(heights, 2, 2, &def);
    CHECK(se3d_shape_create_heightfield(s.system, &def, &shape) == SE3D_OK);
    se3d_body box = scene_box(&s, size, 1.0, at, scene_zero);
    scene_solve(&s, SE3D_METHOD_VERLET, SE3D_FORMULATION_ROMEGA, 0.0, 0.0);
    CHECK(scene_run(&s, 1.5)); /* met at t = 1 s, restitution 0.2 */
    CHECK(se3d_body_get_position(s.system, box, x) == SE3D_OK);
    CHECK_NEAR(x[2], 0.05 + 1.2 * 0.5, 5e-3);
    scene_end(&s);
}

static const char text[] =
    "se3d: 1\n"
    "units: {length: mm}\n"
    "materials: [{name: stuff, density: 1e-6, stiffness: 100 N/mm}]\n"
    "contact: {law: hooke}\n"
    "bodies:\n"
    "  - name: ground\n"
    "    shapes:\n"
    "    - {type: heightfield, name: land, material: stuff, spacing: 1000, row_spacing: 500, %s}\n";

/* The height of the file's land under a place. */
static double land(const char *way, const char *message)
{
    char model_text[1200];
    se3d_model *model = NULL;
    se3d_model_error error = {0};
    double point[3] = {0.0, 0.0, -1.0}, normal[3], distance;
    const double place[3] = {0.5, 0.25, 3.0}; /* over the middle of a cell, on its diagonal */
    se3d_shape shape;
    se3d_model_shape seen;
    snprintf(model_text, sizeof model_text, text, way);
    const se3d_status status =
        se3d_model_read_text(model_text, strlen(model_text), "m", NULL, &model, &error);
    CHECK((status < 0) == (message != NULL));
    CHECK_CONTAINS(error.message, message ? message : "");
    if (status < 0) {
        return -1.0;
    }
    CHECK(se3d_model_get_shape(model, 0, &seen) == SE3D_OK && seen.type == SE3D_SHAPE_HEIGHTFIELD);
    CHECK(se3d_shape_find(se3d_model_get_system(model), "land", &shape) == SE3D_OK);
    CHECK(se3d_shape_get_nearest(se3d_model_get_system(model), shape, place, point, normal,
                                 &distance) == SE3D_OK);
    se3d_model_destroy(model);
    return point[2];
}

/* The message of what reading a table gives; NULL: it is read. */
static void try_table(const char *table, const char *message)
{
    FILE *file = fopen("heights.csv", "w");
    CHECK(file && fputs(table, file) >= 0 && fclose(file) == 0);
    (void)land("file: heights.csv", message);
    CHECK(remove("heights.csv") == 0);
}

/* Decimals with a comma would else be read as two numbers. */
static void a_table_has_one_separator(void)
{
    try_table("0; 1;2\n3;4 ;5\n", NULL);
    try_table("0 1\t2\n 3 4 5 \n", NULL);
    try_table("0,1;0,2\n0,1;0,2\n", "heights.csv:1: has `,` and `;`, must have one of them");
    try_table("0;2\n0;0,2\n", "heights.csv:2: has `,` and `;`, must have one of them");
    try_table("0;2\n0,2\n", "heights.csv:2: has `,` between numbers, must have `;`");
    try_table("0 2\n0,5 2\n", "heights.csv:2: has `,` between numbers, must have ` `");
    try_table("0,1 0,2\n0,1 0,2\n", "heights.csv:1: has a blank alone between numbers");
    try_table("0, 1\n0 1\n", "heights.csv:2: has a blank alone between numbers");
    try_table("0, 1\n0\n", "heights.csv:2: has 1 heights, must have 2");
}

/* Instances of a part share its text, not always what that says: by parameters, by the index, and
 * mirrored. Equal ones are the same. */
static void instances_of_a_part_have_heights_of_their_own(void)
{
    static const char model_text[] =
        "se3d: 1\n"
        "materials: [{name: stuff, density: 1000, stiffness: 1e5}]\n"
        "contact: {law: hooke}\n"
        "parts:\n"
        "  p:\n"
        "    parameters: {h: 0.1, s: 1}\n"
        "    bodies:\n"
        "    - {name: g, fixed: true, mass: 1, inertia: [1, 1, 1], shapes: [\n"
        "        {type: heightfield, material: stuff, spacing: s, rows: 3,\n"
        "         columns: 3, heights: h + 0.1*x}]}\n"
        "instances:\n"
        "- {part: p, prefix: 'a{i}_', repeat: 3, position: [0, 5*i, 0], parameters: {h: 0.2*i}}\n"
        "- {part: p, prefix: b_, position: [0, 15, 0], parameters: {s: 0.2}}\n"
        "- {part: p, prefix: m_, mirror: x, position: [0, 20, 0], parameters: {h: 0.5}}\n"
        "- {part: p, prefix: n_, mirror: x, position: [0, 25, 0], parameters: {h: 0.7}}\n";
    static const struct {
        double h, slope, end; /* its height over the middle, along x, largest x */
    } fields[] = {{0.0, 0.1, 1.0}, {0.2, 0.1, 1.0},  {0.4, 0.1, 1.0},
                  {0.1, 0.1, 0.2}, {0.5, -0.1, 1.0}, {0.7, -0.1, 1.0}};
    se3d_model *model = NULL;
    se3d_model_error error = {0};
    (void)se3d_model_read_text(model_text, strlen(model_text), "m", NULL, &model, &error);
    CHECK(model != NULL);
    if (!model) {
        fprintf(stderr, "%s\n", error.message);
    }
    for (size_t k = 0; model && k < sizeof fields / sizeof *fields; ++k) {
        const double beyond[3] = {9.0, 5.0 * (double)k, fields[k].h};
        double point[3], normal[3], distance;
        se3d_shape shape;
        se3d_system *system = se3d_model_get_system(model);
        CHECK(se3d_system_get_shape(system, k, &shape) == SE3D_OK);
        CHECK(se3d_shape_get_nearest(system, shape, beyond, point, normal, &distance) == SE3D_OK);
        CHECK_NEAR(point[0], fields[k].end, 1e-14);
        CHECK_NEAR(point[2], fields[k].h + fields[k].slope * fields[k].end, 1e-14);
    }
    se3d_model_destroy(model);
}

static void a_file_takes_heights_as_numbers_a_table_or_an_expression(void)
{
    FILE *file = fopen("heights.csv", "w");
    CHECK(file && fputs("# x ->\n0, 0,0\n\n0 , 400,400\r\n0,400,\t400", file) >= 0 &&
          fclose(file) == 0);
    CHECK_NEAR(land("heights: [[0, 0, 0], [0, 400, 0.4 m], [0, 400, 400]]", NULL), 0.4, 1e-15);
    CHECK_NEAR(land("file: heights.csv", NULL), 0.4, 1e-15);
    CHECK_NEAR(land("rows: 3, columns: 3, heights: 0.4 m", NULL), 0.4, 1e-15);
    CHECK_NEAR(land("rows: 3, columns: 3, heights: 399.5 + x/1000 + 0*y", NULL), 0.4, 1e-5);
    (void)land("rows: 3, columns: 3, heights: z", "z");
    (void)land("rows: 3, heights: x", "columns");
    (void)land("rows: 1, columns: 3, heights: x", "rows");
    (void)land("heights: [[0, 0, 0], [0, 0]]", "3");
    (void)land("heights: [[0, 0, 0]]", "at least two rows");
    (void)land("rows: 3, heights: [[0, 0], [0, 0]]", "is of an expression");
    (void)land("file: heights.csv, heights: [[0, 0], [0, 0]]", "exclude each other");
    (void)land("file: nothing.csv", "cannot be opened");
    (void)land("heights: {}", "must be a list of rows");
    (void)land("rows: 3, columns: 3, heights: 1/(x - 1)*1 m*0/0", "finite");
    (void)land("columns: 3", "is missing");
    file = fopen("heights.csv", "w");
    CHECK(file && fputs("0, 0, 0\n0, 1\n", file) >= 0 && fclose(file) == 0);
    (void)land("file: heights.csv", "heights.csv:2: has 2 heights, must have 3");
    file = fopen("heights.csv", "w");
    CHECK(file && fputs("0, 0,, 0\n0, 1\n", file) >= 0 && fclose(file) == 0);
    (void)land("file: heights.csv", "heights.csv:1: `` is not a number");
    CHECK(remove("heights.csv") == 0);
}

int main(void)
{
    RUN(solids_touch_heights_as_they_touch_the_same_mesh);
    RUN(places_near_and_far_are_found_as_in_the_same_mesh);
    RUN(a_ball_rolls_in_a_parabolic_trough_at_the_frequency_of_the_closed_form);
    RUN(heights_move_with_their_body);
    RUN(a_table_has_one_separator);
    RUN(instances_of_a_part_have_heights_of_their_own);
    RUN(a_file_takes_heights_as_numbers_a_table_or_an_expression);
    return check_finish();
}
