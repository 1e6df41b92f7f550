"""Shared parts of the package's tests: a user's project, made from the document and outside/, and its picture."""

import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parent.parent
BUILD = pathlib.Path(os.environ["TERRELLA_BUILD"])
CMAKE = os.environ["CMAKE_COMMAND"]
COMPILER = os.environ["CXX"]

sys.path[:0] = [str(HERE.parent / "window"), str(HERE.parent / "support")]
import pictures  # noqa: E402
import png  # noqa: E402

# The eye of outside/main.cpp looks straight down on the first: it is in the middle of the picture, the other is behind the limb.
QUAKES = """{"type": "FeatureCollection", "features": [
  {"type": "Feature", "geometry": {"type": "Point", "coordinates": [170, -20]}, "properties": {"marker-color": "#ff00ff"}},
  {"type": "Feature", "geometry": {"type": "Point", "coordinates": [-10, 20]}, "properties": {"marker-color": "#00ffff"}}
]}"""

# A yellow square that the eye sees 8° south of the middle, 31 pixels under it.
YELLOW, SQUARE, SQUARE_PX = (255, 220, 0), "168,-30,172,-26", (128, 159)
CAMERA = "-20,170,10000000"


def run(*command, **options):
    done = subprocess.run([*map(str, command)], capture_output=True, text=True, **options)
    if done.returncode != 0:
        raise AssertionError(f"{shlex.join(map(str, command))}: exit {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def write_project(folder, number):
    """The program in outside/ with a CMakeLists.txt that is a block of engine/README.md, to the letter: the first, second …"""
    document = (SOURCE / "engine/README.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```cmake\n(.*?)^```$", document, re.MULTILINE | re.DOTALL)
    shutil.copytree(HERE / "outside", folder, dirs_exist_ok=True)
    (folder / "CMakeLists.txt").write_text(blocks[number])
    return folder


# A project whose own header has the name of one of Terrella's, and that uses GLM as GLM is by default.
STRICT_CMAKE = """
include_directories(BEFORE own)
target_compile_options(application PRIVATE -fno-exceptions -fno-rtti)
"""
OWN_HEADER = """#pragma once
#include <glm/vec3.hpp>
inline glm::vec3 narrow(const glm::dvec3& wide) { return wide; }  // GLM's implicit conversion
#define OWN_COORDINATES 1
"""


def write_strict_project(folder):
    """The document's first project with a geo/coordinates.h of its own, without exceptions and without RTTI."""
    write_project(folder, 0)
    (folder / "own/geo").mkdir(parents=True)
    (folder / "own/geo/coordinates.h").write_text(OWN_HEADER)
    source = (folder / "main.cpp").read_text()
    (folder / "main.cpp").write_text('#include "geo/coordinates.h"\n' + source
                                     + "\nstatic_assert(OWN_COORDINATES == 1);\nglm::vec3 (*used)(const glm::dvec3&) = narrow;\n")
    with open(folder / "CMakeLists.txt", "a") as cmake:
        cmake.write(STRICT_CMAKE)
    return folder


def cut_square(terrella, folder):
    """A tile set of the yellow square."""
    picture, tiles = folder / "square.png", folder / "square.gpkg"
    picture.write_bytes(pictures.png(64, 64, YELLOW))
    run(terrella, "cut", picture, "-o", tiles, f"--bounds={SQUARE}", "--format", "png")
    return tiles


def assert_picture(test, path, square=True):
    """Checks the picture that outside/main.cpp draws of the Earth, the square and the earthquakes."""
    width, height, rows = png.read(path)
    test.assertEqual((width, height), (256, 256))
    pixels = [tuple(row[3 * x : 3 * x + 3]) for row in rows for x in range(width)]
    test.assertEqual(pixels[128 * width + 128], (255, 0, 255), "the earthquake under the eye")
    test.assertEqual(pixels[SQUARE_PX[1] * width + SQUARE_PX[0]] == YELLOW, square, "the second layer")
    test.assertNotIn((0, 255, 255), pixels, "the earthquake on the far side")
    test.assertEqual(pixels[0], (0, 0, 0), "the sky")
    test.assertGreater(len(set(pixels)), 1000, "colours of the Earth")
