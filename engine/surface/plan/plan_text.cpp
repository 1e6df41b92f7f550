#include "surface/plan/plan_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <iterator>
#include <span>

namespace terrella {
namespace {

std::string name(const PatchId& id) {
  return fmt::format("{}/{}/{}/{}", static_cast<int>(id.face), id.level, id.x, id.y);
}

void print(const SelectedPatch& patch, std::span<const WindowCell> cells, std::string& text) {
  fmt::format_to(std::back_inserter(text),
                 "patch {} level {} squeeze {} coarse {}{}{} pixel {:.6g} m footprint {:.6g} cells {:x}\n",
                 name(patch.node->id), patch.tile_level, patch.squeeze, patch.coarse_sides,
                 patch.in_band ? " band" : "", patch.cut_by_view ? " cut" : "", patch.pixel_m, patch.footprint_texels,
                 fmt::join(cells, " "));
}

void print(const LayerPlan& layer, std::string& text) {
  const TileCoverage& c = layer.coverage;
  fmt::format_to(std::back_inserter(text),
                 "layer detail {:.6g} tiles {} pending {} missing {} uncovered {} shown {} uses {}\n", layer.detail,
                 c.tiles, c.pending, c.missing, c.uncovered, c.shown, c.uses.all().size());
  const std::span<const WindowCell> cells(c.cells);
  for (std::size_t k = 0; k < layer.patches.size(); ++k) {
    const std::size_t first = c.draws[k].window.x;
    const std::size_t end = k + 1 < c.draws.size() ? c.draws[k + 1].window.x : cells.size();
    print(layer.patches[k], cells.subspan(first, end - first), text);
  }
  for (const WantedTile& tile : c.wanted) {
    fmt::format_to(std::back_inserter(text), "tile {}/{}/{}/{} priority {:.6g}\n", tile.id.level, tile.id.x, tile.id.y,
                   tile.id.squeeze, tile.priority);
  }
}

}  // namespace

std::string to_text(const FramePlan& plan) {
  std::string text =
      fmt::format("frame layers {} meshes {} put off {}\n", plan.layers.size(), plan.meshes.size(), plan.put_off);
  for (const LayerPlan& layer : plan.layers) print(layer, text);
  for (const NodeRef& node : plan.meshes) fmt::format_to(std::back_inserter(text), "mesh {}\n", name(node->id));
  return text;
}

}  // namespace terrella
