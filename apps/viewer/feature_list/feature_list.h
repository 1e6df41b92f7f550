#pragma once

#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "apps/open_scene/listed_features.h"
#include "apps/viewer/feature_list/feature_filter.h"
#include "apps/viewer/feature_list/feature_list_panel.h"
#include "apps/viewer/feature_list/feature_table.h"
#include "apps/viewer/parts/part.h"

namespace terrella {

/// A layer of objects, as its list shows it.
struct ListedLayer {
  LayerId id = LayerId::none;
  std::string name = {};
  std::shared_ptr<const std::vector<ListedFeature>> features = {};  ///< in ascending order of ids
};

/// Requests of the list to the other parts of the window.
struct FeatureListAsks {
  std::function<bool(LayerId)> has_layer;                     ///< false once the layer is removed
  std::function<ObjectId(LayerId)> chosen;                    ///< the layer's object with a balloon; none: no object
  std::function<void(LayerId, const ListedFeature&)> choose;  ///< opens the balloon of a feature
  std::function<void()> fly;                                  ///< flies to the object with the balloon
};

/// The list of a layer's features: a filter, a table, and the way to each of them. Owns the panel. thread: main
class FeatureList : public Panel {
 public:
  FeatureList(const ViewerContext& context, FeatureListAsks asks) : Panel(context, "Objects"), asks_(std::move(asks)) {}

  /// Opens the list of a layer, without a filter.
  void open(ListedLayer layer);

  void draw(float foot) override;
  void take_keyboard() override;
  [[nodiscard]] std::string job() const override;
  [[nodiscard]] bool changed() const override;

 private:
  /// A value that a worker makes, and the way to stop the worker.
  template <class Value>
  struct Work {
    std::stop_source stop;
    std::future<Value> value;
    void cancel() {
      stop.request_stop();
      value = {};
    }
  };

  void draw_open(float foot) override;
  void toggled() override;
  void read_features();
  void read_field(const std::string& field);
  void take_work();
  void search_again();
  [[nodiscard]] const SortOrder& order() const;
  [[nodiscard]] std::optional<std::uint32_t> selected() const;
  void answer(const ListWish& wish);
  void move_by(int step);
  void enter();
  void choose(std::uint32_t row);

  FeatureListAsks asks_;
  ListedLayer layer_;
  Work<FeatureTable> reading_;
  Work<FieldColumn> reading_field_;
  std::optional<FeatureTable> table_;
  std::optional<FieldColumn> column_;  ///< values of `field_`
  std::string field_;                  ///< empty: none
  ListSort sort_;
  std::string text_;  ///< the filter's
  FeatureFilter filter_;
  int frames_ = 0;       ///< frames still to draw: Dear ImGui fits a table to its rows one frame later
  bool reveal_ = false;  ///< the next frame scrolls to the selected row
};

}  // namespace terrella
