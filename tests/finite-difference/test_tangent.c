/* SPDX-License-Identifier: BSD-3-Clause */
/* The derivatives of the equations of motion (lib/assembly/tangent.h) of a whole model against
 * central differences of their residual, in both formulations; the error falls with the square of
 * the step. Newton with them converges quadratically. */
#include "check.h"

#include "assembly/tangent.h"
#include "math/quaternion.h"
#include "math/vec3.h"
#include "nonlinear/newton.h"
#include "se3d/se3d.h"
#include "support/two_points.h"
#include "system/system_internal.h"

#define BODIES 3

static uint64_t seed = 1234567891234567u;

static void random_vector(double *v, int count, double scale)
{
    for (int k = 0; k < count; ++k) {
        v[k] = scale * check_random(&seed);
    }
}

/* Of another sequence: the elements beside them stay as they are. */
static void law_vector(double *v, int count, double scale)
{
    static uint64_t law_seed = 987654321987654321u;
    for (int k = 0; k < count; ++k) {
        v[k] = scale * check_random(&law_seed);
    }
}

/* A law of time, of `own` variables of its element, and of two kinds of signals, with a product of
 * both. */
static se3d_function make_law(se3d_system *system, const se3d_body body[BODIES + 1], int32_t kind,
                              size_t own, se3d_force spring)
{
    static const char *const names[] = {"t", "x", "v"};
    const char *variables[5] = {"a", "b", "a", "b", "b"};
    se3d_signal signals[2];
    se3d_function function;
    se3d_function_def def = se3d_function_def_default();
    memset(signals, 0, sizeof signals);
    for (int32_t s = 0; s < 2; ++s) {
        signals[s].kind = (kind + 3 * s) % SE3D_SIGNAL_ORIENTATION + 1;
        signals[s].component = signals[s].kind <= SE3D_SIGNAL_JOINT_RATE ? s : (kind + s) % 3;
        signals[s].body = body[1 + (kind + s) % BODIES];
        signals[s].force = spring;
        law_vector(signals[s].point, 3, 0.5);
        CHECK(se3d_system_get_constraint(system, 2, &signals[s].joint) == SE3D_OK);
    }
    for (size_t k = 0; k < own + 2; ++k) {
        variables[k] = k < own ? names[k] : k == own ? "a" : "b";
    }
    def.expression = own == 3 ? "0.3*sin(t) + 0.2*a*b + 0.1*a^2*x + 0.1*b*v - 0.04*b^2"
                              : "0.3*sin(t) + 0.2*a*b + 0.1*a^2 - 0.04*b^2 + 0.1*b";
    def.variables = variables;
    def.variable_count = own + 2;
    def.signals = signals;
    def.signal_count = 2;
    CHECK(se3d_function_create(system, &def, &function) == SE3D_OK);
    return function;
}

/* Every kind of signals in every element whose law may have them. */
static void add_laws(se3d_system *system, const se3d_body body[BODIES + 1], se3d_force spring)
{
    se3d_force force;
    for (int32_t kind = 0; kind < SE3D_SIGNAL_ORIENTATION; ++kind) {
        se3d_load_def load = se3d_load_def_default();
        se3d_tsda_def actuator = se3d_tsda_def_default();
        se3d_effort_def effort = se3d_effort_def_default();
        load.body = body[1 + kind % BODIES];
        load.in_body_frame = kind % 2;
        law_vector(load.point, 3, 0.5);
        load.function[kind % 3] = make_law(system, body, kind, 1, spring);
        CHECK(se3d_force_create_load(system, &load, &force) == SE3D_OK);
        CHECK(se3d_force_create_torque(system, &load, &force) == SE3D_OK);
        actuator.body_i = body[kind % 2]; /* one of them is the ground */
        actuator.body_j = body[2];
        law_vector(actuator.point_i, 3, 0.5);
        actuator.h = make_law(system, body, kind, 3, spring);
        CHECK(se3d_force_create_tsda(system, &actuator, &force) == SE3D_OK);
        CHECK(se3d_system_get_constraint(system, 2, &effort.joint) == SE3D_OK);
        effort.coordinate = kind % 2;
        effort.function = make_law(system, body, kind, 3, spring);
        CHECK(se3d_force_create_effort(system, &effort, &force) == SE3D_OK);
    }
}

