#include "steering_experiment.hpp"

#include <cmath>
#include <optional>

#include "needle/needle.hpp"
#include "pressing_hand.hpp"
#include "steering/sweep.hpp"

namespace interlock::experiment {
namespace {

/** Steering plans anew every so many periods, 5 ms; an image costs it a step for each of them since the last.
 */
constexpr std::uint64_t periods_a_plan = 5;

struct Drawn {
  needle::NeedleParameters needle;
  Eigen::Vector3d shift_mm;
};

Drawn draw(const SteeringWorld& world, std::uint64_t seed) {
  needle::Noise noise(seed, Stream::world);
  Drawn drawn;
  drawn.needle.curvature_per_mm =
      world.curvature_per_mm * (1.0 + noise.between(-world.curvature_error, world.curvature_error));
  drawn.needle.wander_rad = world.wander_rad;
  drawn.needle.bevel_rad = world.bevel_rad + noise.normal(world.bevel_sd_rad);
  drawn.needle.torsion_play_rad = world.torsion_play_rad;
  drawn.needle.entry_mm = noise.normal_vector(world.entry_sd_mm).head<2>();
  drawn.needle.tilt_rad = noise.normal_vector(world.tilt_sd_rad).head<2>();
  const double shift_mm = noise.between(world.least_shift_mm, world.most_shift_mm);
  drawn.shift_mm = shift_mm * noise.direction();
  return drawn;
}

/** Steers without images: the needle turns evenly, or not at all, to the planned depth. */
SteeringCommand uncompensated(Steering steering, double depth_mm, double insertion_mm, double direction) {
  SteeringCommand command;
  command.rotation_rad_s = steering == Steering::spinning ? direction * CurvParameters{}.fastest_rad_s : 0.0;
  command.insertion_setpoint_mm = depth_mm;
  command.arrived = depth_mm - insertion_mm <= CompensatorParameters{}.arrived_mm;
  return command;
}

}  // namespace

SteeringOutcome insert(const SteeringWorld& world, Steering steering, std::uint64_t seed,
                       const CompensatorParameters& parameters) {
  const Drawn drawn = draw(world, seed);
  const Eigen::Vector3d planned_mm(0.0, 0.0, world.depth_mm);
  Eigen::Vector3d target_mm = planned_mm + drawn.shift_mm;
  const bool compensates = steering == Steering::published || steering == Steering::averaged;

  CompensatorParameters tuned = parameters;
  tuned.tip.curvature_per_mm = world.curvature_per_mm;
  tuned.share_rule = steering == Steering::published ? ShareRule::published : ShareRule::averaged;
  Compensator compensator = Compensator::create(tuned, NeedleAxes{}, planned_mm).value();
  needle::Needle needle(drawn.needle, needle::Noise(seed, Stream::tissue));
  needle::Imager imager(world.imager, needle::Noise(seed, Stream::image));
  PressingHand hand(seed, world.force_noise_counts);
  Sweep sweep;

  SteeringOutcome outcome;
  outcome.shift_mm = drawn.shift_mm.norm();
  outcome.curvature_per_mm = drawn.needle.curvature_per_mm;
  SteeringCommand command;
  for (std::uint64_t tick = 1; !command.arrived && outcome.duration_s < longest_s; ++tick) {
    outcome.duration_s = static_cast<double>(tick) * period_s;
    const NeedleAxes axes{outcome.duration_s, needle.seen_insertion_mm(), needle.seen_rotation_rad()};
    target_mm.z() = planned_mm.z() + drawn.shift_mm.z() + world.dragged_share * axes.insertion_mm;
    const auto image = imager.at(outcome.duration_s, needle.tip_mm(), target_mm);
    if (compensates && image) {
      const bool fused = compensator.see({image->time_s, image->tip_mm, image->target_mm}).has_value();
      ++(fused ? outcome.images_fused : outcome.images_refused);
      if (!outcome.flagged) {
        outcome.flagged = compensator.images_disagree();
        outcome.flagged_error_mm = (compensator.tip().guide_from_tip.translation() - needle.tip_mm()).norm();
      }
    }
    if (compensates && tick % periods_a_plan == 0) {
      command = compensator.step(axes).value();
    } else if (!compensates) {
      command =
          uncompensated(steering, world.depth_mm, axes.insertion_mm, sweep.direction(axes.rotation_rad));
    }
    outcome.out_of_reach += command.reachable ? 0 : 1;
    const double left_mm = command.arrived ? 0.0 : command.insertion_setpoint_mm - axes.insertion_mm;
    needle.advance(hand.speed_mm_s(left_mm), command.rotation_rad_s, period_s);
  }
  const Eigen::Vector3d miss_mm = needle.tip_mm() - target_mm;
  outcome.error_mm = miss_mm.norm();
  outcome.beside_mm = miss_mm.head<2>().norm();
  outcome.estimated_per_mm = compensator.tip().curvature_per_mm;
  if (compensates) {
    outcome.estimate_error_mm = (compensator.tip().guide_from_tip.translation() - needle.tip_mm()).norm();
  }
  outcome.arrived = command.arrived;
  return outcome;
}

}  // namespace interlock::experiment
