#include "streaming/objects/icon_shelf.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include "codecs/image.h"

namespace terrella {
namespace {

constexpr std::size_t kShownCharacters = 40;

/// An icon's name in a message.
std::string shown(const std::string& name) {
  return name.size() <= kShownCharacters ? name : name.substr(0, kShownCharacters) + "…";
}

Result<std::vector<std::byte>> decode_uri(const std::string& name) {
  std::vector<unsigned char> bytes;
  std::string type;
  if (!tinygltf::DecodeDataURI(&bytes, type, name, 0, false)) {
    return Error{"this data: URI cannot be read; write data:image/png;base64, and the picture"};
  }
  const auto all = std::as_bytes(std::span(bytes));
  return std::vector<std::byte>(all.begin(), all.end());
}

}  // namespace

std::shared_ptr<const IconImage> IconShelf::get(const std::string& name, const Complain& complain) {
  const auto complain_of = [&](const std::string& what) {
    complain(fmt::format("the icon {}: {}; a disc is drawn", shown(name), what));
  };
  const auto found = icons_.find(name);
  if (found != icons_.end()) {
    if (!found->second) complain_of("as said, it cannot be drawn");
    return found->second;
  }
  if (icons_.size() >= kMostIcons) {
    complain_of(fmt::format("a file names at most {} icons; divide it", kMostIcons));
    return nullptr;
  }
  auto icon = read(name);
  if (!icon) complain_of(icon.error().message);
  return icons_.emplace(name, icon ? *std::move(icon) : nullptr).first->second;
}

Result<std::shared_ptr<const IconImage>> IconShelf::read(const std::string& name) const {
  const auto bytes = name.starts_with("data:") ? decode_uri(name) : read_file_(name);
  if (!bytes) return bytes.error();
  if (bytes->size() > kMostIconBytes) return Error{fmt::format("it has more than {} bytes", kMostIconBytes)};
  const auto size = picture_size(*bytes);
  if (size && (size->width_px > kMostIconSide_px || size->height_px > kMostIconSide_px)) {
    return Error{fmt::format("{}x{} pixels; scale it down to at most {} a side", size->width_px, size->height_px,
                             kMostIconSide_px)};
  }
  auto picture = decode_image(*bytes);
  if (!picture) return Error{picture.error().message + "; a PNG, JPEG or WebP picture is needed"};
  return std::make_shared<const IconImage>(IconImage{picture->width_px, picture->height_px, std::move(picture->rgba)});
}

}  // namespace terrella
