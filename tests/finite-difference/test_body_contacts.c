/* SPDX-License-Identifier: BSD-3-Clause */
/* K and D of contacts between bodies against central differences of their wrenches, at random
 * states with velocities, sticking and slipping: the error falls with the square of the step. */
#include "check.h"
#include "contact/bodies/body_contacts.h"
#include "math/quaternion.h"
#include "math/vec3.h"
#include "se3d/se3d.h"
#include "system/system_internal.h"

typedef struct trial {
    se3d_system *system;
    se3di_model *model;
    double mu, rolling, restitution;
    int law;
    double time; /* of the state that is looked at; contacts remember that at 0 */
} trial;

static se3d_body add_body(trial *t, const double r[3], const double q[4])
{
    se3d_body_def def = se3d_body_def_default();
    se3d_body body;
    double p[4];
    def.mass = 2.0;
    def.inertia[0] = 0.05;
    def.inertia[1] = 0.07;
    def.inertia[2] = 0.04;
    def.inertia[3] = 0.005;
    memcpy(def.position, r, sizeof def.position);
    se3di_quat_normalize(q, p);
    memcpy(def.orientation, p, sizeof p);
    CHECK(se3d_body_create(t->system, &def, &body) == SE3D_OK);
    return body;
}

static void add_shape(trial *t, int kind, se3d_body body, se3d_material material)
{
    se3d_shape_def def = se3d_shape_def_default();
    se3d_shape shape;
    def.body = body;
    def.material = material;
    def.radius = 0.3;
    def.length = 0.6;
    def.size[0] = 0.5;
    def.size[1] = 0.7;
    def.size[2] = 0.4;
    def.semi_axes[0] = 0.25;
    def.semi_axes[1] = 0.45;
    def.semi_axes[2] = 0.2;
    se3d_status status = SE3D_ERR_STATE;
    switch (kind) {
    case SE3DI_SHAPE_SPHERE:
        status = se3d_shape_create_sphere(t->system, &def, &shape);
        break;
    case SE3DI_SHAPE_BOX:
        status = se3d_shape_create_box(t->system, &def, &shape);
        break;
    case SE3DI_SHAPE_CAPSULE:
        status = se3d_shape_create_capsule(t->system, &def, &shape);
        break;
    case SE3DI_SHAPE_CYLINDER:
        status = se3d_shape_create_cylinder(t->system, &def, &shape);
        break;
    case SE3DI_SHAPE_ELLIPSOID:
        status = se3d_shape_create_ellipsoid(t->system, &def, &shape);
        break;
    default:
        status = se3d_shape_create_plane(t->system, &def, &shape);
        break;
    }
    CHECK(status == SE3D_OK);
}

typedef struct meeting {
    int kind_i, kind_j;
    double r[3], q[4]; /* of j; i is turned a little about the origin */
} meeting;

/* A law of a user's that uses all that it is given: its caps are where materials have them. */
static se3d_status users_law(void *ctx, const se3d_contact_input *in, se3d_contact_output *out)
{
    const double k = 1e4 * sqrt(in->overlap / in->radius), c = 20.0 * sqrt(in->mass);
    (void)ctx;
    out->force = fmax(0.0, k * in->overlap - in->onset * c * in->velocity);
    for (int a = 0; a < 3; ++a) {
        out->tangential[a] = -0.3 * k * in->spring[a] - 0.5 * c * in->slip[a];
        out->moment[a] = -0.01 * in->radius * out->force * in->spin[a];
    }
    const double size = se3di_norm(out->tangential), most = in->friction * out->force;
    se3di_scale(size > most ? most / size : 1.0, out->tangential, out->tangential);
    return SE3D_OK;
}

