#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <variant>
#include <vector>

#include "geo/camera.h"
#include "view/flight.h"
#include "view/ground.h"
#include "view/orbit.h"
#include "view/surface_pin.h"

namespace terrella {

enum class PointerButton { left, right };
enum class NavigationKey { pan_left, pan_right, pan_up, pan_down, zoom_in, zoom_out, north_up, whole_globe };

/// Turns pointer, wheel and key events into a camera.
///
/// Left drag holds the grabbed surface point under the cursor, and a flick glides on and stops; the wheel zooms and
/// keeps the point under the cursor; right drag, or left with Ctrl, tilts (up: towards the horizon) and turns around
/// the point at the picture's centre; a double click flies to a point. A new gesture ends what moved before.
///
/// What is grabbed, zoomed to and turned around is the ground as it is drawn, mountains included, and the eye stays
/// over it: where it would not, it is raised to 1 m over it, at the latest by advance(), and never lowered for it. With
/// set_deepest() it may go under the ground.
///
/// Pure state: times come from the caller, any origin, and only their differences count, each clamped to [0 s, 0.25 s];
/// so a clock that jumps, either way, moves nothing far. Positions are pixels of the viewport, centres at halves, and
/// may lie outside it. Events with a value that is not finite are ignored. thread: any, one at a time
class Navigator {
 public:
  Navigator(const Camera& camera, const Ground& ground, Viewport viewport);

  void set_viewport(Viewport viewport);   ///< sides below 1 count as 1
  void set_camera(const Camera& camera);  ///< stops every motion
  void set_ground(const Ground& ground);  ///< goes on with the motion over another ground
  /// How deep under the ellipsoid the eye may go, a negative height in metres; none: it stays over the ground.
  void set_deepest(std::optional<double> deepest_m) { deepest_m_ = deepest_m; }

  void pointer_down(PointerButton button, bool ctrl, glm::dvec2 at_px, Seconds now);
  void pointer_move(glm::dvec2 at_px, Seconds now);
  /// `late`: how long before `now` this and what was told just before may have happened, after a slow frame for
  /// example. What cannot be told from a rest does not flick, and no flick is faster than all that was told over that
  /// time.
  void pointer_up(PointerButton button, Seconds now, Seconds late = Seconds(0.0));
  void double_click(glm::dvec2 at_px, Seconds now);
  void wheel(glm::dvec2 at_px, double steps, Seconds now);  ///< steps: positive towards the ground
  /// Fingers on a touch pad or screen: the point under `at_px`, between them, stays there and comes nearer by `factor`,
  /// over 1 as they move apart. At once, without a glide; nothing while a button is held.
  void pinch(glm::dvec2 at_px, double factor, Seconds now);
  void key(NavigationKey key, Seconds now);
  /// Flies there over the globe's curve, higher on the way if it is long (view/flight.h). A camera with a value that
  /// is not finite is ignored.
  void fly_to(const Camera& camera, Seconds now);
  /// Lets time pass: flights, glides and zooms go on. Call it once a frame while animating().
  void advance(Seconds now);

  [[nodiscard]] const Camera& camera() const { return camera_; }
  [[nodiscard]] Viewport viewport() const { return viewport_; }
  /// Something moves by itself: frames are needed.
  [[nodiscard]] bool animating() const;
  /// Nothing moves and no button is held.
  [[nodiscard]] bool at_rest() const { return std::holds_alternative<Rest>(motion_); }

 private:
  struct Rest {};
  struct Sample {
    glm::dvec2 at_px;
    Seconds when;
  };
  struct Drag {
    Camera start;
    Ecef held;
    HeadingRule rule;
    glm::dvec2 from_px;
    std::vector<Sample> trail;  ///< where the pointer was in the last moments; never empty
  };
  struct Turn {
    std::optional<Orbit> orbit;  ///< none where the picture's centre shows the sky: the eye turns in its place
    Camera start;
    glm::dvec2 from_px;
  };
  struct Glide {
    glm::dvec2 at_px;
    glm::dvec2 speed_px_s;
  };
  struct Zoom {
    Ecef held;
    bool holds;  ///< there is a point under the cursor to keep there
    HeadingRule rule;
    glm::dvec2 at_px;
    double base_m;    ///< height of what is zoomed to
    double target_m;  ///< over that; negative under it
  };
  struct Pan {
    glm::dvec2 left_px;  ///< what is still to move
  };
  struct Fly {
    Flight flight;
    Seconds flown{0.0};
  };
  struct TurnNorth {
    Grab centre;
    Angle from;
    Seconds turned{0.0};
  };
  using Motion = std::variant<Rest, Drag, Turn, Glide, Zoom, Pan, Fly, TurnNorth>;

  [[nodiscard]] const Ellipsoid& body() const { return ground_.ellipsoid(); }
  [[nodiscard]] double lowest_m(const Geodetic& place) const;
  [[nodiscard]] double base_m(const Grab& held) const;
  [[nodiscard]] double nearer_m(double over_m, double factor) const;
  void stay_over_ground();
  [[nodiscard]] Orbit over_ground(Orbit orbit, Angle fov_y) const;
  [[nodiscard]] Seconds pass(Seconds now);
  [[nodiscard]] glm::dvec2 centre_px() const;
  [[nodiscard]] Grab grab_at(glm::dvec2 at_px) const;
  void pin_to(const Ecef& point, glm::dvec2 at_px, HeadingRule rule);
  void pin_drag(const Drag& drag);
  [[nodiscard]] static glm::dvec2 flick_px_s(const Drag& drag, Seconds now, Seconds late);
  void shift(glm::dvec2 from_px, glm::dvec2 by_px);
  void set_height(double height_m);
  void zoom_by(double factor, std::optional<glm::dvec2> at_px);
  void pan_by(glm::dvec2 by_px);
  void start_flight(const Camera& camera);
  void go_whole_globe();
  void turn_to(const Turn& turn, glm::dvec2 at_px);

  [[nodiscard]] Motion go_on(Rest rest, Seconds passed);
  [[nodiscard]] Motion go_on(Drag drag, Seconds passed);
  [[nodiscard]] Motion go_on(Turn turn, Seconds passed);
  [[nodiscard]] Motion go_on(Glide glide, Seconds passed);
  [[nodiscard]] Motion go_on(Zoom zoom, Seconds passed);
  [[nodiscard]] Motion go_on(Pan pan, Seconds passed);
  [[nodiscard]] Motion go_on(Fly fly, Seconds passed);
  [[nodiscard]] Motion go_on(TurnNorth north, Seconds passed);

  Camera camera_;
  Ground ground_;
  std::optional<double> deepest_m_;
  Viewport viewport_;
  Motion motion_;
  std::optional<Seconds> clock_;
};

}  // namespace terrella
