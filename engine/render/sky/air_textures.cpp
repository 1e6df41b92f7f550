#include "render/sky/air_textures.h"

#include <algorithm>
#include <cmath>
#include <future>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <utility>
#include <vector>

#include "geo/scaled_space.h"

namespace terrella {
namespace {

// While the eye moves, the air is computed again when the eye's height has changed by this fraction, or the cosine of
// the Sun's zenith angle by this amount.
constexpr double kHeightStep = 0.003;
constexpr double kSunStep = 0.0005;

glm::dvec3 scaled_direction(const Ellipsoid& e, const glm::dvec3& d) { return glm::normalize(d / semi_axes_m(e)); }

// x towards the Sun's azimuth, z up.
glm::dmat3 horizon_axes(const glm::dvec3& up, const glm::dvec3& sun) {
  glm::dvec3 x = sun - glm::dot(sun, up) * up;
  if (glm::dot(x, x) < 1e-12) x = glm::cross(up, std::abs(up.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0));
  x = glm::normalize(x);
  return {x, glm::cross(up, x), up};
}

// Height over the limb of a pixel, at the point of the limb that is nearest to the picture's middle.
double pixel_height(const View& view, double radius, const glm::dvec3& up_ecef) {
  const double nadir = std::acos(std::clamp(-glm::dot(view.forward, up_ecef), -1.0, 1.0));
  const double off = std::min(std::abs(nadir - std::asin(1.0 / radius)), 1.2);
  return std::sqrt((radius - 1.0) * (radius + 1.0)) * std::cos(off) * std::cos(off) / view.pixels_per_radian();
}

gl::Texture make_table(int width, int height, const std::vector<glm::vec4>& texels) {
  gl::Texture texture = gl::make_texture(GL_TEXTURE_2D);
  glTextureStorage2D(texture.name(), 1, GL_RGBA32F, width, height);
  glTextureSubImage2D(texture.name(), 0, 0, 0, width, height, GL_RGBA, GL_FLOAT, texels.data());
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) {
    glTextureParameteri(texture.name(), filter, GL_LINEAR);
  }
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) {
    glTextureParameteri(texture.name(), wrap, GL_CLAMP_TO_EDGE);
  }
  return texture;
}

void bind(GLuint unit, const gl::Texture& texture) {
  glBindTextureUnit(unit, texture.name());
  glBindSampler(unit, 0);
}

}  // namespace

double sun_cosine(const Body& body, const View& view, const EcefDir& sun) {
  return glm::dot(glm::normalize(view.eye.xyz_m / semi_axes_m(body.ellipsoid)),
                  scaled_direction(body.ellipsoid, sun.xyz));
}

AirTextures::AirTextures(const Body& body, const Atmosphere& air, std::shared_future<AirTables> tables)
    : body_(body), air_(air), tables_(std::move(tables)) {}

bool AirTextures::fit(const View& view, const EcefDir& sun, double below_m, bool exact) {
  const Ellipsoid& e = body_.ellipsoid;
  const glm::dvec3 from_center = view.eye.xyz_m / semi_axes_m(e);
  const double length = glm::length(from_center);
  if (!(length > 0.0)) return false;
  const AirEye eye{std::max(length, 1.0 + 1e-9), sun_cosine(body_, view, sun)};
  axes_ = horizon_axes(from_center / length, scaled_direction(e, sun.xyz));
  // Added to the eye's height, so that small changes near the ground do not compute the air again.
  const double scale = 0.05 * (tables().top() - 1.0);
  const double moved = std::abs(eye.radius - eye_.radius) / (eye.radius - 1.0 + scale);
  const bool crossed = (eye.radius > tables().top()) != sky_.outside;
  const double pixel =
      eye.radius > tables().top() ? pixel_height(view, eye.radius, glm::normalize(view.eye.xyz_m)) : 0.0;
  const bool same_pixel = std::abs(pixel - pixel_) <= 0.003 * pixel_;
  const double below = below_m / e.a_m();
  const bool near = below == below_ && !crossed && same_pixel && moved < kHeightStep &&
                    std::abs(eye.sun_cos - eye_.sun_cos) < kSunStep;
  const bool same = near && eye.radius == eye_.radius && eye.sun_cos == eye_.sun_cos && pixel == pixel_;
  rounded_ = rounded_ || (near && !same && !exact);
  if (same || (near && !exact)) return true;
  eye_ = eye;
  pixel_ = pixel;
  below_ = below;
  upload();
  return true;
}

void AirTextures::upload() {
  std::future<GroundColors> ground_colors =
      std::async(std::launch::async, [this] { return make_ground_colors(tables(), eye_); });
  sky_ = make_sky_colors(tables(), eye_, pixel_, below_);
  sky_light_ = make_table(sky_.columns, sky_.rows, sky_.light_srgb);
  std::vector<glm::vec4> rows;
  for (std::size_t k = 0; k < sky_.through.size(); ++k) {
    rows.push_back(sky_.through[k]);
    rows.emplace_back(sky_.zenith[k], 0.0F, 0.0F);
  }
  sky_rows_ = make_table(2, sky_.rows, rows);
  if (sky_.outside) {
    limb_light_ = make_table(sky_.columns, SkyColors::kLimbRows, sky_.limb_light_sum);
    limb_through_ = make_table(1, SkyColors::kLimbRows, sky_.limb_through_sum);
  }
  const GroundColors ground = ground_colors.get();
  ground_through_ = make_table(GroundColors::kColumns, GroundColors::kRows, ground.through);
  ground_light_ = make_table(GroundColors::kColumns, GroundColors::kRows, ground.light_sq);
}

glm::dmat3 AirTextures::horizon_from_ecef() const {
  const glm::dvec3 axes_m = semi_axes_m(body_.ellipsoid);
  const glm::dmat3 to = glm::transpose(axes_);
  return {to[0] / axes_m.x, to[1] / axes_m.y, to[2] / axes_m.z};
}

glm::dmat3 AirTextures::ecef_from_horizon() const {
  const glm::dvec3 shape = semi_axes_m(body_.ellipsoid) / body_.ellipsoid.a_m();
  return {axes_[0] * shape, axes_[1] * shape, axes_[2] * shape};
}

bool AirTextures::near_ground() const { return (eye_.radius - 1.0) * body_.ellipsoid.a_m() < 5.0 * air().gas_scale_m; }

void AirTextures::bind_sky() const {
  bind(0, sky_light_);
  bind(1, sky_rows_);
}

void AirTextures::bind_limb() const {
  bind(2, limb_light_);
  bind(3, limb_through_);
}

void AirTextures::bind_ground() const {
  bind(7, ground_through_);
  bind(8, ground_light_);
}

}  // namespace terrella
