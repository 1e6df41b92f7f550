"""Flat maps that `render --extent` writes: the place of each pixel, its colour, and what GDAL reads."""

import functools
import http.server
import json
import threading
import unittest

import numpy as np
from osgeo import gdal, osr

from program import DONE_IN_PART, FAILED, WRONG_USAGE, ProgramTest

gdal.UseExceptions()
osr.DontUseExceptions()  # places beyond a projection are infinite

# Limits of a map's place and colour.
OFF_PX = 0.05
RMS = 0.5
# Maps in four projections, two of them over a pole and over ±180°, one across the whole planet; and the waves' length
# there, degrees. In the last map a pixel is 0.6 degrees: its mean of shorter waves would differ from the formula's point.
MAPS = {
    "EPSG:3413": ((-3e6, -3e6, 3e6, 3e6), 6.0),
    "EPSG:3031": ((-2.5e6, -2e6, 2.5e6, 2e6), 6.0),
    "EPSG:32632": ((-1e6, 4e6, 2e6, 7e6), 6.0),
    "ESRI:54030": ((-17.2e6, -8.7e6, 17.2e6, 8.7e6), 24.0),
}


def painted(lon_deg, lat_deg, wave):
    """Three waves over the planet, without a seam at the poles and at ±180°; `wave` is their length in degrees."""
    lon, lat, k = np.radians(lon_deg), np.radians(lat_deg), 360.0 / wave
    x, y, z = np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)
    return np.stack([128 + 90 * np.sin(k * a + b) for a, b in ((x, 0.3), (y, 1.1), (z, 2.0))])


