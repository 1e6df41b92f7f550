"""Drags, wheel and double clicks: the place under the cursor ends where the gesture requires."""

import unittest

from real_window import SIZE, WindowTest

HELD_PX = 1.0  # least shift that a user sees
CENTRE = (SIZE[0] / 2, SIZE[1] / 2)


def middle(pixel):
    return pixel[0] + 0.5, pixel[1] + 0.5


class Pointer(WindowTest):
    def drag_holds(self, camera, start, end):
        viewer = self.start("--camera", camera)
        held = viewer.camera.ground(*middle(start))
        self.assertIsNotNone(held)
        viewer.drag(start, end)
        after = viewer.next_camera()
        self.assertLess(after.miss_px(held, *middle(end)), HELD_PX)
        return viewer, after

    def test_drag_at_mid_latitude(self):
        viewer, after = self.drag_holds("46,7,3000000", (200, 150), (420, 300))
        self.assertAlmostEqual(after.heading, 0.0, delta=1e-6)
        self.screenshot(viewer, "dragged")

    def test_drag_across_the_antimeridian(self):
        _, after = self.drag_holds("10,179.5,2000000", (500, 250), (150, 240))
        self.assertLess(after.lon, -170.0)

    def test_drag_tilted_at_300_km(self):
        viewer, _ = self.drag_holds("46,7,300000,30,-35", (150, 380), (480, 300))
        self.screenshot(viewer, "tilted")

    def test_drag_over_the_pole(self):
        viewer, after = self.drag_holds("75,30,5000000", (320, 150), (325, 420))
        self.assertLess(abs(after.lon - 30.0 + 180.0), 15.0)
        self.screenshot(viewer, "over_the_pole")

    def test_flick_glides_on_and_stops(self):
        viewer = self.start("--camera", "20,50,4000000")
        viewer.move(250, 240)
        viewer.xdotool(
            *"mousedown 1 sleep 0.03 mousemove_relative 30 0 sleep 0.03 mousemove_relative 30 0 sleep 0.03".split(),
            *"mousemove_relative 30 0 mouseup 1".split(),
        )
        start = viewer.camera
        held = start.ground(250.5, 240.5)
        after = viewer.next_camera()
        self.assertGreater(after.pixel(held)[0], 345.0)
        self.assertTrue(viewer.camera_stays())

    def test_wheel_keeps_the_point_under_the_cursor(self):
        viewer = self.start("--camera", "46,7,3000000")
        for pixel, clicks in (((420, 320), 5), ((150, 100), -3)):
            held = viewer.camera.ground(*middle(pixel))
            height_m = viewer.camera.height_m
            viewer.wheel(*pixel, clicks)
            after = viewer.next_camera()
            self.assertLess(after.miss_px(held, *middle(pixel)), HELD_PX)
            self.assertAlmostEqual(after.height_m / (height_m * 0.8**clicks), 1.0, delta=1e-6)

    def tilt(self, button, modifier=None):
        viewer = self.start("--camera", "46,7,300000")
        centre = viewer.camera.ground(*CENTRE)
        if modifier:
            viewer.xdotool("keydown", modifier)
        viewer.drag((300, 300), (340, 180), button=button)
        if modifier:
            viewer.xdotool("keyup", modifier)
        after = viewer.next_camera()
        self.assertLess(after.miss_px(centre, *CENTRE), HELD_PX)
        self.assertGreater(after.pitch, -75.0)
        self.assertGreater(abs(after.heading), 5.0)
        return viewer

    def test_right_drag_tilts_and_turns(self):
        self.screenshot(self.tilt(button=3), "tilted")

    def test_left_drag_with_control_tilts_and_turns(self):
        self.tilt(button=1, modifier="ctrl")

    def test_double_click_flies_there(self):
        viewer = self.start("--camera", "46,7,3000000")
        there = viewer.camera.ground(400.5, 150.5)
        viewer.double_click(400, 150)
        after = viewer.next_camera()
        self.assertLess(after.miss_px(there, *CENTRE), HELD_PX)
        self.assertLess(after.height_m, 2.0e6)


if __name__ == "__main__":
    unittest.main()
