#include "globe/globe_view.h"

#include <algorithm>
#include <utility>

#include "base/range_check.h"
#include "geo/ranges.h"
#include "globe/globe_impl.h"

// Views of a globe: the calls that Globe makes for its main view, and GlobeView for others.
namespace terrella {
namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kNoGlobe = "the view's globe is gone";
// Longest wait for a tile before checking for due retries.
constexpr std::chrono::milliseconds kLook{100};
// Far beyond every framebuffer, and far from the end of the integers.
constexpr double kMostCorner_px = 1e6;

}  // namespace

void Globe::Impl::end_views() {
  for (GlobeView::Impl* view : views) {
    view->stack.clear();
    view->planned.clear();
    view->memory = {};
    view->ground = {};
    view->globe = nullptr;
  }
  views.clear();
}

Status GlobeView::Impl::may_call(const char* call) const {
  if (globe != nullptr) return globe->may_call(call);
  return misuse(call, kNoGlobe);
}

Result<GlScope> GlobeView::Impl::may_draw(const char* call) const {
  if (globe != nullptr) return globe->may_draw(call);
  return misuse(call, kNoGlobe);
}

bool GlobeView::Impl::on_thread(const char* call) const {
  if (std::this_thread::get_id() == thread) return true;
  static_cast<void>(misuse(call, kOtherThread));
  return false;
}

bool GlobeView::Impl::may_set(const char* call, const Status& good) {
  if (!may_call(call)) return false;
  if (good) return true;
  refused = status = refusal(call, good);
  changed = true;
  return false;
}

Status GlobeView::Impl::may_begin(const char* call, Viewport viewport, glm::ivec2 corner_px) {
  if (!refused) return std::exchange(refused, Done{});
  const int most_px = globe->renderer->longest_side_px();
  const Status good = RangeCheck()
                          .in("the width of the picture", viewport.width_px, 1, most_px, " px")
                          .in("the height of the picture", viewport.height_px, 1, most_px, " px")
                          .in("corner_px.x", corner_px.x, -kMostCorner_px, kMostCorner_px)
                          .in("corner_px.y", corner_px.y, -kMostCorner_px, kMostCorner_px)
                          .result();
  return good ? good : refusal(call, good);
}

const Status& GlobeView::Impl::last_status(const char* call) const {
  if (std::this_thread::get_id() == thread) return status;
  thread_local Status elsewhere = Done{};
  elsewhere = misuse(call, kOtherThread);
  return elsewhere;
}

void GlobeView::Impl::set_camera(const Camera& to) {
  if (to == camera) return;  // callers set the camera every frame; this keeps the reduced detail
  camera = to;
  restore_detail();
}

void GlobeView::Impl::set_stereo(const StereoLook& look) {
  stereo = look;
  restore_detail();
}

FrameStats GlobeView::Impl::render(const char* call, unsigned framebuffer, Viewport viewport, glm::ivec2 corner_px,
                                   Draw when) {
  FrameStats drawn_stats;
  {
    const auto scope = may_draw(call);
    if (!scope) {
      if (std::this_thread::get_id() == thread) status = scope.error();
      return drawn_stats;
    }
    status = may_begin(call, viewport, corner_px);
    if (status) drawn_stats = draw(framebuffer, viewport, corner_px, when);
  }
  tell_settled();
  return drawn_stats;
}

bool GlobeView::Impl::render_until_settled(const char* call, unsigned framebuffer, Viewport viewport,
                                           Clock::time_point deadline) {
  if (!may_call(call)) return false;
  for (;;) {
    const bool last = Clock::now() >= deadline;
    render(call, framebuffer, viewport, {0, 0}, last ? Draw::always : Draw::when_settled);
    if (settled()) return true;
    if (last || !status) return false;
    ArrivalBell& bell = *globe->bell;
    while (!needs_frame() && Clock::now() < deadline) bell.wait_until(std::min(deadline, Clock::now() + kLook));
  }
}

