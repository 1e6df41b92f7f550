"""A COG on a server: shown by ranges, kept in a cache, preloaded, refused with a reason. The truth is the same file on disk."""

import contextlib
import json
import struct
import subprocess
import sys
import unittest

from georeferenced import gdal, make
from program import DONE, DONE_IN_PART, FAILED, SOURCE, ProgramTest
from range_server import range_server

sys.path.insert(0, str(SOURCE / "tests/preload"))
import servers  # noqa: E402

VIEW = ("--unlit", "--sky", "off", "--size", "256x256")
WHOLE = "20,10,9000000"
NEAR = "40,10,700000"
FAR = "-40,-150,700000"  # not in the view of the whole
PLANET = ("-a_srs", "EPSG:4326", "-a_ullr", "-180", "90", "180", "-90")
HEAD = 32768


class RemoteTiffTest(ProgramTest):
    def planet(self, *options, name="a.tif", width=2048):
        """A COG of the whole planet with tiles of 128 pixels, whose finest level has 128 tiles."""
        plain = make(self.folder / "plain.tif", width, width // 2, *PLANET)
        gdal("gdal_translate", "-q", "-of", "COG", "-co", "BLOCKSIZE=128", *options, plain, self.folder / name)
        plain.unlink()
        return (self.folder / name).read_bytes()

    def shot(self, source, *options, camera=WHOLE, code=DONE):
        done = self.run_program("render", source, "-o", "shot.png", "--camera", camera, *VIEW, *options)
        self.assertEqual(done.returncode, code, f"{source}\n{done.stdout}{done.stderr}")
        return (self.folder / "shot.png").read_bytes(), done.stderr

    def pixels(self, source, *options, **others):
        return self.shot(source, *options, **others)[0]


class ShownTest(RemoteTiffTest):
    def test_few_requests_then_none_then_offline(self):
        with range_server(self.planet(), name="a.tif") as (url, server):
            whole = self.pixels(url, "--cache", "c.gpkg")
            cold = list(server.asked)
            before = next(i for i, (first, last) in enumerate(cold) if (first, last + 1 - first) not in
                          {(n * HEAD, HEAD) for n in range(100)})
            self.assertLessEqual(before, 3, cold)
            self.assertLessEqual(sum(last + 1 - first for first, last in cold[:before]), 128 << 10, cold)
            self.assertEqual(len(set(cold)), len(cold), "a range was requested twice")
            self.assertEqual(self.pixels(url, "--cache", "c.gpkg"), whole)
            self.assertEqual(len(server.asked), len(cold), "the second run asked the server")
        self.assertEqual(self.pixels(url, "--cache", "c.gpkg", "--offline"), whole)
        # What was never looked at is drawn from what was.
        self.shot(url, "--cache", "c.gpkg", "--offline", camera=FAR, code=DONE_IN_PART)

    def test_neighbours_are_one_request(self):
        """The view needs some four tiles of the COG for each of its own; rows of a COG lie one after the other."""
        with range_server(self.planet(), name="a.tif", latency_s=0.02) as (url, server):
            told = json.loads(self.assert_done("render", url, "-o", "x.png", "--camera", WHOLE, "--cache", "off", "--json",
                                               "--unlit", "--sky", "off", "--size", "1024x1024").stdout)
            self.assertGreater(told["tiles_asked"], 10)
            self.assertLessEqual(len(server.asked), told["tiles_asked"] + 3, "more than one request a tile")

    def test_a_large_table_is_read_by_parts(self):
        """The table of the 14,280 tiles of the finest level has 170 kB. No tile is stored, so all requests are of tables."""
        gdal("gdal_create", "-q", "-outsize", 43200, 21600, "-bands", 1, "-ot", "Byte", *PLANET, "-co", "TILED=YES", "-co",
             "SPARSE_OK=YES", self.folder / "empty.tif")
        gdal("gdal_translate", "-q", "-of", "COG", "-co", "SPARSE_OK=TRUE", "-co", "BLOCKSIZE=256", "-co", "BIGTIFF=YES",
             "-co", "OVERVIEW_RESAMPLING=NEAREST", self.folder / "empty.tif", self.folder / "a.tif")
        with range_server((self.folder / "a.tif").read_bytes(), name="a.tif") as (url, server):
            self.pixels(url, "--cache", "off")
            self.assertLessEqual(len(server.asked), 3)
            self.assertLessEqual(sum(last + 1 - first for first, last in server.asked), 128 << 10)

    def test_no_name_and_other_endings(self):
        data = self.planet()
        with range_server(data, name="a.tif") as (url, _):
            truth = self.pixels(url, "--cache", "off")
        for name in "mosaic.TIFF", "download?id=7":
            with self.subTest(name), range_server(data, name=name) as (url, server):
                self.assertEqual(self.pixels(url, "--cache", "off"), truth)
                self.assertLess(server.asked[0][1], HEAD)

    def test_nginx_over_http_2(self):
        data = self.planet()
        served = self.folder / "served"
        served.mkdir()
        (served / "a.tif").write_bytes(data)
        with range_server(data, name="a.tif") as (url, _):
            truth = self.pixels(url, "--cache", "off")
        with servers.nginx(served) as server:
            for template in server.template, server.tls_template:
                url = template.replace("{z}/{x}/{y}.jpg", "a.tif")
                environment = {"CURL_CA_BUNDLE": server.ca_file, "SSL_CERT_FILE": server.ca_file}
                done = self.run_program("render", url, "-o", "shot.png", "--camera", WHOLE, *VIEW, "--cache", "off",
                                        environment=environment)
                if template == server.template or done.returncode == DONE:
                    self.assertEqual((self.folder / "shot.png").read_bytes(), truth, done.stderr)

    def test_info(self):
        with range_server(self.planet(), name="a.tif") as (url, _):
            told = self.assert_done("info", url).stdout
        for text in "a.tif", "west -180", "north 90":
            self.assertIn(text, told)


class VersionTest(RemoteTiffTest):
    def test_a_file_that_changes_between_runs_is_noticed(self):
        first, second = self.planet(), self.planet("-co", "COMPRESS=LZW", "-scale", "0", "255", "255", "0")
        options = ("--cache", "c.gpkg")
        with range_server(first, name="a.tif") as (url, server):
            old = self.pixels(url)
            self.pixels(url, *options)
            server.data, server.tag = second, '"two"'
            # The cache is fresh, so the server is not asked; but a tile that is not in it is refused.
            _, told = self.shot(url, camera=FAR, code=DONE_IN_PART)
            self.assertIn("a.tif", told)
            self.assertIn("has changed on the server", told)
            # The next run asks, and begins anew.
            new, told = self.shot(url)
            self.assertIn("has changed on the server", told)
            self.assertNotEqual(new, old)
            self.assertEqual(self.pixels(url, "--cache", "off"), new)
            # A cache that the user named is not deleted.
            self.shot(url, *options, camera=FAR, code=DONE_IN_PART)
            self.assert_fails(FAILED, "render", url, "-o", "x.png", *VIEW, *options, says=["c.gpkg", "earlier version"])

    def test_a_file_that_changes_midway_is_noticed(self):
        for fault in "changes", "412":
            with self.subTest(fault), range_server(self.planet(), fault, name="a.tif") as (url, _):
                done = self.run_program("render", url, "--cache", "off", "-o", "x.png", *VIEW)
                self.assertIn(done.returncode, (FAILED, DONE_IN_PART), done.stderr)
                self.assertIn("has changed on the server", done.stderr)


class PreloadTest(RemoteTiffTest):
    def test_a_region_is_kept_and_shown_offline(self):
        with range_server(self.planet(), name="a.tif") as (url, server):
            truth = self.pixels(url, "--cache", "off", camera=NEAR)
            server.asked.clear()
            done = self.assert_done("preload", url, "--bbox", "0,30,20,50", "-o", "c.gpkg")
            some = len(server.asked)
            self.assertLess(sum(last + 1 - first for first, last in server.asked), 0.6 * len(server.data), done.stdout)
            self.assert_done("preload", url, "--bbox", "0,30,20,50", "-o", "c.gpkg")
            self.assertEqual(len(server.asked), some, "a second preload asked the server")
            self.assert_done("preload", url, "-o", "all.gpkg")
        self.assertEqual(self.pixels(url, "--cache", "c.gpkg", "--offline", camera=NEAR), truth)
        self.assert_fails(FAILED, "render", "c.gpkg", "-o", "x.png", says=["c.gpkg", "--offline"])

    def test_dry_run_makes_no_file(self):
        with range_server(self.planet(), name="a.tif") as (url, _):
            told = self.assert_done("preload", url, "--bbox", "0,30,20,50", "--dry-run", "-o", "c.gpkg").stdout
            self.assertIn("tiles", told)
        self.assertFalse((self.folder / "c.gpkg").exists())


class CutTest(RemoteTiffTest):
    def test_the_cut_is_that_of_the_file(self):
        data = self.planet()
        self.assert_done("cut", "a.tif", "-o", "truth", "--format", "png")
        with range_server(data, name="a.tif", latency_s=0.005) as (url, server):
            self.assert_done("cut", url, "-o", "tiles", "--format", "png")
            self.assertLess(len(server.asked), 64, "128 tiles in rows of 16")
        tiles = sorted(path.relative_to(self.folder / "truth") for path in (self.folder / "truth").glob("*/*/*.png"))
        self.assertGreater(len(tiles), 40)
        for tile in tiles:
            self.assertEqual((self.folder / "tiles" / tile).read_bytes(), (self.folder / "truth" / tile).read_bytes(), tile)

    def test_what_cannot_be_cut_is_named(self):
        with range_server(self.planet(), name="a.tif") as (url, _):
            self.assert_fails(FAILED, "cut", url, url, "-o", "tiles", says=["alone"])
            self.assert_fails(FAILED, "cut", url, "--elevation", "-o", "tiles", says=["a.tif", "download"])
        self.assert_fails(FAILED, "cut", "http://127.0.0.1:1/a.tif", "-o", "tiles", says=["127.0.0.1"])


class RefusedTest(RemoteTiffTest):
    def test_faults_of_the_server_are_named(self):
        data = self.planet()
        for fault, says in (("whole", "ignores byte ranges"), ("endless", "ignores byte ranges"),
                            ("shifted", "other bytes"), ("shorter", "other bytes"), ("nonsense", "other bytes"),
                            ("none", "other bytes")):
            with self.subTest(fault), range_server(data, fault, name="a.tif") as (url, handler):
                self.assert_fails(FAILED, "render", url, "-o", "x.png", *VIEW, "--cache", "off", says=[url, says])
                self.assertLessEqual(handler.count, 3)

    def test_layouts_that_cannot_be_read_by_parts(self):
        make(self.folder / "strips.tif", 64, 32, *PLANET)
        make(self.folder / "flat.tif", 8192, 4096, *PLANET, "-co", "TILED=YES", "-co", "COMPRESS=DEFLATE")
        for name, says in (("strips.tif", "strips"), ("flat.tif", "overviews")):
            with self.subTest(name), range_server((self.folder / name).read_bytes(), name=name) as (url, _):
                self.assert_fails(FAILED, "render", url, "-o", "x.png", *VIEW, "--cache", "off",
                                  says=[url, says, "gdal_translate -of COG"])

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
            "no TIFF": (b"<html>" + bytes(1000), "not a TIFF"),
            "head alone": (good[:8], "not a TIFF"),
            "cut in the directory": (good[:first + 30], "TIFF"),
            "cut in the tiles": (good[:-len(good) // 2], "beyond the end"),
            "directories in a circle": (changed(("<I", entries[-1] + 12, first)), "circle"),
            "no width": (changed(("<HHI", tags[256] + 2, 2, 1, 0)), ""),
            "2^31 pixels": (changed(("<HII", tags[256] + 2, 4, 1, 1 << 31)), "too many"),
            "tiles of 2^31": (changed(("<HII", tags[322] + 2, 4, 1, 1 << 31)), ""),
            "offsets of a wrong type": (changed(("<H", tags[324] + 2, 2)), ""),
            "offsets beyond the end": (changed(*(("<I", offsets + 4 * n, 0xFFFFFF00) for n in range(count))),
                                       "beyond the end"),
            "one tile's bytes for all": (changed(*(("<I", offsets + 4 * n, 8) for n in range(count))), "cannot be read"),
        }
        for name, (data, says) in cases.items():
            with self.subTest(name), range_server(data, name="a.tif") as (url, _):
                done = self.run_program("render", url, "-o", "x.png", *VIEW, "--cache", "off", "--camera", NEAR)
                self.assertIn(done.returncode, (FAILED, DONE_IN_PART), f"{name}\n{done.stdout}{done.stderr}")
                self.assertIn("a.tif", done.stderr)
                self.assertIn(says, done.stderr)
                for internal in "terminate called", "Sanitizer", "std::":
                    self.assertNotIn(internal, done.stderr)


if __name__ == "__main__":
    unittest.main()
