"""Georeferenced pictures are drawn in their place, or refused with their claim and what helps.

gdaltransform gives the true places of pixels. Options and commands in a refusal are tried, and the result must be drawn.
test_placement.py has the corpus of pictures that are drawn in their place.
"""

import json
import math
import os
import pathlib
import shlex
import subprocess
import unittest

from georeferenced import (DEGREES, DOUBLES, MATRIX, PLACED_PX, SCALE, TIES, brightness, commands_in, gdal, geo_keys,
                           make, pgm, placed_at, places, tiff)
from program import FAILED, WRONG_USAGE, ProgramTest

MOON_M = 1737400.0
MOON_HALF = math.pi * MOON_M
MOON_DEGREES = "+proj=longlat +R=1737400 +no_defs"
MOON_METRES = "+proj=eqc +R=1737400 +units=m +no_defs"
MARS_SPHERE = "+proj=longlat +R=3396190 +no_defs"
MARS_FIGURE = "+proj=longlat +a=3396190 +b=3376200 +no_defs"
PLANET = ("-a_ullr", -180, 90, 180, -90)
# Brightness changes by 1 about each 1/160 of the width; bilinear resampling and rounding move it by less than this.
BRIGHTNESS = 4


class GeoreferenceTest(ProgramTest):
    def info(self, name):
        return json.loads(self.assert_done("info", name, "--json").stdout)

    @staticmethod
    def options_in(info):
        """Options that `info` says must be given with the picture."""
        return shlex.split(info["command"])[3:]

    def options_for(self, name):
        return self.options_in(self.info(name))

    def assert_drawn_as_gdal_says(self, name, crs, *cut_options, source_crs=()):
        """Cut, and each corner of the tile set's bounds is where gdaltransform has it."""
        info = self.info(name)
        self.assertTrue(info["shown"], info)
        width, height = info["width_px"], info["height_px"]
        self.assert_done("cut", name, "-o", "out.gpkg", "--tile-size", "16", *self.options_in(info), *cut_options)
        bounds = json.loads(self.assert_done("info", "out.gpkg", "--json").stdout)["bounds"]
        west, south, east, north = bounds
        (lon0, lat0), (lon1, lat1) = places(self.folder / name, [(0, 0), (width, height)], crs, source_crs)
        pixel = (north - south) / height
        for ours, gdals in ((west, lon0), (east, lon1)):
            off = (ours - gdals + 180) % 360 - 180
            self.assertLessEqual(abs(off), PLACED_PX * pixel, f"{name}: longitudes {bounds}, GDAL {lon0} to {lon1}")
        for ours, gdals in ((north, lat0), (south, lat1)):
            self.assertLessEqual(abs(ours - gdals), PLACED_PX * pixel, f"{name}: latitudes {bounds}, GDAL {lat0} to {lat1}")
        (self.folder / "out.gpkg").unlink()

    def assert_refused(self, name, *says, options=(), drawn=True):
        """By cut, and if `drawn` by render alike; nothing is left."""
        before = sorted(p.name for p in self.folder.iterdir() if p.name != "cache")
        first = self.assert_fails(FAILED, "cut", name, "-o", "out.gpkg", *options, says=[name, *says])
        if drawn:
            self.assert_fails(FAILED, "render", name, "-o", "out.png", *options, says=[name, *says])
        self.assert_nothing_but(*before)
        return first.stderr

    def run_command(self, command):
        done = subprocess.run(command, shell=True, cwd=self.folder, capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 0, f"{command}\n{done.stdout}{done.stderr}")

    def picture(self, name, *options, size=(72, 36)):
        make(self.folder / name, *size, *options)
        return name


