#include "apps/process/option_names.h"

#include <algorithm>
#include <array>
#include <utility>

#include "streaming/url.h"

namespace terrella {
namespace {

using Row = std::pair<std::string_view, std::string_view>;

/// Settings and work of the libraries, and the options that set them or commands that do it.
/// tests/structure/test_messages.py finds one without a row.
constexpr std::array kOptions = {
    Row{"band", "--band"},
    Row{"bands", "--bands"},
    Row{"body", "--body"},
    Row{"bounds", "--bounds"},
    Row{"ca_file", "--ca-file"},
    Row{"cache", "--cache"},
    Row{"colormap", "--colormap"},
    Row{"crs", "--crs"},
    Row{"cut", "terrella cut"},
    Row{"elevation", "--elevation"},
    Row{"force", "--force"},
    Row{"format", "--format"},
    Row{"grid", "--grid"},
    Row{"jobs", "--jobs"},
    Row{"latitude", "--latitude"},
    Row{"layer", "--layer"},
    Row{"levels", "--levels"},
    Row{"mosaic", "--mosaic"},
    Row{"nodata", "--nodata"},
    Row{"offline", "--offline"},
    Row{"preload", "terrella preload"},
    Row{"projection", "--projection"},
    Row{"root_span_deg", "--root-span"},
    Row{"scale", "--scale"},
    Row{"shard", "--shard"},
    Row{"stretch", "--stretch"},
    Row{"tile_px", "--tile-size"},
    Row{"time", "--layer-time"},
    Row{"times", "--layer-times"},
    Row{"verify", "terrella info --verify"},
    Row{"west_deg", "--west"},
};

constexpr std::string_view kOpen = "‹", kClose = "›";

}  // namespace

std::string with_option_names(std::string_view message) {
  std::string shown;
  for (std::size_t open = message.find(kOpen); open != message.npos; open = message.find(kOpen)) {
    shown += message.substr(0, open);
    message.remove_prefix(open);
    const std::size_t close = std::min(message.find(kClose), message.size());
    const auto row = std::ranges::find(kOptions, message.substr(kOpen.size(), close - kOpen.size()), &Row::first);
    const bool is_known = row != kOptions.end() && close < message.size();
    shown += is_known ? row->second : kOpen;
    message.remove_prefix(is_known ? close + kClose.size() : kOpen.size());
  }
  return shown.append(message);
}

std::string shown_message(std::string_view message) { return redact_addresses(with_option_names(message)); }

}  // namespace terrella
