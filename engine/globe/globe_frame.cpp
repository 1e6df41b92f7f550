#include <algorithm>
#include <cmath>
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

// Light until a clock tells the Sun's place: from over the viewer's left shoulder, so that ground in view is lit.
glm::dvec3 sun_over_the_shoulder(const View& view) {
  return glm::normalize(glm::normalize(view.eye.xyz_m) - 0.45 * view.right + 0.35 * view.up);
}

// A plain colour is nothing to blend with. Colours of unlit numbers take no light from a layer that blends with them.
void agree_on_blends(std::vector<LayerFrame>& layers, bool has_plain) {
  if (has_plain && layers.size() > 1) layers[1].blend = LayerBlend::normal;
  for (std::size_t k = 1; k < layers.size(); ++k) {
    if (layers[k].blend != LayerBlend::normal) layers[k].unlit = layers[k].unlit || layers[k - 1].unlit;
  }
}

}  // namespace

// The lowest drawn layer must be opaque. If it is not, a plain colour lies under it.
void GlobeView::Impl::stack_layers() {
  stack.clear();
  for (const auto& layer : globe->images) {
    if (layer->is_drawn(globe->sides()) && !layer->is_early()) {
      stack.push_back(&layer->seen_by(id));
      if (ImageLayer* next = globe->fade_over(*layer); next != nullptr) stack.push_back(&next->seen_by(id));
    } else {
      layer->stop_asking();
    }
  }
  if (stack.empty() || !stack.front()->layer().is_opaque(globe->sides())) {
    if (!globe->plain) globe->plain = ImageLayer::make_plain(globe->setup());
    stack.insert(stack.begin(), &globe->plain->seen_by(id));
  }
  planned = stack;
  for (const auto& layer : globe->coming) {
    LayerView& seen = layer->seen_by(id);
    if (std::ranges::find(stack, &seen) != stack.end()) continue;
    if (globe->image(layer->id())->is_drawn(globe->sides())) {
      planned.push_back(&seen);
    } else {
      layer->stop_asking();
    }
  }
}

// In side-by-side stereo each eye gets half the width.
Viewport GlobeView::Impl::eye_picture(Viewport viewport) const {
  if (stereo.mode == Stereo::side_by_side) viewport.width_px = std::max(1, viewport.width_px / 2);
  return viewport;
}

void GlobeView::Impl::look(Viewport viewport) {
  view = make_view(camera, globe->options.body.ellipsoid, eye_picture(viewport));
  eyes.reset();
  if (stereo.mode == Stereo::off) return;
  eyes = stereo_eyes(view, globe->ground(), stereo);
  view = eyes->both;
}

// Slopes may be nearer than the ground under the eye.
double GlobeView::Impl::clearance_m() const {
  return 0.5 * std::max(1.0, std::abs(globe->ground().height_over_m(camera.eye)));
}

PatchSelectionOptions GlobeView::Impl::selection_options() const {
  const GlobeOptions& options = globe->options;
  PatchSelectionOptions selection;
  selection.max_error_px = options.max_error_px;
  selection.max_polar_columns = options.polar_columns;
  selection.horizon_culling = options.surface.horizon_culling;
  selection.relief = globe->relief();
  if (!options.unlit) {
    selection.max_footprint_texels = kLitPixel_texels;
    selection.slant_power = kLitSlantPower;
    selection.columns_beside = true;
  }
  if (globe->has_ground()) {
    selection.most_patch_px = GroundPictures::kMostPatch_px;
    selection.clearance_m = clearance_m();
  }
  selection.mesh_budget = options.relief_meshes_per_frame;
  if (options.surface.inner_sphere_below_m) {
    const Ellipsoid& e = options.body.ellipsoid;
    selection.inner_sphere_m = inner_sphere_radius_m(e.a_m(), e.b_m(), *options.surface.inner_sphere_below_m);
  }
  return selection;
}

FrameSnapshot GlobeView::Impl::snapshot() {
  if (globe->heights) globe->relief()->refresh_bounds(stack.front()->tree());
  FrameSnapshot snapshot{.layers = {}, .sun = {}, .patch_shuffle = globe->experiments.patch_shuffle};
  if (globe->has_night()) snapshot.sun = sun();
  if (!globe->options.unlit) snapshot.light = sun();
  for (LayerView* layer : planned) snapshot.layers.push_back(layer->snapshot());
  return snapshot;
}

void GlobeView::Impl::execute(FramePlan& plan) {
  for (std::size_t k = 0; k < planned.size(); ++k) planned[k]->execute(plan.layers[k], frame);
  const bool heights = globe->heights != nullptr;
  if (heights) stats.relief_meshes = globe->relief()->make_meshes(stack.front()->tree(), plan.meshes);
  for (std::size_t k = 1; heights && k < planned.size(); ++k) planned[k]->copy_relief();
  stats.relief_put_off = plan.put_off;
}

