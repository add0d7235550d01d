/**
 * @file
 * Quantities over time as a picture: panels one above the other whose time axes agree.
 */
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace interlock {

/** One curve; where a value is not known it is interrupted. */
struct ChartSeries {
  std::string name;
  std::string colour;                        /**< as SVG spells it: "#0b62a4" */
  std::vector<std::optional<double>> values; /**< one for each time of the chart */
};

/** One panel: its series share an axis of values. */
struct ChartPanel {
  std::string label; /**< quantity and unit */
  std::vector<ChartSeries> series;
};

/** Names, labels and title may hold any text. */
struct TimeChart {
  std::string title;
  std::vector<double> times_s; /**< from 0, increasing; at least one */
  std::vector<ChartPanel> panels;
  std::string x_label = "time [s]"; /**< for what is drawn over another quantity than time */
};

/** A whole SVG document that needs nothing else; of long curves it draws as many points as can be seen. */
std::string svg_of(const TimeChart& chart);

}  // namespace interlock
