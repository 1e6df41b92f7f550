"""terrella.distributed on three worker processes. A worker is killed during each kind of work; the result is the same."""

import concurrent.futures
import contextlib
import fcntl
import json
import os
import pathlib
import random
import shutil
import signal
import sqlite3
import subprocess
import tempfile
import time
import unittest

import dask
import servers
import terrella
from distributed import Client, LocalCluster
from program import BLUE_MARBLE, NATURAL_EARTH
from terrella.distributed import plan_cut, plan_film, plan_preload, run

WORKERS = 3
# A task may be on this many workers that die: more than the kills of a test.
dask.config.set({"distributed.scheduler.allowed-failures": 10, "distributed.worker.profile.enabled": False})
random.seed(20260611)
HOME = tempfile.TemporaryDirectory(prefix="terrella-dask-", ignore_cleanup_errors=True)

FLIGHT = {"type": "Feature", "properties": {"duration_s": 2, "pitches": [-40, -90], "times": ["2026-06-21T08:00Z"] * 2},
          "geometry": {"type": "LineString", "coordinates": [[5, 62, 900000], [12, 78, 9000000]]}}
PROJECTIONS = "EPSG:4326", "EPSG:3857", "EPSG:32633"


def setUpModule():
    os.environ["XDG_CACHE_HOME"] = HOME.name
    start_cluster()
    unittest.addModuleCleanup(lambda: (CLIENT.close(), CLUSTER.close()))


def start_cluster():
    global CLIENT, CLUSTER
    CLUSTER = LocalCluster(n_workers=WORKERS, threads_per_worker=1, processes=True, dashboard_address=None,
                           local_directory=HOME.name, silence_logs="CRITICAL")
    CLIENT = Client(CLUSTER)


def tiles(path):
    """Place and bytes of each tile of a GeoPackage."""
    with contextlib.closing(sqlite3.connect(path)) as base:
        return sorted(base.execute("SELECT zoom_level, tile_column, tile_row, tile_data FROM tiles"))


class ClusterTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="terrella-dask-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        try:
            CLIENT.wait_for_workers(WORKERS, timeout=20)
        except TimeoutError:  # Dask does not always start a killed worker again
            CLIENT.close()
            CLUSTER.close()
            start_cluster()

    def run_and_kill(self, plan, has_begun):
        """Runs a plan, and kills one of the workers that have tasks as soon as the work has begun."""
        with concurrent.futures.ThreadPoolExecutor(1) as pool:
            running = pool.submit(run, CLIENT, plan)
            while not has_begun():
                self.assertFalse(running.done(), "the work was done before a worker was killed")
                time.sleep(0.005)
            pids = {worker.worker_address: worker.pid for worker in CLUSTER.workers.values()}
            busy = [pids[address] for address, tasks in CLIENT.processing().items() if tasks and pids.get(address)]
            self.assertTrue(busy, "no worker had work when one was to be killed")
            os.kill(random.choice(busy), signal.SIGKILL)
            return running.result()

    def assert_nothing_but(self, *names):
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), sorted(names))


