#include "apps/viewer/feature_list/feature_table.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

namespace terrella {
namespace {

using Rows = std::vector<std::uint32_t>;
using Texts = std::vector<std::string>;

std::vector<ListedFeature> features_with(const Texts& properties) {
  std::vector<ListedFeature> features;
  features.reserve(properties.size());
  for (const std::string& one : properties) {
    features.push_back({.of = {.id = ObjectId{features.size() + 1},
                               .feature = std::make_shared<const ObjectFeature>(ObjectFeature{.properties = one})}});
  }
  return features;
}

TEST(FeatureTable, NumbersAreSortedAsNumbersThenTextsThenRowsWithoutAText) {
  const SortOrder order = sort_order(Texts{"b", "", "10", "Älm", "9", "-1.5", "a", "", "9"});
  EXPECT_EQ(order.rows, (Rows{5, 4, 8, 2, 6, 3, 0, 1, 7}));
  EXPECT_EQ(order.blank, 2U);
}

TEST(FeatureTable, ARowHasANameOrTheNumberOfTheFeature) {
  const auto features = features_with({R"({"name": "Wien\nVienna", "people": 2})", R"({"people": 3, "wet": true})"});
  const FeatureTable table = read_table(features);
  EXPECT_EQ(table.names, (Texts{"Wien Vienna", "Feature 2"}));
  EXPECT_EQ(table.fields, (Texts{"people", "wet"}));
  EXPECT_EQ(table.folded, (Texts{"wien vienna\n2", "feature 2\n3\ntrue"}));
  EXPECT_EQ(table.by_name.rows, (Rows{0, 1}));
  EXPECT_EQ(table.by_name.blank, 1U);
}

TEST(FeatureTable, AColumnHasTheValuesOfOneField) {
  const auto features = features_with({R"({"people": 10})", R"({})", R"({"people": "9"})", "no JSON"});
  const FieldColumn column = read_column(features, "people");
  EXPECT_EQ(column.values, (Texts{"10", "", "9", ""}));
  EXPECT_EQ(column.order.rows, (Rows{2, 0, 1, 3}));
}

TEST(FeatureTable, AStopLeavesTheRestUnread) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_TRUE(read_table(features_with({"{}"}), stop.get_token()).names.empty());
  EXPECT_TRUE(read_column(features_with({"{}"}), "people", stop.get_token()).values.empty());
}

}  // namespace
}  // namespace terrella
