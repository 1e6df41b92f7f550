// aircraft TILES DATA OUTPUT.png [SECONDS]: 10,000 aircraft with icons and labels fly over 2,000 areas; one area is
// highlighted.
#include <terrella/globe.h>
#include <terrella/globe/data_files.h>
#include <terrella/render/gl/offscreen.h>
#include <terrella/streaming/sets/open_tile_set.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>

using namespace terrella;

namespace {

constexpr int kAircraft = 10'000, kAreas = 2'000;
constexpr Viewport kSize{1024, 1024};
constexpr float kIcon_px = 24.0F;

/// Aircraft fly round circles: a place by its number and the time.
Geodetic place_of(int aircraft, double seconds) {
  const double way = 0.02 * seconds + aircraft, lat_deg = std::fmod(aircraft * 90.585, 120.0) - 60.0;
  return {.lat = Angle::degrees(lat_deg + 2.0 * std::sin(way)),
          .lon = Angle::degrees(std::fmod(aircraft * 205.1425, 360.0) - 180.0 + 2.0 * std::cos(way)),
          .height_m = 10e3};
}

/// The direction in which the place moves, clockwise from north.
Angle heading_of(int aircraft, double seconds) {
  const double way = 0.02 * seconds + aircraft, cos_lat = std::cos(place_of(aircraft, seconds).lat.rad());
  return Angle::radians(std::atan2(-std::sin(way) * cos_lat, std::cos(way)));
}

/// An aircraft seen from above, nose up, with a dark rim. A file would be read by decode_image().
std::shared_ptr<const IconImage> aircraft_icon() {
  constexpr int kSide = 64;
  constexpr double kRim = 2.0;
  const auto outside = [](double x, double y) {  // about the distance from the shape, texels; inside it is negative
    const auto bar = [x, y](double top, double bottom, double half, double slope) {
      return std::max({top - y + slope * x, y - slope * x - bottom, x - half});
    };
    return std::min({bar(4.0, 60.0, 4.0, 0.0), bar(22.0, 31.0, 29.0, 0.5), bar(50.0, 56.0, 12.0, 0.4)});
  };
  IconImage icon{kSide, kSide, {}};
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const double off = outside(std::abs(x + 0.5 - kSide / 2), y + 0.5);
      const auto ink = [](double part) { return static_cast<std::uint8_t>(255.0 * std::clamp(part, 0.0, 1.0)); };
      const std::uint8_t light = ink(0.5 - off);
      icon.rgba.insert(icon.rgba.end(), {light, light, light, ink(0.5 + kRim - off)});
    }
  }
  return std::make_shared<const IconImage>(std::move(icon));
}

ObjectScene fleet() {
  ObjectScene scene;
  const auto icon = aircraft_icon();
  for (int k = 0; k < kAircraft; ++k) {
    const std::string name = "TE " + std::to_string(k);
    const ObjectIdentity of{ObjectId(k + 1),
                            std::make_shared<ObjectFeature>(ObjectFeature{R"({"name": ")" + name + "\"}"})};
    scene.points.push_back(
        {.place = place_of(k, 0.0),
         .size_px = kIcon_px,
         .icon = {.image = icon, .heading = heading_of(k, 0.0), .from_north = true, .tint = {255, 210, 60}},
         .of = of});
    scene.labels.push_back({.text = name, .place = place_of(k, 0.0), .size_px = kIcon_px, .of = of});
  }
  return scene;
}

ObjectScene areas() {
  ObjectScene scene;
  for (int k = 0; k < kAreas; ++k) {
    const double south = k / 72 * 4.5 - 62.0, west = k % 72 * 5.0 - 180.0;
    const auto corner = [](double lat, double lon) { return Geodetic{Angle::degrees(lat), Angle::degrees(lon)}; };
    scene.polygons.push_back({.rings = {{corner(south, west), corner(south, west + 4), corner(south + 4, west)}},
                              .fill = {90, 140, 230, 60},
                              .of = {ObjectId(k + 1)}});
  }
  return scene;
}

Status fly(const char* tiles, const char* data, const char* output, double seconds) {
  const auto context = HeadlessContext::create();
  if (!context) return context.error();
  auto source = open_tile_set(tiles);
  if (!source) return source.error();
  GlobeOptions options;
  if (Status read = add_data(options, data); !read) return read;
  auto made = Globe::create(options, *std::move(source));
  if (!made) return made.error();
  Globe& globe = **made;
  globe.set_camera({.eye = {.lat = Angle::degrees(30), .lon = Angle::degrees(10), .height_m = 5e6}});
  const auto ground = globe.add_objects(areas()), air = globe.add_objects(fleet());
  if (!ground || !air) return Error{"the objects cannot be drawn"};

  const OffscreenTarget picture(kSize);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  if (!globe.render_until_settled(picture.framebuffer(), kSize, deadline)) return Error{"tiles are still coming"};
  ObjectId highlighted = ObjectId::none;
  for (double now = 0.0; now < seconds; now += 1.0 / 30.0) {
    ObjectEdits edits;
    for (int k = 0; k < kAircraft; ++k) edits.moves.push_back({ObjectId(k + 1), place_of(k, now), heading_of(k, now)});
    if (Status moved = globe.edit_objects(*air, std::move(edits)); !moved) return moved;
    const GlobePick under = globe.pick({512.5, 512.5}, kSize);
    if (under.object && under.objects == *ground && under.object->of.id != highlighted) {
      edits = {.changes = {{.id = under.object->of.id, .selected = true}}};
      if (highlighted != ObjectId::none) edits.changes.push_back({.id = highlighted, .selected = false});
      if (Status lit = globe.edit_objects(*ground, edits); !lit) return lit;
      highlighted = under.object->of.id;
    }
    globe.render(picture.framebuffer(), kSize);
  }
  const auto png = encode_png({kSize.width_px, kSize.height_px, picture.read()});
  if (!png) return png.error();
  std::ofstream file(output, std::ios::binary);
  file.write(reinterpret_cast<const char*>(png->data()), std::ssize(*png));
  return file.flush() ? Status{Done{}} : Error{std::string(output) + ": cannot be written"};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4 || argc > 5) return std::cerr << "aircraft TILES DATA OUTPUT.png [SECONDS]\n", 2;
  const Status flown = fly(argv[1], argv[2], argv[3], argc == 5 ? std::atof(argv[4]) : 2.0);
  if (!flown) std::cerr << flown.error().message << '\n';
  return flown ? 0 : 1;
}
