"""`render` from a server: cold, warm, offline and with a server that misbehaves."""

import json
import sys

from program import BLUE_MARBLE, DONE, DONE_IN_PART, SOURCE, ProgramTest

sys.path.insert(0, str(SOURCE / "tests/preload"))
sys.path.insert(0, str(SOURCE / "tests/window"))
import servers  # noqa: E402

LEVELS = 3
VIEW = ("--unlit", "--camera", "30,20,6000000", "--size", "512x512")

# What a tile suffers, and what the summary must say of it. Each of the program's attempts meets it.
FAULTS = {
    "403": "403",
    "404": "404",
    "500": "500",
    "truncated_jpeg": "",
    "html200": "",
    "loop": "redirect",
    "bomb": "",
    "reset": "",
    "empty": "",
}


class RemoteTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.pyramid = self.folder / "tiles"
        servers.write_pyramid(self.pyramid, LEVELS)

    def describe(self, template, **more):
        description = {"url": template, "max_level": LEVELS - 1, **more}
        return self.write("source.json", json.dumps(description).encode())

    def render(self, source, name, *more):
        done = self.run_program("render", source, "-o", name, *VIEW, "--cache", "cache.gpkg", *more)
        return done, (self.folder / name).read_bytes() if (self.folder / name).exists() else b""

    def test_cold_warm_offline_and_without_its_server_the_pixels_are_the_same(self):
        with servers.nginx(self.pyramid, "--no-expiry") as server:
            # A life of no time: each view asks again, with the validators of what it has.
            source = self.describe(server.template, tile_life_s=0)
            cold, first = self.render(source, "cold.png")
            self.assertEqual(cold.returncode, DONE, cold.stderr)
            asked = server.requests()
            self.assertTrue(asked and all(status == 200 for status, _ in asked), asked)
            self.assertEqual(len(asked), len({path for _, path in asked}), "a tile was asked for twice")
            warm, second = self.render(source, "warm.png")
            again = server.requests()[len(asked):]
            self.assertEqual({path for _, path in again}, {path for _, path in asked})
            self.assertTrue(all(status == 304 for status, _ in again), again)
            before = len(server.requests())
            offline, third = self.render(source, "offline.png", "--offline")
            self.assertEqual(len(server.requests()), before, "--offline asked")
        stopped, fourth = self.render(source, "stopped.png")
        for done, picture in (warm, second), (offline, third), (stopped, fourth):
            self.assertEqual(done.returncode, DONE, done.stderr)
            self.assertEqual(picture, first)

    def test_offline_without_a_cache_says_so(self):
        self.assert_fails(1, "render", "http://127.0.0.1:9/{z}/{x}/{y}.jpg", "--offline", "-o", "x.png",
                          says=["127.0.0.1:9", "--offline"])
        self.assert_fails(1, "render", "http://127.0.0.1:9/{z}/{x}/{y}.jpg", "--offline", "--cache", "off", "-o",
                          "x.png", says=["--cache"])

    def test_each_fault_is_named_and_an_ancestor_stands_in(self):
        finest = [f"{LEVELS - 1}/{x}/{y}.jpg" for x in range(3, 6) for y in range(3)]
        faults = dict(zip(finest, FAULTS))
        with servers.misbehaving(self.pyramid, faults) as server:
            done, picture = self.render(self.describe(server.template), "faults.png")
            log = server.log()
        self.assertEqual(done.returncode, DONE_IN_PART, done.stderr)
        self.assertTrue(picture)
        asked = {entry["path"] for entry in log}
        lacking = [path for path in faults if f"/{path}" in asked]
        self.assertGreaterEqual(len(lacking), 6, "the view hardly meets a fault")
        for path in lacking:
            lines = [line for line in done.stderr.splitlines() if path.removesuffix(".jpg") + ":" in line]
            self.assertTrue(lines, f"{path} ({faults[path]}) is not named:\n{done.stderr}")
            self.assertIn(FAULTS[faults[path]], lines[0])
        self.assert_under_the_rate(log)
        # The parents are there, so no pixel of the planet is background.
        self.assert_as_covered(picture)

    def test_a_mistaken_grid_is_named_and_not_drawn(self):
        cut = self.folder / "marble"
        self.assert_done("cut", BLUE_MARBLE, "-o", cut)
        with servers.nginx(cut) as server:
            source = server.template.replace("{y}", "{-y}")
            for _ in range(2):
                self.assert_fails(1, "render", source, "--max-level", "3", "-o", "x.png", *VIEW, says=["{-y}", "other end"])
            self.assert_fails(1, "render", server.template, "--root-span", "360", "--max-level", "3", "-o", "x.png",
                              *VIEW, says=["root"])
            self.assert_done("render", server.template, "--max-level", "3", "-o", "x.png", *VIEW)

    def test_a_server_that_asks_for_patience_gets_it(self):
        path = f"{LEVELS - 1}/4/1.jpg"
        with servers.misbehaving(self.pyramid, {path: "429?retry_after=1&times=1"}) as server:
            done, _ = self.render(self.describe(server.template), "patience.png")
            log = server.log()
        self.assertEqual(done.returncode, DONE, done.stderr)
        times = sorted(entry["time_s"] for entry in log if entry["path"] == f"/{path}")
        self.assertEqual(len(times), 2, log)
        self.assertGreaterEqual(times[1] - times[0], 1.0)
        # What was with the host at that moment may still be answered; nothing new for a second.
        soon = [e for e in log if times[0] + 0.2 < e["time_s"] < times[0] + 0.9]
        self.assertEqual(soon, [], "the pause holds for the host")

    def assert_under_the_rate(self, log):
        """At most the bucket (100) and 200 a second more."""
        times = sorted(entry["time_s"] for entry in log)
        for first in range(len(times)):
            for last in range(first, len(times)):
                self.assertLessEqual(last - first + 1, 100 + 200 * (times[last] - times[first]) + 1)

    def assert_as_covered(self, picture):
        import png
        (self.folder / "read.png").write_bytes(picture)
        _, height, rows = png.read(self.folder / "read.png")
        middle = rows[height // 2]
        self.assertNotIn(b"\0\0\0", {middle[3 * x : 3 * x + 3] for x in range(96, 416)})


class NoServerTest(ProgramTest):
    def test_a_server_that_is_not_there_is_named(self):
        done = self.assert_fails(DONE_IN_PART, "render", "http://127.0.0.1:9/{z}/{x}/{y}.jpg", "--max-level", "2", "-o",
                                 "x.png", *VIEW, says=["127.0.0.1"])
        self.assertIn("lacked", done.stdout)

    def test_a_template_without_a_place_for_the_level_is_wrong(self):
        self.assert_fails(1, "render", "http://127.0.0.1:9/{x}/{y}.jpg", "-o", "x.png", says=["{z}"])