class Drawn(GeoreferenceTest):
    """Placed within 0.01 pixels of gdaltransform's answer."""

    def check(self, crs, *options, size=(72, 36), cut=(), name="in.tif"):
        self.picture(name, *options, size=size)
        self.assert_drawn_as_gdal_says(name, crs, *cut)

    def test_pixel_size_is_of_longitude_and_latitude_or_of_arc(self):
        make(self.folder / "in.tif", 100, 40, "-a_srs", "EPSG:4326", "-a_ullr", 5, 47, 10, 45)
        self.assertIn("pixel size   0.05° by 0.05° of longitude and latitude, 3866", self.assert_done("info", "in.tif").stdout)
        for ours, true in zip(self.info("in.tif")["pixel_deg"], (0.05, 0.05)):
            self.assertAlmostEqual(ours, true, 9)
        wide_m, high_m = self.info("in.tif")["pixel_m"]
        self.assertAlmostEqual(wide_m / high_m, math.cos(math.radians(46)), 3)
        make(self.folder / "in.tif", 100, 40, "-a_srs", "EPSG:32632", "-a_ullr", 500000, 5100000, 600000, 5060000)
        self.assertRegex(self.assert_done("info", "in.tif").stdout, r"pixel size   0\.00897\d*° by 0\.00900\d*° of arc, 99\d")

    def test_says_nothing_and_is_two_to_one(self):
        self.picture("in.tif")
        self.assertIsNone(self.info("in.tif")["georeference"])
        self.assert_done("cut", "in.tif", "-o", "out.gpkg")
        info = json.loads(self.assert_done("info", "out.gpkg", "--json").stdout)
        self.assertEqual(info["bounds"], [-180, -90, 180, 90])

    def test_degrees_whole_planet(self):
        self.check("EPSG:4326", "-a_srs", "EPSG:4326", *PLANET)

    def test_degrees_part(self):
        self.check("EPSG:4326", "-a_srs", "EPSG:4326", "-a_ullr", 10, 50, 26, 42, size=(64, 32))

    def test_degrees_part_over_180(self):
        self.check("EPSG:4326", "-a_srs", "EPSG:4326", "-a_ullr", 170, 40, 190, 30, size=(40, 20))

    def test_degrees_part_beyond_180(self):
        self.check("EPSG:4326", "-a_srs", "EPSG:4326", "-a_ullr", 200, 40, 240, 20, size=(40, 20))

    def test_pixel_is_point_on_the_grid(self):
        self.check("EPSG:4326", "-a_srs", "EPSG:4326", "-a_ullr", 10, 50, 26, 42, "-mo", "AREA_OR_POINT=Point",
                   size=(64, 32))
        self.assertTrue(self.info("in.tif")["georeference"]["pixel_is_point"])

    def test_another_geographic_system(self):
        self.check("EPSG:4326", "-a_srs", "EPSG:4269", "-a_ullr", -100, 50, -84, 42, size=(64, 32))

    def test_plate_carree_in_metres(self):
        self.check("EPSG:4326", "-a_srs", "EPSG:4087", "-a_ullr", -20037508.342789244, 10018754.171394622,
                   20037508.342789244, -10018754.171394622)

    def test_moon_in_degrees(self):
        self.check(MOON_DEGREES, "-a_srs", MOON_DEGREES, *PLANET)

    def test_moon_in_metres(self):
        self.check(MOON_DEGREES, "-a_srs", MOON_METRES, "-a_ullr", -MOON_HALF, MOON_HALF / 2, MOON_HALF, -MOON_HALF / 2)

    def test_part_of_the_moon_in_metres(self):
        degree = MOON_HALF / 180
        self.check(MOON_DEGREES, "-a_srs", MOON_METRES, "-a_ullr", 10 * degree, 50 * degree, 26 * degree, 42 * degree,
                   size=(64, 32))

    def test_part_in_metres_from_another_meridian(self):
        degree = MOON_HALF / 180
        self.check(MOON_DEGREES, "-a_srs", MOON_METRES + " +lon_0=180", "-a_ullr", 10 * degree, 50 * degree,
                   26 * degree, 42 * degree, size=(64, 32))

    def test_mars_ellipsoid(self):
        self.check(MARS_FIGURE, "-a_srs", MARS_FIGURE, *PLANET)
        self.assertEqual(self.options_for("in.tif"), ["--body", "mars"])

    def test_mars_sphere(self):
        self.check(MARS_SPHERE, "-a_srs", MARS_SPHERE, *PLANET)
        self.assertEqual(self.options_for("in.tif"), ["--body", "mars"])

    def test_names_of_the_iau(self):
        half = math.pi * 3396190
        self.check(MARS_SPHERE, "-a_srs", "IAU_2015:49910", "-a_ullr", -half, half / 2, half, -half / 2)
        self.assertEqual(self.options_for("in.tif"), ["--body", "mars"])
        self.check(MARS_FIGURE, "-a_srs", "IAU_2015:49901", *PLANET)
        self.assertEqual(self.options_for("in.tif"), ["--body", "mars"])
        self.picture("in.tif", "-a_srs", "IAU_2015:49902", *PLANET)
        self.assertEqual(self.options_for("in.tif"), ["--body", "mars"])

    def test_world_files_in_degrees(self):
        for picture, world in (("a.png", "a.pgw"), ("b.png", "b.PGW"), ("c.png", "c.wld"), ("d.jpg", "d.jgw"),
                               ("e.png", "e.Pgw"), ("f.tif", "f.tfw")):
            with self.subTest(world):
                self.picture(picture, "-of", {"png": "PNG", "jpg": "JPEG", "tif": "GTiff"}[picture[-3:]], size=(64, 32))
                self.write(world, b"0.25\n0\n0\n-0.25\n10.125\n49.875\n")
                self.assert_done("cut", picture, "-o", "out.gpkg", "--force")
                info = json.loads(self.assert_done("info", "out.gpkg", "--json").stdout)
                for ours, said in zip(info["bounds"], (10, 42, 26, 50)):
                    self.assertAlmostEqual(ours, said, delta=PLACED_PX * 0.25)

    def test_world_file_and_prj(self):
        self.picture("in.png", "-of", "PNG", size=(64, 32))
        self.write("in.pgw", b"0.25\n0\n0\n-0.25\n10.125\n49.875\n")
        self.write("in.prj", gdal("gdalsrsinfo", "-o", "wkt_esri", "EPSG:4326").encode())
        self.assertEqual(self.info("in.png")["georeference"]["source"], "in.pgw, in.prj")
        self.assertIn("WGS 84", self.info("in.png")["georeference"]["crs"]["name"])
        self.assert_drawn_as_gdal_says("in.png", "EPSG:4326", source_crs=("-s_srs", "EPSG:4326"))

    def test_gdals_own_file_beside(self):
        self.check("EPSG:4326", "-of", "PNG", "-a_srs", "EPSG:4326", "-a_ullr", 10, 50, 26, 42, size=(64, 32),
                   name="in.png")
        self.assertTrue((self.folder / "in.png.aux.xml").exists())

    def test_world_file_that_agrees(self):
        self.check("EPSG:4326", "-co", "TFW=YES", "-a_srs", "EPSG:4326", "-a_ullr", 10, 50, 26, 42, size=(64, 32))
        self.assertTrue((self.folder / "in.tfw").exists())

    def test_transformation_matrix(self):
        matrix = [0.25, 0, 0, 10, 0, -0.25, 0, 50, 0, 0, 0, 0, 0, 0, 0, 1.0]
        self.write("in.tif", tiff(64, 32, [DEGREES, (MATRIX, 12, matrix)]))
        self.assert_drawn_as_gdal_says("in.tif", "EPSG:4326")

    def test_tags_without_keys_in_degrees(self):
        self.write("in.tif", tiff(64, 32, placed_at(10, 50, 0.25, 0.25)))
        self.assert_drawn_as_gdal_says("in.tif", "EPSG:4326", source_crs=("-s_srs", "EPSG:4326"))

    def test_planet_by_nodes(self):
        half = 2.5
        self.picture("in.tif", "-ot", "UInt16", "-a_srs", "EPSG:4326", "-a_ullr", -180 - half, 90 + half, 180 - half,
                     -90 - half, size=(72, 37))
        self.assert_done("cut", "in.tif", "--elevation", "-o", "out.gpkg", "--tile-size", "16")
        info = json.loads(self.assert_done("info", "out.gpkg", "--json").stdout)
        self.assertEqual(info["bounds"], [-180, -90, 180, 90])

    def test_bounds_overrule_the_place(self):
        self.picture("in.tif", "-a_srs", "EPSG:32633", "-a_ullr", 500000, 4650000, 506400, 4646800, size=(64, 32))
        self.assert_done("cut", "in.tif", "-o", "out.gpkg", "--bounds", "10,42,26,50")


