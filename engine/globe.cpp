#include "engine/globe.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <random>
#include <string>

#include "render/globe_renderer.h"
#include "scene/relief.h"
#include "streaming/elevation/height_loader.h"

namespace terrella {
namespace {

using Clock = std::chrono::steady_clock;

// Any day will do for stars without a time: noon of an equinox.
constexpr UtcTime kQuietSky{std::chrono::sys_days{std::chrono::year{2026} / 3 / 20} + std::chrono::hours{12}};
constexpr int kMips = 4;
constexpr std::chrono::milliseconds kPoll{20};
constexpr std::size_t kMostLacking = 64;
constexpr std::chrono::seconds kRetryFailed{30};
// Steps by a quarter in which detail gives way to the budget: six tile levels.
constexpr int kMostCoarser = 16;

// Until a clock says where the sun is: over the viewer's left shoulder, so that what one looks at is lit.
glm::dvec3 sun_over_the_shoulder(const View& view) {
  return glm::normalize(glm::normalize(view.eye.xyz_m) - 0.45 * view.right + 0.35 * view.up);
}

bool same(const Camera& a, const Camera& b) {
  return a.eye.lat == b.eye.lat && a.eye.lon == b.eye.lon && a.eye.height_m == b.eye.height_m &&
         a.heading == b.heading && a.pitch == b.pitch && a.fov_y == b.fov_y;
}

bool same(Viewport a, Viewport b) { return a.width_px == b.width_px && a.height_px == b.height_px; }

void note(std::deque<LackingTile>& lacking, LackingTile tile) {
  lacking.push_back(std::move(tile));
  if (lacking.size() > kMostLacking) lacking.pop_front();
}

Status check_context() {
  if (epoxy_gl_version() < 45) return Error{"the globe needs a current OpenGL 4.5 context"};
  return Done{};
}

// Said so that NaN is outside too.
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
  return Done{};
}

// The other ways of texturing are there to be compared with: they take tiles as every tool knows them.
TileGrid grid_to_draw(const GlobeOptions& options, TileGrid grid) {
  const bool polar_program = options.texturing == Texturing::exact || options.texturing == Texturing::automatic;
  grid.reduced = grid.reduced && options.squeezed_rows && polar_program;
  return grid;
}

}  // namespace

struct Globe::Impl {
  Impl(const GlobeOptions& o, std::shared_ptr<TileSource> imagery, const std::optional<ElevationSource>& elevation)
      : options(o),
        grid(grid_to_draw(o, imagery->info().grid)),
        roots(root_tiles(grid)),
        layout{grid.tile_px, o.gutter_px},
        tree(o.body.ellipsoid, grid, o.segments, o.mapping),
        tiles(grid, layout, kMips, o.gpu_bytes),
        loader(std::move(imagery), {.workers = o.workers, .gutter = o.gutter_px, .mips = kMips}) {
    if (!elevation) return;
    relief = std::make_unique<Relief>(o.body.ellipsoid, elevation->grid(), o.exaggeration);
    heights = std::make_unique<HeightLoader>(*elevation);
    tree.set_relief(*relief);
  }

  [[nodiscard]] Viewport eye_picture(Viewport viewport) const;
  void select(Viewport viewport);
  void ask();
  void take_heights();
  void ask_heights();
  std::size_t take_finished();
  void note_lacking(const TileId& id, const TileFailure& failure);
  void retry_failed();
  FrameStats draw(unsigned framebuffer, Viewport viewport);
  [[nodiscard]] std::optional<SkyInput> sky() const;
  [[nodiscard]] glm::dvec3 sun() const;
  [[nodiscard]] Ground ground() const { return {options.body.ellipsoid, relief.get()}; }
  [[nodiscard]] double ground_m() const { return relief ? relief->height_m(camera.eye.lat, camera.eye.lon) : 0.0; }
  bool roots_decided();

