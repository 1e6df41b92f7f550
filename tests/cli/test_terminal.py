"""Text from files and servers reaches a terminal as plain text, never as control sequences."""

import http.server
import json
import os
import re
import sqlite3
import subprocess
import threading

import servers
from program import DONE, PROGRAM, SOURCE, TIME_LIMIT_S, ProgramTest
from test_remote import CAPABILITIES, MATRIX

VIEW = ("--unlit", "--camera", "30,20,6000000", "--size", "64x64")
# Clear the screen, set the title, C1's way to do so, back to the line's start, ring, right to left, a line of its own.
EVIL = "a\x1b[2J\x1b]0;owned\x07\x9b2J\rb\x7f\u202ec\u2066\u2028d\x0be\bf"
FORGED = "terrella: all is well"
EVIL_LINES = f"{EVIL}\n{FORGED}\nx"
# C0 but tab and line end, DEL, C1, line separators, embeddings, overrides and isolates.
ACTS = re.compile("[\0-\x08\x0b-\x1f\x7f-\x9f\u2028\u2029\u202a-\u202e\u2066-\u2069]")


class TerminalTest(ProgramTest):
    def speaks(self, *arguments, codes=(DONE,), shows=True):
        """Runs the program and looks at the bytes that it prints. They hold the name, made harmless."""
        env = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
        env["XDG_CACHE_HOME"] = str(self.folder / "cache")
        done = subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, env=env, capture_output=True,
                              timeout=TIME_LIMIT_S, check=False)
        told = done.stdout + done.stderr
        text = told.decode()  # strictly: bytes that are not UTF-8 may be C1 to a terminal
        self.assertIn(done.returncode, codes, (arguments, told))
        self.assertIsNone(ACTS.search(text), (arguments, told))
        self.assertFalse([line for line in text.splitlines() if line.startswith(FORGED)], (arguments, told))
        if shows:
            self.assertIn("\\u001b", text, arguments)
        return done

    def tile_set(self, folder_name, **description):
        folder = self.folder / folder_name
        servers.write_pyramid(folder, 1)
        said = {"max_level": 0, "root_span_deg": 180, "tile_px": 256, "min_level": 0, "format": "jpg", **description}
        (folder / "tileset.json").write_text(json.dumps(said))
        return folder

    def test_the_names_of_tile_sets(self):
        tiles = self.tile_set("tiles", name=EVIL_LINES, attribution=EVIL_LINES)
        self.speaks("info", tiles)
        self.speaks("render", tiles, "-o", "a.png", *VIEW)
        for command in ("info", tiles, "--json"), ("info", tiles, "--json", "--verify"):
            said = json.loads(self.speaks(*command).stdout)
            self.assertEqual((said["name"], said["attribution"]), (EVIL_LINES, EVIL_LINES))
        picture = self.speaks("render", tiles, "-o", "a.png", "--json", *VIEW)
        self.assertEqual(json.loads(picture.stdout)["attributions"], [EVIL_LINES])
        self.speaks("preload", tiles, "-o", "a.gpkg", shows=False)
        self.speaks("info", "a.gpkg")
        bodies = self.tile_set("bodies", body=EVIL_LINES)
        self.speaks("info", bodies, codes=(1,), shows=False)
        self.speaks("render", bodies, "-o", "a.png", *VIEW, codes=(1,), shows=False)
        self.speaks("info", self.tile_set("fields", **{EVIL_LINES: 1}), codes=(0, 1), shows=False)

    def test_databases(self):
        self.assert_done("cut", SOURCE / "data/earth/blue_marble_4096x2048.jpg", "-o", "a.gpkg", "--quality", "30",
                         "--tile-size", "1024")
        with sqlite3.connect(self.folder / "a.gpkg") as database:
            database.execute("UPDATE gpkg_contents SET identifier = ?, description = ?", (EVIL_LINES, EVIL_LINES))
            database.execute("DROP TABLE terrella_tileset")  # the program's own description goes before the standard's
        database.close()
        self.speaks("info", "a.gpkg")
        self.speaks("info", "a.gpkg", "--json")
        with sqlite3.connect(self.folder / "b.mbtiles") as database:
            database.execute("CREATE TABLE metadata (name TEXT, value TEXT)")
            database.execute("CREATE TABLE tiles (zoom_level INT, tile_column INT, tile_row INT, tile_data BLOB)")
            database.execute("INSERT INTO tiles VALUES (0, 0, 0, ?)", (servers.tile_file(0, 0, 0).read_bytes(),))
            for name in "name", "attribution", "description", "format", "profile", "crs":
                database.execute("INSERT INTO metadata VALUES (?, ?)", (name, EVIL_LINES))
        database.close()
        self.speaks("info", "b.mbtiles", codes=(0, 1), shows=False)

    def test_objects(self):
        feature = {"type": "Feature", "id": EVIL_LINES, "properties": {"name": EVIL_LINES, "model": EVIL_LINES,
                                                                       "marker-color": EVIL_LINES},
                   "geometry": {"type": EVIL_LINES, "coordinates": []}}
        self.write("evil.geojson", json.dumps({"type": "FeatureCollection", "features": [feature]}).encode())
        for command in (("render", "--objects", "evil.geojson", "-o", "a.png", *VIEW),
                        ("preload", servers.TILES[0].parents[2], "--polygon", "evil.geojson", "-o", "b.gpkg"),
                        ("preload", servers.TILES[0].parents[2], "--flight", "evil.geojson", "-o", "b.gpkg")):
            self.speaks(*command, codes=(1, 3), shows=False)

    def test_the_names_of_files(self):
        name = "\x1b[2Jx\u202e\r.gpkg"
        self.speaks("info", name, codes=(1,))
        self.speaks("cut", name, "-o", "a.gpkg", codes=(1,))
        self.speaks("render", name, name, "-o", "a.png", codes=(2,))
        self.speaks(name, codes=(1,))
        (self.folder / "\x1b[2J.jpg").symlink_to(SOURCE / "data/earth/blue_marble_4096x2048.jpg")
        self.speaks("render", "\x1b[2J.jpg", "-o", "\x1b[3J.png", *VIEW)
        self.speaks("cut", "\x1b[2J.jpg", "-o", "\x1b[3J.gpkg", "--quality", "30")
        self.speaks(b"info".decode(), os.fsdecode(b"\x9b2J"), codes=(1,), shows=False)

    def test_servers(self):
        matrices = MATRIX.format(z=0, scale=279541132.0143589, width=2, height=1).replace("512", "256")

        class Evil(http.server.BaseHTTPRequestHandler):
            def do_GET(self):
                if self.path.endswith(".xml"):
                    # XML itself forbids most control characters; those that it lets pass:
                    title = "a\x7f\x9b2J\u202e\u2028b"
                    body = CAPABILITIES.format(address=f"http://{self.headers['Host']}", matrices=matrices)
                    body = body.replace("Marble", title).encode()
                    self.send_response(200, "\x1b[2J\x9b")
                else:
                    body = EVIL.encode()
                    self.send_response(403 if "/0/0/" in self.path else 404, "\x1b[2J\x9b owned")
                    self.send_header("Content-Type", "\x1b[2J")
                    self.send_header("ETag", "\x1b[2J")
                self.send_header("Content-Length", str(len(body)))
                self.end_headers()
                self.wfile.write(body)

            def log_message(self, *_):
                pass

        with http.server.ThreadingHTTPServer(("127.0.0.1", 0), Evil) as server:
            threading.Thread(target=server.serve_forever, daemon=True).start()
            self.addCleanup(server.shutdown)
            address = f"http://127.0.0.1:{server.server_address[1]}"
            self.assertIn(b"\\u202e", self.speaks("info", f"{address}/caps.xml", shows=False).stdout)
            self.speaks("info", f"{address}/caps.xml", "--json", shows=False)
            self.speaks("render", f"{address}/caps.xml", "-o", "a.png", *VIEW, codes=(1,), shows=False)
            self.speaks("preload", f"{address}/caps.xml", "-o", "a.gpkg", "--missing", "m.txt", codes=(3,), shows=False)
            self.assertIsNone(ACTS.search((self.folder / "m.txt").read_text()))
            self.speaks("info", "a.gpkg", shows=False)

    def test_nothing_is_printed_past_the_one_function_that_makes_text_harmless(self):
        # The progress bars move the cursor and print numbers; process.cpp only flushes.
        own = {"console.cpp", "progress.cpp", "preload_progress.cpp", "process.cpp"}
        prints = re.compile(r"fmt::print\((stderr|stdout|\"|format)|std::(cout|cerr|puts|printf|fprintf\(std)")
        for path in sorted((SOURCE / "apps").rglob("*.cpp")):
            if path.name not in own and "examples" not in path.parts:
                self.assertIsNone(prints.search(path.read_text()), f"{path}: print with apps/process/console.h")
