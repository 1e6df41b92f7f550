"""Broken and hostile tile sets: a message that names the set; never a crash, a hang or a huge allocation."""

import shutil
import sqlite3
import unittest
import zlib

import geopackages
from pictures import heights_png, png_of
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
    """Sets of heights are no pictures to draw: said, with what to do with them."""

    def assert_told_apart(self, tiles):
        self.assert_fails(FAILED, "render", tiles, *RENDER, says=[tiles, "heights, not pictures", "--elevation"])
        self.assertFalse((self.folder / "shot.png").exists())
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
