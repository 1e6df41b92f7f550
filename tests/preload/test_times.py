"""Preloading several times of a layer from a real server: each time has a cache of its own."""

import json
import random
import signal
import sqlite3
import subprocess
import time
import unittest
from pathlib import Path

import servers
from preload_test import PreloadTest
from program import DONE, FAILED, PROGRAM, WRONG_USAGE

LEVELS, KILLS = 4, 5
DATES = [f"2026-06-{day:02}" for day in range(1, 6)]


class Times(PreloadTest):
    def setUp(self):
        super().setUp()
        for date in DATES:
            servers.write_pyramid(self.root / date, LEVELS)
        self.server = self.enterContext(servers.nginx(self.root))
        self.template = self.server.template.replace("{z}", "{time:%Y-%m-%d}/{z}")
        self.words = ["--layer-times", "2026-06-01/2026-06-05/P1D", "--levels", f"0-{LEVELS - 1}"]

    def cache_of(self, date):
        return self.folder / f"cache.{date}.gpkg"

    def tiles_of(self, date):
        if not self.cache_of(date).exists():
            return set()
        base = sqlite3.connect(self.cache_of(date))
        rows = base.execute("SELECT zoom_level, tile_column, tile_row FROM tiles").fetchall()
        base.close()
        return {f"/{date}/{z}/{x}/{y}.jpg" for z, x, y in rows}

    def forecast(self, times):
        done = self.run_program("preload", self.template, "-o", self.cache, *self.words, "--times", times, "--dry-run",
                                "--offline", "--json")
        self.assertEqual(done.returncode, DONE, done.stderr)
        return json.loads(done.stdout)

    def test_exactly_what_the_dry_run_said(self):
        a_date = servers.tiles_in(LEVELS)
        self.preload(self.template, *self.words, "--times", "2026-06-02")
        self.assertEqual(len(self.server.requests()), a_date)
        for times, dates in (("2026-06-02/2026-06-04", DATES[1:4]), ("2026-06-01/2026-06-05/P2D", DATES[::2]),
                             ("2026-06-05T12:00Z,2026-06-02,2026-06-03/2026-06-09/P1M", [DATES[1], DATES[2], DATES[4]])):
            with self.subTest(times):
                told, before = self.forecast(times), len(self.server.requests())
                self.assertEqual((told["tiles"], told["instants"]), (len(dates) * a_date, len(dates)))
                summary, _ = self.preload(self.template, *self.words, "--times", times)
                self.assertEqual([one["time"] for one in summary["instants"]], dates)
                self.assertEqual(len(self.server.requests()) - before, told["tiles"] - told["there"])
                self.assertEqual(summary["requests"], told["tiles"] - told["there"])
        self.assertEqual(set(self.server.counts().values()), {1})
        self.assertFalse(self.cache.exists())
        for date in DATES:
            self.assertEqual(len(self.tiles_of(date)), a_date, date)

    def test_a_span_to_now_and_a_period_far_finer_than_the_steps(self):
        for times in ("2026-06-01/now", "2026-06-01/PRESENT", "2026-06-01/2090-06-01/PT3S"):
            self.assertEqual(self.forecast(times)["instants"], len(DATES), times)

    def render(self, *words):
        return self.run_program("render", self.template, "--max-level", LEVELS - 1, "--cache", self.cache, "-o", "a.png",
                                "--size", "64x64", "--tile-size", "256", *words)

    def test_a_named_cache_of_another_time_has_files_beside_it(self):
        later, earlier = ("--layer-times", "2026-06-01/2026-06-05/P1D"), ("--layer-times", "2026-06-01/2026-06-04/P1D")
        for words in (earlier, (*later, "--layer-time", "2026-06-02"), later):
            for asked in (True, False):
                before = len(self.server.requests())
                done = self.render(*words)
                self.assertEqual(done.returncode, DONE, done.stderr)
                self.assertEqual(len(self.server.requests()) > before, asked, words)
        self.assertTrue(all(file.exists() for file in (self.cache, self.cache_of("2026-06-02"), self.cache_of("2026-06-05"))))

    def test_offline_with_files_of_times_alone(self):
        self.preload(self.template, *self.words, "--times", "2026-06-02/2026-06-04")
        before = len(self.server.requests())
        for words in ((), ("--layer-time", "2026-06-03"), ("--layer-time", "2026-06-05")):
            done = self.render(*self.words[:2], "--offline", *words)
            self.assertEqual(done.returncode, DONE, done.stderr)
        done = self.render(*self.words[:2], "--offline", "--layer-time", "2026-06-01")
        self.assertEqual(done.returncode, FAILED)
        self.assertIn("the first time is 2026-06-02", done.stderr)
        self.assertEqual(len(self.server.requests()), before)

    def test_reports_of_a_failure_and_a_release(self):
        times = ("--times", "2026-06-02/2026-06-04", "--missing", "/dev/null")
        self.cache_of("2026-06-03").mkdir()
        summary, _ = self.preload(self.template, *self.words, *times, code=FAILED)
        self.assertEqual([one["time"] for one in summary["instants"]], ["2026-06-02"])
        self.cache_of("2026-06-03").rmdir()
        self.preload(self.template, *self.words, *times)
        self.assertFalse(Path("/dev/null.2026-06-02").exists())
        told, _ = self.preload(self.template, *self.words, "--times", "2026-06-01/2026-06-05", "--release")
        self.assertEqual([one["output"] for one in told["instants"]], [str(self.cache_of(date)) for date in DATES[1:4]])
        self.assertEqual(told["released"], 3 * (servers.tiles_in(LEVELS) - servers.tiles_in(1)), "level 0 stays")
        self.assert_fails(FAILED, "preload", self.template, "-o", self.cache, *self.words, "--times", "2026-06-01",
                          "--release", says=["no such file"])

    def test_a_viewer_takes_them_without_a_request(self):
        self.preload(self.template, *self.words, "--times", "2026-06-03/2026-06-05")
        before = len(self.server.requests())
        done = self.run_program("render", self.template, *self.words[:2], "--max-level", LEVELS - 1, "--cache", self.cache,
                                "--layer-time", "2026-06-04", "-o", self.folder / "a.png", "--size", "64x64",
                                "--tile-size", "256")
        self.assertEqual(done.returncode, DONE, done.stderr)
        self.assertEqual(len(self.server.requests()), before)

    def test_the_newest_time_of_another_day_has_a_cache_too(self):
        for date in DATES[-2:]:
            description = {"url": self.template, "times": [f"2026-06-01/{date}/P1D"], "max_level": LEVELS - 1}
            self.write("set.json", json.dumps(description).encode())
            for asked in (True, False):
                before = len(self.server.requests())
                done = self.run_program("render", "set.json", "-o", "a.png", "--size", "64x64")
                self.assertEqual(done.returncode, DONE, done.stderr)
                self.assertEqual(len(self.server.requests()) > before, asked, date)

    def test_killed_and_started_again(self):
        """No tile that is there is asked for again."""
        random.seed(20261129)
        cuts, there = [], []
        for kill in range(KILLS):
            process = subprocess.Popen([PROGRAM, "preload", self.template, "-o", self.cache, *self.words, "--times",
                                        "2026-06-01/2026-06-05", "--rate", "400"], stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL)
            aim = len(self.server.requests()) + random.randint(20, 5 * servers.tiles_in(LEVELS) // KILLS)
            while process.poll() is None and len(self.server.requests()) < aim:
                time.sleep(0.005)
            process.send_signal(signal.SIGKILL)
            process.wait()
            cuts.append(self.server.cut())
            there.append(set().union(*map(self.tiles_of, DATES)))
        summary, _ = self.preload(self.template, *self.words, "--times", "2026-06-01/2026-06-05")
        self.assertEqual(summary["there"] + summary["stored"], 5 * servers.tiles_in(LEVELS))
        for cut, stored in zip(cuts, there):
            self.assertEqual(stored & self.server.paths_since(cut), set(), "asked for again")
        self.assertGreater(len(set(map(len, there))), 2, "killed at different moments")

    def test_wrong_times_are_told(self):
        for code, times, says in ((FAILED, "2026-05-30/2026-06-02/P1D", "its first time is 2026-06-01"),
                                  (FAILED, "1999-01-01/1999-02-01", "no time there"),
                                  (WRONG_USAGE, "yesterday", "yesterday"), (WRONG_USAGE, "2026-06-01/2026-06-02/P0D", "P0D"),
                                  (WRONG_USAGE, "2026-06-04/2026-06-01", "ends before it begins")):
            with self.subTest(times):
                self.assert_fails(code, "preload", self.template, "-o", self.cache, *self.words, "--times", times,
                                  says=["--times", says])
        self.assert_fails(FAILED, "preload", self.server.template, "-o", self.cache, "--levels", "0-1", "--times",
                          "2026-06-01", says=["no list of times", "--times"])
        self.assert_fails(FAILED, "preload", self.template, "-o", self.cache, "--levels", "0-1", says=["--layer-times"])
        self.assert_fails(WRONG_USAGE, "preload", self.template, "-o", self.cache, *self.words, "--times", "2026-06-01",
                          "--layer-time", "2026-06-01", says=["--times", "--layer-time"])


if __name__ == "__main__":
    unittest.main()
