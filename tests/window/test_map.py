"""The map over the globe by real keys and clicks: on at first, one key, a tick box, kept for later runs."""

import json
import time
import unittest

import png
from real_window import SIZE, WindowTest, wait_until

CAMERA = ("--camera", "47,10,1000000", "--unlit")


class Map(WindowTest):
    def shown(self, viewer, name):
        """True if the picture differs from that of the globe alone."""
        picture = png.read(self.screenshot(viewer, name))[2]
        return self.differing(picture) > 500

    def differing(self, picture):
        # Panels are at the upper and lower edge and at the right.
        return sum(a[3 * x : 3 * x + 3] != b[3 * x : 3 * x + 3]
                   for a, b in zip(picture[60:380], self.globe[60:380]) for x in range(SIZE[0] // 2 - 20))

    def settle_until(self, viewer, wanted, name):
        wait_until(f"the map {'on' if wanted else 'off'}", lambda: self.shown(viewer, name) == wanted)

    def test_it_is_on_at_first_and_has_a_key_and_a_tick_box(self):
        bare = self.start(*CAMERA)
        time.sleep(2.0)
        self.globe = png.read(self.screenshot(bare, "globe"))[2]
        bare.close()
        viewer = self.start(*CAMERA, "--map", "on", bare=False)
        self.settle_until(viewer, True, "on")
        viewer.key("c")
        self.settle_until(viewer, False, "key_off")
        viewer.key("c")
        self.settle_until(viewer, True, "key_on")
        viewer.key("l")
        time.sleep(0.5)
        viewer.click(SIZE[0] - 211, 92)  # the first row has the tick boxes of graticule and map
        viewer.move(500, 300)  # away from the tip
        self.settle_until(viewer, False, "box_off")
        viewer.key("Escape")
        self.assertEqual(viewer.quit(), 0)
        self.assertFalse(json.loads(self.settings.read_text(encoding="utf-8"))["map"])

    def test_the_first_run_shows_it(self):
        bare = self.start("--camera", "47,10,1000000")
        time.sleep(2.0)
        self.globe = png.read(self.screenshot(bare, "globe"))[2]
        bare.close()
        viewer = self.start("--camera", "47,10,1000000", bare=False)
        self.settle_until(viewer, True, "first")


if __name__ == "__main__":
    unittest.main()
