#include "apps/viewer/styles/style_choice.h"

#include <algorithm>

#include "streaming/objects/classes/class_breaks.h"
#include "view/color_map.h"

namespace terrella {
namespace {

void use_categories(ClassStyle& style, const StyleChoice& choice, const FieldValues& field) {
  const std::size_t count = std::min(static_cast<std::size_t>(choice.classes), field.categories.size());
  style.categories.reserve(count);
  for (std::size_t k = 0; k < count; ++k) style.categories.push_back(field.categories[k].value);
  style.colors = class_colors(choice.colormap, count, choice.reversed);
  style.rest = kRestColor;
}

void use_numbers(ClassStyle& style, const StyleChoice& choice, const FieldValues& field) {
  ClassBreaks breaks = class_breaks(field.numbers, static_cast<ClassKind>(choice.kind), choice.classes);
  if (breaks.counts.empty()) return;
  style.colors = class_colors(choice.colormap, breaks.counts.size(), choice.reversed);
  style.stops = std::move(breaks.stops);
  if (field.missing > 0) style.rest = kRestColor;
}

}  // namespace

std::vector<ObjectColor> class_colors(const std::string& colormap, std::size_t count, bool reversed) {
  const ColorMap map = named_color_map(colormap).value_or(ColorMap{});
  std::vector<ObjectColor> colors;
  colors.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    const double at = count > 1 ? static_cast<double>(k) / static_cast<double>(count - 1) : 0.5;
    const Rgba8 color = color_at(map, at);
    colors.push_back({color.r, color.g, color.b});
  }
  if (reversed) std::ranges::reverse(colors);
  return colors;
}

const FieldValues* chosen_field(const StyleChoice& choice, std::span<const FieldValues> fields) {
  const auto found = std::ranges::find(fields, choice.field, &FieldValues::name);
  return found == fields.end() ? nullptr : &*found;
}

StyleChoice suited(StyleChoice choice, const FieldValues& field) {
  if (!field.is_numeric) choice.kind = StyleClasses::categories;
  return choice;
}

ClassStyle style_of(const StyleChoice& choice, const FieldValues& field, const StyleTargets& targets) {
  ClassStyle style{.field = field.name, .targets = targets};
  if (suited(choice, field).kind == StyleClasses::categories) {
    use_categories(style, choice, field);
  } else {
    use_numbers(style, choice, field);
  }
  return style;
}

}  // namespace terrella
