/* SPDX-License-Identifier: BSD-3-Clause */
/* Snapshots as bytes: what is cut, changed or of another model is refused; bytes that were made up
 * with a right checksum do no harm. */
#include <string.h>

#include "base/hash.h"
#include "check.h"
#include "model/model.h"
#include "support/ball_on_floor.h"
#include "support/damage.h"
#include "support/models.h"
#include "support/world.h"

enum { ROOM = 20000 };

typedef struct world {
    support_model model;
    se3d_solver *solver;
    unsigned char bytes[ROOM];
    size_t size;
} world;

static void add_ball(se3d_system *system, double height)
{
    const double v[3] = {0.0, 0.0, 0.0};
    (void)add_ball_of(system, add_floor_of(system, 1000.0, 1e4, 0.0), 0.01, height, v);
}

static void open_world(world *w, int32_t method)
{
    se3d_solver_def def = se3d_solver_def_default();
    se3d_snapshot *snapshot = NULL;
    support_model_make(&w->model, "four_bar", 1);
    add_ball(w->model.system, 0.0995);
    def.method = method;
    CHECK(!se3d_solver_create(w->model.system, &def, &w->solver));
    CHECK(se3d_solver_run(w->solver, 0.02) >= 0);
    CHECK(se3d_system_count_contacts(w->model.system) == 1);
    CHECK(!se3d_snapshot_create(w->model.system, &snapshot));
    CHECK(!se3d_snapshot_write(snapshot, w->bytes, ROOM, &w->size));
    se3d_snapshot_destroy(snapshot);
}

static void close_world(world *w)
{
    se3d_solver_destroy(w->solver);
    support_model_destroy(&w->model);
}

static se3d_status read_bytes(world *w, const unsigned char *bytes, size_t size,
                              se3d_snapshot **snapshot)
{
    return se3d_snapshot_read(w->model.system, bytes, size, snapshot);
}

static int is_refused(world *w, const unsigned char *bytes, size_t size, const char *why)
{
    se3d_snapshot *snapshot = NULL;
    const se3d_status status = read_bytes(w, bytes, size, &snapshot);
    const char *message = se3d_system_get_error(w->model.system);
    const int holds = status < 0 && !snapshot && strstr(message, why) != NULL;
    if (!holds) {
        fprintf(stderr, "status %d, `%s` should have: %s\n", (int)status, message, why);
    }
    return holds;
}

static void sign(unsigned char *bytes, size_t size)
{
    const uint64_t sum = se3di_hash_bytes(SE3DI_HASH_START, bytes, size - 8);
    for (int k = 0; k < 8; ++k) {
        bytes[size - 8 + (size_t)k] = (unsigned char)(sum >> (8 * k));
    }
}

static void cut_and_changed_bytes_are_refused(void)
{
    static world w;
    static unsigned char bytes[ROOM];
    open_world(&w, SE3D_METHOD_AUTO);
    for (size_t size = 0; size < w.size; ++size) {
        se3d_snapshot *snapshot = NULL;
        CHECK(read_bytes(&w, w.bytes, size, &snapshot) == SE3D_ERR_INVALID_ARGUMENT && !snapshot);
    }
    for (size_t k = 0; k < w.size; ++k) {
        se3d_snapshot *snapshot = NULL;
        memcpy(bytes, w.bytes, w.size);
        bytes[k] ^= 0x10;
        CHECK(read_bytes(&w, bytes, w.size, &snapshot) == SE3D_ERR_INVALID_ARGUMENT && !snapshot);
    }
    CHECK(is_refused(&w, w.bytes, 10, "too few"));
    CHECK(is_refused(&w, w.bytes, w.size - 8, "damaged or cut"));
    memcpy(bytes, w.bytes, w.size);
    char version[24]; /* a later one */
    snprintf(version, sizeof version, "version %d", ++bytes[8]);
    CHECK(is_refused(&w, bytes, w.size, version));
    bytes[8] = 4; /* before cells that strain, broken joints and what convex remembers */
    CHECK(is_refused(&w, bytes, w.size, "a snapshot of version 4, must be of version 12"));
    bytes[0] = 'X';
    CHECK(is_refused(&w, bytes, w.size, "must begin with SE3DSNAP"));
    close_world(&w);
}

