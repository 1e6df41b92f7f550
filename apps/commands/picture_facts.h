#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/open_scene/open_remote_tiff.h"
#include "base/result.h"
#include "streaming/cut/input/picture_place.h"
#include "streaming/georeference/georeference.h"
#include "streaming/raster/open_raster.h"

namespace terrella {

/// Size of the pixel in the middle of the picture.
struct PixelSize {
  bool of_arc;                   ///< true if the degrees are of arc; false: of longitude and latitude
  double width_deg, height_deg;  ///< pixels of geographic systems: longitude, latitude; of projected ones: arc
  double width_m, height_m;
};

/// Facts about a picture and its place; unknown ones are absent.
struct PictureFacts {
  PictureFile file;
  PlaceWords words;
  std::optional<RasterFacts> raster{};  ///< facts of a TIFF
  int orientation = 1;                  ///< EXIF orientation by which the picture is turned; 1: not turned
  bool is_numbers = false;              ///< shown as numbers, unless options ask for something else
  std::optional<Georeference> said;
  std::optional<CrsFacts> crs;
  std::optional<Affine> transform;
  std::optional<CrsBounds> bounds_deg;
  std::optional<PixelSize> pixel;
  std::optional<PicturePlace> place;
  std::vector<std::string> remarks;
  std::string command;  ///< command that shows the picture
  std::string refused;  ///< reason for a refusal; empty if the picture is accepted
};

/// Looks at a picture and the files beside it, with the user's words about its place. Reads no pixels, except for the
/// statistics of a TIFF's coarsest level. Fails if the file is not a readable picture. thread: any
[[nodiscard]] Result<PictureFacts> look_at(const std::filesystem::path& picture, const PlaceWords& words,
                                           const DescribedBand& band = {});

/// The same for a TIFF on a server. Reads no values if it could not be shown. Waits for the network.
[[nodiscard]] Result<PictureFacts> look_at(const RemotePicture& tiff, const PlaceWords& words,
                                           const DescribedBand& band = {});

/// Facts without values, and without the command that shows the picture: from the data read when it was opened.
[[nodiscard]] Result<PictureFacts> look_at_place(const RemotePicture& tiff, const PlaceWords& words,
                                                 const DescribedBand& band);

/// Smallest rectangle around the picture in its own system; `transform` is set.
[[nodiscard]] CrsBounds own_bounds(const PictureFacts& facts);

}  // namespace terrella
