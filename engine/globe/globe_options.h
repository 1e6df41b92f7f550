#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <vector>

#include "base/result.h"
#include "base/utc_time.h"
#include "geo/body.h"
#include "sky/cube_picture.h"
#include "sky/star_catalogue.h"
#include "view/render_modes.h"

namespace terrella {

/// A globe's treatment of the OpenGL state that it finds at a call.
enum class GlContract {
  restore,  ///< every call leaves the state as it found it: about 250 queries in a call of render()
  leave,    ///< a call asks for no state and restores none; the caller sets what it needs itself afterwards
};

/// Settings of a globe. Globe::create() fails if a value is out of its range (check_options()).
struct GlobeOptions {
  Body body = earth();
  Texturing texturing = Texturing::automatic;
  /// Draws squeezed tiles near the poles if the set has them and `texturing` is exact or automatic. False: draws the
  /// full grid.
  bool squeezed_rows = true;
  /// A patch that touches a pole takes a coarser level if it spans more than this many tile columns, [1, 4096].
  int polar_columns = 32;
  /// Detail of the imagery, [0.125, 8]: along the meridian a texel is at most 1 / texels_per_pixel of a pixel, if the
  /// set has that detail. Tiles, bytes and memory grow with the square of this number. `bench accuracy` has the curve.
  double texels_per_pixel = 1.0;
  /// Largest error on the screen, in pixels, [0.01, 16], of the drawn ellipsoid and of values interpolated over it. A
  /// patch with a larger error is split.
  double max_error_px = 0.2;
  int segments = 24;  ///< edges of triangles along a patch's side: even, [2, 128]
  /// Border of neighbouring texels around a tile in its slot, [0, 64]; mip k has 2^-k times as many. Filtering reaches
  /// at most 8 texels. Without a gutter, tile borders show.
  int gutter_px = 8;
  DepthMode depth = DepthMode::reversed;
  bool unlit = false;  ///< draws imagery only: no light, no sky, black background
  SurfaceLook surface{};
  double exaggeration = 1.0;  ///< factor of the heights, [0, 100]
  StereoLook stereo{};
  bool sky = false;  ///< draws stars, Sun, Moon and atmosphere; not with `unlit`
  /// Time for Sun and sky. None: the Sun shines from over the viewer's shoulder and is not drawn, and it is day
  /// everywhere (ImageLook::daylight).
  std::optional<UtcTime> time{};
  std::vector<Star> stars{};  ///< stars of the sky
  /// City lights on the Earth's night side, drawn only with a sky and a time (Globe::set_night_lights()); may be empty.
  GreyPicture night_lights{};
  std::vector<std::byte> label_font{};             ///< bytes of a font file for the labels of objects; empty: no labels
  std::size_t gpu_bytes = 512UL << 20;             ///< texture slots for tiles, all image layers together
  std::size_t height_bytes = 256UL << 20;          ///< elevation tiles in main memory; at least 64 tiles always fit
  std::size_t upload_bytes_per_frame = 8UL << 20;  ///< positive; a frame uploads at least one tile
  std::chrono::microseconds upload_time_per_frame{4000};  ///< [0, 24 h]
  /// Patches whose relief may be rebuilt per frame, about 0.3 ms each. Patches without which the frame cannot be drawn
  /// do not count. The other height tiles wait, and mountains become finer frame by frame. Positive.
  int relief_meshes_per_frame = 24;
  int workers = 0;                               ///< decoder threads of an image layer, [0, 64]; 0: decoder_threads()
  GlContract gl_contract = GlContract::restore;  ///< the picture is the same with both
  /// A tile of imagery or heights that failed for now (MissingKind::failed) is requested again after this time, if it
  /// is still wanted. Positive, at most 365 days.
  std::chrono::milliseconds retry_after{30'000};
};

/// Budget of a globe; the fields are those of GlobeOptions.
struct GlobeBudget {
  std::size_t gpu_bytes;
  std::size_t upload_bytes_per_frame;
  std::chrono::microseconds upload_time_per_frame;
  int relief_meshes_per_frame;
};
[[nodiscard]] inline GlobeBudget budget_of(const GlobeOptions& options) {
  return {options.gpu_bytes, options.upload_bytes_per_frame, options.upload_time_per_frame,
          options.relief_meshes_per_frame};
}

/// Fails if a value is out of its range, and names the value. thread: any
[[nodiscard]] Status check_options(const GlobeOptions& options);
[[nodiscard]] Status check_budget(const GlobeBudget& budget);
[[nodiscard]] Status check_exaggeration(double exaggeration);

}  // namespace terrella
