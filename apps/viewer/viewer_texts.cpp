#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "apps/viewer/viewer.h"

// Texts of the window about the view: readout, credits, scale bar.
namespace terrella {
namespace {

constexpr double kScaleBar_px = 150.0;  // at 96 dots per inch
constexpr double kScaleBarShare = 0.5;  // largest share of the window's width

}  // namespace

PanelStatus Viewer::status(const View& view) {
  const Ground ground = globe_.ground();
  PanelStatus status;
  const auto cursor = input_.cursor_px();
  if (const auto place = cursor ? pick(view, ground, *cursor) : std::nullopt) {
    status.cursor = place_text(*place, pixel_step_deg(view, ground));
    if (const std::string value = layers_.value_at(*place, cursor->x); !value.empty()) status.cursor += "   " + value;
    const auto elevation_m = globe_.elevation_m(place->lat, place->lon);
    if (elevation_m) status.cursor += "   " + height_text(*elevation_m, ui_.units());
  }
  status.eye = "Altitude " + length_text(navigator_.camera().eye.height_m, ui_.units());
  const int loading = frame_.stats().tiles_pending;
  if (loading > 0) status.tiles = fmt::format("{} {} loading", loading, loading == 1 ? "tile" : "tiles");
  if (const auto& time = globe_.options().time) status.time = time_text(*time);
  status.message = messages_.text();
  status.is_fault = messages_.is_fault();
  status.job = job_text_;
  if (!pictures_.is_drawing()) status.attribution = fmt::format("{}", fmt::join(credits(), "   "));
  if (!status.attribution.empty()) last_attribution_ = status.attribution;
  status.last_attribution = last_attribution_;
  const double most_px = std::min(kScaleBar_px * window_.text_scale(), kScaleBarShare * view.viewport.width_px);
  status.scale = scale_bar(view, ground, most_px, ui_.units());
  return status;
}

// Dates and sources of the last frame.
std::vector<std::string> Viewer::credits() const {
  std::vector<std::string> credits = timeline_.shown();
  std::ranges::move(globe_.attributions(), std::back_inserter(credits));
  std::ranges::move(map_.attributions(), std::back_inserter(credits));
  return credits;
}

PictureOverlay Viewer::overlay() {
  return {.graticule = graticule_.is_on(), .map = map_.painter(), .legend = layers_.legend(), .credits = credits()};
}

}  // namespace terrella
