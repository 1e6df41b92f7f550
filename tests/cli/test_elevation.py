"""Faulty heights: damaged, missing, unknown, on another grid, or no heights at all. Each message names file and tile."""

import json
import resource
import sqlite3
import struct
import subprocess
import time
import unittest
import zlib

import servers
from pictures import heights_png, png, png_of
from program import BLUE_MARBLE, DONE, DONE_IN_PART, FAILED, ProgramTest

RENDER = ("-o", "out.png", "--size", "64x64", "--camera", "10,20,2000000,0,-50", "--unlit", "--cache", "off")
ROUGH = "--exaggeration", "20"


def hills(width, height):
    """Rows of numbers from 30000 to 39000: with --offset -32768, 2768 m deep to 6232 m high."""
    rows = bytearray()
    for y in range(height):
        rows += b"\0" + b"".join(struct.pack(">H", 30000 + 9000 * ((x // 8 + y // 8) % 2)) for x in range(width))
    return png_of(width, height, zlib.compress(bytes(rows)), bits=16, colour=0)


class BadHeights(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("sea.png", png(128, 64))
        self.assert_done("cut", "sea.png", "-o", "sea.gpkg", "--tile-size", "64")

    def cut(self, picture, *options, name="relief.gpkg"):
        self.write("in.png", picture)
        self.assert_done("cut", "in.png", "--elevation", "--offset", "-32768", "-o", name, "--force", *options)

    def spoil(self, sql, *values):
        with sqlite3.connect(self.folder / "relief.gpkg") as base:
            base.execute(sql, values)
        base.close()

    def render(self, code=DONE):
        done = self.run_program("render", "sea.gpkg", "--elevation", "relief.gpkg", *ROUGH, *RENDER)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return (self.folder / "out.png").read_bytes(), done

    def finest(self):
        with sqlite3.connect(self.folder / "relief.gpkg") as base:
            level, = base.execute("SELECT max(zoom_level) FROM gpkg_tile_matrix").fetchone()
            table, = base.execute("SELECT table_name FROM gpkg_contents").fetchone()
        base.close()
        return level, table

    def test_a_picture_for_heights(self):
        self.assert_fails(FAILED, "render", "sea.gpkg", "--elevation", BLUE_MARBLE, *RENDER,
                          says=[str(BLUE_MARBLE), "heights"])

    def test_a_picture_of_numbers_is_heights(self):
        flat, _ = self.run_flat()
        self.write("in.png", hills(256, 128))
        done = self.run_program("render", "sea.gpkg", "--elevation", "in.png", *ROUGH, *RENDER)
        self.assertEqual(done.returncode, DONE, done.stderr)
        self.assertNotEqual((self.folder / "out.png").read_bytes(), flat)

    def test_a_tile_set_of_pictures_for_heights(self):
        self.assert_fails(FAILED, "render", "sea.gpkg", "--elevation", "sea.gpkg", *RENDER,
                          says=["sea.gpkg", "pictures, not heights"])

    def test_tiles_of_eight_bits(self):
        self.cut(heights_png(128, 64), "--tile-size", "64")
        gray = png_of(64, 64, zlib.compress((b"\0" + bytes(64)) * 64), colour=0)
        level, table = self.finest()
        self.spoil(f'UPDATE "{table}" SET tile_data = ?', gray)
        self.assert_fails(FAILED, "render", "sea.gpkg", "--elevation", "relief.gpkg", *RENDER,
                          says=["relief.gpkg", "level", "8 bits", "16 bits"])

    def test_another_grid_than_the_imagerys(self):
        flat, _ = self.run_flat()
        for options in (["--tile-size", "32"], ["--tile-size", "100"], ["--tile-size", "128"]):
            with self.subTest(options):
                self.cut(hills(256, 128), *options)
                picture, _ = self.render()
                self.assertNotEqual(picture, flat, "heights raise nothing")

    def run_flat(self):
        done = self.assert_done("render", "sea.gpkg", *RENDER)
        return (self.folder / "out.png").read_bytes(), done

    def test_one_damaged_tile(self):
        self.cut(hills(256, 128), "--tile-size", "32")
        level, table = self.finest()
        # All of the finest level: the camera sees some of it.
        self.spoil(f'UPDATE "{table}" SET tile_data = substr(tile_data, 1, 60) WHERE zoom_level = ?', level)
        _, done = self.render(DONE_IN_PART)
        self.assertRegex(done.stderr, rf"relief\.gpkg: heights missing: {level}/\d+/\d+: PNG")
        self.assertIn("heights missing", done.stdout)

    def test_missing_tiles(self):
        self.cut(hills(256, 128), "--tile-size", "32")
        whole, _ = self.render()
        level, table = self.finest()
        self.spoil(f'DELETE FROM "{table}" WHERE zoom_level = ?', level)
        coarse, done = self.render(DONE_IN_PART)
        self.assertRegex(done.stderr, rf"relief\.gpkg: heights missing: {level}/\d+/\d+: ")
        self.assertNotEqual(coarse, whole)
        flat, _ = self.run_flat()
        self.assertNotEqual(coarse, flat, "the coarser levels stand for what is missing")

    def test_numbers_that_say_no_data(self):
        rows = b"".join(b"\0" + b"".join(struct.pack(">H", 0 if (x + y) % 7 == 0 else 32768) for x in range(256))
                        for y in range(128))
        holes = png_of(256, 128, zlib.compress(rows), bits=16, colour=0)
        flat, _ = self.run_flat()
        self.cut(holes, "--tile-size", "32")
        spikes, _ = self.render()
        self.assertNotEqual(spikes, flat, "without --nodata the number is a height")
        (self.folder / "relief.gpkg").unlink()
        self.cut(holes, "--tile-size", "32", "--nodata", "0")
        level_ground, _ = self.render()
        self.assertEqual(level_ground, self.flat_with_heights(), "holes are drawn as what lies around them")

    def flat_with_heights(self):
        (self.folder / "relief.gpkg").unlink()
        self.cut(heights_png(256, 128, 32768), "--tile-size", "32")
        return self.render()[0]


class HeightsFromServer(ProgramTest):
    """--elevation takes a description of heights on a server, as TILESET takes one of imagery."""

    MEANING = {"scale": 1.0, "offset": -32768.0}
    VIEW = ("-o", "out.png", "--size", "64x64", "--camera", "10,20,2000000,0,-50", "--unlit", *ROUGH)

    def setUp(self):
        super().setUp()
        self.write("sea.png", png(128, 64))
        self.assert_done("cut", "sea.png", "-o", "sea.gpkg", "--tile-size", "64")
        self.write("in.png", hills(256, 128))
        self.assert_done("cut", "in.png", "--elevation", "--offset", "-32768", "-o", "relief", "--tile-size", "32")
        self.relief = self.folder / "relief"
        self.truth = self.render("relief")

    def describe(self, template, **more):
        said = json.loads((self.relief / "tileset.json").read_text())
        grid = {name: said[name] for name in ("tile_px", "root_span_deg", "max_level")}
        description = {"url": template.replace(".jpg", ".png"), **grid, "elevation": self.MEANING, **more}
        self.write("heights.json", json.dumps(description).encode())
        return "heights.json"

    def render(self, elevation, *more, code=DONE):
        self.done = self.run_program("render", "sea.gpkg", "--elevation", elevation, *self.VIEW, *more)
        self.assertEqual(self.done.returncode, code, self.done.stdout + self.done.stderr)
        return (self.folder / "out.png").read_bytes()

    def test_cold_warm_and_offline_the_ground_is_the_same(self):
        with servers.nginx(self.relief) as server:
            heights = self.describe(server.template)
            self.assertEqual(self.render(heights), self.truth)
            asked = server.requests()
            self.assertTrue(asked and all(status == 200 for status, _ in asked), asked)
            self.assertEqual(self.render(heights), self.truth)
            self.assertEqual(self.render(heights, "--offline"), self.truth)
            self.assertEqual(server.requests(), asked, "what is fresh in the cache was asked for again")
        self.assertEqual(self.render(heights, "--offline"), self.truth)

    def test_a_cache_that_is_named_has_the_heights_beside_it(self):
        with servers.nginx(self.relief) as server:
            heights = self.describe(server.template)
            self.assertEqual(self.render(heights, "--cache", "trip.gpkg"), self.truth)
            self.assertTrue((self.folder / "trip-heights.gpkg").exists())
            self.assertEqual(self.render(heights, "--cache", "trip.gpkg", "--offline"), self.truth)
            asked = len(server.requests())
            self.assertEqual(self.render(heights, "--cache", "off"), self.truth)
            self.assertGreater(len(server.requests()), asked, "--cache off still has a cache")

    def test_preloaded_heights_serve_offline(self):
        with servers.nginx(self.relief) as server:
            heights = self.describe(server.template)
            levels = f"0-{json.loads((self.folder / heights).read_text())['max_level']}"
            self.assert_done("preload", heights, "--levels", levels, "-o", "trip-heights.gpkg")
        self.assertEqual(self.render(heights, "--cache", "trip.gpkg", "--offline"), self.truth)
        self.assertEqual(self.render("trip-heights.gpkg"), self.truth)
        told = json.loads(self.assert_done("info", "--verify", "--json", "trip-heights.gpkg").stdout)
        self.assertEqual((told["elevation"]["scale"], told["elevation"]["offset"]), (1.0, -32768.0))
        # GDAL reads the same metres: 30000 and 39000, less 32768.
        shown = subprocess.run(["gdalinfo", "-mm", self.folder / "trip-heights.gpkg"], capture_output=True, text=True,
                               check=True).stdout
        self.assertIn("Computed Min/Max=-2768.000,6232.000", shown)

    def test_a_description_brings_its_own_headers(self):
        with servers.misbehaving(self.relief, {}) as server:
            self.assertEqual(self.render(self.describe(server.template, headers=["X-Key: 4711"])), self.truth)
            self.assertTrue(all(entry["headers"].get("X-Key") == "4711" for entry in server.log()))

    def test_numbers_without_a_meaning_are_refused_with_the_cure(self):
        with servers.nginx(self.relief) as server:
            template = server.template.replace(".jpg", ".png")
            cure = ["heights.json", '"elevation"', '"scale"', "--elevation"]
            self.assert_fails(FAILED, "render", "sea.gpkg", "--elevation", template, *self.VIEW, says=[template, *cure])
            heights = self.describe(server.template)
            said = json.loads((self.folder / heights).read_text())
            del said["elevation"]
            self.write(heights, json.dumps(said).encode())
            self.assert_fails(FAILED, "render", "sea.gpkg", "--elevation", heights, *self.VIEW, says=[heights, *cure])
            self.assertEqual(server.requests(), [])

    def test_heights_named_as_imagery_are_drawn_in_colours(self):
        with servers.nginx(self.relief) as server:
            drawn = self.assert_done("render", self.describe(server.template), "-o", "out.png")
        self.assertIn("heights.json: numbers in the colours of viridis", drawn.stderr)

    def test_missing_tiles_are_counted_and_named(self):
        finest = max(int(folder.name) for folder in self.relief.iterdir() if folder.is_dir())
        for tile in (self.relief / str(finest)).glob("*/*.png"):
            tile.unlink()
        with servers.nginx(self.relief) as server:
            coarse = self.render(self.describe(server.template), code=DONE_IN_PART)
        self.assertRegex(self.done.stderr, rf"heights\.json: heights missing: {finest}/\d+/\d+: .*404")
        self.assertRegex(self.done.stdout, r"[1-9]\d* tiles of heights missing")
        self.assertNotEqual(coarse, self.truth)

    def test_heights_that_have_not_come_in_time_are_missing(self):
        with servers.misbehaving(self.relief, {}, "--latency-ms", "60000") as server:
            self.render(self.describe(server.template), "--timeout", "1", code=DONE_IN_PART)
        self.assertRegex(self.done.stdout, r"[1-9]\d* tiles of heights missing")

    def test_a_server_that_asks_for_patience_gets_it_for_both_kinds(self):
        self.assert_done("cut", "sea.png", "-o", "sea", "--tile-size", "64")
        both = self.folder / "both"
        both.mkdir()
        (self.folder / "sea").rename(both / "sea")
        self.relief.rename(both / "relief")
        self.relief = both / "relief"
        once = {str(tile.relative_to(both)): "503?times=1" for tile in both.glob("*/*/*/*.*")}
        with servers.misbehaving(both, once) as server:
            said = json.loads((both / "sea/tileset.json").read_text())
            grid = {name: said[name] for name in ("tile_px", "root_span_deg", "max_level")}
            template = server.template.replace(".jpg", "." + said["format"])
            imagery = {"url": template.replace("/{z}", "/sea/{z}"), **grid}
            self.write("sea.json", json.dumps(imagery).encode())
            heights = self.describe(server.template.replace("/{z}", "/relief/{z}"))
            done = self.run_program("render", "sea.json", "--elevation", heights, *self.VIEW)
            self.assertEqual(done.returncode, DONE, done.stdout + done.stderr)
            log = [entry["path"] for entry in server.log()]
        self.assertEqual((self.folder / "out.png").read_bytes(), self.truth)
        for kind in "/sea/", "/relief/":
            asked = [path for path in log if path.startswith(kind)]
            # A tile that the view no longer wants while it waits is not asked for again.
            self.assertGreaterEqual(sum(asked.count(path) == 2 for path in set(asked)), 2, asked)

    def test_waiting_for_heights_takes_no_processor_time(self):
        def cost(latency_ms):
            """Processor and wall seconds of one render."""
            with servers.misbehaving(self.relief, {}, "--latency-ms", str(latency_ms)) as server:
                before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
                heights = self.describe(server.template)
                self.assertEqual(self.render(heights, "--cache", "off"), self.truth)
                wall, after = time.monotonic() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
            return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, wall

        prompt, _ = cost(0)
        slow, wall = cost(8000)
        self.assertGreater(wall, 8.0)
        # A loop that draws while it waits takes a core and more: 8 s. A few frames take a fraction of a second.
        self.assertLess(slow - prompt, 2.0)


if __name__ == "__main__":
    unittest.main()
