"""conan create engine/package: the libraries of this source tree as a Conan 2 package."""

import os

from conan import ConanFile
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy
from conan.tools.gnu import PkgConfigDeps
from conan.tools.system.package_manager import Apt


class Terrella(ConanFile):
    name = "terrella"
    version = "0.1.0"
    description = "Tile-streaming planetary globe engine"
    license = "Apache-2.0"
    settings = "os", "compiler", "build_type", "arch"
    options = {"shared": [True, False], "fPIC": [True, False]}
    default_options = {"shared": False, "fPIC": True}
    requires = (
        "fmt/10.2.1", "fontconfig/2.15.0", "freetype/2.13.2", "fribidi/1.0.13", "gdal/3.8.3", "geographiclib/2.3",
        "glm/0.9.9.8", "harfbuzz/8.3.0", "libcurl/8.6.0", "libepoxy/1.5.10", "libexif/0.6.24", "libjpeg-turbo/3.0.2",
        "libpng/1.6.43", "libtiff/4.6.0", "libwebp/1.3.2", "nlohmann_json/3.11.3", "proj/9.3.1", "pugixml/1.14",
        "sqlite3/3.45.2", "tinygltf/2.8.19", "zlib/1.3.1")

    def system_requirements(self):
        # Conan's own collection has neither.
        Apt(self).install(["liberfa-dev", "libglu1-mesa-dev"])

    def export_sources(self):
        root = os.path.join(self.recipe_folder, "..", "..")
        for pattern in ("CMakeLists.txt", "LICENSE", "engine/*", "streaming/*", "shaders/*"):
            copy(self, pattern, root, self.export_sources_folder)

    def layout(self):
        cmake_layout(self)

    def generate(self):
        toolchain = CMakeToolchain(self)
        toolchain.variables.update(
            TERRELLA_APPS=False, TERRELLA_INSTALL=True, BUILD_TESTING=False, BUILD_SHARED_LIBS=bool(self.options.shared))
        toolchain.generate()
        CMakeDeps(self).generate()
        PkgConfigDeps(self).generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()
        copy(self, "LICENSE", self.source_folder, os.path.join(self.package_folder, "licenses"))

    def package_info(self):
        # The package's own TerrellaConfig.cmake is used.
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.builddirs = [os.path.join("lib", "cmake", "Terrella")]
