#include "apps/viewer/styles/style_panel.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "apps/viewer/panels/panel_fonts.h"
#include "apps/viewer/panels/panel_items.h"
#include "streaming/objects/classes/class_breaks.h"
#include "view/color_map.h"

namespace terrella {
namespace {

constexpr const char* kOwn = "As in the file";

std::string shown_field(const FieldValues& field) { return field.name + (field.is_numeric ? "" : " (text)"); }

void draw_fields(const std::vector<FieldValues>& fields, StyleChoice& choice) {
  const FieldValues* chosen = chosen_field(choice, fields);
  const std::string shown = chosen != nullptr ? panel_text(shown_field(*chosen)) : kOwn;
  if (!ImGui::BeginCombo("Field", shown.c_str())) return tip("Colours the features by the values of this field.");
  if (ImGui::Selectable(kOwn, choice.field.empty())) choice.field.clear();
  for (std::size_t k = 0; k < fields.size(); ++k) {
    ImGui::PushID(static_cast<int>(k));
    if (ImGui::Selectable(panel_text(shown_field(fields[k])).c_str(), &fields[k] == chosen)) {
      const bool from_texts = chosen != nullptr && !chosen->is_numeric;
      if (from_texts && fields[k].is_numeric) choice.kind = StyleChoice().kind;
      choice.field = fields[k].name;
      choice = suited(choice, fields[k]);
    }
    ImGui::PopID();
  }
  ImGui::EndCombo();
}

void draw_kinds(const FieldValues& field, StyleChoice& choice) {
  if (!field.is_numeric) return;
  choose("Classes by", choice.kind, kStyleClasses);
  tip("Equal intervals have the same width, quantiles the same number of features. Natural breaks lie between groups "
      "of values. Categories show the most frequent values.");
}

void draw_count(StyleChoice& choice) {
  const char* name = choice.kind == StyleClasses::categories ? "Categories" : "Classes";
  ImGui::SliderInt(name, &choice.classes, kLeastStyleClasses, kMostClasses, "%d", ImGuiSliderFlags_AlwaysClamp);
  tip("Fewer are drawn if the field has fewer different values.");
}

void draw_map(StyleChoice& choice) {
  if (ImGui::BeginCombo("Colours", choice.colormap.c_str())) {
    for (const std::string_view name : color_map_names()) {
      const std::string text(name);
      if (ImGui::Selectable(text.c_str(), choice.colormap == text)) choice.colormap = text;
    }
    ImGui::EndCombo();
  }
  ImGui::Checkbox("Reversed", &choice.reversed);
  tip("The last colour comes first.");
}

void draw_missing(const FieldValues& field) {
  if (field.missing > 0) write_wrapped(fmt::format("Features without a value: {}", field.missing), true);
}

void draw_buttons(LayerStyle& style, StyleChoice& choice) {
  if (ImGui::Button("Save style")) style.wish_to_save();
  tip("Saves a JSON file in the folder where the program was started. --object-style reads the file.");
  ImGui::SameLine();
  if (ImGui::Button(kOwn)) choice.field.clear();
  tip("Gives the features their own colours back.");
}

}  // namespace

void draw_style(LayerStyle& style) {
  if (!ImGui::TreeNodeEx("Style", ImGuiTreeNodeFlags_SpanAvailWidth)) {
    return tip("Colours the features by one of their fields.");
  }
  style.read_fields([] { glfwPostEmptyEvent(); });
  const std::vector<FieldValues>* fields = style.fields();
  style.set_waiting(fields == nullptr);
  if (fields == nullptr) write_wrapped("Reading the fields", true);
  if (fields != nullptr && fields->empty()) write_wrapped("The features have no fields.", true);
  if (fields != nullptr && !fields->empty()) {
    StyleChoice choice = style.choice();
    draw_fields(*fields, choice);
    if (const FieldValues* field = chosen_field(choice, *fields); field != nullptr) {
      draw_kinds(*field, choice);
      draw_count(choice);
      draw_map(choice);
      draw_missing(*field);
      draw_buttons(style, choice);
    }
    if (choice != style.choice()) style.wish(choice);
  }
  ImGui::TreePop();
}

}  // namespace terrella
