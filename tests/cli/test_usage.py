"""Wrong command lines: exit code 2, a message that names the option, and no other effect."""

import json
import re
import shutil
import subprocess
import unittest

import pictures
from program import FAILED, NATURAL_EARTH, PROGRAM, WRONG_USAGE, ProgramTest, subcommands


class Program(ProgramTest):
    def test_help_and_version_are_done(self):
        self.assertIn("Examples:", self.assert_done("--help").stdout)
        self.assertRegex(self.assert_done("--version").stdout, r"^terrella \d+\.\d+\.\d+\n$")

    def test_each_subcommand_has_help_with_an_example(self):
        for command in subcommands():
            with self.subTest(command):
                text = self.assert_done(command, "--help").stdout
                self.assertRegex(text, rf"(?is)example.*terrella {command}")

    def test_no_subcommand_prints_the_help(self):
        done = self.assert_done()
        for text in ("Usage: terrella", "Subcommands:", "Examples:", "terrella view"):
            self.assertIn(text, done.stdout)
        self.assertEqual(done.stdout, self.assert_done("--help").stdout)
        self.assertEqual(done.stderr, "")

    def test_the_help_lists_all_bodies(self):
        for command in ("view", "render", "cut"):
            text = " ".join(self.assert_done(command, "--help").stdout.split())
            for body in ("earth", "moon", "mars", "mercury", "ceres", "phobos", "enceladus", "titan", "sun"):
                self.assertRegex(text, rf"\b{body}\b")

    def test_exaggeration_without_heights_warns(self):
        for value, warns in (("3", True), ("1", False)):
            done = self.assert_done("render", NATURAL_EARTH, "--size", "32x32", "--exaggeration", value, "-o", "x.png")
            self.assertEqual("give them with --elevation" in done.stderr, warns, done.stderr)

    def test_help_is_a_command_too(self):
        self.assertEqual(self.assert_done("help").stdout, self.assert_done("--help").stdout)
        for command in subcommands():
            self.assertEqual(self.assert_done("help", command).stdout, self.assert_done(command, "--help").stdout)

    def test_unknown_subcommand(self):
        done = self.assert_fails(WRONG_USAGE, "paint", says=["terrella: there is no command paint", "terrella --help"])
        self.assertNotIn("did you mean", done.stderr)

    def test_mistyped_subcommands_and_options_are_suggested(self):
        for typed, meant in [("rendr", "render"), ("veiw", "view"), ("Cut", "cut"), ("prelaod", "preload")]:
            with self.subTest(typed):
                self.assert_fails(WRONG_USAGE, typed, "a.jpg", "-o", "b.png",
                                  says=[f"there is no command {typed}; did you mean {meant}?"])
        self.assert_fails(WRONG_USAGE, "view", "--exageration=2",
                          says=["there is no option --exageration; did you mean --exaggeration?"])

    def test_a_picture_or_tile_set_without_a_subcommand_is_viewed(self):
        (self.folder / "tiles").mkdir()
        for shown in ("picture.jpg", "planet.gpkg"):
            with self.subTest(shown):
                self.assert_fails(FAILED, shown, says=[f"terrella view: {shown}: no such file"])
        for shown in ("tiles", "https://tiles.example/{z}/{x}/{y}.jpg"):
            with self.subTest(shown):
                self.assert_fails(FAILED, shown, says=["terrella view: cannot open a window: no display"])

    def test_an_argument_too_many(self):
        self.assert_fails(WRONG_USAGE, "info", "a.gpkg", "b.gpkg", says=["unexpected argument b.gpkg"])

    def test_unknown_option(self):
        for command in subcommands():
            with self.subTest(command):
                self.assert_fails(WRONG_USAGE, command, "--colour", "x", says=["--colour", f"terrella {command} --help"])

    def test_missing_output(self):
        for command in ("render", "cut"):
            with self.subTest(command):
                self.assert_fails(WRONG_USAGE, command, "picture.png", says=["-o"])


