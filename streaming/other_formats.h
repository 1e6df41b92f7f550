#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace terrella {

/// Returns the text as one shell word, quoted if necessary. thread: any
[[nodiscard]] std::string shell_word(const std::string& text);

/// Number of leading bytes that convert_hint() examines.
inline constexpr std::size_t kFormatHeadBytes = 4096;

/// Advice for a picture file in an unsupported format, found by its first bytes: "it is JPEG 2000; make a picture of it
/// that is read: gdal_translate -of COG …". Empty if the bytes belong to no raster format that only GDAL reads.
/// thread: any
[[nodiscard]] std::string convert_hint(const std::filesystem::path& path, std::string_view head);

}  // namespace terrella
