"""The Open dialog by keyboard and by mouse, recent files, and time that plays."""

import json
import time
import unittest

import png
from real_window import WindowTest, wait_until
from test_panels import PLACES, write_png

SIZE = (640, 480)
ROW = 20  # pixels of a row in the dialog's lists
FIRST_ROW = 150  # first row of the folder, without recent files: "../"
GROUND = (SIZE[0] // 2, SIZE[1] - 110)  # under the dialog


class Open(WindowTest):
    def setUp(self):
        super().setUp()
        self.data = self.folder / "data"
        (self.data / "pictures").mkdir(parents=True)
        write_png(self.data / "pictures" / "red.png", 512, 256, (255, 0, 0))
        (self.data / "places.geojson").write_text(json.dumps(PLACES), encoding="ascii")
        (self.data / "notes.doc").write_text("nothing to show", encoding="ascii")

    def type(self, viewer, text):
        viewer.xdotool("type", "--delay", "25", text)

    def recent(self):
        file = self.kept / "terrella" / "recent.json"
        return json.loads(file.read_text(encoding="utf-8"))["recent"] if file.exists() else []

    def test_by_keyboard_twice(self):
        viewer = self.start("--camera", "-40,170,9000000", size=SIZE)
        places = str(self.data / "places.geojson")
        for turn in range(2):
            viewer.key("ctrl+o")
            self.type(viewer, f"{self.data}/pla")  # the start of a name is enough
            time.sleep(0.5)
            self.screenshot(viewer, f"typed_{turn}")
            viewer.key("Return")
            self.assertAlmostEqual(viewer.next_camera().lat, 46.0, delta=0.1)
            self.assertEqual(self.recent(), [places])
            viewer.key("Home")
            viewer.next_camera()
        viewer.key("ctrl+o")
        viewer.key("ctrl+o")
        viewer.key("Right")
        self.assertNotEqual(viewer.next_camera().lon, 8.0, "the dialog is closed, and the keyboard is the globe's")

    def test_down_and_enter_open_the_recent_file(self):
        viewer = self.start("--camera", "-40,170,9000000", size=SIZE)
        viewer.drop(self.data / "places.geojson")
        viewer.next_camera()
        viewer.key("Home")
        viewer.next_camera()
        viewer.key("ctrl+o")
        time.sleep(0.5)
        viewer.key("Down")
        time.sleep(0.3)
        self.screenshot(viewer, "recent")
        viewer.key("Return")
        self.assertAlmostEqual(viewer.next_camera().lat, 46.0, delta=0.1)

    def test_files_of_the_command_line_are_recent(self):
        self.start("data/pictures/red.png", "--objects", "data/places.geojson", "--unlit", size=SIZE)
        self.assertEqual(self.recent(),
                         [str((self.data / name).resolve()) for name in ("pictures/red.png", "places.geojson")])

    def test_by_mouse_a_folder_and_a_picture(self):
        viewer = self.start("--camera", "20,10,12000000", "--unlit", size=SIZE)
        viewer.key("ctrl+o")
        time.sleep(0.7)
        self.screenshot(viewer, "folder")
        viewer.double_click(SIZE[0] // 2, FIRST_ROW + ROW)  # data/
        time.sleep(0.7)
        self.screenshot(viewer, "data")
        viewer.double_click(SIZE[0] // 2, FIRST_ROW + ROW)  # pictures/
        time.sleep(0.7)
        self.screenshot(viewer, "pictures")
        viewer.double_click(SIZE[0] // 2, FIRST_ROW + ROW)  # red.png
        wait_until("the picture", lambda: png.pixel(png.read(self.screenshot(viewer, "opened")), *GROUND)[0] > 240)
        self.assertEqual(self.recent(), [str(self.data / "pictures" / "red.png")])

    def test_a_set_with_tiles_in_a_part_of_the_planet_is_flown_to(self):
        tiles = self.folder / "tiles"
        (tiles / "4/24").mkdir(parents=True)
        (tiles / "tileset.json").write_text(json.dumps(
            {"root_span_deg": 180, "tile_px": 64, "max_level": 4, "format": "png"}), encoding="ascii")
        write_png(tiles / "4/24/4.png", 64, 64, (40, 90, 160))  # 90 to 101.25 degrees east, 33.75 to 45 north
        for _ in range(2):
            camera = self.start(tiles, size=SIZE).camera
            self.assertAlmostEqual(camera.lat, 39.4, delta=0.1)
            self.assertAlmostEqual(camera.lon, 95.6, delta=0.1)

    def test_memory_that_the_driver_does_not_give_is_said(self):
        for options, said in ((), False), (("--memory", "65536"), True):
            viewer = self.start(*options, size=SIZE)

            def has_message():
                return any("message" in layout.panels for layout in viewer.layouts)

            if said:
                wait_until("the message", has_message)
            else:
                self.assertFalse(has_message())

    def test_what_is_not_there_is_said_in_the_window(self):
        viewer = self.start("--camera", "20,10,12000000", size=SIZE)
        before = self.picture(viewer, "before")
        for turn in range(2):
            viewer.key("ctrl+o")
            self.type(viewer, "/nowhere/moon.tif")
            viewer.key("Return")
            time.sleep(0.5)
            self.screenshot(viewer, f"missing_{turn}")
            viewer.key("Escape")
            time.sleep(0.3)
        viewer.key("ctrl+o")
        self.type(viewer, str(self.data / "notes.doc"))
        viewer.key("Return")  # a file of another kind: the message names it
        wait_until("the message", lambda: png.changed(before, png.read(self.screenshot(viewer, "another_kind"))) > 3000)
        self.assertEqual(self.recent(), [])
        self.assertIsNone(viewer.program.poll())

    def test_time_plays_and_stops_twice(self):
        viewer = self.start("--camera", "0,0,12000000", "--time", "2026-03-20T17:00Z", size=SIZE)
        middle = (SIZE[0] // 2 + 30, SIZE[1] // 2)

        def light(name):
            return sum(png.pixel(png.read(self.screenshot(viewer, name)), *middle))

        day = light("day")
        viewer.key("t")  # 600 times as fast: night falls within half a minute
        wait_until("the night", lambda: light("dusk") < 0.5 * day)
        viewer.key("t")
        time.sleep(1.0)
        viewer.xdotool("mousemove", "799", "599")
        stopped = png.read(self.screenshot(viewer, "stopped"))
        time.sleep(6.0)  # the message of the pause is gone
        later = png.read(self.screenshot(viewer, "later"))
        globe = [(x, y) for x in range(220, 420, 5) for y in range(140, 330, 5)]
        self.assertEqual([png.pixel(stopped, *at) for at in globe], [png.pixel(later, *at) for at in globe])
        viewer.key("t")

        def moved():
            shot = png.read(self.screenshot(viewer, "again"))
            return sum(png.pixel(shot, *at) != png.pixel(later, *at) for at in globe) > 100

        wait_until("the shadow to move on", moved)

    def test_frame_times_come_and_go(self):
        viewer = self.start("--camera", "20,10,12000000", size=SIZE)
        corner = [(x, y) for x in range(480, 620, 4) for y in range(340, 420, 4)]

        def seen(name):
            time.sleep(0.7)
            shot = png.read(self.screenshot(viewer, name))
            return [png.pixel(shot, *at) for at in corner]

        plain = seen("plain")
        for turn in range(2):
            viewer.key("F3")
            self.assertNotEqual(seen(f"figures_{turn}"), plain)
            viewer.key("F3")
            self.assertEqual(seen(f"without_{turn}"), plain)


if __name__ == "__main__":
    unittest.main()
