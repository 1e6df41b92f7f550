#pragma once

#include "streaming/http/http_fetcher.h"
#include "streaming/remote/remote_tile_set.h"

namespace terrella {

/// Turns an answer that means "no tile here" by the set's own rules (missing_statuses, exception_is_missing) into
/// HttpOutcome::nothing. thread: any
void apply_reply_rules(const RemoteTileSet& set, HttpReply& reply);

/// Turns content that is no tile of the set into HttpOutcome::broken, with the reason. Decodes it, which takes about
/// 1 ms. Tiles at the edges of a `projected` grid may be cut to the part that lies in its bounds. A body without bytes
/// is a blank tile. thread: any
void check_body(const TileSetInfo& info, const TileId& id, HttpReply& reply);

}  // namespace terrella
