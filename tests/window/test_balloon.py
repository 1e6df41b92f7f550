"""The balloon of an object: a click shows its name and its fields, and its links open only by a click on them."""

import json
import os
import time
import unittest

import png
from ellipsoid_camera import ecef
from real_window import SIZE, WindowTest, wait_until

LINK = "https://example.org/athens?a=b&c=d#e"
LONG = "The port has been in use since the fifth century before our era. " * 12
VIEW = "38,24,1500000"
MARKER, LINE, AREA, BARE = (37.98, 23.73), (39.5, 24.0), (36.5, 21.0), (40.8, 20.5)
CORNERS = [[20.0, 35.5], [22.0, 35.5], [22.0, 37.5], [20.0, 37.5], [20.0, 35.5]]
LINK_INK = (115, 184, 255)
SELECTED = (255, 220, 40)


def feature(kind, coordinates, **properties):
    return {"type": "Feature", "properties": properties, "geometry": {"type": kind, "coordinates": coordinates}}


OBJECTS = {
    "type": "FeatureCollection",
    "features": [
        feature("Point", [MARKER[1], MARKER[0]], people=664046, page=LINK, native="Αθήνα", nothing=None,
                **{"name": "Athens ##1", "marker-size": "large", "marker-color": "#0000ff"}),
        feature("LineString", [[22.0, 39.5], [26.0, 39.5]], title="Ferry", stroke="#00ff00", **{"stroke-width": 6}),
        feature("Polygon", [CORNERS], note=LONG, tags={"kind": ["sea", 1]}, fill="#ff0000"),
        feature("Point", [BARE[1], BARE[0]], **{"marker-color": "#00ffff"}),
    ],
}


def near(pixel, ink, slack=24):
    return all(abs(a - b) <= slack for a, b in zip(pixel, ink))


