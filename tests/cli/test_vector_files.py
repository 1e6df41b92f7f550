"""--objects with vector files that GDAL reads: they are drawn where GeoJSON is, and faults are named."""

import subprocess
import unittest
import zipfile

from pictures import png
from program import DONE_IN_PART, FAILED, ProgramTest

SMALL = ["--size", "128x128", "--unlit", "--sky", "off", "--camera", "10,10,3000000"]
AREA = (b'{"type":"Feature","properties":{"fill":"#ff0000","fill-opacity":1},"geometry":{"type":"Polygon","coordinates":'
        b'[[[5,5],[15,5],[15,15],[5,15],[5,5]]]}}')


class VectorFiles(ProgramTest):
    def drawn(self, name):
        self.assert_done("render", "--objects", name, "-o", name + ".png", *SMALL)
        return (self.folder / (name + ".png")).read_bytes()

    def test_formats_draw_the_same_picture_as_geojson(self):
        self.write("a.geojson", AREA)
        expected = self.drawn("a.geojson")
        for name, options in {"a.fgb": [], "a.gpkg": [], "a.csv": ["-lco", "GEOMETRY=AS_WKT"]}.items():
            subprocess.run(["ogr2ogr", *options, name, "a.geojson"], cwd=self.folder, check=True)
            self.assertEqual(self.drawn(name), expected, name)

    def test_a_network_link_is_named_and_not_followed(self):
        self.write("n.kml", b'<kml xmlns="http://www.opengis.net/kml/2.2"><Document><Placemark><Point><coordinates>5,5'
                            b"</coordinates></Point></Placemark><NetworkLink><Link><href>http://127.0.0.1:9/</href></Link>"
                            b"</NetworkLink></Document></kml>")
        self.assert_fails(DONE_IN_PART, "render", "--objects", "n.kml", "-o", "n.png", *SMALL, says=["n.kml", "NetworkLink"])

    def test_pictures_of_kml_lie_where_those_of_a_geotiff_do(self):
        """An icon, and two pictures with a gap between them, in the folder and in a KMZ file: as by --overlay."""
        def overlay(west, east):
            return (f"<GroundOverlay><Icon><href>files/box.png</href></Icon><LatLonBox><north>12</north><south>8</south><east>{east}"
                    f"</east><west>{west}</west></LatLonBox></GroundOverlay>")
        (self.folder / "files").mkdir()
        (self.folder / "rasters").mkdir()
        self.write("files/box.png", png(32, 32, (250, 200, 0)))
        for name, west, east in (("a", 1, 5), ("b", 15, 19)):
            subprocess.run(["gdal_translate", "-q", "-a_srs", "EPSG:4326", "-a_ullr", str(west), "12", str(east), "8", "files/box.png",
                            f"rasters/{name}.tif"], cwd=self.folder, check=True)
        place = ("<Style id='s'><IconStyle><scale>0.5</scale><Icon><href>files/box.png</href></Icon></IconStyle></Style><Placemark>"
                 "<styleUrl>#s</styleUrl><Point><coordinates>10,10</coordinates></Point></Placemark>")
        document = '<kml xmlns="http://www.opengis.net/kml/2.2"><Document>{}</Document></kml>'
        self.write("o.kml", document.format(place + overlay(1, 5) + overlay(15, 19)).encode())
        with zipfile.ZipFile(self.folder / "o.kmz", "w") as kmz:
            for name in ("o.kml", "files/box.png"):
                kmz.write(self.folder / name, name)
        self.write("p.geojson", b'{"type":"Feature","properties":{"icon":"files/box.png","icon-size":16,"heading_deg":0},"geometry":'
                                b'{"type":"Point","coordinates":[10,10]}}')
        self.assert_done("render", "--objects", "p.geojson", "--overlay", "rasters", "-o", "tif.png", *SMALL)
        expected = (self.folder / "tif.png").read_bytes()
        self.assertEqual(self.drawn("o.kml"), expected)
        self.assertEqual(self.drawn("o.kmz"), expected)
        self.write("r.kml", document.format(place + overlay(1, 5).replace("files/", "http://127.0.0.1:9/")).encode())
        self.assert_fails(DONE_IN_PART, "render", "--objects", "r.kml", "-o", "r.png", *SMALL, says=["r.kml", "127.0.0.1:9/box.png"])

    def test_expanding_entities_are_refused_at_once(self):
        entities = b"".join(b'<!ENTITY e%d "%s">' % (k, b"&e%d;" % (k - 1) * 10) for k in range(1, 12))
        bomb = (b'<?xml version="1.0"?><!DOCTYPE kml [<!ENTITY e0 "aaaaaaaaaa">' + entities +
                b']><kml xmlns="http://www.opengis.net/kml/2.2"><Placemark><name>&e11;</name></Placemark></kml>')
        for name in ("b.kml", "b.gpx"):
            self.write(name, bomb.replace(b"kml", name[2:].encode()))
            self.assert_fails(FAILED, "render", "--objects", name, "-o", "b.png", *SMALL, says=[name])


if __name__ == "__main__":
    unittest.main()
