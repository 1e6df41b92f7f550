"""Time from the start of `terrella view` to the first picture of a file of 86400x43200 pixels, beside the included Earth's.

The files hold the Blue Marble, enlarged: a tiled TIFF with overviews (COG), a striped TIFF, and a JPEG of 21600x10800.
GDAL makes them in FOLDER in some minutes (about 1 GB) unless they are there. A window on a private X server shows each
file with an empty cache. The first picture is there when the Sahara, in the middle of the window, is no plain colour.
Usage: first_picture.py TERRELLA BLUE_MARBLE.jpg FOLDER [RUNS]
"""

import mmap
import os
import pathlib
import statistics
import struct
import subprocess
import sys
import tempfile
import time

SIZE = (1280, 800)
PATIENCE_S = 240.0
LARGE = ("-outsize", "86400", "43200", "-r", "nearest", "-a_srs", "EPSG:4326", "-a_ullr", "-180", "90", "180", "-90")
FILES = {
    "mosaic.tif": (*LARGE, "-of", "COG", "-co", "COMPRESS=ZSTD", "-co", "LEVEL=1", "-co", "BIGTIFF=YES",
                   "-co", "OVERVIEW_RESAMPLING=NEAREST", "-co", "NUM_THREADS=ALL_CPUS",
                   "-co", "OVERVIEWS=IGNORE_EXISTING"),  # a JPEG lends its own three
    "striped.tif": (*LARGE, "-co", "COMPRESS=ZSTD", "-co", "ZSTD_LEVEL=1", "-co", "BIGTIFF=YES"),
    "picture.jpg": ("-outsize", "21600", "10800", "-r", "bilinear", "-of", "JPEG"),
}


def make_files(marble, folder):
    folder.mkdir(parents=True, exist_ok=True)
    for name, options in FILES.items():
        if not (folder / name).exists():
            begun = time.monotonic()
            part = folder / f"part-{name}"
            subprocess.run(["gdal_translate", "-q", *options, marble, part], check=True)
            part.rename(folder / name)
            print(f"made {name} in {time.monotonic() - begun:.0f} s", flush=True)


class Screen:
    """An X server whose pixels are a file."""

    def __init__(self, folder):
        read_end, write_end = os.pipe()
        self.server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write_end), "-screen", "0", f"{SIZE[0]}x{SIZE[1]}x24", "-fbdir", folder, "-noreset",
             "-nolisten", "tcp"], pass_fds=[write_end], stderr=subprocess.DEVNULL)
        os.close(write_end)
        with os.fdopen(read_end) as pipe:
            self.display = ":" + pipe.readline().strip()
        with open(pathlib.Path(folder) / "Xvfb_screen0", "rb") as file:
            self.pixels = mmap.mmap(file.fileno(), 0, prot=mmap.PROT_READ)
        header = struct.unpack(">25I", self.pixels[:100])
        self.first = header[0] + header[19] * 12
        self.row_bytes = header[12]

    def shows_sahara(self):
        sand = 0
        for y in range(SIZE[1] // 2 - 40, SIZE[1] // 2 + 40, 4):
            at = self.first + y * self.row_bytes + (SIZE[0] // 2 - 40) * 4
            row = self.pixels[at:at + 320]
            sand += sum(red > blue + 20 for blue, red in zip(row[0::4], row[2::4]))
        return sand > 400


def first_picture_s(program, screen, tile_set):
    with tempfile.TemporaryDirectory(prefix="terrella-first-") as home:
        environment = {**os.environ, "DISPLAY": screen.display, "XDG_CACHE_HOME": home, "XDG_CONFIG_HOME": home,
                       "LIBGL_ALWAYS_SOFTWARE": "1"}
        command = [program, "view", *tile_set, "--size", f"{SIZE[0]}x{SIZE[1]}", "--sky", "off", "--camera", "20,8,12000000"]
        begun = time.monotonic()
        viewer = subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL)
        try:
            while not screen.shows_sahara():
                if viewer.poll() is not None or time.monotonic() - begun > PATIENCE_S:
                    raise RuntimeError(f"{command}: no picture")
                time.sleep(0.005)
            return time.monotonic() - begun
        finally:
            viewer.kill()
            viewer.wait()
            while screen.shows_sahara():  # the window is gone
                time.sleep(0.02)


def main():
    program, marble, folder = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    runs = int(sys.argv[4]) if len(sys.argv) > 4 else 5
    make_files(marble, folder)
    times = {name: [] for name in ("the included Earth", *FILES)}
    with tempfile.TemporaryDirectory() as shown:
        screen = Screen(shown)
        try:
            for _ in range(runs):
                for name, taken in times.items():
                    taken.append(first_picture_s(program, screen, [folder / name] if name in FILES else []))
        finally:
            screen.server.terminate()
    earth = statistics.median(times["the included Earth"])
    print("| file | first picture, s: median (least to most) | of the included Earth's |\n|---|---|---|")
    for name, taken in times.items():
        middle = statistics.median(taken)
        print(f"| {name} | {middle:.2f} ({min(taken):.2f} to {max(taken):.2f}) | {middle / earth:.1f} |")


if __name__ == "__main__":
    main()
