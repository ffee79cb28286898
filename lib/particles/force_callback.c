/* SPDX-License-Identifier: BSD-3-Clause */
/* Forces of particles by a user-defined law: contact by contact, geometry and momentum as in
 * force.inc. The first of the two is j (or the wall), the second i.
 *                                                                   docs/theory/contact-laws.md */
#include "base/floats.h"
#include "math/vec3.h"
#include "particles/clump.h"
#include "particles/wall.h"

#include <math.h>
#include <string.h>

/* What a contact is made of, before the law is asked. */
typedef struct touch {
    double n[3], delta, arm_i, arm_j;
    double v[3]; /* of the centres (the wall's point), i relative to j */
    const double *w_i, *w_j;
    double radius, mass;
    uint32_t material_i, material_j; /* in the set's table */
} touch;

/* Of a damping that does not depend on the overlap: as in force.inc. */
static double onset(double overlap, double way)
{
    return overlap < way * (1.0 + 1e-6) ? 0.5 + overlap / way : 1.0;
}

static void input_of(const se3di_force_task *task, const touch *t, const double xi[3],
                     se3d_contact_input *in)
{
    double spin[3], turned[3];
    const se3di_handle *i = &task->stuffs[t->material_i].handle;
    const se3di_handle *j = &task->stuffs[t->material_j].handle;
    memset(in, 0, sizeof *in);
    in->material_1 = (se3d_material){j->index1, j->generation};
    in->material_2 = (se3d_material){i->index1, i->generation};
    in->step = task->h;
    in->overlap = t->delta;
    in->lag = 0.5 * task->h;
    in->radius = t->radius;
    in->mass = t->mass;
    in->friction = task->pairs[t->material_i * task->materials + t->material_j].friction;
    se3di_copy(t->n, in->normal);
    in->velocity = se3di_dot(t->v, t->n);
    in->onset = onset(t->delta, -task->h * in->velocity);
    for (int a = 0; a < 3; ++a) {
        spin[a] = t->arm_i * t->w_i[a] + t->arm_j * t->w_j[a];
        in->spin[a] = t->w_i[a] - t->w_j[a];
    }
    se3di_cross(t->n, spin, turned);
    for (int a = 0; a < 3; ++a) {
        in->slip[a] = t->v[a] - in->velocity * t->n[a] + turned[a];
        in->spring[a] = xi[a] + task->h * in->slip[a];
    }
    se3di_add_scaled(-se3di_dot(in->spring, t->n), t->n, in->spring);
}

/* Force, lever (n x Ft) and moment on i; returns 0 if the law fails. */
static int respond(const se3di_force_task *task, const touch *t, double xi[3], double force[3],
                   double lever[3], double moment[3])
{
    se3d_contact_input in;
    se3d_contact_output out;
    input_of(task, t, xi, &in);
    memset(&out, 0, sizeof out);
    se3di_copy(in.spring, out.spring);
    const se3d_status status = task->callback(task->ctx, &in, &out);
    se3di_floats_resume();
    if (status < 0) {
        return 0;
    }
    se3di_add_scaled(-se3di_dot(out.tangential, t->n), t->n, out.tangential);
    se3di_copy(out.tangential, force);
    se3di_add_scaled(out.force, t->n, force);
    se3di_cross(t->n, out.tangential, lever);
    se3di_copy(out.moment, moment);
    se3di_copy(out.spring, xi);
    return isfinite(se3di_dot(force, force)) && isfinite(se3di_dot(moment, moment));
}

static void fail(se3di_force_task *task, uint32_t i, uint32_t j, int wall)
{
    if (!task->failure.happened) {
        task->failure = (se3di_law_failure){1, wall, i, j};
    }
}

static void load(se3di_load *to, double sign, double arm, const double force[3],
                 const double lever[3], const double moment[3])
{
    for (int a = 0; a < 3; ++a) {
        to->force[a] += sign * force[a];
        to->torque[a] += sign * moment[a] - arm * lever[a];
    }
}

static void take_xi(const se3di_particle_block *block, int lane, double xi[3])
{
    for (int a = 0; a < 3; ++a) {
        xi[a] = block->xi[a][lane];
    }
}

static void put_xi(se3di_particle_block *block, int lane, const double xi[3])
{
    for (int a = 0; a < 3; ++a) {
        block->xi[a][lane] = xi[a];
    }
}

static const double zero[3] = {0.0, 0.0, 0.0};

/* What a unit force along n moves particle i by. */
static double mobility_of(const se3di_force_task *task, uint32_t i, const double n[3])
{
    const double alone = task->particles[i].inverse_mass;
    return task->clumped ? se3di_clump_mobility(task->clumped, task->spins[i].id, n, alone) : alone;
}

/* To the nearest image in a cell that strains: as in force.inc. */
static void find_image(const se3di_strain *s, double d[3], double v[3])
{
    const double across = se3di_nearest(se3di_dot(s->across, d));
    se3di_add_scaled(-across, s->column, d);
    se3di_add_scaled(-across, s->jump, v);
}

