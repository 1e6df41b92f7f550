#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/result.h"
#include "streaming/georeference/georeference.h"
#include "streaming/objects/vector/kml_file.h"

namespace terrella {

/// Most GroundOverlay elements of a KML file and of the files that it links to.
inline constexpr std::size_t kMostGroundOverlays = 20'000;

/// The picture of a GroundOverlay element of KML.
struct GroundOverlay {
  std::string picture;  ///< name of the picture's file in the KmlFile
  /// Longitude and latitude, degrees: lower left, lower right, upper right, upper left. Longitudes are continuous, also
  /// over ±180°.
  std::array<CrsPoint, 4> corners{};
  double order = 0.0;  ///< drawOrder: a higher one lies on top
  bool shown = true;   ///< its own visibility and that of the folders around it
};

struct GroundOverlays {
  std::vector<GroundOverlay> pictures;  ///< in the order of the documents
  std::vector<std::string> complaints;  ///< elements that are left out, or drawn otherwise than the file says
  bool all_linked = true;  ///< each link leads to a document that was read and has no features but pictures
};

/// Reads the ground overlays of a KML file, and of the KML files in its folder or in the KMZ file that it links to, so
/// that a super-overlay is all its pictures. Regions do not count. A rotation turns the box round its middle,
/// anticlockwise, in a plane where a degree of longitude is cos(latitude of the middle) degrees of latitude long, as in
/// Google Earth. Pictures on a network are left out with a complaint. The error names the file. Blocks. thread: any
[[nodiscard]] Result<GroundOverlays> read_ground_overlays(const KmlFile& file);

}  // namespace terrella
