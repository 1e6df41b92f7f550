"""A TIFF on a server that is damaged, hostile or cannot be read by parts, and servers that answer with something else."""

import sqlite3
import struct
import unittest

from georeferenced import gdal, make
from program import DONE, DONE_IN_PART, FAILED
from range_server import RangeServer, range_server
from test_remote_tiff import PLANET, VIEW, RemoteTiffTest

CLOSE = "40,10,3000"  # shows pixels of the finest level


class SpoiledTest(RemoteTiffTest):
    """Answers with the right ranges, length and entity tag, and wrong bytes."""

    AREA = ("--bbox", "5,30,50,60")
    SPOILS = {"zeros": lambda body: bytes(len(body)), "shifted": lambda body: bytes(3) + body[:-3]}

    def preload(self, url):
        return self.run_program("preload", url, *self.AREA, "-o", "c.gpkg")

    def assert_well(self, url, data, about):
        """The server is well again: what was spoiled is asked for again, and the cache has bytes of the file alone."""
        done = self.preload(url)
        self.assertEqual(done.returncode, DONE, f"{about}: {done.stderr}")
        with sqlite3.connect(self.folder / "c.gpkg") as base:
            rows = base.execute("SELECT tile_column, tile_row, tile_data FROM tiles WHERE tile_column >= 0").fetchall()
        base.close()
        self.assertGreater(len(rows), 10)
        for high, low, stored in rows:
            at = (high << 32) + low
            self.assertEqual(stored, data[at:at + len(stored)], f"{about}: bytes from {at} on")

    def spoil_each(self, data, spoils):
        """Each request of a run in turn is answered wrongly, once, or until the run ends."""
        with range_server(data, name="a.tif") as (url, server):
            self.assertEqual(self.preload(url).returncode, DONE)
            requests = server.count
            cases = [(n, name, last) for n in range(1, requests + 1) for name in spoils for last in (n, 1 << 30)]
            for number, name, last in cases:
                (self.folder / "c.gpkg").unlink()
                server.count = 0
                server.spoil = staticmethod(lambda nth, _, body, s=self.SPOILS[name], n=number, end=last:
                                            s(body) if n <= nth <= end else body)
                done = self.preload(url)
                server.spoil = staticmethod(RangeServer.spoil)
                about = f"{name}, request {number} of {requests} to {last}: {done.stdout}{done.stderr}"
                self.assertIn(done.returncode, (DONE,) if last == number else (FAILED, DONE_IN_PART), about)
                if last > number:
                    self.assertRegex(about, "a.tif: |do not decode")
                self.assert_well(url, data, about)
            (self.folder / "c.gpkg").unlink()
        return requests

    def test_no_answer_spoils_the_cache(self):
        for coding in "DEFLATE", "JPEG", "LZW":
            with self.subTest(coding):
                self.spoil_each(self.planet("-co", f"COMPRESS={coding}", width=1024), self.SPOILS if coding == "LZW" else ["zeros"])

    def test_no_answer_spoils_directories_at_the_end(self):
        """The overviews' directories and tables of tiles are not in the first block."""
        make(self.folder / "a.tif", 1024, 512, *PLANET, "-co", "TILED=YES", "-co", "COMPRESS=LZW", "-co", "BLOCKXSIZE=128",
             "-co", "BLOCKYSIZE=128")
        gdal("gdaladdo", "-q", self.folder / "a.tif", 2, 4)
        data = (self.folder / "a.tif").read_bytes()
        self.assertGreaterEqual(self.spoil_each(data, ["zeros"]), 3)

    def test_a_picture_is_whole_once_the_server_is_well(self):
        """`render` fails while all tiles come as zeros, and not later."""
        with range_server(self.planet("-co", "COMPRESS=DEFLATE"), name="a.tif") as (url, server):
            truth = self.pixels(url, "--cache", "off", camera=CLOSE)
            server.spoil = staticmethod(lambda _, first, body: body if first == 0 else bytes(len(body)))
            bad = self.run_program("render", url, "-o", "x.png", *VIEW, "--camera", CLOSE, "--cache", "c.gpkg")
            self.assertIn(bad.returncode, (FAILED, DONE_IN_PART), bad.stderr)
            server.spoil = staticmethod(RangeServer.spoil)
            self.assertEqual(self.pixels(url, "--cache", "c.gpkg", camera=CLOSE), truth)

    def test_spans_that_are_spoiled_in_the_cache_are_asked_for_again(self):
        with range_server(self.planet("-co", "COMPRESS=DEFLATE"), name="a.tif") as (url, _):
            truth = self.pixels(url, "--cache", "c.gpkg", camera=CLOSE)
            with sqlite3.connect(self.folder / "c.gpkg") as base:
                base.execute("UPDATE tiles SET tile_data = zeroblob(length(tile_data)) WHERE zoom_level = 1")
            base.close()
            # A run asks for the spans that the run before met.
            codes = [self.run_program("render", url, "-o", "x.png", *VIEW, "--camera", CLOSE, "--cache", "c.gpkg").returncode
                     for _ in range(8)]
            self.assertIn(codes[0], (FAILED, DONE_IN_PART))
            self.assertEqual(codes[-1], DONE, codes)
            self.assertEqual((self.folder / "x.png").read_bytes(), truth)