class Cut(ClusterTest):
    def cut_and_kill(self, picture, **options):
        """Cuts on the cluster and on one machine."""
        terrella.cut(picture, output=self.folder / "whole.gpkg", name="n", **options)
        output = self.folder / "out.gpkg"
        plan = plan_cut(picture, output=output, parts=4, name="n", jobs=1, **options)
        report = self.run_and_kill(plan, lambda: any(self.folder.glob("out.gpkg.shard-*/*.part")))
        self.assertEqual(output.read_bytes(), (self.folder / "whole.gpkg").read_bytes())
        self.assertEqual(len(report.parts), 4)
        self.assertEqual(report.joined["tiles"], len(tiles(output)))

    def test_a_picture(self):
        self.cut_and_kill(BLUE_MARBLE, tile_size=32)
        self.assert_nothing_but("out.gpkg", "whole.gpkg")

    def test_a_folder_in_three_projections(self):
        pictures = self.folder / "pictures"
        pictures.mkdir()
        placed = self.folder / "placed.vrt"
        subprocess.run(["gdal_translate", "-q", "-of", "VRT", "-a_srs", "EPSG:4326", "-a_ullr", "-180", "90", "180", "-90",
                        BLUE_MARBLE, placed], check=True)
        for k in range(6):
            box = map(str, (6 + 4 * k, 40 + 3 * k, 12 + 4 * k, 46 + 3 * k))
            subprocess.run(["gdalwarp", "-q", "-t_srs", PROJECTIONS[k % 3], "-te", *box, "-te_srs", "EPSG:4326", "-ts",
                            "400", "400", placed, pictures / f"{k}.tif"], check=True)
        self.cut_and_kill(pictures, tile_size=16)
        self.assert_nothing_but("out.gpkg", "whole.gpkg", "pictures", "placed.vrt")

    def test_a_part_that_another_process_does_is_waited_for(self):
        plan = plan_cut(BLUE_MARBLE, output=self.folder / "out.gpkg", parts=2, tile_size=64)
        os.mkdir(plan.work)
        with open(f"{plan.work}/1-of-2.lock", "w") as lock, concurrent.futures.ThreadPoolExecutor(1) as pool:
            fcntl.flock(lock, fcntl.LOCK_EX)
            running = pool.submit(run, CLIENT, plan)
            while not any(self.folder.glob("out.gpkg.shard-2-of-2/*.rows")):
                self.assertFalse(running.done())
                time.sleep(0.005)
            self.assertFalse((self.folder / "out.gpkg.shard-1-of-2").exists())
            fcntl.flock(lock, fcntl.LOCK_UN)
            running.result()
        self.assert_nothing_but("out.gpkg")

    def test_a_part_that_waits_for_a_finished_run_writes_nothing(self):
        plan = plan_cut(BLUE_MARBLE, output=self.folder / "out.gpkg", parts=2, tile_size=64)
        locked = terrella.distributed._locked
        with concurrent.futures.ThreadPoolExecutor(1) as pool:
            with locked(plan, "1-of-2") as path:
                waiting = pool.submit(terrella.distributed._work, plan, 1)
                while self.descriptors(path) < 2:
                    time.sleep(0.005)
                os.unlink(path)
            with self.assertRaisesRegex(terrella.Error, "out.gpkg: another run of this plan has finished"):
                waiting.result()
            self.assertFalse((self.folder / "out.gpkg.shard-1-of-2").exists())
            with locked(plan, "2-of-2") as path:
                waiting = pool.submit(terrella.distributed._work, plan, 2)
                while self.descriptors(path) < 2:
                    time.sleep(0.005)
                os.unlink(path)
                again = open(path, "w")  # another run does this part
                fcntl.flock(again, fcntl.LOCK_EX)
            while self.descriptors(path) < 2:
                time.sleep(0.005)
            self.assertFalse((self.folder / "out.gpkg.shard-2-of-2").exists())
            again.close()
            waiting.result()
        self.assertTrue((self.folder / "out.gpkg.shard-2-of-2").exists())

    def descriptors(self, path):
        """Number of descriptors that this process has open at a path."""
        names = []
        for descriptor in pathlib.Path("/proc/self/fd").iterdir():
            with contextlib.suppress(OSError):
                names.append(os.readlink(descriptor))
        return names.count(path)

    def test_parts_of_other_plans_stay(self):
        for parts in 2, 3:
            terrella.distributed._work(plan_cut(BLUE_MARBLE, output=self.folder / "out.gpkg", parts=parts, tile_size=64), 1)
        run(CLIENT, plan_cut(BLUE_MARBLE, output=self.folder / "out.gpkg", parts=2, tile_size=64))
        self.assert_nothing_but("out.gpkg", "out.gpkg.shard-1-of-3", "out.gpkg.work")
        self.assertEqual(os.listdir(self.folder / "out.gpkg.work"), ["1-of-3.lock"])

    def test_a_join_may_run_again(self):
        plan = plan_cut(BLUE_MARBLE, output=self.folder / "out.gpkg", parts=2, tile_size=64)
        for index in 1, 2:
            terrella.distributed._work(plan, index)
        terrella.distributed._join(plan)
        first = (self.folder / "out.gpkg").read_bytes()
        terrella.distributed._join(plan)
        self.assertEqual((self.folder / "out.gpkg").read_bytes(), first)


