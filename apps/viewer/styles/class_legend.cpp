#include "apps/viewer/styles/class_legend.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace terrella {
namespace {

constexpr double kMostPlain = 1e15, kLeastPlain = 1e-9;  // other numbers have a power of ten
constexpr int kMostDecimals = 10;

/// Width of the narrowest class between two stops; the size of a single stop.
double least_gap(std::span<const double> stops) {
  if (stops.size() == 1) return stops.front() != 0.0 ? std::abs(stops.front()) : 1.0;
  double gap = std::numeric_limits<double>::infinity();
  for (std::size_t k = 1; k < stops.size(); ++k) gap = std::min(gap, stops[k] - stops[k - 1]);
  return gap;
}

/// True if all stops have at most as many decimals.
bool are_exact(std::span<const double> stops, int decimals, double gap) {
  const double power = std::pow(10.0, decimals);
  return std::ranges::all_of(
      stops, [&](double stop) { return std::abs(std::round(stop * power) / power - stop) < 1e-6 * gap; });
}

/// The text of a category, or the texts of several.
std::string category_text(const nlohmann::json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_array()) return value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  std::string all;
  for (const nlohmann::json& one : value) all += (all.empty() ? "" : ", ") + category_text(one);
  return all;
}

std::vector<std::string> range_texts(const ClassStyle& classes) {
  const std::vector<std::string> stops = stop_texts(classes.stops);
  if (stops.empty()) return {"all values"};
  std::vector<std::string> texts{"under " + stops.front()};
  texts.reserve(stops.size() + 1);
  for (std::size_t k = 1; k < stops.size(); ++k) texts.push_back(stops[k - 1] + " to " + stops[k]);
  texts.push_back(stops.back() + " and over");
  return texts;
}

std::vector<std::string> category_texts(const ClassStyle& classes) {
  std::vector<std::string> texts;
  texts.reserve(classes.categories.size());
  for (const std::string& value : classes.categories)
    texts.push_back(category_text(nlohmann::json::parse(value, nullptr, false)));
  return texts;
}

Rgba8 opaque(const ObjectColor& color) { return {color.red, color.green, color.blue}; }

}  // namespace

std::vector<std::string> stop_texts(std::span<const double> stops) {
  std::vector<std::string> texts;
  if (stops.empty()) return texts;
  const double gap = least_gap(stops);
  const double greatest = std::max(std::abs(stops.front()), std::abs(stops.back()));
  const int most = std::clamp(static_cast<int>(std::ceil(-std::log10(gap))) + 1, 0, kMostDecimals);
  int decimals = 0;
  while (decimals < most && !are_exact(stops, decimals, gap)) ++decimals;
  const bool plain = greatest < kMostPlain && gap > kLeastPlain;
  texts.reserve(stops.size());
  for (const double stop : stops) {
    texts.push_back(plain ? fmt::format("{:.{}f}", stop, decimals) : fmt::format("{:.6g}", stop));
  }
  return texts;
}

LegendItem class_legend(const std::string& layer, const ClassStyle& classes) {
  LegendItem item{.title = fmt::format("{} ({})", classes.field, layer), .unit = {}, .look = {}};
  const std::vector<std::string> texts = classes.categories.empty() ? range_texts(classes) : category_texts(classes);
  item.classes.reserve(classes.colors.size() + 1);
  for (std::size_t k = 0; k < classes.colors.size(); ++k) item.classes.push_back({opaque(classes.colors[k]), texts[k]});
  if (classes.rest) item.classes.push_back({opaque(*classes.rest), classes.categories.empty() ? "no value" : "other"});
  return item;
}

}  // namespace terrella
