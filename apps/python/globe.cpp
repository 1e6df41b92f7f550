#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "apps/open_scene/options/option_words.h"
#include "apps/process/console.h"
#include "apps/process/option_names.h"
#include "apps/process/stop_signals.h"
#include "apps/program/command_line.h"
#include "apps/program/commands.h"
#include "apps/program/scene_picture.h"
#include "apps/python/arguments.h"
#include "apps/python/bindings.h"
#include "apps/python/gl_thread.h"
#include "apps/python/long_call.h"
#include "apps/python/python_globe.h"
#include "streaming/objects/feature_style.h"
#include "streaming/objects/geojson_objects.h"
#include "streaming/objects/vector_objects.h"
#include "streaming/url.h"

namespace terrella {
namespace {

using Place = std::tuple<double, double, double>;  // latitude, longitude in degrees, height in metres

Geodetic geodetic(double lat, double lon, double height_m) {
  return {.lat = Angle::degrees(lat), .lon = Angle::degrees(lon), .height_m = height_m};
}

Place place_of(const Geodetic& place) { return {place.lat.deg(), place.lon.deg(), place.height_m}; }

bool is_path(const py::object& value) { return py::isinstance<py::str>(value) || py::hasattr(value, "__fspath__"); }

std::string dumped(const py::object& value) {
  return py::module_::import("json").attr("dumps")(value).cast<std::string>();
}

/// A path, or a dict.
FeatureStyle style_of(const py::object& style) {
  return value_or_raise(is_path(style) ? FeatureStyle::load(py::str(style).cast<std::string>())
                                       : FeatureStyle::parse(dumped(style), "style"));
}

/// A path, or anything that json.dumps() writes, or that has __geo_interface__ (shapely, geopandas).
ObjectFile objects_of(const py::object& geojson, const py::object& style) {
  const FeatureStyle look = style.is_none() ? FeatureStyle() : style_of(style);
  Result<ObjectFile> file = Error{};
  if (is_path(geojson)) {
    file = read_objects(py::str(geojson).cast<std::string>(), ObjectId{1}, look);
  } else {
    const py::object plain =
        py::hasattr(geojson, "__geo_interface__") ? py::object(geojson.attr("__geo_interface__")) : geojson;
    std::istringstream text(dumped(plain));
    file = parse_geojson_objects(text, "objects", {}, ObjectId{1}, look);
  }
  ObjectFile read = value_or_raise(std::move(file));
  if (read.ground_overlays > 0) {
    read.complaints.push_back(py::str(geojson).cast<std::string>() +
                              ": its pictures are imagery; add the file as that");
  }
  if (!read.complaints.empty()) conclude({.exit_code = kDoneInPart, .result = {}, .messages = read.complaints});
  return read;
}

StyledFeatures styled_features(const ObjectFile& file, double cluster_px) {
  return {features_of(file.scene), static_cast<std::size_t>(file.next) - 1, cluster_px};
}

const char* kind_name(ObjectKind kind) {
  constexpr const char* kNames[] = {"point", "line", "polygon", "mesh", "label"};
  return kNames[static_cast<int>(kind)];
}

py::dict pick(PythonGlobe& self, double x, double y) {
  const GlobePick found = self.with_globe([&](Globe& globe) { return globe.pick({x, y}, self.size()); });
  const auto id_or_none = [](LayerId id) {
    return id == LayerId::none ? py::object(py::none()) : py::object(py::int_(static_cast<std::uint64_t>(id)));
  };
  py::dict answer;
  answer["place"] = found.place ? py::cast(place_of(*found.place)) : py::none();
  answer["imagery"] = id_or_none(found.imagery);
  answer["layer"] = id_or_none(found.objects);
  const bool is_feature = found.object && found.object->of.feature && !found.object->of.feature->properties.empty();
  answer["id"] = found.object && found.object->of.id != ObjectId::none
                     ? py::object(py::int_(static_cast<std::uint64_t>(found.object->of.id)))
                     : py::none();
  answer["properties"] =
      is_feature ? py::module_::import("json").attr("loads")(found.object->of.feature->properties) : py::none();
  answer["kind"] = found.object ? py::object(py::str(kind_name(found.object->kind))) : py::none();
  answer["index"] = found.object ? py::object(py::int_(found.object->index)) : py::none();
  return answer;
}

std::uint64_t add_objects(PythonGlobe& self, const py::object& geojson, const py::object& style, double cluster_px) {
  ObjectFile file = objects_of(geojson, style);
  StyledFeatures features = styled_features(file, cluster_px);
  const auto added = self.with_picture([&](ScenePicture& picture) -> Result<LayerId> {
    const std::vector<ClusterPoint> points = cluster_points(file.scene);
    auto layer = picture.globe().add_objects(std::move(file.scene));
    if (!layer) return layer;
    Status done = picture.set_clusters(*layer, points, cluster_px);
    if (done) done = picture.set_shown(*layer, std::move(file.shown_when));
    if (!done) static_cast<void>(picture.globe().remove(*layer));
    return done ? layer : done.error();
  });
  const auto layer = static_cast<std::uint64_t>(value_or_raise(added));
  self.features()[layer] = std::move(features);
  return layer;
}

void set_objects(PythonGlobe& self, std::uint64_t layer, const py::object& geojson, const py::object& style) {
  ObjectFile file = objects_of(geojson, style);
  StyledFeatures features = styled_features(file, self.features()[layer].cluster_px);
  value_or_raise(self.with_picture([&](ScenePicture& picture) -> Status {
    const std::vector<ClusterPoint> points = cluster_points(file.scene);
    Status set = picture.globe().set_objects(LayerId{layer}, std::move(file.scene));
    if (set) picture.forget_features(LayerId{layer});
    if (set) set = picture.set_clusters(LayerId{layer}, points, features.cluster_px);
    return set ? picture.set_shown(LayerId{layer}, std::move(file.shown_when)) : set;
  }));
  self.features()[layer] = std::move(features);
}

using Values = py::array_t<double, py::array::c_style | py::array::forcecast>;

void set_style(PythonGlobe& self, std::uint64_t layer, const py::object& style, const std::optional<Values>& values) {
  const FeatureStyle look = style_of(style);
  const auto found = self.features().find(layer);
  if (found == self.features().end()) throw py::value_error("set_style is for layers that add_objects() added");
  const StyledFeatures& features = found->second;
  const std::span<const double> numbers =
      values ? std::span(values->data(), static_cast<std::size_t>(values->size())) : std::span<const double>();
  if (values && (values->ndim() != 1 || numbers.size() != features.count)) {
    throw py::value_error(fmt::format("values must be one number for each of the {} features", features.count));
  }
  value_or_raise(self.with_picture([&](ScenePicture& picture) -> Status {
    Status done = picture.globe().edit_objects(LayerId{layer}, restyled(features.parts, look, numbers));
    return done ? picture.set_shown(LayerId{layer}, shown_when(features.parts, look, numbers)) : done;
  }));
}

void move(PythonGlobe& self, std::uint64_t layer, std::uint64_t id, double lat, double lon, double height_m,
          std::optional<double> heading_deg) {
  ObjectEdits edits;
  edits.moves = {{.id = ObjectId{id}, .place = geodetic(lat, lon, height_m)}};
  if (heading_deg) edits.moves[0].heading = Angle::degrees(*heading_deg);
  value_or_raise(self.with_globe([&](Globe& globe) { return globe.edit_objects(LayerId{layer}, std::move(edits)); }));
}

void grow(PythonGlobe& self, std::uint64_t layer, std::uint64_t id, const std::vector<std::vector<double>>& places,
          std::size_t drop_first) {
  LineGrowth growth{.id = ObjectId{id}, .drop_first = drop_first};
  for (const std::vector<double>& place : places) {
    if (place.size() != 2 && place.size() != 3) {
      throw py::value_error("each place is (latitude, longitude) or (latitude, longitude, height)");
    }
    growth.append.push_back(geodetic(place[0], place[1], place.size() == 3 ? place[2] : 0.0));
  }
  ObjectEdits edits;
  edits.growths.push_back(std::move(growth));
  value_or_raise(self.with_globe([&](Globe& globe) { return globe.edit_objects(LayerId{layer}, std::move(edits)); }));
}

/// Shows or hides a layer of either kind.
void show(PythonGlobe& self, std::uint64_t layer, bool shown) {
  value_or_raise(self.with_globe([&](Globe& globe) -> Status {
    const auto look = globe.look(LayerId{layer});
    if (!look) return globe.show_objects(LayerId{layer}, shown);
    ImageLook changed = *look;
    changed.shown = shown;
    return globe.set_look(LayerId{layer}, changed);
  }));
}

void set_opacity(PythonGlobe& self, std::uint64_t layer, double opacity) {
  if (!(opacity >= 0.0 && opacity <= 1.0)) throw py::value_error("the opacity must be from 0 to 1");
  value_or_raise(self.with_globe([&](Globe& globe) -> Status {
    const auto look = globe.look(LayerId{layer});
    if (!look) return globe.fade_objects(LayerId{layer}, opacity);
    ImageLook changed = *look;
    changed.opacity = opacity;
    return globe.set_look(LayerId{layer}, changed);
  }));
}

void set_tone(PythonGlobe& self, std::uint64_t layer, double brightness, double contrast, double gamma) {
  change_look(self, layer,
              [&](ImageLook& look) { look.tone = {.brightness = brightness, .contrast = contrast, .gamma = gamma}; });
}

void set_blend(PythonGlobe& self, std::uint64_t layer, const std::string& blend) {
  const LayerBlend chosen = value_of_word("blend", blend, layer_blend_words());
  change_look(self, layer, [chosen](ImageLook& look) { look.blend = chosen; });
}

/// Shows layers on one side of a line; none: everywhere.
void set_swipe(PythonGlobe& self, std::optional<double> line, std::optional<std::uint64_t> before,
               std::optional<std::uint64_t> behind) {
  if (line && !(*line >= 0.0 && *line <= 1.0)) throw py::value_error("the line must be from 0 to 1");
  value_or_raise(self.with_globe([&](Globe& globe) -> Status {
    for (const auto& layer : {before, behind}) {
      if (layer && !globe.look(LayerId{*layer})) return globe.look(LayerId{*layer}).error();
    }
    for (const LayerId id : globe.imagery()) {
      ImageLook look = *globe.look(id);
      look.swipe = before && id == LayerId{*before}   ? SwipeSide::before
                   : behind && id == LayerId{*behind} ? SwipeSide::behind
                                                      : SwipeSide::both;
      if (Status set = globe.set_look(id, look); !set) return set;
    }
    SurfaceLook surface = globe.options().surface;
    surface.swipe = line;
    globe.set_surface(surface);
    return globe.status();
  }));
}

std::vector<std::uint64_t> numbers_of(const std::vector<LayerId>& ids) {
  std::vector<std::uint64_t> numbers;
  for (const LayerId id : ids) numbers.push_back(static_cast<std::uint64_t>(id));
  return numbers;
}

void add_layer_methods(GlobeClass& globe) {
  globe
      .def("add_imagery", &PythonGlobe::add_imagery, py::arg("tileset"), py::arg("opacity") = 1.0,
           "add_imagery(self, tileset, opacity=1.0)\n--\n\n"
           "Add a layer of imagery on top: all that render() takes as TILESET. Returns the layer's number.")
      .def("add_objects", &add_objects, py::arg("geojson"), py::arg("style") = py::none(), py::arg("cluster") = 0.0,
           "add_objects(self, geojson, style=None, cluster=0)\n--\n\n"
           "Add a layer of objects: the path of a file (GeoJSON, KML, GPX, shapefile, GeoPackage, ...), a dict, or an "
           "object with __geo_interface__. A style is a dict or the path of a JSON file. Points within `cluster` "
           "pixels, 10 to "
           "400, are drawn as one disc with their number; 0: no clusters. Returns the layer's number.")
      .def("set_objects", &set_objects, py::arg("layer"), py::arg("geojson"), py::arg("style") = py::none(),
           "set_objects(self, layer, geojson, style=None)\n--\n\nReplace the objects of a layer.")
      .def("set_style", &set_style, py::arg("layer"), py::arg("style"), py::arg("values") = py::none(),
           "set_style(self, layer, style, values=None)\n--\n\n"
           "Draw the features of a layer in another style, without reading them again. `values`, a number for each "
           "feature, are their field 'value'; NaN: none.")
      .def("move", &move, py::arg("layer"), py::arg("id"), py::arg("lat"), py::arg("lon"), py::arg("height") = 0.0,
           py::arg("heading") = py::none(),
           "move(self, layer, id, lat, lon, height=0.0, heading=None)\n--\n\n"
           "Move a feature of a layer: its points, labels and models. `heading`, degrees, turns its models and icons. "
           "The first feature of a GeoJSON has id 1.")
      .def("grow", &grow, py::arg("layer"), py::arg("id"), py::arg("places"), py::arg("drop_first") = 0,
           "grow(self, layer, id, places, drop_first=0)\n--\n\n"
           "Let the line of a feature go on to more places, each (latitude, longitude) or (latitude, longitude, "
           "height), "
           "and drop that many from its start. Costs what comes and goes, whatever the length of the line.")
      .def("show", &show, py::arg("layer"), py::arg("shown") = true,
           "show(self, layer, shown=True)\n--\n\nShow or hide a layer.")
      .def("set_opacity", &set_opacity, py::arg("layer"), py::arg("opacity"),
           "set_opacity(self, layer, opacity)\n--\n\nSet the opacity of a layer, 0 to 1.")
      .def("set_tone", &set_tone, py::arg("layer"), py::arg("brightness") = 0.0, py::arg("contrast") = 1.0,
           py::arg("gamma") = 1.0,
           "set_tone(self, layer, brightness=0.0, contrast=1.0, gamma=1.0)\n--\n\n"
           "Change the colours of a layer of pictures: brightness -1 to 1, contrast 0 to 4, gamma 0.1 to 10.")
      .def("set_blend", &set_blend, py::arg("layer"), py::arg("blend") = "normal",
           "set_blend(self, layer, blend='normal')\n--\n\n"
           "Set how a layer of imagery combines with the layers below: normal, multiply, screen or difference.")
      .def("set_swipe", &set_swipe, py::arg("line"), py::arg("before") = py::none(), py::arg("behind") = py::none(),
           "set_swipe(self, line, before=None, behind=None)\n--\n\n"
           "Compare two layers of imagery at a line, a fraction of the picture's width: one shows to its left, the "
           "other to its right. Line None: all layers show everywhere.")
      .def(
          "remove",
          [](PythonGlobe& self, std::uint64_t layer) {
            value_or_raise(self.with_globe([&](Globe& g) { return g.remove(LayerId{layer}); }));
            self.features().erase(layer);
          },
          py::arg("layer"), "remove(self, layer)\n--\n\nRemove a layer.")
      .def_property_readonly(
          "imagery",
          [](PythonGlobe& self) { return numbers_of(self.with_globe([](Globe& g) { return g.imagery(); })); },
          "Numbers of the image layers, lowest first.")
      .def_property_readonly(
          "objects",
          [](PythonGlobe& self) { return numbers_of(self.with_globe([](Globe& g) { return g.objects(); })); },
          "Numbers of the object layers, lowest first.");
}

void add_questions(GlobeClass& globe) {
  globe
      .def("pick", &pick, py::arg("x"), py::arg("y"),
           "pick(self, x, y)\n--\n\n"
           "What the last view shows at a pixel, x to the right and y down from the top left corner: a dict with "
           "'place' (latitude, longitude, height), 'imagery' (layer), and for an object 'layer', 'id' and 'properties' "
           "of its feature, 'kind' and 'index' in the layer's list of that kind. None is nothing.")
      .def(
          "project",
          [](PythonGlobe& self, double lat, double lon, double height_m) -> std::optional<std::pair<double, double>> {
            const auto at =
                self.with_globe([&](Globe& g) { return g.project(geodetic(lat, lon, height_m), self.size()); });
            if (!at) return std::nullopt;
            return std::pair(at->x, at->y);
          },
          py::arg("lat"), py::arg("lon"), py::arg("height") = 0.0,
          "project(self, lat, lon, height=0.0)\n--\n\n"
          "The pixel (x, y) of a place in the last view; None if the place is hidden or outside the picture.")
      .def(
          "ground_height",
          [](PythonGlobe& self, double lat, double lon) {
            return self.with_globe(
                [&](Globe& g) { return g.ground_height_m(Angle::degrees(lat), Angle::degrees(lon)); });
          },
          py::arg("lat"), py::arg("lon"),
          "ground_height(self, lat, lon)\n--\n\n"
          "Height of the drawn ground over the ellipsoid, in metres, from the heights loaded so far.")
      .def(
          "value_at",
          [](PythonGlobe& self, std::uint64_t layer, double lat, double lon) -> std::optional<double> {
            const auto value = value_or_raise(
                self.with_globe([&](Globe& g) { return g.value_at(LayerId{layer}, geodetic(lat, lon, 0.0)); }));
            if (!value) return std::nullopt;
            return value->value;
          },
          py::arg("layer"), py::arg("lat"), py::arg("lon"),
          "value_at(self, layer, lat, lon)\n--\n\n"
          "The number that a layer of numbers shows at a place; NaN without data, None if no tile is loaded there.")
      .def_property_readonly(
          "attributions", [](PythonGlobe& self) { return self.with_globe([](Globe& g) { return g.attributions(); }); },
          "Attribution texts of the last view.");
}

}  // namespace

void add_globe(py::module_& module) {
  RenderCommand command;
  CLI::App app;
  const std::vector<std::string> left_out = {"json", "output"};
  const CLI::App& sub = add_render_options(app, command);
  const std::string doc = command_doc("Globe", sub, left_out);
  std::string init = command_doc("__init__", sub, left_out);
  init.insert(init.find('(') + 1, "self, ");
  GlobeClass globe(module, "Globe", doc.c_str());
  globe.def(py::init<py::args, py::kwargs>(), init.c_str())
      .def("render", &PythonGlobe::render,
           "render(self)\n--\n\n"
           "Draw the view until all its tiles have come, as terrella.render() does. Returns the picture, height x "
           "width x 3 bytes.")
      .def("close", &PythonGlobe::close, "close(self)\n--\n\nFree the globe now; every later call fails.")
      .def(
          "__enter__", [](py::object self) { return self; }, "__enter__(self)\n--\n\n")
      .def(
          "__exit__", [](PythonGlobe& self, const py::args&) { self.close(); }, "__exit__(self, *args)\n--\n\n")
      .def_property("camera", &PythonGlobe::camera, &PythonGlobe::set_camera,
                    "Latitude, longitude, altitude, heading, pitch and field of view, in degrees and metres. Set it "
                    "with a tuple of three to six numbers, or with a text as --camera takes it.")
      .def_property_readonly(
          "size", [](const PythonGlobe& self) { return std::pair(self.size().width_px, self.size().height_px); },
          "Width and height of the picture in pixels.");
  add_layer_methods(globe);
  add_time_methods(globe);
  add_questions(globe);
}

}  // namespace terrella
