"""Tiles in Web Mercator: from a server, over the included Earth, preloaded, and with a wrong projection stated."""

import json
import math
import shutil
import struct
import subprocess
import unittest
import zlib

import png
import servers
from pictures import TILE_PX, png_of, square_tile
from program import ProgramTest

LEVELS = 3
SAME_RMS = 2.5  # levels; 1.65 is measured. Both resample jumps of 245 levels, a pixel wide
SIDE = 256
POLE = ("--unlit", "--sky", "off", "--camera", "90,0,3000000", "--size", f"{SIDE}x{SIDE}")


def radius_px_of(lat_deg):
    """Radius of a parallel around the pole in POLE's pictures, 40° high; formulas of the ellipsoid WGS 84."""
    a, b = 6378137.0, 6356752.314245
    e2 = 1 - (b / a) ** 2
    lat = math.radians(lat_deg)
    n = a / math.sqrt(1 - e2 * math.sin(lat) ** 2)
    off_axis, height = n * math.cos(lat), n * (1 - e2) * math.sin(lat)
    return off_axis / (b + 3e6 - height) * SIDE / 2 / math.tan(math.radians(20))


def web_texel(column, row, side):
    """Longitude and latitude of the middle of a texel of the square of Web Mercator, which has `side` texels each way."""
    lat = math.atan(math.sinh(math.pi * (1 - 2 * (row + 0.5) / side)))
    return (column + 0.5) / side * 360 - 180, math.degrees(lat)


class MercatorTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.pyramid = self.folder / "square"
        for z in range(LEVELS):
            for x in range(1 << z):
                column = self.pyramid / str(z) / str(x)
                column.mkdir(parents=True)
                for y in range(1 << z):
                    (column / f"{y}.png").write_bytes(square_tile(z, x, y))

    def pixels(self, name):
        _, _, rows = png.read(self.folder / name)
        return [row[i:i + 3] for row in rows for i in range(0, len(row), 3)]

    @staticmethod
    def tiles_asked(server):
        server.cut()
        return {path: times for path, times in server.counts().items() if path.endswith(".png")}

    def assert_hole_over_the_pole(self, name, below):
        """Red beyond 85.05°; within, what lies below: by its area a circle of the right radius."""
        pixels = self.pixels(name)
        # The Arctic Sea is dark: half way to red lies the edge.
        hole = [k for k, pixel in enumerate(pixels) if pixel[0] < 132]
        radius = math.sqrt(len(hole) / math.pi)
        self.assertAlmostEqual(radius, radius_px_of(85.0511288), delta=0.5)
        middle = SIDE // 2 * SIDE + SIDE // 2
        self.assertEqual(pixels[middle], self.pixels(below)[middle])

    def test_over_the_earth_the_pole_shows_what_lies_below(self):
        self.assert_done("render", "-o", "earth.png", *POLE)
        with servers.nginx(self.pyramid) as server:
            template = server.template.replace(".jpg", ".png")
            source = self.write("web.json", json.dumps({"url": template, "max_level": LEVELS - 1, "tile_px": TILE_PX,
                                                        "projection": "web-mercator"}).encode())
            self.assert_done("render", "-o", "web.png", *POLE, "--overlay", source)
            asked = self.tiles_asked(server)
            self.assert_done("render", "-o", "again.png", *POLE, "--overlay", source)
            self.assertEqual(self.tiles_asked(server), asked, "what is in the cache is not asked for again")
            self.assertEqual(set(asked.values()), {1}, "what many tiles are made of is fetched once")
        self.assert_hole_over_the_pole("web.png", "earth.png")
        self.assertEqual(self.pixels("web.png"), self.pixels("again.png"))
        # The server is gone: from the cache alone, half over the Earth.
        self.assert_done("render", "-o", "half.png", *POLE, "--overlay", f"{source}:0.5")
        half, earth, web = (self.pixels(name)[5] for name in ("half.png", "earth.png", "web.png"))
        for c in range(3):
            self.assertAlmostEqual(half[c], (earth[c] + web[c]) / 2, delta=2)

    def test_a_folder_says_it_itself_and_info_tells(self):
        (self.pyramid / "tileset.json").write_text(json.dumps(
            {"projection": "web-mercator", "tile_px": TILE_PX, "max_level": LEVELS - 1, "format": "png"}))
        told = self.assert_done("info", self.pyramid, "--verify").stdout
        self.assertIn("made of      tiles in Web Mercator (EPSG:3857): 64 px a tile, levels 0 to 2", told)
        self.assertIn("0 absent, 0 blank, 0 broken", told)
        self.assert_fails(1, "render", self.pyramid, "--projection", "equal-area", "-o", "x.png", *POLE,
                          says=["Web Mercator", "--projection"])
        (self.pyramid / "2/1/1.png").write_bytes(b"no picture")
        done = self.run_program("info", self.pyramid, "--verify")
        self.assertRegex(done.stdout, "broken +2/1/1: ")

    def test_what_is_preloaded_stays_as_it_is_and_opens_elsewhere(self):
        with servers.nginx(self.pyramid) as server:
            template = server.template.replace(".jpg", ".png")
            self.assert_done("preload", template, "--projection", "web-mercator", "--tile-size", TILE_PX, "--levels",
                             f"0-{LEVELS - 1}", "-o", "kept.gpkg")
            self.assert_done("render", template, "--projection", "web-mercator", "--tile-size", TILE_PX, "--max-level",
                             LEVELS - 1, "-o", "served.png", *POLE)
        self.assert_done("render", "kept.gpkg", "-o", "kept.png", *POLE)
        self.assertEqual(self.pixels("kept.png"), self.pixels("served.png"))
        if shutil.which("gdalinfo"):
            told = subprocess.run(["gdalinfo", self.folder / "kept.gpkg"], capture_output=True, text=True).stdout
            self.assertIn('ID["EPSG",3857]', told)
            self.assertIn("Size is 256, 256", told)
            self.assertIn("Upper Left  (-20037508.343,20037508.343)", told)

    def test_what_is_said_of_a_server_is_compared_with_its_tiles(self):
        with servers.nginx(self.pyramid) as server:
            template = server.template.replace(".jpg", ".png")
            size = ("--tile-size", TILE_PX, "--max-level", LEVELS - 1, "-o", "x.png", *POLE)
            self.assert_fails(1, "render", template, *size, says=["--projection web-mercator"])
        geodetic = self.folder / "geodetic"
        servers.write_pyramid(geodetic, LEVELS)
        with servers.nginx(geodetic) as server:
            self.assert_fails(1, "render", server.template, "--projection", "web-mercator", "--max-level", LEVELS - 1,
                              "-o", "x.png", *POLE, says=["leave out --projection web-mercator"])
        self.assert_fails(1, "render", "--projection", "web-mercator", "-o", "x.png", *POLE, says=["not in Web Mercator"])

    def test_cut_puts_a_picture_where_gdal_finds_it_and_draws_it_as_it_was(self):
        width, height, zoom_px = 360, 180, 512
        rows = b"".join(b"\0" + b"".join(bytes((x % 36 * 7, y % 36 * 7, 90)) for x in range(width)) for y in range(height))
        self.write("picture.png", png_of(width, height, zlib.compress(rows)))
        outputs = ("web.gpkg", "web.mbtiles", "web.pmtiles", "web")
        for output in outputs:
            told = self.assert_done("cut", "picture.png", "-o", output, "--grid", "webmercator", "--format", "png")
            self.assertIn("85.05", told.stderr)
            told = self.assert_done("info", output, "--verify").stdout
            self.assertIn("Web Mercator", told)
            self.assertIn("0 absent, 0 blank, 0 broken", told)
        # Middles of texels that lie away from the jumps of the colours.
        for column, row in ((40, 300), (200, 40), (300, 256), (470, 470)):
            lon, lat = web_texel(column, row, zoom_px)
            wanted = ((lon + 180 - 0.5) % 36 * 7, (90 - lat - 0.5) % 36 * 7)
            for output in outputs[:2]:
                # A texel further is 4.9 levels more. The filter overshoots a little beside the jumps.
                for value, truth in zip(self.by_gdal(output, lon, lat), wanted):
                    self.assertAlmostEqual(value, truth, delta=1.5, msg=f"{output} {lon} {lat}")
        view = ("--unlit", "--sky", "off", "--camera", "20,30,12000000", "--size", "256x256")
        self.assert_done("cut", "picture.png", "-o", "plain.gpkg", "--format", "png")
        self.assert_done("render", "plain.gpkg", "-o", "plain.png", *view)
        self.assert_done("render", "web.pmtiles", "-o", "web.png", *view)
        plain, web = self.pixels("plain.png"), self.pixels("web.png")
        squares = sum((a - b) ** 2 for p, q in zip(plain, web) for a, b in zip(p, q))
        self.assertLess(math.sqrt(squares / (3 * len(plain))), SAME_RMS)

    def by_gdal(self, tiles, lon, lat):
        """The values of all bands that GDAL finds at a place."""
        found = subprocess.run(["gdallocationinfo", "-valonly", "-wgs84", self.folder / tiles, str(lon), str(lat)],
                               capture_output=True, text=True, check=True).stdout
        return [float(value) for value in found.split()]

    def test_heights_of_a_region_are_known_at_its_corners_too(self):
        width, height, value = 123, 61, 1000
        rows = (b"\0" + value.to_bytes(2, "big") * width) * height
        self.write("heights.png", png_of(width, height, zlib.compress(rows), bits=16, colour=0))
        # A texel at each corner is covered by about 0.56 of its width and of its height: more than half of both, and
        # less than half of its area.
        self.assert_done("cut", "heights.png", "--elevation", "--bounds", "5.4,43.6,17.7,49.7", "--tile-size", "64",
                         "--grid", "webmercator", "-o", "web")
        tiles = list((self.folder / "web").rglob("*.png"))
        self.assertGreater(len(tiles), 8)
        for tile in tiles:
            told = subprocess.run(["gdalinfo", "-mm", tile], capture_output=True, text=True, check=True).stdout
            self.assertIn(f"Computed Min/Max={value}.000,{value}.000", told, tile)

    def test_cut_puts_heights_where_gdal_finds_them(self):
        width, height = 360, 180
        rows = b"".join(b"\0" + struct.pack(f">{width}H", *(10 * x + 5 * y for x in range(width))) for y in range(height))
        self.write("heights.png", png_of(width, height, zlib.compress(rows), bits=16, colour=0))
        self.assert_done("cut", "heights.png", "--elevation", "-o", "web.gpkg", "--grid", "webmercator")
        for column, row in ((40, 300), (200, 40), (300, 256), (470, 470)):
            lon, lat = web_texel(column, row, 512)
            # Numbers are whole.
            self.assertAlmostEqual(self.by_gdal("web.gpkg", lon, lat)[0], 10 * (lon + 179.5) + 5 * (89.5 - lat), delta=0.51)
        self.assert_fails(1, "cut", "heights.png", "--elevation", "-o", "web.pmtiles", "--grid", "webmercator",
                          says=["numbers", ".gpkg"])

    def test_cut_into_web_formats_without_the_grid_names_it(self):
        self.write("picture.png", png_of(8, 4, zlib.compress((b"\0" + bytes(24)) * 4)))
        for output in ("a.mbtiles", "a.pmtiles"):
            self.assert_fails(1, "cut", "picture.png", "-o", output, says=["--grid webmercator", output])


if __name__ == "__main__":
    unittest.main()
