#include "chart/time_chart.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string_view>

namespace interlock {
namespace {

constexpr double width = 900.0;
constexpr double panel_height = 190.0;
constexpr double panel_distance = 250.0;
constexpr double left = 90.0;
constexpr double top = 50.0;
constexpr double right_margin = 20.0;
constexpr double bottom_margin = 10.0;
/** More points than pixels show nothing more. */
constexpr std::size_t most_points = 1500;
constexpr int ticks_desired = 5;
/** A chart of a single moment has a time axis, too. */
constexpr double shortest_s = 1e-3;

struct Range {
  double lowest;
  double highest;
};

template <typename... Values>
std::string text(const char* format, Values... values) {
  std::array<char, 256> buffer{};
  const int length = std::snprintf(buffer.data(), buffer.size(), format, values...);
  return {buffer.data(), std::min(static_cast<std::size_t>(length), buffer.size() - 1)};
}

std::string escaped(std::string_view plain) {
  std::string safe;
  for (const char each : plain) {
    switch (each) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      default:
        safe += each;
        break;
    }
  }
  return safe;
}

std::string label(double x, double y, const char* anchor, std::string_view words) {
  return text("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\">", x, y, anchor) + escaped(words) + "</text>\n";
}

std::string line(double x1, double y1, double x2, double y2, const char* colour) {
  return text("<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"%s\"/>\n", x1, y1, x2, y2,
              colour);
}

/** 1, 2 or 5 times a power of ten, for about `ticks_wanted` ticks. */
double tick_distance(const Range& range) {
  const double rough = (range.highest - range.lowest) / ticks_desired;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  const double share = rough / power;
  return power * (share < 1.5 ? 1.0 : share < 3.5 ? 2.0 : share < 7.5 ? 5.0 : 10.0);
}

/** Of all values that are known, with a margin in which their ticks can be told apart. */
Range range_of(const ChartPanel& panel) {
  std::optional<Range> range;
  for (const ChartSeries& series : panel.series) {
    for (const std::optional<double>& value : series.values) {
      if (value && !range) {
        range = {*value, *value};
      } else if (value) {
        range = {std::min(range->lowest, *value), std::max(range->highest, *value)};
      }
    }
  }
  const auto [lowest, highest] = range.value_or(Range{0.0, 0.0});
  const double margin =
      std::max({0.05 * (highest - lowest), 1e-3, 1e-4 * std::abs(lowest), 1e-4 * std::abs(highest)});
  return {lowest - margin, highest + margin};
}

/** Draws panels whose time axes agree. */
class Sheet {
 public:
  explicit Sheet(const TimeChart& chart)
      : times_s_(chart.times_s),
        x_label_(chart.x_label),
        time_{0.0, std::max(chart.times_s.back(), shortest_s)} {}

  std::string draw(const ChartPanel& panel, std::size_t place) const {
    const double upper = top + static_cast<double>(place) * panel_distance;
    const Range range = range_of(panel);
    std::string svg = grid(range, upper);
    svg += label(left, upper - 8, "start", panel.label);
    double legend = width - right_margin;
    for (const ChartSeries& series : panel.series) {
      svg += curve(series, range, upper);
      svg += "<g fill=\"" + escaped(series.colour) + "\">" + label(legend, upper - 8, "end", series.name) +
             "</g>\n";
      legend -= 110;
    }
    return svg;
  }

 private:
  [[nodiscard]] double x(double time_s) const {
    return left + (time_s - time_.lowest) / (time_.highest - time_.lowest) * (width - left - right_margin);
  }

  static double y(double value, const Range& range, double upper) {
    return upper + (range.highest - value) / (range.highest - range.lowest) * panel_height;
  }

  [[nodiscard]] std::string grid(const Range& range, double upper) const {
    const double lower = upper + panel_height;
    std::string svg;
    const double rise = tick_distance(range);
    // Adding zero makes no minus of a zero that was rounded from below.
    for (double n = std::ceil(range.lowest / rise) + 0.0; n * rise <= range.highest; n += 1.0) {
      const double height = y(n * rise, range, upper);
      svg += line(left, height, width - right_margin, height, "#ddd");
      svg += label(left - 6, height + 4, "end", text("%.6g", n * rise));
    }
    const double step = tick_distance(time_);
    for (double n = 0.0; n * step <= time_.highest; n += 1.0) {
      svg += line(x(n * step), upper, x(n * step), lower, "#ddd");
      svg += label(x(n * step), lower + 16, "middle", text("%.6g", n * step));
    }
    svg += label((left + width - right_margin) / 2, lower + 32, "middle", x_label_);
    return svg + text(
                     "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"none\" "
                     "stroke=\"#444\"/>\n",
                     left, upper, width - left - right_margin, panel_height);
  }

  /** A stretch of known values for each interruption, and one more. */
  [[nodiscard]] std::string curve(const ChartSeries& series, const Range& range, double upper) const {
    const std::string begin = "<polyline fill=\"none\" stroke=\"" + escaped(series.colour) + "\" points=\"";
    const std::size_t stride = times_s_.size() / most_points + 1;
    std::string svg;
    std::string points;
    const auto end_stretch = [&] {
      if (!points.empty()) {
        svg += begin + points + "\"/>\n";
        points.clear();
      }
    };
    for (std::size_t n = 0; n < std::min(times_s_.size(), series.values.size()); n += stride) {
      if (const std::optional<double> value = series.values[n]) {
        points += text("%.1f,%.1f ", x(times_s_[n]), y(*value, range, upper));
      } else {
        end_stretch();
      }
    }
    end_stretch();
    return svg;
  }

  const std::vector<double>& times_s_;
  const std::string& x_label_;
  Range time_;
};

}  // namespace

std::string svg_of(const TimeChart& chart) {
  const double height = top + static_cast<double>(chart.panels.size()) * panel_distance - bottom_margin;
  std::string svg = text(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" width=\"%.0f\" "
      "height=\"%.0f\" font-family=\"sans-serif\" font-size=\"12\">\n",
      width, height, width, height);
  svg += "<title>" + escaped(chart.title) + "</title>\n";
  svg += text("<rect width=\"%.0f\" height=\"%.0f\" fill=\"#fff\"/>\n", width, height);
  svg += "<g font-size=\"15\">" + label(width / 2, 20, "middle", chart.title) + "</g>\n";
  const Sheet sheet(chart);
  for (std::size_t place = 0; place < chart.panels.size(); ++place) {
    svg += sheet.draw(chart.panels[place], place);
  }
  return svg + "</svg>\n";
}

}  // namespace interlock
