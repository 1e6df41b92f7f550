"""Tiles that arrive damaged: none is stored, each is asked for again, and each that stays damaged is named."""

import json
import random
import sqlite3
import unittest

import pmtiles
import servers
from pictures import square_tile
from preload_test import PreloadTest
from program import DONE, DONE_IN_PART, FAILED
from range_server import range_server

SPOILED = {"2/1/1.jpg": "zeroed", "2/2/1.jpg": "shifted", "2/3/1.jpg": "scrambled", "2/4/1.jpg": "truncated_jpeg"}
LEVELS = 3
VIEW = ("--unlit", "--sky", "off", "--camera", "0,0,20000000", "--size", "128x128")


class DamageTest(PreloadTest):
    def missing(self):
        """Place to kind of each tile that a run with --missing named."""
        return {line.split("\t")[0]: line.split("\t")[1] for line in (self.folder / "missing.txt").read_text().splitlines()}

    def assert_verified(self, good):
        told = json.loads(self.assert_done("info", self.cache, "--verify", "--json").stdout)
        self.assertEqual((told["verified"]["good"], told["verified"]["broken"]), (good, 0), told)


class Server(DamageTest):
    def setUp(self):
        super().setUp()
        servers.write_pyramid(self.root, LEVELS)

    def test_one_bad_answer_is_asked_for_again(self):
        with servers.misbehaving(self.root, {path: fault + "?times=1" for path, fault in SPOILED.items()}) as server:
            summary, _ = self.preload(server.template, "--levels", "0-2")
            asked = [entry["path"].strip("/") for entry in server.log()]
        self.assertEqual(summary["stored"], servers.tiles_in(LEVELS))
        self.assertEqual({path: asked.count(path) for path in SPOILED}, dict.fromkeys(SPOILED, 2))
        self.assertEqual(len(asked), servers.tiles_in(LEVELS) + len(SPOILED))
        self.assert_stored_are_right()
        self.assert_verified(servers.tiles_in(LEVELS))

    def test_bad_answers_are_named_and_the_next_run_gets_the_tiles(self):
        # Each run asks twice.
        with servers.misbehaving(self.root, {path: fault + "?times=2" for path, fault in SPOILED.items()}) as server:
            summary, said = self.preload(server.template, "--levels", "0-2", "--missing", "missing.txt", code=DONE_IN_PART)
            self.assertEqual(self.missing(), {path.removesuffix(".jpg"): "broken" for path in SPOILED}, said)
            self.assertEqual(summary["stored"], servers.tiles_in(LEVELS) - len(SPOILED))
            self.assert_verified(servers.tiles_in(LEVELS) - len(SPOILED))
            summary, _ = self.preload(server.template, "--levels", "0-2")
        self.assertEqual(summary["stored"], len(SPOILED))
        self.assert_stored_are_right()

    def test_a_picture_is_whole_once_the_server_is_well(self):
        """The cache of `render` keeps neither a bad tile nor that it was bad."""
        roots = {"0/0/0.jpg": "scrambled?times=2", "0/1/0.jpg": "zeroed?times=2"}
        with servers.misbehaving(self.root, roots) as server:
            render = ("render", server.template, "--max-level", 0, "-o", "x.png", *VIEW, "--cache", self.cache)
            bad = self.run_program(*render)
            self.assertIn(bad.returncode, (FAILED, DONE_IN_PART), bad.stderr)
            well = self.run_program(*render)
            self.assertEqual(well.returncode, DONE, well.stderr)
        self.assert_verified(2)


