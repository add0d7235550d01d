#include "service/status_json.hpp"

#include <array>
#include <utility>

#include "build_info/build_info.hpp"
#include "interlock/sim_bus.h"
#include "link/card_frame.hpp"
#include "motion/axis_plan.hpp"
#include "motion/setpoint_range.hpp"
#include "robot/catalog.hpp"
#include "robot/compile.hpp"

namespace interlock {
namespace {

using catalog::Family;
using nlohmann::json;

const std::array<const char*, ILK_PHASE_COUNT> phase_names{"wake", "bus", "step", "publish"};

json causes_json(std::uint32_t causes_seen) {
  json causes = json::array();
  for (const catalog::Entry& cause : catalog::entries(Family::cause)) {
    if (((causes_seen >> cause.number) & 1u) != 0) {
      causes.push_back(cause.name);
    }
  }
  return causes;
}

json lamps_json(const ilk_snapshot_t& snapshot) {
  json lamps = json::object();
  for (std::uint32_t lamp = 0; lamp < ILK_LAMP_COUNT; ++lamp) {
    lamps[catalog::name(Family::lamp, lamp)] = catalog::name(Family::colour, snapshot.lamp[lamp]);
  }
  return lamps;
}

/** How long the card's newest valid frame lies back, by the kernel's clock; null when none has come yet. */
json frame_age_ms(const ilk_config_t& config, const ilk_state_t& state, std::uint32_t slot) {
  const std::uint32_t missed = state.axis[slot].bad_frames;
  return missed < state.system.tick ? json(missed * (config.common.period_us / 1000.0)) : json();
}

json cards_json(const ilk_config_t& config, const ilk_snapshot_t& snapshot) {
  const ilk_state_t& state = snapshot.state;
  json cards = json::array();
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    const ilk_axis_t& axis = state.axis[slot];
    const bool expected = config.axis[slot].card != ILK_CARD_NONE;
    cards.push_back({{"slot", slot},
                     {"card", catalog::name(Family::card, config.axis[slot].card)},
                     {"detected", card_frame::detected(config, state, slot)},
                     {"heartbeat", card_frame::heartbeat(snapshot, slot)},
                     // A frame that is repeated or late is not valid.
                     {"heartbeat_live", expected && axis.card_valid != 0},
                     {"frame_age_ms", expected ? frame_age_ms(config, state, slot) : json()},
                     {"checksum_failures", axis.checksum_failures}});
  }
  return cards;
}

json timing_json(const ilk_timing_t& timing) {
  json phases = json::object();
  for (std::size_t phase = 0; phase < phase_names.size(); ++phase) {
    phases[phase_names[phase]] = {{"max_ns", timing.max_ns[phase]}, {"buckets", timing.bucket[phase]}};
  }
  return phases;
}

const char* power_name(const ilk_config_t& config, const ilk_snapshot_t& snapshot) {
  if (snapshot.power == 0) {
    return "off";
  }
  return power_is_up(config, snapshot) ? "on" : "coming_up";
}

const char* clock_name(const ilk_snapshot_t& snapshot) {
  if (snapshot.clock == ILK_CLOCK_REAL) {
    return "real";
  }
  return snapshot.pace_ns != 0 ? "paced" : "sim";
}

/** How late the host is; null unless simulated time waits for it. */
json host_late_json(const ilk_snapshot_t& snapshot, double age_ms) {
  constexpr double second_ms = 1000.0;
  constexpr double ns_per_ms = 1e6;
  if (snapshot.clock == ILK_CLOCK_REAL || snapshot.pace_ns == 0) {
    return nullptr;
  }
  const ilk_lateness_t& late = snapshot.lateness;
  // The next tick is due a tick after the last one.
  const double overdue_ms = age_ms - static_cast<double>(snapshot.pace_ns) / ns_per_ms;
  return {{"now_ms", age_ms < second_ms ? late.second_us / 1000.0 : overdue_ms},
          {"worst_ms", late.worst_us / 1000.0},
          {"total_ms", late.total_ms}};
}

json verdict_event(const ilk_event_t& event) {
  return {{"kind", "verdict"},
          {"sequence", event.value[0]},
          {"request", catalog::name(Family::request, event.value[1])},
          {"slot", event.value[2]},
          {"verdict", catalog::name(Family::verdict, event.value[3])}};
}

json mode_event(const ilk_event_t& event) {
  return {{"kind", "mode"},
          {"from", catalog::name(Family::mode, event.value[0])},
          {"to", catalog::name(Family::mode, event.value[1])},
          {"cause", catalog::name(Family::cause, event.value[2])},
          {"cause_value", event.value[3]}};
}

json fault_event(const ilk_event_t& event) {
  return {{"kind", "fault"},
          {"slot", event.value[0]},
          {"fault", catalog::name(Family::fault, event.value[1])},
          {"fault_value", static_cast<std::int32_t>(event.value[2])}};
}

json axis_event(const ilk_event_t& event) {
  return {{"kind", "axis"},
          {"slot", event.value[0]},
          {"from", catalog::name(Family::axis_state, event.value[1])},
          {"to", catalog::name(Family::axis_state, event.value[2])},
          {"homed", event.value[3] != 0}};
}

json event_body(const ilk_event_t& event) {
  switch (event.kind) {
    case ILK_EVENT_VERDICT:
      return verdict_event(event);
    case ILK_EVENT_MODE:
      return mode_event(event);
    case ILK_EVENT_FAULT:
      return fault_event(event);
    case ILK_EVENT_AXIS:
      return axis_event(event);
    default:
      return {{"kind", "unknown"}};
  }
}

}  // namespace

