/** @file A robot of the project's files, built with errors, and a tracker that measures its tool. */
#pragma once

#include <map>
#include <random>
#include <string>

#include "calibration/calibration.hpp"
#include "targeting/robot_kinematics.hpp"

namespace interlock::test {

/** Errors of numbers of the file, by name: of the machine less the file; zeros of axes in counts. */
using Errors = std::map<std::string, double>;

/** The file of a robot: of the project, or of the tests. */
struct RobotText {
  explicit RobotText(const std::string& path);

  std::string text;
  Robot robot;
};

/** A machine that differs from its file. */
class Machine {
 public:
  Machine(const RobotText& file, const Errors& errors);

  /** Where the treatment point is while the app shows these positions; empty where the machine cannot be. */
  [[nodiscard]] std::optional<Pose> at(const AxisPositions& shown) const;

 private:
  RobotKinematics kinematics_;
  std::vector<double> offsets_;
};

/** What a tracker does. */
struct Tracker {
  Pose tracker_from_zframe;
  double sd_mm = 0.1;
  std::optional<double> sd_rad; /**< empty: it sees no direction */
};

/** Positions at which the robot can be measured, whatever its numbers are within their plausible
 * errors. */
std::vector<AxisPositions> random_positions(const RobotText& file, std::size_t count, std::uint64_t seed);

/** What the tracker measures there, from line 2 on. */
std::vector<MeasuredPose> measured(const Machine& machine, const std::vector<AxisPositions>& positions,
                                   const Tracker& tracker, std::mt19937_64& generator);

}  // namespace interlock::test
