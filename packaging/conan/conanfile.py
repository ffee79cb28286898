# SPDX-License-Identifier: BSD-3-Clause
from conan import ConanFile
from conan.tools.cmake import CMake, CMakeToolchain, cmake_layout
from conan.tools.files import get


class Se3d(ConanFile):
    name = "se3d"
    version = "@VERSION@"
    license = "BSD-3-Clause"
    description = "Constrained rigid multibody dynamics in three dimensions, in plain C11"
    topics = ("multibody", "mechanisms", "simulation", "contact", "granular")
    package_type = "library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"shared": [True, False], "fPIC": [True, False], "openmp": [True, False]}
    default_options = {"shared": False, "fPIC": True, "openmp": False}
    implements = ["auto_shared_fpic"]
    languages = "C"

    def requirements(self):
        self.requires("suitesparse-amd/3.3.3")
        self.requires("libyaml/0.2.5")
        self.requires("expat/[>=2.6.2 <3]")
        self.requires("zlib/[>=1.2.11 <2]")

    def build_requirements(self):
        self.tool_requires("cmake/[>=3.25]")

    def layout(self):
        cmake_layout(self)

    def source(self):
        get(self, "@URL@", sha256="@SHA256@", strip_root=True)

    def generate(self):
        chain = CMakeToolchain(self)
        chain.cache_variables["SE3D_BUILD_TESTS"] = False
        chain.cache_variables["SE3D_BUILD_EXAMPLES"] = False
        chain.cache_variables["SE3D_BUNDLE_VIEWER"] = False
        chain.cache_variables["SE3D_LIVE"] = False
        chain.cache_variables["SE3D_FMU"] = False
        chain.cache_variables["SE3D_OPENMP"] = bool(self.options.openmp)
        chain.cache_variables["CMAKE_PREFIX_PATH"] = ";".join(
            one.package_folder for one in self.dependencies.host.values())
        chain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()

    def package_info(self):
        self.cpp_info.set_property("cmake_file_name", "se3d")
        core = self.cpp_info.components["core"]
        core.libs = ["se3d"]
        core.set_property("cmake_target_name", "se3d::se3d")
        core.set_property("pkg_config_name", "se3d")
        core.requires = ["suitesparse-amd::suitesparse-amd"]
        io = self.cpp_info.components["io"]
        io.libs = ["se3d-io"]
        io.set_property("cmake_target_name", "se3d::se3d-io")
        io.set_property("pkg_config_name", "se3d-io")
        io.requires = ["core", "libyaml::libyaml", "expat::expat", "zlib::zlib"]
        if self.settings.os in ("Linux", "FreeBSD"):
            core.system_libs = ["m"]
