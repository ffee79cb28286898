/* SPDX-License-Identifier: BSD-3-Clause */
/* `particles`. */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "io/base/pool.h"
#include "io/document/document.h"
#include "io/document/fields.h"
#include "io/document/function.h"
#include "io/document/keys.h"
#include "io/document/reader.h"
#include "io/document/value.h"
#include "io/model/model.h"
#include "io/model/tagged.h"
#include "io/read/bonds.h"
#include "io/read/cell.h"
#include "io/read/clumps.h"
#include "io/read/entries.h"
#include "io/read/flows.h"
#include "io/read/materials.h"
#include "io/read/objects.h"
#include "io/read/particle_names.h"
#include "io/read/particle_table.h"
#include "io/read/sections.h"
#include "io/read/servos.h"
#include "io/read/warn.h"

enum { LATTICE = 0, RANDOM = 1 };
static const char *const packings[] = {[LATTICE] = "lattice", [RANDOM] = "random", NULL};
static const char *const regions[] = {[SE3D_FILL_REGION_BOX] = "box",
                                      [SE3D_FILL_REGION_CYLINDER] = "cylinder",
                                      [SE3D_FILL_REGION_SPHERE] = "sphere",
                                      NULL};
static const char *const axes[] = {"x", "y", "z", NULL};

/* clang-format off */
static const se3di_key particles_keys[] = {
    {"material", SE3DI_KIND_MATERIAL, .required = true, .text = "what they are made of"},
    {"packing", SE3DI_KIND_WORD, .words = packings, .standard = "lattice",
     .text = "lattice: in rows; random: count of them without overlaps"},
    {"count", SE3DI_KIND_COUNT, .most = 1e8, .standard = "0",
     .text = "lattice: at most, 0 for all that fit; random: how many"},
    {"radius", SE3DI_KIND_RADIUS,
     .text = "[m]: a number, [smallest, largest], or a table of radii with how often each comes; "
         "of clumps: of the sphere about the centre of mass that holds one, without it as they "
         "are"},
    {"clump", SE3DI_KIND_TEXT, .text = "what of: one of `clumps` in place of single spheres"},
    {"orientation", SE3DI_KIND_ORIENTATION, SE3DI_INTO(se3d_fill_def, orientation),
     .standard = "at random, by the seed", .text = "of clumps"},
    {"lower", SE3DI_KIND_VECTOR, SE3DI_INTO(se3d_fill_def, lower),
     .text = "corner of the region [m]"},
    {"upper", SE3DI_KIND_VECTOR, SE3DI_INTO(se3d_fill_def, upper),
     .text = "corner of the region [m]"},
    {"spacing", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3d_fill_def, spacing),
     .standard = "1.1 diameters", .text = "lattice [m]"},
    {"jitter", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE, SE3DI_INTO(se3d_fill_def, jitter),
     .standard = "0", .text = "lattice: largest displacement along each axis [m]"},
    {"velocity", SE3DI_KIND_VECTOR, SE3DI_INTO(se3d_fill_def, velocity),
     .standard = "[0, 0, 0]", .text = "[m/s]"},
    {"position", SE3DI_KIND_VECTOR,
     .text = "in place of a region: the centre of a single one, of a clump that of mass [m]"},
    {"angular_velocity", SE3DI_KIND_VECTOR, .standard = "[0, 0, 0]",
     .text = "with position: ground frame [rad/s]"},
    {"fixed", SE3DI_KIND_BOOL, .standard = "false",
     .text = "true: spheres that go on at their velocity whatever acts on them"},
    {"seed", SE3DI_KIND_COUNT, .most = 9007199254740992.0, .standard = "0",
     .text = "of the random numbers"},
    {"region", SE3DI_KIND_WORD, .words = regions, .standard = "box",
     .text = "what is filled of the box from lower to upper: all, or the largest cylinder or "
         "sphere in it"},
    {"axis", SE3DI_KIND_WORD, .words = axes, .standard = "z", .text = "of a cylinder"},
    {"name", SE3DI_KIND_NAME, .text = "of the set; entries of one name are one set"},
    {"file", SE3DI_KIND_TEXT,
     .text = "a CSV table with the columns x, y, z, radius and more, relative to the model"},
    {"source", SE3DI_KIND_OBJECT, .object = "source",
     .text = "inserts them during the run, in place of all at the start"},
    {.key = NULL}};
