#include "apps/viewer/tools/measure_export.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "apps/viewer/draw/geojson_shape.h"
#include "geo/measure.h"

namespace terrella {
namespace {

using OrderedJson = nlohmann::ordered_json;

double rounded(double value, double per_unit) { return std::round(value * per_unit) / per_unit; }

OrderedJson feature(const char* type, OrderedJson coordinates, OrderedJson properties) {
  return {{"type", "Feature"},
          {"properties", std::move(properties)},
          {"geometry", {{"type", type}, {"coordinates", std::move(coordinates)}}}};
}

std::vector<double> segments_m(const Ellipsoid& ellipsoid, std::span<const Geodetic> places) {
  std::vector<double> lengths;
  for (std::size_t k = 1; k < places.size(); ++k) {
    lengths.push_back(rounded(geodesic_m(ellipsoid, places[k - 1], places[k]), 1e3));
  }
  return lengths;
}

}  // namespace

std::string measurement_text(const Ellipsoid& ellipsoid, std::span<const Geodetic> places) {
  std::string text;
  const std::vector<double> lengths = segments_m(ellipsoid, places);
  for (std::size_t k = 0; k < places.size(); ++k) {
    text += fmt::format("{:.7f}, {:.7f}", places[k].lat.deg(), places[k].lon.deg());
    text += k == 0 ? "\n" : fmt::format("\t{:.3f} m\n", lengths[k - 1]);
  }
  if (places.size() > 1) text += fmt::format("Length\t{:.3f} m\n", path_m(ellipsoid, places));
  if (places.size() > 2) text += fmt::format("Area\t{:.1f} m²\n", polygon_measure(ellipsoid, places).area_m2);
  return text;
}

std::string measurement_geojson(const Ellipsoid& ellipsoid, std::span<const Geodetic> places) {
  const auto positions = line_positions(places);
  OrderedJson features = OrderedJson::array();
  if (places.size() == 1) features.push_back(feature("Point", positions[0], OrderedJson::object()));
  if (places.size() > 1) {
    features.push_back(feature("LineString", positions,
                               {{"length_m", rounded(path_m(ellipsoid, places), 1e3)},
                                {"segment_lengths_m", segments_m(ellipsoid, places)},
                                {"stroke", "#ffd640"},
                                {"stroke-width", 3}}));
  }
  if (places.size() > 2) {
    const PolygonMeasure measure = polygon_measure(ellipsoid, places);
    features.push_back(feature("Polygon", OrderedJson::array({ring_positions(places)}),
                               {{"area_m2", rounded(measure.area_m2, 10.0)},
                                {"perimeter_m", rounded(measure.perimeter_m, 1e3)},
                                {"fill", "#ffd640"},
                                {"fill-opacity", 0.2},
                                {"stroke-opacity", 0}}));
  }
  return OrderedJson{{"type", "FeatureCollection"}, {"features", std::move(features)}}.dump(2) + "\n";
}

}  // namespace terrella
