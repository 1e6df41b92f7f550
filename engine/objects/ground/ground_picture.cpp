#include "objects/ground/ground_picture.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <numbers>

#include "objects/ground/ground_fills.h"
#include "objects/ground/ground_lines.h"

namespace terrella {
namespace {

/// Points of a line closer than this to the last one are left out.
constexpr double kFinest_px = 0.25;
/// Nearer to an end of a piece, the direction to it says nothing.
constexpr float kNearEnd_px = 0.35F;

std::uint32_t packed(const ObjectColor& c) {
  return std::uint32_t{c.red} | std::uint32_t{c.green} << 8U | std::uint32_t{c.blue} << 16U |
         std::uint32_t{c.alpha} << 24U;
}

std::uint32_t premultiplied(const ObjectColor& c) {
  const auto part = [&](std::uint8_t v) { return static_cast<std::uint8_t>((v * c.alpha + 127) / 255); };
  return packed({part(c.red), part(c.green), part(c.blue), c.alpha});
}

/// A premultiplied colour over another.
std::uint32_t over(std::uint32_t color, std::uint32_t below) {
  const std::uint32_t left = 255 - (color >> 24U);
  std::uint32_t sum = 0;
  for (unsigned at = 0; at < 32; at += 8) {
    sum |= std::min(255U, (color >> at & 255U) + ((below >> at & 255U) * left + 127) / 255) << at;
  }
  return sum;
}

/// Calls use(part, object) for the drawn parts of objects in a box.
template <class Use>
void each_part(std::span<const GroundChunks> layers, CubeFace face, const FaceBox& box, const std::atomic<bool>& stop,
               Use use) {
  for (const GroundChunks& chunks : layers) {
    for (const auto& chunk : chunks) {
      if (stop) return;
      for (const GroundObject& object : chunk->objects) {
        if (!object.shape) continue;
        for (const GroundPart& part : object.shape->parts) {
          if (part.face == face && part.box.meets(box)) use(part, object);
        }
      }
    }
  }
}

bool has_line(const GroundObject& object) { return object.line.alpha > 0 && object.width_px > 0.0F; }
bool has_casing(const GroundObject& object) { return object.casing.alpha > 0 && object.casing_px > 0.0F; }
float width_of(const GroundObject& object) {
  return object.width_px + (has_casing(object) ? 2.0F * object.casing_px : 0.0F);
}

/// The angle between two points of a face.
double angle_between(const glm::dvec2& a, const glm::dvec2& b) {
  const auto direction = [](const glm::dvec2& p) {
    return glm::normalize(
        glm::dvec3(std::tan(std::numbers::pi / 4.0 * p.x), std::tan(std::numbers::pi / 4.0 * p.y), 1.0));
  };
  return 2.0 * std::asin(std::min(1.0, 0.5 * glm::distance(direction(a), direction(b))));
}

void add_mip(std::vector<std::uint32_t>& all, std::size_t from, int side) {
  for (int y = 0; y < side; y += 2) {
    for (int x = 0; x < side; x += 2) {
      const std::size_t at = from + static_cast<std::size_t>(y * side + x);
      std::uint32_t mean = 0;
      for (unsigned k = 0; k < 32; k += 8) {
        const std::uint32_t sum = (all[at] >> k & 255U) + (all[at + 1] >> k & 255U) +
                                  (all[at + static_cast<std::size_t>(side)] >> k & 255U) +
                                  (all[at + static_cast<std::size_t>(side) + 1] >> k & 255U);
        mean |= (sum + 2) / 4 << k;
      }
      all.push_back(mean);
    }
  }
}

}  // namespace

void GroundFills::blend(std::uint32_t ink, bool opaque, std::uint32_t covered, std::size_t texel) {
  constexpr std::uint32_t kWhole = 0xFFFF;
  const auto inked = [&](std::uint32_t below) { return opaque || below == 0 ? ink : over(ink, below); };
  std::uint32_t& parted = memory_.parted[texel];
  if (covered == kWhole && (parted == 0 || opaque)) {
    memory_.colors[texel] = inked(memory_.colors[texel]);
    parted = 0;
    return;
  }
  if (parted == 0) {
    memory_.samples.emplace_back().fill(memory_.colors[texel]);
    parted = static_cast<std::uint32_t>(memory_.samples.size());
  }
  Samples& samples = memory_.samples[parted - 1];
  for (; covered != 0; covered &= covered - 1) {
    std::uint32_t& sample = samples[static_cast<std::size_t>(std::countr_zero(covered))];
    sample = inked(sample);
  }
}

// Each line of toggles becomes the samples east of an odd number of edges. Four lines are a row of texels.
void GroundFills::blend(ObjectColor color) {
  constexpr std::size_t kTexels = std::size_t{GroundPicture::kSide_px} * GroundPicture::kSide_px;
  constexpr int kTexelsAWord = 64 / kSamples;
  if (memory_.colors.empty()) memory_.colors.assign(kTexels, 0), memory_.parted.assign(kTexels, 0);
  const std::uint32_t ink = premultiplied(color);
  for (int row = low_ / kSamples; row <= high_ / kSamples; ++row) {
    std::array<std::uint64_t, kSamples> carry{};
    for (std::size_t word = 0; word < kWords; ++word) {
      std::array<std::uint64_t, kSamples> in{};
      for (std::size_t s = 0; s < kSamples; ++s) {
        std::uint64_t bits = std::exchange(memory_.toggles[static_cast<std::size_t>(row * kSamples) + s][word], 0);
        for (int shift = 1; shift < 64 && bits != 0; shift *= 2) bits ^= bits << shift;
        in[s] = bits ^ carry[s];
        carry[s] = in[s] >> 63U != 0 ? ~std::uint64_t{0} : 0;
      }
      if ((in[0] | in[1] | in[2] | in[3]) == 0) continue;
      const std::size_t first = static_cast<std::size_t>(row) * GroundPicture::kSide_px + word * kTexelsAWord;
      for (unsigned k = 0; k < kTexelsAWord; ++k) {
        const unsigned shift = k * kSamples;
        const auto covered = static_cast<std::uint32_t>((in[0] >> shift & 15U) | (in[1] >> shift & 15U) << 4U |
                                                        (in[2] >> shift & 15U) << 8U | (in[3] >> shift & 15U) << 12U);
        if (covered != 0) blend(ink, color.alpha == 255, covered, first + k);
      }
    }
  }
}

std::vector<std::uint32_t> GroundFills::means() const {
  constexpr int kSide = GroundPicture::kSide_px;
  std::vector<std::uint32_t> all = memory_.colors;
  all.reserve(std::size_t{kSide} * kSide * 4 / 3);
  for (std::size_t texel = 0; texel < memory_.parted.size(); ++texel) {
    if (memory_.parted[texel] == 0) continue;
    std::uint32_t even = 0, odd = 0;  // sums of two channels each; 16 samples of 255 need 12 bits
    for (const std::uint32_t sample : memory_.samples[memory_.parted[texel] - 1]) {
      even += sample & 0xFF00FFU;
      odd += sample >> 8U & 0xFF00FFU;
    }
    all[texel] = ((even + 0x80008U) >> 4U & 0xFF00FFU) | (((odd + 0x80008U) >> 4U & 0xFF00FFU) << 8U);
  }
  std::size_t from = 0;
  for (int mip = 1, side = kSide; mip < GroundPicture::kMips; ++mip, side /= 2) {
    const std::size_t next = all.size();
    add_mip(all, from, side);
    from = next;
  }
  return all;
}

void GroundLines::add(const GroundPart& part, const GroundObject& object) {
  add_way(part, object.line, object.width_px, object.dashes);
}

void GroundLines::add_casing(const GroundPart& part, const GroundObject& object) {
  add_way(part, object.casing, width_of(object), {});
}

void GroundLines::add_way(const GroundPart& part, ObjectColor color, float width_px, const LineDashes& dashes) {
  if (texels_.empty()) texels_.resize(std::size_t{GroundPicture::kSide_px} * GroundPicture::kSide_px);
  half_width_ = 0.5F * width_px;
  color_ = packed(color);
  ++owner_;
  for (const GroundRun& run : part.runs) {
    if (run.use == RunUse::fill) continue;
    const double margin_px = reach_ + edges_.bend_px(run.box);
    const glm::dvec2 low = edges_.texel({run.box.west, run.box.south}) - margin_px,
                     high = edges_.texel({run.box.east, run.box.north}) + margin_px;
    if (high.x < 0.0 || high.y < 0.0 || low.x > GroundPicture::kSide_px || low.y > GroundPicture::kSide_px) continue;
    add_run(part, run, dashes);
  }
}

void GroundLines::add_run(const GroundPart& part, const GroundRun& run, const LineDashes& dashes) {
  const bool has_gaps = dashes.off_px > 0.0F;
  glm::dvec2 from = edges_.texel(part.points[run.first]);
  const glm::dvec2 end = edges_.texel(part.points[run.first + run.pieces]);
  double from_rad = run.along_rad, to_rad = from_rad;
  for (std::uint32_t k = run.first; k < run.first + run.pieces; ++k) {
    const double begin_rad = to_rad;
    if (has_gaps) to_rad += angle_between(part.points[k], part.points[k + 1]);
    const glm::dvec2 begin = edges_.texel(part.points[k]);
    const double length = glm::distance(begin, edges_.texel(part.points[k + 1]));
    edges_.each(part.points[k], part.points[k + 1], [&](const glm::dvec2&, const glm::dvec2& b) {
      if (std::hypot(b.x - from.x, b.y - from.y) < kFinest_px && b != end) return;
      const double b_rad = length > 0.0 ? glm::mix(begin_rad, to_rad, glm::distance(begin, b) / length) : to_rad;
      has_gaps ? dashed(from, b, from_rad, b_rad, dashes) : piece(from, b);
      from = b;
      from_rad = b_rad;
    });
  }
}

// Ends of dashes are round, so a dash is shorter by its width. Their period in texels is the same in all pictures of a
// level, and twice as long on the ground in those of the next coarser one, so dashes meet where pictures do. Pixels are
// one to two texels long.
void GroundLines::dashed(const glm::dvec2& a, const glm::dvec2& b, double from_rad, double to_rad,
                         const LineDashes& dashes) {
  const double px_rad = std::numbers::sqrt2 * texel_rad_;
  const double on_rad = double(dashes.on_px) * px_rad, period_rad = on_rad + double(dashes.off_px) * px_rad;
  const double cap_rad = std::min(double(half_width_) * px_rad, 0.5 * on_rad);
  const auto [first, last] = edges_.inside(a, b);
  if (!(first < last) || !(to_rad > from_rad)) return;
  const double begin_rad = glm::mix(from_rad, to_rad, first), end_rad = glm::mix(from_rad, to_rad, last);
  const auto at = [&](double rad) { return glm::mix(a, b, (rad - from_rad) / (to_rad - from_rad)); };
  for (double dash_rad = std::floor(begin_rad / period_rad) * period_rad; dash_rad < end_rad; dash_rad += period_rad) {
    const double on = std::max(dash_rad + cap_rad, begin_rad), off = std::min(dash_rad + on_rad - cap_rad, end_rad);
    if (on <= off) piece(at(on), at(off));
  }
}

// Goes through the texels within reach of a piece, row by row.
void GroundLines::piece(glm::dvec2 a, glm::dvec2 b) {
  constexpr int kSide = GroundPicture::kSide_px;
  const double length = std::hypot(b.x - a.x, b.y - a.y);
  const glm::dvec2 way = length > 0.0 ? (b - a) / length : glm::dvec2(1.0, 0.0);
  // A piece that goes on from the last one with a turn under 37 degrees starts without a round end.
  constexpr double kCosineOfATurn = 0.8;
  const bool goes_on = a == last_end_ && glm::dot(last_way_, way) > kCosineOfATurn;
  last_end_ = b;
  last_way_ = way;
  const auto row = [](double v) { return static_cast<int>(std::clamp(std::floor(v), -1.0, double(kSide))); };
  const int south = std::max(0, row(std::min(a.y, b.y) - reach_)),
            north = std::min(kSide - 1, row(std::max(a.y, b.y) + reach_));
  for (int y = south; y <= north; ++y) {
    // The part of the row within reach of the piece's line.
    const double off = y + 0.5 - a.y;
    double west = std::min(a.x, b.x) - reach_, east = std::max(a.x, b.x) + reach_;
    if (std::abs(way.y) > 0.05) {
      const double middle = a.x + off * way.x / way.y, half = reach_ / std::abs(way.y);
      west = std::max(west, middle - half);
      east = std::min(east, middle + half);
    }
    const int first = std::max(0, row(west)), last = std::min(kSide - 1, row(east));
    for (int x = first; x <= last; ++x) {
      const double px = x + 0.5 - a.x, there = px * way.x + off * way.y;
      const double along = std::clamp(there, 0.0, length);
      const glm::vec2 to(along * way.x - px, along * way.y - off);
      const float away = std::sqrt(to.x * to.x + to.y * to.y);
      if (!(away < static_cast<float>(reach_))) continue;
      // Beside the piece, and where it nearly meets the texel's middle, the direction is across the piece.
      const bool across = along == there || away < kNearEnd_px;
      const glm::vec2 direction = across ? glm::vec2(-way.y, way.x) : to / away;
      const bool joint = goes_on && there <= 0.0;
      constexpr float kNearer = 0.9999F;  // than the round end of the last piece, which is as far away
      offer({joint ? kNearer * away : away, away - half_width_, across ? to.x * direction.x + to.y * direction.y : away,
             direction, color_, half_width_, owner_, !across && !joint},
            texels_[static_cast<std::size_t>(y * kSide + x)]);
    }
  }
}

// Objects come in their order, so a line lies over all that the texel has.
void GroundLines::offer(const Line& line, Texel& texel) const {
  Line& top = texel.top;
  if (top.owner == line.owner ? line.away >= top.away : top.color == line.color && line.over > top.over) return;
  if (top.color != line.color && may_show(top)) {
    if (!may_show(line)) return;
    texel.below = top;
  } else if (top.color != line.color && top.owner != 0 && !may_show(line) && line.over > top.over) {
    return;
  }
  top = line;
}

// The direction lies in a half turn, and the distance has a sign.
std::uint32_t GroundLines::code(const Line& line) const {
  const double sign = line.direction.y < 0.0F ? -1.0 : 1.0;
  const auto whole = [](double value) { return static_cast<std::uint32_t>(std::lround(value)); };
  const std::uint32_t width = whole(std::clamp(8.0 * double(line.half_width_px), 1.0, 511.0));
  return width << 23U | (line.is_end ? 1U << 22U : 0U) |
         whole(512.0 + sign * 511.0 * double(line.distance) / reach_) << 12U |
         whole(32.0 + sign * 31.0 * double(line.direction.x)) << 6U | whole(sign * 63.0 * double(line.direction.y));
}

template <class Pick>
LineSheet GroundLines::sheet(Pick pick) const {
  LineSheet sheet;
  for (std::size_t k = 0; k < texels_.size(); ++k) {
    const Line* line = pick(texels_[k]);
    if (line == nullptr) continue;
    if (sheet.empty()) sheet.resize(texels_.size(), glm::uvec2(0));
    sheet[k] = {line->color, code(*line)};
  }
  return sheet;
}

LineSheet GroundLines::top() const {
  return sheet([](const Texel& texel) { return texel.top.owner != 0 ? &texel.top : nullptr; });
}

LineSheet GroundLines::below() const {
  constexpr float kLeastTexelsAPixel = 0.7F;
  return sheet([](const Texel& texel) -> const Line* {
    const Line& top = texel.top;
    const bool hides = top.color >> 24U == 255U && top.away + 1.0F < kLeastTexelsAPixel * top.half_width_px;
    return texel.below.owner == 0 || hides ? nullptr : &texel.below;
  });
}

struct GroundCanvas::Memory {
  GroundFills::Memory fills;
  GroundLines::Memory lines;
};

GroundCanvas::GroundCanvas() = default;
GroundCanvas::~GroundCanvas() = default;
GroundCanvas::Memory& GroundCanvas::memory() {
  if (!memory_) memory_ = std::make_unique<Memory>();
  return *memory_;
}
void GroundCanvas::forget() { memory_.reset(); }

FaceBox box_of(const FaceSquare& square, double reach_px) {
  const double around = (GroundPicture::kRim_px + reach_px) / GroundPicture::kInner_px * square.side;
  return {square.west - around, square.south - around, square.west + square.side + around,
          square.south + square.side + around};
}

GroundPicture paint_ground(const FaceSquare& square, std::span<const GroundChunks> layers, double stretch,
                           const std::atomic<bool>& stop, GroundCanvas& canvas) {
  GroundPicture picture;
  GroundFills fills(square, canvas.memory().fills);
  float widest_px = 0.0F;
  bool casings = false;
  each_part(layers, square.face, box_of(square, GroundPicture::kMostReach_px), stop,
            [&](const GroundPart& part, const GroundObject& object) {
              if (object.fill.alpha > 0) fills.add(part, object.fill);
              if (!has_line(object)) return;
              widest_px = std::max(widest_px, width_of(object));
              casings = casings || has_casing(object);
            });
  if (stop) return picture;
  if (fills.any()) picture.fill = fills.means();
  if (widest_px == 0.0F) return picture;
  while (picture.reach_px < GroundPicture::kMostReach_px &&
         picture.reach_px < 0.5 * double(widest_px) * stretch + 2.0) {
    picture.reach_px *= 2.0F;
  }
  const FaceBox within = box_of(square, double(picture.reach_px));
  // Casings lie below all lines, so that lines join where they cross.
  if (casings) {
    GroundLines around(square, double(picture.reach_px), stretch, canvas.memory().lines);
    each_part(layers, square.face, within, stop, [&](const GroundPart& part, const GroundObject& object) {
      if (has_line(object) && has_casing(object)) around.add_casing(part, object);
    });
    picture.lines[GroundPicture::casing] = around.top();
  }
  GroundLines lines(square, double(picture.reach_px), stretch, canvas.memory().lines);
  each_part(layers, square.face, within, stop, [&](const GroundPart& part, const GroundObject& object) {
    if (has_line(object)) lines.add(part, object);
  });
  picture.lines[GroundPicture::top] = lines.top();
  picture.lines[GroundPicture::below] = lines.below();
  return picture;
}

}  // namespace terrella
