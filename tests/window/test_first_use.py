"""A new user's whole session at three sizes: nothing overlaps, and each thing is found, used and left."""

import json
import re
import time
import unittest

import png
from real_window import WindowTest, differing, wait_until
from test_actions import ICONS

WIDTH, HEIGHT = 780, 560
ROUTE = {
    "type": "Feature",
    "attribution": "Example Survey",
    "properties": {"title": "From Rome", "stroke": "#ffff00", "stroke-width": 4},
    "geometry": {"type": "LineString", "coordinates": [[12.5, 41.9], [14.3, 40.9], [18.2, 40.1]]},
}

BUTTON = 26  # units
BY_WORTH = ["menu", "compass", "plus", "minus", "search", "layers", "home", "tilted", "flat", "back", "forward", "clock"]


class FirstUse(WindowTest):
    """`unit`: pixels of a unit at 96 dots per inch."""

    def begin(self, viewer, unit=1):
        self.viewer, self.unit, self.count = viewer, unit, 0

    def shoot(self, name):
        """Keeps the picture at rest, in which nothing overlaps."""
        time.sleep(0.2)
        picture = self.viewer.settled()
        width, height = len(picture[0]), len(picture)
        faults = self.viewer.layout.faults(width, height)
        self.count += 1
        self.viewer.save_grab(self.folder / f"{self.count:02}_{name}.png", picture)
        self.assertEqual(faults, [], name)

    def panel(self, name):
        return wait_until(f"the panel {name}", lambda: self.viewer.layout.panels.get(name))

    def click_in(self, name, right, down):
        """Clicks at a place in units from the upper left corner of a panel."""
        left, top, *_ = self.panel(name)
        self.viewer.click(round(left + right * self.unit), round(top + down * self.unit))

    def type(self, text):
        self.viewer.xdotool("type", "--delay", "30", text)

    def free_spot(self):
        """A place of the globe that no panel covers, another one each time."""
        width, height = self.viewer.geometry()[2:]
        boxes = self.viewer.layout.panels.values()
        spots = [(x * width // 24, y * height // 24) for y in range(1, 24) for x in range(1, 24)]
        free = [(x, y) for x, y in spots
                if not any(left - 4 < x < right + 4 and top - 4 < y < bottom + 4 for left, top, right, bottom in boxes)]
        self.spots = getattr(self, "spots", 0) + 1
        return free[self.spots * len(free) // 3 % len(free)]

    # The steps of a session

    def search(self):
        for text, lat, lon in (("rome", 41.9, 12.5), ("sao paulo", -23.55, -46.63), ("47.4, 8.5", 47.4, 8.5)):
            self.viewer.key("slash")
            self.type(text)
            self.shoot("search_" + text.split(",")[0].replace(" ", "_"))
            self.viewer.key("Return")
            there = self.viewer.next_camera()
            self.assertAlmostEqual(there.lat, lat, delta=0.2)
            self.assertAlmostEqual(there.lon, lon, delta=0.2)
            self.shoot("there")

    def row_of_compass(self):
        """The row in the column of buttons, which has those of most worth."""
        _, top, _, bottom = self.viewer.layout.panels["controls"]
        count = round(((bottom - top) / self.unit - 6) / BUTTON)
        return [name for name in ICONS if name in BY_WORTH[:count]].index("compass")

    def tilt_and_return(self):
        """By the compass; a window without room for it has the key."""
        for key in ("shift+Up", "shift+Up", "shift+Left"):
            self.viewer.key(key)
            tilted = self.viewer.next_camera()
        self.assertGreater(tilted.pitch, -85.0)
        self.shoot("tilted")
        for pitch in (tilted.pitch, -90.0):
            if "controls" in self.viewer.layout.panels:
                self.click_in("controls", 15, 16 + BUTTON * self.row_of_compass())
            else:
                self.viewer.key("n")
            back = self.viewer.next_camera()
            self.assertAlmostEqual(back.heading, 0.0, delta=0.01)
            self.assertAlmostEqual(back.pitch, pitch, delta=1.0)
            time.sleep(1.0)  # no double click on the compass
        self.shoot("north_up")

    def open_by_dialog(self):
        route = self.folder / "route.geojson"
        route.write_text(json.dumps(ROUTE), encoding="ascii")
        self.viewer.key("ctrl+o")
        self.type(f"{self.folder.resolve()}/rou")
        self.shoot("open_dialog")
        self.viewer.key("Return")
        self.assertAlmostEqual(self.viewer.next_camera().lat, 41.0, delta=0.1)
        self.shoot("opened")

    def copy_by_right_click(self):
        width, height = self.viewer.geometry()[2:]
        self.viewer.set_clipboard("nothing")
        self.viewer.right_click(width // 2, height // 3)
        self.panel("Menu")
        self.shoot("menu")
        self.click_in("Menu", 50, 34)
        wait_until("the coordinates", lambda: re.fullmatch(r"4\d\.\d+, 1\d\.\d+", self.viewer.clipboard()))
        self.shoot("copied")

    def bookmark(self):
        file = self.kept / "terrella" / "bookmarks.json"
        self.viewer.key("k")
        self.panel("Bookmarks")
        self.shoot("bookmarks")
        self.click_in("Bookmarks", 60, 40)  # Save this view
        wait_until("the bookmark", file.exists)
        self.shoot("bookmark_saved")
        left, top, right, _ = self.panel("Bookmarks")
        self.viewer.click(round(right - 30 * self.unit), round(top + 62 * self.unit))  # Edit
        time.sleep(0.4)
        self.type("Start")
        self.shoot("bookmark_named")
        self.viewer.key("Return")
        wait_until("the name", lambda: json.loads(file.read_text())["names"] == {"1": "Start"})
        self.shoot("bookmark_kept")
        self.viewer.key("k")

    def measure_and_copy(self):
        self.viewer.key("m")
        for _ in range(2):
            self.viewer.settled()
            self.viewer.click(*self.free_spot())
        self.shoot("measured")
        self.viewer.set_clipboard("nothing")
        self.viewer.key("ctrl+c")
        wait_until("the length", lambda: "Length" in self.viewer.clipboard())
        self.shoot("measurement_copied")
        self.viewer.key("m")

    def play(self):
        self.viewer.settled()
        before = self.viewer.grab()
        self.viewer.key("t")
        wait_until("the time", lambda: differing(before, self.viewer.grab()) > 100)
        time.sleep(0.5)
        self.viewer.key("t")
        self.shoot("time_played")

    def reset(self):
        self.viewer.key("r")
        self.assertTrue(self.viewer.camera_stays(0.5), "R asks before a time is lost")
        self.viewer.key("r")
        there = self.viewer.next_camera()
        self.assertEqual((there.heading, there.pitch), (0.0, -90.0))
        self.shoot("reset")

    def panels(self):
        for key, name in (("F1", "shortcuts"), ("p", "view_settings"), ("l", "layers"), ("i", "picture")):
            self.viewer.key(key)
            self.shoot(name)
            self.viewer.key("Escape")
        self.viewer.key("g")
        self.shoot("graticule")

    def session(self):
        self.shoot("first_start")
        self.search()
        self.tilt_and_return()
        self.open_by_dialog()
        self.copy_by_right_click()
        self.bookmark()
        self.measure_and_copy()
        self.play()
        self.reset()
        self.panels()

    def test_from_the_first_start_to_the_second(self):
        self.settings.unlink()
        self.begin(self.start(size=None, bare=False))
        self.viewer.xdotool("windowsize", self.viewer.window, str(WIDTH), str(HEIGHT))
        wait_until("the size", lambda: self.viewer.geometry()[2:] == (WIDTH, HEIGHT))
        wait_until("panels of this size", lambda: not self.viewer.layout.faults(WIDTH, HEIGHT))
        self.session()
        self.fade()
        self.save_a_picture()
        self.viewer.key("Escape")  # the layers
        time.sleep(0.3)
        self.assertEqual(self.viewer.quit(closing=1), 0, "the mark of the search")
        kept = json.loads(self.settings.read_text(encoding="utf-8"))
        self.assertEqual((kept["width"], kept["height"], kept["graticule"]), (WIDTH, HEIGHT, True))
        self.viewer = self.start(size=None, bare=False)
        self.shoot("second_start")
        self.assertEqual(self.viewer.geometry()[2:], (WIDTH, HEIGHT))

    def fade(self):
        self.viewer.key("l")
        self.click_in("Layers", 80, 89)  # the imagery's row opens
        self.shoot("layer_row")

    def save_a_picture(self):
        self.viewer.key("i")
        left, _, _, bottom = self.panel("Save picture")
        self.shoot("picture_panel")
        self.viewer.click(round(left + 30), round(bottom - 42))  # Save

        def whole():
            files = list(self.folder.glob("terrella-*.png"))
            return files[0] if files and files[0].read_bytes().endswith(b"IEND\xaeB`\x82") else None

        file = wait_until("the picture", whole)
        file = file.rename(self.folder / "picture.png")
        self.assertEqual(png.read(file)[:2], (2 * WIDTH, 2 * HEIGHT))
        self.shoot("picture_saved")

    def test_the_same_in_a_window_of_200_by_150(self):
        self.begin(self.start(size=(200, 150), bare=False))
        self.session()

    def test_the_same_at_192_dots_per_inch(self):
        self.begin(self.start_at_192_dpi(bare=False), unit=2)
        self.session()


if __name__ == "__main__":
    unittest.main()
