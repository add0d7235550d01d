#include "cli/kinematics_lines.hpp"

#include <array>
#include <vector>

#include "targeting/robot_kinematics.hpp"

namespace interlock::cli {

using Eigen::Vector3d;
using nlohmann::json;

namespace {

/** The positions of the axes that play a role, by their names. */
Solved<AxisPositions> read_joints(const Robot& robot, const json& object) {
  if (!object.is_object()) {
    return refused("BAD_FIELD", "joints: expected an object with a number for each axis");
  }
  AxisPositions positions;
  std::vector<std::string> names;
  for (const Axis& axis : robot.axes) {
    positions.push_back(0.0);
    if (axis.role.empty()) {
      continue;
    }
    names.push_back(axis.name);
    const auto entry = object.find(axis.name);
    const auto position = number(entry == object.end() ? json() : *entry, "joints." + axis.name);
    if (!position) {
      return tl::unexpected(position.error());
    }
    positions.back() = *position;
  }
  return check_keys(object, names).map([&] { return positions; });
}

json write_joints(const Robot& robot, const AxisPositions& positions) {
  json object = json::object();
  for (std::size_t place = 0; place < positions.size(); ++place) {
    if (!robot.axes[place].role.empty()) {
      object[robot.axes[place].name] = positions[place];
    }
  }
  return object;
}

Solved<AxisPositions> from_pose(const RobotKinematics& kinematics, const json& request) {
  return check_keys(request, std::array{"pose", "entry"})
      .and_then([&] { return pose(request); })
      .and_then([&](const Pose& desired) {
        if (!request.contains("entry")) {
          return solved(kinematics.positions_for(desired, std::nullopt));
        }
        return point(request, "entry").and_then([&](const Vector3d& entry) {
          return solved(kinematics.positions_for(desired, entry));
        });
      });
}

Solved<AxisPositions> from_entry_and_target(const RobotKinematics& kinematics, const json& request) {
  const Solved<void> known = check_keys(request, std::array{"entry", "target", "rotation"});
  const Solved<Vector3d> entry = known.and_then([&] { return point(request, "entry"); });
  const Solved<Vector3d> target = entry.and_then([&](const Vector3d&) { return point(request, "target"); });
  return target.and_then([&](const Vector3d&) { return number_or_zero(request, "rotation"); })
      .and_then([&](double rotation) { return solved(kinematics.positions_for(*entry, *target, rotation)); });
}

/** The answer of either task: the joints, and the pose to which they lead. */
Solved<json> solve(const Robot& robot, const RobotKinematics& kinematics, KinematicsTask task,
                   const json& request) {
  const auto positions = [&]() -> Solved<AxisPositions> {
    if (task == KinematicsTask::forward) {
      return check_keys(request, std::array{"joints"}).and_then([&] {
        return read_joints(robot, request.contains("joints") ? request["joints"] : json());
      });
    }
    return request.contains("pose") ? from_pose(kinematics, request)
                                    : from_entry_and_target(kinematics, request);
  }();
  return positions.and_then([&](const AxisPositions& found) {
    return solved(kinematics.zframe_from_treatment(found)).map([&](const Pose& reached) {
      return json{{"joints", write_joints(robot, found)}, {"pose", row_major(reached)}};
    });
  });
}

}  // namespace

KinematicsResult<KinematicsLines> KinematicsLines::create(const Robot& robot, KinematicsTask task) {
  return RobotKinematics::create(robot).map([&](const RobotKinematics& kinematics) {
    return KinematicsLines([robot, kinematics, task](const json& request) {
      return task == KinematicsTask::alignment ? align_line(robot, kinematics, request)
                                               : solve(robot, kinematics, task, request);
    });
  });
}

KinematicsLines::Answer KinematicsLines::answer(std::string_view line, std::size_t number) const {
  const Solved<json> answer = parse_line(line).and_then(solve_);
  const json object = answer ? *answer : json{{"line", number}, {"error", answer.error()}};
  return {object.dump(), answer.has_value()};
}

}  // namespace interlock::cli
