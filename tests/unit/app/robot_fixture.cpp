#include "robot_fixture.hpp"

#include <algorithm>
#include <stdexcept>

#include "robot/compile.hpp"

namespace interlock::test {

const ilk_config_t& neuro_config() {
  static const ilk_config_t config = config_of(neuro());
  return config;
}

const ilk_config_t& prostate_config() {
  static const ilk_config_t config = config_of(prostate());
  return config;
}

ilk_config_t config_of(const Robot& robot) {
  const auto compiled = compile(robot);
  return compiled ? *compiled : throw std::runtime_error(compiled.error().message());
}

void move(ControlView& view, std::uint32_t slot, std::int32_t counts) {
  ilk_axis_t& moved = view.snapshot.state.axis[slot];
  const bool is_corrected = neuro_config().axis[slot].direction_correction != 0;
  moved.position_counts += counts;
  moved.raw += static_cast<std::uint32_t>(is_corrected ? -counts : counts);
}

ControlView ready_view() { return ready_view(neuro()); }

ControlView ready_view(const Robot& robot) {
  const ilk_config_t config = config_of(robot);
  ControlView view;
  view.attached = true;
  view.generation = 1;
  view.received = std::chrono::steady_clock::now();
  view.snapshot.config_crc = config.crc;
  view.snapshot.period_us = config.common.period_us;
  view.snapshot.state.system.tick = 1000;
  view.snapshot.state.system.mode = ILK_MODE_READY;
  for (const Axis& axis : robot.axes) {
    ilk_axis_t& state = view.snapshot.state.axis[axis.slot];
    state.state = ILK_AXIS_ENABLED;
    state.homed = 1;
    state.card_seen = 1;
    state.card_valid = 1;
    state.position_counts = (axis.soft_limits.min_counts + axis.soft_limits.max_counts) / 2;
  }
  return view;
}

ControlView needle_view(std::uint32_t hand_counts, std::uint32_t needle_counts) {
  ControlView view = ready_view(prostate());
  for (const Axis& axis : prostate().axes) {
    std::int32_t& position = view.snapshot.state.axis[axis.slot].position_counts;
    const bool is_slider = axis.role != "insertion" && axis.role != "rotation";
    const std::int32_t parked = position < 0 ? -375000 : 375000;
    position = is_slider ? parked : std::max(0, axis.lowest_setpoint_counts());
  }
  view.force.count = 1000;
  view.force.tick = view.snapshot.state.system.tick;
  view.force.hand = hand_counts;
  view.force.needle = needle_counts;
  view.force.last_hand.fill(hand_counts);
  view.force.last_needle.fill(needle_counts);
  return view;
}

}  // namespace interlock::test