static void add_elements(se3d_system *system, const se3d_body body[BODIES + 1])
{
    se3d_force force;
    se3d_tsda_def spring = se3d_tsda_def_default();
    spring.body_i = body[1];
    spring.body_j = body[3];
    random_vector(spring.point_i, 3, 0.5);
    random_vector(spring.point_j, 3, 0.5);
    spring.k = 40.0;
    spring.c = 3.0;
    spring.l0 = 1.0;
    CHECK(se3d_force_create_tsda(system, &spring, &force) == SE3D_OK);
    se3d_bushing_def bushing = se3d_bushing_def_default();
    bushing.body_i = body[2];
    bushing.body_j = body[3];
    for (int k = 0; k < 6; ++k) {
        bushing.K[7 * k] = 10.0 + k;
        bushing.C[7 * k] = 2.0 + k;
    }
    CHECK(se3d_force_create_bushing(system, &bushing, &force) == SE3D_OK);
    se3d_load_def load = se3d_load_def_default();
    load.body = body[2];
    random_vector(load.point, 3, 0.5);
    random_vector(load.value, 3, 10.0);
    CHECK(se3d_force_create_load(system, &load, &force) == SE3D_OK);
    load.in_body_frame = 1;
    CHECK(se3d_force_create_torque(system, &load, &force) == SE3D_OK);
}

static void add_joints(se3d_system *system, const se3d_body body[BODIES + 1])
{
    se3d_constraint joint;
    double at[3] = {0.3, 0.2, 0.1};
    double axis[3] = {0.2, 0.9, 0.3};
    se3d_joint_def def = se3d_joint_def_default();
    def.body_i = body[0];
    def.body_j = body[1];
    CHECK(se3d_joint_def_set_frame(system, &def, at, axis, NULL) == SE3D_OK);
    CHECK(se3d_joint_create_revolute(system, &def, &joint) == SE3D_OK);
    se3d_driver_def driver = se3d_driver_def_default();
    driver.joint = joint;
    driver.value = 0.3;
    CHECK(se3d_driver_create(system, &driver, &joint) == SE3D_OK);
    def.body_i = body[1];
    def.body_j = body[2];
    CHECK(se3d_joint_def_set_frame(system, &def, at, axis, NULL) == SE3D_OK);
    CHECK(se3d_joint_create_cylindrical(system, &def, &joint) == SE3D_OK);
    def.body_i = body[3];
    def.body_j = body[1];
    CHECK(se3d_joint_def_set_frame(system, &def, at, axis, NULL) == SE3D_OK);
    def.distance = 1.0;
    CHECK(se3d_joint_create_distance(system, &def, &joint) == SE3D_OK);
}

/* One that is said by callback, against the order of the pair. */
static void add_user_constraint(se3d_system *system, const se3d_body body[BODIES + 1])
{
    se3d_constraint joint;
    se3d_user_constraint_def user = se3d_user_constraint_def_default();
    user.callback = two_points;
    user.bodies[0] = body[3];
    user.bodies[1] = body[2];
    user.body_count = TWO_POINTS_BODIES;
    user.equation_count = TWO_POINTS_EQUATIONS;
    CHECK(se3d_user_constraint_create(system, &user, &joint) == SE3D_OK);
}

