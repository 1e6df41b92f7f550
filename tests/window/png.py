"""Reads pictures with ImageMagick, and compares them."""

import subprocess


def read(path):
    """Width, height and rows of bytes, three a pixel."""
    ppm = subprocess.run(["convert", str(path), "-depth", "8", "ppm:-"], capture_output=True, check=True, timeout=60).stdout
    kind, size, most, data = ppm.split(b"\n", 3)
    assert (kind, most) == (b"P6", b"255"), path
    width, height = map(int, size.split())
    return width, height, [data[3 * width * y : 3 * width * (y + 1)] for y in range(height)]


def changed(a, b):
    """Number of pixels of two pictures of one size that differ by more than 24 in a channel."""
    count = 0
    for one, other in zip(a[2], b[2]):
        if one != other:
            pixels = zip(zip(*[iter(one)] * 3), zip(*[iter(other)] * 3))
            count += sum(x != y and max(abs(p - q) for p, q in zip(x, y)) > 24 for x, y in pixels)
    return count


def largest_difference(a, b):
    """Largest difference of a channel of two pictures of one size, in levels."""
    return max(max(map(abs, (p - q for p, q in zip(one, other)))) for one, other in zip(a[2], b[2]))


def pixel(picture, x, y):
    """Red, green and blue; rows from the top."""
    return tuple(picture[2][y][3 * x : 3 * x + 3])
