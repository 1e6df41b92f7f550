"""convert: the same tiles in every format, read by programs and code that are not Terrella's."""

import json
import os
import random
import shutil
import signal
import sqlite3
import subprocess
import time
import unittest

import pmtiles
from pictures import TILE_PX, png, square_tile
from program import DONE, FAILED, NATURAL_EARTH, PROGRAM, ProgramTest

LEVELS = 4
KINDS = ("tiles", "set.gpkg", "set.mbtiles", "set.pmtiles")
FIELDS = ("name", "attribution", "body")  # kept by each format
ONE_COLOUR = png(TILE_PX, TILE_PX)
BEGINS_AS_JPEG = b"\xff\xd8\xff\xe0 as a JPEG picture begins"
INFO = {"version": 1, "name": "Of the \"test\"", "attribution": "nobody \u2013 © 2026", "projection": "web-mercator",
        "tile_px": TILE_PX, "min_level": 0, "max_level": LEVELS - 1, "format": "png", "body": "moon",
        "bounds": [-180, -85.05112877980659, 180, 85.05112877980659]}


def planet(levels=LEVELS):
    """All tiles of the levels but a few, with neighbours of one colour."""
    tiles = {(z, x, y): square_tile(z, x, y) for z in range(levels) for x in range(1 << z) for y in range(1 << z)}
    for x in range(1 << (levels - 1)):
        for y in range(3):
            tiles[levels - 1, x, y] = ONE_COLOUR
    for place in (3, 1, 4), (3, 6, 1):
        tiles.pop(place, None)
    return tiles


def write_folder(folder, tiles, info=None):
    for (z, x, y), data in tiles.items():
        column = folder / str(z) / str(x)
        column.mkdir(parents=True, exist_ok=True)
        (column / f"{y}.png").write_bytes(data)
    (folder / "tileset.json").write_text(json.dumps({**INFO, **(info or {})}))


def rows(path, sql):
    base = sqlite3.connect(path)
    found = base.execute(sql).fetchall()
    base.close()
    return found


def tiles_of(path):
    """{(z, x, y): bytes} with rows from the north, of the output of any kind."""
    if path.suffix == ".pmtiles":
        return pmtiles.contents(path.read_bytes())[2]
    if path.suffix == "":
        return {(int(p.parts[-3]), int(p.parts[-2]), int(p.stem)): p.read_bytes() for p in path.glob("[0-9]*/*/*")}
    found = rows(path, "SELECT zoom_level, tile_column, tile_row, tile_data FROM tiles")
    return {(z, x, (1 << z) - 1 - y if path.suffix == ".mbtiles" else y): data for z, x, y, data in found}


def bytes_of(path):
    return {str(p.relative_to(path)): p.read_bytes() for p in path.rglob("*") if p.is_file()} if path.is_dir() else path.read_bytes()


