#include "streaming/remote/grid_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "codecs/image.h"
#include "tiles/tile_range.h"

namespace terrella {
namespace {

/// Means of red, green and blue in 16 × 16 cells of a picture, in 8-bit levels. Averaging removes fine detail, JPEG
/// noise and the smoothing of coarser levels.
constexpr int kThumbnailSide = 16;
using Thumbnail = std::array<float, std::size_t{3} * kThumbnailSide * kThumbnailSide>;

/// A part of a picture, as fractions of its sides.
struct PicturePart {
  double left = 0.0, top = 0.0, right = 1.0, bottom = 1.0;
};

struct PixelSpan {
  int first, last;  ///< pixels, the last excluded; never empty
};

PixelSpan cell(int size_px, double from, double to, int index) {
  const double step = (to - from) / kThumbnailSide;
  const int first = std::clamp(static_cast<int>(std::lround(size_px * (from + step * index))), 0, size_px - 1);
  const int last = static_cast<int>(std::lround(size_px * (from + step * (index + 1))));
  return {first, std::clamp(last, first + 1, size_px)};
}

std::array<float, 3> mean_of(const Image& image, const PixelSpan& x, const PixelSpan& y) {
  std::array<double, 3> sum{};
  for (int row = y.first; row < y.last; ++row) {
    for (int column = x.first; column < x.last; ++column) {
      const std::size_t at = 4 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width_px) +
                                  static_cast<std::size_t>(column));
      const double alpha = image.rgba[at + 3] / 255.0;
      for (std::size_t c = 0; c < 3; ++c) sum[c] += alpha * image.rgba[at + c];
    }
  }
  const double count = static_cast<double>(x.last - x.first) * (y.last - y.first);
  return {static_cast<float>(sum[0] / count), static_cast<float>(sum[1] / count), static_cast<float>(sum[2] / count)};
}

Thumbnail thumbnail_of(const Image& image, const PicturePart& part = {}) {
  Thumbnail small{};
  std::size_t at = 0;
  for (int row = 0; row < kThumbnailSide; ++row) {
    const PixelSpan y = cell(image.height_px, part.top, part.bottom, row);
    for (int column = 0; column < kThumbnailSide; ++column, at += 3) {
      const auto mean = mean_of(image, cell(image.width_px, part.left, part.right, column), y);
      std::copy(mean.begin(), mean.end(), small.begin() + static_cast<std::ptrdiff_t>(at));
    }
  }
  return small;
}

