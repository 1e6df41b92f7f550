"""Outputs over existing files: only files that can be made again are replaced."""

import json
import os
import shutil
import sqlite3
import subprocess
import time
import unittest

import servers
from pictures import png
from program import BLUE_MARBLE, FAILED, NATURAL_EARTH, PROGRAM, ProgramTest

ROADS = {"type": "FeatureCollection", "features": [
    {"type": "Feature", "properties": {"name": "A1"}, "geometry": {"type": "LineString", "coordinates": [[8, 47], [9, 46]]}}]}


class Replacing(ProgramTest):
    def setUp(self):
        super().setUp()
        self.picture = self.write("planet.png", png(128, 64))
        self.other = self.write("other.png", png(128, 64, (9, 9, 9)))

    def content(self):
        """All files in the working folder with their bytes; links by what they name."""
        return {str(p.relative_to(self.folder)): os.readlink(p) if p.is_symlink() else p.read_bytes()
                for p in self.folder.rglob("*") if p.is_symlink() or p.is_file()}

    def assert_stays(self, *arguments, says=()):
        """Refused, and every file is as it was, with nothing beside them."""
        before = self.content()
        self.assert_fails(FAILED, *arguments, says=says)
        self.assertEqual(self.content().keys(), before.keys())
        self.assertEqual(self.content(), before)


