/* SPDX-License-Identifier: BSD-3-Clause */
/* Driven mechanisms against closed forms (tests/data/README.md): every column to 1e-9 of its
 * largest value, over the whole range, in both formulations, with joints that leave no equation
 * over and with plain revolutes, whose equations are redundant in a plane. The references are
 * exact; what is allowed is rounding, enlarged by the condition of the mechanisms (about 1e3). */
#include "support/mechanisms.h"

#define COLUMNS_MAX 96
#define ROWS_MAX    128
#define TOLERANCE   1e-9

typedef struct table {
    char text[4096];
    const char *names[COLUMNS_MAX];
    double values[ROWS_MAX][COLUMNS_MAX];
    double largest[COLUMNS_MAX];
    int seen[COLUMNS_MAX];
    int columns, rows, row;
} table;

static table reference;

static void read_names(FILE *file)
{
    CHECK(fgets(reference.text, sizeof reference.text, file) != NULL);
    for (char *name = strtok(reference.text, ",\r\n"); name && reference.columns < COLUMNS_MAX;
         name = strtok(NULL, ",\r\n")) {
        reference.names[reference.columns++] = name;
    }
}

/* A table without rows makes the tests that use it fail. */
static void read_table(const char *path)
{
    static char line[16384];
    FILE *file = fopen(path, "r");
    memset(&reference, 0, sizeof reference);
    CHECK(file != NULL);
    if (!file) {
        return;
    }
    read_names(file);
    while (reference.rows < ROWS_MAX && fgets(line, sizeof line, file)) {
        char *end = line;
        for (int k = 0; k < reference.columns; ++k) {
            double value = strtod(end, &end);
            end += *end == ',';
            reference.values[reference.rows][k] = value;
            reference.largest[k] = fmax(reference.largest[k], fabs(value));
        }
        ++reference.rows;
    }
    CHECK(reference.rows > 50 && reference.rows < ROWS_MAX);
    fclose(file);
}

static int find_column(const char *name)
{
    for (int k = 0; k < reference.columns; ++k) {
        if (strcmp(reference.names[k], name) == 0) {
            return k;
        }
    }
    fprintf(stderr, "no column %s\n", name);
    CHECK(0);
    return 0;
}

/* Columns that are zero throughout are held to 1e-9 of their unit. */
static void expect(const char *name, double value)
{
    int k = find_column(name);
    double scale = reference.largest[k] > 1e-12 ? reference.largest[k] : 1.0;
    double expected = reference.values[reference.row][k];
    reference.seen[k] = 1;
    if (!(fabs(value - expected) <= TOLERANCE * scale)) {
        fprintf(stderr, "row %d, column %s: ", reference.row, name);
    }
    CHECK_NEAR(value, expected, TOLERANCE * scale);
}

static void expect_angle(const char *name, double value)
{
    double expected = reference.values[reference.row][find_column(name)];
    expect(name, value + 2.0 * PI * nearbyint((expected - value) / (2.0 * PI)));
}

static void expect_vector(const char *prefix, const char *suffixes, const double *value)
{
    for (int k = 0; k < 3; ++k) {
        char name[32];
        snprintf(name, sizeof name, "%s%c", prefix, suffixes[k]);
        expect(name, value[k]);
    }
}

/* Every column but the time was compared. */
static void expect_all_seen(void)
{
    for (int k = 1; k < reference.columns; ++k) {
        if (!reference.seen[k]) {
            fprintf(stderr, "column %s was not compared\n", reference.names[k]);
        }
        CHECK(reference.seen[k]);
    }
}

/* Run to the time of a row; the positive status tells whether equations are redundant. */
static void run_to_row(world *w, int row, se3d_status expected)
{
    reference.row = row;
    se3d_status status = se3d_solver_run(w->solver, reference.values[row][0]);
    MUST(w, status);
    CHECK(status == expected);
}

/* ---- Haug's spatial slider-crank: revolute, spherical, universal, prismatic ---- */

typedef struct spatial {
    world w;
    se3d_body body[3]; /* crank, rod, slider */
    se3d_constraint A, B, C, D, driver;
} spatial;

static se3d_body add_spatial_body(world *w, int k, double mass, const double J[3])
{
    se3d_body body;
    se3d_body_def def = se3d_body_def_default();
    static const char *const names[3] = {"crank", "rod", "slider"};
    char column[16];
    snprintf(column, sizeof column, "b%d_x", k + 1);
    const double *row = reference.values[0] + find_column(column);
    def.name = names[k];
    def.mass = mass;
    memcpy(def.inertia, J, 3 * sizeof *J);
    memcpy(def.position, row, sizeof def.position);
    memcpy(def.orientation, row + 3, sizeof def.orientation);
    MUST(w, se3d_body_create(w->system, &def, &body));
    return body;
}

