"""Runs the viewer in a private display, and sends real key and pointer events to the viewer."""

import json
import operator
import os
import queue
import re
import shutil
import subprocess
import tempfile
import threading
import time
import unittest
import zlib
from pathlib import Path

import pictures
import png
import window_pixels
from ellipsoid_camera import Camera

PROGRAM = os.environ.get("TERRELLA", "terrella")
DROP_FILES = os.environ.get("DROP_FILES", "drop_files")
ARTEFACTS = Path(os.environ.get("WINDOW_ARTEFACTS", "window-artefacts"))
SIZE = (640, 480)
MENU_PIXELS = 20000  # the least that a menu covers
PATIENCE_S = 60.0  # software GL on a loaded machine


def wait_until(what, condition, seconds=PATIENCE_S):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        value = condition()
        if value:
            return value
        time.sleep(0.05)
    raise AssertionError(f"waited {seconds} s in vain for {what}")


def differing(one, other, rows=None):
    """Number of pixels that differ between two grabs, in the first rows."""
    if len(one) != len(other) or len(one[0]) != len(other[0]):
        return len(one) * len(one[0])
    return sum(sum(map(operator.ne, a, b)) for a, b in zip(one[:rows], other[:rows]) if a != b)


class Display:
    """An X server on the first free display, without a window manager."""

    def __init__(self, size="800x600"):
        read_end, write_end = os.pipe()
        self.server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write_end), "-screen", "0", f"{size}x24", "-nolisten", "tcp", "-noreset"],
            pass_fds=[write_end],
            stderr=subprocess.DEVNULL,
        )
        os.close(write_end)
        with os.fdopen(read_end) as pipe:
            number = pipe.readline().strip()
        if not number:
            raise RuntimeError("Xvfb does not start")
        self.environment = {**os.environ, "DISPLAY": f":{number}", "LIBGL_ALWAYS_SOFTWARE": "1"}

    def close(self):
        self.server.terminate()
        self.server.wait()


class Layout:
    """Rectangles of panels and labels: left, top, right, bottom."""

    OVER_OTHERS = re.compile(r"Menu|##Tooltip_|##Combo_|##Popup_")  # as long as they are open

    def __init__(self, told):
        self.panels = {name.split("##")[-1]: box for name, box in told["panels"].items()}
        self.labels = told["labels"]
        self.cut = [f"{name} is cut" for name in told["cut"]]
        self.fixed = [(name, box) for name, box in told["panels"].items() if not self.OVER_OTHERS.match(name)]

    def faults(self, width, height):
        """Pairs that overlap, what leaves the window, and panels whose contents are cut."""
        boxes = self.fixed + [(f"label {k}", box) for k, box in enumerate(self.labels)]
        over = [(a, b) for k, a in enumerate(boxes) for b in boxes[:k]
                if all(min(a[1][i + 2], b[1][i + 2]) - max(a[1][i], b[1][i]) > 0.5 for i in (0, 1))]
        all_panels = [(name, box) for name, box in self.panels.items()]
        beyond = [one for one in all_panels if min(one[1]) < 0 or one[1][2] > width + 0.5 or one[1][3] > height + 0.5]
        return over + beyond + self.cut


