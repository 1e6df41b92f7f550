"""Routes with a radius, hours of the day, and `terrella purge`, against a real server."""

import json
import math
import sqlite3
import subprocess
import time
import unittest

import georeferenced
import servers
from preload_test import PyramidTest
from program import DONE, DONE_IN_PART, FAILED, PROGRAM, WRONG_USAGE

LEVELS = 6
ALL = servers.tiles_in(LEVELS)
DAY_S = 86400
EARTH_M = 6371008.8


class PurgeTest(PyramidTest):
    LEVELS = LEVELS

    def setUp(self):
        super().setUp()
        self.words = ["--levels", f"0-{LEVELS - 1}"]

    def purge(self, *options, code=DONE, cache=None):
        done = self.run_program("purge", cache or self.cache, "--json", *options)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return json.loads(done.stdout) if code == DONE else done.stderr

    def purge_as_said(self, *options):
        """The dry run says what is purged, and changes nothing."""
        before = self.cache.read_bytes()
        told = self.purge(*options, "--dry-run")
        self.assertEqual(self.cache.read_bytes(), before, "a dry run changes the file")
        done = self.purge(*options)
        for field in ("tiles", "absences"):
            self.assertEqual(done[field], told[field], options)
        self.assertEqual(done["caches"][0]["tile_bytes"], told["caches"][0]["tile_bytes"])
        self.assert_sound()
        self.assert_stored_are_right()
        return done

    def set_times(self, column, **levels):
        """Makes the tiles of levels so many days old."""
        base = sqlite3.connect(self.cache)
        for level, days in levels.items():
            base.execute(f"UPDATE terrella_cache_tiles SET {column} = ? WHERE id IN (SELECT id FROM tiles WHERE "
                         "zoom_level = ?)", (int(time.time()) - days * DAY_S, int(level[1:])))
        base.commit()
        base.close()


