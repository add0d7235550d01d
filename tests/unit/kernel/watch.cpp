#include "watch.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace interlock::kernel_test {

namespace {

bool is_motor(const ilk_axis_config_t& axis) {
  return axis.card != ILK_CARD_NONE && axis.card != ILK_CARD_SENSOR;
}

}  // namespace

void SafetyWatch::judge(const ilk_inputs_t& in, std::span<const ilk_request_t> requests, uint32_t count,
                        const ilk_state_t& state, const ilk_outputs_t& out) {
  if (failed_) return;
  observe_frames(in);
  observe_contacts(in);
  observe_verdicts(requests, out);

  std::string broken = judge_verdicts(requests, count, out);
  if (broken.empty()) broken = judge_modes(state, out);
  for (uint32_t slot = 0; slot < ILK_SLOTS && broken.empty(); ++slot) {
    broken = judge_axis(slot, in, state, out);
    if (!broken.empty()) broken += ", slot " + std::to_string(slot);
  }
  if (!broken.empty()) {
    failed_ = true;
    ADD_FAILURE() << "tick " << state.system.tick << ": " << broken;
  }
  remember(state, out);
}

void SafetyWatch::observe_frames(const ilk_inputs_t& in) {
  for (uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    AxisView& axis = axis_[slot];
    const std::span<const uint32_t> frame(in.frame[slot]);
    const bool heard = !echo_ || *echo_ == frame[incoming::tick_echo];
    axis.valid = config_.axis[slot].card != ILK_CARD_NONE && in.transaction_done == 1 &&
                 (in.frames_received >> slot & 1u) == 1 && start_and_checksum_right(frame) && heard;
    axis.periods += 1 + uint64_t{in.deadlines_missed};
    axis.jump = 0;
    if (!axis.valid) {
      axis.bad_frames += 1;
      if (axis.bad_frames >= config_.common.bad_frame_limit) axis.raw.reset();
      continue;
    }
    const uint32_t raw = frame[incoming::encoder];
    if (axis.raw) {
      const auto delta = static_cast<int64_t>(static_cast<int32_t>(raw - *axis.raw));
      const uint64_t distance = static_cast<uint64_t>(delta < 0 ? -delta : delta);
      const uint64_t reach = uint64_t{config_.axis[slot].max_delta_counts} * axis.periods;
      axis.jump = distance > reach ? distance : 0;
    }
    axis.raw = raw;
    axis.bad_frames = 0;
    axis.periods = 0;
  }
}

void SafetyWatch::observe_contacts(const ilk_inputs_t& in) {
  const bool two = config_.common.pedal_channels == 2;
  pressed_ = in.pedal_no_closed == 1 && (!two || in.pedal_nc_closed == 0);
  released_ = in.pedal_no_closed == 0 && (!two || in.pedal_nc_closed == 1);
  pressed_ticks_ = pressed_ ? pressed_ticks_ + 1 : 0;
  silent_ticks_ += silent_ticks_ < UINT32_MAX ? 1 : 0;
  const bool may_arm = mode_ == ILK_MODE_READY && silent_ticks_ < config_.common.app_timeout_ticks;
  released_in_ready_ = released_ && may_arm ? released_in_ready_ + 1 : 0;
  armed_ = may_arm && (armed_ || released_in_ready_ >= config_.common.pedal_debounce_ticks);
}

