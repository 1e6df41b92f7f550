#include "apps/bench/truth/truth_cache.h"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <functional>
#include <optional>
#include <system_error>
#include <utility>

namespace terrella::truth {
namespace {

// Increase this with every change of the ray caster's results.
constexpr int kRayCasterVersion = 1;

template <typename T>
void put(std::ofstream& out, const std::vector<T>& values) {
  out.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(T)));
}

template <typename T>
void get(std::ifstream& in, std::vector<T>& values, std::size_t count) {
  values.resize(count);
  in.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(count * sizeof(T)));
}

std::optional<TruthImage> load(const std::filesystem::path& file, const std::string& key, const TruthOptions& options) {
  std::ifstream in(file, std::ios::binary);
  std::string stored;
  if (!in || !std::getline(in, stored) || stored != key) return std::nullopt;
  TruthImage image{.width = options.width,
                   .height = options.height,
                   .rays_per_pixel = options.rays_per_side * options.rays_per_side,
                   .rgb = {},
                   .hits = {},
                   .lat_deg = {},
                   .lon_deg = {},
                   .incidence_deg = {}};
  const std::size_t pixels = static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height);
  get(in, image.rgb, 3 * pixels);
  get(in, image.hits, pixels);
  get(in, image.lat_deg, pixels);
  get(in, image.lon_deg, pixels);
  get(in, image.incidence_deg, pixels);
  if (!in) return std::nullopt;
  return image;
}

void store(const std::filesystem::path& file, const std::string& key, const TruthImage& image) {
  const std::filesystem::path unfinished = fmt::format("{}.{}", file.string(), getpid());
  std::ofstream out(unfinished, std::ios::binary);
  out << key << '\n';
  put(out, image.rgb);
  put(out, image.hits);
  put(out, image.lat_deg);
  put(out, image.lon_deg);
  put(out, image.incidence_deg);
  out.close();
  std::error_code ignored;  // a picture that could not be cached is cast again
  if (out) {
    std::filesystem::rename(unfinished, file, ignored);
  } else {
    std::filesystem::remove(unfinished, ignored);
  }
}

}  // namespace

Source make_source(Picture picture) {
  const std::uint64_t print = fingerprint(picture);
  return {std::move(picture), print};
}

std::string truth_key(const Source& source, const RowRule& rows, const Spheroid& body, const TruthCamera& camera,
                      const TruthOptions& options) {
  return fmt::format("v{} {:016x} {}x{} area {} centric {} body {},{} camera {},{},{},{},{},{} size {}x{} rays {}",
                     kRayCasterVersion, source.fingerprint, source.picture.width, source.picture.height,
                     rows.equal_area, rows.centric, body.a_m, body.f, camera.eye.lat_deg, camera.eye.lon_deg,
                     camera.eye.height_m, camera.heading_deg, camera.pitch_deg, camera.fov_deg, options.width,
                     options.height, options.rays_per_side);
}

TruthImage cast_cached(const Source& source, const RowRule& rows, const Spheroid& body, const TruthCamera& camera,
                       const TruthOptions& options, const std::filesystem::path& folder) {
  if (folder.empty()) return cast(source.picture, rows, body, camera, options);
  const std::string key = truth_key(source, rows, body, camera, options);
  const std::filesystem::path file = folder / fmt::format("truth_{:016x}.bin", std::hash<std::string>{}(key));
  if (std::optional<TruthImage> image = load(file, key, options)) return std::move(*image);
  std::filesystem::create_directories(folder);
  TruthImage image = cast(source.picture, rows, body, camera, options);
  store(file, key, image);
  return image;
}

}  // namespace terrella::truth