const se3di_object se3di_object_particles = {
    "particles",
    "A region that is filled with spheres, one sphere, a table of them, or a source.",
    particles_keys, NULL,
    "\"anyOf\": [{\"required\": [\"file\"]}, {\"required\": [\"radius\", \"lower\", \"upper\"]}, "
    "{\"required\": [\"clump\", \"lower\", \"upper\"]}, "
    "{\"required\": [\"radius\", \"position\"]}, {\"required\": [\"clump\", \"position\"]}]"};
/* clang-format on */

/* clang-format off */
static const se3di_key radius_keys[] = {
    {"table", SE3DI_KIND_PAIRS, .required = true, .text = "pairs [radius, frequency]"},
    {.key = NULL}};
const se3di_object se3di_object_radius = {
    "radius",
    "Radii with how often each comes.",
    radius_keys, NULL,
    NULL};
/* clang-format on */

/* clang-format off */
static const se3di_key source_keys[] = {
    {"rate", SE3DI_KIND_FUNCTION, .text = "[1/s], may be an expression in t"},
    {"mass_rate", SE3DI_KIND_FUNCTION, .text = "[kg/s], in place of rate"},
    {"start", SE3DI_KIND_NUMBER, SE3DI_INTO(se3d_particles_source_def, start), .standard = "0",
     .text = "[s]"},
    {"stop", SE3DI_KIND_NUMBER, SE3DI_INTO(se3d_particles_source_def, stop),
     .standard = "never", .text = "[s]"},
    {"count", SE3DI_KIND_COUNT, .most = 1e8, .standard = "no limit",
     .text = "the largest number"},
    {"every", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE, SE3DI_INTO(se3d_particles_source_def, every),
     .standard = "0", .text = "least time between insertions [s]"},
    {.key = NULL}};
const se3di_object se3di_object_source = {
    "source",
    "Particles are inserted during the run, in place of all at the start.",
    source_keys, NULL,
    "\"oneOf\": [{\"required\": [\"rate\"]}, {\"required\": [\"mass_rate\"]}]"};
/* clang-format on */

/* clang-format off */
static const se3di_key sink_keys[] = {
    {"name", SE3DI_KIND_NAME, .text = "for its channel"},
    {"lower", SE3DI_KIND_VECTOR, SE3DI_INTO(se3d_particles_sink_def, lower),
     .text = "corner of the region [m]"},
    {"upper", SE3DI_KIND_VECTOR, SE3DI_INTO(se3d_particles_sink_def, upper),
     .text = "corner of the region [m]"},
    {"region", SE3DI_KIND_WORD, .words = regions, .standard = "box",
     .text = "all of the box, or the largest cylinder or sphere in it"},
    {"axis", SE3DI_KIND_WORD, .words = axes, .standard = "z", .text = "of a cylinder"},
    {"point", SE3DI_KIND_VECTOR, SE3DI_INTO(se3d_particles_sink_def, point),
     .standard = "[0, 0, 0]", .text = "of a plane [m]"},
    {"normal", SE3DI_KIND_DIRECTION, SE3DI_INTO(se3d_particles_sink_def, normal),
     .text = "of a plane; particles behind it are removed"},
    {.key = NULL}};
const se3di_object se3di_object_sink = {
    "sink",
    "A region, or what is behind a plane: particles whose centre is in it are removed and "
         "counted.",
    sink_keys, NULL,
    NULL};
/* clang-format on */

/* clang-format off */
static const se3di_key region_keys[] = {
    {"name", SE3DI_KIND_NAME, .required = true, .text = "for its channels"},
    {"lower", SE3DI_KIND_VECTOR, .required = true, SE3DI_INTO(se3di_region_entry, lower),
     .text = "corner of the box [m]"},
    {"upper", SE3DI_KIND_VECTOR, .required = true, SE3DI_INTO(se3di_region_entry, upper),
     .text = "corner of the box [m]"},
    {"set", SE3DI_KIND_TEXT, .standard = "all particles", 
     .text = "a name of `particles`: only those"},
    {.key = NULL}};
