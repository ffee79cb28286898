/* SPDX-License-Identifier: BSD-3-Clause */
/* SDF, the Simulation Description Format (sdformat.org, to version 1.12): worlds of models of links
 * and joints, which may close loops. The pose is that of the file. */
#include <string.h>

#include "io/import/formats.h"
#include "io/import/sdf.h"

/* Elements that say nothing of the mechanism; others that are not read are noted. */
static const char *const quiet[] = {"pose",           "static",
                                    "visual",         "collision",
                                    "inertial",       "name",
                                    "link",           "joint",
                                    "frame",          "model",
                                    "gravity",        "allow_auto_disable",
                                    "enable_wind",    "must_be_base_link",
                                    "velocity_decay", "kinematic"};

static bool is_true(const se3di_xml *node)
{
    return se3di_sdf_flag(node->parent, node->name, false);
}

static bool is_quiet(const se3di_xml *node)
{
    for (size_t k = 0; k < sizeof quiet / sizeof *quiet; ++k) {
        if (se3di_xml_is(node, quiet[k])) {
            return true;
        }
    }
    return false;
}

/* Drag that slows a link down. */
static bool has_decay(se3di_machine *m, const se3di_xml *node, bool *good)
{
    double linear = 0.0;
    double angular = 0.0;
    *good = se3di_sdf_number(m, node, "linear", &linear) &&
            se3di_sdf_number(m, node, "angular", &angular);
    return linear != 0.0 || angular != 0.0;
}

/* What a model or link holds beside what is carried. @return false: it cannot be imported. */
static bool note_others(se3di_machine *m, const se3di_xml *parent)
{
    const bool in_model = se3di_xml_is(parent, "model");
    for (const se3di_xml *node = parent->first; node; node = node->next) {
        if (se3di_xml_is(node, "include")) {
            return se3di_machine_fail(m, node->line, node->column,
                                      "<include> is not followed: `gz sdf -p FILE` puts the model "
                                      "in its place");
        }
        if (in_model && se3di_xml_is(node, "model")) {
            return se3di_machine_fail(m, node->line, node->column,
                                      "a model in a model is not carried: put its links, joints "
                                      "and frames into `%.80s`",
                                      se3di_xml_get(parent, "name"));
        }
        const bool decays = se3di_xml_is(node, "velocity_decay");
        bool good = true;
        const bool acts =
            (se3di_xml_is(node, "gravity") && !se3di_sdf_flag(parent, "gravity", true)) ||
            (se3di_xml_is(node, "kinematic") && is_true(node)) ||
            (decays && has_decay(m, node, &good)) || se3di_xml_is(node, "gripper");
        if (!good) {
            return false;
        }
        if (acts) {
            se3di_machine_note_of(m, SE3D_IMPORT_LOST, node->line, "<%.40s> of `%.80s`", node->name,
                                  se3di_xml_get(parent, "name"));
        } else if (!is_quiet(node)) {
            se3di_machine_note_of(m, SE3D_IMPORT_NOTE, node->line,
                                  "<%.40s> of `%.80s` is no part of the mechanism and left out",
                                  node->name, se3di_xml_get(parent, "name"));
        }
    }
    return true;
}

static bool read_link(se3di_sdf_model *s, const se3di_xml *node, bool is_static)
{
    se3di_machine *m = s->links->m;
    se3di_sdf_place *place = se3di_sdf_add_place(s, node, SE3DI_SDF_LINK);
    if (!place || !note_others(m, node)) {
        return false;
    }
    const char *name =
        *s->prefix ? se3di_machine_text(m, "%s_%s", s->prefix, place->name) : place->name;
    const size_t index = s->links->count;
    se3di_link *link = name ? se3di_links_add(s->links, name, node->line) : NULL;
    if (!link) {
        return false;
    }
    place->link = index;
    link->anchored = is_static;
    return (is_static || se3di_sdf_inertial(m, node, &link->mass)) &&
           se3di_sdf_shapes(s->links, index, node);
}

static bool read_places(se3di_sdf_model *s, bool is_static)
{
    for (const se3di_xml *node = s->node->first; node; node = node->next) {
        const bool good =
            se3di_xml_is(node, "link")    ? read_link(s, node, is_static)
            : se3di_xml_is(node, "joint") ? se3di_sdf_add_place(s, node, SE3DI_SDF_JOINT) != NULL
            : se3di_xml_is(node, "frame") ? se3di_sdf_add_place(s, node, SE3DI_SDF_FRAME) != NULL
                                          : true;
        if (!good) {
            return false;
        }
    }
    return true;
}

/* The link of the model's own frame: that of `canonical_link`, else the first. */
static bool find_canonical(se3di_sdf_model *s)
{
    const char *said = se3di_xml_get(s->node, "canonical_link");
    s->canonical = s->first_link;
    return !said || !*said || se3di_sdf_find_link(s, s->node, said, &s->canonical);
}

/* The model's frame in the ground: its pose says where its `placement_frame` is. */
static bool place_model(se3di_sdf_model *s)
{
    se3di_machine *m = s->links->m;
    const se3di_xml *pose = se3di_xml_child(s->node, "pose");
    const char *base = pose ? se3di_xml_get(pose, "relative_to") : NULL;
    const char *placed = se3di_xml_get(s->node, "placement_frame");
    const se3di_frame unit = se3di_frame_identity();
    se3di_frame said;
    se3di_frame at;
    if (base && *base && strcmp(base, "world") != 0) {
        return se3di_machine_fail(m, pose->line, pose->column,
                                  "the pose of the model is relative to `%.80s`, must be so to the "
                                  "world",
                                  base);
    }
    if (!se3di_sdf_pose(m, s->node, &said) ||
        !se3di_sdf_find_frame(s, s->node, placed ? placed : "", &at)) {
        return false;
    }
    const se3di_frame back = se3di_frame_in(&at, &unit);
    s->frame = se3di_frame_of(&said, &back);
    return true;
}

