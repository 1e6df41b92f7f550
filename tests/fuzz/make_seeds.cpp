#include <sqlite3.h>
#include <tiffio.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "codecs/image.h"
#include "streaming/cut/output/gray16_png.h"
#include "streaming/sets/tileset_json.h"
#include "support/model_file.h"

namespace {

using namespace terrella;
namespace fs = std::filesystem;

void write(const fs::path& path, std::string_view text) {
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary).write(text.data(), static_cast<std::streamsize>(text.size()));
}

void write(const fs::path& path, const std::vector<std::byte>& bytes) {
  write(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

/// A box as .glb with a picture in its buffer, and as .gltf with its buffer in the text and nodes that turn it.
void write_models(const fs::path& folder) {
  test::ModelFixture box = test::box_model<std::uint8_t>({-1, 0, -1}, {1, 2, 1}, {1.0, 0.5, 0.0, 1.0});
  write(folder / "plain.glb", box.bytes());
  const auto png = encode_png({1, 1, {9, 99, 199, 255}});
  box.json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", box.buffer.size()}, {"byteLength", png->size()}});
  box.buffer.append(reinterpret_cast<const char*>(png->data()), png->size());
  box.buffer.resize((box.buffer.size() + 3) / 4 * 4);
  box.json["images"] = {{{"bufferView", 2}, {"mimeType", "image/png"}}};
  box.json["textures"] = {{{"source", 0}}};
  box.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
  write(folder / "picture.glb", box.bytes());
  write(
      folder / "a.gltf",
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"children":[1],"rotation":[0,0,1,0]},)"
      R"({"mesh":0,"scale":[1,2,3]}],"meshes":[{"primitives":[{"mode":5,"attributes":{"POSITION":0}}]}],"accessors":)"
      R"([{"bufferView":0,"componentType":5126,"type":"VEC3","count":3}],"bufferViews":[{"buffer":0,"byteLength":36}],)"
      R"("buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,)"
      R"(AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})");
  box.json["nodes"] = {{{"children", {1, 2}}}, {{"children", {2}}}, {{"mesh", 0}, {"children", {0, 9}}}};
  write(folder / "ring.glb", box.bytes());
  write(folder / "away.gltf", box.document("%2e%2e/a.bin").dump());
}

Image picture(std::uint8_t alpha) {
  Image image{16, 16, {}};
  for (int i = 0; i < 256; ++i) {
    for (const int channel : {i, 255 - i, i / 2}) image.rgba.push_back(static_cast<std::uint8_t>(channel));
    image.rgba.push_back(alpha);
  }
  return image;
}

TileSetInfo info() {
  TileSetInfo info;
  info.name = "seed";
  info.body = "mars";
  info.grid.tile_px = 16;
  info.grid.projection = Projection::equal_area;
  info.format = ImageFormat::png;
  return info;
}

constexpr const char* kTms =
    "<TileMap><Title>t</Title><SRS>EPSG:4326</SRS><BoundingBox minx=\"-180\" miny=\"-90\" maxx=\"180\" maxy=\"90\"/>"
    "<TileFormat width=\"256\" height=\"256\" extension=\"jpg\"/><TileSets profile=\"geodetic\">"
    "<TileSet href=\"0\" units-per-pixel=\"1.40625\"/><TileSet href=\"1\" "
    "units-per-pixel=\"0.703125\"/></TileSets></TileMap>";

constexpr const char* kFields =
    "HTTP/1.1 103 Early Hints\r\nLink: </a>\r\n\r\nHTTP/1.1 200 OK\r\nDate: Sun, 06 Nov 1994 08:49:37 GMT\r\n"
    "Content-Type: image/jpeg\r\nETag: W/\"5f-1\"\r\nLast-Modified: Sunday, 06-Nov-94 08:49:37 GMT\r\n"
    "Cache-Control: public, max-age=60, private=\"a, b\"\r\nAge: 5\r\nExpires: 0\r\n\r\n";
constexpr const char* kRefusal =
    "HTTP/2 429\r\nCache-Control: no-store, no-cache\r\nRetry-After: Sun, 06 Nov 1994 08:50:37 GMT\r\n"
    "Retry-After: 120\r\n\r\n";

