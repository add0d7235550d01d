#include <algorithm>
#include <functional>
#include <tuple>
#include <utility>

#include "robot/readers.hpp"

namespace interlock {
namespace {

/** The channel of that name, and the slot of its card. */
std::pair<SensorChannel, std::uint32_t> channel_of(TableReader& table, std::string_view key,
                                                   const Robot& robot) {
  const std::string name = table.text(key);
  for (const Sensor& sensor : robot.sensors) {
    const auto found = std::ranges::find(sensor.channels, name, &SensorChannel::name);
    if (found != sensor.channels.end()) {
      return {*found, sensor.slot};
    }
  }
  table.refuse(key, "no sensor has a channel \"" + name + '"', "the name of a [[sensor.channel]]");
  return {};
}

std::vector<double> read_depths(TableReader& table) {
  constexpr double deepest_mm = 500.0;
  const std::string expected = "at most 16 depths below the skin in mm, above 0 to 500, each below the next";
  std::vector<double> depths = table.numbers("membranes_mm", expected);
  const bool rising = std::ranges::is_sorted(depths, std::ranges::less_equal());
  const bool within = depths.empty() || (depths.front() > 0.0 && depths.back() <= deepest_mm);
  if (!rising || !within || depths.size() > Biopsy::most_membranes) {
    table.refuse("membranes_mm", "these are no depths of membranes", expected);
    depths.clear();
  }
  return depths;
}

}  // namespace

void read_biopsy(TableReader& parent, Robot& robot) {
  if (!parent.has("biopsy")) {
    return;
  }
  TableReader table = parent.table("biopsy");
  Biopsy biopsy;
  std::uint32_t needle_slot = 0;
  std::tie(biopsy.hand, biopsy.sensor_slot) = channel_of(table, "hand_force", robot);
  std::tie(biopsy.needle, needle_slot) = channel_of(table, "needle_force", robot);
  if (needle_slot != biopsy.sensor_slot) {
    table.refuse("needle_force", "it is read by another card than the force of the hand",
                 "a channel of the same card");
  }
  biopsy.units_per_newton = table.number_between("units_per_newton", 1e-3, 1e6);
  biopsy.entry_mm = table.number_between("entry_mm", 0.0, 500.0);
  biopsy.deadband_n = table.number_between("deadband_n", 0.0, 100.0);
  biopsy.gain_mm_s_n = table.number_between("gain_mm_s_n", 0.01, 100.0);
  biopsy.fastest_mm_s = table.number_between("fastest_mm_s", 0.1, 100.0);
  biopsy.curvature_per_mm = table.number_between("curvature_per_mm", 1e-6, 0.1);
  biopsy.membranes_mm = read_depths(table);
  table.refuse_unknown_keys();
  robot.biopsy = std::move(biopsy);
}

}  // namespace interlock