  GlobeOptions options;
  TileGrid grid;
  std::vector<TileId> roots;
  SlotLayout layout;
  Camera camera;
  std::unique_ptr<Relief> relief;         ///< none: the ellipsoid
  std::unique_ptr<HeightLoader> heights;  ///< there if relief is
  PatchTree tree;
  TileTextures tiles;
  TileLoader loader;
  std::unique_ptr<GlobeRenderer> renderer;
  View view;  ///< what is selected for: the eye's, or both eyes'
  std::optional<EyePair> eyes;
  std::vector<SelectedPatch> patches;
  TileCoverage coverage;
  std::optional<Almanac> almanac;  ///< there if a sky can be drawn
  bool sky_on = false;
  std::optional<unsigned> patch_shuffle;
  std::uint64_t frame = 0;
  double detail = 1.0;  // less than 1 where the view wants more tiles than the budget holds
  Viewport drawn;       // the last frame's
  FrameStats stats;
  std::deque<LackingTile> lacking, lacking_heights;
  std::deque<std::pair<Clock::time_point, TileId>> failed;  ///< to be asked for again, the earliest first
};

// Of one eye, half of a side-by-side picture is all there is.
Viewport Globe::Impl::eye_picture(Viewport viewport) const {
  if (options.stereo.mode == Stereo::side_by_side) viewport.width_px = std::max(1, viewport.width_px / 2);
  return viewport;
}

void Globe::Impl::select(Viewport viewport) {
  view = make_view(camera, options.body.ellipsoid, eye_picture(viewport));
  eyes.reset();
  if (options.stereo.mode != Stereo::off) {
    eyes = stereo_eyes(view, ground(), options.stereo);
    view = eyes->both;
  }
  PatchSelectionOptions selection;
  selection.texels_per_pixel = options.texels_per_pixel * detail;
  selection.max_error_px = options.max_error_px;
  selection.max_polar_columns = options.polar_columns;
  selection.horizon_culling = options.surface.horizon_culling;
  if (options.surface.inner_sphere_below_m) {
    const Ellipsoid& e = options.body.ellipsoid;
    selection.inner_sphere_m = inner_sphere_radius_m(e.a_m(), e.b_m(), *options.surface.inner_sphere_below_m);
  }
  select_patches(tree, view, selection, patches);
  if (patch_shuffle) std::shuffle(patches.begin(), patches.end(), std::mt19937(*patch_shuffle));
  cover_with_tiles(tree, view, patches, tiles.residency(), frame, coverage, selection.texels_per_pixel);
}

// Root tiles come first: an ancestor for everything.
void Globe::Impl::ask() {
  std::vector<TileRequest> requests;
  for (const TileId& id : roots) {
    const TileResidency::Entry& entry = tiles.residency().entry(id);
    if (entry.state == TileState::unknown) requests.push_back({id, 1e9});
  }
  for (const WantedTile& wanted : coverage.wanted) requests.push_back({wanted.id, wanted.priority});
  loader.request(requests);
}

std::size_t Globe::Impl::take_finished() {
  const auto deadline = Clock::now() + options.upload_time_per_frame;
  std::size_t bytes = 0;
  while (bytes < options.upload_bytes_per_frame) {
    std::vector<LoadedTile> batch = loader.poll(1);
    if (batch.empty()) break;
    for (LoadedTile& tile : batch) {
      if (!tile.pixels) {
        note_lacking(tile.id, tile.pixels.error());
      } else if (tiles.upload(tile.id, tile.pixels->mips, frame)) {
        bytes += tiles.slot_bytes();
      }
    }
    if (Clock::now() > deadline) break;
  }
  return bytes;
}

// After the picture is drawn: who steers the eye sees the new ground before it is drawn. One by one, until the frame's
// share of meshes has to be made anew.
void Globe::Impl::take_heights() {
  if (!heights) return;
  for (int meshes = 0; meshes < options.relief_meshes_per_frame;) {
    std::vector<LoadedHeights> batch = heights->poll(1);
    if (batch.empty()) return;
    for (LoadedHeights& tile : batch) {
      if (!tile.heights) {
        relief->set_lacking(tile.id);
        note(lacking_heights, {tile.id, tile.heights.error()});
        continue;
      }
      meshes += relief->touched(tree, tile.id, patches);
      relief->add(std::move(*tile.heights));
      stats.heights_arrived = true;
    }
  }
}