constexpr const char* kTables =
    "PRAGMA page_size = 512;"
    "CREATE TABLE gpkg_spatial_ref_sys (srs_id, organization, organization_coordsys_id);"
    "INSERT INTO gpkg_spatial_ref_sys VALUES (7, 'EPSG', 4326);"
    "CREATE TABLE gpkg_contents (table_name, data_type, identifier, description, min_x, min_y, max_x, max_y, srs_id);"
    "INSERT INTO gpkg_contents VALUES ('t', 'tiles', 'n', 'd', -180, -90, 180, 90, 7);"
    "CREATE TABLE gpkg_tile_matrix_set (table_name, srs_id, min_x, min_y, max_x, max_y);"
    "INSERT INTO gpkg_tile_matrix_set VALUES ('t', 7, -180, -90, 180, 90);"
    "CREATE TABLE gpkg_tile_matrix (table_name, zoom_level, matrix_width, matrix_height, tile_width, tile_height, "
    "pixel_x_size,"
    " pixel_y_size);"
    "INSERT INTO gpkg_tile_matrix VALUES ('t', 0, 2, 1, 16, 16, 11.25, 11.25), ('t', 1, 4, 2, 16, 16, 5.625, 5.625);"
    "CREATE TABLE t (zoom_level, tile_column, tile_row, tile_data);"
    "INSERT INTO t VALUES (0, 0, 0, x'FFD8FF'), (1, 3, 1, x'89'), (1, 0, 0, NULL);";

/// The tables as those of heights.
constexpr const char* kCoverage =
    "UPDATE gpkg_contents SET data_type = '2d-gridded-coverage';"
    "CREATE TABLE gpkg_2d_gridded_coverage_ancillary (tile_matrix_set_name, datatype, scale, offset, data_null, uom, "
    "grid_cell_encoding);"
    "INSERT INTO gpkg_2d_gridded_coverage_ancillary VALUES ('t', 'integer', 1.0, -32768, 5, 'm', 'grid-value-is-area');"
    "CREATE TABLE gpkg_2d_gridded_tile_ancillary (tpudt_name, tpudt_id, scale, offset);"
    "INSERT INTO gpkg_2d_gridded_tile_ancillary VALUES ('t', 1, 2.0, 1.0);"
    "ALTER TABLE t ADD COLUMN id; UPDATE t SET id = rowid;";

constexpr const char* kGdalWms =
    "<GDAL_WMS><Service "
    "name=\"TMS\"><ServerUrl>http://a/${z}/${x}/${y}.png</ServerUrl></Service><DataWindow><UpperLeftX>"
    "-180</UpperLeftX><UpperLeftY>90</UpperLeftY><LowerRightX>180</LowerRightX><LowerRightY>-90</"
    "LowerRightY><TileLevel>3"
    "</TileLevel><TileCountX>2</TileCountX><TileCountY>1</TileCountY><YOrigin>top</YOrigin></DataWindow><Projection>"
    "EPSG:4326</Projection><BlockSizeX>256</BlockSizeX><BlockSizeY>256</BlockSizeY><BandsCount>1</BandsCount><DataType>"
    "Int16</DataType><DataValues NoData=\"-1\"/><ZeroBlockHttpCodes>204,404</ZeroBlockHttpCodes></GDAL_WMS>";

constexpr const char* kWms =
    "<WMS_Capabilities "
    "version=\"1.3.0\"><Service><MaxWidth>2048</MaxWidth></Service><Capability><Request><GetMap><Format>"
    "image/png</Format><DCPType><HTTP><Get><OnlineResource xlink:href=\"http://a/?\"/></Get></HTTP></DCPType></GetMap>"
    "</Request><Layer><Name>l</Name><CRS>EPSG:4326</CRS><CRS>EPSG:3413</CRS><BoundingBox CRS=\"EPSG:3413\" minx=\"-1\" "
    "miny=\"-1\" maxx=\"1\" maxy=\"1\"/><MinScaleDenominator>9</MinScaleDenominator><Dimension name=\"time\" "
    "default=\"2004"
    "\">2003,2004</Dimension></Layer></Capability></WMS_Capabilities>";

