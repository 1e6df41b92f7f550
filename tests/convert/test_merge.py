"""merge into PMTiles and MBTiles files: the tiles that merge chooses for a GeoPackage."""

import contextlib
import json
import os
import random
import signal
import sqlite3
import subprocess
import time
import unittest

from pictures import TILE_PX, png
from program import FAILED, PROGRAM, ProgramTest
from test_convert import LEVELS, bytes_of, planet, tiles_of, write_folder

KINDS = ("pmtiles", "mbtiles")


class Merge(ProgramTest):
    def setUp(self):
        super().setUp()
        write_folder(self.folder / "source", planet())
        self.parts = ["1.gpkg", "2.gpkg", "3.gpkg"]
        for index, part in enumerate(self.parts, 1):
            self.assert_done("preload", "source", "-o", part, "--shard", f"{index}/3")

    def change(self, cache, sql, *values):
        with contextlib.closing(sqlite3.connect(self.folder / cache)) as base, base:
            base.execute(sql, values)

    def merged(self, kind):
        (self.folder / "out").mkdir(exist_ok=True)
        output = self.folder / "out" / f"set.{kind}"
        return output, json.loads(self.assert_done("merge", *self.parts, "-o", output, "--json").stdout)

    def test_the_tiles_are_those_of_the_geopackage(self):
        # Places of several caches: the tile stored later counts, whichever cache comes first.
        self.assert_done("preload", "source", "-o", "all.gpkg")
        self.parts = ["1.gpkg", "all.gpkg", "2.gpkg", "3.gpkg"]
        for cache, colour in ("all.gpkg", b"\x11\x22\x33"), ("2.gpkg", b"\x44\x55\x66"):
            self.change(cache, "UPDATE tiles SET tile_data = ? WHERE tile_column % 2 = 1", png(TILE_PX, TILE_PX, colour))
        self.change("all.gpkg", "UPDATE terrella_cache_tiles SET stored = stored + 60 WHERE id % 3 = 0")
        self.change("3.gpkg", "UPDATE terrella_cache_tiles SET stored = stored + 60 WHERE id % 2 = 0")
        cache, told = self.merged("gpkg")
        self.assertEqual(told["tiles"], len(planet()))
        for kind in KINDS:
            output, said = self.merged(kind)
            self.assertEqual(tiles_of(output), tiles_of(cache))
            self.assertEqual((said["tiles"], said["absences"]), (told["tiles"], 0))
            self.assertEqual(said["dropped"], len(planet()))
            for source, folder in (output, "a"), (cache, "b"):
                (self.folder / folder).mkdir(exist_ok=True)
                self.assert_done("convert", source, f"{folder}/set.{kind}")
            self.assertEqual(bytes_of(self.folder / f"a/set.{kind}"), bytes_of(self.folder / f"b/set.{kind}"))
        self.assertEqual(sorted(p.name for p in cache.parent.iterdir()), ["set.gpkg", "set.mbtiles", "set.pmtiles"])

    def test_killed_it_leaves_no_half_file_and_is_repeated_with_the_same_bytes(self):
        moments = random.Random(35)
        for kind in KINDS:
            begun = time.monotonic()
            output, _ = self.merged(kind)
            whole_s, whole = time.monotonic() - begun, output.read_bytes()
            for _ in range(int(os.environ.get("TERRELLA_KILLS", "5"))):
                output.unlink(missing_ok=True)
                process = subprocess.Popen([PROGRAM, "merge", *self.parts, "-o", output], cwd=self.folder,
                                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                time.sleep(moments.uniform(0, whole_s))
                process.send_signal(signal.SIGKILL)
                process.wait()
                self.assertEqual(output.read_bytes() if output.exists() else whole, whole)
            output.unlink(missing_ok=True)
            self.assertEqual(self.merged(kind)[0].read_bytes(), whole)
        self.assertEqual(sorted(p.name for p in output.parent.iterdir()), ["set.mbtiles", "set.pmtiles"])

    def test_what_has_no_place_in_the_file_is_refused(self):
        write_folder(self.folder / "plate", {(0, 0, 0): png(TILE_PX, TILE_PX)},
                     {"projection": "equirectangular", "root_span_deg": 180, "max_level": 0, "bounds": [-180, -90, 180, 90]})
        self.assert_done("preload", "plate", "-o", "plate.gpkg")
        for kind in KINDS:
            self.assert_fails(FAILED, "merge", "plate.gpkg", "-o", f"a.{kind}",
                              says=[f"a.{kind}", "Web Mercator alone", ".gpkg"])
            self.assert_fails(FAILED, "merge", "1.gpkg", "plate.gpkg", "-o", f"a.{kind}", says=["plate.gpkg", "1.gpkg"])
            self.write(f"b.{kind}", b"mine")
            self.assert_fails(FAILED, "merge", *self.parts, "-o", f"b.{kind}", says=[f"b.{kind}", "is there already"])
            self.assertEqual((self.folder / f"b.{kind}").read_bytes(), b"mine")
        self.change("1.gpkg", "UPDATE tiles SET tile_data = ? WHERE zoom_level = ?", b"\xff\xd8\xff\xe0 as a JPEG", LEVELS - 1)
        self.assert_fails(FAILED, "merge", *self.parts, "-o", "a.mbtiles", says=["MBTiles", "one format", ".gpkg or .pmtiles"])
        self.assert_done("merge", *self.parts, "-o", "a.pmtiles")
        self.assert_nothing_but("source", "plate", "plate.gpkg", *self.parts, "a.pmtiles", "b.pmtiles", "b.mbtiles")


if __name__ == "__main__":
    unittest.main()
