"""Panels by real mouse and keyboard: layers, dropped files, pictures of any size, kept settings."""

import json
import struct
import subprocess
import time
import unittest
import zlib

import png
from real_window import PROGRAM, SIZE, WindowTest, wait_until

PLACES = {
    "type": "FeatureCollection",
    "features": [
        {
            "type": "Feature",
            "properties": {"marker-color": "#ff00ff", "marker-size": "large"},
            "geometry": {"type": "Point", "coordinates": [lon, 46]},
        }
        for lon in (6, 8, 10)
    ],
}


def write_png(path, width, height, pixel, depth=8, kind=2):
    """A picture of one colour, or of one grey (kind 0)."""

    def chunk(name, body):
        return struct.pack(">I", len(body)) + name + body + struct.pack(">I", zlib.crc32(name + body))

    rows = zlib.compress((b"\0" + bytes(pixel) * width) * height)
    header = struct.pack(">IIBBBBB", width, height, depth, kind, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", rows) + chunk(b"IEND", b""))


class Panels(WindowTest):
    def test_the_exaggeration_slider_and_the_time_by_mouse_and_keyboard(self):
        heights = self.kept / "heights.png"
        viewer = self.start("--camera", "20,10,12000000", "--elevation", str(self.relief(heights)))
        viewer.key("p")
        viewer.panel("View")
        plain = self.picture(viewer, "panel")
        viewer.drag((40, 253), (150, 253))

        # The blue grip of the slider, which began at 1 of 30, stands where the pointer let it go.
        def has_grip(picture):
            red, _, blue = png.pixel(picture, 150, 246)
            return blue - red > 120

        self.picture(viewer, "slid", has_grip)
        self.assertTrue(viewer.camera_stays(0.5), "the drag was the panel's")
        viewer.click(100, 335)
        viewer.xdotool("type", "--delay", "40", "2026-06-21T00:00Z")
        viewer.key("Return")
        ground = (SIZE[0] - 120, SIZE[1] // 2)

        def light(picture):
            return sum(png.pixel(picture, *ground))

        self.picture(viewer, "midnight", lambda picture: light(picture) < 0.7 * light(plain))  # 10° E sleeps

    def test_modes_are_not_kept_and_r_returns_to_those_of_the_start(self):
        self.settings.write_text('{"opacity": 0.4, "stereo": "anaglyph", "sky": false}', encoding="ascii")
        view = ("--camera", "20,10,12000000", "--unlit")
        ground = (SIZE[0] // 2, SIZE[1] // 2 - 60)

        def seen(viewer, name):
            time.sleep(1.0)
            return png.pixel(self.picture(viewer, name), *ground)

        viewer = self.start(*view)
        plain = seen(viewer, "first_run")
        for key in ("s", "u", "u"):
            viewer.key(key)
        changed = seen(viewer, "changed")
        self.assertLess(sum(changed), 0.7 * sum(plain))
        self.assertEqual(viewer.quit(), 0)
        again = self.start(*view)
        second = seen(again, "second_run")
        self.assertLess(max(abs(a - b) for a, b in zip(second, plain)), 8, "neither translucent nor red")
        for key in ("s", "u", "x"):
            again.key(key)
        self.assertLess(again.next_camera().height_m, 0.0)
        for _ in range(2):
            again.key("r")
        there = again.next_camera()
        self.assertGreater(there.height_m, 1.2e7)
        self.assertEqual((there.heading, there.pitch), (0.0, -90.0))
        reset = seen(again, "reset")
        as_started = self.start("--camera", f"{there.lat},{there.lon},{there.height_m}", "--unlit")
        self.assertLess(max(abs(a - b) for a, b in zip(reset, seen(as_started, "as_started"))), 8)

    def relief(self, picture):
        """Heights of the whole planet, all 3000 m."""
        write_png(picture, 512, 256, struct.pack(">H", 3000), depth=16, kind=0)
        tiles = picture.with_suffix(".gpkg")
        subprocess.run([PROGRAM, "cut", str(picture), "-o", str(tiles), "--elevation"], check=True, capture_output=True)
        return tiles

    def test_a_dropped_picture_is_a_layer_that_fades_and_goes(self):
        picture = self.folder / "red.png"
        write_png(picture, 512, 256, (255, 0, 0))
        viewer = self.start("--camera", "20,10,12000000", "--unlit")
        ground = (SIZE[0] // 2 - 100, SIZE[1] // 2)
        before = png.pixel(self.picture(viewer, "before"), *ground)
        viewer.drop(picture)
        wait_until("the picture", lambda: png.pixel(png.read(self.screenshot(viewer, "dropped")), *ground)[0] > 240)
        viewer.key("l")
        closed = wait_until("the panel", lambda: viewer.layout.panels.get("Layers"))
        time.sleep(0.5)
        left, row = round(closed[0]), round(closed[1]) + 65  # below the title and the row of switches
        viewer.click(left + 90, row)  # opens the row's content
        wait_until("the row", lambda: viewer.panel("Layers") != closed)
        self.screenshot(viewer, "row")
        viewer.drag((left + 168, row + 26), (left + 68, row + 26))
        self.picture(viewer, "faded", lambda picture: png.pixel(picture, *ground)[0] < 240)
        self.assertTrue(viewer.camera_stays(0.3), "the drag was the panel's")
        # Blue Marble shows through again, and with it its attribution, which has its own room.
        self.assertEqual(viewer.layout.panels["Layers"][1], closed[1], "the panel jumped under the pointer")
        viewer.click(left + 22, row)  # the row's check mark
        self.picture(viewer, "hidden",
                     lambda picture: max(abs(a - b) for a, b in zip(png.pixel(picture, *ground), before)) < 8)

    def test_dropped_places_are_flown_to(self):
        places = self.folder / "places.geojson"
        places.write_text(json.dumps(PLACES), encoding="ascii")
        viewer = self.start("--camera", "-40,170,9000000")
        viewer.drop(places)
        there = viewer.next_camera()
        self.assertAlmostEqual(there.lat, 46.0, delta=0.1)
        self.assertAlmostEqual(there.lon, 8.0, delta=0.1)

        def has_marker(picture):
            red, green, blue = png.pixel(picture, SIZE[0] // 2, SIZE[1] // 2)
            return min(red, blue) - green > 100

        self.picture(viewer, "places", has_marker)

    def test_bad_files_are_told_of_and_lose_nothing(self):
        bad = self.folder / "bad.png"
        bad.write_bytes(b"no picture")
        half = self.folder / "half.geojson"
        half.write_text('{"type": "FeatureCo', encoding="ascii")
        viewer = self.start("--camera", "20,10,12000000")
        plain = self.picture(viewer, "plain")
        viewer.drop(bad, half, self.folder / "missing.gpkg")
        wait_until("the message", lambda: png.changed(plain, png.read(self.screenshot(viewer, "told"))) > 3000)
        self.assertIsNone(viewer.program.poll())
        self.assertTrue(viewer.camera_stays(0.3))

    def test_a_picture_larger_than_the_window(self):
        viewer = self.start("--camera", "20,10,12000000")
        viewer.key("i")
        time.sleep(1.0)
        self.screenshot(viewer, "panel")
        viewer.xdotool("key", "ctrl+a")
        viewer.xdotool("type", "--delay", "60", "1500")
        viewer.key("Tab")
        viewer.xdotool("key", "ctrl+a")
        viewer.xdotool("type", "--delay", "60", "1000")
        self.screenshot(viewer, "written")
        viewer.key("Return")  # saves

        def whole():
            files = list(self.folder.glob("terrella-*.png"))
            return files[0] if files and files[0].read_bytes().endswith(b"IEND\xaeB`\x82") else None

        file = wait_until("the picture", whole)
        self.assertEqual(struct.unpack(">II", file.read_bytes()[16:24]), (1500, 1000))
        file.rename(self.folder / "large.png")
        self.screenshot(viewer, "after")

    def test_keys_go_to_the_globe_or_to_a_panel(self):
        viewer = self.start("--camera", "20,10,3000000")
        viewer.key("p")
        time.sleep(0.5)
        viewer.key("Up")
        self.assertTrue(viewer.camera_stays(), "the panel has the keyboard")
        viewer.key("F6")
        time.sleep(0.5)
        viewer.key("Up")
        self.assertGreater(viewer.next_camera().lat, 20.5)
        before = viewer.camera
        viewer.key("shift+Right")
        turned = viewer.next_camera()
        self.assertGreater(abs(turned.heading - before.heading), 2.0)
        viewer.key("Prior")
        self.assertLess(viewer.next_camera().height_m, 2.5e6)

    def test_text_is_twice_as_large_on_a_screen_of_192_dots_per_inch(self):
        viewer = self.start_at_192_dpi("--camera", "20,10,90000000")
        viewer.key("F1")
        time.sleep(0.5)
        helped = png.read(self.screenshot(viewer, "large_help"))
        viewer.key("F1")
        viewer.key("p")
        time.sleep(0.5)
        viewer.key("F1")
        time.sleep(0.5)
        over = png.read(self.screenshot(viewer, "large_help_over_panel"))
        self.assertLess(png.changed(helped, over), 600, "nothing of the panel is seen beside the list of shortcuts")
        viewer.key("F1")
        time.sleep(0.5)
        large = png.read(self.screenshot(viewer, "large_panel"))
        ordinary = self.start("--camera", "20,10,90000000", size=(800, 600))  # the panel is open: it was left so
        small = png.read(self.screenshot(ordinary, "panel"))

        def title_end(picture, y):
            """End of the blue of the panel's title, pixels from the left."""
            row = picture[2][y]
            return max(x for x in range(picture[0]) if row[3 * x + 2] > row[3 * x] + 60)

        self.assertAlmostEqual(title_end(large, 44) / title_end(small, 22), 2.0, delta=0.1)



if __name__ == "__main__":
    unittest.main()
