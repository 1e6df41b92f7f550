#include "globe/globe.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "globe/globe_impl.h"
#include "render/gl/gl_state.h"

// The façade. Each function checks that the call is allowed, then forwards it.
namespace terrella {
namespace {

using Clock = std::chrono::steady_clock;

// Sky for stars without a time: any instant will do; this one is noon of an equinox.
constexpr UtcTime kQuietSky{std::chrono::sys_days{std::chrono::year{2026} / 3 / 20} + std::chrono::hours{12}};
// Longest wait for a tile before checking for due retries.
constexpr std::chrono::milliseconds kLook{100};

bool has_context() { return glGetString(GL_VERSION) != nullptr; }

Status check_context() {
  if (!has_context()) return Error{"Globe::create: no OpenGL context is current on this thread; make one current"};
  if (const int version = epoxy_gl_version(); version < 45 || !epoxy_is_desktop_gl()) {
    return Error{"Globe::create: the current context is OpenGL " + std::string(epoxy_is_desktop_gl() ? "" : "ES ") +
                 std::to_string(version / 10) + "." + std::to_string(version % 10) + "; the globe needs OpenGL 4.5"};
  }
  return Done{};
}

// Conditions are written so that NaN is out of range too.
Status check_ranges(const GlobeOptions& o) {
  if (!(o.texels_per_pixel >= 0.125 && o.texels_per_pixel <= 8.0)) {
    return Error{"a globe's texels_per_pixel is from 0.125 to 8, not " + std::to_string(o.texels_per_pixel)};
  }
  if (!(o.max_error_px >= 0.01 && o.max_error_px <= 16.0)) {
    return Error{"a globe's max_error_px is from 0.01 to 16, not " + std::to_string(o.max_error_px)};
  }
  if (o.segments < 2 || o.segments > 128 || o.segments % 2 != 0) {
    return Error{"a globe's segments are an even number from 2 to 128, not " + std::to_string(o.segments)};
  }
  if (o.gutter_px < 0 || o.gutter_px > 64) {
    return Error{"a globe's gutter_px is from 0 to 64, not " + std::to_string(o.gutter_px)};
  }
  if (o.retry_after.count() <= 0) {
    return Error{"a globe's retry_after is positive, not " + std::to_string(o.retry_after.count()) + " ms"};
  }
  return Done{};
}

// Sets the state that drawing depends on. The value that it returns restores the caller's state when the call ends.
[[nodiscard]] std::optional<GlState> at_call(GlContract contract) {
  if (contract == GlContract::restore) return std::optional<GlState>(std::in_place);
  set_first_gl_state();
  return std::nullopt;
}

// Misuse: told at once where assertions are on.
bool refuse([[maybe_unused]] const char* call, [[maybe_unused]] const char* why) {
#ifndef NDEBUG
  std::fprintf(stderr, "terrella: %s: %s\n", call, why);
  std::abort();
#endif
  return false;
}

Error refused(const char* call) {
  return Error{std::string(call) + ": called from another thread than the globe's, or without its context"};
}

}  // namespace

bool Globe::Impl::may_call(const char* call) const {
  if (std::this_thread::get_id() == thread) return true;
  return refuse(call, "called from another thread than the one that the globe was made on");
}

bool Globe::Impl::may_draw(const char* call) const {
  if (!may_call(call)) return false;
  if (!has_context()) return refuse(call, "no OpenGL context is current");
  if (renderer && !renderer->is_of_current_context()) return refuse(call, "another OpenGL context is current");
  return true;
}

Globe::Globe(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Globe::~Globe() { static_cast<void>(impl_->may_call("Globe::~Globe")); }

Result<std::unique_ptr<Globe>> Globe::create(const GlobeOptions& options, std::shared_ptr<TileSource> imagery,
                                             std::optional<ElevationSource> elevation) {
  Result<std::unique_ptr<Globe>> globe = make(options, elevation);
  if (!globe) return globe;
  if (auto added = (*globe)->add_imagery(std::move(imagery)); !added) return added.error();
  return globe;
}

Result<std::unique_ptr<Globe>> Globe::create(const GlobeOptions& options) { return make(options, {}); }

Result<std::unique_ptr<Globe>> Globe::make(const GlobeOptions& options,
                                           const std::optional<ElevationSource>& elevation) {
  if (const Status ranges = check_ranges(options); !ranges) return ranges.error();
  if (const Status context = check_context(); !context) return context.error();
  const auto state = at_call(options.gl_contract);
  gl::find_deletes();
  auto impl = std::make_unique<Impl>(options);
  RenderOptions render;
  render.texturing = options.texturing;
  render.depth = options.depth;
  render.paper_a = options.paper_a;
  render.paper_band = options.paper_band;
  SkyAssets sky{.body = options.body, .stars = options.stars, .night_lights = {}};
  if (options.sky || options.time) {
    const Result<Almanac> almanac = almanac_at(options.time.value_or(kQuietSky));
    if (!almanac) return almanac.error();
    impl->almanac = *almanac;
    impl->sky_on = options.sky;
    if (options.time && options.body.name == "earth") sky.night_lights = options.night_lights;
  }
  Result<std::unique_ptr<GlobeRenderer>> renderer =
      GlobeRenderer::create(render, options.body.ellipsoid, options.sky ? &sky : nullptr);
  if (!renderer) return renderer.error();
  impl->renderer = std::move(*renderer);
  if (elevation) impl->make_relief(*elevation);
  if (Status made = impl->renderer->set_relief(elevation.has_value()); !made) return made.error();
  impl->renderer->set_label_font(std::move(impl->options.label_font));
  return std::unique_ptr<Globe>(new Globe(std::move(impl)));
}

Result<LayerId> Globe::add_imagery(std::shared_ptr<TileSource> source, const ImageLook& look) {
  if (!impl_->may_draw("Globe::add_imagery")) return refused("Globe::add_imagery");
  const auto state = at_call(impl_->options.gl_contract);
  return impl_->add_imagery(std::move(source), look);
}

Status Globe::set_look(LayerId imagery, const ImageLook& look) {
  if (!impl_->may_call("Globe::set_look")) return refused("Globe::set_look");
  return impl_->set_look(imagery, look);
}

Result<ImageLook> Globe::look(LayerId imagery) const {
  if (!impl_->may_call("Globe::look")) return refused("Globe::look");
  return impl_->look(imagery);
}

Status Globe::move(LayerId layer, std::size_t position) {
  if (!impl_->may_draw("Globe::move")) return refused("Globe::move");
  const auto state = at_call(impl_->options.gl_contract);
  return impl_->move(layer, position);
}

std::vector<LayerId> Globe::imagery() const {
  std::vector<LayerId> ids;
  if (!impl_->may_call("Globe::imagery")) return ids;
  for (const auto& layer : impl_->images) ids.push_back(layer->id());
  return ids;
}

Result<LayerId> Globe::add_objects(ObjectScene objects, bool shown) {
  if (!impl_->may_draw("Globe::add_objects")) return refused("Globe::add_objects");
  const auto state = at_call(impl_->options.gl_contract);
  return impl_->add_objects(std::move(objects), shown);
}

Status Globe::set_objects(LayerId layer, ObjectScene objects) {
  if (!impl_->may_draw("Globe::set_objects")) return refused("Globe::set_objects");
  const auto state = at_call(impl_->options.gl_contract);
  return impl_->set_objects(layer, std::move(objects));
}

Status Globe::show_objects(LayerId layer, bool shown) {
  if (!impl_->may_draw("Globe::show_objects")) return refused("Globe::show_objects");
  const auto state = at_call(impl_->options.gl_contract);
  return impl_->show_objects(layer, shown);
}

Status Globe::fade_objects(LayerId layer, double opacity) {
  if (!impl_->may_draw("Globe::fade_objects")) return refused("Globe::fade_objects");
  const auto state = at_call(impl_->options.gl_contract);
  return impl_->fade_objects(layer, opacity);
}

std::vector<LayerId> Globe::objects() const {
  std::vector<LayerId> ids;
  if (!impl_->may_call("Globe::objects")) return ids;
  for (const ObjectLayer& layer : impl_->objects) ids.push_back(layer.id);
  return ids;
}

Status Globe::remove(LayerId layer) {
  if (!impl_->may_draw("Globe::remove")) return refused("Globe::remove");
  const auto state = at_call(impl_->options.gl_contract);
  return impl_->remove(layer);
}

Status Globe::set_attribution(LayerId layer, std::string text) {
  if (!impl_->may_call("Globe::set_attribution")) return refused("Globe::set_attribution");
  return impl_->set_attribution(layer, std::move(text));
}

std::vector<std::string> Globe::attributions() const {
  if (!impl_->may_call("Globe::attributions")) return {};
  return impl_->attributions();
}

Status Globe::set_elevation(std::optional<ElevationSource> elevation) {
  if (!impl_->may_draw("Globe::set_elevation")) return refused("Globe::set_elevation");
  const auto state = at_call(impl_->options.gl_contract);
  return impl_->set_elevation(elevation);
}

bool Globe::has_relief() const { return impl_->relief != nullptr; }

void Globe::set_camera(const Camera& camera) {
  if (!impl_->may_call("Globe::set_camera")) return;
  // Callers set the camera every frame; an unchanged camera keeps the reduced detail.
  if (camera == impl_->camera) return;
  impl_->camera = camera;
  impl_->restore_detail();
}

const Camera& Globe::camera() const { return impl_->camera; }
const GlobeOptions& Globe::options() const { return impl_->options; }

void Globe::set_unlit(bool unlit) {
  if (!impl_->may_call("Globe::set_unlit")) return;
  impl_->options.unlit = unlit;
  impl_->changed = true;
}

void Globe::set_surface(const SurfaceLook& surface) {
  if (!impl_->may_call("Globe::set_surface")) return;
  impl_->options.surface = surface;
  impl_->restore_detail();
}

void Globe::set_stereo(const StereoLook& stereo) {
  if (!impl_->may_call("Globe::set_stereo")) return;
  impl_->options.stereo = stereo;
  impl_->restore_detail();
}

void Globe::set_sky(bool on) {
  if (!impl_->may_call("Globe::set_sky")) return;
  impl_->sky_on = on && impl_->options.sky;
  impl_->changed = true;
}

void Globe::set_exaggeration(double exaggeration) {
  if (!impl_->may_call("Globe::set_exaggeration")) return;
  impl_->options.exaggeration = exaggeration;
  if (impl_->relief) impl_->relief->set_exaggeration(exaggeration);
  impl_->changed = true;
}

Status Globe::set_time(std::optional<UtcTime> time) {
  if (!impl_->may_call("Globe::set_time")) return refused("Globe::set_time");
  const Result<Almanac> almanac = almanac_at(time.value_or(kQuietSky));
  if (!almanac) return almanac.error();
  impl_->options.time = time;
  impl_->almanac = *almanac;
  impl_->changed = true;
  return Done{};
}

void Globe::set_budget(const GlobeBudget& budget) {
  if (!impl_->may_draw("Globe::set_budget")) return;
  const auto state = at_call(impl_->options.gl_contract);
  impl_->options.gpu_bytes = budget.gpu_bytes;
  impl_->options.upload_bytes_per_frame = budget.upload_bytes_per_frame;
  impl_->options.upload_time_per_frame = budget.upload_time_per_frame;
  impl_->options.relief_meshes_per_frame = budget.relief_meshes_per_frame;
  impl_->share_gpu();
  impl_->restore_detail();
}

void Globe::set_patch_shuffle(std::optional<unsigned> seed) {
  impl_->patch_shuffle = seed;
  impl_->changed = true;
}

FrameStats Globe::render(unsigned framebuffer, Viewport viewport, glm::ivec2 corner_px) {
  if (!impl_->may_draw("Globe::render")) return {};
  FrameStats stats;
  {
    const auto state = at_call(impl_->options.gl_contract);
    stats = impl_->draw(framebuffer, viewport, corner_px);
  }
  const bool settled_before = std::exchange(impl_->was_settled, impl_->settled());
  if (impl_->was_settled && !settled_before && impl_->on_settled) impl_->on_settled();
  return stats;
}

const Status& Globe::status() const { return impl_->status; }
bool Globe::settled() const { return impl_->settled(); }
void Globe::on_settled(std::function<void()> told) { impl_->on_settled = std::move(told); }
bool Globe::needs_frame() const { return impl_->needs_frame(); }

bool Globe::render_until_settled(unsigned framebuffer, Viewport viewport, Clock::time_point deadline) {
  if (!impl_->may_draw("Globe::render_until_settled")) return false;
  for (;;) {
    render(framebuffer, viewport);
    if (settled()) return true;
    if (!status()) return false;
    while (!needs_frame() && Clock::now() < deadline) impl_->bell->wait_until(std::min(deadline, Clock::now() + kLook));
    if (Clock::now() >= deadline) return false;
  }
}

Ground Globe::ground() const { return impl_->ground(); }

double Globe::ground_height_m(Angle lat, Angle lon) const { return ground().height_m(lat, lon); }

std::optional<double> Globe::elevation_m(Angle lat, Angle lon) const {
  if (!impl_->relief) return std::nullopt;
  return impl_->relief->field().height_m(lat, lon);
}

const std::deque<MissingTile>& Globe::missing_tiles() const { return impl_->missing; }
const std::deque<MissingTile>& Globe::missing_heights() const { return impl_->missing_heights; }

LoaderCounts Globe::loading() const {
  LoaderCounts all;
  for (const auto& layer : impl_->images) {
    const LoaderCounts counts = layer->loading();
    all.waiting += counts.waiting;
    all.running += counts.running;
    all.fetching += counts.fetching;
    all.finished += counts.finished;
    all.read += counts.read;
    all.missing += counts.missing;
  }
  return all;
}

GlobePick Globe::pick(glm::dvec2 pixel_px, Viewport viewport) const {
  if (!impl_->may_call("Globe::pick")) return {};
  return impl_->pick(view(viewport), pixel_px);
}

std::optional<glm::dvec2> Globe::project(const Geodetic& place, Viewport viewport) const {
  if (!impl_->may_call("Globe::project")) return std::nullopt;
  const View eye = view(viewport);
  const Ecef at = impl_->options.body.ellipsoid.to_ecef(place);
  const auto pixel = terrella::project(eye, at);
  if (!pixel || pixel->x < 0.0 || pixel->y < 0.0 || pixel->x > viewport.width_px || pixel->y > viewport.height_px) {
    return std::nullopt;
  }
  return hidden_by_ground(eye, ground(), at) ? std::nullopt : pixel;
}

View Globe::view(Viewport viewport) const { return make_view(impl_->camera, impl_->options.body.ellipsoid, viewport); }

}  // namespace terrella
