#include "apps/viewer/panels/panels.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace terrella {
namespace {

constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs |
                                    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                                    ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoBringToFrontOnFocus;
constexpr float kMargin = 0.8F;         // in text heights, between panels and the window's edge
constexpr float kFootOfMessage = 3.6F;  // in text heights, above the status line
constexpr float kPlainText_px = 15.0F;  // text height at 96 dots per inch
constexpr float kUnderFirstRow = 2.8F;
const ImU32 kInk = IM_COL32(232, 240, 248, 255);
const ImU32 kMessageShade = IM_COL32(13, 20, 31, 235);
const ImU32 kShade = IM_COL32(0, 0, 0, 150);

constexpr const char* kHelp[][2] = {
    {"Drag", "move the ground"},
    {"Wheel", "zoom to the cursor"},
    {"Right-drag, Ctrl + drag", "tilt and turn"},
    {"Double-click", "fly to this place"},
    {"Arrows; with Shift", "move; tilt and turn"},
    {"+  -  Page up, down", "zoom"},
    {"N", "north up"},
    {"Home", "reset view: whole globe"},
    {"G", "graticule"},
    {"/", "search for a place"},
    {"M", "measure: click to add, Enter for the centre, Backspace to undo"},
    {"1 ... 9", "fly to a bookmark; Ctrl saves the view"},
    {"P", "view settings"},
    {"L", "layers: show, opacity, order, remove"},
    {"Drop a file", "add a picture, tile set, GeoJSON or glTF"},
    {"U", "translucent surface"},
    {"X", "go under the ground, and back"},
    {"B", "sky on or off"},
    {"S", "stereo: anaglyph, side by side, interlaced, off"},
    {"F", "full screen"},
    {"I", "save a picture of any size"},
    {"F12", "save a screenshot"},
    {"F6", "switch the keyboard between panel and globe"},
    {"F1  ?", "shortcuts"},
    {"Esc", "close a panel, cancel, quit"},
};

ImVec2 to_ui(glm::dvec2 px, double unit_px) {
  return {static_cast<float>(px.x / unit_px), static_cast<float>(px.y / unit_px)};
}

/// Starts a panel of a given inner size at a corner; pivot (0, 1) is the lower left. ImGui's own fitting follows the
/// text one frame late, and the viewer may draw only one frame.
void begin_panel(const char* name, ImVec2 at, ImVec2 pivot, ImVec2 inner) {
  const ImVec2 padding = ImGui::GetStyle().WindowPadding;
  ImGui::SetNextWindowPos(at, ImGuiCond_Always, pivot);
  ImGui::SetNextWindowSize({std::ceil(inner.x + 2.0F * padding.x), std::ceil(inner.y + 2.0F * padding.y)});
  ImGui::Begin(name, nullptr, kFixed);
}

/// Converts a line width at 96 dots per inch to units of the window.
float line_width(float width_px) { return width_px * ImGui::GetFontSize() / kPlainText_px; }

float margin() { return kMargin * ImGui::GetFontSize(); }

struct Field {
  std::string text;
  bool quiet = false;
};

void draw_text(const Field& field) {
  ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(field.quiet ? ImGuiCol_TextDisabled : ImGuiCol_Text));
  ImGui::TextUnformatted(field.text.c_str());
  ImGui::PopStyleColor();
}

/// Draws a panel with one line of text; empty text draws nothing.
void draw_row(const char* name, std::vector<Field> fields, ImVec2 at, ImVec2 pivot) {
  std::erase_if(fields, [](const Field& field) { return field.text.empty(); });
  if (fields.empty()) return;
  const float gap = 1.3F * ImGui::GetFontSize();
  float width = -gap;
  for (const Field& field : fields) width += gap + ImGui::CalcTextSize(field.text.c_str()).x;
  begin_panel(name, at, pivot, {width, ImGui::GetFontSize()});
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (i > 0) ImGui::SameLine(0.0F, gap);
    draw_text(fields[i]);
  }
  ImGui::End();
}

/// Draws wrapped text over all panels, centred above a position; empty text draws nothing.
void draw_paragraph(const std::string& text, ImVec2 at) {
  if (text.empty()) return;
  const float widest = 0.85F * ImGui::GetIO().DisplaySize.x;
  const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, widest);
  const ImVec2 padding = ImGui::GetStyle().WindowPadding;
  const ImVec2 from{std::floor(at.x - 0.5F * size.x), std::floor(at.y - padding.y - size.y)};
  ImDrawList* list = ImGui::GetForegroundDrawList();
  list->AddRectFilled({from.x - padding.x, from.y - padding.y}, {from.x + size.x + padding.x, at.y}, kMessageShade,
                      ImGui::GetStyle().WindowRounding);
  list->AddText(ImGui::GetFont(), ImGui::GetFontSize(), from, kInk, text.c_str(), nullptr, widest);
}

