#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "base/result.h"

namespace terrella {

/// Reads a file that the viewer keeps between runs: a JSON object of at most 1 MiB; null if the file is missing. The
/// error names the file. thread: any
[[nodiscard]] Result<nlohmann::json> read_kept_json(const std::filesystem::path& file);

/// Writes such a file, with its folder if that is missing. The error names file or folder. thread: any
Status write_kept_json(const std::filesystem::path& file, const nlohmann::json& json);
/// The same for a text.
Status write_kept_text(const std::filesystem::path& file, std::string_view text);

/// Copies a damaged file to NAME.damaged, and returns a message that begins with `complaint` and says so. thread: any
[[nodiscard]] std::string set_aside(const std::filesystem::path& file, const std::string& complaint);

}  // namespace terrella
