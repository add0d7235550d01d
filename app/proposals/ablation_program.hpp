/**
 * @file
 * From angles and depths of the probe to the motion of the mode "ablation".
 */
#pragma once

#include <optional>

#include "motion/path_program.hpp"

namespace interlock {

/** One place at which the probe rests. */
struct AblationStep {
  double probe_rotation_rad = 0.0;
  double insertion_mm = 0.0;
  double dwell_s = 0.0;

  bool operator==(const AblationStep&) const = default;
};

/** Whether the robot's file has the mode and the axes for it. */
bool can_ablate(const Robot& robot);

/** The probe to one place; nothing when an encoder does not reach so far. Of a robot that can ablate. */
std::optional<MoveLeg> ablation_leg(const Robot& robot, const AblationStep& step);

}  // namespace interlock
