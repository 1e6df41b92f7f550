"""Preloading into PMTiles and MBTiles files from a real server."""

import contextlib
import os
import pathlib
import random
import signal
import sqlite3
import subprocess
import time
import unittest

import pmtiles
import servers
from preload_test import PyramidTest
from program import DONE, DONE_IN_PART, FAILED, NATURAL_EARTH, PROGRAM, WRONG_USAGE

LEVELS = 6
KINDS = ("pmtiles", "mbtiles")
KILLS = int(os.environ.get("TERRELLA_KILLS", "6"))
PLACES = [(z, x, y) for z in range(LEVELS) for x in range(1 << z) for y in range(1 << z)]
WEB = ("--projection", "web-mercator", "--levels", f"0-{LEVELS - 1}")


def tiles_of(path):
    """{(z, x, y): bytes} of an archive, with rows from the north."""
    if path.suffix == ".pmtiles":
        return pmtiles.contents(path.read_bytes())[2]
    with contextlib.closing(sqlite3.connect(path)) as base:
        found = base.execute("SELECT zoom_level, tile_column, tile_row, tile_data FROM tiles").fetchall()
    return {(z, x, (1 << z) - 1 - y): data for z, x, y, data in found}


class Archives(PyramidTest):
    LEVELS = LEVELS

    def bring(self, kind, *options, folder="out", template=None, words=WEB, **run):
        """Preloads into FOLDER/web.KIND; the name of a set that has none is that of its file."""
        (self.folder / folder).mkdir(exist_ok=True)
        self.cache = self.folder / folder / f"web.{kind}"
        return self.preload(template or self.server.template, *words, *options, **run)

    def unfinished(self):
        return pathlib.Path(f"{self.cache}.unfinished.gpkg")

    def asked(self):
        return sum(count for path, count in self.server.counts().items() if not path.startswith("/cut/"))

    def converted(self, source, folder):
        (self.folder / folder).mkdir(exist_ok=True)
        output = self.folder / folder / source.with_suffix(self.cache.suffix).name
        self.assert_done("convert", source, output, "--force")
        return output.read_bytes()

    def test_the_tiles_are_those_of_the_geopackage(self):
        self.bring("gpkg")
        cache = self.cache
        for kind in KINDS:
            with self.subTest(kind):
                before = self.asked()
                summary, _ = self.bring(kind)
                self.assertEqual((summary["stored"], self.asked() - before), (len(PLACES), len(PLACES)))
                self.assertEqual(tiles_of(self.cache), {place: servers.tile_file(*place).read_bytes() for place in PLACES})
                self.assertEqual(self.converted(self.cache, "a"), self.converted(cache, "b"))
                self.assert_done("info", self.cache, "--verify")
                summary, _ = self.bring(kind)
                self.assertEqual((summary["there"], summary["requests"]), (len(PLACES), 0))
                self.assertEqual(self.bring(kind, "--dry-run", "--offline")[0]["there"], len(PLACES))
                self.assertEqual(self.asked() - before, len(PLACES))
        self.assertEqual(sorted(p.name for p in cache.parent.iterdir()), ["web.gpkg", "web.mbtiles", "web.pmtiles"])

    def test_gdal_reads_the_same_pixels(self):
        found = {}
        for kind in "gpkg", "mbtiles":
            self.bring(kind, words=(*WEB[:2], "--levels", "0-2"))
            subprocess.run(["gdal_translate", "-q", "-of", "ENVI", "-b", "1", "-b", "2", "-b", "3", self.cache,
                            self.folder / "pixels"], check=True, capture_output=True)
            found[kind] = (self.folder / "pixels").read_bytes()
        self.assertEqual(len(found["gpkg"]), 3 * 1024 * 1024)
        self.assertEqual(found["gpkg"], found["mbtiles"])

    def end(self, kind, until, sent):
        """Ends a preload a moment after until() first says so."""
        process = subprocess.Popen([PROGRAM, "preload", self.server.template, *WEB, "-o", self.cache, "--rate", "2000"],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        while process.poll() is None and not until():
            time.sleep(0.001)
        time.sleep(random.uniform(0.0, 0.01))
        process.send_signal(sent)
        told = process.communicate()[1]
        return process.returncode, told

    def kept(self):
        """The tiles that a kill has left."""
        if not self.unfinished().exists():
            return set()
        with contextlib.closing(sqlite3.connect(self.unfinished())) as base:
            with contextlib.suppress(sqlite3.OperationalError):  # a file without tables yet
                return set(base.execute("SELECT zoom_level, tile_column, tile_row FROM tiles"))
        return set()

    def lists(self):
        """The list of tiles that each run begins with when all tiles are there; a killed run leaves its own."""
        found = set()
        for path in self.cache.parent.glob(".web*.part/order"):
            with contextlib.suppress(FileNotFoundError):
                found.add((path, path.stat().st_mtime_ns))
        return found

    def test_killed_it_goes_on_to_the_same_bytes(self):
        random.seed(35)
        for kind in KINDS:
            self.bring(kind, folder="whole")
            whole = self.cache.read_bytes()
            (self.folder / kind).mkdir()
            self.cache = self.folder / kind / f"web.{kind}"
            cuts, there, writing = [], [], 0
            for kill in range(KILLS):
                goal, before = len(self.kept()) + random.randint(0, 2 * len(PLACES) // KILLS), self.lists()
                self.end(kind, lambda: self.lists() - before if 2 * kill >= KILLS else len(self.kept()) >= goal,
                         signal.SIGKILL)
                writing += not self.cache.exists() and len(self.kept()) == len(PLACES)
                cuts.append(self.server.cut())
                there.append(self.kept() if not self.cache.exists() else set(PLACES))
            self.bring(kind, folder=kind)
            self.assertEqual(self.cache.read_bytes(), whole)
            self.assertEqual([p.name for p in self.cache.parent.iterdir()], [self.cache.name])
            for cut, stored in zip(cuts, there):
                self.assertEqual(stored & self.server.asked_since(cut), set(), "fetched again")
            print(f"{kind}: {KILLS} kills, {writing} of them between the last tile and the name of the file")

    def test_stopped_it_keeps_the_tiles_and_makes_only_what_is_planned(self):
        self.cache = self.folder / "web.pmtiles"
        code, told = self.end("pmtiles", lambda: any(z == LEVELS - 1 for z, _, _ in self.kept()), signal.SIGINT)
        self.assertEqual(code, DONE_IN_PART, told)
        self.assertIn("web.pmtiles.unfinished.gpkg has the tiles", told)
        self.assertFalse(self.cache.exists())
        cut, few = self.server.cut(), [place for place in PLACES if place[0] < LEVELS - 1]
        self.preload(self.server.template, *WEB[:2], "--max-level", LEVELS - 1, "--levels", f"0-{LEVELS - 2}")
        self.assertEqual(set(tiles_of(self.cache)), set(few))
        self.assertEqual(self.server.paths_since(cut), set())
        # Tiles of the finest level stay where they are: another plan brought them.
        self.assertTrue(self.folder.joinpath("web.pmtiles.unfinished.gpkg").exists())
        _, told = self.preload(self.server.template, *WEB, code=FAILED)
        self.assertIn("was not made by this preload", told)
        self.assertEqual(set(tiles_of(self.cache)), set(few))

    def test_no_file_without_all_tiles(self):
        for kind in KINDS:
            with self.subTest(kind), servers.misbehaving(self.pyramid, {"2/1/1.jpg": "500?times=2"}) as server:
                _, told = self.bring(kind, "--retries", "0", template=server.template, code=DONE_IN_PART)
                self.assertFalse(self.cache.exists())
                self.assertIn(f"{self.unfinished()} has the tiles, and terrella convert takes it", told)
                self.assert_done("convert", self.unfinished(), f"part.{kind}")
                self.assertEqual(set(tiles_of(self.folder / f"part.{kind}")), set(PLACES) - {(2, 1, 1)})
                before = len(server.log())
                self.bring(kind, template=server.template)
                self.assertEqual({line["path"] for line in server.log()[before:]} - {"/log"}, {"/2/1/1.jpg"})
                self.assertEqual(set(tiles_of(self.cache)), set(PLACES))
                self.assertFalse(self.unfinished().exists())

    def test_each_time_has_a_file(self):
        for date in "2026-06-01", "2026-06-02":
            servers.write_pyramid(self.root / date, 2)
        with servers.nginx(self.root) as server:
            self.cache = self.folder / "june.pmtiles"
            self.preload(server.template.replace("{z}", "{time:%Y-%m-%d}/{z}"), *WEB[:2], "--levels", "0-1", "--layer-times",
                         "2026-06-01/2026-06-02/P1D", "--times", "2026-06-01/2026-06-02")
        self.assert_nothing_but("june.2026-06-01.pmtiles", "june.2026-06-02.pmtiles", "tiles")

    def test_what_has_no_place_in_the_file_is_refused(self):
        for kind in KINDS:
            name = f"web.{kind}"
            for options in ("--release",), ("--cache-size", 9), ("--refresh-older-than", 1):
                self.assert_fails(WRONG_USAGE, "preload", self.server.template, *WEB, "-o", name, *options,
                                  says=[name, options[0], ".gpkg", "terrella convert"])
            self.assert_fails(FAILED, "preload", self.server.template, *WEB[2:], "-o", name,
                              says=[name, "Web Mercator alone", ".gpkg", "--projection web-mercator"])
            self.assert_fails(FAILED, "preload", NATURAL_EARTH, "-o", name, says=[name, "Web Mercator alone", ".gpkg"])
            self.write(name, b"mine")
            self.assert_fails(FAILED, "preload", self.server.template, *WEB, "-o", name, says=[name, "is there already"])
            self.assertEqual((self.folder / name).read_bytes(), b"mine")
            (self.folder / name).unlink()
        self.assertEqual(self.server.requests(), [])
        self.assert_nothing_but()


if __name__ == "__main__":
    unittest.main()
