#pragma once

#include <compare>
#include <cstdint>

namespace terrella {

/// Bytes of a file.
struct ByteRange {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  auto operator<=>(const ByteRange&) const = default;
};

/// True if the range lies within the first `bytes` bytes. No sum overflows. thread: any
[[nodiscard]] constexpr bool is_within(const ByteRange& range, std::uint64_t bytes) {
  return range.offset <= bytes && range.length <= bytes - range.offset;
}

}  // namespace terrella
