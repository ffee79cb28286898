/* SPDX-License-Identifier: BSD-3-Clause */
/* Shelves: what is found on them, how long it lives, and owners in several threads. */
#include <pthread.h>

#include "base/shelf.h"
#include "check.h"
#include "linsol/kkt.h"
#include "support/counting.h"

typedef struct thing {
    se3di_shelf_item item;
    int number;
} thing;

static atomic_int living;

static void destroy_thing(se3di_shelf_item *item)
{
    atomic_fetch_sub(&living, 1);
    free(item);
}

static thing *make_thing(int number)
{
    thing *made = calloc(1, sizeof *made);
    CHECK(made != NULL);
    se3di_shelf_item_init(&made->item, destroy_thing);
    made->number = number;
    atomic_fetch_add(&living, 1);
    return made;
}

static int is_number(const se3di_shelf_item *item, const void *wanted)
{
    return ((const thing *)(const void *)item)->number == *(const int *)wanted;
}

static thing *find(se3di_shelf *shelf, int number)
{
    return (thing *)(void *)se3di_shelf_find(shelf, is_number, &number);
}

static se3di_shelf *create(support_counting *counting)
{
    const se3d_allocator allocator = support_counting_allocator(counting);
    return se3di_shelf_create(&allocator);
}

static void what_was_put_is_found_until_others_take_its_place(void)
{
    support_counting counting = {0};
    se3di_shelf *shelf = create(&counting);
    for (int k = 0; k < 100; ++k) {
        thing *made = make_thing(k);
        CHECK(find(shelf, k) == NULL);
        se3di_shelf_put(shelf, &made->item);
        thing *found = find(shelf, k);
        CHECK(found == made);
        se3di_shelf_item_drop(&made->item);
        CHECK(found && found->number == k);
        se3di_shelf_item_drop(&found->item);
    }
    CHECK(atomic_load(&living) == 8 && find(shelf, 91) == NULL);
    thing *last = find(shelf, 92);
    CHECK(last != NULL);
    se3di_shelf_keep(shelf);
    se3di_shelf_drop(shelf);
    CHECK(atomic_load(&living) == 8);
    se3di_shelf_drop(shelf);
    CHECK(atomic_load(&living) == 1 && last && last->number == 92);
    se3di_shelf_item_drop(&last->item);
    CHECK(atomic_load(&living) == 0 && counting.live == 0 && counting.wrong == 0);
}

static void where_there_is_no_shelf_nothing_is_found(void)
{
    support_counting counting = {.fail_at = 1};
    CHECK(create(&counting) == NULL);
    thing *made = make_thing(1);
    se3di_shelf_keep(NULL);
    se3di_shelf_put(NULL, &made->item);
    CHECK(find(NULL, 1) == NULL);
    se3di_shelf_drop(NULL);
    se3di_shelf_item_drop(NULL);
    se3di_shelf_item_drop(&made->item);
    CHECK(atomic_load(&living) == 0);
}

/* Somebody who is at the shelf while it is asked. */
typedef struct visitor {
    se3di_shelf *shelf;
    thing *brought;
    int visits;
} visitor;

static int visit(const se3di_shelf_item *item, const void *wanted)
{
    visitor *v = *(visitor *const *)wanted;
    ++v->visits;
    CHECK(find(v->shelf, ((const thing *)(const void *)item)->number) == NULL);
    se3di_shelf_put(v->shelf, &v->brought->item);
    return 0;
}

static void who_comes_while_another_is_there_goes_without(void)
{
    support_counting counting = {0};
    visitor v = {.shelf = create(&counting), .brought = make_thing(2)};
    visitor *wanted = &v;
    thing *first = make_thing(1);
    se3di_shelf_put(v.shelf, &first->item);
    se3di_shelf_item_drop(&first->item);
    CHECK(se3di_shelf_find(v.shelf, visit, &wanted) == NULL && v.visits == 1);
    CHECK(find(v.shelf, 2) == NULL);
    se3di_shelf_item_drop(&v.brought->item);
    CHECK(atomic_load(&living) == 1);
    se3di_shelf_drop(v.shelf);
    CHECK(atomic_load(&living) == 0 && counting.live == 0);
}

/* More kinds of things than there are places: they come and go all the time. */
static void *take_and_put(void *ctx)
{
    se3di_shelf *shelf = ctx;
    intptr_t wrong = 0;
    for (int k = 0; k < 20000; ++k) {
        const int number = k * 7 % 11;
        thing *one = find(shelf, number);
        if (!one) {
            one = make_thing(number);
            se3di_shelf_put(shelf, &one->item);
        }
        wrong += one->number != number;
        se3di_shelf_item_drop(&one->item);
    }
    se3di_shelf_drop(shelf);
    return (void *)wrong;
}

