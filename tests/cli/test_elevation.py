"""Heights that are damaged, missing, unknown, of another grid or no heights at all: each message names file and tile."""

import sqlite3
import struct
import unittest
import zlib

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
        self.write("in.png", heights_png(128, 64))
        for picture in ("in.png", BLUE_MARBLE):
            self.assert_fails(FAILED, "render", "sea.gpkg", "--elevation", picture, *RENDER,
                              says=[str(picture), "cut --elevation"])

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
        self.assertRegex(done.stderr, rf"relief\.gpkg lacks the heights {level}/\d+/\d+: PNG")
        self.assertIn("heights lacked", done.stdout)

    def test_missing_tiles(self):
        self.cut(hills(256, 128), "--tile-size", "32")
        whole, _ = self.render()
        level, table = self.finest()
        self.spoil(f'DELETE FROM "{table}" WHERE zoom_level = ?', level)
        coarse, done = self.render(DONE_IN_PART)
        self.assertRegex(done.stderr, rf"relief\.gpkg lacks the heights {level}/\d+/\d+: ")
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


if __name__ == "__main__":
    unittest.main()