void SafetyWatch::observe_verdicts(std::span<const ilk_request_t> requests, const ilk_outputs_t& out) {
  reset_accepted_ = false;
  cleared_ = 0;
  commanded_ = 0;
  const uint32_t judged = std::min<uint32_t>(out.verdict_count, ILK_REQUESTS_PER_TICK);
  for (uint32_t index = 0; index < judged && index < requests.size(); ++index) {
    if (out.verdict[index].verdict != ILK_VERDICT_ACCEPTED) continue;
    const ilk_request_t& request = requests[index];
    if (request.kind == ILK_REQUEST_HEARTBEAT) silent_ticks_ = 0;
    if (request.kind == ILK_REQUEST_STOP ||
        (request.kind == ILK_REQUEST_HEARTBEAT && request.holder != holder_)) {
      armed_ = false;
      released_in_ready_ = 0;
    }
    if (request.kind == ILK_REQUEST_HEARTBEAT) holder_ = request.holder;
    if (request.kind == ILK_REQUEST_MOVE || request.kind == ILK_REQUEST_HOME)
      consents_.insert(request.consent);
    if (request.kind == ILK_REQUEST_RESET) reset_accepted_ = true;
    if (request.axis >= ILK_SLOTS) continue;
    if (request.kind == ILK_REQUEST_CLEAR_FAULT) cleared_ |= 1u << request.axis;
    if (request.kind == ILK_REQUEST_MOVE) {
      axis_[request.axis].lease = request.lease_ticks + 1;
      axis_[request.axis].homing = false;
      commanded_ |= 1u << request.axis;
    }
    if (request.kind == ILK_REQUEST_HOME) {
      axis_[request.axis].homing = true;
      axis_[request.axis].lease = 0;
      commanded_ |= 1u << request.axis;
    }
  }
}

std::string SafetyWatch::judge_verdicts(std::span<const ilk_request_t> requests, uint32_t count,
                                        const ilk_outputs_t& out) const {
  if (out.verdict_count != std::min<uint32_t>(count, ILK_REQUESTS_PER_TICK)) {
    return "P11: not one verdict for each request";
  }
  for (uint32_t index = 0; index < out.verdict_count; ++index) {
    const ilk_verdict_record_t& record = out.verdict[index];
    if (record.sequence != requests[index].sequence || record.kind != requests[index].kind ||
        record.axis != requests[index].axis || record.verdict >= ILK_VERDICT_COUNT) {
      return "P11: a verdict does not name its request";
    }
  }
  return {};
}

std::string SafetyWatch::judge_modes(const ilk_state_t& state, const ilk_outputs_t& out) const {
  const bool relocked = state.system.cause == ILK_CAUSE_INTEGRITY;
  if (mode_ == ILK_MODE_LOCKED) {
    if (state.system.mode != ILK_MODE_LOCKED && !reset_accepted_) return "P8: LOCKED was left without RESET";
    if (state.system.mode == ILK_MODE_LOCKED && state.system.cause != cause_ && !relocked &&
        !reset_accepted_) {
      return "P8: the first cause was overwritten";
    }
  }
  const bool on = state.system.mode == ILK_MODE_READY || state.system.mode == ILK_MODE_MOTION;
  if ((out.power == 1) != on) return "P1: power is not that of the mode";
  if ((state.system.mode == ILK_MODE_MOTION) != (state.system.consent != 0))
    return "P12: consent outside of MOTION";
  if (state.system.mode == ILK_MODE_MOTION && mode_ != ILK_MODE_MOTION) {
    if (mode_ != ILK_MODE_READY) return "P9: MOTION was entered from another mode than READY";
    if (!armed_) return "P9: MOTION was entered without a release seen in READY";
    if (pressed_ticks_ < config_.common.pedal_debounce_ticks)
      return "P9: MOTION was entered on a press not debounced";
  }
  return {};
}

