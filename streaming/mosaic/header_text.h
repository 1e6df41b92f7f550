#pragma once

#include <optional>
#include <string>

#include "streaming/mosaic/mosaic_sheet.h"

namespace terrella {

/// A file's facts as text for the store, and back; nothing for a text of another version or a damaged one. The path
/// and the mark are not among them. thread: any
[[nodiscard]] std::string header_text(const PlacedFile& file);
[[nodiscard]] std::optional<PlacedFile> parse_header_text(const std::string& text);

}  // namespace terrella
