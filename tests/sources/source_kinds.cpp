#include "tests/sources/source_kinds.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

#include "picture_files.h"
#include "raster_files.h"
#include "streaming/cut/growing/growing_cut.h"
#include "streaming/remote/remote_source.h"
#include "streaming/remote_tiff/remote_tiff.h"
#include "streaming/warp/warp_source.h"
#include "streaming/warp/web_mercator.h"
#include "tests/mosaic/cells.h"

namespace terrella::test {
namespace {

constexpr int kSourceTilePx = 32;

template <class T>
std::shared_ptr<TileSource> must(Result<T> opened) {
  EXPECT_TRUE(opened) << (opened ? "" : opened.error().message);
  return opened ? std::shared_ptr<TileSource>(*std::move(opened)) : nullptr;
}

}  // namespace

std::vector<std::string> SourceFiles::kinds() {
  return {"GrowingCut", "MosaicOverview", "RemoteSet", "WarpOfARemoteSet", "WarpOfARemoteTiff"};
}

SourceFiles::SourceFiles() {
  write_png(folder_ / "in.png", noise(512, 256));
  write_png(served_ / "tile.png", noise(kSourceTilePx, kSourceTilePx));
  std::filesystem::create_directory(folder_ / "cells");
  // A few more than a tile is made of directly: each is opened in each of a hundred rounds, also by the thread
  // sanitizer.
  for (int cell = 0; cell < 16; ++cell) {
    write_cell(folder_ / fmt::format("cells/cell-{:02}.tif", cell),
               {.west_deg = 10.0 + cell % 4, .north_deg = 50.0 - cell / 4}, [](int x, int y) { return x + y; });
  }
  write_raw(folder_ / "in.raw", "Byte", 400, 200, 3,
            [](int x, int y, int band) { return 250.0 * noise_at(x, y, band); });
  EXPECT_TRUE(translate("-of COG -co BLOCKSIZE=64", folder_ / "in.raw", served_ / "a.tif"));
}

std::shared_ptr<TileSource> SourceFiles::open(const std::string& kind) {
  ++opened_;
  if (kind == "GrowingCut") return open_growing_cut();
  if (kind == "MosaicOverview") return open_mosaic_overview();
  if (kind == "RemoteSet") return open_remote_set(Projection::equirectangular);
  if (kind == "WarpOfARemoteSet") return open_remote_set(Projection::web_mercator);
  return open_remote_tiff();
}

std::shared_ptr<TileSource> SourceFiles::open_growing_cut() {
  const auto to = folder_ / fmt::format("cut-{}", opened_);
  std::filesystem::create_directory(to);
  auto cut = GrowingCut::start({.images = {folder_ / "in.png"}, .tile_px = kSourceTilePx, .name = "in"}, to);
  return must(std::move(cut));
}

std::shared_ptr<TileSource> SourceFiles::open_mosaic_overview() {
  return must(open_mosaic(folder_ / "cells", {.tile_px = kSourceTilePx}));
}

std::shared_ptr<TileSource> SourceFiles::open_remote_set(Projection projection) {
  RemoteTileSet set;
  set.info.grid = {.root_span_deg = 360.0, .tile_px = kSourceTilePx, .max_level = 4, .projection = projection};
  set.info.format = ImageFormat::png;
  set.url = served_.url("tile.png?{z}/{x}/{y}");
  return must(as_geodetic(make_remote_source(std::move(set), nullptr, quick_options()), "the remote set"));
}

std::shared_ptr<TileSource> SourceFiles::open_remote_tiff() {
  const auto file = RemoteFile::open({.url = served_.url("a.tif"), .http = quick_options()});
  EXPECT_TRUE(file) << file.error().message;
  if (!file) return nullptr;
  auto pyramid = open_remote_raster(**file);
  EXPECT_TRUE(pyramid) << pyramid.error().message;
  if (!pyramid) return nullptr;
  auto raster = RemoteTiff::make(*file, *std::move(pyramid), some_place(), {});
  EXPECT_TRUE(raster) << raster.error().message;
  if (!raster) return nullptr;
  const WarpOptions options{.figure = {.ellipsoid = Ellipsoid(6378137.0, 0.0)}, .tile_px = kSourceTilePx};
  return must(warp_source(*std::move(raster), options, "a.tif"));
}

}  // namespace terrella::test
