#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>

#include "globe/ground_pictures.h"
#include "surface/view_planes.h"

// The choice of pictures for the patches of a view.
namespace terrella {
namespace {

/// A patch is shown by at most 2^this pictures a side.
constexpr int kMostDepth = 6;
constexpr int kMostHalvings = 12;  // GroundFrame::cells
/// Pictures of larger squares would lack lines of other faces within their reach.
constexpr int kLeastLevel = 1;
/// Stretches of pictures are powers of kStretchStep, so that a turn of the eye seldom needs other pictures. At
/// kMostSlant lines have faded (patch_ground.glsl); slopes of relief bring pixels of kReliefSlant everywhere.
constexpr double kLeastStretch = 2.0, kStretchStep = 1.414, kReliefSlant = 7.0, kMostSlant = 16.0;
/// Pixels of ground whose normal has a smaller cosine towards the eye are clearly longer than wide.
constexpr double kSlanted = 0.55;
/// Texels may be this many pixels wide; those of pictures of squares larger than patches less, since slopes stretch
/// them.
constexpr double kMostTexel_px = 1.4, kMostLargerTexel_px = 0.7, kMostLargerTexelOnRelief_px = 0.1;
constexpr double kCoarserStep = 1.5;
constexpr int kMostCoarser = 16;
constexpr glm::uvec3 kEmptyCell{0xFFFFFFFFU, 0U, 0xFFFFFFFFU};

double stretch_of(double wish) {
  double least = kLeastStretch;
  while (least < wish) least *= kStretchStep;
  return least;
}

PatchId ancestor(const PatchId& id, int up) {
  return {id.face, id.level - up, id.x >> unsigned(up), id.y >> unsigned(up)};
}

}  // namespace

/// Plans one view: a patch has the pictures of its own square or of its parts, or the picture of a larger square.
class GroundPictures::Planner {
 public:
  Planner(GroundPictures& pictures, const GroundView& view, double pixels, int coarser)
      : pictures_(pictures),
        view_(view),
        coarser_(std::pow(kCoarserStep, coarser)),
        room_(pictures.room(pixels)),
        planes_(view_planes(view.view)) {}

  /// True if the pictures that the view needs are not more than there is room for.
  [[nodiscard]] bool has_room() {
    for (const SelectedPatch& patch : view_.patches) {
      patch_ = &patch;
      visit(patch.node->id, 0, nullptr);
    }
    return needs_.size() <= room_;
  }

  void add(const SelectedPatch& patch, ViewGround& out) {
    leaves_.clear();
    deepest_ = 0;
    slanted_ = false;
    patch_ = &patch;
    visit(patch.node->id, 0, &out.frame);
    glm::uvec4 window(0);
    if (!leaves_.empty()) {
      window = {out.frame.cells.size(), deepest_, 0, 0};
      const auto side = std::size_t{1} << static_cast<unsigned>(deepest_);
      out.frame.cells.resize(out.frame.cells.size() + side * side, kEmptyCell);
      for (const Leaf& leaf : leaves_) put(leaf, window, side, out.frame.cells.data() + window.x);
      if (window.z != 0 && slanted_) window.z |= 4U;
      if (std::ranges::any_of(leaves_, [](const Leaf& leaf) { return leaf.entry->slots.has_more_lines(); })) {
        window.z = kMoreLines;
      }
    }
    out.frame.windows.push_back(window);
  }

  [[nodiscard]] int left_out() const { return left_out_; }
  /// Pictures that the patches need and that are not there or out of date.
  void add_wants(std::vector<ViewGround::Want>& wants) const {
    for (const auto& [id, need] : needs_) {
      if (!pictures_.entries_.at(id).serves(need.stretch)) wants.push_back({id, need.stretch, need.urgent});
    }
  }

 private:
  /// A part of the patch, and the picture that shows it.
  struct Leaf {
    PatchId id;
    int depth = 0;
    const Entry* entry = nullptr;
    int up = 0;  ///< levels from `id` up to the picture's square
  };
  struct Need {
    double stretch = 1.0;
    bool urgent = false;
  };
  /// The ground of a square, as seen by the eye.
  struct Sight {
    BoundingSphere sphere;
    glm::dvec3 up{0.0}, to_eye{0.0};
    double away_m = 0.0, side_m = 0.0;
    double pixel_m = 0.0;    ///< ground under a pixel of a size
    double longest_m = 0.0;  ///< the same, under the longest pixel
    /// Pixels that a texel of a square some levels above is wide.
    [[nodiscard]] double texel_px(int levels) const {
      return std::ldexp(side_m, levels) / (GroundPicture::kInner_px * pixel_m);
    }
  };

