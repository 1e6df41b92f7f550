"""The swipe in the window: V shows the line, the mouse drags it, and a layer's row chooses its side."""

import json
import unittest

import pictures
import png
from real_window import SIZE, WindowTest

RED, GREEN = (200, 0, 0), (0, 200, 0)
ROW = SIZE[1] // 4  # off the handle in the middle, and under the texts


class Swipe(WindowTest):
    def setUp(self):
        super().setUp()
        for name, colour in (("red", RED), ("green", GREEN)):
            (self.folder / f"{name}.png").write_bytes(pictures.png(256, 128, colour))

    def begin(self, *more):
        viewer = self.start(*more, "--overlay", str(self.folder / "red.png"), "--overlay",
                            str(self.folder / "green.png"), "--camera", "0,0,1000000", "--unlit")
        viewer.settled()
        return viewer

    def line(self, viewer, name, place):
        """Waits for green to the left of a place and red to its right; `place` 0: red alone, SIZE[0]: green alone."""

        def divided(picture):
            seen = [png.pixel(picture, x, ROW)[:3] for x in range(100, SIZE[0] - 100, 20) if abs(x - place) > 10]
            return seen == [GREEN if x < place else RED for x in range(100, SIZE[0] - 100, 20) if abs(x - place) > 10]

        return self.picture(viewer, name, divided)

    def test_the_line_is_shown_and_dragged_twice(self):
        viewer = self.begin()
        middle = SIZE[0] // 2
        for k in range(2):
            self.line(viewer, f"plain{k}", SIZE[0])
            viewer.key("v")
            self.line(viewer, f"line{k}", middle)
            viewer.drag((middle, SIZE[1] // 2), (300, SIZE[1] // 2))
            self.line(viewer, f"left{k}", 300)
            viewer.drag((300, 100), (500, 200))
            self.line(viewer, f"right{k}", 500)
            self.assertTrue(viewer.camera_stays(0.5), "the drags were the line's")
            viewer.drag((500, 200), (middle, 200))
            viewer.key("v")

    def test_the_line_returns_at_the_next_start(self):
        viewer = self.begin("--swipe", "0.25")
        self.line(viewer, "begins", SIZE[0] // 4)
        viewer.drag((SIZE[0] // 4, 100), (560, 100))
        self.line(viewer, "dragged", 560)
        viewer.quit()
        session = json.loads((self.kept / "terrella" / "session.terrella").read_text(encoding="utf-8"))
        self.assertAlmostEqual(session["settings"]["swipe"], 560 / SIZE[0], delta=1 / SIZE[0])
        self.assertEqual([layer.get("swipe-side") for layer in session["layers"]], [None, "behind", "before"])
        again = self.start(bare=False)
        self.line(again, "returned", 560)

    def test_one_layer_is_not_compared(self):
        viewer = self.start("--camera", "0,0,1000000", "--unlit")
        plain = viewer.settled()
        viewer.key("v")
        self.assertNotEqual(viewer.settled(), plain, "a message says what is missing")


if __name__ == "__main__":
    unittest.main()
