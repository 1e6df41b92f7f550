"""A new user's whole session: help, turning, a place, a distance, a file, a picture, and a second run."""

import json
import time
import unittest

import png
from real_window import WindowTest, wait_until

WIDTH, HEIGHT = 780, 560
ROUTE = {
    "type": "Feature",
    "properties": {"title": "From Rome", "stroke": "#ffff00", "stroke-width": 4},
    "geometry": {"type": "LineString", "coordinates": [[12.5, 41.9], [14.3, 40.9], [18.2, 40.1]]},
}


class FirstUse(WindowTest):
    def shoot(self, viewer, name):
        self.count = getattr(self, "count", 0) + 1
        time.sleep(1.5)  # what a person waits for
        return png.read(self.screenshot(viewer, f"{self.count:02}_{name}"))

    def test_from_the_first_start_to_the_second(self):
        self.settings.unlink()
        viewer = self.start(size=None, bare=False)
        self.shoot(viewer, "first_start")
        viewer.key("F1")
        self.shoot(viewer, "help")
        viewer.key("F1")
        viewer.xdotool("windowsize", viewer.window, str(WIDTH), str(HEIGHT))
        before = viewer.camera
        viewer.drag((500, 300), (400, 260))
        self.assertNotEqual(viewer.next_camera().lon, before.lon)
        self.shoot(viewer, "turned")
        self.find_rome(viewer)
        self.measure(viewer)
        self.add_and_fade(viewer)
        self.save_a_picture(viewer)
        viewer.key("g")
        self.shoot(viewer, "graticule")
        viewer.key("Escape")  # the layers
        time.sleep(0.5)
        self.assertEqual(viewer.quit(), 0)
        kept = json.loads(self.settings.read_text(encoding="utf-8"))
        self.assertEqual((kept["width"], kept["height"], kept["graticule"]), (WIDTH, HEIGHT, True))
        again = self.start(size=None, bare=False)
        self.assertEqual(self.shoot(again, "second_start")[:2], (WIDTH, HEIGHT))

    def find_rome(self, viewer):
        viewer.key("slash")
        viewer.xdotool("type", "--delay", "60", "rome")
        self.shoot(viewer, "search")
        viewer.key("Return")
        there = viewer.next_camera()
        self.assertAlmostEqual(there.lat, 41.9, delta=0.3)
        self.shoot(viewer, "rome")

    def measure(self, viewer):
        viewer.key("m")
        viewer.key("Return")
        viewer.click(600, 200)
        viewer.click(650, 400)
        self.shoot(viewer, "measured")
        viewer.key("m")

    def add_and_fade(self, viewer):
        route = self.folder / "route.geojson"
        route.write_text(json.dumps(ROUTE), encoding="ascii")
        viewer.drop(route)
        viewer.next_camera()
        self.shoot(viewer, "dropped")
        viewer.key("l")
        viewer.click(WIDTH - 240, 144)  # the imagery's row opens
        self.shoot(viewer, "layers")
        viewer.drag((WIDTH - 160, 170), (WIDTH - 240, 170))
        self.shoot(viewer, "faded")

    def save_a_picture(self, viewer):
        viewer.key("i")
        self.shoot(viewer, "picture_panel")
        viewer.click(WIDTH // 2 - 128, HEIGHT // 2 + 32)  # Save

        def whole():
            files = list(self.folder.glob("terrella-*.png"))
            return files[0] if files and files[0].read_bytes().endswith(b"IEND\xaeB`\x82") else None

        file = wait_until("the picture", whole)
        file = file.rename(self.folder / "picture.png")
        self.assertEqual(png.read(file)[:2], (2 * WIDTH, 2 * HEIGHT))
        self.shoot(viewer, "picture_saved")


if __name__ == "__main__":
    unittest.main()
