#include "render/objects/icon_atlas.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "render/gl/storage.h"

namespace terrella {
namespace {

using Icons = std::vector<std::shared_ptr<const IconImage>>;
using Place = std::array<std::uint16_t, 4>;  // left, top, width, height

struct Layout {
  int rim_px;  ///< around each icon; a power of two, of which all cells are multiples
  int width_px = 0, height_px = 0;
  std::vector<Place> places;
};

int longest_side_px(const Icons& icons) {
  int side = 1;
  for (const auto& icon : icons) side = std::max({side, icon->width_px, icon->height_px});
  return side;
}

/// Puts the icons on shelves, the highest first.
Layout pack(const Icons& icons) {
  const auto rim =
      std::bit_floor(static_cast<unsigned>(std::max(1, longest_side_px(icons) / IconAtlas::kLeastSide_px)));
  Layout layout{.rim_px = static_cast<int>(rim), .places = std::vector<Place>(icons.size())};
  const auto cell = [rim = layout.rim_px](int side) { return (side + 3 * rim - 1) / rim * rim; };
  double area = 0.0;
  for (const auto& icon : icons) area += double(cell(icon->width_px)) * cell(icon->height_px);
  const int widest = cell(longest_side_px(icons));
  layout.width_px = static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::max(double(widest), std::sqrt(area)))));
  std::vector<std::size_t> order(icons.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::stable_sort(
      order, [&icons](std::size_t a, std::size_t b) { return icons[a]->height_px > icons[b]->height_px; });
  int x = 0, y = 0, next_y = 0;
  for (const std::size_t k : order) {
    const IconImage& icon = *icons[k];
    if (x + cell(icon.width_px) > layout.width_px) x = 0, y = next_y;
    layout.places[k] = {static_cast<std::uint16_t>(x + layout.rim_px), static_cast<std::uint16_t>(y + layout.rim_px),
                        static_cast<std::uint16_t>(icon.width_px), static_cast<std::uint16_t>(icon.height_px)};
    x += cell(icon.width_px);
    next_y = std::max(next_y, y + cell(icon.height_px));
  }
  layout.height_px = next_y;
  return layout;
}

/// Writes an icon and its rim: premultiplied.
void put(const IconImage& icon, const Place& place, const Layout& layout, std::vector<std::uint8_t>& texels) {
  const int rim = layout.rim_px;
  for (int y = -rim; y < icon.height_px + rim; ++y) {
    for (int x = -rim; x < icon.width_px + rim; ++x) {
      const int from_x = std::clamp(x, 0, icon.width_px - 1), from_y = std::clamp(y, 0, icon.height_px - 1);
      const std::uint8_t* from =
          &icon.rgba[4 * (static_cast<std::size_t>(from_y) * static_cast<std::size_t>(icon.width_px) +
                          static_cast<std::size_t>(from_x))];
      std::uint8_t* to =
          &texels[4 * (static_cast<std::size_t>(place[1] + y) * static_cast<std::size_t>(layout.width_px) +
                       static_cast<std::size_t>(place[0] + x))];
      for (int k = 0; k < 3; ++k) to[k] = static_cast<std::uint8_t>((from[k] * from[3] + 127) / 255);
      to[3] = from[3];
    }
  }
}

gl::Texture texture_of(GLenum format, GLsizei levels, int width_px, int height_px) {
  gl::Texture texture = gl::make_texture(GL_TEXTURE_2D);
  glTextureStorage2D(texture.name(), levels, format, width_px, height_px);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  return texture;
}

}  // namespace

bool IconAtlas::follow(const Icons& icons) {
  if (icons == icons_) return true;
  icons_ = icons;
  if (icons.empty()) return true;
  const Layout layout = pack(icons);
  std::vector<std::uint8_t> texels(4 * static_cast<std::size_t>(layout.width_px) *
                                   static_cast<std::size_t>(layout.height_px));
  for (std::size_t k = 0; k < icons.size(); ++k) put(*icons[k], layout.places[k], layout, texels);
  const int levels = std::bit_width(static_cast<unsigned>(layout.rim_px));
  texture_ = texture_of(GL_RGBA8, levels, layout.width_px, layout.height_px);
  if (!gl::has_storage(texture_)) {
    icons_.clear();
    return false;
  }
  glTextureSubImage2D(texture_.name(), 0, 0, 0, layout.width_px, layout.height_px, GL_RGBA, GL_UNSIGNED_BYTE,
                      texels.data());
  glGenerateTextureMipmap(texture_.name());
  glTextureParameteri(texture_.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  const auto count = static_cast<GLsizei>(icons.size());
  places_ = texture_of(GL_RGBA16UI, 1, count, 1);
  glTextureSubImage2D(places_.name(), 0, 0, 0, count, 1, GL_RGBA_INTEGER, GL_UNSIGNED_SHORT, layout.places.data());
  glTextureParameteri(places_.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(places_.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return true;
}

}  // namespace terrella
