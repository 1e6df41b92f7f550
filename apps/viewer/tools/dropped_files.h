#pragma once

#include <atomic>
#include <deque>
#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "apps/commands/raster_facts.h"
#include "apps/open_scene/open_imagery.h"
#include "apps/open_scene/scene_numbers.h"
#include "streaming/cut/growing/growing_cut.h"
#include "streaming/objects/geojson_objects.h"

namespace terrella {

/// A file whose tiles are of another body than the globe's, by their own word or by the name of a picture.
struct OtherBodyFile {
  SourceOptions said;  ///< the file or address, and what is said about it
  Body body;
  bool of_heights = false;
  bool by_name = false;  ///< the file itself says nothing
};

/// The body that the name of a JPEG, PNG or WebP has as a word of its own ("moon_4k.jpg"), because such pictures rarely
/// say where they lie. Nullopt for other files, and for names with other meanings, such as Europa. thread: any
[[nodiscard]] std::optional<Body> named_body(const std::filesystem::path& path);

/// Contents of a dropped file.
struct OpenedFile {
  SourceOptions said;  ///< the file or address, and what is said about it
  std::variant<ImageryLayer, ElevationSource, ObjectFile> what;
  std::optional<Geodetic> model_place = {};            ///< set for a model: where it stands
  std::vector<std::shared_ptr<GrowingCut>> cuts = {};  ///< cuts of a picture that run in the background
  FactsReader read_facts = {};                         ///< reads the facts of a raster
  std::optional<ObjectFile> features = {};             ///< features of a KML file whose pictures are `what`
  std::optional<OtherBodyFile> other_body = {};        ///< set: the file is not opened, and `what` is empty
};

/// Opens a file, a folder or an address, `said`: a picture (shown at once, or while it is cut into the cache), a tile
/// set of pictures, numbers or heights, GeoJSON, KML with its pictures, or a glTF model. A model stands at `place`.
/// `how` sets the cache and the globe's body. The error names the file and the reason. thread: any, one at a time
[[nodiscard]] Result<OpenedFile> open_dropped(const SourceOptions& said, const SourceOptions& how,
                                              const Geodetic& place, const CutProgress& progress = {});

/// The file's name, or the whole address without its query: the last part of most addresses is just "{y}.jpg".
/// thread: any
[[nodiscard]] std::string shown_name(const std::filesystem::path& path);
/// The name that is said about the source, else that of its address. thread: any
[[nodiscard]] std::string shown_name(const SourceOptions& said);

/// Opens files one after another on a background thread while the window continues. thread: main
class DroppedFiles {
 public:
  explicit DroppedFiles(SourceOptions options) : options_(std::move(options)) {}
  ~DroppedFiles();  ///< cancels the cutting in progress
  DroppedFiles(const DroppedFiles&) = delete;
  DroppedFiles& operator=(const DroppedFiles&) = delete;

  void add(SourceOptions said, const Geodetic& place);
  /// Returns the next opened file or error; nullopt if none is ready.
  [[nodiscard]] std::optional<Result<OpenedFile>> poll();
  [[nodiscard]] bool ready() const;  ///< true if poll() would return a file or error
  [[nodiscard]] bool busy() const { return running_.valid(); }
  [[nodiscard]] std::string text() const;  ///< current job and its progress; empty if idle
  /// Cancels the cutting in progress and all waiting files. Returns these, the first one too.
  std::vector<SourceOptions> leave_off();

 private:
  struct Waiting {
    SourceOptions said;
    Geodetic place;
  };
  void start_next();

  SourceOptions options_;
  std::deque<Waiting> waiting_;
  SourceOptions current_;
  std::future<Result<OpenedFile>> running_;
  std::atomic<int> percent_{-1};
  std::atomic<bool> leave_off_{false};
};

}  // namespace terrella