bool power_is_up(const ilk_config_t& config, const ilk_snapshot_t& snapshot) {
  return snapshot.power != 0 && snapshot.state.system.powered_ticks >= config.common.power_up_ticks;
}

json status_json(const Robot& robot, const ilk_config_t& config, const ControlView& view,
                 std::string_view app_mode, std::chrono::steady_clock::time_point now) {
  static const ControlView nothing{};
  const ControlView& shown = view.attached ? view : nothing;
  const ilk_snapshot_t& snapshot = shown.snapshot;
  const ilk_state_t& state = snapshot.state;
  const std::chrono::duration<double, std::milli> age =
      view.attached ? now - view.received : std::chrono::steady_clock::duration::zero();
  return {{"version", version()},
          {"commit", commit()},
          {"robot", robot.name},
          {"simulated", snapshot.simulated != 0},
          {"degraded", snapshot.degraded != 0},
          {"clock", clock_name(snapshot)},
          {"host_late", host_late_json(snapshot, age.count())},
          {"replay", view.replay},
          {"connected", view.attached},
          {"mode", catalog::name(Family::mode, state.system.mode)},
          {"cause", catalog::name(Family::cause, state.system.cause)},
          {"cause_tick", state.system.cause_tick},
          {"cause_value", state.system.cause_value},
          {"causes_seen", causes_json(state.system.causes_seen)},
          {"tick", state.system.tick},
          {"estop", state.system.estop != 0},
          {"pedal", catalog::name(Family::pedal, state.system.pedal)},
          {"pedal_armed", state.system.pedal_armed != 0},
          {"power", power_name(config, snapshot)},
          {"consent", state.system.consent},
          {"app_alive", state.system.app_alive != 0},
          {"holder", state.system.holder},
          {"app_mode", app_mode},
          {"overruns", snapshot.overruns},
          {"config_crc", config_hash(config)},
          {"age_ms", age.count()},
          {"lamps", lamps_json(snapshot)},
          {"cards", cards_json(config, snapshot)},
          {"timing", timing_json(snapshot.timing)}};
}

