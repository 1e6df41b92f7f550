#include "apps/bench/test_planet.h"

#include <fmt/format.h>
#include <unistd.h>

#include <stdexcept>
#include <system_error>

#include "apps/bench/truth/noise_planet.h"
#include "streaming/cut.h"

namespace terrella::bench {
namespace {

namespace fs = std::filesystem;

truth::Picture make_picture(const fs::path& file, const BenchOptions& options) {
  truth::NoisePlanetOptions noise;
  if (options.effort == Effort::quick) noise.width = 1024, noise.height = 512;
  options.progress(fmt::format("making a noise planet of {}x{}", noise.width, noise.height));
  truth::Picture picture = truth::noise_planet(noise);
  // A temporary name first, so that an interrupted run leaves no incomplete planet.
  const fs::path unfinished = fmt::format("{}.{}", file.string(), getpid());
  truth::write_png(picture, unfinished);
  fs::rename(unfinished, file);
  return picture;
}

fs::path picture_file(const BenchOptions& options) {
  return options.work / (options.effort == Effort::quick ? "noise_1024.png" : "noise_8192.png");
}

CutOptions cut_options(const BenchOptions& options) {
  CutOptions cut;
  cut.images = {picture_file(options)};
  cut.format = ImageFormat::png;
  cut.name = "noise planet";
  cut.progress = [goes_on = options.goes_on](auto, auto) { return goes_on(); };
  return cut;
}

/// Creates the planet without its tiles.
TestPlanet noise_picture(const BenchOptions& options) {
  const fs::path file = picture_file(options);
  fs::create_directories(options.work);
  return {.source = truth::make_source(fs::exists(file) ? truth::read_picture(file) : make_picture(file, options)),
          .tiles = {}};
}

}  // namespace

Result<TestPlanet> noise_test_planet(const BenchOptions& options) {
  try {
    TestPlanet planet = noise_picture(options);
    options.progress("cutting it to tiles");
    auto tiles = cut_into_cache(cut_options(options), options.work);
    if (!tiles) return tiles.error();
    planet.tiles = *std::move(tiles);
    return planet;
  } catch (const std::exception& error) {
    return Error{fmt::format("{}: {}", options.work.string(), error.what())};
  }
}

Result<TestPlanet> noise_test_folder(const BenchOptions& options) {
  try {
    TestPlanet planet = noise_picture(options);
    CutOptions cut_to = cut_options(options);
    planet.tiles = cut_to.output = options.work / (picture_file(options).stem().string() + "_tiles");
    if (fs::exists(planet.tiles)) return planet;
    options.progress("cutting it to a folder of tiles");
    const auto done = cut(cut_to);
    if (!done) return done.error();
    return planet;
  } catch (const std::exception& error) {
    return Error{fmt::format("{}: {}", options.work.string(), error.what())};
  }
}

fs::path truth_folder(const BenchOptions& options) { return options.work / "truth"; }

}  // namespace terrella::bench