void draw_scale(const ScaleBar& bar, ImVec2 lower_right, double unit_px) {
  const std::string text = length_text(bar.length_m);
  const float width = static_cast<float>(bar.width_px / unit_px);
  const float text_width = ImGui::CalcTextSize(text.c_str()).x;
  const float row = std::max(width, text_width);
  const float tick = 0.35F * ImGui::GetFontSize();
  const float height = ImGui::GetFontSize() + tick + 2.0F;
  begin_panel("##scale", lower_right, {1.0F, 1.0F}, {row, height});
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddText({at.x + 0.5F * (row - text_width), at.y}, kInk, text.c_str());
  const float left = at.x + 0.5F * (row - width);
  const float base = at.y + height;
  const ImVec2 points[] = {{left, base - tick}, {left, base}, {left + width, base}, {left + width, base - tick}};
  list->AddPolyline(points, 4, kInk, 0, line_width(1.5F));
  ImGui::End();
}

ImU32 tinted(glm::vec3 color, const glm::vec3& tint, int alpha) {
  color *= tint;
  return IM_COL32(static_cast<int>(color.x), static_cast<int>(color.y), static_cast<int>(color.z), alpha);
}

void shaded_text(ImDrawList* list, ImVec2 at, const char* text, ImU32 ink) {
  for (const ImVec2 off : {ImVec2(1, 0), ImVec2(-1, 0), ImVec2(0, 1), ImVec2(0, -1)}) {
    list->AddText({at.x + off.x, at.y + off.y}, kShade, text);
  }
  list->AddText(at, ink, text);
}

}  // namespace

void draw_status(const PanelStatus& status, double unit_px) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float gap = margin();
  draw_row("##status", {{status.cursor}, {status.eye}, {status.tiles, true}, {status.frame, true}}, {gap, size.y - gap},
           {0.0F, 1.0F});
  if (status.scale) draw_scale(*status.scale, {size.x - gap, size.y - gap}, unit_px);
  draw_row("##attribution", {{status.attribution, true}}, {size.x - gap, gap}, {1.0F, 0.0F});
  draw_row("##measure", {{status.measure}}, {0.5F * size.x, gap + kUnderFirstRow * ImGui::GetFontSize()}, {0.5F, 0.0F});
  std::string told = status.job;
  if (!told.empty() && !status.message.empty()) told += "\n";
  draw_paragraph(told + status.message, {0.5F * size.x, size.y - kFootOfMessage * ImGui::GetFontSize()});
}

void draw_help() {
  constexpr float kAiry = 1.45F, kRoomForHelp = 0.94F;
  const ImVec2 size = ImGui::GetIO().DisplaySize, padding = ImGui::GetStyle().WindowPadding;
  const float rows = float(std::size(kHelp));
  float keys = 0.0F, whats = 0.0F;
  for (const auto& [key, what] : kHelp) {
    keys = std::max(keys, ImGui::CalcTextSize(key).x);
    whats = std::max(whats, ImGui::CalcTextSize(what).x);
  }
  const float gap = 1.8F * ImGui::GetFontSize();
  const ImVec2 room{kRoomForHelp * size.x - 2.0F * padding.x, kRoomForHelp * size.y - 2.0F * padding.y};
  // A small window shows the whole list in small letters.
  const float scale = std::min({1.0F, room.x / (keys + gap + whats), room.y / (rows * ImGui::GetFontSize())});
  const float text = scale * ImGui::GetFontSize(), second = scale * (keys + gap);
  const float line = std::clamp(room.y / rows, text, kAiry * text);
  ImGui::SetNextWindowBgAlpha(0.9F);
  begin_panel("##help", {0.5F * size.x, 0.5F * size.y}, {0.5F, 0.5F}, {second + scale * whats, line * rows});
  ImGui::SetWindowFontScale(scale);
  ImVec2 at = ImGui::GetCursorPos();
  at.y += 0.5F * (line - text);
  for (const auto& [key, what] : kHelp) {
    ImGui::SetCursorPos(at);
    draw_text({key});
    ImGui::SetCursorPos({at.x + second, at.y});
    draw_text({what, true});
    at.y += line;
  }
  ImGui::End();
}

void draw_graticule(const Graticule& graticule, const GraticulePart& part, double unit_px) {
  ImDrawList* list = ImGui::GetBackgroundDrawList();
  const glm::dvec2 corner(part.left_px, 0);
  list->PushClipRect(to_ui(corner, unit_px),
                     to_ui(corner + glm::dvec2(part.size.width_px, part.size.height_px), unit_px));
  std::vector<ImVec2> points;
  for (const GraticuleLine& line : graticule.lines) {
    points.clear();
    for (const glm::dvec2 px : line.points_px) points.push_back(to_ui(corner + px, unit_px));
    const ImU32 colour =
        line.principal ? tinted({255, 226, 150}, part.tint, 190) : tinted(glm::vec3(255.0F), part.tint, 105);
    list->AddPolyline(points.data(), static_cast<int>(points.size()), colour, 0,
                      line_width(line.principal ? 1.6F : 1.0F));
  }
  for (const GraticuleLabel& label : graticule.labels) {
    const ImVec2 size = ImGui::CalcTextSize(label.text.c_str());
    const ImVec2 at = to_ui(corner + label.at_px, unit_px);
    shaded_text(
        list, {at.x - static_cast<float>(label.anchor.x) * size.x, at.y - static_cast<float>(label.anchor.y) * size.y},
        label.text.c_str(), tinted({232, 240, 248}, part.tint, 255));
  }
  list->PopClipRect();
}

}  // namespace terrella