class RefusedTest(RemoteTiffTest):
    def test_faults_of_the_server_are_named(self):
        data = self.planet()
        for fault, says in (("whole", "ignores byte ranges"), ("endless", "ignores byte ranges"),
                            ("shifted", "other bytes"), ("shorter", "other bytes"), ("nonsense", "other bytes"),
                            ("none", "other bytes")):
            with self.subTest(fault), range_server(data, fault, name="a.tif") as (url, handler):
                self.assert_fails(FAILED, "render", url, "-o", "x.png", *VIEW, "--cache", "off", says=[url, says])
                self.assertLessEqual(handler.count, 3)

    def test_faults_that_begin_with_the_tiles_are_named(self):
        data = self.planet()
        for fault, says in (("whole", "ignores byte ranges"), ("shifted", "other bytes"), ("shorter", "other bytes"),
                            ("none", "other bytes")):
            with self.subTest(fault), range_server(data, f"later {fault}", name="a.tif") as (url, _):
                done = self.run_program("render", url, "-o", "x.png", *VIEW, "--cache", "off")
                self.assertIn(done.returncode, (FAILED, DONE_IN_PART), done.stderr)
                self.assertIn(url, done.stderr)
                self.assertIn(says, done.stderr)

    def test_layouts_that_cannot_be_read_by_parts(self):
        gdal("gdal_create", "-q", "-outsize", 43200, 21600, "-bands", 1, *PLANET, "-co", "SPARSE_OK=YES", "-co", "COMPRESS=LZW",
             "-co", "BLOCKYSIZE=16", self.folder / "strips.tif")
        gdal("gdal_create", "-q", "-outsize", 8192, 4096, "-bands", 1, *PLANET, "-co", "TILED=YES", "-co", "COMPRESS=DEFLATE",
             self.folder / "flat.tif")
        for name, says in (("strips.tif", "strips"), ("flat.tif", "overviews")):
            with self.subTest(name), range_server((self.folder / name).read_bytes(), name=name) as (url, _):
                self.assert_fails(FAILED, "render", url, "-o", "x.png", *VIEW, "--cache", "off",
                                  says=[url, says, "gdal_translate -of COG"])

    @staticmethod
    def two_to_the_31_tiles():
        """A BigTIFF of 2^20 x 2^19 pixels in tiles of 16, whose table would have 16 GiB, three empty overviews, and a
        whole one."""
        def directory(at, following, kind, width, height, side, offsets, sizes):
            entries = [(254, 4, 1, kind), (256, 4, 1, width), (257, 4, 1, height), (258, 3, 1, 8), (259, 3, 1, 1),
                       (262, 3, 1, 1), (277, 3, 1, 1), (322, 4, 1, side), (323, 4, 1, side), (324, 16, *offsets),
                       (325, 16, *sizes)]
            body = b"".join(struct.pack("<HHQQ", *entry) for entry in entries)
            return struct.pack("<Q", len(entries)) + body + struct.pack("<Q", following)

        tiles, tables, nothing = 1 << 31, 4096, 1 << 18
        first = directory(16, 512, 0, 1 << 20, 1 << 19, 16, (tiles, 1 << 24), (tiles, 1 << 35))
        overviews = (directory(512, 1024, 1, 1 << 19, 1 << 18, 4096, (8192, nothing), (8192, nothing)),
                     directory(1024, 1536, 1, 1 << 15, 1 << 14, 1024, (512, nothing), (512, nothing)),
                     directory(1536, 2048, 1, 1 << 11, 1 << 10, 1024, (2, nothing), (2, nothing)),
                     directory(2048, 0, 1, 512, 256, 256, (2, tables), (2, tables + 16)))
        data = struct.pack("<2sHHHQ", b"II", 43, 8, 0, 16) + first
        for overview in overviews:
            data = data.ljust((len(data) + 511) // 512 * 512, b"\0") + overview
        data = data.ljust(tables, b"\0") + struct.pack("<QQQQ", 8192, 8192 + 65536, 65536, 65536)
        return (data.ljust(8192, b"\0") + bytes(range(256)) * 512).ljust(nothing + 8192 * 8, b"\0")

    def test_hostile_files_are_named(self):
        good = self.planet(width=512)
        first = struct.unpack_from("<I", good, 4)[0]
        entries = [first + 2 + 12 * n for n in range(struct.unpack_from("<H", good, first)[0])]
        tags = {struct.unpack_from("<H", good, at)[0]: at for at in entries}

        def changed(*changes):
            data = bytearray(good)
            for layout, at, *values in changes:
                struct.pack_into(layout, data, at, *values)
            return bytes(data)

        offsets = struct.unpack_from("<I", good, tags[324] + 8)[0]
        count = struct.unpack_from("<I", good, tags[324] + 4)[0]
        cases = {
            "no TIFF": (b"<html>" + bytes(1000), "no raster"),
            "head alone": (good[:8], "TIFF directory"),
            "cut in the directory": (good[:first + 30], "TIFF"),
            "cut in the tiles": (good[:-len(good) // 2], "beyond the end"),
            "no width": (changed(("<HHI", tags[256] + 2, 2, 1, 0)), ""),
            "2^31 pixels": (changed(("<HII", tags[256] + 2, 4, 1, 1 << 31)), "Too large image size"),
            "tiles of 2^31": (changed(("<HII", tags[322] + 2, 4, 1, 1 << 31)), ""),
            "offsets of a wrong type": (changed(("<H", tags[324] + 2, 2)), ""),
            "offsets beyond the end": (changed(*(("<I", offsets + 4 * n, 0xFFFFFF00) for n in range(count))),
                                       "beyond the end"),
            "2^31 tiles": (self.two_to_the_31_tiles(), "Too many blocks"),
            "one tile's bytes for all": (changed(*(("<I", offsets + 4 * n, 8) for n in range(count))), "do not decode"),
        }
        for name, (data, says) in cases.items():
            with self.subTest(name), range_server(data, name="a.tif") as (url, _):
                self.assert_named(url, says)
            with self.subTest(name + ", local"):
                (self.folder / "a.tif").write_bytes(data)
                self.assert_named("a.tif", "")
                self.assert_named("a.tif", "", "--bounds=-180,-90,180,90")

    def assert_named(self, source, says, *options):
        done = self.run_program("render", source, *options, "-o", "x.png", *VIEW, "--cache", "off", "--camera", CLOSE)
        self.assertIn(done.returncode, (FAILED, DONE_IN_PART), f"{options}\n{done.stdout}{done.stderr}")
        self.assertIn("a.tif", done.stderr)
        self.assertIn(says, done.stderr)
        for internal in "terminate called", "Sanitizer", "std::":
            self.assertNotIn(internal, done.stderr)


if __name__ == "__main__":
    unittest.main()
