/* SPDX-License-Identifier: BSD-3-Clause */
/* Models: what one can ask of one. */
#include "io/model/model.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "io/base/pool.h"
#include "io/base/sized.h"

void se3d_model_destroy(se3d_model *model)
{
    if (model && !model->running && !se3d_system_is_busy(model->system)) {
        se3di_iopool pool = model->pool; /* the model itself lies in it */
        (void)se3d_system_set_kept(model->system, 0);
        se3d_system_destroy(model->system);
        se3di_iopool_destroy(&pool);
    }
}

se3d_system *se3d_model_get_system(const se3d_model *model)
{
    return model ? model->system : NULL;
}

const char *se3d_model_get_name(const se3d_model *model)
{
    return model ? model->name : "";
}

const char *se3d_model_get_title(const se3d_model *model)
{
    return model ? model->title : "";
}

se3d_status se3d_model_get_parameter(const se3d_model *model, const char *name, double *value)
{
    if (!model || !name || !value) {
        return SE3D_ERR_NULL;
    }
    const se3di_amount *known = model->scope ? se3di_scope_find(model->scope, name) : NULL;
    if (known && known->rank == 1) {
        *value = known->v[0];
        return SE3D_OK;
    }
    return SE3D_ERR_INVALID_ARGUMENT;
}

size_t se3d_model_count_parameters(const se3d_model *model)
{
    const se3di_node *map = model ? se3di_node_get(model->root, "parameters") : NULL;
    return map && map->kind == SE3DI_NODE_MAP ? map->count : 0;
}

static const se3di_node *get_parameter_node(const se3d_model *model, size_t index)
{
    if (index >= se3d_model_count_parameters(model)) {
        return NULL;
    }
    const se3di_node *node = se3di_node_get(model->root, "parameters")->first;
    while (index-- > 0) {
        node = node->next;
    }
    return node;
}

const char *se3d_model_get_parameter_name(const se3d_model *model, size_t index)
{
    const se3di_node *node = get_parameter_node(model, index);
    return node && node->key ? node->key : "";
}

const char *se3d_model_get_parameter_text(const se3d_model *model, size_t index)
{
    const se3di_node *node = get_parameter_node(model, index);
    return node && node->text ? node->text : "";
}

size_t se3d_model_count_analyses(const se3d_model *model)
{
    return model ? model->analysis_count : 0;
}

se3d_status se3d_model_get_analysis_sized(const se3d_model *model, size_t index,
                                          se3d_model_analysis *analysis, size_t size)
{
    return SE3DI_IO_GIVE_ENTRY(analysis, size, model, index, analysis_count,
                               analyses[index].analysis);
}

se3d_status se3d_model_get_solver(const se3d_model *model, size_t index, se3d_solver_def *def)
{
    if (!model || !def) {
        return SE3D_ERR_NULL;
    }
    if (index >= model->analysis_count || def->struct_size < sizeof def->struct_size) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    if (model->analyses[index].modes.file) {
        return SE3D_ERR_UNSUPPORTED;
    }
    const size_t size = def->struct_size;
    memcpy(def, &model->analyses[index].solver, size < sizeof *def ? size : sizeof *def);
    def->struct_size = size;
    return SE3D_OK;
}

size_t se3d_model_count_shapes(const se3d_model *model)
{
    return model ? model->shape_count : 0;
}

se3d_status se3d_model_get_shape_sized(const se3d_model *model, size_t index,
                                       se3d_model_shape *shape, size_t size)
{
    return SE3DI_IO_GIVE_ENTRY(shape, size, model, index, shape_count, shapes[index].shape);
}

size_t se3d_model_count_pictures(const se3d_model *model)
{
    return model ? model->picture_count : 0;
}

se3d_status se3d_model_get_picture_sized(const se3d_model *model, size_t index,
                                         se3d_model_picture *picture, size_t size)
{
    return SE3DI_IO_GIVE_ENTRY(picture, size, model, index, picture_count, pictures[index]);
}

bool se3di_joint_has(const se3d_system *system, se3d_constraint joint, se3d_joint_coordinate which)
{
    const se3d_status status = se3d_joint_get_coordinate(system, joint, which, NULL, NULL, NULL);
    return !SE3D_FAILED(status) || status == SE3D_ERR_NOT_FINITE;
}

bool se3di_solver_takes_time(const se3d_solver_def *solver)
{
    return solver->analysis == SE3D_ANALYSIS_KINEMATICS ||
           solver->analysis == SE3D_ANALYSIS_INVERSE_DYNAMICS ||
           solver->analysis == SE3D_ANALYSIS_DYNAMICS;
}

bool se3di_analysis_has_motion(const se3di_analysis_entry *entry)
{
    return !entry->modes.file && se3di_solver_takes_time(&entry->solver);
}
