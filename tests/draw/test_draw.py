"""Marks are drawn, edited, kept and saved in a real window, by mouse and by keyboard."""

import json
import subprocess
import time
import unittest

from ellipsoid_camera import ecef
from real_window import WindowTest, differing, wait_until

SIZE = (800, 600)
VIEW = "0,20,9000000"
AREA = ((430, 200), (640, 230), (600, 400), (450, 380))  # pixels beside the panel
MOVED = (400, 150)
MIDDLE = (SIZE[0] / 2 - 0.5, SIZE[1] / 2 - 0.5)
NAME_FIELD, FILE_FIELD = 174, 43  # pixels under the upper edge of the panel, and over its lower edge
KINDS = {"Place mark": 0, "Line": 1, "Area": 2}


class Draw(WindowTest):
    def begin(self, *options, view=VIEW):
        self.viewer = self.start("--camera", view, "--unlit", *options, size=SIZE)
        self.viewer.settled()

    # Hands

    def key(self, *names):
        for name in names:
            self.viewer.key(name)
            time.sleep(0.15)

    def click(self, *at):
        time.sleep(0.5)  # no double click
        self.viewer.click(*at)

    def seen(self, act, *arguments):
        """Acts, and waits until the picture has changed: a slow frame takes no letters for a field."""
        before = self.viewer.settled()
        act(*arguments)
        wait_until("another picture", lambda: differing(before, self.viewer.grab()) > 8)
        self.viewer.settled(still_s=0.4)

    def quits(self):
        self.key("ctrl+q")
        self.assertEqual(self.viewer.program.wait(timeout=30), 0)

    def open_panel(self):
        self.seen(self.key, "d")
        self.viewer.panel("Draw")

    def choose(self, kind):
        """By keyboard, while the panel has it and one of the buttons in the first row is chosen."""
        self.key("Left", "Left", *["Right"] * KINDS[kind])
        self.seen(self.key, "Return")

    def type(self, text):
        self.viewer.xdotool("type", "--delay", "40", text)

    # Kept marks

    def features(self):
        file = self.kept_file()
        return json.loads(file.read_text(encoding="utf-8"))["features"] if file.exists() else []

    def kept_file(self, name="drawings"):
        return self.settings.parent / f"{name}.geojson"

    def marks(self, count):
        wait_until(f"{count} kept marks", lambda: len(self.features()) == count)
        return self.features()

    def ring(self, mark=0):
        return self.features()[mark]["geometry"]["coordinates"][0]

    def near(self, position, pixel, slack_px=1.0):
        lon, lat = position
        x, y = self.viewer.camera.pixel(ecef(lat, lon, 0.0))
        self.assertLess(abs(x - 0.5 - pixel[0]) + abs(y - 0.5 - pixel[1]), slack_px, (position, pixel))

    def draw_area(self):
        self.open_panel()
        self.choose("Area")
        for at in AREA[:-1]:
            self.click(*at)
        time.sleep(0.5)
        self.viewer.double_click(*AREA[-1])

    def test_an_area_by_mouse_is_moved_undone_redone_and_kept(self):
        self.begin()
        before = self.viewer.settled()
        self.draw_area()
        self.marks(1)
        ring = self.ring()
        self.assertEqual(len(ring), len(AREA) + 1)
        self.assertEqual(ring[0], ring[-1])
        self.near(ring[0], AREA[0])
        self.assertTrue(self.viewer.camera_stays(0.2), "clicks that draw do not fly")
        self.viewer.settled()
        self.viewer.save_grab(self.folder / "area.png")
        for times in (1, 2):
            self.viewer.drag(AREA[0], MOVED)
            moved = wait_until("the moved place", lambda: self.ring() != ring and self.ring())
            self.near(moved[0], MOVED)
            self.assertEqual(moved[1:-1], ring[1:-1])
            self.assertTrue(self.viewer.camera_stays(0.2), "the globe stays")
            self.viewer.save_grab(self.folder / f"moved_{times}.png")
            self.key("ctrl+z")
            wait_until("the earlier place", lambda: self.ring() == ring)
            self.key("ctrl+y" if times == 1 else "ctrl+shift+z")
            wait_until("the later place", lambda: self.ring() == moved)
            self.key("ctrl+z")
            wait_until("the earlier place", lambda: self.ring() == ring)
        self.key("ctrl+z")
        self.marks(0)
        self.key("Escape")
        wait_until("no panel", lambda: "Draw" not in self.viewer.layout.panels)
        after = self.viewer.settled()
        self.assertEqual(sum(map(int.__ne__, before[300], after[300])), 0, "nothing is left in the picture")

    def test_the_diamond_moves_the_whole_mark(self):
        self.begin()
        self.draw_area()
        self.marks(1)
        ring = self.ring()
        lat, lon = (sum(position[k] for position in ring[:-1]) / 4 for k in (1, 0))
        x, y = (round(value - 0.5) for value in self.viewer.camera.pixel(ecef(lat, lon, 0.0)))
        self.viewer.drag((x, y), (x - 60, y - 40))
        moved = wait_until("another ring", lambda: self.ring() != ring and self.ring())
        for (lon_before, lat_before), (lon_after, lat_after) in zip(ring, moved):
            self.assertLess(lon_after, lon_before)
            self.assertGreater(lat_after, lat_before)

    def test_a_line_and_a_place_mark_by_keyboard_alone(self):
        self.begin()
        self.open_panel()
        self.choose("Line")
        self.key("Return")
        for _ in range(3):
            self.key("Right")
            self.viewer.next_camera()
            self.key("Return")
        self.viewer.settled()
        self.viewer.save_grab(self.folder / "sketch.png")
        self.key("BackSpace", "Return", "Return")
        line = self.marks(1)[0]["geometry"]
        self.assertEqual((line["type"], len(line["coordinates"])), ("LineString", 4))
        lons = [lon for lon, _ in line["coordinates"]]
        self.assertEqual(lons, sorted(lons))
        self.near(line["coordinates"][-1], MIDDLE)
        self.seen(self.key, "F6")
        self.choose("Place mark")
        self.key("Up")
        self.viewer.next_camera()
        self.key("Return")
        place = self.marks(2)[1]["geometry"]
        self.assertEqual(place["type"], "Point")
        self.near(place["coordinates"], MIDDLE)
        self.key("Up")
        self.viewer.next_camera()
        self.seen(self.key, "F6")
        self.key(*["Down"] * 6, "Return")
        wait_until("the moved place mark", lambda: self.features()[1]["geometry"] != place)
        self.viewer.settled()
        self.viewer.save_grab(self.folder / "by_keyboard.png")
        self.quits()

    def test_escape_drops_the_mark_and_then_closes_the_panel(self):
        self.begin()
        for _ in range(2):
            self.open_panel()
            self.choose("Area")
            self.click(*AREA[0])
            self.key("Escape")
            self.viewer.settled()
            self.assertIn("Draw", self.viewer.layout.panels)
            self.key("Escape")
            wait_until("no panel", lambda: "Draw" not in self.viewer.layout.panels)
        self.assertEqual(self.features(), [])
        self.assertIsNone(self.viewer.program.poll())

    def test_a_mark_that_is_being_drawn_is_kept_at_the_end(self):
        self.begin()
        self.open_panel()
        self.choose("Line")
        self.click(*AREA[0])
        self.click(*AREA[1])
        self.quits()
        self.marks(1)

    def save_as(self, name):
        left, _, _, bottom = map(round, self.viewer.layout.panels["Draw"])
        self.viewer.move(left + 60, bottom - 5)  # the pointer may rest on the field since an earlier viewer
        self.seen(self.viewer.click, left + 60, bottom - FILE_FIELD)
        self.key("ctrl+a")
        self.type(name)
        self.key("Return")
        return wait_until(name, lambda: (self.folder / name).exists() and (self.folder / name).read_text("utf-8") or None)

    def test_what_is_saved_opens_again_in_the_same_bytes_twice_in_a_row(self):
        self.viewer = self.start("--camera", VIEW, size=SIZE)
        self.draw_area()
        self.marks(1)
        self.viewer.settled(still_s=0.4)
        left, top, _, _ = map(round, self.viewer.layout.panels["Draw"])
        self.seen(self.viewer.click, left + 60, top + NAME_FIELD)
        self.type("Delta 1")
        self.key("Return")
        wait_until("the name", lambda: self.features()[0]["properties"].get("title") == "Delta 1")
        self.viewer.settled()
        self.viewer.save_grab(self.folder / "named.png")
        saved = self.save_as("one.geojson")
        self.assertEqual(saved, self.kept_file().read_text("utf-8"))
        kml = self.save_as("one.kml")
        self.quits()
        for times in (1, 2):
            with self.subTest(times=times):
                self.begin("--objects", "one.kml" if times == 1 else "one.geojson")
                self.open_panel()
                self.viewer.settled()
                self.viewer.save_grab(self.folder / f"restarted_{times}.png")
                self.assertEqual(self.save_as(f"again_{times}.geojson"), saved)
                self.assertEqual(self.save_as(f"again_{times}.kml"), kml)
                self.quits()
        for name in ("one.geojson", "one.kml"):
            told = subprocess.run(["ogr2ogr", "-f", "GeoJSON", "/vsistdout/", name], cwd=self.folder, check=True,
                                  capture_output=True, text=True, timeout=60).stdout
            shape = json.loads(told)["features"][0]["geometry"]["coordinates"][0]
            self.assertEqual([position[:2] for position in shape], self.ring(), name)

    def test_a_measurement_is_kept_as_a_line(self):
        self.begin()
        self.key("m")
        for at in AREA[:2]:
            self.click(*at)
        self.key("ctrl+d")
        line = self.marks(1)[0]["geometry"]
        self.assertEqual(line["type"], "LineString")
        for position, at in zip(line["coordinates"], AREA):
            self.near(position, at)
        wait_until("the panel", lambda: "Draw" in self.viewer.layout.panels)
        self.assertNotIn("measure", self.viewer.layout.panels)

    def test_a_file_that_cannot_be_kept_is_told_before_the_end(self):
        self.kept_file().mkdir()
        self.begin()
        self.draw_area()
        wait_until("the message", lambda: "message" in self.viewer.layout.panels)
        self.key("ctrl+q")
        time.sleep(1.0)
        self.assertIsNone(self.viewer.program.poll(), "the first time")
        self.viewer.settled()
        self.viewer.save_grab(self.folder / "not_kept.png")
        self.quits()

    def test_other_clicks_and_the_balloon_are_as_before(self):
        self.begin()
        self.draw_area()
        self.marks(1)
        self.key("Escape")
        wait_until("no panel", lambda: "Draw" not in self.viewer.layout.panels)
        self.click(530, 300)
        wait_until("the balloon", lambda: "#balloon" in self.viewer.layout.panels)
        self.viewer.drag((530, 300), (560, 330))
        self.viewer.next_camera()
        self.assertEqual(len(self.ring()), len(AREA) + 1)

    def test_the_panel_fits_small_windows_and_large_letters(self):
        for size in ((320, 240), (640, 480)):
            with self.subTest(size=size):
                self.viewer = self.start("--camera", VIEW, "--unlit", size=size)
                self.open_panel()
                self.choose("Place mark")
                self.seen(self.key, "Return")
                self.seen(self.key, "F6")
                self.viewer.save_grab(self.folder / f"{size[0]}.png")
                self.assertEqual(self.viewer.layout.faults(*size), [])
                self.viewer.close()
        self.marks(2)
        self.viewer = self.start_at_192_dpi("--camera", VIEW, "--unlit")
        self.open_panel()
        self.key("Down")
        self.seen(self.key, "Return")
        self.viewer.save_grab(self.folder / "dpi.png")
        self.assertEqual(self.viewer.layout.faults(800, 600), [])


if __name__ == "__main__":
    unittest.main()
