#include "streaming/georeference/side_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <pugixml.hpp>
#include <set>
#include <sstream>
#include <string_view>

#include "base/number.h"
#include "streaming/file_bytes.h"
#include "streaming/georeference/crs.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostWorldFileBytes = 64U << 10;
constexpr std::size_t kMostCrsBytes = 1U << 20;
constexpr std::size_t kMostAuxBytes = 64U << 20;

Error damaged(const fs::path& file, std::string_view why) {
  return Error{fmt::format("{} beside it {}; correct it, or move it away if it does not belong to the picture",
                           file.filename().string(), why)};
}

/// Text of a file; none if there is no such regular file.
Result<std::optional<std::string>> side_text(const fs::path& file, std::size_t max_bytes) {
  std::error_code failed;
  if (!fs::is_regular_file(file, failed)) return std::optional<std::string>{};
  const auto bytes = read_file(file, max_bytes);
  if (!bytes) return damaged(file, fmt::format("cannot be read ({})", bytes.error().message));
  return std::optional(std::string(as_text(*bytes)));
}

/// First six words as numbers; none if one of them is no number.
std::optional<std::array<double, 6>> six_numbers(std::string text) {
  std::ranges::replace(text, ',', ' ');
  std::istringstream words(text);
  std::array<double, 6> values{};
  for (double& value : values) {
    std::string word;
    words >> word;
    const auto number = read_number(word);
    if (!number) return {};
    value = *number;
  }
  return values;
}

std::string lower_case(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}
std::string upper_case(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

/// Existing files with an ending in different cases. Each file is listed once, because some file systems ignore case.
std::vector<fs::path> found_with_ending(const fs::path& picture, const std::string& ending) {
  std::string first_upper = ending;
  first_upper[0] = upper_case(ending)[0];
  std::vector<fs::path> found;
  for (const std::string& spelled : {ending, upper_case(ending), first_upper}) {
    fs::path file = picture;
    file.replace_extension("." + spelled);
    std::error_code failed;
    const auto same = [&file](const fs::path& other) {
      std::error_code ignored;
      return fs::equivalent(file, other, ignored);
    };
    if (fs::is_regular_file(file, failed) && std::ranges::none_of(found, same)) found.push_back(file);
  }
  return found;
}

std::set<std::string> world_file_endings(const fs::path& picture) {
  std::set<std::string> endings{"wld"};
  const std::string extension = lower_case(picture.extension().string());
  if (extension.size() < 3) return endings;
  endings.insert(extension.substr(1) + "w");
  endings.insert({extension[1], extension.back(), 'w'});
  return endings;
}

Result<std::optional<SideClaim>> read_world_file(const fs::path& file) {
  const auto text = side_text(file, kMostWorldFileBytes);
  if (!text) return text.error();
  if (!*text) return std::optional<SideClaim>{};
  const auto numbers = six_numbers(**text);
  if (!numbers) return damaged(file, "is named as its world file, and does not begin with six numbers");
  const auto& [x_per_column, y_per_column, x_per_row, y_per_row, x, y] = *numbers;
  const Affine centre{x, x_per_column, x_per_row, y, y_per_column, y_per_row};
  return std::optional(
      SideClaim{.file = file, .transform = centre.from_centre(), .crs = {}, .has_control_points = false});
}

Result<std::optional<SideClaim>> read_aux_xml(const fs::path& picture) {
  const fs::path file = picture.string() + ".aux.xml";
  const auto text = side_text(file, kMostAuxBytes);
  if (!text) return text.error();
  if (!*text) return std::optional<SideClaim>{};
  pugi::xml_document document;
  if (!document.load_buffer((*text)->data(), (*text)->size())) return damaged(file, "is not XML");
  const pugi::xml_node root = document.child("PAMDataset");
  const std::string crs = root.child_value("SRS");
  SideClaim claim{.file = file, .transform = {}, .crs = wkt_only(crs), .has_control_points = false};
  if (claim.crs.empty() && !crs.empty()) return damaged(file, "holds a coordinate system that is no WKT");
  claim.has_control_points = !root.child("GCPList").empty() || !root.select_node(".//SourceGCPs").node().empty();
  if (const pugi::xml_node transform = root.child("GeoTransform")) {
    const auto numbers = six_numbers(transform.child_value());
    if (!numbers) return damaged(file, "has a GeoTransform that is not six numbers");
    const auto& [x, x_per_column, x_per_row, y, y_per_column, y_per_row] = *numbers;
    claim.transform = Affine{x, x_per_column, x_per_row, y, y_per_column, y_per_row};
  }
  if (claim.crs.empty() && !claim.transform && !claim.has_control_points) return std::optional<SideClaim>{};
  return std::optional(std::move(claim));
}

Result<std::optional<SideClaim>> read_prj(const fs::path& picture) {
  for (const fs::path& file : found_with_ending(picture, "prj")) {
    const auto text = side_text(file, kMostCrsBytes);
    if (!text) return text.error();
    if (!*text) continue;
    const std::string crs = wkt_only(**text);
    if (crs.empty()) return damaged(file, "holds no coordinate system as WKT");
    return std::optional(SideClaim{.file = file, .transform = {}, .crs = crs, .has_control_points = false});
  }
  return std::optional<SideClaim>{};
}

}  // namespace

Result<std::vector<SideClaim>> read_side_files(const fs::path& picture) {
  std::vector<SideClaim> claims;
  for (const std::string& ending : world_file_endings(picture)) {
    for (const fs::path& file : found_with_ending(picture, ending)) {
      auto claim = read_world_file(file);
      if (!claim) return claim.error();
      if (*claim) claims.push_back(**std::move(claim));
    }
  }
  if (!claims.empty()) {
    auto crs = read_prj(picture);
    if (!crs) return crs.error();
    if (*crs) claims.push_back(**std::move(crs));
  }
  auto aux = read_aux_xml(picture);
  if (!aux) return aux.error();
  if (*aux) claims.push_back(**std::move(aux));
  return claims;
}

bool is_placed_as_stored(const fs::path& picture) {
  const auto claims = read_side_files(picture);
  const auto places = [](const SideClaim& claim) { return claim.transform || claim.has_control_points; };
  return claims && std::ranges::any_of(*claims, places);
}

}  // namespace terrella