static void another_model_is_refused(void)
{
    static world w, other;
    open_world(&w, SE3D_METHOD_AUTO);
    open_world(&other, SE3D_METHOD_AUTO);
    add_ball(other.model.system, 3.0);
    CHECK(is_refused(&other, w.bytes, w.size, "of another model"));
    close_world(&other);
    close_world(&w);
}

/* A body that a driver holds in one coordinate of a cylindrical joint, or in that of another joint
 * between the same bodies. */
static se3d_system *create_driven(int32_t coordinate, int second)
{
    const double at[3] = {0.0, 0.0, 0.0}, axis[3] = {0.0, 0.0, 1.0};
    se3d_system *system = NULL;
    se3d_body body, ground;
    se3d_constraint joints[2], driver;
    se3d_body_def def = se3d_body_def_default();
    se3d_driver_def drives = se3d_driver_def_default();
    CHECK(!se3d_system_create(NULL, &system));
    def.mass = def.inertia[0] = def.inertia[1] = def.inertia[2] = 1.0;
    CHECK(!se3d_body_create(system, &def, &body));
    CHECK(!se3d_system_get_ground(system, &ground));
    for (int k = 0; k < 2; ++k) {
        joints[k] = world_join(system, se3d_joint_create_cylindrical, NULL, ground, body, at, axis);
    }
    drives.joint = joints[second];
    drives.coordinate = coordinate;
    CHECK(!se3d_driver_create(system, &drives, &driver));
    return system;
}

static void drivers_of_other_coordinates_are_another_model(void)
{
    static const struct {
        int32_t coordinate;
        int second;
    } rows[] = {{SE3D_JOINT_COORDINATE_ANGLE, 0},
                {SE3D_JOINT_COORDINATE_DISPLACEMENT, 0},
                {SE3D_JOINT_COORDINATE_ANGLE, 1}};
    for (int a = 0; a < 3; ++a) {
        for (int b = 0; b < 3; ++b) {
            unsigned char bytes[ROOM];
            size_t size = 0;
            se3d_snapshot *snapshot = NULL, *read = NULL;
            se3d_system *from = create_driven(rows[a].coordinate, rows[a].second);
            se3d_system *to = create_driven(rows[b].coordinate, rows[b].second);
            CHECK(!se3d_snapshot_create(from, &snapshot));
            CHECK(!se3d_snapshot_write(snapshot, bytes, ROOM, &size));
            CHECK((se3d_snapshot_read(to, bytes, size, &read) >= 0) == (a == b));
            se3d_snapshot_destroy(read);
            se3d_snapshot_destroy(snapshot);
            se3d_system_destroy(from);
            se3d_system_destroy(to);
        }
    }
}

/* Whatever one word says, nothing is read or written that is not there, and what is taken can be
 * gone on with: the run ends well or with a message. */
static void made_up_words_do_no_harm(void)
{
    static const int32_t methods[] = {
        SE3D_METHOD_DOP853, SE3D_METHOD_BDF,    SE3D_METHOD_RADAU, SE3D_METHOD_GENERALIZED_ALPHA,
        SE3D_METHOD_RATTLE, SE3D_METHOD_CONVEX, SE3D_METHOD_GAUSS};
    static world w;
    static unsigned char bytes[ROOM];
    for (size_t m = 0; m < sizeof methods / sizeof *methods; ++m) {
        size_t taken = 0, refused = 0;
        open_world(&w, methods[m]);
        for (size_t at = 16; at + 16 <= w.size; at += 8) {
            const uint64_t word = damage_words[(at / 8) % DAMAGE_WORDS];
            se3d_snapshot *snapshot = NULL;
            memcpy(bytes, w.bytes, w.size);
            damage_write(bytes, at, word);
            sign(bytes, w.size);
            const se3d_status status = read_bytes(&w, bytes, w.size, &snapshot);
            CHECK((status >= 0) == (snapshot != NULL));
            refused += status < 0;
            if (status >= 0 && at % 24 == 0) {
                double time;
                ++taken;
                CHECK(!se3d_snapshot_restore(snapshot, w.model.system));
                CHECK(!se3d_system_get_time(w.model.system, &time));
                (void)se3d_solver_step(w.solver, 1e-3);
            }
            se3d_snapshot_destroy(snapshot);
        }
        CHECK(taken > 20 && refused > 20);
        close_world(&w);
    }
}

