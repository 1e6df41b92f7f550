"""Applications that build the library within their own build: FetchContent and add_subdirectory."""

import json
import pathlib
import shutil
import tempfile
import unittest

from projects import BUILD, CMAKE, COMPILER, QUAKES, SOURCE, assert_picture, cut_square, run, write_project

# Kept between runs, so that the library is compiled again only where it has changed.
KEPT = BUILD / "package_tests"
# The other compiler, where there is one, and what is fast to compile; the language's version is the compiler's default.
FAST = [f"-DCMAKE_CXX_COMPILER={shutil.which('clang++') or COMPILER}", "-DCMAKE_CXX_FLAGS=-O0 -Wall -Wextra -Werror",
        "-DCMAKE_UNITY_BUILD=ON", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON"]

SUBDIRECTORY_CMAKE = """cmake_minimum_required(VERSION 3.25)
project(Application LANGUAGES CXX)
add_subdirectory("{source}" terrella)
add_executable(application main.cpp)
target_link_libraries(application PRIVATE Terrella::terrella)
foreach(leak CMAKE_BUILD_TYPE BUILD_TESTING CMAKE_RUNTIME_OUTPUT_DIRECTORY CMAKE_CXX_STANDARD CMAKE_CXX_EXTENSIONS CPACK_PACKAGE_NAME)
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

    def test_fetch_content(self):
        """The document's second project, with this folder in place of the archive that it fetches, draws a picture."""
        folder = write_project(KEPT / "fetch-content", 1)
        configure(folder, f"-DFETCHCONTENT_SOURCE_DIR_TERRELLA={SOURCE}")
        run(CMAKE, "--build", folder / "build", "--parallel", "2")
        quakes, picture = self.scratch / "quakes.geojson", self.scratch / "earth.png"
        quakes.write_text(QUAKES)
        square = cut_square(BUILD / "terrella", self.scratch)
        run(folder / "build/application", BUILD / "data/earth.gpkg", square, quakes, picture)
        assert_picture(self, picture)

    def test_add_subdirectory(self):
        """The libraries come alone, change none of the application's settings, and bring their headers and the language."""
        folder = write_project(self.scratch / "with-subdirectory", 0)
        (folder / "CMakeLists.txt").write_text(SUBDIRECTORY_CMAKE.format(source=SOURCE))
        configure(folder, "-DCMAKE_UNITY_BUILD=OFF")
        run(CMAKE, "--build", folder / "build", "--target", "CMakeFiles/application.dir/main.cpp.o")
        compiled = [command["file"] for command in json.loads((folder / "build/compile_commands.json").read_text())]
        for part in ("apps", "tests"):
            self.assertFalse([name for name in compiled if f"/{part}/" in name], "what only the project itself needs")
        self.assertFalse(list((folder / "build").rglob("CPack*")))
        run(CMAKE, "--install", folder / "build", "--prefix", self.scratch / "prefix")
        self.assertFalse((self.scratch / "prefix").exists(), "nobody asked for Terrella's files to be installed")


if __name__ == "__main__":
    unittest.main()
