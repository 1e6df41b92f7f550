#include "apps/program/map_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "apps/open_scene/open_rasters.h"
#include "apps/process/console.h"
#include "apps/process/process.h"
#include "apps/process/stop_signals.h"
#include "apps/process/write_file.h"
#include "apps/program/commands.h"
#include "base/number.h"
#include "streaming/cut/halve.h"
#include "streaming/file_bytes.h"
#include "streaming/raster/gdal/write_geotiff.h"
#include "streaming/raster/in_parallel.h"
#include "streaming/warp/flat_map.h"

namespace terrella {
namespace {

constexpr int kBlock_px = FlatMapLayer::kBlock_px;
constexpr std::size_t kMostOfMap = 16;

/// A layer of the map with its look.
struct MapLayer {
  std::unique_ptr<FlatMapLayer> pixels;
  ImageLook look;
  NumberInfo numbers{};
};

/// A colour with values in [0, 1], premultiplied by its alpha.
struct Colour {
  float r = 0.0F, g = 0.0F, b = 0.0F, a = 0.0F;
};

Colour colour_of(const std::uint8_t* rgba) {
  constexpr float kByte = 1.0F / 255.0F;
  const float a = static_cast<float>(rgba[3]) * kByte, to = a * kByte;
  return {static_cast<float>(rgba[0]) * to, static_cast<float>(rgba[1]) * to, static_cast<float>(rgba[2]) * to, a};
}

/// As toned() of shaders/surface/patch_common.glsl.
float toned(float part, float alpha, const ImageTone& tone) {
  const double color = (static_cast<double>(part / std::max(alpha, 1e-3F)) - 0.5) * tone.contrast + 0.5;
  return static_cast<float>(std::pow(std::clamp(color + tone.brightness, 0.0, 1.0), 1.0 / tone.gamma)) * alpha;
}

/// The colour of a pixel of a picture in its layer's look.
Colour with_look(Colour colour, const ImageLook& look) {
  if (!(look.tone == ImageTone{})) {
    for (float* part : {&colour.r, &colour.g, &colour.b}) *part = toned(*part, colour.a, look.tone);
  }
  if (look.alpha == AlphaFrom::brightness) colour.a = std::max({colour.r, colour.g, colour.b});
  return colour;
}

/// As blended() of shaders/surface/patch_blend.glsl, of values that are not premultiplied.
float blended(float below, float own, LayerBlend blend) {
  switch (blend) {
    case LayerBlend::multiply:
      return below * own;
    case LayerBlend::screen:
      return below + own - below * own;
    case LayerBlend::difference:
      return std::abs(below - own);
    case LayerBlend::normal:
      break;
  }
  return own;
}

/// A colour of a layer blended with the colour below, as far as that one is there.
Colour blended(Colour over, const Colour& below, LayerBlend blend) {
  if (blend == LayerBlend::normal || over.a <= 0.0F || below.a <= 0.0F) return over;
  const auto part = [&](float own, float under) {
    return own * (1.0F - below.a) + over.a * below.a * blended(under / below.a, own / over.a, blend);
  };
  return {part(over.r, below.r), part(over.g, below.g), part(over.b, below.b), over.a};
}

/// The map's picture, drawn block by block.
class MapDrawing {
 public:
  MapDrawing(const FlatMap& map, const std::vector<MapLayer>& layers, double timeout_s)
      : layers_(layers),
        across_((map.width_px + kBlock_px - 1) / kBlock_px),
        down_((map.height_px + kBlock_px - 1) / kBlock_px),
        deadline_(std::chrono::steady_clock::now() + std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                                                         std::chrono::duration<double>(timeout_s))) {
    image.width_px = map.width_px;
    image.height_px = map.height_px;
    image.rgba.resize(static_cast<std::size_t>(map.width_px) * static_cast<std::size_t>(map.height_px) * 4);
  }

  void draw() {
    in_parallel(thread_count(0), std::int64_t{across_} * down_,
                [this](std::int64_t block) { draw_block(block % across_, block / across_); });
  }

