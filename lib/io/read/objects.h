/* SPDX-License-Identifier: BSD-3-Clause */
/* All objects of the model file; the table of each stands beside its reader. */
#ifndef SE3D_IO_OBJECTS_H
#define SE3D_IO_OBJECTS_H

#include "io/document/keys.h"

/* In the order of the schema. */
#define SE3DI_OBJECT_LIST(X)                                                                       \
    X(model)                                                                                       \
    X(instance)                                                                                    \
    X(part)                                                                                        \
    X(units)                                                                                       \
    X(spline)                                                                                      \
    X(orientation)                                                                                 \
    X(shape)                                                                                       \
    X(marker)                                                                                      \
    X(material)                                                                                    \
    X(contact)                                                                                     \
    X(pair)                                                                                        \
    X(clump)                                                                                       \
    X(sphere)                                                                                      \
    X(radius)                                                                                      \
    X(particles)                                                                                   \
    X(source)                                                                                      \
    X(sink)                                                                                        \
    X(region)                                                                                      \
    X(bond)                                                                                        \
    X(stage)                                                                                       \
    X(flow)                                                                                        \
    X(servo)                                                                                       \
    X(body)                                                                                        \
    X(term)                                                                                        \
    X(breakage)                                                                                    \
    X(joint)                                                                                       \
    X(driver)                                                                                      \
    X(constraint)                                                                                  \
    X(force)                                                                                       \
    X(state)                                                                                       \
    X(road)                                                                                        \
    X(wheel)                                                                                       \
    X(analysis)                                                                                    \
    X(event)                                                                                       \
    X(fmu)                                                                                         \
    X(fmu_input)                                                                                   \
    X(fmu_output)                                                                                  \
    X(fmu_parameter)                                                                               \
    X(modes_input)                                                                                 \
    X(modes_output)                                                                                \
    X(frequencies)                                                                                 \
    X(output)                                                                                      \
    X(goal)                                                                                        \
    X(unknown)                                                                                     \
    X(limit)                                                                                       \
    X(fields)                                                                                      \
    X(study)                                                                                       \
    X(varied)                                                                                      \
    X(measure)

#define SE3DI_OBJECT(name) extern const se3di_object se3di_object_##name;
SE3DI_OBJECT_LIST(SE3DI_OBJECT)
#undef SE3DI_OBJECT

/* The k-th object, NULL behind the last. */
const se3di_object *se3di_objects_get(size_t k);

#endif