const se3di_object se3di_object_region = {
    "region",
    "A box whose particles are averaged over: how densely they lie, how they move, how they "
    "press.",
    region_keys, NULL,
    NULL};
/* clang-format on */

static bool read_boundaries(se3di_reader *reader, const se3di_node *map, se3d_particles_def *def)
{
    const char *const *words = se3di_object_find(&se3di_object_contact, NULL, "boundary")->words;
    const se3di_node *list = se3di_node_get(map, "boundary");
    size_t k = 0;
    if (list && (list->kind != SE3DI_NODE_LIST || list->count != 3)) {
        return se3di_reader_fail(reader, list,
                                 "must be a list of 3 words, for x, y and z: open, "
                                 "periodic or sink");
    }
    for (const se3di_node *child = list ? list->first : NULL; child; child = child->next) {
        size_t word = 0;
        if (!se3di_read_word(reader, child, words, &word)) {
            return false;
        }
        def->boundary[k++] = (int32_t)word;
    }
    return se3di_read_fields(reader, map, &se3di_object_contact, NULL, "se3d_particles_def", def);
}

/* Of the option --threads, else of the file. */
static bool read_threads(se3di_reader *reader, const se3di_node *contact, int32_t *threads)
{
    const char *option = reader->options->threads;
    const se3di_node *node = option ? se3di_node_of_text(reader->pool, "--threads", option)
                                    : se3di_node_get(contact, "threads");
    const double most = se3di_object_find(&se3di_object_contact, NULL, "threads")->most;
    double count = 1.0;
    if (option && !node) {
        return se3di_reader_fail_memory(reader);
    }
    if (node && !se3di_read_count(reader, node, 1.0, most, &count)) {
        return false;
    }
    *threads = (int32_t)count;
    return true;
}

static bool create_set(se3di_reader *reader, const se3di_node *contact, int32_t threads)
{
    se3d_particles_def def = se3d_particles_def_default();
    if (contact && !read_boundaries(reader, contact, &def)) {
        return false;
    }
    def.threads = threads;
    def.name = "particles";
    reader->model->particles->audit = def.audit != 0;
    for (int a = 0; a < 3; ++a) {
        const bool periodic = def.boundary[a] == SE3D_DOMAIN_BOUNDARY_PERIODIC;
        reader->model->particles->period[a] = periodic ? def.upper[a] - def.lower[a] : 0.0;
    }
    const se3d_status status =
        se3d_particles_create(reader->system, &def, &reader->model->particles->set);
    return status < 0
               ? se3di_reader_fail_system(reader, contact ? contact : reader->model->root, status)
               : true;
}

/* {table: [[radius, frequency], ...]} */
static bool read_radius_table(se3di_reader *reader, const se3di_node *radius, se3d_fill_def *def)
{
    const se3di_node *table = se3di_node_get(radius, "table");
    if (!se3di_read_keys(reader, radius, &se3di_object_radius)) {
        return false;
    }
    if (!table || table->kind != SE3DI_NODE_LIST || table->count == 0) {
        return se3di_reader_fail(
            reader, table ? table : radius,
            "must be {table: [[radius, frequency], ...]} with one pair or more");
    }
    double *numbers = se3di_iopool_array(reader->pool, 2 * table->count, sizeof *numbers);
    if (!numbers) {
        return se3di_reader_fail_memory(reader);
    }
    size_t k = 0;
    for (const se3di_node *pair = table->first; pair; pair = pair->next, ++k) {
        double values[2];
        if (!se3di_read_pair_of(reader, pair, NULL, radius, values)) {
            return false;
        }
        numbers[k] = values[0];
        numbers[table->count + k] = values[1];
    }
    def->radii = numbers;
    def->weights = numbers + table->count;
    def->radius_count = table->count;
    return true;
}

