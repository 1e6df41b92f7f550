"""Temporarily unavailable tiles: the window retries tiles of every kind after half a minute."""

import collections
import json
import os
import subprocess
import sys
import unittest
from pathlib import Path

from real_window import PROGRAM, WindowTest, wait_until

SOURCE = Path(os.environ["TERRELLA_SOURCE"])
sys.path.insert(0, str(SOURCE / "tests/preload"))
sys.path.insert(0, str(SOURCE / "tests/support"))
import servers  # noqa: E402
from pictures import heights_png, png  # noqa: E402

ATTEMPTS = 3  # attempts of one request; each meets a 503
LIMIT_S = 150.0  # half a minute and the attempts before it, on a loaded machine


class Retry(WindowTest):
    def cut(self, name, picture, *options):
        (self.kept / f"{name}.png").write_bytes(picture)
        folder = self.kept / "served" / name
        folder.parent.mkdir(exist_ok=True)
        subprocess.run([PROGRAM, "cut", self.kept / f"{name}.png", "-o", folder, "--tile-size", "64", *options],
                       check=True, capture_output=True)
        return folder

    def describe(self, server, folder, **more):
        said = json.loads((folder / "tileset.json").read_text())
        grid = {field: said[field] for field in ("tile_px", "root_span_deg", "max_level")}
        url = f"{server.address}/{folder.name}/{{z}}/{{x}}/{{y}}.{said['format']}"
        description = self.kept / f"{folder.name}.json"
        description.write_text(json.dumps({"url": url, **grid, **more}))
        return description

    def test_imagery_and_heights_that_failed_for_now_come_later(self):
        sea = self.cut("sea", png(256, 128))
        relief = self.cut("relief", heights_png(256, 128), "--elevation", "--offset", "-32768")
        served = sea.parent
        faults = {str(tile.relative_to(served)): f"503?times={ATTEMPTS}" for tile in served.glob("*/*/*/*.*")}
        with servers.misbehaving(served, faults) as server:
            heights = self.describe(server, relief, elevation={"scale": 1.0, "offset": -32768.0})
            self.start(self.describe(server, sea), "--elevation", heights, "--camera", "10,20,9000000")

            def all_came():
                asked = collections.Counter(entry["path"] for entry in server.log())
                kinds = {path.split("/")[1] for path in asked}
                return kinds == {"sea", "relief"} and all(times > ATTEMPTS for times in asked.values())

            wait_until("a further request for each tile of both kinds", all_came, LIMIT_S)


if __name__ == "__main__":
    unittest.main()
