/* SPDX-License-Identifier: BSD-3-Clause */
/* The k-th allocation fails, once or for ever, for every k until the operation succeeds: the
 * failure is reported, nothing changed, nothing leaks, and a second attempt succeeds. */
#include "check.h"
#include "misuse/element_defs.h"
#include "support/analyses.h"
#include "support/counting.h"
#include "support/models.h"
#include "support/parts.h"

/* A small model with one element of everything that others are attached to. */
typedef struct workshop {
    support_counting counting;
    se3d_allocator allocator;
    se3d_system *system;
    se3d_body ground, body[2];
    se3d_constraint pin, slide;
    se3d_function of_time;
} workshop;

static se3d_joint_def joint_between(const workshop *w, se3d_body i, se3d_body j)
{
    se3d_joint_def def = se3d_joint_def_default();
    def.name = "joint";
    def.body_i = i;
    def.body_j = j;
    (void)w;
    return def;
}

static se3d_status make_integral(workshop *w)
{
    const double x[3] = {0.0, 1.0, 2.0}, y[3] = {1.0, 0.0, 3.0};
    se3d_function_def def = se3d_function_def_default();
    se3d_function function;
    def.table_x = x;
    def.table_y = y;
    def.table_count = 3;
    def.integrate = 1;
    return se3d_function_create(w->system, &def, &function);
}

/* Of an expression: the run makes room for its sums. */
static void add_rate(workshop *w)
{
    se3d_function_def def = se3d_function_def_default();
    se3d_function function;
    def.expression = "cos(t)";
    def.integrate = 1;
    CHECK(se3d_function_create(w->system, &def, &function) == SE3D_OK);
    CHECK(make_integral(w) == SE3D_OK);
}

static void workshop_open(workshop *w)
{
    *w = (workshop){0};
    w->allocator = support_counting_allocator(&w->counting);
    se3d_system_def def = se3d_system_def_default();
    def.allocator = &w->allocator;
    CHECK(se3d_system_create(&def, &w->system) == SE3D_OK);
    CHECK(se3d_system_get_ground(w->system, &w->ground) == SE3D_OK);
    for (int k = 0; k < 2; ++k) {
        se3d_body_def body = se3d_body_def_default();
        body.mass = 1.0 + k;
        body.inertia[0] = body.inertia[1] = body.inertia[2] = 1.0;
        CHECK(se3d_body_create(w->system, &body, &w->body[k]) == SE3D_OK);
    }
    se3d_joint_def pin = joint_between(w, w->ground, w->body[0]);
    pin.name = "pin";
    CHECK(se3d_joint_create_revolute(w->system, &pin, &w->pin) == SE3D_OK);
    se3d_joint_def slide = joint_between(w, w->ground, w->body[1]);
    slide.name = "slide";
    CHECK(se3d_joint_create_prismatic(w->system, &slide, &w->slide) == SE3D_OK);
    CHECK(se3d_function_create_expression(w->system, "sin(t)", &w->of_time) == SE3D_OK);
    add_rate(w);
}

static void workshop_close(workshop *w)
{
    se3d_system_destroy(w->system);
    CHECK(w->counting.live == 0 && w->counting.bytes == 0 && w->counting.wrong == 0);
}

/* Operations on a workshop; each leaves nothing behind where it fails. */
typedef se3d_status (*operation)(workshop *w);

static site site_of(const workshop *w)
{
    return (site){.ground = w->body[1], .body = w->body[0], .pin = w->pin};
}

#define OPERATION(kind, name, handle)                                                              \
    static se3d_status make_##name(workshop *w)                                                    \
    {                                                                                              \
        static const char *const text = "made";                                                    \
        const site at = site_of(w);                                                                \
        double def[200];                                                                           \
        handle made;                                                                               \
        fill_##name(&at, def);                                                                     \
        memcpy((char *)def + sizeof(size_t), &text, sizeof text);                                  \
        return se3d_##kind##_create_##name(w->system, (const void *)def, &made);                   \
    }
#define JOINT_OPERATION(type, flags) OPERATION(joint, type, se3d_constraint)
#define FORCE_OPERATION(name, def)   OPERATION(force, name, se3d_force)
SE3DI_JOINT_LIST(JOINT_OPERATION)
FORCE_LIST(FORCE_OPERATION)

static se3d_status make_body(workshop *w)
{
    se3d_body_def def = se3d_body_def_default();
    se3d_body body;
    def.name = "third";
    def.mass = 1.0;
    def.inertia[0] = def.inertia[1] = def.inertia[2] = 1.0;
    return se3d_body_create(w->system, &def, &body);
}

