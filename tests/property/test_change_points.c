/* SPDX-License-Identifier: BSD-3-Clause */
/* Linkages that move freely through positions where two branches of their motion meet: four-bars
 * with s + l = p + q (parallelogram, antiparallelogram, kites, unequal bars), the slider-crank of
 * equal lengths, Peaucellier's inversor. On the branch that they are on they are one smooth curve
 * x(u), known in closed form, so that u'' follows from the energies alone:
 *
 *     T = M(u) u'^2 / 2,   M u'' = -M' u'^2 / 2
 *
 * A run keeps to that branch, with its energy. */
#include "check.h"
#include "se3d/se3d.h"
#include "support/world.h"

#include <complex.h>

#define BODIES 7

typedef double complex number; /* the imaginary part carries the derivative with respect to u */
typedef struct point {
    number x, y;
} point;

typedef struct linkage {
    const char *name;
    void (*place)(const struct linkage *, number u, point ends[BODIES][2]);
    int bodies;
    double a, b, c, d; /* lengths */
    double side;       /* of the diagonal on which the coupler begins: 1 or -1 */
} linkage;

/* A change point makes a square root vanish: what is below it is a square itself there. */
static void place_four_bar(const linkage *l, number u, point ends[BODIES][2])
{
    const double a = l->a, b = l->b, c = l->c, d = l->d, twice = 2.0 * sqrt(a * d);
    const int folds = fabs(d - a) == fabs(b - c), stretches = a + d == b + c;
    const point O = {0.0, 0.0}, Q = {d, 0.0}, A = {a * ccos(u), a * csin(u)};
    const number square = a * a + d * d - 2.0 * a * d * ccos(u); /* of A Q */
    const number x = Q.x - A.x, y = Q.y - A.y;
    point B;
    if (a == d && b == c) { /* A Q is 2 a sin(u/2) long and may vanish */
        const number half = a * csin(0.5 * u), height = csqrt(b * b - half * half);
        B.x = A.x + half * csin(0.5 * u) + l->side * height * ccos(0.5 * u);
        B.y = A.y - half * ccos(0.5 * u) + l->side * height * csin(0.5 * u);
    } else {
        const number outer = stretches ? twice * ccos(0.5 * u) : csqrt((b + c) * (b + c) - square);
        const number inner = folds ? twice * csin(0.5 * u) : csqrt(square - (b - c) * (b - c));
        const number along = 0.5 * (b * b - c * c + square), across = 0.5 * l->side * outer * inner;
        B.x = A.x + (along * x - across * y) / square;
        B.y = A.y + (along * y + across * x) / square;
    }
    const point bars[3][2] = {{O, A}, {A, B}, {B, Q}};
    memcpy(ends, bars, sizeof bars);
}

static void place_slider_crank(const linkage *l, number u, point ends[BODIES][2])
{
    (void)l;
    const point O = {0.0, 0.0}, A = {ccos(u), csin(u)}, B = {2.0 * ccos(u), 0.0};
    const point C = {B.x + 0.5, 0.0};
    const point bars[3][2] = {{O, A}, {A, B}, {B, C}};
    memcpy(ends, bars, sizeof bars);
}

/* u: half the angle of the rhombus of sides c between arms b at O; its inner corner goes on a
 * circle of radius a through O. */
static void place_inversor(const linkage *l, number u, point ends[BODIES][2])
{
    const double r = l->a, arm = l->b, side = l->c;
    const number high = side * csin(u), middle = csqrt(arm * arm - high * high);
    const number in = middle - side * ccos(u), out = middle + side * ccos(u);
    const number x = in / (2.0 * r), y = csqrt(1.0 - x * x); /* of the line through O */
    const point O = {0.0, 0.0}, M = {r, 0.0}, P = {in * x, in * y}, Q = {out * x, out * y};
    const point A = {middle * x - high * y, middle * y + high * x};
    const point B = {middle * x + high * y, middle * y - high * x};
    const point bars[7][2] = {{M, P}, {O, A}, {O, B}, {P, A}, {P, B}, {Q, A}, {Q, B}};
    memcpy(ends, bars, sizeof bars);
}

