#include "apps/viewer/draw/drawing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <utility>
#include <vector>

#include "apps/viewer/draw/drawing_scene.h"
#include "geo/ellipsoid.h"
#include "tests/draw/draw_samples.h"

namespace terrella {
namespace {

using test::place_at;

constexpr double kTurn_deg = 1e-12;  // some ulp of 180°

DrawnMark area(std::vector<Geodetic> places) { return {.kind = MarkKind::area, .places = std::move(places)}; }
DrawnMark place(double lat_deg, double lon_deg) { return {.places = {place_at(lat_deg, lon_deg)}}; }

Drawing with(int marks) {
  Drawing drawing;
  for (int k = 0; k < marks; ++k) drawing.add(place(k, 0));
  return drawing;
}

TEST(Drawing, MarksHaveIdsOfTheirOwnInTheirOrder) {
  Drawing drawing = with(3);
  EXPECT_EQ(drawing.find(ObjectId{2})->places[0], place_at(1, 0));
  EXPECT_EQ(drawing.find(ObjectId{4}), nullptr);
  EXPECT_EQ(drawing.find(ObjectId::none), nullptr);
  drawing.remove(ObjectId{2});
  EXPECT_EQ(drawing.find(ObjectId{2}), nullptr);
  EXPECT_EQ(drawing.find(ObjectId{3})->places[0], place_at(2, 0));
  EXPECT_EQ(drawing.add(place(5, 5)), ObjectId{4});
}

TEST(Drawing, AMarkNeedsItsPlacesAndAnArea) {
  EXPECT_TRUE(check_mark(place(1, 2)));
  EXPECT_FALSE(check_mark({.kind = MarkKind::place}));
  EXPECT_FALSE(check_mark({.kind = MarkKind::line, .places = {place_at(0, 0)}}));
  EXPECT_TRUE(check_mark({.kind = MarkKind::line, .places = {place_at(0, 0), place_at(0, 1)}}));
  EXPECT_FALSE(check_mark(area({place_at(0, 0), place_at(0, 1)})));
  EXPECT_TRUE(check_mark(area({place_at(0, 0), place_at(0, 1), place_at(1, 1)})));
  EXPECT_TRUE(check_mark(area({place_at(80, 0), place_at(80, 120), place_at(80, -120)}))) << "round a pole";
  EXPECT_FALSE(check_mark(area({place_at(0, 0), place_at(0, 180), place_at(10, 90)}))) << "no shorter way";
  EXPECT_NE(check_mark(area({})).error().message.find("3 places"), std::string::npos);
}

TEST(Drawing, TheMiddleIsRightAcrossTheAntimeridianAndAtAPole) {
  const Geodetic far =
      middle_of(area({place_at(10, 170), place_at(10, -170), place_at(-10, -170), place_at(-10, 170)}));
  EXPECT_NEAR(far.lat.deg(), 0.0, kTurn_deg);
  EXPECT_NEAR(std::abs(far.lon.deg()), 180.0, kTurn_deg);
  EXPECT_NEAR(middle_of(area({place_at(80, 0), place_at(80, 120), place_at(80, -120)})).lat.deg(), 90.0, 1e-6);
  EXPECT_EQ(middle_of({.kind = MarkKind::line, .places = {place_at(0, 0), place_at(0, 180)}}), place_at(0, 0))
      << "none is nearer";
}

// Truth: a turn keeps all angles between normals.
TEST(Drawing, AMovedMarkKeepsItsShape) {
  const DrawnMark mark = area({place_at(0, 0), place_at(0, 10), place_at(20, 5)});
  const auto cosine = [](const Geodetic& a, const Geodetic& b) {
    return glm::dot(Ellipsoid::normal(a.lat, a.lon).xyz, Ellipsoid::normal(b.lat, b.lon).xyz);
  };
  for (const Geodetic& to : {place_at(0, 179), place_at(89, 40), place_at(-90, 0), place_at(0, 0)}) {
    const DrawnMark moved = moved_mark(mark, mark.places[0], to);
    EXPECT_NEAR(cosine(moved.places[0], to), 1.0, 1e-15);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(cosine(moved.places[k], moved.places[(k + 1) % 3]), cosine(mark.places[k], mark.places[(k + 1) % 3]),
                  1e-15);
    }
  }
}

TEST(UndoHistory, GoesBackAndForthTwiceInARow) {
  UndoHistory history;
  EXPECT_FALSE(history.can_undo());
  history.undo();
  history.redo();
  for (int k = 1; k <= 3; ++k) history.commit(with(k));
  for (int times = 0; times < 2; ++times) {
    for (std::size_t k = 3; k-- > 0;) {
      history.undo();
      EXPECT_EQ(history.now().marks.size(), k);
    }
    EXPECT_FALSE(history.can_undo());
    for (std::size_t k = 1; k <= 3; ++k) {
      history.redo();
      EXPECT_EQ(history.now().marks.size(), k);
    }
    EXPECT_FALSE(history.can_redo());
  }
}

TEST(UndoHistory, AChangeForgetsWhatWasUndoneAndNoChangeIsNoStep) {
  UndoHistory history(with(1));
  history.commit(with(1));
  EXPECT_FALSE(history.can_undo());
  history.commit(with(2));
  history.undo();
  history.commit(with(1));
  EXPECT_TRUE(history.can_redo());
  history.commit(with(5));
  EXPECT_FALSE(history.can_redo());
  history.undo();
  EXPECT_EQ(history.now(), with(1));
}

TEST(UndoHistory, ForgetsTheFirstStepsAndNotTheLastOne) {
  UndoHistory history;
  for (std::size_t k = 1; k <= UndoHistory::kMostSteps + 5; ++k) history.commit(with(int(k)));
  std::size_t steps = 0;
  for (; history.can_undo(); ++steps) history.undo();
  EXPECT_EQ(steps, UndoHistory::kMostSteps);
  EXPECT_EQ(history.now(), with(5));
  Drawing huge;
  huge.add({.kind = MarkKind::line, .places = std::vector<Geodetic>(UndoHistory::kMostPlaces, place_at(1, 1))});
  UndoHistory large(with(1));
  large.commit(huge);
  large.commit(with(3));
  EXPECT_EQ(large.now(), with(3));
  EXPECT_TRUE(large.can_undo());
}

TEST(DrawingScene, MarksLieOnTheGroundWithTheirIdsAndNames) {
  Drawing drawing;
  drawing.add({.places = {place_at(1, 2)}, .name = "Port"});
  drawing.add({.kind = MarkKind::line, .places = {place_at(0, 0), place_at(0, 10)}, .name = "Way"});
  drawing.add(area({place_at(0, 0), place_at(0, 1), place_at(1, 1)}));
  const ObjectScene scene = drawing_scene(drawing, 2.0F);
  ASSERT_EQ(scene.points.size(), 1U);
  ASSERT_EQ(scene.lines.size(), 1U);
  ASSERT_EQ(scene.polygons.size(), 1U);
  ASSERT_EQ(scene.labels.size(), 2U);
  EXPECT_EQ(scene.points[0].heights, HeightMode::clamp_to_ground);
  EXPECT_TRUE(is_draped(scene.lines[0]));
  EXPECT_TRUE(is_draped(scene.polygons[0]));
  EXPECT_EQ(scene.lines[0].width_px, 6.0F);
  EXPECT_EQ(scene.labels[1].of.id, ObjectId{2});
  EXPECT_NEAR(scene.labels[1].place.lon.deg(), 5.0, kTurn_deg);
  Drawing read = drawing_of(drawing_scene(drawing, 1.0F)).drawing;
  EXPECT_EQ(read.marks.size(), 3U);
  EXPECT_EQ(read.marks[1].name, "Way");
  EXPECT_EQ(read.marks[1].look, drawing.marks[1].look);
}

TEST(DrawingScene, EditsConcernOnlyMarksThatDiffer) {
  const Drawing before = with(3);
  Drawing after = before;
  EXPECT_TRUE(drawing_edits(before, after, 1.0F).remove.empty());
  EXPECT_TRUE(drawing_edits(before, after, 1.0F).add.empty());
  after.find(ObjectId{2})->name = "B";
  after.remove(ObjectId{1});
  after.add(place(9, 9));
  const ObjectEdits edits = drawing_edits(before, after, 1.0F);
  EXPECT_EQ(edits.remove, (std::vector{ObjectId{1}, ObjectId{2}}));
  ASSERT_EQ(edits.add.points.size(), 2U);
  EXPECT_EQ(edits.add.points[0].of.id, ObjectId{2});
  EXPECT_EQ(edits.add.points[1].of.id, ObjectId{4});
  EXPECT_EQ(edits.add.labels.size(), 1U);
}

TEST(DrawingScene, ThingsThatNoMarkCanBeAreCounted) {
  ObjectScene scene;
  scene.points.push_back({.place = place_at(0, 0), .radius_m = 5.0});
  scene.points.push_back({.place = place_at(0, 190)});
  scene.polygons.push_back(
      {.rings = {{place_at(0, 0), place_at(0, 9), place_at(9, 9)}, {place_at(1, 3), place_at(1, 4), place_at(2, 4)}}});
  scene.meshes.emplace_back();
  const SceneDrawing taken = drawing_of(scene);
  EXPECT_EQ(taken.left_out, 3U);
  ASSERT_EQ(taken.drawing.marks.size(), 1U);
  EXPECT_NEAR(taken.drawing.marks[0].places[0].lon.deg(), -170.0, kTurn_deg);
}

}  // namespace
}  // namespace terrella
