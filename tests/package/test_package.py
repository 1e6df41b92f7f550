"""Installs the build to an empty prefix, moves it, and uses it where the source tree cannot be reached."""

import concurrent.futures
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parent.parent
BUILD = pathlib.Path(os.environ["TERRELLA_BUILD"])
CMAKE = os.environ["CMAKE_COMMAND"]
COMPILER = os.environ["CXX"]

sys.path[:0] = [str(HERE.parent / "window"), str(HERE.parent / "cli")]
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

CUTTER_CMAKE = """cmake_minimum_required(VERSION 3.25)
project(Cutter LANGUAGES CXX)
find_package(Terrella REQUIRED COMPONENTS cut streaming)
if(TARGET Terrella::terrella)
  message(FATAL_ERROR "nobody asked for the globe")
endif()
add_executable(cutter main.cpp)
target_compile_features(cutter PRIVATE cxx_std_20)
target_link_libraries(cutter PRIVATE Terrella::cut)
"""
CUTTER = """#include <terrella/streaming/cut.h>
#include <cstdio>
int main() {
  terrella::CutOptions options;
  options.images = {"nowhere.tif"};
  options.output = "out.gpkg";
  const auto done = terrella::cut(options);
  if (done) return 1;
  std::puts(done.error().message.c_str());
}
"""


# Options by name, one of many.
BY_NAME = {
    "terrella/globe.h": "terrella::GlobeOptions a{.unlit = true}; terrella::GlobePick b{.objects = terrella::LayerId::none};"
                        "terrella::ImageLook c{.opacity = 0.5};",
    "terrella/geo/objects.h": "terrella::PointObject a{.place = {}}; terrella::LineObject b{.places = {}};",
    "terrella/streaming/cut.h": 'terrella::CutOptions a{.output = "o.gpkg"};',
    "terrella/streaming/cache/tile_cache.h": "terrella::CacheOptions a{};",
}


