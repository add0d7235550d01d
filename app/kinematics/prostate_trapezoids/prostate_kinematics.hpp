/**
 * @file
 * Kinematics of the prostate robot in closed form, with angulation.
 *
 * Base frame: x towards the left sliders, y up, z along the needle when both stages stand alike. A stage is a
 * pair of sliders (x1 left, x2 right) under a plate with a pivot; the needle driver lies in both pivots,
 * `front` and `back`.
 *
 *     stage   X = (x1 + x2)/2,  Y = H1 + H2 + sqrt(L² - ((x1 - x2 - B)/2)²)
 *     yaw     a = atan2(X_front - X_back, Dt)
 *     pitch   b = atan2(Y_back - Y_front, hypot(Dt, X_front - X_back))
 *     tip     (X_front, Y_front, -C) + Ry(a) Rx(b) (0, h, N + insertion),  rotation Ry(a) Rx(b) Rz(rotation)
 *
 * Source: the published angulated kinematics, made consistent: there the inverse leaves out C and measures Dt
 * along z in one place and along the needle in another; here the inverse is exact. The rotation of the needle
 * about its own axis in the pose is ours. The form of the thesis is the case N = 259.075, C = 0 with no
 * angulation allowed, which admits parallel stages only.
 *
 * In `ProstateTrapezoids`: L side_link, B top_width, H1 lower_height, H2 upper_height, Dt stage_distance, N
 * needle_tip, C front_pivot_offset, h needle_height.
 *
 * Domain: both separations from `dead_centre_clearance_mm` beyond B to the geometry's largest, to 1e-9 mm;
 * both angles within the angulation, to 1e-9 rad; coordinates and sliders within 10 m. Soft limits of the
 * axes are not looked at here: they are in counts and belong to the robot file. Nothing allocates or throws.
 */
#pragma once

#include <Eigen/Core>
#include <array>

#include "kinematics/joints.hpp"
#include "kinematics/path.hpp"
#include "kinematics/pose.hpp"
#include "kinematics/trapezoid.hpp"

namespace interlock {

/** The lengths of the robot file. */
struct ProstateTrapezoids {
  double side_link_mm = 0.0;
  double top_width_mm = 0.0;
  double lower_height_mm = 0.0;       /**< from the rail to the lower pivots */
  double upper_height_mm = 0.0;       /**< from the upper pivots to the centre of the stage */
  double stage_distance_mm = 0.0;     /**< from the rear trapezoid to the front one */
  double needle_tip_mm = 0.0;         /**< from the front stage to the tip, when the insertion stands at 0 */
  double front_pivot_offset_mm = 0.0; /**< from the pivot to the centre of the front stage, along z */
  double needle_height_mm = 0.0;      /**< of the needle's line above the centre of the front stage */
  double needle_guide_mm = 0.0;       /**< from the front stage to the needle guide */
  PointMm base_to_zframe_mm{};        /**< translation of the z-frame in the robot's base */
  double max_separation_mm = 0.0;     /**< of the sliders of one pair */
  double max_angulation_rad = 0.0;    /**< of the needle, each way, about either axis */

  bool operator==(const ProstateTrapezoids&) const = default;
};

/** Joint positions. Left is positive x; home is at +150 and -150 mm. */
struct ProstateJoints {
  double front_left_mm = 0.0;
  double front_right_mm = 0.0;
  double back_left_mm = 0.0;
  double back_right_mm = 0.0;
  double insertion_mm = 0.0;
  double rotation_rad = 0.0; /**< of the needle about its axis; turns beyond a full one count */

  bool operator==(const ProstateJoints&) const = default;
};

/** In the order of the columns of the Jacobian. */
inline constexpr std::array<JointField<ProstateJoints>, 6> prostate_joint_fields{{
    {{"front_left", "front_left_mm", Unit::mm, length_limit_mm}, &ProstateJoints::front_left_mm},
    {{"front_right", "front_right_mm", Unit::mm, length_limit_mm}, &ProstateJoints::front_right_mm},
    {{"back_left", "back_left_mm", Unit::mm, length_limit_mm}, &ProstateJoints::back_left_mm},
    {{"back_right", "back_right_mm", Unit::mm, length_limit_mm}, &ProstateJoints::back_right_mm},
    {{"insertion", "insertion_mm", Unit::mm, length_limit_mm}, &ProstateJoints::insertion_mm},
    {{"rotation", "rotation_rad", Unit::rad, angle_limit_rad}, &ProstateJoints::rotation_rad},
}};

/**
 * Velocity of the needle tip per joint velocity, in the base frame: rows 0 to 2 the tip (mm/mm, mm/rad), rows
 * 3 to 5 the angular velocity (rad/mm, rad/rad); columns as `prostate_joint_fields`.
 */
using ProstateJacobian = Eigen::Matrix<double, 6, 6>;

/**
 * The sliders of a pair stay this much wider apart than their plate: straight above them the plate's height
 * barely follows the sliders, and the inverse loses its digits. Ours; no lower end is published.
 */
inline constexpr double dead_centre_clearance_mm = 1.0;

/** Largest angulation that a geometry may allow. */
inline constexpr double steepest_angulation_rad = 1.0;

/** Closed forms of the robot with two trapezoid stages. */
class ProstateKinematics final : public Kinematics {
 public:
  /** Refused unless lengths are finite and within range, and the angulation at most
   * `steepest_angulation_rad`. */
  static KinematicsResult<ProstateKinematics> create(const ProstateTrapezoids& geometry) noexcept;

