#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "objects/ground/ground_edges.h"

namespace terrella {

/// Areas in 4 · 4 samples a texel. A sample is in an area or not, so areas that share an edge part the samples between
/// them. Corners are rounded to eighths of a texel, alike in all areas. A texel whose samples are alike has one colour.
class GroundFills {
 public:
  static constexpr int kSamples = 4, kAcross = GroundPicture::kSide_px * kSamples, kWords = kAcross / 64;

  using Line = std::array<std::uint64_t, kWords>;  ///< a bit a sample
  using Samples = std::array<std::uint32_t, std::size_t{kSamples} * kSamples>;
  struct Memory {
    std::vector<Line> toggles = std::vector<Line>(kAcross);  ///< all 0 between two pictures
    std::vector<std::uint32_t> colors;                       ///< colours of texels whose samples are alike
    std::vector<std::uint32_t> parted;                       ///< places in samples of the other texels, counted from 1
    std::vector<Samples> samples;
  };

  GroundFills(const FaceSquare& square, Memory& memory) : edges_(square, 0.0), memory_(memory) {
    memory_.colors.clear();
    memory_.samples.clear();
  }

  void add(const GroundPart& part, ObjectColor color) {
    low_ = kAcross;
    high_ = -1;
    for (const GroundRun& run : part.runs) {
      if (run.use != RunUse::stroke) add(part, run);
    }
    if (low_ <= high_) blend(color);
  }
  [[nodiscard]] bool any() const { return !memory_.colors.empty(); }
  /// The means of the samples, with all mips.
  [[nodiscard]] std::vector<std::uint32_t> means() const;

 private:
  struct Corner {
    std::int64_t x, y;  ///< eighths of a texel
  };
  static Corner corner(const glm::dvec2& p) { return {std::llround(8.0 * p.x), std::llround(8.0 * p.y)}; }

  // A run west of the picture counts as one edge from the run's begin to its end.
  void add(const GroundPart& part, const GroundRun& run) {
    const double margin_px = 1.0 + edges_.bend_px(run.box);
    const glm::dvec2 low = edges_.texel({run.box.west, run.box.south}) - margin_px,
                     high = edges_.texel({run.box.east, run.box.north}) + margin_px;
    if (high.y < 0.0 || low.y > GroundPicture::kSide_px || low.x > GroundPicture::kSide_px) return;
    if (high.x < 0.0) {
      edge(corner(edges_.texel(part.points[run.first])), corner(edges_.texel(part.points[run.first + run.pieces])));
      return;
    }
    for (std::uint32_t k = run.first; k < run.first + run.pieces; ++k) {
      edges_.each(part.points[k], part.points[k + 1],
                  [&](const glm::dvec2& a, const glm::dvec2& b) { edge(corner(a), corner(b)); });
    }
  }

  // Toggles what lies east of the edge, on all lines of samples that it crosses.
  void edge(Corner a, Corner b) {
    if (a.y == b.y) return;
    if (a.y > b.y) std::swap(a, b);
    // Line k of the samples lies at 2 k + 1 eighths, and so does column k.
    const std::int64_t first = std::max<std::int64_t>(0, floor_half(a.y)),
                       last = std::min<std::int64_t>(kAcross - 1, floor_half(b.y - 2));
    if (first > last) return;
    low_ = std::min(low_, static_cast<int>(first));
    high_ = std::max(high_, static_cast<int>(last));
    const double slope = double(b.x - a.x) / double(b.y - a.y);
    for (std::int64_t line = first; line <= last; ++line) {
      const double x = double(a.x) + slope * double(2 * line + 1 - a.y);
      const double column = std::ceil(0.5 * (x - 1.0));
      if (column >= kAcross) continue;
      const auto at = static_cast<std::uint32_t>(std::max(0.0, column));
      memory_.toggles[static_cast<std::size_t>(line)][at / 64] ^= std::uint64_t{1} << (at % 64);
    }
  }
  static std::int64_t floor_half(std::int64_t v) { return v >= 0 ? v / 2 : -((1 - v) / 2); }

  void blend(ObjectColor color);
  void blend(std::uint32_t ink, bool opaque, std::uint32_t covered, std::size_t texel);

  GroundEdges edges_;
  int low_ = 0, high_ = -1;
  Memory& memory_;
};

}  // namespace terrella
