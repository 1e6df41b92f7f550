#include "apps/open_scene/project/write_project.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/open_scene/options/option_words.h"
#include "apps/open_scene/options/place_options.h"
#include "apps/open_scene/project/project_paths.h"
#include "apps/open_scene/project/project_words.h"
#include "base/iso_time.h"
#include "streaming/objects/object_style.h"
#include "streaming/sets/elevation_json.h"

namespace terrella {
namespace {

using OrderedJson = nlohmann::ordered_json;
namespace fs = std::filesystem;

/// Writes a value that differs from its default.
template <class Value>
void put(OrderedJson& object, const char* name, const Value& value, const Value& standard) {
  if (value != standard) object[name] = value;
}

template <class Value>
void put_word(OrderedJson& object, const char* name, Value value, Value standard, const OptionWords<Value>& words) {
  if (value != standard) object[name] = word_of(words, value);
}

const char* on_off(bool on) { return on ? "on" : "off"; }

std::string body_text(const Body& body) {
  const auto presets = body_presets();
  const auto same = [&body](const Body& preset) {
    return preset.ellipsoid.a_m() == body.ellipsoid.a_m() && preset.ellipsoid.f() == body.ellipsoid.f();
  };
  const auto named = std::ranges::find(presets, body.name, &Body::name);
  if (named != presets.end() && same(*named)) return named->name;
  return fmt::format("{},{}", body.ellipsoid.a_m(), body.ellipsoid.f());
}

std::string color_text(const glm::vec3& srgb) {
  const glm::u8vec3 bytes(glm::round(255.0F * srgb));
  return terrella::color_text(ObjectColor{bytes.r, bytes.g, bytes.b});
}

void put_surface(OrderedJson& json, const SurfaceLook& surface) {
  const SurfaceLook standard;
  put(json, "surface-alpha", surface.alpha, standard.alpha);
  put_word(json, "blend", surface.blend, standard.blend, blend_words());
  if (!surface.inner_sphere_below_m) {
    json["inner-sphere"] = "off";
  } else {
    put(json, "inner-sphere", *surface.inner_sphere_below_m, *standard.inner_sphere_below_m);
  }
  json["inner-sphere-color"] = color_text(surface.inner_sphere_srgb);
  put_word(json, "surface-from-below", surface.from_below, standard.from_below, from_below_words());
  put_word(json, "horizon-culling", surface.horizon_culling, standard.horizon_culling, culling_words());
  put(json, "hillshade", surface.hillshade, standard.hillshade);
  put_word(json, "magnify", surface.sharpness, standard.sharpness, sharpness_words());
  if (!surface.glint) json["glint"] = "off";
  if (surface.swipe) json["swipe"] = *surface.swipe;
}

void put_drawing(OrderedJson& json, const SceneOptions& scene) {
  const SceneOptions standard;
  put(json, "unlit", scene.unlit, standard.unlit);
  put_word(json, "texturing", scene.texturing, standard.texturing, texturing_words());
  put(json, "paper-a", scene.paper_a, standard.paper_a);
  if (!scene.squeezed_rows) json["polar-rows"] = "full";
  put(json, "polar-columns", scene.polar_columns, standard.polar_columns);
  put(json, "detail", scene.texels_per_pixel, standard.texels_per_pixel);
  put_word(json, "depth", scene.depth, standard.depth, depth_words());
}

void put_sky(OrderedJson& json, const SceneOptions& scene) {
  if (!scene.sky) json["sky"] = "off";
  if (scene.time) json["time"] = time_text(*scene.time, TimePrecision::millisecond, true);
  if (!scene.night_lights) json["night-lights"] = "off";
  put_word(json, "stereo", scene.stereo.mode, Stereo::off, stereo_words());
  if (scene.stereo.eye_separation_m) json["eye-separation"] = *scene.stereo.eye_separation_m;
}

OrderedJson settings_of(const SceneOptions& scene, const fs::path& folder) {
  OrderedJson json = OrderedJson::object();
  if (scene.base.body) json["body"] = body_text(*scene.base.body);
  if (scene.camera) json["camera"] = camera_text(*scene.camera);
  json["size"] = fmt::format("{}x{}", scene.size.width_px, scene.size.height_px);
  put(json, "exaggeration", scene.exaggeration, 1.0);
  put_sky(json, scene);
  if (scene.map) json["map"] = on_off(*scene.map);
  if (!scene.places.empty()) json["places"] = seen_from(scene.places, folder);
  if (scene.graticule) json["graticule"] = *scene.graticule;
  put_surface(json, scene.surface);
  put_drawing(json, scene);
  return json;
}

void put_numbers(OrderedJson& json, const NumberOptions& numbers, const fs::path& folder) {
  put(json, "band", numbers.band, 0);
  if (numbers.bands)
    json["bands"] = fmt::format("{},{},{}", (*numbers.bands)[0], (*numbers.bands)[1], (*numbers.bands)[2]);
  for (const StretchRule& rule : numbers.stretch) json["stretch"].push_back(stretch_text(rule));
  if (numbers.nodata) json["nodata"] = *numbers.nodata;
  put(json, "lit-numbers", numbers.lit, false);
  if (numbers.angle) json[*numbers.angle == GroundAngle::slope ? "slope" : "aspect"] = true;
  put(json, "contours", numbers.contours, 0.0);
  if (numbers.colormap.empty()) return;
  json["colormap"] = has_named_map(numbers.colormap) ? numbers.colormap : seen_from(numbers.colormap, folder);
}

void put_remote(OrderedJson& json, const RemoteOptions& remote) {
  put(json, "layer", remote.layer, {});
  put(json, "matrix-set", remote.matrix_set, {});
  put(json, "style", remote.style, {});
  put(json, "layer-time", remote.time, {});
  for (const std::string& times : remote.times) json["layer-times"].push_back(times);
  if (remote.root_span_deg) json["root-span"] = *remote.root_span_deg;
  if (remote.tile_px) json["tile-size"] = *remote.tile_px;
  if (remote.max_level) json["max-level"] = *remote.max_level;
}

void put_source(OrderedJson& json, const SourceOptions& source, const fs::path& folder) {
  if (!source.address.empty()) json["source"] = seen_from(source.address.with_secrets(), folder);
  if (source.projection) json["projection"] = word_of(projection_words(), *source.projection);
  if (source.latitude) json["latitude"] = word_of(latitude_words(), *source.latitude);
  put(json, "crs", source.place.crs, {});
  if (source.place.bounds) json["bounds"] = bounds_text(*source.place.bounds);
  if (source.place.west_deg) json["west"] = *source.place.west_deg;
  put_numbers(json, source.numbers, folder);
  put_remote(json, source.remote);
}

void put_look(OrderedJson& json, bool shown, double opacity) {
  put(json, kShown, shown, true);
  put(json, kOpacity, opacity, 1.0);
}

OrderedJson image_json(const SourceOptions& source, const ImageLook& look, const fs::path& folder) {
  OrderedJson json = {{kKind, kImagery}};
  put_source(json, source, folder);
  if (source.remote.name) json[kTitle] = *source.remote.name;
  if (source.remote.attribution) json[kAttribution] = *source.remote.attribution;
  put(json, kOtherBody, source.other_body, false);
  put_look(json, look.shown, look.opacity);
  put_word(json, kDaylight, look.daylight, Daylight::both, daylight_words());
  put_word(json, kAlpha, look.alpha, AlphaFrom::own, alpha_words());
  put(json, kHeight, look.height_m, 0.0);
  put_word(json, kLayerBlend, look.blend, LayerBlend::normal, layer_blend_words());
  const ImageTone plain;
  put(json, kBrightness, look.tone.brightness, plain.brightness);
  put(json, kContrast, look.tone.contrast, plain.contrast);
  put(json, kGamma, look.tone.gamma, plain.gamma);
  put_word(json, kSwipe, look.swipe, SwipeSide::both, swipe_words());
  put_word(json, kClock, look.clock, LayerClock::own, clock_words());
  return json;
}

OrderedJson heights_json(const SceneOptions& scene, const fs::path& folder) {
  OrderedJson json = {{kKind, kHeights}};
  if (!is_included_relief(scene.elevation)) json[kSource] = seen_from(scene.elevation.with_secrets(), folder);
  put(json, kShown, scene.elevation_shown, true);
  for (const char* name : kEncodings) {
    if (scene.elevation_encoding && rgb_encoding(name) == scene.elevation_encoding) json[kEncoding] = name;
  }
  return json;
}

OrderedJson objects_json(const ObjectsOption& objects, const fs::path& folder) {
  OrderedJson json = {{kKind, objects.model_place ? kModel : kObjects}, {kSource, seen_from(objects.file, folder)}};
  if (!objects.style.empty()) json[kStyle] = seen_from(objects.style, folder);
  if (!objects.style_over.empty()) json[kStyleOver] = OrderedJson::parse(objects.style_over);
  put(json, kCluster, objects.cluster_px, 0.0);
  if (objects.model_place) {
    const Geodetic& at = *objects.model_place;
    json[kPlace] = {at.lat.deg(), at.lon.deg(), at.height_m};
  }
  put_look(json, objects.shown, objects.opacity);
  return json;
}

/// True for an address that a project may hold; else says that it is left out.
bool may_hold(const SourceOptions& source, std::vector<std::string>& left_out) {
  const Url& address = source.address;
  if (address.redacted() == address.with_secrets() && source.remote.headers.empty()) return true;
  left_out.push_back(
      fmt::format("{}: the project does not hold it, because its address or header is a secret", address.redacted()));
  return false;
}

}  // namespace

std::string preload_task_text(const SourceOptions& source) {
  OrderedJson json = {{"command", "preload"}, {"SOURCE", source.address.with_secrets()}};
  if (source.projection) json["projection"] = word_of(projection_words(), *source.projection);
  put_remote(json, source.remote);
  for (const std::string& header : source.remote.headers) json["header"].push_back(header);
  return json.dump(2, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
}

ProjectText project_text(const SceneOptions& scene, const fs::path& folder) {
  ProjectText project;
  OrderedJson layers = OrderedJson::array();
  if (!scene.elevation.empty() && may_hold({.address = scene.elevation}, project.left_out))
    layers.push_back(heights_json(scene, folder));
  if (may_hold(scene.base, project.left_out)) layers.push_back(image_json(scene.base, scene.base_look, folder));
  for (const LayerOption& layer : scene.layers) {
    if (may_hold(layer.source, project.left_out)) layers.push_back(image_json(layer.source, layer.look, folder));
  }
  for (const ObjectsOption& objects : scene.object_layers) layers.push_back(objects_json(objects, folder));
  OrderedJson json = {{kVersion, kProjectVersion}, {kSettings, settings_of(scene, folder)}, {kLayers, layers}};
  if (!scene.drawings.empty()) json[kDrawings] = OrderedJson::parse(scene.drawings);
  project.text = json.dump(2, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
  return project;
}

}  // namespace terrella