class Preload(ClusterTest):
    LEVELS, BOX = 5, (-180, -90, 0, 90)
    PLACES = [(z, x, y) for z, x, y in servers.places(LEVELS) if x < 1 << z]  # 341

    def setUp(self):
        super().setUp()
        servers.write_pyramid(self.folder / "tiles", self.LEVELS)
        self.server = self.enterContext(servers.nginx(self.folder / "tiles"))
        self.output = self.folder / "out.gpkg"

    def plan(self, **options):
        return plan_preload(self.server.template, output=self.output, parts=3,
                            **({"levels": (0, self.LEVELS - 1), "bbox": self.BOX} | options))

    def test_the_rate_is_that_of_the_cluster(self):
        terrella.preload(self.server.template, output=self.folder / "whole.gpkg", levels=(0, 4), bbox=self.BOX)
        before, begun, rate = len(self.server.requests()), time.monotonic(), 80
        self.run_and_kill(self.plan(rate=rate), lambda: len(self.server.requests()) > before + 50)
        seconds, asked = time.monotonic() - begun, len(self.server.requests()) - before
        self.assertEqual(tiles(self.output), tiles(self.folder / "whole.gpkg"))
        self.assertGreaterEqual(asked, len(self.PLACES))
        burst = rate / 4  # all parts together, whose buckets may be full at the beginning
        self.assertLessEqual(asked, rate * seconds + burst)
        self.assert_nothing_but("out.gpkg", "whole.gpkg", "tiles")

    def test_a_lacking_tile_is_told_and_comes_with_the_next_run(self):
        levels, place = {"levels": (0, 1), "rate": 200}, self.folder / "tiles/1/0/1.jpg"
        good = place.read_bytes()
        place.write_text("an error page")
        with self.assertWarnsRegex(terrella.IncompleteWarning, "1 tiles are missing"):
            run(CLIENT, self.plan(**levels))
        self.assertEqual(len(tiles(self.output)), 4)
        place.write_bytes(good)
        asked = len(self.server.requests())
        report = run(CLIENT, self.plan(**levels))
        self.assertEqual(self.server.requests()[asked:], [(200, "/1/0/1.jpg")])
        self.assertEqual([z for z, *_ in tiles(self.output)], [0, 1, 1, 1, 1])
        self.assertEqual(report.joined["tiles"], 5)
        self.assert_nothing_but("out.gpkg", "tiles")


class Film(ClusterTest):
    def test_frames(self):
        (self.folder / "f.geojson").write_text(json.dumps(FLIGHT))
        film = {"tileset": NATURAL_EARTH, "flight": self.folder / "f.geojson", "fps": 3, "size": (96, 64), "cache": "off"}
        alone = terrella.film(**film, output=self.folder / "whole/%02d.png")
        self.assertEqual(alone["frames"], 6)
        plan = plan_film(**film, output=self.folder / "frames/%02d.png", parts=3)
        report = self.run_and_kill(plan, (self.folder / "frames/film.json").exists)
        self.assertIsNone(report.joined)
        self.assertEqual([part["frames"] for part in report.parts], [2, 2, 2])
        whole, frames = ({path.name: path.read_bytes() for path in (self.folder / folder).iterdir()}
                         for folder in ("whole", "frames"))
        self.assertEqual(len(whole), 6 + 1)
        self.assertEqual(frames, whole)


class Errors(ClusterTest):
    def test_errors_are_those_of_the_functions(self):
        output = self.folder / "out.gpkg"
        with self.assertRaisesRegex(terrella.Error, "nowhere.tif: no such file"):
            run(CLIENT, plan_cut(self.folder / "nowhere.tif", output=output, parts=2))
        with self.assertRaisesRegex(ValueError, "tile-size"):
            run(CLIENT, plan_cut(BLUE_MARBLE, output=output, parts=2, tile_size=7))
        self.assertFalse(output.exists())


if __name__ == "__main__":
    unittest.main()
