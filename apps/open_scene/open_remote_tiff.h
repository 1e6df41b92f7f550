#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "apps/open_scene/options/source_options.h"
#include "base/result.h"
#include "streaming/cut.h"
#include "streaming/http/http_fetcher.h"
#include "streaming/remote_tiff/remote_tiff.h"
#include "streaming/warp/direct_tiles.h"

namespace terrella {

/// A TIFF on a server, and how it is read.
struct RemoteTiffWish {
  SourceOptions source;
  HttpOptions http{};
  std::filesystem::path cache{};                        ///< file of the cache; empty: none
  bool may_replace_cache = false;                       ///< the cache of an earlier version of the TIFF may be deleted
  std::function<void(const Error&)> on_cache_failed{};  ///< see CacheOptions::on_failed
};

/// A TIFF on a server whose directories are read.
struct RemotePicture {
  std::shared_ptr<RemoteFile> file;
  PictureFile picture;  ///< its raster waits for the network
};

struct OpenedRemoteTiff {
  RemotePicture tiff;
  std::unique_ptr<RemoteTiff> raster;
  RasterPlace place;
  std::string body;  ///< preset name or "A,F"; empty: the Earth
};

/// True if the address is that of a TIFF: by its path, or else by the first bytes that the server sends. An address
/// that names another kind of set costs no request. thread: any
[[nodiscard]] bool leads_to_tiff(const Url& url, const std::vector<std::string>& headers, const HttpOptions& http);

/// Opens a TIFF on a server with its cache, and reads its directories. The error names the address or the cache.
/// Reports a file that changed on the server, and a damaged cache that was set aside. Waits for the network. thread:
/// main
[[nodiscard]] Result<RemotePicture> open_remote_picture(const RemoteTiffWish& wish);

/// The same, with its place and a raster that is read as a local one would be: as a picture, as numbers or as heights.
[[nodiscard]] Result<OpenedRemoteTiff> open_remote_tiff(const RemoteTiffWish& wish);

/// Fails for large strips, and for a large picture without overviews, because a coarse tile would need all of it. The
/// error begins with the address. thread: any
[[nodiscard]] Status check_shows_at_once(const RemotePicture& tiff);

/// Makes tiles of an opened TIFF, as check_shows_at_once() allows. thread: any
[[nodiscard]] Result<std::unique_ptr<TileSource>> tiles_of(OpenedRemoteTiff opened, const DirectOptions& direct);

/// Lets `cut` read a TIFF on a server in place of a file. thread: any
void set_raster(CutOptions& cut, const RemotePicture& tiff);

/// The user's statements about a raster. thread: any
[[nodiscard]] DirectOptions direct_options(const SourceOptions& options);

}  // namespace terrella