static trial begin(const meeting *m, double mu, double rolling, int law, uint64_t *seed)
{
    trial t = {.mu = mu, .rolling = rolling, .law = law};
    CHECK(se3d_system_create(NULL, &t.system) == SE3D_OK);
    t.model = &t.system->model;
    se3d_contact_settings settings = se3d_contact_settings_default();
    settings.overlap_limit = 1.0;
    settings.law = law;
    settings.callback = law == SE3D_CONTACT_LAW_CALLBACK ? users_law : NULL;
    settings.step = law == SE3D_CONTACT_LAW_CALLBACK ? 1e-4 : 0.0;
    CHECK(se3d_system_set_contact(t.system, &settings) == SE3D_OK);
    se3d_material_def def = se3d_material_def_default();
    se3d_material material;
    def.density = 1000.0;
    def.stiffness = 1e4;
    def.young = 1e5;
    def.friction = mu;
    def.restitution = 0.6;
    def.rolling_friction = rolling;
    def.torsional_friction = 0.5 * rolling;
    def.rolling_ratio = rolling > 0.0 && rolling < 1.0 ? 0.0 : 0.6;
    def.rolling_stiffness = rolling > 0.0 && rolling < 1.0 ? 300.0 : 0.0;
    def.tangential_damping = 0.7;
    def.tangential_stiffness = rolling > 0.0 ? 400.0 : 0.0;
    def.cohesion = rolling > 0.0 && rolling < 1.0 ? 3e3 : 0.0;
    def.adhesion = rolling > 0.0 && rolling < 1.0 ? 20.0 : 0.0;
    CHECK(se3d_material_create(t.system, &def, &material) == SE3D_OK);
    const double origin[3] = {0.01, -0.02, 0.015}, q[4] = {1.0, 0.03, -0.02, 0.04};
    add_shape(&t, m->kind_i, add_body(&t, origin, q), material);
    add_shape(&t, m->kind_j, add_body(&t, m->r, m->q), material);
    for (int b = 1; b < 3; ++b) {
        for (int c = 0; c < 3; ++c) {
            t.model->shapes[b - 1].surface_velocity[c] = 0.05 * check_random(seed);
            t.model->shapes[b - 1].surface_spin[c] = 0.2 * check_random(seed);
            t.model->frames[b].v[c] = 0.1 * check_random(seed);
            t.model->frames[b].w[c] = 0.3 * check_random(seed);
        }
        se3di_frame_update(&t.model->frames[b]);
    }
    return t;
}

static se3d_status add_derivative(void *ctx, const se3di_encounter *e)
{
    double K[144], D[144];
    double *sum = ctx;
    se3di_encounter_derivative(e, K, D);
    for (int k = 0; k < 144; ++k) {
        sum[k] += K[k];
        sum[144 + k] += D[k];
    }
    return SE3D_OK;
}

/* Move body j or i along one of the 24 directions: positions, then velocities. */
static void wrench_at(const trial *t, const se3di_frame base[3], int direction, double s,
                      double out[12])
{
    double wrench[18] = {0.0};
    int body = 1 + direction % 12 / 6;
    int a = direction % 6;
    se3di_frame *frame = &t->model->frames[body];
    memcpy(t->model->frames, base, 3 * sizeof *base);
    if (direction < 12 && a < 3) {
        frame->r[a] += s;
    } else if (direction < 12) {
        double theta[3] = {0.0, 0.0, 0.0};
        theta[a - 3] = s;
        se3di_quat_rotate(base[body].p, theta, frame->p);
    } else {
        (a < 3 ? frame->v : frame->w)[a % 3] += s;
    }
    se3di_frame_update(frame);
    double power[2], alone[2];
    se3di_contacts_add_wrenches(t->model, t->time, wrench, power);
    se3di_contacts_power(t->model, t->time, alone);
    CHECK(power[0] == alone[0] && power[1] == alone[1]);
    memcpy(out, wrench + 6, 12 * sizeof *out);
    memcpy(t->model->frames, base, 3 * sizeof *base);
}

/* The worst error of a matrix entry relative to the largest entry of its kind. */
static double worst_error(const trial *t, const se3di_frame base[3], const double *exact,
                          int velocities, double s)
{
    double worst = 0.0, scale = 0.0;
    for (int k = 0; k < 144; ++k) {
        scale = fmax(scale, fabs(exact[(velocities ? 144 : 0) + k]));
    }
    for (int column = 0; column < 12; ++column) {
        double plus[12], minus[12];
        wrench_at(t, base, column + (velocities ? 12 : 0), s, plus);
        wrench_at(t, base, column + (velocities ? 12 : 0), -s, minus);
        for (int r = 0; r < 12; ++r) {
            double difference = (plus[r] - minus[r]) / (2.0 * s);
            worst = fmax(worst, fabs(difference - exact[(velocities ? 144 : 0) + 12 * r + column]));
        }
    }
    return scale > 0.0 ? worst / scale : 1.0;
}

