#include "picture_files.h"

#include <gtest/gtest.h>
#include <png.h>
#include <turbojpeg.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <memory>
#include <random>

#include "streaming/cut/input/row_reader.h"

namespace terrella::test {

namespace fs = std::filesystem;

Image painted(int width_px, int height_px, const std::function<int(int, int, int)>& value) {
  Image image{.width_px = width_px, .height_px = height_px, .rgba = {}};
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) {
      for (int c = 0; c < 4; ++c) image.rgba.push_back(static_cast<std::uint8_t>(value(x, y, c)));
    }
  }
  return image;
}

Image noise(int width_px, int height_px, bool with_alpha) {
  std::mt19937 random(20090);
  return painted(width_px, height_px,
                 [&](int, int, int c) { return c == 3 && !with_alpha ? 255 : static_cast<int>(random() & 255U); });
}

void write_bytes(const fs::path& path, std::span<const std::byte> bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

std::vector<std::byte> read_bytes(const fs::path& path) {
  std::vector<std::byte> bytes(fs::file_size(path));
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  return bytes;
}

void write_png(const fs::path& path, const Image& image) { write_bytes(path, *encode_png(image)); }

namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

/// `bytes`: rows of RGBA samples of that depth, big-endian.
void write_png_rows(const fs::path& path, const Image& image, int depth, int interlace,
                    std::vector<std::uint8_t> bytes) {
  const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "wb"));
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, file.get());
  png_set_IHDR(png, info, static_cast<png_uint_32>(image.width_px), static_cast<png_uint_32>(image.height_px), depth,
               PNG_COLOR_TYPE_RGBA, interlace, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  std::vector<png_bytep> rows;
  const std::size_t row_bytes = bytes.size() / static_cast<std::size_t>(image.height_px);
  for (int y = 0; y < image.height_px; ++y) rows.push_back(bytes.data() + static_cast<std::size_t>(y) * row_bytes);
  png_set_rows(png, info, rows.data());
  png_write_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
  png_destroy_write_struct(&png, &info);
}

}  // namespace

void write_interlaced_png(const fs::path& path, const Image& image) {
  write_png_rows(path, image, 8, PNG_INTERLACE_ADAM7, image.rgba);
}

void write_deep_png(const fs::path& path, const Image& image) {
  std::vector<std::uint8_t> deep;
  for (const std::uint8_t value : image.rgba) deep.insert(deep.end(), 2, value);
  write_png_rows(path, image, 16, PNG_INTERLACE_NONE, deep);
}

void write_jpeg(const fs::path& path, const Image& image, bool progressive) {
  tjhandle handle = tjInitCompress();
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  tjCompress2(handle, image.rgba.data(), image.width_px, 0, image.height_px, TJPF_RGBX, &bytes, &size, TJSAMP_420, 90,
              progressive ? TJFLAG_PROGRESSIVE : 0);
  write_bytes(path, std::as_bytes(std::span(bytes, size)));
  tjFree(bytes);
  tjDestroy(handle);
}

Result<Image> read_all_rows(const fs::path& path) {
  auto reader = open_rows(path);
  if (!reader) return reader.error();
  const PictureInfo& info = (*reader)->info();
  Image image{.width_px = static_cast<int>(info.width_px), .height_px = static_cast<int>(info.height_px), .rgba = {}};
  const auto row_bytes = static_cast<std::size_t>(info.width_px) * 4;
  std::vector<std::uint8_t> row(row_bytes);
  for (std::int64_t y = 0; y < info.height_px; ++y) {
    if (Status read = (*reader)->read_row(row); !read) return read.error();
    image.rgba.insert(image.rgba.end(), row.begin(), row.end());
  }
  return image;
}

Image read_tile(TileSource& source, const TileId& id) {
  const auto bytes = source.read(id);
  if (!bytes) {
    ADD_FAILURE() << "tile " << id.level << "/" << id.x << "/" << id.y << ": " << bytes.error().why;
    return {};
  }
  auto image = decode_image(bytes->bytes);
  if (!image) {
    ADD_FAILURE() << image.error().message;
    return {};
  }
  return *std::move(image);
}

Image read_level(TileSource& source, int level) {
  const TileGrid& grid = source.info().grid;
  const auto across = columns(grid, level);
  const auto down = rows(grid, level);
  const int side = grid.tile_px;
  Image whole{.width_px = static_cast<int>(across) * side, .height_px = static_cast<int>(down) * side, .rgba = {}};
  whole.rgba.resize(static_cast<std::size_t>(whole.width_px) * static_cast<std::size_t>(whole.height_px) * 4);
  for (std::int64_t y = 0; y < down; ++y) {
    for (std::int64_t x = 0; x < across; ++x) {
      if (!exists(grid, {level, x, y})) continue;
      const Image tile = read_tile(source, {level, x, y});
      if (tile.rgba.empty()) continue;
      for (int row = 0; row < side; ++row) {
        const auto at = static_cast<std::size_t>((y * side + row) * whole.width_px + x * side) * 4;
        std::memcpy(whole.rgba.data() + at, tile.rgba.data() + static_cast<std::size_t>(row * side) * 4,
                    static_cast<std::size_t>(side) * 4);
      }
    }
  }
  return whole;
}

}  // namespace terrella::test
