"""Makes small pictures as bytes, with the standard library alone."""

import functools
import math
import struct
import zlib

TILE_PX = 64  # side of square_tile()

PDS3_LABEL = """PDS_VERSION_ID = PDS3
RECORD_TYPE = FIXED_LENGTH
RECORD_BYTES = {width}
FILE_RECORDS = {height}
^IMAGE = "SPOTS.IMG"
OBJECT = IMAGE
  LINES = {height}
  LINE_SAMPLES = {width}
  SAMPLE_TYPE = UNSIGNED_INTEGER
  SAMPLE_BITS = 8
END_OBJECT = IMAGE
OBJECT = IMAGE_MAP_PROJECTION
  MAP_PROJECTION_TYPE = "EQUIRECTANGULAR"
  A_AXIS_RADIUS = 3396.19 <KM>
  B_AXIS_RADIUS = 3396.19 <KM>
  C_AXIS_RADIUS = 3396.19 <KM>
  CENTER_LATITUDE = 0.0 <DEG>
  CENTER_LONGITUDE = 0.0 <DEG>
  MAP_SCALE = 10.0 <KM/PIXEL>
  LINE_PROJECTION_OFFSET = {line}
  SAMPLE_PROJECTION_OFFSET = {sample}
END_OBJECT = IMAGE_MAP_PROJECTION
END
"""


def png(width, height, colour=(40, 90, 160)):
    """A PNG of one colour, 8-bit RGB."""
    row = b"\0" + bytes(colour) * width
    return png_of(width, height, zlib.compress(row * height))


def heights_png(width, height, number=33768):
    """A PNG of one number, gray of 16 bits."""
    row = b"\0" + struct.pack(">H", number) * width
    return png_of(width, height, zlib.compress(row * height), bits=16, colour=0)


def png_of(width, height, compressed, bits=8, colour=2):
    """A PNG that claims a size and carries any compressed rows: the truth of the claim is up to the caller."""
    header = struct.pack(">IIBBBBB", width, height, bits, colour, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + _chunk(b"IHDR", header) + _chunk(b"IDAT", compressed) + _chunk(b"IEND", b"")


def _chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def tiff_header(width, height):
    """A little-endian TIFF that claims a size of 8-bit RGB in one strip, and has no strip."""
    entries = [(256, 4, 1, width), (257, 4, 1, height), (258, 3, 1, 8), (259, 3, 1, 1), (262, 3, 1, 2),
               (273, 4, 1, 8), (277, 3, 1, 3), (278, 4, 1, height), (279, 4, 1, 64)]
    directory = struct.pack("<H", len(entries)) + b"".join(struct.pack("<HHII", *e) for e in entries)
    return b"II*\0" + struct.pack("<I", 8) + directory + struct.pack("<I", 0)


@functools.cache  # 3 ms each, and the tests of `convert` ask for thousands
def square_tile(z, x, y):
    """No green at all, red throughout, waves of blue by which a server's grid can be told."""
    rows = bytearray()
    span = 2 * math.pi / (1 << z)
    for j in range(TILE_PX):
        rows.append(0)
        lat = math.atan(math.sinh(math.pi - (y + (j + 0.5) / TILE_PX) * span))
        for i in range(TILE_PX):
            lon = (x + (i + 0.5) / TILE_PX) * span - math.pi
            rows += bytes((255, 0, round(127.5 + 100 * math.sin(lon + 0.9) * math.cos(3 * lat + 0.4))))
    return png_of(TILE_PX, TILE_PX, zlib.compress(bytes(rows), 1))