def planet(path, width, wave, dtype=np.uint8):
    """A plate carrée picture of the waves."""
    step = 360.0 / width
    lon, lat = np.meshgrid(-180 + step * (np.arange(width) + 0.5), 90 - step * (np.arange(width // 2) + 0.5))
    save(path, np.rint(painted(lon, lat, wave)).astype(dtype), "EPSG:4326", (-180, step, 0, 90, 0, -step))


def save(path, bands, crs, transform):
    kind = {np.dtype(np.uint8): gdal.GDT_Byte, np.dtype(np.float32): gdal.GDT_Float32}[bands.dtype]
    out = gdal.GetDriverByName("GTiff").Create(str(path), bands.shape[2], bands.shape[1], bands.shape[0], kind, ["TILED=YES"])
    system = osr.SpatialReference()
    system.SetFromUserInput(crs)
    out.SetSpatialRef(system)
    out.SetGeoTransform(transform)
    for number, band in enumerate(bands, 1):
        out.GetRasterBand(number).WriteArray(band)


def places(raster):
    """Longitudes and latitudes of the middles of a raster's pixels, by GDAL; infinite beyond the projection."""
    x0, dx, _, y0, _, dy = raster.GetGeoTransform()
    degrees = osr.SpatialReference()
    degrees.SetFromUserInput("EPSG:4326")
    degrees.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    system = raster.GetSpatialRef()
    system.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    x, y = np.meshgrid(x0 + dx * (np.arange(raster.RasterXSize) + 0.5), y0 + dy * (np.arange(raster.RasterYSize) + 0.5))
    points = np.stack([x.ravel(), y.ravel()], axis=1)
    found = np.array(osr.CoordinateTransformation(system, degrees).TransformPoints(points))
    return found[:, 0].reshape(x.shape), found[:, 1].reshape(x.shape)


def shift_px(error, truth):
    """The shift by which a picture lies beside the truth, least squares: error = gradient · shift."""
    by_row, by_column = np.gradient(truth, axis=(1, 2))
    inner = (slice(None), slice(2, -2), slice(2, -2))
    slopes = np.stack([by_column[inner].ravel(), by_row[inner].ravel()], axis=1)
    known = np.isfinite(slopes).all(axis=1) & np.isfinite(error[inner].ravel())
    return np.linalg.lstsq(slopes[known], error[inner].ravel()[known], rcond=None)[0]


class ExtentTest(ProgramTest):
    def open_map(self, name):
        return gdal.Open(str(self.folder / name))

    def test_pixels_lie_where_gdal_places_them(self):
        """In pixels and in levels of a byte, beside the formula of the planet."""
        for wave in (6.0, 24.0):
            planet(self.folder / "planet.tif", 2048, wave)
            self.assert_done("cut", "planet.tif", "-o", f"{wave}.gpkg", "--format", "png")
        for crs, (extent, wave) in MAPS.items():
            with self.subTest(crs):
                self.assert_done("render", f"{wave}.gpkg", "--extent=" + ",".join(map(str, extent)), "--crs", crs, "--size",
                                 "600x600", "-o", "map.tif")
                read = self.open_map("map.tif")
                lon, lat = places(read)
                pixels = read.ReadAsArray().astype(float)
                on_map = np.isfinite(lon) & (np.abs(lat) <= 90)
                if len(pixels) == 4:
                    # The rim of a map is covered in part.
                    on_map &= pixels[3] == 255
                truth = painted(np.where(on_map, lon, 0), np.where(on_map, lat, 0), wave)
                truth[:, ~on_map] = np.nan
                error = pixels[:3] - truth
                rms = np.sqrt(np.nanmean(error ** 2))
                off = np.abs(shift_px(error, truth)).max()
                print(f"{crs}: RMS {rms:.3f} levels, {off:.4f} px off")
                self.assertGreater(on_map.mean(), 0.7)
                self.assertLess(rms, RMS)
                self.assertLess(off, OFF_PX)

    def test_gdal_reads_a_placed_map_with_overviews(self):
        done = self.assert_done("render", "--extent=5,43,17,49", "--crs", "EPSG:4326", "--size", "1200x1200", "-o", "alps.tif",
                                "--json")
        told = json.loads(done.stdout)
        read = self.open_map("alps.tif")
        self.assertEqual((read.RasterXSize, read.RasterYSize, read.RasterCount), (1200, 600, 3))
        self.assertEqual((told["width_px"], told["height_px"], told["extent"]), (1200, 600, [5, 43, 17, 49]))
        np.testing.assert_allclose(read.GetGeoTransform(), (5, 0.01, 0, 49, 0, -0.01), atol=1e-12)
        self.assertEqual(read.GetSpatialRef().GetAuthorityCode(None), "4326")
        self.assertGreater(read.GetRasterBand(1).GetOverviewCount(), 0)
        self.assertEqual(read.GetMetadataItem("LAYOUT", "IMAGE_STRUCTURE"), "COG")
        self.assert_nothing_but("alps.tif")
        # A second map replaces the first one, and can be shown itself.
        self.assert_done("render", "--extent=5,43,17,49", "--crs", "EPSG:4326", "-o", "alps.tif")
        self.assert_done("render", "alps.tif", "-o", "seen.png", "--size", "64x64")

    def test_pixels_of_a_set_in_its_own_grid_are_copies(self):
        planet(self.folder / "planet.tif", 1024, 12.0)
        self.assert_done("cut", "planet.tif", "-o", "planet.gpkg", "--format", "png")
        self.assert_done("render", "planet.gpkg", "--extent=-180,-90,180,90", "--crs", "EPSG:4326", "--size", "1024x1024", "-o",
                         "map.tif")
        np.testing.assert_array_equal(self.open_map("map.tif").ReadAsArray(),
                                      gdal.Open(str(self.folder / "planet.tif")).ReadAsArray())

    def test_layers_lie_over_one_another(self):
        """Opaque red, under a blue part of the planet at half its opacity."""
        step = 360.0 / 512
        red = np.zeros((3, 256, 512), np.uint8)
        red[0] = 200
        save(self.folder / "red.tif", red, "EPSG:4326", (-180, step, 0, 90, 0, -step))
        blue = np.zeros((3, 64, 64), np.uint8)
        blue[2] = 100
        save(self.folder / "blue.tif", blue, "EPSG:4326", (0, 0.5, 0, 32, 0, -0.5))
        self.assert_done("render", "red.tif", "--overlay", "blue.tif:0.5", "--extent=-20,-20,50,50", "--crs", "EPSG:4326",
                         "--size", "140x140", "-o", "map.tif")
        pixels = self.open_map("map.tif").ReadAsArray()[:3]
        np.testing.assert_allclose(pixels[:, 80, 80], (100, 0, 50), atol=1)
        np.testing.assert_allclose(pixels[:, 10, 10], (200, 0, 0), atol=1)
        # Halfway from red to black, to the sum, and to both; without red below, blue covers.
        for blend, both in (("multiply", (100, 0, 0)), ("screen", (200, 0, 50)), ("difference", (200, 0, 50))):
            self.assert_done("render", "red.tif", "--overlay", "blue.tif:0.5", "--overlay-blend", blend, "--crs",
                             "EPSG:4326", "--extent=-20,-20,50,50", "--size", "140x140", "-o", f"{blend}.tif")
            np.testing.assert_allclose(self.open_map(f"{blend}.tif").ReadAsArray()[:3, 80, 80], both, atol=1)

    def test_numbers_have_their_colours(self):
        """A grey stretch from 0 to 255 shows each value as its level; what has no data is transparent."""
        values = np.tile(np.linspace(0, 255, 256, dtype=np.float32), (128, 1))
        values[:20] = -9999
        save(self.folder / "numbers.tif", values[None], "EPSG:4326", (0, 0.25, 0, 32, 0, -0.25))
        self.assert_done("render", "numbers.tif", "--nodata", "-9999", "--stretch", "0,255", "--colormap", "grey",
                         "--extent=0,0,64,32", "--crs", "EPSG:4326", "--size", "256x128", "-o", "map.tif")
        pixels = self.open_map("map.tif").ReadAsArray().astype(int)
        self.assertTrue((pixels[3, :18] == 0).all())
        self.assertTrue((pixels[3, 24:] == 255).all())
        self.assertLess(np.abs(pixels[0, 24:] - values[24:]).max(), 1.01)

    def test_tiles_of_a_server(self):
        """As those of the folder that it serves; a tile that fails is named, and its block is left out."""
        planet(self.folder / "planet.tif", 1024, 12.0)
        self.assert_done("cut", "planet.tif", "-o", "set", "--format", "png")
        missing = []

        class Handler(http.server.SimpleHTTPRequestHandler):
            def do_GET(self):
                if any(self.path.endswith(tile) for tile in missing):
                    self.send_error(403)
                else:
                    super().do_GET()

            def log_message(self, *_):
                pass

        server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Handler, directory=self.folder))
        threading.Thread(target=server.serve_forever, daemon=True).start()
        self.addCleanup(server.server_close)
        self.addCleanup(server.shutdown)
        address = f"http://127.0.0.1:{server.server_port}/set/{{z}}/{{x}}/{{y}}.png"
        words = "--extent=-3e6,-3e6,3e6,3e6", "--crs", "EPSG:3413", "--size", "512x512"
        grid = "--projection", "equirectangular", "--root-span", 180, "--max-level", 1, "--cache", "off"
        self.assert_done("render", address, *grid, *words, "-o", "remote.tif")
        self.assert_done("render", "set", *words, "-o", "local.tif")
        remote, local = (self.open_map(name).ReadAsArray().astype(float) for name in ("remote.tif", "local.tif"))
        # A server's tiles are those of the map's own resolution, a folder's are one level finer where there is one.
        self.assertLess(np.sqrt(np.mean((remote - local) ** 2)), 1.0)
        missing.append("/1/0/0.png")
        done = self.run_program("render", address, *grid, *words, "--timeout", "20", "-o", "part.tif")
        self.assertEqual(done.returncode, DONE_IN_PART, done.stdout + done.stderr)
        self.assertIn("missing: made of the tile 1/0/0", done.stderr)
        missing[:] = [".png"]
        self.assert_fails(FAILED, "render", address, *grid, *words, "-o", "none.tif", says=("no tile of this --extent came", "403"))
        part = self.open_map("part.tif").ReadAsArray().astype(float)
        there = part[3] == 255
        self.assertTrue(0.4 < there.mean() < 0.8)
        np.testing.assert_array_equal(part[:3, there], remote[:3, there])

    def test_says_what_is_wrong(self):
        extent = "--extent=-3e6,-3e6,3e6,3e6"
        polar = ("--crs", "EPSG:3413")
        for code, words, says in (
                (WRONG_USAGE, (extent, "-o", "a.tif"), ("--extent", "--crs")),
                (WRONG_USAGE, (extent, *polar, "-o", "a.png"), ("--extent", ".tif")),
                (WRONG_USAGE, ("-o", "a.tif"), ("a.tif", "--extent")),
                (WRONG_USAGE, ("--extent=3,0,3,1", *polar, "-o", "a.tif"), ("WEST < EAST",)),
                (WRONG_USAGE, ("--extent=-1e308,-1,1e308,1", *polar, "-o", "a.tif"), ("WEST < EAST",)),
                (WRONG_USAGE, ("--extent=1e6,1e6,1000000.0000000001,1000000.0000000001", *polar, "-o", "a.tif"), ("WEST < EAST",)),
                (WRONG_USAGE, ("--extent=3,0,nan,1", *polar, "-o", "a.tif"), ("3,0,nan,1",)),
                (WRONG_USAGE, (extent, *polar, "--camera", "0,0,1e6", "-o", "a.tif"), ("--extent and --camera",)),
                (WRONG_USAGE, (extent, *polar, "--time", "2020-01-01T00:00:00Z", "-o", "a.tif"), ("--extent and --time",)),
                (FAILED, (extent, "--crs", "EPSG:999999", "-o", "a.tif"), ("--crs", "EPSG:999999")),
                (FAILED, (extent, "--crs", "+proj=stere +lat_0=90 +R=1737400", "-o", "a.tif"), ("--crs", "another body")),
                (FAILED, ("--extent=9e7,9e7,9.1e7,9.1e7", "--crs", "EPSG:2056", "-o", "a.tif"), ("no data",))):
            with self.subTest(words):
                self.assert_fails(code, "render", *words, says=says)
                self.assert_nothing_but()


class Slope(ProgramTest):
    """--slope beside gdaldem, which gets the metres that pixels have at the hills' latitude."""

    open_map = ExtentTest.open_map
    LAT, SIDE, STEP = 47.0, 300, 0.001
    STEEPEST = 60.0
    # Half a level of the map's grey, and the change of a metre's degrees over the hills: 0.3 % of the slope's tangent.
    OFF = 0.5 * STEEPEST / 255 + 0.1

    def test_equals_gdaldem(self):
        sine = np.sin(np.radians(self.LAT))
        across = 6378137.0 / np.sqrt(1 - 0.00669437999014 * sine**2)
        along = across * (1 - 0.00669437999014) / (1 - 0.00669437999014 * sine**2)
        east_m, north_m = (np.radians(self.STEP) * radius for radius in (across * np.sqrt(1 - sine**2), along))
        column, row = np.meshgrid(np.arange(self.SIDE), np.arange(self.SIDE))
        heights = 900 * np.sin(column / 9.0) * np.cos(row / 13.0) + 4 * column
        heights[40:50, 60:90] = -9999
        heights = heights.astype(np.float32)[None]
        save(self.folder / "hills.tif", heights, "EPSG:4326",
             (10, self.STEP, 0, self.LAT + self.SIDE / 2 * self.STEP, 0, -self.STEP))
        save(self.folder / "metres.tif", heights, "EPSG:32632", (0, east_m, 0, 0, 0, -north_m))
        by_gdal = gdal.DEMProcessing("", str(self.folder / "metres.tif"), "slope", format="MEM").ReadAsArray()
        extent = f"10,{self.LAT - self.SIDE / 2 * self.STEP},{10 + self.SIDE * self.STEP},{self.LAT + self.SIDE / 2 * self.STEP}"
        told = self.assert_done("render", "hills.tif", "--slope", "--nodata=-9999", "--colormap", "grey", "--stretch",
                                f"0,{self.STEEPEST:g}", f"--extent={extent}", "--crs", "EPSG:4326", "--size",
                                f"{self.SIDE}x{self.SIDE}", "-o", "slope.tif")
        self.assertIn("0 to 60 °", told.stderr)
        pixels = self.open_map("slope.tif").ReadAsArray().astype(float)
        # GDAL gives no slope beside pixels without data and at the edge.
        known = np.ones((self.SIDE, self.SIDE), bool)
        known[39:51, 59:91] = known[[0, -1]] = known[:, [0, -1]] = False
        self.assertGreater(by_gdal[known].max(), 0.8 * self.STEEPEST)
        off = np.abs(pixels[0] * self.STEEPEST / 255 - by_gdal)[known]
        self.assertLess(off.max(), self.OFF)
        self.assertTrue((pixels[-1][42:48, 62:88] == 0).all(), "no data is transparent")

    def test_is_of_heights(self):
        save(self.folder / "red.tif", np.full((3, 64, 64), 90, np.uint8), "EPSG:4326", (0, 0.5, 0, 32, 0, -0.5))
        for angle in ("--slope", "--aspect"):
            self.assert_fails(WRONG_USAGE, "render", "red.tif", angle, "--bands", "1,2,3", "-o", "a.png", says=[angle])


if __name__ == "__main__":
    unittest.main()
