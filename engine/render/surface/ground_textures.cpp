#include "render/surface/ground_textures.h"

#include <algorithm>
#include <utility>

#include "render/gl/storage.h"

namespace terrella {
namespace {

constexpr int kFirstGroundSlots = 8;
constexpr int kSide_px = GroundPicture::kSide_px;

constexpr std::size_t slot_bytes(int plane) {
  if (plane == 1) return std::size_t{16} * kSide_px * kSide_px;
  std::size_t texels = 0;
  for (int k = 0; k < GroundPicture::kMips; ++k) texels += static_cast<std::size_t>((kSide_px >> k) * (kSide_px >> k));
  return 4 * texels;
}

int mips_of(int plane) { return plane == 0 ? GroundPicture::kMips : 1; }

gl::Sampler ground_sampler(GLenum minify, GLenum magnify) {
  gl::Sampler s = gl::make_sampler();
  glSamplerParameteri(s.name(), GL_TEXTURE_MIN_FILTER, static_cast<GLint>(minify));
  glSamplerParameteri(s.name(), GL_TEXTURE_MAG_FILTER, static_cast<GLint>(magnify));
  glSamplerParameteri(s.name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glSamplerParameteri(s.name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return s;
}

}  // namespace

gl::Texture GroundTextures::make(int plane, int slots) const {
  gl::Texture array = gl::make_texture(GL_TEXTURE_2D_ARRAY);
  glTextureStorage3D(array.name(), mips_of(plane), plane == fill ? GL_RGBA8 : GL_RGBA32UI, kSide_px, kSide_px, slots);
  return gl::has_storage(array) ? std::move(array) : gl::Texture();
}

std::size_t GroundTextures::bytes() const {
  return static_cast<std::size_t>(planes_[fill].slots) * slot_bytes(fill) +
         static_cast<std::size_t>(planes_[line].slots) * slot_bytes(line);
}

int GroundTextures::capacity() const {
  const std::size_t fit = std::max<std::size_t>(1, budget_bytes_ / (slot_bytes(fill) + slot_bytes(line)));
  return static_cast<int>(std::min(fit, static_cast<std::size_t>(most_slots_)));
}

bool GroundTextures::set_budget(std::size_t bytes) {
  budget_bytes_ = bytes;
  most_slots_ = kMostGroundSlots;
  if (std::max(planes_[fill].slots, planes_[line].slots) <= capacity()) return true;
  planes_ = {};
  return false;
}

// Takes half as many slots as there were.
bool GroundTextures::grow(int plane) {
  Plane& at = planes_[static_cast<std::size_t>(plane)];
  const int more = std::min(capacity() - at.slots, std::max(kFirstGroundSlots, at.slots / 2));
  if (more <= 0) return false;
  gl::Texture larger = make(plane, at.slots + more);
  if (!larger) {
    most_slots_ = at.slots;
    return false;
  }
  for (int k = 0; k < mips_of(plane) && at.slots > 0; ++k) {
    glCopyImageSubData(at.texture.name(), GL_TEXTURE_2D_ARRAY, k, 0, 0, 0, larger.name(), GL_TEXTURE_2D_ARRAY, k, 0, 0,
                       0, kSide_px >> k, kSide_px >> k, at.slots);
  }
  at.texture = std::move(larger);
  at.slots += more;
  return true;
}

bool GroundTextures::take(int plane, int& slot) {
  Plane& at = planes_[static_cast<std::size_t>(plane)];
  if (slot >= 0) return true;
  if (!at.free.empty()) {
    slot = at.free.back();
    at.free.pop_back();
    return true;
  }
  if (at.used == at.slots && !grow(plane)) return false;
  slot = at.used++;
  return true;
}

void GroundTextures::give_back(int plane, int& slot) {
  if (slot >= 0) planes_[static_cast<std::size_t>(plane)].free.push_back(std::exchange(slot, -1));
}

bool GroundTextures::put(const GroundPicture& picture, GroundSlots& slots) {
  if (picture.fill.empty()) give_back(fill, slots.fill);
  if (picture.line.empty()) give_back(line, slots.line);
  if (!picture.fill.empty() && !take(fill, slots.fill)) return false;
  if (!picture.line.empty() && !take(line, slots.line)) return false;
  const std::uint32_t* from = picture.fill.data();
  for (int k = 0; k < GroundPicture::kMips && !picture.fill.empty(); ++k) {
    const int side = kSide_px >> k;
    glTextureSubImage3D(planes_[fill].texture.name(), k, 0, 0, slots.fill, side, side, 1, GL_RGBA, GL_UNSIGNED_BYTE,
                        from);
    from += side * side;
  }
  if (!picture.line.empty()) {
    glTextureSubImage3D(planes_[line].texture.name(), 0, 0, 0, slots.line, kSide_px, kSide_px, 1, GL_RGBA_INTEGER,
                        GL_UNSIGNED_INT, picture.line.data());
  }
  return true;
}

void GroundTextures::release(GroundSlots& slots) {
  give_back(fill, slots.fill);
  give_back(line, slots.line);
}

void GroundTextures::bind(GLuint fill_unit, GLuint line_unit) const {
  if (!fill_sampler_) {
    auto* self = const_cast<GroundTextures*>(this);
    self->fill_sampler_ = ground_sampler(GL_LINEAR_MIPMAP_NEAREST, GL_LINEAR);
    self->line_sampler_ = ground_sampler(GL_NEAREST, GL_NEAREST);
  }
  glBindTextureUnit(fill_unit, planes_[fill].texture ? planes_[fill].texture.name() : 0);
  glBindSampler(fill_unit, fill_sampler_.name());
  glBindTextureUnit(line_unit, planes_[line].texture ? planes_[line].texture.name() : 0);
  glBindSampler(line_unit, line_sampler_.name());
}

}  // namespace terrella