static void pair_lane(se3di_force_task *task, se3di_particle_block *block, int lane)
{
    const uint32_t i = block->i[lane], j = block->j[lane];
    const se3di_particle *gi = &task->particles[i], *gj = &task->particles[j];
    double d[3], v[3], xi[3], force[3], lever[3], moment[3];
    se3di_sub(gi->x, gj->x, d);
    se3di_sub(gi->v, gj->v, v);
    if (task->strain) {
        find_image(task->strain, d, v);
    }
    for (int a = 0; a < 3; ++a) {
        const double times = se3di_nearest(d[a] * task->rate[a]);
        d[a] -= task->length[a] * times;
        v[a] -= task->strain ? task->strain->length_up[a] * times : 0.0;
    }
    double distance = se3di_norm(d), reach = gi->radius + gj->radius;
    if (!(distance < reach && distance > 0.0)) {
        put_xi(block, lane, zero);
        return;
    }
    touch t = {.delta = reach - distance,
               .radius = gi->radius * gj->radius / reach,
               .w_i = task->spins[i].w,
               .w_j = task->spins[j].w,
               .material_i = task->spins[i].material,
               .material_j = task->spins[j].material};
    se3di_scale(1.0 / distance, d, t.n);
    t.mass = 1.0 / (mobility_of(task, i, t.n) + mobility_of(task, j, t.n));
    se3di_copy(v, t.v);
    t.arm_i = gi->radius - 0.5 * t.delta;
    t.arm_j = gj->radius - 0.5 * t.delta;
    ++task->touching;
    task->overlap = fmax(task->overlap, t.delta - task->limit * fmin(gi->radius, gj->radius));
    take_xi(block, lane, xi);
    if (!respond(task, &t, xi, force, lever, moment)) {
        fail(task, task->spins[i].id, task->spins[j].id, 0);
        return;
    }
    put_xi(block, lane, xi);
    load(&task->loads[i], 1.0, t.arm_i, force, lever, moment);
    load(&task->loads[j], -1.0, t.arm_j, force, lever, moment);
    for (int k = 0; task->strain && k < 9; ++k) {
        task->virial[k] += force[k / 3] * d[k % 3];
    }
}

static void pairs(se3di_force_task *task)
{
    for (uint32_t b = task->begin; b < task->end; ++b) {
        se3di_particle_block *block = &task->blocks[b];
        for (int lane = 0; lane < SE3DI_PARTICLE_LANES; ++lane) {
            if (block->i[lane] != block->j[lane]) {
                pair_lane(task, block, lane);
            }
        }
    }
}

/* What a unit force along n moves the point of the body that gives way. */
static double wall_response(const se3di_wall *wall, const double lever[3], const double n[3])
{
    double arm[3], turned[3];
    if (!(wall->inverse_mass > 0.0)) {
        return 0.0;
    }
    se3di_cross(lever, n, arm);
    se3di_mul(wall->turn, arm, turned);
    return wall->inverse_mass + se3di_dot(arm, turned);
}

/* Velocity of the wall's surface on its body `side` from the centre of mass: what is tangential. */
static void find_drift(const se3di_wall *wall, const double side[3], const double n[3],
                       double drift[3])
{
    double turned[3];
    se3di_cross(wall->pose.spin, side, turned);
    se3di_add(wall->pose.u, turned, drift);
    se3di_add_scaled(-se3di_dot(drift, n), n, drift);
}

static void wall_lane(se3di_force_task *task, uint32_t b, int lane)
{
    se3di_particle_block *block = &task->blocks[b];
    const uint32_t i = block->i[lane];
    const se3di_wall *wall = &task->walls[block->j[0]];
    const se3di_particle *g = &task->particles[i];
    double point[3], at[3], side[3], turn[3], xi[3], force[3], lever[3], moment[3];
    double drift[3], spin[3];
    se3di_add(wall->pose.w, wall->pose.spin, spin);
    touch t = {.radius = g->radius,
               .w_i = task->spins[i].w,
               .w_j = spin,
               .material_i = task->spins[i].material,
               .material_j = wall->material};
    double distance, x[3];
    se3di_copy(g->x, x);
    se3di_wall_image(wall, task->length, g->radius, x);
    if (task->given) {
        distance = task->given[b].distance[lane];
        for (int a = 0; a < 3; ++a) {
            t.n[a] = task->given[b].normal[a][lane];
        }
    } else {
        distance = se3di_wall_nearest(wall, x, point, t.n);
    }
    if (!(distance < g->radius && g->radius > 0.0)) {
        put_xi(block, lane, zero);
        return;
    }
    t.delta = g->radius - distance;
    t.arm_i = distance;
    if (se3di_shape_is(&wall->shape, SE3DI_SHAPE_IS_BALL)) {
        t.radius = g->radius * wall->shape.radius / (g->radius + wall->shape.radius);
    }
    se3di_sub(x, wall->pose.c, side); /* from the centre of mass to the point */
    se3di_add_scaled(-distance, t.n, side);
    t.mass = 1.0 / (mobility_of(task, i, t.n) + wall_response(wall, side, t.n));
    se3di_cross(wall->pose.w, side, at);
    find_drift(wall, side, t.n, drift);
    for (int a = 0; a < 3; ++a) {
        t.v[a] = g->v[a] - wall->pose.v[a] - at[a] - drift[a];
    }
    ++task->touching;
    task->overlap = fmax(task->overlap, t.delta - task->limit * g->radius);
    take_xi(block, lane, xi);
    if (!respond(task, &t, xi, force, lever, moment)) {
        fail(task, task->spins[i].id, block->j[0], 1);
        return;
    }
    put_xi(block, lane, xi);
    load(&task->loads[i], 1.0, t.arm_i, force, lever, moment);
    double *sum = task->wall_sums + 6 * (size_t)block->j[0];
    se3di_cross(side, force, turn);
    for (int a = 0; a < 3; ++a) {
        sum[a] -= force[a];
        sum[3 + a] -= turn[a] + moment[a];
    }
}

static void walls(se3di_force_task *task)
{
    for (uint32_t b = task->begin; b < task->end; ++b) {
        for (int lane = 0; lane < SE3DI_PARTICLE_LANES; ++lane) {
            wall_lane(task, b, lane);
        }
    }
}

const se3di_kernels *se3di_particle_kernels_callback(void)
{
    /* never sifts, see mesh.c, nor moves: the set's own kernels do */
    static const se3di_kernels table = {"callback", pairs, walls, NULL, NULL, NULL};
    return &table;
}
