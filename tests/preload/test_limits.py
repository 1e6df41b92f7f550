"""Promises of a preload about its cache: all tiles are stored and stay, levels can be added, and nothing is lost."""

import json
import os
import resource
import shutil
import sqlite3
import subprocess
import threading
import time
import unittest

import servers
from preload_test import PreloadTest
from program import DONE, DONE_IN_PART, FAILED, PROGRAM

MOST_SAMPLED = 20
VIEW = ("--unlit", "--camera", "30,20,3000000", "--size", "512x512")


def padded(picture, bytes_more):
    """The same JPEG with comments of noise: as large as one likes, and still whole."""
    comments = b""
    while bytes_more > 0:
        size = min(bytes_more, 65533)
        comments += b"\xff\xfe" + (size + 2).to_bytes(2, "big") + os.urandom(size)
        bytes_more -= size
    return picture[:2] + comments + picture[2:]


class LimitTest(PreloadTest):
    levels = 4

    def setUp(self):
        super().setUp()
        servers.write_pyramid(self.root, self.levels)
        self.server = self.enterContext(servers.nginx(self.root, "--no-expiry"))

    def pad_all(self, bytes_more, spared=()):
        for path in self.root.glob("*/*/*.jpg"):
            if "/" + str(path.relative_to(self.root)) not in spared:
                path.write_bytes(padded(path.read_bytes(), bytes_more))

    def bring(self, levels, *options, **run):
        return self.preload(self.server.template, "--levels", levels, *options, **run)

    def query(self, sql):
        base = sqlite3.connect(self.cache)
        self.addCleanup(base.close)
        return base.execute(sql).fetchall()


class Room(LimitTest):
    def test_a_plan_larger_than_the_cache_is_refused(self):
        self.pad_all(20_000)  # 170 tiles: 5.2 MB
        _, said = self.bring("0-3", "--cache-size", "2", code=FAILED)
        self.assertLessEqual(len(self.server.requests()), MOST_SAMPLED)
        self.assertIn("--cache-size 2", said)
        self.assertRegex(said, r"give --cache-size [6-8] or more, or fewer levels")
        self.assertIn("levels 0-2 need", said)
        self.assertFalse(self.cache.exists())
        forecast, _ = self.bring("0-3", "--cache-size", "2", "--dry-run")
        self.assertFalse(forecast["fits"])
        self.bring("0-3", "--cache-size", "8")
        self.assertEqual(len(self.stored()), servers.tiles_in(4))

    def test_what_another_preload_pinned_counts(self):
        self.pad_all(20_000)
        self.bring("0-2", "--cache-size", "2", "--max-level", "3")
        _, said = self.bring("3-3", "--bbox", "0,0,180,90", "--cache-size", "1", code=FAILED)
        self.assertIn("--cache-size 1", said)
        self.assertEqual(len(self.stored()), servers.tiles_in(3))

    def test_when_the_sample_misleads_what_is_missing_is_named(self):
        self.bring("0-3", "--dry-run")
        sampled = {path for _, path in self.server.requests()}
        self.pad_all(20_000, sampled)
        summary, said = self.bring("0-3", "--cache-size", "3", "--missing", "missing.txt", code=DONE_IN_PART)
        stored = self.stored()
        missing = [line.split("\t") for line in (self.folder / "missing.txt").read_text().splitlines()]
        self.assertGreater(len(stored), 50)
        self.assertEqual(len(stored), summary["stored"])
        self.assertEqual(len(missing), summary["no_room"])
        self.assertEqual({kind for _, kind, _ in missing}, {"no room"})
        self.assertEqual({tuple(map(int, place.split("/"))) for place, _, _ in missing} & set(stored), set())
        self.assertEqual(len(stored) + len(missing), servers.tiles_in(4))
        self.assertIn(f"{len(missing)} tiles have no room under --cache-size 3", said)
        self.assertTrue({(z, x, y) for z in range(2) for x in range(2 << z) for y in range(1 << z)} <= set(stored))
        self.assertLess(self.cache.stat().st_size, 1.05 * 3e6)
        self.assert_sound()
        # The same command with room for all goes on.
        summary, _ = self.bring("0-3", "--cache-size", "8")
        self.assertEqual((summary["there"], summary["stored"]), (len(stored), len(missing)))


