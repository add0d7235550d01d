/**
 * @file
 * What the targeting asks of the robot and where the robot is: schema `AlignmentView` of
 * spec/openapi.yaml.
 */
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "http/targeting.hpp"
#include "motion/mailbox.hpp"
#include "robot/robot.hpp"
#include "targeting/alignment.hpp"

namespace interlock::web {

/**
 * The alignment with entry and target, and the current pose of the treatment point by the encoders; of each,
 * a problem in its place when there is none.
 */
nlohmann::json alignment_view(const Robot& robot, const Targeting& targeting, const ControlView& view);

/** The same as values; empty where there is a problem. Poses are in the scanner's frame (RAS), mm. */
struct RobotPoses {
  std::optional<Pose> current;         /**< of the treatment point, by the encoders */
  std::optional<Pose> desired;         /**< as entry and target ask */
  std::vector<AxisSetpoint> setpoints; /**< that lead there */
};

RobotPoses robot_poses(const Robot& robot, const Targeting& targeting, const ControlView& view);

/** The target of the targeting as the needle of a robot that takes biopsies sees it. */
struct NeedleTarget {
  interlock::Pose scanner_from_guide;                 /**< guide frame of motion/biopsy_run.hpp */
  Eigen::Vector3d guide_mm = Eigen::Vector3d::Zero(); /**< in that frame */
};

/** Of a robot with a [biopsy] table, where its axes are now; 409 with the code of the problem when there is
 * none. */
tl::expected<NeedleTarget, Problem> needle_target(const Robot& robot, const Targeting& targeting,
                                                  const ControlView& view);

/** Whether an axis ends before the aim, and the reachable pose is another one because of that: more than 0.1
 * mm off. */
bool is_out_of_reach(const Alignment& alignment);

/** The alignment with entry and target; 409 with the code of the problem when there is none. */
tl::expected<Alignment, Problem> alignment_with(const Robot& robot, const Targeting& targeting);

}  // namespace interlock::web
