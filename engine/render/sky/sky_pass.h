#pragma once

#include <future>
#include <memory>
#include <optional>
#include <vector>

#include "base/result.h"
#include "geo/body.h"
#include "geo/camera.h"
#include "render/gl/draw_state.h"
#include "render/gl/gl_handle.h"
#include "render/sky/air_textures.h"
#include "sky/almanac.h"
#include "sky/star_catalogue.h"

namespace terrella {

/// The sky of one frame.
struct SkyInput {
  Almanac almanac;  ///< Earth's almanac; other bodies use the same Sun and rotation
  bool stars = true;
  bool sun = true;
  bool moon = true;        ///< drawn only for the body "earth"
  bool atmosphere = true;  ///< false while the eye is under the ground
  bool exact_air = true;   ///< false: the air of an eye nearby will do
  double below_m = 0.0;    ///< depth of the lowest ground that may stand at the limb, if it leaves more of the sky open
};

/// Draws stars, Sun, Moon and atmosphere, in that order, all at infinity: without near and far plane. The depth and
/// stencil tests of the caller decide where the sky is drawn: where nothing is in front of it. thread: main
class SkyPass {
 public:
  /// `stars` may be empty. Begins to compute the tables of the air on other threads.
  SkyPass(const Body& body, const std::vector<Star>& stars);

  /// Builds the programs of the parts that `input` switches on for the view, each once.
  Status prepare(const View& view, const SkyInput& input);
  /// Keeps the air of one view in `place`, which it fills if it is empty, until the next call. Call it before all
  /// others.
  void keep_air_in(std::unique_ptr<AirTextures>& place);
  /// Draws into the bound framebuffer and viewport, with the tests and color mask of `state`. Needs prepare(). The
  /// frame's uniform block must be bound and of this view. Returns the draw calls made. Changes vertex array and
  /// texture units 0 and 1.
  int draw(const View& view, const SkyInput& input, DrawState state);
  /// Returns the air of the view for the passes that draw ground and limb; null without air. Valid until the next call.
  [[nodiscard]] const AirTextures* fit_air(const View& view, const SkyInput& input);

 private:
  /// Place and size of a body's disc in the sky.
  struct Disc {
    glm::dvec3 center;
    double radius_rad;
  };

  [[nodiscard]] bool has_moon(const SkyInput& input) const { return input.moon && body_.name == earth().name; }
  void load_stars(const std::vector<Star>& stars);
  int draw_stars(const View& view, const SkyInput& input, DrawState state) const;
  int draw_sun(const View& view, const SkyInput& input, DrawState state) const;
  int draw_moon(const View& view, const SkyInput& input, DrawState state) const;
  int draw_air(const View& view, DrawState state) const;
  void place_disc(const View& view, const Disc& disc, double square) const;

  Body body_;
  std::optional<Atmosphere> atmosphere_;
  std::shared_future<AirTables> tables_;  ///< computed on other threads, if there is an atmosphere
  AirTextures* air_ = nullptr;            ///< air of the view that is drawn; null: none
  gl::Program star_program_, sun_program_, moon_program_, air_program_, thin_air_program_;
  gl::VertexArray star_array_, empty_array_;
  gl::Buffer star_buffer_;
  int star_count_ = 0;
};

}  // namespace terrella