static se3d_constraint add_rod_end(world *w, se3d_body slider, se3d_body rod)
{
    se3d_constraint joint;
    se3d_joint_def def = se3d_joint_def_default();
    def.name = "C";
    def.body_i = slider;
    def.body_j = rod;
    def.point_j[0] = 0.15;
    def.axis_i[2] = 1.0; /* the slider's z axis is the global x axis */
    def.axis_j[1] = 1.0;
    def.axis_j[2] = 0.0;
    MUST(w, se3d_joint_create_universal(w->system, &def, &joint));
    return joint;
}

static spatial create_spatial(void)
{
    const double gravity[3] = {0.0, 0.0, -9.81};
    const double J[3][3] = {{1e-4, 1e-5, 1e-4}, {4e-3, 4e-4, 4e-3}, {1e-4, 1e-4, 1e-4}};
    const double x[3] = {1.0, 0.0, 0.0};
    const double pivot[3] = {0.0, 0.1, 0.12};
    const double pin[3] = {0.0, 0.08, 0.0};
    const double end[3] = {-0.15, 0.0, 0.0};
    const double slide[3] = {0.2, 0.0, 0.0};
    spatial s = {.w = world_create()};
    world *w = &s.w;
    MUST(w, se3d_system_set_gravity(w->system, gravity));
    s.body[0] = add_spatial_body(w, 0, 0.12, J[0]);
    s.body[1] = add_spatial_body(w, 1, 0.5, J[1]);
    s.body[2] = add_spatial_body(w, 2, 2.0, J[2]);
    s.A = add_joint(w, se3d_joint_create_revolute, "A", w->ground, s.body[0], pivot, x);
    s.B = add_local(w, se3d_joint_create_spherical, "B", s.body[0], pin, s.body[1], end);
    s.C = add_rod_end(w, s.body[2], s.body[1]);
    s.D = add_joint(w, se3d_joint_create_prismatic, "D", w->ground, s.body[2], slide, x);
    s.driver = add_driver(w, "drive", s.A, SE3D_JOINT_COORDINATE_ANGLE, "-2*pi*t");
    return s;
}

static void expect_orientation(const char *body, const double p[4])
{
    char name[32];
    double dot = 0.0;
    for (int k = 0; k < 4; ++k) {
        snprintf(name, sizeof name, "%s_e%d", body, k);
        dot += p[k] * reference.values[reference.row][find_column(name)];
    }
    for (int k = 0; k < 4; ++k) {
        snprintf(name, sizeof name, "%s_e%d", body, k);
        expect(name, dot < 0.0 ? -p[k] : p[k]);
    }
}

/* Turn a vector of the body frame into the ground frame. */
static void to_ground(const spatial *s, int k, const double r[3], double v[3])
{
    double tip[3];
    MUST(&s->w, se3d_body_get_point(s->w.system, s->body[k], v, tip));
    for (int c = 0; c < 3; ++c) {
        v[c] = tip[c] - r[c];
    }
}

static void expect_body(const spatial *s, int k)
{
    const se3d_system *system = s->w.system;
    double r[3], p[4], v[3], w[3], a[3], alpha[3];
    static const char *const prefix[3][5] = {{"b1_", "b1_v", "b1_w", "b1_a", "b1_al"},
                                             {"b2_", "b2_v", "b2_w", "b2_a", "b2_al"},
                                             {"b3_", "b3_v", "b3_w", "b3_a", "b3_al"}};
    static const char *const body[3] = {"b1", "b2", "b3"};
    MUST(&s->w, se3d_body_get_position(system, s->body[k], r));
    MUST(&s->w, se3d_body_get_orientation(system, s->body[k], p));
    MUST(&s->w, se3d_body_get_velocity(system, s->body[k], v));
    MUST(&s->w, se3d_body_get_angular_velocity(system, s->body[k], w));
    MUST(&s->w, se3d_body_get_acceleration(system, s->body[k], a));
    MUST(&s->w, se3d_body_get_angular_acceleration(system, s->body[k], alpha));
    to_ground(s, k, r, w);
    to_ground(s, k, r, alpha);
    expect_vector(prefix[k][0], "xyz", r);
    expect_orientation(body[k], p);
    expect_vector(prefix[k][1], "xyz", v);
    expect_vector(prefix[k][2], "xyz", w);
    expect_vector(prefix[k][3], "xyz", a);
    expect_vector(prefix[k][4], "xyz", alpha);
}

