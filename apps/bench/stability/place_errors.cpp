#include "apps/bench/stability/place_errors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

namespace terrella::bench {
namespace {

/// Compares each pixel with the ray through it, in double.
class PlaceJudge {
 public:
  explicit PlaceJudge(const PatchScene& scene) : scene_(scene), size_(scene.view.viewport) {}

  PlaceErrors judge(const std::vector<WindowPixel>& pixels) {
    PlaceErrors errors;
    for (int y = 0; y < size_.height_px; ++y) {
      for (int x = 0; x < size_.width_px; ++x) {
        const auto row = static_cast<std::size_t>(size_.height_px - 1 - y);
        add({x + 0.5, y + 0.5}, pixels[row * static_cast<std::size_t>(size_.width_px) + static_cast<std::size_t>(x)],
            errors);
      }
    }
    return errors;
  }

 private:
  void add(glm::dvec2 pixel_px, const WindowPixel& pixel, PlaceErrors& errors) const {
    const Ellipsoid& e = scene_.tree.ellipsoid();
    const std::optional<Geodetic> place = pick(scene_.view, e, pixel_px);
    if (!place) return;
    if (pixel.patch == 0) {
      if (!near_limb(pixel_px)) ++errors.holes;
      return;
    }
    if (near_limb(pixel_px)) return;  // the surface is seen edge-on, so a fragment's place is undefined
    const SelectedPatch& patch = scene_.patches[pixel.patch - 1];
    const double interpolated = off_texels(patch, *place, {pixel.points.x, pixel.points.y});
    const double exact = off_texels(patch, *place, {pixel.points.z, pixel.points.w});
    if (!patch.in_band) errors.interpolated_texels = std::max(errors.interpolated_texels, interpolated);
    errors.exact_texels = std::max(errors.exact_texels, exact);
    const glm::dvec2 drawn =
        patch.in_band ? glm::dvec2(pixel.points.z, pixel.points.w) : glm::dvec2(pixel.points.x, pixel.points.y);
    errors.drawn_px = std::max(errors.drawn_px, off_px(patch, drawn, pixel_px));
    ++errors.judged;
  }

  // Error in texels of the patch's level. Texels shrink along a parallel as the parallel is shorter than the equator.
  [[nodiscard]] double off_texels(const SelectedPatch& patch, const Geodetic& place, glm::dvec2 point) const {
    const PatchNode& node = *patch.node;
    const TileGrid& grid = scene_.tree.grid();
    const double lon_deg = node.lon_center_deg + wrapped_deg(place.lon.deg() - node.lon_center_deg);
    const TileXY xy = tile_xy(grid, node.window->level, place.lat.deg(), lon_deg);
    const glm::dvec2 off(point.x - (xy.x - static_cast<double>(node.window->x0)),
                         point.y - (xy.y - static_cast<double>(node.window->y0)));
    return std::hypot(off.x * std::cos(place.lat.rad()), off.y) * grid.tile_px;
  }

  // Distance on the screen between this pixel and the place drawn at this pixel.
  [[nodiscard]] double off_px(const SelectedPatch& patch, glm::dvec2 point, glm::dvec2 pixel_px) const {
    const TileWindow& window = *patch.node->window;
    const double span_deg = tile_span_deg(scene_.tree.grid(), window.level);
    const Ellipsoid& e = scene_.tree.ellipsoid();
    const double row_deg = 90.0 - (point.y + static_cast<double>(window.y0)) * span_deg;
    const Angle lat = latitude_of_row(scene_.tree.grid(), e, row_deg);
    const Angle lon = Angle::degrees((point.x + static_cast<double>(window.x0)) * span_deg - 180.0);
    const auto drawn = project(scene_.view, e.to_ecef({.lat = lat, .lon = lon}));
    return drawn ? glm::distance(*drawn, pixel_px) : HUGE_VAL;
  }

  // True within 1.5 pixels of rays that miss.
  [[nodiscard]] bool near_limb(glm::dvec2 pixel_px) const {
    const std::array<glm::dvec2, 4> around{{{1.5, 0.0}, {-1.5, 0.0}, {0.0, 1.5}, {0.0, -1.5}}};
    return std::ranges::any_of(around, [&](glm::dvec2 step) {
      return !scene_.tree.ellipsoid().intersect_m(scene_.view.eye, pixel_ray(scene_.view, pixel_px + step));
    });
  }

  const PatchScene& scene_;
  Viewport size_;
};

}  // namespace

PlaceErrors place_errors(PatchScene& scene, PatchProbe& probe) {
  probe.load(scene);
  return PlaceJudge(scene).judge(probe.window_pixels());
}

}  // namespace terrella::bench
