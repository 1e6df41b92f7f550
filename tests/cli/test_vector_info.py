"""terrella info of vector files: layers, features, fields and coordinate systems as GDAL's own ogrinfo says."""

import json
import subprocess
import unittest
import zipfile

from program import FAILED, ProgramTest

FEATURES = json.dumps({"type": "FeatureCollection", "features": [
    {"type": "Feature", "properties": {"name": f"p{k}", "height": k + 0.5, "count": k},
     "geometry": {"type": "Point", "coordinates": [7.0 + 0.01 * k, 46.0 + 0.01 * k]}} for k in range(20)]}).encode()
FORMATS = {"a.kml": ("LIBKML",), "a.fgb": ("FlatGeobuf",), "a.gpkg": ("GPKG", "-t_srs", "EPSG:3034"),
           "a.shp": ("ESRI Shapefile", "-t_srs", "EPSG:32632"), "a.csv": ("CSV", "-lco", "GEOMETRY=AS_XY"),
           "a.gpx": ("GPX", "-nln", "waypoints", "-select", "name")}
# Both programs print 12 digits or more of numbers up to 1e7.
SAME_CORNER = 1e-5


class VectorInfo(ProgramTest):
    def convert(self, name, driver, *options):
        self.write("in.geojson", FEATURES)
        subprocess.run(["ogr2ogr", "-f", driver, *options, name, "in.geojson"], cwd=self.folder, check=True)

    def facts(self, name):
        return json.loads(self.assert_done("info", name, "--json").stdout)

    def test_layers_features_and_fields_are_those_of_ogrinfo(self):
        for name, options in FORMATS.items():
            self.convert(name, *options)
            said = subprocess.run(["ogrinfo", "-ro", "-so", "-al", name], cwd=self.folder, check=True, capture_output=True, text=True).stdout
            facts = self.facts(name)
            self.assertEqual((facts["kind"], facts["format"]), ("vector", options[0]), name)
            layer = max(facts["layers"], key=lambda one: one["features"])
            self.assertEqual(layer["features"], 20, name)
            self.assertIn("name", [field["name"].lower() for field in layer["fields"]], name)
            self.assertIn(f"Layer name: {layer['name']}", said, name)
            for field in layer["fields"] if name != "a.csv" else []:  # ogrinfo does not look for the types of a table
                self.assertIn(f"{field['name']}: {field['type']}", said, name)

    def test_coordinate_systems_and_corners_are_those_of_the_file(self):
        for name, code in {"a.shp": "EPSG:32632", "a.gpkg": "EPSG:3034"}.items():
            self.convert(name, *FORMATS[name])
            layer = self.facts(name)["layers"][0]
            self.assertEqual(layer["crs_code"], code)
            west, south, east, north = layer["bounds"]
            # Longitude and latitude grow together; in both systems so do x and y.
            done = subprocess.run(["gdaltransform", "-s_srs", "EPSG:4326", "-t_srs", code, "-output_xy"], input="7.0 46.0\n7.19 46.19\n",
                                  check=True, capture_output=True, text=True).stdout
            expected = [float(word) for word in done.split()]
            if code == "EPSG:3034":
                expected[0::2] = sorted(expected[0::2])
            for got, wanted in zip((west, south, east, north), expected, strict=True):
                self.assertAlmostEqual(got, wanted, delta=SAME_CORNER, msg=name)

    def test_text_names_layers_fields_and_systems(self):
        self.convert("a.shp", *FORMATS["a.shp"])
        text = self.assert_done("info", "a.shp").stdout
        for part in ("vector file  a.shp", "features   20, Point", "EPSG:32632", "height (Real)"):
            self.assertIn(part, text)

    def test_a_file_that_is_not_what_its_name_says_is_refused_by_name(self):
        for name in ("a.kml", "a.gpx", "a.shp", "a.fgb", "a.csv.zip"):
            self.write(name, b"<html>no map</html>")
            self.assert_fails(FAILED, "info", name, says=[name])

    def test_kml_that_makes_gdal_crash_is_refused_with_a_cure(self):
        """GDAL 3.6 follows a null pointer for each of these, whatever the prefix and the encoding, within a KMZ file too."""
        kml = '<kml xmlns="http://www.opengis.net/kml/2.2" xmlns:gx="http://www.google.com/kml/ext/2.2"><Placemark>{}</Placemark></kml>'
        model = kml.format("<MultiGeometry><Model/></MultiGeometry>")
        track = kml.format("<gx:Track><gx:coord>1 1 0</gx:coord></gx:Track>")
        prefixed = ('<k:kml xmlns:k="http://www.opengis.net/kml/2.2"><k:Placemark><k:MultiGeometry><k:Model/></k:MultiGeometry>'
                    "</k:Placemark></k:kml>")
        files = {"model.kml": (model.encode(), "Model"), "track.kml": (track.encode(), "gx:Track"), "prefix.kml": (prefixed.encode(), "Model"),
                 "wide.kml": (('<?xml version="1.0" encoding="UTF-16"?>' + model).encode("utf-16"), "Model")}
        for name, (content, says) in files.items():
            self.write(name, content)
            self.assert_fails(FAILED, "info", name, says=[name, says])
        for inner in ("doc.kml", "b.txt"):
            with zipfile.ZipFile(self.folder / "a.kmz", "w") as kmz:
                kmz.writestr(inner, model)
            self.assert_fails(FAILED, "info", "a.kmz", says=["a.kmz", inner, "Model"])
        self.write("good.kml", kml.format("<gx:Track><when>2020-01-01</when><gx:coord>1 1 0</gx:coord></gx:Track>").encode())
        self.assert_done("info", "good.kml")

    def test_verify_is_refused_for_features(self):
        self.convert("a.fgb", *FORMATS["a.fgb"])
        self.assert_fails(FAILED, "info", "a.fgb", "--verify", says=["a.fgb", "checks tiles"])


if __name__ == "__main__":
    unittest.main()
