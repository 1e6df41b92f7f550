"""The catalogue in a real window: a click on an entry shows a picture of a local server, on the globe of its body."""

import functools
import http.server
import json
import subprocess
import threading
import unittest

import pictures
import png
from real_window import PROGRAM, Display, Viewer, WindowTest, wait_until

RED, GREEN = (220, 40, 30), (30, 200, 60)
FIRST_ENTRY = (80, 108)  # the first row, pixels from the panel's corner


class Served(http.server.SimpleHTTPRequestHandler):
    asked = []

    def do_GET(self):
        self.asked.append(self.path)
        super().do_GET()

    def log_message(self, *_):
        pass


class Catalogue(WindowTest):
    def setUp(self):
        super().setUp()
        self.session = self.kept / "terrella" / "session.terrella"
        served = self.kept / "served"
        served.mkdir()
        Served.asked = []
        handler = functools.partial(Served, directory=served)
        server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
        threading.Thread(target=server.serve_forever, daemon=True).start()
        self.addCleanup(server.server_close)
        self.addCleanup(server.shutdown)
        self.address = f"http://127.0.0.1:{server.server_port}"
        self.write([self.entry(served, "Red of the Earth", "earth", RED), self.entry(served, "Green Moon", "moon", GREEN)])

    def entry(self, served, title, body, colour):
        picture = self.kept / f"{body}.png"
        picture.write_bytes(pictures.png(256, 128, colour))
        subprocess.run([PROGRAM, "cut", picture, "-o", served / body, "--tile-size", "64"], check=True,
                       capture_output=True)
        said = json.loads((served / body / "tileset.json").read_text())
        return {"title": title, "body": body, "theme": "Test", "attribution": "A local server", "licence": "None",
                "source": f"{self.address}/{body}/{{z}}/{{x}}/{{y}}.{said['format']}", "max-level": said["max_level"],
                "root-span": said["root_span_deg"], "tile-size": said["tile_px"]}

    def write(self, entries):
        file = self.kept / "terrella" / "catalogue.json"
        file.write_text(json.dumps({"catalogue": 1, "entries": entries}), encoding="ascii")

    def scene(self):
        """Body and titles of the layers of the session."""
        if not self.session.exists():
            return None
        project = json.loads(self.session.read_text(encoding="utf-8"))
        return project["settings"]["body"], [one.get("title", "") for one in project["layers"]]

    def shows(self, viewer, body, *titles):
        viewer.settled()
        wait_until(f"{body} with {titles}", lambda: self.scene() == (body, list(titles)))

    def middle(self, viewer, name):
        viewer.settled()
        picture = png.read(self.saved_picture(viewer, name))
        return png.pixel(picture, picture[0] // 2, picture[1] // 2)

    def is_like(self, pixel, colour):
        strong, weak = max(range(3), key=colour.__getitem__), min(range(3), key=colour.__getitem__)
        return pixel[strong] > 90 and pixel[weak] < 0.6 * pixel[strong]

    def open_list(self, viewer, text=""):
        viewer.key("e")
        corner = viewer.panel("Add data")
        viewer.settled()
        if text:
            viewer.xdotool("type", "--delay", "25", text)
        viewer.settled()
        return [round(v) for v in corner[:2]]

    def faults(self, viewer):
        return viewer.layout.faults(*viewer.size)

    def test_a_click_adds_an_entry_and_enter_goes_to_its_body(self):
        viewer = self.start(bare=False)
        self.shows(viewer, "earth", "")
        left, top = self.open_list(viewer, "red of")
        viewer.save_grab(self.folder / "filtered.png")
        self.assertEqual(Served.asked, [], "nothing is asked before a click")
        viewer.click(left + FIRST_ENTRY[0], top + FIRST_ENTRY[1])
        self.shows(viewer, "earth", "", "Red of the Earth")
        self.assertTrue(Served.asked)
        self.assertTrue(self.is_like(self.middle(viewer, "earth"), RED))
        self.open_list(viewer, "local server")
        viewer.xdotool("key", "--delay", "120", "Down", "Return")
        self.shows(viewer, "moon", "Green Moon")
        moon = self.middle(viewer, "moon")
        self.assertTrue(self.is_like(moon, GREEN), moon)
        viewer.key("l")
        viewer.panel("Layers")
        viewer.settled()
        viewer.save_grab(self.folder / "layers.png")
        viewer.key("l")
        self.assertEqual(viewer.quit(), 0)
        viewer = self.start("--offline", bare=False)
        self.shows(viewer, "moon", "Green Moon")
        self.assertEqual(self.middle(viewer, "again"), moon)
        self.open_list(viewer)
        viewer.save_grab(self.folder / "offline.png")
        wait_until("no message", lambda: "message" not in viewer.layout.panels)
        viewer.xdotool("type", "--delay", "25", "snow cover")
        viewer.settled()
        viewer.key("Return")  # no cache has it
        self.shows(viewer, "earth", "", "Red of the Earth")
        viewer.panel("message")
        viewer.save_grab(self.folder / "not_in_a_cache.png")
        self.assertEqual(viewer.quit(closing=1), 0)

    def test_the_included_heights_return_without_a_path(self):
        viewer = self.start(bare=False)
        left, top = self.open_list(viewer, "included")
        viewer.click(left + FIRST_ENTRY[0], top + FIRST_ENTRY[1])
        for closing in (1, 0):
            wait_until("heights", lambda: self.session.exists() and
                       json.loads(self.session.read_text())["layers"] == [{"kind": "heights"}, {"kind": "imagery"}])
            viewer.settled()
            self.assertEqual(viewer.quit(closing), 0)
            viewer = self.start(bare=False)

    def test_a_faulty_entry_is_named_and_the_others_are_listed(self):
        self.write([{"title": "Nameless", "body": "moonn"}])
        viewer = self.start(bare=False)
        viewer.settled()
        self.open_list(viewer)
        viewer.save_grab(self.folder / "faulty.png")
        self.assertEqual(self.faults(viewer), [])
        self.assertIn("message", viewer.layout.panels)
        self.assertEqual(viewer.quit(closing=2), 0, "the fault and the panel")

    def test_the_lists_fit_two_sizes_of_window(self):
        for size in ((640, 480), (1280, 800)):
            viewer = self.start_in(size)
            for key, name, title in (("e", "catalogue", "Add data"), ("w", "bodies", "Body")):
                viewer.key(key)
                viewer.panel(title)
                viewer.settled()
                viewer.save_grab(self.folder / f"{name}_{size[0]}.png")
                self.assertEqual(self.faults(viewer), [])
                viewer.key("Escape")
                viewer.settled()
            viewer.open_menu(size[0] * 2 // 3, size[1] * 2 // 3)
            viewer.save_grab(self.folder / f"menu_{size[0]}.png")
            viewer.key("Escape")
            viewer.key("F1")
            viewer.settled()
            viewer.save_grab(self.folder / f"help_{size[0]}.png")
            viewer.close()

    def start_in(self, size):
        display = Display("x".join(map(str, size)))
        self.addCleanup(display.close)
        display.environment.update(self.display.environment | {"DISPLAY": display.environment["DISPLAY"]})
        viewer = Viewer(display, self.folder, size=size, bare=False)
        self.addCleanup(viewer.close)
        return viewer


if __name__ == "__main__":
    unittest.main()
