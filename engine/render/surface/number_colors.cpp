#include "render/surface/number_colors.h"

#include <numbers>

namespace terrella {
namespace {

constexpr double kMostCode = 65535.0;
constexpr float kHalfLine_px = 0.5F;

/// A number of a raster as a line of what shaders see: value = texel · factor + first. Shaders see a code as a fraction
/// of kMostCode.
struct ValueOfTexel {
  double factor, first;
};
ValueOfTexel value_of_texel(const NumberInfo& info, const NumberSlots& slots) {
  if (!slots.codes) return {info.scale, info.offset};
  return {info.scale * kMostCode / slots.steps, slots.least * info.scale + info.offset};
}

/// Value of the uniform `number_look`.
glm::vec4 uniform_of(const NumberInfo& info, const NumberSlots& slots, const NumberLook& look) {
  const auto [factor, first] = value_of_texel(info, slots);
  const double range = look.high - look.low;
  const double none = slots.codes ? slots.none / kMostCode : kNoNumber, apart = slots.codes ? 0.5 / kMostCode : 1e37;
  return {none, apart, factor / range, (first - look.low) / range};
}

/// Value of the uniform `number_lines`.
glm::vec4 lines_of(const NumberInfo& info, const NumberSlots& slots, const NumberLook& look) {
  const double radians = info.period > 0.0 ? 2.0 * std::numbers::pi / info.period : 0.0;
  if (look.contour_step == 0.0) return {0.0F, 0.0F, 0.0F, radians};
  const auto [factor, first] = value_of_texel(info, slots);
  return {factor / look.contour_step, first / look.contour_step, kHalfLine_px, radians};
}

}  // namespace

void NumberColors::set(const NumberLook& look) {
  if (look_ == look) return;
  look_ = look;
  uniform_ = uniform_of(info_, slots_, look);
  lines_ = lines_of(info_, slots_, look);
  if (!texture_) {
    texture_ = gl::make_texture(GL_TEXTURE_2D);
    glTextureStorage2D(texture_.name(), 1, GL_RGBA8, kBakedColors, 1);
    glTextureParameteri(texture_.name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTextureParameteri(texture_.name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  }
  const GLint filter = look.colors.discrete ? GL_NEAREST : GL_LINEAR;
  glTextureParameteri(texture_.name(), GL_TEXTURE_MIN_FILTER, filter);
  glTextureParameteri(texture_.name(), GL_TEXTURE_MAG_FILTER, filter);
  glTextureSubImage2D(texture_.name(), 0, 0, 0, kBakedColors, 1, GL_RGBA, GL_UNSIGNED_BYTE, bake(look).data());
}

void NumberColors::bind(GLuint unit) const {
  glBindTextureUnit(unit, texture_.name());
  glBindSampler(unit, 0);
}

}  // namespace terrella
