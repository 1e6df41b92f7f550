#include "globe/globe_options.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/range_check.h"
#include "geo/ranges.h"

namespace terrella {
namespace {

using Milliseconds = std::chrono::duration<double, std::milli>;
constexpr double kDay_ms = Milliseconds(std::chrono::hours(24)).count();

bool is_whole(const GreyPicture& map) {
  if (map.values.empty()) return true;
  return map.width_px > 0 && map.height_px > 0 &&
         map.values.size() == static_cast<std::size_t>(map.width_px) * static_cast<std::size_t>(map.height_px);
}

bool is_drawable(const Star& star) {
  const glm::vec3 sums = star.direction_j2000 + star.color_linear;
  return std::isfinite(sums.x + sums.y + sums.z + star.magnitude);
}

}  // namespace

Status check_budget(const GlobeBudget& budget) {
  constexpr double kMostMeshes = std::numeric_limits<int>::max();
  return RangeCheck()
      .that(budget.upload_bytes_per_frame > 0, "upload_bytes_per_frame is 0; give 1 or more")
      .in("upload_time_per_frame", Milliseconds(budget.upload_time_per_frame).count(), 0.0, kDay_ms, " ms")
      .in("relief_meshes_per_frame", budget.relief_meshes_per_frame, 1, kMostMeshes)
      .result();
}

Status check_exaggeration(double exaggeration) {
  return RangeCheck().in("the exaggeration", exaggeration, 0.0, 100.0).result();
}

Status check_options(const GlobeOptions& o) {
  return RangeCheck()
      .part("body", check_ellipsoid(o.body.ellipsoid))
      .known("texturing", o.texturing, Texturing::automatic)
      .known("depth", o.depth, DepthMode::standard)
      .known("gl_contract", o.gl_contract, GlContract::leave)
      .in("polar_columns", o.polar_columns, 1, 4096)
      .in("texels_per_pixel", o.texels_per_pixel, 0.125, 8.0)
      .in("max_error_px", o.max_error_px, 0.01, 16.0)
      .in("segments", o.segments, 2, 128)
      .that(o.segments % 2 == 0, "segments is an odd number; give an even one")
      .in("gutter_px", o.gutter_px, 0, 64)
      .part("surface", check_surface(o.surface))
      .part("exaggeration", check_exaggeration(o.exaggeration))
      .part("stereo", check_stereo(o.stereo))
      .that(std::ranges::all_of(o.stars, is_drawable), "a star has a value that is not finite; leave it out")
      .that(is_whole(o.night_lights), "night_lights has not width · height values; give one for each pixel, or none")
      .part("the budget", check_budget(budget_of(o)))
      .in("workers", o.workers, 0, 64)
      .above("retry_after", Milliseconds(o.retry_after).count(), 0.0, 365.0 * kDay_ms, " ms")
      .result();
}

}  // namespace terrella
