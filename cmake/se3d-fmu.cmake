# SPDX-License-Identifier: BSD-3-Clause
# se3d_fmu: the shared object inside functional mock-up units, of libse3d and libse3d-io without
# threads. It has what it needs in itself and asks for libc and libm only, so it takes libyaml and
# AMD from their static libraries, which must be of position-independent code.
include(CheckCSourceCompiles)

# SE3D_HAS_FMU says whether it can be made.
function(se3d_find_fmu_parts)
    set(SE3D_HAS_FMU OFF PARENT_SCOPE)
    if(NOT SE3D_FMU)
        return()
    endif()
    if(NOT CMAKE_SYSTEM_NAME STREQUAL "Linux" OR NOT TARGET se3d_io_static)
        message(STATUS "No units of FMI: they are made on Linux only")
        return()
    endif()
    foreach(library yaml amd)
        find_library(SE3D_${library}_STATIC_LIBRARY NAMES lib${library}.a)
        mark_as_advanced(SE3D_${library}_STATIC_LIBRARY)
        if(NOT SE3D_${library}_STATIC_LIBRARY)
            message(STATUS "No units of FMI: lib${library}.a is missing "
                    "(set SE3D_${library}_STATIC_LIBRARY, or SE3D_FMU=OFF)")
            return()
        endif()
    endforeach()
    set(CMAKE_REQUIRED_FLAGS "-fPIC")
    set(CMAKE_REQUIRED_LINK_OPTIONS -shared -Wl,--no-undefined)
    set(CMAKE_REQUIRED_LIBRARIES "${SE3D_yaml_STATIC_LIBRARY}" "${SE3D_amd_STATIC_LIBRARY}" m)
    set(CMAKE_REQUIRED_INCLUDES "${SE3D_yaml_INCLUDE}" "${SE3D_amd_INCLUDE}")
    check_c_source_compiles("
        #include <amd.h>
        #include <yaml.h>
        int use(yaml_parser_t *parser, yaml_event_t *event, int *a, double *b);
        int use(yaml_parser_t *parser, yaml_event_t *event, int *a, double *b)
        {
            amd_defaults(b);
            amd_2(1, a, a, a, 1, 1, a, a, a, a, a, a, a, b, b);
            return yaml_parser_initialize(parser) && yaml_parser_parse(parser, event);
        }" SE3D_FMU_LINKS)
    if(NOT SE3D_FMU_LINKS)
        message(STATUS "No units of FMI: libyaml.a and libamd.a cannot be put into a shared object "
                "(they are not position-independent); SE3D_FMU=OFF says no more of it")
        return()
    endif()
    set(SE3D_HAS_FMU ON PARENT_SCOPE)
endfunction()

function(se3d_add_fmu)
    # What has threads in the library is compiled again without them.
    foreach(file base/threads particles/sweep particles/slabs analysis/batch_step)
        list(APPEND serial "${PROJECT_SOURCE_DIR}/lib/${file}.c")
    endforeach()
    file(GLOB sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/fmi/*.c")
    add_library(se3d_fmu MODULE ${sources} ${serial})
    se3d_compile_options(se3d_fmu)
    set(map "${PROJECT_SOURCE_DIR}/fmi/se3d_fmu.map")
    set_target_properties(se3d_fmu PROPERTIES PREFIX "" OUTPUT_NAME se3d_fmu LINK_DEPENDS "${map}"
                          LIBRARY_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/lib"
                          C_VISIBILITY_PRESET hidden)
    target_compile_definitions(se3d_fmu PRIVATE SE3D_BUILD)
    target_include_directories(se3d_fmu PRIVATE "${PROJECT_SOURCE_DIR}/lib" "${PROJECT_SOURCE_DIR}/include"
                               "${SE3D_amd_INCLUDE}")
    target_link_libraries(se3d_fmu PRIVATE $<TARGET_FILE:se3d_io_static> $<TARGET_FILE:se3d_static>
                          "${SE3D_yaml_STATIC_LIBRARY}" "${SE3D_amd_STATIC_LIBRARY}" m)
    target_link_options(se3d_fmu PRIVATE "-Wl,--version-script=${map}" -Wl,-Bsymbolic -Wl,--gc-sections
                        -Wl,--strip-debug)
    if(NOT SE3D_SANITIZE)
        target_link_options(se3d_fmu PRIVATE -Wl,--no-undefined)
    endif()
    add_dependencies(se3d_fmu se3d_io_static se3d_static)
    file(READ "${PROJECT_SOURCE_DIR}/LICENSE" se3d_fmu_license)
    configure_file("${PROJECT_SOURCE_DIR}/fmi/licenses.txt.in"
                   "${PROJECT_BINARY_DIR}/lib/se3d_fmu_licenses.txt" @ONLY)
endfunction()
