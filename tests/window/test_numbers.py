"""A layer of numbers in the window: its legend, the value under the cursor, and the stretch by the mouse."""

import os
import unittest
from pathlib import Path

import png
from real_window import SIZE, WindowTest

TEMPERATURE = Path(os.environ["TERRELLA_SOURCE"]) / "data/ocean/sea_surface_temperature.tif"
GROUND = (150, 240)  # the Atlantic, left of the panel
PANEL_RIGHT = SIZE[0] - 12


class Numbers(WindowTest):
    def test_legend_and_stretch_by_the_mouse(self):
        viewer = self.start(str(TEMPERATURE), "--colormap", "grey", "--camera", "20,-40,9000000", "--unlit")
        plain = png.read(self.screenshot(viewer, "plain"))
        # The legend stands over the status line: a bar from black to white.
        bars = [
            y for y in range(SIZE[1] - 160, SIZE[1] - 40)
            if sum(png.pixel(plain, 30, y)) < 60 and sum(png.pixel(plain, 270, y)) > 660
            and abs(sum(png.pixel(plain, 151, y)) - 382) < 45
        ]
        self.assertGreater(len(bars), 8, "a colour bar")
        viewer.key("l")
        viewer.click(PANEL_RIGHT - 168, 78)  # opens the row
        self.screenshot(viewer, "row")
        viewer.drag((PANEL_RIGHT - 275, 171), (PANEL_RIGHT - 120, 171))
        dragged = png.read(self.screenshot(viewer, "dragged"))
        before, after = (sum(png.pixel(picture, *GROUND)) / 3 for picture in (plain, dragged))
        self.assertLess(after, before - 25, "the first value rose, so the sea is darker")
        self.assertTrue(viewer.camera_stays(0.5), "the drag was the panel's")

    def test_the_value_under_the_cursor_widens_the_status_line(self):
        # The globe is small, so that only words are bright at the lower edge.
        viewer = self.start(str(TEMPERATURE), "--colormap", "grey", "--camera", "20,-40,40000000", "--unlit")
        viewer.move(SIZE[0] // 2, SIZE[1] // 2)
        over = self.status_width(viewer, "over")
        viewer.move(2, 2)
        beside = self.status_width(viewer, "beside")
        self.assertGreater(over, beside + 60)

    def status_width(self, viewer, name):
        """Columns of the status line that its panel covers, by the bright letters in it."""
        picture = png.read(self.screenshot(viewer, name))
        rows = range(SIZE[1] - 38, SIZE[1] - 14)
        bright = [x for x in range(SIZE[0] - 200) if any(min(png.pixel(picture, x, y)) > 200 for y in rows)]
        return max(bright, default=0) - min(bright, default=0)


if __name__ == "__main__":
    unittest.main()
