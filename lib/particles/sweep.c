/* SPDX-License-Identifier: BSD-3-Clause */
/* Forces and motion of all particles in one sweep over the slabs, on any number of threads.
 *
 * Every particle gets its forces in the same order: from an even slab before an odd one. So the
 * forces of an odd slab wait for those of the two even slabs beside it; and a slab's particles may
 * be moved when its own forces and those of the slab before it have been evaluated. Each thread has
 * a range of slabs of about the same work, the same from step to step, and takes them in the order
 * 0 2 1 4 3 ..., so that what it moves is still near it. Then it takes what nobody has begun from
 * the ends of the others' ranges, as a thread may have lost its processor. Who evaluates or moves a
 * slab does not change the bits.                                       docs/theory/particles.md */

#include "particles/sweep.h"
#include "base/floats.h"
#include "base/threads.h"
#include "math/larger.h"
#include "particles/audit.h"
#include "particles/bond.h"
#include "particles/cell.h"
#include "particles/clump.h"
#include "particles/mesh.h"
#include "particles/passage.h"
#include "particles/servo.h"
#include "particles/share.h"
#include "particles/slabs.h"

#include <math.h>
#include <string.h>

#if defined(_OPENMP) && !defined(__STDC_NO_THREADS__)
#include <threads.h>
#endif

/* The largest of some particles; NaN if one is NaN. */
typedef struct haste {
    double fastest; /* squared speed */
    double hasty;   /* the same over the squared small reach */
} haste;

static haste hastier(haste a, haste b)
{
    return (haste){se3di_larger(a.fastest, b.fastest), se3di_larger(a.hasty, b.hasty)};
}

/* Clumps are moved as a whole, ghosts by others; fixed particles drift. */
enum { ELSEWHERE, FREE, FIXED };

static int moved_how(const se3di_particles *set, size_t k)
{
    if (se3di_clump_find(set, k) || se3di_share_is_ghost(set, k)) {
        return ELSEWHERE;
    }
    return set->fixed && se3di_particle_is_fixed(&set->particles[k]) ? FIXED : FREE;
}

static haste move_range(se3di_particles *set, size_t begin, size_t end,
                        const se3di_particle_motion *motion)
{
    const int all = set->clump_count == 0 && !set->fixed && !se3di_share_is_spread(set);
    const se3di_particle_motion on = {0, motion->h, motion->drift};
    haste most = {0.0, 0.0};
    if (set->flow_count > 0 && motion->drift != 0.0) {
        se3di_flows_mark(set, begin, end);
    }
    for (size_t k = begin, next = begin; k < end; k = next) {
        const int how = all ? FREE : moved_how(set, k);
        next = all ? end : k + 1;
        while (next < end && moved_how(set, next) == how) {
            ++next;
        }
        if (how != ELSEWHERE) {
            set->kernels->spheres(set, k, next, how == FIXED ? &on : motion, &most.fastest,
                                  &most.hasty);
        }
    }
    return most;
}

/* What the lists and forces must know of a drift. */
static void note_motion(se3di_particles *set, const se3di_particle_motion *motion, haste most)
{
    if (motion->drift != 0.0) {
        double both[2] = {most.fastest, most.hasty};
        se3di_share_largest(set, 2, both);
        most = (haste){both[0], both[1]};
        if (set->flow_count > 0) {
            se3di_flows_count(set, motion->drift);
        }
        se3di_bonds_turn(set, motion->drift);
        set->drift = fabs(motion->drift);
        set->pace = sqrt(most.fastest) * set->drift;
        set->worn += sqrt(most.hasty) * set->drift;
        set->force_valid = 0;
    }
}

/* What the parts of a cell that strains go by, and what they find. */
typedef struct strain_work {
    const se3di_particle_motion *motion;
    const se3di_domain_map *change;
    se3di_domain_sums sums[SE3DI_PARTS];
} strain_work;

static void strain_part(se3di_particles *set, size_t c, void *ctx)
{
    strain_work *w = ctx;
    se3di_domain_move(set, se3di_part_begin(set->count, c), se3di_part_begin(set->count, c + 1),
                      w->motion, w->change, &w->sums[c]);
}

/* Half a kick in a cell that strains, and the drift: the one if it ends a step, the other if it
 * begins one. */
