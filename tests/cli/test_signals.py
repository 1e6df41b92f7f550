"""Termination signals: the program's own exit code, a message, and no partial output."""

import json
import os
import shutil
import signal
import socket
import subprocess
import time
import unittest

import servers
from program import BLUE_MARBLE, DONE_IN_PART, FAILED, NATURAL_EARTH, PROGRAM, TIME_LIMIT_S, ProgramTest

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


def _usual_signals():
    for number in SIGNALS:
        signal.signal(number, signal.SIG_DFL)


class Signals(ProgramTest):
    def start(self, *arguments, prepare=_usual_signals):
        process = subprocess.Popen([PROGRAM, *map(str, arguments)], cwd=self.folder, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True, preexec_fn=prepare,
                                   env={**os.environ, "XDG_CACHE_HOME": str(self.folder / "cache")})
        self.addCleanup(process.kill)
        return process

    def assert_ends(self, process, number, code, *says):
        process.send_signal(number)
        said = process.communicate(timeout=TIME_LIMIT_S)[1]
        self.assertEqual(process.returncode, code, said)
        for text in ("stopped", *says):
            self.assertIn(text, said)

    def wait_until(self, is_true):
        until = time.monotonic() + TIME_LIMIT_S
        while not is_true():
            self.assertLess(time.monotonic(), until)
            time.sleep(0.01)

    def test_cut(self):
        for number in SIGNALS:
            with self.subTest(signal.Signals(number).name):
                process = self.start("cut", BLUE_MARBLE, "-o", "earth.gpkg")
                self.wait_until(lambda: list(self.folder.glob(".earth.gpkg.*.part/band-*")))
                self.assert_ends(process, number, FAILED, "earth.gpkg")
                self.assert_nothing_but()

    def test_a_picture_that_render_cuts(self):
        for number in SIGNALS:
            with self.subTest(signal.Signals(number).name):
                process = self.start("render", BLUE_MARBLE, "-o", "shot.png")
                self.wait_until(lambda: list((self.folder / "cache").rglob(".*.part/band-*")))
                self.assert_ends(process, number, FAILED)
                self.assertEqual([p for p in (self.folder / "cache").rglob("*") if p.name.startswith(".")], [])
                self.assert_nothing_but()

    def test_render_that_waits_for_a_server(self):
        with socket.create_server(("127.0.0.1", 0)) as silent:
            address = f"http://127.0.0.1:{silent.getsockname()[1]}/{{z}}/{{x}}/{{y}}.jpg"
            for number in SIGNALS:
                with self.subTest(signal.Signals(number).name):
                    process = self.start("render", address, "--max-level", "3", "-o", "shot.png", "--cache", "off",
                                         "--size", "64x64")
                    silent.settimeout(TIME_LIMIT_S)
                    asked = silent.accept()[0]
                    self.addCleanup(asked.close)
                    self.assertTrue(asked.recv(1))  # the program waits for tiles
                    self.assert_ends(process, number, FAILED, "shot.png")
                    self.assert_nothing_but()

    def test_info_verify(self):
        tiles = self.folder / "tiles"
        tiles.mkdir()
        (tiles / "tileset.json").write_text(json.dumps(
            {"root_span_deg": 180, "tile_px": 256, "max_level": 8, "format": "jpg"}))
        # Enough for several seconds, of one file.
        tile = tiles / "tile.jpg"
        shutil.copy(next(NATURAL_EARTH.glob("*/*/*.jpg")), tile)
        for x in range(200):
            (tiles / f"8/{x}").mkdir(parents=True)
            for y in range(250):
                os.link(tile, tiles / f"8/{x}/{y}.jpg")
        for number in SIGNALS:
            with self.subTest(signal.Signals(number).name):
                process = self.start("info", "tiles", "--verify")
                self.assertIn("tiles read", process.stderr.readline())
                self.assert_ends(process, number, FAILED, "tiles")

    def test_preload(self):
        with servers.nginx(NATURAL_EARTH) as server:
            for number in SIGNALS:
                with self.subTest(signal.Signals(number).name):
                    cache = self.folder / f"cache{number}.gpkg"
                    process = self.start("preload", server.template, "--levels", "0-6", "--rate", "20", "-o", cache)
                    self.wait_until(lambda: cache.exists() and server.counts())  # into the first tiles
                    self.assert_ends(process, number, DONE_IN_PART, "same command goes on")

    def test_nohup(self):
        def ignore():
            signal.signal(signal.SIGHUP, signal.SIG_IGN)
        process = self.start("cut", BLUE_MARBLE, "-o", "earth.gpkg", prepare=ignore)
        self.wait_until(lambda: list(self.folder.glob(".earth.gpkg.*.part/band-*")))
        process.send_signal(signal.SIGHUP)
        said = process.communicate(timeout=TIME_LIMIT_S)[1]
        self.assertEqual(process.returncode, 0, said)


if __name__ == "__main__":
    unittest.main()
