#include "world.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

#include "flip.hpp"
#include "interlock/kernel.h"
#include "refusal.hpp"

namespace interlock::campaign {
namespace {

constexpr std::uint64_t kRobotStream = 3;
constexpr std::uint64_t kRefusalStream = 4;
constexpr std::uint32_t kLongestPeriodUs = 2000;
constexpr std::uint64_t kCaseFactor = 0x9e3779b97f4a7c15u;
constexpr std::uint32_t kSweepInterval = 64; /**< ticks from one sweep of flipped bits to the next */
constexpr std::uint32_t kSweptBits = 16;
constexpr std::uint64_t kSweepStart = 4999;   /**< bits from where one case begins to where the next does */
constexpr std::uint32_t kRecoveryTicks = 300; /**< after a lie of the encoder, until nothing moves any more */

Manner manner_of(std::uint64_t number) {
  if (sweeps_stops(number)) {
    return Manner::kSteady;
  }
  return homes_patiently(number) ? Manner::kHoming : Manner::kUsual;
}

/** Whoever homes has a robot of the longest period, of which a case lasts longer than a homing may. */
Robot robot_of(std::uint64_t number, plant::Random& random) {
  Robot robot = make_robot(random, manner_of(number) != Manner::kUsual);
  if (homes_patiently(number)) {
    while (robot.config.period_us != kLongestPeriodUs) {
      robot = make_robot(random, true);
    }
    push_to_far_ends(robot, random);
  }
  return robot;
}

constexpr std::string_view kWrongWay = "driven, but not towards its setpoint";
constexpr std::string_view kCardLost = "its card is lost";
constexpr std::string_view kDrifts = "drifts while enabled and not driven";

bool is_zero_drive(const ilk_outputs_t& outputs) {
  return std::ranges::all_of(outputs.frame,
                             [](const auto& frame) { return oracle::wire::is_zero_drive(frame); });
}

oracle::Contact contact_of(std::uint32_t reading) {
  return reading == 1   ? oracle::Contact::kClosed
         : reading == 0 ? oracle::Contact::kOpen
                        : oracle::Contact::kUndefined;
}

oracle::Mode mode_of(std::uint32_t mode) {
  switch (mode) {
    case ILK_MODE_LOCKED:
      return oracle::Mode::kLocked;
    case ILK_MODE_READY:
      return oracle::Mode::kReady;
    case ILK_MODE_MOTION:
      return oracle::Mode::kMotion;
    default:
      return oracle::Mode::kInit;
  }
}

oracle::AxisMode axis_mode_of(std::uint32_t state) {
  switch (state) {
    case ILK_AXIS_DISABLED:
      return oracle::AxisMode::kDisabled;
    case ILK_AXIS_ENABLED:
      return oracle::AxisMode::kEnabled;
    case ILK_AXIS_MOVING:
      return oracle::AxisMode::kMoving;
    case ILK_AXIS_HOMING:
      return oracle::AxisMode::kHoming;
    default:
      return oracle::AxisMode::kFaulted;
  }
}

}  // namespace

void Totals::add(const Totals& other) {
  ticks += other.ticks;
  faults_injected += other.faults_injected;
  unsafe += other.unsafe;
  late += other.late;
  bit_flips += other.bit_flips;
  bit_flips_unsafe += other.bit_flips_unsafe;
  stops_met += other.stops_met;
  motion_ticks += other.motion_ticks;
  driven_axis_ticks += other.driven_axis_ticks;
  homings += other.homings;
  moves_accepted += other.moves_accepted;
  requests_refused += other.requests_refused;
  configurations_refused += other.configurations_refused;
  digest += other.digest;
  std::ranges::transform(faults_by_kind, other.faults_by_kind, faults_by_kind.begin(), std::plus{});
  std::ranges::transform(axis_faults, other.axis_faults, axis_faults.begin(), std::plus{});
  std::ranges::transform(causes, other.causes, causes.begin(), std::plus{});
  kind_pairs |= other.kind_pairs;
  state_bits |= other.state_bits;
  config_bits |= other.config_bits;
  config_bits_driven |= other.config_bits_driven;
  estop_ticks |= other.estop_ticks;
  pedal_ticks |= other.pedal_ticks;
}

World::World(const Case& plan)
    : plan_(plan),
      random_(plan.seed ^ (plan.number * kCaseFactor), kRobotStream),
      robot_(robot_of(plan.number, random_)),
      config_(robot_.config),
      app_(robot_.config, plan.seed ^ (plan.number * kCaseFactor), manner_of(plan.number)),
      plant_(robot_.config, robot_.plant, plan.seed ^ (plan.number * kCaseFactor)),
      oracle_(robot_.rules),
      sweep_bit_(plan.number * kSweepStart % kStateBits) {
  plant::Random refusals(plan.seed ^ (plan.number * kCaseFactor), kRefusalStream);
  unrefused_ = judge_refusals(robot_.config, refusals);
  totals_.configurations_refused = unrefused_ ? 0 : spoilings();
  ilk_init(&config_, &state_);
  for (std::size_t slot = 0; slot < ILK_SLOTS; slot++) {
    seen_.from_card[slot] = inputs_.frame[slot];
    seen_.to_card[slot] = outputs_.frame[slot];
    undamaged_frames_.emplace_back(undamaged_.frame[slot]);
  }
  if (robot_.far_coaster) {
    break_promise(*robot_.far_coaster, std::numeric_limits<std::int32_t>::max());
    totals_.faults_injected++;
  }
}

void World::act(const plant::command::Command& command, std::uint32_t after) {
  // The plant refuses what the robot does not have, a switch for instance: then there is no such fault.
  static_cast<void>(plant_.schedule(command, plant_.ticks() + after));
}

void World::break_promise(std::size_t slot, std::uint32_t ticks) {
  broken_[slot] = true;
  broken_until_[slot] = std::max(broken_until_[slot], tick_ + ticks);
}

void World::renew_promises() {
  for (std::size_t slot = 0; slot < ILK_SLOTS; slot++) {
    const bool over = tick_ - broken_until_[slot] < std::numeric_limits<std::int32_t>::max() &&
                      tick_ - broken_until_[slot] > kRecoveryTicks;
    if (broken_[slot] && over && state_.axis[slot].homed == 0 && state_.mode != ILK_MODE_MOTION) {
      broken_[slot] = false;
    }
    seen_.truth[slot].keeps_promise = !broken_[slot];
  }
}

void World::exchange() {
  if (app_.foot_is_down() != foot_was_down_) {
    foot_was_down_ = app_.foot_is_down();
    act(plant::command::PressPedal{foot_was_down_});
  }
  for (std::size_t slot = 0; slot < ILK_SLOTS; slot++) {
    seen_.truth[slot].position = static_cast<std::int64_t>(plant_.station(slot)->position_counts());
  }
  ilk_sim_exchange_t sent{};
  sent.magic = ILK_SIM_MAGIC;
  sent.tick = tick_;
  std::memcpy(sent.frame, outputs_.frame, sizeof sent.frame);
  const ilk_sim_reply_t reply = plant_.tick(sent);
  inputs_.link_generation = app_.generation();
  inputs_.frames_received = reply.frames_received;
  inputs_.pedal_no_closed = reply.pedal_no_closed;
  inputs_.pedal_nc_closed = reply.pedal_nc_closed;
  inputs_.estop_loop_closed = reply.estop_loop_closed;
  std::memcpy(inputs_.frame, reply.frame, sizeof inputs_.frame);
}

void World::spoil_inputs() {
  const auto lasts = [](std::uint32_t& ticks) { return ticks > 0 && ticks-- > 0; };
  if (lasts(undefined_pedal_ticks_)) {
    (random_.coin() ? inputs_.pedal_no_closed : inputs_.pedal_nc_closed) = 2 + random_.below(0xFFFF);
  }
  if (lasts(undefined_estop_ticks_)) {
    inputs_.estop_loop_closed = 2 + random_.below(0xFFFF);
  }
  inputs_.deadline_missed = lasts(overrun_ticks_) ? 1 : 0;
  inputs_.transaction_done = lasts(failing_ticks_) ? 0 : 1;
}

void World::run_kernel() {
  const std::span<const ilk_request_t> requests = app_.requests();
  const auto count = static_cast<std::uint32_t>(requests.size());
  seen_.state_damaged = state_bit_.has_value();
  seen_.undamaged = {};
  if (state_bit_) {
    ilk_state_t twin = state_;
    ilk_step(&config_, &twin, &inputs_, requests.data(), count, &undamaged_);
    flip(state_, *state_bit_);
    state_bit_.reset();
    seen_.undamaged = undamaged_frames_;
  }
  const bool sweeps = tick_ % kSweepInterval == 0 && !seen_.state_damaged;
  ilk_state_t before;
  if (sweeps) {
    before = state_;
  }
  ilk_step(&config_, &state_, &inputs_, requests.data(), count, &outputs_);
  if (sweeps) {
    sweep_flips(before);
  }
}

void World::sweep_flips(const ilk_state_t& before) {
  const std::span<const ilk_request_t> requests = app_.requests();
  for (std::uint32_t flips = 0; flips < kSweptBits; flips++) {
    ilk_state_t damaged = before;
    flip(damaged, sweep_bit_);
    ilk_outputs_t outputs;
    ilk_step(&config_, &damaged, &inputs_, requests.data(), static_cast<std::uint32_t>(requests.size()),
             &outputs);
    const bool is_met =
        damaged.mode == ILK_MODE_LOCKED && damaged.cause == ILK_CAUSE_INTEGRITY && is_zero_drive(outputs);
    if (!is_met && std::memcmp(&outputs, &outputs_, sizeof outputs) != 0) {
      totals_.bit_flips_unsafe++;
    }
    totals_.bit_flips++;
    totals_.state_bits.set(sweep_bit_);
    sweep_bit_ = (sweep_bit_ + 1) % kStateBits;
  }
}

void World::show_oracle() {
  seen_.tick = tick_;
  seen_.transaction_failed = inputs_.transaction_done != 1;
  for (std::size_t slot = 0; slot < ILK_SLOTS; slot++) {
    const ilk_axis_t& axis = state_.axis[slot];
    seen_.received[slot] = (inputs_.frames_received >> slot & 1) != 0;
    seen_.claim.axes[slot] = {axis_mode_of(axis.state), axis.homed != 0, axis.fault, axis.position_counts};
  }
  seen_.claim.mode = mode_of(state_.mode);
  seen_.claim.first_cause = state_.cause;
  seen_.pedal_normally_open = contact_of(inputs_.pedal_no_closed);
  seen_.pedal_normally_closed = contact_of(inputs_.pedal_nc_closed);
  seen_.estop_loop = contact_of(inputs_.estop_loop_closed);
  seen_.deadline_missed = inputs_.deadline_missed != 0;
  seen_.app_attached = inputs_.link_generation != shown_generation_;
  shown_generation_ = inputs_.link_generation;
  const std::span<oracle::Message> messages = app_.messages();
  seen_.answers = outputs_.verdict_count;
  for (std::size_t n = 0; n < messages.size(); n++) {
    if (n >= outputs_.verdict_count) {
      messages[n].answer = oracle::Answer::kNone;
    } else {
      messages[n].answer = outputs_.verdict[n].verdict == ILK_VERDICT_ACCEPTED ? oracle::Answer::kAccepted
                                                                               : oracle::Answer::kRefused;
    }
  }
  seen_.messages = messages;
  seen_.configuration_damage_ticks = config_damage_ticks_;
}

void World::count() {
  const bool in_motion = state_.mode == ILK_MODE_MOTION;
  totals_.ticks++;
  totals_.motion_ticks += in_motion ? 1 : 0;
  is_driven_ = std::ranges::any_of(outputs_.command, [](const auto& command) { return command.drive != 0; });
  driven_ticks_ = in_motion ? driven_ticks_ + (is_driven_ ? 1 : 0) : 0;
  for (std::size_t slot = 0; slot < ILK_SLOTS; slot++) {
    const ilk_axis_t& axis = state_.axis[slot];
    totals_.driven_axis_ticks += outputs_.command[slot].drive != 0 ? 1 : 0;
    card_unknown_[slot] = card_unknown_[slot] && outputs_.command[slot].drive == 0;
    totals_.homings += was_homing_[slot] && axis.homed != 0 ? 1 : 0;
    was_homing_[slot] = axis.state == ILK_AXIS_HOMING;
    if (axis.fault != fault_before_[slot]) {
      fault_before_[slot] = axis.fault;
      totals_.axis_faults[axis.fault]++;
    }
    totals_.digest = totals_.digest * 0x100000001b3u + outputs_.frame[slot][ILK_FRAME_WORDS - 1];
  }
  if (state_.mode == ILK_MODE_LOCKED && mode_before_ != ILK_MODE_LOCKED) {
    totals_.causes[state_.cause]++;
  }
  mode_before_ = state_.mode;
  for (std::uint32_t n = 0; n < outputs_.verdict_count; n++) {
    const bool accepted = outputs_.verdict[n].verdict == ILK_VERDICT_ACCEPTED;
    totals_.requests_refused += accepted ? 0 : 1;
    totals_.moves_accepted += accepted && outputs_.verdict[n].kind == ILK_REQUEST_MOVE ? 1 : 0;
  }
}

/** A slot whose kind of card was damaged is none with an axis meanwhile: nothing is counted there. So the
 * watch for drift begins later, until the axis is driven again, and missing frames count from the end of the
 * damage. */
bool World::counts_late(const oracle::Finding& finding) const {
  if (finding.reason == kDrifts) {
    return card_unknown_[static_cast<std::size_t>(finding.axis)];
  }
  return finding.reason == kCardLost &&
         tick_ + 1 < card_known_from_[static_cast<std::size_t>(finding.axis)] + config_.bad_frame_limit;
}

bool World::is_excused(const oracle::Finding& finding) const {
  // Until damage to the configuration is met, the specification promises P1 to P3 of what is driven, and no
  // more. That the app is heard belongs to P2; the oracle names it P10.
  const bool of_drive =
      finding.property <= oracle::Property::kP3 || finding.property == oracle::Property::kP10;
  const bool promised = finding.property == oracle::Property::kP13 ||
                        (of_drive && finding.reason.starts_with("driven") && finding.reason != kWrongWay);
  return counts_late(finding) || (config_damage_ticks_ > 0 && !promised);
}

std::optional<Failure> World::judge() {
  std::optional<Failure> first;
  for (const oracle::Finding& finding : oracle_.step(seen_)) {
    if (is_excused(finding)) {
      continue;
    }
    totals_.unsafe++;
    totals_.bit_flips_unsafe += seen_.state_damaged || config_damage_ticks_ > 0 ? 1 : 0;
    if (!first) {
      first = Failure{tick_, static_cast<unsigned>(finding.property), finding.axis, finding.reason};
    }
  }
  const std::uint32_t late = clock_.step(tick_, seen_.to_card);
  totals_.late += late;
  totals_.stops_met = clock_.met();
  if (!first && late > 0) {
    first = Failure{tick_, 0, oracle::kNoAxis, clock_.latest()};
  }
  return first;
}

std::optional<Failure> World::step() {
  inject_what_is_due();
  if (config_damage_left_ > 0) {
    config_damage_ticks_++;
    if (config_damage_left_-- == 1) {
      flip(config_, config_bit_);
      config_damage_ticks_ = 0;
      if (const auto slot = slot_of_card_word(config_bit_)) {
        card_known_from_[*slot] = tick_;
      }
    }
  }
  app_.act(tick_, state_);
  exchange();
  spoil_inputs();
  renew_promises();
  const std::uint64_t flips_unsafe = totals_.bit_flips_unsafe;
  run_kernel();
  show_oracle();
  count();
  std::optional<Failure> failure = judge();
  if (unrefused_) {
    failure = Failure{tick_, static_cast<unsigned>(oracle::Property::kP13), oracle::kNoAxis, *unrefused_};
  }
  if (!failure && totals_.bit_flips_unsafe != flips_unsafe) {
    failure = Failure{tick_, static_cast<unsigned>(oracle::Property::kP14), oracle::kNoAxis,
                      "a flipped bit of the state was not met"};
  }
  tick_++;
  return failure;
}

}  // namespace interlock::campaign