bool GlobeView::Impl::settle_heights(const char* call, unsigned framebuffer, Viewport viewport,
                                     Clock::time_point deadline) {
  while (may_call(call) && Clock::now() < deadline) {
    render(call, framebuffer, viewport, {0, 0}, Draw::never);
    if (!status || has_settled_heights()) return bool(status);
    // Tiles that arrive one by one would make the ground, and with it the next tiles, depend on their order.
    ArrivalBell& bell = *globe->bell;
    const auto waits = [this] { return !globe->heights->has_all() || !needs_frame(); };
    while (waits() && Clock::now() < deadline) bell.wait_until(std::min(deadline, Clock::now() + kLook));
  }
  return false;
}

Status GlobeView::Impl::copy_depth(const char* call, unsigned framebuffer, glm::ivec2 corner_px) {
  const auto scope = may_draw(call);
  if (!scope) return scope.error();
  if (frame == 0) return Error{std::string(call) + ": the view has drawn no frame; draw one first"};
  if (!memory.has_picture()) {
    return Error{std::string(call) +
                 ": another view of the globe has been drawn since; copy the depth right after the view's own frame"};
  }
  const Status copied = globe->renderer->copy_depth(*memory.targets, framebuffer, corner_px);
  return copied ? copied : refusal(call, copied);
}

void GlobeView::Impl::set_on_draw(std::function<void(DrawStage, const FrameMatrices&)> draws) {
  on_draw = std::move(draws);
  changed = true;
}

bool GlobeView::Impl::needs_frame() const {
  if (globe == nullptr) return false;
  if (globe->changed || changed || frame == 0 || stats.heights_arrived || stats.relief_put_off > 0 || stats.air_put_off)
    return true;
  if (globe->heights && globe->heights->has_news(heights_seen, stats.heights_pending > 0)) return true;
  if (std::ranges::any_of(globe->objects, &ObjectLayer::has_news)) return true;
  if (globe->has_ground() && globe->ground_pictures->has_news()) return true;
  return std::ranges::any_of(planned, [](const LayerView* layer) { return layer->has_news(); });
}

bool GlobeView::Impl::needs_frame(unsigned framebuffer, Viewport viewport) const {
  return drawn != viewport || drawn_into != framebuffer || needs_frame();
}

// True if each patch with tiles of a layer of the stack lies under opaque tiles of a layer over it.
bool GlobeView::Impl::is_hidden(std::size_t layer) const {
  std::vector<const PatchNode*> covered;
  for (std::size_t over = layer + 1; over < stack.size(); ++over) {
    if (!stack[over]->hides()) continue;
    const std::vector<SelectedPatch>& patches = stack[over]->patches();
    for (std::size_t k = 0; k < patches.size(); ++k) {
      if (stack[over]->is_full(k)) covered.push_back(&patches[k].body());
    }
  }
  std::ranges::sort(covered);
  const std::vector<SelectedPatch>& patches = stack[layer]->patches();
  for (std::size_t k = 0; k < patches.size(); ++k) {
    if (stack[layer]->has_tiles(k) && !std::ranges::binary_search(covered, &patches[k].body())) return false;
  }
  return true;
}

std::vector<std::string> GlobeView::Impl::attributions() const {
  std::vector<std::string> texts;
  const auto add = [&texts](const std::string& text) {
    if (!text.empty() && std::ranges::find(texts, text) == texts.end()) texts.push_back(text);
  };
  for (std::size_t k = 0; k < stack.size(); ++k) {
    if (stack[k]->is_on_screen() && !is_hidden(k)) add(stack[k]->layer().attribution());
  }
  if (stack.empty() || stack.front()->patches().empty()) return texts;
  if (globe->heights && globe->heights->is_on_screen()) add(globe->heights->attribution());
  for (const ObjectLayer& layer : globe->objects) {
    if (layer.is_drawn()) add(layer.attribution);
  }
  return texts;
}

std::optional<double> GlobeView::Impl::finest_texel_m() const {
  std::optional<double> finest;
  const double degree_m = globe->options.body.ellipsoid.a_m() * Angle::degrees(1.0).rad();
  for (const LayerView* layer : stack) {
    if (!layer->is_on_screen()) continue;
    const TileGrid& grid = layer->layer().grid();
    const double texel_m = tile_span_deg(grid, grid.max_level) / grid.tile_px * degree_m;
    finest = std::min(finest.value_or(texel_m), texel_m);
  }
  return finest;
}

