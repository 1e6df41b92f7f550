// overview TILES PICTURE: a picture of the Alps with a map of Europe in its corner: two views of one globe.
#include <terrella/globe.h>
#include <terrella/render/gl/offscreen.h>
#include <terrella/streaming/sets/open_tile_set.h>

#include <fstream>
#include <iostream>

using namespace terrella;

constexpr Viewport kSize{640, 360}, kMapSize{160, 90};
const Camera kAlps{.eye = {.lat = Angle::degrees(44.0), .lon = Angle::degrees(8.0), .height_m = 2e5},
                   .pitch = Angle::degrees(-40)};
const Camera kEurope{.eye = {.lat = Angle::degrees(46.0), .lon = Angle::degrees(8.0), .height_m = 4e6}};

Status save(const OffscreenTarget& picture, const std::string& path) {
  const auto png = encode_png({kSize.width_px, kSize.height_px, picture.read()});
  if (!png) return png.error();
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(png->data()), std::ssize(*png));
  return file.flush() ? Status{Done{}} : Error{path + ": cannot be written"};
}

Status draw(const char* tiles_path, const std::string& path) {
  const auto context = HeadlessContext::create();
  if (!context) return context.error();
  auto tiles = open_tile_set(tiles_path);
  if (!tiles) return tiles.error();
  GlobeOptions options;
  options.sky = true;
  auto globe = Globe::create(options, *std::move(tiles));
  if (!globe) return globe.error();
  auto map = GlobeView::create(**globe);
  if (!map) return map.error();
  (*globe)->set_camera(kAlps);
  (*map)->set_camera(kEurope);
  const OffscreenTarget picture(kSize);
  while (!(*globe)->settled() || !(*map)->settled()) {
    (*globe)->render(picture.framebuffer(), kSize);
    (*map)->render(picture.framebuffer(), kMapSize);  // over the lower left corner
    if (!(*globe)->status()) return (*globe)->status();
  }
  return save(picture, path);
}

int main(int argc, char** argv) {
  if (argc != 3) return std::cerr << "overview TILES PICTURE\n", 2;
  const Status drawn = draw(argv[1], argv[2]);
  if (!drawn) std::cerr << drawn.error().message << '\n';
  return drawn ? 0 : 1;
}
