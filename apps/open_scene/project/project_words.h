#pragma once

#include <array>
#include <string>

#include "apps/open_scene/options/option_words.h"
#include "surface/layers.h"
#include "view/color_map.h"

// Words of project files. thread: any
namespace terrella {

inline constexpr int kProjectVersion = 1;
inline constexpr const char *kVersion = "terrella", *kSettings = "settings", *kLayers = "layers",
                            *kDrawings = "drawings";

/// Options of `view` and `render` that a project may set.
inline constexpr std::array kSettingNames = {"body",
                                             "camera",
                                             "size",
                                             "exaggeration",
                                             "sky",
                                             "time",
                                             "night-lights",
                                             "stereo",
                                             "eye-separation",
                                             "map",
                                             "places",
                                             "graticule",
                                             "surface-alpha",
                                             "blend",
                                             "inner-sphere",
                                             "inner-sphere-color",
                                             "surface-from-below",
                                             "horizon-culling",
                                             "hillshade",
                                             "magnify",
                                             "glint",
                                             "swipe",
                                             "unlit",
                                             "texturing",
                                             "paper-a",
                                             "polar-rows",
                                             "polar-columns",
                                             "detail",
                                             "depth"};
/// Options of TILESET that an image layer may set.
inline constexpr std::array kSourceNames = {
    "projection",  "latitude",  "crs",         "bounds",    "west",  "band",  "bands",      "stretch",
    "nodata",      "colormap",  "lit-numbers", "contours",  "layer", "style", "matrix-set", "layer-time",
    "layer-times", "root-span", "tile-size",   "max-level", "slope", "aspect"};

// Fields of a layer.
inline constexpr const char *kKind = "kind", *kSource = "source", *kShown = "shown", *kOpacity = "opacity",
                            *kDaylight = "daylight", *kAlpha = "alpha", *kHeight = "height", *kSwipe = "swipe-side",
                            *kClock = "clock", *kLayerBlend = "blend", *kBrightness = "brightness",
                            *kContrast = "contrast", *kGamma = "gamma", *kEncoding = "elevation-encoding",
                            *kStyle = "object-style", *kStyleOver = "classes", *kPlace = "place", *kCluster = "cluster",
                            *kOtherBody = "other-body", *kTitle = "title", *kAttribution = "attribution";
// Kinds of a layer.
inline constexpr const char *kHeights = "heights", *kImagery = "imagery", *kObjects = "objects", *kModel = "model";
inline constexpr std::array kEncodings = {"terrain-rgb", "terrarium"};

[[nodiscard]] inline OptionWords<Daylight> daylight_words() {
  return {{"both", Daylight::both}, {"day", Daylight::day}, {"night", Daylight::night}};
}
[[nodiscard]] inline OptionWords<AlphaFrom> alpha_words() {
  return {{"own", AlphaFrom::own}, {"brightness", AlphaFrom::brightness}};
}
[[nodiscard]] inline OptionWords<SwipeSide> swipe_words() {
  return {{"both", SwipeSide::both}, {"before", SwipeSide::before}, {"behind", SwipeSide::behind}};
}

/// True if a value of --colormap names a map of the engine's; else it names a file.
[[nodiscard]] inline bool has_named_map(const std::string& colormap) {
  return named_color_map(colormap.substr(0, colormap.rfind(':'))).has_value();
}

}  // namespace terrella