static bool put_links(se3di_sdf_model *s)
{
    for (size_t k = 0; k < s->count; ++k) {
        const se3di_sdf_place *place = &s->places[k];
        if (place->kind == SE3DI_SDF_LINK) {
            s->links->list[place->link].frame = se3di_frame_of(&s->frame, &place->frame);
        }
    }
    return true;
}

/* Frames are markers of the links that they are attached to. */
static bool put_frames(se3di_sdf_model *s)
{
    for (size_t k = 0; k < s->count; ++k) {
        const se3di_sdf_place *place = &s->places[k];
        size_t link = 0;
        if (place->kind != SE3DI_SDF_FRAME) {
            continue;
        }
        if (!se3di_sdf_find_link(s, place->node, place->name, &link)) {
            return false;
        }
        const se3di_frame ground = se3di_frame_of(&s->frame, &place->frame);
        se3di_link *to = &s->links->list[link];
        const se3di_frame in = se3di_frame_in(&to->frame, &ground);
        if (!se3di_parts_add_marker(s->links->m, &to->parts, place->name, &in)) {
            return false;
        }
    }
    return true;
}

static bool read_model(se3di_sdf_model *s)
{
    se3di_machine *m = s->links->m;
    const bool is_static = se3di_sdf_flag(s->node, "static", false);
    s->first_link = s->links->count;
    s->first_joint = s->links->joint_count;
    if (!note_others(m, s->node) || !read_places(s, is_static)) {
        return false;
    }
    if (s->first_link == s->links->count) {
        return se3di_machine_fail(m, s->node->line, s->node->column,
                                  "the model `%.80s` has no <link>",
                                  se3di_xml_get(s->node, "name"));
    }
    return se3di_sdf_resolve(s) && find_canonical(s) && place_model(s) && put_links(s) &&
           put_frames(s) && (is_static || se3di_sdf_joints(s));
}

/* The first world, or the file itself, which may hold a model. */
static bool read_world(se3di_machine *m, const se3di_xml *root, const se3di_xml **world)
{
    const se3di_xml *found = se3di_xml_child(root, "world");
    const se3di_xml *gravity = se3di_xml_child(found, "gravity");
    *world = found ? found : root;
    m->gravity[2] = -9.8; /* SDF's */
    if (found && se3di_xml_again(found)) {
        se3di_machine_note_of(m, SE3D_IMPORT_LOST, se3di_xml_again(found)->line,
                              "all worlds but the first");
    }
    return !gravity || se3di_xml_text_numbers(m, gravity, m->gravity, 3);
}

static bool note_world(se3di_machine *m, const se3di_xml *world)
{
    static const char *const acting[] = {"state", "joint", "population", "road"};
    for (const se3di_xml *node = world->first; node; node = node->next) {
        bool acts = false;
        for (size_t k = 0; k < sizeof acting / sizeof *acting; ++k) {
            acts = acts || se3di_xml_is(node, acting[k]);
        }
        if (se3di_xml_is(node, "include")) {
            return se3di_machine_fail(m, node->line, node->column,
                                      "<include> is not followed: `gz sdf -p FILE` puts the model "
                                      "in its place");
        }
        if (acts) {
            se3di_machine_note_of(m, SE3D_IMPORT_LOST, node->line, "<%.40s> of the world",
                                  node->name);
        }
    }
    return true;
}

static size_t count_models(const se3di_xml *world)
{
    size_t count = 0;
    for (const se3di_xml *node = se3di_xml_child(world, "model"); node;
         node = se3di_xml_again(node)) {
        ++count;
    }
    return count;
}

/* "1.4" is before "1.10": the number behind the point is one of its own. */
static bool is_before_1_5(const se3di_xml *root)
{
    const char *version = se3di_xml_get(root, "version");
    const bool short_one =
        version && strncmp(version, "1.", 2) == 0 && version[2] != '\0' && version[3] == '\0';
    return short_one && version[2] >= '0' && version[2] < '5';
}

bool se3di_import_sdf(se3di_machine *m, se3di_xml *root)
{
    se3di_links links = {.m = m};
    const se3di_xml *world = NULL;
    if (!read_world(m, root, &world) || !note_world(m, world)) {
        return false;
    }
    const size_t count = count_models(world);
    if (count == 0) {
        return se3di_machine_fail(m, root->line, root->column, "there is no <model>");
    }
    se3di_sdf_model *models = se3di_iopool_array(m->pool, count, sizeof *models);
    se3di_link *ground = models ? se3di_links_add(&links, "world", world->line) : NULL;
    if (!ground) {
        return se3di_machine_fail_memory(m);
    }
    ground->is_ground = ground->anchored = true;
    const se3di_xml *node = se3di_xml_child(world, "model");
    for (size_t k = 0; k < count; ++k, node = se3di_xml_again(node)) {
        const char *name = se3di_xml_need(m, node, "name");
        if (!name) {
            return false;
        }
        m->title = k == 0 ? name : m->title;
        models[k] = (se3di_sdf_model){.links = &links,
                                      .node = node,
                                      .prefix = count > 1 ? name : "",
                                      .is_old = is_before_1_5(root),
                                      .frame = se3di_frame_identity()};
        if (!read_model(&models[k])) {
            return false;
        }
    }
    if (!se3di_links_emit(&links)) {
        return false;
    }
    for (size_t k = 0; k < count; ++k) {
        if (!se3di_sdf_flag(models[k].node, "static", false) && !se3di_sdf_mimics(&models[k])) {
            return false;
        }
    }
    return true;
}
