"""--night and --clouds: layers over TILESET, and the attribution of visible layers."""

import json
import unittest

import pictures
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


if __name__ == "__main__":
    unittest.main()