static const linkage linkages[] = {
    {"parallelogram", place_four_bar, 3, 1.0, 2.0, 1.0, 2.0, 1.0},
    {"antiparallelogram", place_four_bar, 3, 1.0, 2.0, 1.0, 2.0, -1.0},
    {"kite, crank on the base", place_four_bar, 3, 1.0, 2.0, 2.0, 1.0, 1.0},
    {"kite, crank on the coupler", place_four_bar, 3, 1.0, 1.0, 2.0, 2.0, 1.0},
    {"unequal bars, stretched", place_four_bar, 3, 1.0, 2.0, 3.0, 4.0, 1.0},
    {"unequal bars, folded", place_four_bar, 3, 1.0, 2.0, 4.0, 3.0, 1.0},
    {"slider-crank", place_slider_crank, 3, 1.0, 1.0, 0.0, 0.0, 1.0},
    {"inversor", place_inversor, 7, 2.0, 2.0, 1.2, 0.0, 1.0},
};

static double mass_of(int body)
{
    return 1.0 + 0.3 * body;
}

static double inertia_of(int body)
{
    return 0.1 + 0.05 * body;
}

typedef struct pose {
    double r[3], v[3], angle, w;
} pose;

static void get_poses(const linkage *l, double u, double rate, pose poses[BODIES])
{
    const double tiny = 1e-30;
    point ends[BODIES][2];
    l->place(l, u + tiny * (number)I, ends);
    for (int k = 0; k < l->bodies; ++k) {
        const number x = 0.5 * (ends[k][0].x + ends[k][1].x),
                     y = 0.5 * (ends[k][0].y + ends[k][1].y);
        const number dx = ends[k][1].x - ends[k][0].x, dy = ends[k][1].y - ends[k][0].y;
        const double turn = creal(dx) * cimag(dy) - creal(dy) * cimag(dx);
        const double square = creal(dx) * creal(dx) + creal(dy) * creal(dy);
        poses[k] = (pose){.r = {creal(x), creal(y), 0.0},
                          .v = {rate * cimag(x) / tiny, rate * cimag(y) / tiny, 0.0},
                          .angle = atan2(creal(dy), creal(dx)),
                          .w = rate * turn / tiny / square};
    }
}

/* M(u) */
static double get_inertia(const linkage *l, double u)
{
    pose poses[BODIES];
    double sum = 0.0;
    get_poses(l, u, 1.0, poses);
    for (int k = 0; k < l->bodies; ++k) {
        const double *v = poses[k].v;
        sum += mass_of(k) * (v[0] * v[0] + v[1] * v[1]) + inertia_of(k) * poses[k].w * poses[k].w;
    }
    return sum;
}

/* What of u' without loads is constant: M^(1/2) u'. One step of the classical method for u. */
static void advance_truth(const linkage *l, double speed, double h, double *u)
{
    const double k1 = speed / sqrt(get_inertia(l, *u));
    const double k2 = speed / sqrt(get_inertia(l, *u + 0.5 * h * k1));
    const double k3 = speed / sqrt(get_inertia(l, *u + 0.5 * h * k2));
    const double k4 = speed / sqrt(get_inertia(l, *u + h * k3));
    *u += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
}

typedef struct world {
    se3d_system *system;
    se3d_body ground, bodies[BODIES];
} world;

static void join(world *w, joint_create create, se3d_body i, se3d_body j, point at)
{
    const int slides = create == se3d_joint_create_prismatic;
    const double place[3] = {creal(at.x), creal(at.y), 0.0};
    const double axis[3] = {slides ? 1.0 : 0.0, 0.0, slides ? 0.0 : 1.0};
    world_join(w->system, create, NULL, i, j, place, axis);
}

