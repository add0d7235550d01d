/// Draws a chart: JSON on standard input, SVG on standard output.
///
/// {"title", "x_label", "x": [...], "panels": [{"label", "series": [{"name", "colour", "values": [...]}]}]}

#include <iostream>
#include <nlohmann/json.hpp>

#include "chart/time_chart.hpp"

int main() {
  const nlohmann::json wanted = nlohmann::json::parse(std::cin, nullptr, false);
  if (wanted.is_discarded() || wanted["x"].empty()) {
    std::cerr << "draw_chart: expected a chart with at least one point as JSON\n";
    return 1;
  }
  interlock::TimeChart chart{wanted["title"], wanted["x"], {}, wanted["x_label"]};
  for (const nlohmann::json& panel : wanted["panels"]) {
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
