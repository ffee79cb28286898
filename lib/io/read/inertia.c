/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/read/inertia.h"

#include <math.h>

#include "io/document/document.h"
#include "io/document/value.h"

bool se3di_read_inertia(se3di_reader *reader, const se3di_node *node, double inertia[6])
{
    double J[3][3];
    size_t row = 0;
    if (node->kind == SE3DI_NODE_LIST && node->count == 6) {
        return se3di_read_vector(reader, node, 6, inertia);
    }
    if (node->kind != SE3DI_NODE_LIST || node->count != 3) {
        return se3di_reader_fail(reader, node,
                                 "must be [Ixx, Iyy, Izz], [Ixx, Iyy, Izz, Ixy, Iyz, Ixz] or three "
                                 "rows of three numbers");
    }
    if (node->first->kind != SE3DI_NODE_LIST) {
        return se3di_read_vector(reader, node, 3, inertia);
    }
    for (const se3di_node *child = node->first; child; child = child->next) {
        if (!se3di_read_vector(reader, child, 3, J[row++])) {
            return false;
        }
    }
    for (size_t i = 0; i < 3; ++i) {
        const size_t j = (i + 1) % 3;
        if (fabs(J[i][j] - J[j][i]) > 1e-9 * (fabs(J[i][i]) + fabs(J[j][j]))) {
            return se3di_reader_fail(reader, node, "is not symmetric: %g and %g face each other",
                                     J[i][j], J[j][i]);
        }
        inertia[i] = J[i][i];
    }
    inertia[3] = J[0][1];
    inertia[4] = J[1][2];
    inertia[5] = J[0][2];
    return true;
}
