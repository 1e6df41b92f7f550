"""A camera over the WGS 84 ellipsoid, independent of the engine, as a reference for the window.

Latitude, longitude, heading, pitch and field of view in degrees, lengths in metres, pixels from the upper left corner.
"""

import math

A_M = 6378137.0
F = 1.0 / 298.257223563
E2 = F * (2.0 - F)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def add_scaled(a, b, s):
    return tuple(x + s * y for x, y in zip(a, b))


def ecef(lat_deg, lon_deg, height_m):
    lat, lon = math.radians(lat_deg), math.radians(lon_deg)
    n = A_M / math.sqrt(1.0 - E2 * math.sin(lat) ** 2)
    return (
        (n + height_m) * math.cos(lat) * math.cos(lon),
        (n + height_m) * math.cos(lat) * math.sin(lon),
        (n * (1.0 - E2) + height_m) * math.sin(lat),
    )


class Camera:
    """Camera of a line of --print-camera, for a window of a size."""

    def __init__(self, line, size):
        self.lat, self.lon, self.height_m, self.heading, self.pitch, self.fov = (float(x) for x in line.split(","))
        self.width, self.height = size
        lat, lon = math.radians(self.lat), math.radians(self.lon)
        heading, pitch = math.radians(self.heading), math.radians(self.pitch)
        east = (-math.sin(lon), math.cos(lon), 0.0)
        north = (-math.sin(lat) * math.cos(lon), -math.sin(lat) * math.sin(lon), math.cos(lat))
        up = (math.cos(lat) * math.cos(lon), math.cos(lat) * math.sin(lon), math.sin(lat))
        ahead = tuple(math.cos(heading) * n + math.sin(heading) * e for n, e in zip(north, east))
        self.right = tuple(math.cos(heading) * e - math.sin(heading) * n for n, e in zip(north, east))
        self.forward = tuple(math.cos(pitch) * a + math.sin(pitch) * u for a, u in zip(ahead, up))
        self.top = tuple(math.cos(pitch) * u - math.sin(pitch) * a for a, u in zip(ahead, up))
        self.eye = ecef(self.lat, self.lon, self.height_m)
        self.focal_px = 0.5 * self.height / math.tan(math.radians(self.fov) / 2.0)

    def ground(self, x, y):
        """The point of the ellipsoid under a pixel position, ECEF; None beside the globe."""
        ray = add_scaled(self.forward, self.right, (x - 0.5 * self.width) / self.focal_px)
        ray = add_scaled(ray, self.top, (0.5 * self.height - y) / self.focal_px)
        axes = (A_M, A_M, A_M * (1.0 - F))
        origin = tuple(e / a for e, a in zip(self.eye, axes))
        along = tuple(r / a for r, a in zip(ray, axes))
        a, b, c = dot(along, along), dot(origin, along), dot(origin, origin) - 1.0
        under_root = b * b - a * c
        if under_root < 0.0 or b >= 0.0:
            return None
        return add_scaled(self.eye, ray, c / (-b + math.sqrt(under_root)))

    def pixel(self, point):
        """Pixel at which an ECEF point is in the picture."""
        off = add_scaled(point, self.eye, -1.0)
        depth = dot(off, self.forward)
        return (
            0.5 * self.width + self.focal_px * dot(off, self.right) / depth,
            0.5 * self.height - self.focal_px * dot(off, self.top) / depth,
        )

    def miss_px(self, point, x, y):
        """Distance of a point from the pixel at which it should be seen."""
        px, py = self.pixel(point)
        return math.hypot(px - x, py - y)
