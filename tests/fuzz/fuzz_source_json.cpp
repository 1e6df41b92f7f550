#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "streaming/remote/source_json.h"
#include "streaming/remote/url_template.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto source = terrella::parse_source_json({reinterpret_cast<const char*>(data), size}, "fuzz");
  if (!source) return 0;
  const auto set = terrella::template_tile_set(source->address, source->options, true, "fuzz");
  if (!set) return 0;
  if (terrella::tile_url(*set, {.level = set->info.grid.min_level}).empty()) std::abort();
  static_cast<void>(terrella::source_key(*set));
  return 0;
}
