"""The window answers: failures are shown, keys act where they are pressed, labels keep apart. Each thing is done twice."""

import json
import socket
import struct
import subprocess
import time
import unittest

from real_window import PATIENCE_S, WindowTest, differing, wait_until
from test_idle import processor_s

PROBLEM_INK = (255, 168, 115)  # colour of the line in the row of a layer
INK_PIXELS = 60  # pixels of that colour, without antialiased edges
NOWHERE = "http://127.0.0.1:9/{z}/{x}/{y}.png"  # the port "discard", where nobody listens
MOST_SHARE = 0.05  # share of a core; looking for tiles 60 times a second took 0.1
NUMBERS = "ncols 64\nnrows 32\nxllcorner -180\nyllcorner -90\ncellsize 5.625\n" + (" ".join(map(str, range(64))) + "\n") * 32
END_OF_PNG = b"IEND\xaeB`\x82"
NAMES = 15  # labels in a picture with more than the graticule
SAME_PIXELS = 300  # rounding at the edge of the globe, among 300,000


def rgb(pixel):
    return pixel >> 16 & 255, pixel >> 8 & 255, pixel & 255


class Feedback(WindowTest):
    def press(self, viewer, *keys):
        for key in keys:
            viewer.key(key)
            time.sleep(0.12)  # some frames: panels act once a frame

    def shown(self, viewer, name):
        return name in viewer.layout.panels

    def wait_shown(self, viewer, name, shown=True):
        wait_until(f"{name}: {shown}", lambda: self.shown(viewer, name) == shown)


class Servers(Feedback):
    def open_address(self, viewer, address):
        self.press(viewer, "ctrl+o", "ctrl+a")
        viewer.xdotool("type", "--delay", "20", address)
        self.press(viewer, "Return")

    @staticmethod
    def ink(viewer):
        near = (sum(abs(a - b) for a, b in zip(rgb(p), PROBLEM_INK)) < 40 for row in viewer.grab() for p in row)
        return sum(near)

    def test_an_unreachable_server_is_told_and_costs_little(self):
        viewer = self.start("--camera", "20,10,12000000", "--unlit")
        self.press(viewer, "l")
        shares = []
        for _ in range(2):
            viewer.settled()
            before, bottom = self.ink(viewer), viewer.panel("Layers")[3]
            self.open_address(viewer, NOWHERE)
            wait_until("the layer's row", lambda: viewer.panel("Layers")[3] > bottom)
            time.sleep(1.0)  # the panel is drawn
            used, start = processor_s(viewer.program.pid), time.monotonic()
            while self.ink(viewer) < before + INK_PIXELS:
                self.assertLess(time.monotonic() - start, PATIENCE_S, "the failure in the layer's row")
                time.sleep(0.5)
            shares.append((processor_s(viewer.program.pid) - used) / (time.monotonic() - start))
        viewer.save_grab(self.folder / "failure.png")
        print("while the server is tried", *(f"{100.0 * share:.1f} %" for share in shares), "of a core")
        self.assertLess(min(shares), MOST_SHARE)


class Stereo(Feedback):
    def test_names_in_both_eyes_of_an_anaglyph(self):
        """Without a distance between the eyes both see the same picture: that of one eye, in all colours."""
        view = "--camera", "47,10,3000000", "--unlit", "--eye-separation", "0", "--map", "on"
        self.settings.write_text('{"graticule": true}', encoding="ascii")
        pictures = []
        for mode in ("off", "anaglyph", "anaglyph"):
            viewer = self.start(*view, "--stereo", mode, bare=False)
            wait_until("the map's names", lambda: len(viewer.layout.labels) > NAMES)
            pictures.append(viewer.settled(still_s=1.0))
            viewer.save_grab(self.folder / f"{len(pictures)}-{mode}.png")
            viewer.close()
        for anaglyph in pictures[1:]:
            self.assertLess(differing(pictures[0], anaglyph), SAME_PIXELS)


class Lists(Feedback):
    def lists(self, viewer):
        return [name for name in viewer.layout.panels if name.startswith("Combo_")]

    def test_esc_closes_a_list_and_not_its_panel(self):
        viewer = self.start("--camera", "20,10,12000000", "--unlit", size=(640, 560))
        self.press(viewer, "p")
        self.wait_shown(viewer, "View")
        self.press(viewer, "Down", "Down", "Down")
        for _ in range(12):  # the buttons above take another number of rows at another width
            self.press(viewer, "space")
            viewer.settled()  # on a busy machine a list opens late
            if self.lists(viewer):
                break
            self.press(viewer, "Down")
        for times in ("first", "second"):
            if times == "second":
                self.press(viewer, "space")
            wait_until(f"{times} time: the list", lambda: self.lists(viewer))
            viewer.save_grab(self.folder / f"{times}.png")
            self.press(viewer, "Escape")
            wait_until(f"{times} time: no list", lambda: not self.lists(viewer))
            time.sleep(0.3)
            self.assertTrue(self.shown(viewer, "View"), "the panel is open")
        self.press(viewer, "Escape")
        self.wait_shown(viewer, "View", False)
        self.assertIsNone(viewer.program.poll(), "the window is open")


