"""A user's way to a distance: search a place, measure, save a picture."""

import json
import math
import subprocess
import unittest

import png
from real_window import PROGRAM, SIZE, WindowTest, differing, wait_until


def is_red(pixel):
    red, green, blue = pixel
    return red > 200 and red - max(green, blue) > 80


class Tools(WindowTest):
    def test_a_place_is_found_and_flown_to(self):
        viewer = self.start("--camera", "10,20,9000000")
        viewer.xdotool("key", "--delay", "1", "slash", "s", "a", "o")  # faster than a frame
        self.screenshot(viewer, "search_found")
        viewer.key("Return")
        there = viewer.next_camera()
        self.assertAlmostEqual(there.lat, -23.55, delta=0.2)
        self.assertAlmostEqual(there.lon, -46.63, delta=0.2)
        # A texel of the included Earth, 360° / 4096 of the equator, covers 8 pixels at a field of view of 40°.
        sharp_m = 40_075_017 / 4096 * SIZE[1] / 2 / math.tan(math.radians(20)) / 8
        self.assertAlmostEqual(there.height_m / sharp_m, 1, delta=0.01)
        # The place is marked by a red disc in the middle, until Esc.
        marked = self.picture(viewer, "search_there", lambda picture: is_red(png.pixel(picture, SIZE[0] // 2, SIZE[1] // 2)))
        viewer.key("Escape")
        plain = self.picture(viewer, "search_unmarked", lambda picture: not is_red(png.pixel(picture, SIZE[0] // 2, SIZE[1] // 2)))
        self.assertGreater(png.changed(marked, plain), 300, "the disc and its name")

    def test_a_flight_goes_as_near_as_the_best_picture_of_the_place_allows(self):
        subprocess.run(["convert", "-size", "512x512", "xc:#2060a0", self.folder / "bay.png"], check=True)
        viewer = self.start("--camera", "10,20,9000000", "--overlay", self.tiles_of("bay.png", "-47,-24,-46,-23"))
        for name, height_m in (("sao", 0.05 * 6378137), ("santa", None)):
            viewer.xdotool("key", "--delay", "1", "slash", *name)
            viewer.key("Return")
            there = viewer.next_camera()
            if height_m:
                self.assertAlmostEqual(there.height_m / height_m, 1, delta=0.01)
            else:
                self.assertGreater(there.height_m, 7e5, "the overlay has no tile there")

    def tiles_of(self, picture, bounds):
        tiles = self.folder / "bay.gpkg"
        subprocess.run([PROGRAM, "cut", self.folder / picture, "-o", tiles, f"--bounds={bounds}"], check=True,
                       capture_output=True)
        return tiles

    def test_a_fault_stays_until_it_is_closed(self):
        (self.folder / "broken.tif").write_bytes(b"II*\0nothing")
        viewer = self.start("--camera", "10,20,9000000")
        viewer.key("ctrl+o")
        viewer.panel("Open")
        viewer.set_clipboard("broken.tif")
        viewer.key("ctrl+v")
        viewer.key("Return")

        def has_bar():
            return any(is_red(row[x].to_bytes(4, "big")[1:]) for row in viewer.grab()[-120:-20]
                       for x in range(4, 400))

        wait_until("a red bar", has_bar)
        viewer.save_grab(self.folder / "fault.png")
        viewer.key("Escape")
        wait_until("no bar", lambda: not has_bar())

    def test_escape_closes_the_search_and_not_the_window(self):
        viewer = self.start("--camera", "10,20,9000000")
        plain = self.picture(viewer, "plain")
        viewer.key("slash")
        viewer.key("x")
        viewer.key("Escape")
        self.picture(viewer, "search_closed", lambda picture: png.changed(plain, picture) < 10000)
        self.assertIsNone(viewer.program.poll())

    def test_bookmarks_are_there_in_the_next_run(self):
        viewer = self.start("--camera", "10,20,9000000")
        viewer.key("ctrl+3")
        viewer.key("Home")
        viewer.next_camera()
        viewer.close()
        viewer = self.start("--camera", "-30,120,3000000")
        viewer.key("3")
        there = viewer.next_camera()
        self.assertAlmostEqual(there.lat, 10.0, places=5)
        self.assertAlmostEqual(there.lon, 20.0, places=5)
        self.assertAlmostEqual(there.height_m, 9e6, delta=1.0)

    def test_units_are_chosen_and_kept(self):
        """By mouse and keyboard: the scale bar and the altitude change, and the next start has them."""
        where = ("--camera", "46,8,3000000")

        def foot(viewer):
            """The rows of the window with altitude and scale bar."""
            viewer.xdotool("mousemove", "400", "100")
            return viewer.settled()[-60:]

        def chosen():
            return json.loads((self.kept / "terrella" / "settings.json").read_text(encoding="utf-8")).get("units")

        viewer = self.start(*where)
        metric = foot(viewer)
        viewer.key("p")
        left, top, _, bottom = wait_until("the panel", lambda: viewer.layout.panels.get("View"))
        viewer.wheel(round(left) + 300, round(bottom) - 60, -40)
        viewer.settled()
        viewer.click(round(left) + 90, round(bottom) - 22)
        for key in ("Down", "Down", "space"):
            viewer.settled()
            viewer.key(key)
        wait_until("nautical miles", lambda: chosen() == 2)
        viewer.key("p")
        nautical = foot(viewer)
        self.assertGreater(differing(metric, nautical), 100)
        viewer.close()
        viewer = self.start(*where)
        self.assertEqual(differing(foot(viewer), nautical), 0)
        viewer.close()
        self.assertEqual(differing(foot(self.start(*where, "--units", "metric")), metric), 0)
        self.assertEqual(chosen(), 2, "an option is for one start")

    def test_a_way_and_an_area_are_measured(self):
        viewer = self.start("--camera", "0,20,9000000")
        plain = self.picture(viewer, "before")
        viewer.key("m")
        middle = (SIZE[0] // 2, SIZE[1] // 2)
        for dx, dy in ((-100, 0), (100, 0), (0, -120)):
            viewer.click(middle[0] + dx, middle[1] + dy)

        # The ways between are drawn, in the tool's yellow, where they lie in the picture: the first one on the equator.
        def has_way(picture):
            red, green, blue = png.pixel(picture, *middle)
            return min(red, green) - blue > 60

        measured = self.picture(viewer, "measured", has_way)
        self.assertGreater(png.changed(plain, measured), 2000)
        viewer.key("BackSpace")
        viewer.key("Return")
        self.screenshot(viewer, "measured_again")
        viewer.key("m")
        # The triangle alone was 12,000.
        self.picture(viewer, "after", lambda picture: png.changed(plain, picture) < 10000)
        self.assertTrue(viewer.camera_stays(0.2), "clicks that measure do not fly")


if __name__ == "__main__":
    unittest.main()
