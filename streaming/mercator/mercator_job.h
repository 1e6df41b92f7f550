#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "streaming/mercator/decoded_tiles.h"
#include "streaming/mercator/mercator_grid.h"
#include "tiles/tile_source.h"

namespace terrella {

/// One tile being made of stored ones: what is known of each of them. Its pieces are settled one by one; where a
/// stored tile is absent its ancestors are asked for in its place, unless all under the tile are absent.
/// thread: one at a time
class MercatorJob {
 public:
  using Bytes = std::shared_ptr<const std::vector<std::byte>>;
  /// What became of a stored tile: bytes, a picture that is at hand already, or why there is neither.
  struct Found {
    Bytes bytes;
    std::shared_ptr<const Image> picture;
    std::optional<TileFailure> failure;
  };
  using LookUp = std::function<Found(const TileId& stored)>;

  MercatorJob(const TileGrid& mercator, const TileId& id);

  /// Looks for all that is not known yet; what is `remote` stays open (missing()).
  void advance(const LookUp& look_up);
  /// What has to be fetched; none: it is finished.
  [[nodiscard]] std::vector<TileId> missing() const;
  /// The answer about a stored tile that was missing.
  void settle(const TileId& stored, const Found& found);
  /// Of a finished job: what makes the picture, or why there is none. The error names the stored tile.
  [[nodiscard]] Result<EncodedTile, TileFailure> result(const std::shared_ptr<DecodedTiles>& decoded) const;

 private:
  enum class State { open, missing, found, absent, hole };
  struct Piece {
    TileId from;  ///< the stored tile that stands for it, an ancestor or itself
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
  std::optional<TileFailure> failed_;       ///< one that could not be asked for: the tile cannot either, for now
  std::optional<TileFailure> all_lacking_;  ///< nothing lies under the tile itself
};

}  // namespace terrella
