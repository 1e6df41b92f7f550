"""A user's way to a distance: search a place, measure, save a picture."""

import json
import unittest

import png
from real_window import SIZE, WindowTest, differing, wait_until


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
