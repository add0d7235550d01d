#include "cli/model_summary.hpp"

#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>

#include "robot/catalog.hpp"
#include "robot/compile.hpp"

namespace interlock::cli {
namespace {

using nlohmann::ordered_json;

std::string joined(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) {
    text += (text.empty() ? "" : ", ") + part;
  }
  return text;
}

std::string card_name(std::uint32_t card) { return catalog::name(catalog::Family::card, card); }

std::string switch_name(const Axis& axis) {
  return axis.limit == ILK_LIMIT_NONE ? "by hand" : axis.limit == ILK_LIMIT_UPPER ? "upper" : "lower";
}

std::string range_text(const Axis& axis) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(2) << axis.to_unit(axis.soft_limits.min_counts) << " to "
       << axis.to_unit(axis.soft_limits.max_counts) << ' ' << unit_name(axis.unit);
  return text.str();
}

void add_row(std::ostream& text, const std::string& slot, const std::string& card, const std::string& name,
             const std::string& range, const std::string& homes) {
  text << std::left << std::setw(6) << slot << std::setw(16) << card << std::setw(16) << name << std::setw(24)
       << range << homes << '\n';
}

void add_cards(std::ostream& text, const Robot& robot) {
  add_row(text, "slot", "card", "name", "range", "homes");
  for (const Axis& axis : robot.axes) {
    add_row(text, std::to_string(axis.slot), card_name(axis.card), axis.name, range_text(axis),
            switch_name(axis));
  }
  for (const Sensor& sensor : robot.sensors) {
    std::vector<std::string> channels;
    for (const SensorChannel& channel : sensor.channels) {
      channels.push_back(channel.name + " (ADC " + std::to_string(channel.adc) + ')');
    }
    text << std::left << std::setw(6) << sensor.slot << std::setw(16) << card_name(ILK_CARD_SENSOR)
         << std::setw(16) << sensor.name << joined(channels) << '\n';
  }
}

struct Travel {
  std::string kind;
  std::vector<std::string> axes;  /**< names */
  std::vector<AxisCounts> counts; /**< empty when the axes go to their switches */
};

Travel travel_of(const Robot& robot, const HomeStep& step) {
  Travel travel{step.home.empty() ? (step.nudge.empty() ? "move" : "nudge") : "home",
                {},
                step.nudge.empty() ? step.move : step.nudge};
  for (const std::uint32_t slot : step.home) {
    travel.axes.push_back(robot.at_slot(slot)->name);
  }
  for (const AxisCounts& each : travel.counts) {
    travel.axes.push_back(robot.at_slot(each.slot)->name);
  }
  return travel;
}

void add_home_steps(std::ostream& text, const Robot& robot) {
  for (const HomeStep& step : robot.home_steps) {
    const Travel travel = travel_of(robot, step);
    text << "home step " << step.name << ": " << travel.kind << ' ' << joined(travel.axes) << '\n';
  }
}

ordered_json axis_json(const Axis& axis) {
  return {{"slot", axis.slot},
          {"name", axis.name},
          {"title", axis.title},
          {"role", axis.role},
          {"card", card_name(axis.card)},
          {"unit", unit_name(axis.unit)},
          {"counts_per_unit", axis.counts_per_unit},
          {"min_counts", axis.soft_limits.min_counts},
          {"max_counts", axis.soft_limits.max_counts},
          {"limit_side", catalog::name(catalog::Family::limit_side, axis.limit)},
          {"required", axis.required}};
}

ordered_json sensor_json(const Sensor& sensor) {
  ordered_json channels = ordered_json::array();
  for (const SensorChannel& channel : sensor.channels) {
    channels.push_back({{"name", channel.name}, {"adc", channel.adc}, {"unit", channel.unit}});
  }
  return {{"slot", sensor.slot},
          {"name", sensor.name},
          {"title", sensor.title},
          {"required", sensor.required},
          {"channels", channels}};
}

ordered_json step_json(const Robot& robot, const HomeStep& step) {
  const Travel travel = travel_of(robot, step);
  ordered_json object{
      {"name", step.name}, {"title", step.title}, {"kind", travel.kind}, {"axes", travel.axes}};
  if (!travel.counts.empty()) {
    ordered_json counts = ordered_json::object();
    for (const AxisCounts& each : travel.counts) {
      counts[robot.at_slot(each.slot)->name] = each.counts;
    }
    object["counts"] = counts;
  }
  return object;
}

}  // namespace

std::string model_text(const Robot& robot, const ilk_config_t& config) {
  std::ostringstream text;
  text << robot.name << ": " << robot.axes.size() << " axes, configuration " << config_hash(config)
       << ", valid\n"
       << robot.title << ", kinematics " << robot.family << ", modes " << joined(robot.modes)
       << ", a tick every " << robot.period_us << " us\n\n";
  add_cards(text, robot);
  text << '\n';
  add_home_steps(text, robot);
  return text.str();
}

std::string model_json(const Robot& robot, const ilk_config_t& config) {
  ordered_json object{{"valid", true},
                      {"file", robot.origin.file},
                      {"name", robot.name},
                      {"title", robot.title},
                      {"config_crc", config_hash(config)},
                      {"period_us", robot.period_us},
                      {"kinematics", robot.family},
                      {"modes", robot.modes},
                      {"auto_approve", robot.auto_approve},
                      {"axes", ordered_json::array()},
                      {"sensors", ordered_json::array()},
                      {"home_steps", ordered_json::array()}};
  for (const Axis& axis : robot.axes) {
    object["axes"].push_back(axis_json(axis));
  }
  for (const Sensor& sensor : robot.sensors) {
    object["sensors"].push_back(sensor_json(sensor));
  }
  for (const HomeStep& step : robot.home_steps) {
    object["home_steps"].push_back(step_json(robot, step));
  }
  return object.dump(2) + '\n';
}

std::string model_json(const RobotError& error) {
  const ordered_json object{{"valid", false},   {"file", error.file},       {"line", error.line},
                            {"key", error.key}, {"problem", error.problem}, {"expected", error.expected}};
  return object.dump(2, ' ', false, ordered_json::error_handler_t::replace) + '\n';
}

}  // namespace interlock::cli
