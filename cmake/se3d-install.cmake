# SPDX-License-Identifier: BSD-3-Clause
# Headers, libraries, CMake package `se3d`, se3d.pc and se3d-io.pc; the program with its pages of the manual, completion
# and viewer; documents. Components: runtime, development, program, documentation.
include(CMakePackageConfigHelpers)

set(se3d_cmake_dir "${CMAKE_INSTALL_LIBDIR}/cmake/se3d")
set(se3d_pc_dir "${CMAKE_INSTALL_LIBDIR}/pkgconfig")

install(DIRECTORY "${PROJECT_SOURCE_DIR}/include/se3d" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}"
        COMPONENT development FILES_MATCHING PATTERN "*.h")

# Shared and static targets are exported apart: only the static ones need our dependencies, each its own.
set(se3d_kinds shared static)
set(se3d_shared_targets se3d)
set(se3d_static_targets se3d_static)
if(TARGET se3d_io)
    list(APPEND se3d_kinds io-static)
    list(APPEND se3d_shared_targets se3d_io)
    set(se3d_io-static_targets se3d_io_static)
endif()
foreach(kind IN LISTS se3d_kinds)
    install(TARGETS ${se3d_${kind}_targets} EXPORT se3d-${kind}-targets
            LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT runtime NAMELINK_COMPONENT development
            ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT development
            RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT runtime)
    install(EXPORT se3d-${kind}-targets NAMESPACE se3d:: DESTINATION "${se3d_cmake_dir}" COMPONENT development)
endforeach()

# What needs MPI, in a component of its own.
if(TARGET se3d_mpi)
    install(TARGETS se3d_mpi EXPORT se3d-mpi-targets
            LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT mpi)
    install(EXPORT se3d-mpi-targets NAMESPACE se3d:: DESTINATION "${se3d_cmake_dir}" COMPONENT mpi)
    install(FILES "${PROJECT_SOURCE_DIR}/mpi/include/se3d/mpi.h"
            DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/se3d" COMPONENT mpi)
endif()
if(TARGET se3d_mpi_program)
    install(TARGETS se3d_mpi_program RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT mpi)
endif()

if(TARGET se3d_record)
    install(TARGETS se3d_record LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}/se3d" COMPONENT program)
    install(FILES "${PROJECT_SOURCE_DIR}/record/record.h" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/se3d"
            COMPONENT development)
endif()

configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/se3d-config.cmake.in"
                              "${PROJECT_BINARY_DIR}/se3d-config.cmake"
                              INSTALL_DESTINATION "${se3d_cmake_dir}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/se3d-config-version.cmake"
                                 COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/se3d-config.cmake"
              "${PROJECT_BINARY_DIR}/se3d-config-version.cmake"
              "${PROJECT_SOURCE_DIR}/cmake/se3d-dependencies.cmake"
        DESTINATION "${se3d_cmake_dir}" COMPONENT development)

# The prefix is taken from where the .pc file lies, so that an installed tree may be moved.
if(IS_ABSOLUTE "${CMAKE_INSTALL_LIBDIR}")
    set(SE3D_PC_PREFIX "${CMAKE_INSTALL_PREFIX}")
else()
    file(RELATIVE_PATH se3d_pc_up "/root/${se3d_pc_dir}" "/root")
    string(REGEX REPLACE "/$" "" se3d_pc_up "${se3d_pc_up}")
    set(SE3D_PC_PREFIX "\${pcfiledir}/${se3d_pc_up}")
endif()
foreach(dir LIBDIR INCLUDEDIR)
    if(IS_ABSOLUTE "${CMAKE_INSTALL_${dir}}")
        set(SE3D_PC_${dir} "${CMAKE_INSTALL_${dir}}")
    else()
        set(SE3D_PC_${dir} "\${prefix}/${CMAKE_INSTALL_${dir}}")
    endif()
endforeach()
# Those who link statically need -L for what does not lie in the compiler's own folders.
set(SE3D_PC_LINK_FOLDERS "")
foreach(library amd yaml expat zlib)
    if(NOT SE3D_${library}_LIBRARY)
        continue()
    endif()
    cmake_path(GET SE3D_${library}_LIBRARY PARENT_PATH folder)
    if(folder AND NOT folder IN_LIST CMAKE_C_IMPLICIT_LINK_DIRECTORIES
       AND NOT SE3D_PC_LINK_FOLDERS MATCHES "-L${folder}( |$)")
        string(APPEND SE3D_PC_LINK_FOLDERS " -L${folder}")
    endif()
endforeach()
# By the names that they were found by: zlib is libz.so here and zlib.lib there.
foreach(part EXPAT ZLIB)
    set(SE3D_PC_${part} "")
    if(SE3D_HAS_${part})
        string(TOLOWER ${part} library)
        cmake_path(GET SE3D_${library}_LIBRARY STEM name)
        if(NOT MSVC)
            string(REGEX REPLACE "^lib" "" name "${name}")
        endif()
        set(SE3D_PC_${part} " -l${name}")
    endif()
endforeach()
set(SE3D_PC_OPENMP "")
foreach(folder IN LISTS SE3D_OPENMP_FOLDERS)
    string(APPEND SE3D_PC_OPENMP " -L${folder}")
endforeach()
foreach(library IN LISTS SE3D_OPENMP_LIBRARIES)
    string(APPEND SE3D_PC_OPENMP " -l${library}")