/* By pins alone, with redundant rows, or by as many as are needed. */
static void build(world *w, const linkage *l, double u, double rate, int redundant)
{
    const joint_create pin = se3d_joint_create_revolute;
    const joint_create ball = redundant ? pin : se3d_joint_create_spherical;
    const joint_create loose = redundant ? pin : se3d_joint_create_cylindrical;
    se3d_body *b = w->bodies;
    pose poses[BODIES];
    point at[BODIES][2];
    world_must(NULL, se3d_system_create(NULL, &w->system), "create");
    CHECK(!se3d_system_get_ground(w->system, &w->ground));
    CHECK(!se3d_system_set_gravity(w->system, (const double[3]){0.0, 0.0, 0.0}));
    l->place(l, u, at);
    get_poses(l, u, rate, poses);
    for (int k = 0; k < l->bodies; ++k) {
        se3d_body_def def = se3d_body_def_default();
        memcpy(def.position, poses[k].r, sizeof def.position);
        memcpy(def.velocity, poses[k].v, sizeof def.velocity);
        def.orientation[0] = cos(0.5 * poses[k].angle);
        def.orientation[3] = sin(0.5 * poses[k].angle);
        def.angular_velocity[2] = poses[k].w;
        def.mass = mass_of(k);
        def.inertia[0] = 0.05;
        def.inertia[1] = def.inertia[2] = inertia_of(k);
        world_must(w->system, se3d_body_create(w->system, &def, &b[k]), "body");
    }
    join(w, pin, w->ground, b[0], at[0][0]);
    if (l->bodies == 3) {
        const int slides = l->d == 0.0;
        join(w, ball, b[0], b[1], at[0][1]);
        join(w, loose, b[1], b[2], at[1][1]);
        join(w, slides ? se3d_joint_create_prismatic : pin, w->ground, b[2], at[2][!slides]);
        return;
    }
    join(w, pin, w->ground, b[1], at[1][0]);
    join(w, pin, w->ground, b[2], at[2][0]);
    join(w, pin, b[1], b[3], at[1][1]);
    join(w, loose, b[1], b[5], at[1][1]);
    join(w, pin, b[2], b[4], at[2][1]);
    join(w, pin, b[2], b[6], at[2][1]);
    join(w, pin, b[0], b[3], at[0][1]);
    join(w, loose, b[3], b[4], at[0][1]);
    join(w, ball, b[5], b[6], at[5][0]);
}

typedef struct trial {
    int32_t method, formulation;
    double tolerance, step;
} trial;

/* The largest distance from the truth, and change of the energy over it. */
static se3d_status measure(const linkage *l, const trial *t, double start, double rate,
                           int redundant, double worst[2])
{
    world w;
    build(&w, l, start, rate, redundant);
    se3d_solver *solver = NULL;
    se3d_solver_def def = se3d_solver_def_default();
    def.method = t->method;
    def.formulation = t->formulation;
    def.tolerance = t->tolerance;
    def.step = t->step;
    world_must(w.system, se3d_solver_create(w.system, &def, &solver), "solver");
    const double speed = rate * sqrt(get_inertia(l, start)), energy = 0.5 * speed * speed;
    double u = start;
    se3d_status status = SE3D_OK;
    worst[0] = worst[1] = 0.0;
    for (int k = 1; k <= 40 && status >= 0; ++k) {
        pose poses[BODIES];
        double kinetic = 0.0;
        status = se3d_solver_run(solver, 0.1 * k);
        for (int s = 0; s < 20; ++s) {
            advance_truth(l, speed, 0.005, &u);
        }
        get_poses(l, u, 1.0, poses);
        for (int body = 0; body < l->bodies && status >= 0; ++body) {
            double r[3], v[3], spin[3];
            CHECK(!se3d_body_get_position(w.system, w.bodies[body], r));
            CHECK(!se3d_body_get_velocity(w.system, w.bodies[body], v));
            CHECK(!se3d_body_get_angular_velocity(w.system, w.bodies[body], spin));
            const double off = hypot(r[0] - poses[body].r[0], r[1] - poses[body].r[1]);
            worst[0] = off <= worst[0] ? worst[0] : off;
            kinetic += 0.5 * mass_of(body) * (v[0] * v[0] + v[1] * v[1]) +
                       0.5 * inertia_of(body) * spin[2] * spin[2];
        }
        const double change = fabs(kinetic / energy - 1.0);
        worst[1] = change <= worst[1] || status < 0 ? worst[1] : change;
    }
    if (status < 0) {
        fprintf(stderr, "%s: %s\n", l->name, se3d_system_get_error(w.system));
    }
    se3d_solver_destroy(solver);
    se3d_system_destroy(w.system);
    return status;
}

static const struct {
    double start, rate;
} starts[] = {{0.77, 2.0}, {0.87, 2.3}, {1.23, 3.1}, {0.61, 2.3}, {1.31, 3.7}};

