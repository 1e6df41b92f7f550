"""A layer of numbers in the window: its legend, the value under the cursor, and the stretch by the mouse."""

import os
import unittest
from pathlib import Path

import png
from real_window import SIZE, WindowTest, wait_until

TEMPERATURE = Path(os.environ["TERRELLA_SOURCE"]) / "data/ocean/sea_surface_temperature.tif"
GROUND = (150, 240)  # the Atlantic, left of the panel
SEA_THERE = 60  # grey: the sky is darker
MIDDLE = (SIZE[0] // 2, SIZE[1] // 2)
PANEL_RIGHT = SIZE[0] - 12


class Numbers(WindowTest):
    def test_legend_and_stretch_by_the_mouse(self):
        viewer = self.start(str(TEMPERATURE), "--colormap", "grey", "--camera", "20,-40,9000000", "--unlit")

        def has_legend(picture):
            """Over the status line stands a bar from black to white."""
            bars = [
                y for y in range(SIZE[1] - 160, SIZE[1] - 40)
                if sum(png.pixel(picture, 30, y)) < 60 and sum(png.pixel(picture, 270, y)) > 660
                and abs(sum(png.pixel(picture, 151, y)) - 382) < 45
            ]
            return len(bars) > 8

        def sea(picture):
            return sum(png.pixel(picture, *GROUND)) / 3

        plain = self.picture(viewer, "plain", lambda picture: has_legend(picture) and sea(picture) > SEA_THERE)
        viewer.key("l")
        closed = viewer.panel("Layers")
        viewer.settled()
        viewer.click(PANEL_RIGHT - 168, 78)  # opens the row
        wait_until("the row", lambda: viewer.panel("Layers") != closed)
        self.picture(viewer, "row")
        viewer.drag((PANEL_RIGHT - 275, 171), (PANEL_RIGHT - 120, 171))
        # The first value rose, so the sea is darker.
        self.picture(viewer, "dragged", lambda picture: sea(picture) < sea(plain) - 25)
        self.assertTrue(viewer.camera_stays(0.5), "the drag was the panel's")

    def test_the_value_under_the_cursor_widens_the_status_line(self):
        # The globe is small, so that only words are bright at the lower edge.
        viewer = self.start(str(TEMPERATURE), "--colormap", "grey", "--camera", "20,-40,40000000", "--unlit")
        def width_at(place, name):
            viewer.move(*place)
            return self.status_width(self.picture(viewer, name))

        wait_until("the value", lambda: width_at(MIDDLE, "over") > width_at((2, 2), "beside") + 60)

    def status_width(self, picture):
        """Columns of the status line that its panel covers, by the bright letters in it."""
        rows = range(SIZE[1] - 38, SIZE[1] - 14)
        bright = [x for x in range(SIZE[0] - 200) if any(min(png.pixel(picture, x, y)) > 200 for y in rows)]
        return max(bright, default=0) - min(bright, default=0)


if __name__ == "__main__":
    unittest.main()