static void expect_spatial_reactions(const spatial *s)
{
    const se3d_system *system = s->w.system;
    double F[3], T[3], effort, phi, rate, acceleration;
    MUST(&s->w, se3d_constraint_get_reaction(system, s->A, F, T));
    expect_vector("RA", "xyz", F);
    expect("MAy", T[1]);
    expect("MAz", T[2]);
    MUST(&s->w, se3d_constraint_get_reaction(system, s->B, F, T));
    expect_vector("RB", "xyz", F);
    CHECK_NEAR(fabs(T[0]) + fabs(T[1]) + fabs(T[2]), 0.0, 1e-12);
    MUST(&s->w, se3d_constraint_get_reaction(system, s->C, F, T));
    expect_vector("RC", "xyz", F);
    expect_vector("MC", "xyz", T);
    MUST(&s->w, se3d_constraint_get_reaction(system, s->D, F, T));
    expect_vector("RD", "xyz", F);
    expect_vector("MD", "xyz", T);
    MUST(&s->w, se3d_driver_get_effort(system, s->driver, &effort));
    expect("Tdrv_x", effort);
    MUST(&s->w, se3d_joint_get_coordinate(system, s->A, SE3D_JOINT_COORDINATE_ANGLE, &phi, &rate,
                                          &acceleration));
    expect("phi", phi);
    double power = effort * rate;
    expect("Tdrv_power", power / rate); /* the torque that the energy balance gives */
}

static void spatial_slider_crank_agrees_in_every_column(void)
{
    for (int f = 0; f < 2; ++f) {
        read_table("tests/data/spatial_slider_crank_driven.csv");
        spatial s = create_spatial();
        use_solver(&s.w, SE3D_ANALYSIS_INVERSE_DYNAMICS, (se3d_formulation)f);
        for (int row = 0; row < reference.rows; ++row) {
            run_to_row(&s.w, row, SE3D_OK);
            for (int k = 0; k < 3; ++k) {
                expect_body(&s, k);
            }
            expect_spatial_reactions(&s);
        }
        expect_all_seen();
        world_destroy(&s.w);
    }
}

/* ---- planar slider-crank ---- */

typedef struct crank_drive {
    world w;
    se3d_body slider;
    se3d_constraint O, B, C, guide, driver;
} crank_drive;

/* `closing` joins rod and slider: point_on_line leaves no equation over, revolute does three. */
static crank_drive create_slider_crank(joint_create closing)
{
    crank_drive s = {.w = world_create()};
    world *w = &s.w;
    const double origin[2] = {0.0, 0.0};
    const double pin[2] = {0.2, 0.0};
    const double end[3] = {0.7, 0.0, 0.0};
    const double x[3] = {1.0, 0.0, 0.0};
    const double z[3] = {0.0, 0.0, 1.0};
    se3d_body crank = add_bar(w, "crank", origin, 0.0, 0.2, 1.0);
    se3d_body rod = add_bar(w, "rod", pin, 0.0, 0.5, 2.0);
    const double before[2] = {0.6, 0.0}; /* centre of mass at the pin */
    s.slider = add_bar(w, "slider", before, 0.0, 0.2, 3.0);
    s.O = add_pin(w, "O", w->ground, crank, 0.0, 0.0);
    s.B = add_pin(w, "B", crank, rod, 0.2, 0.0);
    s.C = add_joint(w, closing, "C", s.slider, rod, end, z);
    s.guide = add_joint(w, se3d_joint_create_prismatic, "guide", w->ground, s.slider, end, x);
    s.driver = add_driver(w, "motor", s.O, SE3D_JOINT_COORDINATE_ANGLE, "10*t");
    return s;
}

static void expect_slider_crank(const crank_drive *s)
{
    const se3d_system *system = s->w.system;
    double r[3], F[3], T[3], effort, theta, rate, acceleration;
    MUST(&s->w, se3d_body_get_position(system, s->slider, r));
    expect("slider_x", r[0]);
    MUST(&s->w, se3d_joint_get_coordinate(system, s->O, SE3D_JOINT_COORDINATE_ANGLE, &theta, &rate,
                                          &acceleration));
    expect("theta", theta); /* counts turns */
    MUST(&s->w, se3d_driver_get_effort(system, s->driver, &effort));
    expect("motor_torque", effort);
    MUST(&s->w, se3d_constraint_get_reaction(system, s->O, F, T));
    expect("FOx_ground_on_crank", F[0]);
    expect("FOy", F[1]);
    MUST(&s->w, se3d_constraint_get_reaction(system, s->B, F, T));
    expect("FBx_crank_on_rod", F[0]);
    expect("FBy", F[1]);
    MUST(&s->w, se3d_constraint_get_reaction(system, s->C, F, T));
    expect("FCx_slider_on_rod", F[0]);
    expect("FCy", F[1]);
    MUST(&s->w, se3d_constraint_get_reaction(system, s->guide, F, T));
    expect("N_ground_on_slider", F[1]);
    CHECK_NEAR(F[2], 0.0, 1e-8);
}