class Refused(GeoreferenceTest):
    """The message says what the picture claims, and what helps."""

    def assert_cured(self, message, **words):
        command = commands_in(message)
        self.assertIsNotNone(command, message)
        for word, value in words.items():
            command = command.replace(word.replace("_", ":"), value)
        self.run_command(command)
        info = self.info(shlex.split(command)[-1])
        self.assertTrue(info["shown"], info)
        return info

    def test_ground_control_points(self):
        corners = []
        for x, y, lon, lat in ((0, 0, 10, 50), (64, 0, 26, 50), (64, 32, 26, 42), (0, 32, 10, 42)):
            corners += ["-gcp", x, y, lon, lat]
        for name in ("in.tif", "my dad's $map.tif"):
            self.picture(name, "-a_srs", "EPSG:4326", *corners, size=(64, 32))
            self.assertIn("ground control points", self.assert_done("info", name).stdout)
            self.assert_drawn_as_gdal_says(name, "EPSG:4326")

    def test_camera_model(self):
        self.write("in.tif", tiff(64, 32, [(50844, 12, [1.0] * 92)]))
        self.assert_refused("in.tif", "camera model (RPC) that cannot be used", "--bounds")

    def test_world_files_in_metres(self):
        # 2:1, and yet no whole planet.
        for picture, world in (("a.tif", "a.tfw"), ("b.jpg", "b.JGW"), ("c.png", "c.wld"), ("d.png", "d.WLD")):
            with self.subTest(world):
                self.picture(picture, "-of", {"png": "PNG", "jpg": "JPEG", "tif": "GTiff"}[picture[-3:]], size=(64, 32))
                self.write(world, b"10000\n0\n0\n-10000\n505000\n4645000\n")
                message = self.assert_refused(picture, world, "no coordinate system", "--crs EPSG:32633")
                info = self.assert_cured(message, EPSG_CODE="EPSG:32633")
                self.assertEqual(info["crs_code"] if "crs_code" in info else info["georeference"]["crs"]["code"],
                                 "EPSG:32633")

    def test_world_file_that_contradicts(self):
        self.picture("in.tif", "-a_srs", "EPSG:4326", "-a_ullr", 10, 50, 26, 42, size=(64, 32))
        self.write("in.tfw", b"0.25\n0\n0\n-0.25\n11.125\n49.875\n")
        message = self.assert_refused("in.tif", "GeoTIFF tags", "in.tfw", "differently")
        self.run_command(commands_in(message))
        self.assert_drawn_as_gdal_says("in-own.tif", "EPSG:4326")

    def test_another_body(self):
        self.picture("in.tif", "-a_srs", MOON_DEGREES, *PLANET)
        self.assert_refused("in.tif", "1737400", "earth has 6378137", "--body moon", options=["--body", "earth"])
        self.assert_refused("in.tif", "mars has 3396190", "--body moon", options=["--body", "mars"])
        self.assert_done("cut", "in.tif", "-o", "out.gpkg", "--body", "moon")
        self.assert_done("render", "in.tif", "-o", "out.png", "--size", "64x64", "--body", "moon")

    def test_the_body_that_a_picture_states_is_drawn(self):
        for name, kind in (("in.tif", "GTiff"), ("in.png", "PNG")):
            self.picture(name, "-of", kind, "-a_srs", MOON_DEGREES, *PLANET)
            self.assert_done("cut", name, "-o", "out.gpkg", "--force")
            self.assertEqual(json.loads(self.assert_done("info", "out.gpkg", "--json").stdout)["body"], "moon")
            self.assert_done("render", name, "-o", "own.png", "--size", "64x64")
            self.assert_done("render", name, "-o", "said.png", "--size", "64x64", "--body", "moon")
            self.assertEqual((self.folder / "own.png").read_bytes(), (self.folder / "said.png").read_bytes())
            # An overlay is of the body of TILESET, here the Earth.
            self.assert_fails(FAILED, "render", "--overlay", name, "-o", "no.png", says=["1737400", "--body moon"])

    def test_another_body_in_a_projection(self):
        self.picture("in.tif", "-a_srs", "+proj=sinu +R=1560800 +units=m +no_defs", "-a_ullr", 0, 320000, 640000, 0)
        self.assert_refused("in.tif", "1560800", "earth has 6378137", "--body europa", options=["--body", "earth"])
        self.assert_refused("in.tif", "1560800", "moon has 1737400", options=["--body", "moon"])

    def test_a_body_without_a_name(self):
        self.picture("in.tif", "-a_srs", "+proj=longlat +a=289000 +b=229000 +no_defs", *PLANET)
        self.assert_refused("in.tif", "--body 289000,0.2076", options=["--body", "earth"])
        self.assert_refused("in.tif", "229000", options=["--body", "289000,0"])
        self.assert_drawn_as_gdal_says("in.tif", "+proj=longlat +a=289000 +b=229000 +no_defs")

    def test_a_claim_that_comes_after_the_first_view(self):
        self.picture("in.png", "-of", "PNG")
        self.assert_done("render", "in.png", "-o", "out.png", "--size", "64x64")
        self.write("in.pgw", b"10000\n0\n0\n-10000\n505000\n4645000\n")
        self.assert_fails(FAILED, "render", "in.png", "-o", "out.png", says=["in.pgw"])

    def test_nowhere_on_the_planet(self):
        self.picture("in.tif", "-a_srs", "+proj=ortho +lat_0=0 +lon_0=0 +R=1737400 +units=m +no_defs", "-a_ullr", 3e6, 3e6,
                     4e6, 2.5e6)
        self.assert_refused("in.tif", "no pixel of it has a place", "--crs", options=["--body", "moon"])

    def test_more_than_a_planet(self):
        self.picture("in.tif", "-a_srs", "EPSG:4326", "-a_ullr", -180, 120, 180, -60)
        self.assert_refused("in.tif", "more than a planet", "--bounds")

    def test_turned_more_than_a_planet(self):
        self.picture("in.png", "-of", "PNG", "-a_srs", "EPSG:4326")
        self.write("in.pgw", b"1.40625\n0\n255\n-1.40625\n-179.296875\n89.296875\n")
        self.assert_refused("in.png", "more than a planet", "--bounds")