/// Root mean square difference, levels. Transparent pixels count as black.
double difference(const Thumbnail& a, const Thumbnail& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

/// Standard deviation from the mean colour, levels.
double contrast(const Thumbnail& picture) {
  Thumbnail mean{};
  for (std::size_t c = 0; c < 3; ++c) {
    double sum = 0.0;
    for (std::size_t i = c; i < picture.size(); i += 3) sum += picture[i];
    for (std::size_t i = c; i < picture.size(); i += 3)
      mean[i] = static_cast<float>(3.0 * sum / static_cast<double>(picture.size()));
  }
  return difference(picture, mean);
}

using Verdict = GridCheck::Verdict;

// JPEG at quality 50 changes the mean of a cell by one or two levels, and different sharpening of the coarse level by
// about three.
constexpr double kLeastContrast = 8.0;
/// A picture looks like the nearer of two if its distance to it is below this share of the distance to the other.
constexpr double kClearly = 0.5;

struct Fault {
  Verdict verdict;
  std::string advice;
};

class Checking {
 public:
  Checking(const FetchTileImage& fetch, const TileGrid& grid) : fetch_(fetch), grid_(grid) {}

  Result<GridCheck> check() {
    if (const auto roots = check_roots()) return GridCheck{roots->verdict, roots->advice};
    if (error_) return *error_;
    const GridCheck rows = check_rows();
    if (error_) return *error_;
    return rows;
  }

 private:
  std::optional<Image> fetch(const TileId& id) {
    if (error_) return std::nullopt;
    Result<std::optional<Image>> tile = fetch_(id);
    if (!tile) error_ = tile.error();
    if (!tile || !*tile || (*tile)->width_px < 1 || (*tile)->height_px < 1) return std::nullopt;
    return **std::move(tile);
  }

  bool has_picture(const TileId& id) {
    const auto tile = fetch(id);
    return tile && contrast(thumbnail_of(*tile)) >= kLeastContrast;
  }

  /// True if the west edge of a tile continues its east edge. This holds for a tile that spans 360°, but not for 180°.
  static bool goes_round(const Image& tile) {
    constexpr double kEdge = 1.0 / 64.0;
    const Thumbnail west = thumbnail_of(tile, {.left = 0.0, .right = kEdge});
    const Thumbnail east = thumbnail_of(tile, {.left = 1.0 - kEdge, .right = 1.0});
    const Thumbnail middle = thumbnail_of(tile, {.left = 0.5 - kEdge, .right = 0.5});
    const double across = difference(west, east);
    return difference(west, middle) >= kLeastContrast && across < kClearly * difference(west, middle);
  }

  /// Checks which root tiles exist. Only sets of the whole planet that begin at their root can be checked.
  std::optional<Fault> check_roots() {
    const GeoRect& bounds = grid_.bounds;
    const bool planet = bounds.west.deg() < -179.0 && bounds.east.deg() > 179.0 && bounds.south.deg() < -85.0 &&
                        bounds.north.deg() > 85.0;
    if (!planet || grid_.min_level > 1 || grid_.max_level <= grid_.min_level) return std::nullopt;
    if (grid_.projection == Projection::web_mercator) return check_square();
    if (grid_.root_span_deg == 360.0) return check_one_root();
    return grid_.root_span_deg == 180.0 && grid_.min_level == 0 ? check_two_roots() : std::nullopt;
  }

  std::optional<Fault> check_two_roots() {
    const auto root = fetch({0, 0, 0});
    if (!root || contrast(thumbnail_of(*root)) < kLeastContrast || fetch({0, 1, 0})) return std::nullopt;
    if (!goes_round(*root)) return std::nullopt;
    const bool north = has_picture({1, 0, 0}) || has_picture({1, 1, 0});
    const bool south = has_picture({1, 0, 1}) || has_picture({1, 1, 1});
    if (north && south) return mercator();
    if (!north && !south) return std::nullopt;
    return Fault{Verdict::one_root,
                 "there is one root tile, 360° wide, where the grid says two of 180°; say ‹root_span_deg› 360"};
  }

  std::optional<Fault> check_one_root() {
    if (fetch({1, 2, 0})) {
      return Fault{
          Verdict::two_roots,
          "there are tiles east of the last column: the set has two root tiles of 180°, where the grid says one "
          "of 360°; say ‹root_span_deg› 180"};
    }
    if (has_picture({1, 0, 0}) && (has_picture({1, 0, 1}) || has_picture({1, 1, 1}))) return mercator();
    return std::nullopt;
  }

  /// Finds a geodetic set: it has tiles east of the Mercator square, or none in the southern half of the square.
  std::optional<Fault> check_square() {
    if (grid_.root_span_deg != 360.0 || grid_.min_level > 0) return std::nullopt;
    if (fetch({1, 2, 0})) {
      return Fault{Verdict::two_roots,
                   "there are tiles east of the square of Web Mercator: the set has two root tiles of 180° and is "
                   "geodetic; leave out ‹projection› web-mercator"};
    }
    const bool north = has_picture({1, 0, 0}) || has_picture({1, 1, 0});
    if (!north || fetch({1, 0, 1}) || fetch({1, 1, 1})) return std::nullopt;
    return Fault{
        Verdict::one_root,
        "there are no tiles in the southern half of the square of Web Mercator: the set is most likely geodetic "
        "with one root tile; say ‹root_span_deg› 360 instead of ‹projection› web-mercator"};
  }

  static Fault mercator() {
    return {Verdict::web_mercator,
            "one root tile shows the whole planet and four tiles lie under it: the set is most likely in Web Mercator; "
            "say ‹projection› web-mercator (\"projection\": \"web-mercator\" in a description)"};
  }

  /// The first tiles that have two tiles under each half.
  std::vector<TileId> parents() const {
    constexpr std::size_t kMost = 3;
    std::vector<TileId> found;
    for (int level = grid_.min_level; level < grid_.max_level && found.size() < kMost; ++level) {
      for_each_place(grid_, level, [&](const TileId& id) {
        const TileId lower{level + 1, 2 * id.x, 2 * id.y + 1};
        const bool whole = exists(grid_, lower) && exists(grid_, {level + 1, lower.x + 1, lower.y}) &&
                           exists(grid_, {level + 1, lower.x, 2 * id.y});
        if (whole) found.push_back(id);
        return found.size() < kMost;
      });
    }
    return found;
  }

  GridCheck check_rows() {
    for (const TileId& id : parents()) {
      const auto parent = fetch(id);
      if (!parent) continue;
      const int side = clearer_half(*parent);
      const Thumbnail upper = quadrant(*parent, side, 0);
      const Thumbnail lower = quadrant(*parent, side, 1);
      if (difference(upper, lower) < kLeastContrast) continue;
      const auto first = fetch({id.level + 1, 2 * id.x + side, 2 * id.y});
      const auto second = fetch({id.level + 1, 2 * id.x + side, 2 * id.y + 1});
      if (!first || !second) continue;
      return judge(upper, lower, thumbnail_of(*first), thumbnail_of(*second));
    }
    return {Verdict::cannot_tell, "its tiles are too flat, or too few, to tell whether they are in the right place"};
  }

  static Thumbnail quadrant(const Image& parent, int column, int row) {
    const double left = 0.5 * column;
    const double top = 0.5 * row;
    return thumbnail_of(parent, {.left = left, .top = top, .right = left + 0.5, .bottom = top + 0.5});
  }

  static int clearer_half(const Image& parent) {
    const auto step = [&](int column) { return difference(quadrant(parent, column, 0), quadrant(parent, column, 1)); };
    return step(1) > step(0) ? 1 : 0;
  }

  static GridCheck judge(const Thumbnail& upper, const Thumbnail& lower, const Thumbnail& first,
                         const Thumbnail& second) {
    const double straight = std::hypot(difference(upper, first), difference(lower, second));
    const double crossed = std::hypot(difference(upper, second), difference(lower, first));
    if (straight < kClearly * crossed) return {Verdict::fits, {}};
    if (crossed < kClearly * straight) {
      return {
          Verdict::flipped_rows,
          "its rows count from the other end: write {-y} instead of {y} in its URL template, or the other way round"};
    }
    return {Verdict::cannot_tell, "its tiles look like neither order of rows; compare its levels by eye"};
  }

  const FetchTileImage& fetch_;
  const TileGrid& grid_;
  std::optional<Error> error_;
};

}  // namespace

Result<GridCheck> find_mistaken_grid(const FetchTileImage& fetch, const TileGrid& grid) {
  return Checking(fetch, grid).check();
}

}  // namespace terrella
