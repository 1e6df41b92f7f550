#include "render/surface/night_lights.h"

#include <algorithm>
#include <bit>
#include <string>

#include "render/gl/storage.h"

namespace terrella {
namespace {
constexpr int kWidest_px = 16384;
}

Result<NightLights> NightLights::create(const GreyPicture& map) {
  const bool filled =
      map.width_px > 0 && map.height_px > 0 &&
      map.values.size() == static_cast<std::size_t>(map.width_px) * static_cast<std::size_t>(map.height_px);
  if (!filled || map.width_px > kWidest_px || map.height_px > kWidest_px) {
    return Error{"the map of night lights is " + std::to_string(map.width_px) + "x" + std::to_string(map.height_px) +
                 " pixels; it takes a filled map of 1 to " + std::to_string(kWidest_px) + " a side"};
  }
  const int side_px = std::max(1, map.width_px / 4);
  const auto levels = static_cast<GLsizei>(std::bit_width(static_cast<unsigned>(side_px)));
  gl::Texture texture = gl::make_texture(GL_TEXTURE_CUBE_MAP);
  glTextureStorage2D(texture.name(), levels, GL_R8, side_px, side_px);
  if (!gl::has_storage(texture)) return Error{"the driver has no memory for a map of night lights"};
  GLint alignment = 4;
  glGetIntegerv(GL_UNPACK_ALIGNMENT, &alignment);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  GLint face = 0;
  for (const std::vector<std::uint8_t>& texels : cube_faces(map, side_px)) {
    glTextureSubImage3D(texture.name(), 0, 0, 0, face++, side_px, side_px, 1, GL_RED, GL_UNSIGNED_BYTE, texels.data());
  }
  glPixelStorei(GL_UNPACK_ALIGNMENT, alignment);
  glGenerateTextureMipmap(texture.name());
  glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  return NightLights(std::move(texture));
}

void NightLights::bind() const {
  glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
  glBindTextureUnit(kUnit, texture_.name());
  glBindSampler(kUnit, 0);
}

}  // namespace terrella