constexpr const char* kCapabilities =
    "<Capabilities><Contents><Layer><Title>t</Title><Identifier>l</Identifier><Style isDefault=\"true\"><Identifier>d"
    "</Identifier></Style><Format>image/png</Format><WGS84BoundingBox><LowerCorner>-180 -90</LowerCorner><UpperCorner>"
    "180 "
    "90</UpperCorner></WGS84BoundingBox><Dimension><Identifier>Time</Identifier><Default>2004-08-01</Default><Value>"
    "2000-01-01/2004-08-01/P1D</Value></Dimension><TileMatrixSetLink><TileMatrixSet>s</TileMatrixSet>"
    "<TileMatrixSetLimits><TileMatrixLimits><TileMatrix>0</TileMatrix><MinTileRow>0</MinTileRow><MaxTileRow>0"
    "</MaxTileRow><MinTileCol>0</MinTileCol><MaxTileCol>1</MaxTileCol></TileMatrixLimits></TileMatrixSetLimits>"
    "</TileMatrixSetLink><ResourceURL format=\"image/png\" resourceType=\"tile\" template=\"http://a/{Style}/{Time}/"
    "{TileMatrixSet}/{TileMatrix}/{TileRow}/{TileCol}\"/></Layer><TileMatrixSet><Identifier>s</Identifier>"
    "<SupportedCRS>urn:ogc:def:crs:OGC:1.3:CRS84</SupportedCRS><TileMatrix><Identifier>0</Identifier><ScaleDenominator>"
    "223632905.6114871</ScaleDenominator><TopLeftCorner>-180 "
    "90</TopLeftCorner><TileWidth>512</TileWidth><TileHeight>512"
    "</TileHeight><MatrixWidth>2</MatrixWidth><MatrixHeight>1</MatrixHeight></TileMatrix></TileMatrixSet></Contents>"
    "</Capabilities>";

constexpr const char* kSource =
    "{\"url\": \"http://{s}.a/{z}/{x}/{-y}.png?key=1\", \"subdomains\": [\"a\"], \"headers\": [\"A: b\"], "
    "\"root_span_deg\": 360, \"tile_px\": 512, \"max_level\": 4, \"bounds\": [-180, -90, 180, 90], \"body\": \"mars\", "
    "\"tile_life_s\": 5, \"format\": \"png\"}";

constexpr const char* kMbtiles =
    "PRAGMA page_size = 512;"
    "CREATE TABLE metadata (name, value); INSERT INTO metadata VALUES ('profile', 'geodetic'), ('bounds', "
    "'-180,-90,180,90');"
    "CREATE TABLE tiles (zoom_level, tile_column, tile_row, tile_data);";

/// A tile of 16 × 16 floats.
void write_float_tiff(const fs::path& path) {
  fs::create_directories(path.parent_path());
  TIFF* tiff = TIFFOpen(path.c_str(), "w");
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, 16);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, 16);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 32);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
  TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_LZW);
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 5);
  for (std::uint32_t y = 0; y < 16; ++y) {
    std::vector<float> row(16, static_cast<float>(y) * 100.5F);
    TIFFWriteScanline(tiff, row.data(), y, 0);
  }
  TIFFClose(tiff);
}

/// One directory of a seed for fuzz_raster: 48 × 48 pixels, or 24 × 24 if it is reduced.
struct RasterSeed {
  int bits = 8;
  int format = SAMPLEFORMAT_UINT;
  int samples = 1;
  int photometric = PHOTOMETRIC_MINISBLACK;
  int planes = PLANARCONFIG_CONTIG;
  int compression = COMPRESSION_ADOBE_DEFLATE;
  bool tiled = true;
  int kind = 0;  ///< FILETYPE_REDUCEDIMAGE, FILETYPE_MASK
};

