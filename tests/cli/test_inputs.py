"""Pictures that cannot be shown or cut: exit code 1, the file named, what is wrong and what to do."""

import unittest
import zlib

from pictures import png, png_of, tiff_header
from program import BLUE_MARBLE, FAILED, NATURAL_EARTH, ProgramTest


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

    def test_jpeg_that_is_not_two_to_one_says_what_to_do(self):
        self.assert_refused(NATURAL_EARTH / "0/0/0.jpg", "--bounds", "256")


if __name__ == "__main__":
    unittest.main()
