"""Rasters of numbers: floats and 16 bits keep their values when they are shown, cut and described."""

import array
import json
import math
import unittest

from georeferenced import gdal
from program import BLUE_MARBLE, DONE, FAILED, SOURCE, WRONG_USAGE, ProgramTest

TEMPERATURE = SOURCE / "data/ocean/sea_surface_temperature.tif"
LOOK = ("-o", "out.png", "--size", "128x128", "--unlit", "--cache", "off")
# The camera looks straight down, so the place is the middle of the picture.
PACIFIC, SOUTHERN_OCEAN, SAHARA = "2,-150,300000", "-60,-120,300000", "22,10,300000"
CODES = {"Byte": "B", "Int16": "h", "UInt16": "H", "Float32": "f", "Float64": "d"}


class NumbersTest(ProgramTest):
    def raster(self, name, kind, value, *options, size=(72, 36), bands=1, place=(-180, 90, 180, -90)):
        """Writes a TIFF whose samples are value(column, row, band)."""
        width, height = size
        data = array.array(CODES[kind], (value(x, y, b) for b in range(bands) for y in range(height)
                                         for x in range(width)))
        self.write("raw.bin", data.tobytes())
        each = data.itemsize
        rows = "".join(
            f'<VRTRasterBand dataType="{kind}" band="{b + 1}" subClass="VRTRawRasterBand">'
            f'<SourceFilename relativetoVRT="1">raw.bin</SourceFilename><ByteOrder>LSB</ByteOrder>'
            f'<ImageOffset>{b * width * height * each}</ImageOffset><PixelOffset>{each}</PixelOffset>'
            f'<LineOffset>{width * each}</LineOffset><UnitType>K</UnitType></VRTRasterBand>' for b in range(bands))
        self.write("raw.vrt", f'<VRTDataset rasterXSize="{width}" rasterYSize="{height}">{rows}</VRTDataset>'.encode())
        gdal("gdal_translate", "-q", "-a_srs", "EPSG:4326", "-a_ullr", *place, *options, self.folder / "raw.vrt",
             self.folder / name)

    def middle(self):
        """The colour in the middle of out.png."""
        return [int(v) for v in gdal("gdallocationinfo", "-valonly", self.folder / "out.png", 64, 64).split()][:3]

    def render(self, *arguments):
        return self.assert_done("render", *arguments, *LOOK)


