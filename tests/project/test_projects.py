"""Sessions and projects: what the window shows survives a restart, and a project is the same picture everywhere."""

import json
import os
import subprocess
import unittest
import zipfile
from pathlib import Path

import pictures
import png
from real_window import PROGRAM, SIZE, WindowTest, wait_until

TEMPERATURE = Path(os.environ["TERRELLA_SOURCE"]) / "data/ocean/sea_surface_temperature.tif"
SQUARE = {"type": "FeatureCollection", "features": [
    {"type": "Feature", "properties": {"fill": "#ff0000", "title": "Square", "size": 7},
     "geometry": {"type": "Polygon", "coordinates": [[[-50, 10], [-30, 10], [-30, 30], [-50, 30], [-50, 10]]]}}]}


CLASSES = {"fill": ["step", ["get", "size"], "#440154", 5, "#fde725"]}
MARK = {"type": "FeatureCollection", "features": [
    {"type": "Feature", "properties": {"name": "Here", "marker-color": "#00ff00"},
     "geometry": {"type": "Point", "coordinates": [-25, 20]}}]}


class Projects(WindowTest):
    def setUp(self):
        super().setUp()
        self.square = self.folder / "square.geojson"
        self.square.write_text(json.dumps(SQUARE), encoding="ascii")
        self.session = self.kept / "terrella" / "session.terrella"

    def layers(self, file):
        """The layers of a project: kind, name of the file, and opacity."""
        project = json.loads(file.read_text(encoding="utf-8")) if file.exists() else {"layers": []}
        return [(one["kind"], Path(one.get("source", "")).name, one.get("opacity", 1)) for one in project["layers"]]

    def camera(self):
        return json.loads(self.session.read_text(encoding="utf-8"))["settings"]["camera"]

    def kept_layers(self, viewer, count):
        """The layers of the session, once there are so many."""
        viewer.settled()
        return wait_until(f"{count} layers in the session",
                          lambda: len(self.layers(self.session)) == count and self.layers(self.session))

    def render(self, project, name):
        """The same project by `terrella render`, as large as saved_picture()."""
        file = self.folder / f"{name}.png"
        subprocess.run([PROGRAM, "render", project, "-o", file, "--size", f"{2 * SIZE[0]}x{2 * SIZE[1]}", "--legend",
                        "--credits"], check=True, timeout=300, env=self.display.environment, cwd="/",
                       capture_output=True)
        return png.read(file)

    def press(self, viewer, *keys):
        for key in keys:
            viewer.key(key)
            viewer.settled()

    def open_file(self, viewer, path):
        viewer.key("ctrl+o")
        viewer.panel("Open")
        viewer.xdotool("type", "--delay", "25", str(path))
        viewer.settled()
        viewer.key("Return")

    def arrange(self, viewer):
        """Layers of numbers and of an area, a graticule, a translucent surface, a place."""
        for k, file in enumerate((TEMPERATURE, self.square)):
            self.open_file(viewer, file)
            self.kept_layers(viewer, 2 + k)
        viewer.key("g")
        viewer.key("u")
        viewer.drag((300, 240), (220, 260))
        viewer.next_camera()
        viewer.settled()

    def test_what_was_open_survives_a_restart_twice(self):
        viewer = self.start(bare=False)
        self.arrange(viewer)
        before = png.read(self.saved_picture(viewer, "before"))
        self.assertEqual(viewer.quit(), 0)
        camera = self.camera()
        self.assertEqual(self.layers(self.session), [("imagery", "", 1), ("imagery", TEMPERATURE.name, 1),
                                                     ("objects", "square.geojson", 1)])
        for turn in range(2):
            viewer = self.start(bare=False)
            self.assertEqual(png.read(self.saved_picture(viewer, f"after_{turn}")), before)
            self.assertEqual(viewer.quit(), 0)
            self.assertEqual(self.camera(), camera)
        self.assertEqual(self.render(self.session, "rendered"), before)

    def test_a_named_scene_is_no_session(self):
        viewer = self.start(bare=False)
        self.arrange(viewer)
        self.assertEqual(viewer.quit(), 0)
        viewer = self.start("--camera", "0,0,9000000", bare=False)
        self.assertEqual(self.kept_layers(viewer, 1), [("imagery", "", 1)])

    def test_a_project_is_saved_left_and_opened_twice(self):
        viewer = self.start("--camera", "20,-40,9000000", bare=False)
        self.open_file(viewer, self.square)
        self.kept_layers(viewer, 2)
        viewer.key("j")
        viewer.panel("Project")
        viewer.key("ctrl+a")
        viewer.xdotool("type", "--delay", "25", "trip")
        viewer.settled()
        self.screenshot(viewer, "panel")
        viewer.key("Return")
        project = self.folder / "trip.terrella"
        wait_until("the project", project.exists)
        self.assertEqual(self.layers(project), [("imagery", "", 1), ("objects", "square.geojson", 1)])
        source = json.loads(project.read_text(encoding="utf-8"))["layers"][1]["source"]
        self.assertEqual(source, "square.geojson", "seen from the folder of the project")
        before = png.read(self.saved_picture(viewer, "before"))
        for turn in range(2):
            viewer.key("j")
            panel = viewer.panel("Project")
            viewer.settled()
            self.screenshot(viewer, f"panel_{turn}")
            self.press(viewer, "Down", "Right", "Return")
            self.kept_layers(viewer, 1)
            self.open_file(viewer, project)
            self.kept_layers(viewer, 2)
            viewer.settled()
            self.assertEqual(png.read(self.saved_picture(viewer, f"opened_{turn}")), before)
        self.assertEqual(viewer.quit(), 0)
        moved = self.folder / "elsewhere"
        moved.mkdir()
        for file in (project, self.square):
            file.rename(moved / file.name)
        self.assertEqual(self.render(moved / project.name, "moved"), before)

    def test_classes_and_drawings_are_in_the_project(self):
        project = self.folder / "classes.terrella"
        project.write_text(json.dumps({
            "terrella": 1, "settings": {"camera": "20,-40,9000000", "map": "off"}, "drawings": MARK,
            "layers": [{"kind": "imagery"}, {"kind": "objects", "source": "square.geojson", "classes": CLASSES}]}),
            encoding="ascii")
        picture = self.render(project, "classes")
        middle = png.pixel(picture, SIZE[0], SIZE[1])  # (253, 231, 37), as translucent as areas are, through the air
        self.assertGreater(min(middle[:2]), 130)
        self.assertLess(middle[2], 110)
        for turn in range(2):
            viewer = self.start(str(project), bare=False)
            shown = self.kept_layers(viewer, 2)
            self.assertEqual(shown, [("imagery", "", 1), ("objects", "square.geojson", 1)])
            kept = json.loads(self.session.read_text(encoding="utf-8"))["layers"][1]["classes"]
            self.assertEqual(kept, CLASSES)
            # The limb's pixels may differ by a level or two, which no eye sees.
            self.assertEqual(png.changed(png.read(self.saved_picture(viewer, f"window_{turn}")), picture), 0)
            self.assertEqual(viewer.quit(), 0)
            marks = json.loads((self.kept / "terrella" / "drawings.geojson").read_text(encoding="utf-8"))
            self.assertEqual([one["properties"]["title"] for one in marks["features"]], ["Here"])

    def test_a_kmz_file_keeps_its_pictures_and_its_places(self):
        kmz = self.folder / "trip.kmz"
        with zipfile.ZipFile(kmz, "w") as file:
            file.writestr("doc.kml", '<kml xmlns="http://www.opengis.net/kml/2.2"><Document><Placemark><name>Here</name><Point><coordinates>'
                          "-25,20</coordinates></Point></Placemark><GroundOverlay><Icon><href>p.png</href></Icon><LatLonBox><north>30</north>"
                          "<south>10</south><east>-30</east><west>-50</west><rotation>20</rotation></LatLonBox></GroundOverlay>"
                          "</Document></kml>")
            file.writestr("p.png", pictures.png(32, 32, (250, 200, 0)))
        viewer = self.start("--camera", "20,-40,9000000", bare=False)
        self.open_file(viewer, kmz)
        expected = [("imagery", "", 1), ("imagery", "trip.kmz", 1), ("objects", "trip.kmz", 1)]
        self.assertEqual(self.kept_layers(viewer, 3), expected)
        before = png.read(self.saved_picture(viewer, "before"))
        self.assertEqual(viewer.quit(), 0)
        middle = png.pixel(before, SIZE[0], SIZE[1])
        self.assertGreater(min(middle[:2]), 100, "the picture, by day")
        self.assertLess(middle[2], 60)
        viewer = self.start(bare=False)
        self.assertEqual(self.kept_layers(viewer, 3), expected)
        self.assertEqual(png.read(self.saved_picture(viewer, "after")), before)
        self.assertEqual(viewer.quit(), 0)

    def test_a_missing_file_is_named_and_the_rest_opens(self):
        viewer = self.start(bare=False)
        self.arrange(viewer)
        self.assertEqual(viewer.quit(), 0)
        self.square.unlink()
        viewer = self.start(bare=False)
        self.assertEqual(self.kept_layers(viewer, 2), [("imagery", "", 1), ("imagery", TEMPERATURE.name, 1)])
        self.screenshot(viewer, "missing")
        self.assertEqual(viewer.quit(), 0)
        self.assertIn("square.geojson", viewer.program.stderr.read())

    def test_a_session_that_cannot_be_opened_gives_way_to_the_earth(self):
        self.session.write_text(json.dumps({"terrella": 1, "settings": {"body": "mars"}, "layers": [
            {"kind": "imagery", "source": "/gone.tif"}]}), encoding="ascii")
        viewer = self.start(bare=False)
        self.assertEqual(self.kept_layers(viewer, 1), [("imagery", "", 1)])
        self.assertEqual(json.loads(self.session.read_text(encoding="utf-8"))["settings"]["body"], "earth")
        self.screenshot(viewer, "given_way")
        self.assertEqual(viewer.quit(), 0)
        self.assertIn("/gone.tif", viewer.program.stderr.read())

    def test_a_damaged_session_is_kept_under_another_name(self):
        self.session.write_text('{"terrella": 1, "layers": [{"kind": "nothing"}]}', encoding="ascii")
        viewer = self.start(bare=False)
        self.kept_layers(viewer, 1)
        self.screenshot(viewer, "damaged")
        self.assertEqual(viewer.quit(), 0)
        damaged = self.session.with_name("session.terrella.damaged")
        self.assertIn("nothing", damaged.read_text(encoding="ascii"))

    def test_the_box_turns_it_off(self):
        viewer = self.start(bare=False)
        viewer.key("j")
        viewer.panel("Project")
        viewer.settled()
        self.press(viewer, "Down", "Down", "space", "Escape")
        self.open_file(viewer, self.square)
        viewer.settled()
        self.assertEqual(viewer.quit(), 0)
        self.assertFalse(json.loads(self.settings.read_text(encoding="utf-8"))["restore"])
        kept = self.layers(self.session)
        viewer = self.start(bare=False)
        viewer.settled()
        self.assertEqual(viewer.quit(), 0)
        self.assertEqual(self.layers(self.session), kept, "nothing is written any more")


if __name__ == "__main__":
    unittest.main()