class Convert(ProgramTest):
    def setUp(self):
        super().setUp()
        write_folder(self.folder / "source", planet())

    def info(self, name):
        return json.loads(self.assert_done("info", name, "--json").stdout)

    def all_kinds(self):
        for name in KINDS:
            self.assert_done("convert", "source", name)

    def test_all_pairs_give_the_same_bytes(self):
        self.all_kinds()
        for name in KINDS:
            self.assertEqual(tiles_of(self.folder / name), planet(), name)
            for kind in KINDS:
                with self.subTest(f"{name} to {kind}"):
                    again = f"again-{kind}"
                    self.assert_done("convert", name, again, "--force")
                    self.assertEqual(tiles_of(self.folder / again), planet())
                    said = self.info(again)
                    self.assertEqual([said[field] for field in FIELDS], [INFO[field] for field in FIELDS])
                    self.assert_done("info", again, "--verify")

    def test_an_mbtiles_file_keeps_its_rules(self):
        self.assert_done("convert", "source", "set.mbtiles")
        path = self.folder / "set.mbtiles"
        said = dict(rows(path, "SELECT name, value FROM metadata"))
        west, south, east, north = map(float, said.pop("bounds").split(","))
        self.assertEqual((west, east), (-180, 180))
        self.assertAlmostEqual(south, -85.05112877980659, 9)
        self.assertAlmostEqual(north, 85.05112877980659, 9)
        self.assertEqual(said.pop("center"), "0,0,0")
        self.assertTrue(said.pop("cut_key"))
        self.assertEqual(said, {field: INFO[field] for field in FIELDS} | {"format": "png", "minzoom": "0",
                                "maxzoom": str(LEVELS - 1), "type": "overlay", "scheme": "tms"})
        self.assertEqual(rows(path, "PRAGMA application_id"), [(0x4D504258,)])
        self.assertEqual(rows(path, "PRAGMA integrity_check"), [("ok",)])
        with self.assertRaises(sqlite3.IntegrityError):
            rows(path, "INSERT INTO tiles SELECT * FROM tiles")

    def test_gdal_reads_the_same_pixels(self):
        self.all_kinds()
        found = {}
        for name in "set.gpkg", "set.mbtiles":
            subprocess.run(["gdal_translate", "-q", "-of", "ENVI", self.folder / name, self.folder / "pixels"], check=True,
                           capture_output=True)
            found[name] = (self.folder / "pixels").read_bytes()
        side = TILE_PX << (LEVELS - 1)
        self.assertGreaterEqual(len(found["set.gpkg"]), 3 * side * side)
        self.assertEqual(found["set.gpkg"], found["set.mbtiles"])

    def test_an_archive_keeps_its_rules(self):
        """pmtiles.contents() checks more."""
        self.assert_done("convert", "source", "set.pmtiles")
        fields, metadata, tiles = pmtiles.contents((self.folder / "set.pmtiles").read_bytes())
        self.assertEqual(fields[16:23], (pmtiles.PNG, 0, LEVELS - 1, -1800000000, -850511288, 1800000000, 850511288))
        self.assertLess(fields[11], fields[10], "neighbours are a run")
        self.assertEqual(fields[12], len(set(planet().values())), "equal tiles are stored once")
        said = json.loads(metadata)
        self.assertEqual([said[field] for field in FIELDS], [INFO[field] for field in FIELDS])

    def test_what_a_format_cannot_hold_is_refused_with_a_cure(self):
        write_folder(self.folder / "heights", planet(), {"elevation": {"scale": 1, "offset": 0}})
        for name in "out.mbtiles", "out.pmtiles":
            for source, says in (NATURAL_EARTH, "Web Mercator"), ("heights", "numbers"):
                self.assert_fails(FAILED, "convert", source, name, says=[name, says, ".gpkg", "folder"])
        self.assert_fails(FAILED, "cut", self.write("planet.png", png(128, 64)), "-o", "cut.pmtiles",
                          says=["cut.pmtiles", "Web Mercator", ".gpkg"])
        self.assert_nothing_but("heights", "planet.png", "source")

    def test_grids_and_heights_are_kept_by_geopackages_and_folders(self):
        self.write("planet.png", png(256, 128))
        self.assert_done("cut", "planet.png", "-o", "cut.gpkg", "--tile-size", "16")
        self.assert_done("cut", "planet.png", "-o", "cut", "--tile-size", "16")
        self.assert_done("convert", "cut.gpkg", "tiles")
        self.assert_done("convert", "tiles", "again.gpkg")
        same = [{name: data for name, data in bytes_of(self.folder / folder).items() if name != "tileset.json"}
                for folder in ("cut", "tiles")]
        self.assertIn("squeezed", "".join(same[0]))
        self.assertEqual(same[0], same[1])
        for table in "tiles", "terrella_squeezed_tiles":
            sql = f"SELECT zoom_level, tile_column, tile_row, tile_data FROM {table} ORDER BY 1, 2, 3"
            self.assertEqual(rows(self.folder / "again.gpkg", sql), rows(self.folder / "cut.gpkg", sql))
        write_folder(self.folder / "heights", planet(), {"elevation": {"scale": 2, "offset": 5, "numbers": "signed"}})
        self.assert_done("convert", "heights", "heights.gpkg")
        self.assertEqual(self.info("heights.gpkg")["elevation"], self.info("heights")["elevation"])
        self.assertEqual(tiles_of(self.folder / "heights.gpkg"), planet())

    def test_tiles_with_a_scale_of_their_own_are_refused(self):
        write_folder(self.folder / "heights", planet(), {"elevation": {"scale": 2, "offset": 5}})
        self.assert_done("convert", "heights", "heights.gpkg")
        self.assert_done("convert", "heights.gpkg", "again")
        self.assertEqual(self.info("again")["elevation"], self.info("heights")["elevation"])
        with sqlite3.connect(self.folder / "heights.gpkg") as base:
            base.execute("UPDATE gpkg_2d_gridded_tile_ancillary SET scale = 2 WHERE id = 7")
        base.close()
        self.assert_fails(FAILED, "convert", "heights.gpkg", "out", says=["heights.gpkg", "level", "scale", "copy the file"])
        self.assert_nothing_but("again", "heights", "heights.gpkg", "source")

    def test_empty_tiles_are_left_out_and_counted(self):
        self.write("source/2/1/1.png", b"")
        for name in KINDS:
            done = self.assert_done("convert", "source", name, "--json")
            said = json.loads(done.stdout)
            self.assertEqual((said["tiles"], said["blank"]), (len(planet()) - 1, 1))
            self.assertIn(f"converting into {name}: 100 %", done.stderr)
            self.assertEqual(tiles_of(self.folder / name), {tile: data for tile, data in planet().items() if tile != (2, 1, 1)})

    def test_a_tile_that_is_listed_but_not_there_is_no_empty_tile(self):
        (self.folder / "source" / "2" / "1" / "1.png").unlink()
        (self.folder / "source" / "2" / "1" / "1.png").symlink_to("moved-away.png")
        for name in KINDS:
            self.assert_fails(FAILED, "convert", "source", name,
                              says=["source: level 2, column 1, row 1", "not there", "1.png", "put it back"])
        self.assert_nothing_but("source")

    def test_pictures_of_several_formats_need_a_set_that_can_mix_them(self):
        mixed = {**planet(), (2, 1, 1): BEGINS_AS_JPEG}
        self.write("source/2/1/1.png", BEGINS_AS_JPEG)
        for source in "source", "set.gpkg", "set.pmtiles":
            for name in "set.gpkg", "again.pmtiles", "set.pmtiles":
                if name != source:
                    self.assert_done("convert", source, name, "--force")
                    self.assertEqual(tiles_of(self.folder / name), mixed)
            fields, metadata, _ = pmtiles.contents((self.folder / "again.pmtiles").read_bytes())
            self.assertEqual((fields[16], json.loads(metadata)["type"]), (0, "overlay"))
            for name, cures in ("out", ".gpkg"), ("out.mbtiles", ".gpkg or .pmtiles"):
                self.assert_fails(FAILED, "convert", source, name,
                                  says=[f"{source}: level 2, column 1, row 1", "jpg", "png", cures])
        self.assert_nothing_but("again.pmtiles", "set.gpkg", "set.pmtiles", "source")

    def test_the_format_is_that_of_the_bytes_and_not_of_the_names(self):
        write_folder(self.folder / "misnamed", {(0, 0, 0): BEGINS_AS_JPEG})
        self.assert_done("convert", "misnamed", "tiles")
        self.assertEqual((self.folder / "tiles" / "0" / "0" / "0.jpg").read_bytes(), BEGINS_AS_JPEG)
        self.assert_done("convert", "misnamed", "set.pmtiles")
        self.assertEqual(pmtiles.contents((self.folder / "set.pmtiles").read_bytes())[0][16], pmtiles.JPEG)

    def test_the_summary_states_the_levels_with_tiles(self):
        shutil.rmtree(self.folder / "source" / "0")
        shutil.rmtree(self.folder / "source" / str(LEVELS - 1))
        for name in KINDS:
            said = json.loads(self.assert_done("convert", "source", name, "--json").stdout)
            self.assertEqual((said["min_level"], said["max_level"]), (1, LEVELS - 2), name)
        self.assertIn(f"levels 1 to {LEVELS - 2},", self.assert_done("convert", "source", "tiles", "--force").stdout)
        write_folder(self.folder / "small", {(1, 3, 5): ONE_COLOUR}, {"root_span_deg": 90})
        for name, level in ("small.gpkg", 1), ("small.pmtiles", 3):
            said = json.loads(self.assert_done("convert", "small", name, "--json").stdout)
            self.assertEqual((said["min_level"], said["max_level"]), (level, level), name)

    def test_other_things_are_named(self):
        self.write("notes.txt", b"to do: nothing")
        for source, says in ("notes.txt", "tile set"), ("nowhere.gpkg", "no such"), (".", "tileset.json"):
            self.assert_fails(FAILED, "convert", source, "out.gpkg", says=[source, says])
        write_folder(self.folder / "empty", {(9, 0, 0): ONE_COLOUR})
        self.assert_fails(FAILED, "convert", "empty", "out.gpkg", says=["empty", "no"])
        base = sqlite3.connect(self.folder / "twice.mbtiles")
        base.execute("CREATE TABLE metadata (name, value)")
        base.execute("CREATE TABLE tiles (zoom_level, tile_column, tile_row, tile_data)")
        base.executemany("INSERT INTO tiles VALUES (0, 0, 0, ?)", [(ONE_COLOUR,), (ONE_COLOUR,)])
        base.commit()
        base.close()
        self.assert_done("convert", "twice.mbtiles", "once.mbtiles")
        self.assertEqual(tiles_of(self.folder / "once.mbtiles"), {(0, 0, 0): ONE_COLOUR})

    def test_outputs_are_replaced_by_force_alone_and_other_files_never(self):
        write_folder(self.folder / "smaller", planet(3), {"max_level": 2})
        for name in KINDS:
            with self.subTest(name):
                self.assert_done("convert", "source", name)
                before = bytes_of(self.folder / name)
                self.assert_fails(FAILED, "convert", "smaller", name, says=[name, "--force"])
                self.assert_fails(FAILED, "convert", name, name, "--force", says=[name, "input"])
                self.assertEqual(bytes_of(self.folder / name), before)
                self.assert_done("convert", "smaller", name, "--force")
                self.assertEqual(tiles_of(self.folder / name), planet(3))
        (self.folder / "set.mbtiles").unlink()
        with sqlite3.connect(self.folder / "set.mbtiles") as base:
            base.execute("CREATE TABLE metadata (name, value)")
            base.execute("CREATE TABLE tiles (zoom_level, tile_column, tile_row, tile_data)")
        base.close()
        self.write("set.pmtiles", pmtiles.archive({(0, 0, 0): ONE_COLOUR}))
        self.write("set.gpkg", b"notes")
        self.write("tiles/notes.txt", b"mine")
        for name in KINDS:
            before = bytes_of(self.folder / name)
            self.assert_fails(FAILED, "convert", "source", name, "--force", says=[name, "another output"])
            self.assertEqual(bytes_of(self.folder / name), before)

    def test_a_full_disk_leaves_nothing(self):
        for name in KINDS:
            done = self.run_program("convert", "source", name, file_size_limit=20_000 if name != "tiles" else 80)
            self.assertEqual(done.returncode, FAILED, done.stderr)
            self.assertIn(name, done.stderr)
            self.assert_nothing_but("source")