/* With laws of signals and a constraint by callback, too; without, Newton has an easier start. */
static se3d_system *build(int with_callback)
{
    se3d_system *system;
    se3d_body body[BODIES + 1];
    CHECK(se3d_system_create(NULL, &system) == SE3D_OK);
    CHECK(se3d_system_get_ground(system, &body[0]) == SE3D_OK);
    for (int k = 1; k <= BODIES; ++k) {
        se3d_body_def def = se3d_body_def_default();
        def.mass = 1.0 + k;
        random_vector(def.inertia, 6, 0.2);
        for (int c = 0; c < 3; ++c) {
            def.inertia[c] = 1.0 + 0.1 * c;
        }
        random_vector(def.position, 3, 2.0);
        random_vector(def.orientation, 4, 1.0);
        def.orientation[0] += 2.0;
        (void)se3di_quat_normalize(def.orientation, def.orientation);
        random_vector(def.velocity, 3, 2.0);
        random_vector(def.angular_velocity, 3, 2.0);
        CHECK(se3d_body_create(system, &def, &body[k]) == SE3D_OK);
    }
    add_joints(system, body);
    if (with_callback) {
        add_user_constraint(system, body);
    }
    add_elements(system, body);
    if (with_callback) {
        se3d_force spring;
        CHECK(se3d_system_get_force(system, 0, &spring) == SE3D_OK);
        add_laws(system, body, spring);
    }
    /* leave the pose at which the joints were made: every curvature counts */
    for (int k = 1; k <= BODIES; ++k) {
        double turn[3];
        se3di_frame *frame = &system->model.frames[k];
        random_vector(turn, 3, 0.4);
        se3di_quat_rotate(frame->p, turn, frame->p);
        se3di_frame_update(frame);
    }
    return system;
}

/* R = M vdot + C^T lambda - Q - velocity terms */
static void residual(se3di_assembly *assembly, const double *vdot, const double *lambda, double *R)
{
    size_t n = (size_t)assembly->formulation->block;
    se3di_error error = {0};
    double b[8 * BODIES] = {0.0};
    se3di_assembly_eval_mass(assembly);
    se3di_assembly_eval_jacobian(assembly);
    CHECK(se3di_assembly_eval_forces(assembly, 0.3, b, &error) == SE3D_OK);
    se3di_assembly_add_transposed(assembly, -1.0, lambda, b);
    for (size_t k = 0; k < BODIES * n; ++k) {
        R[k] = -b[k];
        for (size_t c = 0; c < n; ++c) {
            R[k] += assembly->H[k / n * n * n + (k % n) * n + c] * vdot[k / n * n + c];
        }
        if (k % n == 7) {
            R[k] = 0.0; /* the normalisation is not part of the tangent */
        }
    }
}

/* Move body k along direction c of 12: six of position, six of velocity, by s. In r-p a tangent of
 * p, or pdot. */
static void displace(se3di_assembly *assembly, int k, int c, double s)
{
    se3di_frame *frame = &assembly->model->frames[assembly->free_body[k]];
    const se3di_formulation *formulation = assembly->formulation;
    double dq[8] = {0.0};
    double qdot[8];
    int part = c % 6;
    if (formulation->block == 6 || part < 3) {
        dq[part] = s;
    } else {
        double e[3] = {0.0, 0.0, 0.0};
        e[part - 3] = 0.5 * s;
        se3di_g_transposed_mul(frame->p, e, dq + 3);
    }
    formulation->get_velocity(frame, qdot);
    if (c < 6) {
        formulation->move(frame, dq);
    } else {
        for (int e = 0; e < formulation->size; ++e) {
            qdot[e] += dq[e];
        }
    }
    formulation->set_velocity(frame, qdot);
}

/* The derivative along that direction by the tangent: out = K d or D d. */
static void multiply(const se3di_tangent *tangent, int k, int c, double *out)
{
    const se3di_assembly *assembly = tangent->assembly;
    size_t n = (size_t)assembly->formulation->block;
    const se3di_frame *frame = &assembly->model->frames[assembly->free_body[k]];
    double d[8] = {0.0};
    int part = c % 6;
    if (n == 6 || part < 3) {
        d[part] = 1.0;
    } else {
        double e[3] = {0.0, 0.0, 0.0};
        e[part - 3] = 0.5;
        se3di_g_transposed_mul(frame->p, e, d + 3);
    }
    for (size_t r = 0; r < n * BODIES; ++r) {
        const double *block = NULL;
        int32_t row = (int32_t)(r / n);
        if (row == k) {
            block = (c < 6 ? tangent->K : tangent->D) + n * n * (size_t)k;
        }
        for (size_t e = 0; e < tangent->coupling_count; ++e) {
            const int32_t *pair = tangent->coupling + 2 * e;
            if (pair[0] == row && pair[1] == k) {
                block = (c < 6 ? tangent->K_upper : tangent->D_upper) + n * n * e;
            } else if (pair[1] == row && pair[0] == k) {
                block = (c < 6 ? tangent->K_lower : tangent->D_lower) + n * n * e;
            }
        }
        out[r] = 0.0;
        for (size_t e = 0; e < n && block; ++e) {
            out[r] += block[n * (r % n) + e] * d[e];
        }
    }
}

