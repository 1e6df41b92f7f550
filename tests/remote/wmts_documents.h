#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

namespace terrella::test {

/// A tile matrix set to be written as a capabilities document has it.
struct MatrixSetText {
  std::string name{};
  std::string crs = "urn:ogc:def:crs:OGC:1.3:CRS84";
  double denominator = 0.0;  ///< denominator of the first matrix
  int tile_px = 256;
  std::vector<std::pair<int, int>> sizes{};
  std::string corner = "-180 90";
  std::string prefix{};  ///< prefix of the identifiers of the matrices
  double ratio = 2.0;
};

inline std::string text_of(const MatrixSetText& set) {
  std::string text = fmt::format(
      "<TileMatrixSet><ows:Identifier>{}</ows:Identifier><ows:SupportedCRS>{}</ows:SupportedCRS>", set.name, set.crs);
  for (std::size_t i = 0; i < set.sizes.size(); ++i) {
    text += fmt::format(
        "<TileMatrix><ows:Identifier>{}{}</ows:Identifier><ScaleDenominator>{:.16g}</ScaleDenominator>"
        "<TopLeftCorner>{}</TopLeftCorner><TileWidth>{}</TileWidth><TileHeight>{}</TileHeight>"
        "<MatrixWidth>{}</MatrixWidth><MatrixHeight>{}</MatrixHeight></TileMatrix>",
        set.prefix, i, set.denominator / std::pow(set.ratio, static_cast<double>(i)), set.corner, set.tile_px,
        set.tile_px, set.sizes[i].first, set.sizes[i].second);
  }
  return text + "</TileMatrixSet>";
}

constexpr double kGibsDenominator = 223632905.6114871;
constexpr double kCrs84QuadDenominator = 279541132.0143589;

/// The sets of NASA GIBS' EPSG:4326 service differ in how many of these matrices they have.
inline MatrixSetText gibs_set(const std::string& name, std::size_t levels) {
  MatrixSetText set{.name = name, .denominator = kGibsDenominator, .tile_px = 512};
  set.sizes = {{2, 1}, {3, 2}};
  for (int columns = 5; set.sizes.size() < levels; columns *= 2) set.sizes.emplace_back(columns, (columns + 1) / 2);
  set.sizes.resize(levels);
  return set;
}

/// Two columns and one row at level 0, and twice as many each way from level to level.
inline std::vector<std::pair<int, int>> quads(int columns, int rows, int levels) {
  std::vector<std::pair<int, int>> sizes;
  for (int i = 0; i < levels; ++i) sizes.emplace_back(columns << i, rows << i);
  return sizes;
}

struct LayerText {
  std::string name = "layer";
  std::vector<std::string> matrix_sets{};
  std::string more{};  ///< elements between the title and the links
  std::string resources =
      R"(<ResourceURL format="image/jpeg" resourceType="tile" template="https://example.com/wmts/layer/{Style}/{TileMatrixSet}/{TileMatrix}/{TileRow}/{TileCol}.jpg"/>)";
  std::string limits{};
};

inline std::string text_of(const LayerText& layer) {
  std::string text = fmt::format(
      "<Layer><ows:Title>About {0}</ows:Title>{1}<ows:Identifier>{0}</ows:Identifier>"
      "<Style isDefault=\"true\"><ows:Identifier>default</ows:Identifier></Style>"
      "<Format>image/jpeg</Format>",
      layer.name, layer.more);
  for (const std::string& set : layer.matrix_sets) {
    text +=
        fmt::format("<TileMatrixSetLink><TileMatrixSet>{}</TileMatrixSet>{}</TileMatrixSetLink>", set, layer.limits);
  }
  return text + layer.resources + "</Layer>";
}

inline std::string capabilities(const std::vector<LayerText>& layers, const std::vector<MatrixSetText>& sets,
                                const std::string& operations = {}) {
  std::string text =
      R"(<?xml version="1.0" encoding="UTF-8"?>
<Capabilities xmlns="http://www.opengis.net/wmts/1.0" xmlns:ows="http://www.opengis.net/ows/1.1" xmlns:xlink="http://www.w3.org/1999/xlink" version="1.0.0">
<ows:ServiceProvider><ows:ProviderName>Provider</ows:ProviderName></ows:ServiceProvider>)" +
      operations + "<Contents>";
  for (const LayerText& layer : layers) text += text_of(layer);
  for (const MatrixSetText& set : sets) text += text_of(set);
  return text + "</Contents></Capabilities>";
}

/// A document of the form of GIBS': several sets, times, one layer in each format.
inline std::string gibs_document() {
  const std::string box =
      "<ows:WGS84BoundingBox crs=\"urn:ogc:def:crs:OGC:2:84\"><ows:LowerCorner>-180 -90</ows:LowerCorner>"
      "<ows:UpperCorner>180 90</ows:UpperCorner></ows:WGS84BoundingBox>";
  const std::string time =
      "<Dimension><ows:Identifier>Time</ows:Identifier><ows:UOM>ISO8601</ows:UOM><Default>2024-05-20</Default>"
      "<Current>false</Current><Value>2000-02-24/2020-12-31/P1D</Value><Value>2021-02-01/2024-05-20/P1D</Value>"
      "</Dimension>";
  const auto resource = [](const std::string& layer, const std::string& time_part, const std::string& ending) {
    return fmt::format(R"(<ResourceURL format="image/{}" resourceType="tile" template="https://example.com/wmts/)"
                       R"(epsg4326/best/{}/default/{}{{TileMatrixSet}}/{{TileMatrix}}/{{TileRow}}/{{TileCol}}.{}"/>)",
                       ending, layer, time_part, ending);
  };
  return capabilities(
      {{.name = "Still", .matrix_sets = {"500m"}, .more = box, .resources = resource("Still", "", "jpeg")},
       {.name = "Daily",
        .matrix_sets = {"250m"},
        .more = box + time,
        .resources = resource("Daily", "{Time}/", "png")}},
      {gibs_set("16km", 3), gibs_set("500m", 8), gibs_set("250m", 9), gibs_set("15.625m", 13)});
}

}  // namespace terrella::test
