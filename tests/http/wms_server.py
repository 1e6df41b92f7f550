"""A WMS 1.1.1 and 1.3.0, and tiles of any window, from a picture that is a formula of longitude and latitude. Listens on
loopback until standard input ends. Prints one line of JSON: the port. The formulas are from J. P. Snyder, Map Projections: A
Working Manual (1987), and know nothing of PROJ.

/wms?…                                     GetCapabilities and GetMap
/tiles/CRS/W,N,E,S/BLOCK/COLUMNSxROWS/Z/X/Y.png   tile Z/X/Y of a window whose level 0 has COLUMNSxROWS tiles, rows from the
                                           north; CRS with "-" for ":". numbers=1 in the query gives signed 16-bit numbers
/log                                       every request so far, as JSON
"""

import argparse
import http.server
import json
import math
import struct
import sys
import threading
import urllib.parse
import zlib

A = 6378137.0
E = math.sqrt(1 - (6356752.314245179 / A) ** 2)


def colour_at(lon, lat):
    """Two waves, by which a place is known to a part of a degree, and a ramp."""
    return (round(127.5 + 120 * math.sin(math.radians(6 * lon))), round(127.5 + 120 * math.sin(math.radians(6 * lat))),
            round(255 * ((lon + 180) % 360) / 360))


def number_at(lon, lat):
    return round(3000 * math.sin(math.radians(2 * lon)) * math.cos(math.radians(lat)))


def degrees(x, y):
    return x, y


def web_mercator(x, y):
    """Snyder (7-4), (7-5) on the sphere."""
    return math.degrees(x / A), math.degrees(math.atan(math.sinh(y / A)))


def north_stereographic(x, y, lon_0=-45.0, lat_ts=70.0):
    """EPSG:3413: Snyder (21-33) to (21-40), (7-9)."""
    phi = math.radians(lat_ts)
    t_c = math.tan(math.pi / 4 - phi / 2) / ((1 - E * math.sin(phi)) / (1 + E * math.sin(phi))) ** (E / 2)
    m_c = math.cos(phi) / math.sqrt(1 - (E * math.sin(phi)) ** 2)
    t = math.hypot(x, y) * t_c / (A * m_c)
    lat = math.pi / 2 - 2 * math.atan(t)
    for _ in range(8):
        lat = math.pi / 2 - 2 * math.atan(t * ((1 - E * math.sin(lat)) / (1 + E * math.sin(lat))) ** (E / 2))
    return lon_0 + math.degrees(math.atan2(x, -y)), math.degrees(lat)


def sinusoidal_moon(x, y):
    """Snyder (30-6), (30-7) on a sphere of 1737400 m."""
    lat = y / 1737400.0
    return math.degrees(x / (1737400.0 * max(1e-9, math.cos(lat)))), math.degrees(lat)


def east_of_0_mars(x, y):
    """Equirectangular metres of Mars from the meridian of 180°: Snyder (12-1), (12-2)."""
    return math.degrees(x / 3396190.0) + 180.0, math.degrees(y / 3396190.0)


SYSTEMS = {"EPSG:4326": degrees, "CRS:84": degrees, "EPSG:3857": web_mercator, "EPSG:3413": north_stereographic,
           "sinu": sinusoidal_moon, "eqc": east_of_0_mars}
NORTH_FIRST = {"EPSG:4326"}
BOXES = {"EPSG:4326": (-180, -90, 180, 90), "CRS:84": (-180, -90, 180, 90),
         "EPSG:3857": (-20037508.342789244, -20037508.342789244, 20037508.342789244, 20037508.342789244),
         "EPSG:3413": (-4194304, -4194304, 4194304, 4194304)}


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def picture(to_degrees, west, south, east, north, width, height, numbers=False):
    rows = bytearray()
    for j in range(height):
        rows.append(0)
        y = north + (j + 0.5) * (south - north) / height
        for i in range(width):
            lon, lat = to_degrees(west + (i + 0.5) * (east - west) / width, y)
            rows += struct.pack(">h", number_at(lon, lat)) if numbers else bytes(colour_at(lon, lat))
    header = struct.pack(">IIBBBBB", width, height, 16 if numbers else 8, 0 if numbers else 2, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(bytes(rows), 1)) +
            chunk(b"IEND", b""))