json motor_json(const Axis& axis, const ilk_config_t& config, const ControlView& view,
                const MotionRegistry& registry) {
  const ilk_axis_config_t& rules = config.axis[axis.slot];
  const ilk_axis_t& state = view.snapshot.state.axis[axis.slot];
  const SetpointRange range = setpoint_range(rules, state, view.snapshot.state.system.mode);
  json motor{{"slot", axis.slot},
             {"name", axis.name},
             {"title", axis.title},
             {"card", catalog::name(Family::card, rules.card)},
             {"unit", unit_name(axis.unit)},
             {"counts_per_unit", axis.counts_per_unit},
             {"state", catalog::name(Family::axis_state, state.state)},
             {"fault", catalog::name(Family::fault, state.fault)},
             {"fault_value", state.fault_value},
             {"position_counts", state.position_counts},
             {"position", axis.to_unit(state.position_counts)},
             {"setpoint_counts", nullptr},
             {"setpoint", nullptr},
             {"min_counts", range.lowest_counts},
             {"max_counts", range.highest_counts},
             {"soft_min_counts", rules.min_counts},
             {"soft_max_counts", rules.max_counts},
             {"coast_counts", rules.coast_counts},
             {"unhomed_travel_counts", rules.unhomed_travel_counts},
             {"homed", state.homed != 0},
             {"homed_by", catalog::name(Family::homed, state.homed)},
             {"home_difference_counts", state.home_difference_counts},
             {"homing", registry.homes(axis.slot)},
             {"has_switch", rules.limit_side != ILK_LIMIT_NONE},
             {"switch", state.switch_triggered != 0},
             {"limit_side", catalog::name(Family::limit_side, rules.limit_side)},
             {"gate", catalog::name(Family::gate, view.snapshot.gate[axis.slot])},
             {"drive", view.snapshot.command[axis.slot].drive},
             {"max_drive", rules.max_drive},
             {"unhomed_max_drive", rules.unhomed_max_drive},
             {"deadband_counts", rules.deadband_counts}};
  if (const Proposal* open = registry.open_of(axis.slot)) {
    motor["setpoint_counts"] = open->work<MoveTask>()->target_counts;
    motor["setpoint"] = open->target;
  }
  return motor;
}

json event_json(const ilk_event_t& event) {
  json message = event_body(event);
  message["type"] = "event";
  message["tick"] = event.tick;
  return message;
}

std::string event_words(const Robot& robot, const ilk_event_t& event) {
  const auto title = [&](std::uint32_t slot) {
    const Axis* const axis = robot.at_slot(slot);
    return axis == nullptr ? "slot " + std::to_string(slot) : axis->title;
  };
  const auto& value = event.value;
  switch (event.kind) {
    case ILK_EVENT_VERDICT: {
      const bool accepted = value[3] == ILK_VERDICT_ACCEPTED;
      const std::string what = catalog::name(Family::request, value[1]) + " (" + title(value[2]) + ")";
      return "The kernel " + (accepted ? "accepted " + what
                                       : "refused " + what + ": " + catalog::name(Family::verdict, value[3]));
    }
    case ILK_EVENT_MODE:
      return "The kernel went from " + catalog::name(Family::mode, value[0]) + " to " +
             catalog::name(Family::mode, value[1]) +
             (value[1] == ILK_MODE_LOCKED
                  ? ": " + catalog::name(Family::cause, value[2]) + ", value " + std::to_string(value[3])
                  : "");
    case ILK_EVENT_FAULT:
      return title(value[0]) + " faulted: " + catalog::name(Family::fault, value[1]) + ", value " +
             std::to_string(static_cast<std::int32_t>(value[2]));
    case ILK_EVENT_AXIS:
      return title(value[0]) + " went from " + catalog::name(Family::axis_state, value[1]) + " to " +
             catalog::name(Family::axis_state, value[2]) + (value[3] != 0 ? ", homed" : ", not homed");
    default:
      return "The kernel sent an event of kind " + std::to_string(event.kind) +
             ", which this app does not know";
  }
}

json events_lost_json(std::uint32_t count) { return {{"type", "event"}, {"kind", "lost"}, {"count", count}}; }

nlohmann::json stop_json(const std::optional<StopAnswer>& answer) {
  if (!answer || !answer->verdict) {
    return {{"verdict", nullptr}, {"tick", nullptr}};
  }
  return {{"verdict", catalog::name(catalog::Family::verdict, *answer->verdict)}, {"tick", answer->tick}};
}

}  // namespace interlock
