/* SPDX-License-Identifier: BSD-3-Clause */
/* Chrono YAML: a model, or a simulation that names a model and has its gravity. Chrono has no
 * units: they are those of SI. */
#include <string.h>

#include "io/import/chrono.h"
#include "io/import/formats.h"
#include "io/import/mesh.h"
#include "io/import/scan.h"

bool se3di_import_is_chrono(const se3di_node *root)
{
    return se3di_node_get(root, "chrono-version") != NULL;
}

typedef bool reader(se3di_chrono *c, const se3di_node *map);

static bool read_all(se3di_chrono *c, const se3di_node *model, const char *key, reader *read)
{
    for (const se3di_node *at = se3di_chrono_list(c, model, key); at; at = at->next) {
        if (!read(c, at)) {
            return false;
        }
    }
    return c->m->status >= 0;
}

/* The folder of meshes: `data_path`, as seen from the file. */
static bool read_folder(se3di_chrono *c, const se3di_node *model)
{
    const char *file = c->m->part ? c->m->part : c->m->file;
    const se3di_node *path = se3di_node_get(model, "data_path");
    const char *root = path ? se3di_chrono_text(c, path, "root") : NULL;
    c->folder = se3di_path_folder(c->m, file);
    if (c->folder && root) {
        c->folder = se3di_path_join(c->m, c->folder, root);
    }
    return c->folder && c->m->status >= 0;
}

static bool read_model(se3di_chrono *c, const se3di_node *model)
{
    static const struct {
        const char *key;
        reader *read;
    } lists[] = {{"bodies", se3di_chrono_body_read},
                 {"joints", se3di_chrono_joint},
                 {"constraints", se3di_chrono_constraint},
                 {"tsdas", se3di_chrono_tsda},
                 {"rsdas", se3di_chrono_rsda},
                 {"body_loads", se3di_chrono_load},
                 {"load_controllers", se3di_chrono_load},
                 {"motors", se3di_chrono_motor}};
    if (model->kind != SE3DI_NODE_MAP) {
        return se3di_machine_fail(c->m, model->line, model->column, "`model` must be a map");
    }
    se3di_chrono_keys(c, model,
                      "name angle_degrees data_path bodies joints constraints tsdas rsdas "
                      "body_loads load_controllers motors FEA");
    c->degrees = true;
    c->m->title = se3di_chrono_text(c, model, "name");
    if (!se3di_chrono_bool(c, model, "angle_degrees", &c->degrees) || !read_folder(c, model)) {
        return false;
    }
    if (!se3di_node_get(model, "bodies")) {
        return se3di_machine_fail(c->m, model->line, model->column,
                                  "the model has no `bodies`: those of fluids, beams and vehicles "
                                  "are not read");
    }
    for (size_t k = 0; k < sizeof lists / sizeof *lists; ++k) {
        if (!read_all(c, model, lists[k].key, lists[k].read)) {
            return false;
        }
    }
    const se3di_node *elastic = se3di_node_get(model, "FEA");
    if (elastic) {
        se3di_machine_note_of(c->m, SE3D_IMPORT_LOST, elastic->line, "FEA: bodies that deform");
    }
    return c->m->status >= 0;
}

/* Gravity, the end and the rows of results. */
static bool read_simulation(se3di_chrono *c, const se3di_node *root)
{
    se3di_machine *m = c->m;
    const se3di_node *simulation = se3di_node_get(root, "simulation");
    const se3di_node *output = se3di_node_get(root, "output");
    double rows = 0.0;
    if (simulation && (!se3di_chrono_numbers(c, simulation, "gravity", m->gravity, 3) ||
                       !se3di_chrono_number(c, simulation, "end_time", &m->duration))) {
        return false;
    }
    if (output && !se3di_chrono_number(c, output, "fps", &rows)) {
        return false;
    }
    m->step = rows > 0.0 ? 1.0 / rows : 0.0;
    if (!(m->duration > 0.0 && m->duration <= 1e9)) {
        return se3di_machine_fail(m, simulation->line, simulation->column,
                                  "the end_time is %g, must be > 0 and at most 1e9", m->duration);
    }
    return true;
}

/* The model that a simulation names. */
static bool read_named(se3di_chrono *c, const se3di_node *root)
{
    se3di_machine *m = c->m;
    const char *type = se3di_chrono_need(c, root, "type");
    const char *name = type ? se3di_chrono_need(c, root, "model") : NULL;
    se3di_node *other = NULL;
    if (!name) {
        return false;
    }
    if (!se3di_scan_equal(type, "MBS")) {
        const se3di_node *node = se3di_node_get(root, "type");
        return se3di_machine_fail(m, node->line, node->column,
                                  "the simulation is of type `%.40s`, must be MBS", type);
    }
    const char *folder = se3di_path_folder(m, m->file);
    const char *path = folder ? se3di_path_join(m, folder, name) : NULL;
    if (!path || !read_simulation(c, root) || !se3di_import_document(m, path, &other)) {
        return false;
    }
    m->part = path;
    return se3di_chrono_has(c, other, "model") && read_model(c, se3di_node_get(other, "model"));
}

bool se3di_import_chrono(se3di_machine *m, const se3di_node *root)
{
    se3di_chrono c = {.m = m};
    const se3di_node *model = se3di_node_get(root, "model");
    m->gravity[2] = -9.8; /* Chrono's, if nothing is said */
    if (!se3di_chrono_has(&c, root, "chrono-version") || !se3di_chrono_has(&c, root, "model")) {
        return false;
    }
    if (model->kind == SE3DI_NODE_SCALAR) {
        return read_named(&c, root);
    }
    se3di_machine_note_of(m, SE3D_IMPORT_NOTE, 0,
                          "gravity is in the simulation file, which names the model; it is "
                          "[0, 0, -9.8] as if that said nothing");
    return read_model(&c, model);
}
