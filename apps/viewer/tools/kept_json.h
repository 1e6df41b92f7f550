#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "base/result.h"

namespace terrella {

/// Reads a file that the viewer keeps between runs: a JSON object of at most 1 MiB; null if the file is missing. The
/// error names the file. thread: any
[[nodiscard]] Result<nlohmann::json> read_kept_json(const std::filesystem::path& file);

/// Writes such a file, with its folder if that is missing. The error names file or folder. thread: any
Status write_kept_json(const std::filesystem::path& file, const nlohmann::json& json);

}  // namespace terrella
