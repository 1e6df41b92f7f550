"""Every key's action twice in one session: the first use must not disable the second."""

import time
import unittest

from real_window import WindowTest, differing, wait_until

PANEL_ROWS = 380  # pixels from the top; under them are the status line and messages, which change by themselves
SAME = 600  # pixels that may differ: the bar of a text field blinks, 2 by 20 pixels, and a field is lit or not
SAME_DEG = 0.01  # a key glides, and ends within a pixel, 0.005° here, of where it would
OTHER = 1500  # pixels: the least that an action here changes, lines one pixel wide


def typed(text):
    return ["type " + text]


# Name, what is done, what takes it back. Each step is a key as xdotool names it, or `type` and a text.
SHOWN = [
    ("help by F1", ["F1"], ["F1"]),
    ("help by ?, closed by Esc", ["question"], ["Escape"]),
    ("graticule", ["g"], ["g"]),
    ("opacity of the surface", ["u"], ["u", "u"]),
    ("stereo", ["s"], ["s", "s", "s"]),
    ("view panel", ["p"], ["p"]),
    ("view panel, closed by Esc", ["p"], ["Escape"]),
    ("opacity written into the view panel", ["p", "Down", "Return", "ctrl+a", *typed("0.4"), "Return"],
     ["Return", "ctrl+a", *typed("1.0"), "Return", "Escape"]),
    ("layer panel", ["l"], ["l"]),
    ("layer panel, closed by Esc", ["l"], ["Escape"]),
    ("project panel, closed by Esc", ["j"], ["Escape"]),
    ("drawing panel, closed by Esc", ["d"], ["Escape"]),
    ("graticule by the layer panel", ["l", "Down", "Up", "space"], ["space", "Escape"]),
    ("picture panel, closed by Esc", ["i"], ["Escape"]),
    ("width written into the picture panel", ["i", "ctrl+a", *typed("77"), "Tab"],
     ["shift+Tab", "ctrl+a", *typed("1280"), "Tab", "Escape"]),
    ("search, closed by Esc", ["slash", *typed("sao")], ["Escape"]),
    ("search by name, corrected", ["slash", *typed("sax"), "BackSpace", *typed("o")], ["Escape"]),
    ("search, left to the globe and taken back", ["slash", *typed("s"), "F6", "g", "F6", *typed("ao")],
     ["F6", "g", "Escape"]),
    ("measuring", ["m", "Return"], ["m"]),
    ("measuring, ended by Esc", ["m", "Return"], ["Escape"]),
]

# Name, keys; each moves the camera, and to the same place if done twice from one place.
MOVES = [
    ("arrow", ["Up"]),
    ("arrow with Shift", ["shift+Right"]),
    ("zoom", ["plus"]),
    ("page key", ["Next"]),
    ("whole globe", ["Home"]),
    ("under the ground", ["x"]),
    ("another bookmark", ["2"]),
    ("search by name", ["slash", *typed("sao"), "Return"]),
    ("search by name and keypad", ["slash", *typed("sao"), "KP_Enter"]),
    ("globe beside a panel", ["p", "F6", "Up", "Escape"]),
]


class Twice(WindowTest):
    def do(self, viewer, steps):
        for step in steps:
            if step.startswith("type "):
                viewer.xdotool("type", "--delay", "30", step[5:])
            else:
                viewer.key(step)
            time.sleep(0.12)  # some frames: panels act once a frame

    def test_everything_shown_is_shown_twice(self):
        viewer = self.start("--camera", "20,10,12000000", "--unlit")
        self.screenshot(viewer, "start")
        plain = viewer.settled(PANEL_ROWS, still_s=1.0)  # all tiles are there

        def changed():
            return differing(plain, viewer.grab(), PANEL_ROWS)

        for name, do, undo in SHOWN:
            with self.subTest(name):
                shots = []  # frames of a loaded machine may be half a second apart
                for time_done in ("first", "second"):
                    self.do(viewer, do)
                    wait_until(f"{time_done} time: a change", lambda: changed() > OTHER)
                    shots.append(viewer.settled(PANEL_ROWS, still_s=1.0))
                    self.do(viewer, undo)
                    self.assertIsNone(viewer.program.poll(), "the window is open")
                    wait_until(f"{time_done} time: taken back", lambda: changed() < SAME)
                self.assertLess(differing(*shots, PANEL_ROWS), SAME, "the second time is as the first")

    def test_every_move_is_made_twice(self):
        viewer = self.start("--camera", "-30,120,3000000")
        viewer.key("ctrl+2")
        viewer.key("Up")
        viewer.next_camera()
        viewer.key("ctrl+1")
        start = viewer.camera
        for name, keys in MOVES:
            with self.subTest(name):
                ends = []
                for _ in range(2):
                    self.do(viewer, keys)
                    end = viewer.next_camera()
                    ends.append(end)
                    viewer.key("1")
                    back = viewer.next_camera()
                    self.assertAlmostEqual(back.height_m, start.height_m, delta=1.0)
                first, second = ends
                for value in ("lat", "lon", "heading", "pitch"):
                    self.assertAlmostEqual(getattr(first, value), getattr(second, value), delta=SAME_DEG)
                self.assertAlmostEqual(first.height_m / second.height_m, 1.0, delta=1e-4)

    def test_full_screen_twice(self):
        viewer = self.start("--camera", "20,10,12000000")
        windowed = viewer.geometry()[2:]
        for size in ((800, 600), windowed) * 2:
            viewer.key("f")
            wait_until(f"a window of {size}", lambda: viewer.geometry()[2:] == size)

    def test_search_opens_while_another_key_is_held(self):
        viewer = self.start("--camera", "10,20,9000000")
        for _ in range(2):
            viewer.xdotool("keydown", "Right")
            self.do(viewer, ["slash"])
            viewer.xdotool("keyup", "Right")
            self.do(viewer, [*typed("sao"), "Return"])
            self.arrives(viewer)
            viewer.key("Home")
            viewer.next_camera()

    def arrives(self, viewer):
        """In São Paulo, the most populous of the cities whose names begin like that."""
        wait_until("the flight", lambda: abs(viewer.next_camera().lat + 23.55) < 0.2)

    def test_a_held_key_is_let_go_by_the_loss_of_focus(self):
        viewer = self.start("--camera", "10,20,9000000")
        self.do(viewer, ["slash", *typed("sax")])
        for held in ("BackSpace", "Control_L"):
            viewer.xdotool("keydown", held)
            time.sleep(0.2)
            self.do_without_focus(viewer, ["keyup", held])
        self.do(viewer, ["ctrl+a", *typed("sao"), "Return"])
        self.arrives(viewer)
        self.do(viewer, ["slash", *typed("sao")])
        self.do_without_focus(viewer, ["key", "Escape"])
        self.do(viewer, ["Escape"])
        self.assertIsNone(viewer.program.poll(), "Esc closed the search alone")
        self.screenshot(viewer, "closed")
        viewer.key("Home")
        viewer.next_camera()
        self.do(viewer, ["slash", *typed("sao"), "Return"])
        self.arrives(viewer)

    def do_without_focus(self, viewer, command):
        """The keyboard is nobody's while xdotool does this."""
        viewer.unfocus()
        time.sleep(0.2)
        viewer.xdotool(*command)
        time.sleep(0.2)
        viewer.xdotool("windowfocus", viewer.window)
        time.sleep(0.2)


if __name__ == "__main__":
    unittest.main()
