#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tests/remote_tiff/served_folder.h"
#include "tests/support/scratch_folder.h"
#include "tiles/tile_source.h"

namespace terrella::test {

/// Small files, on disk and behind a real nginx, that a source of each kind opens.
class SourceFiles {
 public:
  SourceFiles();
  /// Opens a source; a failure of the test, and null, if that fails.
  [[nodiscard]] std::shared_ptr<TileSource> open(const std::string& kind);

  /// Names of the kinds: each source with threads of its own.
  [[nodiscard]] static std::vector<std::string> kinds();

 private:
  [[nodiscard]] std::shared_ptr<TileSource> open_growing_cut();
  [[nodiscard]] std::shared_ptr<TileSource> open_mosaic_overview();
  [[nodiscard]] std::shared_ptr<TileSource> open_remote_set(Projection projection);
  [[nodiscard]] std::shared_ptr<TileSource> open_remote_tiff();

  ScratchFolder folder_;
  ServedFolder served_;
  int opened_ = 0;
};

}  // namespace terrella::test
