#include "streaming/cut/input/tile_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <mutex>
#include <vector>

#include "streaming/raster/in_parallel.h"

namespace terrella {
namespace {

constexpr std::int64_t kMostHeldRowBytes = 24LL << 20;
/// Part of a pixel that counts as rounding in the bounds.
constexpr double kPixelRounding = 1e-3;

/// The pixels inside the bounds of a set, in its finest level. Columns may go on beyond ±180°.
struct PixelRange {
  std::int64_t x0 = 0, x1 = 0;
  std::int64_t y0 = 0, y1 = 0;
  double pixel_deg = 0.0;
};

PixelRange range_of(const TileGrid& grid) {
  PixelRange range;
  range.pixel_deg = tile_span_deg(grid, grid.max_level) / grid.tile_px;
  const auto first = [&](double deg) {
    return static_cast<std::int64_t>(std::floor(deg / range.pixel_deg + kPixelRounding));
  };
  const auto last = [&](double deg) {
    return static_cast<std::int64_t>(std::ceil(deg / range.pixel_deg - kPixelRounding));
  };
  const double west = grid.bounds.west.deg();
  const double east = grid.bounds.east.deg() + (grid.bounds.east.deg() <= west ? 360.0 : 0.0);
  range.x0 = first(west + 180.0);
  range.x1 = std::max(range.x0 + 1, last(east + 180.0));
  range.y0 = first(90.0 - grid.bounds.north.deg());
  range.y1 = std::max(range.y0 + 1, last(90.0 - grid.bounds.south.deg()));
  return range;
}

GeoRect bounds_of(const PixelRange& range) {
  const double east = static_cast<double>(range.x1) * range.pixel_deg - 180.0;
  return {
      .west = Angle::degrees(static_cast<double>(range.x0) * range.pixel_deg - 180.0),
      .south = Angle::degrees(std::max(-90.0, 90.0 - static_cast<double>(range.y1) * range.pixel_deg)),
      .east = Angle::degrees(east > 180.0 + kPixelRounding * range.pixel_deg ? east - 360.0 : std::min(east, 180.0)),
      .north = Angle::degrees(90.0 - static_cast<double>(range.y0) * range.pixel_deg)};
}

/// RGBA8, or a float.
constexpr std::size_t kPixelBytes = 4;

class TileRows : public SeekingRows {
 public:
  TileRows(std::unique_ptr<TileSource> tiles, int jobs, const std::optional<NumberInfo>& numbers, std::string where)
      : tiles_(std::move(tiles)),
        grid_(tiles_->info().grid),
        range_(range_of(grid_)),
        jobs_(thread_count(jobs)),
        numbers_(numbers),
        where_(std::move(where)) {
    info_.width_px = range_.x1 - range_.x0;
    info_.height_px = range_.y1 - range_.y0;
    info_.has_alpha = !tiles_->info().numbers;
    info_.opaque_inside = info_.has_alpha && tiles_->info().format == ImageFormat::jpeg;
  }

  [[nodiscard]] const PictureInfo& info() const override { return info_; }
  [[nodiscard]] const PixelRange& range() const { return range_; }

  [[nodiscard]] Status read_row(std::span<std::uint8_t> rgba) override {
    const std::int64_t y = range_.y0 + row_;
    const std::int64_t tile_y = y / grid_.tile_px;
    if (tile_y != held_tile_y_) {
      if (Status read = read_tiles(tile_y); !read) return read;
      held_tile_y_ = tile_y;
    }
    ++row_;
    const auto pixels = static_cast<std::size_t>(info_.width_px);
    const std::uint8_t* from = held_.data() + static_cast<std::size_t>(y % grid_.tile_px) * pixels * kPixelBytes;
    std::memcpy(rgba.data(), from, pixels * kPixelBytes);
    return Done{};
  }

 private:
  /// The part of a tile that is in the picture: columns of the grid, and the picture's column of the grid's first one.
  struct Piece {
    std::int64_t tile_x = 0;
    std::int64_t left = 0, right = 0;
    std::int64_t at_0 = 0;
  };

  /// Tiles of a row. The columns beyond 180° go on at the grid's first column, which need not be a tile's edge there.
  [[nodiscard]] std::vector<Piece> pieces_of_row() const {
    const auto turn = static_cast<std::int64_t>(std::llround(360.0 / range_.pixel_deg));
    std::vector<Piece> pieces;
    const auto add = [&](std::int64_t left, std::int64_t right, std::int64_t at_0) {
      const std::int64_t side = grid_.tile_px;
      for (std::int64_t tile_x = left / side; tile_x * side < right; ++tile_x) {
        pieces.push_back({tile_x, std::max(left, tile_x * side), std::min(right, (tile_x + 1) * side), at_0});
      }
    };
    add(range_.x0, std::min(range_.x1, std::max(turn, range_.x0 + 1)), -range_.x0);
    if (range_.x1 > turn && range_.x0 < turn) add(0, range_.x1 - turn, turn - range_.x0);
    return pieces;
  }

  Status read_tiles(std::int64_t tile_y) {
    held_.resize(static_cast<std::size_t>(info_.width_px) * static_cast<std::size_t>(grid_.tile_px) * kPixelBytes);
    const std::vector<Piece> pieces = pieces_of_row();
    std::mutex mutex;
    std::optional<Error> failed;
    in_parallel(jobs_, static_cast<std::int64_t>(pieces.size()), [&](std::int64_t i) {
      if (Status read = read_tile(pieces[static_cast<std::size_t>(i)], tile_y); !read) {
        const std::lock_guard lock(mutex);
        if (!failed) failed = read.error();
      }
    });
    return failed ? Status(*failed) : Done{};
  }

