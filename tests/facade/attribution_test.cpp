// Attribution of the layers that the last frame had in view, each text once.
#include <gtest/gtest.h>

#include "tests/gl/gl_fixture.h"
#include "tests/gl/layer_source.h"
#include "tests/gl/painted_heights.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

using Texts = std::vector<std::string>;
constexpr Viewport kOwed{64, 64};
const TileGrid kOwedGrid{.tile_px = 32, .max_level = 3};

std::shared_ptr<TileSource> owed_to(const std::string& who, const TileGrid& grid = kOwedGrid) {
  auto source = std::make_shared<LayerSource>(grid, [](double, double) { return Rgba{90, 120, 60, 255}; });
  source->set_attribution(who);
  return source;
}

TileGrid bounded(double west, double south, double east, double north) {
  TileGrid grid = kOwedGrid;
  grid.bounds = {.west = Angle::degrees(west),
                 .south = Angle::degrees(south),
                 .east = Angle::degrees(east),
                 .north = Angle::degrees(north)};
  return grid;
}

class Attributions : public GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    auto made = Globe::create(unlit_options());
    ASSERT_TRUE(made) << made.error().message;
    globe_ = std::move(*made);
    globe_->set_camera(camera_at(10, 20, 8.0e6));
  }
  void TearDown() override {
    globe_.reset();
    GlTest::TearDown();
  }
  LayerId add(const std::shared_ptr<TileSource>& source, const ImageLook& look = {}) {
    return *globe_->add_imagery(source, look);
  }
  Texts of(const Camera& camera) {
    globe_->set_camera(camera);
    return now();
  }
  Texts now() {
    settle(*globe_, kOwed);
    return globe_->attributions();
  }
  std::unique_ptr<Globe> globe_;
};

TEST_F(Attributions, EachLayerTellsItsOwn) {
  const LayerId a = add(owed_to("A"));
  const LayerId objects = *globe_->add_objects({});
  EXPECT_EQ(*globe_->attribution(a), "A");
  EXPECT_EQ(*globe_->attribution(objects), "");
  ASSERT_TRUE(globe_->set_attribution(objects, "B"));
  EXPECT_EQ(*globe_->attribution(objects), "B");
  ASSERT_TRUE(globe_->remove(a));
  EXPECT_FALSE(globe_->attribution(a));
}

TEST_F(Attributions, AreThoseOfLayersThatAreShownInTheirOrderAndOnce) {
  EXPECT_EQ(now(), Texts{});
  const ImageLook thin{.opacity = 0.5};
  const LayerId a = add(owed_to("A")), b = add(owed_to("B"), thin), again = add(owed_to("A"), thin),
                nobody = add(owed_to(""), thin);
  EXPECT_EQ(now(), (Texts{"A", "B"}));
  ASSERT_TRUE(globe_->set_look(b, {.shown = false}));
  EXPECT_EQ(globe_->attributions(), (Texts{"A", "B"})) << "of the last frame";
  EXPECT_EQ(now(), Texts{"A"});
  ASSERT_TRUE(globe_->set_look(b, {.opacity = 0.5}));
  ASSERT_TRUE(globe_->move(b, 0));
  EXPECT_EQ(now(), Texts{"A"}) << "hides B";
  ASSERT_TRUE(globe_->remove(a));
  ASSERT_TRUE(globe_->set_attribution(nobody, "N"));
  EXPECT_EQ(now(), (Texts{"B", "A", "N"}));
  ASSERT_TRUE(globe_->remove(again));
  ASSERT_TRUE(globe_->set_look(b, {.opacity = 0.0}));
  EXPECT_EQ(now(), Texts{"N"});
  EXPECT_FALSE(globe_->set_attribution(again, "gone"));
}

// A layer over others hides them where it is opaque and has tiles.
TEST_F(Attributions, LayersUnderAnOpaqueLayerHaveNone) {
  add(owed_to("globe"));
  const LayerId cover = add(owed_to("cover"));
  EXPECT_EQ(now(), Texts{"cover"});
  add(owed_to("film"), {.opacity = 0.3});
  EXPECT_EQ(now(), (Texts{"cover", "film"}));
  for (const ImageLook& look : {ImageLook{.alpha = AlphaFrom::brightness}, ImageLook{.blend = LayerBlend::multiply}}) {
    ASSERT_TRUE(globe_->set_look(cover, look));
    EXPECT_EQ(now(), (Texts{"globe", "cover", "film"}));
  }
  ASSERT_TRUE(globe_->set_look(cover, {}));
  EXPECT_EQ(now(), (Texts{"cover", "film"}));
  // Clear pixels anywhere in the layer may let those under it through.
  ASSERT_TRUE(globe_->remove(cover));
  auto holes = std::make_shared<LayerSource>(kOwedGrid, [](double lon, double) {
    return Rgba{9, 9, 9, lon < 20 ? std::uint8_t{255} : std::uint8_t{0}};
  });
  holes->set_attribution("holes");
  add(holes);
  EXPECT_EQ(now(), (Texts{"globe", "film", "holes"}));
}

