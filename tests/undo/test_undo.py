"""Undo and redo of layers by real mouse and keyboard: shown, opacity, order, removal, style."""

import json
import unittest

import pictures
import test_styles
from ellipsoid_camera import ecef
from real_window import SIZE, WindowTest, wait_until

RED, GREEN = (200, 0, 0), (0, 200, 0)
HALF = (100, 100, 0)
BLENDS = {"multiply": (285, (0, 0, 0)), "difference": (325, (200, 200, 0)), "screen": (305, (200, 200, 0))}
PROBE = (120, SIZE[1] // 2)  # beside the panel
ROW, OPACITY = 65, 91  # pixels under the panel's upper edge
BOX, NAME = 22, 90  # pixels from the panel's left edge
SLIDER = (103, 167)  # the same, of the opacity: the middle and the end
REMOVE = (268, 286)  # the same, in the row of a layer whose style is open
COMPARISON, BLEND = (102, 191), (90, 240)  # the title of swipe, blend and tone; the list of blends
BUTTONS = (91, 168, 154)  # the same, "Down", the height of both, and "Remove"


def colour_at(rows, x, y):
    return tuple(rows[y][x] >> shift & 255 for shift in (16, 8, 0))


class Undo(WindowTest):
    def begin(self):
        for name, colour in (("red", RED), ("green", GREEN)):
            (self.folder / f"{name}.png").write_bytes(pictures.png(256, 128, colour))
        self.viewer = self.start("--overlay", str(self.folder / "red.png"), "--overlay",
                                 str(self.folder / "green.png"), "--camera", "0,0,1000000", "--unlit")
        self.viewer.settled()
        self.viewer.key("l")
        self.left, self.top = map(round, self.viewer.panel("Layers")[:2])
        self.shows("begins", GREEN)

    def shows(self, name, colour):
        """Waits for a colour beside the panel."""

        def seen():
            return all(abs(a - b) <= 12 for a, b in zip(colour_at(self.viewer.grab(), *PROBE), colour))

        wait_until(name, seen)

    def click(self, x, y):
        """Clicks in the panel; then the pointer leaves it, because the tip of an item may cover the probe."""
        self.viewer.click(self.left + x, self.top + y)
        self.viewer.settled()
        self.viewer.move(5, 5)
        self.viewer.settled()

    def back_and_forth(self, name, before, after):
        """By each way, twice in a row; ends with the step taken back."""
        self.shows(f"{name}_made", after)
        for k, redo in enumerate(("ctrl+y", "ctrl+shift+z")):
            self.viewer.key("ctrl+z")
            self.shows(f"{name}_undone_{k}", before)
            self.viewer.key(redo)
            self.shows(f"{name}_redone_{k}", after)
        self.viewer.key("ctrl+z")
        self.shows(f"{name}_undone", before)

    def open_row(self):
        self.click(NAME, ROW)
        wait_until("the row", lambda: self.viewer.panel("Layers")[3] > self.top + BUTTONS[1] + 100)
        self.viewer.settled()

    def test_showing_and_a_drag_of_the_opacity_are_one_step_each(self):
        self.begin()
        self.click(BOX, ROW)
        self.back_and_forth("hidden", GREEN, RED)
        self.open_row()
        self.viewer.drag((self.left + SLIDER[1], self.top + OPACITY), (self.left + SLIDER[0], self.top + OPACITY))
        self.back_and_forth("faded", GREEN, HALF)
        self.viewer.save_grab(self.folder / "panel.png")

    def test_blends_which_the_next_start_has(self):
        self.begin()
        self.open_row()
        self.click(*COMPARISON)
        for name, (place, colour) in BLENDS.items():
            self.click(*BLEND)
            self.click(BLEND[0], place)
            self.back_and_forth(name, GREEN, colour)
        self.viewer.key("ctrl+y")
        self.shows("screen again", BLENDS["screen"][1])
        self.viewer.save_grab(self.folder / "blend.png")
        self.viewer.key("l")  # closes the panel
        self.viewer.settled()
        self.assertEqual(self.viewer.quit(), 0)
        session = json.loads((self.kept / "terrella" / "session.terrella").read_text(encoding="utf-8"))
        self.assertEqual([layer.get("blend") for layer in session["layers"]], [None, None, "screen"])
        self.viewer = self.start(bare=False)
        self.shows("kept", BLENDS["screen"][1])

    def test_order_and_removal(self):
        self.begin()
        self.open_row()
        for name, x in (("lower", BUTTONS[0]), ("removed", BUTTONS[2])):
            self.click(x, BUTTONS[1])
            self.back_and_forth(name, GREEN, RED)
        self.click(BOX, ROW)
        self.shows("hidden", RED)  # the layer that returned has a row of its own
        self.viewer.key("ctrl+z")
        self.shows("shown", GREEN)
        self.assertEqual([round(x) for x in self.viewer.panel("Layers")[:2]], [self.left, self.top], "the panel jumped")


class StyleUndo(WindowTest):
    write_districts, begin, open_style = (test_styles.Styles.write_districts, test_styles.Styles.begin,
                                          test_styles.Styles.open_style)
    choose, choose_field = test_styles.Styles.choose, test_styles.Styles.choose_field

    def colours(self):
        rows = self.viewer.grab()
        pixels = [self.viewer.camera.pixel(ecef(*test_styles.middle(k), 0.0)) for k in range(9)]
        return [colour_at(rows, round(x - 0.5), round(y - 0.5)) for x, y in pixels]

    def test_a_style_is_undone_and_a_removed_layer_returns_with_its_style(self):
        self.begin()
        own = [test_styles.OWN] * 9
        wait_until("the own colours", lambda: self.colours() == own)
        self.open_style()
        self.choose_field("kind")
        self.viewer.move(5, 5)  # no tip over the districts
        wait_until("other colours", lambda: self.colours()[0] != own[0])
        self.viewer.settled()
        styled = self.colours()
        self.viewer.save_grab(self.folder / "styled.png")
        for k in range(2):
            self.viewer.key("ctrl+z")
            wait_until("the own colours again", lambda: self.colours() == own)
            self.viewer.key("ctrl+y")
            wait_until("the style again", lambda: self.colours() == styled)
        for k in range(2):
            self.viewer.click(self.left + REMOVE[0], self.top + REMOVE[1])
            wait_until("no layer", lambda: "legend" not in self.viewer.layout.panels)
            self.viewer.move(5, 5)
            self.viewer.settled()
            self.assertTrue(all(colour not in styled for colour in self.colours()))
            self.viewer.key("ctrl+z")
            wait_until("the layer in its style", lambda: self.colours() == styled)
            self.viewer.settled()
            self.viewer.save_grab(self.folder / f"returned_{k}.png")


if __name__ == "__main__":
    unittest.main()
