/* SPDX-License-Identifier: BSD-3-Clause */
/* `bonds`. */
#include "io/read/bonds.h"

#include "io/base/pool.h"
#include "io/document/document.h"
#include "io/document/fields.h"
#include "io/document/keys.h"
#include "io/document/value.h"
#include "io/model/model.h"
#include "io/model/tagged.h"
#include "io/read/entries.h"
#include "io/read/objects.h"
#include "io/read/particle_names.h"
#include "se3d/bond.h"

#include <math.h>

static const char *const laws[] = {[SE3D_BOND_LAW_BEAM] = "beam",
                                   [SE3D_BOND_LAW_SLENDER] = "slender",
                                   [SE3D_BOND_LAW_PARALLEL] = "parallel",
                                   [SE3D_BOND_LAW_SPRINGS] = "springs",
                                   NULL};

/* clang-format off */
static const se3di_key bond_keys[] = {
    {"name", SE3DI_KIND_NAME, .required = true, .text = "for its channels"},
    {"set", SE3DI_KIND_TEXT, .standard = "all particles",
     .text = "a name of `particles`: those are bonded with each other"},
    {"with", SE3DI_KIND_TEXT, .standard = "the same",
     .text = "another name of `particles`: those of `set` with these"},
    {"shape", SE3DI_KIND_TEXT,
     .text = "the name of a shape: those of `set` are bonded to its nearest points instead"},
    {"pairs", SE3DI_KIND_PAIRS,
     .text = "[id, id] of the particles to bond, however far apart, in place of all that are near"},
    {"gap", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE, SE3DI_INTO(se3d_bond_def, gap), .standard = "0",
     .text = "the most between the surfaces of what is bonded [m]"},
    {"law", SE3DI_KIND_WORD, SE3DI_INTO(se3d_bond_def, law), .words = laws, .standard = "beam",
     .text = "beam: Timoshenko's; slender: Euler and Bernoulli's; parallel: the parallel bond of "
         "Potyondy and Cundall; springs: as given"},
    {"radius", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3d_bond_def, radius),
     .standard = "by `ratio`", .text = "of the section [m]"},
    {"ratio", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3d_bond_def, ratio),
     .standard = "1", .text = "of that radius to the smaller sphere's"},
    {"young", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3d_bond_def, young),
     .text = "of beams: Young's modulus [Pa]"},
    {"poisson", SE3DI_KIND_NUMBER, SE3DI_INTO(se3d_bond_def, poisson), .standard = "0",
     .text = "of beams: Poisson's ratio"},
    {"normal_stiffness", SE3DI_KIND_NUMBER, SE3DI_POSITIVE,
     SE3DI_INTO(se3d_bond_def, normal_stiffness), .text = "of parallel bonds, per area [Pa/m]"},
    {"shear_stiffness", SE3DI_KIND_NUMBER, SE3DI_POSITIVE,
     SE3DI_INTO(se3d_bond_def, shear_stiffness), .text = "of parallel bonds, per area [Pa/m]"},
    {"damping", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE, SE3DI_INTO(se3d_bond_def, damping),
     .standard = "0", .text = "part of the critical one of each of their springs, at most 1"},
    {"tensile_strength", SE3DI_KIND_NUMBER, SE3DI_POSITIVE,
     SE3DI_INTO(se3d_bond_def, tensile_strength), .standard = "does not break so",
     .text = "of the outermost fibre [Pa]"},
    {"shear_strength", SE3DI_KIND_NUMBER, SE3DI_POSITIVE,
     SE3DI_INTO(se3d_bond_def, shear_strength), .standard = "does not break so",
     .text = "of the outermost fibre [Pa]"},
    {"springs", SE3DI_KIND_NUMBERS,
     .text = "of the law springs: 4, normal, shear [N/m], bending, twisting [N m]"},
    {"dampers", SE3DI_KIND_NUMBERS, .standard = "none",
     .text = "beside them [N s/m], [N m s]"},
    {"limits", SE3DI_KIND_NUMBERS, .standard = "does not break",
     .text = "of the law springs: 4 forces [N] and moments [N m]; it breaks when the sum of what "
         "it holds over them is above 1, 0: does not count"},
    {"smooth", SE3DI_KIND_BOOL, SE3DI_INTO(se3d_bond_def, smooth), .standard = "false",
     .text = "of the law springs: at the share s of its limits a bond does 1 - s^4 of what it "
         "would"},
    {"contact", SE3DI_KIND_BOOL, SE3DI_INTO(se3d_bond_def, contact), .standard = "false",
     .text = "what is bonded touches, too"},
    {.key = NULL}};
const se3di_object se3di_object_bond = {
    "bond",
    "Beams between particles that are near, listed, or near a shape, until they break.",
    bond_keys, NULL,
    NULL};
/* clang-format on */

/* Ids of particles, two by two. */
static bool read_pairs(se3di_reader *reader, const se3di_node *list, uint32_t *ids[2])
{
    if (list->kind != SE3DI_NODE_LIST) {
        return se3di_reader_fail(reader, list, "must be a list of pairs [id, id]");
    }
    for (int n = 0; n < 2; ++n) {
        ids[n] = se3di_iopool_array(reader->pool, list->count + 1, sizeof *ids[n]);
        if (!ids[n]) {
            return se3di_reader_fail_memory(reader);
        }
    }
    size_t k = 0;
    for (const se3di_node *pair = list->first; pair; pair = pair->next, ++k) {
        double values[2];
        if (!se3di_read_vector(reader, pair, 2, values)) {
            return false;
        }
        for (int n = 0; n < 2; ++n) {
            if (!(values[n] >= 0.0 && values[n] < 4294967295.0) || values[n] > floor(values[n])) {
                return se3di_reader_fail(reader, pair, "is [%g, %g], must be ids of particles",
                                         values[0], values[1]);
            }
            ids[n][k] = (uint32_t)values[n];
        }
    }
    return true;
}