  Image image;
  std::atomic<std::int64_t> lacked = 0;  ///< blocks of layers that could not be made
  std::set<std::string> reasons{};       ///< reasons of those, at most kMostOfMap
  std::set<std::string> attributions{};  ///< attributions of the layers that show

 private:
  using Colours = std::vector<Colour>;

  void draw_block(std::int64_t column, std::int64_t row) {
    if (StopSignals::came()) return;
    Colours colours(static_cast<std::size_t>(kBlock_px) * kBlock_px);
    for (const MapLayer& layer : layers_) {
      const auto block = layer.pixels->block(column, row, [this] { return may_wait(); });
      if (block) {
        draw_over(layer, *block, colours);
      } else if (block.error().kind != MissingKind::absent && block.error().kind != MissingKind::blank) {
        note(block.error().why);
      }
    }
    write(colours, static_cast<int>(column) * kBlock_px, static_cast<int>(row) * kBlock_px);
  }

  void draw_over(const MapLayer& layer, const Block& block, Colours& colours) {
    const auto opacity = static_cast<float>(layer.look.opacity);
    bool shows = false;
    for (std::size_t i = 0; i < colours.size(); ++i) {
      Colour& under = colours[i];
      const Colour over = blended(colour_at(layer, block, i), under, layer.look.blend);
      if (over.a <= 0.0F && over.r + over.g + over.b <= 0.0F) continue;
      shows = true;
      const float through = 1.0F - over.a * opacity;
      under = {over.r * opacity + under.r * through, over.g * opacity + under.g * through,
               over.b * opacity + under.b * through, over.a * opacity + under.a * through};
    }
    const std::string& thanks = layer.pixels->info().attribution;
    if (!shows || thanks.empty()) return;
    const std::lock_guard lock(mutex_);
    attributions.insert(thanks);
  }

  static Colour colour_at(const MapLayer& layer, const Block& block, std::size_t at) {
    if (const auto* picture = std::get_if<Image>(&block)) {
      return with_look(colour_of(picture->rgba.data() + 4 * at), layer.look);
    }
    const float number = std::get<Numbers>(block).values[at];
    if (!std::isfinite(number)) return {};
    const Rgba8 rgba = color_of(*layer.look.numbers, number * layer.numbers.scale + layer.numbers.offset);
    const std::array bytes = {rgba.r, rgba.g, rgba.b, rgba.a};
    return with_look(colour_of(bytes.data()), layer.look);
  }

  void write(const Colours& colours, int left, int top) {
    const int width = std::min(kBlock_px, image.width_px - left), height = std::min(kBlock_px, image.height_px - top);
    const auto byte = [](float part) {
      return static_cast<std::uint8_t>(std::clamp(part * 255.0F + 0.5F, 0.0F, 255.0F));
    };
    for (int row = 0; row < height; ++row) {
      const Colour* from = colours.data() + static_cast<std::size_t>(row) * kBlock_px;
      std::uint8_t* to =
          image.rgba.data() + 4 * (static_cast<std::size_t>(top + row) * static_cast<std::size_t>(image.width_px) +
                                   static_cast<std::size_t>(left));
      for (int i = 0; i < width; ++i, ++from, to += 4) {
        if (from->a <= 0.0F) continue;
        to[0] = byte(from->r / from->a);
        to[1] = byte(from->g / from->a);
        to[2] = byte(from->b / from->a);
        to[3] = byte(from->a);
      }
    }
  }

  [[nodiscard]] bool is_late() const { return std::chrono::steady_clock::now() >= deadline_; }
  [[nodiscard]] bool may_wait() const { return !StopSignals::came() && !is_late(); }

  void note(const std::string& why) {
    ++lacked;
    const std::lock_guard lock(mutex_);
    if (reasons.size() < kMostOfMap) reasons.insert(why + (is_late() ? "; --timeout gives servers longer" : ""));
  }

