"""serve: the tiles of every kind of set by HTTP, read by GDAL, by Terrella and by clients that mean ill."""

import http.client
import json
import os
import pathlib
import random
import shutil
import signal
import socket
import sqlite3
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree as ET

import pmtiles
from pictures import TILE_PX, png, square_tile
from program import DONE, FAILED, NATURAL_EARTH, PROGRAM, TIME_LIMIT_S, WRONG_USAGE, ProgramTest

LEVELS = 3
HOLE = (2, 3, 1)
TILES = {(z, x, y): square_tile(z, x, y) for z in range(LEVELS) for x in range(1 << z) for y in range(1 << z)
         if (z, x, y) != HOLE}
INFO = {"version": 1, "name": "Waves & <more>", "attribution": "nobody – © 2026", "projection": "web-mercator",
        "tile_px": TILE_PX, "min_level": 0, "max_level": LEVELS - 1, "format": "png"}
KINDS = {"tiles": "folder", "gpkg": "set.gpkg", "mbt": "set.mbtiles", "pmt": "set.pmtiles"}
# A sanitizer keeps freed memory for a while; without bounds these clients would take gigabytes.
MOST_GROWTH_MB = 400
ENVIRONMENT = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY", "http_proxy")}


class Server:
    """A server of some sets, at a free port."""

    def __init__(self, folder, *arguments):
        self.process = subprocess.Popen([PROGRAM, "serve", "--port", "0", "--json", *map(str, arguments)], cwd=folder,
                                        env=ENVIRONMENT | {"XDG_CACHE_HOME": str(folder / "cache")},
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        line = self.process.stdout.readline()
        if not line:
            raise AssertionError(self.process.communicate()[1])
        self.told = json.loads(line)
        self.port, self.address = self.told["port"], self.told["address"].rstrip("/")

    def get(self, path, method="GET", **fields):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=TIME_LIMIT_S)
        connection.request(method, path, headers={k.replace("_", "-"): v for k, v in fields.items()})
        answer = connection.getresponse()
        body = answer.read()
        connection.close()
        return answer.status, body, answer.headers

    def send(self, data):
        """A connection on which bytes were sent. What the server thinks of them is not asked."""
        connection = socket.create_connection(("127.0.0.1", self.port), timeout=TIME_LIMIT_S)
        try:
            connection.sendall(data)
        except OSError:
            pass
        return connection

    def resident_mb(self):
        status = pathlib.Path(f"/proc/{self.process.pid}/status").read_text()
        return int(status.split("VmRSS:")[1].split()[0]) / 1024

    def stop(self, how=signal.SIGTERM):
        self.process.send_signal(how)
        said = self.process.communicate(timeout=TIME_LIMIT_S)[1]
        return self.process.returncode, said


