#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "surface/layers.h"
#include "tiles/tile_grid.h"
#include "view/render_modes.h"

namespace terrella {

/// Words of an option for the values of an enumeration.
template <class Value>
using OptionWords = std::vector<std::pair<std::string, Value>>;

// The words are functions, because a constant of strings could throw before main(). thread: any, for all of them

[[nodiscard]] inline OptionWords<Projection> projection_words() {
  return {{"equirectangular", Projection::equirectangular},
          {"equal-area", Projection::equal_area},
          {"web-mercator", Projection::web_mercator}};
}
[[nodiscard]] inline OptionWords<LatitudeKind> latitude_words() {
  return {{"graphic", LatitudeKind::graphic}, {"centric", LatitudeKind::centric}};
}
[[nodiscard]] inline OptionWords<LayerClock> clock_words() {
  return {{"own", LayerClock::own}, {"globe", LayerClock::globe}, {"globe-fades", LayerClock::globe_fades}};
}
[[nodiscard]] inline OptionWords<Texturing> texturing_words() {
  return {{"vertex", Texturing::vertex},
          {"paper", Texturing::paper},
          {"exact", Texturing::exact},
          {"auto", Texturing::automatic}};
}
[[nodiscard]] inline OptionWords<Sharpness> sharpness_words() {
  return {{"bilinear", Sharpness::bilinear}, {"bicubic", Sharpness::bicubic}, {"auto", Sharpness::automatic}};
}
[[nodiscard]] inline OptionWords<DepthMode> depth_words() {
  return {{"reversed", DepthMode::reversed}, {"log", DepthMode::logarithmic}, {"standard", DepthMode::standard}};
}
[[nodiscard]] inline OptionWords<Blend> blend_words() {
  return {{"normal", Blend::normal}, {"additive", Blend::additive}};
}
[[nodiscard]] inline OptionWords<LayerBlend> layer_blend_words() {
  return {{"normal", LayerBlend::normal},
          {"multiply", LayerBlend::multiply},
          {"screen", LayerBlend::screen},
          {"difference", LayerBlend::difference}};
}
[[nodiscard]] inline OptionWords<SurfaceFromBelow> from_below_words() {
  return {{"opaque", SurfaceFromBelow::opaque},
          {"translucent", SurfaceFromBelow::translucent},
          {"selective", SurfaceFromBelow::selective}};
}
[[nodiscard]] inline OptionWords<HorizonCulling> culling_words() {
  return {{"on", HorizonCulling::on}, {"off", HorizonCulling::off}, {"auto", HorizonCulling::automatic}};
}
[[nodiscard]] inline OptionWords<Stereo> stereo_words() {
  return {{"off", Stereo::off},
          {"side-by-side", Stereo::side_by_side},
          {"interlaced", Stereo::interlaced},
          {"anaglyph", Stereo::anaglyph}};
}

/// The word of a value that has one.
template <class Value>
[[nodiscard]] std::string word_of(const OptionWords<Value>& words, Value value) {
  return std::ranges::find(words, value, &std::pair<std::string, Value>::second)->first;
}

}  // namespace terrella