class Archive(DamageTest):
    def setUp(self):
        super().setUp()
        self.tiles = {(z, x, y): square_tile(z, x, y) for z in range(LEVELS) for x in range(1 << z) for y in range(1 << z)}

    def write_mbtiles(self, tiles):
        with sqlite3.connect(self.folder / "a.mbtiles") as base:
            base.execute("CREATE TABLE metadata (name TEXT, value TEXT)")
            base.execute("CREATE TABLE tiles (zoom_level, tile_column, tile_row, tile_data)")
            base.executemany("INSERT INTO tiles VALUES (?, ?, ?, ?)",
                             [(z, x, (1 << z) - 1 - y, data) for (z, x, y), data in tiles.items()])
        base.close()
        return "a.mbtiles"

    def write_pmtiles(self, tiles):
        return self.write("a.pmtiles", pmtiles.archive(tiles, leaf_size=8)).name

    def forget(self, source):
        for path in (self.folder / source, self.cache):
            path.unlink(missing_ok=True)

    def test_damaged_tiles_of_a_file_are_missing(self):
        good = self.tiles[2, 1, 2]
        # The PNG's end and size stay, or go.
        spoiled = {(2, 1, 1): good[:60] + bytes(len(good) - 80) + good[-20:], (2, 2, 1): good[:-30], (2, 3, 1): bytes(len(good)),
                   (2, 0, 3): good[:100] + bytes([good[100] ^ 1]) + good[101:]}
        for write in (self.write_mbtiles, self.write_pmtiles):
            with self.subTest(write.__name__):
                source = write(self.tiles | spoiled)
                summary, said = self.preload(source, "--missing", "missing.txt", code=DONE_IN_PART)
                self.assertEqual(self.missing(), {"/".join(map(str, place)): "broken" for place in spoiled}, said)
                self.assertEqual(summary["stored"], len(self.tiles) - len(spoiled))
                self.assert_verified(len(self.tiles) - len(spoiled))
                self.forget(source)

    def test_no_mutant_is_called_complete(self):
        """If `preload` ends with 0, `info --verify` finds nothing wrong, in the archive or in the cache."""
        random.seed(29)
        whole = 0
        for write in (self.write_mbtiles, self.write_pmtiles):
            for number in range(20):
                path = self.folder / write(self.tiles)
                data = bytearray(path.read_bytes())
                for _ in range(random.choice((1, 8, 64))):
                    data[random.randrange(len(data) // 8, len(data))] = random.randrange(256)
                path.write_bytes(data)
                done = self.run_program("preload", path.name, "-o", self.cache)
                self.assertIn(done.returncode, (DONE, FAILED, DONE_IN_PART), done.stderr)
                if done.returncode == DONE:
                    whole += 1
                    for name in path.name, self.cache:
                        verified = self.run_program("info", name, "--verify")
                        self.assertEqual(verified.returncode, DONE, f"{write.__name__} {number}: {verified.stdout}")
                self.forget(path.name)
        print(f"{whole} of 40 mutants were whole")

    def test_an_archive_on_a_server(self):
        """A leaf directory and a tile arrive damaged once, and then always."""
        data = pmtiles.archive(self.tiles, leaf_size=8)
        header = pmtiles.struct.unpack_from(pmtiles.HEADER, data)
        leaves, first_tile = header[6], header[8]
        for times in (1, 1000):
            bad = {}

            def spoil(_, first, body):
                # Requests of the header and the first tile are for the description.
                spoils = first in bad or (leaves < first < first_tile and not bad)
                spoils = spoils or (first > first_tile + 1000 and len(bad) == 1)
                bad[first] = bad.get(first, 0) + 1 if spoils else bad.get(first, 0)
                if not spoils:
                    del bad[first]
                return bytes(len(body)) if spoils and bad[first] <= times else body

            with self.subTest(times), range_server(data, spoil=spoil) as (url, handler):
                summary, said = self.preload(url, "--missing", "missing.txt", code=DONE if times == 1 else DONE_IN_PART)
                self.assertEqual(sorted(bad.values()), [2, 2], handler.asked)
                self.assertEqual(summary["stored"] + len(self.missing()), len(self.tiles), said)
                self.assertLessEqual(set(self.missing().values()), {"broken"})
                self.assertEqual(len(self.missing()) > 0, times > 1, said)
                self.assert_verified(summary["stored"])
            self.cache.unlink()


if __name__ == "__main__":
    unittest.main()