/* Forces of carriers, whose mass is tiny, times this. */
static double carriers_count = 1.0;

static double tangent_error(se3di_assembly *assembly, const se3di_tangent *tangent,
                            const double *vdot, const double *lambda, double h)
{
    double worst = 0.0;
    size_t n = (size_t)assembly->formulation->block;
    se3di_frame kept[BODIES + 1];
    memcpy(kept, assembly->model->frames, sizeof kept);
    for (int k = 0; k < BODIES; ++k) {
        for (int c = 0; c < 12; ++c) {
            double plus[8 * BODIES], minus[8 * BODIES], given[8 * BODIES];
            displace(assembly, k, c, h);
            residual(assembly, vdot, lambda, plus);
            memcpy(assembly->model->frames, kept, sizeof kept);
            displace(assembly, k, c, -h);
            residual(assembly, vdot, lambda, minus);
            memcpy(assembly->model->frames, kept, sizeof kept);
            multiply(tangent, k, c, given);
            for (size_t r = 0; r < n * BODIES; ++r) {
                const int is_state =
                    r % n == 0 && assembly->model->bodies[assembly->free_body[r / n]].state != 0;
                const double scale = is_state ? carriers_count : 1.0;
                worst = fmax(worst, scale * fabs((plus[r] - minus[r]) / (2.0 * h) - given[r]));
            }
        }
    }
    return worst;
}

/* Integrators multiply by K all at once: the same as direction by direction. */
static void check_product(const se3di_tangent *tangent)
{
    double x[6 * BODIES], sum[6 * BODIES] = {0.0}, product[6 * BODIES] = {0.0};
    double column[8 * BODIES];
    for (int k = 0; k < 6 * BODIES; ++k) {
        x[k] = cos(3.0 * k);
    }
    for (int k = 0; k < BODIES; ++k) {
        for (int c = 0; c < 6; ++c) {
            multiply(tangent, k, c, column);
            for (int r = 0; r < 6 * BODIES; ++r) {
                sum[r] += 0.7 * column[r] * x[6 * k + c];
            }
        }
    }
    se3di_tangent_add_stiffness(tangent, 0.7, x, product);
    for (int r = 0; r < 6 * BODIES; ++r) {
        CHECK_NEAR(product[r], sum[r], 1e-10 * (1.0 + fabs(sum[r])));
    }
}

static void check_formulation(const se3di_formulation *formulation)
{
    for (int trial = 0; trial < 5; ++trial) {
        se3d_system *system = build(1);
        se3di_assembly assembly;
        se3di_tangent tangent;
        double vdot[8 * BODIES];
        double lambda[64];
        CHECK(se3di_assembly_init(&assembly, &system->model, formulation, 1, NULL) == SE3D_OK);
        CHECK(se3di_tangent_init(&tangent, &assembly) == SE3D_OK);
        CHECK(tangent.coupling_count == 3);
        CHECK(se3di_assembly_eval_functions(&assembly, 0.3, NULL) == SE3D_OK);
        random_vector(vdot, 8 * BODIES, 5.0);
        random_vector(lambda, 64, 10.0);
        CHECK(se3di_tangent_eval(&tangent, 0.3, vdot, lambda, NULL) == SE3D_OK);
        double coarse = tangent_error(&assembly, &tangent, vdot, lambda, 1e-3);
        double fine = tangent_error(&assembly, &tangent, vdot, lambda, 2.5e-4);
        CHECK(coarse < 2e-2);
        CHECK(fine < coarse / 12.0);
        if (formulation->block == 6) {
            check_product(&tangent);
        }
        se3di_tangent_destroy(&tangent);
        se3di_assembly_destroy(&assembly);
        se3d_system_destroy(system);
    }
}