static void strain(se3di_particles *set, double h, double drift)
{
    const se3di_particle_motion motion = {1, h, drift};
    const se3di_domain_map change =
        drift != 0.0 ? se3di_domain_open(set, h) : se3di_domain_rest(set);
    strain_work work = {&motion, &change, {{0.0, 0.0, {0.0}}}};
    se3di_particles_each_part(set, strain_part, &work);
    haste most = {0.0, 0.0};
    double kinetic[6] = {0.0};
    for (size_t c = 0; c < SE3DI_PARTS; ++c) {
        const se3di_domain_sums *sums = &work.sums[c];
        most = hastier(most, (haste){sums->fastest, sums->hasty});
        for (int k = 0; k < 6; ++k) {
            kinetic[k] += sums->kinetic[k];
        }
    }
    if (drift != 0.0) {
        se3di_domain_drift(set, drift);
    } else {
        memcpy(set->cell.kinetic, kinetic, sizeof kinetic);
        se3di_domain_close(set, h);
    }
    note_motion(set, &motion, most);
}

static void strain_all(se3di_particles *set, const se3di_particle_motion *motion)
{
    const int opens = motion->drift != 0.0;
    if (motion->kicks > opens) {
        strain(set, motion->h, 0.0);
    }
    if (opens) {
        strain(set, motion->h, motion->drift);
    }
}

/* What the parts of a pass go by, and what they find. */
typedef struct pass_work {
    const se3di_particle_motion *motion;
    haste most[SE3DI_PARTS];
} pass_work;

/* Of a part: in whole groups, which are moved side by side. */
static size_t first_clump(size_t clumps, size_t part)
{
    const size_t groups = (clumps + SE3DI_CLUMP_LANES - 1) / SE3DI_CLUMP_LANES;
    const size_t first = SE3DI_CLUMP_LANES * se3di_part_begin(groups, part);
    return first < clumps ? first : clumps;
}

static void pass_part(se3di_particles *set, size_t c, void *ctx)
{
    pass_work *w = ctx;
    const size_t count = set->count, clumps = se3di_share_clumps(set);
    const size_t first = first_clump(clumps, c), end = first_clump(clumps, c + 1);
    w->most[c] =
        move_range(set, se3di_part_begin(count, c), se3di_part_begin(count, c + 1), w->motion);
    if (set->flow_count > 0) {
        se3di_flows_mark_clumps(set, first, end);
    }
    set->kernels->clumps(set, first, end, w->motion, &w->most[c].fastest, &w->most[c].hasty);
}

static void move_all(se3di_particles *set, const se3di_particle_motion *motion)
{
    if (se3di_domain_strains(set)) {
        if (set->count > 0) {
            strain_all(set, motion);
        }
        return;
    }
    pass_work work = {.motion = motion};
    se3di_particles_each_part(set, pass_part, &work);
    haste most = {0.0, 0.0};
    for (size_t c = 0; c < SE3DI_PARTS; ++c) {
        most = hastier(most, work.most[c]);
    }
    note_motion(set, motion, most);
}

static void pass(se3di_particles *set, const se3di_particle_motion *motion)
{
    if (set->audits) {
        se3di_audit_mark(set, 0.5 * motion->kicks * motion->h);
    }
    move_all(set, motion);
    if (set->audits) {
        se3di_audit_add(set, 0.5 * motion->kicks * motion->h);
    }
}

void se3di_particles_kick(se3di_particles *set, double h)
{
    pass(set, &(se3di_particle_motion){1, h, 0.0});
}

void se3di_particles_move(se3di_particles *set, int kicks, double h)
{
    pass(set, &(se3di_particle_motion){kicks, h, h});
    se3di_servos_drift(set, h);
}

typedef struct sweep {
    se3di_particles *set;
    const se3di_force_task *task;
    const se3di_particle_motion *motion;
} sweep;

/* Until another thread has evaluated the forces of slab s. */
static void await(se3di_particles *set, uint32_t s)
{
#ifdef _OPENMP
    for (int tries = 0;; ++tries) {
        int32_t done;
#pragma omp atomic read seq_cst
        done = set->slabs[s].done;
        if (done) {
            return;
        }
#ifndef __STDC_NO_THREADS__
        if (tries > 1000) { /* that thread may want this processor */
            thrd_yield();
        }
#endif
    }
#else
    (void)set;
    (void)s;
#endif
}

static void finish_forces(se3di_slab *slab)
{
#ifdef _OPENMP
#pragma omp atomic write seq_cst
#endif
    slab->done = 1;
}

/* Along the slabs: pairs go across from the last to the first. */
static int has_no_end(const se3di_particles *set)
{
    return set->boundary[0] == SE3DI_BOUNDARY_PERIODIC &&
           set->boundary[1] == SE3DI_BOUNDARY_PERIODIC &&
           set->boundary[2] == SE3DI_BOUNDARY_PERIODIC; /* else slabs are along an open axis */
}

static uint32_t slab_before(const se3di_particles *set, uint32_t s)
{
    return s > 0 ? s - 1 : has_no_end(set) ? set->slab_count - 1 : s;
}

static uint32_t slab_after(const se3di_particles *set, uint32_t s)
{
    return s + 1 < set->slab_count ? s + 1 : has_no_end(set) ? 0 : s - 1;
}

