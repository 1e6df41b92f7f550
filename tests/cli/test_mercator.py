"""Tiles in Web Mercator: from a server, over the included Earth, preloaded, and with a wrong projection stated."""

import json
import math
import shutil
import subprocess
import unittest

import png
import servers
from pictures import TILE_PX, square_tile
from program import ProgramTest

LEVELS = 3
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


if __name__ == "__main__":
    unittest.main()