class Pictures(Feedback):
    def saved(self):
        """Sizes of the pictures that are whole."""
        files = sorted(self.folder.glob("terrella-*.png"), key=lambda file: file.stat().st_mtime_ns)
        return [struct.unpack(">II", data[16:24]) for data in (file.read_bytes() for file in files) if data.endswith(END_OF_PNG)]

    def test_enter_saves_wherever_the_keyboard_is(self):
        viewer = self.start("--camera", "20,10,12000000", "--unlit")
        to_field = [], ["Tab"], ["ctrl+a", "3", "0", "0"], ["Tab", "ctrl+a", "2", "0", "0"], ["Down", "Down"], []
        for count, keys in enumerate(to_field, 1):
            for enter in ("Return", "KP_Enter"):
                before = len(self.saved())
                self.press(viewer, "i")
                self.wait_shown(viewer, "Save picture")
                self.press(viewer, *keys, enter)
                wait_until(f"picture {count} by {keys} and {enter}", lambda: len(self.saved()) == before + 1)
                self.wait_shown(viewer, "Save picture", False)
        self.assertEqual(self.saved()[-1], (300, 200))
        self.press(viewer, "i", "Escape")
        self.wait_shown(viewer, "Save picture", False)

    def test_a_saved_picture_has_one_legend(self):
        """The picture brings its own; the legend of the window makes room while the picture is under way."""
        (self.folder / "n.asc").write_text(NUMBERS)
        subprocess.run(["gdal_translate", "-q", "-a_srs", "EPSG:4326", "-ot", "Float32", "n.asc", "n.tif"], cwd=self.folder,
                       check=True)
        silent = socket.create_server(("127.0.0.1", 0))  # its tiles never come, so that the picture stays under way
        self.addCleanup(silent.close)
        url = f"http://127.0.0.1:{silent.getsockname()[1]}/{{z}}/{{x}}/{{y}}.png"
        (self.folder / "silent.json").write_text(json.dumps({"url": url, "tile_px": 256, "root_span_deg": 180, "max_level": 2}))
        viewer = self.start("n.tif", "--overlay", "silent.json", "--camera", "20,10,12000000", "--unlit")
        self.wait_shown(viewer, "legend")
        for _ in range(2):
            self.press(viewer, "i", "Return")
            self.wait_shown(viewer, "Save picture", False)
            self.wait_shown(viewer, "legend", False)
            self.press(viewer, "Escape")  # cancels the picture
            self.wait_shown(viewer, "legend")


class Time(Feedback):
    def test_switching_the_time_on_is_told_before_the_slow_frame(self):
        for _ in range(2):
            viewer = self.start("--camera", "20,10,12000000")
            viewer.settled()
            wait_until("the status line", lambda: self.shown(viewer, "status"))
            plain = viewer.layout
            self.assertFalse(self.shown(viewer, "message"))
            seen = len(viewer.layouts)
            self.press(viewer, "t")
            wait_until("the time", lambda: viewer.layout.panels.get("status") != plain.panels["status"])
            told = [one for one in viewer.layouts[seen:] if "message" in one.panels]
            self.assertEqual(told[0].panels["status"], plain.panels["status"], "the message comes before the time")
            viewer.close()


class Labels(Feedback):
    def test_names_keep_off_the_labels_of_a_measurement(self):
        """Their text lies over the map's places; an unlit picture has no labels."""
        viewer = self.start("--camera", "47,10,3000000", "--map", "on", bare=False)
        wait_until("the map's names", lambda: len(viewer.layout.labels) > 5)
        for _ in range(2):
            self.press(viewer, "m")
            for place in ((170, 150), (470, 300), (200, 320), (420, 140)):
                viewer.click(*place)
                viewer.settled()
                self.assertEqual(viewer.layout.faults(*viewer.size), [])
            viewer.save_grab(self.folder / "measured.png")
            self.press(viewer, "m")


if __name__ == "__main__":
    unittest.main()
