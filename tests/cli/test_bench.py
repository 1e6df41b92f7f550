"""Tests of terrella bench: output files and wrong names."""

import csv
import json
import math
import shutil
import unittest
import xml.etree.ElementTree as ElementTree

from program import DONE, FAILED, WRONG_USAGE, ProgramTest

# Every row of a benchmark has a time and an error.
BENCHES = {
    "views": ("plain_time", "rms_auto"),
    "polar": ("time", "rms_mid"),
    "accuracy": ("time", "position_error"),
    "traverse": ("time", "rms_lag"),
    "stream": ("time", "rms"),
}


# Seconds, but drawn by a software rasteriser, perhaps with sanitizers on a busy machine.
BENCH_LIMIT_S = 800


class Bench(ProgramTest):
    def run_benches(self):
        done = self.assert_done("bench", "all", "--quick", "--json", "--out", "out", "--work", "work",
                                time_limit_s=BENCH_LIMIT_S)
        return {result["bench"]: result for result in json.loads(done.stdout)}

    def check_files(self, name, result):
        with open(self.folder / "out" / f"{name}.csv", newline="", encoding="utf-8") as file:
            header, *rows = csv.reader(file)
        self.assertEqual(header, [column["name"] for column in result["columns"]])
        self.assertGreater(len(rows), 0)
        for row, same in zip(rows, result["rows"], strict=True):
            self.assertEqual(len(row), len(header))
            for field, value in zip(row, same.values(), strict=True):
                if value is None:
                    self.assertEqual(field, "")
                elif isinstance(value, str):
                    self.assertEqual(field, value)
                else:
                    self.assertEqual(float(field), value)
        written = json.loads((self.folder / "out" / f"{name}.json").read_text(encoding="utf-8"))
        self.assertEqual(written, result)
        self.assertTrue((self.folder / "out" / f"{name}.gnuplot").read_text(encoding="utf-8"))
        if shutil.which("gnuplot"):
            picture = (self.folder / "out" / f"{name}.png").read_bytes()
            self.assertTrue(picture.startswith(b"\x89PNG\r\n"))
        return result["rows"]

    def test_all_write_tables_and_one_page(self):
        results = self.run_benches()
        self.assertEqual(set(results), set(BENCHES) | {"stability", "growth", "objects", "features", "limb", "layers"})
        for name, (time, error) in BENCHES.items():
            with self.subTest(name):
                rows = self.check_files(name, results[name])
                for row in rows:
                    self.assertGreater(row[time], 0.0, row)
                    # Looking down on the pole there are no mid latitudes.
                    found = [row[e] for e in (error, "rms_pole") if row.get(e) is not None]
                    self.assertTrue(found and all(math.isfinite(e) and 0.0 <= e < 60.0 for e in found), row)
                if name == "views":
                    self.check_the_readmes_table(rows)
                if name == "polar":
                    self.check_the_papers_sphere(rows)
        self.check_the_self_test(results["stability"])
        self.check_files("objects", results["objects"])
        self.check_the_features(self.check_files("features", results["features"]))
        self.check_the_limb(self.check_files("limb", results["limb"]))
        self.assertEqual(len(self.check_files("layers", results["layers"])), 21)
        self.check_the_growth(results["growth"])
        self.check_the_page(results)

    def check_the_growth(self, result):
        rows = self.check_files("growth", result)
        sizes = {}
        for row in rows:
            self.assertGreater(row["time"], 0.0, row)
            sizes.setdefault((row["series"], row["subject"]), []).append(row["size"])
        self.assertEqual({series for series, _ in sizes}, {"depth", "window", "layers", "workers", "cache"})
        self.assertLessEqual({"open", "look-up", "store and evict", "info", "merge", "frame"},
                             {subject for _, subject in sizes})
        for subject, grown in sizes.items():
            self.assertEqual(grown, sorted(set(grown)), subject)
            self.assertGreater(len(grown), 1, subject)

    def check_the_page(self, results):
        page = (self.folder / "out" / "index.html").read_text(encoding="utf-8")
        body = ElementTree.fromstring(page.removeprefix("<!DOCTYPE html>")).find("body")
        sections = body.findall("section")
        self.assertEqual([section.find("h2").text for section in sections], list(results))
        for section, result in zip(sections, results.values(), strict=True):
            self.assertEqual(len(section.findall("details/table/tr")), 1 + len(result["rows"]))
            if shutil.which("gnuplot"):
                self.assertIsNotNone(section.find("{http://www.w3.org/2000/svg}svg"))
        for said in ("processor", "cores", "terrella"):
            self.assertIn(said, page)

    def check_the_readmes_table(self, rows):
        for row in rows:
            # Ratios of different texturings; `auto` chooses the better coordinates at the pole.
            for name in ("vertex_over_plain", "paper_over_vertex", "exact_over_vertex", "auto_over_vertex"):
                self.assertGreater(row[name], 0.0, row)
                self.assertGreater(row[name + "_cpu"], 0.0, row)
            self.assertLessEqual(row["rms_auto"], row["rms_vertex"] + 0.01, row)

    def check_the_papers_sphere(self, rows):
        plain = [row for row in rows if row["method"] == "sphere: plain"]
        self.assertEqual({row["triangles"] for row in plain}, {27648})
        self.assertEqual({row["ratio_plain"] for row in plain if row["anisotropy"] == 1}, {1.0})

    def check_the_features(self, rows):
        frames = {row["frame"]: row for row in rows}
        self.assertEqual({row["base"] for row in rows}, {"plain: lit, no sky", "a picture of waves"})
        for base in ("plain: lit, no sky", "a picture of waves"):
            self.assertEqual(frames[base]["cpu_ratio"], 1.0)
        self.assertEqual(frames["numbers of 16 bits"]["slots"], frames["a picture of waves"]["slots"] / 2)

    def check_the_limb(self, rows):
        self.assertEqual([(row["ground"], row["sky"]) for row in rows],
                         [("floes", "yes"), ("floes", "no"), ("earth", "yes"), ("earth", "no")])
        for row in rows:
            self.assertGreater(row["time"], 0.0, row)
            self.assertLess(row["peak_worst"], 15.0, row)

    def test_commands_take_turns(self):
        counter = "printf x >> {} && test -e reset && rm reset"
        done = self.assert_done("bench", "programs", "--json", "--rounds", "3", "--reset", "touch reset",
                                counter.format("first"), counter.format("second") + " && sleep 0.2")
        rows = json.loads(done.stdout)["rows"]
        self.assertEqual([(self.folder / name).read_text() for name in ("first", "second")], ["xxx", "xxx"])
        self.assertEqual(rows[0]["time_ratio"], 1.0)
        self.assertGreaterEqual(rows[1]["least"], 0.2)
        self.assertGreater(rows[0]["peak"], 0.0)

    def test_wrong_commands(self):
        self.assert_fails(FAILED, "bench", "programs", "exit 3", says=["'exit 3'", "exit code 3"])
        self.assert_fails(FAILED, "bench", "programs", "true", "--reset", "kill -9 $$", says=["kill -9", "signal 9"])
        self.assert_fails(WRONG_USAGE, "bench", "programs", says=["COMMAND"])
        self.assert_fails(WRONG_USAGE, "bench", "views", "true", says=["COMMAND"])

    def check_the_self_test(self, result):
        for row in self.check_files("stability", result):
            self.assertGreater(row["time"], 0.0, row)
            self.assertIsNotNone(row["error"], row)
            self.assertIn(row["passed"], ("pass", "-"), row)

    def test_the_self_test_fails(self):
        # Mesa's software rasteriser has a coarse arc tangent: held to the limit it fails.
        result = json.loads(self.assert_done("bench", "stability", "--quick", "--json", "--only", "functions").stdout)
        if result["facts"]["functions the engine chooses here"] == "own":
            self.assert_fails(FAILED, "bench", "stability", "--quick", "--only", "functions", "--functions", "driver",
                              says=["stability.csv"])

    def test_the_table_is_printed(self):
        done = self.assert_done("bench", "stream", "--quick", "--only", "mid", "--work", "work", time_limit_s=BENCH_LIMIT_S)
        self.assertIn("settled", done.stdout)
        self.assertIn("8-bit levels", done.stdout)
        self.assertNotIn("pole", done.stdout)
        self.assertTrue((self.folder / "terrella-bench" / "stream.csv").exists())

    def test_wrong_names(self):
        self.assert_fails(WRONG_USAGE, "bench", "speed", says=["speed", "polar", "terrella bench --help"])
        self.assert_fails(WRONG_USAGE, "bench", says=["NAME"])
        self.assert_fails(WRONG_USAGE, "bench", "polar", "--quick", "--full", says=["--full", "--quick"])
        self.assert_fails(WRONG_USAGE, "bench", "all", "--only", "pole", says=["--only"])
        self.assert_fails(FAILED, "bench", "stream", "--quick", "--only", "nowhere", "--work", "work", says=["nowhere"],
                          time_limit_s=BENCH_LIMIT_S)

    def test_a_folder_that_cannot_be_made(self):
        self.write("file", b"")
        self.assert_fails(FAILED, "bench", "polar", "--quick", "--work", "work", "--out", "file", says=["file"])


if __name__ == "__main__":
    unittest.main()
