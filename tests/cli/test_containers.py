"""Pictures and tile sets in WebP, pictures that EXIF turns, and formats that other programs must convert."""

import pathlib
import re
import shlex
import struct
import subprocess
import unittest

import png
import servers
from program import BLUE_MARBLE, DONE, DONE_IN_PART, FAILED, ProgramTest

VIEW = ("--unlit", "--sky", "off", "--camera", "20,10,9000000", "--size", "128x128")
# Mean difference of a channel, levels: lossy tiles of the same picture differ by less, turned pictures by far more.
SAME_PICTURE = 3.0
OTHER_PICTURE = 12.0


def run(*command, cwd=None):
    subprocess.run([*map(str, command)], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd=cwd)


class PictureTest(ProgramTest):
    """Each test has the same picture, made once, as has its shot."""

    made = upright = None

    def setUp(self):
        super().setUp()
        self.marble = self.folder / "marble.png"
        if PictureTest.made is None:
            run("gdal_translate", "-q", "-of", "PNG", "-outsize", 512, 256, BLUE_MARBLE, self.marble)
            PictureTest.made = self.marble.read_bytes()
        self.marble.write_bytes(PictureTest.made)

    def true_shot(self):
        if PictureTest.upright is None:
            PictureTest.upright = self.shot(self.marble)
        return PictureTest.upright

    def shot(self, *arguments, code=DONE):
        done = self.run_program("render", *arguments, "-o", "shot.png", *VIEW)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}{done.stderr}")
        _, _, rows = png.read(self.folder / "shot.png")
        return b"".join(map(bytes, rows))

    @staticmethod
    def difference(a, b):
        return sum(abs(x - y) for x, y in zip(a, b)) / len(a)


