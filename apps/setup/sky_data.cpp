#include "apps/setup/sky_data.h"

#include "apps/setup/data_dir.h"
#include "codecs/image.h"
#include "streaming/file_bytes.h"

namespace terrella {
namespace {

constexpr std::size_t kMostSkyBytes = 32UL << 20;

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

Result<std::vector<Star>> load_stars(const std::filesystem::path& path) {
  const auto bytes = read_file(path, kMostSkyBytes);
  if (!bytes) return Error{bytes.error().message};
  Result<std::vector<Star>> stars = parse_stars({reinterpret_cast<const char*>(bytes->data()), bytes->size()});
  if (!stars) return Error{path.string() + ": " + stars.error().message};
  return stars;
}

Result<GreyPicture> load_night_lights(const std::filesystem::path& path) {
  const auto bytes = read_file(path, kMostSkyBytes);
  if (!bytes) return Error{bytes.error().message};
  const Result<Image> image = decode_image(*bytes);
  if (!image) return Error{path.string() + ": " + image.error().message};
  GreyPicture map{image->width_px, image->height_px, {}};
  map.values.reserve(image->rgba.size() / 4);
  for (std::size_t k = 0; k < image->rgba.size(); k += 4) map.values.push_back(image->rgba[k]);
  return map;
}

SkyData load_sky_data(bool night_lights) {
  SkyData data;
  load_into(data.stars, "stars.csv", &load_stars, "the sky is without stars", data.problems);
  if (!night_lights) return data;
  load_into(data.night_lights, "night_lights.png", &load_night_lights, "the night is without lights", data.problems);
  return data;
}

}  // namespace terrella
