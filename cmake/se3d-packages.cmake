# SPDX-License-Identifier: BSD-3-Clause
# Debian packages: libse3d0, libse3d-dev, se3d, se3d-doc (tools/packages.sh). Elsewhere `cpack` makes an archive.
set(CPACK_PACKAGE_NAME "se3d")
set(CPACK_PACKAGE_VENDOR "libse3d")
set(CPACK_PACKAGE_CONTACT "libse3d maintainers <maintainers@libse3d.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_RESOURCE_FILE_LICENSE "${PROJECT_SOURCE_DIR}/LICENSE")
set(CPACK_GENERATOR "TGZ")
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_PRIORITY "optional")

set(se3d_deb_runtime "libse3d${PROJECT_VERSION_MAJOR}")
set(se3d_deb_development "libse3d-dev")
set(se3d_deb_program "se3d")
set(se3d_deb_documentation "se3d-doc")

# se3d_describe(<component> <section> <first line> <text>): the text of a package
function(se3d_describe component section summary)
    list(JOIN ARGN "\n" text)
    string(TOUPPER "${component}" upper)
    set(CPACK_COMPONENT_${upper}_DESCRIPTION "${summary}\n${text}" PARENT_SCOPE)
    set(CPACK_DEBIAN_${upper}_PACKAGE_NAME "${se3d_deb_${component}}" PARENT_SCOPE)
    set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION "${section}" PARENT_SCOPE)
endfunction()

se3d_describe(runtime libs "constrained rigid multibody dynamics (shared libraries)"
    "libse3d computes the motion of constrained rigid bodies in three dimensions:"
    "kinematics, inverse dynamics, dynamics, equilibria and vibration modes of"
    "mechanisms, with contact and friction up to granular flows."
    ""
    "This package has the shared libraries libse3d and libse3d-io.")
se3d_describe(development libdevel "constrained rigid multibody dynamics (development files)"
    "libse3d computes the motion of constrained rigid bodies in three dimensions."
    ""
    "This package has the headers, the static libraries, and what pkg-config and"
    "CMake need.")
se3d_describe(program science "constrained rigid multibody dynamics (program)"
    "The program se3d reads mechanisms from text files, computes kinematics,"
    "dynamics, equilibria and modes, and writes tables, plots, pages in 3-D and"
    "films.")
se3d_describe(documentation doc "constrained rigid multibody dynamics (documentation)"
    "The reference of model files, the theory, the C interface, and example models"
    "of libse3d and of the program se3d.")

set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
file(WRITE "${PROJECT_BINARY_DIR}/debian/triggers" "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_CONTROL_EXTRA "${PROJECT_BINARY_DIR}/debian/triggers")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "${se3d_deb_runtime} (= ${PROJECT_VERSION}), libsuitesparse-dev, libyaml-dev, libexpat1-dev, zlib1g-dev")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "gnuplot-nox | gnuplot")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "se3d-doc, chromium, ffmpeg")
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_ARCHITECTURE all)

# What Debian's policy asks for in each package.
if(SE3D_DEBIAN)
    file(READ "${PROJECT_SOURCE_DIR}/LICENSE" se3d_licence)
    file(WRITE "${PROJECT_BINARY_DIR}/debian/copyright" "${se3d_licence}")
    string(TIMESTAMP se3d_date "%a, %d %b %Y %H:%M:%S +0000" UTC)
    foreach(component runtime development program documentation)
        set(package "${se3d_deb_${component}}")
        set(folder "${PROJECT_BINARY_DIR}/debian/${package}")
        file(WRITE "${folder}/changelog" "se3d (${PROJECT_VERSION}) unstable; urgency=medium\n\n"
             "  * See the file CHANGELOG.md of se3d-doc.\n\n -- libse3d maintainers "
             "<maintainers@libse3d.invalid>  ${se3d_date}\n")
        execute_process(COMMAND gzip -9 -n -f "${folder}/changelog" COMMAND_ERROR_IS_FATAL ANY)
        install(FILES "${PROJECT_BINARY_DIR}/debian/copyright" "${folder}/changelog.gz"
                DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/${package}" COMPONENT ${component})
    endforeach()
    # CPack writes these scripts whether a trigger does their work or not.
    file(WRITE "${PROJECT_BINARY_DIR}/debian/overrides/${se3d_deb_runtime}"
         "${se3d_deb_runtime}: maintscript-calls-ldconfig *\n")
    install(FILES "${PROJECT_BINARY_DIR}/debian/overrides/${se3d_deb_runtime}"
            DESTINATION "${CMAKE_INSTALL_DATADIR}/lintian/overrides" COMPONENT runtime)
    # Units run on machines without libyaml.
    file(WRITE "${PROJECT_BINARY_DIR}/debian/overrides/${se3d_deb_program}"
         "${se3d_deb_program}: embedded-library libyaml *se3d_fmu.so*\n")
    install(FILES "${PROJECT_BINARY_DIR}/debian/overrides/${se3d_deb_program}"
            DESTINATION "${CMAKE_INSTALL_DATADIR}/lintian/overrides" COMPONENT program)
endif()

include(CPack)
