#include "plant/parameters_file.hpp"

#include <bitset>

#include "plant/scene_file.hpp"
#include "plant/toml_reader.hpp"

namespace interlock::plant {
namespace {

constexpr double kFarthestStart = 1 << 30;

void read_knob(Reader& reader, const toml::table& table, const AxisKnob& knob, AxisParameters& axis) {
  double value = 0;
  if (!reader.number(table, knob.name, knob.range, value)) {
    return;
  }
  if (knob.whole && !table.get(knob.name)->is_integer()) {
    reader.fail(*table.get(knob.name), knob.name, "expected a whole number");
    return;
  }
  knob.set(axis, value);
}

/** Of `[defaults]` and `[[axis]]`. */
std::vector<std::string_view> dynamics_keys() {
  std::vector<std::string_view> keys;
  for (const AxisKnob& knob : kAxisKnobs) {
    keys.push_back(knob.name);
  }
  keys.insert(keys.end(),
              {"counts_per_revolution", "end_margin_counts", "switch_hysteresis_counts", "switch_bounce_ms"});
  return keys;
}

void read_dynamics(Reader& reader, const toml::table& table, AxisParameters& axis) {
  for (const AxisKnob& knob : kAxisKnobs) {
    read_knob(reader, table, knob, axis);
  }
  reader.number(table, "counts_per_revolution", {1, 1e6}, axis.counts_per_revolution);
  reader.number(table, "end_margin_counts", {0, 1e6}, axis.end_margin_counts);
  reader.number(table, "switch_hysteresis_counts", {0, 1000}, axis.switch_hysteresis_counts);
  reader.milliseconds(table, "switch_bounce_ms", {0, 100}, axis.switch_bounce);
}

void read_start(Reader& reader, const toml::table& table, const ilk_axis_config_t& robot,
                AxisParameters& axis) {
  double from_switch = 0;
  const bool absolute =
      reader.number(table, "start_counts", {-kFarthestStart, kFarthestStart}, axis.start_counts);
  const bool relative = reader.number(table, "start_from_switch_counts", {0, kFarthestStart}, from_switch);
  if (absolute == relative) {
    reader.fail(table, "start_counts", "expected either start_counts or start_from_switch_counts");
    return;
  }
  if (relative && robot.limit_side == ILK_LIMIT_NONE) {
    reader.fail(table, "start_from_switch_counts", "the robot's axis has no switch; expected start_counts");
    return;
  }
  if (relative) {
    axis.start_counts = position_from_switch(robot, from_switch);
  }
  if (axis.start_counts < robot.min_counts || axis.start_counts > robot.max_counts) {
    reader.fail(table, relative ? "start_from_switch_counts" : "start_counts",
                "expected a start within the soft limits " + std::to_string(robot.min_counts) + " to " +
                    std::to_string(robot.max_counts));
  }
}

void read_axis(Reader& reader, const toml::table& table, const ilk_config_t& robot,
               const AxisParameters& defaults, Parameters& parameters, std::bitset<ILK_SLOTS>& found) {
  reader.only(table, {"slot", "name", "start_counts", "start_from_switch_counts"}, dynamics_keys());
  std::uint32_t slot = 0;
  if (!reader.integer(table, "slot", {0, ILK_SLOTS - 1}, slot)) {
    reader.fail(table, "slot", "expected the slot of the axis, 0 to 9");
    return;
  }
  if (!drives_motor(robot.axis[slot].card) || found[slot]) {
    reader.fail(table, "slot",
                "slot " + std::to_string(slot) +
                    (found[slot] ? " has an axis already" : " of the robot has no motor card"));
    return;
  }
  found[slot] = true;
  AxisParameters& axis = parameters.axis[slot];
  axis = defaults;
  axis.name = table["name"].value_or(std::string());
  if (axis.name.empty()) {
    reader.fail(table, "name", "expected the name of the axis");
  }
  read_start(reader, table, robot.axis[slot], axis);
  read_dynamics(reader, table, axis);
}

void read_axes(Reader& reader, const toml::table& document, const ilk_config_t& robot,
               Parameters& parameters) {
  const toml::table& defaults_table = reader.section(document, "defaults");
  reader.only(defaults_table, dynamics_keys());
  AxisParameters defaults;
  read_dynamics(reader, defaults_table, defaults);

  std::bitset<ILK_SLOTS> found;
  for (const toml::table* table : reader.tables(document, "axis")) {
    read_axis(reader, *table, robot, defaults, parameters, found);
  }
  for (std::size_t slot = 0; slot < ILK_SLOTS; ++slot) {
    if (drives_motor(robot.axis[slot].card) && !found[slot]) {
      reader.fail(document, "axis",
                  "expected an [[axis]] for the motor card in slot " + std::to_string(slot));
    }
  }
}

void read_input(Reader& reader, const toml::table& table, SensorParameters& sensor) {
  constexpr double kLargestReading = 65535;
  reader.only(table, {"adc", "zero_counts", "noise_counts"});
  std::uint32_t adc = 0;
  AnalogParameters input;
  if (!reader.integer(table, "adc", {1, wire::kAnalogInputs}, adc) || sensor.input[adc - 1]) {
    reader.fail(table, "adc", "expected the number of the input, 1 to 4, each once");
    return;
  }
  if (!reader.integer(table, "zero_counts", {0, kLargestReading}, input.zero_counts)) {
    reader.fail(table, "zero_counts", "expected the reading without force, 0 to 65535");
  }
  reader.integer(table, "noise_counts", {0, 1000}, input.noise_counts);
  sensor.input[adc - 1] = input;
}

void read_sensor(Reader& reader, const toml::table& table, const ilk_config_t& robot, Parameters& parameters,
                 std::bitset<ILK_SLOTS>& found) {
  reader.only(table, {"slot", "name", "input"});
  std::uint32_t slot = 0;
  if (!reader.integer(table, "slot", {0, ILK_SLOTS - 1}, slot) || robot.axis[slot].card != ILK_CARD_SENSOR ||
      found[slot]) {
    reader.fail(table, "slot", "expected the slot of a sensor card of the robot, each once");
    return;
  }
  found[slot] = true;
  SensorParameters& sensor = parameters.sensor[slot];
  sensor.name = table["name"].value_or(std::string());
  if (sensor.name.empty()) {
    reader.fail(table, "name", "expected the name of the sensor");
  }
  for (const toml::table* input : reader.tables(table, "input")) {
    read_input(reader, *input, sensor);
  }
}

void read_sensors(Reader& reader, const toml::table& document, const ilk_config_t& robot,
                  Parameters& parameters) {
  std::bitset<ILK_SLOTS> found;
  for (const toml::table* table : reader.tables(document, "sensor")) {
    read_sensor(reader, *table, robot, parameters, found);
  }
}

}  // namespace

tl::expected<Parameters, std::string> load_parameters(const std::filesystem::path& path,
                                                      const ilk_config_t& robot) {
  toml::table document;
  try {
    document = toml::parse_file(path.string());
  } catch (const toml::parse_error& error) {
    return tl::unexpected(path.string() + ":" + std::to_string(error.source().begin.line) + ": " +
                          std::string(error.description()));
  }
  Reader reader(path.string());
  Parameters parameters = default_parameters(robot);
  reader.only(document, {"pedal", "estop", "defaults", "axis", "sensor"}, kSceneKeys);
  const toml::table& pedal = reader.section(document, "pedal");
  reader.only(pedal, {"lag_ms", "bounce_ms"});
  reader.milliseconds(pedal, "lag_ms", {0, 1000}, parameters.pedal.lag);
  reader.milliseconds(pedal, "bounce_ms", {0, 1000}, parameters.pedal.bounce);
  const toml::table& estop = reader.section(document, "estop");
  reader.only(estop, {"bounce_ms"});
  reader.milliseconds(estop, "bounce_ms", {0, 1000}, parameters.estop.bounce);
  read_axes(reader, document, robot, parameters);
  read_sensors(reader, document, robot, parameters);
  parameters.scene = read_scene(reader, document, robot, parameters);
  if (!reader.fault().empty()) {
    return tl::unexpected(reader.fault());
  }
  return parameters;
}

}  // namespace interlock::plant
