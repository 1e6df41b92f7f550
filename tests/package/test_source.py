"""Applications that build the library within their own build: FetchContent and add_subdirectory. The shared library."""

import json
import os
import pathlib
import shlex
import shutil
import tempfile
import unittest

from projects import BUILD, CMAKE, COMPILER, QUAKES, SOURCE, assert_picture, cut_square, run, write_project, write_strict_project

# Kept between runs, so that the library is compiled again only where it has changed.
KEPT = BUILD / "package_tests"
# The other compiler, where there is one, and what is fast to compile; the language's version is the compiler's default.
FAST = [f"-DCMAKE_CXX_COMPILER={shutil.which('clang++') or COMPILER}", "-DCMAKE_CXX_FLAGS=-O0 -Wall -Wextra -Werror",
        "-DCMAKE_UNITY_BUILD=OFF", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON"]

SUBDIRECTORY_CMAKE = """cmake_minimum_required(VERSION 3.25)
project(Application LANGUAGES CXX)
add_subdirectory("{source}" terrella)
add_executable(application main.cpp)
target_link_libraries(application PRIVATE Terrella::terrella)
foreach(leak CMAKE_BUILD_TYPE BUILD_TESTING CMAKE_RUNTIME_OUTPUT_DIRECTORY CMAKE_CXX_STANDARD CMAKE_CXX_EXTENSIONS CPACK_PACKAGE_NAME BUILD_SHARED_LIBS)
  if(DEFINED ${{leak}} AND NOT "${{${{leak}}}}" STREQUAL "")
    message(FATAL_ERROR "Terrella has set ${{leak}} to '${{${{leak}}}}'")
  endif()
endforeach()
"""


def configure(folder, *options):
    run(CMAKE, "-S", folder, "-B", folder / "build", "-G", "Ninja", *FAST, *options)


class SourceTest(unittest.TestCase):
    def setUp(self):
        self.scratch = pathlib.Path(tempfile.mkdtemp(prefix="terrella-source-"))
        self.addCleanup(shutil.rmtree, self.scratch)

    def write_data(self):
        """The files that outside/main.cpp draws."""
        quakes = self.scratch / "quakes.geojson"
        quakes.write_text(QUAKES)
        self.data = [BUILD / "data/earth.gpkg", cut_square(BUILD / "terrella", self.scratch), quakes]

    def test_fetch_content_and_shared_library(self):
        """The document's second project, with this folder in place of the archive that it fetches, draws a picture. It
        asks for the shared library, so that one build serves the applications that find that library installed."""
        folder = write_project(KEPT / "fetch-content", 1)
        configure(folder, f"-DFETCHCONTENT_SOURCE_DIR_TERRELLA={SOURCE}", "-DBUILD_SHARED_LIBS=ON", "-DTERRELLA_INSTALL=ON")
        run(CMAKE, "--build", folder / "build", "--parallel", "2")
        picture = self.scratch / "earth.png"
        self.write_data()
        run(folder / "build/application", *self.data, picture)
        assert_picture(self, picture)
        prefix = self.scratch / "prefix"
        run(CMAKE, "--install", folder / "build", "--prefix", prefix)
        self.check_symbols(next(prefix.rglob("libterrella.so")))
        self.use_by_find_package(prefix)
        self.use_by_pkg_config(prefix)

    def check_symbols(self, library):
        """Public headers declare what the library shows; nothing else is to be seen."""
        self.assertRegex(run("readelf", "--dynamic", library), r"SONAME.*\[libterrella\.so\.0\.1\]")
        symbols = run("nm", "--dynamic", "--demangle", "--defined-only", library)
        for public in ("terrella::Globe::render(", "terrella::cut(", "terrella::open_tile_set(", "terrella::TileCache::"):
            self.assertIn(public, symbols)
        for hidden in ("terrella::GlobeRenderer::", "terrella::PatchTree", "terrella::plan_frame", "sqlite3_"):
            self.assertNotIn(hidden, symbols)

    def use_by_find_package(self, prefix):
        folder = write_strict_project(self.scratch / "strict")
        run(CMAKE, "-S", folder, "-B", folder / "build", "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={prefix}",
            f"-DCMAKE_CXX_COMPILER={COMPILER}", "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror")
        run(CMAKE, "--build", folder / "build")
        run(folder / "build/application", *self.data, folder / "earth.png")
        assert_picture(self, folder / "earth.png")

    def use_by_pkg_config(self, prefix):
        folder = write_project(self.scratch / "with-pkg-config", 0)
        environment = {**os.environ, "PKG_CONFIG_PATH": str(next(prefix.rglob("terrella.pc")).parent)}
        flags = shlex.split(run("pkg-config", "--cflags", "--libs", "terrella", env=environment))
        self.assertIn("-lterrella", flags)
        run(COMPILER, "-std=c++20", "-Wall", "-Wextra", "-Werror", "main.cpp", "-o", "application", *flags, cwd=folder)
        libraries = {**os.environ, "LD_LIBRARY_PATH": str(next(prefix.rglob("libterrella.so")).parent)}
        run(folder / "application", *self.data, folder / "earth.png", env=libraries)
        assert_picture(self, folder / "earth.png")

    def test_add_subdirectory(self):
        """The libraries come alone, change none of the application's settings, and bring their headers and the language."""
        folder = write_project(self.scratch / "with-subdirectory", 0)
        (folder / "CMakeLists.txt").write_text(SUBDIRECTORY_CMAKE.format(source=SOURCE))
        configure(folder)
        run(CMAKE, "--build", folder / "build", "--target", "CMakeFiles/application.dir/main.cpp.o")
        compiled = [command["file"] for command in json.loads((folder / "build/compile_commands.json").read_text())]
        for part in ("apps", "tests"):
            self.assertFalse([name for name in compiled if f"/{part}/" in name], "what only the project itself needs")
        self.assertFalse(list((folder / "build").rglob("CPack*")))
        run(CMAKE, "--install", folder / "build", "--prefix", self.scratch / "prefix")
        self.assertFalse((self.scratch / "prefix").exists(), "nobody asked for Terrella's files to be installed")


if __name__ == "__main__":
    unittest.main()
