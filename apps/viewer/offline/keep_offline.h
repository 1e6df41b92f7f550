#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/open_scene/options/source_options.h"
#include "apps/process/program_job.h"
#include "apps/viewer/parts/part.h"
#include "geo/coordinates.h"
#include "tiles/tile_source.h"

namespace terrella {

/// A layer of a server that is to be kept for offline use.
struct LayerToKeep {
  std::string name{};
  SourceOptions source{};  ///< as the window opened it
  TileSetInfo info{};
  std::string time{};  ///< the shown instant, as the service writes it; may be empty
};

/// Keeps a view's tiles of a layer in the session's cache: another process of the program estimates and preloads them.
/// Owns the panel. thread: main for every call
class KeepOffline : public Panel {
 public:
  /// `session`: how the window opens its sources.
  KeepOffline(const ViewerContext& context, const SourceOptions& session)
      : Panel(context, "Keep for offline use"),
        has_cache_(!session.offline && session.cache != "off"),
        cache_size_mb_(session.cache_size_mb) {}
  ~KeepOffline() override;

  /// Opens the panel for a layer and the present view. A layer that is being kept stays there.
  void open(const LayerToKeep& layer);
  /// Takes the ends of the other process. Call it once per frame.
  void advance();

  [[nodiscard]] bool changed() const override;
  [[nodiscard]] std::string job() const override;

 private:
  struct Estimate {
    std::int64_t tiles = 0, there = 0;
    std::optional<double> bytes{};
    std::string fault{};  ///< the preload would be refused
  };
  void draw_open(float foot) override;
  void draw_choice();
  void draw_work();
  [[nodiscard]] bool take(const LayerToKeep& layer);
  [[nodiscard]] std::optional<GeoRect> shown_box() const;
  void take_box(const GeoRect& box);
  [[nodiscard]] std::int64_t tiles_to(int last) const;
  void estimate();
  void take_estimate();
  void begin();
  void take_work();
  [[nodiscard]] std::vector<std::string> arguments() const;
  void draw_estimate() const;
  [[nodiscard]] double part() const;

  const bool has_cache_;
  const std::size_t cache_size_mb_;
  LayerToKeep layer_;
  std::filesystem::path folder_;  ///< files of the processes, for this user alone
  std::filesystem::path cache_;
  std::string task_;  ///< the source, with its keys: never a file
  GeoRect box_{};
  int first_ = 0, last_ = 0;  ///< chosen levels
  std::unique_ptr<ProgramJob> estimating_, work_;
  std::optional<Estimate> estimate_;
  bool paused_ = false, cancelled_ = false;
  mutable double part_ = 0.0;  ///< done, at the last news of the process
  std::string end_;            ///< tells how the work ended
  std::string shown_job_;      ///< job() in the last frame
};

}  // namespace terrella
