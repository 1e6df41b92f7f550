#include <algorithm>
#include <cstdint>
#include <vector>

#include "streaming/cut/input/row_reader.h"
#include "tests/fuzz/memory_file.h"

/// Whatever the bytes are, the readers of pictures give rows or an error.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // A header can claim rows by the million that cost nothing to make: enough is read to pass every stage.
  constexpr std::int64_t kMostRows = 256;
  const terrella::test::MemoryFile file(data, size);
  auto reader = terrella::open_rows(file.path());
  if (!reader) return 0;
  const auto& info = (*reader)->info();
  std::vector<std::uint8_t> row(static_cast<std::size_t>(info.width_px) * 4);
  for (std::int64_t y = 0; y < std::min(info.height_px, kMostRows); ++y) {
    if (!(*reader)->read_row(row)) break;
  }
  return 0;
}