class Words(GeoreferenceTest):
    """The user's words win, and a message says so if the picture says otherwise."""

    UTM = "-a_srs", "EPSG:32633", "-a_ullr", 500000, 4650000, 1140000, 4330000

    def bounds(self, *options, picture="in.tif"):
        done = self.assert_done("cut", picture, "-o", "out.gpkg", "--tile-size", "16", "--force", *options)
        return json.loads(self.assert_done("info", "out.gpkg", "--json").stdout)["bounds"], done.stderr

    def assert_near(self, bounds, expected, step):
        for ours, right in zip(bounds, expected):
            self.assertAlmostEqual(ours, right, delta=step, msg=f"{bounds}, {expected}")

    def test_crs_for_a_picture_without(self):
        self.picture("in.png", "-of", "PNG", size=(64, 32))
        self.write("in.pgw", b"10000\n0\n0\n-10000\n505000\n4645000\n")
        self.picture("same.tif", *self.UTM, size=(64, 32))
        same, _ = self.bounds(picture="same.tif")
        for crs in ("EPSG:32633", "+proj=utm +zone=33 +datum=WGS84", gdal("gdalsrsinfo", "-o", "wkt2", "EPSG:32633")):
            bounds, remarks = self.bounds("--crs", crs, picture="in.png")
            self.assert_near(bounds, same, 1e-6)
            self.assertNotIn("instead", remarks)

    def test_crs_against_the_picture(self):
        self.picture("in.tif", *self.UTM, size=(64, 32))
        right, _ = self.bounds()
        moved, remarks = self.bounds("--crs", "EPSG:32634")
        self.assertIn("UTM zone 33N", remarks)
        self.assertIn("--crs (WGS 84 / UTM zone 34N, EPSG:32634", remarks)
        self.assert_near(moved, [right[0] + 6, right[1], right[2] + 6, right[3]], 0.2)
        self.assertIn("UTM zone 33N", " ".join(self.info_with("in.tif", "--crs", "EPSG:32634")["remarks"]))

    def info_with(self, *words):
        return json.loads(self.assert_done("info", *words, "--json").stdout)

    def test_bounds_in_units_of_the_crs(self):
        self.picture("plain.png", "-of", "PNG", size=(64, 32))
        self.picture("same.tif", *self.UTM, size=(64, 32))
        bounds, _ = self.bounds("--crs", "EPSG:32633", "--bounds", "500000,4330000,1140000,4650000", picture="plain.png")
        self.assert_near(bounds, self.bounds(picture="same.tif")[0], 1e-6)
        self.assert_done("render", "plain.png", "-o", "out.png", "--size", "64x64", "--crs", "EPSG:32633", "--bounds",
                         "500000,4330000,1140000,4650000", "--camera", "40,18,3000000")
        self.assert_fails(WRONG_USAGE, "cut", "plain.png", "-o", "a.gpkg", "--crs", "EPSG:32633", "--bounds", "5,6,4,7",
                          says=["--bounds"])

    def test_bounds_against_the_picture(self):
        self.picture("in.tif", *self.UTM, size=(64, 32))
        bounds, remarks = self.bounds("--bounds", "10,42,26,50")
        self.assert_near(bounds, [10, 42, 26, 50], 1e-9)
        self.assertIn("--bounds is used instead", remarks)

    def test_bounds_that_fit_no_grid(self):
        self.picture("in.png", "-of", "PNG", size=(64, 32))
        bounds, _ = self.bounds("--bounds", "10.1,42,26.1,51", picture="in.png")
        self.assert_near(bounds, [10.1, 42, 26.1, 51], 0.3)

    def test_west(self):
        self.picture("in.png", "-of", "PNG")
        for west in ("0", "-90", "270", "1.25"):
            with self.subTest(west):
                bounds, _ = self.bounds(f"--west={west}", picture="in.png")
                self.assertEqual(bounds, [-180, -90, 180, 90])
                lon = (float(west) + 5.0 * 10 + 2.5 + 180) % 360 - 180
                told = gdal("gdallocationinfo", "-valonly", "-b", 1, "-geoloc", self.folder / "out.gpkg", lon, 42.5)
                self.assertAlmostEqual(float(told), brightness(10, 9, 72, 36), delta=BRIGHTNESS)
        self.picture("square.png", "-of", "PNG", size=(32, 32))
        self.assert_fails(FAILED, "cut", "square.png", "-o", "a.gpkg", "--west", "0", says=["square.png", "2:1", "--bounds"])
        self.assert_fails(WRONG_USAGE, "cut", "in.png", "-o", "a.gpkg", "--west", "0", "--bounds", "0,0,1,1", says=["--west"])
        self.assert_fails(WRONG_USAGE, "view", "in.png", "--west", "nan", says=["--west"])

    def test_bounds_from_zero(self):
        self.picture("in.png", "-of", "PNG")
        bounds, _ = self.bounds("--bounds", "0,-90,360,90", picture="in.png")
        self.assertEqual(bounds, [-180, -90, 180, 90])

    def test_damage_is_overruled(self):
        self.write("in.tif", tiff(64, 32, HOSTILE["keys of bytes"]))
        bounds, remarks = self.bounds("--bounds", "10,42,26,50")
        self.assert_near(bounds, [10, 42, 26, 50], 1e-9)
        self.assertIn("used instead", remarks)
        self.write("in.tif", tiff(64, 32, HOSTILE["unknown geographic code"]))
        bounds, remarks = self.bounds("--crs", "EPSG:4326")
        self.assert_near(bounds, [10, 42, 26, 50], 1e-9)
        self.assertIn("31999", remarks)

    def test_latitude_against_the_picture(self):
        self.picture("in.tif", "-a_srs", MARS_SPHERE, *PLANET, size=(720, 360))
        done = self.assert_done("cut", "in.tif", "-o", "out.gpkg", "--body", "mars", "--latitude", "graphic")
        self.assertIn("planetocentric latitudes; --latitude graphic is used instead", done.stderr)
        done = self.assert_done("cut", "in.tif", "-o", "b.gpkg", "--body", "mars", "--latitude", "centric")
        self.assertNotIn("instead", done.stderr)

    def test_words_that_are_nothing(self):
        self.picture("in.png", "-of", "PNG")
        for crs in ("nonsense", "EPSG:999999", "/etc/passwd", "EPSG:5773"):
            self.assert_fails(FAILED, "cut", "in.png", "-o", "a.gpkg", "--crs", crs, says=["in.png", "coordinate system"])
        self.assert_fails(FAILED, "cut", "in.png", "-o", "a.gpkg", "--crs", "EPSG:32633", says=["--bounds"])

    def test_words_about_a_tile_set(self):
        self.picture("in.png", "-of", "PNG")
        self.assert_done("cut", "in.png", "-o", "out.gpkg")
        self.assert_fails(FAILED, "render", "out.gpkg", "-o", "a.png", "--west", "0", says=["out.gpkg", "--west"])

    def test_each_place_has_its_own_tiles_in_the_cache(self):
        self.picture("in.png", "-of", "PNG")
        shots = {}
        for word in ("--west=-180", "--west=0", "--west=-180"):
            done = self.assert_done("render", "in.png", "-o", "out.png", "--size", "64x64", "--unlit", word)
            self.assertEqual("cutting" in done.stderr, word not in shots, done.stderr)
            shots.setdefault(word, (self.folder / "out.png").read_bytes())
            self.assertEqual(shots[word], (self.folder / "out.png").read_bytes())
        self.assertNotEqual(*shots.values())

    def test_shards_of_a_resampled_picture(self):
        self.picture("in.tif", *self.UTM, size=(640, 320))
        self.assert_done("cut", "in.tif", "-o", "whole.gpkg", "--tile-size", "16")
        for part in ("1/3", "2/3", "3/3"):
            self.assert_done("cut", "in.tif", "-o", "parts.gpkg", "--tile-size", "16", "--shard", part)
        self.assert_done("cut", "in.tif", "-o", "parts.gpkg", "--tile-size", "16", "--join")
        self.assertEqual(*((self.folder / f"{name}.gpkg").read_bytes() for name in ("whole", "parts")))

    def test_heights(self):
        for kind in ("Int16", "UInt16", "Float32"):
            for place in (("-a_srs", "EPSG:4326", "-a_ullr", 0, 90, 360, -90), self.UTM,
                          ("-a_srs", "EPSG:4326", "-a_ullr", -2.5, 92.5, 357.5, -92.5)):
                with self.subTest(kind, place=place[:3]):
                    size = (72, 37) if -2.5 in place else (72, 36)
                    self.picture("in.tif", "-ot", kind, *place, size=size)
                    self.assert_done("cut", "in.tif", "--elevation", "-o", "out.gpkg", "--tile-size", "16", "--force")
                    lon, lat = places(self.folder / "in.tif", [(30.5, 12.5)], "EPSG:4326")[0]
                    lon = (lon + 180) % 360 - 180
                    told = gdal("gdallocationinfo", "-valonly", "-geoloc", self.folder / "out.gpkg", lon, lat)
                    self.assertAlmostEqual(float(told), brightness(30, 12, *size), delta=BRIGHTNESS)


