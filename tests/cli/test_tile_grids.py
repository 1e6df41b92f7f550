"""Tile grids in polar projections: a planet of waves as WMTS, as a URL template and as a TMS, drawn over its poles."""

import json
import math
import struct
import unittest
import zlib

import png
import servers
import wms_server
from georeferenced import gdal
from program import DONE, ProgramTest

TILE_PX = 64
LEVELS = 4
HALF_m = 4194304.0  # half a side of the grid: at level 3 a pixel has 16384 m
SIDE = 128
HEIGHT_m = 3e6
# 20 pixels of the view, in radii.
WAVE = 20 * 17000 / 6378137.0


def south_stereographic(x, y):
    """EPSG:3031 by the formulas of the north: Snyder, page 157."""
    lon, lat = wms_server.north_stereographic(x, -y, 0.0, 71.0)
    return lon, -lat


SYSTEMS = {"EPSG:3413": wms_server.north_stereographic, "EPSG:3031": south_stereographic}


def colour_at(lon, lat):
    """Waves along the axes of the equator's plane, which are even at the poles, and half a ramp."""
    lon, lat = math.radians(lon), math.radians(lat)
    across, towards = (part * math.cos(lat) * 2 * math.pi / WAVE for part in (math.cos(lon), math.sin(lon)))
    return 127.5 + 100 * math.sin(across), 127.5 + 100 * math.sin(towards), 127.5 + 100 * math.sin(3 * lat)


def tile(system, z, x, y):
    return tile_of(system, 2 * HALF_m / TILE_PX / (1 << z), x, y)


def tile_of(system, pixel, x, y):
    """Tile of a level whose pixels have `pixel` metres."""
    rows = bytearray()
    for j in range(TILE_PX):
        rows.append(0)
        northing = HALF_m - (y * TILE_PX + j + 0.5) * pixel
        for i in range(TILE_PX):
            rows += bytes(map(round, colour_at(*SYSTEMS[system]((x * TILE_PX + i + 0.5) * pixel - HALF_m, northing))))
    header = struct.pack(">IIBBBBB", TILE_PX, TILE_PX, 8, 2, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + wms_server.chunk(b"IHDR", header) +
            wms_server.chunk(b"IDAT", zlib.compress(bytes(rows), 1)) + wms_server.chunk(b"IEND", b""))


def view_truth(system, height_m=HEIGHT_m):
    """The colour at the middle of each pixel that looks at the ellipsoid, from over the pole; right is 90° east."""
    a, b = 6378137.0, 6356752.314245
    south = system == "EPSG:3031"
    eye = b + height_m
    for row in range(SIDE):
        for column in range(SIDE):
            right = (column + 0.5 - SIDE / 2) * 2 / SIDE * math.tan(math.radians(20))
            up = (SIDE / 2 - row - 0.5) * 2 / SIDE * math.tan(math.radians(20))
            # |(x/a, y/a, z/b)| = 1 on the ray (right · t, up · t, eye - t)
            p, q = (right ** 2 + up ** 2) / a ** 2 + 1 / b ** 2, eye / b ** 2
            root = q ** 2 - p * (eye ** 2 / b ** 2 - 1)
            t = (q - math.sqrt(root)) / p
            lat = math.degrees(math.atan2((eye - t) * a ** 2 / b ** 2, math.hypot(right, up) * t))
            # Up is towards 180° over the north pole, towards 0° over the south pole.
            lon = math.degrees(math.atan2(right, up if south else -up))
            yield colour_at(lon, -lat if south else lat)


def tiles_near_the_pole():
    """Those that the views ask for, and two of the finest level at Iceland."""
    for z in range(LEVELS):
        middle = range(2, 6) if z == 3 else range(1 << z)
        yield from ((z, x, y) for x in middle for y in middle)
    yield from ((3, x, 6) for x in (4, 5))


