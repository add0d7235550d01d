#include "world.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <span>

#include "flip.hpp"
#include "interlock/kernel.h"
#include "plant/exchange.hpp"
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
    while (robot.config.common.period_us != kLongestPeriodUs) {
      robot = make_robot(random, true);
    }
    push_to_far_ends(robot, random);
  }
  if (sweeps_stops(number)) {
    stand_at_zero(robot);
  }
  return robot;
}

/** What the specification promises while the configuration is damaged. */
constexpr std::array kAlwaysPromised{judge_P1, judge_P2, judge_P3, judge_P10};

bool is_locked(const ilk_state_t& state, const ilk_outputs_t& outputs) {
  return state.system.mode == ILK_MODE_LOCKED && state.system.cause == ILK_CAUSE_INTEGRITY &&
         is_zero_drive(outputs) && outputs.power == 0;
}

bool lasts(std::uint32_t& ticks) { return ticks > 0 && ticks-- > 0; }

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
      sweep_bit_(plan.number * kSweepStart % kStateBits) {
  plant::Random refusals(plan.seed ^ (plan.number * kCaseFactor), kRefusalStream);
  unrefused_ = judge_refusals(robot_.config, refusals);
  totals_.configurations_refused = unrefused_ ? 0 : spoilings();
  begin_anew();
  if (robot_.far_coaster) {
    break_promise(*robot_.far_coaster, std::numeric_limits<std::int32_t>::max());
    totals_.faults_injected++;
  }
}

/** The kernel starts, and the monitors with it. */
void World::begin_anew() {
  ilk_init(&config_, &state_);
  ghost_init(&ghost_);
  judge_view(&state_, &before_);
  totals_.causes[before_.cause]++;
}

/** The monitors know what the kernel knows that finds its state damaged: nothing. */
void World::forget() {
  ghost_init(&ghost_);
  before_ = {};
  before_.mode = ILK_MODE_LOCKED;
  before_.cause = ILK_CAUSE_INTEGRITY;
  for (ilk_axis_view_t& axis : before_.axis) {
    axis = {ILK_AXIS_FAULTED, ILK_FAULT_INTEGRITY, ILK_HOMED_NOT, 0};
  }
  starts_++;
}

void World::act(const plant::command::Command& command, std::uint32_t after) {
  commands_.emplace_back(tick_ + after, command);
}

void World::break_promise(std::size_t slot, std::uint32_t ticks) {
  broken_[slot] = true;
  broken_until_[slot] = std::max(broken_until_[slot], tick_ + ticks);
}

void World::renew_promises() {
  for (std::size_t slot = 0; slot < ILK_SLOTS; slot++) {
    const bool over = tick_ - broken_until_[slot] < std::numeric_limits<std::int32_t>::max() &&
                      tick_ - broken_until_[slot] > kRecoveryTicks;
    if (broken_[slot] && over && state_.axis[slot].homed == ILK_HOMED_NOT &&
        state_.system.mode != ILK_MODE_MOTION) {
      broken_[slot] = false;
    }
  }
}

void World::exchange() {
  if (app_.foot_is_down() != foot_was_down_) {
    foot_was_down_ = app_.foot_is_down();
    act(plant::command::PressPedal{foot_was_down_});
  }
  const bool misses = lasts(overrun_ticks_);
  if (misses) {
    plant_.advance(plant_.period());
  }
  std::erase_if(commands_, [this](const auto& each) {
    const bool due = each.first == tick_;
    // The plant refuses what the robot does not have, a switch for instance: then there is no such fault.
    static_cast<void>(due && plant_.schedule(each.second));
    return due;
  });
  inputs_ = plant::exchange(plant_, outputs_, tick_);
  inputs_.link_generation = app_.generation();
  inputs_.boot_nonce = starts_;
  inputs_.deadlines_missed = misses ? 1 : 0;
}

void World::spoil_inputs() {
  if (lasts(undefined_pedal_ticks_)) {
    (random_.coin() ? inputs_.pedal_no_closed : inputs_.pedal_nc_closed) = 2 + random_.below(0xFFFF);
  }
  if (lasts(undefined_estop_ticks_)) {
    inputs_.estop_loop_closed = 2 + random_.below(0xFFFF);
  }
  inputs_.transaction_done = lasts(failing_ticks_) ? 0 : 1;
}

void World::run_kernel() {
  const std::span<const ilk_request_t> requests = app_.requests();
  const auto count = static_cast<std::uint32_t>(requests.size());
  state_damaged_ = state_bit_.has_value();
  if (state_bit_) {
    flip(state_, *state_bit_);
    state_bit_.reset();
    forget();
  }
  const bool sweeps = tick_ % kSweepInterval == 0 && !state_damaged_;
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
    if (!is_locked(damaged, outputs) && std::memcmp(&outputs, &outputs_, sizeof outputs) != 0) {
      totals_.bit_flips_unsafe++;
    }
    totals_.bit_flips++;
    totals_.state_bits.set(sweep_bit_);
    sweep_bit_ = (sweep_bit_ + 1) % kStateBits;
  }
}

