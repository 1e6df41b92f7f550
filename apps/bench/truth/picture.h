#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace terrella::truth {

/// An 8-bit RGB picture, rows from the top, no padding. Values are gamma-encoded as in the file.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;  ///< 3 · width · height

  [[nodiscard]] const std::uint8_t* texel(int x, int y) const {
    return rgb.data() +
           3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
  }
};

/// Reads a PNG or a JPEG, told apart by their first bytes. Grey becomes RGB, alpha is blended over black. Throws
/// std::runtime_error that names the file and its fault. An exception suits this test tool, because its callers can
/// only end.
[[nodiscard]] Picture read_picture(const std::filesystem::path& file);

/// Writes an RGB PNG, fast rather than small. Throws std::runtime_error.
void write_png(const Picture& picture, const std::filesystem::path& file);

/// Computes a fingerprint of size and pixels (FNV-1a over 64-bit words); equal pictures have equal fingerprints.
[[nodiscard]] std::uint64_t fingerprint(const Picture& picture);

}  // namespace terrella::truth
