#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "streaming/warp/stored_blocks.h"
#include "streaming/warp/warp_plan.h"

namespace terrella {

/// State of one tile being made from blocks. Pieces are settled one by one. An absent block is replaced by its
/// ancestors, if the level has parents, unless all blocks under the tile are absent. thread: one at a time
class WarpJob {
 public:
  WarpJob(std::shared_ptr<const StoredBlocks> blocks, WarpPlan plan);

  /// Looks up all pieces that are still open. Pieces that are `remote` stay open (missing()).
  void advance();
  /// Blocks to fetch, as the raster names them; none if the job is finished.
  [[nodiscard]] std::vector<TileId> missing() const;
  /// Takes the answer for a missing block.
  void settle(const TileId& stored, const FoundBlock& found);
  /// Result of a finished job: an EncodedTile that makes the picture or the numbers, or the reason why there is none.
  /// The error names the block.
  [[nodiscard]] Result<EncodedTile, TileFailure> result(bool numbers) const;

 private:
  enum class State { open, missing, found, absent, hole };
  struct Piece {
    TileId from;  ///< block used for the piece: its own or an ancestor
    State state = State::open;
    FoundBlock found;
  };
  struct Recipe;

  void look(Piece& piece);
  void take(Piece& piece, const FoundBlock& found);
  void climb();
  [[nodiscard]] std::optional<TileFailure> failure_of_all() const;

  const std::shared_ptr<const StoredBlocks> blocks_;
  const std::shared_ptr<const WarpPlan> plan_;
  std::vector<Piece> pieces_;
  std::optional<TileFailure> failed_;       ///< a failed block: this tile then fails too
  std::optional<TileFailure> all_missing_;  ///< set if nothing lies under the tile itself
};

}  // namespace terrella
