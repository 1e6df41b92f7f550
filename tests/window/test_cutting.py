"""A large picture without overviews shows at once in the window, and its cut goes on behind it, also after a kill."""

import os
import pathlib
import signal
import subprocess
import time
import unittest

import png
from real_window import SIZE, WindowTest, wait_until

MARBLE = pathlib.Path(os.environ["TERRELLA_SOURCE"]) / "data/earth/blue_marble_4096x2048.jpg"
PICTURE = (32768, 16384)  # eight bands of 2048 rows: a cut of many seconds, so that it can be met halfway
BAR = (SIZE[0] // 2 - 100, SIZE[0] // 2 + 100, 30)  # columns and row of the progress bar's panel
SAHARA = (SIZE[0] // 2, SIZE[1] // 2)


class Cutting(WindowTest):
    def setUp(self):
        super().setUp()
        self.picture = self.folder / "striped.tif"
        subprocess.run(["gdal_translate", "-q", "-outsize", *map(str, PICTURE), "-co", "COMPRESS=ZSTD", "-co", "ZSTD_LEVEL=1",
                        MARBLE, self.picture], check=True)
        self.addCleanup(self.picture.unlink)
        self.cache = self.kept / "terrella"

    def view(self, *options):
        return self.start(self.picture, "--camera", "20,8,30000000", "--sky", "off", *options)

    def work(self):
        """The folder of the unfinished cut; None without one."""
        return next(iter(self.cache.glob(".*.part")), None)

    def logs(self):
        """Sizes and times of the files with tiles."""
        work = self.work()
        found = {}
        for log in work.glob("band-*.tiles*") if work else []:
            try:
                found[log.name.removesuffix(".part")] = log.stat()
            except FileNotFoundError:
                pass  # the file got its final name just now
        return found

    def wait_for_bands(self, count):
        wait_until(f"{count} bands", lambda: self.work() and len(list(self.work().glob("band-*.rows"))) >= count)

    def assert_goes_on_from(self, before):
        """Tiles that were there are not made again: files only grow."""
        after = self.logs()
        self.assertLessEqual(set(before), set(after))
        for name, log in before.items():
            self.assertEqual(after[name].st_ino, log.st_ino, "the file was made again")
            # A record that was torn by the kill is made again.
            self.assertGreaterEqual(after[name].st_size, log.st_size - 65536)

    def test_it_shows_at_once_and_goes_on_after_a_kill_and_after_closing(self):
        killed = self.view()
        self.assert_coarse_picture_and_bar(killed)
        self.wait_for_bands(1)
        earlier = self.logs()
        killed.program.send_signal(signal.SIGKILL)
        killed.program.wait()
        self.assert_goes_on_from(earlier)  # nothing of what was there before the kill is lost

        left = self.logs()
        closed = self.view()
        self.assert_goes_on_from(left)
        self.wait_for_bands(2)
        self.assertEqual(closed.quit(), 0)
        self.assertEqual(closed.program.stderr.read(), "")
        self.assertIsNotNone(self.work(), "closing keeps what was done")

        left = self.logs()
        last = self.view()
        whole = wait_until("the whole cut", lambda: list(self.cache.glob("striped-*.gpkg")), 240)
        self.assertEqual(len(whole), 1)
        wait_until("the folder's end", lambda: self.work() is None)
        time.sleep(1.5)
        done = png.read(self.screenshot(last, "whole"))
        self.assertFalse(self.has_bar(done))
        self.assertTrue(self.has_sand(done), "no Sahara in the middle")
        self.assertEqual(last.quit(), 0)

        again = self.view()
        time.sleep(1.0)
        self.assertFalse(self.has_bar(png.read(self.screenshot(again, "again"))))
        self.assertIsNone(self.work(), "it is cut once")

    def test_a_dropped_picture_shows_while_it_is_cut(self):
        black = self.folder / "black.tif"
        subprocess.run(["gdal_translate", "-q", "-outsize", "256", "128", "-scale", "0", "255", "0", "0", "-co", "TILED=YES",
                        MARBLE, black], check=True)
        viewer = self.start(black, "--camera", "20,8,30000000", "--sky", "off")
        self.assertFalse(self.has_bar(png.read(self.screenshot(viewer, "before"))))
        viewer.drop(self.picture)
        wait_until("the bar", lambda: self.has_bar(png.read(self.screenshot(viewer, "dropped"))))
        wait_until("a cut that goes on", lambda: self.work() is not None)
        self.assert_coarse_picture_and_bar(viewer)
        self.remove_highest_layer(viewer)
        wait_until("the bar's end", lambda: not self.has_bar(png.read(self.screenshot(viewer, "removed"))))
        sizes = [{name: log.st_size for name, log in self.logs().items()} for _ in range(2) if time.sleep(2.0) is None]
        self.assertEqual(sizes[0], sizes[1], "the cut of a removed layer has stopped")
        self.assertIsNotNone(self.work(), "what was done is kept")
        self.assertEqual(viewer.quit(), 0)

    def remove_highest_layer(self, viewer):
        viewer.key("l")
        self.screenshot(viewer, "panel")
        viewer.click(SIZE[0] - 180, 128)  # opens the row, under the bar
        time.sleep(1.0)
        self.screenshot(viewer, "row")
        viewer.click(SIZE[0] - 173, 256)
        time.sleep(1.0)
        viewer.key("l")

    def assert_coarse_picture_and_bar(self, viewer):
        def sandy():
            shot = png.read(self.screenshot(viewer, "coarse"))
            return shot if self.has_sand(shot) else None

        self.assertTrue(self.has_bar(wait_until("the Sahara", sandy)))

    def has_sand(self, shot):
        red, _, blue = png.pixel(shot, *SAHARA)
        return red > blue + 20

    def has_bar(self, shot):
        left, right, row = BAR
        return len({png.pixel(shot, x, row) for x in range(left, right)}) > 1


if __name__ == "__main__":
    unittest.main()