static void check_trial(const meeting *m, double mu, double rolling, int law, int remembers,
                        uint64_t *seed)
{
    trial t = begin(m, mu, rolling, law, seed);
    se3di_error ignored = {0};
    double exact[288] = {0.0}, turn[3], p[4];
    if (remembers) {
        CHECK(se3di_contacts_prepare(t.model, 0.0, &ignored) == SE3D_OK);
        se3di_contacts_accept(t.model);
        CHECK(t.model->contacts.count > 0);
        se3di_contacts_begin(t.model, 0.5, 1.0, 0); /* the effective mass is that of before */
        t.time = rolling > 0.0 ? 0.0 : 0.05;        /* surfaces have gone on */
        /* of the rolling springs the derivative leaves out what a finite turn adds */
        const double moved = 1e-3, turned = rolling > 0.0 ? 0.0 : 1e-4;
        for (int b = 1; b < 3; ++b) { /* a trial state later */
            for (int c = 0; c < 3; ++c) {
                t.model->frames[b].r[c] += moved * check_random(seed);
                turn[c] = turned * check_random(seed);
            }
            se3di_quat_rotate(t.model->frames[b].p, turn, p);
            memcpy(t.model->frames[b].p, p, sizeof p);
            se3di_frame_update(&t.model->frames[b]);
        }
    } else {
        se3di_contacts_begin(t.model, 0.5, rolling > 0.0 ? 0.6 : 1.0, 0);
    }
    se3di_frame base[3];
    memcpy(base, t.model->frames, sizeof base);
    CHECK(se3di_contacts_visit(t.model, t.time, add_derivative, exact) == SE3D_OK);
    /* how curvatures change on the way from the marks is left out */
    const int bends =
        remembers && (m->kind_i == SE3DI_SHAPE_ELLIPSOID || m->kind_j == SE3DI_SHAPE_ELLIPSOID);
    for (int velocities = 0; velocities < 2; ++velocities) {
        double coarse = worst_error(&t, base, exact, velocities, 4e-6);
        double fine = worst_error(&t, base, exact, velocities, 1e-6);
        CHECK(fine < 2e-5);
        CHECK(fine < 0.12 * coarse || fine < (bends ? 3e-6 : 3e-7));
    }
    se3d_system_destroy(t.system);
}

static const meeting meetings[] = {
    {SE3DI_SHAPE_SPHERE, SE3DI_SHAPE_PLANE, {0.0, 0.0, -0.28}, {1.0, 0.1, 0.05, 0.3}},
    {SE3DI_SHAPE_SPHERE, SE3DI_SHAPE_SPHERE, {0.3, 0.4, -0.27}, {1.0, 0.4, 0.2, 0.1}},
    {SE3DI_SHAPE_CAPSULE, SE3DI_SHAPE_PLANE, {0.0, 0.0, -0.53}, {1.0, 0.2, 0.1, 0.0}},
    {SE3DI_SHAPE_CAPSULE, SE3DI_SHAPE_CAPSULE, {0.57, 0.05, 0.1}, {1.0, 0.7, 0.1, 0.0}},
    {SE3DI_SHAPE_SPHERE, SE3DI_SHAPE_CAPSULE, {0.3, 0.48, 0.1}, {1.0, 0.1, 0.2, 0.0}},
    {SE3DI_SHAPE_SPHERE, SE3DI_SHAPE_CAPSULE, {0.3, 0.1, 0.48}, {1.0, 0.1, 0.2, 0.0}},
    {SE3DI_SHAPE_SPHERE, SE3DI_SHAPE_BOX, {0.53, 0.1, 0.05}, {1.0, 0.02, 0.01, 0.03}},
    {SE3DI_SHAPE_SPHERE, SE3DI_SHAPE_BOX, {0.45, 0.55, 0.05}, {1.0, 0.02, 0.01, 0.03}},
    {SE3DI_SHAPE_SPHERE, SE3DI_SHAPE_CYLINDER, {0.42, 0.4, 0.05}, {1.0, 0.02, 0.01, 0.03}},
    {SE3DI_SHAPE_BOX, SE3DI_SHAPE_PLANE, {0.0, 0.0, -0.40}, {1.0, 0.4, 0.3, 0.2}},
    {SE3DI_SHAPE_CYLINDER, SE3DI_SHAPE_PLANE, {0.0, 0.0, -0.4}, {1.0, 0.25, 0.1, 0.2}},
    {SE3DI_SHAPE_ELLIPSOID, SE3DI_SHAPE_PLANE, {0.0, 0.0, -0.18}, {1.0, 0.2, 0.1, 0.0}},
    {SE3DI_SHAPE_SPHERE, SE3DI_SHAPE_ELLIPSOID, {0.3, 0.4, 0.1}, {1.0, 0.2, 0.1, 0.0}},
    {SE3DI_SHAPE_ELLIPSOID, SE3DI_SHAPE_ELLIPSOID, {0.35, 0.38, 0.1}, {1.0, 0.7, 0.1, 0.0}},
    {SE3DI_SHAPE_ELLIPSOID, SE3DI_SHAPE_BOX, {0.48, 0.1, 0.05}, {1.0, 0.02, 0.01, 0.03}},
    {SE3DI_SHAPE_ELLIPSOID, SE3DI_SHAPE_BOX, {0.4, 0.55, 0.05}, {1.0, 0.02, 0.01, 0.03}},
    {SE3DI_SHAPE_ELLIPSOID, SE3DI_SHAPE_CAPSULE, {0.45, 0.05, 0.1}, {1.0, 0.7, 0.1, 0.0}},
    {SE3DI_SHAPE_ELLIPSOID, SE3DI_SHAPE_CYLINDER, {0.42, 0.4, 0.05}, {1.0, 0.02, 0.01, 0.03}},
};

