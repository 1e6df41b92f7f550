#include "render/surface/ground_textures.h"

#include <algorithm>
#include <utility>

#include "render/gl/storage.h"

namespace terrella {
namespace {

constexpr int kFirstGroundSlots = 8;
constexpr int kSide_px = GroundPicture::kSide_px;

constexpr std::size_t slot_bytes(int plane) {
  if (plane == 1) return std::size_t{8} * kSide_px * kSide_px;
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
  glTextureStorage3D(array.name(), mips_of(plane), plane == fill ? GL_RGBA8 : GL_RG32UI, kSide_px, kSide_px, slots);
  return gl::has_storage(array) ? std::move(array) : gl::Texture();
}

std::size_t GroundTextures::bytes() const {
  return static_cast<std::size_t>(planes_[fill].slots) * slot_bytes(fill) +
         static_cast<std::size_t>(planes_[line].slots) * slot_bytes(line);
}

// Each of the planes has a part of every picture until one is seen.
int GroundTextures::capacity() const {
  std::size_t picture_bytes = 0;
  for (const int plane : {fill, line}) {
    picture_bytes += static_cast<std::size_t>(planes_[static_cast<std::size_t>(plane)].parts) * slot_bytes(plane);
  }
  if (picture_bytes == 0) picture_bytes = slot_bytes(fill) + slot_bytes(line);
  const std::size_t all = std::max<std::size_t>(1, budget_bytes_ / picture_bytes);
  return static_cast<int>(std::min(all, static_cast<std::size_t>(most_pictures_)));
}

bool GroundTextures::keep_within_budget() {
  if (planes_[fill].slots <= most_slots(fill) && planes_[line].slots <= most_slots(line)) return true;
  for (Plane& plane : planes_) {
    const int parts = plane.parts;
    plane = {};
    plane.parts = parts;
  }
  return false;
}

bool GroundTextures::set_budget(std::size_t bytes) {
  budget_bytes_ = bytes;
  most_pictures_ = kMostGroundSlots;
  return keep_within_budget();
}

bool GroundTextures::admit(const GroundPicture& picture) {
  const auto sheets = std::ranges::count_if(picture.lines, [](const LineSheet& sheet) { return !sheet.empty(); });
  planes_[fill].parts = std::max(planes_[fill].parts, picture.fill.empty() ? 0 : 1);
  planes_[line].parts = std::max(planes_[line].parts, static_cast<int>(sheets));
  return keep_within_budget();
}

// Takes half as many slots as there were.
bool GroundTextures::grow(int plane) {
  Plane& at = planes_[static_cast<std::size_t>(plane)];
  const int more =
      std::min(std::min(most_slots(plane), kMostGroundSlots) - at.slots, std::max(kFirstGroundSlots, at.slots / 2));
  if (more <= 0) return false;
  gl::Texture larger = make(plane, at.slots + more);
  if (!larger) {
    most_pictures_ = at.slots / at.parts;
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

bool GroundTextures::provide(int plane, bool wanted, int& slot) {
  if (wanted) return take(plane, slot);
  give_back(plane, slot);
  return true;
}

bool GroundTextures::put(const GroundPicture& picture, GroundSlots& slots) {
  if (!provide(fill, !picture.fill.empty(), slots.fill)) return false;
  for (std::size_t k = 0; k < picture.lines.size(); ++k) {
    if (!provide(line, !picture.lines[k].empty(), slots.lines[k])) return false;
  }
  const std::uint32_t* from = picture.fill.data();
  for (int k = 0; k < GroundPicture::kMips && !picture.fill.empty(); ++k) {
    const int side = kSide_px >> k;
    glTextureSubImage3D(planes_[fill].texture.name(), k, 0, 0, slots.fill, side, side, 1, GL_RGBA, GL_UNSIGNED_BYTE,
                        from);
    from += side * side;
  }
  for (std::size_t k = 0; k < picture.lines.size(); ++k) {
    if (picture.lines[k].empty()) continue;
    glTextureSubImage3D(planes_[line].texture.name(), 0, 0, 0, slots.lines[k], kSide_px, kSide_px, 1, GL_RG_INTEGER,
                        GL_UNSIGNED_INT, picture.lines[k].data());
  }
  return true;
}

void GroundTextures::release(GroundSlots& slots) {
  give_back(fill, slots.fill);
  for (int& slot : slots.lines) give_back(line, slot);
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