class Balloon(WindowTest):
    def begin(self, *options, size=SIZE, view=VIEW):
        file = self.folder / "greece.geojson"
        file.write_text(json.dumps(OBJECTS), encoding="utf-8")
        self.viewer = self.start("--objects", file.name, "--camera", view, "--unlit", *options, size=size)
        self.viewer.settled()

    def at(self, place):
        """The pixel of a place."""
        x, y = self.viewer.camera.pixel(ecef(*place, 0.0))
        return round(x - 0.5), round(y - 0.5)

    def click(self, place):
        time.sleep(0.5)  # no double click
        self.viewer.click(*self.at(place))

    def box(self):
        return self.viewer.layout.panels.get("#balloon")

    def opened(self, name, other_than=None):
        """The balloon's place and picture, once it is there and stands still."""
        wait_until("the balloon", lambda: self.box() and self.box() != other_than)
        self.viewer.settled()
        faults = self.viewer.layout.faults(*self.viewer.geometry()[2:])
        picture = self.picture(self.viewer, name)
        self.assertEqual(faults, [], name)
        return self.box(), picture

    def closed(self):
        wait_until("no balloon", lambda: self.box() is None)
        self.assertIsNone(self.viewer.program.poll(), "the window is open")

    def gap(self, box, pixel):
        """Distance from a balloon to a pixel."""
        left, top, right, bottom = box
        return max(left - pixel[0], pixel[0] - right, top - pixel[1], pixel[1] - bottom, 0)

    def test_a_click_on_an_object_shows_it_and_esc_closes_twice_in_a_row(self):
        self.begin()
        for times in (1, 2):
            boxes = []
            for name, place in (("marker", MARKER), ("line", LINE), ("area", AREA), ("bare", BARE)):
                with self.subTest(name, times=times):
                    self.click(place)
                    box, picture = self.opened(f"{name}_{times}")
                    self.assertLess(0, self.gap(box, self.at(place)), "the object is in view")
                    self.assertLess(self.gap(box, self.at(place)), 20)
                    boxes.append(box)
                    self.viewer.key("Escape")
                    self.closed()
            sizes = {(right - left, bottom - top) for left, top, right, bottom in boxes}
            self.assertEqual(len(sizes), 4, "other fields, another size")

    def test_the_object_is_drawn_as_selected_while_its_balloon_is_open(self):
        self.begin()
        marker, bare = self.at(MARKER), self.at(BARE)
        self.click(MARKER)
        _, picture = self.opened("one")
        self.assertTrue(near(png.pixel(picture, *marker), SELECTED))
        self.assertFalse(near(png.pixel(picture, *bare), SELECTED))
        before = self.box()
        self.click(BARE)
        _, picture = self.opened("other", other_than=before)
        self.assertFalse(near(png.pixel(picture, *marker), SELECTED))
        self.assertTrue(near(png.pixel(picture, *bare), SELECTED))
        self.click(BARE)
        self.closed()
        self.picture(self.viewer, "closed", lambda seen: not near(png.pixel(seen, *bare), SELECTED))

    def test_a_click_beside_and_the_cross_close_and_a_drag_does_not_open(self):
        self.begin()
        for times in (1, 2):
            self.click(MARKER)
            self.opened(f"opened_{times}")
            self.click((34.8, 22.5))
            self.closed()
            self.click(MARKER)
            _, top, right, _ = self.opened(f"again_{times}")[0]
            self.viewer.click(round(right - 12), round(top + 11))
            self.closed()
        x, y = self.at(MARKER)
        self.viewer.drag((x, y), (x + 60, y + 40))
        self.viewer.next_camera()
        self.viewer.settled()
        self.assertIsNone(self.box())

    def test_the_balloon_follows_the_object_and_hides_without_it(self):
        self.begin()
        self.click(MARKER)
        first, _ = self.opened("before")
        self.viewer.drag((420, 380), (370, 340))
        self.viewer.next_camera()
        turned, _ = self.opened("turned", other_than=first)
        self.assertLess(self.gap(turned, self.at(MARKER)), 20)
        for _ in range(8):
            self.viewer.key("Right")
            time.sleep(0.2)
        self.viewer.next_camera()
        self.closed()
        for _ in range(8):
            self.viewer.key("Left")
            time.sleep(0.2)
        self.viewer.next_camera()
        back, _ = self.opened("back")
        self.assertLess(self.gap(back, self.at(MARKER)), 20)

    def test_a_double_click_and_the_button_fly_there(self):
        self.begin()
        height_m = self.viewer.camera.height_m
        time.sleep(0.5)
        self.viewer.double_click(*self.at(MARKER))
        there = self.viewer.next_camera()
        self.assertLess(there.height_m, 0.8 * height_m)
        self.assertLess(there.miss_px(ecef(*MARKER, 0.0), SIZE[0] / 2, SIZE[1] / 2), 12.0)
        left, top, *_ = self.opened("flown")[0]
        self.viewer.click(round(left + 40), round(top + 60))
        nearer = self.viewer.next_camera()
        self.assertLess(nearer.height_m, 0.8 * there.height_m)
        self.opened("nearer")

    def fake_browser(self, code=0):
        """A program xdg-open that keeps its arguments, first in PATH."""
        tools = self.folder.resolve() / "bin"
        tools.mkdir()
        program = tools / "xdg-open"
        program.write_text(f'#!/bin/sh\ncd "{tools}"\nprintf "%s\\n" "$#" "$1" > part && mv part asked\nexit {code}\n')
        program.chmod(0o755)
        environment = self.display.environment
        before = environment["PATH"]
        environment["PATH"] = f"{tools}{os.pathsep}{before}"
        self.addCleanup(environment.update, {"PATH": before})
        return tools / "asked"

    def click_link(self):
        wait_until("the balloon", self.box)
        self.viewer.settled()
        left, top, right, bottom = map(round, self.box())
        rows = self.viewer.grab()
        inked = [(x, y) for y in range(top, bottom) for x in range(left, right)
                 if near((rows[y][x] >> 16 & 255, rows[y][x] >> 8 & 255, rows[y][x] & 255), LINK_INK)]
        x, y = inked[-1]
        asked = self.folder / "bin" / "asked"
        self.assertFalse(asked.exists(), "nothing is opened before the click")
        self.viewer.click(x, y)
        wait_until("the browser", asked.exists)
        self.assertEqual(asked.read_text().split("\n")[:2], ["1", LINK])
        asked.unlink()

    def test_a_click_on_a_link_opens_it_in_the_browser(self):
        self.fake_browser()
        self.begin()
        self.click(MARKER)
        for _ in range(2):
            self.click_link()
        time.sleep(2.0)  # the viewer looks at least once a second
        self.assertNotIn("message", self.viewer.layout.panels)

    def test_a_link_that_cannot_be_opened_is_told(self):
        self.fake_browser(code=3)
        self.begin()
        self.click(MARKER)
        self.click_link()
        wait_until("the message", lambda: "message" in self.viewer.layout.panels)
        self.picture(self.viewer, "told")

    def test_the_key_opens_the_object_in_the_middle_and_its_link(self):
        asked = self.fake_browser()
        self.begin(view="38.05,23.73,1500000")
        for times in (1, 2):
            self.viewer.key("o")
            self.opened(f"opened_{times}")
            self.viewer.key("Down")
            time.sleep(0.3)
            self.viewer.key("Return")
            wait_until("the browser", asked.exists)
            asked.unlink()
            self.viewer.key("o")
            self.closed()
        self.viewer.key("o")
        self.opened("third")
        self.viewer.key("F6")
        self.viewer.key("Up")
        self.viewer.next_camera()

    def test_the_name_shows_where_the_pointer_rests(self):
        self.begin()

        def named():
            return any(name.startswith("Tooltip") for name in self.viewer.layout.panels)

        for times in (1, 2):
            self.viewer.move(*self.at(MARKER))
            wait_until("the name", named)
            self.picture(self.viewer, f"name_{times}")
            self.viewer.move(500, 100)
            wait_until("no name", lambda: not named())

    def test_panels_and_balloon_stand_beside_each_other_at_each_size(self):
        """A panel that leaves no room hides the balloon until it is closed."""
        cases = ((200, 150), ""), ((260, 200), "p"), ((640, 480), "p"), ((640, 480), "pl"), ((780, 560), "l")
        for size, keys in cases:
            with self.subTest(size=size, keys=keys):
                self.begin(size=size, view="38.05,23.73,1500000")
                try:
                    self.beside_panels(size, keys)
                finally:
                    self.viewer.close()

    def beside_panels(self, size, keys):
        for key in f"{keys}o":
            self.viewer.key(key)
            self.viewer.settled()
        time.sleep(0.5)
        name = f"{size[0]}_{keys}"
        self.viewer.save_grab(self.folder / f"{name}.png")
        self.assertEqual(self.viewer.layout.faults(*size), [])
        if not self.box():
            self.assertTrue(keys, "no panel is in the way")
            for key in keys:
                self.viewer.key(key)
                self.viewer.settled()
        wait_until("the balloon", self.box)
        self.viewer.save_grab(self.folder / f"{name}_alone.png")
        self.assertEqual(self.viewer.layout.faults(*size), [])

    def test_letters_of_192_dots_per_inch(self):
        file = self.folder / "greece.geojson"
        file.write_text(json.dumps(OBJECTS), encoding="utf-8")
        self.viewer = self.start_at_192_dpi("--objects", file.name, "--camera", VIEW, "--unlit")
        self.viewer.settled()
        for name, place in (("marker", MARKER), ("area", AREA)):
            self.click(place)
            self.opened(name)
            self.viewer.key("Escape")
            self.closed()


if __name__ == "__main__":
    unittest.main()
