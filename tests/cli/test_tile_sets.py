"""Broken and hostile tile sets: a message that names the set; never a crash, a hang or a huge allocation."""

import shutil
import sqlite3
import unittest
import zlib

import geopackages
import georeferenced
from pictures import heights_png, png, png_of
from program import DONE_IN_PART, FAILED, NATURAL_EARTH, ProgramTest

# The least that a render of a broken tile set may leave: said and exit 3, or refused and exit 1.
RENDER = ("-o", "shot.png", "--size", "64x64")


class GeoPackages(ProgramTest):
    def assert_refused(self, path):
        self.assert_fails(FAILED, "render", path, *RENDER, says=[str(path)])
        self.assert_fails(FAILED, "info", path, says=[str(path)])
        self.assertFalse((self.folder / "shot.png").exists())

    def test_a_good_one_is_drawn(self):
        geopackages.write_good(self.folder / "good.gpkg")
        self.assert_done("render", "good.gpkg", *RENDER)
        self.assert_done("info", "good.gpkg")

    def test_zero_bytes(self):
        self.assert_refused(self.write("zero.gpkg", b""))

    def test_not_a_database(self):
        self.assert_refused(self.write("text.gpkg", b"SQLite format 4\0" + b"x" * 8192))

    def test_cut_off(self):
        geopackages.write_good(self.folder / "whole.gpkg")
        self.assert_refused(self.write("half.gpkg", (self.folder / "whole.gpkg").read_bytes()[:5000]))

    def test_a_database_of_something_else(self):
        with sqlite3.connect(self.folder / "other.gpkg") as base:
            base.execute("CREATE TABLE recipes (name TEXT)")
        base.close()
        self.assert_refused(self.folder / "other.gpkg")

    def test_spoilt(self):
        for number, name in enumerate(geopackages.SPOILT):
            with self.subTest(name):
                path = self.folder / f"spoilt{number}.gpkg"
                geopackages.write_spoilt(path, name)
                self.assert_refused(path)

    def test_bounds_that_are_no_numbers(self):
        geopackages.nan_box(self.folder / "nan.gpkg")
        self.assert_refused(self.folder / "nan.gpkg")

    def test_tables_without_end_are_given_up(self):
        for name in geopackages.ENDLESS:
            with self.subTest(name):
                path = self.folder / f"{name}.gpkg"
                geopackages.write_endless(path, name)
                done = self.run_program("render", path, *RENDER)
                self.assertIn(done.returncode, (FAILED, DONE_IN_PART), done.stdout + done.stderr)
                self.run_program("info", path)

    def test_tiles_that_are_no_pictures_are_lacked(self):
        bombs = {"junk": b"not a picture", "empty": b"", "bomb": png_of(60000, 60000, zlib.compress(bytes(10**6)))}
        for name, blob in bombs.items():
            with self.subTest(name):
                path = self.folder / f"{name}.gpkg"
                geopackages.write_good(path, blob)
                done = self.run_program("render", path, *RENDER)
                self.assertEqual(done.returncode, FAILED, done.stdout + done.stderr)
                self.assertIn("none of the", done.stderr)


class ProjectedGeoPackages(ProgramTest):
    """GDAL's GeoPackages in metres are drawn as the pictures are that they were made of."""

    # Mean difference of a byte of the PNG's pixels, levels: GDAL's and our resampling of the same smooth picture.
    SAME_PICTURE = 1.0
    MOON_POLE = ("-a_srs", "+proj=stere +lat_0=90 +R=1737400 +no_defs", "-a_ullr", -400000, -100000, -50000, -350000)
    UTM = ("-a_srs", "EPSG:32633", "-a_ullr", 399900, 5500040, 441900, 5470040)

    SIZE = 700, 500

    def make(self, name, place, *options):
        picture = georeferenced.make(self.folder / f"{name}.tif", *self.SIZE, *place)
        georeferenced.gdal("gdal_translate", "-q", "-of", "GPKG", "-co", "TILE_FORMAT=PNG", *options, picture,
                           self.folder / f"{name}.gpkg")
        georeferenced.gdal("gdaladdo", "-q", "-r", "average", self.folder / f"{name}.gpkg", 2, 4)

    def shot(self, name, camera, *options):
        self.assert_done("render", name, "-o", "shot.png", "--size", "256x256", "--unlit", "--sky", "off", "--camera",
                         camera, *options)
        georeferenced.gdal("gdal_translate", "-q", "-of", "ENVI", self.folder / "shot.png", self.folder / "shot.raw")
        return (self.folder / "shot.raw").read_bytes()

    def assert_same_pictures(self, one, other):
        self.assertEqual(len(one), len(other))
        self.assertGreater(len(set(one)), 50, "nothing is shown")
        self.assertLess(sum(abs(a - b) for a, b in zip(one, other)) / len(one), self.SAME_PICTURE)

    def test_utm_is_drawn_and_preloaded(self):
        self.make("utm", self.UTM)
        camera = "49.5,13.9,40000"
        shot = self.shot("utm.gpkg", camera)
        self.assert_same_pictures(shot, self.shot("utm.tif", camera))
        self.assertIn("tiles in EPSG:32633", self.assert_done("info", "utm.gpkg", "--verify").stdout)
        self.assert_done("preload", "utm.gpkg", "-o", "copy.gpkg")
        self.assertEqual(self.shot("copy.gpkg", camera), shot)

    def test_the_pole_of_the_moon_and_the_black_beside(self):
        self.make("moon", self.MOON_POLE)
        camera = "79,-60,400000"  # beyond a corner: tiles of the bounds lie beside the picture
        self.assert_same_pictures(self.shot("moon.gpkg", camera), self.shot("moon.tif", camera, "--body", "moon"))
        self.assertIn("body         moon", self.assert_done("info", "moon.gpkg").stdout)

    def test_heights_in_metres(self):
        self.SIZE = 700, 350
        half = 20037508.342789244
        self.make("heights", ("-a_srs", "EPSG:4087", "-a_ullr", -half, half / 2, half, -half / 2), "-ot", "Int16")
        self.assert_done("render", "--elevation", "heights.gpkg", *RENDER)
        self.SIZE = 700, 500
        self.make("part", self.UTM, "-ot", "Int16")
        self.assert_done("render", "--elevation", "part.gpkg", *RENDER)


