"""A WMS and GDAL's XML descriptions against servers of formulas: what lands in the cache lies where GDAL finds it."""

import itertools
import json

import png
import servers
import wms_server
from georeferenced import gdal
from program import DONE, ProgramTest

TILE_PX = 64
# Places in each system, away from the pole, where its longitudes turn within a pixel.
PLACES = {"EPSG:4326": [(11.03, 48.07), (-120.51, -33.02), (151.03, -65.31), (-3.01, 2.03)],
          "CRS:84": [(11.03, 48.07), (-120.51, -33.02), (151.03, -65.31), (-3.01, 2.03)],
          "EPSG:3857": [(1.2e6, 6.1e6), (-1.3e7, -3.9e6), (1.7e7, 1.1e7)],
          "EPSG:3413": [(2.1e6, -2.4e6), (-3.3e6, -1.0e6), (-1.5e6, 3.7e6), (4.0e6, 4.0e6)],
          "sinu": [(1.0e6, 1.0e6), (-3.1e6, -0.4e6), (0.3e6, -2.2e6)],
          "eqc": [(1.0e6, -1.0e6), (-9.1e6, 4.4e6), (8.8e6, 2.2e6)]}


def values_at(raster, x, y):
    """The bands of the pixel at a place in the raster's own system, as GDAL reads them."""
    return [float(v) for v in gdal("gdallocationinfo", "-valonly", "-geoloc", raster, x, y).split()]


def pixel_centre(raster, x, y):
    """The middle of the pixel that holds a place, in the raster's own system."""
    x0, dx, _, y0, _, dy = json.loads(gdal("gdalinfo", "-json", raster))["geoTransform"]
    return x0 + (int((x - x0) / dx) + 0.5) * dx, y0 + (int((y - y0) / dy) + 0.5) * dy


class PlacedTest(ProgramTest):
    def preload(self, source, *more):
        cache = self.folder / "cache.gpkg"
        cache.unlink(missing_ok=True)
        done = self.run_program("preload", source, "-o", cache, *more)
        self.assertEqual(done.returncode, DONE, done.stdout + done.stderr)
        return cache

    def worst_colour(self, raster, system, opened=None):
        """The largest difference between a pixel and the formula at its middle."""
        worst = 0
        for x, y in PLACES[system]:
            centre = pixel_centre(raster, x, y)
            truth = wms_server.colour_at(*wms_server.SYSTEMS[system](*centre))
            worst = max(worst, *(abs(a - b) for a, b in zip(values_at(raster, x, y)[:3], truth)))
        return worst