class Parts(GeoreferenceTest):
    """Mosaics whose parts say where they lie."""

    def halves(self, *wests):
        for name, west in zip("ab", wests):
            self.picture(f"{name}.tif", "-a_srs", "EPSG:4326", "-a_ullr", west, 90, west + 180, -90, size=(36, 36))

    def bounds(self):
        return json.loads(self.assert_done("info", "out.gpkg", "--json").stdout)["bounds"]

    def test_in_order(self):
        self.halves(-180, 0)
        self.assert_done("cut", "a.tif", "b.tif", "-o", "out.gpkg")
        self.assertEqual(self.bounds(), [-180, -90, 180, 90])

    def test_from_zero(self):
        self.halves(0, 180)
        for options in ([], ["--mosaic", "2x1"]):
            self.assert_done("cut", "a.tif", "b.tif", "-o", "out.gpkg", "--force", *options)
            self.assertEqual(self.bounds(), [-180, -90, 180, 90])
            for lon, column in ((2, 0), (178, 35)):
                told = gdal("gdallocationinfo", "-valonly", "-b", 1, "-geoloc", self.folder / "out.gpkg", lon, 42.5)
                self.assertAlmostEqual(float(told), brightness(column, 9, 36, 36), delta=BRIGHTNESS)

    def test_an_order_that_contradicts(self):
        self.halves(-180, -90)
        self.assert_fails(FAILED, "cut", "a.tif", "b.tif", "-o", "out.gpkg", "--mosaic", "2x1", says=["b.tif", "--mosaic"])

    def test_names_that_contradict(self):
        for x, name in enumerate(("x.A1.tif", "x.B1.tif")):
            self.picture(name, "-a_srs", "EPSG:4326", "-a_ullr", 90 * x, 90, 90 * x + 90, 0, size=(36, 36))
        self.assert_fails(FAILED, "cut", "x.A1.tif", "x.B1.tif", "-o", "out.gpkg", says=["x.A1.tif", "its name"])

    def test_in_metres(self):
        for x, name in enumerate(("a.tif", "b.tif")):
            self.picture(name, "-a_srs", "EPSG:32633", "-a_ullr", 500000 + 36000 * x, 4650000, 536000 + 36000 * x,
                         4614000, size=(36, 36))
        self.assert_done("cut", "a.tif", "b.tif", "-o", "out.gpkg")
        joined = self.folder / "joined.vrt"
        gdal("gdalbuildvrt", "-q", joined, self.folder / "a.tif", self.folder / "b.tif")
        gdal("gdal_translate", "-q", joined, self.folder / "joined.tif")
        self.assert_done("cut", "joined.tif", "-o", "joined.gpkg")
        one, two = self.info("out.gpkg"), self.info("joined.gpkg")
        self.assertEqual([one[key] for key in ("bounds", "max_level")], [two[key] for key in ("bounds", "max_level")])


