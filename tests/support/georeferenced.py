"""Makes georeferenced pictures with GDAL's programs, and locates their pixels with GDAL."""

import atexit
import functools
import json
import pathlib
import re
import struct
import subprocess

# A pixel may lie this much beside gdaltransform's answer, pixels: what coordinates with few decimals leave.
PLACED_PX = 0.01


def gdal(*arguments, stdin=None):
    """Runs a program of GDAL; returns what it prints."""
    words = [str(a) for a in arguments]
    if words[0] in Worker.PROGRAMS:
        return Worker.ask(words, stdin)
    done = subprocess.run(words, input=stdin, capture_output=True, text=True, timeout=60)
    if done.returncode != 0:
        raise AssertionError(f"{arguments}\n{done.stdout}{done.stderr}")
    return done.stdout


class Worker:
    """One process for all calls of the programs that are called most."""

    PROGRAMS = ("gdal_translate", "gdalinfo", "gdallocationinfo", "gdaltransform")
    process = None

    @classmethod
    def ask(cls, words, stdin):
        if cls.process is None:
            cls.process = subprocess.Popen(["/usr/bin/python3", "-B", str(pathlib.Path(__file__).with_name("gdal_worker.py"))],
                                           stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
            atexit.register(cls.process.communicate)
        cls.process.stdin.write(json.dumps({"words": words, "input": stdin}) + "\n")
        cls.process.stdin.flush()
        answer = json.loads(cls.process.stdout.readline())
        if "error" in answer:
            raise AssertionError(f"{words}\n{answer['error']}")
        return answer["output"]


def pgm(path, width, height):
    """A gray picture whose brightness says where in it a pixel is: smooth, so that resampling keeps it."""
    pathlib.Path(path).write_bytes(b"P5\n%d %d\n255\n" % (width, height) + slope(width, height))


@functools.lru_cache(maxsize=4)
def slope(width, height):
    return bytes(brightness(x, y, width, height) for y in range(height) for x in range(width))


def brightness(x, y, width, height):
    return round(20 + 160 * (x + 0.5) / width + 60 * (y + 0.5) / height)


def make(path, width, height, *options):
    """A picture that gdal_translate gives a place."""
    path = pathlib.Path(path)
    base = path.with_name("base.pgm")
    pgm(base, width, height)
    gdal("gdal_translate", "-q", *options, base, path)
    base.unlink()
    return path


def places(path, pixels, crs, source_crs=()):
    """Longitude and latitude that gdaltransform gives each pixel."""
    told = gdal("gdaltransform", *source_crs, "-t_srs", crs, path, stdin="".join(f"{x} {y}\n" for x, y in pixels))
    return [tuple(map(float, line.split()[:2])) for line in told.splitlines()]


def commands_in(message):
    """The GDAL command line that a message ends with."""
    found = re.search(r"\b(gdalwarp|gdal_translate) .*$", message.strip(), re.MULTILINE)
    return found.group(0) if found else None


# ---- TIFF written by hand: what GDAL would not write

def tiff(width, height, tags, pixels=None):
    """A gray picture with extra tags, (number, type, values[, count]): 2 ASCII, 3 SHORT, 12 DOUBLE."""
    sizes, codes = {1: 1, 2: 1, 3: 2, 4: 4, 12: 8}, {1: "B", 2: "c", 3: "H", 4: "I", 12: "d"}
    base = [(256, 4, [width]), (257, 4, [height]), (258, 3, [8]), (259, 3, [1]), (262, 3, [1]), (273, 4, [0]),
            (277, 3, [1]), (278, 4, [height]), (279, 4, [width * height])]
    entries = sorted(base + list(tags))
    data_at = 8 + 2 + 12 * len(entries) + 4
    directory, data = struct.pack("<H", len(entries)), b""
    pixels_at = data_at + sum(sizes[t] * len(v) for n, t, v, *_ in entries if sizes[t] * len(v) > 4)
    for number, kind, values, *said in entries:
        if number == 273:
            values = [pixels_at]
        raw = values if isinstance(values, bytes) else struct.pack(f"<{len(values)}{codes[kind]}", *values)
        count = said[0] if said else len(values)
        if len(raw) > 4:
            directory += struct.pack("<HHII", number, kind, count, data_at + len(data))
            data += raw
        else:
            directory += struct.pack("<HHI", number, kind, count) + raw.ljust(4, b"\0")
    pixels = pixels or slope(width, height)
    return b"II*\0" + struct.pack("<I", 8) + directory + struct.pack("<I", 0) + data + pixels


def geo_keys(*keys):
    """A GeoKey directory of short keys, (key, value), or whole entries (key, tag, count, value)."""
    entries = [(k[0], 0, 1, k[1]) if len(k) == 2 else k for k in keys]
    return (34735, 3, [1, 1, 0, len(entries)] + [n for e in entries for n in e])


SCALE, TIES, MATRIX, DOUBLES = 33550, 33922, 34264, 34736
DEGREES = geo_keys((1024, 2), (1025, 1), (2048, 4326))


def placed_at(west, north, pixel_x, pixel_y):
    return [(SCALE, 12, [pixel_x, pixel_y, 0.0]), (TIES, 12, [0.0, 0.0, 0.0, west, north, 0.0])]
