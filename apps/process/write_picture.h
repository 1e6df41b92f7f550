#pragma once

#include <filesystem>

#include "base/result.h"
#include "codecs/image.h"

namespace terrella {

/// Quality of written JPEG files, 1…100.
inline constexpr int kWrittenJpegQuality = 92;

/// Refuses a name that ends as another picture format than PNG and JPEG, as a file would belie its name. thread: any
[[nodiscard]] Status check_picture_name(const std::filesystem::path& path);

/// Writes a JPEG if the name ends in .jpg or .jpeg, else a PNG, as write_file() does. The error names the path.
/// thread: any
[[nodiscard]] Status write_picture(const std::filesystem::path& path, const Image& image);

}  // namespace terrella
