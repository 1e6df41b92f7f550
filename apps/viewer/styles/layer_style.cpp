#include "apps/viewer/styles/layer_style.h"

#include <chrono>
#include <span>
#include <system_error>
#include <utility>

#include "apps/process/write_file.h"
#include "apps/viewer/tools/screenshot.h"

namespace terrella {
namespace {

/// Leaves out the row of other features in the legend if there are none.
void leave_out_rest(ClassStyle& classes, const FieldValues& field) {
  const bool all = field.missing == 0 && classes.categories.size() == field.categories.size();
  if (!classes.categories.empty() && all) classes.rest.reset();
}

std::uint64_t next_number() {
  static std::uint64_t last = 0;
  return ++last;
}

}  // namespace

LayerStyle::LayerStyle(std::shared_ptr<const LayerFeatures> features, FeatureStyle drawn)
    : features_(std::move(features)), drawn_{.number = next_number(), .style = std::move(drawn)} {
  drawn_.classes = classes_of(drawn_.style);
  if (drawn_.classes && !is_own()) drawn_.choice.field = drawn_.classes->field;
}

void LayerStyle::read_fields(const std::function<void()>& wake_up) {
  if (fields_.valid()) return;
  fields_ = std::async(std::launch::async, [features = features_, wake_up] {
              std::vector<FieldValues> fields = fields_of(features->parts);
              wake_up();
              return fields;
            }).share();
}

const std::vector<FieldValues>* LayerStyle::fields() const {
  const bool have_come = fields_.valid() && fields_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  return have_come ? &fields_.get() : nullptr;
}

Status LayerStyle::apply(Globe& globe, LayerId layer, const StyleChoice& choice) {
  const std::vector<FieldValues>* all = fields();
  const FieldValues* field = all != nullptr ? chosen_field(choice, *all) : nullptr;
  if (field == nullptr) {
    if (Status done = globe.edit_objects(layer, features_->own); !done) return done;
    drawn_ = {next_number(), choice, features_->style, classes_of(features_->style)};
    drawn_.choice.field.clear();
    return Done{};
  }
  ClassStyle classes = style_of(choice, *field, targets_of(features_->parts));
  Result<FeatureStyle> style = overlaid(features_->style, style_text(classes));
  if (!style) return style.error();
  if (Status done = globe.edit_objects(layer, restyled(features_->parts, *style)); !done) return done;
  leave_out_rest(classes, *field);
  drawn_ = {next_number(), choice, *std::move(style), std::move(classes)};
  return Done{};
}

Status LayerStyle::restore(Globe& globe, LayerId layer, const Drawn& drawn) {
  const bool own = style_text(drawn.style) == style_text(features_->style);
  if (Status done = globe.edit_objects(layer, own ? features_->own : restyled(features_->parts, drawn.style)); !done)
    return done;
  drawn_ = drawn;
  return Done{};
}

Status LayerStyle::follow(Globe& globe, LayerId layer, Viewport picture) {
  if (std::exchange(shown_number_, drawn_.number) != drawn_.number) {
    if (shown_) {
      if (Status ended = shown_->end(globe); !ended) return ended;
    }
    Result<ShownFeatures> made = ShownFeatures::make(layer, shown_when(features_->parts, drawn_.style));
    if (!made) return made.error();
    shown_ = *std::move(made);
  }
  return shown_->update(globe, picture);
}

std::shared_ptr<LayerStyle> style_of_layer(LayerFeatures features, FeatureStyle drawn) {
  if (features.parts.empty()) return nullptr;
  return std::make_shared<LayerStyle>(std::make_shared<const LayerFeatures>(std::move(features)), std::move(drawn));
}

Result<std::filesystem::path> save_style(const LayerStyle& style) {
  std::error_code unknown;
  const auto file =
      new_file_name(std::filesystem::current_path(unknown), std::chrono::system_clock::now(), "-style.json");
  const std::string text = style.text();
  if (const Status saved = write_file(file, std::as_bytes(std::span(text))); !saved) return saved.error();
  return file;
}

}  // namespace terrella