class Purge(PurgeTest):
    def test_area_and_levels_are_purged_given_back_and_preloaded_again(self):
        self.preload(self.server.template, *self.words)
        self.assertEqual(len(self.stored()), ALL)
        whole = self.cache.stat().st_size
        area = ["--bbox=0,0,90,45", "--levels", "3-5"]
        wanted, _ = self.preload(self.server.template, *area, "--dry-run")
        done = self.purge_as_said(*area)
        self.assertEqual(done["tiles"], wanted["tiles"])
        left = self.stored()
        self.assertEqual(len(left), ALL - done["tiles"])
        self.assertEqual({level for level, *_ in set(servers.places(LEVELS)) - set(left)}, {3, 4, 5})
        # The file has no free pages, no log, and is one that GDAL reads.
        self.assertLess(self.cache.stat().st_size, whole - 0.9 * done["caches"][0]["tile_bytes"])
        self.assertEqual(self.cache.stat().st_size, done["caches"][0]["file_bytes"])
        self.assertEqual([path.name for path in self.folder.glob("cache.gpkg-*")], [])
        base = sqlite3.connect(self.cache)
        self.assertEqual(base.execute("PRAGMA freelist_count").fetchone(), (0,))
        self.assertEqual(base.execute("SELECT count(*) FROM terrella_cache_tiles").fetchone(), (len(left),))
        base.close()
        told = json.loads(georeferenced.gdal("gdalinfo", "-json", self.cache))
        self.assertEqual(told["size"], [512 << (LEVELS - 1), 256 << (LEVELS - 1)])
        georeferenced.gdal("gdal_translate", "-q", "-outsize", "256", "128", self.cache, self.folder / "small.tif")
        # The next preload requests all that was purged, and nothing else.
        cut = self.server.cut()
        summary, _ = self.preload(self.server.template, *self.words)
        self.assertEqual(summary["stored"], done["tiles"])
        self.assertEqual(self.server.asked_since(cut), set(servers.places(LEVELS)) - set(left))
        self.assertEqual(len(self.stored()), ALL)

    def test_age_of_storing_and_of_use(self):
        self.preload(self.server.template, *self.words)
        self.set_times("stored", _5=40, _4=20)
        self.assertEqual(self.purge_as_said("--older-than", "30")["tiles"], 2 << 10)
        self.assertEqual(self.purge_as_said("--older-than", "30")["tiles"], 0)
        self.assertEqual(self.purge_as_said("--older-than", "10", "--bbox=0,0,180,90")["tiles"], (2 << 8) // 4)
        # Preloaded tiles are pinned and have no last use.
        self.assertEqual(self.purge_as_said("--unused-for", "0")["tiles"], 0)
        self.run_program("preload", self.server.template, *self.words, "-o", self.cache, "--release")
        self.set_times("used", _3=9)
        self.assertEqual(self.purge_as_said("--unused-for", "7")["tiles"], (2 << 6) + 3 * (2 << 8) // 4)
        self.assertEqual(self.purge_as_said("--all")["tiles"], len(servers.places(3)))
        self.assertEqual(self.stored(), {})

    def test_records_of_missing_tiles_go_too(self):
        summary, _ = self.preload(self.server.template, "--levels", f"0-{LEVELS}", "--bbox=0,0,20,20")
        self.assertGreater(summary["absent"], 0)
        self.assertEqual(self.purge_as_said("--levels", f"{LEVELS}")["absences"], summary["absent"])
        again, _ = self.preload(self.server.template, "--levels", f"0-{LEVELS}", "--bbox=0,0,20,20")
        self.assertEqual(again["absent"], summary["absent"])

    def test_dated_caches_by_their_times(self):
        for day in (1, 2, 3):
            self.cache = self.folder / f"june.2026-06-0{day}.gpkg"
            self.preload(self.server.template, "--levels", "0-1")
        done = self.purge("--times", "2026-06-01/2026-06-02", cache=self.folder / "june.gpkg")
        self.assertEqual([one["cache"][-15:] for one in done["caches"]], ["2026-06-01.gpkg", "2026-06-02.gpkg"])
        self.assertEqual(done["tiles"], 2 * servers.tiles_in(2))
        self.assertEqual(len(self.stored()), servers.tiles_in(2), "of the third day")
        self.assertIn("no such file", self.purge("--times", "2026-06-01", cache=self.folder / "july.gpkg", code=FAILED))
        self.assertIn("name the cache", self.purge("--times", "2026-06-01", cache=self.folder / "none/june.gpkg", code=FAILED))

    def test_only_dated_caches_of_the_named_times_are_purged(self):
        days = ["2026-05-31", "2026-06-01", "2026-06-03"]
        for day in days:
            self.cache = self.folder / f"june.{day}.gpkg"
            self.preload(self.server.template, "--levels", "0-1")
        june = self.folder / "june.gpkg"
        for times, wanted in (("2026-06", days[1:]), ("2026-06-03", days[2:]), ("2026-05-30/2026-06-01T12:00", days[:2]),
                              ("2026-05-30/2026-06-30/P2D", days[1:]), ("2026-05-31,2026-06-03", [days[0], days[2]])):
            found = [one["cache"][-15:-5] for one in self.purge("--times", times, "--dry-run", cache=june)["caches"]]
            # P2D begins on the 30th: 1 and 3 June are its instants, 31 May is not.
            self.assertEqual(found, wanted, times)
        for times in ("2026-06-10", "2026-06-02", "2026-06-01,2026-06-02", "2026-06-02/2026-06-02", "2026-06-02/2026-06-06/P2D"):
            said = self.purge("--times", times, cache=june, code=FAILED)
            self.assertIn("there is nothing of", said)
            self.assertIn("2026-05-31 to 2026-06-03", said)
        self.assertEqual(len(self.stored()), servers.tiles_in(2))

    def test_an_area_keeps_the_tiles_that_reach_beyond_it(self):
        self.preload(self.server.template, *self.words)
        done = self.purge_as_said("--bbox=0,0,90,45")
        # Tiles are 180° / 2^level wide; the corner tile of 90° × 45° is inside from level 2 on.
        gone = set(servers.places(LEVELS)) - set(self.stored())
        self.assertEqual(done["tiles"], len(gone))
        self.assertEqual(gone, {(z, x, y) for z, x, y in servers.places(LEVELS)
                                if 0 <= x * 180 - (180 << z) and (x + 1) * 180 - (180 << z) <= 90 << z
                                and 45 << z <= y * 180 and (y + 1) * 180 <= 90 << z})
        self.assertEqual({z for z, *_ in gone}, {2, 3, 4, 5})
        self.assertIn("no tile lies wholly within", self.purge("--bbox=1,1,2,2", code=FAILED))
        self.assertEqual(self.purge("--bbox=1,1,2,2", "--levels", "0")["tiles"], 1)

    def test_a_purge_that_finds_nothing_takes_no_lock(self):
        summary, _ = self.preload(self.server.template, "--levels", f"0-{LEVELS}", "--bbox=0,0,20,20")
        self.assertGreater(summary["absent"], 0)
        base = sqlite3.connect(self.cache)
        self.addCleanup(base.close)
        base.execute("BEGIN IMMEDIATE")
        for words in (["--older-than", "30"], ["--older-than", "30", "--bbox=0,0,20,20"]):
            done = self.run_program("purge", self.cache, *words, time_limit_s=50)
            self.assertEqual(done.returncode, DONE, done.stderr)
            self.assertIn("0 tiles", done.stdout)
        base.rollback()

    def test_many_records_are_purged_in_steps(self):
        self.preload(self.server.template, "--levels", "0-1")
        base = sqlite3.connect(self.cache)
        count, places = 9000, servers.tiles_in(2)
        base.executemany("INSERT INTO terrella_cache_absences VALUES (?, ?, ?, 'absent', '', '', '', ?, NULL)",
                         [(9 + n % 3, n // 7, n % 7, n % 2) for n in range(count)])
        base.commit()
        base.close()
        self.assertEqual(self.purge("--all", "--dry-run")["absences"], count)
        self.assertEqual(self.purge("--older-than", "1")["absences"], count)
        done = self.purge_as_said("--all")
        self.assertEqual((done["tiles"], done["absences"]), (places, 0))

    def test_other_files_are_refused_and_stay(self):
        other = self.folder / "other.gpkg"
        base = sqlite3.connect(other)
        base.execute("CREATE TABLE tiles (id INTEGER)")
        base.commit()
        base.close()
        (self.folder / "text.gpkg").write_text("no database")
        for name in ("other.gpkg", "text.gpkg"):
            before = (self.folder / name).read_bytes()
            for options in (["--all"], ["--levels", "0"], ["--older-than", "1", "--dry-run"]):
                self.assertIn("is not a cache", self.purge(*options, cache=self.folder / name, code=FAILED))
            self.assertEqual((self.folder / name).read_bytes(), before)
        self.assertIn("no such file", self.purge("--all", code=FAILED))
        self.preload(self.server.template, "--levels", "0-1")
        self.assertIn("--all", self.purge(code=WRONG_USAGE))
        self.assertIn("--all purges every tile", self.purge("--all", "--levels", "0", code=WRONG_USAGE))
        self.assertIn("has levels 0 to 1", self.purge("--levels", "0-7", code=FAILED))


class Route(PurgeTest):
    def route(self, *places):
        path = self.folder / "route.geojson"
        path.write_text(json.dumps({"type": "LineString", "coordinates": places}))
        return ["--route", path, "--radius", "700000"]

    def near(self, start, end, radius_m):
        """The tiles with a place near a great circle of the sphere, by places in each tile."""

        def vector(lon, lat):
            lon, lat = math.radians(lon), math.radians(lat)
            return math.cos(lat) * math.cos(lon), math.cos(lat) * math.sin(lon), math.sin(lat)

        def away_m(a, b):
            return math.acos(min(1.0, sum(x * y for x, y in zip(a, b)))) * EARTH_M

        a, b = vector(*start), vector(*end)
        angle = away_m(a, b) / EARTH_M
        way = [[(math.sin((1 - t) * angle) * x + math.sin(t * angle) * y) / math.sin(angle) for x, y in zip(a, b)]
               for t in (n / 100 for n in range(101))]
        found = set()
        for z, x, y in servers.places(LEVELS):
            span = 180 / (1 << z)
            west, north = -180 + x * span, 90 - y * span
            middle = vector(west + span / 2, north - span / 2)
            if min(away_m(middle, place) for place in way) > radius_m + math.radians(span) * EARTH_M:
                continue
            inner = [vector(west + span * i / 24, north - span * j / 24) for i in range(25) for j in range(25)]
            least = math.cos(radius_m / EARTH_M)
            if any(sum(p * q for p, q in zip(one, place)) >= least for one in inner for place in way):
                found.add((z, x, y))
        return found

    def test_route_over_the_antimeridian_is_preloaded_and_purged_exactly(self):
        words = [*self.route([165, 50], [-160, 62]), *self.words]
        told, _ = self.preload(self.server.template, *words, "--dry-run")
        self.preload(self.server.template, *words)
        stored = set(self.stored())
        self.assertEqual(told["tiles"], len(stored))
        # The sphere differs from the ellipsoid by less than 1 part in 150.
        self.assertLessEqual(self.near((165, 50), (-160, 62), 690000), stored)
        self.assertLessEqual(stored, self.near((165, 50), (-160, 62), 740000))
        self.assertEqual(self.purge_as_said(*words)["tiles"], told["tiles"])
        self.assertEqual(self.stored(), {})

    def test_route_in_a_task_file_and_wrong_usage(self):
        (self.folder / "task.json").write_text(json.dumps(
            {"command": "preload", "SOURCE": self.server.template, "output": str(self.cache), "levels": f"0-{LEVELS - 1}",
             "route": str(self.route([5, 44], [16, 48])[1]), "radius": 50000}))
        done = self.run_program("preload", "--task", self.folder / "task.json", "--json")
        self.assertEqual(done.returncode, DONE, done.stderr)
        self.assertEqual(json.loads(done.stdout)["stored"], len(self.stored()))
        for words in (["--radius", "5"], self.route([5, 44], [16, 48])[:2]):
            _, said = self.preload(self.server.template, *self.words, *words, code=WRONG_USAGE)
            self.assertIn("--route and --radius go together", said)
        _, said = self.preload(self.server.template, *self.words, *self.route([5, 44]), code=FAILED)
        self.assertIn("route.geojson: a line has fewer than 2 positions", said)


class Hours(PurgeTest):
    def test_it_waits_for_the_hours_and_stops_by_a_signal(self):
        later = time.gmtime(time.time() + 3 * 3600)
        begin, end = f"{later.tm_hour:02}:00", f"{(later.tm_hour + 1) % 24:02}:00"
        process = self.begin("preload", self.server.template, *self.words, "-o", self.cache, "--between", f"{begin}-{end}Z")
        line = process.stderr.readline()
        self.assertRegex(line, rf"outside of --between {begin}-{end}Z; waiting \d")
        process.terminate()
        out, said = process.communicate(timeout=60)
        self.assertEqual(process.returncode, DONE_IN_PART, said)
        self.assertNotIn("waiting", said, "it says so once")
        self.assertIn(f"stopped with {ALL} of {ALL} tiles to go", said)
        self.assertEqual(self.server.requests(), [])
        # Within the hours.
        summary, said = self.preload(self.server.template, *self.words, "--between", f"{end}-{begin}Z")
        self.assertEqual(summary["stored"], ALL)
        self.assertNotIn("outside", said)
        # With nothing to request it does not wait.
        summary, said = self.preload(self.server.template, *self.words, "--between", f"{begin}-{end}Z", time_limit_s=50)
        self.assertEqual(summary["there"], ALL)
        self.assertNotIn("outside", said)

    def test_a_cache_in_use_is_purged_and_shrinks(self):
        self.preload(self.server.template, *self.words, "--bbox=0,0,90,45")
        whole = self.cache.stat().st_size
        later = time.gmtime(time.time() + 3 * 3600)
        process = self.begin("preload", self.server.template, *self.words, "-o", self.cache, "--between",
                             f"{later.tm_hour:02}:00-{later.tm_hour:02}:30Z")
        self.assertIn("waiting", process.stderr.readline())  # and has the cache open
        done = self.purge("--levels", "5")
        self.assertGreater(done["tiles"], 100)
        self.assertLess(self.cache.stat().st_size, whole - 0.9 * done["caches"][0]["tile_bytes"])
        process.terminate()
        process.communicate(timeout=60)
        self.assertEqual(process.returncode, DONE_IN_PART)
        self.assert_sound()
        self.assertEqual([path.name for path in self.folder.glob("cache.gpkg-*")], [])

    def begin(self, *words):
        return subprocess.Popen([PROGRAM, *map(str, words)], cwd=self.folder, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, text=True)


if __name__ == "__main__":
    unittest.main()
