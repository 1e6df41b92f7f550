"""The second hour with the window, by mouse alone and by keyboard alone: bodies, the catalogue, files, looks, time, a project."""

import functools
import http.server
import json
import subprocess
import threading
import unittest

import pictures
import png
from georeferenced import gdal, pgm
from real_window import PROGRAM, SIZE, WindowTest, wait_until
from test_actions import ACTION_STEP, COLUMNS, FIRST_ACTION, table

GREEN = (30, 200, 60)
BODIES = ["earth", "moon"]
MENU_AT = (450, 330)
# Places of rows, pixels from the panel's corner.
ENTRY = (80, 281)  # after two steps of the wheel
ENTRIES = {"area.tif": 157, "trip.kml": 197}  # under the recent files, which are one more each time
KML = """<kml xmlns="http://www.opengis.net/kml/2.2"><Document><Style id="s"><LineStyle><color>ff0000ff</color>
<width>4</width></LineStyle><PolyStyle><color>7fff00ff</color></PolyStyle></Style>
<Placemark><name>Camp</name><Point><coordinates>-10,25</coordinates></Point></Placemark>
<Placemark><name>Way</name><styleUrl>#s</styleUrl><LineString><coordinates>0,0 20,10 40,5</coordinates></LineString></Placemark>
<Placemark><name>Field</name><styleUrl>#s</styleUrl><Polygon><outerBoundaryIs><LinearRing><coordinates>
10,20 25,20 25,30 10,30 10,20</coordinates></LinearRing></outerBoundaryIs></Polygon></Placemark></Document></kml>"""