/* ---- d(Phi_q qdot)/dq ---- */

/* Phi_q qdot at the velocities that there are. */
static void get_rates(se3di_assembly *assembly, double *rates)
{
    double qdot[6 * BODIES];
    for (size_t k = 0; k < BODIES; ++k) {
        const se3di_frame *frame = &assembly->model->frames[assembly->free_body[k]];
        assembly->formulation->get_velocity(frame, qdot + 6 * k);
    }
    se3di_assembly_eval_jacobian(assembly);
    se3di_assembly_mul(assembly, qdot, rates);
}

/* Column c of body k in the rows of C: of all equations. */
static void get_column(const se3di_assembly *assembly, const double *rows, int k, int c,
                       double *column)
{
    for (uint32_t joint = 0; joint < assembly->constraint_count; ++joint) {
        const uint32_t first = assembly->model->constraints[joint].row_begin;
        for (int32_t e = assembly->joint_begin[joint]; e < assembly->joint_begin[joint + 1]; ++e) {
            for (int32_t r = 0; r < assembly->joint_rows[joint] && assembly->joint_body[e] == k;
                 ++r) {
                column[first + (uint32_t)r] = rows[assembly->block_offset[e] + (size_t)(6 * r + c)];
            }
        }
    }
}

static double gradient_error(se3di_assembly *assembly, const double *rows, double h)
{
    double worst = 0.0;
    se3di_frame kept[BODIES + 1];
    memcpy(kept, assembly->model->frames, sizeof kept);
    for (int k = 0; k < BODIES; ++k) {
        for (int c = 0; c < 6; ++c) {
            double plus[64], minus[64], given[64];
            for (int r = 0; r < 64; ++r) {
                given[r] = 0.1; /* equations of other bodies */
            }
            displace(assembly, k, c, h);
            get_rates(assembly, plus);
            memcpy(assembly->model->frames, kept, sizeof kept);
            displace(assembly, k, c, -h);
            get_rates(assembly, minus);
            memcpy(assembly->model->frames, kept, sizeof kept);
            get_column(assembly, rows, k, c, given);
            for (size_t r = 0; r < assembly->row_count; ++r) {
                const double slope = (plus[r] - minus[r]) / (2.0 * h);
                worst = fmax(worst, fabs(0.7 * slope - (given[r] - 0.1)));
            }
        }
    }
    return worst;
}

/* What it is added to stays. */
static void the_gradient_of_rates_agrees_with_differences(void)
{
    for (int trial = 0; trial < 5; ++trial) {
        se3d_system *system = build(0);
        se3di_assembly assembly;
        CHECK(se3di_assembly_init(&assembly, &system->model, &se3di_formulation_romega, 1, NULL) ==
              SE3D_OK);
        double *rows = malloc(assembly.joint_value_count * sizeof *rows);
        CHECK(rows && assembly.row_count > 10 && assembly.row_count <= 64);
        for (size_t k = 0; k < assembly.joint_value_count; ++k) {
            rows[k] = 0.1;
        }
        se3di_assembly_add_rate_gradient(&assembly, 0.7, rows);
        const double coarse = gradient_error(&assembly, rows, 1e-3);
        CHECK(coarse < 1e-3);
        CHECK(gradient_error(&assembly, rows, 2.5e-4) < coarse / 12.0);
        free(rows);
        se3di_assembly_destroy(&assembly);
        se3d_system_destroy(system);
    }
}

/* A number of `a`, of time, and of two signals. */
static se3d_function make_rate(se3d_system *system, const char *text, const se3d_signal signals[2])
{
    static const char *const names[] = {"t", "a", "b"};
    se3d_function function;
    se3d_function_def def = se3d_function_def_default();
    def.expression = text;
    def.variables = names;
    def.variable_count = 3;
    def.signals = signals;
    def.signal_count = 2;
    CHECK(se3d_function_create(system, &def, &function) == SE3D_OK);
    return function;
}

/* A body that a law of two states pushes, whose rates, outputs and inputs depend on it, on each
 * other and on themselves; carriers are bodies to the assembly. */
