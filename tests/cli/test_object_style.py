"""--object-style: features have the colours, widths and texts that a style computes from their fields."""

import json
import unittest

import png
from program import FAILED, WRONG_USAGE, ProgramTest

VIEW = ("--camera", "0,0,4000000", "--size", "200x150", "--unlit", "--sky", "off", "--cache", "off")
MIDDLE = (100, 75)
BY_PEOPLE = {"fill": ["interpolate", ["linear"], ["get", "people"], 0, "#000000", 100, "#ff8000"], "fill-opacity": 1,
             "stroke-width": 0}


def square(people):
    return {"type": "Feature", "properties": {"people": people, "fill": "#0000ff"},
            "geometry": {"type": "Polygon", "coordinates": [[[-9, -9], [9, -9], [9, 9], [-9, 9], [-9, -9]]]}}


class ObjectStyle(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("f.geojson", json.dumps(square(50)).encode())

    def drawn(self, style):
        self.write("style.json", json.dumps(style).encode())
        self.assert_done("render", "--objects", "f.geojson", "--object-style", "style.json", "-o", "out.png", *VIEW)
        return png.pixel(png.read(self.folder / "out.png"), *MIDDLE)

    def test_an_area_has_the_colour_of_its_field(self):
        # The mean of black and #ff8000, within the rounding of colours.
        for channel, expected in zip(self.drawn(BY_PEOPLE), (128, 64, 0)):
            self.assertAlmostEqual(channel, expected, delta=1)
        kinds = {**BY_PEOPLE, "fill": ["match", ["get", "people"], 50, "#00ff00", "#ff0000"]}
        self.assertEqual(self.drawn(kinds), (0, 255, 0))

    def test_without_a_style_the_feature_has_its_own(self):
        self.write("own.geojson", json.dumps(square(50)).encode())
        self.assertEqual(self.drawn({"fill-opacity": 1, "stroke-width": 0}), (0, 0, 255), "what the style leaves alone")

    def test_a_legend_shows_its_classes(self):
        style = {"fill": ["step", ["get", "people"], "#00ff00", 40, "#0000ff", 60, "#ff0000"]}
        self.write("style.json", json.dumps(style).encode())
        drawn = ("render", "--objects", "f.geojson", "--object-style", "style.json", "--camera", "40,60,4000000",
                 "--size", "400x300", *VIEW[4:])
        self.assert_done(*drawn, "-o", "plain.png")
        self.assert_done(*drawn, "--legend", "-o", "legend.png")
        # Swatches stand at the left edge: the classes in their order, under the title.
        plain, legend = (png.read(self.folder / name) for name in ("plain.png", "legend.png"))
        column = [png.pixel(legend, 30, y) for y in range(300)]
        seen = [column.index(color) for color in ((0, 255, 0), (0, 0, 255), (255, 0, 0))]
        self.assertEqual(seen, sorted(seen))
        self.assertGreater(seen[0], 200)
        self.assertNotEqual(png.pixel(plain, 30, seen[0]), (0, 255, 0))

    def test_a_faulty_style_is_refused_with_a_cure(self):
        faults = {
            '{"colour": "#fff"}': ["style.json", '"colour"', "there are"],
            '{"fill": ["zoom"]}': ["style.json", '"fill"', '"zoom"', "interpolate"],
            "{": ["style.json"],
        }
        for text, says in faults.items():
            self.write("style.json", text.encode())
            self.assert_fails(FAILED, "render", "--objects", "f.geojson", "--object-style", "style.json", "-o", "no.png",
                              *VIEW, says=says)
            self.assertFalse((self.folder / "no.png").exists())

    def test_points_close_to_one_another_are_a_cluster(self):
        """A disc of the clusters' colour, wider than a marker; apart from nearby; a radius out of range is refused."""
        points = [{"type": "Feature", "properties": {}, "geometry": {"type": "Point", "coordinates": [0.02 * k, 0.0]}} for k in range(9)]
        self.write("p.geojson", json.dumps({"type": "FeatureCollection", "features": points}).encode())
        beside = (MIDDLE[0] - 9, MIDDLE[1])  # a disc of nine has a diameter of 29 px, a marker of 10
        seen = {}
        for height in (4000000, 3000):
            self.assert_done("render", "--objects", "p.geojson", "--cluster", "40", "-o", "out.png", "--camera", f"0,0,{height}", *VIEW[2:])
            seen[height] = png.pixel(png.read(self.folder / "out.png"), *beside)
        for channel, expected in zip(seen[4000000], (38, 92, 150)):
            self.assertAlmostEqual(channel, expected, delta=25, msg="the disc is 235/255 opaque")
        self.assertNotEqual(seen[3000], seen[4000000])
        for radius in ("9", "401", "nan"):
            self.assert_fails(WRONG_USAGE, "render", "--objects", "p.geojson", "--cluster", radius, "-o", "no.png", *VIEW,
                              says=["--cluster", "10"])

    def test_features_are_shown_at_their_zoom_levels_and_times(self):
        """From 4000 km a picture 150 px high has level 1.95, and 0.95 from 8000 km."""
        days = ("2026-06-01", "2026-06-03")
        self.write("f.geojson", json.dumps({**square(50), "properties": {"day": days[0], "level": 1.5}}).encode())
        look = {"fill": "#00ff00", "fill-opacity": 1, "stroke-width": 0}
        self.assertEqual(self.drawn({**look, "minzoom": ["get", "level"]}), (0, 255, 0))
        self.assertNotEqual(self.drawn({**look, "maxzoom": ["get", "level"]}), (0, 255, 0))
        self.write("style.json", json.dumps({**look, "time-begin": ["get", "day"], "time-end": days[1]}).encode())
        drawn = ("render", "--objects", "f.geojson", "--object-style", "style.json", "-o", "out.png", *VIEW)
        for time, shown in (("2026-05-31", False), ("2026-06-02", True), ("2026-06-03", False)):
            self.assert_done(*drawn, "--time", time + "T12:00Z")
            self.assertEqual(png.pixel(png.read(self.folder / "out.png"), *MIDDLE) == (0, 255, 0), shown, time)

    def test_it_needs_a_file_and_objects(self):
        self.assert_fails(FAILED, "render", "--objects", "f.geojson", "--object-style", "nowhere.json", "-o", "no.png",
                          *VIEW, says=["nowhere.json"])
        self.assert_fails(WRONG_USAGE, "render", "--object-style", "style.json", "-o", "no.png", *VIEW,
                          says=["--object-style", "--objects"])


if __name__ == "__main__":
    unittest.main()
