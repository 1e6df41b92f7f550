#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "streaming/mercator/decoded_tiles.h"
#include "streaming/mercator/mercator_grid.h"
#include "tiles/tile_source.h"

namespace terrella {

/// State of one tile being made from stored tiles. Pieces are settled one by one. An absent stored tile is replaced by
/// its ancestors, unless all stored tiles under the tile are absent. thread: one at a time
class MercatorJob {
 public:
  using Bytes = std::shared_ptr<const std::vector<std::byte>>;
  /// Result for a stored tile: its bytes, an already decoded picture, or the reason why there is neither.
  struct Found {
    Bytes bytes;
    std::shared_ptr<const Image> picture;
    std::optional<TileFailure> failure;
  };
  using LookUp = std::function<Found(const TileId& stored)>;

  MercatorJob(const TileGrid& mercator, const TileId& id);

  /// Looks up all pieces that are still open. Pieces that are `remote` stay open (missing()).
  void advance(const LookUp& look_up);
  /// Stored tiles to fetch; none if the job is finished.
  [[nodiscard]] std::vector<TileId> missing() const;
  /// Takes the answer for a missing stored tile.
  void settle(const TileId& stored, const Found& found);
  /// Result of a finished job: an EncodedTile that makes the picture, or the reason why there is none. The error names
  /// the stored tile.
  [[nodiscard]] Result<EncodedTile, TileFailure> result(const std::shared_ptr<DecodedTiles>& decoded) const;

 private:
  enum class State { open, missing, found, absent, hole };
  struct Piece {
    TileId from;  ///< stored tile used for the piece: its own or an ancestor
    State state = State::open;
    Found found;
  };

  void look(Piece& piece, const LookUp& look_up);
  void take(Piece& piece, const Found& found);
  void climb();
  [[nodiscard]] std::optional<TileFailure> failure_of_all() const;

  const int min_level_;
  std::shared_ptr<const MercatorPlan> plan_;
  std::vector<Piece> pieces_;
  std::optional<TileFailure> failed_;       ///< a failed stored tile: this tile then fails too
  std::optional<TileFailure> all_missing_;  ///< set if nothing lies under the tile itself
};

}  // namespace terrella
