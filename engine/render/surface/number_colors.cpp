#include "render/surface/number_colors.h"

namespace terrella {
namespace {

constexpr double kMostCode = 65535.0;

/// Values of the uniform `number_look`. Shaders see a code as a fraction of kMostCode.
glm::vec4 uniform_of(const NumberInfo& info, const NumberSlots& slots, const NumberLook& look) {
  const double range = look.high - look.low;
  if (!slots.codes) return {kNoNumber, 1e37, info.scale / range, (info.offset - look.low) / range};
  return {slots.none / kMostCode, 0.5 / kMostCode, info.scale * kMostCode / slots.steps / range,
          (slots.least * info.scale + info.offset - look.low) / range};
}

}  // namespace

void NumberColors::set(const NumberLook& look) {
  if (look_ == look) return;
  look_ = look;
  uniform_ = uniform_of(info_, slots_, look);
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
