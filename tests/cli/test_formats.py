"""Rasters of formats that GDAL reads: shown in their place, read as numbers, refused with a cure."""

import json
import pathlib
import subprocess
import unittest

import placement
from georeferenced import gdal
from pictures import PDS3_LABEL
from program import BLUE_MARBLE, DONE, DONE_IN_PART, FAILED, ProgramTest

# Resampled pixels lie within this, in pixels of the tiles (test_placement.py).
RESAMPLED_PX = 0.05
SIZE = (128, 96)
UTM = ("-a_srs", "EPSG:32633", "-a_ullr", 500000, 4650000, 1140000, 4170000)
MARS = "+proj=longlat +R=3396190 +no_defs"
MARS_EQC = ("-a_srs", "+proj=eqc +R=3396190 +no_defs", "-a_ullr", 100000, 3000000, 1380000, 2040000)

# Format: ending, options of gdal_translate, place, degrees.
FORMATS = {
    "JP2OpenJPEG": ("jp2", ("-co", "QUALITY=100", "-co", "REVERSIBLE=YES"), UTM, "EPSG:4326"),
    "VRT": ("vrt", (), UTM, "EPSG:4326"),
    "ENVI": ("dat", (), UTM, "EPSG:4326"),
    "netCDF": ("nc", (), UTM, "EPSG:4326"),
    "HFA": ("img", (), UTM, "EPSG:4326"),
    "ISIS3": ("cub", (), MARS_EQC, MARS),
    "FITS": ("fits", (), MARS_EQC, MARS),
    "PDS4": ("xml", (), MARS_EQC, MARS),
    "HDF4Image": ("hdf", (), UTM, "EPSG:4326"),
}

# The truth counts latitudes on the sphere.
SPHERE_OF = {"EPSG:4326": (), MARS: ("--body", "3396190,0")}


