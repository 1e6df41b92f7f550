"""PMTiles archives, on disk and by byte ranges. The truth is an MBTiles file of the same tiles."""

import contextlib
import functools
import gzip
import json
import sqlite3
import unittest

import pmtiles
import servers
from pictures import png
from pictures import square_tile
from pmtiles import archive, directory
from program import DONE, DONE_IN_PART, FAILED, ProgramTest
from range_server import range_server
from test_mercator import LEVELS

VIEW = ("--unlit", "--sky", "off", "--camera", "20,10,9000000", "--size", "128x128")


@functools.cache
def planet():
    """All tiles of the levels, with two quarters of one colour, which make runs."""
    tiles = {(z, x, y): square_tile(z, x, y) for z in range(LEVELS) for x in range(1 << z) for y in range(1 << z)}
    one_colour = png(64, 64)
    for x, y in ((0, 0), (0, 1), (1, 0), (1, 1), (3, 3)):
        tiles[LEVELS - 1, x, y] = one_colour
    return tiles


class ArchiveTest(ProgramTest):
    def shot(self, source, *options, code=DONE):
        done = self.run_program("render", source, "-o", "shot.png", *VIEW, *options)
        self.assertEqual(done.returncode, code, f"{source}\n{done.stdout}{done.stderr}")
        return (self.folder / "shot.png").read_bytes(), done.stderr

    def pixels(self, source, *options):
        return self.shot(source, *options)[0]

    def mbtiles(self, name="truth.mbtiles", tiles=None):
        with sqlite3.connect(self.folder / name) as base:
            base.execute("CREATE TABLE metadata (name TEXT, value TEXT)")
            base.execute("CREATE TABLE tiles (zoom_level, tile_column, tile_row, tile_data)")
            base.executemany("INSERT INTO tiles VALUES (?, ?, ?, ?)",
                             [(z, x, (1 << z) - 1 - y, data) for (z, x, y), data in (tiles or planet()).items()])
        base.close()
        return name


