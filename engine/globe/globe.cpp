#include "globe/globe.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "geo/ranges.h"
#include "globe/globe_impl.h"

// Making a globe, its settings and its frames. Each call first checks thread and context.
namespace terrella {
namespace {

// Sky for stars without a time: any instant will do; this one is noon of an equinox.
constexpr UtcTime kQuietSky{std::chrono::sys_days{std::chrono::year{2026} / 3 / 20} + std::chrono::hours{12}};
constexpr const char* kOtherContext =
    "another OpenGL context is current than the one that the globe was made in; contexts do not share vertex arrays "
    "and "
    "framebuffers, so draw into a texture in the globe's context, and show the texture in the other one";

// Bodies of dust without air or ice.
bool is_dusty(const Body& body) {
  constexpr std::array<std::string_view, 6> kDusty{"moon", "mercury", "phobos", "deimos", "ceres", "vesta"};
  return std::ranges::find(kDusty, body.name) != kDusty.end();
}

bool has_context() { return glGetString(GL_VERSION) != nullptr; }

Status check_context() {
  if (!has_context()) return Error{"Globe::create: no OpenGL context is current on this thread; make one current"};
  if (const int version = epoxy_gl_version(); version < 45 || !epoxy_is_desktop_gl()) {
    return Error{"Globe::create: the current context is OpenGL " + std::string(epoxy_is_desktop_gl() ? "" : "ES ") +
                 std::to_string(version / 10) + "." + std::to_string(version % 10) + "; the globe needs OpenGL 4.5"};
  }
  return Done{};
}

// Sets the GL state that drawing depends on.
GlScope enter(GlContract contract) {
  if (contract == GlContract::restore) return std::make_unique<GlState>();
  set_first_gl_state();
  return nullptr;
}

}  // namespace

Error misuse(const char* call, const char* why) {
#ifndef NDEBUG
  std::fprintf(stderr, "terrella: %s: %s\n", call, why);
  std::abort();
#endif
  return Error{std::string(call) + ": " + why};
}

Status Globe::Impl::may_call(const char* call) const {
  if (std::this_thread::get_id() == thread) return Done{};
  return misuse(call, kOtherThread);
}

Result<GlScope> Globe::Impl::may_draw(const char* call) const {
  if (Status allowed = may_call(call); !allowed) return allowed.error();
  if (!has_context()) return misuse(call, "no OpenGL context is current");
  if (!renderer->is_of_current_context()) return misuse(call, kOtherContext);
  return enter(options.gl_contract);
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
  if (const Status good = check_options(options); !good) return refusal("Globe::create", good);
  if (const Status context = check_context(); !context) return context.error();
  const GlScope scope = enter(options.gl_contract);
  gl::find_deletes();
  auto impl = std::make_unique<Impl>(options);
  impl->main.reset(new GlobeView(std::make_unique<GlobeView::Impl>(*impl, impl->next_view())));
  impl->views.push_back(&impl->first());
  impl->first().stereo = options.stereo;
  SkyAssets sky{.body = options.body, .stars = options.stars, .night_lights = {}};
  if (options.sky || options.time) {
    const Result<Almanac> almanac = almanac_at(options.time.value_or(kQuietSky));
    if (!almanac) return almanac.error();
    impl->almanac = *almanac;
    impl->sky_on = options.sky;
    if (options.time && options.body.name == "earth") sky.night_lights = options.night_lights;
  }
  const PatchLight light{.relief = !options.unlit,
                         .bicubic = options.surface.sharpness != Sharpness::bilinear && !options.unlit};
  Result<std::unique_ptr<GlobeRenderer>> renderer = GlobeRenderer::create(
      {.texturing = options.texturing, .depth = options.depth, .regolith = is_dusty(options.body), .light = light},
      options.body.ellipsoid, options.sky ? &sky : nullptr);
  if (!renderer) return renderer.error();
  impl->renderer = std::move(*renderer);
  if (elevation) impl->heights = std::make_unique<HeightLayer>(*elevation, impl->options, impl->bell);
  impl->renderer->set_relief(elevation.has_value());
  impl->renderer->set_label_font(std::move(impl->options.label_font));
  return std::unique_ptr<Globe>(new Globe(std::move(impl)));
}

GlobeView& Globe::main_view() { return *impl_->main; }

void Globe::set_camera(const Camera& camera) {
  if (impl_->first().may_set("Globe::set_camera", check_camera(camera))) impl_->first().set_camera(camera);
}

const Camera& Globe::camera() const {
  return if_allowed(impl_->first().on_thread("Globe::camera"), impl_->first().camera);
}
const GlobeOptions& Globe::options() const {
  return if_allowed(impl_->first().on_thread("Globe::options"), impl_->options);
}

void Globe::set_unlit(bool unlit) {
  if (!impl_->may_call("Globe::set_unlit")) return;
  impl_->options.unlit = unlit;
  impl_->changed = true;
}

void Globe::set_surface(const SurfaceLook& surface) {
  if (!impl_->first().may_set("Globe::set_surface", check_surface(surface))) return;
  impl_->options.surface = surface;
  impl_->restore_detail();
}

void Globe::set_stereo(const StereoLook& stereo) {
  if (!impl_->first().may_set("Globe::set_stereo", check_stereo(stereo))) return;
  impl_->options.stereo = stereo;
  impl_->first().set_stereo(stereo);
}

void Globe::set_sky(bool on) {
  if (!impl_->may_call("Globe::set_sky")) return;
  impl_->sky_on = on && impl_->options.sky;
  impl_->changed = true;
}

void Globe::set_exaggeration(double exaggeration) {
  if (!impl_->first().may_set("Globe::set_exaggeration", check_exaggeration(exaggeration))) return;
  impl_->options.exaggeration = exaggeration;
  if (impl_->heights) impl_->relief()->set_exaggeration(exaggeration);
  impl_->changed = true;
}

Status Globe::set_time(std::optional<UtcTime> time) {
  if (Status call = impl_->may_call("Globe::set_time"); !call) return call;
  const Result<Almanac> almanac = almanac_at(time.value_or(kQuietSky));
  if (!almanac) return almanac.error();
  impl_->options.time = time;
  impl_->almanac = *almanac;
  impl_->changed = true;
  return Done{};
}

Status Globe::set_night_lights(bool on) {
  const auto call = impl_->may_draw("Globe::set_night_lights");
  if (!call) return call.error();
  const GlobeOptions& options = impl_->options;
  const bool has = options.sky && options.body.name == "earth" && !options.night_lights.values.empty();
  if (!has || on == has_night_lights()) return Done{};
  impl_->changed = true;
  return impl_->renderer->set_night_lights(on ? options.night_lights : GreyPicture{});
}

bool Globe::has_night_lights() const {
  return impl_->may_call("Globe::has_night_lights") && impl_->renderer->has_night_lights();
}

void Globe::set_budget(const GlobeBudget& budget) {
  const auto call = impl_->may_draw("Globe::set_budget");
  if (!call || !impl_->first().may_set("Globe::set_budget", check_budget(budget))) return;
  impl_->options.gpu_bytes = budget.gpu_bytes;
  impl_->options.upload_bytes_per_frame = budget.upload_bytes_per_frame;
  impl_->options.upload_time_per_frame = budget.upload_time_per_frame;
  impl_->options.relief_meshes_per_frame = budget.relief_meshes_per_frame;
  impl_->share_gpu();
  if (impl_->ground_pictures) impl_->ground_pictures->set_budget(impl_->ground_bytes());
  impl_->restore_detail();
}

Experiments& Experiments::of(Globe& globe) {
  globe.impl_->changed = true;
  return globe.impl_->experiments;
}

void Experiments::forget_imagery(Globe& globe) {
  Globe::Impl& own = *globe.impl_;
  if (!own.may_call("Experiments::forget_imagery")) return;
  for (ImageLayer* layer : own.all_images()) layer->forget_tiles();
  for (auto& [id, one] : own.following) {
    one.fades = false;
    one.step.reset();  // a date that another view lacked may be there
  }
  own.missing.clear();
  // Made anew from the objects by the next frame.
  for (auto* view : own.views) view->ground = {};
  own.ground_pictures.reset();
  own.changed = true;
}

bool Experiments::settle_heights(Globe& globe, unsigned framebuffer, Viewport viewport,
                                 std::chrono::steady_clock::time_point deadline) {
  return globe.impl_->first().settle_heights("Experiments::settle_heights", framebuffer, viewport, deadline);
}

// The calls of the main view.

FrameStats Globe::render(unsigned framebuffer, Viewport viewport, glm::ivec2 corner_px) {
  return impl_->first().render("Globe::render", framebuffer, viewport, corner_px);
}

bool Globe::render_until_settled(unsigned framebuffer, Viewport viewport,
                                 std::chrono::steady_clock::time_point deadline) {
  return impl_->first().render_until_settled("Globe::render_until_settled", framebuffer, viewport, deadline);
}

const FrameStats& Globe::last_frame() const {
  return if_allowed(impl_->first().on_thread("Globe::last_frame"), impl_->first().stats);
}
const Status& Globe::status() const { return impl_->first().last_status("Globe::status"); }
bool Globe::settled() const { return impl_->may_call("Globe::settled") && impl_->first().settled(); }
void Globe::on_settled(std::function<void()> told) {
  if (impl_->may_call("Globe::on_settled")) impl_->first().on_settled = std::move(told);
}

void Globe::on_draw(std::function<void(DrawStage, const FrameMatrices&)> draw) {
  if (impl_->may_call("Globe::on_draw")) impl_->first().set_on_draw(std::move(draw));
}

unsigned Globe::depth_texture() const {
  return impl_->may_call("Globe::depth_texture") ? impl_->first().depth_texture() : 0;
}

Status Globe::copy_depth(unsigned framebuffer, glm::ivec2 corner_px) {
  return impl_->first().copy_depth("Globe::copy_depth", framebuffer, corner_px);
}

bool Globe::needs_frame() const { return impl_->may_call("Globe::needs_frame") && impl_->first().needs_frame(); }
bool Globe::needs_frame(unsigned framebuffer, Viewport viewport) const {
  return impl_->may_call("Globe::needs_frame") && impl_->first().needs_frame(framebuffer, viewport);
}

std::vector<std::string> Globe::attributions() const {
  return impl_->may_call("Globe::attributions") ? impl_->first().attributions() : std::vector<std::string>{};
}

std::optional<double> Globe::finest_texel_m() const {
  return impl_->may_call("Globe::finest_texel_m") ? impl_->first().finest_texel_m() : std::nullopt;
}

std::vector<PictureBox> Globe::label_boxes() const {
  std::vector<PictureBox> boxes;
  if (!impl_->may_call("Globe::label_boxes")) return boxes;
  for (const auto& label : impl_->first().memory.labels.labels) boxes.push_back({label.box.low_px, label.box.high_px});
  return boxes;
}

View Globe::view(Viewport viewport) const { return impl_->first().eye_view("Globe::view", viewport); }

GlobePick Globe::pick(glm::dvec2 pixel_px, Viewport viewport) const {
  return impl_->may_call("Globe::pick") ? impl_->first().pick(pixel_px, viewport) : GlobePick{};
}

std::optional<glm::dvec2> Globe::project(const Geodetic& place, Viewport viewport) const {
  return impl_->may_call("Globe::project") ? impl_->first().project(place, viewport) : std::nullopt;
}

// The calls of data that all views share.

const std::deque<MissingTile>& Globe::missing_tiles() const {
  return if_allowed(impl_->first().on_thread("Globe::missing_tiles"), impl_->missing);
}
const std::deque<MissingTile>& Globe::missing_heights() const {
  return if_allowed(impl_->first().on_thread("Globe::missing_heights"), impl_->missing_heights);
}

LoaderCounts Globe::loading() const {
  LoaderCounts all;
  if (!impl_->may_call("Globe::loading")) return all;
  for (const ImageLayer* layer : impl_->all_images()) {
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

}  // namespace terrella
