"""The first view without --camera: a raster or tile set of a part of the planet fills a good part of the picture."""

import json
import sqlite3
import unittest

import png as pngs
from pictures import png
from program import DONE, DONE_IN_PART, FAILED, ProgramTest

SMALL = ("--size", "96x96", "--unlit")
COLOUR = (40, 90, 160)
LEAST_SHARE = 0.3  # share of the picture; the room around the data takes 0.4


class FirstView(ProgramTest):
    def share(self, *arguments):
        """The part of the picture that has the raster's colour."""
        done = self.run_program("render", *arguments, "-o", "shot.png", *SMALL)
        self.assertIn(done.returncode, (DONE, DONE_IN_PART), done.stderr)  # a sparse set has no tiles around its part
        width, height, rows = pngs.read(self.folder / "shot.png")
        near = sum(max(abs(row[3 * x + k] - COLOUR[k]) for k in range(3)) < 16 for row in rows for x in range(width))
        return near / (width * height)

    def test_a_raster_and_a_tile_set_of_a_part_are_flown_to(self):
        self.write("part.png", png(64, 64, COLOUR))
        for bounds in ("100,-40,102,-38", "178,60,182,62", "10,-1,10.01,-0.99", "-60,-30,60,30"):
            with self.subTest(bounds):
                place = ("--bounds", bounds)
                self.assertGreater(self.share("part.png", *place), LEAST_SHARE)
                self.assert_done("cut", "part.png", *place, "-o", "part.gpkg", "--force")
                self.assertGreater(self.share("part.gpkg"), LEAST_SHARE)

    def sparse_sets(self):
        """Sets of the whole planet by their own words, with tiles of level 4 in 90 to 112.5 degrees east, 33.75 to 45 north."""
        tiles = {(4, x, y): png(64, 64, COLOUR) for x in (24, 25) for y in (4,)}
        (self.folder / "folder").mkdir()
        self.write("folder/tileset.json", json.dumps(
            {"root_span_deg": 180, "tile_px": 64, "min_level": 0, "max_level": 4, "format": "png"}).encode())
        for (z, x, y), data in tiles.items():
            (self.folder / f"folder/{z}/{x}").mkdir(parents=True, exist_ok=True)
            self.write(f"folder/{z}/{x}/{y}.png", data)
        with sqlite3.connect(self.folder / "mercator.mbtiles") as base:
            base.executescript("""CREATE TABLE metadata (name text, value text); CREATE TABLE tiles (zoom_level integer,
                tile_column integer, tile_row integer, tile_data blob);""")
            base.executemany("INSERT INTO metadata VALUES (?, ?)", {"name": "m", "format": "png", "minzoom": "0", "maxzoom": "5",
                                                                    "bounds": "-180,-85,180,85"}.items())
            for x in (24, 25):  # columns from 90 to 112.5 degrees east, a row from 31.95 to 40.98 north
                base.execute("INSERT INTO tiles VALUES (5, ?, ?, ?)", (x, 31 - 12, png(256, 256, COLOUR)))
        return "folder", "mercator.mbtiles"

    def test_tiles_in_a_part_of_a_set_of_the_planet_are_flown_to(self):
        for name in self.sparse_sets():
            with self.subTest(name):
                self.assertGreater(self.share(name), 0.2)
                done = self.assert_fails(FAILED, "render", name, "-o", "away.png", *SMALL, "--camera=-20,-60,300000",
                                         says=["90° to 112.5° east", "--camera"])
                self.assertNotIn("none of the", done.stderr)

    def city(self):
        """An MBTiles file of a city alone: four tiles of level 17."""
        across = 360 / (1 << 17)
        west = 8.5 // across * across
        metadata = {"format": "png", "minzoom": "17", "maxzoom": "17", "bounds": f"{west},0,{west + 2 * across},{2 * across}"}
        with sqlite3.connect(self.folder / "city.mbtiles") as base:
            base.executescript("""CREATE TABLE metadata (name text, value text); CREATE TABLE tiles (zoom_level integer,
                tile_column integer, tile_row integer, tile_data blob);""")
            base.executemany("INSERT INTO metadata VALUES (?, ?)", metadata.items())
            column, equator = round((west + 180) / across), 1 << 16
            base.executemany("INSERT INTO tiles VALUES (17, ?, ?, ?)",
                             [(column + x, equator + y, png(256, 256, COLOUR)) for x in (0, 1) for y in (0, 1)])
        return "city.mbtiles"

    def test_a_city_without_coarse_levels_is_shown(self):
        self.assertGreater(self.share(self.city()), 0.2)

    def test_a_grid_with_too_many_coarsest_tiles_is_refused(self):
        (self.folder / "tiny/0/0").mkdir(parents=True)
        self.write("tiny/0/0/0.png", png(64, 64, COLOUR))
        self.write("tiny/tileset.json",
                   json.dumps({"root_span_deg": 0.1, "tile_px": 64, "max_level": 0, "format": "png"}).encode())
        self.assert_fails(FAILED, "render", "tiny", "-o", "shot.png", *SMALL,
                          says=["6480000 tiles", "add coarser levels"])

    def test_a_view_without_data_says_where_they_lie(self):
        self.write("part.png", png(64, 64, COLOUR))
        done = self.assert_done("render", "part.png", "--bounds", "100,-40,102,-38", "-o", "shot.png", *SMALL,
                                "--camera", "50,0,100000")
        for says in ("100° to 102° east", "-40° to -38° north", "--camera"):
            self.assertIn(says, done.stderr)


if __name__ == "__main__":
    unittest.main()