void write_directory(TIFF* tiff, const RasterSeed& seed) {
  const int side = (seed.kind & FILETYPE_REDUCEDIMAGE) != 0 ? 24 : 48;
  const auto set = [tiff](std::uint32_t tag, int value) { TIFFSetField(tiff, tag, value); };
  set(TIFFTAG_SUBFILETYPE, seed.kind);
  set(TIFFTAG_IMAGEWIDTH, side);
  set(TIFFTAG_IMAGELENGTH, side);
  set(TIFFTAG_BITSPERSAMPLE, seed.bits);
  set(TIFFTAG_SAMPLEFORMAT, seed.format);
  set(TIFFTAG_SAMPLESPERPIXEL, seed.samples);
  set(TIFFTAG_PHOTOMETRIC, seed.photometric);
  set(TIFFTAG_PLANARCONFIG, seed.planes);
  set(TIFFTAG_COMPRESSION, seed.compression);
  if (seed.tiled) set(TIFFTAG_TILEWIDTH, 16);
  if (seed.tiled) set(TIFFTAG_TILELENGTH, 16);
  if (!seed.tiled) set(TIFFTAG_ROWSPERSTRIP, 10);
  if (seed.compression == COMPRESSION_JPEG) set(TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
  std::vector<std::uint8_t> block(static_cast<std::size_t>(seed.tiled ? TIFFTileSize(tiff) : TIFFStripSize(tiff)));
  for (std::size_t i = 0; i < block.size(); ++i) block[i] = static_cast<std::uint8_t>(i * i / 7);
  const std::uint32_t blocks = seed.tiled ? TIFFNumberOfTiles(tiff) : TIFFNumberOfStrips(tiff);
  for (std::uint32_t i = 0; i < blocks; ++i) {
    const auto bytes = static_cast<tmsize_t>(block.size());
    seed.tiled ? TIFFWriteEncodedTile(tiff, i, block.data(), bytes)
               : TIFFWriteEncodedStrip(tiff, i, block.data(), bytes);
  }
  TIFFWriteDirectory(tiff);
}

void write_raster(const fs::path& path, const char* mode, const std::vector<RasterSeed>& directories) {
  fs::create_directories(path.parent_path());
  TIFF* tiff = TIFFOpen(path.c_str(), mode);
  for (const RasterSeed& seed : directories) write_directory(tiff, seed);
  TIFFClose(tiff);
}

void write_rasters(const fs::path& folder) {
  const RasterSeed rgb{.samples = 3, .photometric = PHOTOMETRIC_RGB};
  RasterSeed small = rgb, mask{.bits = 1, .photometric = PHOTOMETRIC_MASK, .kind = FILETYPE_MASK};
  small.kind = FILETYPE_REDUCEDIMAGE;
  write_raster(folder / "rgb.tif", "w", {rgb, small, mask});
  write_raster(folder / "planes.tif", "w8", {{.bits = 16, .samples = 2, .planes = PLANARCONFIG_SEPARATE}});
  write_raster(folder / "float.tif", "wb", {{.bits = 32, .format = SAMPLEFORMAT_IEEEFP, .tiled = false}});
  write_raster(folder / "int.tif", "w", {{.bits = 16, .format = SAMPLEFORMAT_INT, .compression = COMPRESSION_LZW}});
  write_raster(folder / "jpeg.tif", "w",
               {{.samples = 3, .photometric = PHOTOMETRIC_YCBCR, .compression = COMPRESSION_JPEG}});
  for (const int scheme : {COMPRESSION_ZSTD, COMPRESSION_WEBP, COMPRESSION_LERC, COMPRESSION_PACKBITS}) {
    RasterSeed other = rgb;
    other.compression = scheme;
    if (TIFFIsCODECConfigured(static_cast<std::uint16_t>(scheme)) == 0) continue;
    write_raster(folder / (std::to_string(scheme) + ".tif"), "w", {other});
  }
}

/// The same files as a server would send them, whole (0) and with faults; see fuzz_remote_tiff.cpp.
void write_remote_tiffs(const fs::path& from, const fs::path& to) {
  for (const auto& entry : fs::directory_iterator(from)) {
    std::ifstream file(entry.path(), std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    for (const char fault : {'\0', '\5'}) {
      write(to / (entry.path().filename().string() + (fault == 0 ? "" : ".faults")), fault + bytes);
    }
  }
}

/// A tile as SQL writes a blob.
std::string blob_of(const std::vector<std::byte>& bytes) {
  constexpr const char* kDigits = "0123456789ABCDEF";
  std::string text = "x'";
  for (const std::byte byte : bytes) {
    text += kDigits[std::to_integer<int>(byte) >> 4];
    text += kDigits[std::to_integer<int>(byte) & 15];
  }
  return text + "'";
}

bool write_database(const fs::path& path, const std::string& sql) {
  fs::create_directories(path.parent_path());
  fs::remove(path);
  sqlite3* database = nullptr;
  const bool written = sqlite3_open(path.c_str(), &database) == SQLITE_OK &&
                       sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK;
  sqlite3_close(database);
  return written;
}

/// One tile, in a leaf directory, nothing compressed.
void write_pmtiles(const fs::path& path) {
  const auto tile = *encode_png(picture(255));
  std::string bytes = "PMTiles\3";
  const auto number = [&bytes](std::uint64_t value, int length) {
    for (int i = 0; i < length; ++i, value >>= 8) bytes += static_cast<char>(value & 255);
  };
  constexpr std::uint64_t kRoot = 127, kDirectory = 6, kMetadata = 2;
  number(kRoot, 8), number(kDirectory, 8);
  number(kRoot + kDirectory, 8), number(kMetadata, 8);
  number(kRoot + kDirectory + kMetadata, 8), number(kDirectory, 8);
  number(kRoot + kDirectory + kMetadata + kDirectory, 8), number(tile.size(), 8);
  number(1, 8), number(1, 8), number(1, 8);
  for (const int flag : {1, 1, 1, 2, 0, 0}) number(static_cast<std::uint64_t>(flag), 1);
  number(0, 25);
  const auto directory = [&](std::uint64_t length, char run) {
    bytes += {1, 0, run, static_cast<char>((length & 127) | 128), static_cast<char>(length >> 7), 1};
  };
  directory(kDirectory, 0);
  bytes += "{}";
  directory(tile.size(), 1);
  bytes.append(reinterpret_cast<const char*>(tile.data()), tile.size());
  write(path, bytes);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: make_fuzz_seeds FOLDER\n", stderr);
    return 2;
  }
  const fs::path folder = argv[1];
  write(folder / "image/a.jpg", *encode_jpeg(picture(255), 80));
  write(folder / "image/a.png", *encode_png(picture(255)));
  write(folder / "image/b.png", *encode_png(picture(100)));
  write(folder / "image/a.webp", *encode_webp(picture(255), 80));
  write(folder / "image/b.webp", *encode_webp(picture(100), 80));
  write_pmtiles(folder / "pmtiles/a.pmtiles");
  std::vector<std::uint16_t> heights;
  for (int i = 0; i < 256; ++i) heights.push_back(static_cast<std::uint16_t>(i * 257));
  write(folder / "heights/a.png", *encode_gray16_png(heights, 16));
  write_float_tiff(folder / "heights/a.tif");
  write_rasters(folder / "raster");
  write_remote_tiffs(folder / "raster", folder / "remote_tiff");
  write(folder / "http_headers/content", kFields);
  write(folder / "http_headers/refusal", kRefusal);
  write(folder / "http_headers/header", "X-Key: value");
  write(folder / "http_headers/address", "https://user:word@tiles.example:8443/1/2/3.jpg?key=value#a");
  write(folder / "tileset_json/a.json", to_tileset_json(info()));
  write(folder / "tms_xml/a.xml", kTms);
  write(folder / "capabilities/a.xml", kCapabilities);
  write(folder / "gdal_wms" / "a.xml", kGdalWms);
  write(folder / "gdal_wms" / "b.xml", kWms);
  write(folder / "source_json/a.json", kSource);
  const std::string mbtiles =
      std::string(kMbtiles) + "INSERT INTO tiles VALUES (1, 3, 1, " + blob_of(*encode_jpeg(picture(255), 50)) + ");";
  write(folder / "geojson/a.geojson",
        R"({"type":"Feature","properties":{"name":"a"},"geometry":{"type":"Polygon","coordinates":[[[170,10],)"
        R"([-170,10],[-170,80],[170,10]]]}})");
  write(
      folder / "geojson_objects/a.geojson",
      R"({"type":"FeatureCollection","metadata":{"url":"https://earthquake.usgs.gov/"},"features":[{"type":"Feature",)"
      R"("id":"q","properties":{"mag":3,"stroke":"#f00","fill-opacity":0.5,"radius_m":5},"geometry":{"type":"Point",)"
      R"("coordinates":[170,10,35]}},{"type":"Feature","properties":null,"geometry":{"type":"GeometryCollection",)"
      R"("geometries":[{"type":"MultiLineString","coordinates":[[[170,10],[-170,80]]]},{"type":"Polygon",)"
      R"("coordinates":[[[170,10],[-170,10],[0,80],[170,10]],[[1,2],[2,2],[2,3],[1,2]]]}]}}]})");
  write(folder / "geojson_objects/simplestyle.geojson",
        R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{"marker-color":"#7e7e7e",)"
        R"("marker-size":"large","marker-symbol":"a","title":"t","description":"d"},"geometry":{"type":"Point",)"
        R"("coordinates":[8,46]}},{"type":"Feature","properties":{"stroke":"555","stroke-width":2,"stroke-opacity":1,)"
        R"("fill":"#555555","fill-opacity":0.6,"marker-symbol":7},"geometry":{"type":"Polygon",)"
        R"("coordinates":[[[1,2],[2,2],[2,3],[1,2]]]}}]})");
  write_models(folder / "gltf");
  const std::string ours =
      std::string(kTables) +
      "CREATE TABLE terrella_tileset (key, value); INSERT INTO terrella_tileset VALUES "
      "('tileset', '{\"root_span_deg\": 180, \"tile_px\": 16, \"max_level\": 1, \"format\": \"png\"}');";
  const bool written = write_database(folder / "geopackage/foreign.gpkg", kTables) &&
                       write_database(folder / "geopackage/ours.gpkg", ours) &&
                       write_database(folder / "geopackage/heights.gpkg", std::string(kTables) + kCoverage) &&
                       write_database(folder / "mbtiles/a.mbtiles", mbtiles);
  return written ? 0 : 1;
}
