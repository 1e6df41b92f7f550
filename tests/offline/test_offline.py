"""The view's tiles of a remote layer are kept for offline use: estimate, start, pause, resume, finish."""

import contextlib
import http.server
import json
import os
import signal
import sqlite3
import subprocess
import sys
import tempfile
import threading
import unittest
from pathlib import Path

from real_window import PROGRAM, WindowTest, wait_until

sys.path.insert(0, str(Path(os.environ["TERRELLA_SOURCE"]) / "tests/preload"))
import servers  # noqa: E402

MAX_LEVEL = 7
FINE = 5  # levels from here on are held back
ROW, KEEP = (90, 65), (166, 194)  # in the panel of layers
VIEW, START, PAUSE, CANCEL = (60, 78), (32, 165), (40, 84), (100, 84)  # in the panel


class Handler(http.server.BaseHTTPRequestHandler):
    """Any tile of the planet; fine ones only while the gate is open."""

    protocol_version = "HTTP/1.1"

    def log_message(self, *_):
        pass

    def do_GET(self):
        place = tuple(map(int, self.path.removesuffix(".jpg").strip("/").split("/")))
        self.server.asked.append(place)
        if place[0] >= FINE:
            self.server.gate.wait()
        with contextlib.suppress(OSError):
            body = servers.tile_file(*place).read_bytes()
            self.send_response(200)
            self.send_header("Content-Type", "image/jpeg")
            self.send_header("Content-Length", str(len(body)))
            self.end_headers()
            self.wfile.write(body)


def temporary_files():
    return {path for path in Path(tempfile.gettempdir()).glob("terrella-??????/*") if path.is_file()}


def catches(process, number):
    """The program's handler serves one signal."""
    caught = Path(f"/proc/{process}/status").read_text().split("SigCgt:")[1].split()[0]
    return int(caught, 16) >> (number - 1) & 1 == 1


def has_ended(process):
    try:
        return Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[0] == "Z"
    except FileNotFoundError:
        return True


