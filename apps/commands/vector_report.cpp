#include "apps/commands/vector_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/process/console.h"

namespace terrella {
namespace {

using Json = nlohmann::ordered_json;

std::string system_text(const VectorLayerFacts& layer) {
  if (layer.crs.empty()) return "(not said)";
  const std::string name = one_line(layer.crs);
  return layer.crs_code.empty() ? name : fmt::format("{} ({})", name, one_line(layer.crs_code));
}

std::string layer_text(const VectorLayerFacts& layer) {
  std::string text = fmt::format("layer        {}\n", one_line(layer.name));
  text += fmt::format("  features   {}, {}\n", layer.features, one_line(layer.geometry));
  text += fmt::format("  system     {}\n", system_text(layer));
  if (layer.bounds) {
    const auto& [west, south, east, north] = *layer.bounds;
    text += fmt::format("  corners    {:.12g} to {:.12g}, {:.12g} to {:.12g} in units of the system\n", west, east,
                        south, north);
  }
  std::string fields;
  for (const auto& [name, type] : layer.fields) {
    fields += fmt::format("{}{} ({})", fields.empty() ? "" : ", ", one_line(name), one_line(type));
  }
  return text + fmt::format("  fields     {}\n", fields.empty() ? "(none)" : fields);
}

Json layer_json(const VectorLayerFacts& layer) {
  Json fields = Json::array();
  for (const auto& [name, type] : layer.fields) fields.push_back({{"name", name}, {"type", type}});
  Json json{{"name", layer.name}, {"features", layer.features}, {"geometry", layer.geometry}};
  json["crs"] = layer.crs.empty() ? Json() : Json(layer.crs);
  json["crs_code"] = layer.crs_code.empty() ? Json() : Json(layer.crs_code);
  json["bounds"] = layer.bounds ? Json(*layer.bounds) : Json();
  json["fields"] = std::move(fields);
  return json;
}

}  // namespace

std::string vector_report(const std::filesystem::path& path, const VectorFacts& facts, bool json) {
  if (json) {
    Json layers = Json::array();
    for (const VectorLayerFacts& layer : facts.layers) layers.push_back(layer_json(layer));
    const Json all{{"path", path.string()},      {"kind", "vector"},
                   {"format", facts.format},     {"network_links", facts.has_links},
                   {"pictures", facts.pictures}, {"layers", std::move(layers)}};
    return all.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  }
  std::string text = fmt::format("vector file  {}\nformat       {}\n", one_line(path.string()), facts.format);
  if (facts.has_links) text += "links        its NetworkLink elements are not followed\n";
  if (facts.pictures > 0) text += fmt::format("pictures     {}, as a layer of imagery\n", facts.pictures);
  for (const VectorLayerFacts& layer : facts.layers) text += layer_text(layer);
  return text;
}

}  // namespace terrella
