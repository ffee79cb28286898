# SPDX-License-Identifier: BSD-3-Clause
# A portfile with stand-ins for the functions of vcpkg, which say what they got:
# cmake -DFOLDER=... -P vcpkg.cmake
set(CURRENT_PACKAGES_DIR "${FOLDER}/packages")
foreach(step vcpkg_cmake_configure vcpkg_cmake_install vcpkg_cmake_config_fixup vcpkg_fixup_pkgconfig
        vcpkg_install_copyright)
    cmake_language(EVAL CODE "macro(${step})\n message(\"${step} \${ARGN}\")\n endmacro()")
endforeach()
macro(vcpkg_download_distfile name)
    message("vcpkg_download_distfile ${ARGN}")
    set(${name} /archive)
endmacro()
macro(vcpkg_extract_source_archive name)
    message("vcpkg_extract_source_archive ${ARGN}")
    set(${name} /source)
endmacro()
include("${FOLDER}/vcpkg/se3d/portfile.cmake")