static void owners_may_be_at_work_in_several_threads(void)
{
    support_counting counting = {0};
    se3di_shelf *shelf = create(&counting);
    pthread_t threads[3];
    void *wrong = NULL;
    for (int k = 0; k < 3; ++k) {
        se3di_shelf_keep(shelf);
    }
    for (int k = 0; k < 3; ++k) {
        CHECK(pthread_create(&threads[k], NULL, take_and_put, shelf) == 0);
    }
    se3di_shelf_drop(shelf);
    for (int k = 0; k < 3; ++k) {
        CHECK(pthread_join(threads[k], &wrong) == 0 && wrong == NULL);
    }
    CHECK(atomic_load(&living) == 0 && counting.live == 0 && counting.wrong == 0);
}

/* ---- what is on them: the structure of equations ---------------------------------------------*/

enum { BODIES = 12, JOINTS = 12, SIZE = 6, ROWS = 5 };

/* A ring of bodies and joints of five rows. */
typedef struct ring {
    int32_t rows[JOINTS], begin[JOINTS + 1], body[2 * JOINTS];
    double H[BODIES * SIZE * SIZE], C[2 * JOINTS * ROWS * SIZE];
    double b[BODIES * SIZE], c[JOINTS * ROWS];
    se3di_kkt_pattern pattern;
} ring;

typedef struct answer {
    double x[BODIES * SIZE], l[JOINTS * ROWS];
} answer;

static void fill_ring(ring *r, int32_t rows, uint64_t seed)
{
    *r = (ring){.pattern = {.body_count = BODIES, .joint_count = JOINTS, .body_size = SIZE}};
    for (int32_t k = 0; k < JOINTS; ++k) {
        r->rows[k] = rows;
        r->begin[k + 1] = 2 * k + 2;
        r->body[2 * k] = k;
        r->body[2 * k + 1] = (k + 1) % BODIES;
    }
    for (size_t k = 0; k < sizeof r->H / sizeof *r->H; ++k) {
        const size_t at = k % (SIZE * SIZE);
        r->H[k] = at / SIZE == at % SIZE ? 2.0 + check_random(&seed) : 0.0;
    }
    for (size_t k = 0; k < sizeof r->C / sizeof *r->C; ++k) {
        r->C[k] = check_random(&seed);
    }
    for (size_t k = 0; k < BODIES * SIZE; ++k) {
        r->b[k] = check_random(&seed);
    }
    r->pattern.symmetric = true;
    r->pattern.joint_rows = r->rows;
    r->pattern.joint_begin = r->begin;
    r->pattern.joint_body = r->body;
}

static size_t create_solver(support_counting *counting, const ring *r, se3di_shelf *shelf,
                            se3di_kkt **kkt)
{
    const se3d_allocator allocator = support_counting_allocator(counting);
    const size_t before = counting->calls;
    CHECK(se3di_kkt_create(&allocator, &r->pattern, SE3DI_KKT_STRUCTURED, shelf, kkt) == SE3D_OK);
    return counting->calls - before;
}

static answer solve(se3di_kkt *kkt, const ring *r)
{
    const se3di_kkt_values values = {.body = r->H, .joint = r->C};
    answer out = {{0.0}, {0.0}};
    CHECK(se3di_kkt_factor(kkt, &values, NULL) >= 0);
    CHECK(se3di_kkt_solve(kkt, &values, r->b, r->c, out.x, out.l, NULL) >= 0);
    return out;
}

/* Also when the shelf and the first solver are gone. Numbers are each solver's own. */
static void solvers_of_one_pattern_share_its_structure_and_no_bit_changes(void)
{
    static ring r, other;
    support_counting counting = {0};
    se3di_shelf *shelf = create(&counting);
    se3di_kkt *alone = NULL, *first = NULL, *second = NULL, *foreign = NULL;
    fill_ring(&r, ROWS, 1);
    fill_ring(&other, ROWS - 1, 2);
    const size_t whole = create_solver(&counting, &r, NULL, &alone);
    CHECK(create_solver(&counting, &r, shelf, &first) == whole);
    CHECK(2 * create_solver(&counting, &other, shelf, &foreign) > whole);
    CHECK(2 * create_solver(&counting, &r, shelf, &second) < whole);
    se3di_kkt_destroy(foreign);
    (void)solve(first, &r);
    se3di_shelf_drop(shelf);
    se3di_kkt_destroy(first);
    const answer a = solve(alone, &r), b = solve(second, &r);
    CHECK(fabs(a.x[0]) > 0.0 && memcmp(&a, &b, sizeof a) == 0);
    se3di_kkt_destroy(alone);
    se3di_kkt_destroy(second);
    CHECK(counting.live == 0 && counting.wrong == 0);
}

int main(void)
{
    RUN(what_was_put_is_found_until_others_take_its_place);
    RUN(where_there_is_no_shelf_nothing_is_found);
    RUN(who_comes_while_another_is_there_goes_without);
    RUN(owners_may_be_at_work_in_several_threads);
    RUN(solvers_of_one_pattern_share_its_structure_and_no_bit_changes);
    return check_finish();
}
