"""Runs a preloader and two viewers on one cache with a limit of half the incoming tiles. Requires no error, no message
about a lock, a file within 5 % of its limit, and an intact database at the end. Run from the repository's root:

  TERRELLA_SOURCE=. python3 tests/bench/shared_cache.py build/terrella --seconds 300"""

import argparse
import json
import pathlib
import random
import subprocess
import sys
import tempfile
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "preload"))
import servers  # noqa: E402

LEVELS = 7
LIMIT_MB = 64
ALLOWED = 1.05


class Run:
    def __init__(self, options, folder):
        self.program = pathlib.Path(options.program).resolve()
        self.folder = folder
        self.ends = time.monotonic() + options.seconds
        self.complaints = []
        self.runs = {"preload": 0, "render": 0}
        self.largest = 0

    def call(self, *arguments):
        done = subprocess.run([self.program, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True)
        self.runs[arguments[0]] += 1
        told = done.stdout + done.stderr
        if done.returncode != 0 or "locked" in told:
            self.complaints.append(f"exit {done.returncode}: {told[-500:]}")

    def preload(self, source):
        while time.monotonic() < self.ends:
            self.call("preload", source, "-o", "cache.gpkg", "--refresh-older-than", "0", "--cache-size", LIMIT_MB)

    def view(self, source, seed):
        draw = random.Random(seed)
        while time.monotonic() < self.ends:
            camera = f"{draw.uniform(-90, 90):.3f},{draw.uniform(-180, 180):.3f},{10 ** draw.uniform(5.3, 7):.0f}"
            self.call("render", source, "-o", f"view{seed}.png", "--unlit", "--camera", camera, "--cache", "cache.gpkg",
                      "--cache-size", LIMIT_MB)

    def watch(self):
        while time.monotonic() < self.ends:
            sizes = [p.stat().st_size for p in self.folder.glob("cache.gpkg*") if not p.name.endswith("-shm")]
            self.largest = max(self.largest, sum(sizes))
            time.sleep(0.2)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--seconds", type=float, default=300.0)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="terrella-shared-") as folder:
        folder = pathlib.Path(folder)
        servers.write_pyramid(folder / "tiles", LEVELS)
        comes_in = sum(p.stat().st_size for p in (folder / "tiles").rglob("*.jpg"))
        with servers.nginx(folder / "tiles") as server:
            source = folder / "source.json"
            source.write_text(json.dumps({"url": server.template, "max_level": LEVELS - 1}))
            run = Run(options, folder)
            threads = [threading.Thread(target=run.preload, args=(source,)), threading.Thread(target=run.watch)]
            threads += [threading.Thread(target=run.view, args=(source, seed)) for seed in (1, 2)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
        check = subprocess.run(["sqlite3", folder / "cache.gpkg", "PRAGMA integrity_check"], capture_output=True,
                               text=True).stdout.strip()
        ended = (folder / "cache.gpkg").stat().st_size
    print(f"{options.seconds:.0f} s: {run.runs['preload']} preloads of {comes_in / 1e6:.0f} MB, {run.runs['render']} views; "
          f"limit {LIMIT_MB} MB, largest {run.largest / 1e6:.1f} MB with its log, {ended / 1e6:.1f} MB at the end; "
          f"integrity {check}; {len(run.complaints)} complaints")
    print("\n".join(run.complaints[:5]))
    return 0 if not run.complaints and check == "ok" and run.largest <= ALLOWED * LIMIT_MB * 1e6 else 1


if __name__ == "__main__":
    sys.exit(main())
