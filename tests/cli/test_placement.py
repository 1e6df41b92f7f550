"""Pictures of any georeference come where gdaltransform puts them: bright spots are found again in the cut tiles."""

import json
import math
import shlex
import unittest

import placement
from georeferenced import DEGREES, DOUBLES, MATRIX, geo_keys, placed_at, tiff
from program import ProgramTest

# Pixels as they are lie where they say; resampled ones within this, in pixels of the tiles.
UNCHANGED_PX = 0.01
RESAMPLED_PX = 0.05
AS_IT_IS, ROLLED, RESAMPLED = "as it is", "rolled", "resampled"

EARTH = "EPSG:4326"
MOON, MARS, EUROPA, VESTA = ("+proj=longlat +R=1737400 +no_defs", "+proj=longlat +R=3396190 +no_defs",
                             "+proj=longlat +R=1560800 +no_defs", "+proj=longlat +a=289000 +b=229000 +no_defs")
MARS_FIGURE = "+proj=longlat +a=3396190 +b=3376200 +no_defs"
SPHERE = "+proj=longlat +R=6378137 +no_defs"
MOON_HALF, MARS_HALF, EUROPA_HALF = math.pi * 1737400, math.pi * 3396190, math.pi * 1560800
WIDE, SIDE = (192, 96), (128, 96)


def box(west, north, pixel, size):
    return "-a_ullr", west, north, west + pixel * size[0], north - pixel * size[1]


def proj(text):
    return "-a_srs", text + " +no_defs"