class WmsTest(PlacedTest):
    def request(self, server, version, **more):
        extra = "".join(f"&{k}={v}" for k, v in more.items())
        return f"{server.address}/wms?service=WMS&request=GetCapabilities&version={version}{extra}"

    def test_tiles_lie_in_their_place_in_each_version_and_system(self):
        for version in "1.1.1", "1.3.0":
            for system in "EPSG:4326", "CRS:84", "EPSG:3857", "EPSG:3413":
                with self.subTest(version=version, system=system), servers.wms("--crs", system) as server:
                    cache = self.preload(self.request(server, version), "--levels", "1-2", "--tile-size", TILE_PX)
                    # One for the rounding of each side.
                    self.assertLessEqual(self.worst_colour(cache, system), 1)
                    said = json.loads(gdal("gdalinfo", "-json", cache))["coordinateSystem"]["wkt"]
                    code = system.split(":")[1].replace("84", "4326") if system == "CRS:84" else system.split(":")[1]
                    self.assertIn(code, said)

    def test_a_server_with_its_axes_swapped_would_be_seen(self):
        with servers.wms("--swap") as server:
            cache = self.preload(self.request(server, "1.3.0"), "--levels", "1-2", "--tile-size", TILE_PX)
            self.assertGreater(self.worst_colour(cache, "EPSG:4326"), 50)

    def test_it_is_drawn_kept_and_drawn_offline(self):
        view = ("--unlit", "--sky", "off", "--camera", "48,11,4000000", "--size", "129x129")
        with servers.wms("--crs", "EPSG:4326") as server:
            # A GetMap address says the layer, and a key goes along without being shown.
            source = f"{server.address}/wms?service=WMS&request=GetMap&layers=waves&token=se%20cret"
            options = ("--tile-size", TILE_PX, "--cache", "wms.gpkg", "--max-level", "4")
            drawn = self.run_program("render", source, "-o", "a.png", *view, *options)
            self.assertEqual(drawn.returncode, DONE, drawn.stderr)
            maps = [path for path in server.log() if "GetMap" in path]
            self.assertTrue(maps)
            for path in maps:
                for part in "token=se%20cret", "map=waves", "TIME=2004-08-01", "TRANSPARENT=TRUE", "VERSION=1.3.0":
                    self.assertIn(part, path)
            again = self.run_program("render", source, "-o", "b.png", *view, *options, "--offline")
            self.assertEqual(again.returncode, DONE, again.stderr)
            self.assertEqual(len([path for path in server.log() if "GetMap" in path]), len(maps))
            gone = self.run_program("info", "wms.gpkg")
            self.assertNotIn("cret", drawn.stderr + again.stderr + gone.stdout)
        _, _, rows = png.read(self.folder / "a.png")
        middle = rows[64][3 * 64:3 * 64 + 3]
        # A pixel of the view is 0.3°, by which a wave of 120 changes by 4; twice that for the tiles' own pixels.
        for seen, truth in zip(middle, wms_server.colour_at(11, 48)):
            self.assertAlmostEqual(seen, truth, delta=10)
        self.assertEqual((self.folder / "a.png").read_bytes(), (self.folder / "b.png").read_bytes())

    def test_what_the_server_says_is_repeated(self):
        with servers.wms("--exception", "layer waves is being repaired") as server:
            self.assert_fails(1, "render", self.request(server, "1.3.0"), "-o", "x.png",
                              says=["the server answers with an exception: layer waves is being repaired"])
            self.assert_fails(1, "info", self.request(server, "1.3.0", layers="hills"), says=['no layer "hills"', "waves"])
            self.assert_fails(1, "info", self.request(server, "1.3.0", time="1999-01-01"), says=["1999-01-01", "2004-07-01"])
            self.assert_fails(1, "info", self.request(server, "1.3.0", crs="EPSG:2180"), says=["EPSG:2180", "EPSG:4326"])
            self.assert_fails(1, "info", self.request(server, "1.3.0", styles="ugly"), says=["ugly", "plain"])


XML = """<GDAL_WMS><Service name="TMS"><ServerUrl>{address}/tiles/{crs}/{window}/{block}/{count}/${{z}}/${{x}}/${{y}}.png{query}
</ServerUrl></Service><DataWindow><UpperLeftX>{west}</UpperLeftX><UpperLeftY>{north}</UpperLeftY><LowerRightX>{east}
</LowerRightX><LowerRightY>{south}</LowerRightY><TileLevel>{level}</TileLevel>{size}<YOrigin>{origin}</YOrigin></DataWindow>
<Projection>{projection}</Projection><BlockSizeX>{block}</BlockSizeX><BlockSizeY>{block}</BlockSizeY>{more}</GDAL_WMS>"""
MERCATOR_M = 20037508.342789244
SQUARE_M = 4194304
MARS_M = 10669445.554195  # half of the way round
# System, window, projection, tiles at level 0.
WINDOWS = {
    "degrees": ("EPSG-4326", (-180, 90, 180, -90), "EPSG:4326", (2, 1)),
    "from 0": ("EPSG-4326", (0, 90, 360, -90), "EPSG:4326", (2, 1)),
    "a part": ("EPSG-4326", (-30, 75, 30, 15), "EPSG:4326", (1, 1)),
    "beside the grid": ("EPSG-4326", (-31.5, 74, 28.5, 14), "EPSG:4326", (1, 1)),
    "Web Mercator": ("EPSG-3857", (-MERCATOR_M, MERCATOR_M, MERCATOR_M, -MERCATOR_M), "EPSG:3857", (1, 1)),
    "stereographic": ("EPSG-3413", (-SQUARE_M, SQUARE_M, SQUARE_M, -SQUARE_M), "EPSG:3413", (1, 1)),
    "Moon": ("sinu", (-5458203.077, 2729101.5385, 5458203.077, -2729101.5385), "+proj=sinu +R=1737400", (2, 1)),
    "Mars": ("eqc", (-MARS_M, MARS_M / 2, MARS_M, -MARS_M / 2), "+proj=eqc +lon_0=180 +R=3396190", (2, 1)),
}