TEST_F(Attributions, AnOpaqueLayerWithBoundsHidesOnlyWhatLiesUnderIt) {
  add(owed_to("globe"));
  add(owed_to("Africa", bounded(-20, -35, 50, 35)));
  EXPECT_EQ(of(camera_at(0, 20, 1.0e6)), Texts{"Africa"});
  EXPECT_EQ(of(camera_at(0, 20, 2.0e7)), (Texts{"globe", "Africa"}));
}

TEST_F(Attributions, LayersOutOfViewHaveNone) {
  add(owed_to("globe"));
  add(owed_to("Africa", bounded(-20, -35, 50, 35)), {.opacity = 0.9});
  EXPECT_EQ(of(camera_at(0, 20, 1.0e6)), (Texts{"globe", "Africa"}));
  EXPECT_EQ(of(camera_at(0, 120, 1.0e6)), Texts{"globe"});
  EXPECT_EQ(of(camera_at(0, -160, 2.0e7)), Texts{"globe"}) << "behind the horizon";
  EXPECT_EQ(of(camera_at(0, 51, 1.0e6)), (Texts{"globe", "Africa"}));
}

TEST_F(Attributions, ALowestLayerWithBoundsHasNoneBesideThem) {
  add(owed_to("Africa", bounded(-20, -35, 50, 35)));
  EXPECT_EQ(of(camera_at(0, 20, 1.0e6)), Texts{"Africa"});
  EXPECT_EQ(of(camera_at(0, -60, 1.0e6)), Texts{});
  EXPECT_EQ(of(camera_at(0, 20, 1.0e6)), Texts{"Africa"});
}

TEST_F(Attributions, LevelsAndTilesThatAreLackingHaveNone) {
  add(owed_to("globe"));
  add(owed_to("near"), {.min_level = 3});
  auto missing = std::make_shared<LayerSource>(
      kOwedGrid, [](double, double) { return Rgba{}; }, [](const TileId&) { return true; });
  missing->set_attribution("never came");
  add(missing);
  EXPECT_EQ(of(camera_at(0, 20, 3.0e7)), Texts{"globe"});
  EXPECT_EQ(of(camera_at(0, 20, 5.0e5)), Texts{"near"}) << "hides the globe";
}

/// Tiles of another provider, and their attribution.
class Owed : public TileSource {
 public:
  Owed(std::shared_ptr<TileSource> tiles, const std::string& who) : tiles_(std::move(tiles)), info_(tiles_->info()) {
    info_.attribution = who;
  }
  [[nodiscard]] const TileSetInfo& info() const override { return info_; }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override { return tiles_->read(id); }

 private:
  std::shared_ptr<TileSource> tiles_;
  TileSetInfo info_;
};

TEST_F(Attributions, HeightsAndObjectsFollow) {
  add(owed_to("globe"));
  auto tiles = painted_heights({.tile_px = 64, .max_level = 1}, [](double, double) { return 100.0; });
  const auto heights = ElevationSource::open(std::make_shared<Owed>(std::move(tiles), "levelling"), "heights");
  ASSERT_TRUE(heights && globe_->set_elevation(*heights));
  EXPECT_EQ(now(), (Texts{"globe", "levelling"}));
  EXPECT_EQ(of({.eye = {.lat = {}, .lon = {}, .height_m = 1.0e7}, .heading = {}, .pitch = Angle::degrees(60)}), Texts{})
      << "beside the globe";
  globe_->set_camera(camera_at(10, 20, 8.0e6));
  ASSERT_TRUE(globe_->set_elevation({}));
  const auto objects = globe_->add_objects({.points = {{.place = {}}}});
  ASSERT_TRUE(objects);
  EXPECT_EQ(now(), Texts{"globe"});
  ASSERT_TRUE(globe_->set_attribution(*objects, "survey"));
  EXPECT_EQ(now(), (Texts{"globe", "survey"}));
  ASSERT_TRUE(globe_->show_objects(*objects, false));
  EXPECT_EQ(now(), Texts{"globe"});
}

}  // namespace
}  // namespace terrella::test
