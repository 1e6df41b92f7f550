"""Unusable pictures and descriptions: exit code 1, and a message with the file, its fault and a remedy."""

import os
import re
import subprocess
import unittest
import zlib

from pictures import png, png_of, tiff_header
from program import BLUE_MARBLE, FAILED, NATURAL_EARTH, WRONG_USAGE, ProgramTest


DEEP = 100_000  # more than a stack holds of whatever calls itself
HUGE = "1e400"  # more than a double holds
TEMPLATE = '"url": "http://127.0.0.1:9/{z}/{x}/{y}.jpg"'


class BadJson(ProgramTest):
    """Numbers that overflow and lists in lists: the file and the reason are named, whatever reads it."""

    def assert_refused(self, name, text, *says):
        self.write(name, text.encode())
        commands = [["render", name, "-o", "a.png"], ["info", name], ["preload", name, "-o", "a.gpkg"]]
        if name.endswith(".geojson"):
            commands = [["render", "--objects", name, "-o", "a.png", "--size", "64x64"],
                        ["preload", NATURAL_EARTH, "--polygon", name, "-o", "a.gpkg"],
                        ["preload", NATURAL_EARTH, "--flight", name, "-o", "a.gpkg"]]
        for command in commands:
            self.assert_fails(FAILED, *command, says=[name, *says])

    def test_nested_too_deep(self):
        lists = "[" * DEEP + "]" * DEEP
        for text in lists, f'{{{TEMPLATE}, "bounds": {lists}}}', '{"a":' * DEEP + "1" + "}" * DEEP:
            self.assert_refused("source.json", text, "nested more than 64 deep")
        for text in f'{{"type": "Feature", "geometry": null, "properties": {lists}}}', lists:
            self.assert_refused("a.geojson", text, "nested more than 64 deep")
        (self.folder / "tiles").mkdir()
        self.write("tiles/tileset.json", lists.encode())
        self.assert_fails(FAILED, "info", "tiles", says=["tileset.json", "nested more than 64 deep"])

    def test_numbers_that_overflow(self):
        for field in "max_level", "root_span_deg", "tile_life_s":
            self.assert_refused("source.json", f'{{{TEMPLATE}, "{field}": {HUGE}}}', "too large")
        self.assert_refused("source.json", f'{{{TEMPLATE}, "bounds": [-{HUGE}, 0, 1, 1]}}', "too large")
        self.assert_refused("a.geojson", f'{{"type": "Polygon", "coordinates": [[[0, 0], [{HUGE}, 0], [1, 1], [0, 0]]]}}',
                            "too large")

    def test_options_that_overflow(self):
        for option in "--root-span", "--exaggeration", "--max-level", "--memory", "--timeout", "--cache-size":
            self.assert_fails(WRONG_USAGE, "render", "-o", "a.png", option, HUGE, says=[option, HUGE, "too large"])

    def test_xml_that_overflows(self):
        from test_remote import CAPABILITIES, MATRIX
        matrix = MATRIX.format(z=0, scale=1.0, width=2, height=1).replace("<ScaleDenominator>1.0", f"<ScaleDenominator>{HUGE}")
        text = CAPABILITIES.format(address="http://127.0.0.1:9", matrices=matrix)
        self.assert_refused("caps.xml", text, "ScaleDenominator")
        text = (NATURAL_EARTH / "tilemapresource.xml").read_text()
        self.write("tms.xml", re.sub('units-per-pixel="[^"]*"', f'units-per-pixel="{HUGE}"', text).encode())
        self.assert_fails(FAILED, "info", "tms.xml", says=["tms.xml", "units-per-pixel"])


