"""Measures requests, bytes and seconds until a view settles from an empty cache and a server 20 ms away, and compares
with the number of tiles that CesiumJS requested. Run from the repository's root:

  build/noise_planet --out noise.png
  build/terrella cut noise.png -o noise-tiles --format png
  TERRELLA_SOURCE=. python3 tests/bench/cold_view.py build/terrella noise-tiles

Exit code 1 if the requests exceed 0.8 times CesiumJS's."""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "preload"))
import servers  # noqa: E402

CAMERAS = (
    ("mid latitude, 6000 km", "30,20,6000000", 54),
    ("antimeridian, 6000 km", "0,180,6000000", 50),
    ("beside the pole, 6000 km", "89.9,0,6000000", 110),
    ("beside the pole, 1500 km", "88,10,1500000", 62),
    ("pole, tilted 45°", "80,180,1200000,0,-45", 84),
    ("low oblique, 300 km", "46,7,300000,30,-20,45", 13),
)
MOST_REQUESTS = 0.8


def measure(program, tiles, grid, camera, latency_ms):
    with tempfile.TemporaryDirectory(prefix="terrella-cold-") as folder:
        folder = pathlib.Path(folder)
        (folder / "tiles").symlink_to(tiles.resolve())
        with servers.misbehaving(folder / "tiles", {}, "--latency-ms", str(latency_ms)) as server:
            source = folder / "source.json"
            source.write_text(json.dumps({"url": server.template.replace(".jpg", f".{grid['format']}"),
                                          "root_span_deg": grid["root_span_deg"], "max_level": grid["max_level"]}))
            begun = time.monotonic()
            subprocess.run([program, "render", source, "-o", folder / "view.png", "--unlit", "--camera", camera,
                            "--cache", folder / "cache.gpkg"], check=True, stdout=subprocess.DEVNULL)
            seconds = time.monotonic() - begun
            paths = [entry["path"].lstrip("/") for entry in server.log()]
        return len(paths), sum((tiles / path).stat().st_size for path in paths), seconds


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("tiles", type=pathlib.Path, help="directory that `terrella cut` wrote")
    parser.add_argument("--latency-ms", type=int, default=20)
    options = parser.parse_args()
    grid = json.loads((options.tiles / "tileset.json").read_text())
    print("| view | requests | of CesiumJS's | bytes | seconds, with the program's start |\n|---|---|---|---|---|")
    worst = 0.0
    for name, camera, cesium in CAMERAS:
        requests, size, seconds = measure(options.program, options.tiles, grid, camera, options.latency_ms)
        worst = max(worst, requests / cesium)
        print(f"| {name} | {requests} | {requests / cesium:.2f} | {size / 1e6:.1f} MB | {seconds:.2f} |", flush=True)
    return 1 if worst > MOST_REQUESTS else 0


if __name__ == "__main__":
    sys.exit(main())
