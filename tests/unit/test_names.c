/* SPDX-License-Identifier: BSD-3-Clause */
/* Names of elements: found after a look or two however many there are; unique among their owner's;
 * right after removals, in copies, and after failures. */
#include <stdlib.h>
#include <string.h>

#include "base/names.h"
#include "base/slots.h"
#include "check.h"
#include "se3d/se3d.h"

#define MANY 100000

static void *allocate(void *ctx, size_t size)
{
    (void)ctx;
    return malloc(size);
}

static void *reallocate(void *ctx, void *memory, size_t old, size_t size)
{
    (void)ctx;
    (void)old;
    return realloc(memory, size);
}

static void release(void *ctx, void *memory, size_t size)
{
    (void)ctx;
    (void)size;
    free(memory);
}

static const se3d_allocator allocator = {allocate, reallocate, release, NULL};

/* Entries that a search for every name looks at, together. */
static size_t count_looks(const se3di_names *names)
{
    size_t looks = 0;
    size_t run = 0; /* neighbours before this entry, an upper bound of its distance from home */
    for (size_t k = 0; k < 2 * names->capacity; ++k) {
        run = names->entries[k % names->capacity].text ? run + 1 : 0;
        looks += k >= names->capacity ? run : 0;
    }
    return looks;
}

static void a_name_is_found_after_a_few_looks_among_many(void)
{
    static char texts[MANY][12];
    se3di_names names = {NULL, 0, 0};
    for (uint32_t k = 0; k < MANY; ++k) {
        snprintf(texts[k], sizeof texts[k], "link%u", k);
        CHECK(se3di_names_reserve(&names, &allocator, names.count + 1) == SE3D_OK);
        se3di_names_add(&names, 0, texts[k], k);
    }
    CHECK(names.count == MANY);
    CHECK(names.capacity >= 2 * MANY && names.capacity <= 8 * MANY);
    CHECK(count_looks(&names) < 4 * MANY);
    for (uint32_t k = 0; k < MANY; ++k) {
        if (se3di_names_find(&names, 0, texts[k]) != k) {
            CHECK(0);
        }
    }
    CHECK(se3di_names_find(&names, 0, "link") == SE3DI_NO_INDEX);
    CHECK(se3di_names_find(&names, 1, "link1") == SE3DI_NO_INDEX);
    se3di_names_destroy(&names, &allocator);
}

/* Against a plain list, with few names so that they meet, and owners. */
static void names_come_and_go_in_any_order(void)
{
    static const char *const texts[] = {"a", "b", "c", "d", "e", "f", "g", "h", "", "aa", "ab"};
    enum { TEXTS = sizeof texts / sizeof *texts, OWNERS = 3 };
    uint32_t there[OWNERS][TEXTS];
    se3di_names names = {NULL, 0, 0};
    uint64_t random = 12345;
    memset(there, 0xFF, sizeof there);
    CHECK(se3di_names_find(&names, 0, "a") == SE3DI_NO_INDEX);
    se3di_names_remove(&names, 0, "a");
    for (uint32_t k = 0; k < 20000; ++k) {
        random = random * 6364136223846793005u + 1442695040888963407u;
        const uint32_t owner = (uint32_t)(random >> 40) % OWNERS;
        const uint32_t text = (uint32_t)(random >> 50) % TEXTS;
        if (there[owner][text] == SE3DI_NO_INDEX) {
            CHECK(se3di_names_reserve(&names, &allocator, names.count + 1) == SE3D_OK);
            se3di_names_add(&names, owner, texts[text], k);
            there[owner][text] = k;
        } else {
            se3di_names_remove(&names, owner, texts[text]);
            there[owner][text] = SE3DI_NO_INDEX;
        }
        for (uint32_t i = 0; i < OWNERS * TEXTS; ++i) {
            const uint32_t found = se3di_names_find(&names, i / TEXTS, texts[i % TEXTS]);
            if (found != there[i / TEXTS][i % TEXTS]) {
                CHECK(0);
            }
        }
    }
    se3di_names_destroy(&names, &allocator);
}

static se3d_body make_body(se3d_system *system, const char *name, se3d_status expected)
{
    se3d_body body;
    se3d_body_def def = se3d_body_def_default();
    def.name = name;
    def.mass = def.inertia[0] = def.inertia[1] = def.inertia[2] = 1.0;
    CHECK(se3d_body_create(system, &def, &body) == expected);
    return body;
}

static se3d_status make_marker(se3d_system *system, se3d_body body, se3d_marker *marker)
{
    se3d_marker_def def = se3d_marker_def_default();
    def.body = body;
    def.name = "tip";
    return se3d_marker_create(system, &def, marker);
}

