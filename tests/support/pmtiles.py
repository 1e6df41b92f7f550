"""Writes and reads PMTiles archives of version 3 by the specification, with the standard library alone."""

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


def parsed_directory(data):
    """The entries (number, offset, length, run) of a directory."""
    values, value, shift = [], 0, 0
    for byte in data:
        value |= (byte & 127) << shift
        shift += 7
        if byte < 128:
            values.append(value)
            value = shift = 0
    count = values[0]
    steps, runs, lengths, offsets = (values[1 + i * count:1 + (i + 1) * count] for i in range(4))
    entries, number, end = [], 0, 0
    for step, run, length, offset in zip(steps, runs, lengths, offsets, strict=True):
        number += step
        at = end if offset == 0 else offset - 1
        end = at + length
        entries.append((number, at, length, run))
    return entries


def contents(data):
    """The header's fields, the metadata as text, and {(z, x, y): bytes} of an archive with gzip directories."""
    fields = struct.unpack_from(HEADER, data)
    assert fields[0] == b"PMTiles" and fields[1] == 3 and fields[14:16] == (GZIP, NONE), fields
    root, metadata, leaves, tiles = ((fields[i], fields[i] + fields[i + 1]) for i in (2, 4, 6, 8))
    assert root[0] == 127 and root[1] <= tiles[0] == 16384 and tiles[1] == metadata[0] and metadata[1] == leaves[0], fields
    assert leaves[1] == len(data), fields

    def entries_of(packed):
        for entry in parsed_directory(gzip.decompress(packed)):
            if entry[3] > 0:
                yield entry
            else:
                yield from entries_of(data[leaves[0] + entry[1]:leaves[0] + entry[1] + entry[2]])

    entries = list(entries_of(data[slice(*root)]))
    place = {number: tile for tile, number in numbers(fields[18] + 1).items()}
    found = {place[number + i]: data[tiles[0] + offset:tiles[0] + offset + length]
             for number, offset, length, run in entries for i in range(run)}
    assert fields[10:13] == (len(found), len(entries), len({entry[1] for entry in entries})), fields
    first = [entry[1] for entry in entries]
    assert fields[13] == 1 and all(at == max(first[:i + 1]) or at in first[:i] for i, at in enumerate(first)), "not clustered"
    return fields, gzip.decompress(data[slice(*metadata)]).decode(), found
