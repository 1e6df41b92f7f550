#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <utility>

#include "apps/open_scene/listed_features.h"
#include "apps/viewer/balloon/balloon_panel.h"
#include "apps/viewer/balloon/link_opener.h"
#include "apps/viewer/balloon/pointer_rest.h"
#include "apps/viewer/parts/part.h"

namespace terrella {

/// Shows the name and the fields of one object beside it, and the name of the object under the pointer. The object is
/// drawn as selected, if it has an id. thread: main
class Balloon : public Part {
 public:
  /// Name of a shown layer; nullopt for other layers.
  using LayerName = std::function<std::optional<std::string>(LayerId)>;
  Balloon(const ViewerContext& context, LayerName layer_name) : Part(context), layer_name_(std::move(layer_name)) {}

  /// Opens the balloon for the object under a pixel of the framebuffer. Closes it beside objects, or on its own object.
  void click(glm::dvec2 at_px);
  /// The same, with the keyboard, for the object in the middle of the picture or near it.
  void open_in_middle();
  /// Opens the balloon of a feature, wherever it is. If the feature is not in view, a message says so.
  void choose(LayerId layer, const ListedFeature& feature);
  /// Flies to the object of the balloon: as by a double click on it, or over it if it is not in view.
  void fly_there() const;
  /// Id of the object of the balloon, if it is one of the layer.
  [[nodiscard]] ObjectId chosen_of(LayerId layer) const;
  /// True while the object of the balloon is in view, from the click on.
  [[nodiscard]] bool is_in_view() const { return in_view_; }
  /// Draws the balloon where no panel of this frame is, while its object is in view; and the name of the object at
  /// `pointer_px`, once the pointer has rested there. Call this after the frame's panels. `pointer_px`: pixel of the
  /// framebuffer; nullopt while the pointer is elsewhere or busy.
  void draw_over(const View& view, std::optional<glm::dvec2> pointer_px, float foot);
  /// Seconds until the pointer has rested, at most `most_s`.
  [[nodiscard]] double seconds_left(double most_s) const;

  [[nodiscard]] const char* panel() const override { return with_keyboard_ ? kBalloon : nullptr; }
  void take_keyboard() override { keyboard_due_ = true; }
  [[nodiscard]] bool changed() const override;
  bool close() override;

 private:
  struct Chosen {
    LayerId layer;
    PickedObject object;
    Geodetic place;  ///< the height counts from the ground, which changes as heights arrive
    BalloonTexts texts;
  };
  [[nodiscard]] static Chosen described(LayerId layer, PickedObject object, const Geodetic& place,
                                        std::string layer_name);
  [[nodiscard]] std::optional<Chosen> find(glm::dvec2 at_px) const;
  [[nodiscard]] bool is_chosen(const Chosen& other) const;
  void choose(std::optional<Chosen> chosen);
  void mark(bool selected) const;
  [[nodiscard]] Geodetic chosen_place() const;
  [[nodiscard]] std::optional<glm::dvec2> place_px(const View& view) const;
  void tell(const std::string& text);
  void draw_chosen(const View& view, float foot);
  void draw_name(std::optional<glm::dvec2> pointer_px);

  LayerName layer_name_;
  std::optional<Chosen> chosen_;
  bool just_chosen_ = false;
  bool in_view_ = false;
  std::optional<UiBox> box_;    ///< the balloon in the last frame; nullopt: not drawn
  int frames_ = 0;              ///< frames still to draw: Dear ImGui fits a panel to its contents one frame later
  bool with_keyboard_ = false;  ///< opened by keyboard, and drawn in each frame since then
  bool keyboard_due_ = false;   ///< the next frame gives the balloon the keyboard
  PointerRest pointer_;
  std::string name_;  ///< name of the object under the resting pointer; empty: none
  LinkOpener links_;
};

}  // namespace terrella
