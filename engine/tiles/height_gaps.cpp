#include "tiles/height_gaps.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace terrella {
namespace {

constexpr int kMostReach_px = 64;

template <class Visit>
void visit_neighbours(std::size_t at, std::size_t side, Visit visit) {
  if (at % side > 0) visit(at - 1);
  if (at % side + 1 < side) visit(at + 1);
  if (at >= side) visit(at - side);
  if (at + side < side * side) visit(at + side);
}

}  // namespace

void fill_gaps(std::vector<float>& heights_m, std::vector<std::uint8_t> known, int side_px) {
  const auto side = static_cast<std::size_t>(side_px);
  std::vector<std::size_t> rim;
  for (std::size_t at = 0; at < known.size(); ++at) {
    if (known[at] == 0) continue;
    visit_neighbours(at, side, [&](std::size_t beside) {
      if (known[beside] == 0) rim.push_back(beside);
    });
  }
  const int reach = std::min(kMostReach_px, side_px / 4);
  for (int round = 1; round < reach && !rim.empty(); ++round) {
    std::sort(rim.begin(), rim.end());
    rim.erase(std::unique(rim.begin(), rim.end()), rim.end());
    const float kept = static_cast<float>(reach - round) / static_cast<float>(reach - round + 1);
    for (const std::size_t at : rim) {
      float sum_m = 0.0F, count = 0.0F;
      visit_neighbours(at, side, [&](std::size_t beside) {
        if (known[beside] == 0) return;
        sum_m += heights_m[beside];
        count += 1.0F;
      });
      heights_m[at] = kept * sum_m / count;
    }
    std::vector<std::size_t> next;
    for (const std::size_t at : rim) known[at] = 1;
    for (const std::size_t at : rim) {
      visit_neighbours(at, side, [&](std::size_t beside) {
        if (known[beside] == 0) next.push_back(beside);
      });
    }
    rim = std::move(next);
  }
}

}  // namespace terrella