/* Every body has a marker of the same name, a joint and a force. */
static void a_system_of_many_elements_is_built_and_searched(void)
{
    se3d_system *system = NULL;
    se3d_system *copy = NULL;
    se3d_body ground;
    se3d_body last;
    se3d_marker marker;
    char name[32] = "";
    CHECK(se3d_system_create(NULL, &system) == SE3D_OK);
    CHECK(se3d_system_get_ground(system, &ground) == SE3D_OK);
    for (int k = 0; k < MANY; ++k) {
        se3d_load_def load = se3d_load_def_default();
        se3d_joint_def joint = se3d_joint_def_default();
        se3d_force force;
        se3d_constraint pin;
        snprintf(name, sizeof name, "link%d", k);
        last = make_body(system, name, SE3D_OK);
        load.name = joint.name = name;
        load.body = joint.body_j = last;
        joint.body_i = ground;
        if (make_marker(system, last, &marker) < 0 ||
            se3d_joint_create_spherical(system, &joint, &pin) < 0 ||
            se3d_force_create_load(system, &load, &force) < 0) {
            CHECK(0);
        }
    }
    CHECK(make_marker(system, last, &marker) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(system), "\"tip\" is taken by another marker");
    make_body(system, name, SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_system_clone(system, &copy) == SE3D_OK);
    for (int k = 0; k < MANY; k += 7) {
        se3d_body body;
        se3d_constraint pin;
        se3d_force force;
        const char *back = "";
        snprintf(name, sizeof name, "link%d", k);
        if (se3d_body_find(copy, name, &body) < 0 || se3d_constraint_find(copy, name, &pin) < 0 ||
            se3d_force_find(copy, name, &force) < 0 || se3d_body_get_name(copy, body, &back) < 0 ||
            strcmp(back, name) != 0) {
            CHECK(0);
        }
    }
    se3d_system_destroy(system);
    make_body(copy, "link5", SE3D_ERR_INVALID_ARGUMENT);
    se3d_system_destroy(copy);
}

static void a_name_is_free_again_when_its_element_is_gone(void)
{
    se3d_system *system = NULL;
    se3d_body found;
    CHECK(se3d_system_create(NULL, &system) == SE3D_OK);
    const se3d_body a = make_body(system, "a", SE3D_OK);
    const se3d_body b = make_body(system, "b", SE3D_OK);
    se3d_marker tips[2];
    CHECK(make_marker(system, a, &tips[0]) == SE3D_OK);
    CHECK(make_marker(system, b, &tips[1]) == SE3D_OK);
    CHECK(se3d_marker_destroy(system, tips[0]) == SE3D_OK);
    CHECK(se3d_body_destroy(system, a) == SE3D_OK); /* b's dense index changes */
    CHECK(make_marker(system, b, &tips[0]) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_marker_destroy(system, tips[1]) == SE3D_OK);
    CHECK(make_marker(system, b, &tips[1]) == SE3D_OK);
    CHECK(se3d_body_find(system, "a", &found) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_body_find(system, "b", &found) == SE3D_OK);
    CHECK(found.index1 == b.index1 && found.generation == b.generation);
    make_body(system, "a", SE3D_OK);
    make_body(system, "a", SE3D_ERR_INVALID_ARGUMENT);
    se3d_system_destroy(system);
}

static int is_plain(const char *text)
{
    for (size_t n; (n = se3d_text_get_character(text)) > 0;) {
        text += n;
    }
    return *text == '\0';
}

static void names_are_characters_that_can_be_shown(void)
{
    static const char *const bad[] = {"\xff",
                                      "\xc3",
                                      "\xc0\xaf",
                                      "\xe0\x80\xaf",
                                      "\xed\xa0\x80",
                                      "\xf4\x90\x80\x80",
                                      "\xf5\x80\x80\x80",
                                      "\xe2\x28\xa1",
                                      "K\xf6rper",
                                      "cut \xe2\x98",
                                      "\xc2\x85",
                                      "\xe2\x80\xa8",
                                      "\xe2\x80\xae",
                                      "\xe2\x81\xa6",
                                      "\xef\xbb\xbf",
                                      "\xef\xbf\xbf",
                                      "\x1b[31m",
                                      "a\tb",
                                      "a\r",
                                      "\x7f",
                                      "",
                                      "a.b"};
    static const char *const good[] = {"K\xc3\xb6rper \xe2\x98\x83", "\xf0\x9f\x94\xa9",
                                       "<b> & 'x'", "$(x)"};
    se3d_system *system = NULL;
    CHECK(se3d_system_create(NULL, &system) == SE3D_OK);
    for (size_t k = 0; k < sizeof bad / sizeof *bad; ++k) {
        make_body(system, bad[k], SE3D_ERR_INVALID_ARGUMENT);
        CHECK(is_plain(se3d_system_get_error(system)));
        CHECK_CONTAINS(se3d_system_get_error(system), "must be UTF-8");
    }
    for (size_t k = 0; k < sizeof good / sizeof *good; ++k) {
        make_body(system, good[k], SE3D_OK);
    }
    /* A message quotes a part of it: the last character is not cut. */
    char name[200] = "";
    for (size_t k = 0; k < 63; ++k) {
        memcpy(name + 3 * k, "\xe2\x98\x83", 3);
    }
    make_body(system, name, SE3D_OK);
    make_body(system, name, SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(system), "is taken");
    CHECK(is_plain(se3d_system_get_error(system)));
    se3d_system_destroy(system);
}

int main(void)
{
    RUN(names_are_characters_that_can_be_shown);
    RUN(a_name_is_found_after_a_few_looks_among_many);
    RUN(names_come_and_go_in_any_order);
    RUN(a_system_of_many_elements_is_built_and_searched);
    RUN(a_name_is_free_again_when_its_element_is_gone);
    return check_finish();
}
