#include "apps/open_scene/sky_data.h"

#include "apps/process/data_dir.h"
#include "globe/data_files.h"

namespace terrella {
namespace {

template <class Value>
void load_into(Value& value, std::string_view file, Result<Value> (*load)(const std::filesystem::path&),
               const char* without, std::vector<std::string>& problems) {
  try {
    Result<Value> loaded = load(data_file(file));
    if (loaded) {
      value = std::move(loaded).value();
    } else {
      problems.push_back(loaded.error().message + "; " + without);
    }
  } catch (const BrokenInstallation& broken) {
    problems.push_back(std::string(broken.what()) + "\n" + without);
  }
}

}  // namespace

SkyData load_sky_data(bool night_lights) {
  SkyData data;
  load_into(data.stars, "stars.csv", &load_stars, "the sky is without stars", data.problems);
  if (!night_lights) return data;
  load_into(data.night_lights, "night_lights.png", &load_night_lights, "the night is without lights", data.problems);
  return data;
}

}  // namespace terrella