static se3d_status make_marker(workshop *w)
{
    se3d_marker_def def = se3d_marker_def_default();
    se3d_marker marker;
    def.name = "tip";
    def.body = w->body[0];
    return se3d_marker_create(w->system, &def, &marker);
}

/* A state that depends on itself. */
static se3d_status make_state(workshop *w)
{
    static const char *const names[] = {"t", "z"};
    se3d_state_def def = se3d_state_def_default();
    se3d_function_def law = se3d_function_def_default();
    se3d_signal signal;
    se3d_function rate;
    se3d_state state;
    def.name = "state";
    se3d_status status = se3d_state_create(w->system, &def, &state);
    if (status < 0) {
        return status;
    }
    memset(&signal, 0, sizeof signal);
    signal.kind = SE3D_SIGNAL_STATE;
    signal.state = state;
    law.expression = "-z";
    law.variables = names;
    law.variable_count = 2;
    law.signals = &signal;
    law.signal_count = 1;
    status = se3d_function_create(w->system, &law, &rate);
    return status < 0 ? (CHECK(!se3d_state_destroy(w->system, state)), status)
                      : se3d_state_set_rate(w->system, state, rate);
}

static se3d_status make_wheel(workshop *w)
{
    double values[SE3D_WHEEL_MEASURES];
    se3d_wheel_def def = se3d_wheel_def_default();
    se3d_wheel wheel;
    def.name = "wheel";
    def.body = w->body[0];
    def.chassis = w->ground;
    def.radius = 0.3;
    se3d_status status = se3d_wheel_create(w->system, &def, &wheel);
    if (status >= 0) {
        status = se3d_wheel_get_measures(w->system, wheel, 0, SE3D_WHEEL_MEASURES, values);
        if (status < 0) {
            CHECK(!se3d_wheel_destroy(w->system, wheel));
        }
    }
    return status;
}

static se3d_status make_primitive(workshop *w, int32_t type)
{
    se3d_primitive_def def = se3d_primitive_def_default();
    se3d_constraint constraint;
    def.name = "primitive";
    def.type = type;
    def.body_i = w->body[0];
    def.body_j = w->body[1];
    def.a_i[0] = def.a_j[1] = def.c[2] = 1.0;
    def.point_j[0] = 1.0;
    def.value = 1.0;
    def.function = w->of_time;
    return se3d_primitive_create(w->system, &def, &constraint);
}

static se3d_status make_dp1(workshop *w)
{
    return make_primitive(w, SE3D_PRIMITIVE_DP1);
}

static se3d_status make_dp2(workshop *w)
{
    return make_primitive(w, SE3D_PRIMITIVE_DP2);
}

static se3d_status make_d(workshop *w)
{
    return make_primitive(w, SE3D_PRIMITIVE_D);
}

static se3d_status make_cd(workshop *w)
{
    return make_primitive(w, SE3D_PRIMITIVE_CD);
}

static se3d_status make_user_constraint(workshop *w)
{
    se3d_user_constraint_def def = se3d_user_constraint_def_default();
    se3d_constraint constraint;
    def.name = "user";
    def.callback = part_no_equation;
    def.bodies[0] = w->body[0];
    def.bodies[1] = w->body[1];
    def.body_count = 2;
    def.equation_count = 3;
    return se3d_user_constraint_create(w->system, &def, &constraint);
}

static se3d_status make_driver(workshop *w)
{
    se3d_driver_def def = se3d_driver_def_default();
    se3d_constraint driver;
    def.name = "drive";
    def.joint = w->pin;
    def.function = w->of_time;
    return se3d_driver_create(w->system, &def, &driver);
}

static se3d_status make_coupler(workshop *w)
{
    se3d_coupler_def def = se3d_coupler_def_default();
    se3d_constraint coupler;
    def.name = "coupler";
    def.joint[0] = w->pin;
    def.joint[1] = w->slide;
    def.coordinate[1] = SE3D_JOINT_COORDINATE_DISPLACEMENT;
    def.ratio[0] = def.ratio[1] = 1.0;
    def.count = 2;
    return se3d_joint_create_coupler(w->system, &def, &coupler);
}

static se3d_status make_rack_pinion(workshop *w)
{
    se3d_constraint joint;
    return se3d_joint_create_rack_pinion(w->system, "rack", w->pin, w->slide, 0.1, &joint);
}

static se3d_status make_load_of_time(workshop *w)
{
    se3d_load_def def = se3d_load_def_default();
    se3d_force force;
    def.name = "push";
    def.body = w->body[0];
    def.function[1] = w->of_time;
    return se3d_force_create_load(w->system, &def, &force);
}