std::string SafetyWatch::judge_axis(uint32_t slot, const ilk_inputs_t& in, const ilk_state_t& state,
                                    const ilk_outputs_t& out) const {
  const AxisView& before = axis_[slot];
  const ilk_axis_t& axis = state.axis[slot];
  const std::span<const uint32_t> wire(out.frame[slot]);
  if (!is_motor(config_.axis[slot])) {
    return drive_words_zero(wire) ? std::string{} : "P1: a slot without a motor is driven";
  }
  if (before.state == ILK_AXIS_FAULTED && axis.state != ILK_AXIS_FAULTED && (cleared_ >> slot & 1u) == 0 &&
      state.system.cause != ILK_CAUSE_INTEGRITY) {
    return "P8: a fault was left without CLEAR_FAULT";
  }
  if (before.jump > 0 && axis.state != ILK_AXIS_FAULTED && state.system.mode != ILK_MODE_INIT) {
    return "P6: a jump of " + std::to_string(before.jump) + " counts did not fault the axis";
  }
  if ((out.gate[slot] == ILK_GATE_OPEN) != !drive_words_zero(wire)) {
    return "P1: the gate reported and the wire differ";
  }
  const Frame expected = pack(config_.axis[slot], out.command[slot], wire[outgoing::tick]);
  if (!std::equal(expected.begin(), expected.end(), wire.begin())) {
    return "P16: the frame does not carry the command";
  }
  return drive_words_zero(wire) ? std::string{} : judge_drive(slot, in, state, out);
}

std::string SafetyWatch::judge_drive(uint32_t slot, const ilk_inputs_t& in, const ilk_state_t& state,
                                     const ilk_outputs_t& out) const {
  const AxisView& view = axis_[slot];
  const ilk_axis_t& axis = state.axis[slot];
  const ilk_axis_config_t& config = config_.axis[slot];
  const ilk_direction_t direction = wire_direction(config, out.frame[slot]);
  const uint32_t drive = out.command[slot].drive;
  const bool increasing = direction == ILK_DIRECTION_INCREASING;
  const auto coast = static_cast<int32_t>(config.coast_counts);

  if (state.system.mode != ILK_MODE_MOTION) return "P2: drive outside MOTION";
  if (!pressed_) return "P2: drive without the pedal";
  if (in.estop_loop_closed != 1) return "P2: drive with the E-stop active";
  if (silent_ticks_ >= config_.common.app_timeout_ticks) return "P10: drive without the app";
  if (!view.valid) return "P1: drive without a valid frame";
  if (axis.state != ILK_AXIS_MOVING && axis.state != ILK_AXIS_HOMING) return "P1: drive of an axis at rest";
  if (axis.fault != ILK_FAULT_NONE) return "P1: drive of a faulted axis";
  if (!consents_.contains(state.system.consent)) return "P12: drive without an order for this press";
  if (!view.homing && view.lease <= 1 && (commanded_ >> slot & 1u) == 0) {
    return "P1: drive without a live lease";
  }
  const bool at_switch = (in.frame[slot][incoming::pairs] & incoming::switch_open_bit) == 0;
  if (at_switch && config.limit_side == (increasing ? ILK_LIMIT_UPPER : ILK_LIMIT_LOWER)) {
    return "P3: drive towards a triggered switch";
  }
  if (axis.homed != ILK_HOMED_NOT && (increasing ? axis.position_counts >= config.max_counts - coast
                                                 : axis.position_counts <= config.min_counts + coast)) {
    return "P4: drive outward at a soft limit";
  }
  if (drive > config.max_drive) return "P7: drive above its bound";
  if (axis.homed == ILK_HOMED_NOT && drive > config.unhomed_max_drive)
    return "P7: drive above the unhomed bound";
  return {};
}

void SafetyWatch::remember(const ilk_state_t& state, const ilk_outputs_t& out) {
  for (uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    AxisView& view = axis_[slot];
    const bool motion = state.system.mode == ILK_MODE_MOTION;
    view.state = state.axis[slot].state;
    view.lease = motion && view.lease > 1 ? view.lease - 1 : 0;
    view.homing = motion && view.homing && view.state == ILK_AXIS_HOMING;
  }
  echo_ = last_sent_;
  last_sent_ = out.frame[0][outgoing::tick];
  if (state.system.mode != ILK_MODE_MOTION) consents_.clear();
  mode_ = state.system.mode;
  cause_ = state.system.cause;
}

}  // namespace interlock::kernel_test
