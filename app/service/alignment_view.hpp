/**
 * @file
 * What the targeting asks of the robot, where the robot is and what it looks like there: schema
 * `AlignmentView` of spec/openapi.yaml.
 */
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "motion/realtime_channel.hpp"
#include "robot/robot.hpp"
#include "service/targeting.hpp"
#include "targeting/alignment.hpp"

namespace interlock {

/** A value, or the problem in its place: schema `TargetingProblem`. */
template <typename Value>
using Known = tl::expected<Value, nlohmann::json>;

/** What is stated of the images. A rotation that is ignored leaves nothing by which the error of the
 * registration is known. */
ImageAccuracy accuracy_of(const Targeting& targeting);

/** What poses are computed with. */
struct PoseSetup {
  RobotKinematics kinematics;
  Registration registration;
};

/** What pictures are made with. */
struct PictureSetup {
  PoseSetup poses;
  const char* frame; /**< "scanner", or "robot" where there is no valid registration */
};

/** The probe of the targeting. */
ProbeOffsets probe_of(const Targeting& targeting);

/** With the probe and the registration of the targeting; NO_REGISTRATION unless that is valid. */
Known<PoseSetup> pose_setup(const Robot& robot, const Targeting& targeting);

/** As above, in the robot's own frame where there is no valid registration. */
Known<PictureSetup> picture_setup(const Robot& robot, const Targeting& targeting);

/** Positions of all axes by their encoders; NOT_HOMED unless each that plays a role in the kinematics is
 * homed. */
Known<AxisPositions> known_positions(const Robot& robot, const ilk_state_t& state);

/** What the robot looks like there: a list of schema `BodyPart`, in the frame of the setup, mm. */
Known<nlohmann::json> body_view(const PoseSetup& setup, const AxisPositions& positions);

/**
 * The alignment with entry and target, and the current pose of the treatment point by the encoders; of each,
 * a problem in its place when there is none.
 */
nlohmann::json alignment_view(const Robot& robot, const Targeting& targeting, const ControlView& view);

/** The same as values; empty where there is a problem. Poses are in the scanner's frame (RAS), mm. */
struct RobotPoses {
  std::optional<RowMajor> current;     /**< of the treatment point, by the encoders */
  std::optional<RowMajor> desired;     /**< as entry and target ask */
  std::vector<AxisSetpoint> setpoints; /**< that lead there */
};

RobotPoses robot_poses(const Robot& robot, const Targeting& targeting, const ControlView& view);

/** The target of the targeting as the needle of a robot that takes biopsies sees it. */
struct NeedleTarget {
  Pose scanner_from_guide;                            /**< guide frame of motion/biopsy_run.hpp */
  Eigen::Vector3d guide_mm = Eigen::Vector3d::Zero(); /**< in that frame */
};

/** Of a robot with a [biopsy] table, where its axes are now; 409 with the code of the problem when there is
 * none. */
tl::expected<NeedleTarget, Problem> needle_target(const Robot& robot, const Targeting& targeting,
                                                  const ControlView& view);

/** 409 UNREACHABLE with the numbers, when the reachable pose is farther from the desired one than somebody
 * has accepted or, without that, the robot's file allows; empty when it is not. */
std::optional<Problem> out_of_reach(const Robot& robot, const Alignment& alignment,
                                    std::optional<double> accepted_mm = std::nullopt,
                                    std::optional<double> accepted_deg = std::nullopt);

/** The alignment with entry and target; 409 with the code of the problem when there is none. */
tl::expected<Alignment, Problem> alignment_with(const Robot& robot, const Targeting& targeting);

}  // namespace interlock
