"""Conan 2 recipe of the tree that it stands in: conan create cmake/packages/conanfile.py"""
import os
import re

from conan import ConanFile
from conan.tools.cmake import CMake, CMakeToolchain
from conan.tools.files import copy, load


class Polybody(ConanFile):
    name = "polybody"
    description = "Flexible multibody dynamics: one model, every formulation (C++20, header-only)"
    license = "BSD-3-Clause"
    topics = ("multibody-dynamics", "finite-elements", "header-only")
    package_type = "header-library"
    settings = "os", "arch", "compiler", "build_type"
    no_copy_source = True

    @property
    def _tree(self):
        return os.path.abspath(os.path.join(self.recipe_folder, "..", ".."))

    def set_version(self):
        text = load(self, os.path.join(self._tree, "include", "polybody", "version.hpp"))
        self.version = re.search(r'library_version = "([^"]+)"', text).group(1)

    def export_sources(self):
        for pattern in ("include/*", "cmake/*", "CMakeLists.txt", "LICENSE"):
            copy(self, pattern, self._tree, self.export_sources_folder)

    def requirements(self):
        self.requires("eigen/3.4.0", transitive_headers=True)

    def package_id(self):
        self.info.clear()

    def generate(self):
        tools = CMakeToolchain(self)
        for what in ("TESTS", "EXAMPLES", "BENCH"):
            tools.variables[f"POLYBODY_BUILD_{what}"] = False
        tools.variables["POLYBODY_INSTALL"] = True
        tools.generate()

    def build(self):
        pass

    def package(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.install()
        copy(self, "LICENSE", self.source_folder, os.path.join(self.package_folder, "licenses"))

    def package_info(self):
        self.cpp_info.bindirs = []
        self.cpp_info.libdirs = []
        self.cpp_info.set_property("cmake_find_mode", "none")  # its own polybodyConfig.cmake
        self.cpp_info.builddirs = [os.path.join("share", "cmake", "polybody")]
