# SPDX-License-Identifier: BSD-3-Clause
vcpkg_download_distfile(archive URLS "@URL@" FILENAME "libse3d-@VERSION@.tar.gz" SHA512 @SHA512@)
vcpkg_extract_source_archive(SOURCE_PATH ARCHIVE "${archive}")
vcpkg_cmake_configure(
    SOURCE_PATH "${SOURCE_PATH}"
    OPTIONS -DSE3D_BUILD_TESTS=OFF -DSE3D_BUILD_EXAMPLES=OFF -DSE3D_BUILD_PROGRAM=OFF -DSE3D_FMU=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/se3d)
vcpkg_fixup_pkgconfig()
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include" "${CURRENT_PACKAGES_DIR}/debug/share")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