# Name: degrees for GDAL, how it is drawn, size, options of gdal_translate.
ALL_ROUND = {
    "earth in degrees": (EARTH, AS_IT_IS, WIDE, "-a_srs", EARTH, *box(-180, 90, 1.875, WIDE)),
    "earth from 0": (EARTH, ROLLED, WIDE, "-a_srs", EARTH, *box(0, 90, 1.875, WIDE)),
    "earth from -90": (EARTH, ROLLED, WIDE, "-a_srs", EARTH, *box(-90, 90, 1.875, WIDE)),
    "earth from 0, half a pixel off": (EARTH, RESAMPLED, WIDE, "-a_srs", EARTH, *box(-0.9375, 90, 1.875, WIDE)),
    "earth from -180.01": (EARTH, RESAMPLED, WIDE, "-a_srs", EARTH, "-a_ullr", -180.01, 90.01, 180.01, -90.01),
    "earth from -180.4": (EARTH, RESAMPLED, WIDE, "-a_srs", EARTH, *box(-180.4, 90, 1.875, WIDE)),
    "overhang of half a pixel": (EARTH, RESAMPLED, (193, 97), "-a_srs", EARTH, *box(-180.9375, 90.9375, 1.875, (193, 97))),
    "plate carree in metres": (EARTH, AS_IT_IS, WIDE, "-a_srs", "EPSG:4087", "-a_ullr", -20037508.342789244,
                               10018754.171394622, 20037508.342789244, -10018754.171394622),
    "moon in metres from -180": (MOON, AS_IT_IS, WIDE, *proj("+proj=eqc +R=1737400"), "-a_ullr", -MOON_HALF,
                                 MOON_HALF / 2, MOON_HALF, -MOON_HALF / 2),
    "moon in metres from 0": (MOON, ROLLED, WIDE, *proj("+proj=eqc +R=1737400"), "-a_ullr", 0, MOON_HALF / 2,
                              2 * MOON_HALF, -MOON_HALF / 2),
    "moon in metres around 180": (MOON, ROLLED, WIDE, *proj("+proj=eqc +R=1737400 +lon_0=180"), "-a_ullr", -MOON_HALF,
                                  MOON_HALF / 2, MOON_HALF, -MOON_HALF / 2),
    "europa around 180": (EUROPA, ROLLED, WIDE, *proj("+proj=eqc +R=1560800 +lon_0=180"), "-a_ullr", -EUROPA_HALF,
                          EUROPA_HALF / 2, EUROPA_HALF, -EUROPA_HALF / 2),
    "europa in degrees from 0": (EUROPA, ROLLED, WIDE, "-a_srs", EUROPA, *box(0, 90, 1.875, WIDE)),
    "vesta in degrees": (VESTA, AS_IT_IS, WIDE, "-a_srs", VESTA, *box(-180, 90, 1.875, WIDE)),
    "vesta from 0": (VESTA, ROLLED, WIDE, "-a_srs", VESTA, *box(0, 90, 1.875, WIDE)),
    "mars on a sphere": (MARS, AS_IT_IS, WIDE, "-a_srs", MARS, *box(-180, 90, 1.875, WIDE)),
    "mars on its figure, from 0": (MARS_FIGURE, ROLLED, WIDE, "-a_srs", MARS_FIGURE, *box(0, 90, 1.875, WIDE)),
    "nearly all longitudes over 180": (EARTH, ROLLED, (180, 48), "-a_srs", EARTH, *box(11.25, 60, 1.875, (180, 48))),
    "band round the planet from 0": (EARTH, ROLLED, (192, 48), "-a_srs", EARTH, *box(0, 45, 1.875, (192, 48))),
}
PARTS = {
    "part on the grid": (EARTH, AS_IT_IS, SIDE, "-a_srs", EARTH, *box(10, 50, 0.125, SIDE)),
    "part over 180": (EARTH, AS_IT_IS, SIDE, "-a_srs", EARTH, *box(175, 50, 0.125, SIDE)),
    "part beyond 180": (EARTH, AS_IT_IS, SIDE, "-a_srs", EARTH, *box(200, 50, 0.125, SIDE)),
    "half a pixel off the grid": (EARTH, AS_IT_IS, SIDE, "-a_srs", EARTH, *box(10.0625, 50.0625, 0.125, SIDE)),
    "part over 180, half a pixel off": (EARTH, RESAMPLED, SIDE, "-a_srs", EARTH, *box(175.0625, 50, 0.125, SIDE)),
    "pixels that are not square": (EARTH, RESAMPLED, SIDE, "-a_srs", EARTH, "-a_ullr", 10, 50, 26, 41),
    "pixels that are no part of a turn": (EARTH, AS_IT_IS, SIDE, "-a_srs", EARTH, *box(10, 50, 0.1237, SIDE)),
    "pixel is point on the grid": (EARTH, AS_IT_IS, SIDE, "-a_srs", EARTH, *box(10, 50, 0.125, SIDE), "-mo",
                                   "AREA_OR_POINT=Point"),
    "grads from Paris": (EARTH, AS_IT_IS, SIDE, "-a_srs", "EPSG:4807", *box(0, 55, 0.125, SIDE)),
    "nad 83": (EARTH, AS_IT_IS, SIDE, "-a_srs", "EPSG:4269", *box(-100, 50, 0.125, SIDE)),
    # Projections
    "utm": (EARTH, RESAMPLED, SIDE, "-a_srs", "EPSG:32633", *box(500000, 4650000, 5000, SIDE)),
    "utm, columns westwards": (EARTH, RESAMPLED, SIDE, "-a_srs", "EPSG:32633", "-a_ullr", 1140000, 4650000, 500000, 4170000),
    "utm of a drone": (EARTH, RESAMPLED, SIDE, "-a_srs", "EPSG:32718", *box(300000, 8500000, 0.5, SIDE)),
    "web mercator": (EARTH, RESAMPLED, SIDE, "-a_srs", "EPSG:3857", *box(1e6, 8e6, 20000, SIDE)),
    "mercator of an ellipsoid": (EARTH, RESAMPLED, SIDE, "-a_srs", "EPSG:3395", *box(1e6, 8e6, 20000, SIDE)),
    "lambert conformal": (EARTH, RESAMPLED, SIDE, "-a_srs", "EPSG:2154", *box(300000, 6900000, 5000, SIDE)),
    "lambert azimuthal": (EARTH, RESAMPLED, SIDE, "-a_srs", "EPSG:3035", *box(3000000, 3400000, 10000, SIDE)),
    "albers": (EARTH, RESAMPLED, SIDE, "-a_srs", "EPSG:5070", *box(-1e6, 2.5e6, 10000, SIDE)),
    "lambert's cylinder": (EARTH, RESAMPLED, SIDE, "-a_srs", "EPSG:6933", *box(1e6, 5e6, 20000, SIDE)),
    "oblique stereographic": (EARTH, RESAMPLED, SIDE, "-a_srs", "EPSG:28992", *box(0, 600000, 2000, SIDE)),
    "own transverse mercator": (EARTH, RESAMPLED, SIDE, *proj("+proj=tmerc +lat_0=10 +lon_0=20 +k=0.9 +x_0=1000 "
                                                              "+ellps=GRS80"), *box(0, 320000, 5000, SIDE)),
    # Two hundred metres beside the same projection of the ellipsoid alone.
    "own conic on the datum of 1927": (EARTH, RESAMPLED, SIDE, *proj("+proj=eqdc +lat_0=33.76 +lon_0=-117.47 +lat_1=33.9 "
                                       "+lat_2=33.6 +datum=NAD27"), *box(-15000, 15000, 200, SIDE)),
    # Half a kilometre beside the same ellipsoid around WGS 84's centre.
    "own datum, seven parameters": (EARTH, RESAMPLED, SIDE, *proj("+proj=tmerc +lat_0=49.5 +lon_0=14 +ellps=bessel "
                                    "+towgs84=570.8,85.7,462.8,4.998,1.587,5.261,3.56"), *box(-15000, 15000, 200, SIDE)),
    "own datum, degrees": (EARTH, RESAMPLED, SIDE, *proj("+proj=longlat +ellps=bessel +towgs84=-148,507,685"),
                           "-a_ullr", 135, 36, 135.5, 35.5),
    "north pole": (EARTH, RESAMPLED, SIDE, "-a_srs", "EPSG:3413", *box(-2.4e6, -1.2e6, 20000, SIDE)),
    "south pole": (EARTH, RESAMPLED, SIDE, "-a_srs", "EPSG:3031", *box(1e6, 3e6, 20000, SIDE)),
    "moon's pole": (MOON, RESAMPLED, SIDE, *proj("+proj=stere +lat_0=90 +R=1737400"), *box(2e5, 7e5, 5000, SIDE)),
    "mars' south pole": (MARS, RESAMPLED, SIDE, *proj("+proj=stere +lat_0=-90 +R=3396190"), *box(3e5, 2e6, 10000, SIDE)),
    "mars sinusoidal": (MARS, RESAMPLED, WIDE, *proj("+proj=sinu +R=3396190"), "-a_ullr", -MARS_HALF, MARS_HALF / 2,
                        MARS_HALF, -MARS_HALF / 2),
    "earth sinusoidal of modis": (EARTH, RESAMPLED, SIDE, *proj("+proj=sinu +R=6371007.181"), *box(1.1e6, 5.5e6, 9000, SIDE)),
    "mollweide": (EARTH, RESAMPLED, WIDE, "-a_srs", "ESRI:54009", *box(-9e6, 6e6, 93750, WIDE)),
    "robinson": (EARTH, RESAMPLED, WIDE, "-a_srs", "ESRI:54030", *box(-9e6, 6e6, 93750, WIDE)),
    "mars with a standard parallel": (MARS, RESAMPLED, SIDE, *proj("+proj=eqc +lat_ts=40 +R=3396190"),
                                      *box(1e5, 3e6, 10000, SIDE)),
    "europa equidistant": (EUROPA, RESAMPLED, SIDE, *proj("+proj=aeqd +lat_0=20 +lon_0=200 +R=1560800"),
                           *box(-640000, 480000, 10000, SIDE)),
    "moon orthographic": (MOON, RESAMPLED, SIDE, *proj("+proj=ortho +lat_0=10 +lon_0=-20 +R=1737400"),
                          *box(-2.4e6, 1.8e6, 37500, SIDE)),
    "vesta mercator": (VESTA, RESAMPLED, SIDE, *proj("+proj=merc +a=289000 +b=229000"), *box(-2e5, 2e5, 2500, SIDE)),
    "mars transverse": (MARS_FIGURE, RESAMPLED, SIDE, *proj("+proj=tmerc +lon_0=137 +a=3396190 +b=3376200"),
                        *box(-64000, 9e5, 1000, SIDE)),
    "lambert of mars": (MARS_FIGURE, RESAMPLED, SIDE, *proj("+proj=lcc +lat_1=30 +lat_2=60 +lat_0=45 +a=3396190 +b=3376200"),
                        *box(-6e5, 5e5, 10000, SIDE)),
    # Spheres. With UTM's parameters GDAL writes UTM's code, which PROJ knows for flattened bodies only.
    "sphere, utm's parameters": (SPHERE, RESAMPLED, SIDE, *proj("+proj=tmerc +lon_0=9 +k=0.9996 +x_0=500000 +R=6378137"),
                                 *box(400000, 5000000, 1000, SIDE)),
    "sphere, utm's parameters in the south": (MOON, RESAMPLED, SIDE, *proj("+proj=tmerc +lon_0=-75 +k=0.9996 +x_0=500000 "
                                              "+y_0=10000000 +R=1737400"), *box(450000, 9100000, 500, SIDE)),
    "sphere, transverse mercator": (MOON, RESAMPLED, SIDE, *proj("+proj=tmerc +lat_0=5 +lon_0=20 +R=1737400"),
                                    *box(-64000, 3e5, 1000, SIDE)),
    "sphere, lambert azimuthal": (SPHERE, RESAMPLED, SIDE, *proj("+proj=laea +lat_0=50 +lon_0=10 +R=6378137"),
                                  *box(-3e5, 4e5, 5000, SIDE)),
    "sphere, lambert azimuthal at the pole": (MARS, RESAMPLED, SIDE, *proj("+proj=laea +lat_0=-90 +R=3396190"),
                                              *box(3e5, 2e6, 10000, SIDE)),
    "sphere, oblique stereographic": (SPHERE, RESAMPLED, SIDE, *proj("+proj=stere +lat_0=40 +lon_0=9 +k=0.99 +R=6378137"),
                                      *box(-3e5, 4e5, 5000, SIDE)),
    "sphere, stereographic with a parallel": (SPHERE, RESAMPLED, SIDE, *proj("+proj=stere +lat_0=90 +lat_ts=71 +R=6378137"),
                                              *box(-2.4e6, -1.2e6, 20000, SIDE)),
    "sphere, equirectangular": (SPHERE, RESAMPLED, SIDE, *proj("+proj=eqc +lat_ts=30 +lon_0=15 +R=6378137"),
                                *box(-3e5, 5e6, 10000, SIDE)),
    "sphere, sinusoidal around 180": (MOON, RESAMPLED, SIDE, *proj("+proj=sinu +lon_0=180 +R=1737400"),
                                      *box(-3e5, 1e6, 5000, SIDE)),
    "sphere, mercator": (MOON, RESAMPLED, SIDE, *proj("+proj=merc +lon_0=40 +R=1737400"), *box(-2e5, 2e6, 5000, SIDE)),
    # Parameters that libgeotiff's PROJ strings do not have.
    "mercator with a scale": (SPHERE, RESAMPLED, SIDE, *proj("+proj=merc +k=0.9 +lon_0=20 +R=6378137"),
                              *box(1e6, 5e6, 10000, SIDE)),
    "oblique mercator": (EARTH, RESAMPLED, SIDE, *proj("+proj=omerc +lat_0=45 +lonc=7 +alpha=30 +k=0.99 +x_0=500 +gamma=10 "
                                                       "+ellps=WGS84"), *box(1e5, 2e5, 5000, SIDE)),
    "oblique mercator of variant A": (SPHERE, RESAMPLED, SIDE, *proj("+proj=omerc +no_uoff +lat_0=45 +lonc=7 +alpha=30 "
                                      "+k=0.99 +gamma=20 +R=6378137"), *box(3e6, 5e6, 5000, SIDE)),
    "sphere, mercator with a parallel": (SPHERE, RESAMPLED, SIDE, *proj("+proj=merc +lat_ts=30 +R=6378137"),
                                         *box(1e6, 5e6, 10000, SIDE)),
}