class GdalWmsTest(PlacedTest):
    def describe(self, server, name, block=TILE_PX, level=2, origin="top", query="", more="", size=None):
        crs, (west, north, east, south), projection, (columns, rows) = WINDOWS[name]
        size = size or f"<TileCountX>{columns}</TileCountX><TileCountY>{rows}</TileCountY>"
        text = XML.format(address=server.address, crs=crs, window=f"{west},{north},{east},{south}", block=block,
                          count=f"{columns}x{rows}", west=west, north=north, east=east, south=south, level=level, size=size,
                          origin=origin, projection=projection, query=query, more=more)
        # A cache belongs to a file's name.
        return self.write(f"{name.replace(' ', '-')}-{block}.xml", text.replace("\n", "").encode())

    def test_a_pixel_is_the_one_that_gdal_reads_from_the_same_file(self):
        with servers.wms() as server:
            for name, block in itertools.product(WINDOWS, (64, 90)):
                with self.subTest(window=name, block=block):
                    xml = self.describe(server, name, block)
                    cache = self.preload(xml)
                    for x, y in self.places_in(name):
                        self.assertEqual(values_at(cache, *self.in_cache(name, x, y))[:3], values_at(xml, x, y)[:3])

    def places_in(self, name):
        crs, (west, north, east, south), _, _ = WINDOWS[name]
        places = PLACES[crs.replace("-", ":")]
        if name in ("a part", "beside the grid"):
            places = [(11.03, 48.07), (-22.31, 33.02), (27.03, 73.91)]
        if name == "from 0":
            places = [(x % 360, y) for x, y in places]
        return places

    @staticmethod
    def in_cache(name, x, y):
        """A geodetic cache counts degrees from -180°."""
        if name == "from 0":
            return (x - 360 if x > 180 else x), y
        if name == "Mars":
            return wms_server.east_of_0_mars(x, y)[0] - 360 * (x > 0), wms_server.east_of_0_mars(x, y)[1]
        return x, y

    def test_rows_from_the_south_are_asked_for_as_gdal_asks(self):
        with servers.wms() as server:
            xml = self.describe(server, "a part", origin="bottom")
            values_at(xml, 11, 48)
            asked = [path for path in server.log() if path.startswith("/tiles/")]
            self.preload(xml, "--levels", "2-2")
            self.assertIn(asked[-1], [p for p in server.log()[len(asked):]])

    def test_numbers_with_a_sign_are_heights(self):
        with servers.wms() as server:
            xml = self.describe(server, "degrees", query="?numbers=1",
                                more="<BandsCount>1</BandsCount><DataType>Int16</DataType>"
                                     "<DataValues><NoData>-32768</NoData></DataValues>")
            self.assertEqual(values_at(xml, -45.0, 10.0)[0] < -2000, True, "the server has negative numbers")
            seen = self.assert_done("render", xml, "-o", "x.png", "--size", "64x64")
            self.assertIn("numbers in the colours of viridis", seen.stderr)
            said = json.loads(self.assert_done("info", xml, "--json").stdout)
            self.assertEqual(said["elevation"], {"scale": 1.0, "offset": 0.0, "nodata": -32768, "numbers": "signed"})
            drawn = self.run_program("render", "--elevation", xml, "-o", "x.png", "--size", "64x64")
            self.assertEqual(drawn.returncode, DONE, drawn.stderr)

    def test_info_sends_no_request(self):
        with servers.wms() as server:
            for name, body in ("degrees", "earth"), ("Moon", "moon"), ("Mars", "mars"), ("stereographic", "earth"):
                said = json.loads(self.assert_done("info", self.describe(server, name), "--json").stdout)
                self.assertEqual((name, said["body"]), (name, body))
            self.assertEqual(server.log(), [])

    def test_a_password_is_sent_and_not_shown(self):
        with servers.wms() as server:
            xml = self.describe(server, "degrees", more="<UserPwd>me:top/secret</UserPwd>")
            done = self.assert_done("preload", xml, "-o", "c.gpkg", "--levels", "0-0")
            shown = done.stdout + done.stderr + self.assert_done("info", "c.gpkg").stdout + self.assert_done("info", xml).stdout
            self.assertNotIn("secret", shown)
            self.assertNotIn(b"secret", (self.folder / "c.gpkg").read_bytes())

    def test_what_cannot_be_read_is_named(self):
        with servers.wms() as server:
            good = self.describe(server, "degrees").read_text()
            for old, new, says in (
                    ('name="TMS"', 'name="TiledWMS"', "TiledWMS"), ('name="TMS"', 'name="AGS"', "AGS"),
                    ("EPSG:4326", "EPSG:99999", "Projection"), ("EPSG:4326", "/etc/passwd", "Projection"),
                    ("<BlockSizeX>64", "<BlockSizeX>65", "65 by 64"), ("${x}", "${tile}", "${tile}"),
                    ("</GDAL_WMS>", "<UnsafeSSL>true</UnsafeSSL></GDAL_WMS>", "UnsafeSSL"),
                    ("</GDAL_WMS>", "<DataType>CFloat32</DataType></GDAL_WMS>", "CFloat32"),
                    ("</GDAL_WMS>", "<BandsCount>7</BandsCount></GDAL_WMS>", "7 bands"),
                    ("<UpperLeftX>-180", "<UpperLeftX>1e400", "UpperLeftX"), ("<UpperLeftX>-180", "<UpperLeftX>nan", "UpperLeftX"),
                    ("<LowerRightY>-90", "<LowerRightY>95", "no window"), ("<TileLevel>2", "<TileLevel>2000000000", "TileLevel"),
                    ("EPSG:4326", "+proj=eqc +R=1737400", "degrees"), ("http:", "ftp:", "http"),
                    ("</GDAL_WMS>", "", "XML"), ("<GDAL_WMS>", "<GDAL_WMTS>", "")):
                self.write("bad.xml", good.replace(old, new).encode())
                self.assert_fails(1, "info", "bad.xml", says=["bad.xml", says])
            self.assertEqual(server.log(), [])


