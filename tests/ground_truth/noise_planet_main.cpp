#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>

#include "apps/bench/truth/noise_planet.h"

namespace {

bool parse_size(const std::string& text, int& width, int& height) {
  int used = 0;
  return std::sscanf(text.c_str(), "%dx%d%n", &width, &height, &used) == 2 && used == static_cast<int>(text.size()) &&
         width > 0 && height > 0 && width <= 32768 && height <= 32768;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Writes the noise planet by which the renderer is judged. Example: noise_planet --out noise.png"};
  std::string out;
  std::string size = "8192x4096";
  terrella::truth::NoisePlanetOptions options;
  app.add_option("--out", out, "PNG file to write")->required();
  app.add_option("--size", size, "pixels, WIDTHxHEIGHT, at most 32768 each")->capture_default_str();
  app.add_option("--seed", options.seed, "another seed, another planet")->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  if (!parse_size(size, options.width, options.height)) {
    std::fprintf(stderr, "--size %s: expected WIDTHxHEIGHT, for example 8192x4096\n", size.c_str());
    return 2;
  }
  try {
    terrella::truth::write_png(terrella::truth::noise_planet(options), out);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
