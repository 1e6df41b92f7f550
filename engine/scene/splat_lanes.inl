#include <cstdint>

#include "scene/splat_kernel.h"

#ifdef __AVX__
#include <immintrin.h>
#endif

// The code behind splat_kernel.h, for each file that includes it with its own number of lanes, TERRELLA_SPLAT_LANES:
// those of the instructions that the file is compiled for. In an anonymous namespace, and by GCC's and Clang's own
// vectors and functions alone, so that nothing of it can be taken for another file's.
namespace terrella {
namespace {

constexpr int kLanes = TERRELLA_SPLAT_LANES;
using Floats = float __attribute__((vector_size(sizeof(float) * kLanes)));
using Integers = std::int32_t __attribute__((vector_size(sizeof(std::int32_t) * kLanes)));
struct Vec3 {
  Floats x, y, z;
};

inline Floats all(float value) { return Floats{} + value; }
inline Floats larger(const Floats& a, const Floats& b) { return a > b ? a : b; }
inline Floats smaller(const Floats& a, const Floats& b) { return a < b ? a : b; }
inline Floats root(const Floats& values) {
  Floats roots;
  for (int k = 0; k < kLanes; ++k) roots[k] = __builtin_sqrtf(values[k]);
  return roots;
}
inline Floats counted() {
  Floats numbers;
  for (int k = 0; k < kLanes; ++k) numbers[k] = static_cast<float>(k);
  return numbers;
}
inline Integers whole(const Floats& values) { return __builtin_convertvector(values, Integers); }
inline bool none(const Integers& truths) {
#ifdef __AVX__
  static_assert(sizeof(__m256i) == sizeof truths);
  const auto bits = reinterpret_cast<__m256i>(truths);
  return _mm256_testz_si256(bits, bits) != 0;
#else
  std::int64_t parts[kLanes / 2], any = 0;
  __builtin_memcpy(parts, &truths, sizeof parts);
  for (const std::int64_t part : parts) any |= part;
  return any == 0;
#endif
}
inline Floats dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Floats dot(const float* a, const Vec3& b) { return a[0] * b.x + a[1] * b.y + a[2] * b.z; }
inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// Column by column.
inline Vec3 turned(const float* m, const Vec3& v) {
  return {m[0] * v.x + m[3] * v.y + m[6] * v.z, m[1] * v.x + m[4] * v.y + m[7] * v.z,
          m[2] * v.x + m[5] * v.y + m[8] * v.z};
}

template <class Lanes, class T>
inline Lanes load(const T* from) {
  static_assert(sizeof(T) * kLanes == sizeof(Lanes));
  Lanes lanes;
  __builtin_memcpy(&lanes, from, sizeof lanes);
  return lanes;
}
template <class Lanes, class T>
inline void store(const Lanes& lanes, T* to) {
  static_assert(sizeof(T) * kLanes == sizeof(Lanes));
  __builtin_memcpy(to, &lanes, sizeof lanes);
}

/// Whether a sphere around the planet's centre hides all of a ball: the ball lies in it, or the way to the ball's
/// middle ends behind it, having passed its middle by less than the difference of the radii.
inline Integers is_hidden(const SplatLens& lens, const Vec3& center, const Vec3& axis, const Floats& away,
                          const Floats& radius) {
  const Vec3 eye{all(lens.eye_high[0]), all(lens.eye_high[1]), all(lens.eye_high[2])};
  const Vec3 place{eye.x + center.x, eye.y + center.y, eye.z + center.z}, past = cross(eye, axis);
  const Floats within = lens.hiding_m - radius, within2 = within * within;
  const Floats along = -dot(eye, axis);
  return (within > 0.0F) &
         ((dot(place, place) < within2) | ((along > 0.0F) & (along < away) & (dot(past, past) < within2)));
}

/// The pixels whose middles lie within `reach` of a place, as far as the picture has them.
inline void range(const Floats& center_px, const Floats& reach_px, float size_px, std::int32_t* first,
                  std::int32_t* last) {
  const Floats low = smaller(larger(center_px - reach_px - 0.5F, all(0.0F)), all(size_px));
  const Floats high = smaller(larger(center_px + reach_px - 0.5F, all(-1.0F)), all(size_px - 1.0F));
  const Integers from = whole(low), to = whole(high);
  store(from - (__builtin_convertvector(from, Floats) < low), first);  // a true comparison is -1
  store(to + (__builtin_convertvector(to, Floats) > high), last);
}

inline void place_lanes(const SplatSpheres& s, int k, const SplatLens& lens, SplatDiscs& d) {
  const auto from_eye = [k](const float* high, const float* low, float eye_high, float eye_low) {
    return (load<Floats>(high + k) - eye_high) + (load<Floats>(low + k) - eye_low);
  };
  const Vec3 c{from_eye(s.high_x, s.low_x, lens.eye_high[0], lens.eye_low[0]),
               from_eye(s.high_y, s.low_y, lens.eye_high[1], lens.eye_low[1]),
               from_eye(s.high_z, s.low_z, lens.eye_high[2], lens.eye_low[2])};
  const Floats away = root(dot(c, c)), near = 1.0F / away;
  const Vec3 axis{c.x * near, c.y * near, c.z * near};
  const Floats r = larger(load<Floats>(s.radius_m + k), lens.smallest_px / lens.focal_px[1] * away);
  const Floats part = r * near;
  const Integers hidden = is_hidden(lens, c, axis, away, r);
  const Integers large = (part > lens.widest_angle) | (part * lens.focal_px[1] > lens.most_px);
  const Vec3 p = turned(lens.view_from_ecef, c);
  const Floats w = -p.z, in = 1.0F / w;
  // Nothing that small reaches into the picture from beside the eye.
  const Integers shown = ~hidden & ~large & (w >= 0.05F * away);
  store(~hidden & large, d.large + k);
  store(shown, d.shown + k);
  // Two axes at right angles to the way there, the first also to whichever of x and z is further from it.
  const Integers by_x = larger(axis.x, -axis.x) < 0.7F;
  const Floats zero{};
  const Vec3 wide{by_x ? zero : -axis.z, by_x ? axis.z : zero, by_x ? -axis.y : axis.x};
  const Floats unit = 1.0F / root(dot(wide, wide));
  const Vec3 side{wide.x * unit, wide.y * unit, wide.z * unit}, up = cross(axis, side);
  const Vec3 side_view = turned(lens.view_from_ecef, side), up_view = turned(lens.view_from_ecef, up);
  const Floats flat = root(1.0F - part * part), scale = r / flat * in * in;
  const Floats x_scale = lens.focal_px[0] * scale, y_scale = lens.focal_px[1] * scale;
  const Floats u_x = x_scale * (side_view.x * w + p.x * side_view.z),
               u_y = y_scale * (side_view.y * w + p.y * side_view.z);
  const Floats v_x = x_scale * (up_view.x * w + p.x * up_view.z), v_y = y_scale * (up_view.y * w + p.y * up_view.z);
  const Floats det = 1.0F / (u_x * v_y - u_y * v_x);
  const Floats radius_px = lens.focal_px[1] * part / flat, edge = 1.0F + 0.5F / radius_px;
  const Floats x = lens.half_px[0] + lens.focal_px[0] * p.x * in, y = lens.half_px[1] + lens.focal_px[1] * p.y * in;
  range(x, edge * root(u_x * u_x + v_x * v_x), lens.size_px[0], d.x_first + k, d.x_last + k);
  range(y, edge * root(u_y * u_y + v_y * v_y), lens.size_px[1], d.y_first + k, d.y_last + k);
  store(x, d.center_x + k);
  store(y, d.center_y + k);
  store(v_y * det, d.u_of_x + k);
  store(-v_x * det, d.u_of_y + k);
  store(-u_y * det, d.v_of_x + k);
  store(u_x * det, d.v_of_y + k);
  store(radius_px, d.radius_px + k);
  store(part, d.part + k);
  store(in, d.nearness + k);
  store(-side_view.z * r * in, d.tilt_u + k);
  store(-up_view.z * r * in, d.tilt_v + k);
  store(dot(lens.sun, side), d.sun_u + k);
  store(dot(lens.sun, up), d.sun_v + k);
  store(-dot(lens.sun, axis), d.sun_out + k);
}

inline void place_group(const SplatSpheres& spheres, int count, const SplatLens& lens, SplatDiscs& discs) {
  for (int k = 0; k < count; k += kLanes) place_lanes(spheres, k, lens, discs);
}

inline Integers byte(const Floats& value) { return whole(smaller(value, all(255.0F)) + 0.5F); }

/// A disc's looks, as the pixels' loop wants them: with what does not change in it worked out.
struct Looks {
  Looks(const SplatSpheres& s, const SplatDiscs& d, int k)
      : nearness(all(d.nearness[k])),
        bulge_nearness(all(d.nearness[k] * d.part[k])),
        u_nearness(all(-d.nearness[k] * d.tilt_u[k])),
        v_nearness(all(-d.nearness[k] * d.tilt_v[k])),
        middle_alpha(all(255.0F * (0.5F + d.radius_px[k]) + 0.5F)),
        edge_alpha(all(255.0F * d.radius_px[k])),
        u_sun(all(d.sun_u[k] * kSunStep)),
        v_sun(all(d.sun_v[k] * kSunStep)),
        out_sun(all(d.sun_out[k] * kSunStep)),
        red(all(s.red[k])),
        green(all(s.green[k])),
        blue(all(s.blue[k])) {}

