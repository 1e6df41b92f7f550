// Compiled with AVX2: the program comes here only on a processor that has it.
#define TERRELLA_SPLAT_LANES 8
#include "scene/splat_lanes.inl"

namespace terrella {

void place_splats_avx2(const SplatSpheres& spheres, int count, const SplatLens& lens, SplatDiscs& discs) {
  place_group(spheres, count, lens, discs);
}

void draw_splat_avx2(const SplatSpheres& spheres, const SplatDiscs& discs, int k, int column, int row, bool lit,
                     float* nearness, std::uint32_t* rgba) {
  draw_block(spheres, discs, k, column, row, lit, nearness, rgba);
}

}  // namespace terrella