static se3d_system *build_states(void)
{
    se3d_system *system;
    se3d_body_def def = se3d_body_def_default();
    se3d_state_def state = se3d_state_def_default();
    se3d_load_def load = se3d_load_def_default();
    se3d_signal own[2], mixed[2], parts[2];
    se3d_state z[2];
    se3d_force force;
    CHECK(se3d_system_create(NULL, &system) == SE3D_OK);
    def.mass = 2.0;
    random_vector(def.position, 3, 1.0);
    random_vector(def.velocity, 3, 1.0);
    random_vector(def.angular_velocity, 3, 1.0);
    def.inertia[0] = 1.0;
    def.inertia[1] = 1.3;
    def.inertia[2] = 1.7;
    CHECK(se3d_body_create(system, &def, &load.body) == SE3D_OK);
    for (int k = 0; k < 2; ++k) {
        state.initial = 0.4 + 0.3 * k;
        CHECK(se3d_state_create(system, &state, &z[k]) == SE3D_OK);
    }
    memset(own, 0, sizeof own);
    memset(mixed, 0, sizeof mixed);
    memset(parts, 0, sizeof parts);
    for (int k = 0; k < 2; ++k) {
        own[k] = (se3d_signal){.kind = SE3D_SIGNAL_STATE, .state = z[k]};
        parts[k] = (se3d_signal){.kind = SE3D_SIGNAL_STATE,
                                 .component = k ? SE3D_STATE_INPUT : SE3D_STATE_OUTPUT,
                                 .state = z[0]};
    }
    mixed[0] = own[1];
    mixed[1].kind = SE3D_SIGNAL_POINT_VELOCITY;
    mixed[1].body = load.body;
    mixed[1].point[1] = 0.4;
    CHECK(!se3d_state_set_input(system, z[0], make_rate(system, "a*b + 0.2*b^2", mixed)));
    parts[0].state = z[1]; /* its value: it has no output */
    CHECK(!se3d_state_set_output(system, z[0], make_rate(system, "a*b - sin(a) + b^2", parts)));
    parts[0].state = z[0];
    CHECK(!se3d_state_set_rate(system, z[0], make_rate(system, "1e12*(b*a + a^2)", parts)));
    CHECK(!se3d_state_set_rate(system, z[1], make_rate(system, "1e12*(b - a*b + 0.1*a^3)", own)));
    load.function[1] = make_rate(system, "a^2*b + 0.3*b*t", parts);
    load.point[2] = 0.3;
    CHECK(se3d_force_create_load(system, &load, &force) == SE3D_OK);
    CHECK(se3d_force_create_torque(system, &load, &force) == SE3D_OK);
    return system;
}

static void check_states(se3d_system *(*build_one)(void), size_t couplings, double h)
{
    static const se3di_formulation *const formulations[] = {&se3di_formulation_romega,
                                                            &se3di_formulation_rp};
    for (int k = 0; k < 2; ++k) {
        se3d_system *system = build_one();
        se3di_assembly assembly;
        se3di_tangent tangent;
        double vdot[8 * BODIES], lambda[1] = {0.0};
        CHECK(!se3di_assembly_init(&assembly, &system->model, formulations[k], 1, NULL));
        CHECK(assembly.body_count == BODIES);
        CHECK(!se3di_tangent_init(&tangent, &assembly));
        CHECK(tangent.coupling_count == couplings);
        random_vector(vdot, 8 * BODIES, 1.0);
        CHECK(!se3di_tangent_eval(&tangent, 0.3, vdot, lambda, NULL));
        const double coarse = tangent_error(&assembly, &tangent, vdot, lambda, h);
        const double fine = tangent_error(&assembly, &tangent, vdot, lambda, 0.25 * h);
        CHECK(coarse < 2e-3);
        CHECK(fine < coarse / 12.0);
        se3di_tangent_destroy(&tangent);
        se3di_assembly_destroy(&assembly);
        se3d_system_destroy(system);
    }
}

/* In rates of 1e12/s a carrier's force is about as large as the others. */
static void the_tangent_of_states_agrees_with_differences(void)
{
    check_states(build_states, 3, 1e-2);
}

