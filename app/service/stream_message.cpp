#include <algorithm>
#include <bit>

#include "interlock/sim_bus.h"
#include "link/card_frame.hpp"
#include "motion/axis_plan.hpp"
#include "motion/setpoint_range.hpp"
#include "service/status_json.hpp"

namespace interlock {
namespace {

class Words {
 public:
  explicit Words(StreamMessage& message) : message_(message) {}

  void put(std::uint32_t word) {
    for (unsigned shift = 0; shift < 32; shift += 8) {
      message_[at_++] = static_cast<std::uint8_t>(word >> shift);
    }
  }
  void put(std::int32_t word) { put(static_cast<std::uint32_t>(word)); }

 private:
  StreamMessage& message_;
  std::size_t at_ = 0;
};

std::uint32_t age_us(const ControlView& view, std::chrono::steady_clock::time_point now) {
  const auto age = std::chrono::duration_cast<std::chrono::microseconds>(now - view.received).count();
  return static_cast<std::uint32_t>(std::clamp<std::int64_t>(age, 0, UINT32_MAX));
}

std::uint32_t bit(bool set, unsigned number) { return set ? 1u << number : 0u; }

void put_header(Words& words, const ControlView& view, const ilk_config_t& config,
                std::chrono::steady_clock::time_point now) {
  const ilk_snapshot_t& snapshot = view.snapshot;
  const ilk_state_t& state = snapshot.state;
  words.put(stream_magic);
  words.put(stream_version);
  words.put(bit(view.attached, 0));
  words.put(state.system.tick);
  words.put(state.system.mode);
  words.put(state.system.cause);
  words.put(state.system.cause_tick);
  words.put(state.system.cause_value);
  words.put(state.system.causes_seen);
  words.put(state.system.pedal);
  words.put(state.system.pedal_armed);
  words.put(state.system.estop);
  words.put(state.system.app_alive);
  words.put(state.system.holder);
  words.put(snapshot.overruns);
  words.put(view.attached ? age_us(view, now) : 0u);
  words.put(bit(snapshot.simulated != 0, 0) | bit(snapshot.degraded != 0, 1) |
            bit(snapshot.clock == ILK_CLOCK_SIM, 2) | bit(view.replay, 3) | bit(snapshot.power != 0, 4) |
            bit(power_is_up(config, snapshot), 5));
  words.put(snapshot.config_crc);
  std::uint32_t lamps = 0;
  for (unsigned lamp = 0; lamp < ILK_LAMP_COUNT; ++lamp) {
    lamps |= (snapshot.lamp[lamp] & 0xFFu) << (8 * lamp);
  }
  words.put(lamps);
  words.put(static_cast<std::uint32_t>(ILK_SLOTS));
}

void put_slot(Words& words, const ControlView& view, const ilk_config_t& config, const OpenTarget& target,
              std::size_t slot) {
  const ilk_axis_config_t& rules = config.axis[slot];
  const ilk_axis_t& axis = view.snapshot.state.axis[slot];
  const bool motor = view.attached && drives_motor(rules.card);
  const SetpointRange range =
      motor ? setpoint_range(rules, axis, view.snapshot.state.system.mode) : SetpointRange{};
  words.put(axis.state);
  words.put(axis.fault);
  words.put(axis.fault_tick);
  words.put(axis.fault_value);
  words.put(bit(axis.homed != 0, 0) | bit(axis.switch_triggered != 0, 1) | bit(axis.card_valid != 0, 2) |
            bit(card_frame::detected(config, view.snapshot.state, slot), 3) | bit(target.open, 4) |
            bit(axis.homed == ILK_HOMED_BY_HAND, 5));
  words.put(view.snapshot.gate[slot]);
  words.put(axis.position_counts);
  words.put(target.open ? target.target_counts : 0);
  words.put(view.snapshot.command[slot].direction);
  words.put(view.snapshot.command[slot].drive);
  words.put(axis.lease_ticks);
  words.put(axis.checksum_failures);
  words.put(card_frame::heartbeat(view.snapshot, slot));
  words.put(range.lowest_counts);
  words.put(range.highest_counts);
  words.put(axis.home_difference_counts);
}

/** The kernel's state, word for word. */
void put_state(Words& words, const ilk_state_t& state) {
  for (const std::uint32_t word : std::bit_cast<std::array<std::uint32_t, stream_state_words>>(state)) {
    words.put(word);
  }
}

}  // namespace

OpenTargets open_targets(const Robot& robot, const MotionRegistry& registry) {
  OpenTargets targets{};
  for (const Axis& axis : robot.axes) {
    if (const Proposal* open = registry.open_of(axis.slot)) {
      targets[axis.slot] = {true, open->work<MoveTask>()->target_counts};
    }
  }
  return targets;
}

StreamMessage encode_state(const ControlView& view, const ilk_config_t& config, const OpenTargets& targets,
                           std::chrono::steady_clock::time_point now) {
  static const ControlView nothing{};
  const ControlView& shown = view.attached ? view : nothing;
  StreamMessage message{};
  Words words(message);
  put_header(words, shown, config, now);
  for (std::size_t slot = 0; slot < ILK_SLOTS; ++slot) {
    put_slot(words, shown, config, view.attached ? targets[slot] : OpenTarget{}, slot);
  }
  put_state(words, shown.snapshot.state);
  return message;
}

}  // namespace interlock
