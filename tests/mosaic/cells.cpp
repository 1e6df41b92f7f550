#include "tests/mosaic/cells.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <future>

#include "streaming/mosaic/sheet_tiles.h"

namespace terrella::test {
namespace {

template <class T>
void put(std::vector<char>& bytes, T value) {
  bytes.insert(bytes.end(), reinterpret_cast<const char*>(&value), reinterpret_cast<const char*>(&value + 1));
}

struct TiffEntry {
  std::uint16_t tag, type;
  std::uint32_t count, value;
};

}  // namespace

void write_cell(const std::filesystem::path& path, const Cell& cell, const std::function<int(int, int)>& value) {
  const auto width = static_cast<std::uint32_t>(cell.width_px), height = static_cast<std::uint32_t>(cell.height_px);
  const std::string metadata =
      "<GDALMetadata><Item name=\"UNITTYPE\" sample=\"0\" role=\"unittype\">" + cell.unit + "</Item></GDALMetadata>";
  const auto text = static_cast<std::uint32_t>(metadata.size() + 1);
  const std::uint32_t count = cell.unit.empty() ? 13 : 14;
  const std::uint32_t scale_at = 8 + 2 + 12 * count + 4, tie_at = scale_at + 24, keys_at = tie_at + 48;
  const std::uint32_t text_at = keys_at + 32, pixels_at = text_at + text;
  std::vector<TiffEntry> entries = {{256, 4, 1, width},     {257, 4, 1, height},      {258, 3, 1, 16},
                                    {259, 3, 1, 1},         {262, 3, 1, 1},           {273, 4, 1, pixels_at},
                                    {277, 3, 1, 1},         {278, 4, 1, height},      {279, 4, 1, width * height * 2},
                                    {339, 3, 1, 2},         {33550, 12, 3, scale_at}, {33922, 12, 6, tie_at},
                                    {34735, 3, 16, keys_at}};
  if (!cell.unit.empty()) entries.push_back({42112, 2, text, text_at});
  std::vector<char> bytes = {'I', 'I', 42, 0, 8, 0, 0, 0};
  put(bytes, static_cast<std::uint16_t>(count));
  for (const TiffEntry& entry : entries) {
    put(bytes, entry.tag);
    put(bytes, entry.type);
    put(bytes, entry.count);
    put(bytes, entry.value);
  }
  put(bytes, std::uint32_t{0});
  for (const double number : {cell.pixel_deg, cell.pixel_deg, 0.0, 0.0, 0.0, 0.0, cell.west_deg, cell.north_deg, 0.0}) {
    put(bytes, number);
  }
  // Geographic, pixel is area, EPSG:4326.
  for (const int key : {1, 1, 0, 3, 1024, 0, 1, 2, 1025, 0, 1, 1, 2048, 0, 1, 4326}) {
    put(bytes, static_cast<std::uint16_t>(key));
  }
  bytes.insert(bytes.end(), metadata.begin(), metadata.end());
  bytes.push_back(0);
  for (int y = 0; y < cell.height_px; ++y) {
    for (int x = 0; x < cell.width_px; ++x) put(bytes, static_cast<std::int16_t>(value(x, y)));
  }
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

std::unique_ptr<MosaicTiles> must_open(const std::filesystem::path& path, const MosaicOptions& options) {
  auto tiles = open_mosaic(path, options);
  EXPECT_TRUE(tiles) << tiles.error().message;
  return tiles ? *std::move(tiles) : nullptr;
}

Block must_read(TileSource& tiles, const TileId& id) {
  auto tile = tiles.read(id);
  if (!tile && tile.error().kind == MissingKind::remote) {
    std::promise<Result<EncodedTile, TileFailure>> made;
    tiles.remote()->fetch(id, 1.0,
                          [&made](Result<EncodedTile, TileFailure> answer) { made.set_value(std::move(answer)); });
    tile = made.get_future().get();
  }
  const int side = tiles.info().grid.tile_px;
  Block none = tiles.info().numbers ? Block(Numbers{side, side, std::vector<float>(side * side, NAN)})
                                    : Block(Image{side, side, std::vector<std::uint8_t>(4 * side * side)});
  if (!tile && (tile.error().kind == MissingKind::blank || tile.error().kind == MissingKind::absent)) return none;
  EXPECT_TRUE(tile) << tile.error().why;
  auto block = tile ? decode_tile(*tile) : Result<Block, TileFailure>(none);
  EXPECT_TRUE(block);
  return block ? *std::move(block) : none;
}

std::vector<TileId> tiles_of(const TileGrid& grid, int level) {
  std::vector<TileId> tiles;
  for (std::int64_t y = 0; y < rows(grid, level); ++y) {
    for (std::int64_t x = 0; x < columns(grid, level); ++x) {
      if (exists(grid, {.level = level, .x = x, .y = y})) tiles.push_back({.level = level, .x = x, .y = y});
    }
  }
  return tiles;
}

BlockDifference difference(const Block& a, const Block& b) {
  BlockDifference all;
  if (const auto* const numbers = std::get_if<Numbers>(&a)) {
    const auto& other = std::get<Numbers>(b).values;
    for (std::size_t i = 0; i < other.size(); ++i) {
      const float x = numbers->values[i], y = other[i];
      if (std::isnan(x) || std::isnan(y)) {
        all.one_only += std::isnan(x) != std::isnan(y) ? 1 : 0;
        continue;
      }
      ++all.shared;
      all.largest = std::max(all.largest, std::abs(static_cast<double>(x) - static_cast<double>(y)));
    }
    return all;
  }
  const auto& one = std::get<Image>(a).rgba;
  const auto& two = std::get<Image>(b).rgba;
  for (std::size_t i = 0; i < one.size(); i += 4) {
    if (one[i + 3] == 0 || two[i + 3] == 0) {
      all.one_only += one[i + 3] != two[i + 3] ? 1 : 0;
      continue;
    }
    ++all.shared;
    for (std::size_t c = 0; c < 4; ++c) {
      all.largest = std::max(all.largest, std::abs(static_cast<double>(one[i + c]) - two[i + c]));
    }
  }
  return all;
}

}  // namespace terrella::test
