#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "apps/open_scene/options/source_options.h"
#include "geo/body.h"

namespace terrella {

/// A public source of tiles.
struct CatalogueEntry {
  std::string title;
  std::string theme;
  std::string licence = {};
  Body body = earth();
  SourceOptions said = {};  ///< address, layer and grid; `remote` has the title, the attribution and the deepest level
  bool has_dates = false;
};

struct Catalogue {
  std::vector<CatalogueEntry> entries;
  std::vector<std::string> complaints;  ///< a message for each faulty entry, which is left out
};

/// Reads a catalogue (apps/viewer/catalogue/README.md). Messages begin with `where` and name the entry. Paths are seen
/// from `folder`. Sends no request. thread: main
[[nodiscard]] Catalogue parse_catalogue(std::string_view text, const std::filesystem::path& folder,
                                        const std::string& where);

/// Reads the catalogue of the program, then the user's: catalogue.json beside the settings, if it is there.
/// thread: main
[[nodiscard]] Catalogue load_catalogue();

}  // namespace terrella
