#include "geo/camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <span>
#include <string>
#include <vector>

#include "base/number.h"
#include "geo/place_text.h"

namespace terrella {
namespace {

/// One field of --camera. Without limits, any finite number is valid.
struct CameraField {
  std::string_view name;
  double low, high;
  std::string_view range;  ///< the limits in words, for the error
  double initial;
  std::optional<double> (*read)(std::string_view text);
};

/// Sines of larger angles would mean nothing.
constexpr double kMostTurn_deg = 1.0e6;
constexpr std::array<CameraField, 6> kFields = {{
    {"LAT", -90.0, 90.0, "from -90 to 90 degrees, such as 47.4 or 47.4N", 0.0, read_latitude_deg},
    {"LON", -kMostTurn_deg, kMostTurn_deg, "from -1e6 to 1e6 degrees, such as -8.5 or 8.5W", 0.0, read_longitude_deg},
    {"ALT", -1.0e12, 1.0e12, "from -1e12 to 1e12 metres, such as 250000 or 250km", 0.0, read_length_m},
    {"HEADING", -kMostTurn_deg, kMostTurn_deg, "from -1e6 to 1e6 degrees", 0.0, read_number},
    {"PITCH", -90.0, 90.0, "from -90 (straight down) to 90 degrees", -90.0, read_number},
    {"FOV", 0.01, 170.0, "from 0.01 to 170 degrees", 40.0, read_number},
}};
constexpr std::size_t kRequiredFields = 3;

Error bad_camera(std::string_view text, const std::string& reason) {
  return {"camera " + in_quotes(text) + ": " + reason};
}

/// Returns a picture position in multiples of right and up, in the plane at forward = 1.
glm::dvec2 slopes(const View& view, glm::dvec2 pixel_px) {
  const double per_px = 2.0 * view.tan_half_fov_y / view.viewport.height_px;
  return {(pixel_px.x - 0.5 * view.viewport.width_px) * per_px + view.shear_x,
          (0.5 * view.viewport.height_px - pixel_px.y) * per_px};
}

/// The degrees that give the angle exactly, if there are any next to the rounded ones.
double degrees_of(Angle angle) {
  const double rounded = angle.deg();
  const double up = std::nextafter(rounded, 1.0e9), down = std::nextafter(rounded, -1.0e9);
  for (const double degrees : {rounded, up, down}) {
    if (Angle::degrees(degrees) == angle) return degrees;
  }
  return rounded;
}

}  // namespace

Result<Camera> parse_camera(std::string_view text) {
  const std::vector<std::string_view> words = split_at_commas(text);
  if (words.size() < kRequiredFields || words.size() > kFields.size()) {
    return bad_camera(text, "expected LAT,LON,ALT[,HEADING[,PITCH[,FOV]]], 3 to 6 numbers, but there are " +
                                std::to_string(words.size()));
  }
  std::array<double, kFields.size()> values{};
  for (std::size_t k = 0; k < kFields.size(); ++k) {
    const CameraField& field = kFields[k];
    const std::optional<double> given = k < words.size() ? field.read(words[k]) : field.initial;
    if (!given || *given < field.low || *given > field.high) {
      return bad_camera(
          text, std::string(field.name) + " is " + in_quotes(words[k]) + ", but must be " + std::string(field.range));
    }
    values[k] = *given;
  }
  return Camera{.eye = {.lat = Angle::degrees(values[0]), .lon = Angle::degrees(values[1]), .height_m = values[2]},
                .heading = Angle::degrees(values[3]),
                .pitch = Angle::degrees(values[4]),
                .fov_y = Angle::degrees(values[5])};
}

std::string camera_text(const Camera& camera) {
  return fmt::format("{},{},{},{},{},{}", degrees_of(camera.eye.lat), degrees_of(camera.eye.lon), camera.eye.height_m,
                     degrees_of(camera.heading), degrees_of(camera.pitch), degrees_of(camera.fov_y));
}

Camera nameable(const Camera& camera) {
  const auto named = [](Angle angle) { return Angle::degrees(angle.deg()); };
  return {.eye = {.lat = named(camera.eye.lat), .lon = named(camera.eye.lon), .height_m = camera.eye.height_m},
          .heading = named(camera.heading),
          .pitch = named(camera.pitch),
          .fov_y = named(camera.fov_y)};
}

View make_view(const Camera& camera, const Ellipsoid& ellipsoid, Viewport viewport) {
  viewport = {std::max(viewport.width_px, 1), std::max(viewport.height_px, 1)};
  // East, north and up follow from latitude and longitude, not from the position: at a pole only the longitude defines
  // where north is.
  const double sin_lon = std::sin(camera.eye.lon.rad());
  const double cos_lon = std::cos(camera.eye.lon.rad());
  const double sin_lat = std::sin(camera.eye.lat.rad());
  const glm::dvec3 east(-sin_lon, cos_lon, 0.0);
  const glm::dvec3 north(-sin_lat * cos_lon, -sin_lat * sin_lon, std::cos(camera.eye.lat.rad()));
  const glm::dvec3 zenith = Ellipsoid::normal(camera.eye.lat, camera.eye.lon).xyz;

  const double sin_heading = std::sin(camera.heading.rad());
  const double cos_heading = std::cos(camera.heading.rad());
  const glm::dvec3 ahead = sin_heading * east + cos_heading * north;
  const double sin_pitch = std::sin(camera.pitch.rad());
  const double cos_pitch = std::cos(camera.pitch.rad());
  return View{.eye = ellipsoid.to_ecef(camera.eye),
              .right = cos_heading * east - sin_heading * north,
              .up = cos_pitch * zenith - sin_pitch * ahead,
              .forward = cos_pitch * ahead + sin_pitch * zenith,
              .tan_half_fov_y = std::tan(0.5 * camera.fov_y.rad()),
              .viewport = viewport};
}

glm::dmat3 view_from_ecef_rotation(const View& view) {
  return glm::transpose(glm::dmat3(view.right - view.shear_x * view.forward, view.up, -view.forward));
}

EcefDir pixel_ray(const View& view, glm::dvec2 pixel_px) {
  const glm::dvec2 slope = slopes(view, pixel_px);
  return EcefDir{glm::normalize(view.forward + slope.x * view.right + slope.y * view.up)};
}

std::optional<glm::dvec2> project(const View& view, const Ecef& p) {
  const glm::dvec3 offset = p.xyz_m - view.eye.xyz_m;
  const double depth = glm::dot(offset, view.forward);
  if (!(depth > 0.0)) return std::nullopt;
  const double px_per_slope = 0.5 * view.viewport.height_px / view.tan_half_fov_y;
  const glm::dvec2 pixel(
      0.5 * view.viewport.width_px + (glm::dot(offset, view.right) / depth - view.shear_x) * px_per_slope,
      0.5 * view.viewport.height_px - glm::dot(offset, view.up) / depth * px_per_slope);
  if (!std::isfinite(pixel.x) || !std::isfinite(pixel.y)) return std::nullopt;
  return pixel;
}

std::optional<Geodetic> pick(const View& view, const Ellipsoid& ellipsoid, glm::dvec2 pixel_px) {
  const EcefDir ray = pixel_ray(view, pixel_px);
  const std::optional<double> distance_m = ellipsoid.intersect_m(view.eye, ray);
  if (!distance_m) return std::nullopt;
  return Ellipsoid::lat_lon(ellipsoid.surface_normal(Ecef{view.eye.xyz_m + *distance_m * ray.xyz}));
}

}  // namespace terrella