static se3d_status make_signals(workshop *w)
{
    const char *const names[3] = {"t", "a", "x"};
    se3d_signal signals[2];
    se3d_function law;
    se3d_function_def def = se3d_function_def_default();
    memset(signals, 0, sizeof signals);
    signals[0].kind = SE3D_SIGNAL_JOINT_COORDINATE;
    signals[0].joint = w->pin;
    signals[1].kind = SE3D_SIGNAL_POINT_POSITION;
    signals[1].body = w->body[0];
    def.expression = "sin(t) - a*x";
    def.variables = names;
    def.variable_count = 3;
    def.signals = signals;
    def.signal_count = 2;
    return se3d_function_create(w->system, &def, &law);
}

static se3d_status make_expression(workshop *w)
{
    const char *const names[3] = {"t", "l", "v"};
    const se3d_expression_symbol symbol = {"k", 2.0};
    se3d_function_def def = se3d_function_def_default();
    se3d_function function;
    def.expression = "if(t > 1, k*sin(l)^2, max(v, 3)) + step(t, 0, 0, 1, 1)";
    def.variables = names;
    def.variable_count = 3;
    def.symbols = &symbol;
    def.symbol_count = 1;
    return se3d_function_create(w->system, &def, &function);
}

static se3d_status make_table(workshop *w)
{
    const double x[4] = {0.0, 1.0, 2.0, 4.0}, y[4] = {1.0, 0.0, 3.0, 2.0};
    se3d_function_def def = se3d_function_def_default();
    se3d_function function;
    def.table_x = x;
    def.table_y = y;
    def.table_count = 4;
    return se3d_function_create(w->system, &def, &function);
}

static se3d_status make_clone(workshop *w)
{
    se3d_system *clone = NULL;
    se3d_status status = se3d_system_clone(w->system, &clone);
    CHECK((status >= 0) == (clone != NULL));
    if (status >= 0) {
        CHECK(se3d_system_hash(clone) == se3d_system_hash(w->system));
    }
    se3d_system_destroy(clone);
    return status;
}

/* A grid, a mesh, a tyre on it whose slip lags, and copies of them. */
static se3d_status make_road(workshop *w)
{
    static const double corners[9] = {-9.0, -9.0, 0.0, 9.0, -9.0, 0.0, 0.0, 9.0, 0.0};
    static const uint32_t triangle[3] = {0, 1, 2};
    se3d_road_def def = se3d_road_def_default();
    se3d_tyre_def tyre = se3d_tyre_def_default();
    se3d_road grid, mesh;
    se3d_force force;
    def.name = "field";
    def.body = w->ground;
    def.heights = corners;
    def.column_count = 3;
    def.row_count = 3;
    def.spacing[0] = def.spacing[1] = 1.0;
    se3d_status status = se3d_road_create(w->system, &def, &grid);
    if (status < 0) {
        return status;
    }
    def.name = "kerb";
    def.heights = NULL;
    def.vertices = corners;
    def.vertex_count = 3;
    def.triangles = triangle;
    def.triangle_count = 1;
    status = se3d_road_create(w->system, &def, &mesh);
    tyre.wheel = w->body[0];
    tyre.surface = mesh;
    tyre.relaxation_x = tyre.radius = tyre.k = tyre.mu = tyre.slip_stiffness = 1.0;
    tyre.cornering_stiffness = 1.0;
    if (status >= 0) {
        status = se3d_force_create_tyre(w->system, &tyre, &force);
        if (status >= 0) {
            status = se3d_road_set_def(w->system, grid, &def);
            status = status < 0 ? status : make_clone(w);
            if (status < 0) {
                CHECK(!se3d_force_destroy(w->system, force));
            }
        }
        if (status < 0) {
            CHECK(!se3d_road_destroy(w->system, mesh));
        }
    }
    if (status < 0) {
        CHECK(!se3d_road_destroy(w->system, grid));
    }
    return status;
}

static se3d_status make_snapshot(workshop *w)
{
    se3d_snapshot *snapshot = NULL;
    se3d_status status = se3d_snapshot_create(w->system, &snapshot);
    CHECK((status >= 0) == (snapshot != NULL));
    if (status >= 0) {
        status = se3d_snapshot_restore(snapshot, w->system);
    }
    static unsigned char bytes[200000];
    size_t size = 0;
    if (status >= 0) {
        CHECK(se3d_snapshot_write(snapshot, bytes, sizeof bytes, &size) == SE3D_OK);
        se3d_snapshot_destroy(snapshot);
        status = se3d_snapshot_read(w->system, bytes, size, &snapshot);
        CHECK((status >= 0) == (snapshot != NULL));
    }
    se3d_snapshot_destroy(snapshot);
    return status;
}

