"""The examples draw as described, without a display and in a window."""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import textwrap
import time
import unittest

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parent.parent
BUILD = pathlib.Path(os.environ["TERRELLA_BUILD"])
EARTH = BUILD / "data/earth.gpkg"

sys.path[:0] = [str(HERE.parent / "window"), str(HERE.parent / "support")]
from real_window import Display, wait_until  # noqa: E402

MAGENTA = (255, 0, 255)
MARK = """{"type": "Feature", "geometry": {"type": "Point", "coordinates": [0, 0]},
           "properties": {"marker-color": "#ff00ff", "marker-size": "large"}}"""
# Half a pixel for the cursor's hotspot, half for the marker's rim.
HELD_PX = 1.0


class Picture:
    """Pixels of a file or of a display, by ImageMagick."""

    def __init__(self, *command, **options):
        header = subprocess.run([*command, "-depth", "8", "ppm:-"], capture_output=True, check=True, **options).stdout
        kind, size, _, self.rgb = header.split(b"\n", 3)
        assert kind == b"P6"
        self.width, self.height = map(int, size.split())

    def places(self, colour):
        """Columns and rows of the pixels of a colour."""
        wanted, at = bytes(colour), -1
        while (at := self.rgb.find(wanted, at + 1)) >= 0:
            if at % 3 == 0:
                yield at // 3 % self.width, at // 3 // self.width

    def middle_of(self, colour):
        places = list(self.places(colour))
        return tuple(sum(p[axis] for p in places) / len(places) for axis in (0, 1)) if places else None

    def colours(self):
        return len({self.rgb[k : k + 3] for k in range(0, len(self.rgb), 3)})


class ExampleTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="terrella-examples-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def run_example(self, name, *arguments):
        done = subprocess.run([BUILD / "examples" / name, *arguments], capture_output=True, text=True, timeout=120)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return done.stdout

    def open_example(self, name, *arguments):
        """The example in a window on a display of its own; the display."""
        display = Display()
        self.addCleanup(display.close)
        program = subprocess.Popen([BUILD / "examples" / name, *arguments], env=display.environment, stderr=subprocess.DEVNULL)
        self.addCleanup(program.wait)
        self.addCleanup(program.terminate)
        return display

    def look(self, display):
        return Picture("import", "-window", "root", env=display.environment)

    def look_at_rest(self, display, condition):
        """The display's picture once it no longer changes and is as it must be."""

        def settled():
            picture = self.look(display)
            time.sleep(0.3)
            return picture if condition(picture) and picture.rgb == self.look(display).rgb else None

        return wait_until("a picture at rest", settled)


class WithoutWindow(ExampleTest):
    def test_earthquakes(self):
        picture = self.folder / "quakes.png"
        self.run_example("earthquakes", EARTH, SOURCE / "data/points/earthquakes.geojson", picture)
        drawn = Picture("convert", picture)
        self.assertEqual((drawn.width, drawn.height), (1024, 1024))
        red = sum(1 for k in range(0, len(drawn.rgb), 3) if drawn.rgb[k] > 200 and drawn.rgb[k + 2] < 80)
        self.assertGreater(red, 200, "shallow earthquakes are red")

    def test_aircraft(self):
        picture = self.folder / "aircraft.png"
        self.run_example("aircraft", EARTH, BUILD / "data", picture, "0.1")
        drawn = Picture("convert", picture)
        yellow = sum(1 for _ in drawn.places((255, 210, 60)))
        self.assertGreater(yellow, 1000, "aircraft are yellow")

    def test_flight_frames(self):
        self.run_example("flight_frames", EARTH, self.folder, "0.2")
        frames = sorted(self.folder.iterdir())
        self.assertEqual([frame.name for frame in frames], [f"{k:04}.png" for k in range(6)])
        self.assertEqual(len({frame.read_bytes() for frame in frames}), 6, "each frame is another")

    def test_tasks(self):
        picture = self.folder / "tasks.png"
        says = self.run_example("tasks", EARTH, picture)
        self.assertEqual(says, '{"name": "TE 1"}\n', "the aircraft has moved to the middle")
        drawn = Picture("convert", picture)
        self.assertGreater(len(list(drawn.places((255, 255, 0)))), 150, "the application's own triangle")
        self.assertGreater(len(list(drawn.places((230, 60, 50)))), 100, "two markers")

    def test_overview(self):
        file = self.folder / "overview.png"
        self.run_example("overview", EARTH, file)
        drawn = Picture("convert", file)
        self.assertEqual((drawn.width, drawn.height), (640, 360))
        corner = Picture("convert", file, "-crop", "160x90+0+270", "+repage")
        above = Picture("convert", file, "-crop", "160x90+0+180", "+repage")
        self.assertGreater(corner.colours(), 500, "the map has many colours")
        self.assertNotEqual(corner.rgb, above.rgb)


