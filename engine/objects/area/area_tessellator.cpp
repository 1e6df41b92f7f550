#include "objects/area/area_tessellator.h"

#include <GL/glu.h>

namespace terrella {

AreaTessellator::AreaTessellator() : tess_(gluNewTess()) {
  gluTessProperty(tess_, GLU_TESS_WINDING_RULE, GLU_TESS_WINDING_ODD);
  gluTessNormal(tess_, 0.0, 0.0, 1.0);
  gluTessCallback(tess_, GLU_TESS_VERTEX_DATA, reinterpret_cast<_GLUfuncptr>(&AreaTessellator::on_vertex));
  gluTessCallback(tess_, GLU_TESS_COMBINE_DATA, reinterpret_cast<_GLUfuncptr>(&AreaTessellator::on_combine));
  // A callback for edges makes the tessellator emit triangles instead of strips and fans.
  gluTessCallback(tess_, GLU_TESS_EDGE_FLAG, reinterpret_cast<_GLUfuncptr>(&AreaTessellator::on_edge));
}

AreaTessellator::~AreaTessellator() { gluDeleteTess(tess_); }

const std::vector<MapPoint>& AreaTessellator::triangles(const MapRings& rings) {
  corners_.clear();
  points_.clear();
  gluTessBeginPolygon(tess_, this);
  for (const MapRing& ring : rings) {
    gluTessBeginContour(tess_);
    for (const MapPoint& p : ring) {
      points_.push_back({p.lon_deg, p.lat_deg, 0.0});
      gluTessVertex(tess_, points_.back().data(), &points_.back());
    }
    gluTessEndContour(tess_);
  }
  gluTessEndPolygon(tess_);
  corners_.resize(corners_.size() - corners_.size() % 3);
  return corners_;
}

void AreaTessellator::on_vertex(void* vertex, void* self) {
  const Point& p = *static_cast<const Point*>(vertex);
  static_cast<AreaTessellator*>(self)->corners_.push_back({p[0], p[1]});
}

// Two edges that cross give four vertices, two vertices at one place give two.
void AreaTessellator::on_combine(const double at[3], void* const met[4], const float[4], void** made, void* self) {
  auto& tessellator = *static_cast<AreaTessellator*>(self);
  tessellator.points_.push_back({at[0], at[1], 0.0});
  tessellator.crossings_ += met[2] != nullptr ? 1U : 0U;
  *made = &tessellator.points_.back();
}

}  // namespace terrella
