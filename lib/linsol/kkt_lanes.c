/* SPDX-License-Identifier: BSD-3-Clause */
/* Several KKT systems of one pattern in lanes: which of them go together, and how those that do not
 * are solved.                                                                docs/theory/kkt.md */
#include "linsol/kkt_lanes.h"

#include <string.h>

#include "linsol/kkt_lanes_internal.h"

#define ALIGN 64 /* bytes */

static const se3di_kkt_lane_core *find_core(int32_t width)
{
    switch (width) {
    case 1:
        return se3di_kkt_lane_core_portable();
    case 4:
        return se3di_kkt_lane_core_avx2();
    case 8:
        return se3di_kkt_lane_core_avx512();
    default:
        return NULL;
    }
}

int32_t se3di_kkt_lanes_widest(void)
{
    return find_core(8) ? 8 : find_core(4) ? 4 : 1;
}

/* ---- memory ---- */

/* An array of the work: where it is kept, its numbers, whether each lane has its own. */
typedef struct part {
    double **to;
    size_t count;
    bool is_wide;
} part;

#define PARTS 20

static void list_parts(se3di_kkt_lanes *s, part parts[PARTS])
{
    const se3di_kkt *kkt = s->kkt;
    const se3di_kkt_pattern *p = &kkt->pattern;
    const size_t nodes = (size_t)kkt->node_count, bodies = p->body_count;
    const size_t n = (size_t)p->body_size, unknowns = kkt->layout.unknown_count;
    const size_t rows = kkt->layout.row_count;
    const part list[] = {
        {&s->upper, kkt->panel[nodes], true},
        {&s->scaled, (size_t)kkt->max_degree * SE3DI_KKT_MAX_BODY_SIZE * KKT_LANES, true},
        {&s->inverse_d, nodes * KKT_LANES, true},
        {&s->z, nodes * KKT_LANES, true},
        {&s->mobility, bodies * KKT_LANES, true},
        {&s->weight, rows, true},
        {&s->e, rows, true},
        {&s->residual_b, unknowns, true},
        {&s->residual_c, rows, true},
        {&s->correction_x, unknowns, true},
        {&s->correction_l, rows, true},
        {&s->top, 1, true},
        {&s->verdict, 1, true},
        {&s->body, bodies * n * n, false},
        {&s->coupling, p->coupling_count * n * n, false},
        {&s->joint, kkt->layout.joint_value_count, false},
        {&s->b, unknowns, false},
        {&s->c, rows, false},
        {&s->x, unknowns, false},
        {&s->l, rows, false},
    };
    _Static_assert(sizeof list == PARTS * sizeof *list, "all of them");
    memcpy(parts, list, sizeof list);
}

/* Each begins at a multiple of ALIGN. */
static size_t room_of(const part *p, size_t width)
{
    const size_t count = p->count * (p->is_wide ? width : 1), step = ALIGN / sizeof(double);
    return (count + step - 1) / step * step;
}

static bool can_have_lanes(const se3di_kkt *kkt)
{
    return kkt->kind == SE3DI_KKT_STRUCTURED && kkt->pattern.symmetric &&
           kkt->pattern.body_size < SE3DI_KKT_MAX_BODY_SIZE;
}

se3d_status se3di_kkt_lanes_create(const se3d_allocator *allocator, se3di_kkt *kkt, int32_t width,
                                   se3di_kkt_lanes **lanes)
{
    const se3di_kkt_lane_core *core = find_core(width);
    part parts[PARTS];
    *lanes = NULL;
    if (!core || !can_have_lanes(kkt)) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    se3di_kkt_lanes *made = se3di_alloc(allocator, 1, sizeof *made);
    if (!made) {
        return SE3D_ERR_NO_MEMORY;
    }
    made->allocator = *allocator;
    made->kkt = kkt;
    made->core = core;
    made->memory_count = ALIGN / sizeof(double);
    list_parts(made, parts);
    for (int k = 0; k < PARTS; ++k) {
        made->memory_count += room_of(&parts[k], (size_t)width);
    }
    made->memory = se3di_alloc(allocator, made->memory_count, sizeof(double));
    if (!made->memory) {
        se3di_kkt_lanes_destroy(made);
        return SE3D_ERR_NO_MEMORY;
    }
    const size_t past = (size_t)((uintptr_t)made->memory % ALIGN);
    double *at = made->memory + (past > 0 ? (ALIGN - past) / sizeof(double) : 0);
    for (int k = 0; k < PARTS; ++k) {
        *parts[k].to = at;
        at += room_of(&parts[k], (size_t)width);
    }
    *lanes = made;
    return SE3D_OK;
}

void se3di_kkt_lanes_destroy(se3di_kkt_lanes *lanes)
{
    if (lanes) {
        const se3d_allocator allocator = lanes->allocator;
        se3di_free(&allocator, lanes->memory, lanes->memory_count, sizeof(double));
        se3di_free(&allocator, lanes, 1, sizeof *lanes);
    }
}

/* ---- together ---- */

static void solve_once(const se3di_kkt_lanes *s, const double *b, const double *c, double *x,
                       double *l)
{
    s->core->scatter(s, b, c);
    s->core->forward(s);
    s->core->backward(s, x, l);
}

