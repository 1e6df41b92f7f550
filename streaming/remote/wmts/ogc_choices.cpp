#include "streaming/remote/wmts/ogc_choices.h"

#include <fmt/format.h>

#include <algorithm>

#include "streaming/remote/url_template.h"
#include "streaming/remote/web_address.h"
#include "tiles/grid_ranges.h"

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

Result<RemoteTileSet> read_capabilities(
    std::string_view xml, const RemoteOptions& options, const std::string& where,
    const std::function<std::string(const pugi::xml_node& root)>& fault_of,
    const std::function<Result<RemoteTileSet>(const pugi::xml_node& root)>& describe) {
  if (xml.size() > kMaxCapabilitiesBytes) {
    return Error{fmt::format("{}: longer than {} bytes", where, kMaxCapabilitiesBytes)};
  }
  if (Status checked = check_options(options, where); !checked) return checked.error();
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_buffer(xml.data(), xml.size());
  if (!parsed) return Error{fmt::format("{}: not XML at byte {}: {}", where, parsed.offset, parsed.description())};
  const pugi::xml_node root = document.document_element();
  if (const std::string fault = fault_of(root); !fault.empty()) return Error{where + ": " + fault};
  Result<RemoteTileSet> set = describe(root);
  if (!set) return Error{where + ": " + set.error().message};
  if (Status checked = check_url_template(*set, true, where); !checked) return checked.error();
  apply_options(*set, options);
  if (Status checked = check_grid(set->info.grid, where); !checked) return checked.error();
  return set;
}

}  // namespace terrella