/* The part of the box from `lower` to `upper` that is filled. */
static bool read_region(se3di_reader *reader, const se3di_node *node, const se3di_object *object,
                        int32_t *region, int32_t *axis)
{
    *region = SE3D_FILL_REGION_BOX;
    *axis = 2;
    if (!se3di_read_key(reader, node, object, NULL, "region", region) ||
        !se3di_read_key(reader, node, object, NULL, "axis", axis)) {
        return false;
    }
    if (se3di_node_get(node, "axis") && *region != SE3D_FILL_REGION_CYLINDER) {
        return se3di_reader_fail_key(reader, node, "axis", "is only for `region: cylinder`");
    }
    return true;
}

/* One radius, [smallest, largest], or a table. */
static bool read_radius(se3di_reader *reader, const se3di_node *node, se3d_fill_def *def)
{
    const se3di_node *radius = se3di_node_get(node, "radius");
    double range[2];
    if (!radius && def->clump > 0) {
        return true;
    }
    if (!radius) {
        return se3di_reader_fail_key(reader, node, "radius",
                                     "is missing, must be a number, [smallest, largest] or {table: "
                                     "[[radius, frequency], ...]} [m]");
    }
    if (radius->kind == SE3DI_NODE_MAP) {
        return read_radius_table(reader, radius, def);
    }
    if (radius->kind != SE3DI_NODE_LIST) {
        if (!se3di_read_number(reader, radius, SE3DI_POSITIVE, &def->radius_min)) {
            return false;
        }
        def->radius_max = def->radius_min;
        return true;
    }
    if (!se3di_read_vector(reader, radius, 2, range)) {
        return false;
    }
    def->radius_min = range[0];
    def->radius_max = range[1];
    return true;
}

/* The tag of the set that an entry names, a new one if the name is new; 0 without a name. */
static bool read_set(se3di_reader *reader, const se3di_node *node, uint32_t *tag)
{
    se3di_tagged *particles = reader->model->particles;
    const se3di_node *child = se3di_node_get(node, "name");
    const char *name = NULL;
    *tag = 0;
    if (!child) {
        return true;
    }
    if (!se3di_read_name(reader, child, &name)) {
        return false;
    }
    const size_t known = se3di_tagged_find(particles, SE3DI_TAGGED_SET, name);
    if (known != SIZE_MAX) {
        *tag = (uint32_t)known;
        return true;
    }
    if (!se3di_check_free_name(reader, child, name)) {
        return false;
    }
    if (particles->set_count == SE3D_PARTICLES_TAGS) {
        return se3di_reader_fail(reader, child, "there are more than %d names of particles",
                                 SE3D_PARTICLES_TAGS - 1);
    }
    *tag = (uint32_t)particles->set_count;
    particles->sets[particles->set_count++] = name;
    return true;
}

/* Keys that have no meaning beside another one. */
static bool check_beside(se3di_reader *reader, const se3di_node *node, const char *beside,
                         const char *keys)
{
    for (const se3di_node *child = node->first; child; child = child->next) {
        if (!se3di_keys_contain(keys, child->key)) {
            return se3di_reader_fail(reader, child, "has no effect with `%s`, which takes:%s",
                                     beside, keys);
        }
    }
    return true;
}

/* rate or mass_rate: a number >= 0, or a function of t. */
static bool read_rate(se3di_reader *reader, const se3di_node *source,
                      se3d_particles_source_def *def)
{
    static const char *const variables[] = {"t", NULL};
    const se3di_node *count = se3di_node_get(source, "rate");
    const se3di_node *mass = se3di_node_get(source, "mass_rate");
    if (!count == !mass) {
        return se3di_reader_fail(reader, source,
                                 "must have either `rate` [1/s] or `mass_rate` [kg/s]");
    }
    if (!se3di_read_function(reader, count ? count : mass, variables, &def->rate, &def->function)) {
        return false;
    }
    if (def->rate < 0.0) {
        return se3di_reader_fail(reader, count ? count : mass, "is %g, must be >= 0", def->rate);
    }
    def->per_mass = mass != NULL;
    return true;
}

