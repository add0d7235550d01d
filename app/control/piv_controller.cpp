#include "control/piv_controller.hpp"

#include <algorithm>
#include <cmath>

namespace interlock {
namespace {

constexpr double largest_gain = 1e4;
/** Of positions, speeds and accelerations in counts and seconds: every result stays finite. */
constexpr double largest_number = 1e10;
constexpr double slowest_full_speed = 1e-3;
constexpr double longest_s = 1.0;
/** Of full speed, that is left of the integral when the profile comes to stand; for what holds the axis then.
 */
constexpr double standing_share = 0.02;

ControlResult<void> check(const PivInput& input) noexcept {
  const VelocityEstimate measured = input.velocity.value_or(VelocityEstimate{});
  const double most = largest_number;
  return require_within("position setpoint", input.setpoint.position_counts, -most, most)
      .and_then([&] {
        return require_within("velocity setpoint", input.setpoint.velocity_counts_per_s, -most, most);
      })
      .and_then([&] {
        return require_within("acceleration setpoint", input.setpoint.acceleration_counts_per_s2, -most,
                              most);
      })
      .and_then([&] { return require_within("position", input.position_counts, -most, most); })
      .and_then([&] { return require_within("velocity", measured.counts_per_s, -most, most); })
      .and_then([&] { return require_within("age of the velocity", measured.age_s, 0.0, longest_s); })
      .and_then(
          [&] { return require_within("ceiling", std::min(input.ceiling_counts_per_s, most), 0.0, most); })
      .and_then(
          [&] { return require_within("time since the last update", input.elapsed_s, 0.0, longest_s); });
}

}  // namespace

ControlResult<PivController> PivController::create(const PivRules& rules) noexcept {
  return require_within("position gain", rules.gains.position_per_s, 0.0, largest_gain)
      .and_then([&] { return require_within("velocity gain", rules.gains.velocity, 0.0, largest_gain); })
      .and_then(
          [&] { return require_within("integral gain", rules.gains.integral_per_s, 0.0, largest_gain); })
      .and_then([&] {
        return require_within("full speed", rules.full_speed_counts_per_s, slowest_full_speed,
                              largest_number);
      })
      .and_then([&] { return require_within("lead", rules.lead_s, 0.0, longest_s); })
      .and_then([&] { return require_within("rate", rules.rate_counts_per_s2, 0.0, largest_number); })
      .and_then([&] { return require_within("integral", rules.integral_counts_per_s, 0.0, largest_number); })
      .map([&] { return PivController(rules); });
}

ControlResult<PivOutput> PivController::update(const PivInput& input) noexcept {
  if (const ControlResult<void> checked = check(input); !checked) {
    reset();
    return tl::unexpected(checked.error());
  }
  turn(input.direction);
  const Setpoint& setpoint = input.setpoint;
  const double full = rules_.full_speed_counts_per_s;
  // What a motor lacks it lacks in proportion to its speed: less of it is to be made up for as the profile
  // slows down, or the axis would pass its target.
  const double pace = std::abs(setpoint.velocity_counts_per_s);
  const double bound = pace == 0.0 ? rules_.integral_counts_per_s
                                   : std::min(rules_.integral_counts_per_s, standing_share * full + pace);
  integral_ = std::clamp(integral_, -bound, bound);
  const double position_error = setpoint.position_counts - input.position_counts;
  const double velocity_desired =
      std::clamp(setpoint.velocity_counts_per_s + rules_.gains.position_per_s * position_error, -full, full);
  const double error = input.velocity
                           ? velocity_desired - setpoint.acceleration_counts_per_s2 * input.velocity->age_s -
                                 input.velocity->counts_per_s
                           : 0.0;
  const double desired = velocity_desired + setpoint.acceleration_counts_per_s2 * rules_.lead_s +
                         rules_.gains.velocity * error + integral_;
  output_ = held(desired, input);
  integrate(error, desired, input.elapsed_s, bound);
  return PivOutput{desired, output_};
}

void PivController::reset() noexcept {
  integral_ = 0.0;
  output_ = 0.0;
}

void PivController::turn(int direction) noexcept {
  if (direction != direction_) {
    reset();
    direction_ = direction;
  }
}

double PivController::held(double desired, const PivInput& input) const noexcept {
  const double most = std::min(rules_.full_speed_counts_per_s, input.ceiling_counts_per_s);
  const double along = std::max(0.0, std::min(direction_ * desired, most));
  if (along == 0.0) {
    return 0.0;
  }
  const double step = rules_.rate_counts_per_s2 * input.elapsed_s;
  const double before = direction_ * output_;
  return direction_ * std::clamp(along, std::min(before - step, most), before + step);
}

void PivController::integrate(double error, double desired, double elapsed_s, double bound) noexcept {
  const bool held_below = output_ < desired;
  const bool held_above = output_ > desired;
  if ((error > 0.0 && held_below) || (error < 0.0 && held_above)) {
    return;
  }
  integral_ = std::clamp(integral_ + rules_.gains.integral_per_s * error * elapsed_s, -bound, bound);
}

}  // namespace interlock
