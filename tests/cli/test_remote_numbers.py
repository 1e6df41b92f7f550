"""Rasters of numbers on a server: shown, described, cut, preloaded and raised like the same file on disk."""

import json
import unittest

from program import FAILED
from range_server import range_server
from test_numbers import CODES, LOOK, TEMPERATURE, NumbersTest, gdal

CAMERA = ("--camera", "10,20,9000000")
DELAY_S = 0.02


class RemoteNumbersTest(NumbersTest):
    def cog(self, kind, value, *options, name="a.tif", size=(512, 256), **others):
        """A COG with tiles of 128 pixels."""
        self.raster("plain.tif", kind, value, *options, size=size, **others)
        gdal("gdal_translate", "-q", "-of", "COG", "-co", "BLOCKSIZE=128", "-co", "RESAMPLING=AVERAGE",
             self.folder / "plain.tif", self.folder / name)
        return (self.folder / name).read_bytes()

    def temperature(self, *options):
        gdal("gdal_translate", "-q", "-of", "COG", "-co", "BLOCKSIZE=128", *options, TEMPERATURE, self.folder / "a.tif")
        return (self.folder / "a.tif").read_bytes()

    def shot(self, *options):
        done = self.assert_done("render", *options, *LOOK)
        return (self.folder / "out.png").read_bytes(), done.stderr


def wave(x, y, band):
    return (x * 7 + y * 3 + 40 * band) % 251


class Shown(RemoteNumbersTest):
    def test_each_type_looks_as_the_file_does(self):
        for kind in CODES:
            data = self.cog(kind, lambda x, y, b: (int if kind not in ("Float32", "Float64") else float)(wave(x, y, b)))
            options = ("--colormap", "viridis") if kind == "Byte" else ()
            with self.subTest(kind), range_server(data, name="a.tif") as (url, _):
                here, said = self.shot("a.tif", *CAMERA, *options)
                there, told = self.shot(url, *CAMERA, *options)
                self.assertEqual(there, here)
                self.assertEqual(told.replace(url, "a.tif"), said)
                self.assertIn("viridis", told)

    def test_options_are_those_of_a_file(self):
        data = self.cog("UInt16", lambda x, y, b: 900 + wave(x, y, b), bands=3)
        with range_server(data, name="a.tif") as (url, _):
            for options in (("--colormap", "magma", "--stretch", "900,1100", "--band", "2"), ("--nodata", "901", "--band", "1"),
                            ("--bands", "3,1,2")):
                with self.subTest(options):
                    self.assertEqual(self.shot(url, *CAMERA, *options)[0], self.shot("a.tif", *CAMERA, *options)[0])
            self.assert_fails(FAILED, "render", url, "--band", "4", *LOOK, says=[url, "3 bands", "band 4"])

    def test_few_requests_then_none_then_offline(self):
        data = self.temperature()
        with range_server(data, name="a.tif", latency_s=DELAY_S) as (url, server):
            look = ("-o", "out.png", "--size", "256x256", "--unlit", *CAMERA, "--cache", "c.gpkg")
            told = json.loads(self.assert_done("render", url, *look, "--json").stdout)
            cold = list(server.asked)
            self.assertEqual(cold[0], (0, 32767))
            # The file's tiles have 128 pixels, four to one of the globe's. Requests for neighbours are merged if they come in
            # time, which a busy machine may miss. No byte is asked for twice.
            self.assertLessEqual(len(cold), 3 + 4 * told["tiles_asked"])
            ends = sorted(cold)
            self.assertTrue(all(a[1] < b[0] for a, b in zip(ends, ends[1:])), cold)
            truth = (self.folder / "out.png").read_bytes()
            self.assert_done("render", url, *look)
            self.assertEqual(len(server.asked), len(cold), "the second run asked the server")
            self.assertEqual((self.folder / "out.png").read_bytes(), truth)
        self.assert_done("render", url, *look, "--offline")
        self.assertEqual((self.folder / "out.png").read_bytes(), truth)

    def test_a_file_that_changes_midway_is_named(self):
        with range_server(self.temperature(), "changes", name="a.tif") as (url, _):
            self.assert_fails(FAILED, "render", url, *LOOK, says=["a.tif", "has changed on the server"])


