"""Writes PMTiles archives of version 3 by the specification, with the standard library alone."""

import gzip
import struct

NONE, GZIP, BROTLI, ZSTD = 1, 2, 3, 4
MVT, PNG, JPEG, WEBP, AVIF = 1, 2, 3, 4, 5
HEADER = "<7sB11Q6B4iB2i"


def curve(level):
    """The tiles (x, y) of a level in the order of the Hilbert curve, made of four turned curves of half its side."""
    if level == 0:
        return [(0, 0)]
    half, quarter = 1 << (level - 1), curve(level - 1)
    return ([(y, x) for x, y in quarter] + [(x, y + half) for x, y in quarter] +
            [(x + half, y + half) for x, y in quarter] + [(2 * half - 1 - y, half - 1 - x) for x, y in quarter])


def numbers(levels):
    """The number of each tile (z, x, y)."""
    order = [(z, x, y) for z in range(levels) for x, y in curve(z)]
    return {tile: number for number, tile in enumerate(order)}


def varint(number):
    out = bytearray()
    while number > 127:
        out.append(number & 127 | 128)
        number >>= 7
    return bytes(out) + bytes([number])


def directory(entries):
    """Entries are (number, offset, length, run)."""
    out = [varint(len(entries))]
    before = 0
    for number, _, _, _ in entries:
        out.append(varint(number - before))
        before = number
    out += [varint(run) for _, _, _, run in entries] + [varint(length) for _, _, length, _ in entries]
    end = None
    for _, offset, length, _ in entries:
        out.append(varint(0 if offset == end else offset + 1))
        end = offset + length
    return b"".join(out)


def packed(data, compression):
    return gzip.compress(data, mtime=0) if compression == GZIP else data


def archive(tiles, leaf_size=0, depth=1, clustered=True, internal=GZIP, compression=NONE, kind=PNG, bounds=None, levels=None,
            metadata=b'{"name": "of the test", "attribution": "nobody"}', root=None, leaves=None, header=None):
    """The bytes of an archive of {(z, x, y): bytes}. Equal neighbours on the curve are one run, and equal tiles are stored
    once. `leaf_size`: entries of a leaf directory, 0 for none; `depth`: directories above each other below the root. `root` and
    `leaves` replace what is right, and `header` single fields, by their place in HEADER."""
    count = 1 + max(z for z, _, _ in tiles)
    number_of = numbers(count)
    order = sorted(tiles, key=number_of.get)
    data, places = bytearray(), {}
    for tile in order if clustered else reversed(order):
        content = packed(tiles[tile], compression)
        if content not in places:
            places[content] = (len(data), len(content))
            data += content
    entries = []
    for tile in order:
        number, place = number_of[tile], places[packed(tiles[tile], compression)]
        if entries and entries[-1][1:3] == list(place) and entries[-1][0] + entries[-1][3] == number:
            entries[-1][3] += 1
        else:
            entries.append([number, *place, 1])
    leaf_bytes = bytearray()
    for _ in range(depth if leaf_size else 0):
        parents = []
        for i in range(0, len(entries), leaf_size):
            leaf = packed(directory(entries[i:i + leaf_size]), internal)
            parents.append([entries[i][0], len(leaf_bytes), len(leaf), 0])
            leaf_bytes += leaf
        entries = parents
    root_bytes = packed(directory(entries) if root is None else root, internal)
    leaf_bytes = leaf_bytes if leaves is None else leaves
    meta = packed(metadata, internal)
    at = [127, 127 + len(root_bytes), 127 + len(root_bytes) + len(meta)]
    at.append(at[2] + len(leaf_bytes))
    west, south, east, north = (round(v * 1e7) for v in bounds or (-180, -85.0511287, 180, 85.0511287))
    low, high = levels or (min(z for z, _, _ in tiles), count - 1)
    fields = [b"PMTiles", 3, at[0], len(root_bytes), at[1], len(meta), at[2], len(leaf_bytes), at[3], len(data),
              len(tiles), 0, len(places), int(clustered), internal, compression, kind, low, high, west, south, east, north,
              low, 0, 0]
    for place, value in (header or {}).items():
        fields[place] = value
    return struct.pack(HEADER, *fields) + root_bytes + meta + bytes(leaf_bytes) + bytes(data)
