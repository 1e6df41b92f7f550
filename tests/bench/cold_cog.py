"""Measures requests, bytes and seconds until a view settles from an empty cache and a server 20 ms away: from a COG by
byte ranges, and from the same tiles one by one. Run from the repository's root:

  build/noise_planet --out noise.png
  gdal_translate -of COG -co BLOCKSIZE=256 -co COMPRESS=JPEG -a_srs EPSG:4326 -a_ullr -180 90 180 -90 noise.png noise.tif
  build/terrella cut noise.png -o noise-tiles
  TERRELLA_SOURCE=. python3 tests/bench/cold_cog.py build/terrella noise.tif noise-tiles

Each view of the COG is drawn twice with the same cache. Exit code 1 if the COG needs more requests in any view, more
than 3 requests or 128 KiB before the first tile's, or any request for the second time."""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "cli"))
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from cold_view import CAMERAS, measure  # noqa: E402
from range_server import range_server  # noqa: E402

HEAD = 32768  # the unit in which directories are read
MOST_BEFORE, MOST_BYTES_BEFORE = 3, 128 << 10


def measure_cog(program, cog, camera, latency_ms):
    with tempfile.TemporaryDirectory(prefix="terrella-cold-") as folder:
        with range_server(cog.read_bytes(), name="a.tif", latency_s=latency_ms / 1000) as (url, server):
            command = [program, "render", url, "-o", f"{folder}/view.png", "--unlit", "--camera", camera, "--cache",
                       f"{folder}/cache.gpkg"]
            begun = time.monotonic()
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
            seconds, asked = time.monotonic() - begun, list(server.asked)
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
            return asked, len(server.asked) - len(asked), seconds


def before_tiles(asked):
    """Requests and bytes before the first request that is not of whole blocks of directories."""
    sizes = [last + 1 - first for first, last in asked]
    count = next((i for i, (first, _) in enumerate(asked) if first % HEAD or sizes[i] % HEAD), len(asked))
    return count, sum(sizes[:count])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("cog", type=pathlib.Path)
    parser.add_argument("tiles", type=pathlib.Path, help="directory that `terrella cut` wrote of the same picture")
    parser.add_argument("--latency-ms", type=int, default=20)
    options = parser.parse_args()
    grid = json.loads((options.tiles / "tileset.json").read_text())
    print("| view | requests, COG | tiles | bytes, COG | tiles | before the first tile | second run | seconds, COG | tiles |\n"
          "|---|---|---|---|---|---|---|---|---|")
    good = True
    for name, camera, _ in CAMERAS:
        asked, again, seconds = measure_cog(options.program, options.cog, camera, options.latency_ms)
        requests, size, tile_seconds = measure(options.program, options.tiles, grid, camera, options.latency_ms)
        count, head = before_tiles(asked)
        cog_size = sum(last + 1 - first for first, last in asked)
        good = good and len(asked) <= requests and count <= MOST_BEFORE and head <= MOST_BYTES_BEFORE and again == 0
        print(f"| {name} | {len(asked)} | {requests} | {cog_size / 1e6:.2f} MB | {size / 1e6:.2f} MB | {count}, "
              f"{head >> 10} KiB | {again} | {seconds:.2f} | {tile_seconds:.2f} |", flush=True)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