class Bodies(ProgramTest):
    def test_tiles_of_another_body_are_refused_by_both_names(self):
        self.write("in.png", png(128, 64))
        self.assert_done("cut", "in.png", "--body", "moon", "-o", "moon.gpkg")
        render = ("render", "--size", "32x32", "-o", "out.png")
        self.assert_done(*render, "moon.gpkg")
        self.assert_done(*render, "moon.gpkg", "--body", "1737000,0")  # under 1 % is the same body
        self.assert_fails(FAILED, *render, "moon.gpkg", "--body", "mars", says=["moon.gpkg", "moon (", "mars (", "--body"])
        self.assert_fails(FAILED, *render, "--body", "mars", says=["the included Earth: ", "mars (", "name a tile set"])
        self.assert_fails(FAILED, *render, "--overlay", "moon.gpkg", says=["moon.gpkg", "moon (", "earth ("])


class Folders(ProgramTest):
    def test_the_fixture_is_drawn(self):
        self.assert_done("render", NATURAL_EARTH, *RENDER)

    def test_without_tiles(self):
        (self.folder / "empty").mkdir()
        self.assert_fails(FAILED, "render", "empty", *RENDER, says=["empty", "tileset.json"])
        self.assert_fails(FAILED, "info", "empty", says=["empty", "tileset.json"])

    def test_description_without_tiles(self):
        (self.folder / "hollow").mkdir()
        shutil.copy(NATURAL_EARTH / "tilemapresource.xml", self.folder / "hollow")
        done = self.run_program("render", "hollow", *RENDER)
        self.assertIn(done.returncode, (FAILED, DONE_IN_PART), done.stderr)

    def test_descriptions_that_are_nonsense(self):
        texts = {
            "tileset.json": [b"", b"{", b"[]", b"{\"tiles\": 7}", b"[" * 100000, b"\xff\xfe\0"],
            "tilemapresource.xml": [b"", b"<TileMap>", b"<a/>", b"<TileMap><TileFormat width='-1'/></TileMap>"],
        }
        for file, contents in texts.items():
            for number, content in enumerate(contents):
                with self.subTest(file, content=content[:20]):
                    folder = self.folder / f"{file}{number}"
                    folder.mkdir()
                    (folder / file).write_bytes(content)
                    self.assert_fails(FAILED, "render", folder, *RENDER, says=[str(folder)])

    def test_some_other_file(self):
        self.write("notes.txt", b"to do: nothing\n")
        self.assert_fails(FAILED, "render", "notes.txt", *RENDER, says=["notes.txt"])


if __name__ == "__main__":
    unittest.main()


class Heights(ProgramTest):
    """Sets of heights are drawn in colours, unless they are asked for as heights."""

    def assert_told_apart(self, tiles):
        drawn = self.assert_done("render", tiles, *RENDER)
        self.assertIn(f"{tiles}: numbers in the colours of viridis", drawn.stderr)
        self.assertIn("elevation", self.assert_done("info", tiles).stdout)
        self.assert_fails(FAILED, "preload", tiles, "-o", "cache.gpkg", says=[tiles, "heights"])

    def test_what_cut_writes(self):
        self.write("in.png", heights_png(512, 256))
        for output in ("relief.gpkg", "relief"):
            with self.subTest(output):
                self.assert_done("cut", "in.png", "--elevation", "--offset", "-32768", "-o", output)
                self.assert_told_apart(output)

    def test_coverages_of_other_programs(self):
        self.write("in.png", heights_png(512, 256))
        self.assert_done("cut", "in.png", "--elevation", "-o", "relief.gpkg")
        with sqlite3.connect(self.folder / "relief.gpkg") as base:
            base.execute("DROP TABLE terrella_tileset")
        base.close()
        self.assert_told_apart("relief.gpkg")
