#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>

#include "streaming/objects/feature_style.h"
#include "streaming/objects/geojson_objects.h"
#include "streaming/objects/icon_shelf.h"
#include "streaming/objects/model_shelf.h"

namespace terrella {

/// Makes objects of the features of a file, one feature after the other. thread: one at a time
class FeatureTaker {
 public:
  /// `where` begins each complaint. Models and icons are read from `folder`. `file` must outlive the taker.
  FeatureTaker(std::string where, const std::filesystem::path& folder, ObjectId first, ObjectFile& file);

  /// Adds the objects of a GeoJSON feature, or a complaint. `index`: its number in the file, counted from 0.
  void take(const nlohmann::json& feature, std::size_t index);
  /// Adds a complaint, or counts it if there are many.
  void complain_of(const std::string& what);
  /// Draws further features in a style.
  void set_style(FeatureStyle style) { style_ = std::move(style); }
  /// Reads the icons of further features otherwise than from the folder.
  void set_icon_reader(IconShelf::ReadPicture read) { icons_ = IconShelf(std::move(read)); }
  /// Makes further features earthquakes of a catalogue.
  void expect_quakes() { quakes_ = true; }

 private:
  void set_icon(ObjectStyle& style, const Complain& complain);

  std::string where_;
  ModelShelf models_;
  IconShelf icons_;
  ObjectId first_;
  ObjectFile& file_;
  FeatureStyle style_;
  bool quakes_ = false;
};

}  // namespace terrella
