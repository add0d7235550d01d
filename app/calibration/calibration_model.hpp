/**
 * @file
 * A robot's kinematics as a function of the numbers that calibration may change. Private to this folder.
 */
#pragma once

#include <toml++/toml.h>

#include <span>
#include <string>
#include <vector>

#include "calibration/pose_table.hpp"
#include "kinematics/kinematics.hpp"

namespace interlock {

/** A number that calibration may change. */
struct FileNumber {
  std::string key;     /**< dotted, from its table on */
  std::string axis;    /**< whose table; empty: [kinematics] */
  std::string unit;    /**< in which the file has it: "mm", "rad" or "counts" */
  double per_unit;     /**< its unit for one mm or rad of the model */
  double plausible;    /**< error that surprises nobody, mm or rad */
  double was;          /**< in the file */
  std::size_t place{}; /**< of the axis among those of the robot */

  /** For people and programs: "kinematics.side_link_mm", "axis.yaw.home_offset_counts". */
  [[nodiscard]] std::string name() const {
    return (axis.empty() ? "kinematics." : "axis." + axis + '.') + key;
  }
};

/** Kinematics read from the file's own table, by its family's own reader, with other numbers in it. */
class CalibrationModel {
 public:
  /** Of a robot with kinematics, and the text of its file. The robot must outlive this. */
  CalibrationModel(const Robot& robot, std::string_view text);

  /** The family's numbers, then the zeros of the axes that have a switch. */
  [[nodiscard]] const std::vector<FileNumber>& numbers() const { return numbers_; }

  /** Places, among the robot's axes, of those that play a role. */
  [[nodiscard]] const std::vector<std::size_t>& axes() const { return axis_of_joint_; }

  /** Poses of the treatment point in the zFrame with every number changed by so much, mm or rad; or the first
   * thing that is refused, with the line of its pose: 0 when it is a number. */
  [[nodiscard]] tl::expected<std::vector<Pose>, std::pair<std::uint32_t, std::string>> poses(
      std::span<const double> changes, std::span<const MeasuredPose> at) const;

 private:
  const Robot& robot_;
  toml::table table_;
  ReadKinematics read_ = nullptr;
  std::vector<std::size_t> axis_of_joint_;
  std::vector<FileNumber> numbers_;
};

}  // namespace interlock
