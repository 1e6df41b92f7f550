"""Outputs that cannot be written: exit code 1, a message that names the output, and no partial file."""

import unittest

from pictures import png
from program import BLUE_MARBLE, FAILED, NATURAL_EARTH, WRONG_USAGE, ProgramTest

# Far less than the tiles of Blue Marble, or a render of it, take.
SMALL_DISK_BYTES = 64 * 1024


class NotWritable(ProgramTest):
    def setUp(self):
        super().setUp()
        self.picture = self.write("planet.png", png(512, 256))
        self.write("file", b"in the way")

    def assert_refused(self, *arguments, output):
        self.assert_fails(FAILED, *arguments, "-o", output, says=[output])
        self.assert_nothing_but("file", "planet.png")

    def test_folder_is_missing(self):
        self.assert_refused("cut", self.picture, output="missing/out.gpkg")
        self.assert_refused("render", NATURAL_EARTH, "--size", "64x64", output="missing/out.png")

    def test_a_file_stands_where_a_folder_must(self):
        self.assert_refused("cut", self.picture, output="file/out.gpkg")
        self.assert_refused("cut", self.picture, output="file/tiles")
        self.assert_refused("render", NATURAL_EARTH, "--size", "64x64", output="file/out.png")

    def test_a_file_of_another_kind_is_not_replaced_by_a_folder_of_tiles(self):
        self.assert_refused("cut", self.picture, output="file")
        self.assertEqual((self.folder / "file").read_bytes(), b"in the way")

    def test_the_output_is_a_folder(self):
        (self.folder / "shots").mkdir()
        self.assert_fails(FAILED, "render", NATURAL_EARTH, "--size", "64x64", "-o", "shots", says=["shots"])
        self.assertTrue((self.folder / "shots").is_dir())

    def test_the_cache_is_a_file(self):
        done = self.assert_done("render", self.picture, "--cache", "file", "-o", "x.png")
        self.assertIn("file: cannot be made: Not a directory; continuing without a cache", done.stderr)


class Formats(ProgramTest):
    def test_the_name_chooses_png_or_jpeg(self):
        for name, begins in (("a.png", b"\x89PNG"), ("b.jpg", b"\xff\xd8\xff"), ("c.JPEG", b"\xff\xd8\xff"), ("d", b"\x89PNG")):
            for _ in range(2):
                self.assert_done("render", NATURAL_EARTH, "--size", "64x32", "-o", name)
                self.assertTrue((self.folder / name).read_bytes().startswith(begins), name)
        self.assertIn("quality 92", self.assert_done("render", "--help").stdout)

    def test_a_name_of_another_format_is_refused(self):
        for name in ("a.tif", "b.WEBP", "c.gif"):
            self.assert_fails(WRONG_USAGE, "render", NATURAL_EARTH, "-o", name, says=[name, "PNG or JPEG", ".png or .jpg"])
        self.assert_nothing_but()


class DiskFull(ProgramTest):
    def assert_refused(self, *arguments, output, **options):
        self.assert_fails(FAILED, *arguments, "-o", output, says=[output], file_size_limit=SMALL_DISK_BYTES, **options)
        self.assert_nothing_but()

    def test_cut_into_a_geopackage(self):
        self.assert_refused("cut", BLUE_MARBLE, output="earth.gpkg")

    def test_cut_into_a_folder(self):
        # Each tile is its own file: the limit must be under one tile.
        self.assert_fails(FAILED, "cut", BLUE_MARBLE, "-o", "tiles", says=["tiles"], file_size_limit=1000)
        self.assert_nothing_but()

    def test_render(self):
        self.assert_refused("render", NATURAL_EARTH, "--size", "1024x1024", output="shot.png",
                            environment={"MESA_SHADER_CACHE_DISABLE": "true"})

    def test_the_cache(self):
        self.assert_fails(FAILED, "render", BLUE_MARBLE, "-o", "shot.png", says=[str(self.folder / "cache")],
                          file_size_limit=SMALL_DISK_BYTES)
        self.assert_nothing_but()


if __name__ == "__main__":
    unittest.main()