static bool read_source(se3di_reader *reader, const se3di_node *node, se3d_fill_def *fill)
{
    se3di_tagged *particles = reader->model->particles;
    const se3di_node *child = se3di_node_get(node, "source");
    se3d_particles_source_def def = se3d_particles_source_def_default();
    double most = 0.0;
    def.fill = fill;
    if (!check_beside(
            reader, node, "source",
            " name material radius clump orientation lower upper region axis velocity seed "
            "source ") ||
        !se3di_read_keys(reader, child, &se3di_object_source) || !read_rate(reader, child, &def) ||
        !se3di_read_fields(reader, child, &se3di_object_source, NULL, "se3d_particles_source_def",
                           &def) ||
        !se3di_read_key(reader, child, &se3di_object_source, NULL, "count", &most)) {
        return false;
    }
    fill->count = (size_t)most;
    uint32_t *grown =
        se3di_iopool_grow(reader->pool, particles->source_tags, particles->source_count,
                          &particles->source_capacity, sizeof *grown);
    if (!grown) {
        return se3di_reader_fail_memory(reader);
    }
    particles->source_tags = grown;
    particles->source_tags[particles->source_count++] = fill->tag;
    return se3di_reader_check(reader, node, se3d_particles_add_source(particles->set, &def, NULL));
}

/* Of an entry that fills a region, at once or as a source. */
static bool read_fill(se3di_reader *reader, const se3di_node *node, se3d_fill_def *def)
{
    const se3di_object *object = &se3di_object_particles;
    se3d_particles *set = reader->model->particles->set;
    double count = 0.0;
    double seed = 0.0;
    int32_t packing = LATTICE;
    if (!se3di_read_key_clump(reader, node, &def->clump) ||
        !se3di_read_key(reader, node, object, NULL, "packing", &packing) ||
        !se3di_read_key(reader, node, object, NULL, "count", &count) ||
        !read_radius(reader, node, def) ||
        !read_region(reader, node, object, &def->region, &def->axis) ||
        !se3di_read_fields(reader, node, object, NULL, "se3d_fill_def", def) ||
        !se3di_read_key(reader, node, object, NULL, "seed", &seed)) {
        return false;
    }
    if (def->clump == 0 && se3di_node_get(node, "orientation")) {
        return se3di_reader_fail_key(reader, node, "orientation", "is only for a `clump`");
    }
    def->count = (size_t)count;
    def->seed = (uint64_t)seed;
    if (se3di_node_get(node, "source")) {
        return read_source(reader, node, def);
    }
    size_t added = 1;
    if (!se3di_reader_check(reader, node,
                            packing == LATTICE ? se3d_particles_fill_lattice(set, def, &added)
                                               : se3d_particles_fill_random(set, def))) {
        return false;
    }
    if (added == 0) {
        se3di_reader_warn(reader, node,
                          "holds no particle: none of radius %g m, displaced by up to %g m, fits",
                          def->radius_max, def->jitter);
    }
    return true;
}

/* A single one at a place. */
static bool read_single(se3di_reader *reader, const se3di_node *node, se3d_fill_def *def)
{
    const se3di_object *object = &se3di_object_particles;
    se3d_particles *set = reader->model->particles->set;
    double r[3] = {0.0, 0.0, 0.0}, w[3] = {0.0, 0.0, 0.0};
    const double straight[4] = {1.0, 0.0, 0.0, 0.0};
    const bool is_clump = se3di_node_get(node, "clump") != NULL;
    const char *keys = is_clump
                           ? " name material clump position orientation velocity angular_velocity "
                           : " name material radius position velocity angular_velocity fixed ";
    if (!check_beside(reader, node, is_clump ? "position` of a `clump" : "position", keys) ||
        !se3di_read_key_clump(reader, node, &def->clump) || !read_radius(reader, node, def) ||
        !se3di_read_fields(reader, node, object, NULL, "se3d_fill_def", def) ||
        !se3di_read_key(reader, node, object, NULL, "position", r) ||
        !se3di_read_key(reader, node, object, NULL, "angular_velocity", w)) {
        return false;
    }
    if (!is_clump && (def->radius_count > 0 || def->radius_max > def->radius_min)) {
        return se3di_reader_fail_key(reader, node, "radius", "must be one number at a `position`");
    }
    const size_t before = se3d_particles_count(set);
    const double *turn = se3di_node_get(node, "orientation") ? def->orientation : straight;
    const se3d_status status = is_clump
                                   ? se3d_particles_add_clumps(set, def->clump - 1, def->material,
                                                               1, r, turn, def->velocity, w)
                                   : se3d_particles_add(set, def->material, 1, r, &def->radius_min,
                                                        def->velocity, w, NULL);
    return se3di_reader_check(reader, node, status) &&
           se3di_tag_particles(reader, node, before, def->tag);
}

