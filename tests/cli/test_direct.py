"""A TIFF with overviews is drawn from its own tiles: as its cut is, and nothing of it is stored."""

import math
import pathlib
import unittest

import png
from georeferenced import gdal
from program import BLUE_MARBLE, ProgramTest

# The finest pixels are the same. Overviews are rounded to 8 bits once more, which moves some pixels by one.
SAME_RMS = 0.3
# A coarse tile in another projection and that of the cut are rounded independently: 0.29 each.
ROUNDED_RMS = 0.45
GLOBAL = ("30,20,12000000", "0,180,6000000", "46,7,2500000,30,-50", "-50,-100,4000000", "90,0,6000000",
          "75,30,1500000")
TILED = ("-co", "TILED=YES", "-co", "COMPRESS=DEFLATE")


class DirectTest(ProgramTest):
    def planet(self, name, *options, size=(2048, 1024)):
        gdal("gdal_translate", "-q", "-r", "average", "-outsize", *size, "-a_srs", "EPSG:4326", "-a_ullr", -180, 90, 180, -90,
             *options, BLUE_MARBLE, self.folder / name)

    def cog(self):
        self.planet("planet.tif")  # first: a COG of a JPEG would get the JPEG's own overviews
        gdal("gdal_translate", "-q", "-of", "COG", "-co", "COMPRESS=DEFLATE", "-co", "BLOCKSIZE=256",
             "-co", "OVERVIEW_RESAMPLING=AVERAGE", self.folder / "planet.tif", self.folder / "cog.tif")

    def shot(self, tiles, camera, name, *options):
        self.assert_done("render", tiles, "-o", name, "--unlit", "--sky", "off", "--size", "256x256", "--camera", camera,
                         *options)
        return png.read(self.folder / name)

    def assert_like_its_cut(self, raster, cameras, most_rms=SAME_RMS):
        self.assert_done("cut", raster, "-o", "cut.gpkg", "--format", "png", "--force")
        for camera in cameras:
            a, b = (self.shot(tiles, camera, f"{pathlib.Path(tiles).stem}.png") for tiles in (raster, "cut.gpkg"))
            squares = sum((p - q) ** 2 for x, y in zip(a[2], b[2]) for p, q in zip(x, y))
            self.assertGreater(sum(map(sum, a[2])), 0, "a black picture")
            self.assertLess(math.sqrt(squares / (256 * 256 * 3)), most_rms, camera)

    def stored(self):
        return sorted(p.name for p in (self.folder / "cache").rglob("*") if p.suffix == ".gpkg")

    def test_a_planet_is_drawn_as_its_cut(self):
        self.cog()
        self.assert_like_its_cut("cog.tif", GLOBAL)
        self.assertEqual(self.stored(), [])

    def test_utm_is_drawn_as_its_cut(self):
        self.planet("planet.tif", size=(4096, 2048))
        gdal("gdalwarp", "-q", "-r", "cubic", "-t_srs", "EPSG:32632", "-te", -300000, 4200000, 1300000, 5800000, "-ts", 700, 700,
             *TILED, "-dstalpha", self.folder / "planet.tif", self.folder / "utm.tif")
        gdal("gdaladdo", "-q", "-r", "average", self.folder / "utm.tif", 2, 4)
        self.assert_like_its_cut("utm.tif", ("46,7,900000,30,-60", "42,12,600000", "48,4,800000"))
        self.assert_like_its_cut("utm.tif", ("45,9,2200000",), ROUNDED_RMS)
        self.assertEqual(self.stored(), [])

    def test_overviews_beside_the_file_and_none_in_a_small_one(self):
        self.planet("tiled.tif", *TILED, "-co", "BIGTIFF=YES")
        self.shot("tiled.tif", GLOBAL[0], "a.png")
        gdal("gdaladdo", "-q", "-ro", "-r", "average", self.folder / "tiled.tif", 2, 4)
        self.assertTrue((self.folder / "tiled.tif.ovr").exists())
        self.shot("tiled.tif", GLOBAL[0], "b.png")
        self.shot("tiled.tif", GLOBAL[0], "c.png", "--overlay", "tiled.tif:0.5", "--cache", "off")
        self.assertEqual(self.stored(), [])

    def test_a_striped_one_is_cut_into_the_cache(self):
        self.planet("striped.tif", size=(512, 256))
        self.shot("striped.tif", GLOBAL[0], "a.png")
        self.assertEqual(len(self.stored()), 1)

    def test_overviews_that_leave_out_levels_are_not_drawn_from_afar(self):
        # Overview 32 alone: views between the two would show it enlarged.
        self.planet("gap.tif", *TILED)
        gdal("gdaladdo", "-q", "-r", "average", self.folder / "gap.tif", 32)
        self.shot("gap.tif", GLOBAL[2], "a.png")
        self.assertEqual(len(self.stored()), 1, "it is cut")
        # Overview 16 alone: views between the two are made of the finest pixels.
        self.planet("step.tif", *TILED)
        gdal("gdaladdo", "-q", "-r", "average", self.folder / "step.tif", 16)
        self.assert_like_its_cut("step.tif", GLOBAL[:3])
        self.assertEqual(len(self.stored()), 1)

    def test_words_about_the_place_and_the_body_hold(self):
        gdal("gdal_translate", "-q", "-outsize", 512, 256, *TILED, BLUE_MARBLE, self.folder / "from_0.tif")
        west, east = (self.shot("from_0.tif", "10,15,9000000", f"{lon}.png", "--west", lon) for lon in (-180, 0))
        self.assertNotEqual(west[2], east[2])
        gdal("gdal_translate", "-q", "-outsize", 512, 256, *TILED, "-a_srs", "+proj=longlat +R=1737400 +no_defs", "-a_ullr",
             -180, 90, 180, -90, BLUE_MARBLE, self.folder / "moon.tif")
        self.assert_fails(1, "render", "moon.tif", "-o", "m.png", "--body", "earth", says=["moon.tif", "1737400", "--body moon"])
        own, said = (self.shot("moon.tif", "10,15,5000000", "m.png", *body) for body in ((), ("--body", "moon")))
        self.assertEqual(own[2], said[2])

    def test_damage_is_named(self):
        self.cog()
        whole = (self.folder / "cog.tif").read_bytes()
        (self.folder / "cog.tif").write_bytes(whole[:len(whole) // 2])
        done = self.run_program("render", "cog.tif", "-o", "a.png", "--size", "256x256", "--camera", "-60,7,100000")
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertIn("cog.tif: block", done.stderr)
        self.assertIn("truncated or damaged", done.stderr)


if __name__ == "__main__":
    unittest.main()