/* Whether pivots that are not small would do for the lanes: else none are solved together. */
static bool may_go_together(const se3di_kkt_lanes *s, double eps)
{
    const se3di_kkt_pivots best = {.eps = eps, .least = 1.0, .least_clear = 1.0};
    return eps >= 0.0 && se3di_kkt_count_refinements(s->kkt, &best) >= 0;
}

/* Those that the factorisation of all cannot serve, as the solver's own would be judged. */
static int32_t find_alone(const se3di_kkt_lanes *s, double eps, bool *is_alone)
{
    const se3di_kkt_settings *settings = &s->kkt->settings;
    const double much = settings->wide ? KKT_NONE_SMALL_WIDE : KKT_NONE_SMALL;
    int32_t refinements = 0;
    for (int32_t lane = 0; lane < s->core->width; ++lane) {
        const se3di_kkt_pivots pivots = {
            .eps = eps, .least = 1.0 / s->top[lane], .least_clear = 1.0};
        const int32_t count = se3di_kkt_count_refinements(s->kkt, &pivots);
        is_alone[lane] = s->verdict[lane] != 0.0 || s->top[lane] > much || count < 0;
        refinements = is_alone[lane] ? refinements : count; /* the same for all */
    }
    return refinements;
}

static void solve_together(const se3di_kkt_lanes *s, const se3di_kkt_values *values,
                           const double *b, const double *c, double *x, double *l,
                           se3di_kkt_lanes_info *info)
{
    const size_t unknowns = s->kkt->layout.unknown_count, rows = s->kkt->layout.row_count;
    const double eps = se3di_kkt_first_eps(s->kkt);
    if (!may_go_together(s, eps)) {
        for (int32_t lane = 0; lane < s->core->width; ++lane) {
            info->is_alone[lane] = true;
        }
        return;
    }
    s->core->weigh(s, values, eps);
    s->core->scatter(s, b, c);
    s->core->factor(s, values);
    info->refinements = find_alone(s, eps, info->is_alone);
    s->core->backward(s, x, l);
    for (int32_t k = 0; k < info->refinements; ++k) {
        s->core->residual(s, values, b, c, x, l);
        solve_once(s, s->residual_b, s->residual_c, s->correction_x, s->correction_l);
        s->core->add(unknowns, s->correction_x, x);
        s->core->add(rows, s->correction_l, l);
    }
    s->core->check(s, unknowns, x);
    s->core->check(s, rows, l);
    for (int32_t lane = 0; lane < s->core->width; ++lane) {
        info->is_alone[lane] = info->is_alone[lane] || s->verdict[lane] != 0.0;
    }
}

/* ---- alone ---- */

static void take_lane(const double *from, size_t count, size_t width, double *to)
{
    for (size_t i = 0; i < count; ++i) {
        to[i] = from[i * width];
    }
}

static void give_lane(const double *from, size_t count, size_t width, double *to)
{
    for (size_t i = 0; i < count; ++i) {
        to[i * width] = from[i];
    }
}

static se3d_status solve_alone(const se3di_kkt_lanes *s, size_t lane, const se3di_kkt_values *v,
                               const double *b, const double *c, double *x, double *l)
{
    const se3di_kkt_pattern *p = &s->kkt->pattern;
    const size_t width = (size_t)s->core->width, n = (size_t)p->body_size;
    const size_t unknowns = s->kkt->layout.unknown_count, rows = s->kkt->layout.row_count;
    const se3di_kkt_values own = {
        .body = s->body, .coupling_upper = s->coupling, .joint = s->joint};
    take_lane(v->body + lane, unknowns * n, width, s->body);
    if (p->coupling_count > 0) {
        take_lane(v->coupling_upper + lane, p->coupling_count * n * n, width, s->coupling);
    }
    if (rows > 0) {
        take_lane(v->joint + lane, s->kkt->layout.joint_value_count, width, s->joint);
    }
    take_lane(b + lane, unknowns, width, s->b);
    if (c) {
        take_lane(c + lane, rows, width, s->c);
    }
    se3di_kkt_hold(s->kkt, false);
    se3di_kkt_expect(s->kkt, NULL, NULL);
    se3d_status status = se3di_kkt_factor(s->kkt, &own, NULL);
    if (status >= 0) {
        status = se3di_kkt_solve(s->kkt, &own, s->b, c ? s->c : NULL, s->x, s->l, NULL);
        give_lane(s->x, unknowns, width, x + lane);
        give_lane(s->l, rows, width, l + lane);
    }
    return status;
}

se3d_status se3di_kkt_lanes_solve(se3di_kkt_lanes *lanes, const se3di_kkt_values *values,
                                  const double *b, const double *c, double *x, double *l,
                                  se3di_kkt_lanes_info *info)
{
    se3d_status first = SE3D_OK;
    *info = (se3di_kkt_lanes_info){.refinements = 0};
    solve_together(lanes, values, b, c, x, l, info);
    for (int32_t lane = 0; lane < lanes->core->width; ++lane) {
        if (info->is_alone[lane]) {
            info->status[lane] = solve_alone(lanes, (size_t)lane, values, b, c, x, l);
            first = first < 0 || info->status[lane] >= 0 ? first : info->status[lane];
        }
    }
    return first;
}
