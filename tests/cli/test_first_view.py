"""The first view without --camera: a raster or tile set of a part of the planet fills a good part of the picture."""

import sys
import unittest

from pictures import png
from program import SOURCE, ProgramTest

sys.path.insert(0, str(SOURCE / "tests/window"))
import png as pngs  # noqa: E402

SMALL = ("--size", "96x96", "--unlit")
COLOUR = (40, 90, 160)
LEAST_SHARE = 0.3  # share of the picture; the room around the data takes 0.4


class FirstView(ProgramTest):
    def share(self, *arguments):
        """The part of the picture that has the raster's colour."""
        self.assert_done("render", *arguments, "-o", "shot.png", *SMALL)
        width, height, rows = pngs.read(self.folder / "shot.png")
        near = sum(max(abs(row[3 * x + k] - COLOUR[k]) for k in range(3)) < 16 for row in rows for x in range(width))
        return near / (width * height)

    def test_a_raster_and_a_tile_set_of_a_part_are_flown_to(self):
        self.write("part.png", png(64, 64, COLOUR))
        for bounds in ("100,-40,102,-38", "178,60,182,62", "10,-1,10.01,-0.99", "-60,-30,60,30"):
            with self.subTest(bounds):
                place = ("--bounds", bounds)
                self.assertGreater(self.share("part.png", *place), LEAST_SHARE)
                self.assert_done("cut", "part.png", *place, "-o", "part.gpkg", "--force")
                self.assertGreater(self.share("part.gpkg"), LEAST_SHARE)

    def test_a_view_without_data_says_where_they_lie(self):
        self.write("part.png", png(64, 64, COLOUR))
        done = self.assert_done("render", "part.png", "--bounds", "100,-40,102,-38", "-o", "shot.png", *SMALL,
                                "--camera", "50,0,100000")
        for says in ("100° to 102° east", "-40° to -38° north", "--camera"):
            self.assertIn(says, done.stderr)


if __name__ == "__main__":
    unittest.main()