/* A solver that takes over what another one knew. */
static se3d_status read_solver(workshop *w)
{
    static unsigned char bytes[2000];
    se3d_solver_def def = se3d_solver_def_default();
    se3d_solver *solver = NULL;
    size_t size = 0;
    se3d_status status = se3d_solver_create(w->system, &def, &solver);
    if (status >= 0) {
        CHECK(se3d_solver_write(solver, bytes, sizeof bytes, &size) == SE3D_OK);
        status = se3d_solver_read(solver, bytes, size);
    }
    se3d_solver_destroy(solver);
    return status;
}

/* A set with a name, and copies of it in a clone and a snapshot. */
static se3d_status make_particles(workshop *w)
{
    se3d_particles *set = NULL;
    se3d_particles_def def = se3d_particles_def_default();
    def.name = "sand";
    se3d_status status = se3d_particles_create(w->system, &def, &set);
    CHECK((status >= 0) == (set != NULL));
    if (status >= 0) {
        status = make_clone(w);
    }
    if (status >= 0) {
        status = make_snapshot(w);
    }
    se3d_particles_destroy(set);
    return status;
}

/* A set of particles, and a material for them. */
static se3d_status make_set(workshop *w, const se3d_particles_def *def, se3d_material *material,
                            se3d_particles **set)
{
    se3d_material_def stuff = se3d_material_def_default();
    stuff.density = 2500.0;
    stuff.stiffness = 1e4;
    const se3d_status status = se3d_particles_create(w->system, def, set);
    return status < 0 ? status : se3d_material_create(w->system, &stuff, material);
}

/* A servo wall: without memory there is none. */
static se3d_status press(workshop *w, se3d_particles *set, se3d_material material)
{
    se3d_shape_def plane = se3d_shape_def_default();
    se3d_servo_def def = se3d_servo_def_default();
    se3d_servo_state state;
    plane.material = material;
    se3d_status status = se3d_shape_create_plane(w->system, &plane, &def.shape);
    if (status >= 0) {
        def.axis[2] = def.speed_max = 1.0;
        status = se3d_particles_add_servo(set, &def, NULL);
        CHECK((status >= 0) == (se3d_particles_get_servo(set, 0, &state) == SE3D_OK));
        const se3d_status gone = se3d_shape_destroy(w->system, def.shape);
        status = status < 0 ? status : gone;
    }
    return status;
}

/* A source with a table of radii and a sink, and copies of them; without memory there is neither,
 * and the set is as it was. */
static se3d_status make_source_and_sink(workshop *w)
{
    static const double radii[2] = {0.01, 0.02}, weights[2] = {1.0, 3.0};
    se3d_particles *set = NULL;
    se3d_material material = {0, 0};
    se3d_status status = make_set(w, NULL, &material, &set);
    if (status >= 0) {
        se3d_particles_source_def source = se3d_particles_source_def_default();
        se3d_particles_source_stats stats;
        se3d_fill_def fill = se3d_fill_def_default();
        fill.material = material;
        fill.upper[0] = fill.upper[1] = fill.upper[2] = 1.0;
        fill.radii = radii;
        fill.weights = weights;
        fill.radius_count = 2;
        source.fill = &fill;
        source.rate = 10.0;
        status = se3d_particles_add_source(set, &source, NULL);
        CHECK((status >= 0) == (se3d_particles_get_source_stats(set, 0, &stats) == SE3D_OK));
    }
    if (status >= 0) {
        se3d_particles_sink_def sink = se3d_particles_sink_def_default();
        uint64_t count;
        sink.normal[2] = 1.0;
        status = se3d_particles_add_sink(set, &sink, NULL);
        CHECK((status >= 0) == (se3d_particles_get_sink_count(set, 0, &count) == SE3D_OK));
    }
    if (status >= 0) {
        se3d_flow_def flow = se3d_flow_def_default();
        se3d_flow_stats passed;
        flow.normal[2] = 1.0;
        status = se3d_particles_add_flow(set, &flow, NULL);
        CHECK((status >= 0) == (se3d_particles_get_flow(set, 0, &passed) == SE3D_OK));
    }
    if (status >= 0) {
        status = press(w, set, material);
    }
    status = status < 0 ? status : make_clone(w);
    status = status < 0 ? status : make_snapshot(w);
    se3d_particles_destroy(set);
    if (material.index1 > 0) {
        CHECK(se3d_material_destroy(w->system, material) == SE3D_OK);
    }
    return status;
}

