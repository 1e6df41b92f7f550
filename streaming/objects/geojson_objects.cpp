#include "streaming/objects/geojson_objects.h"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "streaming/json_text.h"
#include "streaming/objects/feature_taker.h"
#include "streaming/objects/quake_catalogue.h"
#include "streaming/preload/geojson_text.h"

namespace terrella {
namespace {

using nlohmann::json;

/// Takes each feature out of the document as soon as it is complete. No more than one feature is held as JSON.
class DocumentTaker {
 public:
  DocumentTaker(const std::string& where, const std::filesystem::path& folder, ObjectId first, ObjectFile& file,
                const FeatureStyle& style)
      : features_(where, folder, first, file), file_(file) {
    features_.set_style(style);
  }

  /// For JsonBuilder: keeps everything except features.
  bool keep(std::size_t depth, const std::string& member, const json& value) {
    if (depth == 1 && member == "attribution") credit(value);
    if (depth == 1 && member == "metadata" && is_quake_catalogue(value)) features_.expect_quakes();
    if (depth != 2 || member != "features") return true;
    features_.take(value, count_++);
    return false;
  }

  void take(const json& feature) { features_.take(feature, 0); }
  /// Takes a bare geometry: a feature without properties.
  void take_geometry(const json& geometry) { take({{"type", "Feature"}, {"geometry", geometry}}); }
  void complain_of(const std::string& what) { features_.complain_of(what); }
  [[nodiscard]] std::size_t count() const { return count_; }

 private:
  void credit(const json& text) {
    if (!text.is_string()) return complain_of("its \"attribution\" is not a text; it is left out");
    file_.attribution = text.get<std::string>();
  }

  FeatureTaker features_;
  ObjectFile& file_;
  std::size_t count_ = 0;
};

/// Checks the rest of a document after its features were taken.
Status take_rest(const json& document, DocumentTaker& taker) {
  const std::string type = geojson_type(document);
  if (type.empty()) return Error{"JSON, but no GeoJSON: it has no \"type\"; see RFC 7946"};
  if (type == "FeatureCollection") {
    const auto features = document.find("features");
    if (features == document.end() || !features->is_array()) return Error{"a FeatureCollection without \"features\""};
    return Done{};
  }
  if (type == "Feature") return taker.take(document), Done{};
  taker.take_geometry(document);
  return Done{};
}

}  // namespace

Result<ObjectFile> parse_geojson_objects(std::istream& text, const std::string& where,
                                         const std::filesystem::path& folder, ObjectId first,
                                         const FeatureStyle& style) {
  ObjectFile file;
  DocumentTaker taker(where, folder, first, file, style);
  const auto broken = [&](const std::string& what) -> Result<ObjectFile> {
    if (file.scene.empty()) return Error{fmt::format("{}: {}", where, what)};
    taker.complain_of(fmt::format("{}; the {} features before are drawn", what, taker.count()));
    return std::move(file);
  };
  const Result<json> document = parse_json(
      text, {.depth = kJsonLimits.depth, .pieces = kMaxFeatureValues},
      [&taker](std::size_t depth, const std::string& member, json& value) { return taker.keep(depth, member, value); });
  if (!document) return broken(document.error().message + "; a GeoJSON file (RFC 7946) is needed");
  if (const Status rest = take_rest(*document, taker); !rest) return broken(rest.error().message);
  return file;
}

Result<ObjectFile> read_geojson_objects(const std::filesystem::path& path, ObjectId first, const FeatureStyle& style) {
  std::error_code problem;
  const auto bytes = std::filesystem::file_size(path, problem);
  if (problem) return Error{fmt::format("{}: {}", path.string(), problem.message())};
  if (bytes > kMaxObjectFileBytes) {
    return Error{fmt::format("{}: {} bytes are more than the {} that are read; divide it", path.string(), bytes,
                             kMaxObjectFileBytes)};
  }
  std::ifstream text(path, std::ios::binary);
  if (!text) return Error{fmt::format("{}: it cannot be opened", path.string())};
  return parse_geojson_objects(text, path.string(), path.has_parent_path() ? path.parent_path() : ".", first, style);
}

}  // namespace terrella
