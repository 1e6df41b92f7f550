"""Bodies in a real window: each keeps its scene, and a picture of another body asks once."""

import json
import subprocess
import unittest

import pictures
import png
from georeferenced import gdal, pgm
from real_window import PROGRAM, WindowTest, wait_until

MOON = "+proj=longlat +R=1737400 +no_defs"
ROW_X, FIRST_ROW, ROW_STEP = 60, 70, 20  # rows of the list of bodies, pixels from the panel's corner
ORDER = ("earth", "moon", "mars")
BELOW_CREDITS = 60  # rows; a hidden layer is credited as long as its tiles are coming
GLOBE, HERE = (75, 58), (187, 58)  # buttons of the question, pixels from the panel's corner


class Bodies(WindowTest):
    def setUp(self):
        super().setUp()
        self.session = self.kept / "terrella" / "session.terrella"
        self.moon = self.raster("crater.tif", MOON)

    def raster(self, name, crs, bounds=(-180, 90, 180, -90)):
        """A raster of a whole body, or of a part."""
        pgm(self.kept / "base.pgm", 128, 64)
        gdal("gdal_translate", "-q", "-a_srs", crs, "-a_ullr", *bounds, self.kept / "base.pgm", self.folder / name)
        return self.folder / name

    def scene(self):
        """Body and layers of the session."""
        if not self.session.exists():
            return None
        project = json.loads(self.session.read_text(encoding="utf-8"))
        return project["settings"]["body"], [one.get("source", "").split("/")[-1] for one in project["layers"]]

    def shows(self, viewer, body, *layers):
        viewer.settled()
        wait_until(f"{body} with {layers}", lambda: self.scene() == (body, list(layers)))

    def saved(self, viewer, name):
        viewer.settled()
        return png.read(self.saved_picture(viewer, name))

    def look(self, viewer, name):
        viewer.settled()
        viewer.save_grab(self.folder / f"{name}.png")

    def choose(self, viewer, body, by_mouse=False):
        """Chooses a body in the list, which opens at the present one."""
        here = self.scene()[0]
        viewer.key("w")
        left, top, _, _ = viewer.panel("Body")
        viewer.settled()
        if by_mouse:
            return viewer.click(round(left) + ROW_X, round(top) + FIRST_ROW + ROW_STEP * ORDER.index(body))
        steps = ORDER.index(body) - ORDER.index(here)
        keys = ["Down" if steps > 0 else "Up"] * abs(steps)
        return viewer.xdotool("key", "--delay", "120", *keys, "Return")

    def question(self, viewer):
        corner = viewer.panel("Another body")[:2]
        viewer.settled()
        return [round(v) for v in corner]

    def no_question(self, viewer):
        viewer.settled()
        self.assertNotIn("Another body", viewer.layout.panels)

    def turned(self, viewer):
        viewer.drag((300, 240), (220, 260))
        viewer.next_camera()

    def test_each_body_keeps_its_layers_and_its_view(self):
        viewer = self.start(bare=False)
        self.shows(viewer, "earth", "")
        viewer.key("c")  # names on the map stay where they were shown, so that pictures depend on the way there
        viewer.key("u")
        self.turned(viewer)
        earth = self.saved(viewer, "earth")
        viewer.key("w")
        viewer.panel("Body")
        self.look(viewer, "chooser")
        viewer.key("w")
        self.choose(viewer, "moon")
        self.shows(viewer, "moon", "")
        self.look(viewer, "bare_moon")
        viewer.drop(self.moon)
        self.shows(viewer, "moon", "crater.tif")
        self.no_question(viewer)
        viewer.key("g")
        self.turned(viewer)
        before = self.saved(viewer, "moon")
        moon = None
        for turn in range(2):
            self.choose(viewer, "earth", by_mouse=turn == 0)
            self.shows(viewer, "earth", "")
            self.assertTrue(self.saved(viewer, f"earth_{turn}") == earth)
            self.choose(viewer, "moon", by_mouse=turn == 0)
            self.shows(viewer, "moon", "crater.tif")
            again = self.saved(viewer, f"moon_{turn}")
            # Without air the limb's pixels depend on the views before by a level, which no eye sees.
            self.assertEqual(png.changed(again, before), 0)
            moon = moon or again
            self.assertTrue(again == moon)
        self.assertEqual(viewer.quit(), 0)
        viewer = self.start(bare=False)
        self.assertTrue(self.saved(viewer, "moon_restarted") == moon)
        self.choose(viewer, "earth")
        self.shows(viewer, "earth", "")
        self.assertTrue(self.saved(viewer, "earth_restarted") == earth)
        self.assertEqual(viewer.quit(), 0)

    def test_a_picture_of_the_moon_over_the_earth_asks_once(self):
        viewer = self.start(bare=False)
        self.shows(viewer, "earth", "")
        viewer.key("c")
        for _ in range(2):
            viewer.drop(self.moon)
            self.question(viewer)
            self.look(viewer, "question")
            viewer.key("Escape")
            self.no_question(viewer)
        self.shows(viewer, "earth", "")
        viewer.drop(self.moon, self.raster("other.tif", MOON, (-10, 10, 10, -10)))
        self.question(viewer)
        viewer.settled(still_s=1.0)  # both files are read, and the panel has moved for the second one
        left, top = self.question(viewer)
        viewer.click(left + HERE[0], top + HERE[1])
        self.shows(viewer, "earth", "", "crater.tif", "other.tif")
        self.no_question(viewer)
        self.look(viewer, "layer_here")
        here = self.saved(viewer, "here")
        self.assertEqual(viewer.quit(), 0)
        viewer = self.start(bare=False)
        self.shows(viewer, "earth", "", "crater.tif", "other.tif")
        self.no_question(viewer)
        again = self.saved(viewer, "here_restarted")
        self.assertTrue(again[2][BELOW_CREDITS:] == here[2][BELOW_CREDITS:])
        viewer.drop(self.moon)
        self.question(viewer)
        viewer.key("Return")
        self.shows(viewer, "moon", "crater.tif")
        self.assertEqual(viewer.quit(), 0)

    def test_render_draws_a_body_without_pictures(self):
        project = self.folder / "bare.terrella"
        project.write_text('{"terrella": 1, "settings": {"body": "moon"}, "layers": []}', encoding="ascii")
        subprocess.run([PROGRAM, "render", project, "-o", self.folder / "bare.png", "--size", "64x64"], check=True,
                       timeout=60, capture_output=True)
        self.assertEqual(png.read(self.folder / "bare.png")[:2], (64, 64))

    def test_a_picture_named_after_a_body_asks_too(self):
        picture = self.folder / "mars_small.png"
        picture.write_bytes(pictures.png(64, 32, (200, 90, 40)))
        viewer = self.start(bare=False)
        self.shows(viewer, "earth", "")
        viewer.drop(picture)
        self.question(viewer)
        self.look(viewer, "question")
        viewer.key("Return")
        self.shows(viewer, "mars", "mars_small.png")
        self.assertEqual(viewer.quit(), 0)

    def test_a_picture_of_the_earth_over_the_moon_asks_and_goes_home(self):
        earth = self.raster("land.tif", "EPSG:4326")
        viewer = self.start(self.moon, bare=False)
        self.shows(viewer, "moon", "crater.tif")
        viewer.drop(earth)
        left, top = self.question(viewer)
        self.look(viewer, "question")
        viewer.click(left + GLOBE[0], top + GLOBE[1])
        self.shows(viewer, "earth", "", "land.tif")
        self.no_question(viewer)
        self.choose(viewer, "moon")
        self.shows(viewer, "moon", "crater.tif")
        self.assertEqual(viewer.quit(), 0)

    def test_a_body_whose_pictures_are_gone_opens_without_them(self):
        viewer = self.start(self.moon, bare=False)
        self.shows(viewer, "moon", "crater.tif")
        self.choose(viewer, "earth")
        self.shows(viewer, "earth", "")
        self.moon.unlink()
        self.choose(viewer, "moon")
        wait_until("a message", lambda: "message" in viewer.layout.panels)
        viewer.settled()
        session = self.kept / "terrella" / "session-moon.terrella"
        self.assertIn("crater.tif", session.read_text(encoding="utf-8"), "kept until the scene changes")
        viewer.key("g")
        self.shows(viewer, "moon", "")
        self.look(viewer, "gone")
        self.assertEqual(viewer.quit(), 0)
        kept = session.with_name("session-moon.terrella.damaged").read_text(encoding="utf-8")
        self.assertIn("crater.tif", kept)


if __name__ == "__main__":
    unittest.main()