static void run_slider_crank(joint_create closing, se3d_status expected)
{
    for (int f = 0; f < 2; ++f) {
        read_table("tests/data/planar_slider_crank_inverse.csv");
        crank_drive s = create_slider_crank(closing);
        use_solver(&s.w, SE3D_ANALYSIS_INVERSE_DYNAMICS, (se3d_formulation)f);
        for (int row = 0; row < reference.rows; ++row) {
            run_to_row(&s.w, row, expected);
            expect_slider_crank(&s);
        }
        expect_all_seen();
        world_destroy(&s.w);
    }
}

static void planar_slider_crank_agrees_in_every_column(void)
{
    run_slider_crank(se3d_joint_create_point_on_line, SE3D_OK);
}

static void planar_slider_crank_with_redundant_revolutes_agrees_too(void)
{
    run_slider_crank(se3d_joint_create_revolute, SE3D_INFO_REDUNDANT);
}

/* ---- four-bar ---- */

static world create_fourbar(joint_create closing, se3d_body body[3])
{
    world w = world_create();
    const double O[2] = {0.0, 0.0};
    const double A[2] = {cos(0.3), sin(0.3)};
    const double Q[2] = {4.0, 0.0};
    int column = find_column("Bx");
    const double B[3] = {reference.values[0][column], reference.values[0][column + 1], 0.0};
    const double z[3] = {0.0, 0.0, 1.0};
    body[0] = add_bar(&w, "crank", O, 0.3, 1.0, 1.0);
    body[1] = add_bar(&w, "coupler", A, atan2(B[1] - A[1], B[0] - A[0]), 3.5, 3.5);
    body[2] = add_bar(&w, "rocker", Q, atan2(B[1] - Q[1], B[0] - Q[0]), 3.0, 3.0);
    se3d_constraint pin = add_pin(&w, "O", w.ground, body[0], O[0], O[1]);
    add_pin(&w, "A", body[0], body[1], A[0], A[1]);
    add_joint(&w, closing, "B", body[1], body[2], B, z);
    add_pin(&w, "Q", w.ground, body[2], Q[0], Q[1]);
    add_driver(&w, "drive", pin, SE3D_JOINT_COORDINATE_ANGLE, "2*t");
    return w;
}

static void expect_bar(const world *w, se3d_body body, const char *name)
{
    double p[4], omega[3], alpha[3];
    char column[32];
    MUST(w, se3d_body_get_orientation(w->system, body, p));
    MUST(w, se3d_body_get_angular_velocity(w->system, body, omega));
    MUST(w, se3d_body_get_angular_acceleration(w->system, body, alpha));
    snprintf(column, sizeof column, "%s_ang", name);
    expect_angle(column, 2.0 * atan2(p[3], p[0]));
    snprintf(column, sizeof column, "%s_w", name);
    expect(column, omega[2]);
    snprintf(column, sizeof column, "%s_a", name);
    expect(column, alpha[2]);
}

static void run_fourbar(joint_create closing, se3d_status expected)
{
    for (int f = 0; f < 2; ++f) {
        read_table("tests/data/fourbar_kinematics.csv");
        se3d_body body[3];
        world w = create_fourbar(closing, body);
        const double end[3] = {1.75, 0.0, 0.0};
        double B[3];
        use_solver(&w, SE3D_ANALYSIS_KINEMATICS, (se3d_formulation)f);
        for (int row = 0; row < reference.rows; ++row) {
            run_to_row(&w, row, expected);
            MUST(&w, se3d_body_get_point(w.system, body[1], end, B));
            expect("Bx", B[0]);
            expect("By", B[1]);
            expect_bar(&w, body[1], "coupler");
            expect_bar(&w, body[2], "rocker");
        }
        expect_all_seen();
        world_destroy(&w);
    }
}

static void fourbar_agrees_in_every_column(void)
{
    run_fourbar(se3d_joint_create_point_on_line, SE3D_OK);
}

static void fourbar_with_redundant_revolutes_agrees_too(void)
{
    run_fourbar(se3d_joint_create_revolute, SE3D_INFO_REDUNDANT);
}

int main(void)
{
    RUN(spatial_slider_crank_agrees_in_every_column);
    RUN(planar_slider_crank_agrees_in_every_column);
    RUN(planar_slider_crank_with_redundant_revolutes_agrees_too);
    RUN(fourbar_agrees_in_every_column);
    RUN(fourbar_with_redundant_revolutes_agrees_too);
    return check_finish();
}