class LocalTest(ArchiveTest):
    def test_an_mbtiles_file_that_stores_a_tile_twice(self):
        """info --verify waited for ever for the second one."""
        name = self.mbtiles()
        with sqlite3.connect(self.folder / name) as base:
            base.execute("INSERT INTO tiles SELECT * FROM tiles")
        base.close()
        self.assert_done("info", name, "--verify")

    def test_every_layout_shows_the_same(self):
        truth = self.pixels(self.mbtiles())
        layouts = {"flat": {}, "leaves": {"leaf_size": 3}, "deep": {"leaf_size": 2, "depth": 3},
                   "not clustered": {"clustered": False}, "leaves, not clustered": {"clustered": False, "leaf_size": 4},
                   "plain directories": {"internal": pmtiles.NONE, "leaf_size": 4},
                   "gzip tiles": {"compression": pmtiles.GZIP}, "of no type": {"kind": 0}, "no metadata": {"metadata": b"{}"}}
        for name, layout in layouts.items():
            with self.subTest(name):
                self.write("a.pmtiles", archive(planet(), **layout))
                self.assertEqual(self.pixels("a.pmtiles"), truth)
                told = json.loads(self.assert_done("info", "a.pmtiles", "--verify", "--json").stdout)
                self.assertEqual(told["verified"]["good"], len(planet()))
                self.assertEqual(told["made_of"]["max_level"], LEVELS - 1)

    def test_info_says_what_the_archive_says(self):
        self.write("a.pmtiles", archive(planet(), leaf_size=3, bounds=(-20, -30, 40, 50)))
        told = self.assert_done("info", "a.pmtiles").stdout
        for text in ("of the test", "nobody", "Web Mercator", "PNG", "west -20", "north 50"):
            self.assertIn(text, told)

    def test_a_part_of_the_planet(self):
        part = {tile: data for tile, data in planet().items() if tile[0] < 2 or tile[1] > 1}
        truth, lacking = self.shot(self.mbtiles("part.mbtiles", part), code=DONE_IN_PART)
        self.write("part.pmtiles", archive(part, leaf_size=5))
        shot, missing = self.shot("part.pmtiles", code=DONE_IN_PART)
        self.assertEqual(shot, truth)
        self.assertEqual(missing.count("has no such tile"), lacking.count("has no such tile"))

    def test_preload_from_it(self):
        self.write("a.pmtiles", archive(planet(), leaf_size=3))
        self.assert_done("preload", "a.pmtiles", "--levels", f"0-{LEVELS - 1}", "-o", "all.gpkg")
        self.assertEqual(self.pixels("all.gpkg"), self.pixels(self.mbtiles()))

    def test_hostile_archives_are_named(self):
        some = {tile: data for tile, data in planet().items() if tile[0] < 2}
        good = archive(some, leaf_size=2, internal=pmtiles.NONE)
        loop = directory([(0, 0, 5, 0)])
        assert len(loop) == 5, len(loop)
        plain = {"internal": pmtiles.NONE}
        cases = {
            "version 2": (archive(some, header={1: 2}), "version 2"),
            "old": (b"PM\2\0" + bytes(200), "version 2"),
            "vector tiles": (archive(some, kind=pmtiles.MVT), "vector tiles"),
            "avif": (archive(some, kind=pmtiles.AVIF), "AVIF"),
            "brotli": (archive(some, header={14: pmtiles.BROTLI}), "brotli"),
            "zstd tiles": (archive(some, header={15: pmtiles.ZSTD}), "zstd"),
            "levels": (archive(some, header={18: 30}), "levels are 0 to 30"),
            "levels turned round": (archive(some, header={17: 3}), "levels are 3 to 1"),
            "root at 2^63": (archive(some, header={2: 1 << 63}), "root directory"),
            "root of 2^64 bytes": (archive(some, header={3: (1 << 64) - 1}), "root directory"),
            "no root": (archive(some, header={3: 0}), "root directory is empty"),
            "metadata beyond the end": (archive(some, header={5: 1 << 40}), "metadata"),
            "tiles beyond the end": (archive(some, header={9: 1 << 40}), "tiles"),
            "cut in the header": (good[:100], "truncated"),
            "cut in the directory": (good[:140], "truncated"),
            "cut in the tiles": (good[:-1000], "truncated"),
            "long tile": (archive(some, root=directory([(0, 0, 1 << 31, 1)])), "beyond the end of the tiles"),
            "tile at 2^61": (archive(some, root=directory([(0, 1 << 61, 5, 1)])), "beyond the end of the tiles"),
            "tile at 2^63": (archive(some, root=directory([(0, 1 << 63, 5, 1)])), "too large"),
            "leaf beyond the end": (archive(some, leaf_size=2, root=directory([(0, 1 << 30, 5, 0)])), "leaf directories"),
            "leaf loop": (archive(some, root=loop, leaves=loop, **plain), "lead to each other"),
            "run overlap": (archive(some, root=directory([(0, 0, 10, 5), (2, 0, 10, 1)])), "overlap"),
            "order": (archive(some, root=b"\x02\x05\x00\x01\x01\x01\x01\x01\x01", **plain), "out of order"),
            "empty tile": (archive(some, root=directory([(0, 0, 0, 1)])), "no bytes"),
            "nothing listed": (archive(some, root=b"\0"), "lists nothing"),
            "2^31 entries": (archive(some, root=pmtiles.varint(1 << 31) + bytes(100)), "ends before"),
            "endless number": (archive(some, root=b"\xff" * 50), "too large"),
            "number cut off": (archive(some, root=b"\x01\x80"), "damaged"),
            "bomb": (archive(some, root=b"\x01" + bytes(100 << 20)), "after decompression"),
            "metadata bomb": (archive(some, metadata=bytes(100 << 20)), "after decompression"),
            "no gzip": (archive(some, header={14: pmtiles.GZIP}, **plain), "gzip"),
            "metadata that are a list": (archive(some, metadata=b"[]"), "metadata"),
            "metadata that are no JSON": (archive(some, metadata=b"{"), "metadata"),
            "html": (archive({(0, 0, 0): b"<html>no</html>"}), "first tile"),
        }
        for name, (data, says) in cases.items():
            with self.subTest(name):
                self.write("bad.pmtiles", data)
                self.assert_fails(FAILED, "render", "bad.pmtiles", "-o", "x.png", *VIEW, says=["bad.pmtiles", says])
                self.assert_fails(FAILED, "info", "bad.pmtiles", says=["bad.pmtiles", says])

    def test_a_damaged_leaf_breaks_its_tiles_alone(self):
        data = bytearray(archive(planet(), leaf_size=4, internal=pmtiles.NONE))
        root_offset, root_length = 127, int.from_bytes(data[16:24], "little")
        leaves = int.from_bytes(data[40:48], "little")
        first_leaf = directory_lengths(data[root_offset:root_offset + root_length])[0]
        data[leaves + first_leaf:int.from_bytes(data[56:64], "little")] = b"\xff" * (
            int.from_bytes(data[48:56], "little") - first_leaf)
        self.write("leaf.pmtiles", bytes(data))
        _, told = self.shot("leaf.pmtiles", code=DONE_IN_PART)
        self.assertIn("directory is damaged", told)

    def test_a_loop_below_good_entries_ends(self):
        some = {(0, 0, 0): planet()[0, 0, 0]}
        # The first tile is found; all others lead from a leaf to itself.
        leaf = directory([(1, 0, 5, 0)])
        first = planet()[0, 0, 0]
        self.write("loop.pmtiles", archive(some, root=directory([(0, 0, len(first), 1), (1, 0, len(leaf), 0)]), leaves=leaf,
                                           internal=pmtiles.NONE, levels=(0, 2)))
        _, told = self.shot("loop.pmtiles", code=DONE_IN_PART)
        self.assertIn("lead to each other", told)
        self.assert_fails(FAILED, "info", "loop.pmtiles", "--verify", says=["loop.pmtiles", "lead to each other"])


