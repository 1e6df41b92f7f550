"""Names in every script: typed or pasted into the search, found, flown to, and seen as their own letters."""

import itertools
import json
import unittest

from real_window import WindowTest, wait_until

# Name, latitude, longitude.
PLACES = [
    ("Αθήνα", 37.98, 23.73),
    ("Москва", 55.76, 37.62),
    ("القاهرة", 30.04, 31.24),
    ("ירושלים", 31.77, 35.21),
    ("กรุงเทพ", 13.76, 100.5),
    ("北京南站", 39.87, 116.38),
    ("上海虹桥", 31.2, 121.32),
]
INK = 150  # least brightness of letters; the panel behind them is dark


class Scripts(WindowTest):
    def start_with_places(self, camera="0,-150,9000000", bare=True):
        file = self.folder / "places.geojson"
        features = [{"type": "Feature", "properties": {"name": name},
                     "geometry": {"type": "Point", "coordinates": [lon, lat]}} for name, lat, lon in PLACES]
        file.write_text(json.dumps({"type": "FeatureCollection", "features": features}), encoding="ascii")
        return self.start("--places", file.name, "--camera", camera, bare=bare)

    def search(self, viewer, text):
        viewer.set_clipboard(text)
        viewer.key("slash")
        viewer.panel("Search")
        viewer.key("ctrl+v")
        viewer.settled()

    def lines_of(self, viewer):
        """The lines of text in the panel: for each, the columns with ink, and in which rows, as sets."""
        left, top, right, bottom = map(round, viewer.panel("Search"))
        rows = [bytes(row) for row in viewer.grab()[top:bottom]]
        inked = [{x for x in range(left + 4, right - 4) if row[4 * x + 1] > INK} for row in rows]
        bands = [list(band) for ink, band in itertools.groupby(inked, bool) if ink]
        return [[{y for y, row in enumerate(band) if x in row} for x in range(left, right)] for band in bands]

    def letters_of(self, line, count):
        """The pictures of letters of one width."""
        inked = [x for x, column in enumerate(line) if column]
        wide = (inked[-1] + 1 - inked[0]) / count
        starts = [round(inked[0] + k * wide) for k in range(count)]
        return [tuple(map(frozenset, line[start : start + int(wide)])) for start in starts]

    def test_a_name_in_each_script_is_found_and_flown_to(self):
        viewer = self.start_with_places()
        for name, lat, lon in PLACES:
            with self.subTest(name):
                self.search(viewer, name)
                viewer.save_grab(self.folder / f"search_{lat:.0f}_{lon:.0f}.png")
                viewer.key("Return")
                there = viewer.next_camera()
                self.assertAlmostEqual(there.lat, lat, delta=0.1)
                self.assertAlmostEqual(there.lon, lon, delta=0.1)
        self.assertEqual(viewer.quit(closing=1), 0)

    def test_letters_differ_where_question_marks_would_be_equal(self):
        viewer = self.start_with_places()
        seen = []
        for name in ("北京南站", "上海虹桥"):
            self.search(viewer, name)
            row = wait_until("a row of the list", lambda: self.lines_of(viewer)[-1])
            letters = self.letters_of(row, 4)
            self.assertEqual(len(set(letters)), 4, f"the letters of {name} are four pictures")
            seen += letters
            viewer.key("Return")
            viewer.next_camera()
        self.assertEqual(len(set(seen)), 8, "no letter is in both names")

    def test_typed_letters_are_written_and_found(self):
        viewer = self.start_with_places()
        viewer.key("slash")
        viewer.panel("Search")
        viewer.xdotool("type", "--delay", "100", "Αθή")
        viewer.settled()
        viewer.save_grab(self.folder / "typed.png")
        viewer.key("Return")
        there = viewer.next_camera()
        self.assertAlmostEqual(there.lat, 37.98, delta=0.1)
        self.assertAlmostEqual(there.lon, 23.73, delta=0.1)

    def test_a_name_on_the_map_has_its_letters(self):
        name, lat, lon = PLACES[5]
        viewer = self.start_with_places(f"{lat},{lon},3000000", bare=False)
        x, y = viewer.size[0] / 2, viewer.size[1] / 2  # middle of the dot; the name stands right of it

        def is_name(box):
            left, top, right, bottom = box
            return x < left < x + 20 and top < y < bottom and right - left > 2.0 * (bottom - top)

        wait_until(f"{name} on the map", lambda: any(map(is_name, viewer.layout.labels)))
        viewer.save_grab(self.folder / "map.png")


if __name__ == "__main__":
    unittest.main()
