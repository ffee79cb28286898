/* SPDX-License-Identifier: BSD-3-Clause */
/* SDF: poses, and what they are relative to (sdformat.org, "Pose frame semantics"). The pose of a
 * link is in the model's frame, that of a joint in its child's, that of a frame in what it is
 * attached to, unless `relative_to` names something else. */
#include <string.h>

#include "io/import/sdf.h"

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

const char *se3di_sdf_text(se3di_machine *m, const se3di_xml *node, const char *child)
{
    const se3di_xml *found = se3di_xml_child(node, child);
    if (!found) {
        return NULL;
    }
    const char *from = found->text;
    while (is_blank(*from)) {
        ++from;
    }
    size_t length = strlen(from);
    while (length > 0 && is_blank(from[length - 1])) {
        --length;
    }
    const char *text = se3di_iopool_copy(m->pool, from, length);
    if (!text) {
        se3di_machine_fail_memory(m);
    }
    return text;
}

bool se3di_sdf_number(se3di_machine *m, const se3di_xml *node, const char *child, double *value)
{
    const se3di_xml *found = se3di_xml_child(node, child);
    const char *text = found ? se3di_sdf_text(m, node, child) : NULL;
    if (!found) {
        return true;
    }
    if (!text) {
        return false;
    }
    const bool negative = *text == '-';
    const char *word = text + (negative || *text == '+');
    if (strcmp(word, "inf") == 0 || strcmp(word, "INF") == 0 || strcmp(word, "infinity") == 0) {
        *value = negative ? -1e16 : 1e16;
        return true;
    }
    return se3di_xml_text_numbers(m, found, value, 1);
}

bool se3di_sdf_flag(const se3di_xml *node, const char *child, bool standard)
{
    const se3di_xml *found = se3di_xml_child(node, child);
    const char *text = found ? found->text : "";
    while (is_blank(*text)) {
        ++text;
    }
    return *text == '1' || *text == 't' || *text == 'T'   ? true
           : *text == '0' || *text == 'f' || *text == 'F' ? false
                                                          : standard;
}

static bool read_turn(se3di_machine *m, const se3di_xml *pose, const double *v, bool quaternion,
                      double A[9])
{
    const char *degrees = se3di_xml_get(pose, "degrees");
    const bool in_degrees = degrees && (strcmp(degrees, "true") == 0 || strcmp(degrees, "1") == 0);
    const double unit = in_degrees ? 3.14159265358979323846 / 180.0 : 1.0;
    const double rpy[3] = {v[3] * unit, v[4] * unit, v[5] * unit};
    const double p[4] = {v[6], v[3], v[4], v[5]};
    if (!quaternion) {
        se3di_turn_from_rpy(rpy, A);
        return true;
    }
    return se3di_turn_from_parameters(p, A) ||
           se3di_machine_fail(m, pose->line, pose->column, "the quaternion has no length");
}

static bool has_text(const se3di_xml *node)
{
    const char *text = node->text;
    while (is_blank(*text)) {
        ++text;
    }
    return *text != '\0';
}

bool se3di_sdf_pose(se3di_machine *m, const se3di_xml *node, se3di_frame *frame)
{
    const se3di_xml *pose = se3di_xml_child(node, "pose");
    double v[7] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0};
    *frame = se3di_frame_identity();
    if (!pose || !has_text(pose)) {
        return true;
    }
    const char *format = se3di_xml_get(pose, "rotation_format");
    const bool quaternion = format && strcmp(format, "quat_xyzw") == 0;
    if (format && !quaternion && strcmp(format, "euler_rpy") != 0) {
        return se3di_machine_fail(m, pose->line, pose->column,
                                  "rotation_format=\"%.40s\": must be euler_rpy or quat_xyzw",
                                  format);
    }
    if (!se3di_xml_text_numbers(m, pose, v, quaternion ? 7 : 6)) {
        return false;
    }
    memcpy(frame->r, v, sizeof frame->r);
    return read_turn(m, pose, v, quaternion, frame->A);
}

se3di_sdf_place *se3di_sdf_add_place(se3di_sdf_model *s, const se3di_xml *node, se3di_sdf_kind kind)
{
    se3di_machine *m = s->links->m;
    const char *name = se3di_xml_need(m, node, "name");
    if (!name) {
        return NULL;
    }
    if (se3di_ionames_find(&s->names, name, NULL) || strcmp(name, "world") == 0 ||
        strncmp(name, "__", 2) == 0) {
        se3di_machine_fail(m, node->line, node->column,
                           "the name `%.80s` is taken: links, joints and frames of a model have "
                           "different names, none of them `world` or one that begins with __",
                           name);
        return NULL;
    }
    se3di_sdf_place *grown =
        se3di_iopool_grow(m->pool, s->places, s->count, &s->room, sizeof *grown);
    if (!grown || !se3di_ionames_add(&s->names, m->pool, name, s->count)) {
        se3di_machine_fail_memory(m);
        return NULL;
    }
    s->places = grown;
    se3di_sdf_place *place = &grown[s->count++];
    memset(place, 0, sizeof *place);
    place->name = name;
    place->node = node;
    place->kind = kind;
    place->frame = se3di_frame_identity();
    return place;
}

