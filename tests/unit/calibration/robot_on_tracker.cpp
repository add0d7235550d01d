#include "robot_on_tracker.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "robot/robot_file.hpp"
#include "robot/robot_text.hpp"

namespace interlock::test {
namespace {

std::string read(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/** The file with the errors in it that are numbers of [kinematics]. */
Robot built(const RobotText& file, const Errors& errors) {
  std::vector<AxisNumber> numbers;
  const toml::table root = toml::parse(file.text);
  for (const auto& [name, error] : errors) {
    if (name.starts_with("kinematics.")) {
      numbers.push_back({name, *root.at_path(name).value<double>() + error});
    }
  }
  return parse_robot(with_numbers(file.text, "built.toml", "", numbers).value(), "built.toml").value();
}

std::vector<double> offsets(const Robot& robot, const Errors& errors) {
  std::vector<double> found;
  for (const Axis& axis : robot.axes) {
    const auto error = errors.find("axis." + axis.name + ".home_offset_counts");
    found.push_back(error == errors.end() ? 0.0 : error->second / axis.counts_per_unit);
  }
  return found;
}

}  // namespace

RobotText::RobotText(const std::string& path) : text(read(path)), robot(parse_robot(text, path).value()) {}

Machine::Machine(const RobotText& file, const Errors& errors)
    : kinematics_(*RobotKinematics::create(built(file, errors))), offsets_(offsets(file.robot, errors)) {}

std::optional<Pose> Machine::at(const AxisPositions& shown) const {
  AxisPositions real = shown;
  std::ranges::transform(real, offsets_, real.begin(), std::plus{});
  const auto pose = kinematics_.zframe_from_treatment(real);
  return pose ? std::optional(*pose) : std::nullopt;
}

std::vector<AxisPositions> random_positions(const RobotText& file, std::size_t count, std::uint64_t seed) {
  // The corners of what the machine may be: one number off at a time, and the linkages with room.
  std::vector<Machine> corners;
  for (const CalibratedNumber& number : file.robot.kinematics->calibrated()) {
    for (const double times : {1.5, -1.5}) {
      corners.emplace_back(file, Errors{{"kinematics." + number.key, times * number.plausible}});
    }
  }
  std::mt19937_64 generator(seed);
  std::vector<AxisPositions> positions;
  while (positions.size() < count) {
    AxisPositions drawn;
    for (const Axis& axis : file.robot.axes) {
      const double low = axis.to_unit(axis.soft_limits.min_counts);
      const double high = axis.to_unit(axis.soft_limits.max_counts);
      const double margin = 0.05 * (high - low);
      drawn.push_back(std::uniform_real_distribution<double>(low + margin, high - margin)(generator));
    }
    AxisPositions ahead = drawn;
    AxisPositions behind = drawn;
    for (std::size_t place = 0; place < drawn.size(); ++place) {
      const double room = file.robot.axes[place].unit == Unit::mm ? (place % 2 == 0 ? 3.0 : -3.0) : 0.0;
      ahead[place] += room;
      behind[place] -= room;
    }
    if (std::ranges::all_of(corners, [&](const Machine& machine) {
          return machine.at(drawn) && machine.at(ahead) && machine.at(behind);
        })) {
      positions.push_back(drawn);
    }
  }
  return positions;
}

std::vector<MeasuredPose> measured(const Machine& machine, const std::vector<AxisPositions>& positions,
                                   const Tracker& tracker, std::mt19937_64& generator) {
  std::normal_distribution<double> normal;
  const auto noise = [&] { return Eigen::Vector3d(normal(generator), normal(generator), normal(generator)); };
  std::vector<MeasuredPose> poses;
  for (const AxisPositions& shown : positions) {
    const Pose tool = tracker.tracker_from_zframe * machine.at(shown).value();
    MeasuredPose pose;
    pose.line = static_cast<std::uint32_t>(poses.size() + 2);
    pose.positions = shown;
    pose.point_mm = tool.translation() + tracker.sd_mm * noise();
    if (tracker.sd_rad) {
      const Eigen::Vector3d turn = *tracker.sd_rad * noise();
      pose.direction = (tool.linear().col(2) + turn.cross(tool.linear().col(2))).normalized();
    }
    poses.push_back(pose);
  }
  return poses;
}

}  // namespace interlock::test
