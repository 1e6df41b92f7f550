#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "geo/camera.h"
#include "geo/ellipsoid.h"
#include "view/flight.h"

namespace terrella {

/// True if two views are so different that a user would want to return from one to the other: moved by a quarter of the
/// height, 1.3 times as high, turned or tilted by 15°. thread: any
[[nodiscard]] bool is_other_view(const Camera& from, const Camera& to, const Ellipsoid& body);

/// The views at which the camera rested, with a current one, as in a browser. A view enters after a rest of 0.7 s, if
/// it is another view than the current one; a smaller move changes the current view. A new view drops the views after
/// the current one. Times may have any origin. thread: any, but one call at a time
class ViewHistory {
 public:
  explicit ViewHistory(const Ellipsoid& body) : body_(body) {}

  /// Call this once per frame. `at_rest`: the camera stands still and no button is held.
  void follow(const Camera& camera, bool at_rest, Seconds now);
  /// The view before or after the current one, which becomes the current one; nothing at the ends. The view of a camera
  /// at rest enters first, however short the rest.
  [[nodiscard]] std::optional<Camera> back() { return step(-1); }
  [[nodiscard]] std::optional<Camera> forward() { return step(1); }
  [[nodiscard]] std::size_t size() const { return stops_.size(); }

 private:
  struct Stop {
    Camera first;   ///< first view at rest
    Camera latest;  ///< after small moves
  };
  struct Rest {
    Camera camera;
    Seconds since;
  };
  void enter(const Camera& camera);
  [[nodiscard]] std::optional<Camera> step(int by);

  Ellipsoid body_;
  std::vector<Stop> stops_;
  std::size_t current_ = 0;
  std::optional<Rest> rest_;  ///< none while the camera moves
};

}  // namespace terrella