class HostileTest(ProgramTest):
    """Documents that were made to hurt."""

    BOMB = ('<?xml version="1.0"?><!DOCTYPE b [<!ENTITY a0 "aaaaaaaaaa">' +
            "".join(f'<!ENTITY a{i} "{f"&a{i - 1};" * 10}">' for i in range(1, 10)) +
            '<!ENTITY c SYSTEM "file:///etc/passwd">]>')

    def test_they_end_in_a_message(self):
        capabilities = wms_server.capabilities("1.3.0", "http://127.0.0.1:9", type("O", (), {"crs": ["EPSG:4326"], "max_width": 9}))
        deep = b"<WMS_Capabilities version='1.3.0'><Capability>" + b"<Layer>" * 100000
        for number, document in enumerate((
                self.BOMB.encode() + b"<GDAL_WMS>&a9;&c;</GDAL_WMS>", self.BOMB.encode() + capabilities[22:300], deep,
                capabilities.replace(b'href="http', b'href="file'), capabilities.replace(b"EPSG:4326", b"EPSG:" + b"9" * 5000),
                capabilities.replace(b"1.3.0", b"7.0.0"), b"<ServiceExceptionReport><ServiceException>\xff\x00no",
                capabilities.replace(b'maxx="180"', b'maxx="nan"').replace(b"<EX_Geo", b"<X_Geo"),
                b"<GDAL_WMS>" * 50000, b"<GDAL_WMS><Service name='TMS'/></GDAL_WMS>")):
            self.write(f"{number}.xml", document)
            done = self.run_program("info", f"{number}.xml")
            self.assertIn(done.returncode, (0, 1), (number, done.stderr))
            if done.returncode:
                self.assertIn(f"{number}.xml", done.stderr)
            self.assertNotIn("root:", done.stderr + done.stdout)

    def test_a_server_that_redirects_without_end_is_named(self):
        with servers.misbehaving(self.folder / "none", {"wms": "loop"}) as server:
            self.assert_fails(1, "info", f"{server.address}/wms?service=WMS&request=GetCapabilities", says=["redirect"])
