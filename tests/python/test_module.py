"""The module terrella, as a notebook on a machine without a display uses it."""

import contextlib
import functools
import http.server
import inspect
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import unittest
import warnings

for _display in ("DISPLAY", "WAYLAND_DISPLAY"):
    os.environ.pop(_display, None)

import numpy  # noqa: E402
import terrella  # noqa: E402

PROGRAM = os.environ["TERRELLA"]
SOURCE = pathlib.Path(os.environ["TERRELLA_SOURCE"])
NATURAL_EARTH = SOURCE / "tests/fixtures/natural_earth_ii"
PICTURE = SOURCE / "data/earth/blue_marble_4096x2048.jpg"

sys.path[:0] = [str(SOURCE / "tests/window"), str(SOURCE / "tests/support")]
import pictures  # noqa: E402
import png  # noqa: E402

SIZE = (160, 120)
MAGENTA = (255, 0, 255)


def mark(lon, lat):
    """A magenta marker as a GeoJSON feature."""
    return {"type": "Feature", "geometry": {"type": "Point", "coordinates": [lon, lat]},
            "properties": {"marker-color": "#ff00ff", "marker-size": "large"}}


def middle_of(picture, colour):
    """The mean column and row of the pixels of a colour."""
    rows, columns = (picture == colour).all(axis=2).nonzero()
    return (columns.mean() + 0.5, rows.mean() + 0.5) if len(rows) else None


class ModuleTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="terrella-python-"))
        self.addCleanup(shutil.rmtree, self.folder)
        os.environ["XDG_CACHE_HOME"] = str(self.folder / "cache")

    def run_program(self, *arguments):
        return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, cwd=self.folder)

    def assert_same_words(self, error, call, *arguments):
        """A call raises an exception whose words are the program's."""
        done = self.run_program(*arguments)
        self.assertNotEqual(done.returncode, 0)
        with self.assertRaises(error) as raised:
            call()
        self.assertEqual(str(raised.exception), done.stderr.splitlines()[0])


class Documents(ModuleTest):
    def test_each_block_of_the_readme_runs(self):
        blocks = re.findall(r"```python\n(.*?)```", (SOURCE / "apps/python/README.md").read_text(), re.DOTALL)
        self.assertTrue(blocks)
        subprocess.run(["convert", "-size", "256x128", "xc:gray", self.folder / "moon.tif"], check=True)
        districts = {"type": "FeatureCollection", "features": [mark(8, lat) for lat in (46, 47, 48)]}
        (self.folder / "districts.geojson").write_text(json.dumps(districts))
        handler = functools.partial(http.server.SimpleHTTPRequestHandler, directory=NATURAL_EARTH)
        with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server, contextlib.chdir(self.folder):
            threading.Thread(target=server.serve_forever, daemon=True).start()
            for block in blocks:
                here = block.replace("https://tiles.example", f"http://127.0.0.1:{server.server_port}")
                exec(here.replace("levels=(0, 10)", "levels=(0, 2)"), {})
            server.shutdown()

    def test_an_array_is_no_source(self):
        with self.assertRaisesRegex(TypeError, "not ndarray"):
            terrella.render(numpy.zeros((4, 4)))