// In each frame a different layer is the first to upload.
std::size_t Globe::Impl::take_finished() {
  UploadAllowance allowance{options.upload_bytes_per_frame, FrameClock::now() + options.upload_time_per_frame};
  std::size_t bytes = 0;
  const std::vector<ImageLayer*> all = all_images();
  for (std::size_t k = 0; k < all.size(); ++k) {
    bytes += all[(k + frame) % all.size()]->take_finished(allowance, frame, missing);
  }
  return bytes;
}

// Without a time there is no Sun to draw; light comes from over the viewer's shoulder.
std::optional<SkyInput> GlobeView::Impl::sky() const {
  if (!globe->almanac || !globe->sky_on || globe->options.unlit) return std::nullopt;
  SkyInput input{.almanac = *globe->almanac, .exact_air = still};
  if (!globe->options.time) {
    input.almanac.sun = EcefDir{sun()};
    input.sun = input.moon = false;
  }
  return input;
}

glm::dvec3 GlobeView::Impl::sun() const {
  return globe->almanac && globe->options.time ? globe->almanac->sun.xyz : sun_over_the_shoulder(view);
}

FrameInput GlobeView::Impl::frame_input(Viewport viewport, glm::ivec2 corner_px) {
  const GlobeOptions& options = globe->options;
  FrameInput input{.size = viewport,
                   .corner_px = corner_px,
                   .view = view,
                   .eyes = eyes,
                   .stereo = stereo.mode,
                   .layers = {},
                   .relief = globe->relief(),
                   .ground = ground.frame.empty() ? nullptr : &ground.frame,
                   .ground_gpu = &ground.gpu,
                   .surface = options.surface,
                   .sky = sky(),
                   .lit = !options.unlit,
                   .earth = options.body.name == "earth",
                   .timed = options.time.has_value(),
                   .sun = sun(),
                   .frame = frame,
                   .views = static_cast<int>(globe->views.size()),
                   .ground_m = globe->ground().height_m(camera.eye.lat, camera.eye.lon),
                   .on_draw = &on_draw,
                   .paper_a = globe->experiments.paper_a,
                   .paper_band = globe->experiments.paper_band,
                   .pixel_scale = globe->experiments.pixel_scale,
                   .naive_translucency = globe->experiments.naive_translucency,
                   .layers_one_by_one = globe->experiments.layers_one_by_one};
  for (LayerView* layer : stack) input.layers.push_back(layer->frame(layer == stack.front(), globe->sides()));
  agree_on_blends(input.layers, stack.front()->layer().id() == LayerId::none);
  return input;
}

void GlobeView::Impl::count() {
  const LayerView& first = *stack.front();
  stats.patches = static_cast<int>(first.patches().size());
  for (const SelectedPatch& patch : first.patches()) stats.band_patches += patch.in_band ? 1 : 0;
  stats.patches_uncovered = first.coverage().uncovered;
  stats.ground_left_out = ground.left_out;
  if (globe->ground_pictures) {
    stats.gpu_bytes += globe->ground_pictures->bytes();
    stats.gpu_memory_refused = stats.gpu_memory_refused || globe->ground_pictures->memory_refused();
  }
  stats.height_bytes = globe->heights ? globe->relief()->bytes() : 0;
  for (const LayerView* layer : planned) {
    stats.gpu_bytes += layer->layer().gpu_bytes();
    stats.gpu_bytes_granted += layer->layer().gpu_bytes_granted();
    stats.gpu_memory_refused = stats.gpu_memory_refused || layer->layer().tiles().memory_refused();
    stats.patches_held += layer->tree().size();
    stats.tiles_known += layer->layer().tiles_known();
  }
  for (const LayerView* layer : stack) {
    if (&layer->layer() == globe->plain.get()) continue;
    stats.tiles_wanted += layer->coverage().tiles;
    stats.tiles_pending += layer->coverage().pending;
    stats.tiles_missing += layer->coverage().missing;
    stats.imagery_shown = stats.imagery_shown || layer->coverage().shown;
  }
}

// Chooses the patches and tiles that the frame draws, and requests missing tiles.
void GlobeView::Impl::plan(Viewport viewport, Draw when) {
  const auto start = FrameClock::now();
  look(viewport);
  last_plan = plan_frame(view, snapshot(), selection_options(), std::move(last_plan));
  execute(last_plan);
  stats.selection_ms = std::chrono::duration<double, std::milli>(FrameClock::now() - start).count();
  if (when != Draw::never) {
    for (LayerView* layer : planned) layer->ask();
  }
  plan_ground();
  if (!globe->heights) return;
  stats.heights_pending = globe->heights->ask(viewers());
  stats.heights_missing = globe->relief()->missing();
}

void GlobeView::Impl::plan_ground() {
  if (!globe->has_ground()) {
    ground = {};
    return;
  }
  globe->ground_pictures->take_painted();
  globe->ground_pictures->plan({.view = view,
                                .tree = stack.front()->tree(),
                                .patches = stack.front()->patches(),
                                .has_relief = globe->heights != nullptr,
                                .clearance_m = clearance_m(),
                                .pixel_scale = globe->experiments.pixel_scale},
                               ground);
  std::vector<const ViewGround*> views;
  for (const Impl* each : globe->views) views.push_back(&each->ground);
  globe->ground_pictures->ask(views);
}