class Pins(LimitTest):
    levels = 5

    def setUp(self):
        super().setUp()
        self.pad_all(450_000)  # viewers take no limit under 64 MB

    def look(self, longitude, limit_mb, name="shot.png"):
        source = self.write("source.json", json.dumps({"url": self.server.template, "max_level": 4}).encode())
        return self.assert_done("render", source, "-o", name, "--unlit", "--camera", f"20,{longitude},2000000", "--size",
                                "512x512", "--cache", self.cache, "--cache-size", limit_mb)

    def test_viewers_do_not_evict_what_was_preloaded(self):
        self.bring("0-3", "--max-level", "4")
        before = self.stored()
        self.assertGreater(self.cache.stat().st_size, 75e6)
        for limit_mb in 64, 90:  # less than what is pinned, and a little more
            for longitude in range(0, 360, 90):
                self.look(longitude, limit_mb)
        after = self.stored()
        self.assertEqual({place: data for place, data in after.items() if place in before}, before)
        self.assertLess(self.cache.stat().st_size, 1.05 * 90e6)
        self.assertLess(len(before), len(after))
        self.assert_sound()

    def test_released_they_may_go(self):
        self.bring("0-3", "--max-level", "4")
        told = json.loads(self.assert_done("info", self.cache, "--json").stdout)
        self.assertEqual(told["cache"]["pinned_tiles"], servers.tiles_in(4))
        before = len(self.server.requests())
        released, _ = self.bring("0-4", "--release")
        self.assertEqual(len(self.server.requests()), before)
        self.assertEqual(released["released"], servers.tiles_in(4) - 2)  # tiles of the coarsest level stay
        before = self.stored()
        for longitude in range(0, 360, 90):
            self.look(longitude, 64)
        after = self.stored()
        self.assertTrue(set(after) - set(before), "the viewer keeps what it fetches")
        self.assertTrue(set(before) - set(after), "and gives up what was released")
        # Preloading pins what is there already, too.
        self.bring("0-3", "--max-level", "4")
        told = json.loads(self.assert_done("info", self.cache, "--json").stdout)
        self.assertEqual(told["cache"]["pinned_tiles"], servers.tiles_in(4))


class Levels(LimitTest):
    def assert_gdal_opens(self, levels):
        done = subprocess.run(["gdalinfo", "--config", "GDAL_PAM_ENABLED", "NO", self.cache], capture_output=True,
                              text=True, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        side = 256 << (levels - 1)
        self.assertIn(f"Size is {2 * side}, {side}", done.stdout)

    def render(self, source, name, *more):
        self.assert_done("render", source, "-o", name, *VIEW, *more)
        return (self.folder / name).read_bytes()

    def test_finer_levels_are_added(self):
        self.bring("0-1")
        self.assert_gdal_opens(2)
        summary, _ = self.bring("2-2")
        self.assertEqual(summary["stored"], servers.tiles_in(3) - servers.tiles_in(2))
        self.assertEqual(set(self.server.counts().values()), {1})
        self.assert_gdal_opens(3)
        self.assertEqual([row[0] for row in self.query("SELECT zoom_level FROM gpkg_tile_matrix ORDER BY 1")], [0, 1, 2])
        # A run with fewer levels takes none away, and a viewer with more of them adds the rest.
        self.bring("0-0")
        self.assert_gdal_opens(3)
        remote = self.render(self.server.template, "remote.png", "--max-level", "3", "--cache", self.cache)
        self.assert_gdal_opens(4)
        self.assertEqual(self.render(self.cache, "disk.png"), remote)
        self.assert_stored_are_right()

    def test_coarser_levels_are_added(self):
        deep = self.write("deep.json", json.dumps({"url": self.server.template, "min_level": 1, "max_level": 2}).encode())
        self.preload(deep)
        summary, _ = self.bring("0-3")
        self.assertEqual((summary["there"], summary["stored"]),
                         (servers.tiles_in(3) - 2, servers.tiles_in(4) - servers.tiles_in(3) + 2))
        self.assert_gdal_opens(4)
        self.assert_sound()

    def test_caches_of_different_levels_are_joined(self):
        self.bring("0-1")
        first, self.cache = self.cache, self.folder / "finer.gpkg"
        self.bring("2-3")
        self.assert_done("merge", first, self.cache, "-o", "joined.gpkg")
        self.cache = self.folder / "joined.gpkg"
        self.assert_gdal_opens(4)
        self.assertEqual(len(self.stored()), servers.tiles_in(4))
        told = json.loads(self.assert_done("info", "joined.gpkg", "--json").stdout)
        self.assertEqual(told["cache"]["pinned_tiles"], servers.tiles_in(4))


class GoneFromTheServer(LimitTest):
    levels = 3

    def test_a_refresh_keeps_what_is_stored(self):
        self.bring("0-2")
        before = self.stored()
        self.root.rename(self.folder / "away")
        self.root.mkdir()
        summary, said = self.bring("0-2", "--refresh-older-than", "0", code=DONE_IN_PART)
        self.assertEqual((summary["kept"], summary["absent"]), (servers.tiles_in(3), 0))
        self.assertIn(f"{servers.tiles_in(3)} tiles that were stored are no longer on the server", said)
        self.assertEqual(self.stored(), before)
        self.assertEqual(self.query("SELECT count(*) FROM terrella_cache_absences"), [(0,)])
        self.root.rmdir()
        (self.folder / "away").rename(self.root)
        summary, _ = self.bring("0-2", "--refresh-older-than", "0")
        self.assertEqual(summary["unchanged"], servers.tiles_in(3))

    def test_a_viewer_keeps_what_is_stored(self):
        source = self.write("source.json", json.dumps({"url": self.server.template, "max_level": 2,
                                                       "tile_life_s": 0}).encode())
        shots = []
        for name in "before.png", "after.png":
            self.assert_done("render", source, "-o", name, *VIEW, "--cache", self.cache)
            shots.append((self.folder / name).read_bytes())
            stored = self.stored()
            shutil.rmtree(self.root)
            self.root.mkdir()
        self.assertIn(404, {status for status, _ in self.server.requests()})
        self.assertEqual(*shots)
        self.assertTrue(stored)
        self.assertEqual(self.query("SELECT count(*) FROM terrella_cache_absences"), [(0,)])
        # The program asks again after the life of an absence, not with each look.
        before = len(self.server.requests())
        self.assert_done("render", source, "-o", "again.png", *VIEW, "--cache", self.cache)
        self.assertEqual(len(self.server.requests()), before)


class Merges(LimitTest):
    levels = 3

    def setUp(self):
        super().setUp()
        self.bring("0-2")

    def left(self, folder):
        return sorted(path.name for path in folder.iterdir())

    def test_a_disk_that_is_full_keeps_nothing_of_it(self):
        whole = self.cache.stat().st_size
        before = self.left(self.folder)
        for limit in 512, 4096, 20_000, 50_000, whole // 2:
            self.assert_fails(FAILED, "merge", self.cache, "-o", "joined.gpkg", file_size_limit=limit,
                              says=["joined.gpkg", "make space"])
            self.assertEqual(self.left(self.folder), before, limit)

    def test_a_small_disk_that_is_full_keeps_nothing_of_it(self):
        for size in "16k", "64k", "128k":
            disk = servers.SmallDisk(self.folder / f"disk{size}", size)
            self.addCleanup(disk.unmount)
            if not disk.mounted:
                print("no small disk can be mounted here")  # only root may
                return
            self.assert_fails(FAILED, "merge", self.cache, "-o", disk.folder / "joined.gpkg",
                              says=["joined.gpkg", "make space"])
            self.assertEqual(self.left(disk.folder), [], size)

    def test_a_cache_that_was_cut_off_is_called_damaged(self):
        whole = self.cache.read_bytes()
        for size in len(whole) // 2, 5000, 100:
            part = self.write("part.gpkg", whole[:size])
            done = self.assert_fails(FAILED, "merge", self.cache, part, "-o", "joined.gpkg",
                                     says=["part.gpkg", "damaged or was cut off"])
            self.assertNotIn("not a cache", done.stderr)


class OpenFiles(LimitTest):
    levels = 6

    def test_more_connections_than_open_files(self):
        for soft, hard, says in (32, 32, "so it is --jobs 16; `ulimit -n"), (32, 4096, None):
            with self.subTest(hard=hard):
                self.cache = self.folder / f"{hard}.gpkg"
                done = subprocess.run(
                    [PROGRAM, "preload", self.server.template, "--levels", "0-5", "--jobs", "64", "-o", self.cache,
                     "--json"], capture_output=True, text=True, timeout=60,
                    preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard)))
                self.assertEqual(done.returncode, DONE, done.stderr)
                self.assertEqual(json.loads(done.stdout)["retries"], 0, "connections that could not be opened")
                if says:
                    self.assertIn(says, done.stderr)
                else:
                    self.assertNotIn("--jobs", done.stderr)


