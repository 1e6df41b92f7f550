#include <fmt/format.h>

#include <array>
#include <chrono>
#include <limits>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

#include "apps/bench/frame_timing.h"
#include "apps/bench/growth/flat_source.h"
#include "apps/bench/growth/growth_rows.h"
#include "apps/bench/shots.h"
#include "tiles/tile_loader.h"

namespace terrella::bench {
namespace {

struct GrowthView {
  const char* name;
  truth::TruthCamera camera;
};
constexpr std::array<GrowthView, 3> kViews = {GrowthView{"whole globe", {.eye = {20, 0, 2e7}}},
                                              GrowthView{"tilted, 300 km", {{46, 7, 3e5}, 30, -30, 45}},
                                              GrowthView{"tilted, 1 km", {{46, 7, 1e3}, 30, -30, 45}}};
constexpr int kDeepest = 24;

/// A settled view whose frames are timed.
struct Drawn {
  std::unique_ptr<Globe> globe;
  std::unique_ptr<OffscreenTarget> target;
  Viewport size;
  FrameStats stats;
};

Drawn draw_settled(const std::vector<int>& depths, const truth::TruthCamera& camera, Viewport size) {
  GlobeOptions options;
  options.unlit = true;
  options.upload_bytes_per_frame = options.gpu_bytes;
  options.upload_time_per_frame = std::chrono::seconds(1);
  Drawn drawn{.globe = {}, .target = std::make_unique<OffscreenTarget>(size), .size = size, .stats = {}};
  auto globe = Globe::create(options);
  if (!globe) throw std::runtime_error(globe.error().message);
  drawn.globe = *std::move(globe);
  for (const int depth : depths) {
    const bool base = drawn.globe->imagery().empty();
    const auto added = drawn.globe->add_imagery(make_flat_source(depth), {.opacity = base ? 1.0 : 0.5});
    if (!added) throw std::runtime_error(added.error().message);
  }
  drawn.stats = settle(*drawn.globe, camera, *drawn.target, size);
  return drawn;
}

/// Times frames in turn, and adds a row for each.
void add_frames(const char* series, const char* subject, const std::vector<double>& sizes, std::vector<Drawn>& drawn,
                int rounds, const AddRow& add) {
  std::vector<Subject> subjects;
  subjects.reserve(drawn.size());
  for (Drawn& one : drawn) {
    subjects.push_back(
        {.name = "", .draw = [&one] { one.stats = one.globe->render(one.target->framebuffer(), one.size); }});
  }
  time_frames(subjects, rounds);
  for (std::size_t k = 0; k < drawn.size(); ++k) {
    const FrameStats& stats = drawn[k].stats;
    add({.series = series,
         .subject = subject,
         .size = sizes[k],
         .ms = median(subjects[k].ms),
         .cpu_ms = median(subjects[k].cpu_ms),
         .selection_ms = stats.selection_ms,
         .patches = stats.patches,
         .tiles = stats.tiles_wanted,
         .megabytes = 1e-6 * static_cast<double>(stats.gpu_bytes)});
  }
}

void measure_depths(const BenchOptions& options, int side_px, int rounds, const AddRow& add) {
  for (const GrowthView& view : kViews) {
    options.progress(fmt::format("sets of level 3 to {}: {}", kDeepest, view.name));
    std::vector<Drawn> drawn;
    const std::vector<double> levels = {3, 8, 14, 20, kDeepest};
    drawn.reserve(levels.size());
    for (const double level : levels) {
      drawn.push_back(draw_settled({static_cast<int>(level)}, view.camera, {side_px, side_px}));
    }
    add_frames("depth", view.name, levels, drawn, rounds, add);
  }
}

void measure_windows(const BenchOptions& options, int rounds, const AddRow& add) {
  std::vector<Viewport> sizes = {{256, 256}, {512, 512}, {1024, 1024}};
  if (options.effort != Effort::quick) sizes.insert(sizes.end(), {{1920, 1080}, {3840, 2160}, {7680, 4320}});
  for (const Viewport size : sizes) {
    options.progress(fmt::format("window of {}x{}", size.width_px, size.height_px));
    std::vector<Drawn> drawn;
    drawn.push_back(draw_settled({kDeepest}, kViews[1].camera, size));
    add_frames("window", kViews[1].name, {static_cast<double>(size.width_px) * size.height_px}, drawn, rounds, add);
  }
}

void measure_layers(const BenchOptions& options, int side_px, int rounds, const AddRow& add) {
  options.progress("1 to 16 layers");
  std::vector<double> counts = {1, 2, 4};
  if (options.effort != Effort::quick) counts.insert(counts.end(), {8, 16});
  std::vector<Drawn> drawn;
  drawn.reserve(counts.size());
  for (const double count : counts) {
    drawn.push_back(
        draw_settled(std::vector<int>(static_cast<std::size_t>(count), 8), kViews[0].camera, {side_px, side_px}));
  }
  add_frames("layers", kViews[0].name, counts, drawn, rounds, add);
}

/// Tiles that sleep in place of decoding.
class SleepingSource : public TileSource {
 public:
  static constexpr std::chrono::milliseconds kDecode{10};
  [[nodiscard]] const TileSetInfo& info() const override { return flat_->info(); }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId&) override {
    return EncodedTile{.bytes = {}, .make_picture = []() -> Result<Image, TileFailure> {
                         std::this_thread::sleep_for(kDecode);
                         return TileFailure{MissingKind::blank, "no picture"};
                       }};
  }

 private:
  std::shared_ptr<TileSource> flat_ = make_flat_source(8);
};

void measure_workers(const BenchOptions& options, const AddRow& add) {
  options.progress("1 to 16 decoder threads");
  constexpr int kTiles = 128;
  std::vector<TileRequest> wanted;
  wanted.reserve(kTiles);
  for (int x = 0; x < kTiles; ++x) wanted.push_back({{8, x, 0}, 0.0});
  for (const int workers : {1, 2, 4, 8, 16}) {
    TileLoader loader(std::make_shared<SleepingSource>(), {.workers = workers});
    const auto start = std::chrono::steady_clock::now();
    loader.request(wanted);
    const auto late = start + std::chrono::minutes(1);
    while (loader.wait(late)) static_cast<void>(loader.poll(std::numeric_limits<std::size_t>::max()));
    const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - start;
    add({.series = "workers",
         .subject = "tile of 10 ms",
         .size = static_cast<double>(workers),
         .ms = taken.count() / kTiles,
         .tiles = kTiles});
  }
}

}  // namespace

void measure_view_growth(const BenchOptions& options, const AddRow& add) {
  const bool quick = options.effort == Effort::quick;
  const int side_px = quick ? 192 : 1024, rounds = quick ? 3 : 9;
  if (options.wants("depth")) measure_depths(options, side_px, rounds, add);
  if (options.wants("window")) measure_windows(options, quick ? 3 : 5, add);
  if (options.wants("workers")) measure_workers(options, add);
  if (options.wants("layers")) measure_layers(options, side_px, rounds, add);
}

}  // namespace terrella::bench