  // As in object_sphere.frag: smoothstep(-0.5, 0.8, …).
  static constexpr float kSunStep = 1.0F / 1.3F, kSunFrom = 0.5F * kSunStep;
  Floats nearness, bulge_nearness, u_nearness, v_nearness;
  Floats middle_alpha, edge_alpha;
  Floats u_sun, v_sun, out_sun;
  Floats red, green, blue;
};

/// Pixels of a row, from where u and v are.
template <bool lit>
inline void draw_lanes(const Looks& d, const Floats& u, const Floats& v, float* nearness, std::uint32_t* rgba) {
  const Floats zero{}, one = all(1.0F);
  const Floats d2 = u * u + v * v;
  const Floats bulge = root(larger(1.0F - d2, zero));
  // object_sphere.frag's depth, to the first order of what is small here.
  const Floats near = (d.nearness + d.bulge_nearness * bulge) + (d.u_nearness * u + d.v_nearness * v);
  const Integers alpha = whole(larger(smaller(d.middle_alpha - root(d2) * d.edge_alpha, all(255.5F)), zero));
  const auto nearest = load<Floats>(nearness);
  const Integers wins = (near > nearest) & (alpha > 0);
  if (none(wins)) return;
  Floats light = one;
  if constexpr (lit) {
    const Floats sun = (u * d.u_sun + v * d.v_sun) + (bulge * d.out_sun + Looks::kSunFrom);
    const Floats t = larger(smaller(sun, one), zero);
    light = (0.5F + 0.5F * bulge) * (0.8F + t * t * (0.84F - 0.56F * t));
  }
  const Integers color = byte(light * d.red) | byte(light * d.green) << 8 | byte(light * d.blue) << 16 | alpha << 24;
  store(wins ? near : nearest, nearness);
  store(wins ? color : load<Integers>(rgba), rgba);
}

template <bool lit>
inline void draw_rows(const SplatSpheres& s, const SplatDiscs& d, int k, int column, int row, float* nearness,
                      std::uint32_t* rgba) {
  constexpr int kWidth = kSplatBlockWidth_px, kHeight = kSplatBlockHeight_px, kLastLanes = kWidth - kLanes;
  const int left = column * kWidth, bottom = row * kHeight;
  const int x_first = d.x_first[k] > left ? d.x_first[k] - left : 0;
  const int x_last = d.x_last[k] - left < kWidth ? d.x_last[k] - left : kWidth - 1;
  const int y_first = d.y_first[k] > bottom ? d.y_first[k] - bottom : 0;
  const int y_last = d.y_last[k] - bottom < kHeight ? d.y_last[k] - bottom : kHeight - 1;
  const float off_x = (static_cast<float>(left) - d.center_x[k]) + 0.5F;
  const float up = static_cast<float>(bottom + y_first) - d.center_y[k] + 0.5F;
  const Looks looks(s, d, k);
  for (int x = x_first; x <= x_last; x += kLanes) {
    const int from = x < kLastLanes ? x : kLastLanes;
    const Floats right = (counted() + static_cast<float>(from)) + off_x;
    Floats u = d.u_of_x[k] * right + d.u_of_y[k] * up, v = d.v_of_x[k] * right + d.v_of_y[k] * up;
    for (int at = y_first * kWidth + from; at <= y_last * kWidth + from; at += kWidth) {
      draw_lanes<lit>(looks, u, v, nearness + at, rgba + at);
      u += d.u_of_y[k];
      v += d.v_of_y[k];
    }
  }
}

inline void draw_block(const SplatSpheres& s, const SplatDiscs& d, int k, int column, int row, bool lit,
                       float* nearness, std::uint32_t* rgba) {
  lit ? draw_rows<true>(s, d, k, column, row, nearness, rgba) : draw_rows<false>(s, d, k, column, row, nearness, rgba);
}

}  // namespace
}  // namespace terrella
