"""Opens every TIFF below a folder, such as the test data of another project, and judges its place by PROJ's cs2cs.

  TERRELLA=build/terrella python3 tests/corpus/geotiffs.py FOLDER [--direct]

Each file is cut. GDAL's programs then read pixels of the file and the coordinates that its tags give them, cs2cs says where
on the planet these lie, and GDAL reads the cut there. The values must go together: better there than two pixels beside. A file may be refused instead, with a reason and a
cure. `--direct` serves the files by byte ranges on loopback instead, renders them, and counts those that show. One line
for each file; exit code 1 if a file is placed wrongly, crashes, or is refused without a cure."""

import argparse
import json
import os
import pathlib
import random
import re
import shlex
import statistics
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "support"))
PROGRAM = os.environ["TERRELLA"]
SPOTS, MANY_SPOTS = 1500, 20000
SHIFTS_PX = [(0, 0), (2, 0), (-2, 0), (0, 2), (0, -2)]
# Values that go together. Resampling smooths noise, and a stretch bends values: then the distance to the places beside
# counts, which must be three standard errors of a difference: 3 (2 / spots)^½.
LEAST_CORRELATION = 0.8
FEW_PX = 16
CURE = re.compile(r"gdal|--[a-z]|get it again|download|save it|give|name ")
TIME_LIMIT_S = 120


def run(*arguments, stdin=None):
    """Exit code and texts; a crash or a time-out has a code of its own."""
    environment = {**os.environ, "CPL_LOG": "/dev/null"}
    try:
        done = subprocess.run([str(a) for a in arguments], input=stdin, capture_output=True, text=True, errors="replace",
                              timeout=TIME_LIMIT_S, env=environment)
    except subprocess.TimeoutExpired:
        return -99, "", "no end within the time limit"
    return done.returncode, done.stdout, done.stderr


def numbers(text):
    found = []
    for line in text.splitlines():
        try:
            found.append(float(line))
        except ValueError:
            found.append(None)
    return found


def values_at(path, places, band=1, degrees=None):
    """The values of a band at pixels, or at longitudes and latitudes of a system."""
    where = ["-l_srs", degrees] if degrees else []
    code, told, _ = run("gdallocationinfo", "-valonly", "-b", band, *where, path,
                        stdin="".join(f"{x:.12f} {y:.12f}\n" for x, y in places))
    return numbers(told) if code == 0 or told else []


def longitudes(path, pixels, degrees):
    """Places of pixels: coordinates by GDAL from the file's tags, longitudes and latitudes of these by PROJ."""
    code, told, why = run("gdaltransform", path, stdin="".join(f"{x:.6f} {y:.6f}\n" for x, y in pixels))
    points = [line.split()[:2] for line in told.splitlines()]
    if code != 0 or len(points) != len(pixels):
        return None, why
    tags = json.loads(run("gdalinfo", "-json", path)[1])
    system = tags.get("coordinateSystem") or tags.get("gcps", {}).get("coordinateSystem")
    if not system:  # the program takes such coordinates for degrees, and says so
        return [tuple(map(float, point)) for point in points], ""
    order = [abs(axis) - 1 for axis in system["dataAxisToSRSAxisMapping"][:2]]
    code, told, why = run("cs2cs", "-d", "12", " ".join(system["wkt"].split()), degrees,
                          stdin="".join(f"{point[order[0]]} {point[order[1]]}\n" for point in points))
    lines = told.splitlines()
    if code != 0 or len(lines) != len(points):
        return None, why
    # A pixel beside the map has no place. EPSG:4326 has the latitude first.
    swap = -1 if degrees == "EPSG:4326" else 1
    return [tuple(map(float, line.split()[:2][::swap])) if "*" not in line and "inf" not in line else None
            for line in lines], ""


def correlation(a, b):
    pairs = [(x, y) for x, y in zip(a, b) if x is not None and y is not None and abs(x) < 1e30 and abs(y) < 1e30]
    if len(pairs) < 20:
        return None
    xs, ys = zip(*pairs)
    if statistics.pstdev(xs) == 0 or statistics.pstdev(ys) == 0:
        return None
    return statistics.correlation(xs, ys)


def degrees_of(info):
    """The geographic system of the body that the file is on."""
    body = re.search(r"--body (\S+)", info.get("command", ""))
    if not body or body.group(1) == "earth":
        return "EPSG:4326"
    crs = info["georeference"]["body"]
    return f"+proj=longlat +a={crs['semi_major_m']} +b={crs['semi_minor_m']} +no_defs"