class Serve(ProgramTest):
    @classmethod
    def setUpClass(cls):
        cls.sets = pathlib.Path(tempfile.mkdtemp(prefix="terrella-serve-"))
        cls.addClassCleanup(shutil.rmtree, cls.sets, ignore_errors=True)
        for (z, x, y), data in TILES.items():
            path = cls.sets / "folder" / str(z) / str(x) / f"{y}.png"
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(data)
        (cls.sets / "folder/tileset.json").write_text(json.dumps(INFO))
        for name in KINDS.values():
            if name != "folder":
                subprocess.run([PROGRAM, "convert", "folder", name], cwd=cls.sets, check=True, capture_output=True)
        (cls.sets / "picture.png").write_bytes(png(512, 256))
        cls.server = Server(cls.sets, *(f"{name}={path}" for name, path in KINDS.items()), NATURAL_EARTH, "picture.png")
        cls.addClassCleanup(cls.server.stop)

    def get(self, path, **fields):
        return self.server.get(path, **fields)

    def pixels(self, source):
        """The red, green and blue of a source as GDAL reads it."""
        path = self.folder / "pixels"
        subprocess.run(["gdal_translate", "-q", "-of", "ENVI", "-b", "1", "-b", "2", "-b", "3", source, path], check=True,
                       capture_output=True, env=ENVIRONMENT | {"GDAL_DEFAULT_WMS_CACHE_PATH": str(self.folder / "wms")}, cwd=self.folder)
        return path.read_bytes()

    def picture(self, *source):
        path = self.folder / "picture.png"
        self.assert_done("render", *source, "-o", path, "--unlit", "--size", "160x160", "--camera", "20,-60,6000000",
                         "--cache", "off", "--projection", "web-mercator")
        return path.read_bytes()

    def test_tiles_are_those_of_the_set(self):
        for name in KINDS:
            for (z, x, y), data in TILES.items():
                status, body, headers = self.get(f"/{name}/{z}/{x}/{y}.png")
                self.assertEqual((status, body), (200, data), (name, z, x, y))
                self.assertEqual(headers["Content-Type"], "image/png")
                self.assertEqual(headers["Access-Control-Allow-Origin"], "*")
            self.assertEqual(self.get(f"/{name}/tms/2/1/3.png")[1], TILES[2, 1, 0])
            self.assertEqual(self.get(f"/{name}/wmts/{name}/2/0/1.png")[1], TILES[2, 1, 0])
            self.assertEqual(self.get("/{}/{}/{}/{}.png".format(name, *HOLE))[0], 404)

    def test_a_known_tile_is_not_sent_again(self):
        _, body, headers = self.get("/gpkg/2/1/1.png")
        etag = headers["ETag"]
        self.assertEqual(self.get("/gpkg/2/1/1.png", If_None_Match=f'"x", {etag}')[:2], (304, b""))
        self.assertEqual(self.get("/gpkg/2/1/1.png", If_None_Match='"x"')[:2], (200, body))
        self.assertNotEqual(self.get("/gpkg/2/1/2.png")[2]["ETag"], etag)
        self.assertEqual(self.get("/tiles/2/1/1.png")[2]["ETag"], etag, "the same bytes")

    def test_head_and_options_and_other_methods(self):
        status, body, headers = self.get("/mbt/0/0/0.png", method="HEAD")
        self.assertEqual((status, body, headers["Content-Length"]), (200, b"", str(len(TILES[0, 0, 0]))))
        status, body, headers = self.get("/mbt/0/0/0.png", method="OPTIONS")
        self.assertEqual((status, body), (204, b""))
        self.assertIn("Range", headers["Access-Control-Allow-Headers"])
        self.assertEqual(self.get("/mbt/0/0/0.png", method="DELETE")[0], 405)

    def test_a_connection_carries_several_requests(self):
        connection = self.server.send(b"".join(b"GET %s HTTP/1.1\r\nHost: x\r\n%s\r\n" % one for one in (
            (b"/gpkg/9/0/0.png", b""), (b"/picture/0/1/0.jpg", b""), (b"/pmt.pmtiles", b"Range: bytes=0-6\r\n"),
            (b"/gpkg/0/0/0.png", b"Connection: close\r\n"))))
        data = b"".join(iter(lambda: connection.recv(65536), b""))
        self.assertEqual(data.count(b"HTTP/1.1 200"), 2)
        self.assertEqual(data.count(b"HTTP/1.1 206"), 1)
        self.assertTrue(data.endswith(TILES[0, 0, 0]))
        connection.close()

    def test_an_archive_is_served_by_ranges(self):
        whole = (self.sets / "set.pmtiles").read_bytes()
        status, body, headers = self.get("/pmt.pmtiles")
        self.assertEqual((status, body), (200, whole))
        self.assertEqual(pmtiles.contents(body)[2], TILES)
        for asked, start, end in ("0-126", 0, 127), ("100-", 100, len(whole)), ("-7", len(whole) - 7, len(whole)):
            status, body, part = self.get("/pmt.pmtiles", Range=f"bytes={asked}", If_Range=headers["ETag"])
            self.assertEqual((status, body), (206, whole[start:end]), asked)
            self.assertEqual(part["Content-Range"], f"bytes {start}-{end - 1}/{len(whole)}")
        self.assertEqual(self.get("/pmt.pmtiles", Range=f"bytes={len(whole)}-")[0], 416)
        self.assertEqual(self.get("/pmt.pmtiles", Range="bytes=0-1", If_Range='"other"')[:2], (200, whole))
        self.assertEqual(self.get("/pmt.pmtiles", If_None_Match=headers["ETag"])[0], 304)
        self.assertEqual(self.get("/gpkg.pmtiles")[0], 404)

    def test_gdal_reads_wmts_and_tms(self):
        expected = self.pixels(self.sets / "set.mbtiles")
        self.assertEqual(len(expected), 3 * (TILE_PX << (LEVELS - 1)) ** 2)
        for address in (f"{self.server.address}/gpkg/wmts/1.0.0/WMTSCapabilities.xml",
                        f"{self.server.address}/wmts?SERVICE=WMTS&REQUEST=GetCapabilities"):
            self.assertEqual(self.pixels(f"WMTS:{address},layer=gpkg"), expected)
        side = 20037508.342789244
        for url, y, top, bottom in ("gpkg", "top", side, -side), ("gpkg/tms", "bottom", side, -side):
            xml = (f'<GDAL_WMS><Service name="TMS"><ServerUrl>{self.server.address}/{url}/${{z}}/${{x}}/${{y}}.png'
                   f"</ServerUrl></Service><DataWindow><UpperLeftX>{-side}</UpperLeftX><UpperLeftY>{top}</UpperLeftY>"
                   f"<LowerRightX>{side}</LowerRightX><LowerRightY>{bottom}</LowerRightY><TileLevel>{LEVELS - 1}</TileLevel>"
                   f"<TileCountX>1</TileCountX><TileCountY>1</TileCountY><YOrigin>{y}</YOrigin></DataWindow><Projection>"
                   f"EPSG:3857</Projection><BlockSizeX>{TILE_PX}</BlockSizeX><BlockSizeY>{TILE_PX}</BlockSizeY>"
                   "<BandsCount>3</BandsCount><ZeroBlockHttpCodes>404</ZeroBlockHttpCodes></GDAL_WMS>")
            self.assertEqual(self.pixels(self.write("tms.xml", xml.encode())), expected, url)

    def test_terrella_draws_the_same_picture(self):
        expected = self.picture(self.sets / "set.mbtiles")
        template = f"{self.server.address}/pmt/{{z}}/{{x}}/{{y}}.png"
        self.assertEqual(self.picture(template, "--tile-size", TILE_PX, "--max-level", LEVELS - 1), expected)
        self.assertEqual(self.picture(f"{self.server.address}/gpkg/wmts/1.0.0/WMTSCapabilities.xml"), expected)
        self.assertEqual(self.picture(f"{self.server.address}/pmt.pmtiles"), expected)
        said = json.loads(self.assert_done("info", f"{self.server.address}/mbt/wmts/1.0.0/WMTSCapabilities.xml",
                                           "--json").stdout)
        self.assertEqual((said["name"], said["attribution"]), (INFO["name"], INFO["attribution"]))

    def test_a_geodetic_set_keeps_its_grid(self):
        name = NATURAL_EARTH.name
        self.assertEqual(self.get(f"/{name}/tilejson.json")[0], 404)
        xml = self.get(f"/{name}/wmts/1.0.0/WMTSCapabilities.xml")[1]
        corner = next(ET.fromstring(xml).iter("{http://www.opengis.net/wmts/1.0}TopLeftCorner")).text
        self.assertEqual([float(number) for number in corner.split()], [-180, 90])
        told = json.loads(self.assert_done("info", NATURAL_EARTH, "--json").stdout)
        served = json.loads(self.assert_done("info", f"{self.server.address}/{name}/wmts/1.0.0/WMTSCapabilities.xml",
                                             "--json").stdout)
        for field in "root_span_deg", "tile_px", "max_level", "bounds", "format":
            self.assertEqual(served[field], told[field], field)

    def test_tiles_of_a_picture_are_made(self):
        status, body, headers = self.get("/picture/0/1/0.jpg")
        self.assertEqual((status, body[:2], headers["Content-Type"]), (200, b"\xff\xd8", "image/jpeg"))
        self.assertEqual(self.get("/picture/0/1/0.jpg", If_None_Match=headers["ETag"])[0], 304)
        self.assertEqual(self.get("/picture/0/9/0.jpg")[0], 404)

    def test_descriptions(self):
        tilejson = json.loads(self.get("/mbt/tilejson.json", Host="maps.example:81")[1])
        self.assertEqual(tilejson["tiles"], ["http://maps.example:81/mbt/{z}/{x}/{y}.png"])
        self.assertEqual([tilejson[field] for field in ("name", "attribution", "minzoom", "maxzoom")],
                         [INFO["name"], INFO["attribution"], 0, LEVELS - 1])
        page = self.get("/", Host='"><script>')[1].decode()
        self.assertNotIn("<script>", page)
        self.assertIn("Waves &amp; &lt;more&gt;", page)
        self.assertIn(f'src="{self.server.address}/pmt/0/0/0.png"', page)

    def test_a_broken_tile_is_reported(self):
        shutil.copy(self.sets / "set.gpkg", self.folder / "broken.gpkg")
        base = sqlite3.connect(self.folder / "broken.gpkg")
        base.execute("UPDATE tiles SET tile_data = substr(tile_data, 1, 60) WHERE zoom_level = 0")
        base.commit()
        base.close()
        server = Server(self.folder, "broken.gpkg")
        self.assertEqual(server.get("/broken/0/0/0.png")[0], 500)
        self.assertEqual(server.get("/broken/1/0/0.png")[0], 200)
        code, said = server.stop(signal.SIGINT)
        self.assertEqual(code, DONE)
        self.assertIn("broken: level 0, column 0, row 0", said)

    def test_hostile_clients_leave_it_serving(self):
        random.seed(35)
        before = self.server.resident_mb()
        good = b"GET /gpkg/2/1/1.png HTTP/1.1\r\nHost: x\r\nRange: bytes=0-5\r\nIf-None-Match: \"a\"\r\n\r\n"
        pieces = [b"..", b"/", b"%2e%2e%2f", b"%00", b"\0", b"\r\n", b"\r\n\r\n", b":", b"\xff" * 40, b"9" * 400, b"-",
                  b"Content-Length: 99999999999\r\n", b"Transfer-Encoding: chunked\r\n", b"Expect: 100-continue\r\n",
                  b"X: " + b"a" * 70000 + b"\r\n", b"POST ", b"bytes=0-,0-,0-,0-"]
        slow = []
        for i in range(1000):
            data = good
            for _ in range(random.randint(1, 4)):
                at = random.randrange(len(data))
                data = data[:at] + random.choice(pieces) + data[at + random.randint(0, 3):]
            connection = self.server.send(data)
            if i % 10 == 0:
                slow.append(connection)  # never reads, never ends
            else:
                connection.close()
        slow += [self.server.send(b"GET /pmt.pmtiles HTTP/1.1\r\nHost: x\r\n\r\n" * 50) for _ in range(50)]
        slow += [self.server.send(b"GET /pmt") for _ in range(50)]
        self.assertEqual(self.get("/gpkg/2/1/1.png")[:2], (200, TILES[2, 1, 1]))
        self.assertLess(self.server.resident_mb() - before, MOST_GROWTH_MB)
        for connection in slow:
            connection.close()

    def test_names_and_ends(self):
        server = Server(self.sets, "set.gpkg", "set.mbtiles", "other=set.pmtiles", "picture.png")
        self.assertEqual([one["name"] for one in server.told["sets"]], ["set", "set-2", "other", "picture"])
        self.assertEqual(server.told["sets"][2]["pmtiles"], f"{server.address}/other.pmtiles")
        under_way = [server.send(b"GET / HT")]
        self.assert_fails(FAILED, "serve", self.sets / "set.gpkg", "--port", server.port,
                          says=[str(server.port), "in use", "another port"])
        under_way += [server.send(b"GET /picture/1/1/0.jpg HTTP/1.1\r\nHost: x\r\n\r\n" * 9) for _ in range(40)]
        self.assertEqual(server.stop(), (DONE, ""))
        for connection in under_way:
            connection.close()

    def test_what_cannot_be_served_is_refused_with_a_cure(self):
        path = self.sets / "set.gpkg"
        subprocess.run(["gdal_translate", "-q", "-ot", "Float32", "-b", "1", self.sets / "picture.png",
                        self.folder / "numbers.tif"], check=True)
        for arguments, says in (
                (["http://user:word@127.0.0.1:1/{z}/{x}/{y}.png"], ["server", "terrella preload"]),
                ([self.folder / "none.gpkg"], ["none.gpkg"]),
                ([self.folder / "ice_{time}.tif"], ["ice_{time}.tif", "NAME=FILE"]),
                ([self.folder / "numbers.tif"], ["numbers.tif", "terrella cut"]),
                ([f"a/b={path}"], ["a/b="]),
                ([f".a={path}"], [".a", "letters"]),
                ([f"wmts={path}"], ["wmts", "taken"]),
                ([f"a={path}", f"a={path}"], ["a: ", "taken"]),
                ([path, "--bind", "192.0.2.1"], ["192.0.2.1", "this machine"])):
            done = self.assert_fails(FAILED, "serve", "--port", "0", *arguments, says=says)
            self.assertNotIn("word", done.stderr)
        self.assert_fails(WRONG_USAGE, "serve", path, "--port", "65536", says=["--port"])
        self.assert_fails(WRONG_USAGE, "serve", says=["SET"])


if __name__ == "__main__":
    unittest.main()
