"""Pictures with spots, and the distance of the spots in their tiles from where gdaltransform puts them."""

import json
import math
import pathlib

from georeferenced import gdal

SPOT_PX = 1.5
# Half a side of the window in which a spot's middle is measured, pixels of the tiles.
WINDOW = 9
# Spots by column and row, as shares of the picture.
SPOTS = ((0.3, 0.35), (0.52, 0.55), (0.7, 0.3), (0.35, 0.7), (0.68, 0.68))


def spot_value(x, y, width, height, spots=SPOTS):
    """Brightness at pixel coordinates that begin at the first pixel's corner."""
    value = 0.0
    if not math.isfinite(x) or not 0 <= x <= width or not 0 <= y <= height:
        return 0.0
    for u, v in spots:
        cx, cy = u * width + 0.21, v * height - 0.17
        value += 230 * math.exp(-((x - cx) ** 2 + (y - cy) ** 2) / (2 * SPOT_PX ** 2))
    return min(value, 255.0)


def spotted(width, height, spots=SPOTS):
    """A gray picture, black but for smooth round spots."""
    return bytes(round(spot_value(x + 0.5, y + 0.5, width, height, spots)) for y in range(height) for x in range(width))


def read_gray(path):
    """First band of a raster in degrees: west, north, pixel, width, height, rows."""
    told = json.loads(gdal("gdalinfo", "-json", path))
    west, pixel, _, north, _, _ = told["geoTransform"]
    raw = pathlib.Path(path).with_suffix(".raw")
    gdal("gdal_translate", "-q", "-b", 1, "-of", "ENVI", path, raw)
    width, height = told["size"]
    values = raw.read_bytes()
    for made in raw.parent.glob(raw.stem + ".*"):
        if made.suffix in (".raw", ".hdr", ".xml") or made.name.endswith(".aux.xml"):
            made.unlink()
    return west, north, pixel, width, height, values


def spot_errors(picture, tiles, degrees, size, turn_px=0, source_crs=(), spots=SPOTS):
    """Distance of each spot in the tiles from its true place, in pixels of the tiles.

    `turn_px`: columns of 360°, for pictures of all longitudes, because gdaltransform knows one turn only.

    The truth is the picture that the tiles would show without any filter: gdaltransform leads back from each pixel of
    the tiles to the picture, whose brightness there is a formula."""
    width, height = size
    west, north, pixel, columns, rows, values = read_gray(tiles)
    middles = transform(picture, degrees, source_crs, [(u * width + 0.21, v * height - 0.17) for u, v in spots])
    windows = []
    for lon, lat in middles:
        lon = west + (lon - west) % 360
        x0, y0 = round((lon - west) / pixel - 0.5), round((north - lat) / pixel - 0.5)
        # A circle on the ground is wide in degrees near a pole.
        wide = min(WINDOW / math.cos(math.radians(lat)), 5 * WINDOW)
        windows.append([(x, y) for y in range(y0 - WINDOW, y0 + WINDOW + 1)
                        for x in range(round(x0 - wide), round(x0 + wide) + 1)])
    back = iter(transform(picture, degrees, (*source_crs, "-i"),
                          [(west + (x + 0.5) * pixel, north - (y + 0.5) * pixel) for cells in windows for x, y in cells]))
    errors = []
    for cells in windows:
        true = [spot_value(*in_picture(next(back), width, turn_px), width, height, spots) for _ in cells]
        shown = [values[y * columns + x % columns] if 0 <= y < rows else 0 for x, y in cells]
        a, b = middle(cells, shown), middle(cells, true)
        errors.append(math.hypot(a[0] - b[0], a[1] - b[1]) if a and b else math.inf)
    return errors


def in_picture(point, width, turn_px):
    """The point, moved by whole turns into the picture."""
    x, y = point
    if not turn_px or not math.isfinite(x) or 0 <= x <= width:
        return point
    return x - turn_px * math.floor(x / turn_px), y


def transform(picture, degrees, options, points):
    """By gdaltransform; (inf, inf) for points without a place."""
    told = gdal("gdaltransform", *options, "-t_srs", degrees, picture,
                stdin="".join(f"{x:.12f} {y:.12f}\n" for x, y in points)).splitlines()
    return [tuple(map(float, line.split()[:2])) if line[:1] in "-0123456789" else (math.inf, math.inf) for line in told]


def middle(cells, values):
    total = sum(values)
    if total < 1:
        return None
    return (sum(x * v for (x, _), v in zip(cells, values)) / total,
            sum(y * v for (_, y), v in zip(cells, values)) / total)


def place_spots(path, size, *options, spots=SPOTS):
    """A TIFF, or what `-of` says, with spots and the place that gdal_translate gives it."""
    width, height = size
    base = pathlib.Path(path).with_name("base.pgm")
    base.write_bytes(b"P5\n%d %d\n255\n" % (width, height) + spotted(width, height, spots))
    gdal("gdal_translate", "-q", *options, base, path)
    base.unlink()
