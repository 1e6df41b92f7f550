#pragma once

#include <optional>
#include <string>

#include "apps/film/film_record.h"
#include "apps/program/scene_picture.h"
#include "streaming/preload/tile_plan.h"

namespace terrella {

/// Options of `terrella render --flight`.
struct FilmCommand {
  RenderCommand render;  ///< `output` is a pattern of file names or a *.mp4
  std::string flight;    ///< GeoJSON or KML, see read_flight()
  double fps = 30.0;
  std::optional<Shard> shard;  ///< frames whose number leaves the rest `index` - 1 when divided by `count`
  bool force = false;          ///< replace frames of another film
  double shutter = 0.0;        ///< part of a frame's time over which it is averaged, [0, 1]
  int moments = 8;             ///< pictures of such an average
  FilmFacts facts;             ///< hashes of the options
};

/// Checks combinations of options; an error means wrong usage.
[[nodiscard]] Status check_together(const FilmCommand& command);

/// Renders the frames that are not there yet, reports as the program does and returns the exit code. One scene is open
/// for all frames. A frame has the bytes of a picture of its own. thread: main
int run_film(const FilmCommand& command);

}  // namespace terrella
