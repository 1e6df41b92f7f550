#include "streaming_test_support.h"

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

namespace terrella::test {
namespace {

namespace fs = std::filesystem;

std::uint8_t level(double value) { return static_cast<std::uint8_t>(std::clamp(std::lround(value), 0L, 255L)); }
double red_at(double lon_deg) { return (lon_deg + 180.0) / 360.0 * 255.0; }
double green_at(double lat_deg) { return (90.0 - lat_deg) / 180.0 * 255.0; }

template <class Colour>
Image painted(int width_px, int height_px, const Colour& colour) {
  Image image{width_px, height_px, {}};
  image.rgba.reserve(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px) * 4);
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) {
      for (const double channel : colour(x, y)) image.rgba.push_back(level(channel));
    }
  }
  return image;
}

class Database {
 public:
  explicit Database(const fs::path& path) {
    EXPECT_EQ(sqlite3_open(path.c_str(), &handle_), SQLITE_OK) << path;
    // Files of a test need not outlive a power cut.
    EXPECT_EQ(
        sqlite3_exec(handle_, "PRAGMA synchronous = OFF; PRAGMA journal_mode = MEMORY", nullptr, nullptr, nullptr),
        SQLITE_OK);
  }
  ~Database() { sqlite3_close(handle_); }
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;
  [[nodiscard]] sqlite3* handle() const { return handle_; }

 private:
  sqlite3* handle_ = nullptr;
};

}  // namespace

std::vector<std::byte> bytes_of(std::string_view text) {
  const auto* first = reinterpret_cast<const std::byte*>(text.data());
  return {first, first + text.size()};
}

void write_bytes(const fs::path& path, const std::vector<std::byte>& bytes) {
  fs::create_directories(path.parent_path());
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  ASSERT_TRUE(file.good()) << path;
}

void write_text(const fs::path& path, std::string_view text) { write_bytes(path, bytes_of(text)); }

Image gradient(int width_px, int height_px) {
  return painted(width_px, height_px, [&](int x, int y) {
    return std::array{x * 255.0 / width_px, y * 255.0 / height_px, (x + y) * 127.0 / (width_px + height_px), 255.0};
  });
}

Image place_picture(int width_px) {
  const int height_px = width_px / 2;
  return painted(width_px, height_px, [&](int x, int y) {
    return std::array{red_at((x + 0.5) * 360.0 / width_px - 180.0), green_at(90.0 - (y + 0.5) * 180.0 / height_px),
                      64.0, 255.0};
  });
}

Image place_tile(const TileGrid& grid, const TileId& id) {
  const TileBounds bounds = tile_bounds(grid, id);
  const double pixel_deg = tile_span_deg(grid, id.level) / grid.tile_px;
  return painted(grid.tile_px, grid.tile_px, [&](int x, int y) {
    return std::array{red_at(bounds.west_deg + (x + 0.5) * pixel_deg),
                      green_at(bounds.north_deg - (y + 0.5) * pixel_deg), 64.0, 255.0};
  });
}

double worst_misplacement(const TileGrid& grid, const TileId& id, const Image& tile) {
  const TileBounds bounds = tile_bounds(grid, id);
  const double pixel_deg = tile_span_deg(grid, id.level) / tile.width_px;
  constexpr double kMarginDeg = 5.0;
  double worst = 0.0;
  for (int y = 0; y < tile.height_px; ++y) {
    for (int x = 0; x < tile.width_px; ++x) {
      const double lon = bounds.west_deg + (x + 0.5) * pixel_deg;
      const double lat = bounds.north_deg - (y + 0.5) * pixel_deg;
      if (std::abs(lon) > 180.0 - kMarginDeg || std::abs(lat) > 90.0 - kMarginDeg) continue;
      const std::uint8_t* texel = &tile.rgba[static_cast<std::size_t>(y * tile.width_px + x) * 4];
      worst = std::max({worst, std::abs(texel[0] - red_at(lon)), std::abs(texel[1] - green_at(lat))});
    }
  }
  return worst;
}

Image load_tile(TileSource& source, const TileId& id) {
  const Result<EncodedTile, TileFailure> encoded = source.read(id);
  if (!encoded) {
    ADD_FAILURE() << "tile " << id.level << "/" << id.x << "/" << id.y << ": " << encoded.error().why;
    return {};
  }
  Result<Image> image = decode_image(encoded->bytes);
  if (!image) {
    ADD_FAILURE() << image.error().message;
    return {};
  }
  return *std::move(image);
}

void run_sql(const fs::path& path, const std::string& sql) {
  const Database database(path);
  char* message = nullptr;
  EXPECT_EQ(sqlite3_exec(database.handle(), sql.c_str(), nullptr, nullptr, &message), SQLITE_OK)
      << (message != nullptr ? message : "") << "\n"
      << sql;
  sqlite3_free(message);
}

void insert_tile(const fs::path& path, std::int64_t zoom, std::int64_t column, std::int64_t row,
                 const std::vector<std::byte>& bytes) {
  const Database database(path);
  sqlite3_stmt* statement = nullptr;
  ASSERT_EQ(sqlite3_prepare_v2(database.handle(),
                               "INSERT INTO tiles (zoom_level, tile_column, tile_row, tile_data) VALUES (?, ?, ?, ?)",
                               -1, &statement, nullptr),
            SQLITE_OK);
  sqlite3_bind_int64(statement, 1, zoom);
  sqlite3_bind_int64(statement, 2, column);
  sqlite3_bind_int64(statement, 3, row);
  sqlite3_bind_blob(statement, 4, bytes.data(), static_cast<int>(bytes.size()), SQLITE_STATIC);
  EXPECT_EQ(sqlite3_step(statement), SQLITE_DONE);
  sqlite3_finalize(statement);
}

}  // namespace terrella::test
