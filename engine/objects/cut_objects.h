#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "geo/ellipsoid.h"
#include "objects/ground/ground_shape.h"
#include "objects/object_batches.h"
#include "objects/object_shapes.h"
#include "objects/solid/solid_area.h"

namespace terrella {

/// Limits of one layer. Over the first, lines are cut more coarsely; over the second, areas are left out.
inline constexpr std::size_t kMostLineVertices = 4'000'000;
inline constexpr std::size_t kMostFillTriangles = 8'000'000;

/// A line, cut so that it follows the ellipsoid: in the layout for the GPU, without a colour. Pieces are 1 px wide.
struct LineCut {
  std::uint32_t index = 0;   ///< index of the line in its layer
  std::uint32_t number = 0;  ///< Kept::asked_number
  std::vector<LineVertex> vertices = {};
  std::shared_ptr<const GroundShape> ground = {};  ///< in place of vertices, if the line lies on the ground
};

/// An area, cut likewise: its fill and its outlines.
struct AreaCut {
  std::uint32_t index = 0;   ///< index of the area in its layer
  std::uint32_t number = 0;  ///< Kept::asked_number
  std::vector<FillVertex> fill = {};
  std::vector<std::uint32_t> triangles = {};
  std::vector<SolidVertex> solid = {};  ///< in place of these two, if the area is extruded
  std::vector<LineVertex> outline = {};
  std::shared_ptr<const GroundShape> ground = {};  ///< in place of all these, if the area lies on the ground
  FillFault fault = FillFault::none;               ///< reason for a missing fill
};

/// Returns the number of triangles of a fill.
[[nodiscard]] std::size_t triangles_of(const AreaCut& cut);

/// Lines and areas to be cut, which is the slow part of drawing them. Only the places of the objects are read.
struct CutJob {
  struct Line {
    std::uint32_t index, number;
    std::shared_ptr<const LineObject> shape;
    bool on_ground;         ///< lies_on_ground()
    double from_rad = 0.0;  ///< length of the line before its first place, as an angle
    bool is_part = false;   ///< part of a line that grows
  };
  struct Area {
    std::uint32_t index, number;
    std::shared_ptr<const PolygonObject> shape;
    bool fill, outline;  ///< parts that have a colour
    double height_m;     ///< mean height of the places
    bool on_ground;      ///< lies_on_ground()
  };
  Ellipsoid ellipsoid;
  Angle step{};  ///< step between the vertices of lines and outlines (line_step())
  std::size_t most_triangles = kMostFillTriangles;
  std::size_t spare_steps = kSpareFillSteps;  ///< limit for all areas together (fill_area())
  std::vector<Line> lines = {};
  std::vector<Area> areas = {};

  [[nodiscard]] bool empty() const { return lines.empty() && areas.empty(); }
  [[nodiscard]] std::size_t size() const { return lines.size() + areas.size(); }
  /// True if the job is better done by a worker: it may take more than a frame.
  [[nodiscard]] bool is_large() const;
};

struct CutObjects {
  std::vector<LineCut> lines;
  std::vector<AreaCut> areas;
};

/// Returns the length of all lines and outlines together, as an angle on the sphere.
[[nodiscard]] Angle line_length(const ObjectScene& scene);

/// Returns the step for lines and outlines of a total length: kLineStep, doubled until they fit within
/// kMostLineVertices.
[[nodiscard]] Angle line_step(Angle length);

/// Cuts the objects of a job. Areas get their triangles from the lowest to the highest; if there are too many
/// triangles, the highest areas are left out. Ends early, with a useless result, once `stop` is set. thread: any
[[nodiscard]] CutObjects cut_objects(CutJob job, const std::atomic<bool>& stop);

}  // namespace terrella