  [[nodiscard]] const ProstateTrapezoids& geometry() const noexcept { return geometry_; }

  [[nodiscard]] std::span<const Joint> joints() const noexcept override;
  [[nodiscard]] KinematicsResult<KinematicsPtr> with_probe(const ProbeOffsets& probe) const override;
  [[nodiscard]] KinematicsResult<Pose> zframe_from_treatment(
      std::span<const double> positions) const override;
  [[nodiscard]] KinematicsResult<Jacobian> jacobian(std::span<const double> positions) const override;
  [[nodiscard]] KinematicsResult<std::vector<double>> positions_for(const Eigen::Vector3d& entry,
                                                                    const Eigen::Vector3d& target,
                                                                    double rotation_rad) const override;
  [[nodiscard]] KinematicsResult<std::vector<double>> positions_for(
      const Pose& zframe_from_treatment, const std::optional<Eigen::Vector3d>& entry) const override;
  [[nodiscard]] KinematicsResult<RobotBody> zframe_body(std::span<const double> positions) const override;
  [[nodiscard]] std::optional<double> depth_mm(std::span<const double> positions) const override;
  [[nodiscard]] std::vector<CalibratedNumber> calibrated() const override;
  [[nodiscard]] std::span<const SliderPair> slider_pairs() const noexcept override { return pairs_; }

  /** Pose of the needle tip; its z axis is the way the needle advances. */
  [[nodiscard]] KinematicsResult<Pose> base_from_tip(const ProstateJoints& joints) const noexcept;

  /** Pose of the needle guide, on the line of the needle and not moved by the insertion. */
  [[nodiscard]] KinematicsResult<Pose> base_from_needle_guide(const ProstateJoints& joints) const noexcept;

  /** Joints for a pose of the tip. The rotation comes out within half a turn of 0. */
  [[nodiscard]] KinematicsResult<ProstateJoints> joints_for(const Pose& base_from_tip) const noexcept;

  /** Joints that put the tip at `target`, coming straight from `entry` (mm, base frame). DEGENERATE when too
   * close. */
  [[nodiscard]] KinematicsResult<ProstateJoints> joints_for(const Eigen::Vector3d& entry,
                                                            const Eigen::Vector3d& target,
                                                            double rotation_rad = 0.0) const noexcept;

  /** Joints that put the tip at `target` with the needle parallel to z. */
  [[nodiscard]] KinematicsResult<ProstateJoints> joints_for(const Eigen::Vector3d& target,
                                                            double rotation_rad = 0.0) const noexcept;

  /** Closed form, at any joints that forward kinematics accepts. */
  [[nodiscard]] KinematicsResult<ProstateJacobian> jacobian(const ProstateJoints& joints) const noexcept;

 private:
  struct Stages;

  struct Angles {
    double yaw_rad;
    double pitch_rad;
    double rotation_rad;
  };

  ProstateKinematics(const ProstateTrapezoids& geometry, const Trapezoid& trapezoid) noexcept;

  [[nodiscard]] KinematicsResult<Stages> stages(const ProstateJoints& joints) const noexcept;
  [[nodiscard]] KinematicsResult<void> check_angles(const Angles& angles) const noexcept;
  [[nodiscard]] Pose pose_along_needle(const Stages& stages, double rotation_rad,
                                       double length_mm) const noexcept;
  [[nodiscard]] KinematicsResult<ProstateJoints> solve(const Angles& angles,
                                                       const Eigen::Vector3d& target) const noexcept;

  ProstateTrapezoids geometry_;
  Trapezoid trapezoid_;
  std::array<SliderPair, 2> pairs_;
};

}  // namespace interlock