void Globe::Impl::ask_heights() {
  if (!heights) return;
  const std::vector<WantedTile> wanted = relief->want(patches);
  std::vector<TileRequest> requests;
  requests.reserve(wanted.size());
  for (const WantedTile& tile : wanted) requests.push_back({tile.id, tile.priority});
  heights->request(requests);
  stats.heights_missing = static_cast<int>(wanted.size());
  stats.heights_lacked = relief->lacking();
  stats.relief_put_off = relief->put_off();
}

void Globe::Impl::note_lacking(const TileId& id, const TileFailure& failure) {
  tiles.set_state(id, TileState::lacking);
  if (failure.kind == Absence::failed) failed.emplace_back(Clock::now() + kRetryFailed, id);
  note(lacking, {id, failure});
}

void Globe::Impl::retry_failed() {
  for (const auto now = Clock::now(); !failed.empty() && failed.front().first <= now; failed.pop_front()) {
    TileResidency::Entry* entry = tiles.residency().find(failed.front().second);
    if (entry != nullptr && entry->state == TileState::lacking) entry->state = TileState::unknown;
  }
}

// Without a time there is no Sun to draw: its light comes over the viewer's shoulder.
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

FrameStats Globe::Impl::draw(unsigned framebuffer, Viewport viewport) {
  stats = {};
  ++frame;
  if (!same(viewport, drawn)) detail = 1.0;
  drawn = viewport;
  retry_failed();
  stats.uploaded_bytes = take_finished();
  if (relief) relief->set_mesh_budget(options.relief_meshes_per_frame);
  const auto start = Clock::now();
  const std::uint64_t meshes_before = relief ? relief->meshes_made() : 0;
  select(viewport);
  // Slot 0 and those of the root tiles are never given up.
  const int room = tiles.capacity() - 1 - static_cast<int>(roots.size());
  // A view that wants more tiles than there is room for is drawn a little coarser rather than never finished.
  for (int step = 0; step < kMostCoarser && coverage.tiles > room * 9 / 10; ++step) {
    detail *= 0.75;
    select(viewport);
  }
  stats.selection_ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  ask();
  ask_heights();
  if (relief) stats.relief_meshes = static_cast<int>(relief->meshes_made() - meshes_before);
  const FrameInput input{.size = viewport,
                         .view = view,
                         .eyes = eyes,
                         .stereo = options.stereo.mode,
                         .patches = &patches,
                         .coverage = &coverage,
                         .surface = options.surface,
                         .sky = sky(),
                         .lit = !options.unlit,
                         .sun = sun(),
                         .frame = frame,
                         .ground_m = ground_m(),
                         .naive_translucency = options.naive_translucency};
  const FrameCounts counts = renderer->draw(input, tiles, framebuffer);
  stats.patches = static_cast<int>(patches.size());
  for (const SelectedPatch& patch : patches) stats.band_patches += patch.in_band ? 1 : 0;
  stats.draw_calls = counts.draw_calls;
  stats.triangles = counts.triangles;
  stats.tiles_wanted = coverage.tiles;
  stats.tiles_missing = coverage.missing;
  stats.tiles_lacked = coverage.lacking;
  stats.patches_uncovered = coverage.uncovered;
  take_heights();
  return stats;
}

// Where a root tile has finally failed nothing will ever cover its patches: there is nothing to wait for.
bool Globe::Impl::roots_decided() {
  for (const TileId& id : roots) {
    if (tiles.residency().entry(id).state == TileState::unknown) return false;
  }
  return true;
}

