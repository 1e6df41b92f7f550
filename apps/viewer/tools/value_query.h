#pragma once

#include <future>
#include <optional>
#include <string>

#include "globe/globe.h"

namespace terrella {

/// Writes a value with all digits that it has: "28.123 °C". A float is written as short as it can be read back.
/// thread: any
[[nodiscard]] std::string value_text(double value, const std::string& unit);

/// Asks a layer of numbers for the value that its source stores at a place, one question at a time. thread: main
class ValueQuery {
 public:
  /// Asks for a place unless it was asked for already, or another question is open.
  void ask(const Globe& globe, LayerId layer, const Geodetic& place);
  /// The answer for a place: the value, "no data", "..." until it comes; empty where the layer has no numbers.
  [[nodiscard]] std::string text(const Geodetic& place, const std::string& unit) const;
  /// Takes an answer that has come. True if it is new.
  bool take();
  /// True if take() would take an answer.
  [[nodiscard]] bool ready() const;

 private:
  std::future<Result<double, TileFailure>> open_;
  [[nodiscard]] bool is_of(const Geodetic& place) const {
    return place_ && place_->lat == place.lat && place_->lon == place.lon;
  }

  std::optional<Geodetic> place_;  ///< place of the last question
  LayerId layer_ = LayerId::none;
  std::optional<Result<double, TileFailure>> answer_;
};

}  // namespace terrella
