/* SPDX-License-Identifier: BSD-3-Clause */
/* Materials and the law between them. */
#include "contact/bodies/law.h"
#include "contact/bodies/restitution.h"
#include "system/system_internal.h"

#include <math.h>
#include <string.h>

void se3d_contact_settings_init(se3d_contact_settings *settings, size_t size)
{
    se3d_contact_settings defaults = {.struct_size = size, .overlap_limit = 0.2};
    se3di_def_init(settings, size, &defaults, sizeof defaults);
}

void se3d_material_def_init(se3d_material_def *def, size_t size)
{
    se3d_material_def defaults = {.struct_size = size,
                                  .friction = 0.5,
                                  .restitution = 0.5,
                                  .tangential_ratio = 2.0 / 7.0,
                                  .poisson = 0.3};
    se3di_def_init(def, size, &defaults, sizeof defaults);
}

void se3d_material_pair_def_init(se3d_material_pair_def *def, size_t size)
{
    se3d_material_pair_def defaults = {.struct_size = size,
                                       SE3DI_OVERRIDE_LIST(SE3DI_NONE_OF).law = -1};
    se3di_def_init(def, size, &defaults, sizeof defaults);
}

/* What the law needs of a material. */
static se3d_status check_law(se3d_system *system, int32_t law, double stiffness, double young)
{
    if (law == SE3D_CONTACT_LAW_HOOKE && !(stiffness > 0.0)) {
        return SE3DI_FAIL_OF(system, "stiffness", SE3D_ERR_INVALID_ARGUMENT,
                             " = %g N/m of a material, must be > 0 with the law hooke "
                             "(se3d_system_set_contact)",
                             stiffness);
    }
    if (law == SE3D_CONTACT_LAW_HERTZ_MINDLIN && !(young > 0.0)) {
        return SE3DI_FAIL_OF(system, "young", SE3D_ERR_INVALID_ARGUMENT,
                             " = %g Pa of a material, must be > 0 with the law hertz_mindlin "
                             "(se3d_system_set_contact)",
                             young);
    }
    return SE3D_OK;
}

static se3d_status check_damping(se3d_system *system, int32_t law, const se3di_material *material)
{
    const double e = se3di_material_restitution((se3di_contact_law)law, material);
    return e >= SE3DI_RESTITUTION_MIN
               ? SE3D_OK
               : SE3DI_FAIL_OF(system, "damping_ratio", SE3D_ERR_INVALID_ARGUMENT,
                               " = %g, a restitution of %g with this law, must be so small that "
                               "it is %g or more",
                               material->damping_ratio, e, SE3DI_RESTITUTION_MIN);
}

/* The same of a pair of materials; < 0: it says nothing. */
static se3d_status check_ratio(se3d_system *system, int32_t law, double damping_ratio)
{
    const se3di_material of_it = {.damping_ratio = damping_ratio};
    return damping_ratio > 0.0 ? check_damping(system, law, &of_it) : SE3D_OK;
}

/* A rate of damping is in the unit of the system's law: a pair of the other law cannot take it. */
static se3d_status check_rate(se3d_system *system, int32_t of_all, const se3di_override *over,
                              const se3di_material *material)
{
    const int has_own =
        over->damping_rate >= 0.0 || over->damping_ratio >= 0.0 || over->restitution >= 0.0;
    const int is_other = (int32_t)se3di_pair_law((se3di_contact_law)of_all, over) != of_all;
    return has_own || !is_other || !(material->damping_rate != 0.0)
               ? SE3D_OK
               : SE3DI_FAIL_OF(system, "damping_rate", SE3D_ERR_INVALID_ARGUMENT,
                               " of a material, %g, is for the system's law: a pair with another "
                               "law must have a damping_rate, damping_ratio or restitution of its "
                               "own",
                               fmax(material->damping_rate, 0.0));
}

/* What a pair with a law of its own, or else nobody, needs of its materials, where `of_all` is the
 * system's. */
