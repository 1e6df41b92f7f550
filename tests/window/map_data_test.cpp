// Looks of the names on the map: size and room between letters by the size of an area, slanted waters, bold capitals.
#include "apps/viewer/tools/map_data.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <tuple>

#include "geo/body.h"
#include "text/text_shaper.h"

namespace terrella {
namespace {

class MapNames : public testing::Test {
 protected:
  void SetUp() override {
    auto data = load_map(earth(), TERRELLA_PLACES);
    ASSERT_TRUE(data) << data.error().message;
    data_ = *std::move(data);
  }
  [[nodiscard]] const MapName& named(const std::string& text) const {
    const auto found = std::ranges::find(data_.names, text, &MapName::text);
    return found != data_.names.end() ? *found : (ADD_FAILURE() << text, data_.names.front());
  }
  [[nodiscard]] const LabelLook& look(const std::string& text) const { return named(text).look; }

  MapData data_;
};

TEST_F(MapNames, LargerAreasHaveLargerTextsWithMoreRoom) {
  for (const auto& names : {std::array{"RUSSIA", "FRANCE", "ICELAND", "MALTA"},
                            std::array{"INDIAN OCEAN", "Coral Sea", "North Sea", "Irish Sea"}}) {
    for (std::size_t k = 1; k < names.size(); ++k) {
      EXPECT_GT(look(names[k - 1]).text_px, look(names[k]).text_px) << names[k];
      EXPECT_GT(look(names[k - 1]).letter_spacing_em, look(names[k]).letter_spacing_em) << names[k];
    }
  }
  EXPECT_EQ(look("Winterthur").letter_spacing_em, 0.0F);
}

TEST_F(MapNames, WatersAloneAreSlantedAndCapitalsAloneBold) {
  EXPECT_TRUE(look("Irish Sea").slanted);
  EXPECT_FALSE(look("MALTA").slanted);
  EXPECT_FALSE(look("Bern").slanted);
  EXPECT_NE(named("Irish Sea").color, named("MALTA").color);
  EXPECT_EQ(look("Bern").weight, TextWeight::bold);
  EXPECT_EQ(look("Shanghai").weight, TextWeight::bold) << "a large city";
  EXPECT_EQ(look("Winterthur").weight, TextWeight::regular);
  EXPECT_EQ(look("MALTA").weight, TextWeight::regular);
}

TEST_F(MapNames, SeasLieWhereTheyAre) {
  for (const auto& [text, lat, lon] : {std::tuple{"North Sea", 56.0, 3.0}, std::tuple{"Tasman Sea", -38.0, 161.0}}) {
    EXPECT_NEAR(named(text).place.lat.deg(), lat, 2.0);
    EXPECT_NEAR(named(text).place.lon.deg(), lon, 2.0);
    EXPECT_TRUE(named(text).is_area);
  }
}

// A name that no font can write in full would lose its marks.
TEST_F(MapNames, TheProgramsFontHasAllLettersOfAreas) {
  auto shaper = TextShaper::create(data_.font, 15);
  ASSERT_TRUE(shaper) << shaper.error().message;
  for (const MapName& name : data_.names) {
    EXPECT_TRUE(!name.is_area || (*shaper)->shape(label_text(name.text)).width_px > 0.0F) << name.text;
  }
  EXPECT_TRUE((*shaper)->without_font().empty());
}

}  // namespace
}  // namespace terrella