class Cut(Replacing):
    def assert_never(self, output, *says, picture="planet.png"):
        for force in (), ("--force",):
            with self.subTest(force=force):
                self.assert_stays("cut", picture, "-o", output, *force, says=[output, *says, "another output"])

    def test_a_cache_stays(self):
        with servers.nginx(NATURAL_EARTH) as server:
            self.assert_done("preload", server.template, "--levels", "0-1", "-o", "alps.gpkg")
        self.assert_never("alps.gpkg", "cache", "preload")

    def test_vector_data_stay(self):
        self.write("roads.json", json.dumps(ROADS).encode())
        subprocess.run(["ogr2ogr", self.folder / "roads.gpkg", self.folder / "roads.json", "-nln", "roads"], check=True)
        self.assert_never("roads.gpkg", "roads")

    def test_vector_data_in_a_file_of_cut_stay(self):
        self.write("roads.json", json.dumps(ROADS).encode())
        self.assert_done("cut", "planet.png", "-o", "planet.gpkg")
        subprocess.run(["ogr2ogr", "-update", self.folder / "planet.gpkg", self.folder / "roads.json", "-nln", "roads"],
                       check=True)
        self.assert_never("planet.gpkg", "table")

    def test_a_picture_stays_by_any_name(self):
        self.picture.rename(self.folder / "same.gpkg")
        self.assert_never("same.gpkg", "same.gpkg", picture="same.gpkg")
        os.link(self.folder / "same.gpkg", self.folder / "hard.gpkg")
        self.assert_never("hard.gpkg", "same.gpkg", picture="same.gpkg")
        os.symlink("same.gpkg", self.folder / "soft.gpkg")
        self.assert_never("soft.gpkg", "same.gpkg", picture="same.gpkg")

    def test_a_folder_that_holds_the_picture_stays(self):
        self.assert_done("cut", "planet.png", "-o", "tiles", "--tile-size", "32")
        self.write("tiles/0/0/inner.png", self.picture.read_bytes())
        self.assert_never("tiles", "inner.png", picture="tiles/0/0/inner.png")

    def test_other_files_and_folders_stay(self):
        self.write("notes.gpkg", b"to do: nothing\n")
        self.assert_never("notes.gpkg", "no GeoPackage")
        (self.folder / "models").mkdir()
        self.write("models/tileset.json", b'{"asset": {"version": "1.1"}, "geometricError": 500, "root": {}}')
        self.assert_never("models", "other things")
        self.assert_done("cut", "planet.png", "-o", "tiles")
        self.write("tiles/notes.txt", b"mine")
        self.assert_never("tiles", "notes.txt")

    def test_a_pipe_is_not_waited_for(self):
        os.mkfifo(self.folder / "pipe.gpkg")
        self.assert_fails(FAILED, "cut", "planet.png", "-o", "pipe.gpkg", "--force", says=["pipe.gpkg", "pipe"])

    def test_what_another_program_is_writing_stays(self):
        self.assert_done("cut", "planet.png", "-o", "planet.gpkg")
        base = sqlite3.connect(self.folder / "planet.gpkg", isolation_level=None)
        self.addCleanup(base.close)
        base.execute("PRAGMA journal_mode = PERSIST")
        base.execute("BEGIN IMMEDIATE")
        base.execute("UPDATE gpkg_contents SET description = 'better'")
        base.execute("PRAGMA cache_spill = 1")
        self.write("planet.gpkg-journal", b"\xd9\xd5\x05\xf9 as of a program that was killed")
        self.assert_never("planet.gpkg", "planet.gpkg-journal")

    def test_the_same_cut_again_replaces(self):
        for output in ("planet.gpkg", "tiles"):
            self.assert_done("cut", "planet.png", "-o", output)
            before = self.content()
            self.assert_done("cut", "planet.png", "-o", output)
            self.assertEqual(self.content(), before)

    def test_other_options_replace_what_was_cut_from_the_same_picture(self):
        for output in ("planet.gpkg", "tiles"):
            self.assert_done("cut", "planet.png", "-o", output)
            before = self.content()
            self.assert_done("cut", "planet.png", "-o", output, "--quality", "50")
            self.assertNotEqual(self.content(), before)

    def test_another_picture_replaces_by_force_alone(self):
        for output in ("planet.gpkg", "tiles"):
            self.assert_done("cut", "planet.png", "-o", output)
            self.assert_stays("cut", "other.png", "-o", output, says=[output, "--force"])
            before = self.content()
            self.assert_done("cut", "other.png", "-o", output, "--force")
            self.assertNotEqual(self.content(), before)
        self.assert_nothing_but("planet.png", "other.png", "planet.gpkg", "tiles")

    def test_files_and_folders_of_nothing_are_replaced(self):
        self.write("planet.gpkg", b"")
        (self.folder / "tiles").mkdir()
        for output in ("planet.gpkg", "tiles"):
            self.assert_done("cut", "planet.png", "-o", output)

    def test_what_comes_while_it_cuts_stays(self):
        for output, mine in ("out.gpkg", "out.gpkg"), ("tiles", "tiles/notes.txt"):
            with self.subTest(output):
                cutting = subprocess.Popen([PROGRAM, "cut", BLUE_MARBLE, "-o", output, "--force"], cwd=self.folder,
                                           stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
                while cutting.poll() is None and not list(self.folder.glob(f".{output}.*.part")):
                    time.sleep(0.01)
                (self.folder / mine).parent.mkdir(exist_ok=True)
                self.write(mine, b"mine")
                told = cutting.communicate()[1]
                self.assertEqual(cutting.returncode, FAILED, told)
                self.assertIn(output, told)
                self.assertEqual((self.folder / mine).read_bytes(), b"mine")
        self.assert_nothing_but("planet.png", "other.png", "out.gpkg", "tiles")


class Render(Replacing):
    def assert_stays_drawn(self, tile_set, output, *says):
        self.assert_stays("render", tile_set, "-o", output, "--size", "64x64", says=[output, *says, "another output"])

    def test_a_picture_is_replaced(self):
        shutil.copy(self.other, self.folder / "shot.png")
        self.assert_done("render", NATURAL_EARTH, "-o", "shot.png", "--size", "64x64")
        self.assertNotEqual((self.folder / "shot.png").read_bytes(), self.other.read_bytes())

    def test_what_it_draws_stays_by_any_name(self):
        self.assert_done("cut", "planet.png", "-o", "planet.gpkg")
        self.assert_stays_drawn("planet.gpkg", "planet.gpkg", "drawn")
        self.assert_stays_drawn("planet.png", "planet.png", "drawn")
        os.link(self.picture, self.folder / "hard.png")
        self.assert_stays_drawn("planet.png", "hard.png", "planet.png")
        self.assert_done("cut", "planet.png", "-o", "tiles", "--format", "png")
        self.assert_stays_drawn("tiles", "tiles/0/0/0.png", "tiles")

    def test_what_is_no_picture_stays(self):
        self.write("notes.txt", b"to do: nothing\n")
        self.assert_stays_drawn(NATURAL_EARTH, "notes.txt", "no picture")


class Lists(Replacing):
    def test_what_is_no_list_of_tiles_stays(self):
        for option in ("--missing", "--stored"):
            with self.subTest(option):
                self.assert_stays("preload", "http://127.0.0.1:9/{z}/{x}/{y}.jpg", "--levels", "0-0", "-o", "new.gpkg",
                                  option, "planet.png", says=["planet.png", "no list"])


if __name__ == "__main__":
    unittest.main()
