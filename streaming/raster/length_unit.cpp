#include "streaming/raster/length_unit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <utility>

namespace terrella {
namespace {

constexpr double kFoot_m = 0.3048;
constexpr double kSurveyFoot_m = 1200.0 / 3937.0;
constexpr double kFathom_m = 1.8288;

constexpr std::pair<std::string_view, double> kUnits[] = {
    {"", 1.0},
    {"m", 1.0},
    {"metre", 1.0},
    {"metres", 1.0},
    {"meter", 1.0},
    {"meters", 1.0},
    {"mm", 1e-3},
    {"millimetre", 1e-3},
    {"millimeter", 1e-3},
    {"cm", 1e-2},
    {"centimetre", 1e-2},
    {"centimeter", 1e-2},
    {"dm", 1e-1},
    {"decimetre", 1e-1},
    {"decimeter", 1e-1},
    {"km", 1e3},
    {"kilometre", 1e3},
    {"kilometer", 1e3},
    {"ft", kFoot_m},
    {"foot", kFoot_m},
    {"feet", kFoot_m},
    {"international foot", kFoot_m},
    {"us-ft", kSurveyFoot_m},
    {"ftus", kSurveyFoot_m},
    {"us survey foot", kSurveyFoot_m},
    {"us_survey_foot", kSurveyFoot_m},
    {"foot_us", kSurveyFoot_m},
    {"sfeet", kSurveyFoot_m},
    {"fathom", kFathom_m},
};

}  // namespace

std::optional<double> metres_of_unit(std::string_view unit) {
  std::string name(unit);
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
  const auto* const known = std::ranges::find(kUnits, name, &std::pair<std::string_view, double>::first);
  if (known == std::end(kUnits)) return {};
  return known->second;
}

std::string no_length(std::string_view unit) {
  return fmt::format(
      "its numbers are in \"{}\", which is no unit of length, so they are no heights; show them as a layer of numbers, "
      "or "
      "write the right unit into a copy (gdal_edit.py -units m)",
      unit);
}

}  // namespace terrella
