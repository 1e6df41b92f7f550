#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tests/gl/gl_fixture.h"

namespace terrella::test {

/// One eye's part of a picture, whichever way the eyes are put together: halves, rows or colours.
struct EyeSight {
  std::string name;
  const Picture* picture = nullptr;
  View view;
  int left_px = 0, first_row = 0, rows_apart = 1;
  std::array<bool, 3> channels{true, true, true};  ///< red, green, blue: those that are this eye's

  /// True if the view of the eye includes row `y`.
  [[nodiscard]] bool has_row(int y) const { return y % rows_apart == first_row; }
  /// By pixels of the eye's own view; the row must be one of the eye's.
  [[nodiscard]] Color at(glm::ivec2 px) const { return picture->at(left_px + px.x, px.y); }
  /// The pixel of the eye's rows next to where a place is in its view; nothing outside it.
  [[nodiscard]] std::optional<glm::ivec2> pixel_of(const Ecef& place) const;
  /// True if the eye's channels of a colour are those expected, each within `tolerance`.
  [[nodiscard]] bool sees(const Color& color, const Color& expected, int tolerance) const;
};

/// The eyes of the globe's last picture, one or two; `picture` must outlive them.
[[nodiscard]] std::vector<EyeSight> eye_sights(const Globe& globe, const Picture& picture);

/// The size of a picture in which each eye's view has the size `view`.
[[nodiscard]] Viewport picture_size(Stereo stereo, Viewport view);

/// A colour of a surface over another one by paper 2's formulas (2.7) and (2.9).
[[nodiscard]] Color blended(const SurfaceLook& look, const Color& surface, const Color& below);

/// The pixels of an eye whose line of sight meets the body further inside the limb than `margin` of its radius.
[[nodiscard]] std::vector<glm::ivec2> pixels_inside(const EyeSight& eye, const Ellipsoid& body, double margin);

[[nodiscard]] std::string words_of(const EyeSight& eye, glm::ivec2 px, const Color& color);
/// Names the tests of a suite over kAllStereo.
[[nodiscard]] std::string stereo_test_name(const testing::TestParamInfo<Stereo>& tested);

/// All ways of showing two eyes, and one eye alone.
inline constexpr std::array kAllStereo = {Stereo::off, Stereo::side_by_side, Stereo::interlaced, Stereo::anaglyph};

}  // namespace terrella::test
