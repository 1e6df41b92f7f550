#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace terrella {

/// Returns the text as one shell word, quoted if necessary. thread: any
[[nodiscard]] std::string shell_word(const std::string& text);

/// Number of leading bytes that convert_hint() examines.
inline constexpr std::size_t kFormatHeadBytes = 64;

/// Advice for a picture file in a format that GDAL may not read, found by its first bytes: "it is AVIF; make a picture
/// of it that is read: convert a.avif a.png". Empty for others. thread: any
[[nodiscard]] std::string convert_hint(const std::filesystem::path& path, std::string_view head);

}  // namespace terrella
