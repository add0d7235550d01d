#include "steering/compensator.hpp"

#include <algorithm>
#include <utility>

#include "kinematics/domain.hpp"

namespace interlock {
namespace {

KinematicsResult<void> check_axes(const NeedleAxes& axes) noexcept {
  return check_lengths({{"insertion_mm", axes.insertion_mm}}).and_then([&] {
    return check_range("rotation_rad", axes.rotation_rad, -angle_limit_rad, angle_limit_rad);
  });
}

}  // namespace

KinematicsResult<Compensator> Compensator::create(const CompensatorParameters& parameters,
                                                  const NeedleAxes& axes, const Eigen::Vector3d& target_mm) {
  const auto law = CurvLaw::create(parameters.curv);
  if (!law) {
    return tl::unexpected(law.error());
  }
  const auto target = TargetFilter::create(parameters.target, target_mm, axes.time_s);
  if (!target) {
    return tl::unexpected(target.error());
  }
  return check_axes(axes)
      .and_then([&] { return check_range("commit_mm", parameters.commit_mm, 0.0, 100.0); })
      .and_then(
          [&] { return check_range("arrived_mm", parameters.arrived_mm, 10.0 * shortest_ahead_mm, 10.0); })
      .and_then([&] { return check_range("miss_mm", parameters.miss_mm, 0.0, 100.0); })
      .and_then([&] { return steering_target(target_mm); })
      .and_then([&](const SteeringTarget&) { return TipEstimator::create(parameters.tip, axes.time_s); })
      .map([&](TipEstimator tip) { return Compensator(parameters, axes, *law, std::move(tip), *target); });
}

Compensator::Compensator(const CompensatorParameters& parameters, const NeedleAxes& axes, const CurvLaw& law,
                         TipEstimator tip, const TargetFilter& target)
    : parameters_(parameters),
      law_(law),
      tip_(std::move(tip)),
      target_(target),
      deepest_mm_(axes.insertion_mm),
      rotation_rad_(axes.rotation_rad) {}

KinematicsResult<SteeringCommand> Compensator::step(const NeedleAxes& axes) noexcept {
  const NeedleMotion motion{std::max(0.0, axes.insertion_mm - deepest_mm_),
                            axes.rotation_rad - rotation_rad_};
  return check_axes(axes)
      .and_then([&] { return tip_.move(axes.time_s, motion); })
      .and_then([&] {
        deepest_mm_ = std::max(deepest_mm_, axes.insertion_mm);
        rotation_rad_ = axes.rotation_rad;
        return command(axes);
      })
      .map([&](SteeringCommand next) {
        next.rotation_rad_s *= sweep_.direction(axes.rotation_rad);
        last_ = next;
        return next;
      });
}

KinematicsResult<void> Compensator::see(const NeedleImage& image) noexcept {
  TargetFilter target = target_;
  const auto seen = image.target_mm ? target.see(image.time_s, *image.target_mm) : KinematicsResult<void>();
  if (!seen) {
    target_ = target;  // as before, but for how well images agree
    return seen;
  }
  return tip_.see(image.time_s, image.tip_mm).map([&] { target_ = target; });
}

KinematicsResult<SteeringCommand> Compensator::command(const NeedleAxes& axes) const noexcept {
  const Eigen::Vector3d ahead = tip_.now().guide_from_tip.inverse() * target_.target_mm();
  if (last_.arrived || ahead.z() <= parameters_.arrived_mm) {
    SteeringCommand arrived = last_;
    arrived.arrived = true;
    arrived.rotation_rad_s = 0.0;
    return arrived;
  }
  return steering_target(ahead).and_then([&](const SteeringTarget& target) {
    return planned(target, axes).and_then([&](SteeringCommand next) {
      return law_.speed_rad_s(axes.rotation_rad, next.desired_rotation_rad, next.alpha)
          .map([&](double speed) {
            next.rotation_rad_s = speed;
            next.insertion_setpoint_mm = deepest_mm_ + target.arc_mm;
            return next;
          });
    });
  });
}

KinematicsResult<SteeringCommand> Compensator::planned(const SteeringTarget& target,
                                                       const NeedleAxes& axes) const noexcept {
  if (target.arc_mm <= parameters_.commit_mm) {
    return last_;
  }
  const double largest_per_mm = tip_.now().curvature_per_mm;
  const double desired_per_mm = std::min(target.curvature_per_mm, curvature_limit_per_mm);
  const auto share = parameters_.share_rule == ShareRule::averaged
                         ? law_.averaged_share(desired_per_mm, largest_per_mm)
                         : published_share(desired_per_mm, largest_per_mm);
  const double ahead_mm = target.arc_mm - target.extra_mm;
  return share.and_then([&](const CurvShare& chosen) {
    return smallest_miss_mm(target.beside_mm, ahead_mm, largest_per_mm).map([&](double miss_mm) {
      SteeringCommand next;
      next.desired_rotation_rad = within_turn_rad(axes.rotation_rad + target.turn_rad);
      next.alpha = chosen.alpha;
      next.expected_miss_mm = miss_mm;
      next.reachable = miss_mm <= parameters_.miss_mm;
      return next;
    });
  });
}

}  // namespace interlock