void World::count() {
  const bool in_motion = after_.mode == ILK_MODE_MOTION;
  totals_.ticks++;
  totals_.motion_ticks += in_motion ? 1 : 0;
  is_driven_ = std::ranges::any_of(outputs_.command, [](const auto& command) { return command.drive != 0; });
  driven_ticks_ = in_motion ? driven_ticks_ + (is_driven_ ? 1 : 0) : 0;
  for (std::size_t slot = 0; slot < ILK_SLOTS; slot++) {
    const ilk_axis_view_t& before = before_.axis[slot];
    const ilk_axis_view_t& after = after_.axis[slot];
    totals_.driven_axis_ticks += outputs_.command[slot].drive != 0 ? 1 : 0;
    totals_.homings += before.state == ILK_AXIS_HOMING && after.homed == ILK_HOMED_BY_SWITCH ? 1 : 0;
    totals_.axis_faults[after.fault] += after.fault != before.fault || state_damaged_ ? 1 : 0;
    totals_.digest = totals_.digest * 0x100000001b3u + outputs_.frame[slot][ILK_FRAME_WORDS - 1];
  }
  totals_.causes[after_.cause] += after_.cause != before_.cause || state_damaged_ ? 1 : 0;
  for (std::uint32_t n = 0; n < outputs_.verdict_count; n++) {
    const bool accepted = outputs_.verdict[n].verdict == ILK_VERDICT_ACCEPTED;
    totals_.requests_refused += accepted ? 0 : 1;
    totals_.moves_accepted += accepted && outputs_.verdict[n].kind == ILK_REQUEST_MOVE ? 1 : 0;
  }
}

/** Any damaged bit of the state locks in this tick; one of the configuration locks in time. */
std::optional<Failure> World::judge_memory() const {
  if (state_damaged_ && !is_locked(state_, outputs_)) {
    return Failure{tick_, "P14: a flipped bit of the state was not met"};
  }
  if (config_damage_ticks_ > met_within(config_bit_) && after_.mode != ILK_MODE_LOCKED) {
    return Failure{tick_, "P14: a flipped bit of the configuration was not met"};
  }
  return std::nullopt;
}

/** The second half of P4: of axes that do what their configuration says. One that homed at the limit stands
 * there, noise and backlash apart. */
std::optional<Failure> World::judge_range() {
  for (std::size_t slot = 0; slot < ILK_SLOTS; slot++) {
    const ilk_axis_config_t& axis = robot_.config.axis[slot];
    const ilk_axis_view_t& before = before_.axis[slot];
    const ilk_axis_view_t& after = after_.axis[slot];
    const auto nearest = [&](std::int32_t position) {
      return std::clamp(position, axis.min_counts, axis.max_counts);
    };
    const bool stays_homed = before.homed != ILK_HOMED_NOT && after.homed == before.homed;
    const auto slack = static_cast<std::int32_t>(axis.noise_counts + axis.backlash_counts);
    inside_[slot] = nearest(after.position) == after.position || (stays_homed && inside_[slot]);
    if (stays_homed && !broken_[slot] && inside_[slot] &&
        std::abs(nearest(after.position) - after.position) > slack) {
      return Failure{tick_, "P4: left the soft range that it was in", static_cast<int>(slot), after.position,
                     nearest(after.position)};
    }
  }
  return std::nullopt;
}

std::optional<Failure> World::judge() {
  const bool config_damaged = config_damage_ticks_ > 0;
  const std::span<const ilk_request_t> requests = app_.requests();
  const auto count = static_cast<std::uint32_t>(requests.size());
  // The ghost follows what the kernel counts by; what is promised is judged by what the robot is.
  ilk_tick_t seen{&config_, true, &inputs_, requests.data(), count, &outputs_, &before_, &after_};
  ghost_observe(&ghost_, &seen);
  ghost_requests(&ghost_, &seen);
  seen.config = &robot_.config;
  std::optional<Failure> first = judge_memory();
  const std::span<const ilk_judge_t> judges =
      config_damaged ? std::span<const ilk_judge_t>(kAlwaysPromised) : ilk_judges;
  for (const ilk_judge_t monitor : judges) {
    const ilk_judgement_t judgement = monitor(&ghost_, &seen);
    if (judgement.clause != nullptr && !first) {
      const int axis = judgement.slot < ILK_SLOTS ? static_cast<int>(judgement.slot) : kNoAxis;
      first = Failure{tick_, judgement.clause, axis, judgement.found, judgement.bound};
    }
  }
  ghost_settle(&ghost_, &seen);
  if (!first && !config_damaged) {
    first = judge_range();
  }
  totals_.unsafe += first ? 1 : 0;
  totals_.bit_flips_unsafe += first && (state_damaged_ || config_damaged) ? 1 : 0;
  const std::uint32_t late = clock_.step(tick_, outputs_);
  totals_.late += late;
  totals_.stops_met = clock_.met();
  if (!first && late > 0) {
    first = Failure{tick_, clock_.latest()};
  }
  return first;
}

std::optional<Failure> World::step() {
  inject_what_is_due();
  if (config_damage_left_ > 0) {
    config_damage_ticks_++;
    if (config_damage_left_-- == 1) {
      // A kernel whose configuration was damaged is started anew: the monitors know nothing of what it knows.
      flip(config_, config_bit_);
      config_damage_ticks_ = 0;
      starts_++;
      begin_anew();
    }
  }
  app_.act(tick_, state_);
  exchange();
  spoil_inputs();
  renew_promises();
  const std::uint64_t flips_unsafe = totals_.bit_flips_unsafe;
  run_kernel();
  judge_view(&state_, &after_);
  count();
  std::optional<Failure> failure = judge();
  before_ = after_;
  if (unrefused_) {
    failure = Failure{tick_, *unrefused_};
  }
  if (!failure && totals_.bit_flips_unsafe != flips_unsafe) {
    failure = Failure{tick_, "P14: a flipped bit of the state was not met"};
  }
  tick_++;
  return failure;
}

}  // namespace interlock::campaign
