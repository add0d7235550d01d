/**
 * @file
 * How the axes of a proposal will go, beside what they may do: for people to look at before they approve it.
 *
 * Found by the code that carries the proposal out, from where the axes were when it was last checked: a path
 * by its `TrajectoryFollower`, a move of one axis by its drive law. What the kernel, the pedal or a load make
 * of it is not in it. Homing, a sweep and a biopsy follow switches, turns and the surgeon's hand; they have
 * none.
 */
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "motion/setpoint_range.hpp"
#include "proposals/proposal.hpp"
#include "robot/robot.hpp"

namespace interlock {

/** What the samples of a profile follow one another by. */
enum class ProfileBasis : std::uint8_t {
  none, /**< there are no samples; `Profile::why` says why */
  time, /**< `Profile::times_s` */
  way   /**< evenly from the start to the target; no time is planned */
};

/** As the interface spells it. */
constexpr std::string_view basis_name(ProfileBasis basis) noexcept {
  constexpr std::string_view names[] = {"none", "time", "way"};
  return names[static_cast<std::size_t>(basis)];
}

/** One axis of a profile: positions in counts, velocities in counts/s. */
struct AxisProfile {
  std::uint32_t slot = 0;
  bool homed = false;                 /**< soft limits say nothing of one that is not */
  SetpointRange allowed;              /**< in which the kernel takes setpoints of it */
  SoftLimits soft_limits;             /**< beyond which it is not driven once homed */
  std::optional<double> top_velocity; /**< that planned motion keeps to; nothing: no time is planned */
  std::uint32_t most_drive = 0;       /**< that the axis may have now */
  std::vector<double> positions;      /**< at each sample */
  std::vector<double> velocities;     /**< at each sample; by time only */
  std::vector<std::uint32_t> drives;  /**< at each sample; by way only */
  double lowest = 0.0;                /**< of all positions, those between the samples as well */
  double highest = 0.0;               /**< as `lowest` */
  double fastest = 0.0;               /**< speed, as `lowest`; 0 by way */
};

/** Samples of all axes of a proposal. */
struct Profile {
  /** No profile has more samples. */
  static constexpr std::size_t most_samples = 302;

  ProfileBasis basis = ProfileBasis::none;
  std::string why; /**< there are no samples; empty otherwise */
  std::vector<double> times_s;
  std::vector<AxisProfile> axes; /**< in the order of the proposal's axes */
};

/** The profile of a proposal of this robot. Bounded: some thousand steps, whatever the duration. */
Profile profile_of(const Robot& robot, const ilk_config_t& config, const Proposal& proposal);

/** That of a path: by its `TrajectoryFollower`, in steps of time. */
Profile profile_of_path(const Robot& robot, const ilk_config_t& config, const Proposal& proposal);

/** That of a move of one axis: by its drive law, in steps of distance. */
Profile profile_of_move(const Robot& robot, const ilk_config_t& config, const Proposal& proposal);

/** None, and why. */
Profile no_profile(std::string why);

}  // namespace interlock
