"""`render` from a server: cold, warm, offline and with a faulty server."""

import json
import subprocess

import servers
from program import BLUE_MARBLE, DONE, DONE_IN_PART, ProgramTest

LEVELS = 3
VIEW = ("--unlit", "--camera", "30,20,6000000", "--size", "512x512")

# Faults of a tile, and the words that the summary must have for them. Each of the program's attempts meets the fault.
FAULTS = {
    "403": "403",
    "404": "404",
    "500": "500",
    "truncated_jpeg": "",
    "html200": "",
    "loop": "redirect",
    "bomb": "",
    "reset": "",
    "empty": "",
}


class PyramidTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.pyramid = self.folder / "tiles"
        servers.write_pyramid(self.pyramid, LEVELS)


class RemoteTest(PyramidTest):
    def describe(self, template, **more):
        description = {"url": template, "max_level": LEVELS - 1, **more}
        return self.write("source.json", json.dumps(description).encode())

    def render(self, source, name, *more):
        done = self.run_program("render", source, "-o", name, *VIEW, "--cache", "cache.gpkg", *more)
        return done, (self.folder / name).read_bytes() if (self.folder / name).exists() else b""

    def test_cold_warm_offline_and_without_its_server_the_pixels_are_the_same(self):
        with servers.nginx(self.pyramid, "--no-expiry") as server:
            # A life of no time: each view asks again, with the validators of what it has.
            source = self.describe(server.template, tile_life_s=0)
            cold, first = self.render(source, "cold.png")
            self.assertEqual(cold.returncode, DONE, cold.stderr)
            asked = server.requests()
            self.assertTrue(asked and all(status == 200 for status, _ in asked), asked)
            self.assertEqual(len(asked), len({path for _, path in asked}), "a tile was asked for twice")
            warm, second = self.render(source, "warm.png")
            again = server.requests()[len(asked):]
            self.assertEqual({path for _, path in again}, {path for _, path in asked})
            self.assertTrue(all(status == 304 for status, _ in again), again)
            before = len(server.requests())
            offline, third = self.render(source, "offline.png", "--offline")
            self.assertEqual(len(server.requests()), before, "--offline asked")
        stopped, fourth = self.render(source, "stopped.png")
        for done, picture in (warm, second), (offline, third), (stopped, fourth):
            self.assertEqual(done.returncode, DONE, done.stderr)
            self.assertEqual(picture, first)

    def test_offline_without_a_cache_says_so(self):
        self.assert_fails(1, "render", "http://127.0.0.1:9/{z}/{x}/{y}.jpg", "--offline", "-o", "x.png",
                          says=["127.0.0.1:9", "--offline"])
        self.assert_fails(1, "render", "http://127.0.0.1:9/{z}/{x}/{y}.jpg", "--offline", "--cache", "off", "-o",
                          "x.png", says=["--cache"])

    def test_each_fault_is_named_and_an_ancestor_stands_in(self):
        finest = [f"{LEVELS - 1}/{x}/{y}.jpg" for x in range(3, 6) for y in range(3)]
        faults = dict(zip(finest, FAULTS))
        with servers.misbehaving(self.pyramid, faults) as server:
            done, picture = self.render(self.describe(server.template), "faults.png")
            log = server.log()
        self.assertEqual(done.returncode, DONE_IN_PART, done.stderr)
        self.assertTrue(picture)
        asked = {entry["path"] for entry in log}
        lacking = [path for path in faults if f"/{path}" in asked]
        self.assertGreaterEqual(len(lacking), 6, "the view hardly meets a fault")
        for path in lacking:
            lines = [line for line in done.stderr.splitlines() if path.removesuffix(".jpg") + ":" in line]
            self.assertTrue(lines, f"{path} ({faults[path]}) is not named:\n{done.stderr}")
            self.assertIn(FAULTS[faults[path]], lines[0])
        self.assert_under_the_rate(log)
        # The parents are there, so no pixel of the planet is background.
        self.assert_as_covered(picture)

    def test_a_mistaken_grid_is_named_and_not_drawn(self):
        cut = self.folder / "marble"
        self.assert_done("cut", BLUE_MARBLE, "-o", cut)
        with servers.nginx(cut) as server:
            source = server.template.replace("{y}", "{-y}")
            for _ in range(2):
                self.assert_fails(1, "render", source, "--max-level", "3", "-o", "x.png", *VIEW, says=["{-y}", "other end"])
            self.assert_fails(1, "render", server.template, "--root-span", "360", "--max-level", "3", "-o", "x.png",
                              *VIEW, says=["root"])
            self.assert_done("render", server.template, "--max-level", "3", "-o", "x.png", *VIEW)

    def test_a_server_that_asks_for_patience_gets_it(self):
        path = f"{LEVELS - 1}/4/1.jpg"
        with servers.misbehaving(self.pyramid, {path: "429?retry_after=1&times=1"}) as server:
            done, _ = self.render(self.describe(server.template), "patience.png")
            log = server.log()
        self.assertEqual(done.returncode, DONE, done.stderr)
        times = sorted(entry["time_s"] for entry in log if entry["path"] == f"/{path}")
        self.assertEqual(len(times), 2, log)
        self.assertGreaterEqual(times[1] - times[0], 1.0)
        # Requests that the host had at that moment may still be answered; no new ones come for a second.
        soon = [e for e in log if times[0] + 0.2 < e["time_s"] < times[0] + 0.9]
        self.assertEqual(soon, [], "the pause holds for the host")

    def assert_under_the_rate(self, log):
        """At most the bucket (100) and 200 a second more."""
        times = sorted(entry["time_s"] for entry in log)
        for first in range(len(times)):
            for last in range(first, len(times)):
                self.assertLessEqual(last - first + 1, 100 + 200 * (times[last] - times[first]) + 1)

    def assert_as_covered(self, picture):
        import png
        (self.folder / "read.png").write_bytes(picture)
        _, height, rows = png.read(self.folder / "read.png")
        middle = rows[height // 2]
        self.assertNotIn(b"\0\0\0", {middle[3 * x : 3 * x + 3] for x in range(96, 416)})


CAPABILITIES = """<?xml version="1.0"?>
<Capabilities xmlns="http://www.opengis.net/wmts/1.0" xmlns:ows="http://www.opengis.net/ows/1.1" version="1.0.0">
 <Contents>
  <Layer>
   <ows:Title>Marble</ows:Title><ows:Identifier>marble</ows:Identifier>
   <ows:WGS84BoundingBox><ows:LowerCorner>-180 -90</ows:LowerCorner><ows:UpperCorner>180 90</ows:UpperCorner>
   </ows:WGS84BoundingBox>
   <Style isDefault="true"><ows:Identifier>default</ows:Identifier></Style>
   <Format>image/png</Format>
   <TileMatrixSetLink><TileMatrixSet>coarse</TileMatrixSet></TileMatrixSetLink>
   <ResourceURL format="image/png" resourceType="tile" template="{address}/{{TileMatrix}}/{{TileCol}}/{{TileRow}}.png"/>
  </Layer>
  <TileMatrixSet>
   <ows:Identifier>coarse</ows:Identifier><ows:SupportedCRS>urn:ogc:def:crs:OGC:1.3:CRS84</ows:SupportedCRS>
   {matrices}
  </TileMatrixSet>
 </Contents>
</Capabilities>"""
MATRIX = """<TileMatrix><ows:Identifier>{z}</ows:Identifier><ScaleDenominator>{scale!r}</ScaleDenominator>
 <TopLeftCorner>-180 90</TopLeftCorner><TileWidth>512</TileWidth><TileHeight>512</TileHeight>
 <MatrixWidth>{width}</MatrixWidth><MatrixHeight>{height}</MatrixHeight></TileMatrix>"""


class WmtsTest(ProgramTest):
    """The matrices of NASA's GIBS: 288 degrees a root tile of 512 pixels, clipped to the planet."""

    def test_is_drawn_in_the_same_place_as_the_picture_that_it_was_cut_from(self):
        # 640 · 2^3 pixels around: the width whose own pixels lie on the 288° grid.
        subprocess.run(["gdal_translate", "-q", "-r", "bilinear", "-outsize", "5120", "2560", "-of", "PNG", BLUE_MARBLE,
                        self.folder / "marble.png"], check=True)
        self.assert_done("cut", "marble.png", "-o", "tiles", "--tile-size", "512", "--format", "png")
        grid = json.loads((self.folder / "tiles/tileset.json").read_text())
        self.assertEqual((grid["root_span_deg"], grid["max_level"]), (288.0, 3))
        sizes = (2, 1), (3, 2), (5, 3), (10, 5)
        matrices = "".join(MATRIX.format(z=z, scale=223632905.6114871 / 2**z, width=w, height=h)
                           for z, (w, h) in enumerate(sizes))
        with servers.nginx(self.folder / "tiles") as server:
            address = server.template.split("/{z}")[0]
            self.write("wmts.xml", CAPABILITIES.format(address=address, matrices=matrices).encode())
            for camera in "30,20,6000000", "0,180,6000000", "-75,100,3000000":
                view = ("--unlit", "--camera", camera, "--size", "512x512")
                self.assert_done("render", "wmts.xml", "-o", "remote.png", "--cache", "off", *view)
                self.assert_done("render", "tiles", "-o", "local.png", *view)
                self.assertEqual((self.folder / "remote.png").read_bytes(), (self.folder / "local.png").read_bytes())
            self.assertTrue(all(status == 200 for status, _ in server.requests()), server.requests())


class CacheTest(PyramidTest):
    """Caches made in shards, joined, looked at."""

    def preload(self, template, cache, *more):
        return self.assert_done("preload", template, "--levels", f"0-{LEVELS - 1}", "-o", cache, *more)

    def test_shards_joined_are_the_whole(self):
        with servers.nginx(self.pyramid) as server:
            self.preload(server.template, "whole.gpkg")
            for shard in "1/2", "2/2":
                self.preload(server.template, f"part{shard[0]}.gpkg", "--shard", shard)
            asked = server.counts()
        self.assertTrue(all(times == 2 for times in asked.values()), "each tile once for the whole, once for a shard")
        self.assert_done("merge", "part1.gpkg", "part2.gpkg", "-o", "joined.gpkg")
        whole, joined = (json.loads(self.assert_done("info", name, "--verify", "--json").stdout)
                         for name in ("whole.gpkg", "joined.gpkg"))
        self.assertEqual(whole["levels"], joined["levels"])
        for name in "whole", "joined":
            self.assert_done("render", f"{name}.gpkg", "-o", f"{name}.png", *VIEW)
        self.assertEqual((self.folder / "whole.png").read_bytes(), (self.folder / "joined.png").read_bytes())

    def test_caches_of_two_sources_are_not_joined(self):
        with servers.nginx(self.pyramid) as one, servers.nginx(self.pyramid) as other:
            self.preload(one.template, "one.gpkg")
            self.preload(other.template, "other.gpkg")
        self.assert_fails(1, "merge", "one.gpkg", "other.gpkg", "-o", "joined.gpkg", says=["other.gpkg"])
        self.assertFalse((self.folder / "joined.gpkg").exists())


class NoServerTest(ProgramTest):
    def test_a_server_that_is_not_there_is_named(self):
        self.assert_fails(1, "render", "http://127.0.0.1:9/{z}/{x}/{y}.jpg", "--max-level", "2", "-o", "x.png", *VIEW,
                          says=["127.0.0.1", "none of the", "nothing was written"])
        self.assert_nothing_but()

    def test_a_set_of_which_every_tile_is_missing_leaves_no_picture(self):
        with servers.misbehaving(self.folder / "nothing", {}) as server:
            self.assert_fails(1, "render", server.template, "--max-level", "2", "-o", "x.png", *VIEW,
                              says=["0.jpg", "404", "none of the", "nothing was written"])
        self.assertFalse((self.folder / "x.png").exists())

    def test_a_template_without_a_place_for_the_level_is_wrong(self):
        self.assert_fails(1, "render", "http://127.0.0.1:9/{x}/{y}.jpg", "-o", "x.png", says=["{z}"])


class NoPlaceForTheCacheTest(PyramidTest):
    """One goes on without, and it is said once. A file's name as a folder stops root, too."""

    def setUp(self):
        super().setUp()
        self.write("file", b"")

    def draw(self, *arguments, **options):
        done = self.assert_done("render", *arguments, "-o", "x.png", *VIEW, **options)
        said = [line for line in done.stderr.splitlines() if "without a cache" in line]
        self.assertEqual(len(said), 1, done.stderr)
        self.assertIn("file", said[0])
        return (self.folder / "x.png").read_bytes()

    def test_tiles_from_a_server(self):
        with servers.nginx(self.pyramid) as server:
            source = self.write("source.json", json.dumps({"url": server.template, "max_level": LEVELS - 1}).encode())
            expected = self.draw(source, "--cache", "file/cache.gpkg")
            in_a_file = {"XDG_CACHE_HOME": str(self.folder / "file")}
            self.assertEqual(self.draw(source, "--overlay", source, environment=in_a_file), expected)

    def test_a_picture_that_is_cut(self):
        self.draw(BLUE_MARBLE, environment={"XDG_CACHE_HOME": str(self.folder / "file")})

    def test_another_sources_cache_is_refused_as_ever(self):
        with servers.nginx(self.pyramid) as one, servers.nginx(self.pyramid) as other:
            self.assert_done("render", one.template, "--max-level", "2", "-o", "x.png", *VIEW, "--cache", "c.gpkg")
            self.assert_fails(1, "render", other.template, "--max-level", "2", "-o", "x.png", *VIEW, "--cache", "c.gpkg",
                              says=["c.gpkg", "name another file"])
