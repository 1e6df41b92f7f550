#include "streaming/remote/wmts/ogc_choices.h"

#include <fmt/format.h>

#include <algorithm>

namespace terrella {

std::string list_of(const std::vector<std::string>& names) {
  constexpr std::size_t kMaxShown = 20;
  std::string list;
  for (std::size_t i = 0; i < std::min(names.size(), kMaxShown); ++i) {
    list += (i == 0 ? "" : ", ") + names[i].substr(0, 100);
  }
  if (names.size() > kMaxShown) list += fmt::format(" and {} more", names.size() - kMaxShown);
  return list.empty() ? "none" : list;
}

}  // namespace terrella
