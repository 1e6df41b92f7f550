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
KML = """<kml xmlns="http://www.opengis.net/kml/2.2"><Document><Style id="s"><LineStyle><color>ff0000ff</color>
<width>4</width></LineStyle><PolyStyle><color>7fff00ff</color></PolyStyle></Style>
<Placemark><name>Camp</name><Point><coordinates>-10,25</coordinates></Point></Placemark>
<Placemark><name>Way</name><styleUrl>#s</styleUrl><LineString><coordinates>0,0 20,10 40,5</coordinates></LineString></Placemark>
<Placemark><name>Field</name><styleUrl>#s</styleUrl><Polygon><outerBoundaryIs><LinearRing><coordinates>
10,20 25,20 25,30 10,30 10,20</coordinates></LinearRing></outerBoundaryIs></Polygon></Placemark></Document></kml>"""


class Served(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


class Keyboard:
    """Each step by keys alone."""

    def __init__(self, viewer):
        self.viewer = viewer

    def press(self, *keys):
        for key in keys:
            self.viewer.key(key)
            self.viewer.settled()

    def type(self, text):
        self.viewer.xdotool("type", "--delay", "25", text)
        self.viewer.settled()

    def open(self, key, title):
        self.viewer.key(key)
        self.viewer.panel(title)
        self.viewer.settled()

    def choose_body(self, steps):
        self.open("w", "Body")
        self.press(*["Down" if steps > 0 else "Up"] * abs(steps), "Return")

    def add_from_catalogue(self, text):
        self.open("e", "Add data")
        self.type(text)
        self.press("Down", "Return")

    def open_file(self, file):
        self.open("ctrl+o", "Open")
        self.type(file.name)
        self.press("Return")

    def fade_the_raster(self):
        """The second row of the panel of layers, its opacity some steps down."""
        self.open("l", "Layers")
        self.fade()
        self.press("l")

    def set_time(self):
        self.open("p", "View")
        self.time()
        self.press("p")

    def save_project(self, name):
        self.open("j", "Project")
        self.press("ctrl+a")
        self.type(name)
        self.press("Return")

    def quit(self):
        self.viewer.key("ctrl+q")


class Mouse:
    """Each step by the pointer alone."""

    def __init__(self, viewer):
        self.viewer = viewer


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


if __name__ == "__main__":
    unittest.main()