# Systems for gdaltransform, which fails at UTM's code for a sphere: the same but for a micrometre.
SAID = {"sphere, utm's parameters": ("-s_srs", "+proj=tmerc +lon_0=9 +k=0.9996 +x_0=500000.000001 +R=6378137 +no_defs"),
        "sphere, utm's parameters in the south": ("-s_srs", "+proj=tmerc +lon_0=-75 +k=0.9996 +x_0=500000.000001 "
                                                  "+y_0=10000000 +R=1737400 +no_defs")}

# GeoTIFF tags that gdal_translate would not write.
TURNED = [0.12, 0.04, 0, 10, 0.04, -0.12, 0, 50, 0, 0, 0, 0, 0, 0, 0, 1.0]
SOUTH_FIRST = [0.125, 0, 0, 10, 0, 0.125, 0, 40, 0, 0, 0, 0, 0, 0, 0, 1.0]
TAGS = {
    "turned": (EARTH, RESAMPLED, [DEGREES, (MATRIX, 12, TURNED)]),
    "rows from the south": (EARTH, RESAMPLED, [DEGREES, (MATRIX, 12, SOUTH_FIRST)]),
    "pixel is point off the grid": (EARTH, AS_IT_IS, [geo_keys((1024, 2), (1025, 2), (2048, 4326)),
                                                       *placed_at(10, 50, 0.125, 0.125)]),
    "matrix in utm": (EARTH, RESAMPLED, [geo_keys((1024, 1), (1025, 1), (3072, 32633)),
                                         (MATRIX, 12, [4000.0, 1500, 0, 400000, 1500, -4000, 0, 5000000] + [0] * 7 + [1.0])]),
    "a code whose flattening is rounded": (EARTH, AS_IT_IS, [
        geo_keys((1024, 2), (1025, 1), (2048, 4326), (2057, DOUBLES, 1, 0), (2059, DOUBLES, 1, 1)),
        (DOUBLES, 12, [6378137.0, 298.257224]), *placed_at(10, 50, 0.125, 0.125)]),
    "a moon of keys": (MOON, AS_IT_IS, [geo_keys((1024, 2), (1025, 1), (2048, 32767), (2054, 9102), (2057, DOUBLES, 1, 0),
                                                 (2058, DOUBLES, 1, 1)), (DOUBLES, 12, [1737400.0, 1737400.0]),
                                        *placed_at(10, 50, 0.125, 0.125)]),
}