static se3d_status check_pair_law(se3d_system *system, int32_t of_all, const se3di_override *over,
                                  const se3di_material *a, const se3di_material *b)
{
    const se3di_material *const of[2] = {a, b};
    for (int k = 0; over->law >= 0 && k < 2; ++k) {
        SE3DI_TRY(check_law(system, over->law, fmax(over->stiffness, of[k]->stiffness),
                            fmax(over->young, of[k]->young)));
        SE3DI_TRY(check_damping(system, over->law, of[k]));
        SE3DI_TRY(check_rate(system, of_all, over, of[k]));
    }
    const se3di_contact_law law = se3di_pair_law((se3di_contact_law)of_all, over);
    return check_ratio(system, (int32_t)law, over->damping_ratio);
}

/* The same of a material that becomes `data`. */
static se3d_status check_pair_laws(se3d_system *system, uint32_t index, const se3di_material *data)
{
    const se3di_model *model = &system->model;
    const size_t n = model->material_slots.count;
    for (size_t k = 0; k < n; ++k) {
        SE3DI_TRY(check_pair_law(system, model->contact.law, &model->overrides[index * n + k], data,
                                 k == index ? data : &model->materials[k]));
    }
    return SE3D_OK;
}

se3d_status se3d_system_set_contact(se3d_system *system, const se3d_contact_settings *settings)
{
    SE3DI_SET(system);
    se3di_model *model = &system->model;
    se3d_contact_settings full = se3d_contact_settings_default();
    SE3DI_TRY(se3di_check_def(system, "contact settings", settings, &full, sizeof full));
    if (full.law < SE3D_CONTACT_LAW_HOOKE || full.law > SE3D_CONTACT_LAW_CALLBACK) {
        return SE3DI_FAIL_OF(system, "law", SE3D_ERR_INVALID_ARGUMENT,
                             " = %d, must be an se3d_contact_law", full.law);
    }
    if (!(isfinite(full.step) && full.step >= 0.0)) {
        return SE3DI_FAIL_OF(system, "step", SE3D_ERR_INVALID_ARGUMENT,
                             " = %g s, must be finite and >= 0 (0: automatic)", full.step);
    }
    if (full.law == SE3D_CONTACT_LAW_CALLBACK) {
        SE3DI_TRY(se3di_check_pointer(system, "callback", (full.callback ? &full : NULL)));
        if (!(full.step > 0.0)) {
            return SE3DI_FAIL_OF(system, "step", SE3D_ERR_INVALID_ARGUMENT,
                                 " = %g s, must be > 0 with a user-defined law", full.step);
        }
    }
    if (!(full.overlap_limit > 0.0 && full.overlap_limit <= 1.0)) {
        return SE3DI_FAIL_OF(system, "overlap_limit", SE3D_ERR_INVALID_ARGUMENT,
                             " = %g, must be > 0 and <= 1", full.overlap_limit);
    }
    for (size_t k = 0; k < model->material_slots.count; ++k) {
        SE3DI_TRY(
            check_law(system, full.law, model->materials[k].stiffness, model->materials[k].young));
        SE3DI_TRY(check_damping(system, full.law, &model->materials[k]));
        for (size_t j = 0; j <= k; ++j) {
            const se3di_override *over = &model->overrides[k * model->material_slots.count + j];
            SE3DI_TRY(
                check_pair_law(system, full.law, over, &model->materials[k], &model->materials[j]));
        }
    }
    const double before = se3di_audit_contacts(model);
    se3di_model_set_contact(model, &(se3di_contact_settings){.law = full.law,
                                                             .step = full.step,
                                                             .overlap_limit = full.overlap_limit,
                                                             .callback = full.callback,
                                                             .ctx = full.ctx});
    se3di_pair_mix_all(model);
    se3di_audit_contacts_change(model, before);
    return SE3D_OK;
}

se3d_status se3d_system_get_contact(const se3d_system *system, se3d_contact_settings *settings)
{
    if (!system || !settings) {
        return SE3D_ERR_NULL;
    }
    const size_t size = settings->struct_size;
    if (size < sizeof size) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    const se3di_contact_settings *now = &system->model.contact;
    se3d_contact_settings full = {.struct_size = size,
                                  .law = now->law,
                                  .step = now->step,
                                  .overlap_limit = now->overlap_limit,
                                  .callback = now->callback,
                                  .ctx = now->ctx};
    return se3di_sized_give(settings, size, &full, sizeof full);
}

