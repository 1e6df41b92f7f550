"""A COG on a server: shown by ranges, kept in a cache, preloaded, refused with a reason. The truth is the same file on disk."""

import json
import struct
import subprocess
import unittest

import servers
from georeferenced import gdal, make
from program import DONE, DONE_IN_PART, FAILED, ProgramTest
from range_server import range_server

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


def directories(data):
    """The tags of each directory of a classic little-endian TIFF: how their numbers are packed, how many, where they are."""
    at, = struct.unpack_from("<I", data, 4)
    while at:
        count, = struct.unpack_from("<H", data, at)
        tags = {}
        for entry in range(at + 2, at + 2 + 12 * count, 12):
            tag, kind, values = struct.unpack_from("<HHI", data, entry)
            layout = {3: "<H", 4: "<I"}.get(kind, "<B")
            inside = values * struct.calcsize(layout) <= 4
            tags[tag] = layout, values, entry + 8 if inside else struct.unpack_from("<I", data, entry + 8)[0]
        yield tags
        at, = struct.unpack_from("<I", data, at + 2 + 12 * count)


def tiles_in(data):
    """First and last byte of each tile in a TIFF."""
    for tags in directories(data):
        offsets, sizes = ([number for number, in struct.iter_unpack(layout, data[at : at + values * struct.calcsize(layout)])]
                          for layout, values, at in (tags[324], tags[325]))
        yield from ((offset, offset + size - 1) for offset, size in zip(offsets, sizes) if size)


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
        # Parts that were never looked at are drawn from parts that were.
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

    def test_nginx_20_ms_away(self):
        """The delay is that of a server behind a real nginx, whose log has the requests.

        Tiles of 16 KiB are more than what a request may read between the tiles it is for (4 KiB), so none comes twice.
        """
        with range_server(self.planet("-co", "COMPRESS=NONE"), name="a.tif", latency_s=0.02) as (behind, server):
            port = behind.split(":")[2].split("/")[0]
            with servers.nginx(self.folder, "--pass", port) as front:
                url = front.template.replace("{z}/{x}/{y}.jpg", "a.tif")
                look = ("-o", "x.png", *VIEW, "--camera", WHOLE, "--cache", "c.gpkg")
                self.assert_done("render", url, *look)
                cold = list(server.asked)
                heads = [last + 1 - first for first, last in cold if first % HEAD == 0 and last + 1 - first == HEAD]
                self.assertLessEqual(len(heads), 3, cold)
                self.assertLessEqual(sum(heads), 128 << 10, cold)
                # The number of neighbours in one request depends on which of them are wanted at the same moment.
                self.assertGreaterEqual(len(cold) - len(heads), 2, cold)
                tiles = list(tiles_in(server.data))
                for first, last in cold[len(heads):]:
                    self.assertTrue(any(first <= tile[0] and tile[1] <= last for tile in tiles), f"{first}-{last}: no whole tile")
                for tile in tiles:
                    asked = [span for span in cold[len(heads):] if span[0] <= tile[1] and tile[0] <= span[1]]
                    self.assertLessEqual(len(asked), 1, f"tile {tile}: {asked}")
                self.assert_done("render", url, *look)
                self.assertEqual(front.requests(), [(206, "/a.tif")] * len(cold))

    def test_tiles_whose_bytes_overlap(self):
        """Each tile claims bytes of the next one too. A decoder needs only its own."""
        data = bytearray(self.planet("-co", "COMPRESS=DEFLATE", "-co", "OVERVIEWS=NONE", width=1024))
        layout, count, at = next(directories(data))[325]
        each = struct.calcsize(layout)
        for n in range(count - 1):
            size, = struct.unpack_from(layout, data, at + n * each)
            struct.pack_into(layout, data, at + n * each, size + 100)
        truth = self.pixels("a.tif")
        with range_server(bytes(data), name="a.tif") as (url, _):
            self.assertEqual(self.pixels(url, "--cache", "c.gpkg"), truth)
        self.assertEqual(self.pixels(url, "--cache", "c.gpkg", "--offline"), truth)

    def test_info(self):
        with range_server(self.planet(), name="a.tif") as (url, _):
            told = self.assert_done("info", url).stdout
        for text in "a.tif", "west -180", "north 90":
            self.assertIn(text, told)


class StripsTest(RemoteTiffTest):
    def test_strips_are_read_by_parts(self):
        make(self.folder / "plain.tif", 4096, 2048, *PLANET)
        gdal("gdal_translate", "-q", "-co", "BLOCKYSIZE=16", self.folder / "plain.tif",
             self.folder / "a.tif")
        gdal("gdaladdo", "-q", "-r", "average", self.folder / "a.tif", 4, 16)
        gdal("gdal_translate", "-q", "-co", "TILED=YES", "-co", "COPY_SRC_OVERVIEWS=YES", self.folder / "a.tif",
             self.folder / "tiled.tif")
        truth = self.pixels("tiled.tif", camera=NEAR)
        with range_server((self.folder / "a.tif").read_bytes(), name="a.tif") as (url, server):
            self.assertEqual(self.pixels(url, "--cache", "off", camera=NEAR), truth)
            self.assertLess(sum(last + 1 - first for first, last in server.asked), 0.4 * len(server.data))
            self.assertLess(len(server.asked), 16)

    def test_one_strip_is_one_block(self):
        make(self.folder / "plain.tif", 512, 256, *PLANET)
        gdal("gdal_translate", "-q", "-co", "COMPRESS=LZW", "-co", "BLOCKYSIZE=256", self.folder / "plain.tif",
             self.folder / "a.tif")
        gdal("gdal_translate", "-q", "-co", "TILED=YES", self.folder / "plain.tif", self.folder / "tiled.tif")
        with range_server((self.folder / "a.tif").read_bytes(), name="a.tif") as (url, server):
            self.assertEqual(self.pixels(url, "--cache", "off"), self.pixels("tiled.tif"))
            self.assertLessEqual(len(server.asked), 3)


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
        with range_server(self.planet("-b", "1", "-b", "1", "-b", "1", "-colorinterp", "red,green,blue"), name="a.tif") as (url, _):
            self.assert_fails(FAILED, "cut", url, "--elevation", "-o", "tiles", says=["a.tif", "a picture in colours"])
        self.assert_fails(FAILED, "cut", "http://127.0.0.1:1/a.tif", "-o", "tiles", says=["127.0.0.1"])


if __name__ == "__main__":
    unittest.main()
