// Time of one frame's selection on the CPU (patches, then tiles), on a warm tree with every tile there: what a settled
// view pays each frame before anything is drawn.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "geo/body.h"
#include "surface/plan/frame_plan.h"
#include "surface/plan/tile_coverage.h"

namespace {

using namespace terrella;

struct Case {
  const char* name;
  Camera camera;
  Viewport viewport;
  PatchSelectionOptions options{};
};

Camera camera_at(double lat_deg, double lon_deg, double height_m, double heading_deg, double pitch_deg) {
  return {.eye = {.lat = Angle::degrees(lat_deg), .lon = Angle::degrees(lon_deg), .height_m = height_m},
          .heading = Angle::degrees(heading_deg),
          .pitch = Angle::degrees(pitch_deg)};
}

// Named by about how many patches they take; the tilted ones take few patches with many cells.
const std::vector<Case>& cases() {
  static const std::vector<Case> all = {
      {"patches_50", camera_at(20, 30, 2.0e7, 0, -90), {1024, 1024}},
      {"patches_150", camera_at(46, 7, 6.0e6, 30, -90), {3840, 2160}},
      {"patches_500", camera_at(70, 7, 1.0e6, 30, -45), {7680, 4320}},
      {"patches_500_hd", camera_at(46, 7, 6.0e6, 30, -90), {1920, 1080}, {.max_error_px = 0.009}},
      {"tilted", camera_at(46, 7, 3.0e4, 30, -12), {3840, 2160}},
      {"tilted_pole", camera_at(88, 10, 3.0e5, 0, -20), {3840, 2160}},
  };
  return all;
}

/// Deep enough that every camera above is limited by the screen, not by the pyramid.
constexpr TileGrid kGrid{.root_span_deg = 180.0, .tile_px = 256, .max_level = 18};
constexpr int kSegments = 24;  // as the globe draws

/// A tree and its tiles after the view has settled.
struct Settled {
  explicit Settled(const Case& what)
      : tree(body.ellipsoid, kGrid, kSegments),
        view(make_view(what.camera, body.ellipsoid, what.viewport)),
        options(what.options) {
    do {
      frame_once();
      for (const WantedTile& wanted : coverage.wanted) {
        TileResidency::Entry& entry = residency.entry(wanted.id);
        entry.state = TileState::resident;
        entry.slot = ++slots;
      }
    } while (!coverage.wanted.empty());
  }

  void frame_once() {
    plan = plan_frame(view, {.layers = {{.tree = &tree, .tiles = &residency}}, .sun = {}, .patch_shuffle = {}}, options,
                      std::move(plan));
    LayerPlan& layer = plan.layers[0];
    tree.adopt(layer.growth);
    std::swap(patches, layer.patches);
    std::swap(coverage, layer.coverage);
    coverage.uses.note(++frame, residency);
    tree.end_frame();
    residency.end_frame(frame, kGrid.min_level);
  }

  void cover() {
    growth.begin(tree);
    cover_with_tiles({.tree = tree, .growth = growth, .view = view, .patches = patches, .residency = residency},
                     coverage);
    tree.adopt(growth);
    coverage.uses.note(++frame, residency);
  }

  Body body = earth();
  PatchTree tree;
  View view;
  PatchSelectionOptions options;
  TileResidency residency;
  std::vector<SelectedPatch> patches;
  TileCoverage coverage;
  FramePlan plan;
  TreeGrowth growth;
  std::uint64_t frame = 0;
  int slots = 0;
};

void report(benchmark::State& state, const Settled& settled) {
  const auto patches = static_cast<double>(settled.patches.size());
  using benchmark::Counter;
  state.counters["patches"] = patches;
  state.counters["cells"] = static_cast<double>(settled.coverage.cells.size());
  state.counters["tiles"] = settled.coverage.tiles;
  // 1 / (patches a frame × frames / time): printed in seconds a patch.
  state.counters["per_patch"] = Counter(patches, Counter::kIsIterationInvariantRate | Counter::kInvert);
}

void frame(benchmark::State& state, const Case& what) {
  Settled settled(what);
  for (auto _ : state) settled.frame_once();
  report(state, settled);
}

void patches_alone(benchmark::State& state, const Case& what) {
  Settled settled(what);
  for (auto _ : state) select_patches(settled.tree, settled.view, settled.options, settled.patches);
  report(state, settled);
}

void tiles_alone(benchmark::State& state, const Case& what) {
  Settled settled(what);
  for (auto _ : state) settled.cover();
  report(state, settled);
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  const char* rounds = std::getenv("SELECTION_BENCH_ROUNDS");  // exactly so many, to count instructions
  const auto add = [&](const char* kind, auto* function, const Case& what) {
    auto* added = benchmark::RegisterBenchmark((std::string(kind) + what.name).c_str(), function, what);
    added->Unit(benchmark::kMicrosecond);
    if (rounds != nullptr) added->Iterations(std::atoi(rounds));
  };
  for (const Case& what : cases()) {
    add("frame/", frame, what);
    add("select_patches/", patches_alone, what);
    add("cover_with_tiles/", tiles_alone, what);
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
