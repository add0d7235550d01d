#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "cli/named_robot.hpp"
#include "cli/write_file.hpp"

namespace interlock::cli {
namespace {

using Json = nlohmann::ordered_json;

Result<void> drop_lines(std::vector<MeasuredPose>& poses, const std::vector<std::uint32_t>& lines) {
  for (const std::uint32_t line : lines) {
    if (std::erase_if(poses, [&](const MeasuredPose& pose) { return pose.line == line; }) == 0) {
      return failed(ExitCode::usage,
                    "--leave-out " + std::to_string(line) + ": no pose stands in that line of the table");
    }
  }
  return {};
}

Json to_json(const Robot& robot, const Calibration& found) {
  constexpr std::size_t worst_shown = 5;
  Json fitted = Json::array();
  for (const FittedNumber& number : found.fitted) {
    fitted.push_back({{"key", number.name},
                      {"unit", number.unit},
                      {"was", number.was},
                      {"is", number.is},
                      {"sd", number.sd},
                      {"interval_95", number.interval_95}});
  }
  Json held = Json::array();
  for (const HeldNumber& number : found.held) {
    held.push_back({{"key", number.name}, {"why", number.why}});
  }
  Json worst = Json::array();
  Json outliers = Json::array();
  for (const PoseMiss& miss : found.misses) {
    if (worst.size() < worst_shown) {
      worst.push_back(
          {{"line", miss.line}, {"distance_mm", miss.distance_mm}, {"normalised", miss.normalised}});
    }
    if (miss.outlier) {
      outliers.push_back(miss.line);
    }
  }
  Json residual{{"was_mm", found.was_rms_mm}, {"is_mm", found.is_rms_mm}};
  if (found.is_rms_rad) {
    residual.update({{"was_rad", *found.was_rms_rad}, {"is_rad", *found.is_rms_rad}});
  }
  return {{"robot", robot.name},
          {"poses", found.misses.size()},
          {"degrees_of_freedom", found.degrees_of_freedom},
          {"fitted", fitted},
          {"held", held},
          {"residual_rms", residual},
          {"point_sd_mm", found.point_sd_mm},
          {"calibration_mm", found.calibration_mm},
          {"worst", worst},
          {"outliers", outliers},
          {"gaps", found.gaps},
          {"tracker_from_zframe", row_major(found.tracker_from_zframe)}};
}

Result<void> write_without_outliers(const std::filesystem::path& file, const Calibration& found) {
  for (const PoseMiss& miss : found.misses) {
    if (miss.outlier && !file.empty()) {
      return failed(ExitCode::refused,
                    file.string() + " is not written: the pose in line " + std::to_string(miss.line) +
                        " misses by " + std::to_string(miss.distance_mm) +
                        " mm, far more than the others; measure it again, or leave it out (--leave-out)");
    }
  }
  return write_robot_file(file, found.changed_file);
}

}  // namespace

Result<void> calibrate(const CalibrateOptions& options, const Installation& installation,
                       std::ostream& output) {
  return installation.robot(options.robot).and_then([&](const std::filesystem::path& file) -> Result<void> {
    if (is_same_file(options.write, options.poses)) {
      return failed(ExitCode::usage,
                    options.write.string() + " would be overwritten by another file; choose another name");
    }
    const Result<Robot> robot = load_robot(file).map_error(robot_failure);
    const Result<std::string> text =
        robot.and_then([&](const Robot&) { return text_of_file(file, "a robot"); });
    auto poses =
        text.and_then([&](const std::string&) { return text_of_file(options.poses, "measured poses"); })
            .and_then([&](const std::string& table) {
              return read_poses(table, options.poses.string(), *robot).map_error(robot_failure);
            });
    const auto counted =
        poses.and_then([&](std::vector<MeasuredPose>& all) { return drop_lines(all, options.leave_out); });
    const auto found = counted.and_then([&] {
      return interlock::calibrate(*robot, *text, *poses, options.poses.string(), options.fit)
          .map_error(robot_failure);
    });
    return found.and_then([&](const Calibration& calibration) {
      output << to_json(*robot, calibration).dump() << '\n';
      return write_without_outliers(options.write, calibration);
    });
  });
}

}  // namespace interlock::cli