class Served(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


class Hands:
    """A viewer, and places of its panels."""

    def __init__(self, viewer):
        self.viewer = viewer

    def corner(self, title):
        self.viewer.panel(title)
        self.viewer.settled()
        return [round(v) for v in self.viewer.panel(title)[:2]]


class Keyboard(Hands):
    """Each step by keys alone."""

    def press(self, *keys):
        for key in keys:
            self.viewer.key(key)
            self.viewer.settled()

    def type(self, text):
        self.viewer.xdotool("type", "--delay", "25", text)
        self.viewer.settled()

    def open(self, key, title):
        self.viewer.key(key)
        self.corner(title)

    def choose_body(self, now, body):
        self.open("w", "Body")
        steps = BODIES.index(body) - BODIES.index(now)
        self.press(*["Down" if steps > 0 else "Up"] * abs(steps), "Return")

    def add_from_catalogue(self):
        self.open("e", "Add data")
        self.type("green")
        self.press("Down", "Return")

    def open_file(self, file):
        self.open("ctrl+o", "Open")
        self.type(file.name)
        self.press("Return")

    def fade_second_layer(self):
        self.open("l", "Layers")
        self.press("Down", "Down", "Right", "space", "Down", "space", *["Left"] * 40, "space", "l")

    def set_time(self):
        self.open("p", "View")
        self.press(*["Down"] * 6, "Return")
        self.type("2026-06-21T18:00Z")
        self.press("Return", "Escape")

    def save_project(self):
        self.open("j", "Project")
        self.press("Return")

    def quit(self):
        self.viewer.key("ctrl+q")


class Mouse(Hands):
    """Each step by the pointer alone."""

    def menu(self, what):
        rows = [row for row, _, mouse in table() if mouse.startswith("menu") and row != "save the view as a bookmark"]
        index, half = rows.index(what), (len(rows) + 1) // 2
        self.viewer.open_menu(*MENU_AT)
        top = self.corner("Menu")[1]
        self.viewer.click(COLUMNS[index // half], top + FIRST_ACTION + ACTION_STEP * (index % half))

    def click(self, title, x, y):
        left, top = self.corner(title)
        self.viewer.click(left + x, top + y)
        self.viewer.settled()

    def close(self, title):
        self.corner(title)
        right, top = self.viewer.panel(title)[2], self.viewer.panel(title)[1]
        self.viewer.click(round(right) - 10, round(top) + 10)
        self.viewer.settled()

    def choose_body(self, now, body):
        self.menu("body: Earth, Moon, planets")
        self.click("Body", 60, 70 + 20 * BODIES.index(body))

    def add_from_catalogue(self):
        self.menu("add data: public pictures by body and theme")
        left, top = self.corner("Add data")
        self.viewer.wheel(left + ENTRY[0], top + ENTRY[1], -2)
        self.click("Add data", *ENTRY)

    def open_file(self, file):
        self.menu("open a file, folder or address")
        self.click("Open", 60, ENTRIES[file.name])
        self.viewer.click(self.corner("Open")[0] + 33, round(self.viewer.panel("Open")[3]) - 18)

    def fade_second_layer(self):
        self.menu("layers: show, opacity, order, remove")
        self.click("Layers", 80, 90)
        left, top = self.corner("Layers")
        self.viewer.drag((left + 130, top + 116), (left + 80, top + 116))
        self.close("Layers")

    def set_time(self):
        self.menu("view settings")
        self.click("View", 22, 281)
        left, top = self.corner("View")
        self.viewer.drag((left + 60, top + 307), (left + 120, top + 307))
        self.close("View")

    def save_project(self):
        self.menu("project: save, restore at the next start, new")
        self.click("Project", 27, 64)

    def quit(self):
        self.menu("quit")


class SecondHour(WindowTest):
    def setUp(self):
        super().setUp()
        self.session = self.kept / "terrella" / "session.terrella"
        served = self.kept / "served"
        served.mkdir()
        server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Served, directory=served))
        threading.Thread(target=server.serve_forever, daemon=True).start()
        self.addCleanup(server.server_close)
        self.addCleanup(server.shutdown)
        picture = self.kept / "moon.png"
        picture.write_bytes(pictures.png(256, 128, GREEN))
        subprocess.run([PROGRAM, "cut", picture, "-o", served / "moon", "--tile-size", "64"], check=True,
                       capture_output=True)
        said = json.loads((served / "moon" / "tileset.json").read_text())
        entry = {"title": "Green Moon", "body": "moon", "theme": "Test", "attribution": "A local server",
                 "licence": "None", "source": f"http://127.0.0.1:{server.server_port}/moon/{{z}}/{{x}}/{{y}}.{said['format']}",
                 "max-level": said["max_level"], "root-span": said["root_span_deg"], "tile-size": said["tile_px"]}
        (self.kept / "terrella" / "catalogue.json").write_text(json.dumps({"catalogue": 1, "entries": [entry]}),
                                                               encoding="ascii")
        pgm(self.kept / "base.pgm", 128, 64)
        self.raster = self.folder / "area.tif"
        gdal("gdal_translate", "-q", "-a_srs", "EPSG:4326", "-a_ullr", -60, 50, 0, 10, self.kept / "base.pgm", self.raster)
        self.kml = self.folder / "trip.kml"
        self.kml.write_text(KML, encoding="ascii")

    def scene(self):
        """Body and layers of the session: kind, name and opacity."""
        if not self.session.exists():
            return None
        project = json.loads(self.session.read_text(encoding="utf-8"))
        return project["settings"]["body"], [(one["kind"], one.get("title") or one.get("source", "").split("/")[-1])
                                             for one in project["layers"]]

    def shows(self, viewer, body, *layers):
        viewer.settled()
        wait_until(f"{body} with {layers}", lambda: self.scene() == (body, list(layers)))

    def rendered(self, project):
        file = self.folder / "rendered.png"
        subprocess.run([PROGRAM, "render", project, "-o", file, "--size", f"{2 * SIZE[0]}x{2 * SIZE[1]}", "--legend",
                        "--credits"], check=True, timeout=300, env=self.display.environment, cwd="/", capture_output=True)
        return png.read(file)

    def assert_same(self, one, other, what):
        """A few pixels at the limb depend by a level on the views before, which no eye sees; most runs have none."""
        self.assertEqual(one[:2], other[:2])
        self.assertLessEqual(png.largest_difference(one, other), 2, what)

    def walk(self, hands):
        earth = ("imagery", "")
        viewer = self.start(bare=False)
        hand = hands(viewer)
        self.shows(viewer, "earth", earth)
        hand.choose_body("earth", "moon")
        self.shows(viewer, "moon", earth)
        hand.add_from_catalogue()
        self.shows(viewer, "moon", ("imagery", "Green Moon"))
        hand.choose_body("moon", "earth")
        self.shows(viewer, "earth", earth)
        hand.open_file(self.raster)
        self.shows(viewer, "earth", earth, ("imagery", "area.tif"))
        hand.open_file(self.kml)
        shown = (earth, ("imagery", "area.tif"), ("objects", "trip.kml"))
        self.shows(viewer, "earth", *shown)
        hand.fade_second_layer()
        hand.set_time()
        viewer.settled()
        kept = wait_until("opacity and time", lambda: self.arranged(self.session))
        hand.save_project()
        project = self.folder / "globe.terrella"
        wait_until("the project", project.exists)
        self.assertEqual(self.arranged(project), kept)
        before = png.read(self.saved_picture(viewer, "before"))
        viewer.settled()
        viewer.save_grab(self.folder / "window.png")
        hand.quit()
        self.assertEqual(viewer.program.wait(timeout=30), 0)
        viewer = self.start(bare=False)
        self.shows(viewer, "earth", *shown)
        self.assertEqual(self.arranged(self.session), kept)
        self.assert_same(png.read(self.saved_picture(viewer, "again")), before, "another picture after a restart")
        hands(viewer).quit()
        self.assertEqual(viewer.program.wait(timeout=30), 0)
        self.assert_same(self.rendered(project), before, "another picture by terrella render")
        viewer = self.start(str(project), bare=False)
        self.shows(viewer, "earth", *shown)
        self.assert_same(png.read(self.saved_picture(viewer, "opened")), before, "another picture of the project")
        hands(viewer).choose_body("earth", "moon")
        self.shows(viewer, "moon", ("imagery", "Green Moon"))
        hands(viewer).quit()
        self.assertEqual(viewer.program.wait(timeout=30), 0)

    def arranged(self, file):
        """Opacity of the raster and time; None before both are set."""
        project = json.loads(file.read_text(encoding="utf-8"))
        opacity, time = project["layers"][1].get("opacity", 1.0), project["settings"].get("time")
        return (opacity, time) if 0.1 < opacity < 0.9 and time else None

    def test_by_keyboard_alone(self):
        self.walk(Keyboard)

    def test_by_mouse_alone(self):
        self.walk(Mouse)


if __name__ == "__main__":
    unittest.main()
