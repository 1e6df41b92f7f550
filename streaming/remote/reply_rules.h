#pragma once

#include <cstddef>
#include <span>

#include "base/result.h"
#include "streaming/http/http_fetcher.h"
#include "streaming/remote/remote_tile_set.h"

namespace terrella {

/// Turns an answer that means "no tile here" by the set's own rules (missing_statuses, exception_is_missing) into
/// HttpOutcome::nothing. thread: any
void apply_reply_rules(const RemoteTileSet& set, HttpReply& reply);

/// Quick check of a tile's bytes, as check_tile(). Tiles at the edges of a `projected` grid may be cut to the part that
/// lies in its bounds; heights of 32 bits only have to begin as a TIFF. thread: any
[[nodiscard]] Status check_answer(const TileSetInfo& info, const TileId& id, std::span<const std::byte> bytes);

}  // namespace terrella
