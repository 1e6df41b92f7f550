"""Every key and its visible effect."""

import os
import subprocess
import time
import unittest

import png
from real_window import PROGRAM, SIZE, WindowTest, wait_until

CHANGED_WORDS = 10000  # pixels: a message over the bright limb, and the frame time


class Keys(WindowTest):
    """Keys that share a view share a window."""

    def test_arrows_move_plus_and_minus_zoom(self):
        viewer = self.start("--camera", "10,20,3000000")
        for key, lat_sign, lon_sign in (("Up", 1, 0), ("Down", -1, 0), ("Left", 0, -1), ("Right", 0, 1)):
            with self.subTest(key):
                before = viewer.camera
                viewer.key(key)
                after = viewer.next_camera()
                for moved, sign in ((after.lat - before.lat, lat_sign), (after.lon - before.lon, lon_sign)):
                    self.assertTrue(moved * sign > 0.5 if sign else abs(moved) < 0.3, (key, moved))
        middle = viewer.camera.height_m
        viewer.key("plus")
        self.assertLess(viewer.next_camera().height_m, 0.84 * middle)
        viewer.key("minus")
        self.assertAlmostEqual(viewer.next_camera().height_m, middle, delta=1.0)
        viewer.key("KP_Add")
        self.assertLess(viewer.next_camera().height_m, 0.84 * middle)

    def test_n_puts_north_up_and_home_shows_the_whole_globe(self):
        viewer = self.start("--camera", "46.5,7.25,300000,130,-50,45")
        start = viewer.camera
        self.assertEqual([round(value, 9) for value in (start.lat, start.lon, start.height_m, start.heading)],
                         [46.5, 7.25, 300000.0, 130.0])
        centre = viewer.camera.ground(SIZE[0] / 2, SIZE[1] / 2)
        viewer.key("n")
        after = viewer.next_camera()
        self.assertAlmostEqual(after.heading, 0.0, delta=0.01)
        self.assertLess(after.miss_px(centre, SIZE[0] / 2, SIZE[1] / 2), 1.0)
        viewer.key("Home")
        after = viewer.next_camera()
        self.assertEqual((after.heading, after.pitch), (0.0, -90.0))
        self.assertIsNotNone(after.ground(SIZE[0] / 2, 50))
        self.assertIsNone(after.ground(SIZE[0] / 2, 10))
        self.screenshot(viewer, "home")

    def test_g_draws_the_graticule_f1_the_list_and_escape_asks_before_it_leaves(self):
        viewer = self.start("--camera", "20,10,12000000")

        def shot(name, key=None):
            if key:
                viewer.key(key)
            viewer.settled(still_s=0.5)
            return png.read(self.screenshot(viewer, name))

        plain = shot("without")
        self.assertEqual(plain[:2], SIZE)
        # 20 lines of some 300 px, where the ground is not bright
        self.assertGreater(png.changed(plain, shot("graticule", "g")), 2000)
        self.assertLess(png.changed(plain, shot("without_again", "g")), CHANGED_WORDS)
        self.assertGreater(png.changed(plain, shot("help", "F1")), 20000)
        self.assertLess(png.changed(plain, shot("closed", "question")), CHANGED_WORDS)
        plain = shot("plain")
        for _ in range(2):  # the question is forgotten after 3 s
            viewer.key("Escape")
            wait_until("the question", lambda: png.changed(plain, png.read(self.screenshot(viewer, "asked"))) > 300)
            time.sleep(4.0)
            self.assertIsNone(viewer.program.poll(), "one Esc does not quit")
        self.assertEqual(viewer.quit(), 0)

    def test_u_changes_the_opacity_and_s_goes_through_the_kinds_of_stereo(self):
        viewer = self.start("--camera", "20,10,12000000", "--unlit")
        ground = [SIZE[0] // 2, SIZE[1] // 2 - 60]
        plain = self.picture(viewer, "opaque")

        def light(picture):
            return sum(png.pixel(picture, *ground)) / sum(png.pixel(plain, *ground))

        for name, alpha in (("u70", 0.7), ("u40", 0.4), ("u100", 1.0)):
            viewer.key("u")
            # Through the rest shines the inner sphere, which is darker than half of this ground.
            self.picture(viewer, name,
                         lambda picture: alpha - 0.03 < light(picture) < alpha + 0.5 * (1.0 - alpha) + 0.03)
        before = plain
        for name in ("anaglyph", "side_by_side", "interlaced"):
            viewer.key("s")
            before = self.picture(viewer, name, lambda picture: min(png.changed(plain, picture),
                                                                    png.changed(before, picture)) > 10000)
        viewer.key("s")
        self.picture(viewer, "mono_again", lambda picture: png.changed(plain, picture) < CHANGED_WORDS)

    def test_the_window_rests_x_goes_under_the_ground_and_b_switches_the_sky(self):
        viewer = self.start("--camera", "20,10,20000000")
        time.sleep(2.0)  # tiles come
        before = cpu_s(viewer.program.pid)
        time.sleep(2.0)
        self.assertLess(cpu_s(viewer.program.pid) - before, 0.1)
        viewer.key("x")
        below = viewer.next_camera()
        self.assertAlmostEqual(below.height_m, -8.0e5, delta=1.0)
        self.screenshot(viewer, "below")
        viewer.key("x")
        self.assertAlmostEqual(viewer.next_camera().height_m, 2.0e7, delta=1.0)
        stars = self.picture(viewer, "sky")
        viewer.key("b")
        self.picture(viewer, "no_sky", lambda picture: png.changed(stars, picture) > 300)
        viewer.key("b")
        self.picture(viewer, "sky_again", lambda picture: png.changed(stars, picture) < CHANGED_WORDS)

    def test_f_fills_the_screen_and_goes_back_and_control_q_leaves(self):
        viewer = self.start("--camera", "20,10,12000000")
        before = viewer.geometry()
        viewer.key("f")
        wait_until("the full screen", lambda: viewer.geometry() == (0, 0, 800, 600))
        self.picture(viewer, "full_screen", lambda picture: picture[:2] == (800, 600))
        viewer.key("f")
        wait_until("the window", lambda: viewer.geometry()[2:] == before[2:])
        viewer.key("ctrl+q")
        self.assertEqual(viewer.program.wait(timeout=30), 0)

    def test_p_opens_a_panel_that_keys_and_pointer_move(self):
        viewer = self.start("--camera", "20,10,12000000", "--unlit")
        ground = [SIZE[0] - 120, SIZE[1] // 2]
        plain = self.picture(viewer, "without")
        viewer.key("p")
        self.picture(viewer, "panel", lambda picture: png.changed(plain, picture) > 20000)
        # The first arrow goes from the buttons to the slider of opacity; space takes it, an arrow moves it.
        for key in ("Down", "space"):
            viewer.key(key)
            time.sleep(1.0)
        viewer.xdotool("keydown", "Left", "sleep", "3", "keyup", "Left")

        def light(picture):
            return sum(png.pixel(picture, *ground)) / sum(png.pixel(plain, *ground))

        self.picture(viewer, "slid_by_keys", lambda picture: light(picture) < 0.97)
        self.assertTrue(viewer.camera_stays(), "the arrows were the panel's")
        # Its left half is most transparent.
        viewer.drag((150, 149), (30, 149))
        dragged = self.picture(viewer, "slid_by_pointer", lambda picture: light(picture) < 0.6)
        self.assertTrue(viewer.camera_stays(), "the drag was the panel's")
        viewer.key("Escape")
        self.picture(viewer, "closed", lambda picture: png.changed(dragged, picture) > 20000)
        self.assertIsNone(viewer.program.poll(), "Esc closes the panel first")

    def test_g_is_there_for_both_eyes(self):
        viewer = self.start("--camera", "20,10,12000000", "--unlit", "--stereo", "side-by-side")
        plain = self.picture(viewer, "without")
        viewer.key("g")
        half = SIZE[0] // 2

        def lines(picture):
            """Changed pixels in each half."""
            parts = [[(half, SIZE[1], [row[3 * first : 3 * (first + half)] for row in p[2]]) for p in (plain, picture)]
                     for first in (0, half)]
            return [png.changed(*part) for part in parts]

        self.picture(viewer, "graticule", lambda picture: min(lines(picture)) > 1000)


class NoDisplay(unittest.TestCase):
    def test_without_a_display_it_says_what_to_do(self):
        environment = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
        done = subprocess.run([PROGRAM, "view"], env=environment, capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 1)
        self.assertIn("display", done.stderr)
        self.assertIn("terrella render", done.stderr)
        self.assertEqual(done.stdout, "")


def cpu_s(pid):
    """Processor seconds that a process has used."""
    with open(f"/proc/{pid}/stat", encoding="ascii") as stat:
        fields = stat.read().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


if __name__ == "__main__":
    unittest.main()
