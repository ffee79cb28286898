/* SPDX-License-Identifier: BSD-3-Clause */
/* States that runs show without accelerations and multipliers: the motion is the same to the
 * tolerance, steps and all that follows are the same to the bit, what is not there is refused. */
#include "check.h"

#include "support/world.h"

#define ROWS      30
#define EVERY     0.0137
#define TOLERANCE 1e-6

/* Crank, coupler and rocker between two pins and two ball joints, with a spring and damper. */
typedef struct linkage {
    se3d_system *system;
    se3d_solver *solver;
    se3d_body links[3];
    se3d_constraint pin;
} linkage;

static void add_spring(linkage *w, se3d_body ground)
{
    se3d_tsda_def spring = se3d_tsda_def_default();
    se3d_force force;
    spring.body_i = ground;
    spring.body_j = w->links[2];
    spring.point_i[0] = 2.0;
    spring.k = 30.0;
    spring.c = 0.7;
    spring.l0 = 1.0;
    world_must(w->system, se3d_force_create_tsda(w->system, &spring, &force), "spring");
}

static linkage make(int32_t method, int32_t formulation)
{
    static const double J[3] = {0.03, 0.02, 0.01};
    static const double centers[3][3] = {{0.0, 0.0, 0.25}, {0.5, 0.1, 0.5}, {1.0, 0.2, 0.25}};
    static const double at[4][3] = {
        {0.0, 0.0, 0.0}, {0.0, 0.0, 0.5}, {1.0, 0.2, 0.5}, {1.0, 0.2, 0.0}};
    static const double y[3] = {0.0, 1.0, 0.0}, near_y[3] = {0.2, 1.0, 0.0};
    linkage w = {.system = NULL};
    se3d_body ground;
    world_must(NULL, se3d_system_create(NULL, &w.system), "create");
    world_must(w.system, se3d_system_get_ground(w.system, &ground), "ground");
    for (int k = 0; k < 3; ++k) {
        w.links[k] = world_add_body(w.system, 1.0 + k, J, centers[k]);
    }
    w.pin = world_join(w.system, se3d_joint_create_revolute, "pin", ground, w.links[0], at[0], y);
    world_join(w.system, se3d_joint_create_spherical, NULL, w.links[0], w.links[1], at[1], y);
    world_join(w.system, se3d_joint_create_spherical, NULL, w.links[1], w.links[2], at[2], y);
    world_join(w.system, se3d_joint_create_revolute, NULL, ground, w.links[2], at[3], near_y);
    add_spring(&w, ground);
    w.solver = world_solver(w.system, SE3D_ANALYSIS_DYNAMICS, method, formulation, 0.0);
    return w;
}

static void drop(linkage *w)
{
    se3d_solver_destroy(w->solver);
    se3d_system_destroy(w->system);
}

static void run(linkage *w, int32_t shown, double t)
{
    world_must(w->system, se3d_solver_set_shown(w->solver, shown), "set_shown");
    world_must(w->system, se3d_solver_run(w->solver, t), "run");
}

/* Positions and velocities of both are the same to `most`. */
static int are_near(const linkage *a, const linkage *b, double most)
{
    double worst = 0.0;
    for (int k = 0; k < 3; ++k) {
        double r[2][3], v[2][3], w[2][3], p[2][4];
        const linkage *both[2] = {a, b};
        for (int n = 0; n < 2; ++n) {
            CHECK(!se3d_body_get_position(both[n]->system, both[n]->links[k], r[n]));
            CHECK(!se3d_body_get_velocity(both[n]->system, both[n]->links[k], v[n]));
            CHECK(!se3d_body_get_angular_velocity(both[n]->system, both[n]->links[k], w[n]));
            CHECK(!se3d_body_get_orientation(both[n]->system, both[n]->links[k], p[n]));
        }
        for (int c = 0; c < 3; ++c) {
            worst = fmax(worst, fabs(r[0][c] - r[1][c]));
            worst = fmax(worst, fabs(p[0][c] - p[1][c]));
            worst = fmax(worst, 0.1 * fabs(v[0][c] - v[1][c]));
            worst = fmax(worst, 0.1 * fabs(w[0][c] - w[1][c]));
        }
    }
    if (!(worst <= most)) {
        fprintf(stderr, "%s: apart by %.3g\n", check_case, worst);
    }
    return worst <= most;
}

