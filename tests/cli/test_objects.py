"""--objects: faults are reported by file and feature, valid objects are drawn, and the exit code shows the faults."""

import base64
import json
import math
import random
import struct
import unittest

import png as pngs
from pictures import png
from program import DONE_IN_PART, FAILED, WRONG_USAGE, ProgramTest

SMALL = ["--size", "64x64", "--unlit", "--sky", "off"]


def feature(kind, coordinates, **properties):
    return {"type": "Feature", "properties": properties, "geometry": {"type": kind, "coordinates": coordinates}}


def collection(*features):
    return json.dumps({"type": "FeatureCollection", "features": features}).encode()


GOOD = feature("Point", [20.0, 20.0, 1000.0], radius_m=300000)


TRIANGLE = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)


def triangle(uri="data:application/octet-stream;base64," + base64.b64encode(TRIANGLE).decode(), nodes=({"mesh": 0},)):
    """A glTF document with one triangle, its buffer at a URI."""
    return {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": list(nodes),
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
        "bufferViews": [{"buffer": 0, "byteLength": len(TRIANGLE)}],
        "buffers": [{"byteLength": len(TRIANGLE), "uri": uri}],
    }


class Objects(ProgramTest):
    def assert_refused(self, content, *says):
        self.write("f.geojson", content)
        self.assert_fails(FAILED, "render", "--objects", "f.geojson", "-o", "out.png", *SMALL, says=["f.geojson", *says])
        self.assert_nothing_but("f.geojson")

    def assert_drawn_in_part(self, content, *says):
        self.write("f.geojson", content)
        done = self.assert_fails(DONE_IN_PART, "render", "--objects", "f.geojson", "-o", "out.png", *SMALL,
                                 says=["f.geojson: ", *says])
        self.assertTrue((self.folder / "out.png").exists())
        return done

    def test_a_bundle_of_edges_that_takes_too_long_to_plan_is_refused_at_once(self):
        rings = [[[a, a], [5 - a, a], [5 - a, 5 - a], [a, 5 - a], [a, a]] for a in (-1e-7 * k for k in range(2000))]
        self.write("bundle.geojson", json.dumps({"type": "Polygon", "coordinates": rings}).encode())
        plan = ("preload", "http://127.0.0.1:9/{z}/{x}/{y}.png", "--polygon", "bundle.geojson", "--dry-run", "--offline",
                "-o", "x.gpkg", "--levels")
        self.assert_fails(FAILED, *plan, "24-24", says=["--polygon", "level 24", "simplify", "end --levels at 22"])
        self.assert_done(*plan, "0-8")

    def test_a_tangled_polygon_is_named_and_equal_rings_are_drawn(self):
        ring = [[0, 0], [10, 0], [10, 10], [0, 10], [0, 0]]
        self.write("equal.geojson", collection(feature("Polygon", [ring] * 501)))
        self.assert_done("render", "--objects", "equal.geojson", "-o", "equal.png", *SMALL)
        corners = 2001
        turns = [2 * math.pi * k * (corners // 2) / corners for k in range(corners)]
        star = [[0.01 * math.cos(t), 0.01 * math.sin(t)] for t in turns]
        self.write("star.geojson", collection(feature("Polygon", [star + star[:1]])))
        self.assert_done("render", "--objects", "star.geojson", "-o", "star.png", *SMALL)  # a picture has no triangles
        high = [[x, y, 1000.0] for x, y in star]
        self.assert_drawn_in_part(collection(GOOD, feature("Polygon", [high + high[:1]])), "feature 2", "without its fill",
                                  "cross", "ST_MakeValid")

    def test_a_file_without_fault(self):
        self.write("f.geojson", collection(GOOD, feature("Point", [0, 0], title="Null Island")))
        self.assertEqual(self.assert_done("render", "--objects", "f.geojson", "-o", "out.png", *SMALL).stderr, "")

    def test_an_icon_is_drawn_from_a_file_beside_the_objects(self):
        self.write("red.png", png(40, 20, (255, 0, 0)))
        self.write("f.geojson", collection(feature("Point", [0, 0], icon="red.png")))
        self.assert_done("render", "--objects", "f.geojson", "-o", "out.png", "--camera", "0,0,5000000", *SMALL)
        seen = pngs.read(self.folder / "out.png")
        red = [(x, y) for x in range(64) for y in range(64) if tuple(pngs.pixel(seen, x, y)) == (255, 0, 0)]
        self.assertEqual((min(red), max(red)), ((12, 22), (51, 41)), "40 by 20 pixels around the middle")

    def test_an_icon_that_is_not_there_is_told_and_a_disc_is_drawn(self):
        self.assert_drawn_in_part(collection(GOOD, feature("Point", [0, 0], icon="plane.png", name="Kilo 7")),
                                  'feature 2 ("Kilo 7")', "plane.png", "a disc is drawn")
        self.write("plane.png", b"GIF89a")
        self.assert_drawn_in_part(collection(feature("Point", [0, 0], icon="plane.png")), "feature 1", "PNG")
        self.write("plane.png", png(300, 20))
        self.assert_drawn_in_part(collection(feature("Point", [0, 0], icon="plane.png")), "300x20", "at most 256")

    def test_no_such_file(self):
        self.assert_fails(FAILED, "render", "--objects", "nowhere.geojson", "-o", "out.png", *SMALL,
                          says=["nowhere.geojson"])

    def test_without_a_name(self):
        self.assert_fails(WRONG_USAGE, "render", "-o", "out.png", "--objects", says=["--objects"])

    def test_not_json(self):
        self.assert_refused(b"<kml></kml>", "not JSON", "GeoJSON")
        self.assert_refused(b"", "not JSON")
        self.assert_refused(bytes(range(256)), "not JSON")

    def test_json_but_no_geojson(self):
        self.assert_refused(b'{"cities": []}', "no GeoJSON")
        self.assert_refused(b"[1, 2, 3]", "no GeoJSON")

    def test_coordinates_out_of_range(self):
        self.assert_drawn_in_part(collection(GOOD, feature("Point", [8.0, 91.0], name="Above"), GOOD),
                                  'feature 2 ("Above")', "8,91", "not on the planet")
        self.assert_drawn_in_part(collection(feature("LineString", [[0, 0], [0, 0, 1e300]]), GOOD), "feature 1", "height")

    def test_rings_that_do_not_close(self):
        open_ring = [[[0, 0], [10, 0], [10, 10], [0, 10]]]
        self.assert_drawn_in_part(collection(GOOD, feature("Polygon", open_ring, name="Gap")), 'feature 2 ("Gap")', "ring 1",
                                  "not closed", "0,0", "0,10")

    def test_rings_over_the_antimeridian_and_a_pole_are_no_faults(self):
        over = [[[170, -10], [-170, -10], [-170, 10], [170, 10], [170, -10]]]
        pole = [[[0, 70], [90, 70], [180, 70], [-90, 70], [0, 70]]]
        self.write("f.geojson", collection(feature("Polygon", over), feature("Polygon", pole)))
        self.assertEqual(self.assert_done("render", "--objects", "f.geojson", "-o", "out.png", *SMALL).stderr, "")

    def test_text_that_breaks_off(self):
        self.assert_drawn_in_part(collection(GOOD, GOOD)[:-30], "not JSON at byte", "features before are drawn")

    def test_a_model_made_of_a_long_chain_of_nodes(self):
        nodes = [{"children": [k]} for k in range(1, 200_000)] + [{"mesh": 0}]
        self.write("chain.gltf", json.dumps(triangle(nodes=nodes)).encode())
        self.write("f.geojson", collection(GOOD, feature("Point", [0, 0], model="chain.gltf")))
        self.assert_done("render", "--objects", "f.geojson", "-o", "out.png", *SMALL)

    def test_a_model_that_leads_out_of_its_folder(self):
        outside = self.folder.parent / (self.folder.name + "-outside.bin")
        self.addCleanup(outside.unlink)
        outside.write_bytes(bytes(TRIANGLE))
        (self.folder / "link.bin").symlink_to(outside)
        for uri in ("link.bin", f"../{outside.name}", f"%2e%2e/{outside.name}", str(outside)):
            with self.subTest(uri):
                self.write("m.gltf", json.dumps(triangle(uri)).encode())
                self.assert_drawn_in_part(collection(GOOD, feature("Point", [0, 0], model="m.gltf")), "feature 2",
                                          "m.gltf: ", outside.name if uri != "link.bin" else "link.bin", "folder")
        self.write("m.glb", b"glTF")
        (self.folder / "m.glb").unlink()
        (self.folder / "m.glb").symlink_to(outside)
        self.assert_drawn_in_part(collection(GOOD, feature("Point", [0, 0], model="m.glb")), "feature 2", "m.glb: ",
                                  "out of the folder")

    def test_a_million_points(self):
        place = random.Random(1)
        points = [[round(place.uniform(-180, 180), 2), round(place.uniform(-85, 85), 2)] for _ in range(1_000_000)]
        self.write("f.geojson", collection(feature("MultiPoint", points, radius_m=2000)))
        self.assert_done("render", "--objects", "f.geojson", "-o", "out.png", *SMALL)


if __name__ == "__main__":
    unittest.main()
