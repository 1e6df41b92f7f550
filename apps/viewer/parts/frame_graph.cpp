#include "apps/viewer/parts/frame_graph.h"

#include <fmt/core.h>

#include <algorithm>
#include <string>

#include "apps/viewer/panels/panel_items.h"
#include "globe/features/shown_features.h"

namespace terrella {
namespace {

constexpr float kGraphWidth = 17.0F, kGraphHeight = 3.2F;  // in text heights
constexpr float kGraphGap = 0.8F;
constexpr float kGraphMost = 0.7F;       // share of the window's height; a graph whose top would lie above is hidden
constexpr float kGraphLeast_ms = 33.0F;  // top of the graph, at least
constexpr double kMegabyte = 1e6;

}  // namespace

void FrameGraph::note(double frame_ms) {
  frames_ms_[next_] = static_cast<float>(frame_ms);
  next_ = (next_ + 1) % kFrames;
}

float FrameGraph::draw_above(float foot, const FrameStats& stats) const {
  if (!on_) return foot;
  const float unit = ImGui::GetFontSize(), gap = kGraphGap * unit, line = ImGui::GetTextLineHeightWithSpacing();
  const ImVec2 size = ImGui::GetIO().DisplaySize, padding = ImGui::GetStyle().WindowPadding;
  const ImVec2 inner{std::min(kGraphWidth * unit, size.x - 2.0F * gap - 2.0F * padding.x),
                     kGraphHeight * unit + 3.0F * line};
  if (inner.y + foot > kGraphMost * size.y) return foot;
  const float last_ms = frames_ms_[(next_ + kFrames - 1) % kFrames];
  const float most_ms = std::max(kGraphLeast_ms, *std::ranges::max_element(frames_ms_));
  begin_fixed("##frames", {size.x - gap, size.y - foot - 0.5F * gap}, {1.0F, 1.0F}, inner);
  ImGui::PlotHistogram("##ms", frames_ms_.data(), static_cast<int>(kFrames), static_cast<int>(next_),
                       fmt::format("{:.0f} ms, at most {:.0f} ms", last_ms, most_ms).c_str(), 0.0F, most_ms,
                       {inner.x, kGraphHeight * unit});
  ImGui::TextUnformatted(fmt::format("{} {}: {} loading, {} missing", stats.tiles_wanted,
                                     stats.tiles_wanted == 1 ? "tile" : "tiles", stats.tiles_pending,
                                     stats.tiles_missing)
                             .c_str());
  const ImVec2 pixel = ImGui::GetIO().DisplayFramebufferScale;
  const double zoom = zoom_of(context_.globe, {int(size.x * pixel.x), int(size.y * pixel.y)});
  ImGui::TextUnformatted(
      fmt::format("{} patches, {} draw calls, zoom {:.1f}", stats.patches, stats.draw_calls, zoom).c_str());
  ImGui::TextUnformatted(fmt::format("{:.0f} MB of textures, {:.0f} MB of heights", double(stats.gpu_bytes) / kMegabyte,
                                     double(stats.height_bytes) / kMegabyte)
                             .c_str());
  ImGui::End();
  return foot + 0.5F * gap + inner.y + 2.0F * padding.y;
}

}  // namespace terrella
