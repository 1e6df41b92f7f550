// flight_frames TILES FOLDER [SECONDS]: renders a flight from Lisbon to Tokyo as numbered pictures for a video, 25 a
// second:
//   ffmpeg -framerate 25 -i FOLDER/%04d.png -pix_fmt yuv420p flight.mp4
#include <terrella/globe.h>
#include <terrella/render/gl/offscreen.h>
#include <terrella/streaming/sets/open_tile_set.h>
#include <terrella/view/flight.h>

#include <cstdio>
#include <fstream>
#include <iostream>

using namespace terrella;

constexpr Viewport kSize{640, 360};
constexpr double kFramesPerSecond = 25.0;
const Camera kLisbon{.eye = {.lat = Angle::degrees(38.7), .lon = Angle::degrees(-9.1), .height_m = 8e5}};
const Camera kTokyo{.eye = {.lat = Angle::degrees(35.7), .lon = Angle::degrees(139.7), .height_m = 8e5}};

Status save(const OffscreenTarget& picture, const std::string& path) {
  const auto png = encode_png({kSize.width_px, kSize.height_px, picture.read()});
  if (!png) return png.error();
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(png->data()), std::ssize(*png));
  return file.flush() ? Status{Done{}} : Error{path + ": cannot be written"};
}

Status film(const char* tiles_path, const std::string& folder, double seconds) {
  const auto context = HeadlessContext::create();
  if (!context) return context.error();
  auto tiles = open_tile_set(tiles_path);
  if (!tiles) return tiles.error();
  GlobeOptions options;
  options.sky = true;
  auto globe = Globe::create(options, *std::move(tiles));
  if (!globe) return globe.error();
  const OffscreenTarget picture(kSize);
  Flight flight = plan_flight(kLisbon, kTokyo, (*globe)->options().body.ellipsoid);
  flight.duration = Seconds(seconds);
  for (int frame = 0; frame <= seconds * kFramesPerSecond; ++frame) {
    (*globe)->set_camera(flight_camera(flight, Seconds(frame / kFramesPerSecond)));
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    if (!(*globe)->render_until_settled(picture.framebuffer(), kSize, deadline)) std::cerr << "a frame lacks tiles\n";
    char name[16];
    std::snprintf(name, sizeof name, "/%04d.png", frame);
    if (Status saved = save(picture, folder + name); !saved) return saved;
  }
  return Done{};
}

int main(int argc, char** argv) {
  if (argc < 3) return std::cerr << "flight_frames TILES FOLDER [SECONDS]\n", 2;
  const Status filmed = film(argv[1], argv[2], argc > 3 ? std::atof(argv[3]) : 8.0);
  if (!filmed) std::cerr << filmed.error().message << '\n';
  return filmed ? 0 : 1;
}
