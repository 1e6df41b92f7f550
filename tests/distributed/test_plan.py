"""Plans of terrella.distributed: values that are made without a look at anything, and the need for Dask."""

import pathlib
import pickle
import subprocess
import sys
import unittest

from terrella.distributed import plan_cut, plan_film, plan_preload

# Events of Python begin so when a program looks at files, servers or processes.
LOOKS = ("open", "os.", "socket.", "subprocess.", "glob.", "shutil.")


def plans(parts=7):
    return [plan_cut("/nowhere/planet.tif", output="/nowhere/planet.gpkg", parts=parts, tile_size=512),
            plan_preload("http://127.0.0.1:9/{z}/{x}/{y}.jpg", output="/nowhere/cache.gpkg", parts=parts, rate=70),
            plan_film("/nowhere/earth.gpkg", flight="/nowhere/f.geojson", output="/nowhere/%03d.png", parts=parts)]


class Plans(unittest.TestCase):
    def test_equal_arguments_make_equal_plans(self):
        self.assertEqual(plans(), plans())
        self.assertNotEqual(plans(), plans(parts=8))
        self.assertEqual(pickle.loads(pickle.dumps(plans())), plans())

    def test_tasks_are_the_shards(self):
        cut, preload, film = plans()
        for plan in cut, preload, film:
            self.assertEqual([plan.task(k)["shard"] for k in range(1, 8)], [(k, 7) for k in range(1, 8)])
        self.assertEqual(cut.task(3), {"image": "/nowhere/planet.tif", "output": "/nowhere/planet.gpkg",
                                       "shard": (3, 7), "tile_size": 512})
        self.assertEqual({film.task(k)["output"] for k in range(1, 8)}, {"/nowhere/%03d.png"})
        self.assertEqual(len({preload.task(k)["output"] for k in range(1, 8)}), 7)

    def test_work_lies_beside_a_folder(self):
        self.assertEqual(plan_cut("/p", output="/there/tiles/", parts=2).work, "/there/tiles.work")

    def test_parts_share_the_rate(self):
        for parts in 1, 7, 1000:
            plan = plan_preload("/s", output="/c.gpkg", parts=parts, rate=70)
            self.assertAlmostEqual(sum(plan.task(k)["rate"] for k in range(1, parts + 1)), 70)
        self.assertNotIn("rate", plan_preload("/s", output="/c.gpkg", parts=3, rate=None).task(1))

    def test_a_plan_looks_at_nothing(self):
        seen, watching = [], [False]
        sys.addaudithook(lambda event, _: seen.append(event) if watching[0] and event.startswith(LOOKS) else None)
        watching[0] = True
        for plan in plans(parts=7000):
            plan.task(6999)
        watching[0] = False
        self.assertEqual(seen, [])
        watching[0] = True
        open(__file__).close()
        watching[0] = False
        self.assertEqual(seen, ["open"])

    def test_wrong_plans_are_refused(self):
        where = {"output": "/o.gpkg", "parts": 3}
        for says, make in [("parts 0", lambda: plan_cut("/p", output="/o", parts=0)),
                           ("100000", lambda: plan_cut("/p", output="/o", parts=100_001)),
                           ("shard", lambda: plan_cut("/p", **where, shard=(1, 2))),
                           ("join", lambda: plan_cut("/p", **where, join=True)),
                           ("fewer parts", lambda: plan_preload("/s", **where, rate=0.02)),
                           ("rate", lambda: plan_preload("/s", **where, rate=float("nan"))),
                           ("ends in .gpkg", lambda: plan_preload("/s", output="/o.pmtiles", parts=3, rate=1)),
                           ("times", lambda: plan_preload("/s", **where, rate=1, times="2026-06-01")),
                           ("force", lambda: plan_film(flight="/f", output="/%d.png", parts=3, force=True)),
                           ("%05d", lambda: plan_film(flight="/f", output="/film.mp4", parts=3))]:
            with self.subTest(says), self.assertRaisesRegex(ValueError, says):
                make()

    def test_relative_paths_are_refused(self):
        server = "http://127.0.0.1:9/{z}/{x}/{y}.jpg"
        film = {"flight": "/f.geojson", "output": "/%d.png", "parts": 3}
        for make in (lambda: plan_cut("/p", output="rel", parts=3),
                     lambda: plan_cut("rel", output="/o", parts=3),
                     lambda: plan_cut(["/p", pathlib.Path("rel")], output="/o", parts=3),
                     lambda: plan_preload("rel", output="/o", parts=3, rate=None),
                     lambda: plan_preload(server, output="rel", parts=3, rate=None),
                     lambda: plan_film("rel", **film),
                     lambda: plan_film(**film | {"flight": "rel"}),
                     lambda: plan_film(**film | {"output": "rel%d.png"})):
            with self.assertRaisesRegex(ValueError, "rel.*: each worker .* give an absolute path"):
                make()
        plan_film(server, **film)

    def test_without_dask_the_module_names_the_package(self):
        code = "import sys; sys.modules['distributed'] = None; import terrella; import terrella.distributed"
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr.splitlines()[-1], "ImportError: .*install the package python3-distributed")


if __name__ == "__main__":
    unittest.main()