static void evaluate_forces(const sweep *w, uint32_t s)
{
    se3di_particles *set = w->set;
    se3di_slab *slab = &set->slabs[s];
    se3di_force_task task = *w->task;
    size_t walls = set->wall_count;
    if (task.exact_power) {
        task.exact_power = set->share->powers[s];
        memset(task.exact_power, 0, sizeof set->share->powers[s]);
    }
    task.begin = slab->pair_begin;
    task.end = slab->pair_end;
    se3di_particles_get_kernels(set)->pairs(&task);
    task.begin = slab->wall_begin;
    task.end = slab->wall_end;
    if (walls > 0) {
        task.wall_sums = set->wall_sums + 6 * walls * s;
        memset(task.wall_sums, 0, 6 * walls * sizeof(double));
        if (task.exact) {
            task.exact += 6 * SE3DI_EXACT_PARTS * walls * s;
            memset(task.exact, 0, 6 * SE3DI_EXACT_PARTS * walls * sizeof(double));
        }
        se3di_particles_get_kernels(set)->walls(&task);
        se3di_particles_mesh_forces(set, slab, &task);
    }
    memcpy(slab->virial, task.virial, sizeof slab->virial);
    memcpy(slab->power, task.power, sizeof slab->power);
    slab->overlap = task.overlap;
    slab->failure = task.failure;
    slab->touching = task.touching;
}

/* Whether this thread is the first to begin something. */
static int claim(int32_t *begun)
{
    int32_t before;
#ifdef _OPENMP
#pragma omp atomic capture seq_cst
#endif
    {
        before = *begun;
        *begun = 1;
    }
    return !before;
}

/* The forces of an even slab, if nobody has begun them. */
static void even_forces(const sweep *w, uint32_t s)
{
    se3di_slab *slab = &w->set->slabs[s];
    if (claim(&slab->begun)) {
        evaluate_forces(w, s);
        finish_forces(slab);
    }
}

static void forces(const sweep *w, uint32_t s)
{
    se3di_particles *set = w->set;
    if (s % 2 == 0) {
        even_forces(w, s);
        return;
    }
    if (claim(&set->slabs[s].begun)) {
        const uint32_t next = slab_after(set, s);
        even_forces(w, s - 1);
        even_forces(w, next);
        await(set, s - 1);
        await(set, next);
        evaluate_forces(w, s);
        finish_forces(&set->slabs[s]);
    }
}

static void move(const sweep *w, uint32_t s)
{
    se3di_particles *set = w->set;
    se3di_slab *slab = &set->slabs[s];
    const uint32_t before = slab_before(set, s);
    if (w->motion->kicks == 0 || !claim(&slab->moving)) {
        return;
    }
    forces(w, before);
    forces(w, s);
    await(set, before);
    await(set, s);
    const haste most = move_range(set, slab->begin, slab->end, w->motion);
    slab->fastest = most.fastest;
    slab->hasty = most.hasty;
}

/* What others wait for comes first, what waits for others last: an even slab beside another range
 * is awaited there, an odd one needs what that range does first. */
static void sweep_range(const sweep *w, uint32_t begin, uint32_t end)
{
    const int late = begin % 2 == 1 && begin + 2 < end;
    if (begin % 2 == 0 && begin > 0) {
        forces(w, begin);
    }
    if (end % 2 == 1 && end - 1 > begin && end < w->set->slab_count) {
        forces(w, end - 1);
    }
    for (uint32_t s = begin | 1U; s < end; s += 2) {
        if (s + 2 < end) {
            forces(w, s + 1);
        }
        if (late && s == begin) {
            continue;
        }
        forces(w, s);
        if (late && s == begin + 2) {
            forces(w, begin);
            move(w, begin + 1);
        }
        if (s > begin) {
            move(w, s);
        }
        if (s + 1 < end) {
            move(w, s + 1);
        }
    }
    forces(w, begin); /* if nothing is moved */
    move(w, begin);
}

/* About what a slab costs: a block of pairs as much as the motion of nine particles. */
static double work_of(const se3di_slab *slab)
{
    return 9.0 * (slab->wall_end - slab->pair_begin) + (slab->end - slab->begin) +
           30.0 * (slab->mesh_end - slab->mesh_begin);
}

/* The first slab of thread `rank` of `team`: where its share of the work begins. */
static uint32_t first_slab(const se3di_particles *set, int rank, int team)
{
    double total = 0.0;
    for (uint32_t s = 0; s < set->slab_count; ++s) {
        total += work_of(&set->slabs[s]);
    }
    double before = 0.0;
    uint32_t s = 0;
    while (s < set->slab_count) {
        double here = work_of(&set->slabs[s]);
        if ((before + 0.5 * here) * team >= total * rank) {
            break;
        }
        before += here;
        ++s;
    }
    return rank < team ? s : set->slab_count;
}