/* Of a table, at a place, in a region, or by a source. */
static bool read_by_kind(se3di_reader *reader, const se3di_node *node, se3d_fill_def *def)
{
    if (se3di_node_get(node, "file")) {
        return check_beside(reader, node, "file", " name material file fixed ") &&
               se3di_read_particle_table(reader, node, def->material, def->tag);
    }
    if (se3di_node_get(node, "angular_velocity") && !se3di_node_get(node, "position")) {
        return se3di_reader_fail_key(reader, node, "angular_velocity", "is only for a `position`");
    }
    return se3di_node_get(node, "position") ? read_single(reader, node, def)
                                            : read_fill(reader, node, def);
}

static bool read_entry(se3di_reader *reader, const se3di_node *node)
{
    se3d_fill_def def = se3d_fill_def_default();
    const size_t before = se3d_particles_count(reader->model->particles->set);
    int32_t fixed = 0;
    return se3di_read_keys(reader, node, &se3di_object_particles) &&
           se3di_read_key_material(reader, node, "material", &def.material) &&
           read_set(reader, node, &def.tag) &&
           se3di_read_key(reader, node, &se3di_object_particles, NULL, "fixed", &fixed) &&
           read_by_kind(reader, node, &def) &&
           (!fixed || se3di_fix_particles(reader, node, before));
}

static bool read_sink(se3di_reader *reader, const se3di_node *node)
{
    se3di_tagged *particles = reader->model->particles;
    const se3di_node *name = se3di_node_get(node, "name");
    const char *text = NULL;
    se3d_particles_sink_def def = se3d_particles_sink_def_default();
    if (!se3di_read_keys(reader, node, &se3di_object_sink) ||
        (name &&
         (!se3di_read_name(reader, name, &text) || !se3di_check_free_name(reader, name, text))) ||
        (se3di_node_get(node, "normal") &&
         !check_beside(reader, node, "normal", " name point normal ")) ||
        !read_region(reader, node, &se3di_object_sink, &def.region, &def.axis) ||
        !se3di_read_fields(reader, node, &se3di_object_sink, NULL, "se3d_particles_sink_def",
                           &def)) {
        return false;
    }
    if (!se3di_node_get(node, "normal") &&
        (!se3di_node_get(node, "lower") || !se3di_node_get(node, "upper"))) {
        return se3di_reader_fail(reader, node,
                                 "must have `lower` and `upper`, or the `normal` of a plane");
    }
    particles->sinks[particles->sink_count++] = text;
    return se3di_reader_check(reader, node, se3d_particles_add_sink(particles->set, &def, NULL));
}

static bool read_sinks(se3di_reader *reader, const se3di_node *list)
{
    se3di_tagged *particles = reader->model->particles;
    particles->sinks = se3di_read_room(reader, list, sizeof *particles->sinks);
    return particles->sinks && se3di_read_entries(reader, list, read_sink);
}

static bool read_box(se3di_reader *reader, const se3di_node *node, se3di_region_entry *region)
{
    const se3di_node *name = se3di_node_get(node, "name");
    if (!se3di_read_keys(reader, node, &se3di_object_region)) {
        return false;
    }
    if (!name || !se3di_node_get(node, "lower") || !se3di_node_get(node, "upper")) {
        return se3di_reader_fail(reader, node, "must have `name`, `lower` and `upper`");
    }
    if (!se3di_read_name(reader, name, &region->name) ||
        !se3di_check_free_name(reader, name, region->name) ||
        !se3di_read_fields(reader, node, &se3di_object_region, NULL, "se3di_region_entry",
                           region)) {
        return false;
    }
    for (int a = 0; a < 3; ++a) {
        if (!(region->upper[a] > region->lower[a])) {
            return se3di_reader_fail_key(reader, node, "upper",
                                         "is %g along %c, must be greater than `lower`, %g",
                                         region->upper[a], "xyz"[a], region -> lower[a]);
        }
    }
    return se3di_read_key_set(reader, node, "set", &region->tag);
}