class Shown(NumbersTest):
    def test_each_type_by_default_in_viridis_from_its_percentiles(self):
        for kind, least, most in (("UInt16", 1000, 3520), ("Int16", -2000, 2000), ("Float32", 0.25, 0.75),
                                  ("Float64", -1e6, 1e6)):
            whole = kind in ("UInt16", "Int16")
            self.raster("in.tif", kind, lambda x, y, b: (int if whole else float)(least + (most - least) * x / 71))
            with self.subTest(kind):
                done = self.render("in.tif", "--camera", "10,-170,300000")
                self.assertIn("viridis", done.stderr)
                first = self.middle()
                self.render("in.tif", "--camera", "10,170,300000")
                last = self.middle()
                # viridis goes from dark violet to bright yellow.
                self.assertLess(max(abs(a - b) for a, b in zip(first, (68, 1, 84))), 16, first)
                if kind in ("Int16", "Float64"):
                    continue
                self.assertLess(max(abs(a - b) for a, b in zip(last, (253, 231, 37))), 16, last)

    def test_stretch_and_colour_table(self):
        self.write("steps.txt", b"# cold and warm\n-5 0 0 255\n15 0 0 255\n15 255 0 0\n40 255 0 0\nnv 0 0 0 0\n")
        for camera, colour in ((PACIFIC, [255, 0, 0]), (SOUTHERN_OCEAN, [0, 0, 255])):
            self.render(TEMPERATURE, "--colormap", "steps.txt", "--camera", camera)
            self.assertEqual(self.middle(), colour, camera)
        for stretch in ("0,30", "1-99", "sigma:2"):
            done = self.render(TEMPERATURE, "--colormap", "grey", "--stretch", stretch, "--camera", PACIFIC)
            self.assertGreater(self.middle()[0], 200, (stretch, done.stderr))

    def test_an_overlay_shows_the_layer_below_where_it_has_no_data(self):
        self.render("--camera", SAHARA)
        sahara = self.middle()
        self.render("--overlay", TEMPERATURE, "--colormap", "magma", "--camera", SAHARA)
        self.assertEqual(self.middle(), sahara)
        self.render("--overlay", TEMPERATURE, "--colormap", "magma", "--camera", PACIFIC)
        self.assertGreater(self.middle()[0], 240)

    def test_eight_bits_are_a_picture_unless_they_are_asked_for_as_numbers(self):
        self.raster("in.tif", "Byte", lambda x, y, b: 100 + y)
        self.render("in.tif", "--camera", "10,20,300000")
        red, green, blue = self.middle()
        self.assertTrue(red == green == blue and 100 < red < 140)
        self.render("in.tif", "--colormap", "viridis", "--camera", "10,20,300000")
        self.assertGreater(max(self.middle()) - min(self.middle()), 30)

    def test_bands_as_colours(self):
        self.raster("in.tif", "UInt16", lambda x, y, b: 1000 * (b + 1), bands=4)
        self.render("in.tif", "--bands", "4,1,2", "--stretch", "0,5000", "--camera", "10,20,300000")
        for is_, share in zip(self.middle(), (0.8, 0.2, 0.4)):
            self.assertAlmostEqual(is_, 255 * share, delta=3)
        self.render("in.tif", "--bands", "4,1,2", "--stretch", "0,4000", "--stretch", "0,1000", "--stretch", "0,8000",
                    "--camera", "10,20,300000")
        for is_, share in zip(self.middle(), (1.0, 1.0, 0.25)):
            self.assertAlmostEqual(is_, 255 * share, delta=3)
        self.render("in.tif", "--band", "3", "--stretch", "0,3000", "--colormap", "grey", "--camera", "10,20,300000")
        self.assertEqual(self.middle(), [255, 255, 255])

    def test_nodata_by_the_user(self):
        self.raster("in.tif", "Int16", lambda x, y, b: -999 if x < 36 else 20)
        self.render("in.tif", "--nodata", "-999", "--stretch", "0,20", "--colormap", "grey", "--camera", "0,90,300000")
        self.assertEqual(self.middle(), [255, 255, 255])
        self.render("--overlay", "in.tif", "--nodata", "-999", "--camera", "0,-90,300000")
        below = self.middle()
        self.render("--camera", "0,-90,300000")
        self.assertEqual(below, self.middle())

    def test_the_legend_is_drawn_into_the_lower_left(self):
        self.assert_done("render", TEMPERATURE, "--camera", PACIFIC, "--unlit", "--cache", "off", "--size", "512x512",
                         "-o", "plain.png")
        self.assert_done("render", TEMPERATURE, "--camera", PACIFIC, "--unlit", "--cache", "off", "--size", "512x512",
                         "-o", "legend.png", "--legend")
        plain, legend = (self.pixels(name) for name in ("plain.png", "legend.png"))
        differ = [i for i, (a, b) in enumerate(zip(plain, legend)) if a != b]
        columns, rows = [i % 512 for i in differ], [i // 512 for i in differ]
        self.assertGreater(len(differ), 5000)
        self.assertLess(max(columns), 320)
        self.assertGreater(min(rows), 400)

    def test_the_scale_bar_is_drawn_into_the_lower_right(self):
        """As long as the ground says: a camera straight down, 45° from the middle to the upper edge."""
        plain = ("render", TEMPERATURE, "--camera", "0,-140,512000,0,-90,90", "--unlit", "--cache", "off",
                 "--size", "512x512", "-o")
        self.assert_done(*plain, "plain.png")
        before = self.pixels("plain.png")
        for name, more, least_m in (("km.png", [], 200_000), ("mi.png", ["--units", "imperial"], 100 * 1609.344),
                                    ("nm.png", ["--units", "nautical"], 100 * 1852)):
            self.assert_done(*plain, name, "--scale-bar", *more)
            differ = [i for i, (a, b) in enumerate(zip(before, self.pixels(name))) if a != b]
            columns, rows = [i % 512 for i in differ], [i // 512 for i in differ]
            self.assertGreater(min(rows), 440)
            self.assertGreater(min(columns), 256)
            self.assertLess(max(columns), 511)
            panel_px = max(columns) - min(columns) + 1  # the bar with the padding of its panel
            self.assertGreater(panel_px, least_m / 2000)
            self.assertLess(panel_px, least_m / 2000 + 40)
        self.assert_fails(WRONG_USAGE, *plain, "no.png", "--units", "miles", says=["--units", "imperial"])

    def pixels(self, name):
        gdal("gdal_translate", "-q", "-of", "ENVI", "-co", "INTERLEAVE=BIP", self.folder / name, self.folder / "p.raw")
        data = (self.folder / "p.raw").read_bytes()
        each = len(data) // (512 * 512)
        return [data[i:i + each] for i in range(0, len(data), each)]


class Kept(NumbersTest):
    def test_a_cut_keeps_values_unit_and_no_data(self):
        self.assert_done("cut", TEMPERATURE, "-o", "out.gpkg")
        told = json.loads(gdal("gdalinfo", "-json", self.folder / "out.gpkg"))
        band, = told["bands"]
        self.assertEqual((band["type"], band["unit"], band["noDataValue"]), ("Float32", "°C", -9999))
        for lon, lat in ((-150.5, 2.5), (10.5, 22.5), (0.5, 0.5), (179.5, -60.5)):
            self.assertEqual(gdal("gdallocationinfo", "-valonly", "-wgs84", self.folder / "out.gpkg", lon, lat),
                             gdal("gdallocationinfo", "-valonly", "-wgs84", TEMPERATURE, lon, lat))

    def test_the_cut_set_looks_as_the_raster(self):
        for output in ("out.gpkg", "out"):
            self.assert_done("cut", TEMPERATURE, "-o", output)
            for camera in ("30,-60,6000000",):
                self.render(TEMPERATURE, "--stretch=-2,30", "--camera", camera)
                direct = (self.folder / "out.png").read_bytes()
                done = self.render(output, "--stretch=-2,30", "--camera", camera)
                self.assertIn("°C", done.stderr)
                if direct == (self.folder / "out.png").read_bytes():
                    continue
                gdal("gdal_translate", "-q", "-of", "ENVI", self.folder / "out.png", self.folder / "b.raw")
                self.write("a.png", direct)
                gdal("gdal_translate", "-q", "-of", "ENVI", self.folder / "a.png", self.folder / "a.raw")
                a, b = ((self.folder / n).read_bytes() for n in ("a.raw", "b.raw"))
                rms = math.sqrt(sum((x - y) ** 2 for x, y in zip(a, b)) / len(a))
                self.assertLess(rms, 0.3, (output, camera))

    def test_whole_numbers_stay_sixteen_bits(self):
        self.raster("in.tif", "UInt16", lambda x, y, b: 900 * y + x, "-a_nodata", "7")
        self.assert_done("cut", "in.tif", "-o", "out.gpkg", "--tile-size", "16")
        told = json.loads(gdal("gdalinfo", "-json", self.folder / "out.gpkg"))
        self.assertEqual(told["bands"][0]["type"], "UInt16")
        self.assertEqual(told["bands"][0]["unit"], "K")

    def test_a_format_asks_for_a_picture(self):
        self.raster("in.tif", "UInt16", lambda x, y, b: 1000 + 30 * x)
        self.assert_done("cut", "in.tif", "-o", "out.gpkg", "--format", "png")
        self.assertNotIn("elevation", json.loads(self.assert_done("info", "out.gpkg", "--json").stdout))
        self.assert_fails(FAILED, "cut", "in.tif", "-o", "b.gpkg", "--format", "jpg", "--band", "1",
                          says=["--format"])

    def test_info(self):
        told = json.loads(self.assert_done("info", TEMPERATURE, "--json").stdout)
        self.assertEqual((told["samples"], told["nodata"], told["unit"]), ("32-bit floats", -9999, "°C"))
        self.assertEqual(told["quantity"], "sea surface temperature")
        self.assertAlmostEqual(told["statistics"]["min"], -2.02, places=5)
        self.assertAlmostEqual(told["statistics"]["max"], 29.74, places=5)
        self.assertEqual(told["statistics"]["pixels_without_data"], 22636)
        text = self.assert_done("info", TEMPERATURE).stdout
        self.assertIn("statistics   -2.02", text)
        self.raster("in.tif", "Int16", lambda x, y, b: 10 * (b + 1), "-a_scale", "0.5", bands=3)
        told = json.loads(self.assert_done("info", "in.tif", "--band", "2", "--json").stdout)
        self.assertEqual(told["scale"], 0.5)
        self.assertAlmostEqual(told["statistics"]["mean"], 10.0, places=9)


class Refused(NumbersTest):
    def test_wrong_options(self):
        for option, text, says in (("--stretch", "5", "percent:2,98"), ("--stretch", "3,1", "MIN < MAX"),
                                   ("--colormap", "rainbow", "viridis"), ("--colormap", "viridis:3", "terrain"),
                                   ("--bands", "1,2", "4,3,2"), ("--bands", "0,1,2", "counted from 1"),
                                   ("--band", "0", "counted from 1|0.5|band's number")):
            done = self.run_program("render", TEMPERATURE, f"{option}={text}", *LOOK)
            self.assertEqual(done.returncode, WRONG_USAGE, (option, text, done.stderr))
            self.assertTrue(any(part in done.stderr for part in says.split("|")), done.stderr)

    def test_what_the_raster_does_not_have(self):
        self.assert_fails(FAILED, "render", TEMPERATURE, "--band", "2", *LOOK, says=["1 band", "band 2"])
        self.assert_fails(FAILED, "render", TEMPERATURE, "--bands", "1,1,3", *LOOK, says=["band 3"])
        self.assert_fails(FAILED, "render", BLUE_MARBLE, "--colormap", "magma", *LOOK, says=["gdal_translate"])
        self.write("bad.txt", b"0 black\n10 nocolour\n")
        self.assert_fails(FAILED, "render", TEMPERATURE, "--colormap", "bad.txt", *LOOK, says=["bad.txt: line 2"])
        self.assert_done("cut", BLUE_MARBLE, "-o", "earth.gpkg")
        self.assert_fails(FAILED, "render", "earth.gpkg", "--colormap", "magma", *LOOK, says=["are pictures"])
        self.assert_fails(FAILED, "render", "earth.gpkg", "--band", "1", *LOOK, says=["tile set"])


if __name__ == "__main__":
    unittest.main()
