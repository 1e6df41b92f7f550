#include "streaming/mercator/mercator_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <utility>

#include "streaming/mercator/resample.h"

namespace terrella {
namespace {

std::string named(const TileId& id, const std::string& why) {
  return fmt::format("made of the Web Mercator tile {}/{}/{}: {}", id.level, id.x, id.y, why);
}

struct Source {
  TileId id;
  MercatorJob::Bytes bytes;
  std::shared_ptr<const Image> picture;
};

DecodedTiles::Decoded picture_of(const Source& source, int tile_px, DecodedTiles& decoded) {
  if (source.picture) return source.picture;
  return decoded.get(source.id, [&]() -> Result<Image, TileFailure> {
    DecodeLimits limits;
    limits.max_side_px = std::max(tile_px, 1024);
    Result<Image> image = decode_image(*source.bytes, limits);
    if (!image) return TileFailure{MissingKind::broken, named(source.id, image.error().message)};
    if (image->width_px != tile_px || image->height_px != tile_px) {
      return TileFailure{MissingKind::broken,
                         named(source.id, fmt::format("it is {}×{} pixels, the tile set says {}×{}", image->width_px,
                                                      image->height_px, tile_px, tile_px))};
    }
    return *std::move(image);
  });
}

}  // namespace

MercatorJob::MercatorJob(const TileGrid& mercator, const TileId& id)
    : min_level_(mercator.min_level), plan_(std::make_shared<const MercatorPlan>(plan_tile(mercator, id))) {
  for (const MercatorPiece& piece : plan_->pieces) pieces_.push_back({.from = piece.id, .found = {}});
}

void MercatorJob::advance(const LookUp& look_up) {
  for (Piece& piece : pieces_) look(piece, look_up);
  while (!failed_ && !all_missing_ && missing().empty()) {
    all_missing_ = failure_of_all();
    if (all_missing_) return;
    climb();
    if (std::ranges::none_of(pieces_, [](const Piece& piece) { return piece.state == State::open; })) return;
    for (Piece& piece : pieces_) look(piece, look_up);
  }
}

std::vector<TileId> MercatorJob::missing() const {
  std::vector<TileId> tiles;
  if (failed_ || all_missing_) return tiles;
  for (const Piece& piece : pieces_) {
    if (piece.state == State::missing && std::ranges::find(tiles, piece.from) == tiles.end()) {
      tiles.push_back(piece.from);
    }
  }
  return tiles;
}

void MercatorJob::settle(const TileId& stored, const Found& found) {
  for (Piece& piece : pieces_) {
    if (piece.state == State::missing && piece.from == stored) take(piece, found);
  }
}

void MercatorJob::look(Piece& piece, const LookUp& look_up) {
  if (piece.state != State::open || failed_) return;
  take(piece, look_up(piece.from));
}

void MercatorJob::take(Piece& piece, const Found& found) {
  piece.found = found;
  piece.state = State::found;
  if (!found.failure) return;
  switch (found.failure->kind) {
    case MissingKind::remote:
      piece.state = State::missing;
      return;
    case MissingKind::failed:
      if (!failed_) failed_ = TileFailure{MissingKind::failed, named(piece.from, found.failure->why)};
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

/// Replaces absent tiles by their parents.
void MercatorJob::climb() {
  for (Piece& piece : pieces_) {
    if (piece.state != State::absent) continue;
    const bool at_root = piece.from.level <= min_level_;
    piece.state = at_root ? State::hole : State::open;
    if (!at_root) piece.from = parent(piece.from);
  }
}

/// Failure of the whole tile, so that its ancestors are drawn: no stored tile lies under it, or one is broken.
std::optional<TileFailure> MercatorJob::failure_of_all() const {
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
    if (failure.kind == MissingKind::broken) return TileFailure{MissingKind::broken, named(piece.from, failure.why)};
    if (!worst || failure.kind == MissingKind::blank) worst = TileFailure{failure.kind, named(piece.from, failure.why)};
  }
  if (any) return std::nullopt;
  return worst ? worst : TileFailure{MissingKind::absent, "outside the tile set"};
}

Result<EncodedTile, TileFailure> MercatorJob::result(const std::shared_ptr<DecodedTiles>& decoded) const {
  if (failed_) return *failed_;
  if (all_missing_) return *all_missing_;
  assert(missing().empty());
  std::vector<Source> sources;
  for (const Piece& piece : pieces_) {
    const bool found = piece.state == State::found;
    sources.push_back({piece.from, found ? piece.found.bytes : nullptr, found ? piece.found.picture : nullptr});
  }
  EncodedTile tile;
  tile.make_picture = [plan = plan_, sources = std::move(sources), decoded]() -> Result<Image, TileFailure> {
    std::vector<PiecePicture> pictures(sources.size());
    for (std::size_t i = 0; i < sources.size(); ++i) {
      if (!sources[i].bytes && !sources[i].picture) continue;
      const DecodedTiles::Decoded picture = picture_of(sources[i], plan->tile_px, *decoded);
      const TileId& wanted = plan->pieces[i].id;
      const int steps = wanted.level - sources[i].id.level;
      if (!picture && plan->pieces[i].core) return picture.error();
      const std::int64_t parts = std::int64_t{1} << steps;
      if (picture) pictures[i] = {*picture, steps, wanted.x % parts, wanted.y % parts};
    }
    return resample(*plan, pictures);
  };
  return tile;
}

}  // namespace terrella
