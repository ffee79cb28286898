# SPDX-License-Identifier: BSD-3-Clause
# The libraries that libse3d and libse3d-io are linked with, as targets se3d_deps::<name>. Used by
# the build, and by the installed package for those who link statically.

# se3d_find_library(<name> <names of the library> <header or ""> <apt package> [REQUIRED])
function(se3d_find_library name library header package)
    if(TARGET se3d_deps::${name})
        return()
    endif()
    find_library(SE3D_${name}_LIBRARY NAMES ${library})
    set(found "${SE3D_${name}_LIBRARY}")
    if(header)
        find_path(SE3D_${name}_INCLUDE NAMES ${header} PATH_SUFFIXES suitesparse)
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

# se3d_add_openmp(<libraries> <folders>): the runtime of OpenMP, which a compiler brings with it.
function(se3d_add_openmp libraries folders)
    if(NOT TARGET se3d_deps::openmp)
        add_library(se3d_deps::openmp INTERFACE IMPORTED GLOBAL)
        set_target_properties(se3d_deps::openmp PROPERTIES INTERFACE_LINK_LIBRARIES "${libraries}"
                              INTERFACE_LINK_DIRECTORIES "${folders}")
    endif()
endfunction()

# Look for OpenMP if SE3D_OPENMP asks for it; SE3D_OPENMP_LIBRARIES and _FOLDERS are what to link.
function(se3d_find_openmp)
    set(libraries "")
    set(folders "")
    if(SE3D_OPENMP)
        find_package(OpenMP COMPONENTS C)
    endif()
    if(SE3D_OPENMP AND OpenMP_C_FOUND)
        set(libraries "${OpenMP_C_LIB_NAMES}")
        foreach(name IN LISTS libraries)
            cmake_path(GET OpenMP_${name}_LIBRARY PARENT_PATH folder)
            if(NOT folder IN_LIST CMAKE_C_IMPLICIT_LINK_DIRECTORIES)
                list(APPEND folders "${folder}")
            endif()
        endforeach()
    elseif(SE3D_OPENMP)
        message(STATUS "No OpenMP: particles will use one thread")
    endif()
    set(SE3D_OPENMP_LIBRARIES "${libraries}" PARENT_SCOPE)
    set(SE3D_OPENMP_FOLDERS "${folders}" PARENT_SCOPE)
    se3d_add_openmp("${libraries}" "${folders}")
endfunction()

function(se3d_find_core_dependencies)
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

# se3d_find_part(<wanted> <name> <names of the library> <header> <package> <without>): a library that libse3d-io can
# do without. SE3D_HAS_<NAME> says whether it is there; without it se3d_deps::<name> links nothing, and a
# message says what is missing.
function(se3d_find_part wanted name library header package without)
    string(TOUPPER "SE3D_HAS_${name}" has)
    if(wanted)
        se3d_find_library(${name} "${library}" ${header} ${package})
    endif()
    set(${has} OFF)
    if(TARGET se3d_deps::${name})
        get_target_property(type se3d_deps::${name} TYPE)
        if(NOT type STREQUAL "INTERFACE_LIBRARY")
            set(${has} ON)
        endif()
    else()
        add_library(se3d_deps::${name} INTERFACE IMPORTED GLOBAL)
        if(wanted)
            message(STATUS "No ${name}: ${without} (Debian: ${package})")
        endif()
    endif()
    set(${has} ${${has}} PARENT_SCOPE)
endfunction()

# What reads the XML of robots' formats, and what compresses results; <without expat> and <without zlib> tell
# what is not there without them. The names of the libraries on Windows follow those of others.
macro(se3d_find_io_parts expat zlib without_expat without_zlib)
    se3d_find_part("${expat}" expat "expat;libexpat;libexpatMD;libexpatd;libexpatdMD" expat.h libexpat1-dev
                   "${without_expat}")
    se3d_find_part("${zlib}" zlib "z;zlib;zlibstatic;zlibd;zlibstaticd" zlib.h zlib1g-dev "${without_zlib}")
endmacro()

# se3d_find_optional(<wanted> <name> <header> <package> <without>): a library that the program can do
# without. SE3D_HAS_<NAME> says whether it is there; if not, a message what is missing without it.
function(se3d_find_optional wanted name header package without)
    string(TOUPPER "SE3D_HAS_${name}" has)
    set(${has} OFF)
    if(wanted)
        se3d_find_library(${name} ${name} ${header} ${package})
        if(TARGET se3d_deps::${name})
            set(${has} ON)
        else()
            message(STATUS "No ${name}: ${without} (Debian: ${package})")
        endif()
    endif()
    set(${has} ${${has}} PARENT_SCOPE)
endfunction()
