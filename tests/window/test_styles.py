"""A layer's style by real mouse and keyboard: field, classes and colours, the legend, the saved style."""

import json
import unittest

import png
from ellipsoid_camera import ecef
from real_window import WindowTest, wait_until

SIZE = (800, 600)
VIEW = "6,12,4500000"
SIDE = 5.0
# People fall into three groups that quantiles cut elsewhere.
PEOPLE = [1, 2, 3, 40, 41, 42, 43, 100, None]
KINDS = ["town", "town", "town", "wood", "wood", "lake", "moor", "town", None]
OWN, REST = (255, 0, 255), (138, 138, 138)
# The ends and the middle of the colour maps.
VIRIDIS = [(68, 1, 84), (33, 145, 140), (253, 231, 37)]
GREY = [(0, 0, 0), (128, 128, 128), (255, 255, 255)]
ABOVE_MESSAGES = 505  # rows from the top
# Rows of the panel, from its upper edge. The row of the layer is the first one.
ROW, STYLE, FIELD, KIND, CLASSES, COLOURS, REVERSED, BUTTONS = 65, 113, 136, 162, 188, 214, 240, 286
FIELDS = ["", "fill", "fill-opacity", "kind", "people", "stroke"]  # the first one is "As in the file"
MAPS = ["viridis", "magma", "cividis", "grey", "terrain", "diverging"]
JENKS = 2


