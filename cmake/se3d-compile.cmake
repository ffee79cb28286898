# SPDX-License-Identifier: BSD-3-Clause
# How every target is compiled, and how a library becomes a static and a shared one.
include(CheckLinkerFlag)

if(PROJECT_IS_TOP_LEVEL AND NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

set(se3d_warnings
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wdouble-promotion
    -Wstrict-prototypes -Wmissing-prototypes -Wpointer-arith -Wcast-qual -Wcast-align
    -Wwrite-strings -Wundef -Wvla -Wformat=2 -Wnull-dereference -Wimplicit-fallthrough)

if(NOT MSVC)
    check_linker_flag(C "-Wl,--version-script=${PROJECT_SOURCE_DIR}/lib/se3d.map"
                      SE3D_HAS_VERSION_SCRIPT)
    check_linker_flag(C "-Wl,--no-undefined" SE3D_HAS_NO_UNDEFINED)
    check_linker_flag(C "-Wl,-z,nodelete" SE3D_HAS_NODELETE)
endif()

# C11 without extensions, no contraction of a*b+c into one rounding (results must not depend on the
# machine), hidden symbols. With sanitizers the tests take internal symbols from one shared library.
set(se3d_visibility hidden)
if(SE3D_SANITIZE)
    set(se3d_visibility default)
endif()
function(se3d_compile_options target)
    set_target_properties(${target} PROPERTIES C_STANDARD 11 C_STANDARD_REQUIRED ON
                          C_EXTENSIONS OFF C_VISIBILITY_PRESET ${se3d_visibility})
    if(MSVC)
        target_compile_options(${target} PRIVATE /fp:precise)
        return()
    endif()
    target_compile_options(${target} PRIVATE -ffp-contract=off)
    if(PROJECT_IS_TOP_LEVEL)
        target_compile_options(${target} PRIVATE ${se3d_warnings})
    endif()
    if(SE3D_WERROR)
        target_compile_options(${target} PRIVATE -Werror)
    endif()
    if(SE3D_SANITIZE)
        target_compile_options(${target} PRIVATE -fsanitize=${SE3D_SANITIZE}
                               -fno-sanitize-recover=all -fno-omit-frame-pointer)
        target_link_options(${target} PRIVATE -fsanitize=${SE3D_SANITIZE})
    endif()
endfunction()

# se3d_add_library(<name> OUTPUT_NAME .. EXPORT_NAME .. MAP .. SOURCES .. [PUBLIC ..] [PRIVATE ..])
# makes <name> (shared) and <name>_static from one set of objects. A PUBLIC library `x` stands for
# x and x_static.
function(se3d_add_library name)
    cmake_parse_arguments(arg "" "OUTPUT_NAME;EXPORT_NAME;MAP" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
    list(TRANSFORM arg_PUBLIC APPEND _static OUTPUT_VARIABLE public_static)
    add_library(${name}_objects OBJECT ${arg_SOURCES})
    se3d_compile_options(${name}_objects)
    set_target_properties(${name}_objects PROPERTIES POSITION_INDEPENDENT_CODE ON)
    target_compile_definitions(${name}_objects PRIVATE SE3D_BUILD)
    target_include_directories(${name}_objects PRIVATE "${PROJECT_SOURCE_DIR}/lib"
                                                       "${PROJECT_SOURCE_DIR}/include")
    target_link_libraries(${name}_objects PRIVATE ${arg_PRIVATE})

    add_library(${name} SHARED $<TARGET_OBJECTS:${name}_objects>)
    target_link_libraries(${name} PUBLIC ${arg_PUBLIC} PRIVATE ${arg_PRIVATE})
    set_target_properties(${name} PROPERTIES VERSION ${PROJECT_VERSION}
                          SOVERSION ${PROJECT_VERSION_MAJOR})
    if(SE3D_HAS_VERSION_SCRIPT)
        target_link_options(${name} PRIVATE "-Wl,--version-script=${PROJECT_SOURCE_DIR}/${arg_MAP}")
        set_target_properties(${name} PROPERTIES LINK_DEPENDS "${PROJECT_SOURCE_DIR}/${arg_MAP}")
    endif()
    if(SE3D_HAS_NODELETE) # threads of OpenMP wait for more in its code, which would go with ours
        target_link_options(${name} PRIVATE "-Wl,-z,nodelete")
    endif()
    if(SE3D_HAS_NO_UNDEFINED AND NOT SE3D_SANITIZE)
        target_link_options(${name} PRIVATE "-Wl,--no-undefined")
    endif()

    add_library(${name}_static STATIC $<TARGET_OBJECTS:${name}_objects>)
    target_link_libraries(${name}_static PUBLIC ${public_static} PRIVATE ${arg_PRIVATE})
    target_compile_definitions(${name}_static INTERFACE SE3D_STATIC)

    foreach(suffix "" "_static")
        set(target ${name}${suffix})
        set_target_properties(${target} PROPERTIES OUTPUT_NAME ${arg_OUTPUT_NAME}
                              EXPORT_NAME ${arg_EXPORT_NAME}${suffix} LINKER_LANGUAGE C)
        if(MSVC AND suffix)
            set_target_properties(${target} PROPERTIES OUTPUT_NAME ${arg_OUTPUT_NAME}_static)
        endif()
        if(SE3D_SANITIZE)
            target_link_options(${target} PRIVATE -fsanitize=${SE3D_SANITIZE})
        endif()
        target_include_directories(${target} INTERFACE
            "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>"
            "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>")
        add_library(se3d::${arg_EXPORT_NAME}${suffix} ALIAS ${target})
    endforeach()
endfunction()
