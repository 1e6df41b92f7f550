"""Preloading from a faulty server: every fault is named, and only tiles are stored."""

import unittest

import servers
from preload_test import PreloadTest
from program import DONE_IN_PART

FAULTS = {  # a tile of level 2, what the server does, what becomes of it, what the summary says
    "2/0/0.jpg": ("404", "absent", None),
    "2/0/1.jpg": ("204", "absent", None),
    "2/0/2.jpg": ("403", "refused", "403"),
    "2/0/3.jpg": ("500", "failed", "500"),
    "2/1/0.jpg": ("html200", "broken", "HTML"),
    "2/1/1.jpg": ("wrongtype", "broken", "not a JPEG, PNG or WebP"),
    "2/1/2.jpg": ("truncated_jpeg", "broken", ""),
    "2/1/3.jpg": ("reset", "failed", ""),
    "2/2/0.jpg": ("loop", "refused", "redirect"),
    "2/2/1.jpg": ("huge?megabytes=100", "refused", ""),
    "2/2/2.jpg": ("bomb?megabytes=64", "refused", ""),
    "2/2/3.jpg": ("empty", "blank", None),
    "2/3/0.jpg": ("ok", "broken", "another size"),  # its picture is one pixel
    "2/3/1.jpg": ("503?retry_after=1&times=1", "stored", None),
    "2/3/2.jpg": ("429?retry_after=1&times=1", "stored", None),
    "2/3/3.jpg": ("truncated", "failed", ""),
    "2/4/0.jpg": ("401", "refused", "401"),
}


class Faults(PreloadTest):
    def test_each_is_named(self):
        servers.write_pyramid(self.root, 3)
        with servers.misbehaving(self.root, {path: fault for path, (fault, _, _) in FAULTS.items()}) as server:
            summary, said = self.preload(server.template, "--levels", "0-2", "--retries", "1", "--missing", "missing.txt",
                                         code=DONE_IN_PART)
            log = server.log()
        missing = {}
        for line in (self.folder / "missing.txt").read_text().splitlines():
            place, kind, why = line.split("\t")
            missing[place + ".jpg"] = (kind, why)
        for path, (fault, becomes, says) in FAULTS.items():
            with self.subTest(fault):
                if becomes in ("absent", "blank", "stored"):
                    self.assertNotIn(path, missing)
                else:
                    self.assertEqual(missing[path][0], becomes, missing[path])
                    self.assertIn(says, missing[path][1])
                    self.assertTrue(any(group["kind"] == becomes and says in group["why"]
                                        for group in summary["lacking"]), summary["lacking"])
        for kind in ("absent", "blank", "refused", "failed", "broken"):
            self.assertEqual(summary[kind], sum(becomes == kind for _, becomes, _ in FAULTS.values()), kind)
        self.assertEqual(len(missing), summary["refused"] + summary["failed"] + summary["broken"])
        self.assertIn(f"{len(missing)} tiles are missing", said)
        whole = servers.tiles_in(3) - sum(becomes != "stored" for _, becomes, _ in FAULTS.values())
        self.assertEqual(summary["stored"], whole)
        self.assert_stored_are_right()
        self.assert_bounded(log)

    def assert_bounded(self, log):
        """Two attempts in the first pass, two in the second; redirects are followed a few times in each."""
        counts = {}
        for entry in log:
            counts[entry["path"]] = counts.get(entry["path"], 0) + 1
        for path, count in counts.items():
            self.assertLessEqual(count, 24 if path == "/2/2/0.jpg" else 4, path)

    def test_the_next_run_asks_only_for_missing_tiles(self):
        servers.write_pyramid(self.root, 3)
        with servers.misbehaving(self.root, {"2/0/0.jpg": "500?times=2", "1/0/0.jpg": "404"}) as server:
            self.preload(server.template, "--levels", "0-2", "--retries", "0", code=DONE_IN_PART)
            before = len(server.log())
            summary, _ = self.preload(server.template, "--levels", "0-2", "--retries", "0")
            self.assertEqual([entry["path"] for entry in server.log()[before:]], ["/2/0/0.jpg"])
        self.assertEqual((summary["stored"], summary["there"]), (1, servers.tiles_in(3) - 1))

    def test_a_broken_answer_does_not_take_the_place_of_a_tile(self):
        servers.write_pyramid(self.root, 2)
        with servers.misbehaving(self.root, {}) as server:
            self.preload(server.template, "--levels", "0-1")
            for path in ("1/0/0.jpg", "1/1/1.jpg"):
                (self.root / path).write_bytes(b"<html>")
            summary, _ = self.preload(server.template, "--levels", "0-1", "--refresh-older-than", "0",
                                      code=DONE_IN_PART)
        self.assertEqual((summary["stored"], summary["broken"]), (servers.tiles_in(2) - 2, 2))
        self.assertEqual(len(self.stored()), servers.tiles_in(2))
        self.assert_stored_are_right()

    def test_no_more_than_the_rate(self):
        servers.write_pyramid(self.root, 3)
        rate = 30
        with servers.misbehaving(self.root, {"2/0/0.jpg": "500"}) as server:
            self.preload(server.template, "--levels", "0-2", "--rate", rate, code=DONE_IN_PART)
            times = sorted(entry["time_s"] for entry in server.log())
        burst = rate / 4
        for first, begun in enumerate(times):
            within = sum(begun <= t < begun + 1.0 for t in times[first:])
            self.assertLessEqual(within, rate + burst + 2)


if __name__ == "__main__":
    unittest.main()
