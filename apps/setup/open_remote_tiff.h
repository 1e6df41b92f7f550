#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "apps/scene/scene_options.h"
#include "base/result.h"
#include "streaming/cut.h"
#include "streaming/direct/direct_tiles.h"
#include "streaming/http/http_fetcher.h"
#include "streaming/remote_tiff/remote_tiff.h"

namespace terrella {

/// A TIFF on a server, and how it is read.
struct RemoteTiffWish {
  Url url;
  std::vector<std::string> headers{};  ///< may be secret
  HttpOptions http{};
  std::filesystem::path cache{};   ///< file of the cache; empty: none
  bool may_replace_cache = false;  ///< the cache of an earlier version of the TIFF may be deleted
  std::size_t cache_size_mb = 0;   ///< 0: no limit
  bool offline = false;
  DirectOptions direct{};
  bool any_body = false;  ///< the TIFF's own body counts, not that of `direct`
  bool heights = false;   ///< blocks are numbers
};

struct OpenedRemoteTiff {
  std::shared_ptr<RemoteFile> file;
  std::unique_ptr<RemoteTiff> raster;
  PictureFile picture;  ///< its bytes wait for the network
  RasterPlace place;
  std::string body;  ///< preset name or "A,F"; empty: the Earth
};

/// True if the address is that of a TIFF: by its path, or else by the first bytes that the server sends. An address
/// that names another kind of set costs no request. thread: any
[[nodiscard]] bool leads_to_tiff(const Url& url, const std::vector<std::string>& headers, const HttpOptions& http);

/// Opens a TIFF on a server with its cache and finds its place. The error names the address or the cache. Reports a
/// file that changed on the server, and a damaged cache that was set aside. Waits for the network. thread: main
[[nodiscard]] Result<OpenedRemoteTiff> open_remote_tiff(const RemoteTiffWish& wish);

/// Makes tiles of an opened TIFF. Refuses a large picture without overviews, because a coarse tile would need all of
/// it. The error begins with the address. thread: any
[[nodiscard]] Result<std::unique_ptr<TileSource>> tiles_of(OpenedRemoteTiff opened, const DirectOptions& direct);

/// Lets `cut` read a TIFF on a server in place of a file. thread: any
[[nodiscard]] CutRaster cut_raster(OpenedRemoteTiff opened);

/// The user's statements about a raster, from the scene's options. thread: any
[[nodiscard]] DirectOptions direct_options(const SceneOptions& options);

}  // namespace terrella
