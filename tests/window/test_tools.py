"""A user's way to a distance: search a place, measure, save a picture."""

import unittest

import png
from real_window import SIZE, WindowTest


class Tools(WindowTest):
    def test_a_place_is_found_and_flown_to(self):
        viewer = self.start("--camera", "10,20,9000000")
        viewer.xdotool("key", "--delay", "1", "slash", "s", "a", "o")  # faster than a frame
        self.screenshot(viewer, "search_found")
        viewer.key("Return")
        there = viewer.next_camera()
        self.assertAlmostEqual(there.lat, -23.55, delta=0.2)
        self.assertAlmostEqual(there.lon, -46.63, delta=0.2)
        self.assertLess(there.height_m, 1e6)
        self.screenshot(viewer, "search_there")

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
