/* SPDX-License-Identifier: BSD-3-Clause */
/* User-defined constraints in both formulations, against central differences along a motion with
 * known velocities and accelerations: the rate of Phi is Phi_q qdot - nu, its second derivative
 * Phi_q qddot - gamma; the error must fall with the square of the step. */
#include "check.h"

#include "assembly/assembly.h"
#include "joint/equation.h"
#include "math/quaternion.h"
#include "math/vec3.h"
#include "support/two_points.h"
#include "system/system_internal.h"

enum { BODIES = TWO_POINTS_BODIES, EQUATIONS = TWO_POINTS_EQUATIONS };

typedef struct motion {
    double r[3], p[4], v[3], w[3], a[3], wdot[3]; /* at time 0 of the motion */
} motion;

/* r = r0 + s v + s^2/2 a, p = p0 exp(s w + s^2/2 wdot): at s = 0 the derivatives are v, w, a, wdot.
 */
static void place(const motion *m, double s, se3di_frame *frame)
{
    double turn[3] = {0.0, 0.0, 0.0};
    se3di_copy(m->r, frame->r);
    se3di_add_scaled(s, m->v, frame->r);
    se3di_add_scaled(0.5 * s * s, m->a, frame->r);
    se3di_add_scaled(s, m->w, turn);
    se3di_add_scaled(0.5 * s * s, m->wdot, turn);
    se3di_quat_rotate(m->p, turn, frame->p);
    se3di_copy(m->v, frame->v);
    se3di_copy(m->w, frame->w);
    se3di_frame_update(frame);
}

typedef struct world {
    se3d_system *system;
    motion motions[BODIES];
    se3di_error error;
} world;

static void build(world *w, uint64_t *seed)
{
    se3d_constraint link;
    se3d_user_constraint_def def = se3d_user_constraint_def_default();
    CHECK(!se3d_system_create(NULL, &w->system));
    for (int k = 0; k < BODIES; ++k) {
        se3d_body_def body = se3d_body_def_default();
        double *all = (double *)&w->motions[k];
        body.mass = body.inertia[0] = body.inertia[1] = body.inertia[2] = 1.0;
        for (size_t c = 0; c < sizeof(motion) / sizeof(double); ++c) {
            all[c] = check_random(seed);
        }
        w->motions[k].p[0] += 1.5;
        (void)se3di_quat_normalize(w->motions[k].p, w->motions[k].p);
        CHECK(!se3d_body_create(w->system, &body, &def.bodies[k]));
    }
    def.callback = two_points;
    def.body_count = BODIES;
    def.equation_count = EQUATIONS;
    CHECK(!se3d_user_constraint_create(w->system, &def, &link));
}

static void eval_phi(world *w, se3di_assembly *assembly, double t, double s, double *phi)
{
    for (int k = 0; k < BODIES; ++k) {
        place(&w->motions[k], s, &w->system->model.frames[k + 1]);
    }
    CHECK(!se3di_assembly_eval_functions(assembly, t + s, &w->error));
    se3di_assembly_eval_phi(assembly, phi);
}

/* Largest errors of the first and second derivative with step h. */
static void measure(world *w, se3di_assembly *assembly, double t, double h, double worst[2])
{
    double before[EQUATIONS], after[EQUATIONS], phi[EQUATIONS], rate[EQUATIONS], second[EQUATIONS];
    double gamma[EQUATIONS], q[16] = {0.0};
    eval_phi(w, assembly, t, -h, before);
    eval_phi(w, assembly, t, h, after);
    eval_phi(w, assembly, t, 0.0, phi);
    for (int k = 0; k < BODIES; ++k) {
        double *acceleration = w->system->model.acceleration + 6 * (k + 1);
        se3di_copy(w->motions[k].a, acceleration);
        se3di_copy(w->motions[k].wdot, acceleration + 3);
    }
    se3di_assembly_eval_jacobian(assembly);
    se3di_assembly_eval_gamma(assembly, gamma);
    se3di_assembly_get_velocity(assembly, q);
    se3di_assembly_mul(assembly, q, rate);
    se3di_assembly_get_acceleration(assembly, q);
    se3di_assembly_mul(assembly, q, second);
    double violation[3], most[3] = {0.0, 0.0, 0.0};
    worst[0] = worst[1] = 0.0;
    for (int e = 0; e < EQUATIONS; ++e) {
        const double rates = rate[e] - assembly->f[3 * e + 1];
        most[0] = fmax(most[0], fabs(phi[e]));
        most[1] = fmax(most[1], fabs(rates));
        most[2] = fmax(most[2], fabs(second[e] - gamma[e]));
        double first = 0.5 * (after[e] - before[e]) / h;
        double twice = (after[e] - 2.0 * phi[e] + before[e]) / (h * h);
        worst[0] = fmax(worst[0], fabs(first - rates));
        worst[1] = fmax(worst[1], fabs(twice - (second[e] - gamma[e])));
    }
    w->system->model.time = t;
    CHECK(!se3di_violation_measure(&w->system->model, violation));
    for (int level = 0; level < 3; ++level) { /* in both formulations the same numbers */
        CHECK_NEAR(violation[level], most[level], 1e-12 * fmax(1.0, most[level]));
    }
}

static void check_formulation(const se3di_formulation *formulation)
{
    uint64_t seed = 88172645463325252u;
    for (int trial = 0; trial < 20; ++trial) {
        world w = {0};
        se3di_assembly assembly;
        double t = 1.0 + check_random(&seed), coarse[2], fine[2];
        build(&w, &seed);
        CHECK(!se3di_assembly_init(&assembly, &w.system->model, formulation, 1, &w.error));
        measure(&w, &assembly, t, 2e-2, coarse);
        measure(&w, &assembly, t, 1e-2, fine);
        for (int k = 0; k < 2; ++k) {
            CHECK(fine[k] < 1e-2 && fine[k] > 1e-9); /* not compared with itself */
            CHECK_NEAR(coarse[k] / fine[k], 4.0, 0.2);
        }
        se3di_assembly_destroy(&assembly);
        se3d_system_destroy(w.system);
    }
}

static void values_fit_in_romega(void)
{
    check_formulation(&se3di_formulation_romega);
}

static void values_fit_in_rp(void)
{
    check_formulation(&se3di_formulation_rp);
}

int main(void)
{
    RUN(values_fit_in_romega);
    RUN(values_fit_in_rp);
    return check_finish();
}