/* Two boxes that touch with an edge of each. */
static meeting find_edges(uint64_t *seed)
{
    meeting m = {SE3DI_SHAPE_BOX, SE3DI_SHAPE_BOX, {0.0}, {0.0}};
    for (int found = 0; !found;) {
        se3di_shape box = {.kind = SE3DI_SHAPE_BOX, .half = {0.25, 0.35, 0.2}};
        se3di_shape_pose at_i = {.x = {0.01, -0.02, 0.015}}, at_j = {.v = {0.0}};
        const double q[4] = {1.0, 0.03, -0.02, 0.04};
        double p[4];
        se3di_manifold manifold;
        for (int k = 0; k < 4; ++k) {
            m.q[k] = check_random(seed);
            m.r[k % 3] = 0.6 * check_random(seed);
        }
        se3di_quat_normalize(q, p);
        se3di_quat_to_matrix(p, at_i.R);
        se3di_quat_normalize(m.q, p);
        se3di_quat_to_matrix(p, at_j.R);
        se3di_copy(m.r, at_j.x);
        se3di_narrow_find(&box, &at_i, &box, &at_j, &manifold);
        found = manifold.count == 1 && manifold.points[0].feature >= 0x40000000u &&
                manifold.points[0].overlap > 0.01 && manifold.points[0].overlap < 0.03;
    }
    return m;
}

static void edges_have_exact_derivatives(void)
{
    uint64_t seed = 7;
    for (int k = 0; k < 8; ++k) {
        meeting m = find_edges(&seed);
        check_trial(&m, 1e3, 0.0, k % 3, k / 2 % 2, &seed);
        check_trial(&m, 0.1, 0.02, k % 3, k / 2 % 2, &seed);
    }
}

static void contacts_have_exact_derivatives(void)
{
    uint64_t seed = 20240;
    for (size_t k = 0; k < sizeof meetings / sizeof meetings[0]; ++k) {
        for (int law = 0; law < 3; ++law) {
            for (int remembers = 0; remembers < 2; ++remembers) {
                int before = check_failures;
                check_trial(&meetings[k], 1e3, 0.0, law, remembers, &seed);  /* sticks */
                check_trial(&meetings[k], 0.1, 0.0, law, remembers, &seed);  /* slips */
                check_trial(&meetings[k], 1e3, 1e3, law, remembers, &seed);  /* nor rolls */
                check_trial(&meetings[k], 0.1, 0.02, law, remembers, &seed); /* both slip */
                if (check_failures > before) {
                    fprintf(stderr, "  meeting %zu, law %d, remembers %d\n", k, law, remembers);
                }
            }
        }
    }
}

int main(void)
{
    RUN(contacts_have_exact_derivatives);
    RUN(edges_have_exact_derivatives);
    return check_finish();
}
