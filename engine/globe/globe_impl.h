#pragma once

#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <unordered_map>
#include <vector>

#include "globe/experiments.h"
#include "globe/globe.h"
#include "globe/ground_pictures.h"
#include "globe/height_layer.h"
#include "globe/image_layer.h"
#include "globe/object_layer.h"
#include "globe/view_impl.h"
#include "render/globe_renderer.h"
#include "tiles/arrival_bell.h"

namespace terrella {

/// The state of a Globe. Functions of Globe call may_call() or may_draw() first. thread: main
struct Globe::Impl {
  explicit Impl(const GlobeOptions& o) : options(o) {}
  ~Impl() { end_views(); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  /// Fails if a call comes from another thread than the globe's. Reports the misuse by an assertion.
  [[nodiscard]] Status may_call(const char* call) const;
  /// The same for a call that uses OpenGL; also fails without the globe's context. Sets the GL state that drawing
  /// depends on.
  [[nodiscard]] Result<GlScope> may_draw(const char* call) const;
  /// The main view.
  [[nodiscard]] GlobeView::Impl& first() const { return *main->impl_; }
  /// Ends the views, while the context is current. Views that the application holds stay as empty shells.
  void end_views();

  // Layers.
  [[nodiscard]] ImageLayer* image(LayerId id) const;  ///< null if there is none
  [[nodiscard]] ObjectLayer* object(LayerId id);
  [[nodiscard]] LayerId next_id() { return static_cast<LayerId>(++last_id); }
  [[nodiscard]] ViewId next_view() { return static_cast<ViewId>(++last_view); }
  [[nodiscard]] LayerSetup setup() { return {options, experiments.mapping, bell}; }
  /// All image layers, and those that take the place of one when their tiles have come.
  [[nodiscard]] std::vector<ImageLayer*> all_images() const;
  void share_gpu();
  /// Makes an image layer, which takes its share of the memory. Fails as Globe::add_imagery() does.
  [[nodiscard]] Result<std::unique_ptr<ImageLayer>> make_image(const char* call, LayerId id,
                                                               std::shared_ptr<TileSource> source,
                                                               const ImageLook& look);
  void forget_views_of(const ImageLayer& image);  ///< in the stacks of all views
  enum class Coming { all, ahead };               ///< ahead: of a time that nobody has asked to see yet
  void drop_coming(LayerId id, Coming which);     ///< the layers that would take the place of this one
  void put_in_place();                            ///< puts layers in place whose tiles have come
  // Instants of layers (globe_times.cpp).
  [[nodiscard]] Status go_to_time(ImageLayer& shown, UtcTime time);
  [[nodiscard]] Status load_ahead(const ImageLayer& shown, UtcTime time);
  /// The layer that takes the place of this one last; null: none, or one that only fills its cache.
  [[nodiscard]] ImageLayer* newest_coming(const ImageLayer& shown) const;
  /// True if a layer that is not in place waits for tiles, and is wanted now or next.
  [[nodiscard]] bool is_awaited(const ImageLayer& layer) const {
    return !is_late(layer) && !(layer.turn().is_ahead && layer.is_ready());
  }
  /// True if a layer that is not in place will not take its place, because a later one did.
  [[nodiscard]] bool is_late(const ImageLayer& layer) const;
  void drop_late(LayerId id);  ///< drops all coming layers but the latest three
  [[nodiscard]] Status ask_for_time(const ImageLayer& shown, UtcTime time, const SourceTurn& turn);
  /// The layer of a step that is on its way to the place of this one; null: none.
  [[nodiscard]] ImageLayer* coming_at(const ImageLayer& shown, UtcTime step) const;
  /// Gives the turn to the layer of a step that is on its way already; else asks for the step.
  [[nodiscard]] Status ask_for_step(const ImageLayer& shown, UtcTime step, const SourceTurn& turn);
  /// Fails if the layer follows the globe's time.
  [[nodiscard]] Status has_own_clock(const char* call, const ImageLayer& layer) const;
  void note_missing(const ImageLayer& lacking, UtcTime instant);
  void note_missing(LayerId layer, UtcTime instant, std::string why);
  /// Names the instant of a layer without a tile in view, and asks for an earlier one.
  void step_back(const ImageLayer& lacking);
  // The globe's time as the clock of layers (globe_clock.cpp).
  [[nodiscard]] std::optional<UtcTime> layer_clock() const;
  [[nodiscard]] bool follows_clock(const ImageLayer& layer) const;
  void follow_clock();  ///< lets layers whose look says so follow the globe's time. Call it before a frame
  void follow_clock(LayerId id);
  void follow_next(const ImageLayer& shown, std::optional<UtcTime> next);
  struct Fade {
    ImageLayer* next = nullptr;  ///< fades in; null: none
    double share = 0.0;          ///< part of the time from the shown instant to that of `next`
  };
  [[nodiscard]] Fade fade_of(const ImageLayer& shown) const;
  /// The coming layer that fades in over this one in the next frame, and both get their shares; null: none.
  [[nodiscard]] ImageLayer* fade_over(ImageLayer& shown);
  Status show_layers();
  void take_cuts();      ///< takes the objects that workers have cut, and lets objects follow the ground
  void follow_ground();  ///< takes changes of what lies on the ground
  [[nodiscard]] std::size_t ground_bytes() const;  ///< budget of the pictures of the ground
  [[nodiscard]] bool has_ground() const { return ground_pictures && !ground_pictures->empty(); }
  [[nodiscard]] std::shared_ptr<const Relief> shared_relief() const { return heights ? heights->relief() : nullptr; }
  [[nodiscard]] Relief* relief() const { return heights ? heights->relief().get() : nullptr; }

  // A frame of any view.
  std::size_t take_finished();
  [[nodiscard]] bool has_night() const { return almanac && options.time && !options.unlit; }
  [[nodiscard]] PictureSides sides() const { return {has_night(), options.surface.swipe.has_value()}; }
  [[nodiscard]] Ground ground() const { return {options.body.ellipsoid, heights ? heights->relief() : nullptr}; }
  void restore_detail();  ///< restores the full detail of all views

  const std::thread::id thread = std::this_thread::get_id();
  GlobeOptions options;
  Experiments experiments;
  std::unique_ptr<GlobeView> main;
  std::vector<GlobeView::Impl*> views;  ///< the main view first
  std::uint64_t last_view = 0;
  std::shared_ptr<ArrivalBell> bell = std::make_shared<ArrivalBell>();  ///< rung when a tile of any kind has arrived
  std::unique_ptr<HeightLayer> heights;                                 ///< none: the ellipsoid
  std::uint64_t last_id = 0;
  std::vector<std::unique_ptr<ImageLayer>> images;  ///< lowest first
  std::vector<std::unique_ptr<ImageLayer>> coming;  ///< each takes the place of the image layer with its id
  std::unique_ptr<ImageLayer> plain;                ///< made if the lowest image layer is not opaque
  std::vector<ObjectLayer> objects;
  std::size_t objects_cut = 0;  ///< objects cut since the last frame
  std::unique_ptr<GlobeRenderer> renderer;
  std::unique_ptr<GroundPictures> ground_pictures;  ///< made when something lies on the ground
  std::optional<Almanac> almanac;                   ///< set if there is a sky or a time
  bool sky_on = false;
  std::uint64_t frame = 0;  ///< counts the frames of all views
  bool changed = true;      ///< something that all views show has changed since the last frame of any view
  std::deque<MissingTile> missing, missing_heights;
  std::deque<MissingInstant> missing_instants;
  std::uint64_t turns = 0;  ///< sources asked for
  /// A layer that follows the globe's time.
  struct Following {
    std::shared_ptr<const TimeSteps> steps;
    std::optional<UtcTime> step{}, next{};  ///< asked for; next: to fade in
    bool fades = false;                     ///< the tiles of next have come
    bool has_failed = false;                ///< the source of next cannot be made
  };
  std::unordered_map<LayerId, Following> following;
};

/// Misuse: an assertion, and an error if assertions are off. thread: any
[[nodiscard]] Error misuse(const char* call, const char* why);
inline constexpr const char* kOtherThread = "called from another thread than the one that the globe was made on";
/// The error of a call with a value out of range: the call's name, then `wrong`. thread: any
[[nodiscard]] inline Error refusal(const char* call, const Status& wrong) {
  return Error{std::string(call) + ": " + wrong.error().message};
}
/// Returns the error of a call that names a layer which the globe does not have. thread: any
[[nodiscard]] Error no_layer(const char* call, const char* kind, LayerId id);

/// Moves the element at `from` so that `position` others are before it, or to the end.
template <class T>
void move_to(std::vector<T>& all, typename std::vector<T>::iterator from, std::size_t position) {
  const auto to = all.begin() + static_cast<std::ptrdiff_t>(std::min(position, all.size() - 1));
  from < to ? std::rotate(from, from + 1, to + 1) : std::rotate(to, from, from + 1);
}

}  // namespace terrella