def middle(k):
    """Latitude and longitude of the middle of a district."""
    return 17.0 - SIDE * (k // 3), -3.0 + SIDE * (k % 3)


def district(k):
    lat, lon = middle(k)
    half = SIDE / 2
    ring = [[lon - half, lat - half], [lon + half, lat - half], [lon + half, lat + half], [lon - half, lat + half],
            [lon - half, lat - half]]
    fields = {"people": PEOPLE[k], "kind": KINDS[k], "fill": "#ff00ff", "fill-opacity": 1, "stroke": "#ffffff"}
    return {"type": "Feature", "properties": fields, "geometry": {"type": "Polygon", "coordinates": [ring]}}


DISTRICTS = {"type": "FeatureCollection", "features": [district(k) for k in range(9)]}


def near(pixel, color):
    return all(abs(a - b) <= 2 for a, b in zip(pixel, color))


def upper(picture):
    """The rows that show neither messages nor the status line."""
    return picture[2][:ABOVE_MESSAGES]


class Styles(WindowTest):
    def write_districts(self):
        (self.folder / "districts.geojson").write_text(json.dumps(DISTRICTS), encoding="utf-8")

    def begin(self, *options):
        self.write_districts()
        self.viewer = self.start("--objects", "districts.geojson", "--camera", VIEW, "--unlit", *options, size=SIZE)

    def open_style(self):
        """Opens the panel, the row of the layer and its style; the file's fields are read by then."""
        self.viewer.key("l")
        left, top, *_ = self.viewer.panel("Layers")
        self.viewer.settled()
        for y in (ROW, STYLE):
            before = self.viewer.panel("Layers")
            self.viewer.click(round(left) + 90, round(top) + y)
            wait_until("the row", lambda: self.viewer.panel("Layers")[3] > before[3] + 10)
            self.viewer.settled()
        self.left, self.top = round(left), round(top)

    def choose(self, y, choice, count):
        """Chooses an entry of the list in a row of the panel."""
        lists = lambda: [box for name, box in self.viewer.layout.panels.items() if name.startswith("Combo_")]
        self.viewer.click(self.left + 100, self.top + y)
        left, top, right, bottom = wait_until("the list", lists)[0]
        self.viewer.settled()
        self.assertGreater(bottom - top, 15 * count, "all entries are in view")
        self.viewer.click(round(left) + 30, round(top + (bottom - top) * (choice + 0.5) / count))
        wait_until("no list", lambda: not lists())
        self.viewer.settled()

    def choose_field(self, name):
        self.choose(FIELD, FIELDS.index(name), len(FIELDS))

    def choose_classes(self, count, y=CLASSES):
        """Clicks the slider, which begins at two classes and ends at nine."""
        self.viewer.click(self.left + 63 + round(123 * (count - 2) / 7), self.top + y)
        self.viewer.settled()

    def button(self, number, y=BUTTONS):
        self.viewer.click(self.left + 90 + 100 * number, self.top + y)

    def colours(self, picture):
        """The colours of the districts."""
        pixels = [self.viewer.camera.pixel(ecef(*middle(k), 0.0)) for k in range(9)]
        return [png.pixel(picture, round(x - 0.5), round(y - 0.5)) for x, y in pixels]

    def shows(self, expected):
        return lambda picture: all(map(near, self.colours(picture), expected))

    def assert_swatches(self, column, colors):
        """The colours stand in a column of pixels, in this order, each over at least ten pixels."""
        rows = [[y for y, pixel in enumerate(column) if near(pixel, color)] for color in colors]
        self.assertTrue(all(len(ys) >= 10 for ys in rows), rows)
        self.assertEqual(sorted(rows), rows)

    def assert_legend(self, picture, colors):
        left, top, _, bottom = map(round, self.viewer.panel("legend"))
        self.assert_swatches([png.pixel(picture, left + 16, y) for y in range(top, bottom)], colors)
        self.assertEqual(self.viewer.layout.faults(*SIZE), [])

    def test_jenks_classes_with_a_legend_and_back_twice_in_a_row(self):
        self.begin()
        own = self.picture(self.viewer, "own", self.shows([OWN] * 9))
        self.assertNotIn("legend", self.viewer.layout.panels)
        self.open_style()
        for times, name in enumerate(("viridis", "grey")):
            low, mid, high = [VIRIDIS, GREY][times]
            self.choose_field("people")
            self.choose(KIND, JENKS, 4)
            self.choose_classes(3)
            self.choose(COLOURS, MAPS.index(name), len(MAPS))
            picture = self.picture(self.viewer, f"jenks_{times}", self.shows([low] * 3 + [mid] * 4 + [high, REST]))
            self.assert_legend(picture, [low, mid, high, REST])
            self.viewer.click(self.left + 64, self.top + REVERSED)
            picture = self.picture(self.viewer, f"reversed_{times}",
                                   self.shows([high] * 3 + [mid] * 4 + [low, REST]))
            self.viewer.click(self.left + 64, self.top + REVERSED)
            self.viewer.settled()
            self.button(1)
            wait_until("no legend", lambda: "legend" not in self.viewer.layout.panels)
            self.viewer.key("l")
            wait_until("no panel", lambda: "Layers" not in self.viewer.layout.panels)
            back = self.picture(self.viewer, f"back_{times}", self.shows([OWN] * 9))
            self.assertEqual(upper(back), upper(own), "the bytes of the picture before")
            self.viewer.key("l")
            self.viewer.panel("Layers")
            self.viewer.settled()

    def test_a_saved_picture_has_the_legend(self):
        self.begin()
        self.picture(self.viewer, "own", self.shows([OWN] * 9))
        self.open_style()
        self.choose_field("kind")
        low, high = VIRIDIS[0], VIRIDIS[2]
        self.choose_classes(2, KIND)
        self.picture(self.viewer, "styled", self.shows([low] * 3 + [high] * 2 + [REST] * 2 + [low, REST]))
        self.viewer.key("i")
        self.viewer.panel("Save picture")
        self.viewer.settled()
        self.viewer.key("Return")
        file = wait_until("the picture", lambda: list(self.folder.glob("terrella-*.png")))[0]
        picture = png.read(file)
        self.assertEqual(picture[:2], (2 * SIZE[0], 2 * SIZE[1]))
        column = [png.pixel(picture, 32, y) for y in range(SIZE[1], 2 * SIZE[1])]
        self.assert_swatches(column, [low, high, REST])

    def test_categories_of_a_text_and_quantiles(self):
        self.begin()
        self.picture(self.viewer, "own", self.shows([OWN] * 9))
        self.open_style()
        self.choose_field("kind")
        self.choose_classes(2, KIND)  # texts have no row for the kind of classes
        low, _, high = VIRIDIS
        expected = [low] * 3 + [high] * 2 + [REST] * 2 + [low, REST]
        picture = self.picture(self.viewer, "categories", self.shows(expected))
        self.assert_legend(picture, [low, high, REST])
        self.choose_field("people")
        picture = self.picture(self.viewer, "quantiles", self.shows([low] * 3 + [low, high] + [high] * 3 + [REST]))
        self.assert_legend(picture, [low, high, REST])

    def test_a_saved_style_draws_the_same_picture(self):
        self.begin()
        self.picture(self.viewer, "own", self.shows([OWN] * 9))
        self.open_style()
        self.choose_field("people")
        self.choose(KIND, JENKS, 4)
        self.choose_classes(3)
        low, mid, high = VIRIDIS
        groups = [low] * 3 + [mid] * 4 + [high, REST]
        self.picture(self.viewer, "styled", self.shows(groups))
        self.button(0)
        saved = wait_until("the file", lambda: list(self.folder.glob("terrella-*-style.json")))[0]
        self.assertEqual(json.loads(saved.read_text(encoding="utf-8"))["fill"][1][:2], ["step", ["get", "people"]])
        self.viewer.key("l")
        styled = self.picture(self.viewer, "saved", self.shows(groups))
        self.viewer.close()
        self.begin("--object-style", saved.name)
        again = self.picture(self.viewer, "again", self.shows(groups))
        self.assertEqual(upper(again), upper(styled))
        self.open_style()
        self.choose_field("kind")
        self.button(1, BUTTONS - KIND + FIELD)
        self.viewer.key("l")
        back = self.picture(self.viewer, "back", self.shows(groups))
        self.assertEqual(upper(back), upper(again), "the style of the command line counts as the file's own")

    def test_a_dropped_file_has_a_style_too(self):
        self.write_districts()
        self.viewer = self.start("--camera", VIEW, "--unlit", size=SIZE)
        self.viewer.drop((self.folder / "districts.geojson").resolve())
        self.viewer.next_camera()  # flies to the districts, whose middle column is beside the panel
        self.open_style()
        self.choose_field("people")
        self.viewer.move(5, 5)  # no tip over the districts
        self.picture(self.viewer, "dropped", lambda picture: all(map(near, self.colours(picture)[1::3], VIRIDIS)))


if __name__ == "__main__":
    unittest.main()