static void try_all(const trial *t, int first, double most, double most_energy)
{
    const int count = (int)(sizeof linkages / sizeof *linkages);
    for (int k = 0; k < count; ++k) {
        const int choice = (k + first) % 5, redundant = (k / 2 + first) % 2;
        double worst[2];
        const se3d_status status =
            measure(&linkages[k], t, starts[choice].start, starts[choice].rate, redundant, worst);
        CHECK(status >= 0);
        CHECK(worst[0] <= most);
        CHECK(worst[1] <= most_energy);
        if (status < 0 || !(worst[0] <= most && worst[1] <= most_energy)) {
            fprintf(stderr, "%s, %s, %s, start %g, rate %g, redundant %d: %g m, %g of the energy\n",
                    linkages[k].name, se3d_method_get_name(t->method),
                    se3d_formulation_get_name(t->formulation), starts[choice].start,
                    starts[choice].rate, redundant, worst[0], worst[1]);
        }
    }
}

static const int32_t formulations[] = {SE3D_FORMULATION_ROMEGA, SE3D_FORMULATION_RP,
                                       SE3D_FORMULATION_JOINT};

static void explicit_methods_keep_to_their_branch(void)
{
    static const int32_t methods[] = {SE3D_METHOD_AUTO, SE3D_METHOD_DOP853, SE3D_METHOD_RK45,
                                      SE3D_METHOD_GAUSS};
    for (int m = 0; m < 4; ++m) {
        for (int f = 0; f < 3; ++f) {
            const trial t = {methods[m], formulations[f], 1e-4, 0.0};
            try_all(&t, m + f, 5e-3, 2e-3);
        }
    }
}

/* Its steps are so short that many end next to the singular position. */
static void rk4_keeps_to_its_branch(void)
{
    for (int f = 0; f < 3; ++f) {
        const trial loose = {SE3D_METHOD_RK4, formulations[f], 1e-4, f == 1 ? 4e-3 : 0.0};
        const trial tight = {SE3D_METHOD_RK4, formulations[f], 1e-6, 0.0};
        try_all(&loose, f, 3e-4, 3e-4);
        try_all(&tight, f + 1, 3e-5, 3e-5);
    }
}

/* A narrow filter had made 2.7e-3 m of a tolerance of 1e-5, and 1.2e-4 m of 1e-6. */
static void rk45_errs_by_its_tolerance(void)
{
    static const double tolerances[] = {1e-4, 1e-5, 1e-6};
    for (int k = 0; k < 9; ++k) {
        const trial t = {SE3D_METHOD_RK45, formulations[k % 3], tolerances[k / 3], 0.0};
        try_all(&t, k % 3, fmax(1e-5, 3.0 * t.tolerance), fmax(1e-5, t.tolerance));
    }
}

static void implicit_methods_keep_to_their_branch(void)
{
    static const int32_t methods[] = {SE3D_METHOD_BDF, SE3D_METHOD_RADAU,
                                      SE3D_METHOD_GENERALIZED_ALPHA, SE3D_METHOD_HHT};
    for (int m = 0; m < 4; ++m) {
        for (int f = 0; f < 2; ++f) {
            const trial t = {methods[m], formulations[f], 1e-4, 0.0};
            try_all(&t, m + f, 5e-3, 2e-3);
        }
    }
}

/* 4 ms is 1/20 rad of the fastest of them. */
static void equal_steps_keep_to_their_branch(void)
{
    static const int32_t methods[] = {SE3D_METHOD_GENERALIZED_ALPHA, SE3D_METHOD_HHT};
    for (int m = 0; m < 2; ++m) {
        for (int first = check_is_long() ? 0 : m; first < 5; first += check_is_long() ? 1 : 2) {
            const trial t = {methods[m], formulations[first % 2], 0.0, 4e-3};
            try_all(&t, first, 3e-2, 2e-2);
        }
    }
}

/* They close gaps of positions where constraints have no leverage: what that does to velocities is
 * either little, or the run ends and says so. */
static void rattle_and_verlet_keep_to_their_branch_or_say_so(void)
{
    static const struct {
        trial t;
        int linkage;
        double start, rate, most_energy;
    } rows[] = {
        {{SE3D_METHOD_VERLET, SE3D_FORMULATION_RP, 0.0, 0.0}, 5, 1.0, 3.0, 0.02},
        {{SE3D_METHOD_RATTLE, SE3D_FORMULATION_RP, 1e-4, 0.0}, 5, 1.13, 3.7, 0.02},
        {{SE3D_METHOD_RATTLE, SE3D_FORMULATION_ROMEGA, 1e-4, 0.0}, 7, 0.77, 2.0, 0.02},
        {{SE3D_METHOD_VERLET, SE3D_FORMULATION_ROMEGA, 1e-4, 0.0}, 4, 0.5, 3.7, 0.02},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
        double worst[2];
        const se3d_status status =
            measure(&linkages[rows[k].linkage], &rows[k].t, rows[k].start, rows[k].rate, 0, worst);
        CHECK(status >= 0 || status == SE3D_ERR_NO_CONVERGENCE);
        CHECK(worst[1] <= rows[k].most_energy);
    }
}