  // The sphere has its centre in the middle of the square and goes through the farthest corner.
  [[nodiscard]] Sight sight_of(const PatchId& id) const {
    const PatchRelief& relief = patch_->node->relief;
    const Ellipsoid& e = view_.tree.ellipsoid();
    Sight s;
    s.up = patch_point(id, 1, 1, 2).xyz;
    s.sphere.center_m = e.position(EcefDir{s.up}, relief.middle_m).xyz_m;
    double flat_m = 0.0, longest = 0.0;
    for (int k = 0; k < 4; ++k) {
      const EcefDir up = patch_point(id, k % 2, k / 2, 1);
      const glm::dvec3 corner = e.position(up, relief.middle_m).xyz_m, to_eye = view_.view.eye.xyz_m - corner;
      flat_m = std::max(flat_m, glm::distance(corner, s.sphere.center_m));
      const double away_m = glm::length(to_eye), cosine = std::abs(glm::dot(up.xyz, to_eye)) / away_m;
      const double slant = std::min(kMostSlant, 1.0 / std::max(cosine, 1e-3));
      longest = std::max(longest, away_m * std::max(slant, view_.has_relief ? kReliefSlant : 1.0));
    }
    s.longest_m = longest / view_.view.pixels_per_radian() * view_.pixel_scale;
    s.sphere.radius_m = flat_m + relief.half_m;
    s.to_eye = view_.view.eye.xyz_m - s.sphere.center_m;
    s.away_m = glm::length(s.to_eye);
    // An eye among the heights of relief is in the spheres of many squares.
    const double least_m = s.away_m > 1.5 * flat_m ? 0.2 * s.away_m : view_.clearance_m;
    const double nearest_m = std::max(s.away_m - flat_m - std::min(relief.half_m, 0.5 * s.away_m), least_m);
    s.pixel_m = nearest_m / view_.view.pixels_per_radian() * view_.pixel_scale * coarser_;
    s.side_m = std::sqrt(2.0) * flat_m;
    return s;
  }

  // A null frame: only counts what is needed.
  void visit(const PatchId& id, int depth, GroundFrame* out) {
    if (needs_.size() > room_ || !pictures_.meets(id)) return;
    const Sight sight = sight_of(id);
    if (depth > 0 && classify(planes_, view_.view, sight.sphere) < 0) return;
    if (sight.texel_px(0) > kMostTexel_px && depth < kMostDepth && id.level < kMaxPatchLevel) {
      for (const PatchId& child : children(id)) visit(child, depth + 1, out);
      return;
    }
    // A larger view of the same sizes has smaller patches, and the pictures that it would have without.
    const double most_flat_px = view_.pixel_scale > 1.0 ? kMostTexel_px : kMostLargerTexel_px;
    const double most_px = view_.has_relief ? kMostLargerTexelOnRelief_px : most_flat_px;
    PatchId square = id;
    int up = 0;
    while (depth == 0 && up < kMostHalvings && square.level > kLeastLevel && sight.texel_px(up + 1) <= most_px) {
      square = parent(square);
      ++up;
    }
    const auto place = needs_.try_emplace(square).first;
    if (out == nullptr) return;
    if (needs_.size() > room_) {
      needs_.erase(place);
      ++left_out_;
      return;
    }
    Need& need = place->second;
    const double cosine = std::abs(glm::dot(sight.up, sight.to_eye)) / sight.away_m;
    slanted_ = slanted_ || cosine < kSlanted || view_.has_relief;
    const double texels = GroundPicture::kInner_px * sight.longest_m / std::ldexp(sight.side_m, up);
    need.stretch = std::max(need.stretch, stretch_of(texels));
    Entry& entry = pictures_.entries_[square];
    entry.needed = entry.shown = pictures_.plans_;
    if (entry.made) return take({id, depth, &entry, up});
    const bool shown = show_above(id, depth, 0, up) || show_finer(id, depth) ||
                       show_above(id, depth, up + 1, kMostHalvings - kMostDepth);
    need.urgent = need.urgent || !shown;
  }

  void take(const Leaf& leaf) {
    deepest_ = std::max(deepest_, leaf.depth);
    leaves_.push_back(leaf);
  }

