// earthquakes TILES QUAKES.geojson OUTPUT.png: draws earthquakes under a translucent Earth, without a window.
#include <terrella/globe.h>
#include <terrella/render/gl/offscreen.h>
#include <terrella/streaming/objects/geojson_objects.h>
#include <terrella/streaming/sets/open_tile_set.h>

#include <fstream>
#include <iostream>

using namespace terrella;

Status draw(char** paths) {
  const auto context = HeadlessContext::create();
  if (!context) return context.error();
  auto tiles = open_tile_set(paths[0]);
  if (!tiles) return tiles.error();
  GlobeOptions options;
  options.surface.alpha = 0.55;
  auto globe = Globe::create(options, *std::move(tiles));
  if (!globe) return globe.error();

  // Catalogue of the US Geological Survey: colour shows the depth, radius shows the magnitude.
  const auto quakes = read_geojson_objects(paths[1]);
  if (!quakes) return quakes.error();
  for (const std::string& complaint : quakes->complaints) std::cerr << complaint << '\n';
  if (auto added = (*globe)->add_objects(quakes->scene); !added) return added.error();

  constexpr Viewport kSize{1024, 1024};
  const OffscreenTarget picture(kSize);
  (*globe)->set_camera({.eye = {.lat = Angle::degrees(-15), .lon = Angle::degrees(170), .height_m = 9e6}});
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  if (!(*globe)->render_until_settled(picture.framebuffer(), kSize, deadline)) return Error{"tiles are still coming"};
  const auto png = encode_png({kSize.width_px, kSize.height_px, picture.read()});
  if (!png) return png.error();
  std::ofstream file(paths[2], std::ios::binary);
  file.write(reinterpret_cast<const char*>(png->data()), std::ssize(*png));
  return file.flush() ? Status{Done{}} : Error{std::string(paths[2]) + ": cannot be written"};
}

int main(int argc, char** argv) {
  if (argc != 4) return std::cerr << "earthquakes TILES QUAKES.geojson OUTPUT.png\n", 2;
  const Status drawn = draw(argv + 1);
  if (!drawn) std::cerr << drawn.error().message << '\n';
  return drawn ? 0 : 1;
}