/* What follows from accelerations and multipliers is there or refused. */
static int is_whole(const linkage *w)
{
    double a[4], b[3];
    const se3d_status status = se3d_body_get_acceleration(w->system, w->links[0], a);
    CHECK(!status || status == SE3D_ERR_STATE);
    CHECK(se3d_body_get_angular_acceleration(w->system, w->links[0], a) == status);
    CHECK(se3d_constraint_get_reaction(w->system, w->pin, a, b) == status);
    CHECK(se3d_joint_get_coordinate(w->system, w->pin, SE3D_JOINT_COORDINATE_ANGLE, NULL, NULL,
                                    a) == status);
    CHECK(
        !se3d_joint_get_coordinate(w->system, w->pin, SE3D_JOINT_COORDINATE_ANGLE, a, a + 1, NULL));
    CHECK(se3d_system_get_violation(w->system, a) == status);
    return status == SE3D_OK;
}

typedef struct kind {
    int32_t method, formulation;
} kind;

/* All methods that interpolate. */
static const kind kinds[] = {
    {SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA},
    {SE3D_METHOD_DOP853, SE3D_FORMULATION_RP},
    {SE3D_METHOD_DOP853, SE3D_FORMULATION_JOINT},
    {SE3D_METHOD_RK45, SE3D_FORMULATION_ROMEGA},
    {SE3D_METHOD_GAUSS, SE3D_FORMULATION_ROMEGA},
    {SE3D_METHOD_RADAU, SE3D_FORMULATION_ROMEGA},
    {SE3D_METHOD_RADAU, SE3D_FORMULATION_RP},
    {SE3D_METHOD_BDF, SE3D_FORMULATION_ROMEGA},
    {SE3D_METHOD_GENERALIZED_ALPHA, SE3D_FORMULATION_ROMEGA},
    {SE3D_METHOD_HHT, SE3D_FORMULATION_RP},
};
#define KINDS (sizeof kinds / sizeof *kinds)

/* Between their steps these look at accelerations where there are forces, and show them. */
static int shows_all(const kind *of)
{
    return of->method == SE3D_METHOD_GENERALIZED_ALPHA || of->method == SE3D_METHOD_HHT;
}

static void rows_of_the_motion_are_those_of_everything(const kind *of)
{
    linkage all = make(of->method, of->formulation);
    linkage motion = make(of->method, of->formulation);
    int left_out = 0;
    for (int k = 1; k <= ROWS; ++k) {
        run(&all, SE3D_SHOWN_ALL, k * EVERY);
        run(&motion, SE3D_SHOWN_MOTION, k * EVERY);
        CHECK(is_whole(&all));
        left_out += !is_whole(&motion);
        CHECK(are_near(&all, &motion, TOLERANCE));
    }
    CHECK(left_out == (shows_all(of) ? 0 : ROWS));
    run(&all, SE3D_SHOWN_ALL, (ROWS + 1) * EVERY);
    run(&motion, SE3D_SHOWN_ALL, (ROWS + 1) * EVERY);
    CHECK(is_whole(&motion));
    CHECK(se3d_system_hash(all.system) == se3d_system_hash(motion.system));
    se3d_solver_stats stats[2];
    CHECK(!se3d_solver_get_stats(all.solver, &stats[0]));
    CHECK(!se3d_solver_get_stats(motion.solver, &stats[1]));
    CHECK(stats[0].steps == stats[1].steps);
    CHECK(stats[0].evaluations == stats[1].evaluations + (shows_all(of) ? 0 : ROWS));
    drop(&all);
    drop(&motion);
}

