"""Measures a DEM of thousands of small GeoTIFFs as one layer: seconds and memory to open it, cold and warm, and to draw
a close view and the whole. Run from the repository's root:

  python3 tests/bench/many_files.py build/terrella --relief etopo5.raw

Cells of 1° from 10° west and 60° north on, COLUMNS × ROWS of them, 60 pixels a side. The relief is a raw file of
unsigned 16-bit numbers, 4320 × 2161 nodes of a whole planet, metres + 32768 (gdal_translate -of ENVI etopo5.png
etopo5.raw); without one the ground is a formula. Exit code 1 if opening takes over 2 s or 200 MB."""

import argparse
import array
import math
import os
import pathlib
import resource
import struct
import subprocess
import sys
import tempfile
import time

SIDE_PX = 60
MOST_S, MOST_MB = 2.0, 200.0


def formula(lat, lon):
    return round(2000 * math.sin(lat / 3) * math.sin(lon / 4) + 600 * math.sin(lat * 3) * math.cos(lon * 2))


def relief_of(path):
    """Metres at a place, bilinearly between the nodes."""
    numbers = array.array("H")
    numbers.frombytes(pathlib.Path(path).read_bytes())

    def metres(lat, lon):
        x, y = (lon + 180) * 12, (90 - lat) * 12
        column, row = int(x), min(int(y), 2159)
        right, down = x - column, y - row
        at = [numbers[r * 4320 + c % 4320] for r in (row, row + 1) for c in (column, column + 1)]
        top, bottom = at[0] * (1 - right) + at[1] * right, at[2] * (1 - right) + at[3] * right
        return round(top * (1 - down) + bottom * down) - 32768
    return metres


def cell(west, north, metres):
    step = 1 / SIDE_PX
    numbers = b"".join(struct.pack("<h", metres(north - (y + 0.5) * step, west + (x + 0.5) * step))
                       for y in range(SIDE_PX) for x in range(SIDE_PX))
    scale_at = 8 + 2 + 12 * 13 + 4
    tie_at, keys_at = scale_at + 24, scale_at + 72
    entries = [(256, 4, 1, SIDE_PX), (257, 4, 1, SIDE_PX), (258, 3, 1, 16), (259, 3, 1, 1), (262, 3, 1, 1),
               (273, 4, 1, keys_at + 32), (277, 3, 1, 1), (278, 4, 1, SIDE_PX), (279, 4, 1, len(numbers)),
               (339, 3, 1, 2), (33550, 12, 3, scale_at), (33922, 12, 6, tie_at), (34735, 3, 16, keys_at)]
    return (b"II*\0" + struct.pack("<IH", 8, len(entries)) + b"".join(struct.pack("<HHII", *e) for e in entries) +
            struct.pack("<I", 0) + struct.pack("<9d", step, step, 0, 0, 0, 0, west, north, 0) +
            struct.pack("<16H", 1, 1, 0, 3, 1024, 0, 1, 2, 1025, 0, 1, 1, 2048, 0, 1, 4326) + numbers)


def write_cells(folder, columns, rows, metres):
    folder.mkdir(parents=True, exist_ok=True)
    for row in range(rows):
        for column in range(columns):
            west, north = -10 + column, 60 - row
            (folder / f"cell_{north:+03}_{west:+04}.tif").write_bytes(cell(west, north, metres))


def run(program, cache, *arguments):
    """Seconds, processor seconds and the largest memory in MB."""
    begun = time.monotonic()
    child = subprocess.Popen([program, *map(str, arguments)], stdout=subprocess.DEVNULL,
                             env={**os.environ, "XDG_CACHE_HOME": str(cache)},
                             preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (64, 64)))
    _, status, usage = os.wait4(child.pid, 0)
    if status != 0:
        sys.exit(f"{arguments}: status {status}")
    return time.monotonic() - begun, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--relief")
    parser.add_argument("--columns", type=int, default=100)
    parser.add_argument("--rows", type=int, default=40)
    parser.add_argument("--keep", type=pathlib.Path, help="write the cells here, and leave them")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="terrella-many-") as scratch:
        scratch = pathlib.Path(scratch)
        cells = options.keep or scratch / "cells"
        write_cells(cells, options.columns, options.rows, relief_of(options.relief) if options.relief else formula)
        shot = scratch / "shot.png"
        close = ("render", "--elevation", cells, "--camera", "46,8,300000,0,-45", "-o", shot)
        whole = ("render", "--elevation", cells, "--camera", "40,40,12000000", "-o", shot)
        print(f"{options.columns * options.rows} files of {SIDE_PX} pixels; at most 64 open files")
        print("                            seconds   processor s   MB")
        cold = None
        for name, arguments in (("open, first time", ("info", cells)), ("open, again", ("info", cells)),
                                ("close view", close), ("close view, again", close),
                                ("whole, first time", whole), ("whole, again", whole),
                                ("render without heights", ("render", "--camera", "40,40,12000000", "-o", shot))):
            seconds, processor, memory = run(options.program, scratch / "cache", *arguments)
            cold = cold or (seconds, memory)
            print(f"{name:26} {seconds:8.2f} {processor:12.2f} {memory:6.0f}")
        return 0 if cold[0] <= MOST_S and cold[1] <= MOST_MB else 1


if __name__ == "__main__":
    sys.exit(main())
