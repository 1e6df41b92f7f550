#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "geo/coordinates.h"

namespace terrella {

struct NamedPlace {
  std::string name;          ///< UTF-8
  std::string country = {};  ///< may be empty
  std::string folded = {};   ///< name as used in searches: without case and accents
  Geodetic place = {};
  double people = 0.0;
  bool is_capital = false;  ///< capital of a country
  bool is_part = false;     ///< part of a city
};

/// Places by name. thread: any
class Gazetteer {
 public:
  /// Loads the program's list of cities (data/points/cities.json), or a GeoJSON file of points on any body. A point has
  /// a `name` or a `title`, and may have `country` or `adm0name`, and `population` or `pop_max`. Fails if the file
  /// cannot be read or contains no place. Invalid features are skipped.
  [[nodiscard]] static Result<Gazetteer> load(const std::filesystem::path& file);

  /// Finds at most `most` places. Names that begin with the text come first, then names that contain the text; both are
  /// sorted by population, largest first. Case and accents do not count. A blank text finds nothing.
  [[nodiscard]] std::vector<const NamedPlace*> find(std::string_view text, std::size_t most) const;
  [[nodiscard]] const std::vector<NamedPlace>& places() const { return places_; }  ///< largest population first
  [[nodiscard]] std::size_t size() const { return places_.size(); }

 private:
  std::vector<NamedPlace> places_;  ///< largest population first
};

}  // namespace terrella
