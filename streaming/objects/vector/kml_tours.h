#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "base/utc_time.h"
#include "streaming/objects/vector/kml_file.h"

namespace terrella {

/// Most steps of all tours of a KML file.
inline constexpr std::size_t kMostTourViews = 100'000;

/// A Camera or LookAt of KML. Angles are in degrees; heights count from the ellipsoid.
struct KmlView {
  double lon_deg = 0.0, lat_deg = 0.0;  ///< place of the eye, or of the point that it looks at
  double height_m = 0.0;                ///< the same point's
  double heading_deg = 0.0;
  double tilt_deg = 0.0;             ///< 0 looks straight down, 90 to the horizon
  std::optional<double> range_m{};   ///< from the eye to the point of a LookAt; none: a Camera
  std::optional<UtcTime> instant{};  ///< gx:TimeStamp or TimeStamp
};

/// A view of a tour and when the tour is there.
struct TourView {
  KmlView view;
  double time_s = 0.0;  ///< from the tour's first view on
  bool jumps = false;   ///< the tour goes there at once, not by a way from the view before
};

/// A gx:Tour: gx:FlyTo and gx:Wait of its gx:Playlist.
struct KmlTour {
  std::string name;             ///< may be empty
  std::vector<TourView> views;  ///< one at least, by time
};

struct KmlTours {
  std::vector<KmlTour> tours;           ///< in the order of the document
  std::vector<std::string> complaints;  ///< elements that are left out, each once, at most 16
};

/// Reads the tours of a KML document, in the text of KmlFile::document(). A tour begins at its first view. The error
/// does not name the file. thread: any
[[nodiscard]] Result<KmlTours> read_tours(const std::string& document);

}  // namespace terrella