static se3di_material read_material(const se3d_material_def *def)
{
    return (se3di_material){.density = def->density,
                            .young = def->young,
                            .poisson = def->poisson,
                            .friction = def->friction,
                            .restitution = def->restitution,
                            .rolling_friction = def->rolling_friction,
                            .torsional_friction = def->torsional_friction,
                            .stiffness = def->stiffness,
                            .tangential_ratio = def->tangential_ratio,
                            .cohesion = def->cohesion,
                            .adhesion = def->adhesion,
                            .damping_ratio = def->damping_ratio,
                            .tangential_ratio_hertz = def->tangential_ratio_hertz,
                            .tangential_damping = def->tangential_damping,
                            .rolling_ratio = def->rolling_ratio,
                            .rolling_damping = def->rolling_damping,
                            .damping_rate = def->damping_rate,
                            .tangential_stiffness = def->tangential_stiffness,
                            .rolling_stiffness = def->rolling_stiffness};
}

/* What may be the law's own. */
static se3d_status check_choices(se3d_system *system, const se3d_material_def *def)
{
    const struct {
        const char *what;
        double value, most;
    } choices[] = {{"damping_ratio", def->damping_ratio, 100.0},
                   {"tangential_ratio_hertz", def->tangential_ratio_hertz, 10.0},
                   {"tangential_damping", def->tangential_damping, 10.0},
                   {"rolling_ratio", def->rolling_ratio, 100.0},
                   {"rolling_damping", def->rolling_damping, 10.0},
                   {"damping_rate", def->damping_rate, 1e30},
                   {"tangential_stiffness", def->tangential_stiffness, 1e30},
                   {"rolling_stiffness", def->rolling_stiffness, 1e30}};
    for (size_t k = 0; k < sizeof choices / sizeof *choices; ++k) {
        if (!(isfinite(choices[k].value) && choices[k].value <= choices[k].most)) {
            return SE3DI_FAIL_OF(system, choices[k].what, SE3D_ERR_INVALID_ARGUMENT,
                                 " = %g, must be finite and <= %g (0: as the law has it, below 0: "
                                 "none)",
                                 choices[k].value, choices[k].most);
        }
    }
    if (def->tangential_stiffness != 0.0 && def->tangential_ratio_hertz != 0.0) {
        return SE3DI_FAIL_OF(system, "tangential_stiffness", SE3D_ERR_INVALID_ARGUMENT,
                             " = %g, in place of `tangential_ratio_hertz`, must not be beside it",
                             def->tangential_stiffness);
    }
    if (def->rolling_stiffness != 0.0 && def->rolling_ratio != 0.0) {
        return SE3DI_FAIL_OF(system, "rolling_stiffness", SE3D_ERR_INVALID_ARGUMENT,
                             " = %g, in place of `rolling_ratio`, must not be beside it",
                             def->rolling_stiffness);
    }
    const se3di_material data = read_material(def);
    return check_damping(system, system->model.contact.law, &data);
}

static se3d_status check_material(se3d_system *system, const se3d_material_def *def)
{
    const double most = 1e30;
    SE3DI_TRY(se3di_check_range(system, "density", def->density, 1e-30, most));
    SE3DI_TRY(se3di_check_range(system, "friction", def->friction, 0.0, most));
    SE3DI_TRY(
        se3di_check_range(system, "restitution", def->restitution, SE3DI_RESTITUTION_MIN, 1.0));
    SE3DI_TRY(se3di_check_range(system, "rolling_friction", def->rolling_friction, 0.0, most));
    SE3DI_TRY(se3di_check_range(system, "torsional_friction", def->torsional_friction, 0.0, most));
    SE3DI_TRY(se3di_check_range(system, "cohesion", def->cohesion, 0.0, most));
    SE3DI_TRY(se3di_check_range(system, "adhesion", def->adhesion, 0.0, most));
    SE3DI_TRY(se3di_check_range(system, "stiffness", def->stiffness, 0.0, most));
    SE3DI_TRY(se3di_check_range(system, "tangential_ratio", def->tangential_ratio, 0.0, 10.0));
    SE3DI_TRY(se3di_check_range(system, "young", def->young, 0.0, most));
    SE3DI_TRY(se3di_check_range(system, "poisson", def->poisson, 0.0, 0.5));
    SE3DI_TRY(check_choices(system, def));
    return check_law(system, system->model.contact.law, def->stiffness, def->young);
}