/* Keys that say otherwise whom to bond. */
static bool check_beside(se3di_reader *reader, const se3di_node *node)
{
    static const char *const others[] = {"set", "with", "shape", "gap"};
    if (se3di_node_get(node, "shape") && se3di_node_get(node, "with")) {
        return se3di_reader_fail_key(reader, node, "with", "and `shape` exclude each other");
    }
    for (size_t k = 0; k < sizeof others / sizeof *others && se3di_node_get(node, "pairs"); ++k) {
        if (se3di_node_get(node, others[k])) {
            return se3di_reader_fail_key(reader, node, others[k],
                                         "has no effect with `pairs`, which says who is bonded");
        }
    }
    return true;
}

static bool make_bonds(se3di_reader *reader, const se3di_node *node, const se3d_bond_def *def)
{
    se3d_particles *set = reader->model->particles->set;
    const se3di_node *pairs = se3di_node_get(node, "pairs"), *on = se3di_node_get(node, "shape");
    int32_t tags[2] = {-1, -1};
    uint32_t *ids[2] = {NULL, NULL};
    se3d_shape shape = {0, 0};
    size_t added = 1;
    se3d_status status;
    if (!se3di_read_key_set(reader, node, "set", &tags[0]) ||
        !se3di_read_key_set(reader, node, "with", &tags[1]) ||
        (on && !se3di_read_shape_name(reader, on, &shape)) ||
        (pairs && !read_pairs(reader, pairs, ids))) {
        return false;
    }
    tags[1] = se3di_node_get(node, "with") ? tags[1] : tags[0];
    if (pairs) {
        status = se3d_particles_bond(set, def, pairs->count, ids[0], ids[1], NULL);
    } else if (on) {
        status = se3d_particles_bond_shape(set, def, shape, tags[0], &added, NULL);
    } else {
        status = se3d_particles_bond_near(set, def, tags[0], tags[1], &added, NULL);
    }
    if (status < 0) {
        return se3di_reader_fail_system(reader, node, status);
    }
    return added > 0 ||
           se3di_reader_fail(reader, node, "bonds nothing: no surfaces are nearer than `gap`, %g m",
                             def->gap);
}

/* Keys of other laws. */
static bool check_law(se3di_reader *reader, const se3di_node *node, int32_t law)
{
    enum {
        BEAMS = 1 << SE3D_BOND_LAW_BEAM | 1 << SE3D_BOND_LAW_SLENDER,
        PARALLEL = 1 << SE3D_BOND_LAW_PARALLEL,
        SPRINGS = 1 << SE3D_BOND_LAW_SPRINGS
    };
    static const struct {
        const char *key;
        int laws;
    } keys[] = {{"young", BEAMS},
                {"poisson", BEAMS},
                {"normal_stiffness", PARALLEL},
                {"shear_stiffness", PARALLEL},
                {"radius", BEAMS | PARALLEL},
                {"ratio", BEAMS | PARALLEL},
                {"tensile_strength", BEAMS | PARALLEL},
                {"shear_strength", BEAMS | PARALLEL},
                {"springs", SPRINGS},
                {"dampers", SPRINGS},
                {"limits", SPRINGS},
                {"smooth", SPRINGS}};
    for (size_t k = 0; k < sizeof keys / sizeof *keys; ++k) {
        if (!(keys[k].laws >> law & 1) && se3di_node_get(node, keys[k].key)) {
            return se3di_reader_fail_key(reader, node, keys[k].key,
                                         keys[k].laws == SPRINGS
                                             ? "has no effect without `law: springs`"
                                             : "has no effect with this `law`");
        }
    }
    return true;
}

/* Numbers of the four springs. */
static bool read_springs(se3di_reader *reader, const se3di_node *node, se3d_bond_def *def)
{
    const struct {
        const char *key;
        double *into;
    } fours[] = {{"springs", def->springs}, {"dampers", def->dampers}, {"limits", def->limits}};
    for (size_t k = 0; k < sizeof fours / sizeof *fours; ++k) {
        const se3di_node *value = se3di_node_get(node, fours[k].key);
        if (value && !se3di_read_vector(reader, value, 4, fours[k].into)) {
            return false;
        }
    }
    return true;
}

static bool read_bond(se3di_reader *reader, const se3di_node *node)
{
    se3di_tagged *particles = reader->model->particles;
    const se3di_node *name = se3di_node_get(node, "name");
    const char *text = NULL;
    se3d_bond_def def = se3d_bond_def_default();
    if (!se3di_read_keys(reader, node, &se3di_object_bond)) {
        return false;
    }
    if (!name) {
        return se3di_reader_fail(reader, node, "must have `name`");
    }
    if (!se3di_read_name(reader, name, &text) || !se3di_check_free_name(reader, name, text) ||
        !se3di_read_fields(reader, node, &se3di_object_bond, NULL, "se3d_bond_def", &def) ||
        !check_law(reader, node, def.law) || !read_springs(reader, node, &def) ||
        !check_beside(reader, node)) {
        return false;
    }
    particles->bonds[particles->bond_count++] = text;
    return make_bonds(reader, node, &def);
}

bool se3di_read_bonds(se3di_reader *reader, const se3di_node *list)
{
    se3di_tagged *particles = reader->model->particles;
    particles->bonds = se3di_read_room(reader, list, sizeof *particles->bonds);
    return particles->bonds && se3di_read_entries(reader, list, read_bond);
}
