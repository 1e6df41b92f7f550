"""Reads the 8-bit RGB and RGBA pictures that the viewer saves."""

import struct
import zlib


def read(path):
    """Width, height and rows of bytes, three a pixel."""
    data = path.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", path
    at, packed, header = 8, b"", None
    while at < len(data):
        (length,) = struct.unpack(">I", data[at : at + 4])
        kind, body = data[at + 4 : at + 8], data[at + 8 : at + 8 + length]
        if kind == b"IHDR":
            header = struct.unpack(">IIBBBBB", body)
        elif kind == b"IDAT":
            packed += body
        at += 12 + length
    width, height, depth, colour, *_ = header
    assert depth == 8 and colour in (2, 6), header
    return width, height, _rows(zlib.decompress(packed), width, height, 3 if colour == 2 else 4)


def _rows(raw, width, height, step):
    rows, last = [], bytearray(width * step)
    for y in range(height):
        begin = y * (width * step + 1)
        row = bytearray(raw[begin + 1 : begin + 1 + width * step])
        _unfilter(raw[begin], row, last, step)
        last = row
        rows.append(bytes(row) if step == 3 else bytes(b for i, b in enumerate(row) if i % 4 != 3))
    return rows


def _unfilter(kind, row, above, step):
    for i in range(len(row)):
        left = row[i - step] if i >= step else 0
        corner = above[i - step] if i >= step else 0
        row[i] = (row[i] + _predicted(kind, left, above[i], corner)) & 255


def _predicted(kind, left, up, corner):
    if kind == 4:
        guess = left + up - corner
        return min((left, up, corner), key=lambda value: abs(guess - value))
    return (0, left, up, (left + up) // 2)[kind]


def changed(a, b):
    """How many pixels of two pictures of one size differ by more than 24 in a channel."""
    count = 0
    for one, other in zip(a[2], b[2]):
        if one != other:
            pixels = zip(zip(*[iter(one)] * 3), zip(*[iter(other)] * 3))
            count += sum(max(abs(p - q) for p, q in zip(x, y)) > 24 for x, y in pixels)
    return count


def pixel(picture, x, y):
    """Red, green and blue; rows from the top."""
    return tuple(picture[2][y][3 * x : 3 * x + 3])
