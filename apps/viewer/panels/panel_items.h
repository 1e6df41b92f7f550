#pragma once

#include <imgui.h>

#include <array>
#include <cstddef>

namespace terrella {

// What panels are made of; between Ui::begin_frame() and Ui::end_frame(). thread: main

inline constexpr ImGuiWindowFlags kPanelWindow = ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                                                 ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings;

/// Shown while the item before is under the cursor, or has the keyboard and a key has moved that on.
void tip(const char* text);
/// The head of a group, with a line under it.
void group(const char* name);
void slide(const char* name, double& value, double from, double to, const char* format,
           ImGuiSliderFlags flags = ImGuiSliderFlags_AlwaysClamp);

template <class Choice, std::size_t kCount>
void choose(const char* name, Choice& choice, const std::array<const char*, kCount>& words) {
  int index = static_cast<int>(choice);
  if (ImGui::Combo(name, &index, words.data(), static_cast<int>(kCount))) choice = static_cast<Choice>(index);
}

}  // namespace terrella
