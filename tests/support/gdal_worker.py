"""Does what GDAL's programs do, for one request after another: a start of such a program takes longer than its work.

Each line of the input is a request in JSON, {"words": [program, argument…], "input": text}; each line of the output the
answer, {"output": text} or {"error": text}. Run by the Python that has GDAL's module: /usr/bin/python3.
"""

import json
import math
import os
import struct

from osgeo import gdal, osr


def translate(words, _):
    *options, source, target = words
    gdal.Translate(target, source, options=options)
    return ""


def info(words, _):
    *options, source = words
    told = gdal.Info(source, options=options)
    return told if isinstance(told, str) else json.dumps(told)


def transform(words, points):
    """A line of longitude, latitude and height for each point; words, where a point has no place."""
    *words, source = words
    back = "-i" in words
    if back:
        words.remove("-i")
    names = {"-s_srs": "SRC_SRS", "-t_srs": "DST_SRS"}
    options = [f"{names[key]}={value}" for key, value in zip(words[::2], words[1::2], strict=True)]
    picture = gdal.Open(source)
    transformer = gdal.Transformer(picture, None, options)
    lines = []
    for line in points.splitlines():
        x, y = map(float, line.split())
        found, place = transformer.TransformPoint(back, x, y)
        lines.append("{:.15g} {:.15g} {:.15g}\n".format(*place) if found else "transformation failed.\n")
    return "".join(lines)


def values(words, _):
    """With -valonly: a line for each band; nothing, where there is no pixel."""
    words.remove("-valonly")
    *words, source, x, y = words
    picture = gdal.Open(source)
    bands = [int(word) for option, word in zip(words, words[1:]) if option == "-b"] or range(1, picture.RasterCount + 1)
    x, y = float(x), float(y)
    if "-wgs84" in words:
        degrees, system = osr.SpatialReference(), picture.GetSpatialRef()
        degrees.SetWellKnownGeogCS("WGS84")
        for one in (degrees, system):
            one.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
        x, y, _ = osr.CoordinateTransformation(degrees, system).TransformPoint(x, y)
    if "-wgs84" in words or "-geoloc" in words:
        x, y = gdal.ApplyGeoTransform(gdal.InvGeoTransform(picture.GetGeoTransform()), x, y)
    x, y = math.floor(x), math.floor(y)
    if not (0 <= x < picture.RasterXSize and 0 <= y < picture.RasterYSize):
        return "\n"
    pixels = [picture.GetRasterBand(band).ReadRaster(x, y, 1, 1, buf_type=gdal.GDT_Float64) for band in bands]
    return "".join("{:.15g}\n".format(*struct.unpack("d", pixel)) for pixel in pixels)


PROGRAMS = {"gdal_translate": translate, "gdalinfo": info, "gdallocationinfo": values, "gdaltransform": transform}


def main():
    gdal.UseExceptions()
    gdal.PushErrorHandler("CPLQuietErrorHandler")
    requests = os.fdopen(os.dup(0))
    with open(os.devnull, encoding="ascii") as nothing:
        os.dup2(nothing.fileno(), 0)  # a picture's system may name a grid in /dev/stdin
    for line in requests:
        request = json.loads(line)
        program, *words = request["words"]
        try:
            answer = {"output": PROGRAMS[program](words, request["input"])}
        except RuntimeError as error:
            answer = {"error": str(error)}
        print(json.dumps(answer), flush=True)


if __name__ == "__main__":
    main()