// This view first, then the other views that have drawn.
std::vector<HeightLayer::Viewer> GlobeView::Impl::viewers() const {
  std::vector<HeightLayer::Viewer> all{{stack.front()->tree(), stack.front()->patches()}};
  for (const Impl* other : globe->views) {
    if (other == this || other->stack.empty()) continue;
    all.push_back({other->stack.front()->tree(), other->stack.front()->patches()});
  }
  return all;
}

// Heights are taken after the picture is drawn, so that code that steers the eye sees new ground before it is drawn.
void GlobeView::Impl::take_heights() {
  if (!globe->heights) return;
  std::vector<HeightLayer::Viewer> all = viewers();
  globe->heights->take_finished(all, globe->options.relief_meshes_per_frame, globe->missing_heights);
  heights_seen = globe->heights->taken();
  auto viewer = all.begin();
  stats.heights_arrived = viewer->arrived;
  for (Impl* other : globe->views) {
    if (other != this && !other->stack.empty() && (++viewer)->arrived) other->stats.heights_arrived = true;
  }
}

void GlobeView::Impl::draw_picture(unsigned framebuffer, const FrameInput& input) {
  const Result<FrameCounts> counts = globe->renderer->draw(input, memory, framebuffer);
  status = counts ? Status(Done{}) : counts.error();
  if (!counts) return;
  stats.draw_calls = counts->draw_calls;
  stats.gpu_memory_refused = stats.gpu_memory_refused || counts->objects_left_out;
  stats.triangles = counts->triangles;
  stats.air_put_off = input.sky && memory.air && memory.air->is_rounded();
  stats.without_font = globe->renderer->without_font();
}

FrameStats GlobeView::Impl::draw(unsigned framebuffer, Viewport viewport, glm::ivec2 corner_px, Draw when) {
  globe->take_cuts();
  if (std::exchange(globe->changed, false)) {
    for (Impl* each : globe->views) each->changed = true;
  }
  stats = {};
  frame = ++globe->frame;
  if (viewport != drawn) restore_detail();
  still = when != Draw::always || std::pair(camera, globe->options.time) == drawn_at;
  drawn_at = {camera, globe->options.time};
  changed = is_behind = false;
  drawn = viewport;
  drawn_into = framebuffer;
  globe->follow_clock();
  stats.uploaded_bytes = globe->take_finished();
  stats.objects_cut = std::exchange(globe->objects_cut, 0);
  stack_layers();
  plan(viewport, when);
  status = Done{};
  const FrameInput input = frame_input(viewport, corner_px);
  // Programs are made while tiles are on their way.
  if (when == Draw::never || (when == Draw::when_settled && !settled())) {
    status = globe->renderer->prepare(input, memory, framebuffer);
  } else {
    if (when == Draw::when_settled) {
      for (LayerView* layer : stack) layer->layer().tiles().join_squeezed_again();
    }
    draw_picture(framebuffer, input);
  }
  for (LayerView* layer : planned) layer->layer().end_frame(*layer, frame);
  count();
  if (when != Draw::never || (globe->heights && globe->heights->has_all())) take_heights();
  globe->put_in_place();
  const bool fades_now = std::ranges::any_of(globe->images, [this](const auto& layer) {
    ImageLayer* next = globe->fade_over(*layer);
    return next != nullptr && layer->is_drawn(globe->sides()) && !layer->is_early() &&
           std::ranges::find(stack, &next->seen_by(id)) == stack.end();
  });
  for (Impl* each : globe->views) {
    if (fades_now) each->changed = each->is_behind = true;
  }
  return stats;
}

bool GlobeView::Impl::has_settled_heights() const {
  return stats.heights_pending == 0 && !stats.heights_arrived && stats.relief_put_off == 0;
}

bool GlobeView::Impl::settled() const {
  if (frame == 0 || !status || is_behind || !has_settled_heights() || stats.air_put_off) return false;
  if (std::ranges::any_of(globe->objects, &ObjectLayer::waits) || !ground.wants.empty()) return false;
  if (std::ranges::any_of(globe->coming, [this](const auto& layer) { return globe->is_awaited(*layer); })) return false;
  return std::ranges::all_of(
      planned, [this](const LayerView* layer) { return layer->settled() || globe->is_late(layer->layer()); });
}

void GlobeView::Impl::restore_detail() {
  changed = true;
  for (LayerView* layer : planned) layer->restore_detail();
}

void Globe::Impl::restore_detail() {
  changed = true;
  for (ImageLayer* layer : all_images()) layer->restore_detail();
}

void GlobeView::Impl::tell_settled() {
  const bool settled_before = std::exchange(was_settled, settled());
  if (was_settled && !settled_before && on_settled) on_settled();
}

}  // namespace terrella