/* A wheel in the road whose slips lag. */
static se3d_system *build_tyre(void)
{
    se3d_system *system;
    se3d_force force;
    se3d_body_def body = se3d_body_def_default();
    se3d_tyre_def def = se3d_tyre_def_default();
    CHECK(!se3d_system_create(NULL, &system));
    body.mass = body.inertia[0] = body.inertia[1] = body.inertia[2] = 1.0;
    random_vector(body.position, 2, 1.0);
    body.position[2] = 0.27;
    body.orientation[0] = cos(0.1);
    body.orientation[1] = sin(0.1);
    random_vector(body.velocity, 3, 1.0);
    body.velocity[0] += 5.0;
    random_vector(body.angular_velocity, 3, 1.0);
    CHECK(!se3d_body_create(system, &body, &def.wheel));
    CHECK(!se3d_system_get_ground(system, &def.road));
    random_vector(def.center, 3, 0.03);
    def.radius = 0.3;
    def.k = 100.0;
    def.mu = 3.0;
    def.slip_stiffness = 20.0;
    def.cornering_stiffness = 15.0;
    def.relaxation_x = 0.3;
    def.relaxation_y = 0.6;
    CHECK(!se3d_force_create_tyre(system, &def, &force));
    for (int k = 0; k < 2; ++k) {
        system->model.frames[2 + k].v[0] = 0.05 - 0.08 * k;
    }
    return system;
}

static void the_tangent_of_slips_that_lag_agrees_with_differences(void)
{
    carriers_count = 0x1p40;
    check_states(build_tyre, 2, 1e-3);
    carriers_count = 1.0;
}

/* Two bodies of many shapes are one coupling. */
static void bodies_of_many_shapes_are_coupled(void)
{
    se3d_system *system;
    se3d_body_def body = se3d_body_def_default();
    se3d_material_def stuff = se3d_material_def_default();
    se3d_shape_def def = se3d_shape_def_default();
    se3d_shape shape;
    se3d_body bodies[2];
    se3di_assembly assembly;
    se3di_tangent tangent;
    CHECK(se3d_system_create(NULL, &system) == SE3D_OK);
    stuff.density = 1000.0;
    stuff.stiffness = 1e4;
    CHECK(se3d_material_create(system, &stuff, &def.material) == SE3D_OK);
    body.mass = 1.0;
    body.inertia[0] = body.inertia[1] = body.inertia[2] = 1.0;
    def.radius = 0.1;
    for (int k = 0; k < 2; ++k) {
        CHECK(se3d_body_create(system, &body, &bodies[k]) == SE3D_OK);
    }
    for (int k = 0; k < 80; ++k) {
        def.body = bodies[k % 2];
        CHECK(se3d_shape_create_sphere(system, &def, &shape) == SE3D_OK);
    }
    CHECK(!se3di_assembly_init(&assembly, &system->model, &se3di_formulation_romega, 1, NULL));
    CHECK(se3di_tangent_init(&tangent, &assembly) == SE3D_OK);
    CHECK(tangent.coupling_count == 1);
    se3di_tangent_destroy(&tangent);
    se3di_assembly_destroy(&assembly);
    se3d_system_destroy(system);
}

static void the_tangent_of_romega_agrees_with_differences(void)
{
    check_formulation(&se3di_formulation_romega);
}

static void the_tangent_of_rp_agrees_with_differences(void)
{
    check_formulation(&se3di_formulation_rp);
}

/* One implicit step x = h v + h^2/4 vdot, v = v_n + h/2 vdot of the equations of motion: set the
 * state of vdot and return the residual in b and c. */
