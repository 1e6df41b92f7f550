#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>

#include "globe/globe_impl.h"
#include "surface/far_side_curtain.h"

// One frame: takes tiles from the loaders, selects patches, requests tiles, draws.
namespace terrella {
namespace {

using FrameClock = std::chrono::steady_clock;

// A lit picture shows ground up to the limb, so texels there are closer to a pixel's width, and pixels may be longer. A
// view of the whole globe takes 15 % more tiles. A picture of the imagery alone keeps what measurements compare.
constexpr double kLitPixel_texels = 24.0, kLitSlantPower = 0.25;

// Until a clock says where the sun is: over the viewer's left shoulder, so that what one looks at is lit.
glm::dvec3 sun_over_the_shoulder(const View& view) {
  return glm::normalize(glm::normalize(view.eye.xyz_m) - 0.45 * view.right + 0.35 * view.up);
}

}  // namespace

// The lowest drawn layer must be opaque. If it is not, a plain colour lies under it.
void Globe::Impl::stack_layers() {
  stack.clear();
  for (const auto& layer : images) {
    if (layer->is_drawn(has_night())) {
      stack.push_back(layer.get());
    } else {
      layer->stop_asking();
    }
  }
  if (stack.empty() || !stack.front()->is_opaque(has_night())) {
    if (!plain) plain = ImageLayer::make_plain(setup());
    stack.insert(stack.begin(), plain.get());
  }
}

// In side-by-side stereo each eye gets half the width.
Viewport Globe::Impl::eye_picture(Viewport viewport) const {
  if (options.stereo.mode == Stereo::side_by_side) viewport.width_px = std::max(1, viewport.width_px / 2);
  return viewport;
}

void Globe::Impl::look(Viewport viewport) {
  view = make_view(camera, options.body.ellipsoid, eye_picture(viewport));
  eyes.reset();
  if (options.stereo.mode == Stereo::off) return;
  eyes = stereo_eyes(view, ground(), options.stereo);
  view = eyes->both;
}

PatchSelectionOptions Globe::Impl::selection_options() const {
  PatchSelectionOptions selection;
  selection.max_error_px = options.max_error_px;
  selection.max_polar_columns = options.polar_columns;
  selection.horizon_culling = options.surface.horizon_culling;
  selection.relief = relief();
  if (!options.unlit) {
    selection.max_footprint_texels = kLitPixel_texels;
    selection.slant_power = kLitSlantPower;
  }
  selection.mesh_budget = options.relief_meshes_per_frame;
  if (options.surface.inner_sphere_below_m) {
    const Ellipsoid& e = options.body.ellipsoid;
    selection.inner_sphere_m = inner_sphere_radius_m(e.a_m(), e.b_m(), *options.surface.inner_sphere_below_m);
  }
  return selection;
}

FrameSnapshot Globe::Impl::snapshot() {
  if (heights) relief()->refresh_bounds(stack.front()->tree());
  FrameSnapshot snapshot{.layers = {}, .sun = {}, .patch_shuffle = experiments.patch_shuffle};
  if (has_night()) snapshot.sun = sun();
  for (ImageLayer* layer : stack) snapshot.layers.push_back(layer->snapshot());
  return snapshot;
}

void Globe::Impl::execute(FramePlan& plan) {
  for (std::size_t k = 0; k < stack.size(); ++k) stack[k]->execute(plan.layers[k], frame);
  if (heights) stats.relief_meshes = relief()->make_meshes(stack.front()->tree(), plan.meshes);
  for (std::size_t k = 1; heights && k < stack.size(); ++k) stack[k]->copy_relief();
  stats.relief_put_off = plan.put_off;
}

// In each frame a different layer is the first to upload.
std::size_t Globe::Impl::take_finished() {
  UploadAllowance allowance{options.upload_bytes_per_frame, FrameClock::now() + options.upload_time_per_frame};
  std::size_t bytes = 0;
  for (std::size_t k = 0; k < images.size(); ++k) {
    bytes += images[(k + frame) % images.size()]->take_finished(allowance, frame, missing);
  }
  return bytes;
}

// Without a time there is no Sun to draw; light comes from over the viewer's shoulder.
std::optional<SkyInput> Globe::Impl::sky() const {
  if (!almanac || !sky_on || options.unlit) return std::nullopt;
  SkyInput input{.almanac = *almanac};
  if (!options.time) {
    input.almanac.sun = EcefDir{sun()};
    input.sun = input.moon = false;
  }
  return input;
}

glm::dvec3 Globe::Impl::sun() const { return almanac && options.time ? almanac->sun.xyz : sun_over_the_shoulder(view); }

FrameInput Globe::Impl::frame_input(Viewport viewport, glm::ivec2 corner_px) {
  FrameInput input{.size = viewport,
                   .corner_px = corner_px,
                   .view = view,
                   .eyes = eyes,
                   .stereo = options.stereo.mode,
                   .layers = {},
                   .relief = relief(),
                   .surface = options.surface,
                   .sky = sky(),
                   .lit = !options.unlit,
                   .earth = options.body.name == "earth",
                   .timed = options.time.has_value(),
                   .sun = sun(),
                   .frame = frame,
                   .ground_m = ground().height_m(camera.eye.lat, camera.eye.lon),
                   .on_draw = &on_draw,
                   .paper_a = experiments.paper_a,
                   .paper_band = experiments.paper_band,
                   .naive_translucency = experiments.naive_translucency};
  for (ImageLayer* layer : stack) input.layers.push_back(layer->frame(layer == stack.front(), has_night()));
  return input;
}

void Globe::Impl::count() {
  const ImageLayer& first = *stack.front();
  stats.patches = static_cast<int>(first.patches().size());
  for (const SelectedPatch& patch : first.patches()) stats.band_patches += patch.in_band ? 1 : 0;
  stats.patches_uncovered = first.coverage().uncovered;
  stats.height_bytes = heights ? relief()->bytes() : 0;
  for (ImageLayer* layer : stack) {
    stats.gpu_bytes += layer->gpu_bytes();
    stats.patches_held += layer->tree().size();
    stats.tiles_known += layer->tiles_known();
    if (layer == plain.get()) continue;
    stats.tiles_wanted += layer->coverage().tiles;
    stats.tiles_pending += layer->coverage().pending;
    stats.tiles_missing += layer->coverage().missing;
    stats.imagery_shown = stats.imagery_shown || layer->coverage().shown;
  }
}

// Chooses and requests what the frame draws.
void Globe::Impl::plan(Viewport viewport) {
  const auto start = FrameClock::now();
  look(viewport);
  last_plan = plan_frame(view, snapshot(), selection_options(), std::move(last_plan));
  execute(last_plan);
  stats.selection_ms = std::chrono::duration<double, std::milli>(FrameClock::now() - start).count();
  for (ImageLayer* layer : stack) layer->ask();
  if (!heights) return;
  stats.heights_pending = heights->ask(stack.front()->patches());
  stats.heights_missing = relief()->missing();
}

FrameStats Globe::Impl::draw(unsigned framebuffer, Viewport viewport, glm::ivec2 corner_px) {
  stats = {};
  ++frame;
  changed = false;
  if (viewport != drawn) restore_detail();
  drawn = viewport;
  drawn_into = framebuffer;
  stats.uploaded_bytes = take_finished();
  stats.objects_cut = std::exchange(objects_cut, 0);
  stack_layers();
  plan(viewport);
  const Result<FrameCounts> counts = renderer->draw(frame_input(viewport, corner_px), framebuffer);
  status = counts ? Status(Done{}) : counts.error();
  if (counts) {
    stats.draw_calls = counts->draw_calls;
    stats.triangles = counts->triangles;
  }
  for (ImageLayer* layer : stack) layer->end_frame(frame);
  count();
  // Heights are taken after the picture is drawn, so that code that steers the eye sees new ground before it is drawn.
  if (heights) {
    ImageLayer& base = *stack.front();
    stats.heights_arrived =
        heights->take_finished(base.tree(), base.patches(), options.relief_meshes_per_frame, missing_heights);
  }
  return stats;
}

bool Globe::Impl::settled() const {
  if (frame == 0 || !status) return false;
  if (stats.heights_pending > 0 || stats.heights_arrived || stats.relief_put_off > 0) return false;
  return std::ranges::all_of(stack, [](ImageLayer* layer) { return layer->settled(); });
}

void Globe::Impl::restore_detail() {
  changed = true;
  for (const auto& layer : images) layer->restore_detail();
}

}  // namespace terrella