GlobeView::GlobeView(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Result<std::unique_ptr<GlobeView>> GlobeView::create(Globe& globe) {
  Globe::Impl& data = *globe.impl_;
  if (Status call = data.may_call("GlobeView::create"); !call) return call.error();
  std::unique_ptr<GlobeView> view(new GlobeView(std::make_unique<Impl>(data, data.next_view())));
  data.views.push_back(view->impl_.get());
  return view;
}

GlobeView::~GlobeView() {
  Globe::Impl* globe = impl_->globe;
  if (globe == nullptr) return;
  static_cast<void>(globe->may_call("GlobeView::~GlobeView"));
  std::erase(globe->views, impl_.get());
  for (ImageLayer* layer : globe->all_images()) layer->forget(impl_->id);
  if (globe->plain) globe->plain->forget(impl_->id);
}

void GlobeView::set_camera(const Camera& camera) {
  if (impl_->may_set("GlobeView::set_camera", check_camera(camera))) impl_->set_camera(camera);
}

const Camera& GlobeView::camera() const { return if_allowed(impl_->on_thread("GlobeView::camera"), impl_->camera); }

void GlobeView::set_stereo(const StereoLook& stereo) {
  if (impl_->may_set("GlobeView::set_stereo", check_stereo(stereo))) impl_->set_stereo(stereo);
}

FrameStats GlobeView::render(unsigned framebuffer, Viewport viewport, glm::ivec2 corner_px) {
  return impl_->render("GlobeView::render", framebuffer, viewport, corner_px);
}

const FrameStats& GlobeView::last_frame() const {
  return if_allowed(impl_->on_thread("GlobeView::last_frame"), impl_->stats);
}
const Status& GlobeView::status() const { return impl_->last_status("GlobeView::status"); }

void GlobeView::on_draw(std::function<void(DrawStage, const FrameMatrices&)> draw) {
  if (impl_->may_call("GlobeView::on_draw")) impl_->set_on_draw(std::move(draw));
}

unsigned GlobeView::depth_texture() const {
  return impl_->on_thread("GlobeView::depth_texture") ? impl_->depth_texture() : 0;
}

Status GlobeView::copy_depth(unsigned framebuffer, glm::ivec2 corner_px) {
  return impl_->copy_depth("GlobeView::copy_depth", framebuffer, corner_px);
}

bool GlobeView::settled() const {
  return impl_->on_thread("GlobeView::settled") && impl_->globe != nullptr && impl_->settled();
}

void GlobeView::on_settled(std::function<void()> told) {
  if (impl_->on_thread("GlobeView::on_settled")) impl_->on_settled = std::move(told);
}

bool GlobeView::needs_frame() const { return impl_->on_thread("GlobeView::needs_frame") && impl_->needs_frame(); }

bool GlobeView::needs_frame(unsigned framebuffer, Viewport viewport) const {
  return impl_->on_thread("GlobeView::needs_frame") && impl_->globe != nullptr &&
         impl_->needs_frame(framebuffer, viewport);
}

bool GlobeView::render_until_settled(unsigned framebuffer, Viewport viewport, Clock::time_point deadline) {
  return impl_->render_until_settled("GlobeView::render_until_settled", framebuffer, viewport, deadline);
}

std::vector<std::string> GlobeView::attributions() const {
  return impl_->may_call("GlobeView::attributions") ? impl_->attributions() : std::vector<std::string>{};
}

std::optional<double> GlobeView::finest_texel_m() const {
  return impl_->may_call("GlobeView::finest_texel_m") ? impl_->finest_texel_m() : std::nullopt;
}

GlobePick GlobeView::pick(glm::dvec2 pixel_px, Viewport viewport) const {
  return impl_->may_call("GlobeView::pick") ? impl_->pick(pixel_px, viewport) : GlobePick{};
}

std::optional<glm::dvec2> GlobeView::project(const Geodetic& place, Viewport viewport) const {
  return impl_->may_call("GlobeView::project") ? impl_->project(place, viewport) : std::nullopt;
}

View GlobeView::view(Viewport viewport) const { return impl_->eye_view("GlobeView::view", viewport); }

}  // namespace terrella
