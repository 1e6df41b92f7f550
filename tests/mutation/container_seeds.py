"""Makes a small good container of each kind, from which mutants are made."""

import base64
import json
import math
import shutil
import sqlite3
import struct
import subprocess
import sys
import typing
import zlib
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import pmtiles  # noqa: E402
from pictures import PDS3_LABEL, png, png_of  # noqa: E402

ADDRESS = "ADDRESS"  # stands in documents for the address of the server of a mutant's folder
SIDE = 64


class Seed(typing.NamedTuple):
    folder: Path
    target: str  # file, folder or address that the commands get
    mutable: tuple  # files that a mutation may change, below the folder
    objects: bool = False  # drawn by --objects
    heights: bool = False  # drawn by --elevation, cut by --elevation


def run(*command):
    subprocess.run([*map(str, command)], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def wavy_png(width, height):
    rows = b"".join(b"\0" + bytes(v for x in range(width) for v in (2 * x % 256, 3 * y % 256, round(99 + 50 * math.sin(x / 5))))
                    for y in range(height))
    return png_of(width, height, zlib.compress(rows))


class Maker:
    """Each method makes the seeds of one kind in folders of their own."""

    def __init__(self, program, folder):
        self.program, self.root = program, folder
        self.picture = folder / "wavy.png"
        self.picture.write_bytes(wavy_png(4 * SIDE, 2 * SIDE))
        self.tiles = folder / "tiles"
        run(program, "cut", self.picture, "-o", self.tiles, "--tile-size", SIDE, "--format", "png")

    def new(self, name):
        folder = self.root / "seeds" / name
        folder.mkdir(parents=True)
        return folder

    def served(self, name):
        """A folder with two levels of tiles for a server."""
        folder = self.new(name)
        shutil.copytree(self.tiles, folder / "tiles", ignore=shutil.ignore_patterns("*.json"))
        return folder

    def geopackage(self):
        yield self.cut_geopackage("gpkg-pictures")
        heights = self.new("gpkg-heights")
        self.translate(heights / "h.tif", "-ot", "Int16", "-b", 1)
        run(self.program, "cut", heights / "h.tif", "-o", heights / "a.gpkg", "--tile-size", SIDE, "--elevation")
        (heights / "h.tif").unlink()
        yield Seed(heights, "a.gpkg", ("a.gpkg",), heights=True)
        gdal = self.new("gpkg-gdal")
        self.translate(gdal / "a.gpkg", "-of", "GPKG", "-co", "TILING_SCHEME=GoogleCRS84Quad")
        yield Seed(gdal, "a.gpkg", ("a.gpkg",))

    def cut_geopackage(self, name):
        folder = self.new(name)
        run(self.program, "cut", self.picture, "-o", folder / "a.gpkg", "--tile-size", SIDE)
        return Seed(folder, "a.gpkg", ("a.gpkg",))

    def mbtiles(self):
        folder = self.new("mbtiles")
        with sqlite3.connect(folder / "a.mbtiles") as base:
            base.executescript("CREATE TABLE metadata (name TEXT, value TEXT); CREATE TABLE tiles (zoom_level INTEGER,"
                               " tile_column INTEGER, tile_row INTEGER, tile_data BLOB)")
            facts = {"name": "a", "format": "png", "minzoom": "0", "maxzoom": "1", "bounds": "-180,-85,180,85", "attribution": "b"}
            base.executemany("INSERT INTO metadata VALUES (?, ?)", facts.items())
            base.executemany("INSERT INTO tiles VALUES (?, ?, ?, ?)",
                             ((z, x, y, png(SIDE, SIDE)) for z in (0, 1) for x in range(1 << z) for y in range(1 << z)))
        base.close()
        yield Seed(folder, "a.mbtiles", ("a.mbtiles",))

    def pmtiles(self):
        tiles = {(z, x, y): png(SIDE, SIDE, (x, y, z)) for z in (0, 1, 2) for x in range(1 << z) for y in range(1 << z)}
        for name, leaf_size in (("flat", 0), ("leaves", 6)):
            folder = self.new(f"pmtiles-{name}")
            (folder / "a.pmtiles").write_bytes(pmtiles.archive(tiles, leaf_size=leaf_size))
            yield Seed(folder, "a.pmtiles", ("a.pmtiles",))

    def folder(self):
        cut = self.new("folder-cut") / "set"
        shutil.copytree(self.tiles, cut)
        yield Seed(cut.parent, "set", ("set/tileset.json", "set/tileset.json", "set/0/0/0.png"))
        tms = self.new("folder-tms") / "set"
        shutil.copytree(Path(__file__).parents[1] / "fixtures/natural_earth_ii", tms)
        yield Seed(tms.parent, "set", ("set/tilemapresource.xml", "set/tilemapresource.xml", "set/0/0/0.jpg"))

    def gdal_wms(self):
        folder = self.served("gdal-wms")
        (folder / "a.xml").write_text(
            f'<GDAL_WMS><Service name="TMS"><ServerUrl>{ADDRESS}/tiles/${{z}}/${{x}}/${{y}}.png</ServerUrl></Service><DataWindow>'
            "<UpperLeftX>-180</UpperLeftX><UpperLeftY>90</UpperLeftY><LowerRightX>180</LowerRightX><LowerRightY>-90</LowerRightY>"
            "<TileLevel>1</TileLevel><TileCountX>2</TileCountX><TileCountY>1</TileCountY><YOrigin>top</YOrigin></DataWindow>"
            f"<Projection>EPSG:4326</Projection><BlockSizeX>{SIDE}</BlockSizeX><BlockSizeY>{SIDE}</BlockSizeY>"
            "<BandsCount>3</BandsCount></GDAL_WMS>")
        yield Seed(folder, "a.xml", ("a.xml",))

    def wmts(self):
        folder = self.served("wmts")
        matrices = "".join(
            f"<TileMatrix><ows:Identifier>{z}</ows:Identifier><ScaleDenominator>{279541132.0143589 * 256 / SIDE / 2**z}"
            f"</ScaleDenominator><TopLeftCorner>-180 90</TopLeftCorner><TileWidth>{SIDE}</TileWidth><TileHeight>{SIDE}</TileHeight>"
            f"<MatrixWidth>{2 << z}</MatrixWidth><MatrixHeight>{1 << z}</MatrixHeight></TileMatrix>" for z in (0, 1))
        (folder / "capabilities.xml").write_text(
            '<?xml version="1.0"?><Capabilities xmlns="http://www.opengis.net/wmts/1.0" xmlns:ows="http://www.opengis.net/ows/1.1"'
            ' version="1.0.0"><Contents><Layer><ows:Title>A</ows:Title><ows:Identifier>a</ows:Identifier><ows:WGS84BoundingBox>'
            "<ows:LowerCorner>-180 -90</ows:LowerCorner><ows:UpperCorner>180 90</ows:UpperCorner></ows:WGS84BoundingBox>"
            '<Style isDefault="true"><ows:Identifier>default</ows:Identifier></Style><Format>image/png</Format><TileMatrixSetLink>'
            '<TileMatrixSet>s</TileMatrixSet></TileMatrixSetLink><ResourceURL format="image/png" resourceType="tile" '
            f'template="{ADDRESS}/tiles/{{TileMatrix}}/{{TileCol}}/{{TileRow}}.png"/></Layer><TileMatrixSet><ows:Identifier>s'
            "</ows:Identifier><ows:SupportedCRS>urn:ogc:def:crs:OGC:1.3:CRS84</ows:SupportedCRS>"
            f"{matrices}</TileMatrixSet></Contents></Capabilities>")
        yield Seed(folder, f"{ADDRESS}/capabilities.xml", ("capabilities.xml",))

    def geojson(self):
        folder = self.new("geojson")
        ring = [[0, 0, 10], [40, 0, 10], [40, 30, 10], [0, 30, 10], [0, 0, 10]]
        hole = [[10, 10], [10, 20], [20, 20], [10, 10]]
        kinds = {"Point": [20, 20, 1e5], "MultiPoint": [[1, 2], [3, 4]], "LineString": ring, "MultiLineString": [ring, hole],
                 "Polygon": [ring, hole], "MultiPolygon": [[ring], [hole]]}
        looks = {"marker-color": "#ff0000", "stroke": "#00ff00", "stroke-width": 3, "fill": "#0000ff", "fill-opacity": 0.5,
                 "radius_m": 300000, "through_surface": True, "title": "Tést", "extrude_m": 1000}
        features = [{"type": "Feature", "properties": looks, "geometry": {"type": kind, "coordinates": where}}
                    for kind, where in kinds.items()]
        (folder / "a.geojson").write_text(json.dumps({"type": "FeatureCollection", "features": features}))
        yield Seed(folder, "a.geojson", ("a.geojson",), objects=True)

    def gltf(self):
        data = struct.pack("<9f3H2x", 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 2)
        document = {"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "scale": [1e6, 1e6, 1e6]}],
                    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
                    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                                  {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}],
                    "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
                    "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1]}}]}
        chunk = json.dumps(document | {"buffers": [{"byteLength": len(data)}]}).encode()
        chunk += b" " * (-len(chunk) % 4)
        glb = struct.pack("<4sIIII", b"glTF", 2, 28 + len(chunk) + len(data), len(chunk), 0x4E4F534A) + chunk
        glb += struct.pack("<II", len(data), 0x004E4942) + data
        uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
        text = json.dumps(document | {"buffers": [{"byteLength": len(data), "uri": uri}]}).encode()
        for name, content in (("m.glb", glb), ("m.gltf", text)):
            folder = self.new(name)
            (folder / name).write_bytes(content)
            point = {"type": "Feature", "properties": {"model": name}, "geometry": {"type": "Point", "coordinates": [0, 0, 0]}}
            (folder / "a.geojson").write_text(json.dumps({"type": "FeatureCollection", "features": [point]}))
            yield Seed(folder, "a.geojson", (name,), objects=True)

    def translate(self, output, *options):
        run("gdal_translate", "-q", "-a_srs", "EPSG:4326", "-a_ullr", -180, 90, 180, -90, *options, self.picture, output)

    def tiff(self):
        kinds = {"cog": ("-of", "COG", "-co", "BLOCKSIZE=128"), "strips": ("-co", "COMPRESS=LZW"),
                 "float": ("-ot", "Float32", "-b", 1, "-co", "COMPRESS=DEFLATE", "-co", "PREDICTOR=3"),
                 "tiled": ("-co", "TILED=YES", "-co", "BLOCKXSIZE=64", "-co", "BLOCKYSIZE=64", "-co", "COMPRESS=JPEG"),
                 "big": ("-co", "BIGTIFF=YES", "-co", "INTERLEAVE=BAND"), "short": ("-ot", "UInt16", "-b", 2, "-a_nodata", 0)}
        for name, options in kinds.items():
            folder = self.new(f"tiff-{name}")
            self.translate(folder / "a.tif", *options)
            yield Seed(folder, "a.tif", ("a.tif",), heights=name in ("float", "short"))

    def raster(self, driver, name, *mutable, heights=False):
        """A raster that GDAL writes in a format of its own."""
        folder = self.new(f"raster-{driver}")
        self.translate(folder / name, "-of", driver, "-b", 1)
        (folder / f"{name}.aux.xml").unlink(missing_ok=True)
        yield Seed(folder, name, mutable or (name,), heights=heights)

    def jpeg2000(self):
        return self.raster("JP2OpenJPEG", "a.jp2")

    def netcdf(self):
        return self.raster("netCDF", "a.nc", heights=True)

    def fits(self):
        return self.raster("FITS", "a.fits", heights=True)

    def envi(self):
        return self.raster("ENVI", "a.dat", "a.hdr", "a.hdr", "a.dat")

    def isis(self):
        return self.raster("ISIS3", "a.cub")

    def pds4(self):
        return self.raster("PDS4", "a.xml", "a.xml", "a.xml", "a.img")

    def pds3(self):
        folder = self.new("raster-PDS3")
        label = PDS3_LABEL.format(width=4 * SIDE, height=2 * SIDE, line=63.5, sample=127.5)
        label = label.replace("C_AXIS_RADIUS = 3396.19", "C_AXIS_RADIUS = 6356.7523142").replace("3396.19", "6378.137")
        pixels = bytes(range(256)) * (2 * SIDE * 4 * SIDE // 256)
        (folder / "a.lbl").write_text(label)
        (folder / "SPOTS.IMG").write_bytes(pixels)
        yield Seed(folder, "a.lbl", ("a.lbl",))

    def vrt(self):
        folder = self.new("raster-VRT")
        self.translate(folder / "a.tif")
        run("gdal_translate", "-q", "-of", "VRT", folder / "a.tif", folder / "a.vrt")
        yield Seed(folder, "a.vrt", ("a.vrt", "a.vrt", "a.tif"))

    def picture_file(self):
        for ending, options in {"jpg": ("-of", "JPEG"), "png": ("-of", "PNG"), "webp": ("-of", "WEBP")}.items():
            folder = self.new(f"picture-{ending}")
            run("gdal_translate", "-q", *options, self.picture, folder / f"a.{ending}")
            (folder / f"a.{ending}.aux.xml").unlink(missing_ok=True)
            yield Seed(folder, f"a.{ending}", (f"a.{ending}",))

    def beside(self):
        """World files and .aux.xml beside a picture."""
        aux = self.new("beside-aux")
        self.translate(aux / "a.png", "-of", "PNG")
        yield Seed(aux, "a.png", ("a.png.aux.xml",))
        world = self.new("beside-world")
        shutil.copy(self.picture, world / "a.png")
        (world / "a.pgw").write_text("1.40625\n0\n0\n-1.40625\n-179.296875\n89.296875\n")
        (world / "a.prj").write_text('GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],PRIMEM["Greenwich",0],'
                                     'UNIT["degree",0.0174532925199433]]')
        yield Seed(world, "a.png", ("a.pgw", "a.prj"))

    def mosaic(self):
        for name in ("list.txt", "list.json"):
            folder = self.new(f"mosaic-{name}")
            for k, west in enumerate((0, 2 * SIDE)):
                whole = folder / "whole.tif"
                self.translate(whole)
                run("gdal_translate", "-q", "-srcwin", west, 0, 2 * SIDE, 2 * SIDE, whole, folder / f"{k}.tif")
                whole.unlink()
            (folder / "list.txt").write_text("# both halves\n0.tif\n1.tif\n")
            (folder / "list.json").write_text(json.dumps({"name": "Both", "mosaic": ["0.tif", "1.tif"]}))
            yield Seed(folder, name, (name, name, "1.tif"))

    def description(self):
        folder = self.served("description")
        (folder / "a.json").write_text(json.dumps({"url": f"{ADDRESS}/tiles/{{z}}/{{x}}/{{y}}.png", "tile_px": SIDE, "root_span_deg": 180,
                                                   "max_level": 1, "attribution": "nobody", "headers": ["X-Key: secret"]}))
        yield Seed(folder, "a.json", ("a.json",))

    def vector(self, driver, name, *mutable, options=()):
        """Features that GDAL writes: points, a line and an area."""
        folder = self.new(f"vector-{name}")
        look = {"name": "T\u00e9st", "height": 12.5, "count": 3}
        shapes = [("Point", [20, 20]), ("Point", [21, 19])] if name.endswith((".shp", ".gpx", ".csv")) else [
            ("Point", [20, 20, 9]), ("LineString", [[0, 0], [30, 20], [40, 5]]), ("Polygon", [[[0, 0], [40, 0], [40, 30], [0, 0]]])]
        features = [{"type": "Feature", "properties": look, "geometry": {"type": kind, "coordinates": where}} for kind, where in shapes]
        (folder / "in.geojson").write_text(json.dumps({"type": "FeatureCollection", "features": features}))
        run("ogr2ogr", "-f", driver, *options, folder / name, folder / "in.geojson")
        (folder / "in.geojson").unlink()
        yield Seed(folder, name, mutable or (name,), objects=True)

    def kml(self):
        yield from self.vector("LIBKML", "a.kmz")
        folder = self.new("vector-a.kml")
        (folder / "a.kml").write_text(
            '<?xml version="1.0"?><kml xmlns="http://www.opengis.net/kml/2.2"><Document><Style id="s"><LineStyle><color>7f0000ff</color>'
            "<width>6</width></LineStyle><PolyStyle><color>ff00ff00</color></PolyStyle><IconStyle><color>ff00ffff</color><scale>2</scale>"
            "</IconStyle></Style><Placemark><name>P</name><styleUrl>#s</styleUrl><Point><coordinates>5,5,7</coordinates></Point></Placemark>"
            "<Placemark><styleUrl>#s</styleUrl><LineString><altitudeMode>relativeToGround</altitudeMode><coordinates>-30,0,100 30,20,100"
            "</coordinates></LineString></Placemark><Placemark><styleUrl>#s</styleUrl><Polygon><outerBoundaryIs><LinearRing><coordinates>"
            "1,1 9,1 9,9 1,1</coordinates></LinearRing></outerBoundaryIs></Polygon></Placemark><GroundOverlay><drawOrder>1</drawOrder><Icon>"
            "<href>o.png</href></Icon><LatLonBox><north>9</north><south>5</south><east>9</east><west>5</west><rotation>5</rotation>"
            "</LatLonBox></GroundOverlay></Document></kml>")
        (folder / "o.png").write_bytes(png(8, 8))
        yield Seed(folder, "a.kml", ("a.kml",), objects=True)

    def gpx(self):
        return self.vector("GPX", "a.gpx", options=("-nln", "waypoints", "-select", "name"))

    def shapefile(self):
        return self.vector("ESRI Shapefile", "a.shp", "a.shp", "a.shx", "a.dbf", "a.prj")

    def flatgeobuf(self):
        return self.vector("FlatGeobuf", "a.fgb")

    def features(self):
        return self.vector("GPKG", "a.gpkg")

    def table(self):
        return self.vector("CSV", "a.csv", options=("-lco", "GEOMETRY=AS_XY"))

    KINDS = {"geopackage": geopackage, "mbtiles": mbtiles, "pmtiles": pmtiles, "folder": folder, "gdal_wms": gdal_wms, "wmts": wmts,
             "geojson": geojson, "gltf": gltf, "tiff": tiff, "picture": picture_file, "beside": beside, "mosaic": mosaic,
             "description": description, "raster-jpeg2000": jpeg2000, "raster-vrt": vrt, "raster-netcdf": netcdf, "raster-fits": fits,
             "raster-envi": envi, "raster-isis": isis, "raster-pds3": pds3, "raster-pds4": pds4, "vector-kml": kml, "vector-gpx": gpx,
             "vector-shapefile": shapefile, "vector-flatgeobuf": flatgeobuf, "vector-geopackage": features, "vector-csv": table}

    def seeds(self, kind):
        return list(self.KINDS[kind](self))
