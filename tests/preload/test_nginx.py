"""Preloading from a real server: storing, resuming, refreshing, shards and reports."""

import json
import os
import random
import re
import signal
import subprocess
import time
import unittest

import servers
from preload_test import PreloadTest, PyramidTest
from program import DONE, DONE_IN_PART, FAILED, PROGRAM, WRONG_USAGE

LEVELS = 5
KILLS = int(os.environ.get("TERRELLA_KILLS", "20"))


class Nginx(PyramidTest):
    LEVELS = LEVELS

    def command(self, *options):
        return [PROGRAM, "preload", self.server.template, "-o", str(self.cache), "--levels", f"0-{LEVELS - 1}",
                *map(str, options)]

    def test_all_tiles_once_and_right(self):
        summary, _ = self.preload(self.server.template, "--levels", f"0-{LEVELS - 1}")
        self.assertEqual(summary["stored"], servers.tiles_in(LEVELS))
        self.assertEqual(summary["requests"], servers.tiles_in(LEVELS))
        self.assertEqual(len(self.stored()), servers.tiles_in(LEVELS))
        self.assert_stored_are_right()
        self.assert_sound()
        self.assertEqual(set(self.server.counts().values()), {1})

    def test_over_https_with_http2(self):
        summary, _ = self.preload(self.server.tls_template, "--levels", "0-3", "--ca-file", self.server.ca_file)
        self.assertEqual(summary["stored"], servers.tiles_in(4))
        self.assertIn("HTTP/2.0", self.server.access_log.read_text())
        self.assert_stored_are_right()

    def test_a_second_run_asks_for_nothing(self):
        self.preload(self.server.template, "--levels", "0-3", "--max-level", "4")
        before = len(self.server.requests())
        summary, _ = self.preload(self.server.template, "--levels", "0-3", "--max-level", "4")
        self.assertEqual((summary["there"], summary["stored"], summary["requests"]), (servers.tiles_in(4), 0, 0))
        self.assertEqual(len(self.server.requests()), before)
        summary, _ = self.preload(self.server.template, "--levels", "0-4")
        self.assertEqual(summary["stored"], servers.tiles_in(5) - servers.tiles_in(4))

    def test_refresh_asks_conditionally(self):
        self.preload(self.server.template, "--levels", "0-3")
        summary, _ = self.preload(self.server.template, "--levels", "0-3", "--refresh-older-than", "1")
        self.assertEqual(summary["requests"], 0)
        summary, _ = self.preload(self.server.template, "--levels", "0-3", "--refresh-older-than", "0")
        self.assertEqual((summary["unchanged"], summary["stored"]), (servers.tiles_in(4), 0))
        statuses = [status for status, _ in self.server.requests()]
        self.assertEqual(statuses.count(304), servers.tiles_in(4))
        self.assertEqual(len(self.stored()), servers.tiles_in(4))

    def test_boxes_over_the_antimeridian_and_polygons(self):
        self.preload(self.server.template, "--levels", "0-4", "--bbox", "170,-10,-170,10")
        self.assertEqual({x for z, x, _ in self.stored() if z == 4}, {0, 31})
        polygon = {"type": "Polygon", "coordinates": [[[0, 75], [90, 75], [180, 75], [-90, 75], [0, 75]]]}
        self.write("cap.geojson", json.dumps(polygon).encode())
        self.preload(self.server.template, "--levels", "0-4", "--polygon", "cap.geojson")
        self.assertEqual(len([1 for z, _, y in self.stored() if z == 4 and y == 0]), 32)

    def test_a_flight(self):
        way = {"type": "Feature", "properties": {"pitch": -60, "heading": 90},
               "geometry": {"type": "LineString", "coordinates": [[8, 47, 300000], [12, 42, 100000]]}}
        self.write("flight.geojson", json.dumps(way).encode())
        summary, _ = self.preload(self.server.template, "--levels", "0-4", "--flight", "flight.geojson", "--size",
                                  "640x360")
        places = self.stored().keys()
        self.assertLess(len(places), servers.tiles_in(LEVELS) / 4)
        self.assertIn((4, int((180 + 8) / 11.25), int((90 - 47) / 11.25)), places)
        self.assertIn((4, int((180 + 12) / 11.25), int((90 - 42) / 11.25)), places)
        for z, x, y in places:
            self.assertTrue(z == 0 or (z - 1, x // 2, y // 2) in places, "an ancestor is missing")

    def test_shards_together_are_the_whole(self):
        stored = []
        for index in range(1, 4):
            self.cache = self.folder / f"part{index}.gpkg"
            self.preload(self.server.template, "--levels", "0-4", "--shard", f"{index}/3")
            stored.append(self.stored().keys())
        self.assertEqual(len(set().union(*stored)), servers.tiles_in(LEVELS))
        self.assertEqual(sum(map(len, stored)), servers.tiles_in(LEVELS))
        self.assertEqual(set(self.server.counts().values()), {1})

    def test_dry_run_asks_little_and_stores_nothing(self):
        done = self.run_program(*self.command("--dry-run", "--json", "--rate", "100")[1:])
        forecast = json.loads(done.stdout)
        self.assertEqual(forecast["tiles"], servers.tiles_in(LEVELS))
        self.assertLessEqual(len(self.server.requests()), 20)
        whole = sum(path.stat().st_size for path in self.pyramid.glob("*/*/*.jpg"))
        self.assertAlmostEqual(forecast["bytes"] / whole, 1.0, delta=0.5)
        self.assertGreaterEqual(forecast["seconds"], servers.tiles_in(LEVELS) / 100 * 0.99)
        self.assertFalse(self.cache.exists())

    def test_dry_run_offline_says_unknown(self):
        done = self.run_program(*self.command("--dry-run", "--offline")[1:])
        self.assertEqual(done.returncode, DONE)
        self.assertIn("bytes: unknown", done.stdout)
        self.assertEqual(self.server.requests(), [])

    def test_the_rate_is_kept(self):
        begun = time.monotonic()
        self.preload(self.server.template, "--levels", "0-3", "--rate", "60")
        first_second = 60 / 4  # the bucket's burst
        self.assertGreaterEqual(time.monotonic() - begun, (servers.tiles_in(4) - first_second) / 60 * 0.95)

    def test_absent_tiles_are_no_failure_but_nothing_at_all_is(self):
        summary, _ = self.preload(self.server.template, "--levels", "4-5")
        self.assertEqual((summary["absent"], summary["stored"]), (2 << 10, 2 << 8))
        self.cache = self.folder / "wrong.gpkg"
        _, said = self.preload(self.server.template.replace("{z}", "wrong/{z}"), "--levels", "0-2", code=DONE_IN_PART)
        self.assertIn("none of the 42 tiles", said)

    def test_secrets_are_sent_and_never_told_or_stored(self):
        summary, said = self.preload(self.server.template + "?key=hidden1", "--header", "X-Token: hidden2", "--levels",
                                     "0-2")
        self.assertEqual(summary["stored"], servers.tiles_in(3))
        self.assertTrue(all("key=hidden1" in path for _, path in self.server.requests()))
        base = b"".join(path.read_bytes() for path in self.folder.glob("cache.gpkg*"))
        for text in (json.dumps(summary).encode(), said.encode(), base):
            self.assertNotIn(b"hidden", text)

    def test_killed_and_started_again(self):
        """Reported tiles are there and right, and no tile that is there is fetched again."""
        random.seed(20261121)
        levels = LEVELS + 1
        servers.write_pyramid(self.root, levels)
        self.server = self.enterContext(servers.nginx(self.root))
        log, cuts, there, in_the_middle = self.folder / "stored.txt", [], [], 0
        for _ in range(KILLS):
            before = len(self.reported(log))
            self.start_and_kill(log, before + random.randint(0, servers.tiles_in(levels) // KILLS), levels)
            in_the_middle += before < len(self.reported(log)) < servers.tiles_in(levels)
            cuts.append(self.server.cut())
            there.append(self.what_a_kill_left(log))
        summary, _ = self.preload(self.server.template, "--levels", f"0-{levels - 1}")
        self.assertEqual(summary["there"] + summary["stored"], servers.tiles_in(levels))
        self.assertEqual(len(self.stored()), servers.tiles_in(levels))
        self.assert_stored_are_right()
        for cut, stored in zip(cuts, there):
            self.assertEqual(stored & self.server.asked_since(cut), set(), "fetched again")
        again = sum(self.server.counts().values()) - KILLS - servers.tiles_in(levels)
        print(f"{KILLS} kills, {in_the_middle} of them between the first tile and the last; {again} of "
              f"{servers.tiles_in(levels)} tiles were under way at a kill and fetched again; none of those stored")
        self.assertGreaterEqual(in_the_middle, KILLS // 4)

    def start_and_kill(self, log, reported, levels):
        """Kills it a random moment after so many tiles were reported, however slow the machine is."""
        process = subprocess.Popen([PROGRAM, "preload", self.server.template, "-o", self.cache, "--levels",
                                    f"0-{levels - 1}", "--stored", log, "--rate", "400"], stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL)
        while process.poll() is None and len(self.reported(log)) < reported:
            time.sleep(0.005)
        time.sleep(random.uniform(0.0, 0.1))
        process.send_signal(signal.SIGKILL)
        process.wait()

    def what_a_kill_left(self, log):
        if not self.cache.exists():
            return set()
        self.assert_sound()
        stored = self.stored().keys()
        self.assertLessEqual(self.reported(log), stored, "reported, and not there")
        return set(stored)

    def reported(self, log):
        if not log.exists():
            return set()
        lines = log.read_text().split("\n")[:-1]  # the last may have been cut off
        return {tuple(map(int, line.split("/"))) for line in lines}

    def test_reported_tiles_are_not_fetched_again(self):
        log = self.folder / "stored.txt"
        process = subprocess.Popen(self.command("--stored", log, "--rate", "600"), stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL)
        while process.poll() is None and not self.reported(log):
            time.sleep(0.005)
        process.send_signal(signal.SIGKILL)
        process.wait()
        reported = self.reported(log)
        self.assertGreater(len(reported), 0)
        self.preload(self.server.template, "--levels", f"0-{LEVELS - 1}")
        counts = self.server.counts()
        self.assertEqual({counts[f"/{z}/{x}/{y}.jpg"] for z, x, y in reported}, {1})

    def test_interrupted_it_ends_cleanly_and_says_how_to_go_on(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(number):
                self.cache = self.folder / f"cache{number}.gpkg"
                log = self.folder / f"stored{number}.txt"
                process = subprocess.Popen(self.command("--stored", log, "--rate", "20", "--json"), stdout=subprocess.PIPE,
                                           stderr=subprocess.PIPE, text=True)
                while process.poll() is None and not self.reported(log):
                    time.sleep(0.005)
                process.send_signal(number)
                out, said = process.communicate(timeout=60)
                self.assertEqual(process.returncode, DONE_IN_PART, said)
                summary = json.loads(out)
                self.assertEqual(summary["end"], "stopped")
                self.assertEqual(len(self.stored()), summary["stored"])
                self.assertIn("same command goes on", said)
                self.assert_sound()

    def some_but_not_all(self):
        """Bytes in which the largest first transaction (256 tiles) has room, and all tiles have not."""
        sizes = sorted((servers.tile_file(*place).stat().st_size for place in servers.places(LEVELS)), reverse=True)
        room = sum(sizes) * 9 // 10
        self.assertLess(sum(sizes[:256]) * 5 // 4, room)
        return room

    def test_a_full_disk(self):
        done = self.run_program(*self.command()[1:], file_size_limit=self.some_but_not_all())
        self.assertEqual(done.returncode, FAILED, done.stdout + done.stderr)
        self.assertIn(str(self.cache), done.stderr)
        self.assert_sound()
        self.assert_stored_are_right()
        kept = len(self.stored())
        self.assertGreater(kept, 0)
        summary, _ = self.preload(self.server.template, "--levels", f"0-{LEVELS - 1}")
        self.assertEqual(summary["there"] + summary["stored"], servers.tiles_in(LEVELS))
        self.assertGreaterEqual(summary["there"], kept)

    def test_a_full_small_disk(self):
        disk = servers.SmallDisk(self.folder / "disk", self.some_but_not_all())
        self.addCleanup(disk.unmount)
        if not disk.mounted:
            # Only root may mount; the limit on the file size above takes the same path through the code.
            print("no small disk can be mounted here")
            return
        self.cache = disk.folder / "cache.gpkg"
        done = self.run_program(*self.command()[1:])
        self.assertEqual(done.returncode, FAILED, done.stdout + done.stderr)
        self.assertIn(f"{self.cache}: the cache cannot be written: ", done.stderr)
        self.assertIn("make space", done.stderr)
        kept = len(self.stored())
        self.assertGreater(kept, 0)
        told = json.loads(self.assert_done("info", self.cache, "--verify", "--json").stdout)
        self.assertEqual((told["verified"]["good"], told["verified"]["broken"], told["cache"]["problems"]), (kept, 0, []), told)
        disk.resize("64m")
        summary, _ = self.preload(self.server.template, "--levels", f"0-{LEVELS - 1}")
        self.assertEqual((summary["there"], summary["stored"]), (kept, servers.tiles_in(LEVELS) - kept))
        self.assert_sound()
        self.assert_stored_are_right()

    def test_gdal_looks_while_it_is_filled(self):
        log = self.folder / "stored.txt"
        process = subprocess.Popen(self.command("--stored", log, "--rate", "200"), stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL)
        self.addCleanup(process.wait)
        while process.poll() is None and not self.reported(log):
            time.sleep(0.005)
        looks = 0
        while process.poll() is None:
            done = subprocess.run(["gdalinfo", "--config", "GDAL_PAM_ENABLED", "NO", self.cache], capture_output=True,
                                  text=True, check=False)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertIn("Driver: GPKG", done.stdout)
            self.assertIn("Block=256x256", done.stdout)
            looks += process.poll() is None
        self.assertEqual(process.returncode, DONE)
        self.assertGreater(looks, 0)
        self.assertEqual(len(self.stored()), servers.tiles_in(LEVELS))
        self.assert_stored_are_right()
        self.assert_sound()

    def test_progress_has_rate_and_time_left(self):
        _, said = self.preload(self.server.template, "--levels", "0-3", "--rate", "70")
        self.assertRegex(said, r"% of 170 tiles: \d+ stored .*; \d+ tiles/s, [\d.]+ s left")


class Other(PreloadTest):
    def test_a_set_on_disk_is_copied(self):
        from program import NATURAL_EARTH
        summary, _ = self.preload(NATURAL_EARTH)
        self.assertEqual(summary["stored"], servers.tiles_in(3))
        done = self.assert_done("info", self.cache, "--verify")
        self.assertRegex(done.stdout, re.compile(r"42"))
        summary, _ = self.preload(NATURAL_EARTH)
        self.assertEqual(summary["there"], servers.tiles_in(3))

    def test_hosts_that_forbid_it(self):
        _, said = self.preload("https://tile.openstreetmap.org/{z}/{x}/{y}.png", "--levels", "0-3", code=FAILED)
        self.assertIn("openstreetmap", said)
        self.assertFalse(self.cache.exists())

    def test_wrong_usage(self):
        template = "http://127.0.0.1:9/{z}/{x}/{y}.jpg"
        for options, says in [(("--levels", "5-3"), "--levels"), (("--levels", "0-25"), "24"),
                              (("--bbox", "0,10,5,5"), "--bbox"), (("--shard", "4/3"), "--shard"),
                              (("--jobs", "0"), "--jobs"), (("--rate", "-1"), "--rate"), (("--offline",), "--dry-run"),
                              (("--flight", "f", "--bbox", "0,0,1,1"), "--flight"), (("--size", "5"), "--size")]:
            with self.subTest(options):
                self.assert_fails(WRONG_USAGE, "preload", template, "-o", "x.gpkg", *options, says=[says])
        self.assert_fails(WRONG_USAGE, "preload", template, "-o", "x.jpg", says=[".gpkg"])
        self.assert_nothing_but()

    def test_a_bad_polygon_file_is_named(self):
        self.write("bad.geojson", b'{"type":"FeatureCollection","features":[{"type":"Feature","geometry":'
                                  b'{"type":"Point","coordinates":[0,0]}}]}')
        self.assert_fails(FAILED, "preload", "http://127.0.0.1:9/{z}/{x}/{y}.jpg", "--levels", "0-3", "-o", "x.gpkg",
                          "--polygon", "bad.geojson", says=["bad.geojson", "feature 1", "Point"])

    def test_nobody_answers(self):
        _, said = self.preload("http://127.0.0.1:9/{z}/{x}/{y}.jpg", "--levels", "0-2", "--retries", "0",
                               code=DONE_IN_PART)
        self.assertIn("42 tiles are missing", said)


if __name__ == "__main__":
    unittest.main()
