"""Light on the ground by options: hillshade, the inner sphere's colour, glint, clouds over the ground, magnification."""

import struct
import unittest
import zlib

import pictures
from program import WRONG_USAGE, ProgramTest

SMALL = ["--size", "64x64", "--camera", "10,20,1200000,0,-90,20", "--cache", "off", "-o", "out.png"]


def waves(width, height):
    """Heights in waves, for --offset -32768."""
    rows = b"".join(
        b"\0" + b"".join(struct.pack(">H", 32768 + 2000 * ((x // 2 + y // 2) % 2)) for x in range(width))
        for y in range(height))
    return pictures.png_of(width, height, zlib.compress(rows), bits=16, colour=0)


class Light(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("sea.png", pictures.png(256, 128, (60, 90, 120)))
        self.assert_done("cut", "sea.png", "-o", "sea.gpkg", "--tile-size", "64")
        self.write("heights.png", waves(512, 256))
        self.assert_done("cut", "heights.png", "--elevation", "--offset", "-32768", "-o", "relief.gpkg")

    def picture(self, *options):
        self.assert_done("render", "sea.gpkg", *SMALL, *options)
        return (self.folder / "out.png").read_bytes()

    def test_hillshade_changes_relief_alone_and_no_unlit_picture(self):
        relief = ("--elevation", "relief.gpkg", "--sky", "off")
        self.assertNotEqual(self.picture(*relief), self.picture(*relief, "--hillshade"))
        self.assertEqual(self.picture("--sky", "off"), self.picture("--sky", "off", "--hillshade"))
        unlit = ("--elevation", "relief.gpkg", "--unlit")
        self.assertEqual(self.picture(*unlit), self.picture(*unlit, "--hillshade", "--glint", "off"))

    def test_the_inner_sphere_is_black_unless_a_colour_is_given(self):
        glass = ("--surface-alpha", "0.5", "--sky", "off")
        plain = self.picture(*glass)
        self.assertEqual(plain, self.picture(*glass, "--inner-sphere-color", "#000000"))
        self.assertNotEqual(plain, self.picture(*glass, "--inner-sphere-color", "#4060a0"))
        self.assert_fails(WRONG_USAGE, "render", "sea.gpkg", *SMALL, "--inner-sphere-color", "darkish",
                          says=["--inner-sphere-color", "darkish", "#"])

    def test_an_unlit_picture_is_magnified_bilinearly_unless_told_otherwise(self):
        near = ("--unlit",)
        self.assertEqual(self.picture(*near), self.picture(*near, "--magnify", "bilinear"))
        self.assert_fails(WRONG_USAGE, "render", "sea.gpkg", *SMALL, "--magnify", "sharp", says=["--magnify", "bicubic"])
        self.assert_fails(WRONG_USAGE, "render", "sea.gpkg", *SMALL, "--cloud-height", "-1", says=["--cloud-height"])


if __name__ == "__main__":
    unittest.main()