class PlacementTest(ProgramTest):
    def info(self, name, *options):
        return json.loads(self.assert_done("info", name, "--json", *options).stdout)

    def assert_placed(self, name, degrees, drawn, size, *options, turn_px=0, source_crs=()):
        info = self.info(name, *options)
        self.assertTrue(info["shown"], info)
        self.assertEqual(info["drawn"], drawn, info)
        body = shlex.split(info["command"])[3:] if "--body" in info["command"] else []
        body = body[body.index("--body"):][:2] if body else []
        self.assert_done("cut", name, "-o", "out.gpkg", "--format", "png", "--force", *body, *options)
        errors = placement.spot_errors(self.folder / name, self.folder / "out.gpkg", degrees, size, turn_px,
                                       source_crs)
        self.assertLessEqual(max(errors), RESAMPLED_PX if drawn == RESAMPLED else UNCHANGED_PX, errors)

    def test_what_gdal_writes(self):
        for cases, turn_px in ((ALL_ROUND, WIDE[0]), (PARTS, 0)):
            for name, (degrees, drawn, size, *options) in cases.items():
                with self.subTest(name):
                    placement.place_spots(self.folder / "in.tif", size, *options)
                    self.assert_placed("in.tif", degrees, drawn, size, turn_px=turn_px, source_crs=SAID.get(name, ()))

    def test_tags(self):
        for name, (degrees, drawn, tags) in TAGS.items():
            with self.subTest(name):
                self.write("in.tif", tiff(*SIDE, tags, placement.spotted(*SIDE)))
                self.assert_placed("in.tif", degrees, drawn, SIDE)

    def test_latitudes_of_a_sphere_are_planetocentric_without_a_word(self):
        placement.place_spots(self.folder / "in.tif", WIDE, "-a_srs", MARS, *box(-180, 90, 1.875, WIDE))
        self.assertEqual(self.info("in.tif")["latitude"], "centric")
        self.assert_done("cut", "in.tif", "-o", "out.gpkg", "--body", "mars")
        told = self.assert_done("info", "out.gpkg").stdout
        self.assertIn("centric", told)


if __name__ == "__main__":
    unittest.main()
