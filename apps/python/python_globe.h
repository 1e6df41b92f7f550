#pragma once

#include <fmt/format.h>
#include <pybind11/pybind11.h>

#include <CLI/App.hpp>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/open_scene/options/option_words.h"
#include "apps/process/console.h"
#include "apps/process/stop_signals.h"
#include "apps/program/command_line.h"
#include "apps/program/commands.h"
#include "apps/program/scene_picture.h"
#include "apps/python/arguments.h"
#include "apps/python/bindings.h"
#include "apps/python/gl_thread.h"
#include "apps/python/long_call.h"
#include "streaming/objects/feature_style.h"

// thread: that of Python, for all of this header
namespace terrella {

namespace py = pybind11;

/// The value, or an exception of Python.
template <class T>
T value_or_raise(Result<T> result) {
  if (!result) raise_error(result.error().message);
  return std::move(result).value();
}

/// Features of an object layer, for styles.
struct StyledFeatures {
  std::vector<FeatureParts> parts = {};
  std::size_t count = 0;    ///< all features, drawn or not
  double cluster_px = 0.0;  ///< radius of their clusters; 0: none
};

/// The globe of terrella.render() that stays, with the thread of its context.
class PythonGlobe {
 public:
  PythonGlobe(const py::args& positional, const py::kwargs& keywords) {
    CLI::App app("", "terrella");
    int exit_code = kDone;
    CLI::App& sub = add_render_options(app, command_);
    sub.callback([&] { exit_code = open(); });
    command_.more_objects = true;
    const Said said = run_long(
        [&, words = command_arguments(sub, positional, keywords)] { return run_command_line(app, words, exit_code); });
    try {
      conclude(said);
    } catch (...) {
      close();  // on its thread: no destructor follows
      throw;
    }
  }
  ~PythonGlobe() { close(); }
  PythonGlobe(const PythonGlobe&) = delete;
  PythonGlobe& operator=(const PythonGlobe&) = delete;

  /// The features of object layers, by their numbers.
  [[nodiscard]] std::map<std::uint64_t, StyledFeatures>& features() { return features_; }

  void close() {
    const py::gil_scoped_release others_run;
    thread_.run([this] { picture_.reset(); });
  }

  py::object render() {
    std::optional<Result<Rendered>> rendered;
    const Said said = run_long([&] {
      const StopSignals signals;
      thread_.run([&] { rendered = picture_ ? picture_->draw(camera_) : Result<Rendered>(Error{kClosed}); });
      return kDone;
    });
    conclude(said);
    const Rendered drawn = value_or_raise(*std::move(rendered));
    const int without = drawn.stats.tiles_missing + drawn.stats.tiles_pending + heights_without(drawn.stats);
    if (without > 0 || !drawn.missing_dates.empty()) {
      std::vector<std::string> messages = drawn.missing_dates;
      if (without > 0) messages.push_back(fmt::format("{} tiles are missing", without));
      for (const MissingTile& tile : drawn.missing) messages.push_back("missing: " + name_of(tile));
      conclude({.exit_code = kDoneInPart, .result = {}, .messages = std::move(messages)});
    }
    return to_array(drawn.image);
  }

  /// Calls a function with the globe on its thread, without Python's lock.
  template <class Work>
  auto with_globe(Work work) {
    return with_picture([&work](ScenePicture& picture) { return work(picture.globe()); });
  }

  /// The same with the picture.
  template <class Work>
  auto with_picture(Work work) {
    std::optional<decltype(work(std::declval<ScenePicture&>()))> result;
    {
      const py::gil_scoped_release others_run;
      thread_.run([&] {
        if (picture_) result.emplace(work(*picture_));
      });
    }
    if (!result) raise_error(kClosed);
    return *std::move(result);
  }

  [[nodiscard]] py::tuple camera() const {
    const Camera& c = camera_;
    return py::make_tuple(c.eye.lat.deg(), c.eye.lon.deg(), c.eye.height_m, c.heading.deg(), c.pitch.deg(),
                          c.fov_y.deg());
  }
  void set_camera(const py::object& value) {
    std::string text;
    if (py::isinstance<py::str>(value)) {
      text = value.cast<std::string>();
    } else {
      for (const py::handle part : value) text += (text.empty() ? "" : ",") + std::string(py::str(part));
    }
    const Result<Camera> parsed = parse_camera(text);
    if (!parsed) throw py::value_error(shown_message("camera: " + parsed.error().message));
    camera_ = *parsed;
  }
  [[nodiscard]] Viewport size() const { return command_.scene.size; }

  std::uint64_t add_imagery(const std::filesystem::path& tileset, double opacity) {
    std::uint64_t added = 0;
    const Said said = run_long([&] {
      return thread_.run([&] {
        if (!picture_) return fail("imagery", kClosed);
        const auto layer = picture_->add({.tile_set = tileset.string(), .opacity = opacity});
        if (!layer) return fail("imagery", layer.error().message);
        added = static_cast<std::uint64_t>(*layer);
        return static_cast<int>(kDone);
      });
    });
    conclude(said);
    return added;
  }

 private:
  static constexpr const char* kClosed = "the globe is closed";

  int open() {
    return thread_.run([this] {
      auto opened = ScenePicture::open(command_);
      if (!opened) return fail("render", opened.error().message);
      picture_ = *std::move(opened);
      camera_ = picture_->first_camera();
      return static_cast<int>(picture_->has_all_objects() ? kDone : kDoneInPart);
    });
  }

  RenderCommand command_;
  Camera camera_;
  GlThread thread_;
  std::unique_ptr<ScenePicture> picture_;  // lives on the thread
  std::map<std::uint64_t, StyledFeatures> features_;
};

/// Changes the look of an image layer.
template <class Change>
void change_look(PythonGlobe& self, std::uint64_t layer, const Change& change) {
  value_or_raise(self.with_globe([&](Globe& globe) -> Status {
    auto look = globe.look(LayerId{layer});
    if (!look) return look.error();
    change(*look);
    return globe.set_look(LayerId{layer}, *look);
  }));
}

/// The value of a word, or an exception that lists the words.
template <class Value>
Value value_of_word(const char* what, const std::string& text, const OptionWords<Value>& words) {
  std::string all;
  for (const auto& [word, value] : words) {
    if (word == text) return value;
    all += (all.empty() ? "" : ", ") + word;
  }
  throw py::value_error(shown_message(fmt::format("{}: '{}' is none of {}", what, text, all)));
}

using GlobeClass = py::class_<PythonGlobe>;

/// Adds the methods about the globe's time and the dates of layers.
void add_time_methods(GlobeClass& globe);

}  // namespace terrella
