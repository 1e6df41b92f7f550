#include "globe/data_files.h"

#include <cstddef>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>

#include "codecs/image.h"

namespace terrella {
namespace {

constexpr std::uintmax_t kMostBytes = 32UL << 20;

Result<std::vector<std::byte>> read_data(const std::filesystem::path& path) {
  std::error_code failed;
  const std::uintmax_t size = std::filesystem::file_size(path, failed);
  if (failed) return Error{path.string() + ": " + failed.message() + "; name the folder with the data of Terrella"};
  if (size > kMostBytes)
    return Error{path.string() + ": larger than 32 MiB; name the folder with the data of Terrella"};
  std::vector<std::byte> bytes(static_cast<std::size_t>(size));
  std::ifstream file(path, std::ios::binary);
  if (!file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size))) {
    return Error{path.string() + ": cannot be read"};
  }
  return bytes;
}

}  // namespace

Result<std::vector<Star>> load_stars(const std::filesystem::path& path) {
  const auto bytes = read_data(path);
  if (!bytes) return bytes.error();
  Result<std::vector<Star>> stars = parse_stars({reinterpret_cast<const char*>(bytes->data()), bytes->size()});
  if (!stars) return Error{path.string() + ": " + stars.error().message};
  return stars;
}

Result<GreyPicture> load_night_lights(const std::filesystem::path& path) {
  const auto bytes = read_data(path);
  if (!bytes) return bytes.error();
  const Result<Image> image = decode_image(*bytes);
  if (!image) return Error{path.string() + ": " + image.error().message};
  GreyPicture map{image->width_px, image->height_px, {}};
  map.values.reserve(image->rgba.size() / 4);
  for (std::size_t k = 0; k < image->rgba.size(); k += 4) map.values.push_back(image->rgba[k]);
  return map;
}

Status add_data(GlobeOptions& options, const std::filesystem::path& folder) {
  GlobeOptions filled = options;
  if (filled.label_font.empty()) {
    auto font = read_data(folder / "DejaVuSans.ttf");
    if (!font) return font.error();
    filled.label_font = *std::move(font);
  }
  if (filled.sky && filled.stars.empty()) {
    auto stars = load_stars(folder / "stars.csv");
    if (!stars) return stars.error();
    filled.stars = *std::move(stars);
  }
  if (filled.sky && filled.night_lights.values.empty()) {
    auto lights = load_night_lights(folder / "night_lights.png");
    if (!lights) return lights.error();
    filled.night_lights = *std::move(lights);
  }
  options = std::move(filled);
  return Done{};
}

}  // namespace terrella