def capabilities(version, address, options):
    new = version.startswith("1.3")
    name = "CRS" if new else "SRS"
    boxes = ""
    for crs in options.crs:
        west, south, east, north = BOXES[crs]
        if new and crs in NORTH_FIRST:
            west, south, east, north = south, west, north, east
        boxes += f'<BoundingBox {name}="{crs}" minx="{west}" miny="{south}" maxx="{east}" maxy="{north}"/>'
    systems = "".join(f"<{name}>{crs}</{name}>" for crs in options.crs)
    bounds = ("<EX_GeographicBoundingBox><westBoundLongitude>-180</westBoundLongitude><eastBoundLongitude>180"
              "</eastBoundLongitude><southBoundLatitude>-90</southBoundLatitude><northBoundLatitude>90"
              "</northBoundLatitude></EX_GeographicBoundingBox>" if new else
              '<LatLonBoundingBox minx="-180" miny="-90" maxx="180" maxy="90"/>')
    time = ('<Dimension name="time" units="ISO8601" default="2004-08-01">2004-07-01,2004-08-01</Dimension>' if new else
            '<Dimension name="time" units="ISO8601"/><Extent name="time" default="2004-08-01">2004-07-01,2004-08-01</Extent>')
    root = "WMS_Capabilities" if new else "WMT_MS_Capabilities"
    return f"""<?xml version="1.0"?>
<{root} version="{version}"><Service><Name>WMS</Name><Title>Waves</Title><MaxWidth>{options.max_width}</MaxWidth>
<MaxHeight>{options.max_width}</MaxHeight></Service><Capability><Request><GetMap><Format>image/png</Format>
<DCPType><HTTP><Get><OnlineResource xmlns:xlink="http://www.w3.org/1999/xlink" xlink:href="{address}/wms?map=waves&amp;"/>
</Get></HTTP></DCPType></GetMap></Request><Layer><Title>All</Title>{systems}{bounds}{boxes}
<Attribution><Title>Formulas</Title></Attribution><Layer><Name>waves</Name><Title>Waves of colour</Title>{time}
<Style><Name>plain</Name><Title>Plain</Title></Style></Layer></Layer></Capability></{root}>""".encode()


class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    options = None
    log = []
    lock = threading.Lock()

    def do_GET(self):
        if self.path == "/log":
            return self.send(json.dumps(self.log).encode(), "application/json")
        with self.lock:
            self.log.append(self.path)
        split = urllib.parse.urlsplit(self.path)
        asked = {k.lower(): v for k, v in urllib.parse.parse_qsl(split.query, keep_blank_values=True)}
        try:
            if split.path.startswith("/tiles/"):
                return self.tile(split.path.split("/")[2:], "numbers" in asked)
            if asked.get("request", "").lower() == "getcapabilities":
                version = asked.get("version", "1.3.0")
                address = f"http://{self.headers['Host']}"
                return self.send(capabilities(version, address, self.options), "text/xml")
            return self.map(asked)
        except (KeyError, ValueError) as error:
            return self.exception(f"the request is wrong: {error!r}")

    def exception(self, text):
        self.send(f'<?xml version="1.0"?>\n<ServiceExceptionReport><ServiceException code="X">{text}</ServiceException>'
                  "</ServiceExceptionReport>".encode(), "text/xml")

    def map(self, asked):
        if self.options.exception:
            return self.exception(self.options.exception)
        new = asked["version"].startswith("1.3")
        crs = asked["crs" if new else "srs"]
        if asked["layers"] != "waves" or crs not in self.options.crs or "styles" not in asked:
            raise ValueError(asked)
        west, south, east, north = map(float, asked["bbox"].split(","))
        if new and crs in NORTH_FIRST and not self.options.swap:
            west, south, east, north = south, west, north, east
        self.send(picture(SYSTEMS[crs], west, south, east, north, int(asked["width"]), int(asked["height"])), "image/png")

    def tile(self, parts, numbers):
        crs, window, block, count, z, x, y = parts
        west, north, east, south = map(float, window.split(","))
        columns, rows = (int(n) << int(z) for n in count.split("x"))
        x, y, block = int(x), int(y.split(".")[0]), int(block)
        if not (0 <= x < columns and 0 <= y < rows):
            return self.send(b"", "text/plain", 404)
        width, height = (east - west) / columns, (north - south) / rows
        at = (west + x * width, north - (y + 1) * height, west + (x + 1) * width, north - y * height)
        self.send(picture(SYSTEMS[crs.replace("-", ":")], *at, block, block, numbers), "image/png")

    def send(self, body, kind, status=200):
        self.send_response(status)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, *_):
        pass


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--crs", action="append", help="systems that the WMS offers")
    parser.add_argument("--swap", action="store_true", help="take the axes of EPSG:4326 in 1.3.0 for longitude first")
    parser.add_argument("--exception", help="answer each GetMap with this exception")
    parser.add_argument("--max-width", type=int, default=2048)
    Handler.options = parser.parse_args()
    Handler.options.crs = Handler.options.crs or ["EPSG:4326"]
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    print(json.dumps({"port": server.server_address[1]}), flush=True)
    sys.stdin.read()


if __name__ == "__main__":
    main()