# Option, value, and what the message must hold beside the option's name and the value.
OUT_OF_RANGE = [
    ("--camera", "91,0,1000", "90"),
    ("--camera", "-90.5,0,1000", "90"),
    ("--camera", "nan,0,1000", ""),
    ("--camera", "0,nan,1000", ""),
    ("--camera", "0,0,inf", ""),
    ("--camera", "0,0,1e13", ""),
    ("--camera", "0,0,1000,nan", ""),
    ("--camera", "0,0,1000,0,-91", "90"),
    ("--camera", "0,0,1000,0,0,0", ""),
    ("--camera", "0,0,1000,0,0,171", "170"),
    ("--camera", "0,0", ""),
    ("--camera", "0,0,1000,0,0,40,7", ""),
    ("--camera", "here", ""),
    ("--camera", "", ""),
    ("--size", "0x100", "16384"),
    ("--size", "100x16385", "16384"),
    ("--size", "-5x10", ""),
    ("--size", "100", "WIDTHxHEIGHT"),
    ("--size", "100x", "WIDTHxHEIGHT"),
    ("--size", "99999999999x1", ""),
    ("--body", "vulcan", "earth"),
    ("--body", "0,0", ""),
    ("--body", "nan,0", ""),
    ("--body", "6378137,0.5", ""),
    ("--body", "6378137,-0.1", ""),
    ("--projection", "mercator", "equirectangular|equal-area"),
    ("--latitude", "magnetic", "graphic|centric"),
    ("--texturing", "nice", "vertex|paper|exact|auto"),
    ("--paper-a", "1.9", "2"),
    ("--paper-a", "8.1", "8"),
    ("--paper-a", "nan", "8"),
    ("--paper-a", "4x", "8"),
    ("--band", "0", "0.5"),
    ("--band", "0.6", "0.5"),
    ("--band", "nan", "0.5"),
    ("--depth", "w", "reversed|log|standard"),
    ("--polar-rows", "few", "squeezed|full"),
    ("--polar-columns", "0", "4096"),
    ("--detail", "0.1", "8"),
    ("--exaggeration", "-1", "100"),
    ("--surface-alpha", "1.1", "1"),
    ("--time", "1899-01-01T00:00Z", "1950 to 2050"),
    ("--time", "2051-01-01T00:00Z", "1950 to 2050"),
    ("--time", "yesterday", ""),
    ("--cache-size", "0", "64"),
    ("--cache-size", "1e9", "16777216"),
    ("--cache-size", "-1", "64"),
]


# Types of flags, and of words and names of files: no number can be wrong in them.
WORDS = {"", "Excludes:", "Needs:", "CRS", "F.geojson", "FILE", "FILE.json", "FILE:FILE", "FILE|off", "NAME|FILE", "TEXT",
         "TILESET", "TILESET[:OPACITY]", "UTC", "'K: V'", "#RRGGBB", "RASTER|FOLDER|TILESET",
         "HH:MM-HH:MM[Z]", "OUT.gpkg|OUT.mbtiles|OUT.pmtiles|DIR", "OUT.gpkg|.mbtiles|.pmtiles", "CACHE.gpkg|OUT.mbtiles|OUT.pmtiles"}
# One form for each place of a number in a type of several.
FORMS = {"LAT,LON,ALT[,HEADING[,PITCH[,FOV]]]": [",".join("{}" if k == n else "1" for k in range(6)) for n in range(6)],
         "W,S,E,N": ["{},0,1,1", "0,{},1,1", "0,0,{},1", "0,0,1,{}"], "R,G,B": ["{},2,3", "1,{},3", "1,2,{}"],
         "MIN,MAX|minmax|percent:2,98|sigma:2": ["{},1", "0,{}", "percent:{},98", "percent:2,{}", "sigma:{}"],
         "NAME|A,F": ["{},0", "6378137,{}"], "WxH": ["{}x9", "9x{}"], "COLSxROWS": ["{}x1", "1x{}"],
         "I/N": ["{}/2", "1/{}"], "A-B": ["{}-2", "0-{}"]}


def options_of(command):
    """Each option that the help of a command names, with its type; the type of a flag is empty."""
    text = subprocess.run([PROGRAM, command, "--help"], capture_output=True, text=True, check=True).stdout
    found = re.findall(r"^  (?:-\w,)?(--[\w-]+)(?: ('K: V'|\S+))?", text, re.MULTILINE)
    return [(option, re.sub(r"=[^=]*$", "", kind)) for option, kind in found if option != "--help"]


def bad_values(option, kind):
    """Values with a number that is none, or that no option allows; nothing but words is left to a choice."""
    if re.fullmatch(r"[a-z0-9-]+(\|[a-z0-9-]+)+(:.*)?", kind):
        return ["inf", "1e400"]
    numbers = ["inf", "-inf", "nan", "1e400"] + (["1e308", "-1e308"] if option != "--nodata" else [])
    return [form.format(number) for form in FORMS.get(kind, ["{}"]) for number in numbers]


