#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "base/result.h"
#include "geo/camera.h"
#include "view/render_modes.h"

namespace terrella {

/// What the viewer keeps between runs.
struct KeptSettings {
  int width_px = 0, height_px = 0;  ///< of the window; 0: the program's own
  bool panel = false;
  bool layers = false;
  bool graticule = false;
  bool sky = true;
  double opacity = 1.0;  ///< of the surface, [0, 1]
  double exaggeration = 1.0;
  Stereo stereo = Stereo::off;
  bool operator==(const KeptSettings&) const = default;
};

struct LoadedSettings {
  KeptSettings settings;  ///< what could not be read is as it is by itself
  bool first_run = false;
  std::string complaint;  ///< names the file and what is wrong; then a copy of the file is beside it. May be empty
};

/// Of a file that is not there: a first run's. thread: one
[[nodiscard]] LoadedSettings load_settings(const std::filesystem::path& file);
/// Makes the folder if need be; what the file has under other names stays. Fails with a message that names the file.
[[nodiscard]] Status save_settings(const std::filesystem::path& file, const KeptSettings& settings);
/// What was kept, with what has changed from the run's `start` to `now`: the command line's own is for one run.
[[nodiscard]] KeptSettings changed_since(KeptSettings kept, const KeptSettings& start, const KeptSettings& now);
/// settings.json in the user's folder; nothing where there is none.
[[nodiscard]] std::optional<std::filesystem::path> settings_file();

}  // namespace terrella