class PolarTest(ProgramTest):
    @classmethod
    def setUpClass(cls):
        cls.tiles = {(system, *at): tile(system, *at) for system in SYSTEMS for at in tiles_near_the_pole()}

    def write_tiles(self, system, from_south=False):
        root = self.folder / system.replace(":", "-")
        for (of, z, x, y), picture in self.tiles.items():
            if of == system:
                column = root / str(z) / str(x)
                column.mkdir(parents=True, exist_ok=True)
                (column / f"{(1 << z) - 1 - y if from_south else y}.png").write_bytes(picture)
        return root

    def capabilities(self, system, template):
        matrices = "".join(
            f"<TileMatrix><Identifier>{z}</Identifier><ScaleDenominator>{2 * HALF_m / TILE_PX / 0.00028 / (1 << z):.12f}"
            f"</ScaleDenominator><TopLeftCorner>{-HALF_m} {HALF_m}</TopLeftCorner><TileWidth>{TILE_PX}</TileWidth>"
            f"<TileHeight>{TILE_PX}</TileHeight><MatrixWidth>{1 << z}</MatrixWidth><MatrixHeight>{1 << z}</MatrixHeight>"
            "</TileMatrix>" for z in range(LEVELS))
        return self.write("polar.xml", f"""<Capabilities version="1.0.0"><Contents><Layer><Identifier>waves</Identifier>
<Style isDefault="true"><Identifier>default</Identifier></Style><Format>image/png</Format><TileMatrixSetLink>
<TileMatrixSet>polar</TileMatrixSet></TileMatrixSetLink><ResourceURL format="image/png" resourceType="tile"
 template="{template.replace("{z}", "{TileMatrix}").replace("{x}", "{TileCol}").replace("{y}", "{TileRow}")}"/></Layer>
<TileMatrixSet><Identifier>polar</Identifier><SupportedCRS>urn:ogc:def:crs:{system.replace(":", "::")}</SupportedCRS>
{matrices}</TileMatrixSet></Contents></Capabilities>""".encode())

    def rms(self, source, system, height_m=HEIGHT_m, *more):
        """Root mean square difference of a view over the pole from the formulas, levels."""
        pole = -90 if system == "EPSG:3031" else 90
        self.assert_done("render", source, "-o", "view.png", "--unlit", "--sky", "off", "--camera",
                         f"{pole},0,{height_m:.0f}", "--size", f"{SIDE}x{SIDE}", "--cache", "polar.gpkg", *more)
        _, _, rows = png.read(self.folder / "view.png")
        seen = [row[i:i + 3] for row in rows for i in range(0, len(row), 3)]
        squares = [(a - b) ** 2 for pixel, truth in zip(seen, view_truth(system, height_m)) for a, b in zip(pixel, truth)]
        return math.sqrt(sum(squares) / len(squares))

    def test_both_poles_show_what_their_formulas_say(self):
        for system in SYSTEMS:
            with self.subTest(system=system):
                with servers.nginx(self.write_tiles(system)) as server:
                    source = self.capabilities(system, server.template.replace(".jpg", ".png"))
                    # A shift of 0.05 pixels of the view gives 1.1.
                    self.assertLess(self.rms(source, system), 1.0)
                    server.cut()
                    self.assertEqual(set(server.counts().values()), {1}, "no tile is fetched twice")
                (self.folder / "polar.gpkg").unlink()

    def test_each_level_of_any_ratio_is_drawn_from_its_own_tiles(self):
        root = self.write_tiles("EPSG:3413")
        resolutions = [2 * HALF_m / TILE_PX, 78000, 30000, HALF_m / TILE_PX / 4]
        for z, across in (1, 2), (2, 5):
            for x in range(across):
                (root / str(z) / str(x)).mkdir(parents=True, exist_ok=True)
                for y in range(across):
                    (root / str(z) / str(x) / f"{y}.png").write_bytes(tile_of("EPSG:3413", resolutions[z], x, y))
        with servers.nginx(root) as server:
            said = {"url": server.template.replace(".jpg", ".png"), "tile_px": TILE_PX, "crs": "EPSG:3413",
                    "extent": [-HALF_m, -HALF_m, HALF_m, HALF_m], "resolutions": resolutions}
            source = self.write("levels.json", json.dumps(said).encode())
            self.assertLess(self.rms(source, "EPSG:3413"), 1.0)
            high = self.rms(source, "EPSG:3413", 4.2e6)
            self.assertLess(high, 2.5)  # 11 pixels of the level in a wave
            server.cut()
            self.assertTrue([path for path in server.counts() if path.startswith("/2/")])
        self.assertEqual(self.rms(source, "EPSG:3413", 4.2e6, "--offline"), high)

    def test_areas_are_preloaded(self):
        with servers.nginx(self.write_tiles("EPSG:3413")) as server:
            source = self.capabilities("EPSG:3413", server.template.replace(".jpg", ".png"))
            done = self.run_program("preload", source, "-o", "cap.gpkg", "--bbox", "-180,84,180,90", "--jobs", "2")
            self.assertEqual(done.returncode, DONE, done.stdout + done.stderr)
            server.cut()
            finest = {path for path in server.counts() if path.startswith(f"/{LEVELS - 1}/")}
            # 6° of latitude around the pole are 670 km; a tile has 1049 km, and the pole is where four of them meet.
            self.assertEqual(finest, {f"/3/{x}/{y}.png" for x in (3, 4) for y in (3, 4)})
            done = self.run_program("preload", source, "-o", "iceland.gpkg", "--bbox", "-24,63,-13,66.5", "--levels", "3-3")
            self.assertEqual(done.returncode, DONE, done.stdout + done.stderr)
            server.cut()
            asked = {path for path in server.counts() if path.startswith("/3/")} - finest
            # Two tiles, and one whose corner comes near.
            self.assertLessEqual({"/3/4/6.png", "/3/5/6.png"}, asked)
            self.assertLessEqual(asked, {"/3/4/6.png", "/3/5/6.png", "/3/5/5.png"})
        for seen, truth in zip(self.values("iceland.gpkg", -20.0, 65.0), colour_at(-20.0, 65.0)):
            self.assertAlmostEqual(seen, truth, delta=16)  # half a pixel of a wave of 20

    def values(self, raster, lon, lat):
        return [float(v) for v in gdal("gdallocationinfo", "-valonly", "-wgs84", self.folder / raster, lon, lat).split()]

    def test_a_template_and_a_tms_say_their_system(self):
        root = self.write_tiles("EPSG:3413", from_south=True)
        with servers.nginx(root) as server:
            template = server.template.replace(".jpg", ".png").replace("{y}", "{-y}")
            said = {"url": template, "max_level": LEVELS - 1, "tile_px": TILE_PX, "crs": "EPSG:3413",
                    "extent": [-HALF_m, -HALF_m, HALF_m, HALF_m]}
            self.assertLess(self.rms(self.write("polar.json", json.dumps(said).encode()), "EPSG:3413"), 1.0)
        (self.folder / "polar.gpkg").unlink()
        sets = "".join(f'<TileSet href="{z}" units-per-pixel="{2 * HALF_m / TILE_PX / (1 << z)}" order="{z}"/>'
                       for z in range(LEVELS))
        (root / "tilemapresource.xml").write_text(
            f'<TileMap><SRS>EPSG:3413</SRS><BoundingBox minx="{-HALF_m}" miny="{-HALF_m}" maxx="{HALF_m}" maxy="{HALF_m}"/>'
            f'<Origin x="{-HALF_m}" y="{-HALF_m}"/><TileFormat width="{TILE_PX}" height="{TILE_PX}" extension="png"/>'
            f'<TileSets profile="raster">{sets}</TileSets></TileMap>')
        self.assertLess(self.rms(root, "EPSG:3413"), 1.0)


if __name__ == "__main__":
    unittest.main()
