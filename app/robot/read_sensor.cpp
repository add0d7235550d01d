#include <algorithm>
#include <cmath>

#include "robot/readers.hpp"

namespace interlock {
namespace {

constexpr std::int64_t analog_inputs = 4;
constexpr std::int64_t largest_reading = 0xFFFF;

constexpr std::array<std::pair<std::string_view, std::string_view>, 3> sensor_units{{
    {"N", "N"},
    {"N mm", "N mm"},
    {"unspecified", "unspecified"},
}};

double read_slope(TableReader& table) {
  const double slope = table.number_between("slope", -1e6, 1e6);
  if (std::abs(slope) < 1e-9) {
    table.refuse_given("slope", "readings cannot be told apart", "a slope of at least 1e-9, up or down");
  }
  return slope;
}

SensorChannel read_channel(TableReader table, const Sensor& sensor) {
  SensorChannel channel;
  channel.name = table.identifier("name");
  table.rename("sensor." + sensor.name + ".channel." + channel.name);
  if (std::ranges::find(sensor.channels, channel.name, &SensorChannel::name) != sensor.channels.end()) {
    table.refuse("name", "another channel is called \"" + channel.name + "\" already", "a name of its own");
  }
  channel.title = table.text("title");
  channel.adc = static_cast<std::uint32_t>(table.integer_between("adc", 1, analog_inputs));
  if (std::ranges::find(sensor.channels, channel.adc, &SensorChannel::adc) != sensor.channels.end()) {
    table.refuse("adc", "another channel reads input " + std::to_string(channel.adc) + " already",
                 "an input of its own");
  }
  channel.slope = read_slope(table);
  channel.intercept = table.number_between("intercept", -1e9, 1e9);
  channel.reference = static_cast<std::uint32_t>(table.integer_between("reference", 0, largest_reading));
  channel.unit = table.choice("unit", sensor_units);
  table.refuse_unknown_keys();
  return channel;
}

std::string name_at(const Robot& robot, std::uint32_t slot) {
  if (const Axis* const axis = robot.at_slot(slot)) {
    return axis->name;
  }
  const Sensor* const sensor = robot.sensor_at_slot(slot);
  return sensor ? sensor->name : "";
}

}  // namespace

void refuse_twins(TableReader& table, const Robot& robot, const std::string& name, std::uint32_t slot) {
  if (robot.find(name) || robot.find_sensor(name)) {
    table.refuse("name", "another card is called \"" + name + "\" already", "a name of its own");
  }
  if (const std::string other = name_at(robot, slot); !other.empty()) {
    table.refuse("slot", "slot " + std::to_string(slot) + " carries \"" + other + "\" already",
                 "a slot of its own");
  }
}

Sensor read_sensor(TableReader table, const Robot& robot) {
  const std::string expected = "one [[sensor.channel]] table for each analog input";
  Sensor sensor;
  sensor.name = table.identifier("name");
  table.rename("sensor." + sensor.name);
  sensor.slot = static_cast<std::uint32_t>(table.integer_between("slot", 0, ILK_SLOTS - 1));
  refuse_twins(table, robot, sensor.name, sensor.slot);
  sensor.title = table.text("title");
  sensor.required = table.has("required") && table.boolean("required");
  for (TableReader& channel : table.tables("channel", expected)) {
    sensor.channels.push_back(read_channel(std::move(channel), sensor));
  }
  if (sensor.channels.empty()) {
    table.refuse("channel", "the sensor has no channel", expected);
  }
  table.refuse_unknown_keys();
  return sensor;
}

}  // namespace interlock
