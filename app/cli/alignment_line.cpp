#include "cli/kinematics_lines.hpp"
#include "targeting/targeting_json.hpp"

namespace interlock::cli {

using Eigen::Vector3d;
using nlohmann::json;

namespace {

constexpr std::array known_keys{"entry", "target", "rotation", "registration",
                                "ignore_registration_rotation"};

Solved<Registration> registration_of(const json& request) {
  return flag_or_false(request, "ignore_registration_rotation").and_then([&](bool ignored) {
    if (!request.contains("registration")) {
      return Solved<Registration>(Registration());
    }
    return matrix(request, "registration").and_then([&](const RowMajor& numbers) {
      return solved(Registration::create(numbers, ignored));
    });
  });
}

Solved<EntryTarget> entry_target_of(const json& request) {
  return point(request, "entry").and_then([&](const Vector3d& entry) {
    return point(request, "target").and_then([&](const Vector3d& target) {
      return number_or_zero(request, "rotation").map([&](double rotation) {
        return EntryTarget{entry, target, rotation};
      });
    });
  });
}

}  // namespace

Solved<json> align_line(const Robot& robot, const RobotKinematics& kinematics, const json& request) {
  return check_keys(request, known_keys)
      .and_then([&] { return registration_of(request); })
      .and_then([&](const Registration& registration) {
        return entry_target_of(request).and_then(
            [&](const EntryTarget& aim) { return solved(align(robot, kinematics, registration, aim)); });
      })
      .map([&](const Alignment& alignment) { return to_json(robot, alignment); });
}

}  // namespace interlock::cli
