#include <string>
#include <utility>

#include "cli/replay_views.hpp"
#include "robot/catalog.hpp"

namespace interlock::cli {
namespace {

using catalog::Family;

constexpr double ns_per_s = 1e9;
constexpr const char* measured = "#0b62a4";
constexpr const char* desired = "#d1495b";

/** The drive with the sense of its direction. */
double signed_drive(const ilk_command_t& command) {
  const double drive = command.drive;
  return command.direction == ILK_DIRECTION_DECREASING ? -drive : drive;
}

bool has_setpoint(const ilk_axis_t& axis) { return axis.state == ILK_AXIS_MOVING; }

}  // namespace

ReplayedRobot::ReplayedRobot(const ilk_config_t& config) {
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    if (config.axis[slot].card != ILK_CARD_NONE) {
      slots_.push_back(slot);
    }
    if (config.axis[slot].card != ILK_CARD_NONE && config.axis[slot].card != ILK_CARD_SENSOR) {
      axes_.push_back(slot);
    }
  }
}

ReplayCsv::ReplayCsv(const ReplayedRobot& robot, std::ostream& output) : robot_(robot), output_(output) {
  output_ << "tick,begun_ns,mode,cause,pedal,estop,app_alive,holder,requests,accepted,refused,state_hash";
  for (const std::uint32_t slot : robot_.slots()) {
    for (const char* const column : {"state", "fault", "homed", "switch", "card_valid", "position_counts",
                                     "setpoint_counts", "direction", "drive", "gate"}) {
      output_ << ",slot" << slot << '_' << column;
    }
  }
  output_ << '\n';
}

void ReplayCsv::add(const ilk_recorded_tick_t& tick) {
  const ilk_state_t& state = tick.picture.state;
  const ilk_outputs_t& out = tick.picture.out;
  output_ << state.system.tick << ',' << tick.begun_ns << ','
          << catalog::name(Family::mode, state.system.mode) << ','
          << catalog::name(Family::cause, state.system.cause) << ','
          << catalog::name(Family::pedal, state.system.pedal) << ',' << state.system.estop << ','
          << state.system.app_alive << ',' << state.system.holder << ',' << tick.request_count << ','
          << state.system.requests_accepted << ',' << state.system.requests_refused << ','
          << tick.state_digest;
  for (const std::uint32_t slot : robot_.slots()) {
    const ilk_axis_t& axis = state.axis[slot];
    output_ << ',' << catalog::name(Family::axis_state, axis.state) << ','
            << catalog::name(Family::fault, axis.fault) << ',' << axis.homed << ',' << axis.switch_triggered
            << ',' << axis.card_valid << ',' << axis.position_counts << ',' << axis.setpoint_counts << ','
            << catalog::name(Family::direction, out.command[slot].direction) << ',' << out.command[slot].drive
            << ',' << catalog::name(Family::gate, out.gate[slot]);
  }
  output_ << '\n';
}

ReplayPlot::ReplayPlot(const ReplayedRobot& robot, std::string title) : robot_(robot) {
  chart_.title = std::move(title);
  for (const std::uint32_t slot : robot_.axes()) {
    const std::string name = "slot " + std::to_string(slot);
    chart_.panels.push_back({name + ", counts", {{"position", measured, {}}, {"setpoint", desired, {}}}});
    chart_.panels.push_back({name + ", drive", {{"drive", measured, {}}}});
  }
  chart_.panels.push_back({"mode: 1 LOCKED, 2 READY, 3 MOTION", {{"mode", measured, {}}}});
}

void ReplayPlot::add(const ilk_recorded_tick_t& tick) {
  const ilk_state_t& state = tick.picture.state;
  const std::uint64_t first = first_ns_.value_or(tick.begun_ns);
  first_ns_ = first;
  const double time_s = static_cast<double>(tick.begun_ns - first) / ns_per_s;
  const bool later = chart_.times_s.empty() || time_s > chart_.times_s.back();
  if (!later) {
    return;
  }
  chart_.times_s.push_back(time_s);
  auto panel = chart_.panels.begin();
  for (const std::uint32_t slot : robot_.axes()) {
    const ilk_axis_t& axis = state.axis[slot];
    panel->series[0].values.emplace_back(axis.position_counts);
    panel->series[1].values.push_back(has_setpoint(axis) ? std::optional<double>(axis.setpoint_counts)
                                                         : std::nullopt);
    ++panel;
    panel->series[0].values.emplace_back(signed_drive(tick.picture.out.command[slot]));
    ++panel;
  }
  panel->series[0].values.emplace_back(state.system.mode);
}

}  // namespace interlock::cli
