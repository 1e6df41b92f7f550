#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "geo/coordinates.h"

namespace terrella {

struct NamedPlace {
  std::string name;     ///< UTF-8
  std::string country;  ///< may be empty
  std::string folded;   ///< the name as it is looked for: ASCII letters, lower case
  Geodetic place;
  double people = 0.0;
};

/// Places by name. thread: any
class Gazetteer {
 public:
  /// A GeoJSON of points with the properties of Natural Earth's populated places (name, nameascii, adm0name, pop_max).
  /// Fails if it cannot be read, or if no feature of it is such a place; one that is not is left out.
  [[nodiscard]] static Result<Gazetteer> load(const std::filesystem::path& file);

  /// Those whose name begins with the text, the largest first, then those that have it further in; at most `most`. None
  /// for a text of blanks.
  [[nodiscard]] std::vector<const NamedPlace*> find(std::string_view text, std::size_t most) const;
  [[nodiscard]] std::size_t size() const { return places_.size(); }

 private:
  std::vector<NamedPlace> places_;  ///< the largest first
};

}  // namespace terrella
