"""Folders and lists of rasters as one layer, and rasters as heights, as a user has them: files that GDAL wrote."""

import json
import math
import pathlib
import resource
import struct
import subprocess
import unittest
import zlib

from georeferenced import gdal
from pictures import png, png_of
from program import DONE, DONE_IN_PART, FAILED, PROGRAM, WRONG_USAGE, ProgramTest

UNLIT = "--unlit", "--size", "96x96"
CAMERA = "--camera", "49.5,15,90000"


def pixels_of(path):
    """Red, green and blue of each pixel of a PNG, as GDAL reads it."""
    raw = pathlib.Path(path).with_suffix(".raw")
    gdal("gdal_translate", "-q", "-of", "ENVI", "-co", "INTERLEAVE=BIP", "-b", 1, "-b", 2, "-b", 3, path, raw)
    return raw.read_bytes()


def wavy_ppm(path, side):
    """A gradient in colours with waves: a seam would show. Overviews of edges differ by their filter, so there are none."""
    rows = bytes(v for y in range(side) for x in range(side)
                 for v in (20 + 200 * x // side, 20 + 200 * y // side, round(100 + 20 * math.sin(x / 4) * math.cos(y / 4))))
    pathlib.Path(path).write_bytes(b"P6\n%d %d\n255\n" % (side, side) + rows)


class ManyFiles(ProgramTest):
    def setUp(self):
        super().setUp()
        self.cells = self.folder / "cells"
        self.cells.mkdir()
        wavy_ppm(self.folder / "base.ppm", 256)
        gdal("gdal_translate", "-q", "-a_srs", "EPSG:32633", "-a_ullr", 470000, 5510000, 530000, 5450000,
             self.folder / "base.ppm", self.folder / "whole.tif")

    def cut_cells(self, count=4):
        side = 256 // count
        for part in range(count * count):
            gdal("gdal_translate", "-q", "-srcwin", part % count * side, part // count * side, side, side,
                 self.folder / "whole.tif", self.cells / f"cell-{part:02}.tif")

    def render(self, *arguments, code=DONE, **options):
        camera = () if "--camera" in arguments else CAMERA
        done = self.run_program("render", *arguments, *UNLIT, *camera, "-o", "out.png", **options)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return pixels_of(self.folder / "out.png"), done

    def assert_same_picture(self, one, two, levels=1):
        self.assertEqual(len(one), len(two))
        largest = max(abs(a - b) for a, b in zip(one, two))
        self.assertLessEqual(largest, levels)

    def test_sixteen_cells_look_like_the_file_they_were_cut_from(self):
        self.cut_cells()
        (self.folder / "one.txt").write_text("whole.tif\n")
        # Over the corner where four cells meet, by the finest level: the same filter.
        close = "--camera", "49.5,15,20000"
        whole, _ = self.render("one.txt", *close)
        self.assertGreater(len(set(whole)), 20)
        self.assert_same_picture(self.render("cells", *close)[0], whole)
        # From afar: tiles of over twelve files are means of finer ones, which bend waves by a level more than the cubic.
        whole, _ = self.render("one.txt")
        cells, done = self.render("cells")
        self.assertNotIn("left out", done.stderr)
        self.assert_same_picture(cells, whole, levels=3)
        again, _ = self.render("cells")
        self.assertEqual(again, cells)
        self.assertEqual(self.render("cells", "--cache", "off")[0], cells)

    def test_lists_and_descriptions(self):
        self.cut_cells()
        cells, _ = self.render("cells")
        names = sorted(path.name for path in self.cells.iterdir())
        (self.folder / "cells.txt").write_text("# all of them\n" + "".join(f"cells/{name}\n" for name in names))
        (self.folder / "cells.json").write_text(json.dumps({"name": "Cells", "mosaic": ["cells"]}))
        for name in ("cells.txt", "cells.json"):
            self.assertEqual(self.render(name)[0], cells, name)
        told = json.loads(self.assert_done("info", "--json", "cells.json").stdout)
        self.assertEqual((told["name"], told["files"]), ("Cells", {"shown": 16, "left_out": 0, "groups": 1}))

    def test_files_that_cannot_be_read(self):
        self.cut_cells()
        (self.cells / "cell-03.tif").write_bytes(b"II*\0 nothing")
        (self.cells / "readme.tif").write_text("no raster")
        _, done = self.render("cells", code=DONE_IN_PART)
        for text in ("2 of 17 files are left out", "cell-03.tif", "readme.tif"):
            self.assertIn(text, done.stderr)
        told = self.run_program("info", "cells")
        self.assertEqual(told.returncode, DONE_IN_PART, told.stderr)
        self.assertIn("15 rasters in 1 group, 2 left out", told.stdout)

    def test_nothing_that_can_be_read(self):
        (self.cells / "readme.tif").write_text("no raster")
        self.assert_fails(FAILED, "render", "cells", "-o", "out.png", says=["cells: none of the 1 files", "readme.tif"])
        self.assert_nothing_but("base.ppm", "cells", "whole.tif")

    def test_a_place_for_many_files_is_refused(self):
        self.cut_cells(1)
        self.assert_fails(FAILED, "render", "cells", "--crs", "EPSG:4326", "-o", "out.png", says=["cells", "mosaic"])

    def test_few_files_may_be_open(self):
        self.cut_cells(8)
        cells, _ = self.render("cells", "--cache", "off")
        limited = subprocess.run(
            [PROGRAM, "render", "cells", *UNLIT, *CAMERA, "-o", "out.png", "--cache", "off"], cwd=self.folder,
            capture_output=True, text=True, timeout=60,
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (64, 64)))
        self.assertEqual(limited.returncode, DONE, limited.stderr)
        self.assertEqual(pixels_of(self.folder / "out.png"), cells)

    def test_cut_makes_one_tile_set(self):
        self.cut_cells()
        self.assert_done("cut", "whole.tif", "-o", "whole.gpkg", "--format", "png")
        self.assert_done("cut", "cells", "-o", "cells.gpkg", "--format", "png")
        self.assert_same_picture(self.render("cells.gpkg")[0], self.render("whole.gpkg")[0])
        self.assert_done("cut", "cells", "-o", "cells.gpkg", "--format", "png")
        (self.cells / "cell-00.tif").unlink()
        self.assert_fails(FAILED, "cut", "cells", "-o", "cells.gpkg", "--format", "png", says=["cells.gpkg", "--force"])

    def test_a_cut_of_numbers_keeps_them_and_names_the_files_that_it_leaves_out(self):
        gdal("gdal_translate", "-q", "-b", 1, "-ot", "Int16", "-scale", 0, 255, -1000, 3000, "-a_srs", "EPSG:4326",
             "-a_ullr", 10, 50, 12, 48, self.folder / "base.ppm", self.folder / "numbers.tif")
        for part in range(4):
            # One cell has another type than the others.
            gdal("gdal_translate", "-q", "-ot", "Float32" if part == 2 else "Int16", "-srcwin", part % 2 * 128,
                 part // 2 * 128, 128, 128, self.folder / "numbers.tif", self.cells / f"cell-{part}.tif")
        (self.cells / "broken.tif").write_text("no raster")
        done = self.run_program("cut", "cells", "-o", "numbers.gpkg", "--json")
        self.assertEqual(done.returncode, DONE_IN_PART, done.stderr)
        self.assertIn("broken.tif", done.stderr)
        self.assertEqual(json.loads(done.stdout)["left_out"], 1)
        places = "\n".join(f"{10 + (x + 0.5) / 128} {50 - (y + 0.5) / 128}" for x in range(3, 256, 36) for y in range(5, 256, 36))
        ask = ["gdallocationinfo", "-valonly", "-wgs84"]
        told = [subprocess.run([*ask, self.folder / name], input=places, capture_output=True, text=True, check=True).stdout
                for name in ("numbers.tif", "numbers.gpkg")]
        self.assertEqual(told[1].split(), told[0].split())
        (self.cells / "broken.tif").unlink()
        self.assert_done("cut", "cells", "-o", "numbers.gpkg", "--force")

    def test_a_cut_of_heights_in_floats_leaves_out_a_damaged_file(self):
        gdal("gdal_translate", "-q", "-b", 1, "-ot", "Float32", "-scale", 0, 255, -100.25, 3000.5, "-a_srs", "EPSG:4326",
             "-a_ullr", 10, 50, 12, 48, self.folder / "base.ppm", self.folder / "numbers.tif")
        for part in range(4):
            gdal("gdal_translate", "-q", "-srcwin", part % 2 * 128, part // 2 * 128, 128, 128, self.folder / "numbers.tif",
                 self.cells / f"cell-{part}.tif")
        whole = (self.cells / "cell-1.tif").read_bytes()
        (self.cells / "cell-1.tif").write_bytes(whole[:len(whole) // 2])
        done = self.run_program("cut", "cells", "-o", "heights.gpkg", "--elevation")
        self.assertEqual(done.returncode, DONE_IN_PART, done.stderr)
        self.assertIn("cell-1.tif", done.stderr)
        ask = ["gdallocationinfo", "-valonly", "-wgs84"]
        told = [subprocess.run([*ask, self.folder / name, "10.2", "49.9"], capture_output=True, text=True, check=True).stdout
                for name in ("numbers.tif", "heights.gpkg")]
        self.assertAlmostEqual(float(told[0]), float(told[1]), delta=0.05)  # 3100 m in 65534 numbers

    def test_files_of_two_projections_join(self):
        gdal("gdal_translate", "-q", "-srcwin", 0, 0, 128, 256, self.folder / "whole.tif", self.cells / "west.tif")
        gdal("gdal_translate", "-q", "-srcwin", 120, 0, 136, 256, self.folder / "whole.tif", self.folder / "east.tif")
        gdal("gdalwarp", "-q", "-t_srs", "EPSG:4326", "-r", "cubic", "-dstalpha", self.folder / "east.tif",
             self.cells / "east.tif")
        (self.folder / "one.txt").write_text("whole.tif\n")
        whole, _ = self.render("one.txt")
        joined, _ = self.render("cells")
        # The eastern file was resampled twice; edges of the squares differ, and nothing is missing.
        off = [abs(a - b) for a, b in zip(joined, whole)]
        self.assertLess(sum(off) / len(off), 4)
        black = sum(1 for i in range(0, len(joined), 3) if joined[i:i + 3] == b"\0\0\0")
        self.assertEqual(black, sum(1 for i in range(0, len(whole), 3) if whole[i:i + 3] == b"\0\0\0"))


class RastersAsHeights(ProgramTest):
    VIEW = ("--size", "64x64", "--camera", "10,20,2000000,0,-50", "--unlit", "--exaggeration", "20")

    def setUp(self):
        super().setUp()
        self.write("sea.png", png(128, 64))
        self.assert_done("cut", "sea.png", "-o", "sea.gpkg", "--tile-size", "64")
        numbers = b"".join(struct.pack("<h", 3000 * ((x // 8 + y // 8) % 2)) for y in range(128) for x in range(256))
        (self.folder / "raw").write_bytes(numbers)
        (self.folder / "raw.hdr").write_text("ENVI\nsamples = 256\nlines = 128\nbands = 1\nheader offset = 0\n"
                                             "data type = 2\ninterleave = bsq\nbyte order = 0\n")
        gdal("gdal_translate", "-q", "-a_srs", "EPSG:4326", "-a_ullr", -180, 90, 180, -90, self.folder / "raw",
             self.folder / "metres.tif")

    def render(self, *arguments, code=DONE):
        done = self.run_program("render", "sea.gpkg", *arguments, *self.VIEW, "-o", "out.png")
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return pixels_of(self.folder / "out.png")

    def test_a_raster_a_folder_of_its_parts_and_its_cut_raise_the_same_ground(self):
        self.assert_done("cut", "metres.tif", "--elevation", "-o", "cut.gpkg", "--tile-size", "64")
        truth = self.render("--elevation", "cut.gpkg")
        flat = self.render()
        self.assertNotEqual(truth, flat)
        (self.folder / "parts").mkdir()
        for part in range(8):
            gdal("gdal_translate", "-q", "-srcwin", part % 4 * 64, part // 4 * 64, 64, 64, self.folder / "metres.tif",
                 self.folder / "parts" / f"part-{part}.tif")
        for heights in ("metres.tif", "parts"):
            raised = self.render("--elevation", heights)
            off = [abs(a - b) for a, b in zip(raised, truth)]
            # Another size of tiles moves the outline of hills by less than a pixel.
            self.assertLess(sum(off) / len(off), 1.0, heights)
            self.assertNotEqual(raised, flat)

    def test_feet_are_metres(self):
        gdal("gdal_translate", "-q", "-ot", "Float32", "-scale", 0, 3000, 0, 9842.519685, self.folder / "metres.tif",
             self.folder / "feet.tif")
        gdal("gdal_translate", "-q", "-ot", "Float32", self.folder / "metres.tif", self.folder / "floats.tif")
        xml = (self.folder / "feet.vrt")
        gdal("gdal_translate", "-q", "-of", "VRT", self.folder / "feet.tif", xml)
        for unit, name in (("ft", "ft.tif"), ("K", "kelvin.tif")):
            xml.write_text(xml.read_text().replace("<ColorInterp>", f"<UnitType>{unit}</UnitType><ColorInterp>", 1)
                           if "<UnitType>" not in xml.read_text()
                           else xml.read_text().replace("<UnitType>ft<", f"<UnitType>{unit}<"))
            gdal("gdal_translate", "-q", xml, self.folder / name)
        metres = self.render("--elevation", "floats.tif")
        feet = self.render("--elevation", "ft.tif")
        self.assertLess(sum(abs(a - b) for a, b in zip(feet, metres)) / len(metres), 0.1)
        self.assert_fails(FAILED, "render", "sea.gpkg", "--elevation", "kelvin.tif", "-o", "x.png",
                          says=["kelvin.tif", '"K"', "no unit of length", "gdal_edit.py"])

    def test_a_part_of_the_planet_is_enough(self):
        gdal("gdal_translate", "-q", "-projwin", 0, 40, 40, 0, self.folder / "metres.tif", self.folder / "part.tif")
        self.assertNotEqual(self.render("--elevation", "part.tif"), self.render())

    def test_heights_in_colours(self):
        """The same hills as terrain-RGB and as Terrarium."""
        truth = self.render("--elevation", "metres.tif")
        for encoding in ("terrain-rgb", "terrarium"):
            tiles = self.folder / encoding
            for level, (columns, rows) in enumerate(((2, 1), (4, 2))):
                for x in range(columns):
                    for y in range(rows):
                        tile = tiles / str(level) / str(x) / f"{y}.png"
                        tile.parent.mkdir(parents=True, exist_ok=True)
                        tile.write_bytes(colour_tile(encoding, 64, 2 ** (1 - level), x * 64, y * 64))
            said = {"version": 1, "root_span_deg": 180.0, "tile_px": 64, "max_level": 1, "format": "png"}
            (tiles / "tileset.json").write_text(json.dumps({**said, "encoding": encoding}))
            stated = self.render("--elevation", encoding)
            self.assertLess(sum(abs(a - b) for a, b in zip(stated, truth)) / len(truth), 1.0, encoding)
            (tiles / "tileset.json").write_text(json.dumps(said))
            self.assertEqual(self.render("--elevation", encoding, "--elevation-encoding", encoding), stated)
            self.assert_fails(FAILED, "render", "sea.gpkg", "--elevation", encoding, "-o", "x.png", says=["pictures"])
        self.assert_fails(WRONG_USAGE, "render", "sea.gpkg", "--elevation", "terrarium", "--elevation-encoding", "png",
                          "-o", "x.png", says=["--elevation-encoding"])


def colour_tile(encoding, side, step, left, top):
    """A tile of the hills: pixel (x, y) of the level with pixels of `step` finest ones."""
    rows = bytearray()
    for y in range(side):
        rows += b"\0"
        for x in range(side):
            fine_x, fine_y = (left + x) * step, (top + y) * step
            height = 3000 * ((fine_x // 8 + fine_y // 8) % 2)
            number = 10 * (height + 10000) if encoding == "terrain-rgb" else 256 * (height + 32768)
            rows += number.to_bytes(3, "big")
    return png_of(side, side, zlib.compress(bytes(rows)))


if __name__ == "__main__":
    unittest.main()