/* Every number of every method, whatever it is of: but for the number of redundant rows and the
 * ages of what acts, whole numbers of which any will do. */
static void numbers_that_are_not_finite_are_refused(void)
{
    static const uint64_t words[] = {UINT64_C(0x7FF8000000000000), UINT64_C(0xFFF0000000000000)};
    static world w;
    static unsigned char bytes[ROOM];
    for (int32_t method = 1; *se3d_method_get_name(method); ++method) {
        size_t taken = 0;
        open_world(&w, method);
        for (size_t at = 16; at + 16 <= w.size; at += 8) {
            se3d_snapshot *snapshot = NULL;
            memcpy(bytes, w.bytes, w.size);
            damage_write(bytes, at, words[at / 8 % 2]);
            sign(bytes, w.size);
            taken += read_bytes(&w, bytes, w.size, &snapshot) >= 0;
            se3d_snapshot_destroy(snapshot);
        }
        CHECK(taken == 3);
        close_world(&w);
    }
}

/* Rows are left out as dependent, of a broken joint, or of one whose bodies have been apart since:
 * 0, 1, 2, 6. */
static void rows_that_are_left_out_for_no_reason_are_refused(void)
{
    static world w;
    static unsigned char bytes[ROOM];
    const unsigned char broken[8] = {SE3DI_ROW_BROKEN};
    se3d_constraint joint;
    se3d_snapshot *snapshot = NULL;
    size_t at = 16, found = 0;
    open_world(&w, SE3D_METHOD_AUTO);
    CHECK(!se3d_system_get_constraint(w.model.system, 0, &joint));
    CHECK(!se3d_joint_set_broken(w.model.system, joint, 1));
    CHECK(!se3d_snapshot_create(w.model.system, &snapshot));
    CHECK(!se3d_snapshot_write(snapshot, w.bytes, ROOM, &w.size));
    se3d_snapshot_destroy(snapshot);
    for (size_t k = 16; k + 8 <= w.size && found < 5; k += 8) { /* of a revolute joint */
        found = memcmp(w.bytes + k, broken, sizeof broken) == 0 ? found + 1 : 0;
        at = k - 8 * 4;
    }
    CHECK(found == 5);
    for (uint64_t flag = 0; flag < 9; ++flag) {
        memcpy(bytes, w.bytes, w.size);
        for (size_t row = 0; row < 5; ++row) {
            damage_write(bytes, at + 8 * row, flag);
        }
        sign(bytes, w.size);
        CHECK(
            (read_bytes(&w, bytes, w.size, &snapshot) >= 0) ==
            (flag == SE3DI_ROW_DEPENDENT || flag == SE3DI_ROW_BROKEN || flag == SE3DI_ROW_BREAKS));
        se3d_snapshot_destroy(snapshot);
    }
    close_world(&w);
}

int main(void)
{
    RUN(numbers_that_are_not_finite_are_refused);
    RUN(cut_and_changed_bytes_are_refused);
    RUN(another_model_is_refused);
    RUN(drivers_of_other_coordinates_are_another_model);
    RUN(made_up_words_do_no_harm);
    RUN(rows_that_are_left_out_for_no_reason_are_refused);
    return check_finish();
}
