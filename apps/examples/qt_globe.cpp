// qt_globe TILES OBJECTS.geojson: shows a globe in a Qt 6 window; the mouse turns and zooms the globe.
#include <terrella/globe.h>
#include <terrella/streaming/objects/geojson_objects.h>
#include <terrella/streaming/sets/open_tile_set.h>
#include <terrella/view/navigation.h>

#include <QApplication>
#include <QMouseEvent>
#include <QOpenGLWidget>

using namespace terrella;

template <class T>
T must(Result<T> result) {
  if (!result) qFatal("%s", result.error().message.c_str());
  return *std::move(result);
}

class GlobeWidget : public QOpenGLWidget {
 public:
  ~GlobeWidget() override { makeCurrent(), globe_.reset(), doneCurrent(); }
  void initializeGL() override {
    const QStringList files = QApplication::arguments();
    globe_ = must(Globe::create({}));
    must(globe_->add_imagery(must(open_tile_set(files.value(1).toStdString()))));
    must(globe_->add_objects(must(read_geojson_objects(files.value(2).toStdString())).scene));
    navigator_.emplace(Camera{}, globe_->ground(), size_px());
  }
  void paintGL() override {
    navigator_->set_viewport(size_px());
    navigator_->advance(now());
    globe_->set_camera(navigator_->camera());
    globe_->render(defaultFramebufferObject(), size_px());
    if (navigator_->animating() || !globe_->settled()) update();
  }
  void mousePressEvent(QMouseEvent* e) override { navigator_->pointer_down(PointerButton::left, false, at(*e), now()); }
  void mouseMoveEvent(QMouseEvent* e) override { navigator_->pointer_move(at(*e), now()), update(); }
  void mouseReleaseEvent(QMouseEvent*) override { navigator_->pointer_up(PointerButton::left, now()), update(); }
  void wheelEvent(QWheelEvent* e) override { navigator_->wheel(at(*e), e->angleDelta().y() / 120.0, now()), update(); }

 private:
  static Seconds now() { return std::chrono::steady_clock::now().time_since_epoch(); }
  Viewport size_px() const { return {int(width() * devicePixelRatioF()), int(height() * devicePixelRatioF())}; }
  glm::dvec2 at(const QSinglePointEvent& e) const {
    return (glm::dvec2(e.position().x(), e.position().y()) + 0.5) * devicePixelRatioF();
  }
  std::unique_ptr<Globe> globe_;
  std::optional<Navigator> navigator_;
};

int main(int argc, char** argv) {
  QSurfaceFormat format;
  format.setVersion(4, 5);
  format.setProfile(QSurfaceFormat::CoreProfile);
  QSurfaceFormat::setDefaultFormat(format);
  QApplication application(argc, argv);
  GlobeWidget globe;
  globe.resize(800, 600);
  globe.show();
  return QApplication::exec();
}