/* A cell that strains, whose lists have to be collected. */
static se3d_status make_cell(workshop *w)
{
    const double r[6] = {0.5, 0.5, 0.5, 0.69, 0.5, 0.5}, radius[2] = {0.1, 0.1};
    se3d_particles *set = NULL;
    se3d_material material = {0, 0};
    se3d_particles_def box = se3d_particles_def_default();
    se3d_cell_def stage = se3d_cell_def_default();
    se3d_cell_state state;
    for (int k = 0; k < 3; ++k) {
        box.boundary[k] = SE3D_DOMAIN_BOUNDARY_PERIODIC;
        box.upper[k] = 1.0;
    }
    box.mask = 0;
    box.audit = 1;
    stage.rate[0] = 0.5;
    se3d_status status = make_set(w, &box, &material, &set);
    status =
        status < 0 ? status : se3d_particles_add(set, material, 2, r, radius, NULL, NULL, NULL);
    status = status < 0 ? status : se3d_particles_step(set, 2);
    if (status >= 0) {
        status = se3d_particles_add_cell_stage(set, &stage, NULL);
    }
    status = status < 0 ? status : se3d_particles_step(set, 2);
    if (status >= 0) {
        CHECK(se3d_particles_get_cell(set, &state) == SE3D_OK && state.stage == 0);
    }
    se3d_particles_destroy(set);
    if (material.index1 > 0) {
        CHECK(se3d_material_destroy(w->system, material) == SE3D_OK);
    }
    return status;
}

/* Two spheres bonded to each other, and one to a plane. */
static se3d_status make_bonds(workshop *w)
{
    const double r[6] = {0.5, 0.5, 0.1, 0.69, 0.5, 0.1}, radius[2] = {0.1, 0.1};
    const uint32_t first[1] = {0}, second[1] = {1};
    se3d_particles *set = NULL;
    se3d_material material = {0, 0};
    se3d_shape plane = {0, 0};
    se3d_shape_def shape = se3d_shape_def_default();
    se3d_bond_def bond = se3d_bond_def_default();
    bond.young = 1e4;
    shape.normal[2] = 1.0;
    se3d_status status = make_set(w, NULL, &material, &set);
    shape.material = material;
    status = status < 0 ? status : se3d_shape_create_plane(w->system, &shape, &plane);
    status =
        status < 0 ? status : se3d_particles_add(set, material, 2, r, radius, NULL, NULL, NULL);
    status = status < 0 ? status : se3d_particles_step(set, 2);
    status = status < 0 ? status : se3d_particles_bond(set, &bond, 1, first, second, NULL);
    status = status < 0 ? status : se3d_particles_bond_near(set, &bond, -1, -1, NULL, NULL);
    status = status < 0 ? status : se3d_particles_bond_shape(set, &bond, plane, -1, NULL, NULL);
    status = status < 0 ? status : se3d_particles_step(set, 2);
    if (status >= 0) {
        CHECK(se3d_particles_count_bonds(set) == 3);
    }
    se3d_particles_destroy(set);
    if (plane.index1 > 0) {
        CHECK(se3d_shape_destroy(w->system, plane) == SE3D_OK);
    }
    if (material.index1 > 0) {
        CHECK(se3d_material_destroy(w->system, material) == SE3D_OK);
    }
    return status;
}

/* A template of clumps, two of them and a source, and copies of all. */
static se3d_status make_clumps(workshop *w)
{
    static const double r[6] = {0.0, 0.0, 0.0, 0.01, 0.0, 0.0}, radii[2] = {0.01, 0.01};
    static const double at[6] = {0.0, 0.0, 0.0, 1.0, 0.0, 0.0};
    se3d_particles *set = NULL;
    se3d_material material = {0, 0};
    se3d_clump_def def = se3d_clump_def_default();
    uint32_t index;
    def.count = 2;
    def.r = r;
    def.radius = radii;
    se3d_status status = make_set(w, NULL, &material, &set);
    status = status < 0 ? status : se3d_particles_add_clump_template(set, &def, &index);
    if (status >= 0) {
        status = se3d_particles_add_clumps(set, 0, material, 2, at, NULL, NULL, NULL);
        CHECK(se3d_particles_count(set) == (status < 0 ? 0 : 4));
        CHECK(se3d_particles_count_clumps(set) == (status < 0 ? 0 : 2));
    }
    status = status < 0 ? status : make_clone(w);
    status = status < 0 ? status : make_snapshot(w);
    se3d_particles_destroy(set);
    if (material.index1 > 0) {
        CHECK(se3d_material_destroy(w->system, material) == SE3D_OK);
    }
    return status;
}

static se3d_status make_check(workshop *w)
{
    se3d_check *check = NULL;
    se3d_status status = se3d_check_create(w->system, &check);
    CHECK((status >= 0) == (check != NULL));
    se3d_check_destroy(check);
    return status;
}

