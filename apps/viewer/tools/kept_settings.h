#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "apps/viewer/panels/readout.h"
#include "base/result.h"

namespace terrella {

/// Settings that the viewer keeps between runs: window, panels and layers, but no modes of the view.
struct KeptSettings {
  int width_px = 0, height_px = 0;  ///< size of the window; 0: the program's default
  bool panel = false;
  bool layers = false;
  bool graticule = false;
  bool map = true;
  bool restore = true;  ///< start with the scene that was last open
  LengthUnits units = LengthUnits::metric;
  bool operator==(const KeptSettings&) const = default;
};

struct LoadedSettings {
  KeptSettings settings;  ///< unreadable entries have their defaults
  bool first_run = false;
  std::string complaint;  ///< names the file and its fault, after a copy of the file was saved beside it; may be empty
};

/// Loads the settings; a missing file means a first run. thread: one
[[nodiscard]] LoadedSettings load_settings(const std::filesystem::path& file);
/// Saves the settings and creates the folder if needed. Unknown entries in the file stay. The error names the file.
[[nodiscard]] Status save_settings(const std::filesystem::path& file, const KeptSettings& settings);
/// Returns `kept` with the changes between `start` and `now`. Values from the command line apply to one run only.
[[nodiscard]] KeptSettings changed_since(KeptSettings kept, const KeptSettings& start, const KeptSettings& now);
/// settings.json in the user's folder; nullopt without such a folder.
[[nodiscard]] std::optional<std::filesystem::path> settings_file();

}  // namespace terrella
