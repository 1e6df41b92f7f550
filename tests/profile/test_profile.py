"""The profile of a measured path in the window: its plot, and its table beside gdallocationinfo."""

import csv
import math
import os
import subprocess
import unittest
from pathlib import Path

import png
from real_window import SIZE, WindowTest, wait_until

TEMPERATURE = Path(os.environ["TERRELLA_SOURCE"]) / "data/ocean/sea_surface_temperature.tif"
LINE = (120, 200, 255)  # the plot's


class Profile(WindowTest):
    def measured(self):
        """A way from sea over land to sea, and its profile."""
        viewer = self.start(str(TEMPERATURE), "--camera", "5,-45,12000000", "--unlit")
        viewer.settled()
        viewer.key("m")
        for x, y in ((110, 250), (450, 250)):
            viewer.click(x, y)
        viewer.key("ctrl+p")
        viewer.panel("Profile")
        return viewer

    def table(self, viewer):
        """Rows that "Save as CSV" writes."""
        box = viewer.panel("Profile")
        viewer.click(int(box[0]) + 60, int(box[3]) - 18)
        file = wait_until("the table", lambda: next(iter(self.folder.glob("terrella-*.csv")), None))
        with file.open(encoding="ascii", newline="") as rows:
            found = list(csv.DictReader(rows))
        file.unlink()
        return found

    def stored(self, rows):
        """The values that GDAL reads at the places of the table."""
        places = "".join(f"{row['longitude']} {row['latitude']}\n" for row in rows)
        done = subprocess.run(["gdallocationinfo", "-wgs84", "-valonly", str(TEMPERATURE)], input=places, check=True,
                              capture_output=True, text=True)
        return [float(value) for value in done.stdout.split()]

    def test_the_table_has_the_values_of_the_file_twice(self):
        viewer = self.measured()

        def plotted(picture):
            return sum(png.pixel(picture, x, y)[:3] == LINE for x in range(12, 400) for y in range(40, 300)) > 100

        self.picture(viewer, "profile", plotted)
        wait_until("all values", lambda: len([row for row in self.table(viewer) if row["value"]]) > 60)
        viewer.settled(still_s=1.0)
        for _ in range(2):
            rows = self.table(viewer)
            self.assertGreater(len(rows), 250)
            truth = self.stored(rows)
            known = [(float(row["value"]), true) for row, true in zip(rows, truth) if row["value"]]
            blank = [true for row, true in zip(rows, truth) if not row["value"]]
            self.assertGreater(len(known), 60)
            # GDAL writes 15 digits of a float.
            self.assertEqual([pair for pair in known if not math.isclose(*pair, rel_tol=1e-6)], [])
            self.assertTrue(all(value < -100 or math.isnan(value) for value in blank), "no data there")
            viewer.key("ctrl+p")  # closed, and opened again
            viewer.settled()
            viewer.key("ctrl+p")
            viewer.settled(still_s=1.0)

    def test_without_a_way_it_says_what_to_do(self):
        viewer = self.start("--camera", "5,-45,12000000", "--unlit")
        viewer.settled()
        viewer.key("ctrl+p")
        box = viewer.panel("Profile")
        self.assertLess(box[3] - box[1], 120)
        viewer.key("Escape")
        viewer.settled()
        self.assertNotIn("Profile", viewer.layout.panels)


if __name__ == "__main__":
    unittest.main()