TEXT = 34737
NAN, HUGE = float("nan"), 1e308
KEYS = (1024, 2), (1025, 1), (2048, 4326)
MOON_KEYS = (1024, 2), (1025, 1), (2048, 32767), (2057, DOUBLES, 1, 0), (2058, DOUBLES, 1, 1)
HERE = placed_at(10, 50, 0.25, 0.25)
HOSTILE = {
    "scale of NaN": [DEGREES, *placed_at(10, 50, NAN, 0.25)],
    "scale of 0": [DEGREES, *placed_at(10, 50, 0, 0)],
    "scale of 1e308": [DEGREES, *placed_at(10, 50, HUGE, HUGE)],
    "scale of 1e-308": [DEGREES, *placed_at(10, 50, 1e-308, 1e-308)],
    "scale of infinity": [DEGREES, *placed_at(10, 50, math.inf, 0.25)],
    "tie point of NaN": [DEGREES, *placed_at(NAN, 50, 0.25, 0.25)],
    "tie point of 1e308": [DEGREES, *placed_at(HUGE, 50, 0.25, 0.25)],
    "scale without tie point": [DEGREES, (SCALE, 12, [0.25, 0.25, 0])],
    "scale of one number": [DEGREES, (SCALE, 12, [0.25]), HERE[1]],
    "tie point of three numbers": [DEGREES, HERE[0], (TIES, 12, [0.0, 0.0, 0.0])],
    "tie point without scale": [DEGREES, HERE[1]],
    "matrix of 12": [DEGREES, (MATRIX, 12, [0.25] * 12)],
    "matrix of zeros": [DEGREES, (MATRIX, 12, [0.0] * 16)],
    "matrix of NaN": [DEGREES, (MATRIX, 12, [NAN] * 16)],
    "keys of bytes": [(34735, 1, list(range(32))), *HERE],
    "keys of one number": [(34735, 3, [1]), *HERE],
    "keys of another version": [(34735, 3, [9, 1, 0, 1, 1024, 0, 1, 2]), *HERE],
    "key beyond the numbers": [geo_keys(*MOON_KEYS), (DOUBLES, 12, [1737400.0]), *HERE],
    "key of 65535 numbers": [geo_keys((1024, 2), (2048, 32767), (2057, DOUBLES, 65535, 0)), (DOUBLES, 12, [1737400.0]),
                             *HERE],
    "short key in doubles": [geo_keys((1024, DOUBLES, 1, 0), (2048, 4326)), (DOUBLES, 12, [2.0]), *HERE],
    "text key in doubles": [geo_keys(*KEYS, (1026, DOUBLES, 40000, 60000)), (DOUBLES, 12, [2.0]), *placed_at(10.1, 50, 0.25, 0.25)],
    "radius of NaN": [geo_keys(*MOON_KEYS), (DOUBLES, 12, [NAN, NAN]), *HERE],
    "radius of 1e308": [geo_keys(*MOON_KEYS), (DOUBLES, 12, [HUGE, HUGE]), *HERE],
    "negative radius": [geo_keys(*MOON_KEYS), (DOUBLES, 12, [-1737400.0, -1737400.0]), *HERE],
    "unknown geographic code": [geo_keys((1024, 2), (1025, 1), (2048, 31999)), *HERE],
    "geographic code of a projected system": [geo_keys((1024, 2), (1025, 1), (2048, 32633)), *HERE],
    "unknown projected code": [geo_keys((1024, 1), (1025, 1), (3072, 32999)), *HERE],
    "projected without a projection": [geo_keys((1024, 1), (1025, 1), (2048, 4326)), *HERE],
    "unknown projection": [geo_keys((1024, 1), (1025, 1), (2048, 4326), (3072, 32767), (3074, 32767), (3075, 9999)), *HERE],
    "geocentric": [geo_keys((1024, 3), (1025, 1), (2048, 4326)), *HERE],
    "unknown model": [geo_keys((1024, 77), (1025, 1), (2048, 4326)), *HERE],
    "wgs 84 with the moon's radius": [geo_keys(*KEYS, (2057, DOUBLES, 1, 0)), (DOUBLES, 12, [1737400.0]), *HERE],
    "wgs 84 with bessel's ellipsoid": [geo_keys(*KEYS, (2057, DOUBLES, 1, 0), (2059, DOUBLES, 1, 1)),
                                       (DOUBLES, 12, [6377397.155, 299.1528128]), *HERE],
    "wgs 84 in radians": [geo_keys(*KEYS, (2054, 9101)), *HERE],
    "projected system and no place": [geo_keys((1024, 1), (1025, 1), (3072, 32633))],
    "metres in degrees": [DEGREES, *placed_at(500000, 4650000, 10, 10)],
    "scale that counts 2^31": [DEGREES, (SCALE, 12, [0.25, 0.25, 0.0], 2**31), HERE[1]],
    "tie points that count 2^32 - 1": [DEGREES, HERE[0], (TIES, 12, [0.0, 0, 0, 10, 50, 0], 2**32 - 1)],
    "a megabyte of WKT": [geo_keys((1024, 1), (1025, 1), (3072, 32767), (3073, TEXT, 60000, 0)),
                          (TEXT, 2, b"ESRI PE String = " + b"PROJCS[" * 150000 + b"\0"), *HERE],
    "60 kB of WKT": [geo_keys((1024, 1), (1025, 1), (3072, 32767), (3073, TEXT, 59000, 0)),
                     (TEXT, 2, b"ESRI PE String = " + b"PROJCS[" * 8400 + b"|\0"), *HERE],
    "latitudes over 90": [DEGREES, *placed_at(10, 95, 0.25, 0.25)],
    "metres without keys": placed_at(500000, 4650000, 10, 10),
}