def run(*command, **options):
    done = subprocess.run([*map(str, command)], capture_output=True, text=True, **options)
    if done.returncode != 0:
        raise AssertionError(f"{shlex.join(map(str, command))}: exit {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def hiding_source():
    """What runs a command where an empty folder lies over the source tree; nothing where the machine forbids that."""
    hide = ["unshare", "--user", "--map-root-user", "--mount", "sh", "-c",
            f'mount -t tmpfs none {shlex.quote(str(SOURCE))} && exec "$@"', "sh"]
    try:
        return hide if subprocess.run([*hide, "true"], capture_output=True).returncode == 0 else []
    except FileNotFoundError:
        return []


class PackageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = pathlib.Path(tempfile.mkdtemp(prefix="terrella-package-"))
        cls.addClassCleanup(shutil.rmtree, cls.scratch)
        run(CMAKE, "--install", BUILD, "--strip", "--prefix", cls.scratch / "first")
        cls.prefix = cls.scratch / "moved/to here"
        cls.prefix.parent.mkdir()
        (cls.scratch / "first").rename(cls.prefix)
        cls.quakes = cls.scratch / "quakes.geojson"
        cls.quakes.write_text(QUAKES)
        cls.hiding = hiding_source()
        picture = cls.scratch / "square.png"
        picture.write_bytes(pictures.png(64, 64, YELLOW))
        cls.square = cls.scratch / "square.gpkg"
        run(cls.prefix / "bin/terrella", "cut", picture, "-o", cls.square, f"--bounds={SQUARE}", "--format", "png")

    def run_outside(self, *command, **options):
        return run(*self.hiding, *command, cwd=options.pop("cwd", "/"), **options)

    def copy_project(self, name):
        folder = self.scratch / name
        shutil.copytree(HERE / "outside", folder)
        return folder

    def configure(self, folder, *options):
        return self.run_outside(CMAKE, "-S", folder, "-B", folder / "build", "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={self.prefix}",
                                *options)

    def assert_picture(self, path, square):
        width, height, rows = png.read(path)
        self.assertEqual((width, height), (256, 256))
        pixels = [tuple(row[3 * x : 3 * x + 3]) for row in rows for x in range(width)]
        self.assertEqual(pixels[128 * width + 128], (255, 0, 255), "the earthquake under the eye")
        self.assertEqual(pixels[SQUARE_PX[1] * width + SQUARE_PX[0]] == YELLOW, square, "the second layer")
        self.assertNotIn((0, 255, 255), pixels, "the earthquake on the far side")
        self.assertEqual(pixels[0], (0, 0, 0), "the sky")
        self.assertGreater(len(set(pixels)), 1000, "colours of the Earth")

    def test_find_package(self):
        """A project outside the tree draws a picture of two layers and objects."""
        folder = self.copy_project("with-cmake")
        self.configure(folder, "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON")
        self.run_outside(CMAKE, "--build", folder / "build")
        self.assertNotIn(str(SOURCE), (folder / "build/compile_commands.json").read_text())
        picture = folder / "earth.png"
        self.run_outside(folder / "build/outside", self.prefix / "share/terrella/earth.gpkg", self.square, self.quakes, picture)
        self.assert_picture(picture, square=True)

    def test_components(self):
        """The cutter without the globe: nothing of OpenGL is looked for."""
        folder = self.scratch / "cutter"
        folder.mkdir()
        (folder / "CMakeLists.txt").write_text(CUTTER_CMAKE)
        (folder / "main.cpp").write_text(CUTTER)
        self.configure(folder, "-DCMAKE_DISABLE_FIND_PACKAGE_Freetype=ON")
        self.run_outside(CMAKE, "--build", folder / "build")
        self.assertIn("nowhere.tif", self.run_outside(folder / "build/cutter"))

    def test_pkg_config(self):
        """The same sources by the flags of pkg-config."""
        folder = self.copy_project("with-pkg-config")
        environment = {**os.environ, "PKG_CONFIG_PATH": str(next(self.prefix.rglob("terrella.pc")).parent)}
        flags = shlex.split(self.run_outside("pkg-config", "--cflags", "--libs", "terrella", env=environment))
        self.assertFalse([flag for flag in flags if str(SOURCE) in flag], flags)
        self.run_outside(COMPILER, "-std=c++20", "main.cpp", "-o", "outside", *flags, cwd=folder)

    def test_every_header_by_itself(self):
        """What an application includes brings what it needs, and options are given by name without a warning."""
        environment = {**os.environ, "PKG_CONFIG_PATH": str(next(self.prefix.rglob("terrella.pc")).parent)}
        flags = shlex.split(run("pkg-config", "--cflags", "terrella", env=environment))
        named = re.search(r"TERRELLA_PUBLIC_HEADERS\n(.*?)\)", (SOURCE / "engine/package/public_headers.cmake").read_text(), re.DOTALL)
        names = {re.sub("^(engine/)?", "terrella/", header) for header in named[1].split()} | set(BY_NAME)
        self.assertGreater(len(names), 15)

        def check(name):
            self.run_outside(COMPILER, "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Werror", "-x", "c++", *flags, "-",
                             input=f"#include <{name}>\n{BY_NAME.get(name, '')}\n")

        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            list(pool.map(check, sorted(names)))

    def test_no_path_of_the_source(self):
        """What is installed as text names nothing of the machine that it was built on."""
        texts = [p for p in self.prefix.rglob("*") if p.suffix in (".cmake", ".pc", ".h")]
        self.assertGreater(len(texts), 10)
        for path in texts:
            self.assertNotIn(str(SOURCE), path.read_text(), path)

    def test_what_is_not_there(self):
        """A component or a version that is not there is named."""
        for wish, says in (("0.1 REQUIRED COMPONENTS moon", "moon"), ("7.0 REQUIRED", "0.1.0")):
            folder = self.scratch / f"asks for {says}"
            folder.mkdir()
            (folder / "CMakeLists.txt").write_text(
                f"cmake_minimum_required(VERSION 3.25)\nproject(Asks LANGUAGES C)\nfind_package(Terrella {wish})\n")
            with self.assertRaises(AssertionError) as refused:
                self.configure(folder)
            self.assertIn(says, str(refused.exception))

    def test_debian_packages(self):
        """The program runs from where its package is unpacked, and finds the Earth; both packages say what they need."""
        run("cpack", "-G", "DEB", "-B", self.scratch / "deb", cwd=BUILD)
        program, development = (next((self.scratch / "deb").glob(f"{name}_*.deb")) for name in ("terrella", "libterrella-dev"))
        self.assertRegex(run("dpkg-deb", "--field", program, "Depends"), r"libegl1.*libcurl4.*libsqlite3-0")
        self.assertRegex(run("dpkg-deb", "--field", development, "Depends"), r"libglm-dev")
        self.assertEqual(run("dpkg-deb", "--field", program, "Maintainer"), "Terrella developers\n")
        self.assertIn("usr/include/terrella/globe.h", run("dpkg-deb", "--contents", development))
        run("dpkg-deb", "--extract", program, self.scratch / "root")
        picture = self.scratch / "earth.png"
        self.run_outside(self.scratch / "root/usr/bin/terrella", "render", "--unlit", "--size", "256x256", f"--camera={CAMERA}",
                         "--objects", self.quakes, "-o", picture, env={**os.environ, "XDG_CACHE_HOME": str(self.scratch / "cache")})
        self.assert_picture(picture, square=False)


if __name__ == "__main__":
    unittest.main()