Globe::Globe(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Globe::~Globe() = default;

Result<std::unique_ptr<Globe>> Globe::create(const GlobeOptions& options, std::shared_ptr<TileSource> imagery,
                                             std::optional<ElevationSource> elevation) {
  if (const Status ranges = check_ranges(options); !ranges) return ranges.error();
  if (const Status context = check_context(); !context) return context.error();
  auto impl = std::make_unique<Impl>(options, std::move(imagery), elevation);
  RenderOptions render;
  render.texturing = options.texturing;
  render.depth = options.depth;
  render.paper_a = options.paper_a;
  render.paper_band = options.paper_band;
  SkyAssets sky{.body = options.body, .stars = options.stars, .night_lights = {}};
  if (options.sky) {
    const Result<Almanac> almanac = almanac_at(options.time.value_or(kQuietSky));
    if (!almanac) return almanac.error();
    impl->almanac = *almanac;
    impl->sky_on = true;
    if (options.time && options.body.name == "earth") sky.night_lights = options.night_lights;
  }
  Result<std::unique_ptr<GlobeRenderer>> renderer =
      GlobeRenderer::create(render, impl->tree, options.sky ? &sky : nullptr);
  if (!renderer) return renderer.error();
  impl->renderer = std::move(*renderer);
  impl->renderer->set_label_font(std::move(impl->options.label_font));
  return std::unique_ptr<Globe>(new Globe(std::move(impl)));
}

void Globe::set_camera(const Camera& camera) {
  if (same(camera, impl_->camera)) return;  // callers set it every frame: what a view gave way in stays found
  impl_->camera = camera;
  impl_->detail = 1.0;
}
const Camera& Globe::camera() const { return impl_->camera; }
const GlobeOptions& Globe::options() const { return impl_->options; }
void Globe::set_unlit(bool unlit) { impl_->options.unlit = unlit; }
void Globe::set_surface(const SurfaceLook& surface) {
  impl_->options.surface = surface;
  impl_->detail = 1.0;
}
void Globe::set_sky(bool on) { impl_->sky_on = on; }
bool Globe::has_relief() const { return impl_->relief != nullptr; }
void Globe::set_exaggeration(double exaggeration) {
  impl_->options.exaggeration = exaggeration;
  if (impl_->relief) impl_->relief->set_exaggeration(exaggeration);
}
Status Globe::set_time(std::optional<UtcTime> time) {
  const Result<Almanac> almanac = almanac_at(time.value_or(kQuietSky));
  if (!almanac) return almanac.error();
  impl_->options.time = time;
  if (impl_->almanac) impl_->almanac = *almanac;
  return Done{};
}
void Globe::set_patch_shuffle(std::optional<unsigned> seed) { impl_->patch_shuffle = seed; }
Status Globe::set_objects(const ObjectScene& objects) { return impl_->renderer->set_objects(objects); }
void Globe::set_stereo(const StereoLook& stereo) {
  impl_->options.stereo = stereo;
  impl_->detail = 1.0;
}

FrameStats Globe::render(unsigned framebuffer, Viewport viewport) { return impl_->draw(framebuffer, viewport); }

bool Globe::settled() const {
  if (impl_->frame == 0 || !impl_->coverage.wanted.empty()) return false;
  const FrameStats& stats = impl_->stats;
  if (stats.heights_missing > 0 || stats.heights_arrived || stats.relief_put_off > 0) return false;
  return impl_->stats.patches_uncovered == 0 || impl_->roots_decided();
}

bool Globe::render_until_settled(unsigned framebuffer, Viewport viewport, Clock::time_point deadline) {
  for (;;) {
    render(framebuffer, viewport);
    if (settled()) return true;
    if (Clock::now() >= deadline) return false;
    impl_->loader.wait(std::min(deadline, Clock::now() + kPoll));
  }
}

Ground Globe::ground() const { return impl_->ground(); }

double Globe::ground_height_m(Angle lat, Angle lon) const { return ground().height_m(lat, lon); }

std::optional<double> Globe::elevation_m(Angle lat, Angle lon) const {
  if (!impl_->relief) return std::nullopt;
  return impl_->relief->field().height_m(lat, lon);
}

const std::deque<LackingTile>& Globe::lacking() const { return impl_->lacking; }
const std::deque<LackingTile>& Globe::lacking_heights() const { return impl_->lacking_heights; }

LoaderCounts Globe::loading() const { return impl_->loader.counts(); }

View Globe::view(Viewport viewport) const { return make_view(impl_->camera, impl_->options.body.ellipsoid, viewport); }

}  // namespace terrella
