#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "objects/label_layout.h"
#include "view/ground.h"

namespace terrella {

/// A name of a place or of an area.
struct MapName {
  std::string text;       ///< UTF-8
  Geodetic place;         ///< its height does not count
  double rank = 0.0;      ///< > 0; the higher rank gets the room
  double widest_m = 0.0;  ///< shown where a pixel covers at most this many metres, at 96 dots per inch
  bool is_area = false;   ///< the text is centred; else it stands beside a dot
  ObjectColor color{255, 255, 255};
  LabelLook look = {};  ///< at 96 dots per inch
};

/// A name in a picture, pixels.
struct ShownName {
  std::size_t name = 0;  ///< index in names()
  glm::dvec2 place_px{0.0};
  glm::dvec2 text_px{0.0};  ///< upper left corner of the text, from `place_px`
};

/// Texts and other boxes of a picture, as labels are placed around them.
struct LabelPage {
  bool moves = false;                                      ///< the camera is in motion
  double scale = 1.0;                                      ///< pixels of a unit at 96 dots per inch
  std::function<glm::dvec2(const MapName&)> size_px = {};  ///< measures a text; 0: a name that cannot be written
  std::vector<LabelBox> taken = {};                        ///< boxes that stay free of names
};

/// Chooses the names of a map that a picture shows: the highest ranks first, without overlaps. A name of the last
/// picture counts a little more, and a name that vanished stays away for a while. So names do not flicker while the
/// camera moves. thread: that of the ground, one call at a time
class MapLabels {
 public:
  MapLabels(std::vector<MapName> names, const Ellipsoid& ellipsoid);

  [[nodiscard]] const std::vector<MapName>& names() const { return names_; }
  /// Returns the names of a picture, the highest rank first. A name faces the eye, and lies wholly in the picture and
  /// over the planet.
  [[nodiscard]] std::vector<ShownName> place(const View& view, const Ground& ground, const LabelPage& page);
  /// Calls place() in `draw` for a picture of its own: names of earlier pictures count no more than others, and the
  /// next picture after it follows the one before it.
  void apart(const std::function<void()>& draw);
  /// Forgets the names of the last place(), so that the same picture can be placed again.
  void take_back();
  /// Returns the pixel of a name's place on the ground; nothing if it is behind the eye.
  [[nodiscard]] std::optional<glm::dvec2> place_px(std::size_t name, const View& view, const Ground& ground) const;

 private:
  enum class Side : std::uint8_t { hidden, middle, right, left };
  struct Candidate {
    std::size_t name;
    double rank;
    glm::dvec2 px;
  };
  [[nodiscard]] std::vector<Candidate> candidates(const View& view, const Ground& ground, double scale) const;
  [[nodiscard]] std::vector<Side> sides(std::size_t name) const;

  Ellipsoid ellipsoid_;
  std::vector<MapName> names_;
  std::vector<EcefDir> normals_;                                    ///< per name
  std::vector<Ecef> places_;                                        ///< per name, on the ellipsoid
  std::pair<std::vector<Side>, std::vector<std::uint8_t>> before_;  ///< shown_ and wait_ before the last place()
  std::vector<Side> shown_;                                         ///< per name, in the last picture
  std::vector<std::uint8_t> wait_;  ///< per name: pictures of a moving camera without a name that vanished
};

}  // namespace terrella
