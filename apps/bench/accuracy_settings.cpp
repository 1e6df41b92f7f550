#include "apps/bench/accuracy_settings.h"

#include <chrono>
#include <utility>

namespace terrella::bench {
namespace {

GlobeOptions drawn() {
  GlobeOptions options;
  options.unlit = true;
  options.upload_bytes_per_frame = options.gpu_bytes;
  options.upload_time_per_frame = std::chrono::seconds(1);
  return options;
}

class Settings {
 public:
  explicit Settings(Effort effort) : effort_(effort) { settings_.push_back({kDefaults, kNoFigure, drawn()}); }

  /// Adds a setting for each value of the effort; `set` stores a value in the setting.
  template <class Set>
  void sweep(const char* name, const std::vector<double>& quick, const std::vector<double>& normal,
             const std::vector<double>& full, Set set) {
    const std::vector<double>& values = effort_ == Effort::quick ? quick : effort_ == Effort::full ? full : normal;
    for (const double value : values) {
      settings_.push_back({name, value, drawn()});
      set(settings_.back(), value);
    }
  }
  [[nodiscard]] std::vector<AccuracySetting> all() const { return settings_; }

 private:
  Effort effort_;
  std::vector<AccuracySetting> settings_;
};

/// At this height the planet fills the picture's width, and its tiles are not the finest.
constexpr double kFourRadii_m = 3.0 * 6378137.0;
constexpr double kHalfAnOctaveLower_m = 13.5e6;

void add_pair(std::vector<AccuracyView>& views, const std::string& name, double height_m) {
  views.push_back({name + ", equator", {.eye = {0, 20, height_m}}});
  views.push_back({name + ", pole", {.eye = {90, 0, height_m}}, name + ", equator"});
}

}  // namespace

std::vector<AccuracySetting> accuracy_settings(Effort effort) {
  Settings settings(effort);
  settings.sweep(kTessellation, {4, 24}, {4, 8, 16, 24, 32, 48, 64, 96, 128}, {4, 8, 16, 24, 32, 48, 64, 96, 128},
                 [](AccuracySetting& s, double n) { s.globe.segments = static_cast<int>(n); });
  const std::vector<double> thresholds_px{0.05, 0.1, 0.2, 0.4, 0.8, 1.6, 3.2};
  settings.sweep(kThreshold, {0.2, 1.0}, thresholds_px, thresholds_px,
                 [](AccuracySetting& s, double px) { s.globe.max_error_px = px; });
  settings.sweep(kPlainThreshold, {0.2}, thresholds_px, thresholds_px, [](AccuracySetting& s, double px) {
    s.globe.max_error_px = px;
    s.mapping = CubeMapping::plain;
  });
  settings.sweep(kDetail, {0.5, 2.0}, {0.35, 0.5, 0.7, 1.0, 1.4, 2.0, 2.8},
                 {0.25, 0.3, 0.35, 0.42, 0.5, 0.6, 0.7, 0.85, 1.0, 1.2, 1.4, 1.7, 2.0, 2.4, 2.8, 3.4, 4.0},
                 [](AccuracySetting& s, double texels) { s.globe.texels_per_pixel = texels; });
  settings.sweep(kColumns, {32}, {2, 4, 8, 16, 32, 64, 128}, {1, 2, 4, 8, 16, 32, 64, 128},
                 [](AccuracySetting& s, double columns) {
                   s.globe.squeezed_rows = false;
                   s.globe.polar_columns = static_cast<int>(columns);
                 });
  settings.sweep(kGutter, {0}, {0, 1, 2, 4, 8, 16}, {0, 1, 2, 4, 8, 16},
                 [](AccuracySetting& s, double px) { s.globe.gutter_px = static_cast<int>(px); });
  return settings.all();
}

std::vector<AccuracyView> accuracy_views(Effort effort) {
  std::vector<AccuracyView> views = {{"mid latitude, 6000 km", {.eye = {30, 20, 6e6}}},
                                     {"beside the pole, 6000 km", {.eye = {89.9, 0, 6e6}}}};
  if (effort == Effort::quick) return views;
  views.push_back({.name = "low oblique, 300 km", .camera = {{46, 7, 3e5}, 30, -20, 45}, .magnified = true});
  add_pair(views, "four radii", kFourRadii_m);
  add_pair(views, "three radii", kHalfAnOctaveLower_m);
  if (effort == Effort::full) {
    views.push_back({"beside the pole, 1500 km", {.eye = {88, 10, 1.5e6}}});
    views.push_back({"pole, tilted 45°", {{80, 180, 1.2e6}, 0, -45, 40}});
    add_pair(views, "one radius", 7.0e6);
    add_pair(views, "two radii", 9.5e6);
  }
  return views;
}

PatchSelectionOptions selection_of(const GlobeOptions& options) {
  PatchSelectionOptions selection;
  selection.max_error_px = options.max_error_px;
  selection.texels_per_pixel = options.texels_per_pixel;
  selection.max_polar_columns = options.polar_columns;
  return selection;
}

}  // namespace terrella::bench