class Locked(LimitTest):
    hold_s = 4.0

    def hold(self, statement):
        """Another program's lock, let go of after a while."""
        base = sqlite3.connect(self.cache, isolation_level=None, check_same_thread=False)
        base.execute("PRAGMA busy_timeout = 20000")
        base.execute(statement)
        timer = threading.Timer(self.hold_s, lambda: (base.execute("COMMIT"), base.close()))
        timer.start()
        self.addCleanup(timer.join)

    def test_on_opening(self):
        self.bring("0-1")
        self.hold("BEGIN EXCLUSIVE")
        _, said = self.bring("0-3")
        self.assertIn(f"{self.cache} is locked by another program", said)
        self.assertEqual(len(self.stored()), servers.tiles_in(4))

    def test_while_it_is_filled(self):
        stored = self.cache.with_name("stored.txt")
        process = subprocess.Popen([PROGRAM, "preload", self.server.template, "-o", self.cache,
                                    "--levels", "0-3", "--rate", "40", "--stored", stored], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                   text=True)
        while process.poll() is None and not (stored.exists() and stored.stat().st_size > 0):
            time.sleep(0.01)
        self.hold("BEGIN IMMEDIATE")
        out, said = process.communicate(timeout=60)
        self.assertEqual(process.returncode, DONE, out + said)
        self.assertIn("is locked by another program", said)
        waiting = [line for line in said.splitlines() if "locked by another program, waiting" in line]
        self.assertTrue(waiting, said)
        self.assertFalse(any("left" in line for line in waiting), said)
        self.assertEqual(len(self.stored()), servers.tiles_in(4))


if __name__ == "__main__":
    unittest.main()
