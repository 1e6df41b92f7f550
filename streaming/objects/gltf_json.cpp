#include "streaming/objects/gltf_json.h"

#include <fmt/format.h>

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string_view>

#include "streaming/json_text.h"
#include "streaming/objects/gltf_model.h"

namespace terrella {
namespace {

using nlohmann::json;

constexpr std::size_t kMostGltfPieces = 4'000'000;

/// Text of a binary file's first chunk.
Result<std::string_view> first_chunk(std::string_view file) {
  constexpr std::size_t kHeader = 20, kLengthAt = 12, kChunkHeader = 8;
  const auto length_at = [file](std::size_t offset) {
    std::uint32_t length = 0;
    std::memcpy(&length, file.data() + offset, sizeof length);
    return std::size_t(length);
  };
  if (file.size() < kHeader) return Error{"a binary glTF file of fewer than 20 bytes"};
  const std::size_t length = length_at(kLengthAt);
  if (length > file.size() - kHeader) return Error{"a binary glTF file that breaks off in its JSON"};
  const std::size_t next = kHeader + length;
  if (file.size() - next >= kChunkHeader && length_at(next) > file.size() - next - kChunkHeader) {
    return Error{"a binary glTF file that breaks off in its buffer"};
  }
  return file.substr(kHeader, length);
}

}  // namespace

Result<json> gltf_json(std::span<const std::byte> bytes) {
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.starts_with("glTF")) {
    const auto chunk = first_chunk(text);
    if (!chunk) return chunk.error();
    text = *chunk;
  }
  Result<json> document = parse_json(text, {.depth = kJsonLimits.depth, .pieces = kMostGltfPieces});
  if (!document) return Error{document.error().message + "; a .gltf or .glb file is needed"};
  if (!document->is_object() || !document->contains("asset")) return Error{"JSON, but no glTF: it has no \"asset\""};
  const auto nodes = document->find("nodes");
  if (nodes != document->end() && nodes->size() > kMaxModelNodes) {
    return Error{
        fmt::format("it has {} nodes, more than the {} that are read; divide it", nodes->size(), kMaxModelNodes)};
  }
  return document;
}

}  // namespace terrella