/* With a joint that closes a loop. */
static se3d_status make_coordinates(workshop *w)
{
    se3d_coordinates *coordinates = NULL;
    se3d_constraint loop = {0, 0};
    double N[64];
    size_t freedoms;
    const se3d_joint_def def = joint_between(w, w->body[0], w->body[1]);
    se3d_status status = se3d_joint_create_parallel(w->system, &def, &loop);
    if (status >= 0) {
        status = se3d_coordinates_create(w->system, &coordinates);
        CHECK((status >= 0) == (coordinates != NULL));
    }
    if (status >= 0) {
        status = se3d_coordinates_compute_null_space(coordinates, N, &freedoms);
    }
    se3d_coordinates_destroy(coordinates);
    if (loop.index1 > 0) {
        CHECK(se3d_constraint_destroy(w->system, loop) == SE3D_OK);
    }
    return status;
}

static se3d_status make_batch(workshop *w)
{
    se3d_batch *batch = NULL;
    const double mass = 2.0, inertia[6] = {1.0, 1.0, 1.0};
    se3d_status status = se3d_batch_create(w->system, 3, 2, &batch);
    CHECK((status >= 0) == (batch != NULL));
    if (status >= 0) {
        status = se3d_batch_set_mass(batch, w->body[0], 1, 1, &mass, inertia);
    }
    se3d_batch_destroy(batch);
    return status;
}

static se3d_status make_batch_with_loop(workshop *w)
{
    se3d_batch *batch = NULL;
    se3d_constraint loop = {0, 0};
    const se3d_joint_def def = joint_between(w, w->body[0], w->body[1]);
    se3d_status status = se3d_joint_create_spherical(w->system, &def, &loop);
    if (status >= 0) {
        status = se3d_batch_create(w->system, 2, 1, &batch);
        CHECK((status >= 0) == (batch != NULL));
    }
    se3d_batch_destroy(batch);
    if (loop.index1 > 0) {
        CHECK(se3d_constraint_destroy(w->system, loop) == SE3D_OK);
    }
    return status;
}

typedef struct operation_row {
    const char *name;
    operation run;
} operation_row;

#define ROW(name, ignored) {#name, make_##name},
static const operation_row operations[] = {
    SE3DI_JOINT_LIST(ROW) FORCE_LIST(ROW){"body", make_body},
    {"marker", make_marker},
    {"state", make_state},
    {"wheel", make_wheel},
    {"road", make_road},
    {"dp1", make_dp1},
    {"dp2", make_dp2},
    {"d", make_d},
    {"cd", make_cd},
    {"user constraint", make_user_constraint},
    {"driver", make_driver},
    {"coupler", make_coupler},
    {"rack_pinion", make_rack_pinion},
    {"load of time", make_load_of_time},
    {"signals", make_signals},
    {"expression", make_expression},
    {"table", make_table},
    {"integral", make_integral},
    {"clone", make_clone},
    {"snapshot", make_snapshot},
    {"solver bytes", read_solver},
    {"particles", make_particles},
    {"source and sink", make_source_and_sink},
    {"clumps", make_clumps},
    {"cell", make_cell},
    {"bonds", make_bonds},
    {"check", make_check},
    {"coordinates", make_coordinates},
    {"batch", make_batch},
    {"batch with a loop", make_batch_with_loop},
};

typedef struct census {
    size_t bodies, markers, constraints, forces;
    uint64_t hash;
} census;

static census census_of(const se3d_system *system)
{
    return (census){se3d_system_count_bodies(system), se3d_system_count_markers(system),
                    se3d_system_count_constraints(system), se3d_system_count_forces(system),
                    se3d_system_hash(system)};
}

static int census_equal(const census *a, const census *b)
{
    return a->bodies == b->bodies && a->markers == b->markers && a->constraints == b->constraints &&
           a->forces == b->forces && a->hash == b->hash;
}

/* Returns whether allocation k was reached. */
static int fail_one(const operation_row *row, size_t k, int for_ever)
{
    workshop w;
    workshop_open(&w);
    census before = census_of(w.system);
    w.counting.calls = 0;
    w.counting.fail_at = k;
    w.counting.for_ever = for_ever;
    se3d_status status = row->run(&w);
    int reached = w.counting.failed > 0;
    w.counting.fail_at = 0;
    if (reached) {
        census after = census_of(w.system);
        if (status != SE3D_ERR_NO_MEMORY || !census_equal(&before, &after)) {
            fprintf(stderr, "%s, allocation %zu: %s\n", row->name, k, se3d_status_get_text(status));
        }
        CHECK(status == SE3D_ERR_NO_MEMORY);
        CHECK(census_equal(&before, &after));
        status = row->run(&w);
    }
    if (status < 0) {
        fprintf(stderr, "%s: %s\n", row->name, se3d_system_get_error(w.system));
    }
    CHECK(status >= 0);
    workshop_close(&w);
    return reached;
}