def directory_lengths(data):
    """The lengths in a directory, read with nothing of the writer."""
    return [length for _, _, length, _ in pmtiles.parsed_directory(data)]


class RemoteTest(ArchiveTest):
    def setUp(self):
        super().setUp()
        self.served = self.folder / "served"
        self.served.mkdir()

    @contextlib.contextmanager
    def nginx(self, data):
        (self.served / "a.pmtiles").write_bytes(data)
        with servers.nginx(self.served) as server:
            yield server, server.template.replace("{z}/{x}/{y}.jpg", "a.pmtiles")

    def test_cold_warm_offline_and_without_its_server(self):
        truth = self.pixels(self.mbtiles())
        options = ("--cache", "c.gpkg")
        with self.nginx(archive(planet(), leaf_size=3)) as (server, url):
            self.assertEqual(self.pixels(url, *options), truth)
            asked = server.requests()
            self.assertEqual({status for status, _ in asked}, {206})
            tiles, leaves = len(planet()), 8
            self.assertLessEqual(len(asked), tiles + leaves + 3, "a tile or a directory was requested twice")
            self.assertEqual(self.pixels(url, *options), truth)
            again = len(server.requests()) - len(asked)
            self.assertLessEqual(again, 3, "cached tiles are not requested again")
            before = len(server.requests())
            self.assertEqual(self.pixels(url, *options, "--offline"), truth)
            self.assertEqual(len(server.requests()), before)
        self.assertEqual(self.pixels(url, *options, "--offline"), truth)

    def test_gzip_tiles_and_deep_directories(self):
        truth = self.pixels(self.mbtiles())
        with self.nginx(archive(planet(), leaf_size=2, depth=3, compression=pmtiles.GZIP)) as (_, url):
            self.assertEqual(self.pixels(url, "--cache", "off"), truth)

    def test_preload_and_info(self):
        truth = self.pixels(self.mbtiles())
        with self.nginx(archive(planet(), leaf_size=3)) as (server, url):
            self.assertIn("of the test", self.assert_done("info", url).stdout)
            self.assert_done("preload", url, "--levels", f"0-{LEVELS - 1}", "-o", "all.gpkg")
            before = len(server.requests())
            done = self.assert_done("preload", url, "--levels", f"0-{LEVELS - 1}", "-o", "all.gpkg")
            self.assertLessEqual(len(server.requests()) - before, 3, done.stdout)
        self.assertEqual(self.pixels("all.gpkg"), truth)

    def test_absent_tiles_are_remembered(self):
        part = {tile: data for tile, data in planet().items() if tile[0] < 2 or tile[1] > 1}
        truth, _ = self.shot(self.mbtiles("part.mbtiles", part), code=DONE_IN_PART)
        with self.nginx(archive(part, leaf_size=5)) as (server, url):
            self.assertEqual(self.shot(url, "--cache", "c.gpkg", code=DONE_IN_PART)[0], truth)
            before = len(server.requests())
            self.assertEqual(self.shot(url, "--cache", "c.gpkg", code=DONE_IN_PART)[0], truth)
            self.assertLessEqual(len(server.requests()) - before, 3, "an absent tile was looked for again")
        self.assertEqual(self.shot(url, "--cache", "c.gpkg", "--offline", code=DONE_IN_PART)[0], truth)

    def test_faults_of_the_server_are_named(self):
        data = archive(planet(), leaf_size=3)
        for fault, says in (("whole", "ignores byte ranges"), ("endless", "ignores byte ranges"),
                            ("shifted", "other bytes"), ("shorter", "other bytes"), ("nonsense", "other bytes"),
                            ("none", "other bytes")):
            with self.subTest(fault), range_server(data, fault) as (url, handler):
                self.assert_fails(FAILED, "info", url, says=[url, says])
                self.assertLessEqual(handler.count, 3)
        with self.nginx(data) as (_, url):
            self.assert_fails(FAILED, "info", url.replace("a.pmtiles", "b.pmtiles"), says=["b.pmtiles", "does not exist"])

    def test_a_file_that_changes_is_noticed(self):
        data = archive(planet(), leaf_size=3)
        for fault in "changes", "412":
            with self.subTest(fault), range_server(data, fault) as (url, _):
                done = self.run_program("render", url, "--cache", "off", "-o", "x.png", *VIEW)
                self.assertIn(done.returncode, (FAILED, DONE_IN_PART), done.stderr)
                self.assertIn("has changed on the server", done.stderr)

    def test_a_server_of_another_mind_still_serves(self):
        truth = self.pixels(self.mbtiles())
        with range_server(archive(planet(), leaf_size=3)) as (url, handler):
            self.assertEqual(self.pixels(url, "--cache", "off"), truth)

    def test_other_failures_are_named(self):
        with range_server(archive(planet(), leaf_size=3), "gone after two") as (url, _):
            done = self.run_program("render", url, "--cache", "off", "-o", "x.png", *VIEW)
            self.assertIn(done.returncode, (FAILED, DONE_IN_PART), done.stderr)
            self.assertIn("does not exist", done.stderr)


if __name__ == "__main__":
    unittest.main()
