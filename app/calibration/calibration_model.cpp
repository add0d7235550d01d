#include "calibration/calibration_model.hpp"

#include <algorithm>
#include <charconv>

#include "robot/table_reader.hpp"

namespace interlock {
namespace {

/** Puts a number in the place of the one under a dotted key such as "joint[1].xyz_mm[2]". */
void replace(toml::table& table, const std::string& key, double value) {
  const std::size_t cut = key.find_last_of(".[");
  if (cut == std::string::npos || key[cut] == '.') {
    toml::table* const parent =
        cut == std::string::npos ? &table : table.at_path(key.substr(0, cut)).as_table();
    parent->insert_or_assign(key.substr(cut + 1), value);
    return;
  }
  toml::array& parent = *table.at_path(key.substr(0, cut)).as_array();
  std::ptrdiff_t place = 0;
  std::from_chars(key.data() + cut + 1, key.data() + key.size(), place);
  parent.replace(parent.cbegin() + place, value);
}

}  // namespace

CalibrationModel::CalibrationModel(const Robot& robot, std::string_view text)
    : robot_(robot),
      table_(*toml::parse(text)["kinematics"].as_table()),
      read_(std::ranges::find(kinematics_families(), robot.family, &KinematicsFamily::first)->second) {
  // What the robot file's reader takes itself.
  table_.erase("family");
  table_.erase("calibration_mm");
  for (const CalibratedNumber& number : robot.kinematics->calibrated()) {
    numbers_.push_back({number.key, "", std::string(unit_name(number.unit)), 1.0, number.plausible,
                        *table_.at_path(number.key).value<double>()});
  }
  for (const Joint& joint : robot.kinematics->joints()) {
    const Axis& axis = *robot.with_role(joint.role);
    const auto place = static_cast<std::size_t>(&axis - robot.axes.data());
    axis_of_joint_.push_back(place);
    if (axis.limit != ILK_LIMIT_NONE) {
      numbers_.push_back({"home_offset_counts", axis.name, "counts", axis.counts_per_unit,
                          axis.unit == Unit::mm ? plausible_mm : plausible_rad,
                          static_cast<double>(axis.home_offset_counts), place});
    }
  }
}

tl::expected<std::vector<Pose>, std::pair<std::uint32_t, std::string>> CalibrationModel::poses(
    std::span<const double> changes, std::span<const MeasuredPose> at) const {
  toml::table changed = table_;
  std::vector<double> offsets(robot_.axes.size(), 0.0);
  for (std::size_t place = 0; place < numbers_.size(); ++place) {
    const FileNumber& number = numbers_[place];
    if (!number.axis.empty()) {
      offsets[number.place] = changes[place];
    } else if (changes[place] != 0.0) {
      replace(changed, number.key, number.was + changes[place]);
    }
  }
  ReadLog log;
  TableReader table(log, changed, "kinematics");
  const KinematicsPtr read = read_(table);
  if (log.first_error) {
    return tl::unexpected(std::pair(0U, log.first_error->message()));
  }
  const auto kinematics = read->with_probe(robot_.probe);
  if (!kinematics) {
    return tl::unexpected(std::pair(0U, kinematics.error().message()));
  }
  std::vector<Pose> poses;
  std::vector<double> joints(axis_of_joint_.size());
  for (const MeasuredPose& pose : at) {
    for (std::size_t joint = 0; joint < joints.size(); ++joint) {
      joints[joint] = pose.positions[axis_of_joint_[joint]] + offsets[axis_of_joint_[joint]];
    }
    const auto reached = (*kinematics)->zframe_from_treatment(joints);
    if (!reached) {
      return tl::unexpected(std::pair(pose.line, reached.error().message()));
    }
    poses.push_back(*reached);
  }
  return poses;
}

}  // namespace interlock
