#pragma once

#include <cstdint>

// The loops of SphereSplats, several spheres or pixels at once: once for every processor, once for those with AVX2.
// Plain numbers and functions alone: what is compiled for newer processors must share no code with the rest.
namespace terrella {

inline constexpr int kSplatBlockWidth_px = 64;  ///< of a SplatBlock
inline constexpr int kSplatBlockHeight_px = 32;
inline constexpr int kSplatGroup = 64;  ///< spheres that are looked at together

/// Up to kSplatGroup spheres; those beyond the last are copies of it.
struct SplatSpheres {
  using Floats = float[kSplatGroup];
  Floats high_x, high_y, high_z, low_x, low_y, low_z;  ///< metres, Earth-fixed
  Floats radius_m;
  Floats red, green, blue;  ///< 0 to 255
};

/// The view in pixels.
struct SplatLens {
  float view_from_ecef[9];  ///< column by column
  float eye_high[3], eye_low[3];
  float sun[3];
  float half_px[2], focal_px[2];
  float size_px[2];
  float smallest_px;   ///< a smaller sphere is drawn as if it had this radius
  float most_px;       ///< a wider one is left to others
  float widest_angle;  ///< so is one of more radius over distance
  float hiding_m;      ///< of an opaque sphere around the planet's centre; 0: none
};

/// Spheres on the picture, where their outlines are ellipses: how pixels go over into their discs' axes, u and v.
struct SplatDiscs {
  using Floats = float[kSplatGroup];
  using Integers = std::int32_t[kSplatGroup];
  Integers shown, large;                      ///< not 0: small and in the picture; too large for it, or too near
  Integers x_first, x_last, y_first, y_last;  ///< pixels that it may cover
  Floats center_x, center_y;                  ///< in pixels, from the lower left corner
  Floats u_of_x, u_of_y, v_of_x, v_of_y;
  Floats radius_px;                 ///< in the picture's middle
  Floats part;                      ///< radius over distance
  Floats nearness, tilt_u, tilt_v;  ///< in the disc's middle, and how much it shrinks along the disc's axes
  Floats sun_u, sun_v, sun_out;     ///< to the sun, in the disc's axes and towards the eye
};

/// Where in the picture the first `count` of some spheres are. thread: any
void place_splats(const SplatSpheres& spheres, int count, const SplatLens& lens, SplatDiscs& discs);

/// Draws disc k into the block at a column and a row of blocks: nearness, 1 over the distance before the eye's plane,
/// and colour where it is nearer than what is there. thread: any
void draw_splat(const SplatSpheres& spheres, const SplatDiscs& discs, int k, int column, int row, bool lit,
                float* nearness, std::uint32_t* rgba);

#ifdef __x86_64__
/// The same, to the bit, on processors that have AVX2.
void place_splats_avx2(const SplatSpheres& spheres, int count, const SplatLens& lens, SplatDiscs& discs);
void draw_splat_avx2(const SplatSpheres& spheres, const SplatDiscs& discs, int k, int column, int row, bool lit,
                     float* nearness, std::uint32_t* rgba);
#endif

}  // namespace terrella
