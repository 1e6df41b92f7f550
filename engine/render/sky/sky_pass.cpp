#include "render/sky/sky_pass.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "geo/scaled_space.h"
#include "render/gl/shader_library.h"
#include "render/gl/vertex_attribute.h"

namespace terrella {
namespace {

// Radius of the Sun's glow, in radii of its disc.
constexpr double kGlow_radii = 10.0;
// Smallest radius of a drawn disc, so that it does not flicker.
constexpr double kSmallestDisc_px = 1.0;
// The table is rebuilt when the eye's height has changed by this fraction, or the cosine of the Sun's zenith angle by
// this amount.
constexpr double kHeightStep = 0.003;
constexpr double kSunStep = 0.0005;
constexpr BlendState kAdd{GL_ONE, GL_ONE, GL_ONE, GL_ONE};
constexpr BlendState kOver{GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA};
constexpr BlendState kThroughAir{GL_ONE, GL_SRC1_COLOR, GL_ONE, GL_SRC1_COLOR};

// Scales places and directions so that the body is a sphere of radius 1.
glm::dvec3 scaled(const Ellipsoid& e, const glm::dvec3& p) { return p / semi_axes_m(e); }

/// Rows and columns of the mesh in shaders/sky/sky_air.vert.
struct AirMesh {
  int rows, columns;
};
// From outside, the air is a thin ring. Its chords must stay within 1 % of its height, for which 512 columns suffice.
// From inside, the air is a dome. Its brightest part, around the Sun, needs steps of a few degrees.
constexpr AirMesh kRing{20, 512};
constexpr AirMesh kDome{40, 120};

glm::dvec3 scaled_direction(const Ellipsoid& e, const glm::dvec3& d) {
  return glm::normalize(glm::dvec3(d.x, d.y, d.z * e.a_m() / e.b_m()));
}

// Axes of the horizon: x towards the Sun's azimuth, z up.
glm::dmat3 horizon_axes(const glm::dvec3& up, const glm::dvec3& sun) {
  glm::dvec3 x = sun - glm::dot(sun, up) * up;
  if (glm::dot(x, x) < 1e-12) x = glm::cross(up, std::abs(up.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0));
  x = glm::normalize(x);
  return {x, glm::cross(up, x), up};
}

// Axes of a disc in the sky: right, up, and towards the eye.
glm::dmat3 disc_axes(const glm::dvec3& center) {
  const glm::dvec3 other = std::abs(center.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  const glm::dvec3 right = glm::normalize(glm::cross(other, center));
  return {right, glm::cross(center, right), -center};
}

double sun_cosine(const Body& body, const View& view, const Almanac& almanac) {
  return glm::dot(glm::normalize(scaled(body.ellipsoid, view.eye.xyz_m)),
                  scaled_direction(body.ellipsoid, almanac.sun.xyz));
}

double pixel_rad(const View& view) { return 1.0 / view.pixels_per_radian(); }

void set(GLint location, const glm::dvec3& v) { glUniform3fv(location, 1, glm::value_ptr(glm::vec3(v))); }
void set(GLint location, const glm::dvec3& v, double w) {
  glUniform4fv(location, 1, glm::value_ptr(glm::vec4(glm::vec3(v), static_cast<float>(w))));
}
void set(GLint location, const glm::dmat3& m) {
  glUniformMatrix3fv(location, 1, GL_FALSE, glm::value_ptr(glm::mat3(m)));
}

}  // namespace

Result<std::unique_ptr<SkyPass>> SkyPass::create(const Body& body, const std::vector<Star>& stars) {
  std::unique_ptr<SkyPass> pass(new SkyPass(body));
  if (const Status built = pass->build_programs(); !built) return built.error();
  pass->empty_array_ = gl::make_vertex_array();
  pass->load_stars(stars);
  return pass;
}

Status SkyPass::build_programs() {
  const auto build = [](gl::Program& into, std::string_view vertex, std::string_view fragment) {
    return build_into(into,
                      {{GL_VERTEX_SHADER, {"frame.glsl", "sky_color.glsl", vertex}},
                       {GL_FRAGMENT_SHADER, {"frame.glsl", "sky_color.glsl", "regolith.glsl", fragment}}},
                      {});
  };
  if (Status s = build(star_program_, "sky_star.vert", "sky_star.frag"); !s) return s;
  if (Status s = build(sun_program_, "sky_disc.vert", "sky_sun.frag"); !s) return s;
  if (Status s = build(moon_program_, "sky_disc.vert", "sky_moon.frag"); !s) return s;
  if (!air_) return Done{};
  table_texture_ = gl::make_texture(GL_TEXTURE_2D_ARRAY);
  glTextureStorage3D(table_texture_.name(), 1, GL_RGBA32F, SkyTable::kColumns, SkyTable::kRows, 3);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) {
    glTextureParameteri(table_texture_.name(), filter, GL_LINEAR);
  }
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) {
    glTextureParameteri(table_texture_.name(), wrap, GL_CLAMP_TO_EDGE);
  }
  return build(air_program_, "sky_air.vert", "sky_air.frag");
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
  const double visibility =
      air_ && input.atmosphere ? star_visibility(*air_, height_m, sun_cosine(body_, view, input.almanac)) : 1.0;
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

void SkyPass::update_table(double eye_radius, double sun_cos) {
  // Added to the eye's height, so that small changes near the ground do not rebuild the table.
  const double scale = air_->top_m / body_.ellipsoid.a_m() * 0.05;
  const double height_change = std::abs(eye_radius - table_key_.eye_radius) / (std::abs(eye_radius - 1.0) + scale);
  const bool crossed = (eye_radius > 1.0 + air_->top_m / body_.ellipsoid.a_m()) != table_.outside;
  if (!crossed && height_change < kHeightStep && std::abs(sun_cos - table_key_.sun_cos) < kSunStep) return;
  table_key_ = {eye_radius, sun_cos};
  table_ = make_sky_table(*air_, body_.ellipsoid.a_m(), eye_radius, sun_cos);
  GLint layer = 0;
  for (const auto* texels : {&table_.gas, &table_.dust, &table_.transmitted}) {
    glTextureSubImage3D(table_texture_.name(), 0, 0, 0, layer++, SkyTable::kColumns, SkyTable::kRows, 1, GL_RGBA,
                        GL_FLOAT, texels->data());
  }
}

int SkyPass::draw_air(const View& view, const SkyInput& input, DrawState state) {
  const Ellipsoid& e = body_.ellipsoid;
  const glm::dvec3 eye = scaled(e, view.eye.xyz_m);
  const double radius = glm::length(eye);
  if (!(radius > 0.0)) return 0;
  update_table(radius, sun_cosine(body_, view, input.almanac));
  const glm::dvec3 up = eye / radius, sun = scaled_direction(e, input.almanac.sun.xyz);
  const glm::dmat3 axes = horizon_axes(up, sun);
  const glm::dmat3 ecef_from_scaled(glm::dvec3(1.0, 0.0, 0.0), glm::dvec3(0.0, 1.0, 0.0),
                                    glm::dvec3(0.0, 0.0, e.b_m() / e.a_m()));
  const AirMesh mesh = table_.outside ? kRing : kDome;
  state.blend = kThroughAir;
  apply(state.with(air_program_.name()));
  set(0, ecef_from_scaled * axes);
  set(1, glm::transpose(axes) * sun, radius);
  set(2, glm::dvec3(table_.outside ? 1.0 : 0.0, air_->top_m / e.a_m(), table_.horizon_dip_rad), mesh.rows);
  const double g = air_->dust_forwardness;
  set(3, glm::dvec3(air_->exposure, g, g * g), mesh.columns);
  glBindTextureUnit(0, table_texture_.name());
  glBindSampler(0, 0);
  glBindVertexArray(empty_array_.name());
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 2 * (mesh.columns + 1), mesh.rows);
  return 1;
}

int SkyPass::draw(const View& view, const SkyInput& input, DrawState state) {
  state.depth.reset();
  state.cull.reset();
  int calls = 0;
  if (input.stars) calls += draw_stars(view, input, state);
  if (input.sun) calls += draw_sun(view, input, state);
  if (input.moon && body_.name == earth().name) calls += draw_moon(view, input, state);
  if (input.atmosphere && air_) calls += draw_air(view, input, state);
  return calls;
}

}  // namespace terrella
