#pragma once

#include <string>

#include "base/result.h"
#include "streaming/cut.h"

namespace terrella {

/// Text of all options that affect the tiles, on one line. `place` stands for the options about the place. thread: any
[[nodiscard]] std::string options_text(const CutOptions& options, std::string place);

/// Key of a cut: the options, the place (place_text()), and name, size and time of change of each picture. Equal cuts
/// have equal keys. Folders are not part of the key, so machines may see the pictures under different paths. The error
/// names a picture that cannot be found. thread: any
[[nodiscard]] Result<std::string> cut_key(const CutOptions& options, const std::string& place);

/// Mark of a tile set cut from these pictures with any options; see read_cut_key(). thread: any
[[nodiscard]] std::string cut_mark(const std::string& key);

/// Latest change of the pictures, as "2026-01-31T12:00:00.000Z". thread: any
[[nodiscard]] std::string last_change_of(const std::vector<std::filesystem::path>& images);

}  // namespace terrella
