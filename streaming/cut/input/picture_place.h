#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "geo/body.h"
#include "streaming/cut.h"
#include "streaming/cut/input/row_reader.h"
#include "streaming/georeference/placement.h"

namespace terrella {

/// Ways in which a picture comes onto the grid.
enum class PlaceKind {
  planet,    ///< no place is stated: a whole planet from -180°
  nodes,     ///< heights at the nodes of a whole planet
  as_it_is,  ///< the picture's pixels are the grid's
  rolled,    ///< the picture's pixels are the grid's after rolling its columns
  warped     ///< the picture is resampled
};

/// Place of a picture in its grid.
struct PicturePlace {
  PlaceKind kind = PlaceKind::planet;
  std::optional<GeoRect> bounds{};  ///< area on the grid; none: the whole planet, or `warped`
  LatitudeKind latitude = LatitudeKind::graphic;
  std::int64_t first_column = 0;   ///< rolled: column of the grid of the picture's first column
  std::int64_t turn_px = 0;        ///< rolled: columns of 360°
  std::optional<CrsPlace> from{};  ///< warped: place in the picture's own system
  PlacedPicture placed{};
};

/// Finds the place by the options' words and the picture's statement. The error names the picture, what is wrong, and
/// what to do. thread: any
[[nodiscard]] Result<PicturePlace> find_place(const CutOptions& options, const PictureFile& picture);

/// The same for pictures joined into one of the given size, with the place stated by the parts.
[[nodiscard]] Result<PicturePlace> find_joined_place(const CutOptions& options, const PictureFile& joined,
                                                     std::optional<Placement> stated);

/// True if a picture crosses ±180° and no grid of the options' tiles keeps both its sides apart.
[[nodiscard]] bool meets_itself(const CutOptions& options, const PictureInfo& picture, const GeoRect& bounds);

/// The body that the options name; the Earth if they name none.
[[nodiscard]] Result<Body> body_of(const CutOptions& options);

/// All longitudes of the same latitudes.
[[nodiscard]] GeoRect all_round(const GeoRect& bounds);

/// Text that differs if the place does, for the key of a cut.
[[nodiscard]] std::string place_text(const PicturePlace& place);

/// Words of the options about the place.
[[nodiscard]] PlaceWords words_of(const CutOptions& options);

/// Reads the size of a picture from its head. thread: any
[[nodiscard]] Result<PictureFile> measure_picture(const std::filesystem::path& picture);

/// The first picture of a cut: as it was opened before, else measured. thread: any
[[nodiscard]] Result<PictureFile> picture_of(const CutOptions& options);

/// Sets the body to the one that the first picture states, for a cut without one by its user. thread: any
void set_stated_body(CutOptions& options);

}  // namespace terrella
