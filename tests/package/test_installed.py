"""Installs the build to an empty prefix, moves the prefix, and uses it without access to the source tree."""

import concurrent.futures
import gzip
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest
import xml.dom.minidom

from projects import BUILD, CAMERA, CMAKE, COMPILER, QUAKES, SOURCE, YELLOW, assert_picture, cut_square, run, write_project, write_strict_project

CUTTER_CMAKE = """cmake_minimum_required(VERSION 3.25)
project(Cutter LANGUAGES CXX)
find_package(Terrella REQUIRED COMPONENTS cut streaming)
if(TARGET Terrella::terrella)
  message(FATAL_ERROR "nobody asked for the globe")
endif()
add_executable(cutter main.cpp)
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

# The sources of the document's project as a shared object, whose one function is main() by another name.
PLUG_IN_CMAKE = """
add_library(plug_in MODULE plug_in.cpp)
target_link_options(plug_in PRIVATE -Wl,--no-undefined)
target_link_libraries(plug_in PRIVATE Terrella::terrella)
"""
PLUG_IN = """#define main draw_globe
extern "C" int draw_globe(int, char**);
#include "main.cpp"
"""
DRAW_BY_PLUG_IN = """import ctypes, sys
words = [word.encode() for word in sys.argv[1:]]
sys.exit(ctypes.CDLL(sys.argv[1]).draw_globe(len(words), (ctypes.c_char_p * len(words))(*words)))
"""

# Code of applications: options by name, one of many; conversions that GLM allows by default.
BY_NAME = {
    "terrella/geo/coordinates.h": "inline glm::vec3 narrow(const terrella::Ecef& p) { return p.xyz_m; }",
    "terrella/globe.h": "terrella::GlobeOptions a{.unlit = true}; terrella::GlobePick b{.objects = terrella::LayerId::none};"
                        "terrella::ImageLook c{.opacity = 0.5};",
    "terrella/geo/objects.h": "terrella::PointObject a{.place = {}}; terrella::LineObject b{.places = {}};",
    "terrella/streaming/cut.h": 'terrella::CutOptions a{.output = "o.gpkg"};',
    "terrella/streaming/cache/tile_cache.h": "terrella::CacheOptions a{};",
}


def hiding_source():
    """Words that run a command with an empty folder over the source tree; empty if the machine forbids that."""
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
        cls.square = cut_square(cls.prefix / "bin/terrella", cls.scratch)

    def run_outside(self, *command, **options):
        return run(*self.hiding, *command, cwd=options.pop("cwd", "/"), **options)

    def configure(self, folder, *options):
        return self.run_outside(CMAKE, "-S", folder, "-B", folder / "build", "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={self.prefix}",
                                *options)

    def build(self, name, *options):
        """The folder of the document's first project, built with -Wall -Wextra -Werror and else with the compiler's defaults."""
        folder = write_project(self.scratch / name, 0)
        self.configure(folder, "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON", *options)
        self.run_outside(CMAKE, "--build", folder / "build")
        return folder

    def draw(self, folder, *program, **options):
        """Draws the document's data by a program, and checks the picture."""
        data = [self.prefix / "share/terrella/earth.gpkg", self.square, self.quakes]
        self.run_outside(*program, *data, folder / "earth.png", **options)
        assert_picture(self, folder / "earth.png")

    def test_find_package(self):
        """A project outside the tree, the document's own, draws a picture of two layers and objects."""
        folder = self.build("with-cmake")
        commands = (folder / "build/compile_commands.json").read_text()
        self.assertNotIn(str(SOURCE), commands)
        self.assertNotIn("-D", commands, "settings of Terrella's in the application")
        self.draw(folder, folder / "build/application")

    @unittest.skipUnless(shutil.which("clang++"), "needs clang++")
    def test_find_package_with_another_compiler(self):
        folder = self.build("with-clang", "-DCMAKE_CXX_COMPILER=clang++")
        self.draw(folder, folder / "build/application")

    def test_strict_project(self):
        """A geo/coordinates.h of the application's own, GLM's defaults, no exceptions, no RTTI."""
        folder = write_strict_project(self.scratch / "strict")
        self.configure(folder, "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror")
        self.run_outside(CMAKE, "--build", folder / "build")
        self.draw(folder, folder / "build/application")

    def test_plug_in(self):
        """The archives fit into a shared object; a process that knows nothing of C++ opens it and draws."""
        folder = write_project(self.scratch / "plug-in", 0)
        with open(folder / "CMakeLists.txt", "a") as cmake:
            cmake.write(PLUG_IN_CMAKE)
        (folder / "plug_in.cpp").write_text(PLUG_IN)
        self.configure(folder, "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror")
        self.run_outside(CMAKE, "--build", folder / "build", "--target", "plug_in")
        plug_in = folder / "build/libplug_in.so"
        self.draw(folder, sys.executable, "-c", DRAW_BY_PLUG_IN, plug_in)
        symbols = run("nm", "--dynamic", "--demangle", "--defined-only", plug_in)
        self.assertIn("draw_globe", symbols)
        self.assertNotIn("terrella::Globe::", symbols, "the library's symbols are its own affair")

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
        folder = write_project(self.scratch / "with-pkg-config", 0)
        environment = {**os.environ, "PKG_CONFIG_PATH": str(next(self.prefix.rglob("terrella.pc")).parent)}
        flags = shlex.split(self.run_outside("pkg-config", "--cflags", "--libs", "terrella", env=environment))
        self.assertFalse([flag for flag in flags if str(SOURCE) in flag], flags)
        self.run_outside(COMPILER, "-std=c++20", "-Wall", "-Wextra", "-Werror", "main.cpp", "-o", "application", *flags, cwd=folder)
        self.draw(folder, folder / "application")

    def test_every_header_by_itself(self):
        """Each public header brings the headers that it needs, and options are given by name without a warning."""
        environment = {**os.environ, "PKG_CONFIG_PATH": str(next(self.prefix.rglob("terrella.pc")).parent)}
        flags = shlex.split(run("pkg-config", "--cflags", "terrella", env=environment))
        named = re.search(r"TERRELLA_PUBLIC_HEADERS\n(.*?)\)", (SOURCE / "engine/package/public_headers.cmake").read_text(), re.DOTALL)
        names = {"terrella/" + re.sub("^(engine/)?(globe/(?=globe.h$))?", "", header) for header in named[1].split()} | set(BY_NAME)
        self.assertGreater(len(names), 15)

        def check(name):
            self.run_outside(COMPILER, "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Werror", "-x", "c++", *flags, "-",
                             input=f"#include <{name}>\n{BY_NAME.get(name, '')}\n")

        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            list(pool.map(check, sorted(names)))

    def test_documents_that_headers_name(self):
        named = {name for header in (self.prefix / "include/terrella").rglob("*.h")
                 for name in re.findall(r"[\w/]+\.md\b", header.read_text())}
        self.assertGreater(len(named), 3)
        for name in named | {"engine/README.md"}:
            self.assertTrue((self.prefix / "share/doc/terrella" / name).exists(), name)

    def test_no_path_of_the_build(self):
        """No binary that is installed names the folders that it was built in or from."""
        binaries = [p for p in self.prefix.rglob("*") if p.suffix in (".a", ".so") or p.parent.name == "bin"]
        self.assertGreater(len(binaries), 10)
        for path in binaries:
            content = path.read_bytes()
            for folder in (SOURCE, BUILD):
                self.assertNotIn(str(folder).encode() + b"/", content, path)

    def test_uninstall(self):
        """Uninstalling removes the files of the installation, and files beside them stay."""
        prefix = self.scratch / "gone"
        (prefix / "share/terrella").mkdir(parents=True)
        (prefix / "share/terrella/own.txt").touch()
        manifest = self.scratch / "manifest.txt"
        written = run(CMAKE, "--install", BUILD, "--prefix", prefix)
        files = [name for name in re.findall(r"^-- Installing: (.*)$", written, re.MULTILINE) if pathlib.Path(name).is_file()]
        manifest.write_text("\n".join(files))
        run(CMAKE, f"-DMANIFEST={manifest}", "-P", SOURCE / "engine/package/uninstall.cmake")
        self.assertEqual([str(p.relative_to(prefix)) for p in prefix.rglob("*") if not p.is_dir()], ["share/terrella/own.txt"])
        self.assertFalse((prefix / "include/terrella").exists())

    def test_no_path_of_the_source(self):
        """Installed texts name nothing of the machine that built them."""
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
        """The program runs from where its package is unpacked, and finds the Earth; each package says what it needs."""
        run("cpack", "-G", "DEB", "-B", self.scratch / "deb", cwd=BUILD)
        names = ["terrella", "libterrella-dev"] + ["python3-terrella"] * (BUILD / "python").exists()
        packages = {name: next((self.scratch / "deb").glob(f"{name}_*.deb")) for name in names}
        program, development = packages["terrella"], packages["libterrella-dev"]
        self.assertRegex(run("dpkg-deb", "--field", program, "Depends"), r"libegl1.*libcurl4.*libsqlite3-0")
        self.assertRegex(run("dpkg-deb", "--field", development, "Depends"), r"libglm-dev")
        self.assertEqual(run("dpkg-deb", "--field", program, "Maintainer"), "Terrella developers <terrella@localhost>\n")
        held = {name: run("dpkg-deb", "--contents", package) for name, package in packages.items()}
        self.assertIn("usr/include/terrella/globe.h", held["libterrella-dev"])
        self.assertRegex(held["libterrella-dev"], r"usr/lib/[a-z0-9_]+-linux-gnu/libterrella_globe\.a")
        for name in names:
            self.assertIn(f"usr/share/doc/{name}/copyright", held[name])
            self.assertIn(f"usr/share/doc/{name}/changelog.gz", held[name])
        for file in ("applications/terrella.desktop", "icons/hicolor/scalable/apps/terrella.svg", "mime/packages/terrella.xml",
                     "man/man1/terrella.1.gz"):
            self.assertIn(f"usr/share/{file}", held["terrella"])
        for package in packages.values():
            run("dpkg-deb", "--extract", package, self.scratch / "root")
        picture = self.scratch / "earth.png"
        environment = {**os.environ, "XDG_CACHE_HOME": str(self.scratch / "cache")}
        self.run_outside(self.scratch / "root/usr/bin/terrella", "render", "--unlit", "--size", "256x256", f"--camera={CAMERA}",
                         "--objects", self.quakes, "-o", picture, env=environment)
        assert_picture(self, picture, square=False)
        if "python3-terrella" in names:
            environment["PYTHONPATH"] = str(self.scratch / "root/usr/lib/python3/dist-packages")
            says = self.run_outside("/usr/bin/python3", "-c", "import terrella; print(terrella.render(size=(64, 64)).shape)",
                                    env=environment)
            self.assertEqual(says, "(64, 64, 3)\n")
        self.check_desktop(self.scratch / "root/usr/share")

    def check_desktop(self, share):
        """Menu entry, MIME types and manual page are accepted by the tools that read them."""
        run("desktop-file-validate", share / "applications/terrella.desktop")
        for path in (share / "mime/packages/terrella.xml", share / "icons/hicolor/scalable/apps/terrella.svg"):
            xml.dom.minidom.parse(str(path))
        manual = gzip.decompress((share / "man/man1/terrella.1.gz").read_bytes()).decode()
        for section in (".SH NAME", ".SH SYNOPSIS", "EXIT STATUS", "render"):
            self.assertIn(section, manual)


if __name__ == "__main__":
    unittest.main()