class Tasks(unittest.TestCase):
    """The page about six tasks quotes the code that is built, and counts its lines."""

    def setUp(self):
        self.page = (SOURCE / "apps/examples/TASKS.md").read_text(encoding="utf-8")
        text = (SOURCE / "apps/examples/tasks.cpp").read_text(encoding="utf-8")
        self.code = {name: textwrap.dedent(code)
                     for name, code in re.findall(r"^ *// \[([^]\n]*)\]\n(.*?)^ *// \[end\]$", text, re.MULTILINE | re.DOTALL)}

    def test_quotes(self):
        quoted = re.findall(r"^## (.*?)\n(?:(?!^## ).)*?^```cpp\n(.*?)^```$", self.page, re.MULTILINE | re.DOTALL)
        self.assertEqual({name.lower(): code for name, code in quoted}, self.code)
        self.assertEqual(len(quoted), 6)

    def test_counts(self):
        rows = re.findall(r"^\| (.*?) \| (\d+) \| (.*) \|$", self.page, re.MULTILINE)
        self.assertEqual([name for name, _, _ in rows], list(self.code))
        for name, count, others in rows:
            lines = [line for line in self.code[name].splitlines() if line.strip() and not line.strip().startswith("//")]
            self.assertEqual(int(count), len(lines), name)
            self.assertLessEqual(int(count), min(map(int, re.findall(r"\d+", others))), name)


class InWindow(ExampleTest):
    def test_ten_lines(self):
        display = self.open_example("ten_lines", EARTH)
        first = wait_until("the globe", lambda: (p := self.look(display)).colours() > 1000 and p)
        wait_until("the globe to turn", lambda: self.look(display).rgb != first.rgb)


class InQt(ExampleTest):
    def xdotool(self, display, *arguments):
        subprocess.run(["xdotool", *map(str, arguments)], env=display.environment, check=True, timeout=60)

    def drag(self, display, start, end, steps=6):
        self.xdotool(display, "mousemove", *start)
        self.xdotool(display, "mousedown", 1)
        for k in range(1, steps + 1):
            self.xdotool(display, "mousemove", *(a + (b - a) * k // steps for a, b in zip(start, end)))
            time.sleep(0.05)
        time.sleep(0.6)  # a hand that rests before it lets go does not flick
        self.xdotool(display, "mouseup", 1)

    def assert_marked(self, picture, x, y):
        found = picture.middle_of(MAGENTA)
        self.assertLess(abs(found[0] - x), HELD_PX, found)
        self.assertLess(abs(found[1] - y), HELD_PX, found)

    def test_mouse(self):
        """A grabbed place goes where the hand goes; the wheel zooms to the place under the cursor."""
        mark = self.folder / "mark.geojson"
        mark.write_text(MARK)
        display = self.open_example("qt_globe", EARTH, mark)
        start = self.look_at_rest(display, lambda picture: picture.middle_of(MAGENTA))
        self.assert_marked(start, 399.5, 299.5)
        self.drag(display, (400, 300), (480, 342))
        dragged = self.look_at_rest(display, lambda picture: picture.rgb != start.rgb)
        self.assert_marked(dragged, 479.5, 341.5)
        self.xdotool(display, "click", 4)
        zoomed = self.look_at_rest(display, lambda picture: picture.rgb != dragged.rgb)
        self.assert_marked(zoomed, 479.5, 341.5)


if __name__ == "__main__":
    unittest.main()