class WebpTest(PictureTest):
    def lossless(self, name="marble.webp", source=None, *options):
        run("cwebp", "-quiet", "-lossless", "-exact", *options, source or self.marble, "-o", self.folder / name)
        return self.folder / name

    def test_a_picture_by_cwebp_is_drawn_as_its_png(self):
        self.assertEqual(self.shot(self.lossless()), self.true_shot())

    def test_a_picture_by_gdal(self):
        run("gdal_translate", "-q", "-of", "WEBP", "-co", "QUALITY=95", self.marble, self.folder / "gdal.webp")
        self.assertLess(self.difference(self.shot("gdal.webp"), self.true_shot()), SAME_PICTURE)

    def test_transparency(self):
        run("convert", self.marble, "-alpha", "set", "-region", "256x256+0+0", "-channel", "A", "-evaluate", "set", "40%",
            self.folder / "clear.png")
        webp = self.lossless("clear.webp", self.folder / "clear.png")
        self.assert_done("cut", webp, "-o", "from_webp.gpkg")
        self.assert_done("cut", "clear.png", "-o", "from_png.gpkg")
        self.assertEqual(self.shot("from_webp.gpkg"), self.shot("from_png.gpkg"))
        self.assertIn("PNG", self.assert_done("info", "from_webp.gpkg").stdout)

    def test_cut_into_webp_tiles_that_gdal_reads(self):
        for output in "tiles", "tiles.gpkg":
            self.assert_done("cut", self.marble, "-o", output, "--format", "webp", "--quality", "90")
            self.assertIn("WebP", self.assert_done("info", output, "--verify").stdout)
            self.assertLess(self.difference(self.shot(output), self.true_shot()), SAME_PICTURE)
        tile = next((self.folder / "tiles").rglob("*.webp"))
        self.assertIn("WEBP", subprocess.check_output(["gdalinfo", tile], text=True))
        run("gdal_translate", "-q", "-of", "PNG", self.folder / "tiles.gpkg", self.folder / "back.png")
        self.assertLess(self.difference(self.shot("back.png"), self.true_shot()), SAME_PICTURE)
        check = subprocess.check_output(["sqlite3", self.folder / "tiles.gpkg", "SELECT extension_name FROM gpkg_extensions"],
                                        text=True) if pathlib.Path("/usr/bin/sqlite3").exists() else "gpkg_webp\n"
        self.assertEqual(check, "gpkg_webp\n")

    def test_half_transparent_webp_tiles(self):
        run("convert", self.marble, "-alpha", "set", "-region", "256x256+0+0", "-channel", "A", "-evaluate", "set", "40%",
            self.folder / "clear.png")
        self.assert_done("cut", "clear.png", "-o", "clear.gpkg", "--format", "webp", "--quality", "90")
        self.assert_done("cut", "clear.png", "-o", "png.gpkg")
        self.assertLess(self.difference(self.shot("clear.gpkg"), self.shot("png.gpkg")), SAME_PICTURE)

    def test_sets_by_gdal(self):
        truth = self.true_shot()
        geo = self.folder / "geo.tif"
        run("gdal_translate", "-q", "-a_srs", "EPSG:4326", "-a_ullr", -180, 90, 180, -90, self.marble, geo)
        run("gdal_translate", "-q", "-of", "GPKG", "-co", "TILE_FORMAT=WEBP", "-co", "QUALITY=95", geo, self.folder / "a.gpkg")
        self.assertLess(self.difference(self.shot("a.gpkg"), truth), SAME_PICTURE)
        run("gdal_translate", "-q", "-of", "MBTILES", "-projwin", -180, 85, 180, -85, "-co", "TILE_FORMAT=WEBP", "-co",
            "QUALITY=95", "-co", "ZOOM_LEVEL_STRATEGY=UPPER", geo, self.folder / "a.mbtiles")
        run("gdaladdo", "-q", self.folder / "a.mbtiles", 2, 4)
        self.assertIn("WebP", self.assert_done("info", "a.mbtiles").stdout)
        self.assertLess(self.difference(self.shot("a.mbtiles"), truth), SAME_PICTURE)

    def test_a_server_with_webp_tiles(self):
        self.assert_done("cut", self.marble, "-o", "tiles", "--format", "webp", "--tile-size", "64")
        truth = self.shot("tiles")
        with servers.nginx(self.folder / "tiles") as server:
            template = server.template.replace(".jpg", ".webp")
            options = ("--tile-size", "64", "--max-level", "2", "--cache", "c.gpkg")
            self.assertEqual(self.shot(template, *options), truth)
            self.assert_done("preload", template, "--tile-size", "64", "--levels", "0-2", "-o", "all.gpkg")
        self.assertEqual(self.shot(template, *options, "--offline"), truth)
        self.assertEqual(self.shot("all.gpkg"), truth)

    def test_a_truncated_tile_from_a_server(self):
        self.assert_done("cut", self.marble, "-o", "tiles", "--format", "webp", "--tile-size", "64")
        for tile in (self.folder / "tiles/2").rglob("*.webp"):
            tile.write_bytes(tile.read_bytes()[:-40])
        with servers.nginx(self.folder / "tiles") as server:
            done = self.run_program("render", server.template.replace(".jpg", ".webp"), "--tile-size", "64", "--max-level", "2",
                                    "--cache", "off", "-o", "shot.png", *VIEW)
        self.assertEqual(done.returncode, DONE_IN_PART, done.stderr)
        self.assertIn("ends too early", done.stderr)

    def test_hostile_pictures(self):
        good = self.lossless().read_bytes()
        run("convert", self.marble, "-alpha", "set", "-channel", "A", "-evaluate", "set", "40%", self.folder / "clear.png")
        extended = bytearray(self.lossless("vp8x.webp", self.folder / "clear.png", "-metadata", "all").read_bytes())
        frames = [self.folder / f"{i}.webp" for i in range(2)]
        for i, frame in enumerate(frames):
            run("cwebp", "-quiet", "-q", 20 + 60 * i, self.marble, "-o", frame)
        run("webpmux", "-frame", frames[0], "+100", "-frame", frames[1], "+100", "-o", self.folder / "animated.webp")
        cases = {
            "head.webp": (good[:12], "WebP"),
            "short.webp": (good[:40], "truncated"),
            "half.webp": (good[:len(good) // 2], "truncated"),
            "long.webp": (good[:4] + struct.pack("<I", len(good) + 1000) + good[8:], "truncated"),
            "noise.webp": (good[:30] + bytes(range(256)) * 20, "noise.webp"),
            "animated.webp": ((self.folder / "animated.webp").read_bytes(), "animation"),
        }
        if extended[12:16] == b"VP8X":
            extended[24:30] = b"\xff\x00\x00\xff\x00\x00"
            cases["lying.webp"] = bytes(extended), "lying.webp"
        for name, (data, says) in cases.items():
            with self.subTest(name):
                self.write(name, data)
                self.assert_fails(FAILED, "render", name, "-o", "x.png", *VIEW, says=[name, says])
                self.assert_fails(FAILED, "cut", name, "-o", "x.gpkg", says=[name, says])
                self.assertFalse((self.folder / "x.png").exists())
        self.assert_fails(FAILED, "cut", "marble.webp", "--elevation", "-o", "h.gpkg", says=["marble.webp", "heights"])


def exif(orientation, order="<"):
    """An APP1 marker with one EXIF field."""
    tiff = (b"II" if order == "<" else b"MM") + struct.pack(order + "HI", 42, 8)
    tiff += struct.pack(order + "HHHIHHI", 1, 0x0112, 3, 1, orientation, 0, 0)
    block = b"Exif\0\0" + tiff
    return b"\xff\xe1" + struct.pack(">H", len(block) + 2) + block


# Options by which ImageMagick turns the upright picture so that the orientation turns it back.
STORED = {2: ["-flop"], 3: ["-rotate", "180"], 4: ["-flip"], 5: ["-transpose"], 6: ["-rotate", "270"], 7: ["-transverse"],
          8: ["-rotate", "90"]}


class OrientationTest(PictureTest):
    def stored(self, orientation, order="<", name="turned.jpg"):
        plain = self.folder / "plain.jpg"
        run("convert", self.marble, *STORED.get(orientation, []), "-quality", 98, plain)
        data = plain.read_bytes()
        return self.write(name, data[:2] + exif(orientation, order) + data[2:])

    def test_all_orientations(self):
        truth = self.true_shot()
        for orientation in range(1, 9):
            for order in "<>":
                with self.subTest(orientation=orientation, order=order):
                    turned = self.stored(orientation, order)
                    self.assertLess(self.difference(self.shot(turned), truth), SAME_PICTURE)
        # ImageMagick turns it alike.
        run("convert", self.stored(6), "-auto-orient", self.folder / "upright.png")
        self.assertLess(self.difference(self.shot("upright.png"), truth), SAME_PICTURE)

    def test_without_exif_it_is_another_picture(self):
        run("convert", self.marble, "-rotate", "180", "-quality", 98, self.folder / "plain.jpg")
        self.assertGreater(self.difference(self.shot("plain.jpg"), self.true_shot()), OTHER_PICTURE)

    def test_info_and_cut_know_it(self):
        told = self.assert_done("info", self.stored(6)).stdout
        self.assertIn("512x256, turned upright by its EXIF orientation 6", told)
        self.assertIn('"exif_orientation": 6', self.assert_done("info", "turned.jpg", "--json").stdout)
        self.assertNotIn("EXIF", self.assert_done("info", self.stored(1)).stdout)
        self.assert_done("cut", self.stored(8), "-o", "turned.gpkg")
        self.assertLess(self.difference(self.shot("turned.gpkg"), self.true_shot()), SAME_PICTURE)

    def test_a_world_file_places_the_stored_rows(self):
        """As GDAL does, which ignores EXIF: it and its world files know the stored picture alone."""
        run("convert", self.marble, "-quality", 98, self.folder / "plain.jpg")
        data = (self.folder / "plain.jpg").read_bytes()
        self.write("placed.jpg", data[:2] + exif(3) + data[2:])
        step = 360 / 512
        self.write("placed.jgw", f"{step}\n0\n0\n{-step}\n{-180 + step / 2}\n{90 - step / 2}\n".encode())
        self.assertLess(self.difference(self.shot("placed.jpg"), self.true_shot()), SAME_PICTURE)
        self.assertNotIn("EXIF", self.assert_done("info", "placed.jpg").stdout)

    def test_webp_is_turned_too(self):
        """By its EXIF chunk, which other programs write with and without the head of a JPEG's marker."""
        for orientation in (2, 3, 6):
            for head in (4, 10):
                with self.subTest(orientation=orientation, head=head):
                    run("convert", self.marble, *STORED[orientation], self.folder / "plain.png")
                    run("cwebp", "-quiet", "-lossless", self.folder / "plain.png", "-o", self.folder / "plain.webp")
                    self.write("exif.bin", exif(orientation)[head:])
                    run("webpmux", "-set", "exif", self.folder / "exif.bin", self.folder / "plain.webp",
                        "-o", self.folder / "turned.webp")
                    self.assertLess(self.difference(self.shot("turned.webp"), self.true_shot()), SAME_PICTURE)
        told = self.assert_done("info", "turned.webp").stdout
        self.assertIn("512x256, turned upright by its EXIF orientation 6", told)
        # With transparency: the corner of the stored picture becomes the corner that it is upright.
        run("convert", "-size", "64x32", "xc:none", "-fill", "red", "-draw", "rectangle 0,0 7,7", self.folder / "plain.png")
        run("cwebp", "-quiet", "-lossless", "-exact", self.folder / "plain.png", "-o", self.folder / "plain.webp")
        self.write("exif.bin", exif(3)[10:])
        run("webpmux", "-set", "exif", self.folder / "exif.bin", self.folder / "plain.webp", "-o", self.folder / "clear.webp")
        self.assert_done("cut", "clear.webp", "-o", "clear.gpkg", "--format", "png", "--tile-size", 32)
        shown = subprocess.run(["gdallocationinfo", "-valonly", "-geoloc", str(self.folder / "clear.gpkg")],
                               input="170 -80\n-170 80\n", capture_output=True, text=True, timeout=60).stdout.split()
        self.assertEqual(shown[:4], ["255", "0", "0", "255"])
        self.assertEqual(shown[7], "0")

    def test_a_turned_tiff_is_refused_with_the_command_that_turns_it(self):
        run("convert", self.marble, *STORED[6], "-orient", "RightTop", self.folder / "turned.tif")
        error = self.assert_fails(FAILED, "cut", "turned.tif", "-o", "x.gpkg", says=["turned.tif", "Orientation tag (6)"]).stderr
        self.assert_fails(FAILED, "info", "turned.tif", says=["Orientation tag (6)"])
        command = error.split("upright: ")[1].strip().splitlines()[0]
        run(*shlex.split(command), cwd=self.folder)
        self.assertLess(self.difference(self.shot("upright.tif"), self.true_shot()), SAME_PICTURE)
        # A place is that of the stored rows: GDAL ignores the tag.
        run("convert", self.marble, "-orient", "BottomRight", self.folder / "placed.tif")
        step = 360 / 512
        self.write("placed.tfw", f"{step}\n0\n0\n{-step}\n{-180 + step / 2}\n{90 - step / 2}\n".encode())
        self.assertLess(self.difference(self.shot("placed.tif"), self.true_shot()), SAME_PICTURE)

    def test_broken_exif_turns_nothing(self):
        run("convert", self.marble, "-quality", 98, self.folder / "plain.jpg")
        data = (self.folder / "plain.jpg").read_bytes()
        truth = self.shot("plain.jpg")
        good = exif(6)
        blocks = [good[:4] + b"Exif\0\0" + b"\xff" * (len(good) - 10), exif(0), exif(9), exif(65535),
                  good[:14] + struct.pack("<I", 0xFFFFFFF0) + good[18:],
                  b"\xff\xe1\x00\x08Exif\0\0", b"\xff\xe1\x00\x02", (b"\xff\xe1\xff\xff" + b"x" * 65533) * 20]
        for i, block in enumerate(blocks):
            with self.subTest(i):
                self.write("broken.jpg", data[:2] + block + data[2:])
                self.assertEqual(self.shot("broken.jpg"), truth)
        self.write("ends.jpg", data[:2] + good[:12])
        self.assert_fails(FAILED, "info", "ends.jpg", says=["ends.jpg"])


class OtherFormatsTest(ProgramTest):
    def test_heads_of_formats_that_gdal_cannot_write_here(self):
        for name, data, says in (("a.jxl", b"\xff\x0a" + bytes(40), "djxl a.jxl a.png"),
                                 ("b.jxl", b"\0\0\0\x0cJXL \r\n\x87\n", "djxl b.jxl b.png"),
                                 ("a.avif", b"\0\0\0\x1cftypavif" + bytes(16), "convert a.avif a.png"),
                                 ("a.heic", b"\0\0\0\x1cftypheic" + bytes(16), "gdal_translate -of COG"),
                                 ("a.grb", b"GRIB" + bytes(16), "gdal_translate -of COG")):
            self.write(name, data)
            self.assert_fails(FAILED, "info", name, says=[name, says])

    def test_a_file_that_is_nothing(self):
        self.write("letter.doc", b"Dear all, " * 100)
        done = self.assert_fails(FAILED, "info", "letter.doc", says=["JPEG, PNG, WebP, TIFF", "PMTiles"])
        self.assertLess(done.stderr.index("pictures"), done.stderr.index("GeoPackage"))


if __name__ == "__main__":
    unittest.main()