se3d_status se3d_material_create(se3d_system *system, const se3d_material_def *def,
                                 se3d_material *material)
{
    SE3DI_CREATE(system, material);
    se3d_material_def full = se3d_material_def_default();
    SE3DI_TRY(se3di_check_def(system, "material def", def, &full, sizeof full));
    SE3DI_TRY(
        se3di_check_new_name(system, &system->model.material_slots, 0, "material", full.name));
    SE3DI_TRY(check_material(system, &full));
    se3di_material data = read_material(&full);
    se3di_handle handle;
    memcpy(&data.name, &full.name, sizeof data.name); /* copied by the model */
    if (se3di_model_add_material(&system->model, &data, &handle) < 0) {
        return SE3DI_FAIL(system, SE3D_ERR_NO_MEMORY, "no memory for a material");
    }
    se3di_pair_mix_all(&system->model);
    *material = (se3d_material){handle.index1, handle.generation};
    return SE3D_OK;
}

se3d_status se3d_material_set(se3d_system *system, se3d_material material,
                              const se3d_material_def *def)
{
    SE3DI_SET(system);
    uint32_t index;
    SE3DI_TRY(se3di_find_material(system, "material", material, &index));
    se3d_material_def full = se3d_material_def_default();
    SE3DI_TRY(se3di_check_def(system, "material def", def, &full, sizeof full));
    SE3DI_TRY(check_material(system, &full));
    se3di_model *model = &system->model;
    se3di_material data = read_material(&full);
    data.name = model->materials[index].name;
    data.users = model->materials[index].users;
    SE3DI_TRY(check_pair_laws(system, index, &data));
    const double before = se3di_audit_contacts(model);
    model->materials[index] = data;
    se3di_pair_mix_all(model);
    se3di_audit_contacts_change(model, before);
    se3di_model_touch_contact(model);
    return SE3D_OK;
}

se3d_status se3d_material_get(const se3d_system *system, se3d_material material,
                              se3d_material_def *def)
{
    if (!system || !def) {
        return SE3D_ERR_NULL;
    }
    const size_t size = def->struct_size;
    if (size < sizeof size) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    const uint32_t index =
        se3di_slots_find(&system->model.material_slots, material.index1, material.generation);
    if (index == SE3DI_NO_INDEX) {
        return SE3D_ERR_STALE_HANDLE;
    }
    const se3di_material *data = &system->model.materials[index];
    const se3d_material_def full = {.struct_size = size,
                                    .density = data->density,
                                    .friction = data->friction,
                                    .restitution = data->restitution,
                                    .rolling_friction = data->rolling_friction,
                                    .torsional_friction = data->torsional_friction,
                                    .stiffness = data->stiffness,
                                    .tangential_ratio = data->tangential_ratio,
                                    .young = data->young,
                                    .poisson = data->poisson,
                                    .cohesion = data->cohesion,
                                    .adhesion = data->adhesion,
                                    .name = data->name,
                                    .damping_ratio = data->damping_ratio,
                                    .tangential_ratio_hertz = data->tangential_ratio_hertz,
                                    .tangential_damping = data->tangential_damping,
                                    .rolling_ratio = data->rolling_ratio,
                                    .rolling_damping = data->rolling_damping,
                                    .damping_rate = data->damping_rate,
                                    .tangential_stiffness = data->tangential_stiffness,
                                    .rolling_stiffness = data->rolling_stiffness};
    return se3di_sized_give(def, size, &full, sizeof full);
}

se3d_status se3d_material_get_name(const se3d_system *system, se3d_material material,
                                   const char **name)
{
    uint32_t index;
    const se3d_status status =
        se3di_read_index(SE3DI_SLOTS(system, material), SE3DI_HANDLE(material), name, &index);
    return se3di_give_name(status, status < 0 ? NULL : system->model.materials[index].name, name);
}

se3d_status se3d_material_find(const se3d_system *system, const char *name, se3d_material *material)
{
    return se3di_read_named(SE3DI_SLOTS(system, material), name, material);
}

se3d_status se3d_material_destroy(se3d_system *system, se3d_material material)
{
    SE3DI_EDIT(system);
    uint32_t index;
    SE3DI_TRY(se3di_find_material(system, "material", material, &index));
    uint32_t users = system->model.materials[index].users;
    if (users > 0) {
        return SE3DI_FAIL(system, SE3D_ERR_IN_USE,
                          "the material is used by %u shapes or sets of particles; destroy them "
                          "first",
                          users);
    }
    se3di_model_remove_material(&system->model, index);
    se3di_pair_mix_all(&system->model);
    return SE3D_OK;
}