/* What the pose of a place is relative to. "" is the model. NULL: the machine has failed. */
static const char *base_of(se3di_sdf_model *s, const se3di_sdf_place *place)
{
    se3di_machine *m = s->links->m;
    const se3di_xml *pose = se3di_xml_child(place->node, "pose");
    const char *said = pose ? se3di_xml_get(pose, "relative_to") : NULL;
    const char *old = pose ? se3di_xml_get(pose, "frame") : NULL; /* of versions 1.5 and 1.6 */
    if (said && *said) {
        return said;
    }
    if (old && *old) {
        return old;
    }
    if (place->kind == SE3DI_SDF_JOINT) {
        const char *child = se3di_sdf_text(m, place->node, "child");
        if (!child && m->status >= 0) {
            se3di_machine_fail(m, place->node->line, place->node->column,
                               "the joint `%.80s` has no <child>", place->name);
        }
        if (child && strcmp(child, "world") == 0) {
            se3di_machine_fail(m, place->node->line, place->node->column,
                               "the child of the joint `%.80s` is the world: its <pose> needs "
                               "`relative_to`, or make the world its parent",
                               place->name);
            return NULL;
        }
        return child;
    }
    const char *attached =
        place->kind == SE3DI_SDF_FRAME ? se3di_xml_get(place->node, "attached_to") : NULL;
    return attached ? attached : "";
}

static bool fail_unknown(se3di_machine *m, const se3di_xml *node, const char *name)
{
    const bool nested = strstr(name, "::") != NULL;
    return se3di_machine_fail(m, node->line, node->column,
                              "there is no link, joint or frame `%.80s`%s", name,
                              nested ? ": names of nested models are not followed" : "");
}

static bool is_model(const char *name)
{
    return !*name || strcmp(name, "__model__") == 0;
}

/* Find the frame of a place from that of what it is relative to, which comes first. */
static bool resolve(se3di_sdf_model *s, size_t index, size_t *stack)
{
    se3di_machine *m = s->links->m;
    size_t depth = 0;
    stack[depth++] = index;
    while (depth > 0) {
        se3di_sdf_place *place = &s->places[stack[depth - 1]];
        const char *base = base_of(s, place);
        se3di_frame in = se3di_frame_identity();
        se3di_frame own;
        size_t other = 0;
        if (!base) {
            return false;
        }
        if (!is_model(base) && !se3di_ionames_find(&s->names, base, &other)) {
            return fail_unknown(m, place->node, base);
        }
        if (!is_model(base) && s->places[other].state == 0 && &s->places[other] != place) {
            place->state = 1;
            stack[depth++] = other;
            continue;
        }
        if (!is_model(base) && s->places[other].state != 2) {
            return se3di_machine_fail(m, place->node->line, place->node->column,
                                      "the pose of `%.80s` is relative to itself in a circle",
                                      place->name);
        }
        if (!is_model(base)) {
            in = s->places[other].frame;
        }
        if (!se3di_sdf_pose(m, place->node, &own)) {
            return false;
        }
        place->frame = se3di_frame_of(&in, &own);
        place->state = 2;
        --depth;
    }
    return true;
}

bool se3di_sdf_resolve(se3di_sdf_model *s)
{
    size_t *stack = se3di_iopool_array(s->links->m->pool, s->count + 1, sizeof *stack);
    if (!stack) {
        return se3di_machine_fail_memory(s->links->m);
    }
    for (size_t k = 0; k < s->count; ++k) {
        if (s->places[k].state == 0 && !resolve(s, k, stack)) {
            return false;
        }
    }
    return true;
}

bool se3di_sdf_find_frame(se3di_sdf_model *s, const se3di_xml *node, const char *name,
                          se3di_frame *frame)
{
    size_t index = 0;
    *frame = se3di_frame_identity();
    if (is_model(name)) {
        return true;
    }
    if (!se3di_ionames_find(&s->names, name, &index)) {
        return fail_unknown(s->links->m, node, name);
    }
    *frame = s->places[index].frame;
    return true;
}

/* What a place is attached to; NULL: the machine has failed. */
static const char *attachment_of(se3di_machine *m, const se3di_sdf_place *place)
{
    if (place->kind == SE3DI_SDF_JOINT) {
        return se3di_sdf_text(m, place->node, "child");
    }
    const char *said = se3di_xml_get(place->node, "attached_to");
    return said ? said : "";
}

/* Known at once: a link, the world, the model, and what was asked before. */
static bool is_known(se3di_sdf_model *s, const char *name, size_t *index, size_t *link)
{
    const bool ends = strcmp(name, "world") == 0 || is_model(name);
    if (ends) {
        *link = is_model(name) ? s->canonical : s->world;
        return true;
    }
    if (!se3di_ionames_find(&s->names, name, index)) {
        *index = s->count;
        return false;
    }
    const se3di_sdf_place *place = &s->places[*index];
    *link = place->link;
    return place->kind == SE3DI_SDF_LINK || place->is_attached;
}

bool se3di_sdf_find_link(se3di_sdf_model *s, const se3di_xml *node, const char *name, size_t *link)
{
    se3di_machine *m = s->links->m;
    const char *at = name;
    size_t index = 0;
    size_t steps = 0;
    while (!is_known(s, at, &index, link)) {
        if (index == s->count) {
            return fail_unknown(m, node, at);
        }
        if (steps++ > s->count) {
            return se3di_machine_fail(m, node->line, node->column,
                                      "what `%.80s` is attached to is attached to itself in a "
                                      "circle",
                                      name);
        }
        at = attachment_of(m, &s->places[index]);
        if (!at) {
            return m->status >= 0 && fail_unknown(m, node, name);
        }
    }
    size_t other = 0;
    for (at = name; steps > 0 && at; --steps) { /* the whole way knows it now */
        is_known(s, at, &index, &other);
        s->places[index].link = *link;
        s->places[index].is_attached = true;
        at = attachment_of(m, &s->places[index]);
    }
    return m->status >= 0;
}
