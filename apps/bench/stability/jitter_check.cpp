#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "apps/bench/stability/check.h"
#include "apps/bench/stability/patch_probe.h"

namespace terrella::bench {
namespace {

constexpr Viewport kWayPicture{1024, 1024};
constexpr double kMostJitter_px = 0.05;
constexpr double kMostVertexOff_px = 0.25;
// Fraction of a pixel on the ground per step; no vertex should show such steps.
constexpr double kStep = 0.001;

// Fields of view. The usual lens shows the whole globe from afar; the long lens shows a sixth of its width and reveals
// float errors. At a million kilometres a float's step is 64 m, 1/30 of a pixel of the long lens.
enum class Lens { usual, long_one };

Camera camera_from(double height_m, double pitch_deg, Lens lens) {
  const double a_m = earth().ellipsoid.a_m();
  const double disc_deg = 2.0 * Angle::radians(std::asin(a_m / (a_m + height_m))).deg();
  const double fov_deg = lens == Lens::long_one ? disc_deg / 6.0 : std::min(40.0, 1.1 * disc_deg);
  return {.eye = {.lat = Angle::degrees(47.123), .lon = Angle::degrees(8.456), .height_m = height_m},
          .heading = Angle::degrees(33.0),
          .pitch = Angle::degrees(pitch_deg),
          .fov_y = Angle::degrees(fov_deg)};
}

/// Differences in pixels between vertex positions by the GPU and in double.
class ScreenErrors {
 public:
  ScreenErrors(const PatchScene& scene, PatchProbe& probe) : scene_(scene), probe_(probe) {}

  /// Errors of the vertices that were in the picture at the start, wherever they are now; vertices behind the eye are
  /// skipped.
  std::vector<glm::dvec2> at(const View& view) {
    if (seen_.empty()) find_seen(view);
    const std::vector<glm::vec4> clip = probe_.positions(view);
    std::vector<glm::dvec2> errors;
    for (const std::size_t vertex : seen_) {
      const glm::dvec2 half(0.5 * kWayPicture.width_px, 0.5 * kWayPicture.height_px);
      const glm::dvec4 c(clip[vertex]);
      const glm::dvec2 gpu = half + glm::dvec2(c.x, -c.y) / c.w * half;
      errors.push_back(gpu - project(view, Ecef{scene_.position_m(vertex)}).value_or(gpu + 1e9));
    }
    return errors;
  }

 private:
  void find_seen(const View& view) {
    for (std::size_t k = 0; k < scene_.vertices.size(); ++k) {
      const auto pixel = project(view, Ecef{scene_.position_m(k)});
      if (pixel && pixel->x >= 0.0 && pixel->y >= 0.0 && pixel->x <= kWayPicture.width_px &&
          pixel->y <= kWayPicture.height_px)
        seen_.push_back(k);
    }
  }

  const PatchScene& scene_;
  PatchProbe& probe_;
  std::vector<std::size_t> seen_;
};

struct Worst {
  double off_px = 0.0, step_px = 0.0;
};

// Moves the eye in steps. Jitter is the change of a vertex's error between two steps.
Worst worst_of_way(const Camera& camera, PatchProbe& probe, int steps) {
  PatchScene scene(camera, kWayPicture, kMaxTileLevel);
  probe.load(scene);
  ScreenErrors errors(scene, probe);
  const double a_m = earth().ellipsoid.a_m();
  const double step_rad = kStep * camera.eye.height_m / (scene.view.pixels_per_radian() * a_m);
  Worst worst;
  std::vector<glm::dvec2> before;
  Camera moved = camera;
  for (int k = 0; k <= steps; ++k) {
    const std::vector<glm::dvec2> now = errors.at(make_view(moved, earth().ellipsoid, kWayPicture));
    for (std::size_t v = 0; v < now.size(); ++v) {
      worst.off_px = std::max(worst.off_px, glm::length(now[v]));
      if (!before.empty()) worst.step_px = std::max(worst.step_px, glm::distance(now[v], before[v]));
    }
    before = now;
    moved.eye.lon = moved.eye.lon + Angle::radians(step_rad / std::cos(moved.eye.lat.rad()));
    moved.eye.lat = moved.eye.lat + Angle::radians(0.7 * step_rad);
  }
  return before.empty() ? Worst{HUGE_VAL, HUGE_VAL} : worst;
}

struct Way {
  const char* name;
  double pitch_deg;
  Lens lens;
  double lowest_m, highest_m;
  double most_px;
};
constexpr Way kWays[] = {{"straight down", -90.0, Lens::usual, 1.0, 1.0e9, kMostJitter_px},
                         {"tilted", -20.0, Lens::usual, 1.0, 1.0e5, kMostJitter_px},
                         {"long lens", -90.0, Lens::long_one, 1.0e7, 1.0e9, std::numeric_limits<double>::quiet_NaN()}};

void check_from(const Way& way, double height_m, PatchProbe& probe, int steps, Checks& checks) {
  Check check{
      .test = "jitter", .subject = way.name, .at = height_m, .at_unit = "m", .unit = "px", .limit = way.most_px};
  Worst worst;
  check = timed(check, [&] {
    worst = worst_of_way(camera_from(height_m, way.pitch_deg, way.lens), probe, steps);
    return worst.step_px;
  });
  checks.push_back(check);
  check.test = "vertex position";
  check.error = worst.off_px;
  check.limit = kMostVertexOff_px;
  checks.push_back(check);
}

}  // namespace

Status check_jitter(const StabilityOptions& options, Checks& checks) {
  Result<PatchProbe> probe = PatchProbe::create(options.functions);
  if (!probe) return probe.error();
  for (const Way& way : kWays) {
    for (double height_m = way.lowest_m; height_m < 1.5 * way.highest_m; height_m *= options.quick ? 1e3 : 10.0) {
      check_from(way, height_m, *probe, options.quick ? 5 : 40, checks);
    }
  }
  return Done{};
}

}  // namespace terrella::bench
