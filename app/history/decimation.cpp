#include "history/decimation.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace interlock {
namespace {

/** The drive with the sense of its direction. */
std::int32_t signed_drive(const ilk_command_t& command) noexcept {
  const auto drive = static_cast<std::int32_t>(command.drive);
  return command.direction == ILK_DIRECTION_DECREASING ? -drive : drive;
}

/** Setpoint less position, saturating. */
std::int32_t error_of(const ilk_axis_t& axis) noexcept {
  const std::int64_t error = std::int64_t{axis.setpoint_counts} - axis.position_counts;
  return static_cast<std::int32_t>(std::clamp<std::int64_t>(error, std::numeric_limits<std::int32_t>::min(),
                                                            std::numeric_limits<std::int32_t>::max()));
}

}  // namespace

Decimation::Decimation(const RobotPlan& plan) : length_(ticks_of_bucket(plan.period_us)) {
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    if (drives_motor(plan.axis[slot].rules.card)) {
      slots_.push_back(slot);
      estimators_.emplace_back(plan.axis[slot].control.velocity);
    }
  }
}

bool Decimation::begins_anew(std::uint32_t generation, std::uint32_t tick) const noexcept {
  return generation != generation_ || tick < bucket_.last_tick;
}

std::optional<TickBucket> Decimation::take(std::uint32_t generation, const ilk_snapshot_t& snapshot,
                                           const ForceReadings& force) noexcept {
  const std::uint32_t tick = snapshot.state.system.tick;
  const bool anew = begins_anew(generation, tick);
  std::optional<TickBucket> complete;
  if (anew || tick / length_ != bucket_.last_tick / length_) {
    const std::uint32_t run = bucket_.run + (anew ? 1u : 0u);
    if (bucket_.ticks != 0) {
      complete = bucket_;
    }
    bucket_ = TickBucket{};
    bucket_.run = run;
  }
  if (anew) {
    generation_ = generation;
    std::for_each(estimators_.begin(), estimators_.end(), [](VelocityEstimator& each) { each.reset(); });
  }
  bucket_.last_tick = tick;
  ++bucket_.ticks;
  for (std::size_t motor = 0; motor < slots_.size(); ++motor) {
    const ilk_axis_t& axis = snapshot.state.axis[slots_[motor]];
    if (axis.card_valid != 0) {
      estimators_[motor].add(axis.position_counts, axis.card_time_us);
      if (const auto velocity = estimators_[motor].estimate()) {
        bucket_.axis[slots_[motor]].velocity_counts_per_s.add(static_cast<float>(velocity->counts_per_s));
      }
    }
    add_axis(slots_[motor], snapshot);
  }
  if (force.age_ticks(tick) == 0) {
    bucket_.hand_counts.add(force.hand);
    bucket_.needle_counts.add(force.needle);
  }
  return complete;
}

void Decimation::add_axis(std::uint32_t slot, const ilk_snapshot_t& snapshot) noexcept {
  const ilk_axis_t& axis = snapshot.state.axis[slot];
  AxisExtremes& extremes = bucket_.axis[slot];
  const bool read = axis.card_valid != 0;
  const bool requested = axis.state == ILK_AXIS_MOVING;
  if (read) {
    extremes.position_counts.add(axis.position_counts);
  }
  if (requested) {
    extremes.setpoint_counts.add(axis.setpoint_counts);
  }
  extremes.last_position_counts = read ? std::optional(axis.position_counts) : std::nullopt;
  extremes.last_setpoint_counts = requested ? std::optional(axis.setpoint_counts) : std::nullopt;
  if (read && requested) {
    const std::int32_t error = error_of(axis);
    extremes.error_counts.add(error);
    extremes.error_squares += static_cast<double>(error) * error;
    ++extremes.error_ticks;
  }
  extremes.drive.add(signed_drive(snapshot.command[slot]));
}

}  // namespace interlock
