"""Contour lines of rasters lie where gdal_contour puts them."""

import json
import math
import unittest

from ellipsoid_camera import Camera, ecef
from georeferenced import gdal
from program import SOURCE, WRONG_USAGE, ProgramTest

TEMPERATURE = SOURCE / "data/ocean/sea_surface_temperature.tif"
SIZE = (640, 480)
GREY = 200
FAR = "-5,-130,2500000,0,-90,40"
# A line is one pixel wide, so that a pixel that it covers by half or more is within half a pixel of its middle; and half
# a pixel is what the lines may be off.
OFF_PX = 0.5 + 0.5


def along(line):
    """Points of a line, at most two pixels apart."""
    for (x, y), (x2, y2) in zip(line, line[1:]):
        count = math.ceil(math.hypot(x2 - x, y2 - y) / 2)
        yield from ((x + (x2 - x) * k / count, y + (y2 - y) * k / count) for k in range(count))


class ContoursTest(ProgramTest):
    def covered(self, camera, *arguments):
        """The share of each pixel that lines cover, by rows, with a map that is grey everywhere."""
        self.write("grey.txt", f"-100 {GREY} {GREY} {GREY}\n100 {GREY} {GREY} {GREY}\n".encode())
        self.assert_done("render", "fine.tif", "--colormap", "grey.txt", "--camera", camera, "--size", "%dx%d" % SIZE, "--unlit",
                         "-o", "out.png", *arguments)
        gdal("gdal_translate", "-q", "-b", 1, "-of", "ENVI", self.folder / "out.png", self.folder / "out.raw")
        values = (self.folder / "out.raw").read_bytes()
        return [[(GREY - v) / GREY / 0.75 for v in values[y * SIZE[0]:(y + 1) * SIZE[0]]] for y in range(SIZE[1])]

    def fine_part(self, west, south, east, north):
        """Texels of 0.1°, because gdal_contour draws chords across a texel, and the program bends."""
        gdal("gdal_translate", "-q", "-projwin", west, north, east, south, "-r", "cubicspline", "-outsize", "1000%", "1000%",
             TEMPERATURE, self.folder / "fine.tif")

    def true_lines(self, camera, step):
        """Contour lines of the part, in pixels."""
        gdal("gdal_contour", "-q", "-a", "value", "-i", step, "-f", "GeoJSON", self.folder / "fine.tif",
             self.folder / "lines.geojson")
        for feature in json.loads((self.folder / "lines.geojson").read_text())["features"]:
            if round(feature["properties"]["value"] / step) % 5:  # the others are wider
                places = feature["geometry"]["coordinates"]
                yield [camera.pixel(ecef(lat, lon, 0.0)) for lon, lat in places]

    def test_lie_where_gdal_contour_puts_them(self):
        """Over the Gulf Stream and the open Pacific, twice as far away."""
        for view, bounds in (("36,-66,900000,0,-90,40", (-74, 30, -58, 42)), (FAR, (-148, -20, -112, 10))):
            camera = Camera(view, SIZE)
            self.fine_part(*bounds)
            covered = self.covered(view, "--contours", 1)
            seen = checked = 0
            for line in self.true_lines(camera, 1.0):
                for x, y in along(line):
                    column, row = math.floor(x), math.floor(y)
                    if not (3 < column < SIZE[0] - 4 and 3 < row < SIZE[1] - 4):
                        continue
                    checked += 1
                    seen += any(covered[j][i] >= 0.5 and math.hypot(i + 0.5 - x, j + 0.5 - y) <= OFF_PX
                                for j in range(row - 1, row + 2) for i in range(column - 1, column + 2))
            self.assertGreater(checked, 300)
            # gdal_contour goes half a texel further towards places without data.
            self.assertGreaterEqual(seen / checked, 0.99, f"{seen} of {checked}")

    def test_no_lines_unless_asked(self):
        self.fine_part(-148, -20, -112, 10)
        self.assertEqual(max(map(max, self.covered(FAR))), 0.0)

    def test_wrong_steps_are_named(self):
        for step in ("-1", "often", "nan"):
            self.assert_fails(WRONG_USAGE, "render", TEMPERATURE, "--contours", step, "-o", "out.png", says=["--contours"])


if __name__ == "__main__":
    unittest.main()
