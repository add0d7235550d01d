#include "stage.hpp"

#include <algorithm>
#include <cstdlib>
#include <numeric>

namespace interlock::oracle::test {

void seal(Words& frame) {
  frame[0] = 0xFEFEFE01u;
  frame.back() = 0xFFFFFFFFu - std::accumulate(frame.begin(), frame.end() - 1, 0u);
}

SystemRules stage_rules() {
  SystemRules rules;
  for (const std::size_t slot : {0u, 1u}) {
    AxisRules& axis = rules.axes[slot];
    axis.card = CardKind::kPwm;
    axis.switch_end = slot == 0 ? SwitchEnd::kUpper : SwitchEnd::kNone;
    axis.soft_min = -kSoftMax;
    axis.soft_max = kSoftMax;
    axis.home_offset = kSoftMax;
    axis.coast = kCoast;
    axis.deadband = 2;
    axis.max_drive = kMaxDrive;
    axis.unhomed_max_drive = kMaxDrive / 10;
    axis.home_drive = kDrive;
    axis.unhomed_travel = 100;
    axis.stall_min = 3;
    axis.stall_ticks = 50;
    axis.reverse = 15;
    axis.drift = 15;
    axis.settle_ticks = 5;
    axis.max_delta = 20;
  }
  rules.axes[2].card = CardKind::kSensor;
  rules.axes[2].required = true;
  return rules;
}

void Stage::prepare() {
  messages_.clear();
  seen = {};
  seen.tick = next_tick_++;
  seen.pedal_normally_open = pressed_ ? Contact::kClosed : Contact::kOpen;
  seen.pedal_normally_closed = pressed_ ? Contact::kOpen : Contact::kClosed;
  seen.claim = claim;
  seen.truth[0].position = truth;
  for (std::size_t slot = 0; slot < kSlots; slot++) {
    const bool present = rules.axes[slot].card != CardKind::kNone;
    seen.received[slot] = present;
    from_card[slot] = {};
    from_card[slot][2] = slot == 0 && triggered ? 0u : 0x00080000u;
    from_card[slot][3] = slot == 0 ? counter : 0u;
    from_card[slot][9] = seen.tick;
    from_card[slot][11] = seen.tick - 2;
    to_card[slot] = {};
    to_card[slot][13] = seen.tick;
  }
  if (drive_ != 0) {
    to_card[0][3] = (drive_ > 0 ? 0u : 0x80000000u) + static_cast<std::uint32_t>(std::abs(drive_));
    to_card[0][14] = 1;
  }
  if (app_speaks) {
    say(Order::kHeartbeat).holder = 7;
  }
}

void Stage::seal_all() {
  std::ranges::for_each(from_card, seal);
  std::ranges::for_each(to_card, seal);
}

void Stage::play() {
  for (std::size_t slot = 0; slot < kSlots; slot++) {
    seen.from_card[slot] = from_card[slot];
    seen.to_card[slot] = to_card[slot];
  }
  seen.messages = messages_;
  seen.answers += static_cast<std::uint32_t>(messages_.size());
  for (const Finding& finding : oracle_.step(seen)) {
    found.insert(finding.property);
  }
}

void Stage::run(std::uint32_t ticks) {
  for (std::uint32_t tick = 0; tick < ticks; tick++) {
    prepare();
    seal_all();
    play();
  }
}

Message& Stage::say(Order order, std::uint32_t axis) {
  Message message;
  message.order = order;
  message.sequence = ++sequence_;
  message.axis = axis;
  message.answer = Answer::kAccepted;
  return messages_.emplace_back(message);
}

Message& Stage::say_move(std::int32_t target, std::uint32_t lease_ticks, std::uint32_t drive) {
  Message& message = say(Order::kMove);
  message.target = target;
  message.lease_ticks = lease_ticks;
  message.drive = drive;
  return message;
}

void Stage::come_to_ready() {
  claim.mode = Mode::kLocked;
  claim.first_cause = 1;
  claim.axes[0].position = 0;
  run(5);
  claim.mode = Mode::kReady;
  prepare();
  say(Order::kReset);
  seal_all();
  play();
  run(rules.pedal_debounce_ticks);
  claim.axes[0].mode = AxisMode::kEnabled;
  prepare();
  say(Order::kEnable);
  seal_all();
  play();
}

void Stage::come_to_motion() {
  press();
  run(rules.pedal_debounce_ticks - 1);
  claim.mode = Mode::kMotion;
  run(1);
}

void Stage::home_at(std::int32_t position) {
  claim.axes[0].mode = AxisMode::kDisabled;
  claim.axes[0].homed = true;
  prepare();
  say(Order::kDisable);
  say(Order::kSetHome);
  seal_all();
  play();
  const std::int32_t step = position < 0 ? -10 : 10;
  for (std::int32_t at = 0; at != position; at += step) {
    counter += static_cast<std::uint32_t>(step);
    truth += step;
    run(1);
  }
  claim.axes[0].mode = AxisMode::kEnabled;
  prepare();
  say(Order::kEnable);
  seal_all();
  play();
}

}  // namespace interlock::oracle::test