static void implicit_state(se3di_equations *equations, const double *v_n, const double *vdot,
                           double h, double *x)
{
    se3di_assembly *assembly = &equations->assembly;
    size_t n = (size_t)assembly->formulation->block;
    double v[8 * BODIES], lambda[64] = {0.0};
    double R[8 * BODIES];
    se3di_equations_restore(equations);
    for (size_t k = 0; k < n * BODIES; ++k) {
        x[k] = h * v_n[k] + 0.25 * h * h * vdot[k];
        v[k] = v_n[k] + 0.5 * h * vdot[k];
    }
    for (size_t k = 0; k < BODIES; ++k) {
        assembly->formulation->move(&assembly->model->frames[assembly->free_body[k]], x + n * k);
    }
    se3di_assembly_set_velocity(assembly, v);
    residual(assembly, vdot, lambda, R);
    for (size_t k = 0; k < n * BODIES; ++k) {
        equations->b[k] = -R[k];
        if (k % n == 7) {
            equations->b[k] = 4.0 / (h * h) *
                              assembly->formulation->normalisation(
                                  &assembly->model->frames[assembly->free_body[k / n]]);
        }
    }
    se3di_assembly_eval_phi(assembly, equations->c);
    for (uint32_t k = 0; k < assembly->row_count; ++k) {
        equations->c[k] *= -4.0 / (h * h);
    }
}

/* The sizes of the first 12 corrections of Newton with the exact matrix. */
static void newton_corrections(const se3di_formulation *formulation, double e[12])
{
    se3d_system *system = build(0);
    se3di_error error = {0};
    se3di_equations equations;
    se3di_newton newton;
    double v_n[8 * BODIES], vdot[8 * BODIES] = {0.0}, x[8 * BODIES], lambda[64] = {0.0};
    const double h = 0.1;
    memset(e, 0, 12 * sizeof *e);
    const se3di_newton_weights weights = {.velocity = 0.5 * h, .position = 0.25 * h * h};
    CHECK(se3di_equations_init(&equations, &system->model, formulation, 1, &error) == SE3D_OK);
    CHECK(se3di_newton_init(&newton, &equations) == SE3D_OK);
    CHECK(se3di_position_solve(&equations, 0.0) == SE3D_OK);
    CHECK(se3di_velocity_solve(&equations, 0.0) == SE3D_OK);
    se3di_assembly_get_velocity(&equations.assembly, v_n);
    se3di_equations_save(&equations);
    for (int k = 0; k < 12; ++k) {
        implicit_state(&equations, v_n, vdot, h, x);
        CHECK(se3di_newton_factor(&newton, 0.3, vdot, lambda, x, &weights) >= 0);
        CHECK(se3di_newton_solve(&newton) >= 0);
        for (uint32_t c = 0; c < equations.assembly.unknown_count; ++c) {
            vdot[c] += equations.x[c];
            int counts = formulation->block == 6 || c % 8 < 7;
            e[k] = counts ? fmax(e[k], fabs(equations.x[c])) : e[k];
        }
        memcpy(lambda, equations.l, equations.assembly.row_count * sizeof *lambda);
    }
    CHECK(e[11] < 1e-8);
    se3di_newton_destroy(&newton);
    se3di_equations_destroy(&equations);
    se3d_system_destroy(system);
}

static void newton_of_an_implicit_step_converges_quadratically(void)
{
    for (int trial = 0; trial < 10; ++trial) {
        double e[12];
        newton_corrections(&se3di_formulation_romega, e);
        for (int k = 0; k < 5; ++k) {
            CHECK(e[k + 1] <= 2e-2 * e[k] * e[k] + 1e-11); /* one constant for all */
        }
        CHECK(e[4] < 1e-11);
    }
}

/* K leaves out what a change of |p| does, which is of second order: a little slower. */
static void newton_in_rp_converges_superlinearly(void)
{
    for (int trial = 0; trial < 10; ++trial) {
        double e[12];
        newton_corrections(&se3di_formulation_rp, e);
        CHECK(e[4] < 1e-7);
        CHECK(e[5] < 1e-11);
    }
}

int main(void)
{
    RUN(bodies_of_many_shapes_are_coupled);
    RUN(the_tangent_of_romega_agrees_with_differences);
    RUN(the_tangent_of_rp_agrees_with_differences);
    RUN(newton_of_an_implicit_step_converges_quadratically);
    RUN(newton_in_rp_converges_superlinearly);
    RUN(the_tangent_of_states_agrees_with_differences);
    RUN(the_tangent_of_slips_that_lag_agrees_with_differences);
    RUN(the_gradient_of_rates_agrees_with_differences);
    return check_finish();
}
