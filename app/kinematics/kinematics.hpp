/**
 * @file
 * What the app knows of a robot's kinematics: one interface, which every family implements.
 *
 * Positions are one number for each joint, in mm or rad, in the order of `joints()`. Poses and points are in
 * the zFrame, the registration fiducials on the robot, in mm. The treatment point is what is brought to a
 * target: its z axis is the way the probe or needle advances.
 *
 * Every function answers with finite numbers or a typed error; none throws, and each may be called from
 * several threads at once.
 */
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kinematics/family.hpp"
#include "kinematics/kinematics_error.hpp"
#include "kinematics/pose.hpp"
#include "robot/unit.hpp"

namespace interlock {

/** A joint, and the part that exactly one axis of the robot plays in the kinematics. */
struct Joint {
  std::string_view role;     /**< of its axis in the robot file: "probe_rotation" */
  std::string_view quantity; /**< name in errors: "probe_rotation_rad" */
  Unit unit;                 /**< of the axis */
  double limit; /**< a position means something within plus and minus this; soft limits are narrower */
  /** Lowest and highest position of the inverse, where the robot file gives them; soft limits are wider. */
  std::optional<std::pair<double, double>> given_limits = std::nullopt;
};

/** One straight part of what the robot looks like, for pictures. Thickness is no part of the model. */
struct BodyPart {
  std::string_view
      name; /**< "rail", "slider", "link", "plate", "lateral", "arm", "guide", "carrier", "probe" */
  Eigen::Vector3d from_mm;
  Eigen::Vector3d to_mm; /**< of guide and probe: the end that points at the patient */
};

/** All parts of a robot; the probe, or needle, is the last. */
using RobotBody = std::vector<BodyPart>;

/** Two sliders on one rail, joined by a linkage that bounds their separation: `at_zero_mm` + left - right. */
struct SliderPair {
  std::string_view left_role;
  std::string_view right_role;
  double at_zero_mm; /**< separation when both stand at 0 */
  double min_separation_mm;
  double max_separation_mm;
};

/** A number of the family's file that measured poses can correct (calibration/calibration.hpp). */
struct CalibratedNumber {
  std::string key;  /**< dotted, from [kinematics] on: "home_rcm_mm[2]" */
  Unit unit;        /**< of the number */
  double plausible; /**< an error of this size surprises nobody, in that unit */
};

/** Errors that assembly leaves in a robot that nobody has calibrated. */
inline constexpr double plausible_mm = 1.0;
inline constexpr double plausible_rad = 0.01;

/** Velocity of the treatment point per joint velocity, in the zFrame: rows 0 to 2 the point (mm/mm, mm/rad),
 * rows 3 to 5 the angular velocity (rad/mm, rad/rad); a column for each joint. */
using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/** The kinematics of a robot. A family that leaves out a part does not compile. */
class Kinematics {
 public:
  virtual ~Kinematics() = default;

  /** The joints, each with its role; the positions of every other function are in this order. */
  [[nodiscard]] virtual std::span<const Joint> joints() const noexcept = 0;

  /** The same robot with another probe. Refused when its geometry does not work with the probe. */
  [[nodiscard]] virtual KinematicsResult<KinematicsPtr> with_probe(const ProbeOffsets& probe) const = 0;

  /** Pose of the treatment point. */
  [[nodiscard]] virtual KinematicsResult<Pose> zframe_from_treatment(
      std::span<const double> positions) const = 0;

  /** How the treatment point moves with each joint. Refused where forward kinematics refuses the positions.
   */
  [[nodiscard]] virtual KinematicsResult<Jacobian> jacobian(std::span<const double> positions) const = 0;

  /** Positions that put the treatment point at `target`, coming straight from `entry`, with the probe turned
   * by `rotation_rad`. Soft limits play no part. */
  [[nodiscard]] virtual KinematicsResult<std::vector<double>> positions_for(const Eigen::Vector3d& entry,
                                                                            const Eigen::Vector3d& target,
                                                                            double rotation_rad) const = 0;

  /** Positions for a pose of the treatment point. Of a robot that goes through an entry point, the entry says
   * how far it is inserted; without one the insertion is 0. OFF_AXIS unless the entry lies on the z axis. */
  [[nodiscard]] virtual KinematicsResult<std::vector<double>> positions_for(
      const Pose& zframe_from_treatment, const std::optional<Eigen::Vector3d>& entry) const = 0;

  /** What the robot looks like. Refused where forward kinematics refuses the positions. */
  [[nodiscard]] virtual KinematicsResult<RobotBody> zframe_body(std::span<const double> positions) const = 0;

  /** How far the treatment point is beyond the entry point; empty when the joints do not fix an entry. */
  [[nodiscard]] virtual std::optional<double> depth_mm(std::span<const double> positions) const = 0;

  /** The numbers of its file that measured poses can correct. Of two that move the treatment point alike, the
   * first is corrected and the other held. */
  [[nodiscard]] virtual std::vector<CalibratedNumber> calibrated() const = 0;

  /** Pairs of sliders that could damage each other's linkage. */
  [[nodiscard]] virtual std::span<const SliderPair> slider_pairs() const noexcept = 0;
};

}  // namespace interlock