static se3d_status check_pair(se3d_system *system, const se3d_material_pair_def *def)
{
#define CHECK_ONE(name, least, most)                                                               \
    if (!(def->name < 0.0)) {                                                                      \
        SE3DI_TRY(se3di_check_range(system, #name, def->name, least, most));                       \
    }
    SE3DI_OVERRIDE_LIST(CHECK_ONE)
#undef CHECK_ONE
    if (def->damping_ratio >= 0.0 && def->restitution >= 0.0) {
        return SE3DI_FAIL_OF(system, "damping_ratio", SE3D_ERR_INVALID_ARGUMENT,
                             " = %g, in place of `restitution`, must not be beside it",
                             def->damping_ratio);
    }
    if (def->tangential_stiffness >= 0.0 && def->tangential_ratio >= 0.0) {
        return SE3DI_FAIL_OF(system, "tangential_stiffness", SE3D_ERR_INVALID_ARGUMENT,
                             " = %g, in place of `tangential_ratio`, must not be beside it",
                             def->tangential_stiffness);
    }
    if (def->rolling_stiffness >= 0.0 && def->rolling_ratio >= 0.0) {
        return SE3DI_FAIL_OF(system, "rolling_stiffness", SE3D_ERR_INVALID_ARGUMENT,
                             " = %g, in place of `rolling_ratio`, must not be beside it",
                             def->rolling_stiffness);
    }
    if (def->law > SE3D_CONTACT_LAW_HERTZ_MINDLIN) {
        return SE3DI_FAIL_OF(system, "law", SE3D_ERR_INVALID_ARGUMENT,
                             " = %d, must be hooke, hertz_mindlin or negative (the system's)",
                             (int)def->law);
    }
    return SE3D_OK;
}

se3d_status se3d_material_set_pair(se3d_system *system, se3d_material a, se3d_material b,
                                   const se3d_material_pair_def *def)
{
    SE3DI_SET(system);
    uint32_t index_a, index_b;
    SE3DI_TRY(se3di_find_material(system, "material a", a, &index_a));
    SE3DI_TRY(se3di_find_material(system, "material b", b, &index_b));
    se3d_material_pair_def full = se3d_material_pair_def_default();
    SE3DI_TRY(se3di_check_def(system, "pair def", def, &full, sizeof full));
    SE3DI_TRY(check_pair(system, &full));
#define TAKE(name, least, most) .name = full.name,
    const se3di_override over = {SE3DI_OVERRIDE_LIST(TAKE).law = full.law};
#undef TAKE
    SE3DI_TRY(check_pair_law(system, system->model.contact.law, &over,
                             &system->model.materials[index_a], &system->model.materials[index_b]));
    const double before = se3di_audit_contacts(&system->model);
    se3di_model_set_override(&system->model, index_a, index_b, &over);
    se3di_pair_mix_all(&system->model);
    se3di_audit_contacts_change(&system->model, before);
    return SE3D_OK;
}

size_t se3d_system_count_materials(const se3d_system *system)
{
    return system ? system->model.material_slots.count : 0;
}

se3d_status se3d_system_get_material(const se3d_system *system, size_t index,
                                     se3d_material *material)
{
    return se3di_read_handle(SE3DI_SLOTS(system, material), index, material);
}

se3d_status se3d_material_get_pair(const se3d_system *system, se3d_material a, se3d_material b,
                                   se3d_material_pair_def *def)
{
    uint32_t index_a, index_b;
    SE3DI_TRY(se3di_read_index(SE3DI_SLOTS(system, material), SE3DI_HANDLE(a), def, &index_a));
    SE3DI_TRY(se3di_read_index(SE3DI_SLOTS(system, material), SE3DI_HANDLE(b), def, &index_b));
    const se3di_override *over =
        &system->model.overrides[index_a * system->model.material_slots.count + index_b];
#define TELL(name, least, most) .name = over->name,
    const se3d_material_pair_def full = {.struct_size = def->struct_size,
                                         SE3DI_OVERRIDE_LIST(TELL).law = over->law};
#undef TELL
    return se3di_sized_give(def, def->struct_size, &full, sizeof full);
}