class FormatsTest(ProgramTest):
    def painted(self, place):
        """A TIFF with spots; the truth is where its place puts them by PROJ."""
        path = self.folder / "truth.tif"
        placement.place_spots(path, SIZE, *place)
        return path

    def assert_in_place(self, picture, truth, degrees, *options):
        tiles = self.folder / "tiles.gpkg"
        self.assert_done("cut", picture, "-o", tiles, "--format", "png", "--force", *options)
        flat = self.folder / "flat.tif"
        gdal("gdal_translate", "-q", tiles, flat)
        self.assertLess(max(placement.spot_errors(truth, flat, degrees, SIZE)), RESAMPLED_PX, picture)

    def assert_body(self, picture, body):
        self.assert_done("cut", picture, "-o", "own.gpkg", "--force")
        self.assertEqual(json.loads(self.assert_done("info", "own.gpkg", "--json").stdout)["body"], body)

    def test_pictures_are_where_they_say(self):
        for name, (ending, options, place, degrees) in FORMATS.items():
            with self.subTest(name):
                truth = self.painted(place)
                picture = self.folder / f"spots.{ending}"
                gdal("gdal_translate", "-q", "-of", name, *options, truth, picture)
                self.assert_in_place(picture, truth, degrees, *SPHERE_OF[degrees])
                self.assert_done("render", picture, "-o", "a.png", "--size", "64x64")
                self.assert_body(picture, "mars" if degrees == MARS else "")
                self.assertIn("pixels", self.assert_done("info", picture).stdout)

    def test_formats_without_a_place_are_a_planet(self):
        for name, ending in (("GIF", "gif"), ("BMP", "bmp"), ("PNM", "pgm"), ("ISIS2", "cub")):
            with self.subTest(name):
                picture = self.folder / f"my dad's.{ending}"
                gdal("gdal_translate", "-q", "-of", name, "-b", 1, "-outsize", 128, 64, BLUE_MARBLE, picture)
                self.assert_done("render", picture, "-o", "a.png", "--size", "64x64")

    def test_a_pds3_label_of_mars(self):
        width, height = SIZE
        truth = self.painted(MARS_EQC)
        (self.folder / "SPOTS.IMG").write_bytes(placement.spotted(width, height))
        label = self.folder / "spots.lbl"
        # PDS counts from the middle of the first pixel, towards the pole's origin of the projection.
        label.write_text(PDS3_LABEL.format(width=width, height=height, line=299.5, sample=-10.5))
        told = json.loads(gdal("gdalinfo", "-json", label))["geoTransform"]
        self.assertEqual(told[:1] + told[3:4], [100000.0, 3000000.0], "the label says another place than the truth")
        self.assert_in_place(label, truth, MARS, *SPHERE_OF[MARS])
        self.assert_body(label, "mars")

    def test_control_points_place_a_picture(self):
        truth = self.painted(UTM)
        points = []
        for x, y in ((0, 0), (128, 0), (0, 96), (128, 96)):
            points += ["-gcp", x, y, 500000 + 5000 * x, 4650000 - 5000 * y]
        picture = self.folder / "points.img"
        plain = self.folder / "plain.pgm"
        plain.write_bytes(b"P5\n128 96\n255\n" + placement.spotted(*SIZE))
        gdal("gdal_translate", "-q", "-of", "HFA", "-a_srs", "EPSG:32633", *points, plain, picture)
        self.assertIn("control points", self.assert_done("info", picture).stdout)
        self.assert_in_place(picture, truth, "EPSG:4326")

    def test_a_file_of_several_rasters_names_them(self):
        source = self.folder / "two.tif"
        gdal("gdal_translate", "-q", "-b", 1, "-b", 1, "-ot", "Float32", "-scale", 0, 255, -5, 30, self.painted(UTM), source)
        several = self.folder / "two.nc"
        gdal("gdal_translate", "-q", "-of", "netCDF", source, several)
        first = self.assert_done("render", several, "-o", "first.png", "--size", "64x64")
        self.assertIn("it holds 2 rasters", first.stderr)
        second = f'NETCDF:"{several}":Band2'
        self.assertIn("Band2", first.stderr)
        self.assert_done("render", second, "-o", "second.png", "--size", "64x64")
        self.assertEqual((self.folder / "first.png").read_bytes(), (self.folder / "second.png").read_bytes())
        self.assert_done("cut", second, "-o", "second.gpkg")
        self.assert_done("render", "--elevation", second, "-o", "relief.png", "--size", "64x64")

    def test_heights_of_any_format(self):
        heights = self.folder / "heights.dat"
        gdal("gdal_translate", "-q", "-of", "ENVI", "-ot", "Int16", "-scale", 0, 255, 0, 3000, self.painted(UTM), heights)
        self.assert_done("cut", "--elevation", heights, "-o", "heights.gpkg")
        self.assert_done("render", "--elevation", heights, "-o", "relief.png", "--size", "64x64", "--camera",
                         "40,18,900000")

    def test_a_vrt_reads_its_own_folder_alone(self):
        truth = self.painted(UTM)
        inside = self.folder / "inner"
        inside.mkdir()
        for name in (truth, "/vsicurl/http://127.0.0.1:9/a.tif", "http://127.0.0.1:9/a.tif", "../truth.tif"):
            with self.subTest(str(name)):
                vrt = inside / "a.vrt"
                relative = 1 if str(name).startswith("..") else 0
                vrt.write_text('<VRTDataset rasterXSize="8" rasterYSize="8"><VRTRasterBand dataType="Byte" band="1">'
                               f'<SimpleSource><SourceFilename relativeToVRT="{relative}">{name}</SourceFilename>'
                               '<SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>')
                self.assert_fails(FAILED, "render", vrt, "-o", "a.png", says=["a.vrt", "its folder", "gdal_translate"])
                self.assertFalse((self.folder / "a.png").exists())

    def test_damage_is_named(self):
        picture = self.folder / "spots.jp2"
        gdal("gdal_translate", "-q", "-of", "JP2OpenJPEG", self.painted(UTM), picture)
        picture.write_bytes(picture.read_bytes()[:400])
        done = self.run_program("render", picture, "-o", "a.png", "--size", "64x64")
        self.assertIn(done.returncode, (FAILED, DONE_IN_PART), done.stderr)
        self.assertIn("spots.jp2", done.stderr)

    def test_without_gdal_the_message_names_the_package(self):
        picture = self.folder / "spots.jp2"
        gdal("gdal_translate", "-q", "-of", "JP2OpenJPEG", self.painted(UTM), picture)
        (self.folder / "libgdal.so.32").write_text("no library")
        self.assert_fails(FAILED, "render", picture, "-o", "a.png", says=["spots.jp2", "libgdal32"],
                          environment={"LD_LIBRARY_PATH": str(self.folder)})

    def test_plain_pictures_load_no_gdal(self):
        for name in ((), (BLUE_MARBLE,)):
            done = self.run_program("render", *name, "-o", "a.png", "--size", "64x64", environment={"LD_DEBUG": "libs"})
            self.assertEqual(done.returncode, DONE)
            self.assertIn("find library=", done.stderr)
            self.assertNotIn("libgdal", done.stderr)


if __name__ == "__main__":
    unittest.main()
