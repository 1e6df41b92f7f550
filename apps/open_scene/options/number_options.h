#pragma once

#include <CLI/App.hpp>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "streaming/numbers/slope_tiles.h"
#include "streaming/numbers/stretch_rule.h"

namespace terrella {

/// Options for reading and colouring the numbers of a raster; the parse has checked every value.
struct NumberOptions {
  std::string colormap{};              ///< name of a map, with ":CENTRE" if it has a middle, or a file; empty: viridis
  std::vector<StretchRule> stretch{};  ///< one, or one for each of `bands`; empty: percent:2,98
  std::optional<double> nodata{};
  int band = 0;                               ///< counted from 1; 0: the only one
  std::optional<std::array<int, 3>> bands{};  ///< shown as red, green and blue, counted from 1
  bool lit = false;                           ///< NumberLook::lit
  double contours = 0.0;                      ///< NumberLook::contour_step
  std::optional<GroundAngle> angle{};         ///< the numbers are heights, and their slope or aspect is shown
  bool heights = false;                       ///< set by --elevation: reads numbers as heights in any case
  bool operator==(const NumberOptions&) const = default;

  /// True if the user wants a raster of any kind read as numbers.
  [[nodiscard]] bool ask_for_numbers() const {
    return !bands && (!colormap.empty() || !stretch.empty() || nodata || band > 0 || angle);
  }
};

/// Adds --bands and --stretch. `options` must outlive the parse, which checks them. thread: main
void add_stretch_options(CLI::App& command, NumberOptions& options);

/// Adds --colormap, after add_stretch_options(). thread: main
void add_colormap_option(CLI::App& command, NumberOptions& options);

/// Adds all of these for a raster that is shown, and --band, --nodata, --lit-numbers, --contours, --slope, --aspect.
/// --band was the width of paper 1's pole bands before it was a band of a raster: a fraction goes to `pole_band`, a
/// whole number is a band. thread: main
void add_number_options(CLI::App& command, NumberOptions& options, double& pole_band);

/// A band's number, a whole number from 1 on. thread: any
[[nodiscard]] std::optional<int> band_number(std::string_view text);

}  // namespace terrella