endforeach()
if(TARGET se3d_mpi)
    list(TRANSFORM MPI_C_INCLUDE_DIRS PREPEND " -I" OUTPUT_VARIABLE SE3D_PC_MPI)
    string(REPLACE ";" "" SE3D_PC_MPI "${SE3D_PC_MPI}")
    list(JOIN MPI_C_LIBRARIES " " SE3D_PC_MPI_LIBRARIES)
    configure_file("${PROJECT_SOURCE_DIR}/pkgconfig/se3d-mpi.pc.in" "${PROJECT_BINARY_DIR}/se3d-mpi.pc" @ONLY)
    install(FILES "${PROJECT_BINARY_DIR}/se3d-mpi.pc" DESTINATION "${se3d_pc_dir}" COMPONENT mpi)
endif()
foreach(pc se3d se3d-io)
    if(pc STREQUAL "se3d" OR TARGET se3d_io)
        configure_file("${PROJECT_SOURCE_DIR}/pkgconfig/${pc}.pc.in"
                       "${PROJECT_BINARY_DIR}/${pc}.pc" @ONLY)
        install(FILES "${PROJECT_BINARY_DIR}/${pc}.pc" DESTINATION "${se3d_pc_dir}" COMPONENT development)
    endif()
endforeach()

# Documents. The schema lies where editors are pointed at it.
foreach(name LICENSE README.md CHANGELOG.md)
    install(FILES "${PROJECT_SOURCE_DIR}/${name}" DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT documentation)
endforeach()
install(DIRECTORY "${PROJECT_SOURCE_DIR}/docs" DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT documentation)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/examples/models" "${PROJECT_SOURCE_DIR}/examples/fsae" DESTINATION "${CMAKE_INSTALL_DOCDIR}/examples"
        COMPONENT documentation)
install(FILES "${PROJECT_SOURCE_DIR}/docs/se3d.schema.json" DESTINATION "${CMAKE_INSTALL_DATADIR}/se3d"
        COMPONENT program)

# The pages of the manual and the completion of shells are what the program says of itself; a program for another machine
# needs an emulator for that (CMAKE_CROSSCOMPILING_EMULATOR).
if(TARGET se3d_program)
    install(TARGETS se3d_program RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT program)
    if(TARGET se3d_fmu)
        install(TARGETS se3d_fmu LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}/se3d" COMPONENT program)
        install(FILES "${PROJECT_BINARY_DIR}/lib/se3d_fmu_licenses.txt"
                DESTINATION "${CMAKE_INSTALL_LIBDIR}/se3d" COMPONENT program)
    endif()
endif()
if(TARGET se3d_program AND UNIX AND (NOT CMAKE_CROSSCOMPILING OR CMAKE_CROSSCOMPILING_EMULATOR))
    set(se3d_manual_dir "${PROJECT_BINARY_DIR}/manual")
    set(se3d_manual "")
    # se3d_manual_page(<file> <where to> <words of the program>...)
    function(se3d_manual_page file folder)
        set(path "${se3d_manual_dir}/${file}")
        add_custom_command(OUTPUT "${path}" DEPENDS se3d_program VERBATIM
            COMMAND "${CMAKE_COMMAND}" -E make_directory "${se3d_manual_dir}"
            COMMAND se3d_program ${ARGN} > "${path}")
        if(SE3D_DEBIAN AND folder MATCHES "/man[1-9]$")
            add_custom_command(OUTPUT "${path}.gz" DEPENDS "${path}" VERBATIM
                COMMAND gzip -9 -n -f -k "${path}")
            string(APPEND path ".gz")
        endif()
        install(FILES "${path}" DESTINATION "${folder}" COMPONENT program)
        set(se3d_manual ${se3d_manual} "${path}" PARENT_SCOPE)
    endfunction()
    se3d_manual_page(se3d.1 "${CMAKE_INSTALL_MANDIR}/man1" help --man)
    se3d_manual_page(se3d-model.5 "${CMAKE_INSTALL_MANDIR}/man5" explain --man)
    se3d_manual_page(se3d "${CMAKE_INSTALL_DATADIR}/bash-completion/completions" completion bash)
    se3d_manual_page(_se3d "${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions" completion zsh)
    se3d_manual_page(se3d.fish "${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d" completion fish)
    add_custom_target(se3d_manual ALL DEPENDS ${se3d_manual})
endif()

# What `se3d view` and `se3d video` make their page of. three.js and uPlot come from npm when it is installed; where
# npm is not there, the page's first user makes it.
if(TARGET se3d_program)
    option(SE3D_BUNDLE_VIEWER "Install three.js with the viewer" ${PROJECT_IS_TOP_LEVEL})
    set(se3d_viewer_dir "${CMAKE_INSTALL_DATADIR}/se3d/viewer")
    install(DIRECTORY "${PROJECT_SOURCE_DIR}/tools/viewer/" DESTINATION "${se3d_viewer_dir}" COMPONENT program
            PATTERN "*.sh" PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
                                       WORLD_READ WORLD_EXECUTE)
    if(SE3D_BUNDLE_VIEWER AND UNIX)
        install(CODE "
            execute_process(COMMAND sh \"${PROJECT_SOURCE_DIR}/tools/viewer/build.sh\" \"${PROJECT_BINARY_DIR}/viewer\"
                            RESULT_VARIABLE se3d_viewer_failed)
            if(se3d_viewer_failed)
                message(STATUS \"three.js is not installed with the viewer; it will be made at its first use\")
            endif()" COMPONENT program)
        install(FILES "${PROJECT_BINARY_DIR}/viewer/three.js" DESTINATION "${se3d_viewer_dir}" COMPONENT program OPTIONAL)
    endif()
endif()
