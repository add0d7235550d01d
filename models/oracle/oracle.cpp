#include "oracle/oracle.hpp"

#include <algorithm>
#include <limits>
#include <string_view>

namespace interlock::oracle {
namespace {

constexpr std::uint32_t kFirstJudgedEcho =
    2; /**< before that tick of the kernel no frame can have been answered */
constexpr std::uint32_t kMostMessages = 16; /**< that the kernel looks at in one tick */

}  // namespace

Oracle::Oracle(const SystemRules& rules) : rules_(rules), system_(rules_) {
  axes_.reserve(kSlots);
  for (std::size_t slot = 0; slot < kSlots; slot++) {
    axes_.emplace_back(rules_.axes[slot], rules_, static_cast<std::int8_t>(slot));
  }
}

bool Oracle::any_drive(const Observation& seen) const noexcept {
  return !std::ranges::all_of(seen.to_card, wire::is_zero_drive);
}

std::uint32_t Oracle::counter_of(const Observation& seen) const noexcept {
  const auto card = std::ranges::find_if(
      rules_.axes, [](CardKind kind) { return kind != CardKind::kNone; }, &AxisRules::card);
  return card == rules_.axes.end()
             ? seen.tick
             : wire::tick_counter(seen.to_card[static_cast<std::size_t>(card - rules_.axes.begin())]);
}

/** A kernel whose memory was damaged may count from its start again, in LOCKED. */
bool Oracle::starts_anew(const Observation& seen) const noexcept {
  return seen.state_damaged && seen.claim.mode == Mode::kLocked && counter_of(seen) != sent_counters_[0] + 1;
}

void Oracle::note_counter(const Observation& seen) noexcept {
  const std::uint32_t counter = counter_of(seen);
  const bool anew = kernel_ticks_ == 0 || starts_anew(seen);
  if (!anew && counter != sent_counters_[0] + 1) {
    findings_.report(seen.tick, Property::kP16, kNoAxis, "the tick counter does not count");
  }
  kernel_ticks_ = anew ? 1 : std::min(kernel_ticks_ + 1, kFirstJudgedEcho);
  sent_counters_ = {counter, sent_counters_[0]};
}

void Oracle::judge_frames(const Observation& seen) noexcept {
  note_counter(seen);
  for (std::size_t slot = 0; slot < kSlots; slot++) {
    const wire::FrameView frame = seen.to_card[slot];
    const auto axis = static_cast<std::int8_t>(slot);
    if (rules_.axes[slot].card != CardKind::kNone &&
        (!wire::is_intact(frame) || wire::tick_counter(frame) != sent_counters_[0])) {
      findings_.report(seen.tick, Property::kP16, axis,
                       "a frame without start word, checksum or the tick of the others");
    }
    if (!has_axis(rules_.axes[slot].card) && !wire::is_zero_drive(frame)) {
      findings_.report(seen.tick, Property::kP16, axis, "drive words for a slot without an axis");
    }
  }
}

void Oracle::judge_stop(const Observation& seen) noexcept {
  if (!any_drive(seen)) {
    return;
  }
  const auto unsafe = [&](Property property, std::string_view reason) {
    findings_.report(seen.tick, property, kNoAxis, reason);
  };
  if (system_.estop_active()) {
    unsafe(Property::kP2, "driven with the E-stop active");
  }
  if (!system_.pedal_pressed()) {
    unsafe(Property::kP2, "driven although the pedal is not pressed on every channel");
  }
  if (system_.bus_lost()) {
    unsafe(Property::kP2, "driven on a lost bus");
  }
  if (!system_.app_alive()) {
    unsafe(Property::kP10, "driven although the app is silent");
  }
  if (seen.claim.mode == Mode::kInit) {
    unsafe(Property::kP13, "driven in INIT");
  } else if (seen.claim.mode != Mode::kMotion) {
    unsafe(Property::kP2, "driven outside of MOTION");
  }
}

void Oracle::judge_damage(const Observation& seen) noexcept {
  if (seen.undamaged.empty() || (seen.claim.mode == Mode::kLocked && !any_drive(seen))) {
    return;
  }
  for (std::size_t slot = 0; slot < kSlots; slot++) {
    if (!std::ranges::equal(seen.to_card[slot], seen.undamaged[slot])) {
      findings_.report(seen.tick, Property::kP14, static_cast<std::int8_t>(slot),
                       "damaged memory changed an output without locking");
    }
  }
}

bool Oracle::is_in_order(const Message& message) noexcept {
  const std::uint32_t ahead = message.sequence - sequence_;
  if (!message.intact ||
      (sequence_known_ && (ahead == 0 || ahead > std::uint32_t{std::numeric_limits<std::int32_t>::max()}))) {
    return false;
  }
  sequence_known_ = true;
  sequence_ = message.sequence;
  return true;
}

void Oracle::take_accepted(const Observation& seen, const Message& message) noexcept {
  if (seen.claim.mode == Mode::kInit) {
    findings_.report(seen.tick, Property::kP13, kNoAxis, "a request accepted in INIT");
  }
  switch (message.order) {
    case Order::kHeartbeat:
      system_.accept_heartbeat(seen, message.holder);
      return;
    case Order::kStop:
      system_.accept_stop();
      return;
    case Order::kReset:
      system_.accept_reset(seen, findings_);
      return;
    case Order::kUnknown:
      findings_.report(seen.tick, Property::kP11, kNoAxis, "an unknown request accepted");
      return;
    case Order::kEnable:
    case Order::kDisable:
    case Order::kClearFault:
    case Order::kMove:
    case Order::kHome:
    case Order::kSetHome:
    case Order::kRestore:
    default:
      break;
  }
  if (message.axis >= kSlots) {
    findings_.report(seen.tick, Property::kP11, kNoAxis, "a request accepted for a slot that does not exist");
    return;
  }
  axes_[message.axis].accept(seen, message,
                             {system_.may_be_in_motion(), system_.may_be_ready(), system_.pedal_released()},
                             findings_);
}

void Oracle::take_messages(const Observation& seen) noexcept {
  if (seen.app_attached) {
    sequence_known_ = false;
  }
  const std::size_t looked_at = std::min<std::size_t>(seen.messages.size(), kMostMessages);
  if (seen.answers != looked_at) {
    findings_.report(seen.tick, Property::kP11, kNoAxis, "not one verdict for each request");
  }
  for (const Message& message : seen.messages.first(looked_at)) {
    const bool in_order = is_in_order(message);
    if (message.answer == Answer::kNone) {
      findings_.report(seen.tick, Property::kP11, kNoAxis, "a request without a verdict");
    } else if (message.answer == Answer::kRefused) {
      if (message.axis < kSlots && message.order != Order::kHeartbeat) {
        axes_[message.axis].refuse(seen, message);
      }
    } else {
      if (!in_order) {
        findings_.report(seen.tick, Property::kP11, kNoAxis,
                         "a request accepted that is damaged or out of order");
      }
      take_accepted(seen, message);
    }
  }
}

std::span<const Finding> Oracle::step(const Observation& seen) noexcept {
  findings_.clear();
  const bool in_motion = system_.before() == Mode::kMotion;
  const Echo echo{kernel_ticks_ >= kFirstJudgedEcho, sent_counters_[1]};
  bool any_card_valid = false;
  bool new_fault = false;
  bool required_card_lost = false;
  for (std::size_t slot = 0; slot < kSlots; slot++) {
    axes_[slot].see(seen, echo, in_motion);
    any_card_valid = any_card_valid || axes_[slot].card_valid();
    new_fault = new_fault || axes_[slot].faults_now(seen);
    required_card_lost = required_card_lost || (rules_.axes[slot].required && axes_[slot].card_lost());
  }
  if (starts_anew(seen)) {
    std::ranges::for_each(axes_, [&seen](AxisWatch& axis) { axis.forget(seen.tick); });
    sequence_known_ = false;
  }
  system_.see(seen, any_card_valid);
  system_.decide(seen, new_fault, required_card_lost);
  for (const AxisWatch& axis : axes_) {
    axis.judge_due(seen, findings_);
  }
  take_messages(seen);
  judge_frames(seen);
  judge_stop(seen);
  judge_damage(seen);
  for (AxisWatch& axis : axes_) {
    axis.judge(seen, findings_);
  }
  system_.judge(seen, findings_);
  return findings_.kept();
}

}  // namespace interlock::oracle
