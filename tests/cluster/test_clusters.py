"""Clusters of points by real mouse and keyboard: on, apart from nearby, undone, kept by the session."""

import json
import unittest

from real_window import SIZE, WindowTest, wait_until

DISC = (38, 92, 150)
ROW, CLUSTERS = 65, 162  # pixels under the panel's upper edge
LEFT, RIGHT, TOP, BOTTOM = 130, 250, 190, 290  # the part of the picture beside the panel where the points are


def near(value, colour):
    return all(abs((value >> shift & 255) - part) <= 30 for shift, part in zip((16, 8, 0), colour))


class Clusters(WindowTest):
    def setUp(self):
        super().setUp()
        points = [{"type": "Feature", "properties": {"name": f"P{i}"}, "geometry": {"type": "Point", "coordinates":
                  [-40 + 1.0 * (i % 5), 20 + 1.0 * (i // 5)]}} for i in range(25)]
        self.points = self.folder / "points.geojson"
        self.points.write_text(json.dumps({"type": "FeatureCollection", "features": points}), encoding="ascii")
        self.session = self.kept / "terrella" / "session.terrella"

    def disc(self, viewer):
        """The pixels of a disc, beside its number."""
        rows = viewer.grab()
        return [(x, y) for y in range(TOP, BOTTOM) for x in range(LEFT, RIGHT) if near(rows[y][x], DISC)]

    def shows(self, viewer, name, clusters):
        wait_until(name, lambda: (len(self.disc(viewer)) > 300) == clusters)

    def kept_cluster(self):
        return json.loads(self.session.read_text(encoding="utf-8"))["layers"][1].get("cluster", 0)

    def test_they_are_switched_on_undone_and_kept(self):
        viewer = self.start("--objects", str(self.points), "--camera", "20.1,-22,9000000", "--unlit", bare=False)
        viewer.settled()
        self.shows(viewer, "begins", False)
        viewer.key("l")
        left, top, *_ = map(round, viewer.panel("Layers"))
        viewer.settled()
        viewer.click(left + 90, top + ROW)
        wait_until("the row", lambda: viewer.panel("Layers")[3] > top + CLUSTERS + 20)
        viewer.settled()
        self.screenshot(viewer, "row")
        for time in range(2):
            viewer.click(left + 43, top + CLUSTERS)
            viewer.move(left + 100, top + 8)  # without the tip
            self.shows(viewer, f"clusters_{time}", True)
            viewer.settled()
            self.screenshot(viewer, f"clusters_{time}")
            viewer.key("ctrl+z")
            self.shows(viewer, f"undone_{time}", False)
        viewer.key("ctrl+y")
        self.shows(viewer, "redone", True)
        viewer.key("F6")  # the keyboard is the globe's
        viewer.key("l")
        viewer.settled()
        self.assertEqual(viewer.quit(), 0)
        self.assertEqual(self.kept_cluster(), 40)
        viewer = self.start(bare=False)
        viewer.settled()
        self.shows(viewer, "kept", True)
        pixels = self.disc(viewer)
        x, y = (round(sum(axis) / len(pixels)) for axis in zip(*pixels))
        viewer.wheel(x, y, 30)
        viewer.settled()
        self.screenshot(viewer, "apart")
        self.shows(viewer, "apart", False)
        self.assertEqual(viewer.quit(), 0)


    def test_features_come_and_go_with_the_zoom_level_twice(self):
        """From 9000 km the window, 480 px high, has level 2.5; six steps of the wheel are more than a level."""
        area = {"type": "Feature", "properties": {"fill": "#265c96", "fill-opacity": 1, "stroke-width": 0, "max-zoom": 3},
                "geometry": {"type": "Polygon", "coordinates": [[[-26, 15], [-18, 15], [-18, 25], [-26, 25], [-26, 15]]]}}
        (self.folder / "area.geojson").write_text(json.dumps(area), encoding="ascii")
        viewer = self.start("--objects", "area.geojson", "--camera", "20,-22,9000000", "--unlit")
        viewer.settled()
        middle = lambda: near(viewer.grab()[SIZE[1] // 2][SIZE[0] // 2], DISC)
        for time in range(2):
            wait_until(f"shown, {time}", middle)
            viewer.wheel(SIZE[0] // 2, SIZE[1] // 2, 6)
            wait_until(f"hidden from nearby, {time}", lambda: not middle())
            viewer.wheel(SIZE[0] // 2, SIZE[1] // 2, -6)


if __name__ == "__main__":
    unittest.main()