class Offline(WindowTest):
    def setUp(self):
        super().setUp()
        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.server.daemon_threads = True
        self.server.asked, self.server.gate = [], threading.Event()
        self.server.gate.set()
        thread = threading.Thread(target=self.server.serve_forever, daemon=True)
        thread.start()
        self.addCleanup(thread.join)
        self.addCleanup(self.server.server_close)
        self.addCleanup(self.server.shutdown)
        self.addCleanup(self.server.gate.set)
        self.words = [f"http://127.0.0.1:{self.server.server_address[1]}/{{z}}/{{x}}/{{y}}.jpg", "--max-level", str(MAX_LEVEL),
                      "--cache", str(self.kept / "session.gpkg"), "--unlit"]

    def children(self):
        """The preloads that the window runs."""
        found = subprocess.run(["ps", "-o", "args=", "--ppid", str(self.viewer.program.pid)], capture_output=True, text=True)
        return [line for line in found.stdout.splitlines() if line.startswith("terrella preload")]

    def stored(self):
        base = sqlite3.connect(self.kept / "session.gpkg")
        rows = base.execute("SELECT zoom_level, tile_column, tile_row FROM tiles t JOIN terrella_cache_tiles s ON "
                            "s.id = t.id WHERE s.used IS NULL").fetchall()
        base.close()
        return set(rows)

    def click_in(self, panel, at):
        self.viewer.settled()
        left, top, *_ = self.viewer.panel(panel)
        self.viewer.click(round(left) + at[0], round(top) + at[1])

    def click_keep(self):
        """Opens the layer's row, and clicks its button."""
        self.viewer.key("l")
        before = self.viewer.panel("Layers")[3]
        self.click_in("Layers", ROW)
        wait_until("the row", lambda: self.viewer.panel("Layers")[3] > before + 10)
        self.viewer.save_grab(self.folder / "layers.png")
        self.click_in("Layers", KEEP)

    def open_panel(self):
        self.click_keep()
        self.viewer.panel("Keep for offline use")

    def estimated(self):
        """Waits for the button that starts: the window looks for the end of the process that counts once a second."""
        wait_until("the estimate", lambda: not self.children())
        self.viewer.settled(still_s=1.2)

    def keep(self):
        """Start, pause, resume, end. Returns the child's command."""
        self.estimated()
        self.viewer.save_grab(self.folder / "estimate.png")
        before = len(self.server.asked)
        self.server.gate.clear()
        self.click_in("Keep for offline use", START)
        command = wait_until("the preload", self.children)[0]
        wait_until("its fine tiles", lambda: any(z >= FINE for z, *_ in self.server.asked[before:]))
        self.viewer.settled()
        self.viewer.save_grab(self.folder / "running.png")
        self.click_in("Keep for offline use", PAUSE)
        wait_until("the pause", lambda: not self.children())
        self.server.gate.set()
        self.viewer.settled(still_s=1.2)  # the window looks for the end of the process once a second
        self.viewer.save_grab(self.folder / "paused.png")
        asked = len(self.server.asked)
        self.viewer.move(500, 300)
        self.viewer.settled()
        self.assertEqual(len(self.server.asked), asked, "a paused preload asks")
        self.click_in("Keep for offline use", PAUSE)
        wait_until("the preload again", lambda: len(self.server.asked) > asked)
        wait_until("its end", lambda: not self.children())
        self.viewer.settled()
        self.viewer.save_grab(self.folder / "kept.png")
        return command

    def planned(self, command):
        """The tiles of the child's command line, by the program's own count."""
        words = dict(word.split("=") if "=" in word else (word, "") for word in command.split())
        box, levels = words["--bbox"], command.split("--levels ")[1].split()[0]
        done = subprocess.run([PROGRAM, "preload", self.words[0], "--max-level", str(MAX_LEVEL), "--dry-run", "--json",
                               f"--bbox={box}", "--levels", levels, "-o", self.words[4]], capture_output=True, text=True)
        answer = json.loads(done.stdout)
        self.assertEqual(answer["there"], answer["tiles"], "not all is there")
        return answer["tiles"]

    def test_a_view_is_kept_with_a_pause_twice_and_shows_offline(self):
        self.viewer = self.start(*self.words, "--camera", "20,30,3000000")
        self.viewer.settled()
        self.open_panel()
        first = self.planned(self.keep())
        self.assertGreater(first, 50)
        self.viewer.wheel(560, 300, 4)
        self.viewer.next_camera()
        self.click_in("Keep for offline use", VIEW)
        self.planned(self.keep())
        self.assertGreater(len(self.stored()), first)
        self.viewer.key("Escape")
        self.viewer.key("Escape")
        self.viewer.settled()
        online = self.saved_picture(self.viewer, "online").read_bytes()
        camera = f"{self.viewer.camera.lat},{self.viewer.camera.lon},{self.viewer.camera.height_m}"
        self.viewer.quit()
        asked = len(self.server.asked)
        self.viewer = self.start(*self.words, "--offline", "--camera", camera)
        self.viewer.settled()
        self.assertEqual(self.saved_picture(self.viewer, "offline").read_bytes(), online)
        self.assertEqual(len(self.server.asked), asked)

    def test_cancel_keeps_what_came_and_the_window_ends_a_running_preload(self):
        self.viewer = self.start(*self.words, "--camera", "20,30,3000000")
        self.viewer.settled()
        self.open_panel()
        for _ in range(2):
            self.estimated()
            self.server.gate.clear()
            self.click_in("Keep for offline use", START)
            wait_until("the preload", self.children)
            wait_until("the bar", self.stored)
            self.click_in("Keep for offline use", CANCEL)
            wait_until("its end", lambda: not self.children())
            self.server.gate.set()
            self.assertTrue(self.stored())
        self.estimated()
        self.server.gate.clear()
        self.click_in("Keep for offline use", START)
        wait_until("the preload", self.children)
        self.viewer.key("ctrl+q")
        self.viewer.program.wait(timeout=60)
        self.assertEqual(self.viewer.program.returncode, 0)

    def start_keeping(self):
        """A preload whose fine tiles are held back, and the number of its process."""
        self.viewer = self.start(*self.words, "--camera", "20,30,3000000")
        self.viewer.settled()
        self.open_panel()
        self.estimated()
        before = len(self.server.asked)
        self.server.gate.clear()
        self.click_in("Keep for offline use", START)
        wait_until("its fine tiles", lambda: any(z >= FINE for z, *_ in self.server.asked[before:]))
        found = subprocess.run(["pgrep", "-P", str(self.viewer.program.pid), "-f", "^terrella preload"], capture_output=True,
                               text=True)
        return int(found.stdout)

    def test_a_fault_during_a_pause_is_told(self):
        child = self.start_keeping()
        height = self.viewer.panel("Keep for offline use")[3]
        self.click_in("Keep for offline use", PAUSE)
        wait_until("the pause", lambda: not catches(child, signal.SIGTERM))
        os.kill(child, signal.SIGKILL)
        wait_until("its end", lambda: not self.children())
        self.server.gate.set()
        # The panel offers the choice again, which is higher than the bar with its buttons.
        wait_until("the choice", lambda: self.viewer.panel("Keep for offline use")[3] > height + 30)
        self.viewer.settled(still_s=1.2)
        self.viewer.save_grab(self.folder / "fault.png")

    def test_a_window_that_is_killed_leaves_no_preload_and_no_key(self):
        before = temporary_files()
        child = self.start_keeping()
        held = [path.read_text() for path in temporary_files() - before]
        self.assertTrue(any("terrella preload" in text for text in held), "the log is elsewhere")
        self.assertFalse(any("127.0.0.1" in text for text in held))
        self.assertNotIn("127.0.0.1", Path(f"/proc/{child}/cmdline").read_text())
        self.viewer.program.kill()
        self.viewer.program.wait()
        self.server.gate.set()
        wait_until("the preload's end", lambda: has_ended(child))

    def test_a_view_of_the_sky_alone_is_not_kept(self):
        self.viewer = self.start(*self.words, "--camera", "20,30,3000000,0,60")
        self.viewer.settled()
        self.click_keep()
        self.viewer.settled()
        self.viewer.save_grab(self.folder / "sky.png")
        self.assertNotIn("Keep for offline use", self.viewer.layout.panels)

    def test_without_a_cache_the_window_says_what_to_do(self):
        self.viewer = self.start(*self.words[:3], "--cache", "off", "--unlit", "--camera", "20,30,3000000")
        self.viewer.settled()
        self.click_keep()
        self.viewer.settled()
        self.viewer.save_grab(self.folder / "no_cache.png")
        self.assertNotIn("Keep for offline use", self.viewer.layout.panels)


if __name__ == "__main__":
    unittest.main()
