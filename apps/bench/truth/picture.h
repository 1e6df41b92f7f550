#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace terrella::truth {

/// An 8-bit RGB picture, rows from the top, no padding. Gamma-encoded values as they stand in the file.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;  ///< 3 · width · height

  [[nodiscard]] const std::uint8_t* texel(int x, int y) const {
    return rgb.data() +
           3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
  }
};

/// Reads a PNG or a JPEG (told apart by their first bytes). Grey becomes RGB, alpha is laid over black.
/// Throws std::runtime_error that names the file and what is wrong with it: the ground truth is a test tool, and its
/// callers have nothing better to do with a picture that cannot be read than to end.
[[nodiscard]] Picture read_picture(const std::filesystem::path& file);

/// Writes an RGB PNG, quickly rather than small. Throws std::runtime_error.
void write_png(const Picture& picture, const std::filesystem::path& file);

/// A fingerprint of size and pixels (FNV-1a over 64-bit words); equal pictures have equal ones.
[[nodiscard]] std::uint64_t fingerprint(const Picture& picture);

}  // namespace terrella::truth