class Ends(ProgramTest):
    """Kills and signals at random moments, of a set that takes a while."""

    def setUp(self):
        super().setUp()
        tiles = {(z, x, y): ONE_COLOUR + bytes([z, x, y]) * 99 for z in range(8) for x in range(1 << z) for y in range(1 << z)}
        write_folder(self.folder / "folder", tiles, {"max_level": 7})
        self.assert_done("convert", "folder", "source.gpkg")
        shutil.rmtree(self.folder / "folder")

    def end(self, name, sent, after_s):
        converting = subprocess.Popen([PROGRAM, "convert", "source.gpkg", name], cwd=self.folder, stdout=subprocess.PIPE,
                                      stderr=subprocess.PIPE, text=True)
        time.sleep(after_s)
        converting.send_signal(sent)
        told = converting.communicate()[1]
        return converting.returncode, told

    def test_killed_it_leaves_no_half_file_and_is_repeated_with_the_same_bytes(self):
        moments = random.Random(35)
        for name in "set.pmtiles", "set.mbtiles":
            begun = time.monotonic()
            self.assert_done("convert", "source.gpkg", name)
            whole_s = time.monotonic() - begun
            whole = bytes_of(self.folder / name)
            for _ in range(int(os.environ.get("TERRELLA_KILLS", "5"))):
                (self.folder / name).unlink(missing_ok=True)
                code, told = self.end(name, signal.SIGKILL, moments.uniform(0, whole_s))
                if (self.folder / name).exists():
                    self.assertEqual(bytes_of(self.folder / name), whole)
                    continue
                self.assertEqual(code, -signal.SIGKILL, told)
            (self.folder / name).unlink(missing_ok=True)
            self.assert_done("convert", "source.gpkg", name)
            self.assertEqual(bytes_of(self.folder / name), whole)
        self.assert_nothing_but("set.mbtiles", "set.pmtiles", "source.gpkg")

    def test_interrupted_it_leaves_nothing(self):
        for sent in signal.SIGINT, signal.SIGTERM:
            code, told = self.end("set.pmtiles", sent, 0.3)
            if code == DONE:  # the program was faster than the signal
                (self.folder / "set.pmtiles").unlink()
                continue
            self.assertIn(code, (FAILED, -sent), told)
            if code == FAILED:
                self.assertIn("interrupted", told)
                self.assert_nothing_but("source.gpkg")


if __name__ == "__main__":
    unittest.main()