static int has_begun(const int32_t *begun)
{
    int32_t now;
#ifdef _OPENMP
#pragma omp atomic read seq_cst
#endif
    now = *begun;
    return now;
}

/* What others have not begun, from the ends of their ranges. But for the two slabs that they are
 * about to take: what is in their caches costs more to get than to wait for. */
static void help_range(const sweep *w, uint32_t begin, uint32_t end, int moves)
{
    const se3di_slab *slabs = w->set->slabs;
    for (uint32_t s = end; s-- > begin;) {
        const se3di_slab *before = &slabs[s >= begin + 2 ? s - 2 : begin];
        if (moves && !has_begun(&before->moving)) {
            move(w, s);
        } else if (!moves && !has_begun(&before->begun)) {
            forces(w, s);
        }
    }
}

static void help(const sweep *w, int rank, int team)
{
    for (int moves = 0; moves < 2; ++moves) {
        for (int k = 1; k < team; ++k) {
            const int other = (rank + team - k) % team;
            help_range(w, first_slab(w->set, other, team), first_slab(w->set, other + 1, team),
                       moves);
        }
    }
}

static void sweep_share(const sweep *w, int rank, int team)
{
    uint32_t begin = first_slab(w->set, rank, team), end = first_slab(w->set, rank + 1, team);
    if (begin < end) {
        sweep_range(w, begin, end);
    }
    help(w, rank, team);
}

static void sweep_together(const sweep *w)
{
#ifdef _OPENMP
#pragma omp parallel num_threads(se3di_particles_team(w->set))
    {
        const int team = se3di_threads_count();
        const se3di_floats host = se3di_floats_set();
        sweep_share(w, se3di_threads_get_own(), team);
        se3di_floats_restore(host);
#pragma omp master
        w->set->team = team;
    }
#else
    sweep_share(w, 0, 1);
#endif
}

/* Of an audited set that is spread: pairs give nothing, and each wall contact is evaluated once. */
static void sum_powers(se3di_particles *set)
{
    se3di_exact *sums = set->share->powers[0];
    for (uint32_t s = 1; s < set->slab_count; ++s) {
        for (int k = 0; k <= SE3DI_AUDIT_KINDS; ++k) {
            se3di_exact_add_sum(&sums[k], &set->share->powers[s][k]);
        }
    }
    se3di_share_add_exactly(set, SE3DI_AUDIT_KINDS + 1, sums);
    for (int k = 0; k <= SE3DI_AUDIT_KINDS; ++k) {
        set->audit_power[k] = se3di_exact_get(&sums[k]);
    }
}

static void sum_slabs(se3di_particles *set)
{
    double sum[9] = {0.0}, touching = 0.0;
    if (set->audits && se3di_share_is_spread(set)) {
        sum_powers(set);
        return;
    }
    memset(set->audit_power, 0, sizeof set->audit_power);
    for (uint32_t s = 0; s < set->slab_count; ++s) {
        for (int k = 0; k <= SE3DI_AUDIT_KINDS; ++k) {
            set->audit_power[k] += set->slabs[s].power[k];
        }
        for (int k = 0; k < 9; ++k) {
            sum[k] += set->slabs[s].virial[k];
        }
        touching += (double)set->slabs[s].touching;
    }
    memcpy(set->cell.virial, sum, sizeof sum);
    set->cell.touching = touching;
}

void se3di_particles_sweep(se3di_particles *set, const se3di_force_task *task,
                           const se3di_particle_motion *motion)
{
    static const se3di_particle_motion still = {0, 0.0, 0.0};
    /* clumps move when all of their spheres are done, cells when their stress is known, and bonds
     * hold spheres of any slabs; an audit needs the velocities before and after */
    const int waits =
        set->clump_count > 0 || set->bond_count > 0 || set->audits || se3di_domain_strains(set);
    const sweep w = {set, task, waits ? &still : motion};
    set->team = 1;
    for (uint32_t s = 0; s < set->slab_count; ++s) {
        set->slabs[s].done = set->slabs[s].begun = set->slabs[s].moving = 0;
    }
    if (se3di_particles_team(set) > 1) {
        sweep_together(&w);
    } else {
        sweep_share(&w, 0, 1);
    }
    if (waits) {
        sum_slabs(set);
        se3di_bonds_forces(set, task->h);
        if (motion->kicks > 0) {
            pass(set, motion);
        }
        return;
    }
    haste most = {0.0, 0.0};
    for (uint32_t s = 0; s < set->slab_count; ++s) {
        most = hastier(most, (haste){set->slabs[s].fastest, set->slabs[s].hasty});
    }
    note_motion(set, motion, most);
}
