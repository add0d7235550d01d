/// Draws a chart: JSON on standard input, SVG on standard output.
///
/// {"title", "x_label", "x": [...], "panels": [{"label", "series": [{"name", "colour", "values": [...]}]}]}

#include <iostream>
#include <nlohmann/json.hpp>

#include "chart/time_chart.hpp"

int main() {
  const nlohmann::json desired = nlohmann::json::parse(std::cin, nullptr, false);
  if (desired.is_discarded() || desired["x"].empty()) {
    std::cerr << "draw_chart: expected a chart with at least one point as JSON\n";
    return 1;
  }
  interlock::TimeChart chart{desired["title"], desired["x"], {}, desired["x_label"]};
  for (const nlohmann::json& panel : desired["panels"]) {
    chart.panels.push_back({panel["label"], {}});
    for (const nlohmann::json& series : panel["series"]) {
      interlock::ChartSeries curve{series["name"], series["colour"], {}};
      for (const nlohmann::json& value : series["values"]) {
        curve.values.emplace_back(value.get<double>());
      }
      chart.panels.back().series.push_back(std::move(curve));
    }
  }
  std::cout << interlock::svg_of(chart);
}
