#include "tests/gl/eye_sights.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "view/stereo.h"

namespace terrella::test {
namespace {

EyeSight right_eye_of(Stereo stereo, EyeSight eye) {
  eye.name = "right eye";
  if (stereo == Stereo::side_by_side) eye.left_px = eye.view.viewport.width_px;
  if (stereo == Stereo::interlaced) eye.first_row = 1;
  if (stereo == Stereo::anaglyph) eye.channels = {false, true, true};
  return eye;
}

}  // namespace

std::optional<glm::ivec2> EyeSight::pixel_of(const Ecef& place) const {
  const auto px = project(view, place);
  if (!px) return {};
  glm::ivec2 pixel(std::floor(px->x), std::floor(px->y));
  pixel.y -= (pixel.y + rows_apart - first_row) % rows_apart;
  if (pixel.x < 0 || pixel.y < 0 || pixel.x >= view.viewport.width_px || pixel.y >= view.viewport.height_px) return {};
  return pixel;
}

bool EyeSight::sees(const Color& color, const Color& expected, int tolerance) const {
  for (std::size_t k = 0; k < 3; ++k) {
    if (channels[k] && std::abs(int{color[k]} - int{expected[k]}) > tolerance) return false;
  }
  return true;
}

std::vector<EyeSight> eye_sights(const Globe& globe, const Picture& picture) {
  const StereoLook& look = globe.options().stereo;
  Viewport size = picture.size;
  if (look.mode == Stereo::side_by_side) size.width_px = std::max(1, size.width_px / 2);
  const View middle = globe.view(size);
  if (look.mode == Stereo::off) return {{.name = "one eye", .picture = &picture, .view = middle}};
  const EyePair pair = stereo_eyes(middle, globe.ground(), look);
  EyeSight left{.name = "left eye", .picture = &picture, .view = pair.left}, right = left;
  right.view = pair.right;
  if (look.mode == Stereo::interlaced) left.rows_apart = right.rows_apart = 2;
  if (look.mode == Stereo::anaglyph) left.channels = {true, false, false};
  right = right_eye_of(look.mode, right);
  if (right.left_px >= picture.size.width_px) return {left};  // a picture of one column has none for the right eye
  return {left, right};
}

Viewport picture_size(Stereo stereo, Viewport view) {
  if (stereo == Stereo::side_by_side) view.width_px *= 2;
  return view;
}

Color blended(const SurfaceLook& look, const Color& surface, const Color& below) {
  const double rest = look.blend == Blend::normal ? 1.0 - look.alpha : 1.0;
  Color out{};
  for (std::size_t k = 0; k < 3; ++k) {
    out[k] = static_cast<std::uint8_t>(std::lround(std::min(255.0, look.alpha * surface[k] + rest * below[k])));
  }
  return look.alpha < 1.0 ? out : surface;  // opaque is opaque by either formula
}

std::vector<glm::ivec2> pixels_inside(const EyeSight& eye, const Ellipsoid& body, double margin) {
  const Ellipsoid smaller(body.a_m() * (1.0 - margin), body.f());
  std::vector<glm::ivec2> inside;
  for (int y = 0; y < eye.view.viewport.height_px; ++y) {
    if (!eye.has_row(y)) continue;
    for (int x = 0; x < eye.view.viewport.width_px; ++x) {
      if (smaller.intersect_m(eye.view.eye, pixel_ray(eye.view, {x + 0.5, y + 0.5}))) inside.emplace_back(x, y);
    }
  }
  return inside;
}

std::string words_of(const EyeSight& eye, glm::ivec2 px, const Color& color) {
  std::string text = eye.name + " at " + std::to_string(px.x) + "," + std::to_string(px.y) + " sees";
  for (const std::uint8_t c : color) text += " " + std::to_string(c);
  return text;
}

std::string stereo_test_name(const testing::TestParamInfo<Stereo>& tested) {
  constexpr std::array kNames = {"OneEye", "SideBySide", "Interlaced", "Anaglyph"};
  return kNames[static_cast<std::size_t>(tested.param)];
}

}  // namespace terrella::test