def judge_place(path, cut, info, is_heights, spots=SPOTS):
    """Says "placed", "flat" if the values cannot tell, or what is wrong. Noise takes many spots."""
    generator = random.Random(7)
    width, height = info["width_px"], info["height_px"]
    if min(width, height) < FEW_PX:
        return "flat (too few pixels to tell)"
    pixels = [(generator.randrange(3, max(4, width - 3)) + 0.5, generator.randrange(3, max(4, height - 3)) + 0.5)
              for _ in range(spots)]
    degrees = degrees_of(info)
    truth = values_at(path, [(int(x), int(y)) for x, y in pixels])
    truth = [None if value == info.get("nodata") else value for value in truth]
    found = []
    for dx, dy in SHIFTS_PX:
        places, why = longitudes(path, [(x + dx, y + dy) for x, y in pixels], degrees)
        if places is None:
            return f"cs2cs cannot place it: {why.strip()[:80]}"
        # gdallocationinfo knows no longitudes beyond 180°.
        known = [i for i, place in enumerate(places) if place]
        places = [((places[i][0] + 180) % 360 - 180, places[i][1]) for i in known]
        there = values_at(cut, places, degrees="EPSG:4326")
        # No data and masked pixels are transparent, so their colours mean nothing.
        alpha = values_at(cut, places, 4, "EPSG:4326") if not is_heights else []
        there = [value if i >= len(alpha) or alpha[i] == 255 else None for i, value in enumerate(there)]
        found.append(correlation([truth[i] for i in known], there))
    if found[0] is None:
        return "flat"
    beside = max((c for c in found[1:] if c is not None), default=-1)
    text = f"{found[0]:.3f}, beside {beside:.3f}"
    if found[0] >= beside - 1e-9 and (found[0] >= LEAST_CORRELATION or found[0] - beside >= 3.0 * (2.0 / spots) ** 0.5):
        return f"placed ({text})"
    if found[0] >= 0.99:
        return f"flat ({text})"
    return f"WRONG ({text})" if spots == MANY_SPOTS else judge_place(path, cut, info, is_heights, MANY_SPOTS)


def judge_edges(path, cut, info):
    """Says "flat", or what is wrong: the outermost places of a file are the bounds of its cut, within two pixels."""
    width, height = info["width_px"], info["height_px"]
    steps = [k / 32 for k in range(33)]
    edge = [(x * width, y * height) for k in steps for x, y in ((k, 0), (k, 1), (0, k), (1, k), (k, 0.5), (0.5, k))]
    places, why = longitudes(path, edge, degrees_of(info))
    if places is None:
        return f"cs2cs cannot place it: {why.strip()[:80]}"
    tiles = json.loads(run(PROGRAM, "info", cut, "--json")[1])
    west, south, east, north = tiles["bounds"]
    slack = 2 * max(max(info["pixel_deg"]), tiles["levels"][-1]["tile_span_deg"] / tiles["tile_px"])
    lats = [place[1] for place in places if place]
    off = max(abs(max(lats) - north), abs(min(lats) - south))
    if (east - west) % 360 > 1e-9:  # not round the planet
        middle = west + (east - west) % 360 / 2
        lons = [(place[0] - middle + 180) % 360 - 180 for place in places if place]
        half = (east - west) % 360 / 2
        off = max(off, abs(max(lons) - half), abs(min(lons) + half))
    return "flat, edges placed" if off <= slack else f"WRONG edges: off by {off:.6g} degrees, pixels of {slack / 2:.6g}"


def refused(why):
    why = " ".join(why.split())
    return ("refused: " if CURE.search(why) else "NO CURE: ") + why[:240]


def check_file(path, folder):
    code, told, why = run(PROGRAM, "info", path, "--json")
    if code != 0:
        return refused(why) if code == 1 else f"CRASH {code}: {why[:200]}"
    info = json.loads(told)
    if not info.get("shown"):
        return refused(info.get("refused") or info.get("why") or told)
    if not info.get("georeference"):
        return "no place stated: shown as a whole planet"
    command = shlex.split(info["command"])[2:]
    options = [word for word in command if word.startswith("--")]
    words = []
    if "--body" in options:
        words += ["--body", command[command.index("--body") + 1]]
    if "--elevation" in options:
        words.append("--elevation")
    cut = folder / "cut.gpkg"
    code, _, why = run(PROGRAM, "cut", path, "-o", cut, "--force", *words, *([] if "--elevation" in words else ["--format", "png"]))
    if code != 0:
        return refused(why) if code == 1 else f"CRASH {code}: {why[:200]}"
    # Numbers of colours go with no colour.
    expanded = folder / "expanded.tif"
    is_palette = run("gdal_translate", "-q", "-expand", "rgb", path, expanded)[0] == 0
    told = judge_place(expanded if is_palette else path, cut, info, "--elevation" in words)
    return judge_edges(path, cut, info) if told.startswith("flat") else told


def check_direct(path, folder):
    from range_server import range_server
    with range_server(path.read_bytes(), name="a.tif") as (url, server):
        code, _, why = run(PROGRAM, "render", url, "-o", folder / "x.png", "--unlit", "--sky", "off", "--size", "128x128",
                           "--cache", "off")
        if code == 0:
            return f"shown over HTTP, {len(server.asked)} requests"
        return refused(why) if code == 1 else f"CRASH {code}: {why[:200]}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--direct", action="store_true", help="by byte ranges from a server on loopback")
    options = parser.parse_args()
    check = check_direct if options.direct else check_file
    counts = {}
    with tempfile.TemporaryDirectory(prefix="terrella-corpus-") as folder:
        for path in sorted(p for p in options.folder.rglob("*") if p.suffix.lower() in (".tif", ".tiff")):
            told = check(path, pathlib.Path(folder))
            kind = told.split(":")[0].split(" (")[0].split(",")[0]
            counts[kind] = counts.get(kind, 0) + 1
            print(f"{path.relative_to(options.folder)}: {told}", flush=True)
    print(json.dumps(counts, indent=2))
    return 1 if any(word in kind for kind in counts for word in ("WRONG", "CRASH", "NO CURE")) else 0


if __name__ == "__main__":
    sys.exit(main())
