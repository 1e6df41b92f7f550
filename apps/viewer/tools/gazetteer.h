#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
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
  double area_km2 = 0.0;    ///< largest part of a country, or a sea; 0: neither
  bool is_capital = false;  ///< capital of a country
  bool is_part = false;     ///< part of a city
};

/// Countries or seas by the columns `name`, `lat`, `lon` and `km2` of a map. Throws nlohmann::json::exception. thread:
/// any
[[nodiscard]] std::vector<NamedPlace> areas_of(const nlohmann::json& columns);

/// Rank of a place among others by its people, or by the area of a country or sea: larger ones come first. thread: any
[[nodiscard]] double rank_of(const NamedPlace& place);

/// Places by name. thread: any
class Gazetteer {
 public:
  /// Loads the program's list of cities (data/points/cities.json), or a GeoJSON file of points on any body. A point has
  /// a `name` or a `title`, and may have `country` or `adm0name`, and `population` or `pop_max`. Fails if the file
  /// cannot be read or contains no place. Invalid features are skipped.
  [[nodiscard]] static Result<Gazetteer> load(const std::filesystem::path& file);

  /// Adds the countries and seas of the program's map (data/vector/map.json). The error names the file.
  [[nodiscard]] Status add_areas(const std::filesystem::path& map);

  /// Finds at most `most` places. Names that are the text come first, then names that begin with it, then names that
  /// contain it; each sorted by rank_of(). Case and accents do not count. A blank text finds nothing.
  [[nodiscard]] std::vector<const NamedPlace*> find(std::string_view text, std::size_t most) const;
  /// The place of the highest rank within a distance of another place, for example of the middle of a view. Countries
  /// and seas much larger than that are left out. Null if there is none.
  [[nodiscard]] const NamedPlace* near(const Geodetic& place, Angle distance) const;
  [[nodiscard]] const std::vector<NamedPlace>& places() const { return places_; }  ///< the highest rank first
  [[nodiscard]] std::size_t size() const { return places_.size(); }

 private:
  void sort();

  std::vector<NamedPlace> places_;  ///< the highest rank first
};

}  // namespace terrella