  const std::vector<MapLayer>& layers_;
  const int across_, down_;  ///< blocks
  const std::chrono::steady_clock::time_point deadline_;
  std::mutex mutex_;  ///< guards reasons and attributions
};

/// The largest map within the size whose pixels are square.
FlatMap map_of(const MapCommand& command) {
  const CrsBounds& extent = command.extent;
  const Viewport& most = command.render.scene.size;
  const double width = extent.east - extent.west, height = extent.north - extent.south;
  const double unit = std::max(width / most.width_px, height / most.height_px);
  const auto pixels = [&](double side) { return std::max(1, static_cast<int>(std::lround(side / unit))); };
  return {.crs = command.crs,
          .west = extent.west,
          .north = extent.north,
          .unit_per_px = unit,
          .width_px = pixels(width),
          .height_px = pixels(height)};
}

/// The tiles of a layer, at the scene's time if the layer follows that; null before its first instant.
Result<std::shared_ptr<TileSource>> tiles_of(const SceneLayer& layer, const ImageLook& look,
                                             std::optional<UtcTime> time) {
  const auto& steps = layer.tiles->info().steps;
  if (look.clock == LayerClock::own || !time || !steps) return layer.tiles;
  if (!steps->at_or_before(*time)) return std::shared_ptr<TileSource>();
  auto tiles = layer.tiles->at_time(*time);
  if (!tiles) return tiles.error();
  return std::shared_ptr<TileSource>(*std::move(tiles));
}

Result<std::vector<MapLayer>> layers_of(const OpenedScene& scene, const FlatMap& map) {
  std::vector<MapLayer> layers;
  for (const SceneLayer& layer : scene.images) {
    const auto look = scene.globe->look(layer.id);
    // A layer of the night shows where a time puts it, and a map has none.
    if (!look || !look->shown || look->opacity == 0.0 || look->daylight == Daylight::night) continue;
    auto tiles = tiles_of(layer, *look, scene.globe->options().time);
    if (!tiles) return Error{layer.source.address.redacted() + ": " + tiles.error().message};
    if (!*tiles) continue;
    auto pixels = FlatMapLayer::open(*std::move(tiles), map, scene.body);
    if (!pixels) return Error{fmt::format("--crs {}: {}", in_quotes(map.crs), pixels.error().message)};
    MapLayer made{.pixels = *std::move(pixels), .look = *look};
    if (const auto& numbers = made.pixels->info().numbers) made.numbers = *numbers;
    if (made.numbers.period > 0.0) {
      return Error{layer.source.address.redacted() + ": a map of --extent has no directions; leave --aspect out"};
    }
    layers.push_back(std::move(made));
  }
  return layers;
}

/// Names what the scene has and the map has not. True if there is something.
bool tell_of_left_out(const OpenedScene& scene, const std::vector<MapLayer>& layers) {
  const bool contours = std::ranges::any_of(
      layers, [](const MapLayer& layer) { return layer.look.numbers && layer.look.numbers->contour_step != 0.0; });
  if (contours) print_message("terrella render: a map of --extent has no contour lines; they are left out\n");
  if (!scene.objects.empty()) print_message("terrella render: a map of --extent has no objects; they are left out\n");
  return contours || !scene.objects.empty();
}

void report(const MapCommand& command, const FlatMap& map, const MapDrawing& drawing) {
  const CrsPoint corner = map.to_crs().at(map.width_px, map.height_px);
  const CrsBounds extent{map.west, corner.y, corner.x, map.north};
  if (command.render.json) {
    const nlohmann::json result = {{"output", command.render.output},
                                   {"width_px", map.width_px},
                                   {"height_px", map.height_px},
                                   {"unit_per_px", map.unit_per_px},
                                   {"crs", map.crs},
                                   {"extent", {extent.west, extent.south, extent.east, extent.north}},
                                   {"blocks_lacked", drawing.lacked.load()},
                                   {"lacking", drawing.reasons},
                                   {"attributions", drawing.attributions}};
    print_result("{}\n", result.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    return;
  }
  print_result("{}: {}x{} pixels of {:.6g} units of {}, from {:.9g},{:.9g} to {:.9g},{:.9g}\n", command.render.output,
               map.width_px, map.height_px, map.unit_per_px, one_line(map.crs), extent.west, extent.south, extent.east,
               extent.north);
  thank(command.render.output, fmt::format("{}", fmt::join(drawing.attributions, "; ")));
}

bool is_empty(const Image& image) {
  for (std::size_t alpha = 3; alpha < image.rgba.size(); alpha += 4) {
    if (image.rgba[alpha] != 0) return false;
  }
  return true;
}

/// Draws and writes the map. Returns the exit code.
Result<int> write_map(const MapCommand& command) {
  const std::string& output = command.render.output;
  const std::vector<std::string> inputs = inputs_of(command.render.scene);
  if (const Status may = may_write_picture(output, inputs); !may) return may.error();
  const FlatMap map = map_of(command);
  constexpr std::size_t kBytesAPixel = 8;  // the picture, and GDAL's blocks and overviews of it
  const auto pixels = static_cast<std::size_t>(map.width_px) * static_cast<std::size_t>(map.height_px);
  const Status room =
      check_memory(kBytesAPixel * pixels, fmt::format("a map of {}x{} pixels", map.width_px, map.height_px));
  if (!room) return room.error();
  // The scene opens with the looks of its layers; the globe itself is not drawn.
  RenderCommand opened = command.render;
  opened.scene.size = {.width_px = 64, .height_px = 64};
  const auto picture = ScenePicture::open(opened);
  if (!picture) return picture.error();
  const OpenedScene& scene = (*picture)->scene();
  const auto layers = layers_of(scene, map);
  if (!layers) return layers.error();
  MapDrawing drawing(map, *layers, command.render.scene.base.timeout_s);
  drawing.draw();
  if (StopSignals::came()) return Error{output + ": stopped; no map was written"};
  for (const std::string& why : drawing.reasons) print_message("terrella render: missing: {}\n", one_line(why));
  if (is_empty(drawing.image)) {
    return Error{drawing.lacked > 0
                     ? "no tile of this --extent came; nothing was written"
                     : "no data are in this --extent; nothing was written: name another --extent, in units "
                       "of --crs, easting first"};
  }
  if (const Status may = may_write_picture(output, inputs); !may) return may.error();
  const std::string thanks = fmt::format("{}", fmt::join(drawing.attributions, "; "));
  if (const Status written =
          write_geotiff(output, {drawing.image, !are_opaque(drawing.image.rgba)}, map.crs, map.to_crs(), thanks);
      !written) {
    return written.error();
  }
  const bool left_out = tell_of_left_out(scene, *layers) || !scene.left_out.empty() || rasters_left_out() > 0;
  report(command, map, drawing);
  return drawing.lacked > 0 || left_out ? kDoneInPart : kDone;
}

}  // namespace

Status check_together(const MapCommand& command) {
  const CrsBounds& extent = command.extent;
  constexpr double kFarthest = 1e12;
  const bool near = std::max({std::abs(extent.west), std::abs(extent.south), std::abs(extent.east),
                              std::abs(extent.north)}) < kFarthest;
  // A pixel must move the edges on.
  const double unit = map_of(command).unit_per_px;
  if (!near || !(extent.west + unit > extent.west) || !(extent.north - unit < extent.north) ||
      extent.west >= extent.east || extent.south >= extent.north) {
    return Error{"--extent: it takes WEST < EAST and SOUTH < NORTH, in the units of --crs"};
  }
  const std::string extension = lower_extension(command.render.output);
  if (extension == ".tif" || extension == ".tiff") return Done{};
  return Error{"--output: a map of --extent is a GeoTIFF; name a file that ends in .tif"};
}

int run_map(const MapCommand& command) {
  const StopSignals signals;
  const auto exit_code = write_map(command);
  return exit_code ? *exit_code : fail("render", exit_code.error().message);
}

}  // namespace terrella
