"""The list of a layer's objects by real mouse and keyboard: filter, order, selection, flight."""

import json
import time
import unittest

from ellipsoid_camera import ecef
from real_window import SIZE, WindowTest, wait_until

VIEW = "44,14,6000000"
# Name, latitude, longitude, people, river.
TOWNS = [("Αθήνα", 37.98, 23.73, 664046, None), ("Wien", 48.21, 16.37, 1982097, "Donau"),
         ("Köln", 50.94, 6.96, 1085664, "Rhein"), ("Sydney", -33.87, 151.21, 5297089, None),
         ("Београд", 44.8, 20.46, 1197714, "Donau und Save"), ("Basel", 47.56, 7.59, 178120, "Rhein"),
         (None, 41.9, 12.5, 90, None)]
PLACES = {name: (lat, lon) for name, lat, lon, *_ in TOWNS}
ROW, LIST, REMOVE, BUTTONS = 65, 208, 268, 136  # in the panel of layers
FIELD, HEAD, FIRST, STEP = 84, 109, 129, 19  # in the list


def feature(name, lat, lon, people, river):
    fields = {key: value for key, value in (("name", name), ("people", people), ("river", river)) if value}
    return {"type": "Feature", "properties": fields, "geometry": {"type": "Point", "coordinates": [lon, lat]}}


class FeatureList(WindowTest):
    def begin(self):
        towns = {"type": "FeatureCollection", "features": [feature(*town) for town in TOWNS]}
        (self.folder / "towns.geojson").write_text(json.dumps(towns), encoding="utf-8")
        self.viewer = self.start("--objects", "towns.geojson", "--camera", VIEW, "--unlit")
        self.viewer.settled()
        self.viewer.key("l")
        left, top, *_ = before = self.viewer.panel("Layers")
        self.viewer.settled()
        self.viewer.click(round(left) + 90, round(top) + ROW)
        wait_until("the row", lambda: self.viewer.panel("Layers")[3] > before[3] + 10)
        self.viewer.settled()

    def open_list(self):
        """Clicks "List" in the row of the layer."""
        left, top, *_ = self.viewer.panel("Layers")
        self.viewer.click(round(left) + LIST, round(top) + BUTTONS)
        self.box = self.viewer.panel("Objects")
        self.viewer.settled()
        self.assertNotIn("Layers", self.viewer.layout.panels, "a small window shows the newer panel")

    def close_list(self):
        self.viewer.key("Escape")
        wait_until("no list", lambda: "Objects" not in self.viewer.layout.panels)
        self.viewer.panel("Layers")
        self.viewer.settled()

    def type(self, text):
        self.viewer.xdotool("type", "--delay", "60", text)
        self.viewer.settled()

    def click(self, y, x=40):
        self.viewer.click(round(self.box[0]) + x, round(self.box[1]) + y)
        self.viewer.settled()

    def row(self, k):
        self.click(FIRST + STEP * k)

    def balloon(self):
        return self.viewer.layout.panels.get("#balloon")

    def flown_to(self, name, picture):
        camera = self.viewer.next_camera()
        self.assertLess(camera.miss_px(ecef(*PLACES[name], 0.0), SIZE[0] / 2, SIZE[1] / 2), 12.0)
        wait_until("the balloon", self.balloon)
        self.viewer.settled()
        self.viewer.save_grab(self.folder / f"{picture}.png")
        self.assertEqual(self.viewer.layout.faults(*SIZE), [])
        return camera

    def test_a_filtered_row_is_selected_by_a_click_and_flown_to_by_a_second_one_twice(self):
        self.begin()
        for times, (text, name) in enumerate((("koln", "Köln"), ("sYd", "Sydney"))):
            self.open_list()
            self.viewer.save_grab(self.folder / f"opened_{times}.png")
            self.type(text)
            self.row(0)
            if name == "Köln":
                wait_until("the balloon", self.balloon)
            else:
                wait_until("a message that it is not in view", lambda: "message" in self.viewer.layout.panels)
            self.assertTrue(self.viewer.camera_stays(0.3), "a click selects")
            height_m = self.viewer.camera.height_m
            self.row(0)
            self.assertLess(self.flown_to(name, f"flown_{times}").height_m, 0.6 * height_m)
            self.close_list()

    def test_arrows_choose_a_row_and_enter_flies_there(self):
        self.begin()
        self.open_list()
        for times in range(2):
            self.viewer.key("ctrl+a")
            self.type("DONAU")  # a value of another field than the name
            self.viewer.key("Down")
            wait_until("the balloon", self.balloon)
            self.viewer.key("Down")
            self.viewer.settled()
            self.viewer.key("Return")
            self.flown_to("Београд", f"second_row_{times}")
            self.viewer.key("Up")
            self.viewer.settled()
            self.viewer.key("Return")
            self.flown_to("Wien", f"first_row_{times}")

    def test_a_field_is_shown_and_sorted_as_numbers_and_the_list_closes_with_its_layer(self):
        self.begin()
        self.open_list()
        self.click(FIELD, 150)
        lists = lambda: [box for name, box in self.viewer.layout.panels.items() if name.startswith("Combo_")]
        left, top, right, bottom = wait_until("the fields", lists)[0]
        self.viewer.settled()
        self.viewer.click(round(left) + 30, round((top + bottom) / 2))  # people, between no field and the river
        wait_until("no list of fields", lambda: not lists())
        self.viewer.settled()
        self.click(HEAD, 230)
        self.viewer.save_grab(self.folder / "by_people.png")
        for k, name in ((1, "Basel"), (2, "Αθήνα")):
            self.row(k)
            self.row(k)
            self.flown_to(name, f"row_{k}")
        self.viewer.xdotool("key", "--delay", "0", "F6", "l")  # the globe has the keyboard before another frame
        left, top, *_ = self.viewer.panel("Layers")
        self.viewer.settled()
        self.viewer.click(round(left) + REMOVE, round(top) + BUTTONS)
        wait_until("no balloon", lambda: not self.balloon())
        self.viewer.key("l")
        wait_until("no panel", lambda: "Layers" not in self.viewer.layout.panels)
        time.sleep(0.3)
        self.viewer.settled()
        self.assertNotIn("Objects", self.viewer.layout.panels)


if __name__ == "__main__":
    unittest.main()
