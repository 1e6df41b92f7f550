#pragma once

#include <cstddef>
#include <span>

namespace terrella {

/// Reads the orientation in an EXIF block, which begins with "Exif". Returns 1…8 (EXIF 2.32, tag 0x0112): the side of
/// the scene at which the first row and the first column lie. Returns 1, upright, if the block states nothing that
/// libexif can read. thread: any
[[nodiscard]] int exif_orientation(std::span<const std::byte> block);

/// The same of the EXIF chunk of a WebP file. thread: any
[[nodiscard]] int exif_orientation_of_webp(std::span<const std::byte> file);

}  // namespace terrella
