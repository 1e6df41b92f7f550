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
enum class NavigationKey { pan_left, pan_right, pan_up, pan_down, zoom_in, zoom_out, north_up, whole_globe, look_down };

/// Turns pointer, wheel and key events into a camera.
///
/// Left drag keeps the grabbed surface point under the cursor. A flick glides on and stops. The wheel zooms and keeps
/// the point under the cursor. Right drag, or left drag with Ctrl, tilts (up: towards the horizon) and turns around the
/// point at the picture's centre. A double click flies to a point. Key look_down puts the eye over the point at the
/// picture's centre, with north up. A new gesture ends the motion before it.
///
/// The user grabs, zooms to and turns around the ground as it is drawn, mountains included. The eye stays at least 1 m
/// over the ground. If it would be lower, it is raised, at the latest by advance(); it is never lowered. After
/// set_deepest() the eye may go under the ground.
///
/// The class holds pure state. The caller supplies times of any origin. Only their differences count, each clamped to
/// [0 s, 0.25 s], so a clock that jumps moves nothing far. Positions are pixels of the viewport, centres at halves, and
/// may lie outside it. Events with a value that is not finite are ignored. thread: any, but one call at a time
class Navigator {
 public:
  Navigator(const Camera& camera, const Ground& ground, Viewport viewport);

  void set_viewport(Viewport viewport);   ///< sides below 1 count as 1
  void set_camera(const Camera& camera);  ///< stops every motion; a camera out of its ranges is ignored
  void set_ground(const Ground& ground);  ///< continues the motion over another ground
  /// Sets the lowest height of the eye over the ellipsoid, metres, negative; none: the eye stays over the ground.
  void set_deepest(std::optional<double> deepest_m) { deepest_m_ = deepest_m; }
  /// Sets the finest texel of the imagery, metres on the ground, > 0; none: no stop. The wheel and the keys then stop
  /// zooming in where a texel covers 8 pixels. A push after a pause of 0.4 s goes on from there.
  void set_finest_texel(std::optional<double> texel_m) { texel_m_ = texel_m; }
  /// Height over the ground from which a texel of that many metres covers 8 pixels.
  [[nodiscard]] double texel_stop_m(double texel_m) const;
  /// True while the zoom stands at the finest texels, until another gesture.
  [[nodiscard]] bool is_at_texels() const { return at_texels_; }

  void pointer_down(PointerButton button, bool ctrl, glm::dvec2 at_px, Seconds now);
  void pointer_move(glm::dvec2 at_px, Seconds now);
  /// Ends a drag. `late` is how long before `now` this event and the events just before it may have happened, for
  /// example after a slow frame. A movement that could also be a rest does not flick. The speed of a flick is averaged
  /// over at least `late`.
  void pointer_up(PointerButton button, Seconds now, Seconds late = Seconds(0.0));
  void double_click(glm::dvec2 at_px, Seconds now);
  void centre_on(glm::dvec2 at_px, Seconds now);  ///< flies at constant height until the point is at the centre
  void wheel(glm::dvec2 at_px, double steps, Seconds now);  ///< positive steps zoom towards the ground
  /// Zooms by two fingers on a touch pad or screen. The point under `at_px`, between the fingers, stays there and comes
  /// nearer by `factor`, which is over 1 as the fingers move apart. Takes effect at once, without a glide. Ignored
  /// while a button is held.
  void pinch(glm::dvec2 at_px, double factor, Seconds now);
  void key(NavigationKey key, Seconds now);
  /// Starts a flight to `camera` (view/flight.h). A camera with a value out of range is ignored.
  void fly_to(const Camera& camera, Seconds now);
  /// Puts the camera at the next place of a motion that the caller leads, until set_camera() or a gesture ends it. A
  /// camera with a value out of range is ignored.
  void lead(const Camera& camera);
  [[nodiscard]] bool is_led() const { return std::holds_alternative<Led>(motion_); }
  /// Advances flights, glides and zooms to `now`. Call this once per frame while animating().
  void advance(Seconds now);

  [[nodiscard]] const Camera& camera() const { return camera_; }
  [[nodiscard]] Viewport viewport() const { return viewport_; }
  /// True while something moves by itself and frames are needed.
  [[nodiscard]] bool animating() const;
  /// True if nothing moves and no button is held.
  [[nodiscard]] bool at_rest() const { return std::holds_alternative<Rest>(motion_); }

 private:
  struct Rest {};
  struct Led {};
  struct Sample {
    glm::dvec2 at_px;
    Seconds when;
  };
  struct Drag {
    Camera start;
    Ecef held;
    HeadingRule rule;
    glm::dvec2 from_px;
    std::vector<Sample> trail;  ///< recent positions of the pointer; never empty
  };
  struct Turn {
    std::optional<Orbit> orbit;  ///< none if the picture's centre shows the sky: the eye then turns in its place
    Camera start;
    glm::dvec2 from_px;
  };
  struct Glide {
    glm::dvec2 at_px;
    glm::dvec2 speed_px_s;
  };
  struct Zoom {
    Ecef held;
    bool holds;  ///< true if there is a point to keep under the cursor
    HeadingRule rule;
    glm::dvec2 at_px;
    double base_m;    ///< height of the ground that is zoomed to
    double target_m;  ///< target height of the eye over `base_m`; negative under it
  };
  struct Pan {
    glm::dvec2 left_px;  ///< distance still to move
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
  using Motion = std::variant<Rest, Drag, Turn, Glide, Zoom, Pan, Fly, TurnNorth, Led>;

  [[nodiscard]] const Ellipsoid& body() const { return ground_.ellipsoid(); }
  [[nodiscard]] double lowest_m(const Geodetic& place) const;
  [[nodiscard]] double base_m(const Grab& held) const;
  [[nodiscard]] double nearer_m(double over_m, double factor) const;
  [[nodiscard]] double zoomed_m(double over_m, double factor, Seconds now);
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
  void zoom_by(double factor, std::optional<glm::dvec2> at_px, Seconds now);
  void pan_by(glm::dvec2 by_px);
  void start_flight(const Camera& camera);
  void go_whole_globe();
  void go_look_down();
  void fly_towards(glm::dvec2 at_px, double factor, Seconds now);
  void turn_to(const Turn& turn, glm::dvec2 at_px);

  [[nodiscard]] Motion go_on(Rest rest, Seconds passed);
  [[nodiscard]] Motion go_on(Led led, Seconds passed);
  [[nodiscard]] Motion go_on(Drag drag, Seconds passed);
  [[nodiscard]] Motion go_on(Turn turn, Seconds passed);
  [[nodiscard]] Motion go_on(Glide glide, Seconds passed);
  [[nodiscard]] Motion go_on(Zoom zoom, Seconds passed);
  [[nodiscard]] Motion go_on(Pan pan, Seconds passed);
  [[nodiscard]] Motion go_on(Fly fly, Seconds passed);
  [[nodiscard]] Motion go_on(TurnNorth north, Seconds passed);

  Camera camera_;
  Ground ground_;
  std::optional<double> texel_m_;
  bool at_texels_ = false;
  Seconds last_zoom_{0.0};
  std::optional<double> deepest_m_;
  Viewport viewport_;
  Motion motion_;
  std::optional<Seconds> clock_;
};

}  // namespace terrella
