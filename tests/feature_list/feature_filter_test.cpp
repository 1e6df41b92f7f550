#include "apps/viewer/feature_list/feature_filter.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "apps/viewer/tools/folded_text.h"

namespace terrella {
namespace {

using Rows = std::vector<std::uint32_t>;

/// Features with words in every field, and the same texts for the truth.
struct Layer {
  std::vector<ListedFeature> features;
  std::vector<std::vector<std::string>> texts;  ///< folded, for each feature
  FeatureTable table;
};

constexpr std::array kWords = {"Αθήνα", "МОСКВА", "Köln",   "Łódź", "Saint-Étienne", "10", "9.5",
                               "İzmir", "as",     "Москва", "x"};

Layer made_layer(std::size_t count) {
  std::mt19937 random(5);  // NOLINT(cert-msc32-c,cert-msc51-cpp): the same layer in every run
  const auto word = [&random] { return std::string(kWords[random() % kWords.size()]); };
  Layer layer;
  for (std::size_t k = 0; k < count; ++k) {
    const std::string name = word() + " " + word(), kind = word(), note = word();
    const std::string text = fmt::format(R"({{"name": "{}", "kind": "{}", "note": "{}"}})", name, kind, note);
    layer.features.push_back(
        {.of = {.id = ObjectId{k + 1},
                .feature = std::make_shared<const ObjectFeature>(ObjectFeature{.properties = text})}});
    layer.texts.push_back({folded(name), folded(kind), folded(note)});
  }
  layer.table = read_table(layer.features);
  return layer;
}

/// The rows that a search finds, in the order of the file.
Rows true_rows(const Layer& layer, const std::string& text) {
  const std::string sought = folded(text);
  Rows rows;
  for (std::uint32_t k = 0; k < layer.texts.size(); ++k) {
    const auto has = [&sought](const std::string& one) {
      return std::search(one.begin(), one.end(), sought.begin(), sought.end()) != one.end() || sought.empty();
    };
    if (std::ranges::any_of(layer.texts[k], has)) rows.push_back(k);
  }
  return rows;
}

Rows in_file_order(Rows rows) {
  std::ranges::sort(rows);
  return rows;
}

void finish(FeatureFilter& filter, const FeatureTable& table) {
  while (filter.is_busy()) filter.step(table, 7);
}

TEST(FeatureFilter, FindsTheRowsThatHaveTheTextInTheNameOrAnyValue) {
  const Layer layer = made_layer(300);
  for (const std::string text :
       {"", " ", "αθηνα", "ΑΘΉ", "москва", "koln", "KÖLN ", "etienne", "9.5", "n a", "nowhere"}) {
    FeatureFilter filter;
    filter.begin(layer.table.by_name, false, text);
    finish(filter, layer.table);
    EXPECT_EQ(in_file_order(filter.found()), true_rows(layer, text)) << text;
  }
}

TEST(FeatureFilter, FindsTheSameLetterByLetterAndBack) {
  const Layer layer = made_layer(300);
  FeatureFilter filter;
  filter.begin(layer.table.by_name, false, "");
  for (const std::string text : {"", "m", "mo", "м", "мо", "мос", "м", "a", "as", "s", ""}) {
    filter.narrow(layer.table.by_name, false, text);
    finish(filter, layer.table);
    EXPECT_EQ(in_file_order(filter.found()), true_rows(layer, text)) << text;
  }
}

TEST(FeatureFilter, KeepsTheOrderAndTurnsItRound) {
  const std::vector<std::string> values{"7", "", "100", "b", "20"};
  FeatureTable table{.folded = {"7", "", "100", "b", "20"}};
  FeatureFilter filter;
  filter.begin(sort_order(values), false, "");
  finish(filter, table);
  EXPECT_EQ(filter.found(), (Rows{0, 4, 2, 3, 1}));
  filter.begin(sort_order(values), true, "");
  finish(filter, table);
  EXPECT_EQ(filter.found(), (Rows{3, 2, 4, 0, 1})) << "without a value: last";
  filter.narrow(sort_order(values), true, "0");
  finish(filter, table);
  EXPECT_EQ(filter.found(), (Rows{2, 4}));
}

TEST(FeatureFilter, KeepsTheLastRowsWhileItSearchesStepByStep) {
  const Layer layer = made_layer(100);
  FeatureFilter filter;
  filter.begin(layer.table.by_name, false, "");
  finish(filter, layer.table);
  filter.narrow(layer.table.by_name, false, "koln");
  for (int k = 0; k < 9; ++k) {
    EXPECT_FALSE(filter.step(layer.table, 10));
    EXPECT_EQ(filter.found().size(), 100U);
  }
  EXPECT_TRUE(filter.step(layer.table, 10));
  EXPECT_EQ(in_file_order(filter.found()), true_rows(layer, "koln"));
  EXPECT_FALSE(filter.step(layer.table, 10)) << "there is nothing left to do";
}

}  // namespace
}  // namespace terrella
