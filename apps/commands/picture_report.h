#pragma once

#include <string>

#include "apps/commands/picture_facts.h"

namespace terrella {

/// Describes a picture for `terrella info`, as lines of text or one JSON object: its metadata, and how `view` would
/// show it. thread: any
[[nodiscard]] std::string picture_report(const PictureFacts& facts, bool json);

}  // namespace terrella
