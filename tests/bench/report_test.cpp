#include "apps/bench/report/report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/bench/report/gnuplot.h"
#include "apps/bench/report/report_page.h"

namespace terrella::bench {
namespace {

Report small_report() {
  return {.name = "small",
          .title = "A small report",
          .facts = {{"renderer", "none"}},
          .columns = {{"view", ""}, {"time", "ms", 1}, {"tiles", ""}},
          .rows = {{std::string("over \"there\", far"), 1.25, std::int64_t{7}},
                   {std::string("here"), kNoFigure, std::int64_t{8}}},
          .findings = {{"slower than that", 2.0, 1.0, "ms"}, {"no bound", 3.0}},
          .plots = {{.title = "time beside tiles", .x = "tiles", .y = "time", .series = "view"}}};
}

TEST(ReportTest, CsvQuotesWhatNeedsItAndLeavesOutWhatIsNotThere) {
  EXPECT_EQ(as_csv(small_report()), "view,time,tiles\r\n\"over \"\"there\"\", far\",1.25,7\r\nhere,,8\r\n");
}

TEST(ReportTest, JsonSaysTheSame) {
  const nlohmann::json json = nlohmann::json::parse(as_json(small_report()));
  EXPECT_EQ(json["bench"], "small");
  EXPECT_EQ(json["facts"]["renderer"], "none");
  EXPECT_EQ(json["columns"][1]["unit"], "ms");
  EXPECT_EQ(json["rows"][0]["view"], "over \"there\", far");
  EXPECT_EQ(json["rows"][0]["time"], 1.25);
  EXPECT_TRUE(json["rows"][1]["time"].is_null());
  EXPECT_FALSE(json["findings"][0]["holds"].get<bool>());
  EXPECT_TRUE(json["findings"][1]["limit"].is_null());
  EXPECT_TRUE(json["findings"][1]["holds"].get<bool>());
}

TEST(ReportTest, TheTableHasUnitsFiguresAndFindings) {
  const std::string text = as_text(small_report());
  for (const char* said :
       {"A small report", "renderer: none", "ms", "1.2", "does not hold", "no bound: 3", "finding: fail"}) {
    EXPECT_NE(text.find(said), std::string::npos) << said << '\n' << text;
  }
}

TEST(ReportTest, ThePageHasEachBenchmarkItsPlotsAndWhyOneIsMissing) {
  Report broken = small_report();
  broken.name = "broken";
  const std::string page = as_page({{"cores", "2"}}, {{.report = small_report(), .svg = "<svg><g id=\"dots\"/></svg>"},
                                                      {.report = broken, .failure = "no <planet>"}});
  for (const char* said :
       {"<td>cores</td><td>2</td>", "<h2>small</h2>", "<g id=\"dots\">", "<td>here</td><td></td>",
        "<li class=\"broken\">slower than that: 2 ms (at most 1)</li>", "<h2>broken</h2>", "no &lt;planet&gt;"}) {
    EXPECT_NE(page.find(said), std::string::npos) << said << '\n' << page;
  }
}

TEST(GnuplotTest, AnSvgIsDrawnOnItsOwnTerminal) {
  EXPECT_NE(gnuplot_script(small_report(), "small.svg").find("set terminal svg"), std::string::npos);
}

TEST(GnuplotTest, TheScriptHoldsTheData) {
  const std::string script = gnuplot_script(small_report(), "small.png");
  EXPECT_NE(script.find("7 1.25\n"), std::string::npos);
  EXPECT_EQ(script.find("\n8 "), std::string::npos) << "a row without a figure is not drawn";
  EXPECT_NE(script.find("set output \"small.png\""), std::string::npos);
  EXPECT_NE(script.find(R"(title "over \"there\", far")"), std::string::npos);
}

TEST(GnuplotTest, WhatALogarithmicAxisCannotShowIsLeftOut) {
  Report report = small_report();
  report.rows = {{std::string("a"), 0.0, std::int64_t{3}}, {std::string("a"), 4.0, std::int64_t{5}}};
  report.plots.front().log_y = true;
  const std::string script = gnuplot_script(report, "small.png");
  EXPECT_EQ(script.find("3 0\n"), std::string::npos);
  EXPECT_NE(script.find("5 4\n"), std::string::npos);
}

}  // namespace
}  // namespace terrella::bench
