/**
 * @file
 * One line of `interlock kinematics`: a JSON object with joints, or with a pose to reach, to a JSON object
 * with both.
 */
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>

#include "kinematics/kinematics_error.hpp"
#include "robot/robot.hpp"

namespace interlock::cli {

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
