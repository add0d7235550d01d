#include "cli/kinematics_lines.hpp"

#include <algorithm>
#include <array>

#include "cli/alignment_line.hpp"
#include "cli/kinematics_fields.hpp"
#include "kinematics/neuro_kinematics.hpp"
#include "kinematics/prostate_kinematics.hpp"

namespace interlock::cli {

using Eigen::Vector3d;
using nlohmann::json;

namespace {

/** The joints of a robot under the names of its axes. */
template <typename Joints, std::size_t count>
class NamedJoints {
 public:
  NamedJoints(const Robot& robot, const std::array<JointField<Joints>, count>& fields) : fields_(fields) {
    std::ranges::transform(fields, names_.begin(), [&](const JointField<Joints>& field) {
      return robot.with_role(field.role)->name;
    });
  }

  [[nodiscard]] Solved<Joints> read(const json& object) const {
    if (!object.is_object()) {
      return refused("BAD_FIELD", "joints: expected an object with a number for each axis");
    }
    Joints joints;
    for (std::size_t index = 0; index < count; ++index) {
      const auto entry = object.find(names_[index]);
      const Solved<double> position =
          number(entry == object.end() ? json() : *entry, "joints." + names_[index]);
      if (!position) {
        return tl::unexpected(position.error());
      }
      joints.*fields_[index].position = *position;
    }
    return check_keys(object, names_).map([&] { return joints; });
  }

  [[nodiscard]] json write(const Joints& joints) const {
    json object = json::object();
    for (std::size_t index = 0; index < count; ++index) {
      object[names_[index]] = joints.*fields_[index].position;
    }
    return object;
  }

 private:
  const std::array<JointField<Joints>, count>& fields_;
  std::array<std::string, count> names_;
};

/** What both tasks need of the NeuroRobot. */
struct Neuro {
  NeuroKinematics kinematics;
  NamedJoints<NeuroJoints, neuro_joint_fields.size()> names;

  [[nodiscard]] Solved<Pose> forward(const NeuroJoints& joints) const {
    return solved(kinematics.zframe_from_treatment(joints));
  }

  [[nodiscard]] Solved<NeuroJoints> inverse(const json& request) const {
    if (has(request, {"pose", "entry"})) {
      return from_pose_and_entry(request);
    }
    if (has(request, {"pose", "insertion"})) {
      return from_pose_and_insertion(request);
    }
    if (has(request, {"entry", "target"})) {
      return from_entry_and_target(request);
    }
    return refused("BAD_FIELD", "expected entry and target, pose and entry, or pose and insertion");
  }

 private:
  [[nodiscard]] Solved<NeuroJoints> from_pose_and_entry(const json& request) const {
    return check_keys(request, std::array{"pose", "entry"})
        .and_then([&] { return pose(request); })
        .and_then([&](const Pose& wanted) {
          return point(request, "entry").and_then([&](const Vector3d& entry) {
            return solved(kinematics.joints_for(wanted, entry));
          });
        });
  }

  [[nodiscard]] Solved<NeuroJoints> from_pose_and_insertion(const json& request) const {
    return check_keys(request, std::array{"pose", "insertion"})
        .and_then([&] { return pose(request); })
        .and_then([&](const Pose& wanted) {
          return number(request["insertion"], "insertion").and_then([&](double insertion_mm) {
            return solved(kinematics.joints_at_insertion(wanted, insertion_mm));
          });
        });
  }

  [[nodiscard]] Solved<NeuroJoints> from_entry_and_target(const json& request) const {
    const Solved<void> known = check_keys(request, std::array{"entry", "target", "probe_rotation"});
    const Solved<Vector3d> entry = known.and_then([&] { return point(request, "entry"); });
    const Solved<Vector3d> target = entry.and_then([&](const Vector3d&) { return point(request, "target"); });
    return target.and_then([&](const Vector3d&) { return number_or_zero(request, "probe_rotation"); })
        .and_then([&](double rotation) { return solved(kinematics.joints_for(*entry, *target, rotation)); });
  }
};

/** What both tasks need of the prostate robot. */
struct Prostate {
  ProstateKinematics kinematics;
  NamedJoints<ProstateJoints, prostate_joint_fields.size()> names;

  [[nodiscard]] Solved<Pose> forward(const ProstateJoints& joints) const {
    return solved(kinematics.base_from_tip(joints));
  }

  [[nodiscard]] Solved<ProstateJoints> inverse(const json& request) const {
    if (has(request, {"pose"})) {
      return check_keys(request, std::array{"pose"})
          .and_then([&] { return pose(request); })
          .and_then([&](const Pose& wanted) { return solved(kinematics.joints_for(wanted)); });
    }
    if (has(request, {"target"})) {
      return from_target(request);
    }
    return refused("BAD_FIELD", "expected pose, entry and target, or target");
  }

 private:
  [[nodiscard]] Solved<ProstateJoints> from_target(const json& request) const {
    const Solved<void> known = check_keys(request, std::array{"entry", "target", "rotation"});
    const Solved<Vector3d> target = known.and_then([&] { return point(request, "target"); });
    return target.and_then([&](const Vector3d&) { return number_or_zero(request, "rotation"); })
        .and_then([&](double rotation) {
          if (!request.contains("entry")) {
            return solved(kinematics.joints_for(*target, rotation));
          }
          return point(request, "entry").and_then([&](const Vector3d& entry) {
            return solved(kinematics.joints_for(entry, *target, rotation));
          });
        });
  }
};

/** The answer of either task: the joints, and the pose to which they lead. */
template <typename Family>
Solved<json> solve(const Family& family, KinematicsTask task, const json& request) {
  const auto joints = [&] {
    if (task == KinematicsTask::inverse) {
      return family.inverse(request);
    }
    return check_keys(request, std::array{"joints"}).and_then([&] {
      return family.names.read(request.contains("joints") ? request["joints"] : json());
    });
  }();
  return joints.and_then([&](const auto& found) {
    return family.forward(found).map([&](const Pose& reached) {
      return json{{"joints", family.names.write(found)}, {"pose", row_major(reached)}};
    });
  });
}

}  // namespace

KinematicsResult<KinematicsLines> KinematicsLines::create(const Robot& robot, KinematicsTask task) {
  if (task == KinematicsTask::alignment) {
    return RobotKinematics::create(robot).map([&](const RobotKinematics& kinematics) {
      return KinematicsLines(
          [robot, kinematics](const json& request) { return align_line(robot, kinematics, request); });
    });
  }
  const auto lines_of = [&](auto family) {
    return KinematicsLines(
        [family = std::move(family), task](const json& request) { return solve(family, task, request); });
  };
  if (const auto* const geometry = std::get_if<NeuroRcm>(&robot.kinematics)) {
    return NeuroKinematics::create(*geometry, robot.probe).map([&](const NeuroKinematics& kinematics) {
      return lines_of(Neuro{kinematics, {robot, neuro_joint_fields}});
    });
  }
  return ProstateKinematics::create(std::get<ProstateTrapezoids>(robot.kinematics))
      .map([&](const ProstateKinematics& kinematics) {
        return lines_of(Prostate{kinematics, {robot, prostate_joint_fields}});
      });
}

KinematicsLines::Answer KinematicsLines::answer(std::string_view line, std::size_t number) const {
  const Solved<json> answer = parse_line(line).and_then(solve_);
  const json object = answer ? *answer : json{{"line", number}, {"error", answer.error()}};
  return {object.dump(), answer.has_value()};
}

}  // namespace interlock::cli
