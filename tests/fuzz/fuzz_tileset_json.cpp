#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "streaming/sets/tileset_json.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto info = terrella::parse_tileset_json({reinterpret_cast<const char*>(data), size}, "fuzz");
  // An accepted description is written so that it is accepted again.
  if (info && !terrella::parse_tileset_json(terrella::to_tileset_json(*info), "again")) std::abort();
  return 0;
}
