#pragma once

#include <atomic>
#include <deque>
#include <filesystem>
#include <future>
#include <optional>
#include <string>
#include <variant>

#include "apps/setup/open_imagery.h"
#include "streaming/objects/geojson_objects.h"

namespace terrella {

/// What a file that was dropped holds.
struct OpenedFile {
  std::filesystem::path path;
  std::variant<std::shared_ptr<TileSource>, ElevationSource, ObjectFile> what;
};

/// Opens a picture (which is cut into the cache), a tile set of pictures or heights, GeoJSON, or a glTF model, which
/// then stands at `place`. `options`: the cache's. The error names the file and the reason. thread: any, one at a time
[[nodiscard]] Result<OpenedFile> open_dropped(const std::filesystem::path& path, const SceneOptions& options,
                                              const Geodetic& place, const CutProgress& progress = {});

/// Opens files one after the other on a thread of its own, while the window goes on. thread: main
class DroppedFiles {
 public:
  explicit DroppedFiles(SceneOptions options) : options_(std::move(options)) {}
  ~DroppedFiles();  ///< leaves off what is being cut
  DroppedFiles(const DroppedFiles&) = delete;
  DroppedFiles& operator=(const DroppedFiles&) = delete;

  void add(std::filesystem::path path, const Geodetic& place);
  /// The next one that is open, or could not be opened; nothing while none is.
  [[nodiscard]] std::optional<Result<OpenedFile>> poll();
  [[nodiscard]] bool ready() const;  ///< poll() would give one
  [[nodiscard]] bool busy() const { return running_.valid(); }
  [[nodiscard]] std::string text() const;  ///< what is being done, and how far it is; empty: nothing
  void leave_off();                        ///< what is being cut, and what waits

 private:
  struct Waiting {
    std::filesystem::path path;
    Geodetic place;
  };
  void start_next();

  SceneOptions options_;
  std::deque<Waiting> waiting_;
  std::filesystem::path current_;
  std::future<Result<OpenedFile>> running_;
  std::atomic<int> percent_{-1};
  std::atomic<bool> leave_off_{false};
};

}  // namespace terrella