static void every_edit_survives_every_failed_allocation(void)
{
    size_t failures = 0;
    for (size_t r = 0; r < sizeof operations / sizeof operations[0]; ++r) {
        for (int for_ever = 0; for_ever < 2; ++for_ever) {
            size_t k = 1;
            while (k < 1000 && fail_one(&operations[r], k, for_ever)) {
                ++k;
            }
            CHECK(k < 1000);
            failures += k - 1;
        }
    }
    CHECK(failures > 100); /* the sweep is not empty */
}

static int fail_system(size_t k, int for_ever)
{
    support_counting counting = {.fail_at = k, .for_ever = for_ever};
    se3d_allocator allocator = support_counting_allocator(&counting);
    se3d_system_def def = se3d_system_def_default();
    se3d_system *system = NULL;
    def.allocator = &allocator;
    se3d_status status = se3d_system_create(&def, &system);
    CHECK(status == (counting.failed ? SE3D_ERR_NO_MEMORY : SE3D_OK));
    CHECK((status < 0) == (system == NULL));
    se3d_system_destroy(system);
    CHECK(counting.live == 0 && counting.wrong == 0);
    return counting.failed > 0;
}

static void creating_a_system_survives_every_failed_allocation(void)
{
    for (int for_ever = 0; for_ever < 2; ++for_ever) {
        size_t k = 1;
        while (k < 100 && fail_system(k, for_ever)) {
            ++k;
        }
        CHECK(k > 1 && k < 100);
    }
}

/* One analysis: create, run, on failure run again with memory. Returns whether k was reached. */
static int fail_analysis(const support_analysis *row, int32_t formulation, size_t k, int for_ever,
                         uint64_t *hash)
{
    support_counting counting = {0};
    se3d_allocator allocator = support_counting_allocator(&counting);
    support_plan plan;
    support_model model;
    se3d_solver *solver = NULL;
    support_plan_make(&plan, row->mechanism, row->count);
    CHECK(support_model_create(&model, &plan, &allocator, 0) == SE3D_OK);
    support_plan_destroy(&plan);
    uint64_t before = se3d_system_hash(model.system);
    counting.calls = 0;
    counting.fail_at = k;
    counting.for_ever = for_ever;
    se3d_status status = support_solver_create(model.system, row, formulation, &solver);
    CHECK((status < 0) == (solver == NULL));
    if (status >= 0) {
        status = se3d_solver_run(solver, row->step);
    }
    int reached = counting.failed > 0;
    counting.fail_at = 0;
    if (reached) {
        CHECK(status == SE3D_ERR_NO_MEMORY);
        CHECK(se3d_system_hash(model.system) == before);
        CHECK_CONTAINS(se3d_system_get_error(model.system), "memory");
        if (!solver) {
            CHECK(support_solver_create(model.system, row, formulation, &solver) == SE3D_OK);
        }
        status = se3d_solver_run(solver, row->step);
    }
    CHECK(status >= 0);
    *hash = se3d_system_hash(model.system);
    se3d_solver_destroy(solver);
    support_model_destroy(&model);
    CHECK(counting.live == 0 && counting.wrong == 0);
    return reached;
}

static void fail_each_allocation(const support_analysis *row, int32_t formulation)
{
    uint64_t expected, hash;
    CHECK(!fail_analysis(row, formulation, 0, 0, &expected));
    for (int for_ever = 0; for_ever < 2; ++for_ever) {
        size_t k = 1;
        while (k < 1000 && fail_analysis(row, formulation, k, for_ever, &hash)) {
            CHECK(hash == expected); /* the retry gives the same bits */
            ++k;
        }
        CHECK(k > 5 && k < 1000);
    }
}

static void every_analysis_survives_every_failed_allocation(void)
{
    static const support_analysis in_lanes = {"four_bar",        1,    SE3D_ANALYSIS_DYNAMICS,
                                              SE3D_METHOD_GAUSS, 0.02, 0.4};
    for (size_t r = 0; r < 2 * SUPPORT_ANALYSES; ++r) {
        fail_each_allocation(&support_analyses[r / 2], (int32_t)(r % 2));
    }
    fail_each_allocation(&in_lanes, SE3D_FORMULATION_JOINT);
    fail_each_allocation(&in_lanes, SE3D_FORMULATION_AUTO);
}

static se3d_status get_drop(void *ctx, const se3d_system *system, double *value)
{
    se3d_body body;
    double r[3];
    (void)ctx;
    se3d_status status = se3d_system_get_body(system, 1, &body);
    status = status < 0 ? status : se3d_body_get_position(system, body, r);
    *value = r[2];
    return status;
}

