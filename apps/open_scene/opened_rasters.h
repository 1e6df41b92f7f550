#pragma once

#include <map>
#include <string>

#include "apps/open_scene/open_remote_tiff.h"
#include "streaming/mosaic/mosaic_facts.h"

namespace terrella {

/// Rasters that were opened in place, by the name that opened them (which may be secret), for facts about them.
struct OpenedRasters {
  std::map<std::string, RemotePicture> remote{};  ///< keeps the connection and the cache of each open
  std::map<std::string, MosaicFacts> many{};
};

}  // namespace terrella
