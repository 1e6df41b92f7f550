"""Ways that users expect: the menu of a place, the compass, measuring to a file, bookmarks with names."""

import json
import time
import unittest

from ellipsoid_camera import ecef
from real_window import SIZE, WindowTest, differing, wait_until

LAST_ICON, ICON_STEP, ICON_X = 407, 26, 612
MENU_FIRST, MENU_STEP = 34, 20  # items about the place, pixels under the menu's corner
ROWS = 380  # pixels from the top; messages and the status line are under them


class Hands(WindowTest):
    def compass(self, viewer):
        viewer.click(ICON_X, LAST_ICON - 7 * ICON_STEP)

    def menu_item(self, viewer, x, y, index):
        viewer.open_menu(x, y)
        left, top, *_ = viewer.panel("Menu")
        viewer.click(left + 50, top + MENU_FIRST + MENU_STEP * index)
        time.sleep(0.3)

    def copied(self, viewer, before="nothing"):
        return wait_until("the clipboard", lambda: viewer.clipboard() if viewer.clipboard() != before else None)

    def test_the_compass_turns_north_up_and_then_looks_straight_down(self):
        viewer = self.start("--camera", "46,7,300000,130,-40")
        centre = viewer.camera.ground(SIZE[0] / 2, SIZE[1] / 2)
        for _ in range(2):
            self.compass(viewer)
            north = viewer.next_camera()
            self.assertAlmostEqual(north.heading, 0.0, delta=0.01)
            self.assertGreater(north.pitch, -75.0)
            self.assertLess(north.miss_px(centre, SIZE[0] / 2, SIZE[1] / 2), 1.0)
            time.sleep(0.6)  # no double click
            self.compass(viewer)
            down = viewer.next_camera()
            self.assertAlmostEqual(down.pitch, -90.0, delta=1e-6)
            self.assertLess(down.miss_px(centre, SIZE[0] / 2, SIZE[1] / 2), 1.0)
            viewer.drag((300, 300), (340, 180), button=3)
            viewer.next_camera()
            centre = viewer.camera.ground(SIZE[0] / 2, SIZE[1] / 2)
        self.screenshot(viewer, "tilted")

    def test_a_right_click_copies_the_place_and_the_view(self):
        viewer = self.start("--camera", "46,7,3000000")
        for x, y in ((200, 55), (240, 60)):
            viewer.set_clipboard("nothing")
            self.menu_item(viewer, x, y, 0)
            lat, lon = (float(part) for part in self.copied(viewer).split(","))
            self.assertLess(viewer.camera.miss_px(ecef(lat, lon, 0.0), x + 0.5, y + 0.5), 1.0)
            viewer.set_clipboard("nothing")
            self.menu_item(viewer, x, y, 1)
            option, line = self.copied(viewer).split()
            self.assertEqual(option, "--camera")
            self.assertEqual([float(part) for part in line.split(",")], [46.0, 7.0, 3e6, 0.0, -90.0, 40.0])
        self.assertTrue(viewer.camera_stays(0.3))

    def test_centre_here_flies_at_the_same_height(self):
        viewer = self.start("--camera", "46,7,3000000")
        for x, y in ((400, 55), (250, 60)):
            there = viewer.camera.ground(x + 0.5, y + 0.5)
            self.menu_item(viewer, x, y, 4)
            after = viewer.next_camera()
            self.assertLess(after.miss_px(there, SIZE[0] / 2, SIZE[1] / 2), 1.0)
            self.assertAlmostEqual(after.height_m, 3e6, delta=1.0)

    def test_a_right_drag_opens_no_menu_and_a_click_beside_the_menu_only_closes_it(self):
        viewer = self.start("--camera", "46,7,3000000", "--unlit", "--sky", "off")
        viewer.drag((300, 300), (340, 250), button=3)
        viewer.next_camera()
        time.sleep(0.5)
        plain = viewer.grab()
        for _ in range(2):
            viewer.right_click(200, 60)
            wait_until("the menu", lambda: differing(plain, viewer.grab(), ROWS) > 10000)
            viewer.click(60, 300)
            wait_until("the globe alone", lambda: differing(plain, viewer.grab(), ROWS) < 100)
        viewer.right_click(200, 60)
        viewer.key("Escape")
        wait_until("the globe alone", lambda: differing(plain, viewer.grab(), ROWS) < 100)
        self.assertIsNone(viewer.program.poll(), "Esc closed the menu alone")
        self.assertTrue(viewer.camera_stays(0.3))

    def test_measuring_by_the_menu_is_saved_twice_and_overwrites_nothing(self):
        viewer = self.start("--camera", "0,20,9000000")
        self.menu_item(viewer, 220, 55, 3)  # measure from here
        plain = viewer.settled()
        viewer.move(420, 240)
        wait_until("the band to the cursor", lambda: differing(plain, viewer.grab(), ROWS) > 300)
        self.screenshot(viewer, "band")
        viewer.click(420, 240)
        viewer.click(300, 330)
        for count in (1, 2):
            viewer.key("ctrl+s")
            files = wait_until("a file", lambda: len(list(self.folder.glob("*.geojson"))) == count and
                               list(self.folder.glob("*.geojson")))
        self.screenshot(viewer, "measured")
        way, area = json.loads(files[0].read_text())["features"]
        self.assertEqual(files[0].read_text(), files[1].read_text())
        for pixel, (lon, lat) in zip(((220, 55), (420, 240), (300, 330)), way["geometry"]["coordinates"]):
            self.assertLess(viewer.camera.miss_px(ecef(lat, lon, 0.0), pixel[0] + 0.5, pixel[1] + 0.5), 1.0)
        lengths = way["properties"]["segment_lengths_m"]
        self.assertAlmostEqual(sum(lengths), way["properties"]["length_m"], delta=0.01)
        self.assertGreater(area["properties"]["perimeter_m"], sum(lengths))
        viewer.set_clipboard("nothing")
        viewer.key("ctrl+c")
        text = self.copied(viewer)
        self.assertEqual(text.count("\n"), 5, text)
        self.assertIn(f"Length\t{way['properties']['length_m']:.3f} m", text)

    def test_a_bookmark_is_named_moved_deleted_and_restored(self):
        viewer = self.start("--camera", "46,7,3000000")
        file = self.kept / "terrella" / "bookmarks.json"

        def kept():
            return json.loads(file.read_text()) if file.exists() else {}

        viewer.key("k")
        viewer.settled()
        self.screenshot(viewer, "empty")
        viewer.click(80, 94)  # Save this view
        viewer.click(80, 94)
        wait_until("two bookmarks", lambda: set(kept().get("bookmarks", {})) == {"1", "2"})
        viewer.settled()
        viewer.click(298, 115)  # Edit of the first
        viewer.settled()
        viewer.xdotool("type", "--delay", "30", "Home")
        viewer.key("Return")
        wait_until("the name", lambda: kept()["names"] == {"1": "Home"})
        self.screenshot(viewer, "named")
        viewer.click(298, 115)
        viewer.settled()
        self.screenshot(viewer, "edited")
        viewer.click(80, 161)  # Down
        wait_until("the order", lambda: kept()["names"] == {"2": "Home"})
        viewer.settled()
        self.screenshot(viewer, "moved")
        viewer.click(140, 181)  # Delete, in the second row now
        wait_until("one bookmark", lambda: set(kept()["bookmarks"]) == {"1"})
        viewer.settled()
        self.screenshot(viewer, "deleted")
        viewer.click(168, 94)  # Restore
        wait_until("the restored one", lambda: kept()["names"] == {"2": "Home"})

    def test_the_buttons_of_the_mouse_go_back_and_forward(self):
        viewer = self.start("--camera", "46,7,3000000")
        viewer.key("Home")
        globe = viewer.next_camera()
        viewer.settled()
        for _ in range(2):
            viewer.xdotool("click", "8")
            self.assertAlmostEqual(viewer.next_camera().height_m, 3e6, delta=1.0)
            viewer.xdotool("click", "9")
            self.assertAlmostEqual(viewer.next_camera().height_m, globe.height_m, delta=1.0)


if __name__ == "__main__":
    unittest.main()