static bool add_region(se3di_reader *reader, const se3di_node *node)
{
    se3di_tagged *particles = reader->model->particles;
    return read_box(reader, node, &particles->regions[particles->region_count]) &&
           ++particles->region_count > 0;
}

static bool read_regions(se3di_reader *reader, const se3di_node *list)
{
    se3di_tagged *particles = reader->model->particles;
    particles->regions = se3di_read_room(reader, list, sizeof *particles->regions);
    return particles->regions && se3di_read_entries(reader, list, add_region);
}

/* Particles push bodies in `verlet` only; in kinematics the motion of the bodies is given. */
static bool check_analyses(se3di_reader *reader)
{
    const se3d_model *model = reader->model;
    for (size_t k = 0; k < model->analysis_count; ++k) {
        const se3di_analysis_entry *entry = &model->analyses[k];
        const se3di_node *node = entry->node ? entry->node : model->root;
        const char *type = entry->analysis.type;
        int32_t method = entry->solver.method;
        if (strcmp(type, "dynamics") != 0 && strcmp(type, "kinematics") != 0 &&
            model->moving_shapes) {
            return se3di_reader_fail_key(
                reader, node, "type",
                "is `%s`, must be dynamics or kinematics if particles touch bodies that move",
                type);
        }
        if (strcmp(type, "dynamics") == 0 && method != SE3D_METHOD_AUTO &&
            method != SE3D_METHOD_VERLET) {
            return se3di_reader_fail_key(
                reader, node, "method",
                "must be verlet (or auto, which picks it) if there are particles");
        }
    }
    return true;
}

/* Without particles nothing of theirs is there. */
static bool check_alone(se3di_reader *reader, const se3di_node *root)
{
    static const char *const sections[] = {"sinks",  "clumps", "regions", "flows",
                                           "servos", "cell",   "bonds"};
    for (size_t k = 0; k < sizeof sections / sizeof *sections; ++k) {
        const se3di_node *section = se3di_node_get(root, sections[k]);
        if (section) {
            return se3di_reader_fail(reader, section,
                                     "needs `particles`, which the model does not have");
        }
    }
    return true;
}

bool se3di_read_particles(se3di_reader *reader, const se3di_node *root)
{
    se3d_model *model = reader->model;
    const se3di_node *contact = se3di_node_get(root, "contact");
    enum { PARTICLES, SINKS, REGIONS, FLOWS, SERVOS, CELL, BONDS, SECTIONS };
    static const char *const sections[SECTIONS] = {"particles", "sinks", "regions", "flows",
                                                   "servos",    "cell",  "bonds"};
    const se3di_node *lists[SECTIONS] = {NULL};
    for (int k = 0; k < SECTIONS; ++k) {
        if (!se3di_read_list(reader, root, sections[k], &lists[k])) {
            return false;
        }
    }
    const se3di_node *list = lists[PARTICLES];
    int32_t threads = 1;
    if (!read_threads(reader, contact, &threads) || (!list && !check_alone(reader, root))) {
        return false;
    }
    if (!list) {
        return true;
    }
    model->particles = se3di_iopool_alloc(&model->pool, sizeof *model->particles);
    if (!model->particles) {
        return se3di_reader_fail_memory(reader);
    }
    model->particles->moving_walls = model->moving_shapes;
    model->particles->set_count = 1; /* those without a name */
    if (!create_set(reader, contact, threads) || !se3di_read_clumps(reader, root) ||
        !read_sinks(reader, lists[SINKS])) {
        return false;
    }
    for (const se3di_node *node = list->first; node; node = node->next) {
        if (!read_entry(reader, node)) {
            return false;
        }
    }
    return read_regions(reader, lists[REGIONS]) && se3di_read_flows(reader, lists[FLOWS]) &&
           se3di_read_servos(reader, lists[SERVOS]) && se3di_read_cell(reader, lists[CELL]) &&
           se3di_read_bonds(reader, lists[BONDS]) && check_analyses(reader);
}