/* Bars of 1 m upright on the ground, the tops of each two joined by another one, pushed over. */
static se3d_system *build_windows(int count)
{
    static const double upright[3] = {1.0 / 12.0, 1.0 / 12.0, 1e-3};
    static const double level[3] = {1e-3, 1.0 / 12.0, 1.0 / 12.0};
    static const double y[3] = {0.0, 1.0, 0.0}, spin[3] = {0.0, 1.0, 0.0};
    se3d_system *system = NULL;
    se3d_body ground, bar, before, top = {0, 0};
    world_must(NULL, se3d_system_create(NULL, &system), "create");
    CHECK(!se3d_system_get_ground(system, &ground));
    for (int k = 0; k <= count; ++k) {
        const double x = k, foot[3] = {x, 0.0, 0.0}, head[3] = {x, 0.0, 1.0};
        before = top;
        bar = world_add_body(system, 1.0, upright, (const double[3]){x, 0.0, 0.5});
        CHECK(!se3d_body_set_velocity(system, bar, (const double[3]){0.5, 0.0, 0.0}));
        CHECK(!se3d_body_set_angular_velocity(system, bar, spin));
        world_join(system, se3d_joint_create_revolute, NULL, ground, bar, foot, y);
        if (k > 0) {
            world_join(system, se3d_joint_create_revolute, NULL, before, bar, head, y);
        }
        if (k < count) {
            top = world_add_body(system, 1.0, level, (const double[3]){x + 0.5, 0.0, 1.0});
            CHECK(!se3d_body_set_velocity(system, top, (const double[3]){1.0, 0.0, 0.0}));
            world_join(system, se3d_joint_create_revolute, NULL, bar, top, head, y);
        }
    }
    return system;
}

/* Next to a flat position accelerations change within a step that is long beside it; parts of that
 * step, shorter and shorter, had made 201 J of 36. */
static void equal_steps_pass_flat_windows_as_they_are(void)
{
    static const struct {
        int32_t method, order, count;
        double step, end;
    } rows[] = {
        {SE3D_METHOD_VERLET, 0, 2, 0.0, 10.0},
        {SE3D_METHOD_VERLET, 0, 4, 0.0, 1.5},
        {SE3D_METHOD_RATTLE, 2, 2, 0.0, 1.5},
        {SE3D_METHOD_RATTLE, 4, 2, 5e-3, 1.5},
    };
    for (size_t k = 0; k < 2 * sizeof rows / sizeof *rows; ++k) {
        if (!check_is_long() && k % 2 != k / 2 % 2) {
            continue; /* each row in one formulation */
        }
        se3d_system *system = build_windows(rows[k / 2].count);
        se3d_solver *solver = NULL;
        se3d_solver_def def = se3d_solver_def_default();
        se3d_energy energy, start;
        def.method = rows[k / 2].method;
        def.order = rows[k / 2].order;
        def.step = rows[k / 2].step;
        def.formulation = formulations[k % 2];
        world_must(system, se3d_solver_create(system, &def, &solver), "solver");
        CHECK(!se3d_system_get_energy(system, &start));
        se3d_status status = SE3D_OK;
        for (double t = 0.5; status >= 0 && t <= rows[k / 2].end; t += 0.5) {
            status = se3d_solver_run(solver, t);
            CHECK(!se3d_system_get_energy(system, &energy));
            CHECK_NEAR(energy.kinetic + energy.potential, start.kinetic + start.potential, 5e-3);
        }
        CHECK(status >= 0);
        se3d_solver_destroy(solver);
        se3d_system_destroy(system);
    }
}

int main(void)
{
    RUN(explicit_methods_keep_to_their_branch);
    RUN(rk4_keeps_to_its_branch);
    RUN(rk45_errs_by_its_tolerance);
    RUN(implicit_methods_keep_to_their_branch);
    RUN(equal_steps_keep_to_their_branch);
    RUN(rattle_and_verlet_keep_to_their_branch_or_say_so);
    RUN(equal_steps_pass_flat_windows_as_they_are);
    return check_finish();
}
