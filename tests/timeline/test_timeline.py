"""The dates of a layer in the window: A opens the panel, dates are stepped, played and kept."""

import json
import os
import subprocess
import sys
import unittest
from pathlib import Path

import pictures
import png
from real_window import SIZE, WindowTest, wait_until

sys.path.insert(0, str(Path(os.environ["TERRELLA_SOURCE"]) / "tests/preload"))
import servers  # noqa: E402

COLOURS = [(200, 0, 0), (0, 200, 0), (0, 0, 200), (200, 200, 0)]
DATES = [f"2020-01-{day:02}" for day in range(1, 1 + len(COLOURS))]
BUTTONS = {"First": 30, "Back": 77, "Play": 125, "Next": 173, "Last": 220}  # from the panel's left edge
ROW = 84  # pixels from the panel's upper edge to the buttons
AT = (SIZE[0] // 2, 300)  # on the globe, under the panel and over messages


class Timeline(WindowTest):
    def setUp(self):
        super().setUp()
        self.served = self.folder / "served"
        for date, colour in zip(DATES, COLOURS):
            for x in (0, 1):
                (self.served / date / "0" / str(x)).mkdir(parents=True)
                (self.served / date / "0" / str(x) / "0.png").write_bytes(pictures.png(64, 64, colour))
        server = self.enterContext(servers.misbehaving(self.served, {}))
        self.server = server
        self.set = self.folder / "days.json"
        self.set.write_text(json.dumps({
            "url": f"{server.address}/{{time}}/{{z}}/{{x}}/{{y}}.png", "tile_px": 64, "max_level": 0,
            "times": [f"{DATES[0]}/{DATES[-1]}/P1D"]}))

    def begin(self, **more):
        return self.start(self.set, "--unlit", "--camera", "0,0,1000000", **more)

    def session(self):
        """The layer in the file of the session."""
        return json.loads((self.kept / "terrella" / "session.terrella").read_text(encoding="utf-8"))["layers"][0]

    def press(self, viewer, button):
        viewer.panel("Dates")
        viewer.settled()
        left, top, *_ = viewer.panel("Dates")
        viewer.click(left + BUTTONS[button], top + ROW)

    def shows(self, viewer, name, day):
        """Waits for a date's colour, up to the rounding of JPEG tiles."""
        self.picture(viewer, name, lambda picture: all(abs(seen - wanted) <= 3 for seen, wanted in
                                                       zip(png.pixel(picture, *AT), COLOURS[day])))

    def test_dates_are_stepped_and_played_twice(self):
        viewer = self.begin()
        self.shows(viewer, "newest", 3)
        for k in range(2):
            viewer.key("a")
            self.press(viewer, "Back")
            self.shows(viewer, f"back{k}", 2)
            self.press(viewer, "First")
            self.shows(viewer, f"first{k}", 0)
            self.press(viewer, "Next")
            self.shows(viewer, f"next{k}", 1)
            self.press(viewer, "Last")
            self.shows(viewer, f"last{k}", 3)
            viewer.key("a")
        asked = len(self.server.log())
        viewer.key("a")
        self.press(viewer, "Play")
        self.shows(viewer, "played on", 0)
        self.shows(viewer, "played to", 2)
        self.press(viewer, "Play")
        self.assertEqual(len(self.server.log()), asked, "dates that were shown are not asked for again")
        self.press(viewer, "Last")
        self.shows(viewer, "last", 3)
        viewer.key("a")
        viewer.quit()
        self.assertNotIn("layer-time", self.session(), "a layer at its newest date shows a newer one at the next start")

    def test_the_date_is_kept_and_returns(self):
        viewer = self.begin()
        viewer.key("a")
        self.press(viewer, "First")
        self.shows(viewer, "first", 0)
        viewer.key("a")
        viewer.quit()
        self.assertEqual(self.session()["layer-time"], DATES[0])
        self.shows(self.start(bare=False), "returned", 0)

    def test_files_with_dates_in_their_names_are_stepped_and_return(self):
        for date, colour in zip(DATES, COLOURS):
            (self.folder / f"day_{date.replace('-', '')}.png").write_bytes(pictures.png(64, 32, colour))
        pattern = str(self.folder / "day_{time:%Y%m%d}.png")
        program = os.environ["TERRELLA"]
        told = json.loads(subprocess.run([program, "info", "--json", pattern], capture_output=True, check=True).stdout)
        self.assertEqual(told["times"], f"{DATES[0]} to {DATES[-1]}: {len(DATES)} instants")
        for wrong, cure in ((pattern.replace("%d", "%q"), "unknown code %q"), (pattern.replace("day", "d"), "no file")):
            failed = subprocess.run([program, "info", wrong], capture_output=True, text=True)
            self.assertNotEqual(failed.returncode, 0)
            self.assertIn(cure, failed.stderr)
        viewer = self.start(pattern, "--unlit", "--camera", "0,0,1000000")
        self.shows(viewer, "newest file", 3)
        viewer.key("a")
        self.press(viewer, "First")
        self.shows(viewer, "first file", 0)
        self.press(viewer, "Next")
        self.shows(viewer, "next file", 1)
        viewer.key("a")
        viewer.quit()
        self.assertEqual(self.session()["layer-time"], DATES[1])
        self.shows(self.start(bare=False), "file returned", 1)

    def test_the_globes_time_leads_a_layer(self):
        viewer = self.start(self.set, "--unlit", "--camera", "0,0,1000000", "--layer-clock", "globe", "--time",
                            f"{DATES[1]}T18:00Z")
        self.shows(viewer, "led", 1)
        viewer.key("a")
        viewer.panel("Dates")
        viewer.settled()
        viewer.save_grab(self.folder / "panel.png")
        viewer.key("a")
        viewer.quit()
        self.assertEqual(self.session()["clock"], "globe")
        self.assertNotIn("layer-time", self.session(), "its date is the time's")
        self.shows(self.start(bare=False), "returned", 1)

    def test_a_picture_without_dates_has_no_panel(self):
        viewer = self.start("--unlit")
        viewer.settled()
        viewer.key("a")
        viewer.panel("message")  # tells what is missing
        self.assertNotIn("Dates", viewer.layout.panels)


if __name__ == "__main__":
    unittest.main()
