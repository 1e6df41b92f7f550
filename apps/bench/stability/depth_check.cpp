#include <algorithm>
#include <cmath>

#include "apps/bench/stability/check.h"
#include "geo/body.h"
#include "render/frame_camera.h"
#include "render/gl/shader_library.h"
#include "view/render_modes.h"

namespace terrella::bench {
namespace {

constexpr int kSide_px = 64;
// The renderer's near plane for an eye 10 m over the ground: the nearest plane likely in a wide view.
constexpr double kNear_m = 1.0;
// Reversed depth is near over distance as a float. The relative precision is a float's at every distance, as for
// vertices.
constexpr double kMostReversedPart = 1.0e-6;

struct Mode {
  DepthMode mode;
  const char* name;
};
constexpr Mode kModes[] = {
    {DepthMode::reversed, "reversed"}, {DepthMode::logarithmic, "logarithmic"}, {DepthMode::standard, "standard"}};

/// Draws two slanted surfaces, one behind the other, in both orders.
class DepthPair {
 public:
  DepthPair(DepthMode mode, gl::Program program)
      : reversed_(mode == DepthMode::reversed), program_(std::move(program)) {
    color_ = gl::make_texture(GL_TEXTURE_2D);
    depth_ = gl::make_texture(GL_TEXTURE_2D);
    glTextureStorage2D(color_.name(), 1, GL_R8, kSide_px, kSide_px);
    glTextureStorage2D(depth_.name(), 1, GL_DEPTH_COMPONENT32F, kSide_px, kSide_px);
    glNamedFramebufferTexture(framebuffer_.name(), GL_COLOR_ATTACHMENT0, color_.name(), 0);
    glNamedFramebufferTexture(framebuffer_.name(), GL_DEPTH_ATTACHMENT, depth_.name(), 0);
    glNamedBufferStorage(frame_.name(), sizeof(FrameBlock), nullptr, GL_DYNAMIC_STORAGE_BIT);
  }

  void bind() const {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glViewport(0, 0, kSide_px, kSide_px);
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    for (const GLenum state : {GL_BLEND, GL_STENCIL_TEST, GL_SCISSOR_TEST, GL_CULL_FACE}) glDisable(state);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    glDepthFunc(reversed_ ? GL_GREATER : GL_LESS);
    glClearDepth(reversed_ ? 0.0 : 1.0);
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, frame_.name());
    glBindVertexArray(nothing_.name());
    glUseProgram(program_.name());
  }

  /// True if every pixel shows the nearer surface in both drawing orders.
  [[nodiscard]] bool told_apart(double distance_m, double apart_m) const {
    const Camera camera{.eye = {.lat = {}, .lon = {}, .height_m = 10.0 * kNear_m}};
    const View view = make_view(camera, earth().ellipsoid, {kSide_px, kSide_px});
    // The far plane covers the planet or the drawn surfaces, whichever reaches further.
    const FrameBlock block = frame_of_camera(view, kNear_m, std::max(2.5 * earth().ellipsoid.a_m(), 4.0 * distance_m));
    glNamedBufferSubData(frame_.name(), 0, sizeof(block), &block);
    return nearer_wins(distance_m, distance_m + apart_m) && nearer_wins(distance_m + apart_m, distance_m);
  }

 private:
  [[nodiscard]] bool nearer_wins(double first_m, double second_m) const {
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    for (const double distance_m : {first_m, second_m}) {
      glUniform1f(0, static_cast<float>(distance_m));
      glUniform1f(1, distance_m <= std::min(first_m, second_m) ? 1.0F : 0.5F);
      glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    }
    std::vector<std::uint8_t> shades(std::size_t{kSide_px} * kSide_px);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, kSide_px, kSide_px, GL_RED, GL_UNSIGNED_BYTE, shades.data());
    return std::ranges::all_of(shades, [](std::uint8_t shade) { return shade == 255; });
  }

  bool reversed_;
  gl::Program program_;
  gl::Texture color_, depth_;
  gl::Framebuffer framebuffer_ = gl::make_framebuffer();
  gl::Buffer frame_ = gl::make_buffer();
  gl::VertexArray nothing_ = gl::make_vertex_array();
};

// Shrinks the gap from the whole distance by sqrt(0.5) a step, until the two surfaces flicker.
double smallest_told_apart_m(const DepthPair& pair, double distance_m) {
  double told_m = HUGE_VAL;
  for (double part = 1.0; part > 1e-9 && pair.told_apart(distance_m, part * distance_m); part *= std::sqrt(0.5)) {
    told_m = part * distance_m;
  }
  return told_m;
}

double farthest_metre_m(const DepthPair& pair) {
  double told_m = 0.0;
  for (double power = 1.0; power <= 8.0; power += 0.125) {
    const double distance_m = std::pow(10.0, power);
    if (!pair.told_apart(distance_m, 1.0)) break;
    told_m = distance_m;
  }
  return told_m;
}

void check_mode(const Mode& mode, const DepthPair& pair, const StabilityOptions& options, Checks& checks) {
  const bool reversed = mode.mode == DepthMode::reversed;
  for (double distance_m = 10.0; distance_m < 2e8; distance_m *= options.quick ? 1e5 : 10.0) {
    Check check{.test = "depth, smallest gap", .subject = mode.name, .at = distance_m, .at_unit = "m", .unit = "m"};
    if (reversed) check.limit = kMostReversedPart * distance_m;
    checks.push_back(timed(check, [&] { return smallest_told_apart_m(pair, distance_m); }));
  }
  // Distance beyond which a metre flickers. More is better, so this figure has no limit; the gap seen from 1000 km has
  // one.
  const Check metre{.test = "depth, how far a metre is seen", .subject = mode.name, .unit = "m"};
  checks.push_back(timed(metre, [&] { return farthest_metre_m(pair); }));
}

}  // namespace

Status check_depth(const StabilityOptions& options, Checks& checks) {
  for (const Mode& mode : kModes) {
    Result<gl::Program> program = build_program({{GL_VERTEX_SHADER, {"frame.glsl", "probe_depth.vert"}},
                                                 {GL_FRAGMENT_SHADER, {"frame.glsl", "probe_depth.frag"}}},
                                                {depth_define(mode.mode)});
    if (!program) return program.error();
    const DepthPair pair(mode.mode, *std::move(program));
    pair.bind();
    check_mode(mode, pair, options, checks);
  }
  return Done{};
}

}  // namespace terrella::bench
