#include "chart/time_chart.hpp"

#include <gmock/gmock.h>

#include <regex>

namespace interlock {
namespace {

using testing::HasSubstr;
using testing::Not;

std::size_t count_of(const std::string& svg, const char* pattern) {
  const std::regex desired(pattern);
  return static_cast<std::size_t>(
      std::distance(std::sregex_iterator(svg.begin(), svg.end(), desired), std::sregex_iterator()));
}

TimeChart chart_of(std::vector<std::optional<double>> values) {
  TimeChart chart{"yaw", {}, {{"position [rad]", {{"measured", "#0b62a4", std::move(values)}}}}};
  for (std::size_t n = 0; n < chart.panels[0].series[0].values.size(); ++n) {
    chart.times_s.push_back(0.1 * static_cast<double>(n));
  }
  return chart;
}

TEST(TimeChart, ACurveIsInterruptedWhereItsValueIsNotKnown) {
  EXPECT_EQ(count_of(svg_of(chart_of({1.0, 2.0, 3.0, 4.0})), "<polyline"), 1u);
  EXPECT_EQ(count_of(svg_of(chart_of({1.0, 2.0, std::nullopt, 4.0, 5.0})), "<polyline"), 2u);
  EXPECT_EQ(count_of(svg_of(chart_of({std::nullopt, 2.0, 3.0, std::nullopt})), "<polyline"), 1u);
  EXPECT_EQ(count_of(svg_of(chart_of({std::nullopt, std::nullopt})), "<polyline"), 0u);
}

TEST(TimeChart, TheLowestValueIsDrawnBelowTheHighestWithinThePanel) {
  const std::string svg = svg_of(chart_of({150.0, 150.5, 151.0}));
  std::smatch points;
  ASSERT_TRUE(std::regex_search(
      svg, points, std::regex("points=\"[0-9.]+,([0-9.]+) [0-9.]+,([0-9.]+) [0-9.]+,([0-9.]+) \"")));
  const double first = std::stod(points[1]);
  const double middle = std::stod(points[2]);
  const double last = std::stod(points[3]);
  EXPECT_NEAR(middle, (first + last) / 2, 0.2) << "the scale is even";
  EXPECT_GT(first - last, 100.0) << "what moves by a millimetre far from 0 fills its panel";
}

TEST(TimeChart, EveryPanelHasAFrameAndItsLabel) {
  TimeChart chart = chart_of({0.0, 1.0});
  chart.panels.push_back({"error [counts]", chart.panels[0].series});
  const std::string svg = svg_of(chart);
  EXPECT_EQ(count_of(svg, "<rect[^>]*stroke"), 2u);
  EXPECT_THAT(svg, HasSubstr("position [rad]"));
  EXPECT_THAT(svg, HasSubstr("error [counts]"));
}

TEST(TimeChart, WhatIsDrawnOverAnotherQuantityThanTimeSaysSo) {
  TimeChart chart = chart_of({0.0, 1.0});
  EXPECT_THAT(svg_of(chart), HasSubstr("time [s]"));
  chart.x_label = "loop time [us]";
  EXPECT_THAT(svg_of(chart), HasSubstr("loop time [us]"));
  EXPECT_THAT(svg_of(chart), Not(HasSubstr("time [s]")));
}

TEST(TimeChart, ValuesThatNeverChangeHaveAScale) {
  for (const double value : {0.0, -375000.0, 1e-9}) {
    const std::string svg = svg_of(chart_of({value, value, value}));
    EXPECT_THAT(svg, Not(HasSubstr("nan"))) << value;
    EXPECT_THAT(svg, Not(HasSubstr("inf"))) << value;
    EXPECT_GE(count_of(svg, "text-anchor=\"end\""), 3u) << value;
  }
}

TEST(TimeChart, AnyTextIsText) {
  TimeChart chart = chart_of({0.0, 1.0});
  chart.title = "a<b> & c";
  chart.panels[0].series[0].name = "<d>";
  EXPECT_THAT(svg_of(chart), HasSubstr(">a&lt;b&gt; &amp; c<"));
  EXPECT_THAT(svg_of(chart), HasSubstr(">&lt;d&gt;<"));
}

}  // namespace
}  // namespace interlock
