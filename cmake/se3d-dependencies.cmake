# SPDX-License-Identifier: BSD-3-Clause
# The libraries that libse3d and libse3d-io are linked with, as targets se3d_deps::<name>. Used by
# the build, and by the installed package for those who link statically.

# se3d_find_library(<name> <library> <header or ""> <apt package> [REQUIRED])
function(se3d_find_library name library header package)
    if(TARGET se3d_deps::${name})
        return()
    endif()
    find_library(SE3D_${name}_LIBRARY NAMES ${library})
    set(found "${SE3D_${name}_LIBRARY}")
    if(header)
        find_path(SE3D_${name}_INCLUDE NAMES ${header} PATH_SUFFIXES suitesparse openblas)
        if(NOT SE3D_${name}_INCLUDE)
            set(found "")
        endif()
    endif()
    mark_as_advanced(SE3D_${name}_LIBRARY SE3D_${name}_INCLUDE)
    if(NOT found)
        if("${ARGN}" STREQUAL "REQUIRED")
            message(FATAL_ERROR "se3d needs the library `${library}`"
                    " (header ${header}): on Debian or Ubuntu `apt-get install ${package}`, "
                    "elsewhere set SE3D_${name}_LIBRARY and SE3D_${name}_INCLUDE.")
        endif()
        return()
    endif()
    add_library(se3d_deps::${name} UNKNOWN IMPORTED GLOBAL)
    set_target_properties(se3d_deps::${name} PROPERTIES IMPORTED_LOCATION "${found}")
    if(header)
        set_target_properties(se3d_deps::${name} PROPERTIES
                              INTERFACE_INCLUDE_DIRECTORIES "${SE3D_${name}_INCLUDE}")
    endif()
endfunction()

function(se3d_find_math)
    if(NOT TARGET se3d_deps::math)
        add_library(se3d_deps::math INTERFACE IMPORTED GLOBAL)
        if(UNIX)
            set_target_properties(se3d_deps::math PROPERTIES INTERFACE_LINK_LIBRARIES m)
        endif()
    endif()
endfunction()

function(se3d_find_core_dependencies)
    se3d_find_library(lapacke lapacke lapacke.h liblapacke-dev ${ARGN})
    se3d_find_library(openblas openblas "" libopenblas-dev ${ARGN})
    se3d_find_library(suitesparseconfig suitesparseconfig "" libsuitesparse-dev ${ARGN})
    se3d_find_library(amd amd amd.h libsuitesparse-dev ${ARGN})
    se3d_find_math()
    if(TARGET se3d_deps::amd AND TARGET se3d_deps::suitesparseconfig)
        set_target_properties(se3d_deps::amd PROPERTIES
                              INTERFACE_LINK_LIBRARIES se3d_deps::suitesparseconfig)
    endif()
endfunction()

function(se3d_find_io_dependencies)
    se3d_find_library(yaml yaml yaml.h libyaml-dev ${ARGN})
    se3d_find_math()
endfunction()
