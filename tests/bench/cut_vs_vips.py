#!/usr/bin/env python3
"""Times `terrella cut` against `vips dzsave` on a 21600x10800 JPEG, alternately, and prints ratios and peak memory.

  tests/bench/cut_vs_vips.py build/terrella data/earth/blue_marble_4096x2048.jpg

Ratios under 1 mean that terrella is faster. The figures of the project's README are from the last line.
"""

import argparse
import os
import pathlib
import shutil
import statistics
import subprocess
import tempfile
import time

WIDTH = 21600


class Cost:
    """Cost of one command: seconds on the clock, seconds of all cores, peak resident MiB."""

    def __init__(self, command):
        start = time.monotonic()
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        told = process.stderr.read()
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        self.wall_s = time.monotonic() - start
        self.cpu_s = used.ru_utime + used.ru_stime
        self.peak_mib = used.ru_maxrss / 1024
        if process.returncode != 0:
            raise SystemExit(f"{' '.join(map(str, command))}\n{told.decode(errors='replace')}")


def make_picture(source, picture):
    width = int(subprocess.run(["vipsheader", "-f", "width", source], capture_output=True, check=True).stdout)
    subprocess.run(["vips", "resize", source, f"{picture}[Q=85]", str(WIDTH / width)], check=True)


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("terrella")
    arguments.add_argument("picture", help="of a whole planet; enlarged to 21600 pixels")
    arguments.add_argument("--runs", type=int, default=5)
    options = arguments.parse_args()
    costs = {"terrella": [], "vips": []}
    with tempfile.TemporaryDirectory(prefix="terrella-bench-") as name:
        folder = pathlib.Path(name)
        picture = folder / "picture.jpg"
        make_picture(options.picture, picture)
        commands = {
            "terrella": [options.terrella, "cut", picture, "-o", folder / "out.gpkg"],
            "vips": ["vips", "dzsave", picture, folder / "out", "--tile-size", "256", "--overlap", "0", "--suffix",
                     ".jpg[Q=85]"],
        }
        for run in range(options.runs):
            for program, command in commands.items():
                cost = Cost(command)
                costs[program].append(cost)
                shutil.rmtree(folder / "out_files", ignore_errors=True)
                print(f"{run + 1} {program:9} wall {cost.wall_s:6.2f} s  cpu {cost.cpu_s:6.2f} s  "
                      f"peak {cost.peak_mib:6.1f} MiB", flush=True)

    def median(program, field):
        return statistics.median(getattr(cost, field) for cost in costs[program])

    def ratio(field):
        return statistics.median(
            getattr(ours, field) / getattr(theirs, field) for ours, theirs in zip(costs["terrella"], costs["vips"]))

    print("\n| 21600x10800 JPEG | wall | CPU | peak memory |\n|---|---|---|---|")
    for program, label in (("terrella", "`terrella cut` to a GeoPackage"), ("vips", "`vips dzsave` to a folder")):
        print(f"| {label} | {median(program, 'wall_s'):.1f} s | {median(program, 'cpu_s'):.1f} s | "
              f"{max(cost.peak_mib for cost in costs[program]):.0f} MiB |")
    print(f"| ratio, median of {options.runs} pairs | {ratio('wall_s'):.2f} | {ratio('cpu_s'):.2f} | |")


if __name__ == "__main__":
    main()
