/* SPDX-License-Identifier: BSD-3-Clause */
#include "se3d/base.h"

#define STRING_OF(x) #x
#define STRING(x)    STRING_OF(x)

const char *se3d_status_get_text(se3d_status status)
{
    switch (status) {
#define STATUS_CASE(name, value, text)                                                             \
    case name:                                                                                     \
        return text;
        SE3D_STATUS_LIST(STATUS_CASE)
#undef STATUS_CASE
    }
    return "unknown status";
}

int32_t se3d_version_number(void)
{
    return SE3D_VERSION_NUMBER;
}

const char *se3d_version_get_text(void)
{
    return STRING(SE3D_VERSION_MAJOR) "." STRING(SE3D_VERSION_MINOR) "." STRING(SE3D_VERSION_PATCH);
}
