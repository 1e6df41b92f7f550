#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "streaming/pmtiles/pmtiles_set.h"
#include "streaming/pmtiles/tile_number.h"

using namespace terrella;

namespace {

/// Follows the directories to some tiles. Every way ends, within the sections.
void look_for_tiles(PmtilesIndex& index, std::span<const std::byte> file) {
  for (std::uint64_t tile = 0; tile < 100; ++tile) {
    for (int reads = 0; reads < kMaxPmtilesReads; ++reads) {
      const auto step = index.next(tile);
      if (!step || step->is_tile) break;
      if (!is_within(step->range, file.size())) std::abort();
      if (!index.learn(step->range, file.subspan(step->range.offset, step->range.length))) break;
    }
  }
}

}  // namespace

/// The bytes as a whole archive, and as a directory.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = std::as_bytes(std::span(data, size));
  const ReadBytes read = [file](const ByteRange& range) -> Result<std::vector<std::byte>> {
    const auto from = file.subspan(std::min<std::uint64_t>(range.offset, file.size()));
    const auto part = from.first(std::min<std::uint64_t>(range.length, from.size()));
    return std::vector<std::byte>(part.begin(), part.end());
  };
  const auto set = describe_pmtiles(
      read, [size] { return std::optional<std::uint64_t>(size); }, "file");
  if (!set && set.error().message.empty()) std::abort();
  if (set) look_for_tiles(*set->index, file);
  if (const auto directory = parse_pmtiles_directory(file)) {
    for (std::size_t i = 1; i < directory->size(); ++i) {
      if ((*directory)[i].tile < (*directory)[i - 1].tile + (*directory)[i - 1].run) std::abort();
    }
    const auto again = parse_pmtiles_directory(pmtiles_directory_bytes(*directory));
    if (!again || !std::ranges::equal(*again, *directory)) std::abort();
  }
  return 0;
}
