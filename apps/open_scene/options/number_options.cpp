#include "apps/open_scene/options/number_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/open_scene/options/option_checks.h"
#include "apps/open_scene/scene_numbers.h"
#include "apps/process/console.h"
#include "base/number.h"

namespace terrella {
namespace {

constexpr int kMostBands = 65535;

Result<std::array<int, 3>> parse_bands(const std::string& text) {
  std::array<int, 3> bands{};
  const auto pieces = split_at_commas(text);
  bool read = pieces.size() == bands.size();
  for (std::size_t i = 0; read && i < bands.size(); ++i) {
    const auto band = band_number(pieces[i]);
    read = band.has_value();
    bands[i] = band.value_or(0);
  }
  if (read) return bands;
  return Error{fmt::format("{} is not R,G,B; write three bands, counted from 1, as 4,3,2", in_quotes(text))};
}

}  // namespace

std::optional<int> band_number(std::string_view text) {
  const auto number = read_number(text);
  if (!number || *number < 1.0 || *number > kMostBands || *number != std::floor(*number)) return {};
  return static_cast<int>(*number);
}

void add_stretch_options(CLI::App& command, NumberOptions& options) {
  CLI::Option* bands = command.add_option_function<std::string>(
      "--bands", [&options](const std::string& text) { options.bands = parsed_or_throw("--bands", parse_bands(text)); },
      "Show three bands of a TIFF as red, green and blue, counted from 1. Each is stretched when it is read");
  bands->type_name("R,G,B");
  command
      .add_option_function<std::vector<std::string>>(
          "--stretch",
          [&options](const std::vector<std::string>& texts) {
            if (texts.size() != 1 && texts.size() != 3)
              throw CLI::ValidationError("--stretch", "give it once, or with --bands once for each of the three");
            for (const std::string& text : texts)
              options.stretch.push_back(parsed_or_throw("--stretch", parse_stretch(text)));
          },
          "Set the first and the last shown value of a raster of numbers: MIN,MAX, minmax, percentiles, or standard "
          "deviations around the mean. Give it three times for --bands (default: percent:2,98)")
      ->type_name("MIN,MAX|minmax|percent:2,98|sigma:2")
      ->allow_extra_args(false);
}

void add_colormap_option(CLI::App& command, NumberOptions& options) {
  command
      .add_option_function<std::string>(
          "--colormap",
          [&options](const std::string& text) {
            if (const Status known = check_colormap(text); !known)
              throw CLI::ValidationError("--colormap", known.error().message);
            options.colormap = text;
          },
          "Colour a raster of numbers: viridis, magma, cividis, grey, terrain, diverging, or a file in the text form "
          "of gdaldem color-relief. NAME:CENTRE sets the value in the middle of terrain and diverging (default: 0). "
          "Rasters of 16 bits and of floats are coloured anyway, others if this is given (default: viridis)")
      ->type_name("NAME|FILE")
      ->excludes(command.get_option("--bands"));
}

void add_number_options(CLI::App& command, NumberOptions& options, double& pole_band) {
  command
      .add_option_function<std::string>(
          "--band",
          [&options, &pole_band](const std::string& text) {
            if (const auto band = band_number(text)) {
              options.band = *band;
            } else if (const std::string wrong = number_in(0.001, 0.5)(std::string(text)); !wrong.empty()) {
              throw CLI::ValidationError("--band", wrong + ", or a band's number from 1 on");
            } else {
              pole_band = *read_number(text);
            }
          },
          "Show the numbers of this band of a TIFF, counted from 1. With --texturing paper, a fraction from 0.001 to "
          "0.5 is the width b of the pole bands (default: 0.05)")
      ->type_name("N");
  add_stretch_options(command, options);
  add_colormap_option(command, options);
  command.add_option("--nodata", options.nodata, "Set the value that means no data in a raster that does not say it")
      ->check(any_number())
      ->type_name("VALUE");
  command
      .add_option(
          "--contours", options.contours,
          "Draw contour lines at the multiples of this step, one pixel wide, every fifth two (default: 0, none)")
      ->check(number_in(0.0, 1e30))
      ->type_name("STEP");
  CLI::Option* slope = command.add_flag_callback(
      "--slope", [&options] { options.angle = GroundAngle::slope; },
      "Show the slope of heights, in degrees from level ground, as a layer of numbers. Heights of a server are "
      "preloaded first");
  CLI::Option* aspect = command.add_flag_callback(
      "--aspect", [&options] { options.angle = GroundAngle::aspect; },
      "Show the direction that the ground of heights faces, in degrees clockwise from north, as a layer of numbers");
  slope->excludes(aspect)->excludes(command.get_option("--bands"));
  aspect->excludes(command.get_option("--bands"));
  command.add_flag("--lit-numbers", options.lit,
                   "Let Sun, relief and air change the colours of numbers too. Otherwise they are those of the legend");
}

}  // namespace terrella
