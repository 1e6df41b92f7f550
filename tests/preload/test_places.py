"""Files of a cache that other programs remove, move, replace or cut off while it is filled, and what killed runs left."""

import contextlib
import http.server
import os
import socket
import sqlite3
import subprocess
import threading
import time
import unittest

import servers
from pictures import square_tile
from preload_test import PreloadTest
from program import BLUE_MARBLE, DONE, DONE_IN_PART, FAILED, PROGRAM

LEVELS = 4
HELD = "/3/15/7.jpg"
PATIENCE_S = 60


class HoldingServer(http.server.BaseHTTPRequestHandler):
    """Sends the tiles of servers.tile_file(), and HELD only once the test says so."""

    protocol_version = "HTTP/1.1"

    def log_message(self, *_):
        pass

    def do_GET(self):
        if self.path == HELD:
            self.server.go.wait()
        try:
            body = servers.tile_file(*map(int, self.path.removesuffix(".jpg").strip("/").split("/"))).read_bytes()
            self.send_response(200)
            self.send_header("Content-Length", str(len(body)))
            self.end_headers()
            self.wfile.write(body)
        except OSError:
            self.close_connection = True


@contextlib.contextmanager
def holding_server():
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), HoldingServer)
    server.go = threading.Event()
    thread = threading.Thread(target=server.serve_forever, daemon=True)
    thread.start()
    try:
        yield server, f"http://127.0.0.1:{server.server_address[1]}/{{z}}/{{x}}/{{y}}.jpg"
    finally:
        server.go.set()
        server.shutdown()
        server.server_close()
        thread.join()


