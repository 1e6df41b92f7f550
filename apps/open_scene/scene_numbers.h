#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/open_scene/options/source_options.h"
#include "base/result.h"
#include "globe/globe.h"
#include "streaming/numbers/number_statistics.h"
#include "streaming/numbers/stretch_rule.h"
#include "tiles/tile_source.h"
#include "view/number_look.h"

namespace terrella {

/// Facts about a layer of numbers for legends and panels, beside its look.
struct NumberFacts {
  std::string colormap;                        ///< as --colormap states it
  std::string unit, quantity;                  ///< empty: unknown
  std::vector<std::string> lines;              ///< facts for a person: no data, system, bounds, pixels
  std::optional<NumberStatistics> statistics;  ///< none if they were not needed, or could not be had
};

/// An opened tile set and the look with which it becomes a layer.
struct ImageryLayer {
  std::shared_ptr<TileSource> tiles;
  ImageLook look;                      ///< with ImageLook::numbers if the tiles are numbers
  std::optional<NumberFacts> numbers;  ///< set if the tiles are numbers
};

/// Fails if the text names neither a map of the engine nor a file. thread: any
[[nodiscard]] Status check_colormap(const std::string& text);

/// The colours of --colormap. `statistics` give percentages of a file their values. Stops by value replace the stretch
/// unless `stretched`. The error names the file. thread: any
[[nodiscard]] Result<NumberLook> look_of(const std::string& colormap, const Stretch& stretch, bool stretched,
                                         const NumberStatistics& statistics);

/// Opens TILESET as a layer, with pictures or numbers. Numbers get the stretch and the colours of the options, and one
/// line on standard error says which. The error names the input. Throws BrokenInstallation. thread: main
[[nodiscard]] Result<ImageryLayer> open_layer(const SourceOptions& options);

/// Makes the layer of tiles that are open already. `wants_statistics`: for a panel with a histogram. thread: any
[[nodiscard]] Result<ImageryLayer> layer_of(std::shared_ptr<TileSource> tiles, const NumberOptions& options,
                                            const std::string& name, bool wants_statistics);

/// The quantity, or the layer's name if that is unknown. thread: any
[[nodiscard]] std::string legend_title(const std::string& name, const NumberFacts& facts);

/// "viridis from -1.8 to 28.9 °C" thread: any
[[nodiscard]] std::string look_text(const NumberFacts& facts, const NumberLook& look);

}  // namespace terrella
