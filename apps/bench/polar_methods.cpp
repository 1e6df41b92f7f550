#include "apps/bench/polar_methods.h"

#include <array>
#include <utility>

namespace terrella::bench {
namespace {

using Method = PaperLook::Method;

constexpr std::array<double, 3> kAs{2.0, 4.0, 8.0};
constexpr std::array<double, 4> kBands{0.02, 0.05, 0.1, 0.2};
constexpr std::array<double, 5> kAnisotropies{1.0, 2.0, 4.0, 8.0, 16.0};
constexpr double kPaperA = 4.0, kPaperBand = 0.05;

PolarMethod of_sphere(const char* name, const PaperLook& look, bool everywhere) {
  return {.name = name,
          .sphere = look,
          .a = look.a,
          .band = look.band,
          .has_a_and_band = look.method == Method::bands,
          .has_anisotropy = look.method != Method::bands,
          .everywhere = everywhere};
}

PolarMethod of_globe(const char* name, Texturing texturing) {
  return {.name = name, .sphere = std::nullopt, .texturing = texturing};
}

void add_with(std::vector<PolarMethod>& methods, double a, double band, bool everywhere) {
  methods.push_back(of_sphere("sphere: paper", {.method = Method::bands, .a = a, .band = band}, everywhere));
  PolarMethod globe = of_globe("globe: paper", Texturing::paper);
  globe.a = a;
  globe.band = band;
  globe.has_a_and_band = true;
  globe.everywhere = everywhere;
  methods.push_back(std::move(globe));
}

}  // namespace

std::vector<PolarMethod> polar_methods(Effort effort) {
  const bool full = effort == Effort::full;
  std::vector<PolarMethod> methods{of_sphere(kPlainSphere, {}, true), of_globe(kVertexGlobe, Texturing::vertex),
                                   of_globe(kAutoGlobe, Texturing::automatic),
                                   of_globe("globe: exact", Texturing::exact),
                                   of_globe("globe: auto, full grid", Texturing::automatic)};
  methods.back().squeezed = false;
  add_with(methods, kPaperA, kPaperBand, true);
  for (const double anisotropy : kAnisotropies) {
    const bool end = anisotropy == kAnisotropies.back();
    methods.push_back(of_sphere("sphere: exact", {.method = Method::exact, .anisotropy = anisotropy}, end || full));
    if (anisotropy > 1.0) methods.push_back(of_sphere(kPlainSphere, {.anisotropy = anisotropy}, full));
  }
  for (const double a : kAs) {
    for (const double band : kBands) {
      if (a == kPaperA && band == kPaperBand) continue;
      if (full || a == kPaperA || band == kPaperBand) add_with(methods, a, band, full);
    }
  }
  if (effort == Effort::quick) std::erase_if(methods, [](const PolarMethod& m) { return !m.everywhere; });
  return methods;
}

}  // namespace terrella::bench