class Viewer:
    """The program in a window; what it prints of its camera."""

    def __init__(self, display, folder, *options, size=SIZE, bare=True):
        self.environment = display.environment
        self.size = size or SIZE
        sized = ["--size", f"{size[0]}x{size[1]}"] if size else []
        command = [PROGRAM, "view", *sized, "--print-camera", "--print-panels", *(["--map", "off"] if bare else []),
                   *options]
        self.program = subprocess.Popen(
            command, cwd=folder, env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        self.lines = queue.Queue()
        self.layout = Layout({"panels": {}, "labels": [], "cut": []})
        self.layouts = []  # all so far
        self.reader = threading.Thread(target=self._read, daemon=True)
        self.reader.start()
        self.camera = None
        self.next_camera()
        self.window = wait_until("the window", self._find_window)
        self.pixels = None

    def _read(self):
        for line in self.program.stdout:
            if line.startswith("{"):
                self.layout = Layout(json.loads(line))
                self.layouts.append(self.layout)
            else:
                self.lines.put(line.strip())

    def _find_window(self):
        found = self.xdotool("search", "--onlyvisible", "--name", "^Terrella", check=False).split()
        return found[0] if found else None

    def xdotool(self, *arguments, check=True):
        done = subprocess.run(["xdotool", *arguments], env=self.environment, capture_output=True, text=True, timeout=60)
        if check and done.returncode != 0:
            raise RuntimeError(f"xdotool {arguments}: {done.stderr}")
        return done.stdout

    def next_camera(self):
        """Waits for the camera to come to rest somewhere else, and for good."""
        self.camera = Camera(self.lines.get(timeout=PATIENCE_S), self.size)
        while True:
            try:
                self.camera = Camera(self.lines.get(timeout=0.5), self.size)
            except queue.Empty:
                return self.camera

    def camera_stays(self, seconds=1.0):
        try:
            return self.lines.get(timeout=seconds) is None
        except queue.Empty:
            return True

    # The cursor is put on pixel (x, y); what it points at is that pixel's middle.

    def move(self, x, y):
        self.xdotool("mousemove", "--window", self.window, str(x), str(y))

    def drag(self, start, end, button=1, steps=6):
        self.move(*start)
        self.xdotool("mousedown", str(button))
        for i in range(1, steps + 1):
            self.move(*(round(a + (b - a) * i / steps) for a, b in zip(start, end)))
            time.sleep(0.05)
        time.sleep(0.6)  # a hand that rests before it lets go does not flick
        self.xdotool("mouseup", str(button))

    def wheel(self, x, y, clicks):
        self.move(x, y)
        self.xdotool("click", "--repeat", str(abs(clicks)), "--delay", "60", "4" if clicks > 0 else "5")

    def click(self, x, y):
        self.move(x, y)
        self.xdotool("click", "1")

    def double_click(self, x, y):
        self.move(x, y)
        self.xdotool("click", "--repeat", "2", "--delay", "80", "1")

    def key(self, name):
        self.xdotool("key", name)

    def grab(self):
        """The window's pixels as rows of 32-bit numbers."""
        if not self.pixels:
            self.pixels = window_pixels.Connection(self.environment["DISPLAY"], self.window)
        return self.pixels.grab()

    def save_grab(self, file, rows=None):
        """Keeps a grab for a person to look at; without one, the picture that shows."""
        rows = rows or self.grab()
        data = bytearray()
        for row in rows:
            pixels, line = row.tobytes(), bytearray(3 * len(row))
            line[0::3], line[1::3], line[2::3] = pixels[2::4], pixels[1::4], pixels[0::4]  # from blue, green, red and 0
            data += b"\0" + line
        Path(file).write_bytes(pictures.png_of(len(rows[0]), len(rows), zlib.compress(data, 1)))

    def clipboard(self):
        done = subprocess.run(["xclip", "-selection", "clipboard", "-o"], env=self.environment, capture_output=True,
                              text=True, timeout=60)
        return done.stdout

    def set_clipboard(self, text):
        subprocess.run(["xclip", "-selection", "clipboard", "-i"], env=self.environment, input=text, text=True,
                       stdout=subprocess.DEVNULL, check=True, timeout=60)

    def quit(self, closing=0):
        """Leaves as a user does, by Esc and Esc again, after `closing` that close a fault or a mark; the exit code."""
        self.xdotool("key", "--delay", "200", *["Escape"] * (closing + 2))
        return self.program.wait(timeout=30)

    def right_click(self, x, y):
        self.move(x, y)
        self.xdotool("click", "3")

    def is_busy(self):
        """True while the viewer's frame loop runs, draws, or waits for a processor: events may not have acted yet."""
        for task in Path(f"/proc/{self.program.pid}/task").glob("*"):
            try:
                name, _, state = (task / "stat").read_text(encoding="utf-8", errors="replace").rpartition(") ")
            except (FileNotFoundError, ProcessLookupError):
                continue  # this thread has ended
            draws = task.name == str(self.program.pid) or "(llvmpipe" in name
            if draws and state[0] in "RD":
                return True
        return False

    def settled(self, rows=None, still_s=0.15):
        """The picture once tiles and panels stand still, in the first rows; all events so far have acted."""

        def same():
            if self.is_busy():
                return None
            one = self.grab()
            time.sleep(still_s)
            return one if not self.is_busy() and differing(one, self.grab(), rows) == 0 else None

        return wait_until("a picture at rest", same)

    def panel(self, name):
        """The rectangle of a panel, once it is in a layout."""
        return wait_until(f"the panel {name}", lambda: self.layout.panels.get(name))

    def open_menu(self, x, y):
        """By a right click; waits until the menu is there and stands still."""
        self.move(x, y)
        before = self.settled()
        self.xdotool("click", "3")
        wait_until("the menu", lambda: differing(before, self.grab()) > MENU_PIXELS)
        self.settled()

    def unfocus(self):
        """Gives the keyboard to what the pointer is over, and puts the pointer beside the window."""
        self.xdotool("mousemove", "799", "599", "windowfocus", "1")

    def drop(self, *files):
        done = subprocess.run(
            [DROP_FILES, self.window, *map(str, files)], env=self.environment, capture_output=True, text=True, timeout=90
        )
        if done.returncode != 0:
            raise RuntimeError(f"dropping {files}: {done.stderr}")

    def geometry(self):
        text = self.xdotool("getwindowgeometry", "--shell", self.window)
        values = dict(re.findall(r"(\w+)=(-?\d+)", text))
        return tuple(int(values[name]) for name in ("X", "Y", "WIDTH", "HEIGHT"))

    def close(self):
        if self.pixels:
            self.pixels.close()
            self.pixels = None
        if self.program.poll() is None:
            self.program.terminate()
        self.program.wait()
        self.reader.join()
        self.program.stdout.close()
        self.program.stderr.close()


class WindowTest(unittest.TestCase):
    """Each test has a viewer of its own, on a display that they share."""

    @classmethod
    def setUpClass(cls):
        cls.display = Display()
        cls.addClassCleanup(cls.display.close)

    def setUp(self):
        kept = tempfile.TemporaryDirectory(prefix="terrella-kept-")
        self.addCleanup(kept.cleanup)
        self.kept = Path(kept.name)
        for name in ("XDG_CONFIG_HOME", "XDG_CACHE_HOME", "XDG_STATE_HOME"):
            self.display.environment[name] = kept.name
        # No hint over the pictures: what is kept is there, and empty.
        self.settings = self.kept / "terrella" / "settings.json"
        self.settings.parent.mkdir()
        self.settings.write_text("{}", encoding="ascii")
        self.folder = ARTEFACTS / self.id().split(".")[-1]
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir(parents=True)

    def start_at_192_dpi(self, *options, bare=True):
        """A viewer of 800×600 pixels on a display of its own, where letters are twice as large."""
        display = Display()
        self.addCleanup(display.close)
        display.environment.update(self.display.environment | {"DISPLAY": display.environment["DISPLAY"]})
        subprocess.run(
            ["xprop", "-root", "-f", "RESOURCE_MANAGER", "8s", "-set", "RESOURCE_MANAGER", "Xft.dpi:\t192\n"],
            env=display.environment,
            check=True,
        )
        viewer = Viewer(display, self.folder, *options, size=(800, 600), bare=bare)
        self.addCleanup(viewer.close)
        return viewer

    def start(self, *options, size=SIZE, bare=True):
        """`bare`: without the map, whose lines and names would be in the pictures."""
        viewer = Viewer(self.display, self.folder, *options, size=size, bare=bare)
        self.addCleanup(viewer.close)
        return viewer

    def screenshot(self, viewer, name):
        """Presses F12, waits for the file to be whole and keeps it under a name."""
        viewer.key("F12")

        def whole():
            files = list(self.folder.glob("terrella-*.png"))
            return files if files and files[0].read_bytes().endswith(b"IEND\xaeB`\x82") else None

        files = wait_until("the screenshot", whole)
        self.assertEqual(len(files), 1)
        self.assertRegex(files[0].name, r"^terrella-\d{8}-\d{6}\.png$")
        kept = self.folder / f"{name}.png"
        files[0].rename(kept)
        return kept

    def saved_picture(self, viewer, name):
        """The picture that the window saves without its panels, twice the window's size."""
        viewer.key("i")
        viewer.panel("Save picture")
        viewer.settled()
        viewer.key("Return")

        def whole():
            files = list(self.folder.glob("terrella-*.png"))
            return files[0] if files and files[0].read_bytes().endswith(b"IEND\xaeB`\x82") else None

        return wait_until("the picture", whole).rename(self.folder / f"{name}.png")

    def picture(self, viewer, name, shows=lambda picture: True):
        """The screenshot of a window at rest, once it shows what is looked for: events act some frames later."""

        def taken():
            viewer.settled()
            picture = png.read(self.screenshot(viewer, name))
            return picture if shows(picture) else None

        return wait_until(f"the picture {name}", taken)