class CacheInUse(PreloadTest):
    def act_on_the_cache(self, command, act, stored, again=False):
        """Runs a command until so many tiles are stored, acts, and lets it have the held tile. `again`: and once more."""
        with holding_server() as (server, template):
            process = subprocess.Popen([PROGRAM, *map(str, command(template))], cwd=self.folder, stdout=subprocess.PIPE,
                                       stderr=subprocess.PIPE, text=True)
            self.wait_for(process, stored)
            act()
            server.go.set()
            out, said = process.communicate()
            if again:
                done = self.run_program(*command(template))
                self.assertEqual(done.returncode, DONE, done.stderr)
        return process.returncode, out, said

    def wait_for(self, process, stored):
        end = time.monotonic() + PATIENCE_S
        while process.poll() is None and self.count() < stored and time.monotonic() < end:
            time.sleep(0.02)
        self.assertIsNone(process.poll())
        self.assertGreaterEqual(self.count(), stored)

    def count(self):
        if not self.cache.exists():
            return 0
        with contextlib.closing(sqlite3.connect(self.cache)) as base, contextlib.suppress(sqlite3.Error):
            return base.execute("SELECT count(*) FROM tiles").fetchone()[0]
        return 0

    def preload_of(self, template):
        return ["preload", template, "-o", self.cache, "--levels", f"0-{LEVELS - 1}"]

    def replace(self):
        (self.folder / "new.gpkg").write_bytes(b"of another program")
        os.replace(self.folder / "new.gpkg", self.cache)

    def test_a_cache_that_goes_away_is_no_success(self):
        acts = {"removed": self.cache.unlink, "moved": lambda: self.cache.rename(self.folder / "moved.gpkg"), "replaced": self.replace,
                "cut off": lambda: os.truncate(self.cache, 40_000), "emptied": lambda: os.truncate(self.cache, 0)}
        for name, act in acts.items():
            with self.subTest(name):
                code, out, said = self.act_on_the_cache(self.preload_of, act, servers.tiles_in(LEVELS) - 1, again=True)
                # The log may still have all that an emptied file had.
                if name != "emptied" or code != DONE:
                    self.assertEqual(code, FAILED, out + said)
                    self.assertIn(f"{self.cache}: another program", said)
                    self.assertNotIn("safe", said)
                    self.assertIn("the same command goes on", said)
                self.assertEqual(len(self.stored()), servers.tiles_in(LEVELS))
                self.assert_stored_are_right()
                self.assert_sound()
                for path in self.folder.glob("*.gpkg*"):
                    path.unlink()

    def test_a_new_cache_takes_nothing_of_the_log_of_a_deleted_one(self):
        """A killed run leaves a log; whoever deletes the cache alone must not poison the next one."""
        servers.write_pyramid(self.root, LEVELS)
        with holding_server() as (_, template):
            process = subprocess.Popen([PROGRAM, *map(str, self.preload_of(template))], stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL)
            self.wait_for(process, servers.tiles_in(LEVELS) - 1)
            process.kill()
            process.wait()
        self.assertTrue(self.cache.with_name("cache.gpkg-wal").exists())
        self.cache.unlink()
        with servers.misbehaving(self.root, {}) as server:
            summary, said = self.preload(server.template, "--levels", "0-1")
        self.assertEqual(summary["stored"], servers.tiles_in(2), said)
        self.assert_sound()
        self.assertEqual(len(self.stored()), servers.tiles_in(2))

    def test_a_picture_without_its_cache_says_so(self):
        """`render` shows all tiles, and says that it keeps none."""
        def render(template):
            return ["render", template, "--max-level", LEVELS - 1, "-o", "x.png", "--unlit", "--sky", "off", "--camera", "-70,170,3000000",
                    "--size", "256x256", "--cache", self.cache]
        code, _, said = self.act_on_the_cache(render, self.cache.unlink, 2)
        self.assertEqual(code, DONE, said)
        self.assertIn(f"{self.cache}: another program removed", said)
        self.assertIn("without a cache", said)

    def test_a_cut_whose_work_is_removed_is_no_success(self):
        process = subprocess.Popen([PROGRAM, "cut", BLUE_MARBLE, "-o", "earth.gpkg", "--tile-size", "64"], cwd=self.folder,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        bands = []
        while process.poll() is None and not bands:
            bands = list(self.folder.glob(".earth.gpkg.*.part/band-*"))
        self.assertTrue(bands)
        # In one step: the cutter goes on writing into a folder that is emptied file by file.
        bands[0].parent.rename(self.folder / "gone")
        _, said = process.communicate()
        self.assertEqual(process.returncode, FAILED, said)
        self.assertIn("earth.gpkg", said)
        self.assertFalse((self.folder / "earth.gpkg").exists())


class Leftovers(PreloadTest):
    def test_parts_of_dead_processes_go_and_others_stay(self):
        dead = subprocess.Popen(["true"])
        dead.wait()
        host = socket.gethostname()
        gone = [f".cache.gpkg.{host}.{dead.pid}-0.part{ending}" for ending in ("", "-journal")]
        kept = [f".cache.gpkg.{host}.{os.getpid()}-0.part", f".cache.gpkg.not-{host}.{dead.pid}-0.part",
                f".other.gpkg.{host}.{dead.pid}-0.part", f".cache.gpkg.{host}.{dead.pid}-x.part"]
        for name in gone + kept:
            self.write(name, b"x")
        servers.write_pyramid(self.root, 1)
        with servers.misbehaving(self.root, {}) as server:
            self.preload(server.template, "--levels", "0-0")
        left = {path.name for path in self.folder.iterdir() if path.name.startswith(".")}
        self.assertEqual(left, set(kept))


class OneColumn(PreloadTest):
    def test_a_server_in_web_mercator_is_not_complete(self):
        for z in range(3):
            for x in range(1 << z):
                column = self.root / str(z) / str(x)
                column.mkdir(parents=True)
                for y in range(1 << z):
                    (column / f"{y}.png").write_bytes(square_tile(z, x, y))
        with servers.misbehaving(self.root, {}) as server:
            template = server.address + "/{z}/{x}/{y}.png"
            for levels in "0-2", "1-2":
                self.cache = self.folder / f"c{levels}.gpkg"
                summary, said = self.preload(template, "--levels", levels, "--tile-size", 64, code=DONE_IN_PART)
                self.assertEqual(summary["absent"], summary["planned"] // 2)
                self.assertIn("--projection web-mercator", said)
            self.cache = self.folder / "right.gpkg"
            summary, said = self.preload(template, "--levels", "0-2", "--tile-size", 64, "--projection", "web-mercator")
            self.assertEqual((summary["stored"], summary["absent"]), (21, 0))
            # A part of the planet, and a set with a gap in the west, prove nothing.
            self.cache = self.folder / "east.gpkg"
            self.preload(template, "--levels", "1-2", "--tile-size", 64, "--bbox", "-170,10,-100,60")
            (self.root / "2/0/1.png").unlink()
            self.cache = self.folder / "gap.gpkg"
            _, said = self.preload(template, "--levels", "0-2", "--tile-size", 64)
            self.assertNotIn("web-mercator", said)


if __name__ == "__main__":
    unittest.main()