/* Steps by the caller, and what acts anew, begin with the whole state. */
static void what_begins_behind_them_is_the_same(const kind *of)
{
    static const double gravity[3] = {1.0, 2.0, -9.0};
    linkage all = make(of->method, of->formulation);
    linkage motion = make(of->method, of->formulation);
    const double t = ROWS * EVERY;
    run(&all, SE3D_SHOWN_ALL, t);
    run(&motion, SE3D_SHOWN_MOTION, t);
    CHECK(is_whole(&motion) == shows_all(of));
    CHECK(!se3d_system_set_gravity(all.system, gravity));
    CHECK(!se3d_system_set_gravity(motion.system, gravity));
    CHECK(is_whole(&motion) == shows_all(of));
    run(&all, SE3D_SHOWN_ALL, 1.1 * t);
    run(&motion, SE3D_SHOWN_MOTION, 1.1 * t);
    CHECK(se3d_solver_step(all.solver, 1e-3) >= 0);
    CHECK(se3d_solver_step(motion.solver, 1e-3) >= 0);
    CHECK(is_whole(&motion));
    CHECK(se3d_system_hash(all.system) == se3d_system_hash(motion.system));
    drop(&all);
    drop(&motion);
}

static void snapshots_and_clones_know_what_is_missing(void)
{
    linkage w = make(SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA);
    run(&w, SE3D_SHOWN_MOTION, 0.2);
    linkage copy = w;
    world_must(w.system, se3d_system_clone(w.system, &copy.system), "clone");
    copy.solver = world_solver(copy.system, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_DOP853,
                               SE3D_FORMULATION_ROMEGA, 0.0);
    CHECK(!is_whole(&copy));
    run(&w, SE3D_SHOWN_ALL, 0.3);
    run(&copy, SE3D_SHOWN_ALL, 0.3);
    CHECK(is_whole(&copy));
    CHECK(se3d_system_hash(w.system) == se3d_system_hash(copy.system));
    drop(&copy);
    drop(&w);
}

/* What was shown before is not of the state. */
static void a_motion_has_one_hash(void)
{
    linkage w = make(SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA);
    linkage other = make(SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA);
    run(&w, SE3D_SHOWN_MOTION, 0.1);
    run(&other, SE3D_SHOWN_ALL, 0.1);
    CHECK(se3d_system_hash(w.system) != se3d_system_hash(other.system));
    run(&w, SE3D_SHOWN_MOTION, 0.2);
    run(&other, SE3D_SHOWN_MOTION, 0.2);
    CHECK(se3d_system_hash(w.system) == se3d_system_hash(other.system));
    drop(&other);
    drop(&w);
}

static void a_run_to_the_present_time_completes_the_state(void)
{
    linkage w = make(SE3D_METHOD_RADAU, SE3D_FORMULATION_ROMEGA);
    run(&w, SE3D_SHOWN_MOTION, 0.2);
    CHECK(!is_whole(&w));
    run(&w, SE3D_SHOWN_ALL, 0.2);
    CHECK(is_whole(&w));
    drop(&w);
}

/* Friction in the pin follows its load. */
static void what_needs_multipliers_gets_them(void)
{
    linkage w = make(SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA);
    se3d_friction_def def = se3d_friction_def_default();
    se3d_force friction;
    def.joint = w.pin;
    def.mu = 0.1;
    def.radius = 0.02;
    world_must(w.system, se3d_force_create_friction(w.system, &def, &friction), "friction");
    run(&w, SE3D_SHOWN_MOTION, 0.1);
    CHECK(is_whole(&w));
    drop(&w);
}

static void other_values_are_refused(void)
{
    linkage w = make(SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA);
    CHECK(se3d_solver_set_shown(w.solver, 2) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(strstr(se3d_system_get_error(w.system), "shown = 2"));
    CHECK(se3d_solver_set_shown(w.solver, -1) == SE3D_ERR_INVALID_ARGUMENT);
    drop(&w);
}

int main(void)
{
    for (size_t k = 0; k < KINDS; ++k) {
        char name[80];
        snprintf(name, sizeof name, "%s %s", se3d_method_get_name(kinds[k].method),
                 se3d_formulation_get_name(kinds[k].formulation));
        check_case = name;
        rows_of_the_motion_are_those_of_everything(&kinds[k]);
        what_begins_behind_them_is_the_same(&kinds[k]);
    }
    RUN(snapshots_and_clones_know_what_is_missing);
    RUN(a_motion_has_one_hash);
    RUN(a_run_to_the_present_time_completes_the_state);
    RUN(what_needs_multipliers_gets_them);
    RUN(other_values_are_refused);
    return check_finish();
}
