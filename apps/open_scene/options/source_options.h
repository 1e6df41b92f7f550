#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/open_scene/options/number_options.h"
#include "geo/body.h"
#include "streaming/georeference/georeference.h"
#include "streaming/remote/remote_options.h"
#include "streaming/url.h"
#include "tiles/tile_grid.h"

namespace terrella {

class GrowingCut;
struct OpenedRasters;

/// One source of tiles, what the user says about it, and how it is opened; the parse has checked every value.
struct SourceOptions {
  Url address{};                           ///< file, folder or address; empty: the included Earth
  std::optional<Body> body{};              ///< the globe's; absent: the source's
  bool other_body = false;                 ///< tiles of another body than the globe's are taken too
  std::optional<Projection> projection{};  ///< absent: as the source states
  std::optional<LatitudeKind> latitude{};  ///< absent: as the source states
  PlaceWords place{};                      ///< place of a picture
  NumberOptions numbers{};
  RemoteOptions remote{};            ///< options of a source on a server
  std::string cache{};               ///< value of --cache; empty: the default file; "off": none
  std::size_t cache_size_mb = 4096;  ///< limit of the cache's file, in 10^6 bytes
  double timeout_s = 600.0;  ///< longest wait for the description of a remote input, and for the tiles of a picture
  bool offline = false;      ///< use the cache only
  /// Receives the cuts that go on in the background; null: a picture is cut before it shows.
  std::vector<std::shared_ptr<GrowingCut>>* cuts = nullptr;
  OpenedRasters* opened = nullptr;  ///< receives rasters that are read in place; may be null
};

/// Options for another source of the scene than TILESET. The statements about TILESET and the options of its server do
/// not apply. A cache holds the tiles of one source, so the other source's cache is the default one. thread: any
[[nodiscard]] inline SourceOptions options_beside(const SourceOptions& options, const Url& address) {
  SourceOptions other;
  other.address = address;
  other.body = options.body;
  if (options.cache == "off") other.cache = options.cache;
  other.cache_size_mb = options.cache_size_mb;
  other.timeout_s = options.timeout_s;
  other.offline = options.offline;
  other.cuts = options.cuts;
  other.opened = options.opened;
  return other;
}

/// `how` a source is opened, with what is said about another source. thread: any
[[nodiscard]] inline SourceOptions with_words(SourceOptions how, const SourceOptions& said) {
  how.address = said.address;
  how.other_body = said.other_body;
  how.projection = said.projection;
  how.latitude = said.latitude;
  how.place = said.place;
  how.numbers = said.numbers;
  how.remote = said.remote;
  return how;
}

}  // namespace terrella
