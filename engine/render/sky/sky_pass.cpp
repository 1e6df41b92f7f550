#include "render/sky/sky_pass.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <numbers>

#include "render/gl/shader_library.h"
#include "render/gl/vertex_attribute.h"

namespace terrella {
namespace {

// Radius of the Sun's glow, in radii of its disc.
constexpr double kGlow_radii = 10.0;
// Smallest radius of a drawn disc, so that it does not flicker.
constexpr double kSmallestDisc_px = 1.0;
constexpr double kPi = std::numbers::pi;
constexpr BlendState kAdd{GL_ONE, GL_ONE, GL_ONE, GL_ONE};
constexpr BlendState kOver{GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA};
constexpr BlendState kThroughAir{GL_ONE, GL_SRC1_COLOR, GL_ONE, GL_SRC1_COLOR};

// Axes of a disc in the sky: right, up, and towards the eye.
glm::dmat3 disc_axes(const glm::dvec3& center) {
  const glm::dvec3 other = std::abs(center.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  const glm::dvec3 right = glm::normalize(glm::cross(other, center));
  return {right, glm::cross(center, right), -center};
}

double pixel_rad(const View& view) { return 1.0 / view.pixels_per_radian(); }

void set(GLint location, const glm::dvec3& v) { glUniform3fv(location, 1, glm::value_ptr(glm::vec3(v))); }
void set(GLint location, const glm::dmat3& m) {
  glUniformMatrix3fv(location, 1, GL_FALSE, glm::value_ptr(glm::mat3(m)));
}

/// Columns of the mesh of air, counted from half a turn before the Sun's azimuth; may be 0 or more than once round.
struct Columns {
  int first = 0, count = 0;
};

// The columns that meet a cone around the view, widened by the rows of the mesh.
Columns columns_in_view(const View& view, const AirTextures& air) {
  constexpr double kMargin_rad = 0.02;  // scaled space bends angles by the body's flattening
  const SkyColors& colors = air.sky();
  const double tan_x = view.tan_half_fov_y * view.aspect() + std::abs(view.shear_x);
  const auto zenith_rad = [](const glm::vec2& z) { return std::atan2(double(z.x), double(z.y)); };
  const double low = zenith_rad(colors.zenith.front()), high = zenith_rad(colors.zenith.back());
  const double reach = std::atan(std::hypot(view.tan_half_fov_y, tan_x)) + 0.5 * std::abs(low - high) + kMargin_rad;
  const glm::dvec3 ahead = glm::normalize(air.horizon_from_ecef() * view.forward);
  const double middle = 0.5 * (low + high), sine = std::sin(middle) * std::hypot(ahead.x, ahead.y);
  // Cosine of the azimuths, from the view's, at which the middle row leaves the cone.
  const double leaves = (std::cos(std::min(reach, kPi)) - std::cos(middle) * ahead.z) / std::max(sine, 1e-9);
  if (leaves >= 1.0) return {};
  if (leaves <= -1.0) return {0, colors.turn};
  const double columns_per_rad = 0.5 * colors.turn / kPi, half = std::acos(leaves);
  const double center = std::atan2(ahead.y, ahead.x) + kPi + 2.0 * kPi;  // above 0
  const int first = static_cast<int>(std::floor((center - half) * columns_per_rad));
  const int last = static_cast<int>(std::ceil((center + half) * columns_per_rad));
  return {first, std::min(last - first, colors.turn)};
}

}  // namespace

SkyPass::SkyPass(const Body& body, const std::vector<Star>& stars)
    : body_(body), atmosphere_(atmosphere_of(body)), empty_array_(gl::make_vertex_array()) {
  if (atmosphere_) {
    tables_ = std::async(std::launch::async, [air = *atmosphere_, radius_m = body.ellipsoid.a_m()] {
                return AirTables(air, radius_m);
              }).share();
  }
  load_stars(stars);
}

void SkyPass::keep_air_in(std::unique_ptr<AirTextures>& place) {
  if (atmosphere_ && !place) place = std::make_unique<AirTextures>(body_, *atmosphere_, tables_);
  air_ = place.get();
  if (air_ != nullptr) air_->begin_frame();
}

Status SkyPass::prepare(const View& view, const SkyInput& input) {
  const auto build = [](bool needed, gl::Program& into, std::string_view vertex, std::string_view fragment,
                        std::string_view define) -> Status {
    if (!needed || into) return Done{};
    return build_into(into,
                      {{GL_VERTEX_SHADER, {"frame.glsl", "sky_color.glsl", vertex}},
                       {GL_FRAGMENT_SHADER, {"frame.glsl", "air.glsl", "sky_color.glsl", "regolith.glsl", fragment}}},
                      {define});
  };
  if (Status s = build(input.stars && star_count_ > 0, star_program_, "sky_star.vert", "sky_star.frag", "STARS"); !s)
    return s;
  if (Status s = build(input.sun, sun_program_, "sky_disc.vert", "sky_sun.frag", "SUN"); !s) return s;
  if (Status s = build(has_moon(input), moon_program_, "sky_disc.vert", "sky_moon.frag", "MOON"); !s) return s;
  const AirTextures* air = fit_air(view, input);
  const bool thin = air != nullptr && air->sky().thin;
  return build(air != nullptr, thin ? thin_air_program_ : air_program_, "sky_air.vert", "sky_air.frag",
               thin ? "THIN_RING" : "MANY_ROWS");
}

void SkyPass::load_stars(const std::vector<Star>& stars) {
  star_count_ = static_cast<int>(stars.size());
  if (stars.empty()) return;
  star_array_ = gl::make_vertex_array();
  star_buffer_ = gl::make_buffer();
  glNamedBufferStorage(star_buffer_.name(), static_cast<GLsizeiptr>(stars.size() * sizeof(Star)), stars.data(), 0);
  const GLuint array = star_array_.name();
  glVertexArrayVertexBuffer(array, 0, star_buffer_.name(), 0, sizeof(Star));
  gl::float_attribute(array, 0, 0, 3, offsetof(Star, direction_j2000));
  gl::float_attribute(array, 1, 0, 1, offsetof(Star, magnitude));
  gl::float_attribute(array, 2, 0, 3, offsetof(Star, color_linear));
}

int SkyPass::draw_stars(const View& view, const SkyInput& input, DrawState state) const {
  if (star_count_ == 0) return 0;
  const double height_m = body_.ellipsoid.to_geodetic(view.eye).height_m;
  const double visibility = air_ != nullptr && input.atmosphere
                                ? star_visibility(air_->air(), height_m, sun_cosine(body_, view, input.almanac.sun))
                                : 1.0;
  if (visibility < 1e-3) return 0;
  state.blend = kAdd;
  state.program_point_size = true;
  apply(state.with(star_program_.name()));
  set(0, view_from_ecef_rotation(view) * input.almanac.ecef_from_j2000);
  glUniform1f(1, static_cast<float>(visibility));
  glBindVertexArray(star_array_.name());
  glDrawArrays(GL_POINTS, 0, star_count_);
  return 1;
}

// `square` is the half width of the square in radii of the disc.
void SkyPass::place_disc(const View& view, const Disc& disc, double square) const {
  const glm::dmat3 axes = disc_axes(disc.center);
  const double half = std::tan(std::min(square * disc.radius_rad, 1.4));
  const glm::mat2x3 sides(glm::vec3(axes[0] * half), glm::vec3(axes[1] * half));
  set(0, disc.center);
  glUniform3fv(1, 2, glm::value_ptr(sides));
  glUniform2f(3, static_cast<float>(std::tan(disc.radius_rad) / half), static_cast<float>(pixel_rad(view) / half));
  glBindVertexArray(empty_array_.name());
}

int SkyPass::draw_sun(const View& view, const SkyInput& input, DrawState state) const {
  const double radius = std::asin(kSunRadius_m / input.almanac.sun_distance_m);
  const Disc disc{input.almanac.sun.xyz, std::max(radius, kSmallestDisc_px * pixel_rad(view))};
  state.blend = kAdd;
  apply(state.with(sun_program_.name()));
  place_disc(view, disc, kGlow_radii);
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  return 1;
}

int SkyPass::draw_moon(const View& view, const SkyInput& input, DrawState state) const {
  const Almanac& almanac = input.almanac;
  const glm::dvec3 from_eye = almanac.moon.xyz_m - view.eye.xyz_m;
  const double distance_m = glm::length(from_eye);
  if (distance_m <= kMoonRadius_m) return 0;
  const Disc disc{from_eye / distance_m,
                  std::max(std::asin(kMoonRadius_m / distance_m), kSmallestDisc_px * pixel_rad(view))};
  state.blend = kOver;
  apply(state.with(moon_program_.name()));
  // Room for the antialiased rim.
  place_disc(view, disc, 1.0 + pixel_rad(view) / disc.radius_rad);
  const glm::mat3 axes(disc_axes(disc.center));
  glUniform3fv(4, 3, glm::value_ptr(axes));
  set(7, glm::normalize(almanac.sun.xyz * almanac.sun_distance_m - almanac.moon.xyz_m));
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  return 1;
}

int SkyPass::draw_air(const View& view, DrawState state) const {
  const SkyColors& colors = air_->sky();
  const Columns seen = columns_in_view(view, *air_);
  if (seen.count == 0) return 0;
  state.blend = kThroughAir;
  apply(state.with((colors.thin ? thin_air_program_ : air_program_).name()));
  set(0, air_->ecef_from_horizon());
  glUniform1f(1, static_cast<float>(colors.turn));
  air_->bind_sky();
  glBindVertexArray(empty_array_.name());
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 2 * seen.first, 2 * (seen.count + 1), colors.thin ? 1 : colors.rows - 1);
  return 1;
}

const AirTextures* SkyPass::fit_air(const View& view, const SkyInput& input) {
  return input.atmosphere && air_ != nullptr && air_->fit(view, input.almanac.sun, input.below_m, input.exact_air)
             ? air_
             : nullptr;
}

int SkyPass::draw(const View& view, const SkyInput& input, DrawState state) {
  state.cull.reset();
  int calls = 0;
  if (input.stars) calls += draw_stars(view, input, state);
  if (input.sun) calls += draw_sun(view, input, state);
  if (has_moon(input)) calls += draw_moon(view, input, state);
  if (fit_air(view, input) != nullptr) calls += draw_air(view, state);
  return calls;
}

}  // namespace terrella
