#include "targeting/guide_frame.hpp"

namespace interlock {

KinematicsResult<Pose> zframe_from_guide(const Robot& robot, const RobotKinematics& kinematics,
                                         AxisPositions positions) {
  for (std::size_t place = 0; place < positions.size(); ++place) {
    if (robot.axes[place].role == "insertion") {
      positions[place] = robot.biopsy->entry_mm;
    } else if (robot.axes[place].role == "rotation") {
      positions[place] = 0.0;
    }
  }
  return kinematics.zframe_from_treatment(positions);
}

}  // namespace interlock
