"""`info --verify` of sparse tile sets on deep grids: the time depends on the tiles, not on the grid."""

import json
import shutil
import sqlite3
import unittest

import geopackages
from pictures import png
from program import FAILED, ProgramTest

DEEPEST = 24
COLUMNS, ROWS = 2 << DEEPEST, 1 << DEEPEST
PLACES = ((0, 1, 0), (DEEPEST, COLUMNS - 1, ROWS - 1), (DEEPEST, 5, 7))
TILE_PX = 64


class Sparse(ProgramTest):
    def assert_verified(self, tile_set, good, broken):
        done = self.run_program("info", tile_set, "--verify", "--json")
        self.assertEqual(done.returncode, FAILED if broken else 0, done.stdout + done.stderr)
        told = json.loads(done.stdout)["verified"]
        self.assertEqual((told["good"], told["broken"]), (good, broken))
        return told

    def folder_of_tiles(self, rows_from_south=False):
        tiles = self.folder / "tiles"
        for z, x, y in PLACES:
            row = (1 << z) - 1 - y if rows_from_south else y
            (tiles / f"{z}/{x}").mkdir(parents=True, exist_ok=True)
            (tiles / f"{z}/{x}/{row}.png").write_bytes(png(TILE_PX, TILE_PX))
        return tiles

    def test_folder(self):
        tiles = self.folder_of_tiles()
        (tiles / "tileset.json").write_text(json.dumps(
            {"root_span_deg": 180, "tile_px": TILE_PX, "max_level": DEEPEST, "format": "png"}))
        # None of these is a tile of the set.
        for name in ("24/x/7.png", "24/5/007.png", "24/5/-7.png", "24/5/7.txt", f"24/5/{ROWS}.png", "24/99999999999/1.png"):
            (tiles / name).parent.mkdir(exist_ok=True)
            (tiles / name).write_bytes(b"no tile")
        self.assert_verified("tiles", good=3, broken=0)
        (tiles / "24/5/7.png").write_bytes(b"no picture")
        told = self.assert_verified("tiles", good=2, broken=1)
        self.assertEqual([(t["level"], t["x"], t["y"]) for t in told["broken_tiles"]], [(DEEPEST, 5, 7)])

    def test_geopackage(self):
        path = self.folder / "sparse.gpkg"
        geopackages.write_good(path, png(TILE_PX, TILE_PX))
        with sqlite3.connect(path) as base:
            base.execute("DELETE FROM tiles")
            base.execute("DELETE FROM gpkg_tile_matrix")
            for z in range(DEEPEST + 1):
                base.execute("INSERT INTO gpkg_tile_matrix VALUES ('tiles', ?, ?, ?, ?, ?, ?, ?)",
                             (z, 2 << z, 1 << z, TILE_PX, TILE_PX, 180 / TILE_PX / 2**z, 180 / TILE_PX / 2**z))
            for place in PLACES:
                base.execute("INSERT INTO tiles VALUES (NULL, ?, ?, ?, ?)", (*place, png(TILE_PX, TILE_PX)))
        base.close()
        self.assert_verified(path, good=3, broken=0)
        with sqlite3.connect(path) as base:
            base.execute("UPDATE tiles SET tile_data = x'00' WHERE tile_column = 5")
        base.close()
        told = self.assert_verified(path, good=2, broken=1)
        self.assertEqual([(t["level"], t["x"], t["y"]) for t in told["broken_tiles"]], [(DEEPEST, 5, 7)])

    def test_rows_without_end_are_given_up(self):
        for name in geopackages.ENDLESS:
            with self.subTest(name):
                path = self.folder / f"{name}.gpkg"
                geopackages.write_endless(path, name)
                self.assert_fails(FAILED, "info", path, "--verify", says=[str(path)])

    def test_a_sparse_copy_of_a_cut_counts_what_is_missing(self):
        self.write("planet.png", png(1024, 512))
        self.assert_done("cut", "planet.png", "-o", "tiles", "--tile-size", str(TILE_PX))
        whole = self.assert_verified("tiles", good=170 + self.squeezed(), broken=0)
        self.assertEqual(whole["absent"], 0)
        shutil.rmtree(self.folder / "tiles/3/0")
        self.assertEqual(self.assert_verified("tiles", good=whole["good"] - 8, broken=0)["absent"], 8)

    def squeezed(self):
        return sum(1 for _ in (self.folder / "tiles/squeezed").rglob("*.jpg"))


if __name__ == "__main__":
    unittest.main()