class Commands(ModuleTest):
    def test_render_is_the_picture_of_the_command(self):
        file = self.folder / "shot.png"
        camera = (-20, 170, 1e7, 30)
        done = self.run_program("render", "-o", file, "--camera=-20,170,1e7,30", "--size", "160x120", "--sky", "off",
                                "--surface-alpha", "0.5", "--map", "on")
        self.assertEqual(done.returncode, 0, done.stderr)
        picture = terrella.render(camera=camera, size=SIZE, sky=False, surface_alpha=0.5, map=True)
        width, height, rows = png.read(file)
        self.assertEqual(picture.shape, (height, width, 3))
        self.assertEqual(picture.tobytes(), b"".join(map(bytes, rows)))
        again = self.folder / "again.png"
        terrella.render(NATURAL_EARTH, size=SIZE, overlay=[f"{NATURAL_EARTH}:0.5"], output=again)
        self.assertEqual(png.read(again)[:2], SIZE)

    def test_cut_and_info(self):
        tiles = self.folder / "earth.gpkg"
        cut = terrella.cut(PICTURE, output=tiles, tile_size=512, name="A planet")
        self.assertEqual(cut["tiles"], 42)
        info = terrella.info(tiles, verify=True)
        self.assertEqual(info["name"], "A planet")
        self.assertEqual(info, terrella.info(str(tiles), verify=True))
        terrella.cut(PICTURE, output=self.folder / "moon", attribution="", body="moon", tile_size=1024)
        self.assertEqual(terrella.info(self.folder / "moon")["body"], "moon", "an empty text takes no other option")

    def test_preload_merge_convert_and_purge(self):
        address = serve(self, NATURAL_EARTH)
        done = terrella.preload(address + "/{z}/{x}/{-y}.jpg", output=self.folder / "a.gpkg", levels=(0, 1), header=["X-A: 1"])
        self.assertEqual(done["stored"], 10)
        merged = terrella.merge([self.folder / "a.gpkg", self.folder / "a.gpkg"], output=self.folder / "b.gpkg")
        self.assertEqual(merged["tiles"], 10)
        self.assertEqual(terrella.convert(self.folder / "b.gpkg", self.folder / "tiles")["tiles"], 10)
        self.assertEqual(terrella.purge(self.folder / "b.gpkg", levels=(1, 1), dry_run=True)["tiles"], 8)
        self.assertEqual(terrella.purge(self.folder / "b.gpkg", levels=(1, 1))["tiles"], 8)
        self.assertEqual(terrella.info(self.folder / "b.gpkg")["cache"]["tiles"], 2)

    def test_errors_have_the_words_of_the_command(self):
        out = self.folder / "o.png"
        self.assert_same_words(terrella.Error, lambda: terrella.render("nowhere.gpkg"), "render", "nowhere.gpkg", "-o", out)
        self.assert_same_words(terrella.Error, lambda: terrella.info("nowhere.gpkg"), "info", "nowhere.gpkg")
        self.assert_same_words(ValueError, lambda: terrella.render(camera=(95, 0, 1e6)), "render", "--camera=95,0,1000000.0", "-o", out)
        self.assert_same_words(ValueError, lambda: terrella.render(surface_alfa=1), "render", "--surface-alfa", "-o", out)
        self.assert_same_words(ValueError, lambda: terrella.cut("a.jpg"), "cut", "a.jpg")
        with self.assertRaises(TypeError):
            terrella.render(camera=object())

    def test_errors_show_no_secrets_of_addresses(self):
        for address in "ftp://me:a/hush@h/x.tif?key=hush", "me:hush@h:80/x", "http://me:hush@h/x y.tif?key=hush":
            globe = terrella.Globe(size=SIZE)
            for call in (lambda: terrella.render(address), lambda: terrella.info(address), lambda: terrella.Globe(address),
                         lambda: terrella.merge([address], output=self.folder / "m.gpkg"),
                         lambda: terrella.preload(address, output=self.folder / "p.gpkg"),
                         lambda: terrella.render(camera=address), lambda: globe.add_imagery(address),
                         lambda: globe.add_objects(address), lambda: setattr(globe, "camera", address)):
                with self.assertRaises((terrella.Error, ValueError)) as caught:
                    call()
                self.assertNotIn("hush", str(caught.exception))

    def test_what_is_missing_is_a_warning(self):
        tiles = self.folder / "tiles"
        shutil.copytree(NATURAL_EARTH, tiles)
        (tiles / "2/5/2.jpg").write_bytes(b"no picture")
        with self.assertWarnsRegex(terrella.IncompleteWarning, "missing: 2/5/1"):
            picture = terrella.render(tiles, camera=(20, 70, 2e6), size=SIZE)
        self.assertEqual(picture.shape, (120, 160, 3))

    def test_other_threads_run_meanwhile(self):
        """A long call holds no lock of Python's: another thread counts meanwhile."""
        begun, over, turns = threading.Event(), threading.Event(), []

        def count():
            begun.set()
            while not over.wait(0.001):
                turns.append(1)

        counter = threading.Thread(target=count)
        counter.start()
        begun.wait()
        before = len(turns)
        terrella.cut(PICTURE, output=self.folder / "earth.gpkg")
        counted = len(turns) - before
        over.set()
        counter.join()
        self.assertGreater(counted, 10, "a call with the lock lets the counter run once or twice, at its ends")

    def test_example(self):
        picture = self.folder / "quakes.png"
        done = subprocess.run([sys.executable, SOURCE / "apps/examples/earthquakes.py",
                               SOURCE / "data/points/earthquakes.geojson", picture], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("85 earthquakes, 900 x 600 pixels", done.stdout)
        self.assertEqual(png.read(picture)[:2], (900, 600))

    def test_signature_and_help(self):
        parameters = inspect.signature(terrella.render).parameters
        self.assertIn("surface_alpha", parameters)
        self.assertNotIn("json", parameters)
        self.assertIs(inspect.signature(terrella.cut).parameters["output"].default, inspect.Parameter.empty)
        self.assertIn("WxH", terrella.render.__doc__)


class Globes(ModuleTest):
    def test_an_object_moves_and_is_picked(self):
        with terrella.Globe(NATURAL_EARTH, camera=(0, 0, 8e6), size=SIZE, unlit=True) as globe:
            layer = globe.add_objects(mark(0, 0))
            first = globe.render()
            x, y = middle_of(first, MAGENTA)
            self.assertAlmostEqual(x, 80, delta=1)
            self.assertAlmostEqual(y, 60, delta=1)
            self.assertEqual((globe.pick(x, y)["layer"], globe.pick(x, y)["kind"], globe.pick(x, y)["index"]), (layer, "point", 0))
            self.assertEqual((globe.pick(x, y)["id"], globe.pick(x, y)["properties"]["marker-size"]), (1, "large"))
            globe.move(layer, 1, 10, 20)
            second = globe.render()
            moved = middle_of(second, MAGENTA)
            where = globe.project(10, 20)
            self.assertAlmostEqual(moved[0], where[0], delta=1)
            self.assertAlmostEqual(moved[1], where[1], delta=1)
            self.assertIsNone(globe.pick(x, y)["layer"])
            under = globe.pick(*where)
            self.assertEqual(under["layer"], layer)
            self.assertAlmostEqual(under["place"][0], 10, places=1)
            self.assertAlmostEqual(under["place"][1], 20, places=1)
            globe.set_objects(layer, {"type": "FeatureCollection", "features": [mark(0, 0)]})
            self.assertTrue((globe.render() == first).all())
            with self.assertRaises(terrella.Error):
                globe.move(layer, 2, 10, 20)

    def test_points_close_to_one_another_are_one_object(self):
        marks = {"type": "FeatureCollection", "features": [mark(0.01 * k, 0) for k in range(5)]}
        with terrella.Globe(NATURAL_EARTH, camera=(0, 0, 8e6), size=SIZE, unlit=True) as globe:
            layer = globe.add_objects(marks, cluster=40)
            globe.render()
            self.assertEqual(globe.pick(80, 60)["properties"]["point_count"], 5)
            globe.set_objects(layer, {"type": "FeatureCollection", "features": marks["features"][:3]})
            globe.render()
            self.assertEqual(globe.pick(80, 60)["properties"]["point_count"], 3)
            with self.assertRaisesRegex(terrella.Error, "radius"):
                globe.add_objects(marks, cluster=5)

    def test_another_style_is_what_reading_in_it_draws(self):
        def square(west, people):
            ring = [[west, -9], [west + 9, -9], [west + 9, 9], [west, 9], [west, -9]]
            return {"type": "Feature", "properties": {"people": people},
                    "geometry": {"type": "Polygon", "coordinates": [ring]}}

        districts = {"type": "FeatureCollection", "features": [square(-10, 1), square(1, 3)]}

        def style(field):
            return {"fill": ["step", ["get", field], "#ff0000", 2, "#00ff00"], "fill-opacity": 1, "stroke-width": 0}

        with terrella.Globe(NATURAL_EARTH, camera=(0, 0, 5e6), size=SIZE, unlit=True) as globe:
            layer = globe.add_objects(districts, style=style("people"))
            red, green = ([round(v) for v in globe.project(0, lon)] for lon in (-5, 5))
            by_people = globe.render()
            self.assertEqual(tuple(by_people[red[1], red[0]]), (255, 0, 0))
            self.assertEqual(tuple(by_people[green[1], green[0]]), (0, 255, 0))
            globe.set_style(layer, style("value"), numpy.array([5.0, 0.0]))
            by_value = globe.render()
            self.assertEqual(tuple(by_value[red[1], red[0]]), (0, 255, 0))
            self.assertEqual(tuple(by_value[green[1], green[0]]), (255, 0, 0))
            globe.set_style(layer, style("people"))
            self.assertTrue((globe.render() == by_people).all())
            with self.assertRaisesRegex(ValueError, "2 features"):
                globe.set_style(layer, style("value"), [1.0])
            with self.assertRaisesRegex(terrella.Error, "unknown property"):
                globe.set_style(layer, {"colour": "#fff"})
            with self.assertRaisesRegex(ValueError, "add_objects"):
                globe.set_style(layer + 99, style("people"))

    def test_marks_come_with_their_zoom_level(self):
        marks = {"type": "FeatureCollection", "features": [mark(0.0, 0)]}
        with terrella.Globe(NATURAL_EARTH, camera=(0, 0, 8e6), size=SIZE, unlit=True) as globe:
            layer = globe.add_objects(marks, style={"min-zoom": 3})

            def seen(height_m):
                globe.camera = (0, 0, height_m)
                globe.render()
                return globe.pick(80, 60)["layer"] == layer

            self.assertEqual([seen(8e6), seen(8e5), seen(8e6)], [False, True, False])
            globe.set_style(layer, {"max-zoom": 3})
            self.assertEqual([seen(8e6), seen(8e5)], [True, False])
            globe.set_objects(layer, marks)
            self.assertEqual([seen(8e6), seen(8e5)], [True, True])

    def test_a_line_grows_to_what_a_whole_one_draws(self):
        def line(*longitudes):
            return {"type": "Feature", "properties": {"stroke": "#ff00ff", "stroke-width": 6},
                    "geometry": {"type": "LineString", "coordinates": [[lon, 0] for lon in longitudes]}}

        with terrella.Globe(NATURAL_EARTH, camera=(0, 0, 8e6), size=SIZE, unlit=True) as globe:
            layer = globe.add_objects(line(-10, 0, 10))
            whole = globe.render()
            globe.set_objects(layer, line(-20, -10))
            self.assertFalse((globe.render() == whole).all())
            globe.grow(layer, 1, [(0, 0), (0, 10, 0)], drop_first=1)
            # The edge of a joint may be off by a quarter of a pixel.
            self.assertLess(abs(globe.render().astype(int) - whole.astype(int)).max(), 64)
            with self.assertRaisesRegex(ValueError, "latitude"):
                globe.grow(layer, 1, [(0, 0, 0, 0)])
            with self.assertRaises(terrella.Error):
                globe.grow(layer, 2, [(0, 20)])

    def test_globe_draws_what_render_draws(self):
        options = {"camera": (46, 7, 3e6, 0, -60), "size": SIZE, "surface_alpha": 0.7}
        globe = terrella.Globe(NATURAL_EARTH, **options)
        alone = terrella.render(NATURAL_EARTH, **options)  # a second context of the process, gone before the next line
        self.assertTrue((globe.render() == alone).all())
        globe.camera = (0, 0, 1e7)
        self.assertEqual(globe.camera[:3], (0, 0, 1e7))
        self.assertFalse((globe.render() == alone).all())
        globe.camera = "46,7,3000000,0,-60"
        self.assertTrue((globe.render() == alone).all())

    def test_a_project_is_a_scene(self):
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "mark.geojson").write_text(json.dumps(mark(7, 46)), encoding="ascii")
            project = pathlib.Path(folder) / "p.terrella"
            project.write_text(json.dumps({
                "terrella": 1, "settings": {"camera": "46,7,3000000", "size": "160x120"},
                "layers": [{"kind": "imagery", "source": str(NATURAL_EARTH)},
                           {"kind": "objects", "source": "mark.geojson"}]}), encoding="ascii")
            drawn = terrella.render(project)
            self.assertEqual(tuple(drawn[SIZE[1] // 2, SIZE[0] // 2]), MAGENTA)
            self.assertTrue((terrella.Globe(project).render() == drawn).all())
            options = {"camera": (46, 7, 3e6), "size": SIZE, "objects": pathlib.Path(folder) / "mark.geojson"}
            self.assertTrue((terrella.render(NATURAL_EARTH, **options) == drawn).all())
            elsewhere = terrella.render(project, camera=(0, 0, 1e7))
            self.assertFalse((elsewhere == drawn).all(), "a keyword wins over the project")

    def test_layers(self):
        globe = terrella.Globe(NATURAL_EARTH, size=SIZE, unlit=True)
        base = globe.render()
        layer = globe.add_imagery(PICTURE, opacity=0.5)
        self.assertEqual(globe.imagery[1], layer)
        self.assertFalse((globe.render() == base).all())
        globe.show(layer, False)
        self.assertTrue((globe.render() == base).all())
        globe.show(layer)
        globe.set_opacity(layer, 0)
        self.assertTrue((globe.render() == base).all())
        globe.set_opacity(layer, 1)
        over, middle = globe.render(), SIZE[0] // 2
        globe.set_swipe(0.5, before=layer)
        both = globe.render()
        # The antialiased limb takes colours from beside the line.
        self.assertTrue((both[:, :middle - 4] == over[:, :middle - 4]).all())
        self.assertTrue((both[:, middle + 4:] == base[:, middle + 4:]).all())
        globe.set_swipe(None)
        self.assertTrue((globe.render() == over).all())
        globe.set_tone(layer, contrast=0)
        self.assertLessEqual(abs(int(globe.render()[SIZE[1] // 2, middle, 0]) - 128), 1)
        globe.set_tone(layer)
        globe.set_blend(layer, "multiply")
        product = over.astype(int) * base / 255
        inner = (slice(SIZE[1] // 2 - 9, SIZE[1] // 2 + 9), slice(middle - 9, middle + 9))
        self.assertLessEqual(abs(globe.render()[inner] - product[inner]).max(), 1)
        globe.set_blend(layer)
        self.assertTrue((globe.render() == over).all())
        for wrong in (lambda: globe.set_swipe(2), lambda: globe.set_blend(layer, "burn"), lambda: globe.set_swipe(0.5, before=77),
                      lambda: globe.set_tone(layer, gamma=0)):
            with self.assertRaises((ValueError, terrella.Error)):
                wrong()
        globe.remove(layer)
        self.assertEqual(len(globe.imagery), 1)
        with self.assertRaises(terrella.Error):
            globe.remove(layer)
        with self.assertRaisesRegex(terrella.Error, "nowhere.gpkg"):
            globe.add_imagery("nowhere.gpkg")

    def test_a_layer_at_its_times(self):
        colours = {"2026-06-01": (200, 0, 0), "2026-06-02": (0, 200, 0), "2026-06-03": (0, 0, 200)}
        for date, colour in colours.items():
            for x in (0, 1):
                tile = self.folder / date / "0" / str(x) / "0.png"
                tile.parent.mkdir(parents=True)
                tile.write_bytes(pictures.png(256, 256, colour))
        template = serve(self, self.folder) + "/{time:%Y-%m-%d}/{z}/{x}/{y}.png"
        globe = terrella.Globe(template, layer_times="2026-06-01/2026-06-03/P1D", max_level=0, size=SIZE, unlit=True)
        layer = globe.imagery[0]
        self.assertEqual(globe.layer_times(layer), list(colours))
        self.assertEqual(globe.layer_time(layer), "2026-06-03")
        for time, shown in (("2026-06-01", "2026-06-01"), ("2026-06-02T23:59Z", "2026-06-02"), ("2030-01-01", "2026-06-03")):
            globe.set_layer_time(layer, time)
            self.assertEqual(tuple(globe.render()[SIZE[1] // 2, SIZE[0] // 2]), colours[shown])
            self.assertEqual(globe.layer_time(layer), shown)
        for time, says in (("2026-05-31", "first time is 2026-06-01"), ("soon", "soon")):
            with self.assertRaisesRegex(terrella.Error, says):
                globe.set_layer_time(layer, time)
        still = globe.add_imagery(NATURAL_EARTH)
        self.assertEqual((globe.layer_times(still), globe.layer_time(still)), ([], None))
        with self.assertRaisesRegex(terrella.Error, "no list of times"):
            globe.set_layer_time(still, "2026-06-01")
        words = {"layer_times": "2026-06-01/2026-06-03/P1D"}
        terrella.preload(template, times="2026-06-02/2026-06-03", levels="0-0", output=self.folder / "a.gpkg", **words)
        offline = terrella.Globe(template, max_level=0, size=SIZE, unlit=True, cache=self.folder / "a.gpkg", offline=True, **words)
        self.assertEqual((offline.layer_times(layer), offline.layer_time(layer)), (["2026-06-02", "2026-06-03"], "2026-06-03"))
        offline.set_layer_time(layer, "2026-06-02")
        self.assertEqual(tuple(offline.render()[SIZE[1] // 2, SIZE[0] // 2]), colours["2026-06-02"])

    def test_layers_added_later_are_those_of_the_scene(self):
        plain, explained = (terrella.Globe(NATURAL_EARTH, camera=(0, -140, 8e6), size=(320, 240), legend=legend) for legend in (False, True))
        self.assertTrue((plain.render() == explained.render()).all())
        for globe in plain, explained:
            globe.add_imagery(SOURCE / "data/ocean/sea_surface_temperature.tif")
        self.assertFalse((plain.render() == explained.render()).all(), "no legend")
        terrella.cut(PICTURE, output=self.folder / "mars.gpkg", body="mars")
        with self.assertRaisesRegex(terrella.Error, "mars"):
            plain.add_imagery(self.folder / "mars.gpkg")

    def test_threads_and_two_globes(self):
        globes = [terrella.Globe(NATURAL_EARTH, camera=(0, lon, 8e6), size=SIZE) for lon in (0, 90)]
        drawn = [None, None]

        def draw(k):
            drawn[k] = globes[k].render()

        threads = [threading.Thread(target=draw, args=(k,)) for k in (0, 1)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        globes[0].close()
        self.assertTrue((globes[1].render() == drawn[1]).all())
        self.assertFalse((drawn[0] == drawn[1]).all())
        with self.assertRaisesRegex(terrella.Error, "closed"):
            globes[0].render()

    def test_faulty_objects_are_told(self):
        with terrella.Globe(NATURAL_EARTH, size=SIZE) as globe:
            faulty = {"type": "Feature", "geometry": {"type": "Point", "coordinates": [0, 95]}, "properties": {}}
            with self.assertWarns(terrella.IncompleteWarning):
                globe.add_objects({"type": "FeatureCollection", "features": [mark(0, 0), faulty]})
            with self.assertRaises(terrella.Error):
                globe.add_objects(self.folder / "nowhere.geojson")
        file = self.folder / "objects.geojson"
        file.write_text(json.dumps({"type": "FeatureCollection", "features": [mark(0, 0), faulty]}))
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            with self.assertRaises(terrella.IncompleteWarning):  # the globe that was made already goes away
                terrella.Globe(NATURAL_EARTH, size=SIZE, objects=file)


def serve(test, folder):
    """The address of a server on loopback that serves a folder until the test ends."""
    server = subprocess.Popen([sys.executable, "-m", "http.server", "--bind", "127.0.0.1", "--directory", str(folder), "0"],
                              stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, env={**os.environ, "PYTHONUNBUFFERED": "1"})
    test.addCleanup(server.wait)
    test.addCleanup(server.stdout.close)
    test.addCleanup(server.terminate)
    return server.stdout.readline().split("(")[1].split(")")[0].rstrip("/")


if __name__ == "__main__":
    warnings.simplefilter("error")
    unittest.main()
