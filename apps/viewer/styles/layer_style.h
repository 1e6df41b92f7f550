#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/viewer/styles/style_choice.h"
#include "base/result.h"
#include "globe/features/shown_features.h"
#include "globe/globe.h"
#include "streaming/objects/classes/layer_features.h"

namespace terrella {

/// The style of one layer of objects in the window. thread: main for every call
class LayerStyle {
 public:
  /// `features` of the layer, as layer_features() returns them; at least one. `drawn`, the style that they have now.
  LayerStyle(std::shared_ptr<const LayerFeatures> features, FeatureStyle drawn);

  /// Reads the fields on a worker, once; `wake_up` is called there at the end.
  void read_fields(const std::function<void()>& wake_up);
  /// The layer's fields; null until they have come.
  [[nodiscard]] const std::vector<FieldValues>* fields() const;
  /// Tells if the panel of this frame waits for the fields.
  void set_waiting(bool waits) { waiting_ = waits; }
  /// True if the panel waits for fields that have come.
  [[nodiscard]] bool has_news() const { return waiting_ && fields() != nullptr; }

  /// The choice that the layer is drawn in.
  [[nodiscard]] const StyleChoice& choice() const { return drawn_.choice; }
  /// Wishes another choice, which take_wish() tells once.
  void wish(StyleChoice choice) { wish_ = std::move(choice); }
  [[nodiscard]] std::optional<StyleChoice> take_wish() { return std::exchange(wish_, {}); }
  /// Wishes that the style is saved, which take_save_wish() tells once.
  void wish_to_save() { save_wish_ = true; }
  [[nodiscard]] bool take_save_wish() { return std::exchange(save_wish_, false); }

  /// Draws the features of a layer in a choice, without reading their file.
  Status apply(Globe& globe, LayerId layer, const StyleChoice& choice);

  /// The drawn style, as restore() takes it. States with the same number are the same.
  struct Drawn {
    std::uint64_t number = 0;  ///< another one for each style that was ever drawn
    StyleChoice choice = {};
    FeatureStyle style = {};
    std::optional<ClassStyle> classes = {};
  };
  [[nodiscard]] const Drawn& drawn() const { return drawn_; }
  /// Draws the features of a layer in a style that they had before.
  Status restore(Globe& globe, LayerId layer, const Drawn& drawn);
  /// Shows the features of the layer that the drawn style shows at the globe's time, from this far. Call it before each
  /// frame, for the same layer.
  Status follow(Globe& globe, LayerId layer, Viewport picture);

  /// The drawn classes; nullopt for a style without classes.
  [[nodiscard]] const std::optional<ClassStyle>& classes() const { return drawn_.classes; }
  /// True if the layer is drawn in the style that it was read in.
  [[nodiscard]] bool is_own() const { return text() == style_text(features_->style); }
  /// The drawn style, as --object-style reads it.
  [[nodiscard]] std::string text() const { return style_text(drawn_.style); }

 private:
  std::shared_ptr<const LayerFeatures> features_;
  std::shared_future<std::vector<FieldValues>> fields_;
  bool waiting_ = false;
  Drawn drawn_;
  std::optional<ShownFeatures> shown_;
  std::uint64_t shown_number_ = 0;  ///< number of the style of `shown_`
  std::optional<StyleChoice> wish_;
  bool save_wish_ = false;
};

/// Returns the style of a layer that is drawn in `drawn`; null if the layer has no features that can be edited.
[[nodiscard]] std::shared_ptr<LayerStyle> style_of_layer(LayerFeatures features, FeatureStyle drawn = {});

/// Saves the drawn style in a new file of the working folder, and returns the file. The error names the file.
[[nodiscard]] Result<std::filesystem::path> save_style(const LayerStyle& style);

}  // namespace terrella
