"""Films of layers with dates: the time of the flight chooses the date, and the next one fades in."""

import datetime
import json
import os
import sys
import unittest
from pathlib import Path

import pictures
import png
from program import DONE, DONE_IN_PART, FAILED, WRONG_USAGE, ProgramTest

sys.path.insert(0, str(Path(os.environ["TERRELLA_SOURCE"]) / "tests/preload"))
import servers  # noqa: E402

DATES = ["20200101", "20200103", "20200104"]
DAYS = [0, 2, 3]
COLOURS = [(200, 20, 20), (20, 180, 20), (20, 20, 220)]
FRAMES, FPS, DAYS_LONG = 16, 8, 4.0
START = datetime.datetime(2019, 12, 31, 12)
LEVELS = 4  # a tile's JPEG, and rounding


class Dates(ProgramTest):
    def setUp(self):
        super().setUp()
        for date, colour in zip(DATES, COLOURS):
            self.write(f"day_{date}.png", pictures.png(64, 32, colour))
        end = START + datetime.timedelta(days=DAYS_LONG)
        flight = {"type": "Feature", "properties": {"duration_s": FRAMES / FPS, "times": [
                      time.strftime("%Y-%m-%dT%H:%MZ") for time in (START, end)]},
                  "geometry": {"type": "LineString", "coordinates": [[0, 0, 9000000], [0, 0, 9000000.5]]}}
        self.write("f.geojson", json.dumps(flight).encode())

    def film(self, clock, folder, *options):
        return self.assert_done("render", "day_{time:%Y%m%d}.png", "--flight", "f.geojson", "--fps", str(FPS), "--unlit",
                                "--size", "32x32", "--cache", "off", "--layer-clock", clock, *options, "-o",
                                f"{folder}/%02d.png")

    def colours(self, folder):
        return [png.pixel(png.read(self.folder / folder / f"{k:02}.png"), 16, 16) for k in range(FRAMES)]

    def frames(self, folder):
        return {path.name: path.read_bytes() for path in (self.folder / folder).glob("*.png")}

    def expected(self, frame, fades):
        """The colour at the frame's time; none before the first date."""
        day = DAYS_LONG * frame / FRAMES - 0.5  # since the first date
        if day < 0:
            return None
        last = max(k for k in range(len(DAYS)) if DAYS[k] <= day)
        if not fades or last == len(DAYS) - 1:
            return COLOURS[last]
        share = (day - DAYS[last]) / (DAYS[last + 1] - DAYS[last])
        return tuple((1 - share) * a + share * b for a, b in zip(COLOURS[last], COLOURS[last + 1]))

    def test_each_frame_has_the_date_of_its_time(self):
        for clock in ("globe", "globe-fades"):
            self.film(clock, clock)
            for frame, seen in enumerate(self.colours(clock)):
                wanted = self.expected(frame, clock == "globe-fades")
                with self.subTest(clock=clock, frame=frame, wanted=wanted, seen=seen):
                    if wanted is None:
                        self.assertLess(max(seen) - min(seen), 60, "the plain colour of a globe without imagery")
                        continue
                    for a, b in zip(wanted, seen):
                        self.assertAlmostEqual(a, b, delta=LEVELS)

    def test_runs_and_shards_have_the_same_bytes(self):
        self.film("globe-fades", "whole")
        for shard in ("2/3", "1/3", "3/3"):
            self.film("globe-fades", "parts", "--shard", shard)
        self.assertEqual(len(self.frames("whole")), FRAMES)
        self.assertEqual(self.frames("whole"), self.frames("parts"))

    def test_a_missing_date_is_the_one_before_in_any_run(self):
        served = self.folder / "served"
        for day, colour in zip((1, 2, 4), COLOURS):
            for x in (0, 1):
                tile = served / f"2020-01-0{day}" / "0" / str(x)
                tile.mkdir(parents=True)
                (tile / "0.png").write_bytes(pictures.png(64, 64, colour))
        server = self.enterContext(servers.misbehaving(served, {}))
        days = {"url": f"{server.address}/{{time}}/{{z}}/{{x}}/{{y}}.png", "tile_px": 64, "max_level": 0,
                "times": ["2020-01-01/2020-01-04/P1D"]}
        self.write("days.json", json.dumps(days).encode())
        words = ["render", "days.json", "--flight", "f.geojson", "--fps", str(FPS), "--unlit", "--size", "32x32",
                 "--layer-clock", "globe"]
        whole = self.run_program(*words, "-o", "whole/%02d.png")
        self.assertEqual(whole.returncode, DONE_IN_PART, whole.stderr)
        self.assertIn("2020-01-03", whole.stderr)
        self.assertIn("2020-01-02 is shown", whole.stderr)
        for shard in range(1, FRAMES + 1):  # each run begins with its own date
            self.run_program(*words, "--shard", f"{shard}/{FRAMES}", "--cache", "off", "-o", "parts/%02d.png")
        self.assertEqual(len(self.frames("whole")), FRAMES)
        self.assertEqual(self.frames("whole"), self.frames("parts"))
        # Frame 10 is the first of January 3rd, frame 14 that of January 4th.
        for frame, colour in ((10, COLOURS[1]), (11, COLOURS[1]), (14, COLOURS[2])):
            for a, b in zip(colour, self.colours("whole")[frame]):
                self.assertAlmostEqual(a, b, delta=LEVELS)

    def test_a_clock_needs_a_time(self):
        self.assert_fails(FAILED, "render", "day_{time:%Y%m%d}.png", "--layer-clock", "globe", "-o", "a.png",
                          says=("--layer-clock", "--time"))
        self.assert_fails(WRONG_USAGE, "render", "day_{time:%Y%m%d}.png", "--layer-clock", "moon", "-o", "a.png",
                          says=("--layer-clock", "globe-fades"))
        done = self.run_program("render", "day_{time:%Y%m%d}.png", "--layer-clock", "globe", "--time", "2020-01-03T05:00Z",
                                "--unlit", "--size", "32x32", "--cache", "off", "--camera", "0,0,9000000", "-o", "a.png")
        self.assertEqual(done.returncode, DONE, done.stderr)
        for a, b in zip(COLOURS[1], png.pixel(png.read(self.folder / "a.png"), 16, 16)):
            self.assertAlmostEqual(a, b, delta=LEVELS)


if __name__ == "__main__":
    unittest.main()
