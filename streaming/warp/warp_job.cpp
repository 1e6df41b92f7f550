#include "streaming/warp/warp_job.h"

#include <algorithm>
#include <cassert>
#include <unordered_map>
#include <utility>

#include "streaming/warp/filter/resample.h"

namespace terrella {

/// All that a worker needs to make the tile.
struct WarpJob::Recipe {
  struct Source {
    TileId from;
    FoundBlock found;
    bool core = false;
  };
  std::shared_ptr<const StoredBlocks> blocks;
  std::shared_ptr<const WarpPlan> plan;
  std::unordered_map<TileId, Source, TileIdHash> sources;

  [[nodiscard]] DecodedBlocks::Decoded block_at(const TileId& id) const {
    const auto source = sources.find(id);
    if (source == sources.end()) return std::shared_ptr<const Block>();
    const auto decoded = blocks->decode(source->second.from, source->second.found);
    if (!decoded && !source->second.core) return std::shared_ptr<const Block>();
    if (!decoded) return TileFailure{decoded.error().kind, blocks->named(source->second.from, decoded.error().why)};
    const int steps = id.level - source->second.from.level;
    if (steps == 0) return decoded;
    const std::int64_t parts = std::int64_t{1} << steps;
    return std::make_shared<const Block>(enlarged_part(**decoded, steps, id.x % parts, id.y % parts));
  }
  [[nodiscard]] const WarpLevel& level() const { return blocks->level(plan->level); }
};

WarpJob::WarpJob(std::shared_ptr<const StoredBlocks> blocks, WarpPlan plan)
    : blocks_(std::move(blocks)), plan_(std::make_shared<const WarpPlan>(std::move(plan))) {
  for (const WarpPiece& piece : plan_->pieces) pieces_.push_back({.from = piece.id, .found = {}});
}

void WarpJob::advance() {
  for (Piece& piece : pieces_) look(piece);
  while (!failed_ && !all_missing_ && missing().empty()) {
    all_missing_ = failure_of_all();
    if (all_missing_) return;
    climb();
    if (std::ranges::none_of(pieces_, [](const Piece& piece) { return piece.state == State::open; })) return;
    for (Piece& piece : pieces_) look(piece);
  }
}

std::vector<TileId> WarpJob::missing() const {
  std::vector<TileId> tiles;
  if (failed_ || all_missing_) return tiles;
  for (const Piece& piece : pieces_) {
    if (piece.state == State::missing) tiles.push_back(blocks_->stored(piece.from));
  }
  std::ranges::sort(tiles);
  tiles.erase(std::unique(tiles.begin(), tiles.end()), tiles.end());
  return tiles;
}

void WarpJob::settle(const TileId& stored, const FoundBlock& found) {
  for (Piece& piece : pieces_) {
    if (piece.state == State::missing && blocks_->stored(piece.from) == stored) take(piece, found);
  }
}

void WarpJob::look(Piece& piece) {
  if (piece.state != State::open || failed_) return;
  take(piece, blocks_->find(piece.from));
}

void WarpJob::take(Piece& piece, const FoundBlock& found) {
  piece.found = found;
  piece.state = State::found;
  if (!found.failure) return;
  switch (found.failure->kind) {
    case MissingKind::remote:
      piece.state = State::missing;
      return;
    case MissingKind::failed:
      if (!failed_) failed_ = TileFailure{MissingKind::failed, blocks_->named(piece.from, found.failure->why)};
      return;
    case MissingKind::absent:
    case MissingKind::broken:
      piece.state = State::absent;
      return;
    case MissingKind::blank:
      piece.state = State::hole;
      return;
  }
}

/// Replaces absent blocks by their parents.
void WarpJob::climb() {
  for (Piece& piece : pieces_) {
    if (piece.state != State::absent) continue;
    const bool has_parent = blocks_->level(piece.from.level).has_parents;
    piece.state = has_parent ? State::open : State::hole;
    if (has_parent) piece.from = parent(piece.from);
  }
}

/// Failure of the whole tile, so that its ancestors are drawn: no block lies under it, or one is broken.
std::optional<TileFailure> WarpJob::failure_of_all() const {
  std::optional<TileFailure> worst;
  bool any = false;
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const Piece& piece = pieces_[i];
    if (!plan_->pieces[i].core || piece.from != plan_->pieces[i].id) {
      any = any || plan_->pieces[i].core;
      continue;
    }
    if (!piece.found.failure) {
      any = true;
      continue;
    }
    const TileFailure& failure = *piece.found.failure;
    const TileFailure named{failure.kind, blocks_->named(piece.from, failure.why)};
    if (failure.kind == MissingKind::broken) return named;
    if (!worst || failure.kind == MissingKind::blank) worst = named;
  }
  // A tile beside the raster is transparent.
  if (any || pieces_.empty()) return std::nullopt;
  return worst ? worst : TileFailure{MissingKind::absent, "outside the tile set"};
}

Result<EncodedTile, TileFailure> WarpJob::result(bool numbers) const {
  if (failed_) return *failed_;
  if (all_missing_) return *all_missing_;
  assert(missing().empty());
  const auto recipe = std::make_shared<Recipe>(Recipe{blocks_, plan_, {}});
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    if (pieces_[i].state != State::found) continue;
    recipe->sources[plan_->pieces[i].id] = {pieces_[i].from, pieces_[i].found, plan_->pieces[i].core};
  }
  const auto block_at = [recipe](const TileId& id) { return recipe->block_at(id); };
  EncodedTile tile;
  if (numbers) {
    tile.make_numbers = [recipe, block_at] { return warp_numbers(*recipe->plan, recipe->level(), block_at); };
  } else {
    tile.make_picture = [recipe, block_at] { return warp_picture(*recipe->plan, recipe->level(), block_at); };
  }
  return tile;
}

}  // namespace terrella
