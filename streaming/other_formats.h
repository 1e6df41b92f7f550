#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace terrella {

/// Text as one word for a shell, in quotes if it needs them. thread: any
[[nodiscard]] std::string shell_word(const std::string& text);

/// How many first bytes convert_hint() looks at.
inline constexpr std::size_t kFormatHeadBytes = 512;

/// What to do with a file that is no picture that is read here, by its first bytes: "it is JPEG 2000; make a picture of
/// it that is read: gdal_translate -of COG …", or "" for bytes of no raster format that GDAL reads and we do not.
/// thread: any
[[nodiscard]] std::string convert_hint(const std::filesystem::path& path, std::string_view head);

}  // namespace terrella
