#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include "globe/globe.h"
#include "render/objects/layer_buffers.h"
#include "surface/relief.h"
#include "tiles/arrival_bell.h"

namespace terrella {

/// Features of edits that the layer does not have, or that have not the one line or area that the edit needs.
struct UnknownObjects {
  std::vector<ObjectId> ids, without_line, without_shape;
};

/// An object layer of a globe. Large cuts are made by workers. A new scene is drawn once its cuts are there; the
/// earlier scene is drawn until then. thread: main
class ObjectLayer {
 public:
  ObjectLayer(LayerId layer, bool is_shown, std::shared_ptr<ArrivalBell> rung)
      : id(layer), shown(is_shown), bell_(std::move(rung)) {}

  LayerId id;
  bool shown;
  std::string attribution = {};

  /// Replaces the scene. Returns the number of objects that were cut at once.
  std::size_t set(ObjectScene scene, const Ellipsoid& ellipsoid, std::shared_ptr<const Relief> relief);
  /// Moves what stands on the ground to its height now. No relief: the ellipsoid. Returns the number of objects that
  /// were cut at once.
  std::size_t follow(const Ellipsoid& ellipsoid, const std::shared_ptr<const Relief>& relief);
  /// Makes edits. Returns the number of objects that were cut at once. What grows is cut by take_cuts(), once for all
  /// edits before a frame.
  std::size_t edit(ObjectEdits edits, UnknownObjects& unknown);
  void set_opacity(double opacity);
  [[nodiscard]] double opacity() const { return opacity_; }

  /// Takes the cuts that workers have finished. Returns the number of objects.
  std::size_t take_cuts();
  [[nodiscard]] bool has_news() const;  ///< a worker has finished
  [[nodiscard]] bool waits() const;     ///< the layer is drawn, and a worker has not finished

  /// The objects that edits change: those of the last scene that was set.
  [[nodiscard]] const LayerObjects* newest() const { return &(next_ ? next_ : now_)->objects; }

  [[nodiscard]] bool is_drawn() const { return shown && opacity_ > 0.0 && now_ && !now_->objects.empty(); }
  /// The version that is drawn. Call it only if is_drawn().
  [[nodiscard]] DrawnLayer drawn() const { return {&now_->objects, &now_->buffers}; }
  /// True once after another scene is drawn than before.
  [[nodiscard]] bool take_replaced() { return std::exchange(replaced_, false); }

 private:
  /// A worker's job. The destructor stops the job and does not wait for it.
  class Cutting {
   public:
    Cutting(CutJob job, const std::shared_ptr<ArrivalBell>& bell);
    ~Cutting();
    Cutting(Cutting&&) = default;
    Cutting& operator=(Cutting&&) = default;
    [[nodiscard]] bool is_done() const { return shared_->done; }
    /// The objects that were cut. Call it once, after is_done(). Throws what the job threw.
    [[nodiscard]] CutObjects take();
    [[nodiscard]] std::size_t size() const { return size_; }

   private:
    struct Shared {
      std::atomic<bool> stop = false, done = false;
      CutObjects cut;
      std::exception_ptr fault;
    };
    std::shared_ptr<Shared> shared_ = std::make_shared<Shared>();
    std::size_t size_;
    std::future<void> worker_;
  };
  /// A scene and its edits.
  struct Version {
    explicit Version(LayerObjects all) : objects(std::move(all)) {}
    LayerObjects objects;
    LayerBuffers buffers = {};
    std::vector<Cutting> cutting = {};
    std::shared_ptr<const Relief> relief = {};  ///< under the objects
    std::uint64_t heights_seen = 0;             ///< Relief::changes_seen()
  };
  std::size_t follow(Version& version, const Ellipsoid& ellipsoid, const std::shared_ptr<const Relief>& relief);
  std::size_t cut(Version& version);
  std::size_t take_cuts(Version& version);

  std::shared_ptr<ArrivalBell> bell_;
  double opacity_ = 1.0;
  ObjectColor selected_color_ = kSelectedColor;
  std::unique_ptr<Version> now_;   ///< version that is drawn
  std::unique_ptr<Version> next_;  ///< version that is drawn next, once it is cut
  bool replaced_ = false;
};

}  // namespace terrella