/* Events created, met and removed. */
static se3d_status run_with_events(se3d_solver *solver, double level, double t_end)
{
    se3d_event_def def = se3d_event_def_default();
    se3d_event event;
    def.name = "level";
    def.value = get_drop;
    def.level = level;
    se3d_status status = se3d_event_create(solver, &def, &event);
    CHECK((status < 0) == (event.index1 == 0));
    if (status >= 0) {
        status = se3d_solver_run(solver, t_end);
        CHECK(status < 0 || se3d_solver_count_event_records(solver) == 1);
        CHECK(se3d_event_destroy(solver, event) == SE3D_OK);
        CHECK(se3d_solver_count_event_records(solver) == 0);
    }
    return status;
}

/* As fail_analysis: the chain falls from rest, its first link by about a millimetre. */
static int fail_events(int32_t method, size_t k, int for_ever)
{
    support_counting counting = {0};
    se3d_allocator allocator = support_counting_allocator(&counting);
    se3d_solver_def def = se3d_solver_def_default();
    support_plan plan;
    support_model model;
    se3d_solver *solver = NULL;
    double level = 0.0;
    support_plan_make(&plan, "chain_revolute", 2);
    CHECK(support_model_create(&model, &plan, &allocator, 0) == SE3D_OK);
    support_plan_destroy(&plan);
    get_drop(NULL, model.system, &level);
    level -= 1e-3;
    def.method = method;
    def.step = 0.01;
    CHECK(se3d_solver_create(model.system, &def, &solver) == SE3D_OK);
    counting.calls = 0;
    counting.fail_at = k;
    counting.for_ever = for_ever;
    se3d_status status = run_with_events(solver, level, 0.05);
    const int reached = counting.failed > 0;
    counting.fail_at = 0;
    if (reached) {
        CHECK(status == SE3D_ERR_NO_MEMORY);
        CHECK_CONTAINS(se3d_system_get_error(model.system), "memory");
        double t;
        se3d_system_get_time(model.system, &t);
        se3d_system_set_time(model.system, t); /* from the state it was left in */
        CHECK(!SE3D_FAILED(se3d_solver_run(solver, 0.05)));
    } else {
        CHECK(status >= 0);
    }
    se3d_solver_destroy(solver);
    support_model_destroy(&model);
    CHECK(counting.live == 0 && counting.wrong == 0);
    return reached;
}

static void events_survive_every_failed_allocation(void)
{
    const int32_t methods[] = {SE3D_METHOD_DOP853, SE3D_METHOD_GENERALIZED_ALPHA,
                               SE3D_METHOD_RADAU,  SE3D_METHOD_VERLET,
                               SE3D_METHOD_CONVEX, SE3D_METHOD_GAUSS};
    for (size_t m = 0; m < 2 * sizeof methods / sizeof *methods; ++m) {
        size_t k = 1;
        while (k < 1000 && fail_events(methods[m / 2], k, (int)(m % 2))) {
            ++k;
        }
        CHECK(k > 5 && k < 1000);
    }
}

static void thousand_steady_steps_allocate_nothing(void)
{
    for (size_t r = 0; r < 2 * SUPPORT_ANALYSES; ++r) {
        const support_analysis *row = &support_analyses[r / 2];
        support_counting counting = {0};
        se3d_allocator allocator = support_counting_allocator(&counting);
        support_plan plan;
        support_model model;
        se3d_solver *solver = NULL;
        support_plan_make(&plan, row->mechanism, row->count);
        CHECK(support_model_create(&model, &plan, &allocator, 0) == SE3D_OK);
        support_plan_destroy(&plan);
        CHECK(!support_solver_create(model.system, row, (int32_t)(r % 2), &solver));
        CHECK(!SE3D_FAILED(se3d_solver_step(solver, 1e-3)));
        counting.calls = 0;
        se3d_status status = SE3D_OK;
        for (int k = 0; k < 1000 && status >= 0; ++k) {
            status = se3d_solver_step(solver, 1e-3);
        }
        if (status < 0) {
            fprintf(stderr, "%s: %s\n", row->mechanism, se3d_system_get_error(model.system));
        }
        CHECK(status >= 0);
        CHECK(counting.calls == 0);
        se3d_solver_destroy(solver);
        support_model_destroy(&model);
    }
}

int main(void)
{
    RUN(creating_a_system_survives_every_failed_allocation);
    RUN(every_edit_survives_every_failed_allocation);
    RUN(every_analysis_survives_every_failed_allocation);
    RUN(events_survive_every_failed_allocation);
    RUN(thousand_steady_steps_allocate_nothing);
    return check_finish();
}
