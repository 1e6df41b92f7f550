"""--night and --clouds: layers over TILESET, and the attribution of visible layers."""

import json
import unittest

import pictures
import png
from program import FAILED, WRONG_USAGE, ProgramTest

SMALL = ["--size", "64x64", "--sky", "off", "-o", "out.png"]
NOON_AT_GREENWICH = ["--time", "2026-03-20T12:00Z"]


class Layers(ProgramTest):
    def setUp(self):
        super().setUp()
        self.tile_set("ground", "A Ground")
        self.tile_set("lamps", "B Lamps")

    def tile_set(self, name, attribution):
        self.write(f"{name}.png", pictures.png(256, 128))
        self.assert_done("cut", f"{name}.png", "-o", f"{name}.gpkg", "--attribution", attribution)

    def owed(self, *arguments):
        return json.loads(self.assert_done("render", "ground.gpkg", *SMALL, "--json", *arguments).stdout)["attributions"]

    def test_night_is_owed_to_where_it_is_night(self):
        night = ["--night", "lamps.gpkg", *NOON_AT_GREENWICH]
        self.assertEqual(self.owed(*night, "--camera", "0,180,1e6"), ["A Ground", "B Lamps"])
        self.assertEqual(self.owed(*night, "--camera", "0,0,1e6"), ["A Ground"])

    def test_night_needs_a_time(self):
        self.assert_fails(WRONG_USAGE, "render", "ground.gpkg", *SMALL, "--night", "lamps.gpkg",
                          says=["--night", "--time"])

    def test_clouds_may_have_an_opacity(self):
        for clouds, owed in (("lamps.gpkg", ["A Ground", "B Lamps"]), ("lamps.gpkg:0.5", ["A Ground", "B Lamps"]),
                             ("lamps.gpkg:0", ["A Ground"])):
            self.assertEqual(self.owed("--clouds", clouds), owed, clouds)
        done = self.assert_done("render", "ground.gpkg", *SMALL, "--clouds", "lamps.gpkg")
        self.assertIn("out.png: thanks to A Ground; B Lamps\n", done.stdout)

    def test_a_layer_that_is_not_there(self):
        for option in (["--clouds", "nowhere.gpkg"], ["--night", "nowhere.gpkg", *NOON_AT_GREENWICH]):
            self.assert_fails(FAILED, "render", "ground.gpkg", *SMALL, *option, says=["nowhere.gpkg"])

    def test_an_opacity_that_is_none(self):
        self.assert_fails(WRONG_USAGE, "render", "ground.gpkg", *SMALL, "--clouds", "lamps.gpkg:1.5",
                          says=["--clouds", "lamps.gpkg:1.5"])


class Blend(ProgramTest):
    """--overlay-blend, and the blend of a layer of a project."""

    BELOW, OWN = (200, 90, 30), (120, 60, 220)
    BLENDS = {"normal": lambda b, c: c, "multiply": lambda b, c: b * c / 255,
              "screen": lambda b, c: b + c - b * c / 255, "difference": lambda b, c: abs(b - c)}

    def setUp(self):
        super().setUp()
        for name, color in (("below", self.BELOW), ("own", self.OWN)):
            self.write(f"{name}.png", pictures.png(256, 128, color))

    def seen(self, *arguments):
        self.assert_done("render", *arguments, *SMALL, "--unlit", "--cache", "off", "--camera", "0,0,1e6")
        return png.pixel(png.read(self.folder / "out.png"), 32, 32)[:3]

    def test_each_blend_has_its_formula(self):
        for blend, formula in self.BLENDS.items():
            for opacity in (1.0, 0.5):
                with self.subTest(blend, opacity=opacity):
                    wanted = [b + opacity * (formula(b, c) - b) for b, c in zip(self.BELOW, self.OWN)]
                    self.write("p.terrella", json.dumps({"terrella": 1, "layers": [
                        {"kind": "imagery", "source": "below.png"},
                        {"kind": "imagery", "source": "own.png", "opacity": opacity, "blend": blend}]}).encode())
                    for scene in (["below.png", "--overlay", f"own.png:{opacity}", "--overlay-blend", blend],
                                  ["p.terrella"]):
                        for got, want in zip(self.seen(*scene), wanted):  # tiles are JPEG, which rounds
                            self.assertLessEqual(abs(got - want), 3, scene)

    def test_another_word_is_refused(self):
        self.assert_fails(WRONG_USAGE, "render", "below.png", "-o", "out.png", "--overlay-blend", "burn",
                          says=["--overlay-blend", "burn", "multiply"])
        self.write("p.terrella", json.dumps({"terrella": 1, "layers": [
            {"kind": "imagery", "source": "below.png", "blend": "burn"}]}).encode())
        self.assert_fails(FAILED, "render", "p.terrella", "-o", "out.png", says=["blend", "burn"])


class Swipe(ProgramTest):
    """--swipe: each side of the line is the picture with that side's layer alone."""

    COLORS = {"ground": (0, 0, 200), "first": (200, 0, 0), "second": (0, 200, 0)}

    def setUp(self):
        super().setUp()
        for name, color in self.COLORS.items():
            self.write(f"{name}.png", pictures.png(256, 128, color))

    def seen(self, *arguments):
        """The colours left and right of the middle."""
        self.assert_done("render", "ground.png", *SMALL, "--unlit", "--cache", "off", "--camera", "0,0,1e6", *arguments)
        picture = png.read(self.folder / "out.png")
        return [self.named(png.pixel(picture, x, 32)) for x in (4, 30, 34, 60)]

    def named(self, pixel):
        """The layer of a colour; tiles are JPEG, which rounds."""
        return next(name for name, color in self.COLORS.items()
                    if all(abs(a - b) <= 3 for a, b in zip(pixel, color)))

    def test_two_overlays_are_compared_at_the_line(self):
        both = ["--overlay", "first.png", "--overlay", "second.png"]
        self.assertEqual(self.seen(*both), ["second"] * 4)
        self.assertEqual(self.seen(*both, "--swipe", "0.5"), ["second", "second", "first", "first"])
        self.assertEqual(self.seen(*both, "--swipe", "0"), ["first"] * 4)
        self.assertEqual(self.seen(*both, "--swipe", "1"), ["second"] * 4)

    def test_one_overlay_is_compared_with_what_lies_under_it(self):
        self.assertEqual(self.seen("--overlay", "first.png", "--swipe", "0.5"), ["first", "first", "ground", "ground"])

    def test_one_layer_cannot_be_compared(self):
        self.assert_fails(FAILED, "render", "ground.png", *SMALL, "--cache", "off", "--swipe", "0.5",
                          says=["--swipe", "--overlay"])

    def test_a_place_outside_the_picture(self):
        self.assert_fails(WRONG_USAGE, "render", "ground.png", *SMALL, "--swipe", "1.5", says=["--swipe"])


if __name__ == "__main__":
    unittest.main()