  [[nodiscard]] bool show_finer(const PatchId& id, int depth) {
    if (depth == kMostDepth || id.level == kMaxPatchLevel) return false;
    std::array<Entry*, 4> found{};
    const std::array<PatchId, 4> parts = children(id);
    bool any = false;
    for (std::size_t k = 0; k < 4; ++k) {
      const auto at = pictures_.entries_.find(parts[k]);
      if (at != pictures_.entries_.end() && at->second.made) found[k] = &at->second, any = true;
      if (found[k] == nullptr && pictures_.meets(parts[k]) && !any) return false;
    }
    if (!any) return false;
    for (std::size_t k = 0; k < 4; ++k) {
      if (found[k] == nullptr) continue;
      found[k]->shown = pictures_.plans_;
      take({parts[k], depth + 1, found[k], 0});
    }
    return true;
  }

  // The finest picture, `from` to `to` levels above a square.
  [[nodiscard]] bool show_above(const PatchId& id, int depth, int from, int to) {
    for (int up = from; up <= std::min(to, id.level); ++up) {
      const auto at = pictures_.entries_.find(ancestor(id, up));
      if (at == pictures_.entries_.end() || !at->second.made) continue;
      at->second.shown = pictures_.plans_;
      take({id, depth, &at->second, up});
      return true;
    }
    return false;
  }

  void put(const Leaf& leaf, glm::uvec4& window, std::size_t side, glm::uvec3* cells) const {
    const GroundSlots& slots = leaf.entry->slots;
    if (!slots.any()) return;
    window.z |= (slots.fill >= 0 ? 1U : 0U) | (slots.lines[GroundPicture::top] >= 0 ? 2U : 0U);
    const auto more = static_cast<unsigned>(deepest_ - leaf.depth), up = static_cast<unsigned>(leaf.up);
    const std::uint32_t across = 1U << more, below = (1U << up) - 1U;
    const std::uint32_t x0 = (leaf.id.x << more) - (patch_->node->id.x << static_cast<unsigned>(deepest_)),
                        y0 = (leaf.id.y << more) - (patch_->node->id.y << static_cast<unsigned>(deepest_));
    const auto both = [](int low, int high) {
      return static_cast<std::uint32_t>(low & 0xFFFF) | static_cast<std::uint32_t>(high) << 16U;
    };
    const std::uint32_t word = both(slots.fill, slots.lines[GroundPicture::top]),
                        more_lines = both(slots.lines[GroundPicture::below], slots.lines[GroundPicture::casing]);
    const auto reach = static_cast<std::uint32_t>(std::lround(std::log2(leaf.entry->reach_px))) - 2U;
    for (std::uint32_t y = 0; y < across; ++y) {
      for (std::uint32_t x = 0; x < across; ++x) {
        const std::uint32_t column = ((leaf.id.x & below) << more) + x, row = ((leaf.id.y & below) << more) + y;
        cells[(y0 + y) * side + x0 + x] = {word, (more + up) | column << 4U | row << 16U | reach << 28U, more_lines};
      }
    }
  }

  GroundPictures& pictures_;
  const GroundView& view_;
  double coarser_;
  std::size_t room_;
  ViewPlanes planes_;
  const SelectedPatch* patch_ = nullptr;
  std::vector<Leaf> leaves_;
  int deepest_ = 0;
  bool slanted_ = false;
  int left_out_ = 0;
  std::map<PatchId, Need> needs_;
};

// The coarsest pictures of a disc are as many in small views as in large ones.
std::size_t GroundPictures::room(double pixels) const {
  constexpr std::size_t kLeast = 16;
  const auto all = static_cast<std::size_t>(textures_.capacity());
  const std::size_t views = std::max<std::size_t>(1, views_), least = std::min(kLeast, all / views);
  return least + static_cast<std::size_t>(double(all - least * views) * pixels / std::max(pixels, pixels_));
}

// A view that needs more pictures than there is room for takes coarser ones.
void GroundPictures::plan(const GroundView& view, ViewGround& out) {
  out.frame.textures = &textures_;
  out.frame.windows.clear();
  out.frame.cells.clear();
  out.wants.clear();
  out.planned = ++plans_;
  out.pixels = double(view.view.viewport.width_px) * view.view.viewport.height_px;
  const auto has_room = [&](int coarser) { return Planner(*this, view, out.pixels, coarser).has_room(); };
  while (out.coarser < kMostCoarser && !has_room(out.coarser)) ++out.coarser;
  while (out.coarser > 0 && has_room(out.coarser - 1)) --out.coarser;
  Planner planner(*this, view, out.pixels, out.coarser);
  for (const SelectedPatch& patch : view.patches) planner.add(patch, out);
  planner.add_wants(out.wants);
  out.left_out = planner.left_out();
}

}  // namespace terrella