class Ranges(ProgramTest):
    def test_render_names_option_value_and_range(self):
        for option, value, also in OUT_OF_RANGE:
            with self.subTest(option=option, value=value):
                self.assert_fails(WRONG_USAGE, "render", "-o", "x.png", option, value, says=[option, value, also])
        self.assert_nothing_but()

    def test_view_checks_the_same(self):
        for option, value, also in OUT_OF_RANGE[::6]:
            with self.subTest(option=option, value=value):
                self.assert_fails(WRONG_USAGE, "view", option, value, says=[option, value, also])

    def test_cut(self):
        for option, value in [("--tile-size", "15"), ("--tile-size", "4097"), ("--quality", "0"), ("--quality", "101"),
                              ("--quality", "nan"), ("--format", "gif"), ("--bounds", "0,0,0"),
                              ("--bounds", "nan,0,1,1"), ("--bounds", "0,10,20,-10"), ("--bounds", "0,-91,20,10"),
                              ("--jobs", "-1"), ("--jobs", "many")]:
            with self.subTest(option=option, value=value):
                self.assert_fails(WRONG_USAGE, "cut", "p.png", "-o", "x.gpkg", option, value, says=[option, value])
        self.assert_nothing_but()

    def test_numbers_are_finite_and_in_range_in_every_option(self):
        """Asks the program for its options. A new one is tested by its type, or is listed in WORDS."""
        seen = set()
        for command in subcommands():
            for option, kind in set(options_of(command)) - seen:
                if kind in WORDS:
                    continue
                seen.add((option, kind))
                for value in bad_values(option, kind):
                    with self.subTest(command, option=option, value=value):
                        files = {"merge": ("a.gpkg", "-o", "b.gpkg"), "info": ("a.tif",), "bench": ("views",),
                                 "view": ("a.tif",), "purge": ("a.gpkg",)}.get(command, ("a.tif", "-o", "b.gpkg"))
                        self.assert_fails(WRONG_USAGE, command, *files, f"{option}={value}", says=[option])
        self.assert_nothing_but()

    def test_no_data_may_be_the_lowest_number_and_times_are_words(self):
        for command in ("cut", "render", "info"):  # no data may be the lowest number of a double
            for number in ("inf", "nan", "1e400"):
                out = () if command == "info" else ("-o", "x.gpkg" if command == "cut" else "x.png")
                self.assert_fails(WRONG_USAGE, command, "missing.tif", *out, f"--nodata={number}", says=["--nodata"])
        self.assert_fails(FAILED, "render", "missing.tif", "-o", "x.png", "--nodata=-1.7976931348623157e+308",
                          says=["missing.tif"])
        for time in ("nan", "inf", "soon"):
            self.assert_fails(WRONG_USAGE, "render", "missing.tif", "-o", "x.png", f"--layer-time={time}",
                              says=["--layer-time", "2024-07-01"])

    def test_values_at_the_ends_of_their_ranges_are_no_wrong_usage(self):
        for option, value in [("--camera", "-90,-180,1"), ("--camera", "90,540,1e12,720,90,170"), ("--size", "1x16384"),
                              ("--paper-a", "2"), ("--paper-a", "8"), ("--band", "0.5"), ("--cache-size", "64"),
                              ("--body", "saturn"), ("--body", "3396190,0.00588600756")]:
            with self.subTest(option=option, value=value):
                self.assert_fails(FAILED, "render", "missing.gpkg", "-o", "x.png", option, value, says=["missing.gpkg"])


