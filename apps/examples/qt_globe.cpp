// qt_globe TILES [OBJECTS.geojson]: a globe in a Qt 6 window, turned and zoomed by the mouse.
#include <terrella/globe.h>
#include <terrella/scene/navigation.h>
#include <terrella/streaming/objects/geojson_objects.h>

#include <QApplication>
#include <QMouseEvent>
#include <QOpenGLWidget>

using namespace terrella;

class GlobeWidget : public QOpenGLWidget {
 public:
  ~GlobeWidget() override { makeCurrent(), globe_.reset(), doneCurrent(); }

 protected:
  void initializeGL() override {
    const QStringList files = QApplication::arguments().mid(1);
    auto tiles = open_tile_set(files.value(0).toStdString());
    if (!tiles) qFatal("%s", tiles.error().message.c_str());
    auto globe = Globe::create({}, *std::move(tiles));
    if (!globe) qFatal("%s", globe.error().message.c_str());
    globe_ = *std::move(globe);
    if (files.size() > 1) {
      const auto objects = read_geojson_objects(files[1].toStdString());
      if (!objects || !globe_->add_objects(objects->scene)) qFatal("cannot show the objects");
    }
    navigator_.emplace(Camera{}, globe_->ground(), size_px());
  }
  void paintGL() override {
    navigator_->set_viewport(size_px());
    navigator_->advance(now());
    globe_->set_camera(navigator_->camera());
    globe_->render(defaultFramebufferObject(), size_px());
    if (navigator_->animating() || !globe_->settled()) update();
  }
  void mousePressEvent(QMouseEvent* e) override { navigator_->pointer_down(button(*e), false, at(*e), now()); }
  void mouseMoveEvent(QMouseEvent* e) override { navigator_->pointer_move(at(*e), now()), update(); }
  void mouseReleaseEvent(QMouseEvent* e) override { navigator_->pointer_up(button(*e), now()), update(); }
  void wheelEvent(QWheelEvent* e) override { navigator_->wheel(at(*e), e->angleDelta().y() / 120.0, now()), update(); }

 private:
  static Seconds now() { return std::chrono::steady_clock::now().time_since_epoch(); }
  static PointerButton button(const QMouseEvent& e) {
    return e.button() == Qt::LeftButton ? PointerButton::left : PointerButton::right;
  }
  int px(int units) const { return static_cast<int>(units * devicePixelRatioF()); }
  Viewport size_px() const { return {px(width()), px(height())}; }
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
