"""Allowed places of the eye: in and under the ground, with mountains, and out to where the planet is a pixel wide."""

import unittest

import png as pngs
from pictures import heights_png, png
from program import DONE, WRONG_USAGE, ProgramTest

SIZE = 128
MOVED = "under the ground, which is opaque"


class Eye(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("land.png", png(128, 64, (200, 150, 90)))
        self.assert_done("cut", "land.png", "-o", "land.gpkg", "--tile-size", "64")

    def render(self, camera, *options, code=DONE):
        """The rows of the picture, and what was said."""
        done = self.run_program("render", "land.gpkg", "-o", "out.png", "--unlit", "--size", f"{SIZE}x{SIZE}",
                                "--camera", camera, *options)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return pngs.read(self.folder / "out.png"), done.stderr

    def cut_heights(self, metres):
        self.write("heights.png", heights_png(256, 128, 32768 + metres))
        self.assert_done("cut", "heights.png", "--elevation", "--offset", "-32768", "-o", "relief.gpkg", "--tile-size",
                         "32")
        return "--elevation", "relief.gpkg"

    def is_land(self, picture, y):
        return min(pngs.pixel(picture, SIZE // 2, y)) > 30  # half of it, where the surface is translucent

    def assert_on_the_ground(self, picture):
        """Looking level: the sky above, land below."""
        self.assertFalse(self.is_land(picture, SIZE // 8), "the sky is land: the planet's inside, upside down")
        self.assertTrue(self.is_land(picture, SIZE - SIZE // 8))

    def test_an_eye_in_the_ground_stands_on_it(self):
        level, _ = self.render("46,7,1,0,0")
        self.assert_on_the_ground(level)
        for height in "0", "0.5":
            for options in (), ("--surface-alpha", "0.5"):
                with self.subTest(height, options=options):
                    picture, said = self.render(f"46,7,{height},0,0", *options)
                    self.assertEqual(said, "")
                    if not options:
                        self.assertEqual(picture, level)
                    else:
                        self.assertFalse(self.is_land(picture, SIZE // 8))

    def test_an_eye_under_opaque_ground_is_put_on_it_and_that_is_said(self):
        level, _ = self.render("46,7,1,0,0")
        for height in "-10", "-400000":
            with self.subTest(height):
                picture, said = self.render(f"46,7,{height},0,0")
                self.assertEqual(picture, level)
                self.assertIn(MOVED, said)
                self.assertIn(f"ALT {height} m", said)

    def test_an_eye_under_translucent_ground_stays_there(self):
        above, _ = self.render("46,7,1,0,30", "--surface-alpha", "0.5")
        for height in "-10", "-700000":
            with self.subTest(height):
                below, said = self.render(f"46,7,{height},0,30", "--surface-alpha", "0.5", "--surface-from-below",
                                          "translucent")
                self.assertEqual(said, "")
                self.assertNotEqual(below, above)
                self.assertTrue(self.is_land(below, SIZE // 2), "the ground over the eye")

    def test_the_eye_stands_on_mountains(self):
        # Flat highlands: from 1 m over them the horizon is in the picture's middle, as it is from 1 m over the ellipsoid.
        heights = self.cut_heights(3000)
        for camera in "46,7,500,0,0", "46,7,0,0,0":
            with self.subTest(camera):
                picture, said = self.render(camera, *heights)
                self.assert_on_the_ground(picture)
                self.assertIn(MOVED, said)
        over, said = self.render("46,7,3002,0,0", *heights)
        self.assert_on_the_ground(over)
        self.assertEqual(said, "")

    def test_an_eye_in_a_basin_is_not_under_the_ground(self):
        picture, said = self.render("46,7,-400,0,0", *self.cut_heights(-430))
        self.assert_on_the_ground(picture)
        self.assertEqual(said, "")

    def test_from_where_the_planet_is_no_pixel_wide_nothing_is_drawn(self):
        for height in "1e12", "1.1e10":
            self.assert_fails(WRONG_USAGE, "render", "land.gpkg", "-o", "out.png", "--size", f"{SIZE}x{SIZE}",
                              "--camera", f"46,7,{height}", says=["--camera", "ALT", "less than a pixel", "FOV"])
        self.assert_nothing_but("land.gpkg", "land.png")
        picture, _ = self.render("46,7,1e9")
        self.assertTrue(any(self.is_land(picture, y) for y in range(SIZE)))
        telescope, _ = self.render("46,7,1e12,0,-90,0.01")
        self.assertTrue(self.is_land(telescope, SIZE // 2))

    def test_an_eye_in_the_inner_sphere_is_refused(self):
        below = ("--size", "64x64", "--surface-alpha", "0.5", "-o", "out.png")
        self.assert_fails(WRONG_USAGE, "render", "land.gpkg", *below, "--camera", "0,0,-2000000",
                          says=["--camera", "ALT", "--inner-sphere"])
        self.assert_fails(WRONG_USAGE, "render", "land.gpkg", *below, "--camera", "0,0,-7000000", "--inner-sphere", "off",
                          says=["--camera", "ALT", "centre"])
        self.assert_done("render", "land.gpkg", *below, "--camera", "0,0,-2000000", "--inner-sphere", "off")


if __name__ == "__main__":
    unittest.main()