class Tasks(ProgramTest):
    """A task file does the work of the command line that it states."""

    def task(self, **keys):
        (self.folder / "task.json").write_text(json.dumps(keys), encoding="utf-8")
        return "task.json"

    def picture(self, name, colour=(200, 90, 40)):
        (self.folder / name).write_bytes(pictures.png(512, 256, colour))
        return name

    def tree(self, folder):
        root = self.folder / folder
        return {file.relative_to(root): file.read_bytes() for file in root.rglob("*") if file.is_file()}

    def test_a_cut_is_that_of_the_same_options(self):
        words = ["--tile-size=64", "--bounds=5,43,17,49", "--format=png", "--name=-7", "--force"]
        self.assert_done("cut", self.picture("a.png"), "-o", "by_words", *words)
        task = self.task(command="cut", image="a.png", output="by_task", bounds=[5, 43, 17, 49], format="png", name="-7",
                         force=True, join=False, **{"tile-size": 64})
        self.assert_done("cut", "--task", task)
        self.assertEqual(self.tree("by_task"), self.tree("by_words"))
        self.assertGreater(len(self.tree("by_task")), 8)
        for words in (["-o", "other"], ["--output=other"], ["-oother"]):
            with self.subTest(words):
                self.assert_done("cut", *words, f"--task={task}")
                self.assertEqual(self.tree("other"), self.tree("by_words"))
                shutil.rmtree(self.folder / "other")
        self.picture("b.png", (10, 90, 40))
        self.assert_done("cut", "b.png", "-o", "other", "--task", task)
        self.assertNotEqual(self.tree("other"), self.tree("by_words"))
        self.assertEqual(len(self.tree("other")), len(self.tree("by_words")), "one picture, not two side by side")

    def test_values_that_look_like_options_or_like_nothing(self):
        picture = self.picture("a.png")
        self.assert_done("cut", picture, "-o", "by_words", "--attribution", "", "--body", "moon", "--name", "--task")
        self.assert_done("cut", "--name", "--task", "--task",
                         self.task(image=picture, output="by_task", attribution="", body="moon", **{"tile-size": 256.0}))
        self.assertEqual(self.tree("by_task"), self.tree("by_words"))
        self.assertIn("moon", self.assert_done("info", "by_task").stdout)

    def test_a_list_of_pictures_and_a_list_of_boxes(self):
        task = self.task(image=[self.picture("west.png"), self.picture("east.png")], output="both", mosaic="2x1",
                         bounds="0,0,20,5", **{"tile-size": 64})
        self.assert_done("cut", "--task", task)
        preload = {"SOURCE": "both", "output": "held.gpkg"}
        counts = []
        for boxes in ([[0, 0, 1, 1]], [[15, 0, 16, 1]], [[0, 0, 1, 1], "15,0,16,1"], [0, 0, 1, 1]):
            done = self.assert_done("preload", "--task", self.task(bbox=boxes, **preload), "--dry-run", "--json")
            counts.append(json.loads(done.stdout)["tiles"])
        self.assertEqual(counts[3], counts[0], "four numbers are one box")
        self.assertGreater(counts[2], max(counts[:2]))
        self.assert_nothing_but("both", "east.png", "task.json", "west.png")

    def test_a_wrong_task_is_named_with_a_cure(self):
        for keys, says in [({"levles": "0-3"}, ["\"levles\"", "preload --help"]), ({"task": "b.json"}, ["\"task\""]),
                           ({"command": "cut"}, ["not for preload", "\"cut\""]), ({"rate": True}, ["\"rate\"", "a text or a number"]),
                           ({"dry-run": 1}, ["\"dry-run\"", "true or false"]), ({"SOURCE": "-x"}, ["\"SOURCE\"", "./"]),
                           ({"bbox": [[]]}, ["\"bbox\""]), ({"rate": {}}, ["\"rate\""]), ({"rate": None}, ["\"rate\""]),
                           ({"--rate": 2}, ["\"--rate\""]), ({"-o": "x"}, ["\"-o\""])]:
            with self.subTest(keys):
                self.assert_fails(WRONG_USAGE, "preload", "--task", self.task(**keys), says=["terrella preload: task.json", "See terrella preload --help", *says])
        self.assert_fails(FAILED, "preload", "--task", "none.json", says=["terrella preload: none.json"])
        for text in (b"[]", b"{", b""):
            self.assert_fails(FAILED, "preload", "--task", self.write("task.json", text).name, says=["task.json"])
        self.write("task.json", b'{"bbox": [1, 2, 3, 4], "bbox": [5, 6, 7, 8]}')
        self.assert_fails(WRONG_USAGE, "preload", "--task", "task.json", says=["task.json", "\"bbox\"", "twice", "list"])
        self.assert_fails(WRONG_USAGE, "preload", "--task=", says=["--task"])
        self.assert_fails(WRONG_USAGE, "cut", "--task", "task.json", "--task", "task.json", says=["--task", "twice"])
        self.assert_fails(WRONG_USAGE, "cut", "--task", says=["--task"])
        self.assert_fails(WRONG_USAGE, "render", "--task", "task.json", says=["--task"])
        task = self.task(SOURCE="a.gpkg", output="b.gpkg", rate="fast")
        self.assert_fails(WRONG_USAGE, "preload", "--task", task, says=["--rate"])
        self.assert_nothing_but("task.json")


class Installation(ProgramTest):
    def test_a_broken_one_is_named(self):
        self.assert_fails(FAILED, "render", "-o", "x.png", environment={"TERRELLA_DATA": str(self.folder)},
                          says=["earth.gpkg", str(self.folder)])
        self.assert_nothing_but()


if __name__ == "__main__":
    unittest.main()