class Described(RemoteNumbersTest):
    def test_info_says_what_it_says_of_the_file(self):
        data = self.temperature()
        with range_server(data, name="a.tif") as (url, server):
            for options in ((), ("--json",), ("--band", "1", "--nodata", "20")):
                told = self.assert_done("info", url, *options).stdout
                said = self.assert_done("info", "a.tif", *options).stdout
                self.assertEqual(told.replace(f"'{url}'", "a.tif").replace(url, "a.tif"), said)
            self.assertLess(server.count, 3 * 5)

    def test_info_of_what_cannot_be_shown(self):
        gdal("gdal_create", "-q", "-outsize", 43200, 21600, "-bands", 1, "-ot", "Float32", "-a_srs", "EPSG:4326", "-a_ullr",
             -180, 90, 180, -90, "-co", "SPARSE_OK=YES", "-co", "BLOCKYSIZE=64", "-co", "COMPRESS=DEFLATE",
             self.folder / "a.tif")
        with range_server((self.folder / "a.tif").read_bytes(), name="a.tif") as (url, server):
            told = json.loads(self.assert_done("info", url, "--json").stdout)
            self.assertEqual((told["width_px"], told["shown"]), (43200, False))
            self.assertIn("gdal_translate -of COG", told["refused"])
            self.assertLess(sum(last + 1 - first for first, last in server.asked), 128 << 10)

    def test_files_beside_are_not_asked_for_and_that_is_said(self):
        self.raster("plain.tif", "Float32", lambda x, y, b: float(x), "-co", "TILED=YES", size=(48, 36))
        gdal("gdal_translate", "-q", "-co", "PROFILE=BASELINE", "-co", "TILED=YES", self.folder / "plain.tif",
             self.folder / "a.tif")
        with range_server((self.folder / "a.tif").read_bytes(), name="a.tif") as (url, _):
            for command in ("render", url, *LOOK), ("cut", url, "-o", "out.gpkg"):
                self.assert_fails(FAILED, *command, says=[url, "files beside it", "--bounds"])
        gdal("gdal_translate", "-q", "-co", "PROFILE=BASELINE", "-co", "TILED=YES", TEMPERATURE, self.folder / "b.tif")
        with range_server((self.folder / "b.tif").read_bytes(), name="b.tif") as (url, _):
            for command in ("render", url, *LOOK), ("cut", url, "-o", "out.gpkg"):
                self.assertIn("taken for a whole planet", self.assert_done(*command).stderr)


class Heights(RemoteNumbersTest):
    SCENE = ("--exaggeration", "30", "--camera", "10,20,3000000,0,-50")

    def test_heights_are_those_of_the_file(self):
        self.heights("a.tif", "m", 1.0)
        flat, _ = self.shot(*self.SCENE)
        here, _ = self.shot("--elevation", "a.tif", *self.SCENE)
        with range_server((self.folder / "a.tif").read_bytes(), name="a.tif") as (url, _):
            there, _ = self.shot("--elevation", url, *self.SCENE)
        self.assertGreater(self.differing(here, flat), 0.2)
        self.assertLess(self.differing(here, there), 0.02)

    def heights(self, name, unit, factor):
        self.cog("Float32", lambda x, y, b: (x + y) % 150 * 40.0 / factor, size=(256, 128), name=name)
        gdal("gdal_edit.py", "-units", unit, self.folder / name)

    def differing(self, one, other):
        """Share of pixels that differ by more than 8."""
        values = []
        for name, picture in (("one", one), ("other", other)):
            self.write(f"{name}.png", picture)
            gdal("gdal_translate", "-q", "-of", "ENVI", self.folder / f"{name}.png", self.folder / f"{name}.raw")
            values.append((self.folder / f"{name}.raw").read_bytes())
        return sum(abs(a - b) > 8 for a, b in zip(*values)) / len(values[0])

    def test_units_of_length_are_metres_and_others_refused(self):
        shots = []
        for unit, factor in (("ft", 0.3048), ("m", 1.0)):
            self.heights("a.tif", unit, factor)
            with range_server((self.folder / "a.tif").read_bytes(), name="a.tif") as (url, _):
                shots.append(self.shot("--elevation", url, *self.SCENE)[0])
        self.assertLess(self.differing(*shots), 0.02)
        with range_server(self.temperature(), name="a.tif") as (url, _):
            self.assert_fails(FAILED, "render", "--elevation", url, *LOOK, says=[url, "°C"])


class Kept(RemoteNumbersTest):
    def test_a_cut_has_the_values_of_the_file(self):
        for kind, number, extra in (("UInt16", int, ()), ("Int16", int, ("--elevation",)), ("Float32", float, ()),
                                    ("Float32", float, ("--elevation",))):
            data = self.cog(kind, lambda x, y, b: number(wave(x, y, b)), "-a_nodata", "7")
            with self.subTest((kind, extra)), range_server(data, name="a.tif") as (url, _):
                self.assert_done("cut", url, "-o", "there.gpkg", "--force", *extra)
                band, = json.loads(gdal("gdalinfo", "-json", self.folder / "there.gpkg"))["bands"]
                self.assertEqual(band["type"], kind)
                for lon, lat in ((-150.5, 2.5), (10.5, 22.5), (0.5, 0.5), (179.5, -60.5), (-179.9, 89.9)):
                    place = ("gdallocationinfo", "-valonly", "-wgs84")
                    self.assertAlmostEqual(float(gdal(*place, self.folder / "there.gpkg", lon, lat)),
                                           float(gdal(*place, self.folder / "a.tif", lon, lat)), places=3)

    def test_a_preload_keeps_what_the_stretch_needs(self):
        data = self.cog("Float32", lambda x, y, b: float(x), size=(2048, 1024))
        look = ("--camera", "40,10,300000")
        with range_server(data, name="a.tif") as (url, server):
            truth, told = self.shot(url, *look)
            self.assert_done("preload", url, "--bbox", "0,30,20,50", "-o", "c.gpkg")
            fetched = server.count
        look_offline = tuple(o for o in LOOK if o not in ("--cache", "off")) + ("--cache", "c.gpkg", "--offline")
        done = self.assert_done("render", url, *look, *look_offline)
        self.assertEqual((self.folder / "out.png").read_bytes(), truth)
        self.assertEqual(done.stderr, told)
        self.assertGreater(fetched, 1)


if __name__ == "__main__":
    unittest.main()