  /// Writes the part of a tile that is in the picture into the row of tiles.
  Status read_tile(const Piece& piece, std::int64_t tile_y) {
    const TileId id{.level = grid_.max_level, .x = piece.tile_x, .y = tile_y, .squeeze = 0};
    auto tile = tiles_->read(id);
    if (!tile) return missing(piece, id, tile.error());
    if (tiles_->info().numbers) return read_numbers(piece, id, *tile);
    const auto image = tile->make_picture ? tile->make_picture() : decoded(*tile);
    if (!image) return missing(piece, id, image.error());
    if (Status fits = check_side(id, image->width_px, image->height_px); !fits) return fits;
    place(piece, [&](std::size_t at, std::uint8_t* to) { std::memcpy(to, image->rgba.data() + 4 * at, kPixelBytes); });
    return Done{};
  }

  [[nodiscard]] static Result<Image, TileFailure> decoded(const EncodedTile& tile) {
    auto image = decode_image(tile.bytes);
    if (!image) return TileFailure{.kind = MissingKind::broken, .why = image.error().message};
    return *std::move(image);
  }

  Status read_numbers(const Piece& piece, const TileId& id, const EncodedTile& tile) {
    if (!tile.make_numbers) return row_of_tiles_error(id, "its heights are stored as pictures and cannot be cut again");
    const auto made = tile.make_numbers();
    if (!made) return missing(piece, id, made.error());
    if (Status fits = check_side(id, made->width_px, made->height_px); !fits) return fits;
    const NumberInfo& set = *tiles_->info().numbers;
    const NumberInfo meaning = numbers_.value_or(NumberInfo{});
    place(piece, [&](std::size_t at, std::uint8_t* to) {
      const double number = made->values[at] * tile.number_scale + tile.number_offset;
      const double metres = number * set.scale + set.offset;
      const bool known = !set.nodata || number != *set.nodata;
      const auto coded = known ? static_cast<float>((metres - meaning.offset) / meaning.scale)
                               : std::numeric_limits<float>::quiet_NaN();
      std::memcpy(to, &coded, sizeof(coded));
    });
    return Done{};
  }

  /// Calls `pixel` with the index in the tile and the place in the row of tiles, for each pixel in the picture.
  template <class Pixel>
  void place(const Piece& piece, const Pixel& pixel) {
    const std::int64_t side = grid_.tile_px;
    for (std::int64_t y = 0; y < side; ++y) {
      const std::int64_t first = y * info_.width_px + piece.left + piece.at_0;
      std::uint8_t* to = held_.data() + static_cast<std::size_t>(first) * kPixelBytes;
      for (std::int64_t x = piece.left; x < piece.right; ++x, to += kPixelBytes) {
        pixel(static_cast<std::size_t>(y * side + x - piece.tile_x * side), to);
      }
    }
  }

  /// A missing tile is transparent or without heights. Other failures end the reading.
  Status missing(const Piece& piece, const TileId& id, const TileFailure& failure) {
    if (failure.kind != MissingKind::absent && failure.kind != MissingKind::blank) {
      return row_of_tiles_error(id, failure.why.empty() ? "a tile cannot be had" : failure.why);
    }
    std::array<std::uint8_t, 4> empty{};
    const float none = std::numeric_limits<float>::quiet_NaN();
    if (tiles_->info().numbers) std::memcpy(empty.data(), &none, sizeof(none));
    place(piece, [&](std::size_t, std::uint8_t* to) { std::memcpy(to, empty.data(), kPixelBytes); });
    return Done{};
  }

  [[nodiscard]] Status check_side(const TileId& id, int width, int height) const {
    if (width == grid_.tile_px && height == grid_.tile_px) return Done{};
    return row_of_tiles_error(id, fmt::format("a tile has {}x{} pixels instead of {}", width, height, grid_.tile_px));
  }

  [[nodiscard]] Error row_of_tiles_error(const TileId& id, const std::string& why) const {
    const std::int64_t row = std::max<std::int64_t>(0, id.y * grid_.tile_px - range_.y0);
    return Error{
        fmt::format("{}: the rows from {} of {} on cannot be made: {}", where_, row + 1, info_.height_px, why)};
  }

  std::unique_ptr<TileSource> tiles_;
  TileGrid grid_;
  PixelRange range_;
  int jobs_;
  std::optional<NumberInfo> numbers_;
  std::string where_;
  PictureInfo info_;
  std::int64_t held_tile_y_ = -1;
  std::vector<std::uint8_t> held_;
};

}  // namespace

Result<TileRowsInput> open_tile_rows(std::unique_ptr<TileSource> tiles, int jobs,
                                     const std::optional<NumberInfo>& numbers, const std::string& where) {
  if (tiles->info().grid.projection != Projection::equirectangular) {
    return Error{fmt::format("{}: only tiles with evenly spaced parallels can be cut", where)};
  }
  if (tiles->remote() != nullptr) {
    return Error{fmt::format("{}: tiles of a server cannot be cut; store them with ‹preload›", where)};
  }
  auto rows = std::make_unique<TileRows>(std::move(tiles), jobs, numbers, where);
  const GeoRect bounds = bounds_of(rows->range());
  return TileRowsInput{.rows = std::move(rows), .bounds = bounds};
}

int tile_side_for_rows(std::int64_t width_px) {
  int side = 256;
  while (side > 16 && width_px * side * 4 > kMostHeldRowBytes) side /= 2;
  return side;
}

}  // namespace terrella