class Hostile(GeoreferenceTest):
    """Tags that are damaged, missing, unknown or contradict each other: refused in a second, with a cure. By cut: render
    reads a place by the same function, as Refused shows."""

    def test_tags(self):
        for name, tags in HOSTILE.items():
            with self.subTest(name):
                (self.folder / "out.gpkg").unlink(missing_ok=True)
                self.write("in.tif", tiff(64, 32, tags))
                message = self.assert_refused("in.tif", drawn=False)
                self.assertRegex(message, "--crs|--bounds|--body|gdal", message)
                self.assertNotIn("PROJ:", message)
                self.assertEqual(len(message.strip().splitlines()), 1, message)
                info = self.info("in.tif")
                self.assertFalse(info["shown"])
                self.assertIn(info["refused"], message)

    def test_the_advice_for_what_cannot_be_believed(self):
        self.write("in.tif", tiff(64, 32, HOSTILE["keys of bytes"]))
        command = commands_in(self.assert_refused("in.tif", "GeoTIFF tags"))
        for word, value in (("EPSG:CODE", "EPSG:4326"), ("WEST NORTH EAST SOUTH", "10 50 26 42")):
            command = command.replace(word, value)
        done = subprocess.run(command, shell=True, cwd=self.folder, capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 0, f"{command}\n{done.stderr}")
        self.assert_drawn_as_gdal_says("in-placed.tif", "EPSG:4326")

    def test_files_beside(self):
        broken = {"in.pgw": [b"1 2 3", b"no numbers at all", b"", b"nan 0 0 nan 0 0", b"0,25\n0\n0\n-0,25\n10\n50\n", b"\0" * 100,
                             b"1e308 0 0 -1e308 0 0", b"9" * 100000],
                  "in.png.aux.xml": [b"<PAMDataset>", b"<PAMDataset><GeoTransform>1,2</GeoTransform></PAMDataset>",
                                     b"<PAMDataset><SRS>nonsense</SRS></PAMDataset>",
                                     b"<PAMDataset><SRS>+proj=longlat +nadgrids=/dev/stdin</SRS></PAMDataset>",
                                     b"<PAMDataset><SRS>GEOGCS[</SRS></PAMDataset>",
                                     b"<PAMDataset><SRS>" + b"GEOGCS[" * 100000 + b"</SRS></PAMDataset>",
                                     b"<PAMDataset><GeoTransform>0,0,0,0,0,0</GeoTransform></PAMDataset>"]}
        for beside, contents in broken.items():
            for content in contents:
                with self.subTest(beside, content=content[:40]):
                    self.picture("in.png", "-of", "PNG")
                    self.write(beside, content)
                    self.assert_refused("in.png", "in.p", drawn=False)
            (self.folder / beside).unlink()

    def test_a_pipe_beside_is_not_read(self):
        self.picture("in.png", "-of", "PNG")
        os.mkfifo(self.folder / "in.pgw")
        self.assert_done("cut", "in.png", "-o", "out.gpkg")


if __name__ == "__main__":
    unittest.main()
