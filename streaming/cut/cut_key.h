#pragma once

#include <string>

#include "base/result.h"
#include "streaming/cut.h"

namespace terrella {

/// All options that a tile depends on, as text. thread: any
[[nodiscard]] std::string options_text(const CutOptions& options);

/// The options, and name, size and time of change of each picture: what is equal when the same is cut again. Folders
/// have no part, so that machines may see the pictures under different paths. The error names a picture that cannot be
/// found. thread: any
[[nodiscard]] Result<std::string> cut_key(const CutOptions& options);

/// The mark of a tile set cut from these pictures, with any options; see read_cut_key(). thread: any
[[nodiscard]] std::string cut_mark(const std::string& key);

/// When the pictures were changed last, as "2026-01-31T12:00:00.000Z". thread: any
[[nodiscard]] std::string last_change_of(const std::vector<std::filesystem::path>& images);

}  // namespace terrella
