"""--map: coastlines and borders are where the data say, and a picture without them is the picture as it was."""

import json
import unittest

import png
from pictures import png as png_bytes
from program import FAILED, SOURCE, WRONG_USAGE, ProgramTest

MAP = json.loads((SOURCE / "data/vector/map.json").read_text(encoding="utf-8"))
SIDE = 64  # pixels
LOOK = ["--unlit", "--size", f"{SIDE}x{SIDE}"]
# A line is a pixel wide, and its edge three; data and picture agree to half a pixel.
ON_LINE_PX, BESIDE_LINE_PX = 1, 5


def places(kind, number):
    """Latitudes and longitudes of a line: steps in fractions of a degree."""
    steps, x, y = MAP[kind][number], 0, 0
    for i in range(0, len(steps), 2):
        x, y = x + steps[i], y + steps[i + 1]
        yield MAP["origin"][1] + y * MAP["degrees"][1], MAP["origin"][0] + x * MAP["degrees"][0]


def difference(a, b, x, y):
    return sum(abs(a[2][y][3 * x + i] - b[2][y][3 * x + i]) for i in range(3))


class MapTest(ProgramTest):
    def picture(self, name, *options, look=LOOK):
        self.assert_done("render", "-o", name, *look, *options)
        return self.folder / name

    def test_without_the_map_the_picture_is_as_it_was(self):
        view = ["--camera", "46,9,800000"]
        plain, off, on = (self.picture(f"{k}.png", *view, *more).read_bytes()
                          for k, more in enumerate(([], ["--map", "off"], ["--map", "on"])))
        self.assertEqual(plain, off)
        self.assertNotEqual(plain, on)

    def test_lines_are_where_the_data_say(self):
        """Straight down on a place of a line, the middle of the picture has the line, and its ring has not."""
        longest = {kind: max(range(len(MAP[kind])), key=lambda k: len(MAP[kind][k])) for kind in ("coasts", "borders")}
        lines = [list(places(kind, number)) for kind, number in longest.items()]
        spots = [line[len(line) // 3] for line in lines]
        coasts = [list(places("coasts", k)) for k in range(len(MAP["coasts"]))]
        spots.append(max((line[len(line) // 2] for line in coasts), key=lambda spot: abs(spot[1])))  # at the antimeridian
        spots.append(min((line[len(line) // 2] for line in coasts), key=lambda spot: spot[0]))  # in Antarctica
        for lat, lon in spots:
            with self.subTest(lat=lat, lon=lon):
                camera = ["--camera", f"{lat},{lon},60000"]
                off, on = (png.read(self.picture(f"{word}.png", *camera, "--map", word)) for word in ("off", "on"))
                middle = range(SIDE // 2 - ON_LINE_PX, SIDE // 2 + ON_LINE_PX)
                self.assertGreater(max(difference(off, on, x, y) for x in middle for y in middle), 60)
                ring = range(SIDE // 2 - BESIDE_LINE_PX, SIDE // 2 + BESIDE_LINE_PX)
                same = sum(difference(off, on, x, y) == 0 for x in ring for y in ring)
                self.assertGreater(same, BESIDE_LINE_PX**2)

    def test_the_name_of_a_sea_is_spaced_and_slanted(self):
        """The Philippine Sea, without coasts near its name's place: the left edge of its P leans to the right."""
        row = MAP["seas"]["name"].index("Philippine Sea")
        look = ["--unlit", "--size", "400x300"]
        view = ["--camera", f"{MAP['seas']['lat'][row]},{MAP['seas']['lon'][row]},3000000"]
        off, on = (png.read(self.picture(f"{word}.png", *view, "--map", word, look=look)) for word in ("off", "on"))
        names = range(400 // 2 - 90, 400 // 2 + 90)
        rows = [[x for x in names if difference(off, on, x, y) > 90] for y in range(150 - 12, 150 + 12)]
        inked = [row for row in rows if row]
        letters = sorted({x for row in inked for x in row})
        self.assertGreater(letters[-1] - letters[0], 7 * len("Philippine Sea") + 20)
        self.assertLess(letters[-1] - letters[0], 11 * len("Philippine Sea") + 20)
        self.assertAlmostEqual(0.5 * (letters[0] + letters[-1]), 200, delta=8)
        self.assertGreater(min(inked[2]), min(inked[9]))

    def test_what_is_drawn_is_credited(self):
        told = [json.loads(self.assert_done("render", "-o", "m.png", *LOOK, "--json", *more).stdout)["attributions"]
                for more in (["--map", "on"], [])]
        self.assertEqual(set(told[0]) - set(told[1]), {"Natural Earth", "GeoNames"})

    def test_graticule_and_credits_are_drawn_at_any_size(self):
        """Lines cross where latitudes and longitudes are round; credits stand in the upper right corner."""
        for width, height in ((320, 240), (2048, 1024)):
            view = ["--unlit", "--size", f"{width}x{height}", "--camera", "0,0,40000000"]
            plain, lined, credited = (png.read(self.picture("g.png", *more, look=view))
                                      for more in ([], ["--graticule"], ["--credits"]))
            middle = (width // 2, height // 2)
            self.assertGreater(max(difference(plain, lined, middle[0] + d, middle[1] + d) for d in (-1, 0)), 60)
            beside = (middle[0] + height // 40, middle[1] + height // 40)
            self.assertEqual(difference(plain, lined, *beside), 0)
            rows = [y for y in range(height) if plain[2][y] != credited[2][y]]
            self.assertLess(max(rows), height // 3)
            differ = [x for x in range(width) if any(difference(plain, credited, x, y) for y in rows)]
            self.assertGreater(min(differ), width // 100)
            self.assertGreater(max(differ), width * 9 // 10)

    def test_labels_are_legible_on_snow(self):
        """On white ground each name and each label of the graticule has a dark edge."""
        self.write("snow.png", png_bytes(64, 32, (255, 255, 255)))
        view = ["snow.png", "--unlit", "--size", "320x240", "--camera", "47,8,900000"]
        for layer in (["--map", "on"], ["--graticule"]):
            _, _, rows = png.read(self.picture("s.png", *layer, look=view))
            self.assertGreater(sum(max(row[i : i + 3]) < 90 for row in rows for i in range(0, len(row), 3)), 300, layer)

    def test_credits_without_room_are_refused(self):
        failed = self.assert_fails(FAILED, "render", "-o", "m.png", *LOOK, "--credits",
                                   says=["m.png", "64 x 64", "no room for the sources", "larger"])
        self.assertEqual(failed.stdout, "")
        self.assertFalse((self.folder / "m.png").exists())

    def test_objects_credit_their_source(self):
        spot = {"type": "Point", "coordinates": [8, 47]}
        self.write("o.geojson", json.dumps({**spot, "attribution": "Example Survey"}).encode())
        told = json.loads(self.assert_done("render", "-o", "o.png", *LOOK, "--json", "--objects", "o.geojson").stdout)
        self.assertIn("Example Survey", told["attributions"])

    def test_the_moon_has_no_map_but_names_from_a_file(self):
        self.write("moon.png", png_bytes(64, 32))
        moon = ["moon.png", "--body", "moon"]
        self.assert_fails(WRONG_USAGE, "render", "-o", "m.png", *LOOK, *moon, "--map", "on",
                          says=["--map", "Earth", "--places"])
        feature = {"type": "Feature", "properties": {"name": "Tycho"},
                   "geometry": {"type": "Point", "coordinates": [-11.2, -43.3]}}
        self.write("moon.geojson", json.dumps({"type": "FeatureCollection", "features": [feature]}).encode())
        view = [*moon, "--camera", "-43.3,-11.2,2000000"]
        plain, named, off = (self.picture("moon_view.png", *view, *more, look=["--unlit", "--size", "256x256"]).read_bytes()
                             for more in ([], ["--places", "moon.geojson"], ["--places", "moon.geojson", "--map", "off"]))
        self.assertNotEqual(plain, named)
        self.assertEqual(plain, off)


if __name__ == "__main__":
    unittest.main()
