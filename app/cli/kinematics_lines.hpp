/**
 * @file
 * What `interlock kinematics` answers line by line.
 */
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>

#include "kinematics/kinematics_error.hpp"
#include "kinematics/pose.hpp"
#include "robot/robot.hpp"
#include "targeting/robot_kinematics.hpp"
#include "targeting/targeting_json.hpp"

namespace interlock::cli {

// Reading the fields of a line of `interlock kinematics`; what is wrong comes back as its error
// object.

/** What was read or solved, or the object that says what is wrong. */
template <typename Value>
using Solved = tl::expected<Value, nlohmann::json>;

/** The answer that refuses a line, with a code of the kinematics. */
tl::unexpected<nlohmann::json> refused(std::string_view code, const std::string& text);

/** What kinematics answered, an error as the object that a line gets. */
template <typename Value>
Solved<Value> solved(const KinematicsResult<Value>& result) {
  return result.map_error([](const KinematicsError& error) { return to_json(error); });
}

/** The one JSON object of a line. */
Solved<nlohmann::json> parse_line(std::string_view line);

/** Whether the object has all of these keys. */
bool has(const nlohmann::json& object, std::initializer_list<std::string_view> keys);

/** Nothing, when the object has no keys but these: a slip of the pen must not pass for a default. */
template <typename Keys>
Solved<void> check_keys(const nlohmann::json& object, const Keys& keys) {
  for (const auto& [key, value] : object.items()) {
    if (std::ranges::find(keys, key) == std::ranges::end(keys)) {
      std::string known;
      for (const auto& name : keys) {
        known += (known.empty() ? "" : ", ") + std::string(name);
      }
      return refused("BAD_FIELD", key + ": not known here; expected " + known);
    }
  }
  return {};
}

/** The number of that name. */
Solved<double> number(const nlohmann::json& value, const std::string& name);
/** The number under that key; 0 when the key is missing. */
Solved<double> number_or_zero(const nlohmann::json& object, const std::string& key);
/** The flag under that key; false when the key is missing. */
Solved<bool> flag_or_false(const nlohmann::json& object, const std::string& key);
/** Three numbers: x, y, z. */
Solved<Eigen::Vector3d> point(const nlohmann::json& object, const std::string& key);
/** A matrix row by row. */
Solved<RowMajor> matrix(const nlohmann::json& object, const std::string& key);

/** The rigid pose under `pose`. */
Solved<Pose> pose(const nlohmann::json& object);

// One line of `interlock kinematics align`.

/**
 * Aligns the robot with `entry` and `target` of the request, in the scanner's RAS frame, mm; `registration`,
 * `ignore_registration_rotation` and `rotation` where they are not identity, false and 0. The answer has
 * `desired` and `reachable` pose, `setpoints` by axis, the names of `clamped` axes, the `deviation`, the
 * `reachable_tip` and `cannula_length_mm`.
 */
Solved<nlohmann::json> align_line(const Robot& robot, const RobotKinematics& kinematics,
                                  const nlohmann::json& request);

// One line of `interlock kinematics`: a JSON object with joints, or with a pose to reach, to a JSON object
// with both.

/** What is computed for each line. */
enum class KinematicsTask {
  forward,   /**< `fk`: joints to a pose */
  inverse,   /**< `ik`: a pose, or entry and target, to joints */
  alignment, /**< `align`: entry and target in the scanner to setpoints, and what they reach */
};

/** Answers lines of JSON with lines of JSON, for one robot and one task. */
class KinematicsLines {
 public:
  /** The answer to one line, without its end. */
  struct Answer {
    std::string text;
    bool solved = false;
  };

  /** Refused when the robot has no kinematics, or they cannot work. */
  static KinematicsResult<KinematicsLines> create(const Robot& robot, KinematicsTask task);

  /** Solves a line; what is wrong with it comes back as an object with `error` and `line`. */
  [[nodiscard]] Answer answer(std::string_view line, std::size_t number) const;

 private:
  using Solve = std::function<tl::expected<nlohmann::json, nlohmann::json>(const nlohmann::json&)>;

  explicit KinematicsLines(Solve solve) : solve_(std::move(solve)) {}

  Solve solve_;
};

}  // namespace interlock::cli