class BadPictures(ProgramTest):
    def assert_refused(self, picture, *says):
        """By `cut` as by `render`, which cuts into the cache; neither leaves anything behind."""
        before = sorted(p.name for p in self.folder.iterdir() if p.name != "cache")
        for arguments in (["cut", picture, "-o", "out.gpkg"], ["cut", picture, "-o", "tiles"],
                          ["render", picture, "-o", "out.png"]):
            with self.subTest(arguments[0], output=arguments[-1]):
                self.assert_fails(FAILED, *arguments, says=[str(picture), *says])
                self.assert_nothing_but(*before)
        cache = self.folder / "cache"
        self.assertEqual([str(p) for p in cache.rglob("*") if p.is_file()], [], "left in the cache")

    def test_no_such_file(self):
        self.assert_refused(self.folder / "nowhere.jpg", "no such file")

    def test_view_names_a_missing_file_too(self):
        self.assert_fails(FAILED, "view", "nowhere.jpg", says=["nowhere.jpg"])

    def test_a_folder_for_a_picture(self):
        (self.folder / "folder.jpg").mkdir()
        self.assert_fails(FAILED, "cut", "folder.jpg", "-o", "out.gpkg", says=["folder.jpg"])

    def test_empty_file(self):
        self.assert_refused(self.write("empty.jpg", b""))

    def test_not_an_image(self):
        self.assert_refused(self.write("letter.jpg", b"Dear Sir or Madam,\n" * 100))

    def test_truncated_jpeg(self):
        whole = BLUE_MARBLE.read_bytes()
        self.assert_refused(self.write("half.jpg", whole[: len(whole) // 2]))

    def test_jpeg_cut_off_in_its_header(self):
        self.assert_refused(self.write("head.jpg", BLUE_MARBLE.read_bytes()[:200]))

    def test_truncated_png(self):
        whole = png(512, 256)
        self.assert_refused(self.write("half.png", whole[: len(whole) - 60]))

    def test_png_with_fewer_rows_than_it_claims(self):
        rows = zlib.compress((b"\0" + bytes(3 * 512)) * 100)
        self.assert_refused(self.write("short.png", png_of(512, 256, rows)))

    def test_tiff_without_its_pixels(self):
        self.assert_refused(self.write("hollow.tif", tiff_header(512, 256)))

    def test_tiff_that_is_a_bare_header(self):
        self.assert_refused(self.write("bare.tif", b"II*\0\xff\xff\xff\x7f"))

    def test_picture_that_claims_to_be_enormous(self):
        # 2^31 - 2 by 2^30 - 1 pixels: 2:1, and more than any disk here holds.
        self.assert_refused(self.write("vast.png", png_of(2**31 - 2, 2**30 - 1, zlib.compress(b"\0" * 1000))))
        self.assert_refused(self.write("vast.tif", tiff_header(2**32 - 2, 2**31 - 1)))

    def test_picture_that_is_not_two_to_one_says_what_to_do(self):
        self.assert_refused(self.write("square.png", png(300, 300)), "--bounds", "300")

    def test_almost_two_to_one_is_to_be_resized_or_placed(self):
        self.assert_refused(self.write("almost.png", png(2000, 999)), "2000x999", "Resize it to 2000x1000",
                            "if it shows a part, say which with --bounds W,S,E,N")

    def test_pipes_are_not_waited_for(self):
        os.mkfifo(self.folder / "fifo.jpg")
        for arguments in (["cut", "fifo.jpg", "-o", "out.gpkg"], ["cut", "fifo.jpg", "-o", "out.gpkg", "--elevation"],
                          ["render", "fifo.jpg", "-o", "out.png"], ["view", "fifo.jpg"], ["info", "fifo.jpg"],
                          ["render", BLUE_MARBLE, "--overlay", "fifo.jpg", "-o", "out.png"]):
            with self.subTest(arguments[0]):
                self.assert_fails(FAILED, *arguments, says=["fifo.jpg"], time_limit_s=30)

    def test_devices_are_no_pictures(self):
        self.assert_fails(FAILED, "cut", "/dev/zero", "-o", "out.gpkg", says=["/dev/zero", "device"])
        self.assert_fails(FAILED, "info", "/dev/zero", says=["/dev/zero"])

    def test_pictures_of_other_formats(self):
        """The start of a file alone, which GDAL recognizes and cannot read."""
        starts = {"a.jp2": b"\0\0\0\x0cjP  \r\n\x87\n", "a.vrt": b"<VRTDataset rasterXSize='2' rasterYSize='1'>",
                  "a.nc": b"CDF\1\0\0\0\0", "b.nc": b"\x89HDF\r\n\x1a\n", "a.bmp": b"BM\x36\0\0\0\0\0",
                  "a.gif": b"GIF89a", "a.img": b"PDS_VERSION_ID = PDS3\r\n", "a.cub": b"Object = IsisCube\n"}
        for name, start in starts.items():
            with self.subTest(name):
                picture = self.write(name, start)
                self.assert_refused(picture)
                self.assert_fails(FAILED, "info", picture, says=[name])

    def test_what_is_neither_names_pictures_first(self):
        letter = self.write("letter.txt", b"Dear Sir or Madam,\n" * 100)
        done = self.assert_fails(FAILED, "render", letter, "-o", "out.png", says=["JPEG, PNG, WebP, TIFF", "GeoPackage"])
        self.assertLess(done.stderr.index("JPEG, PNG, WebP, TIFF"), done.stderr.index("GeoPackage"))

    def test_jpeg_that_is_not_two_to_one_says_what_to_do(self):
        self.assert_refused(NATURAL_EARTH / "0/0/0.jpg", "--bounds", "256")


if __name__ == "__main__":
    unittest.main()
