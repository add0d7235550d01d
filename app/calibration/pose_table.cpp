#include "calibration/pose_table.hpp"

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <charconv>
#include <cmath>
#include <functional>
#include <map>

#include "robot/table_reader.hpp"

namespace interlock {
namespace {

using Eigen::Vector3d;

/** A number of a row, and where it goes. */
struct Column {
  std::string name;
  bool needed;
  std::function<void(MeasuredPose& pose, double number)> keep;
  std::optional<std::size_t> place = std::nullopt; /**< in the rows */
};

std::vector<Column> columns_of(const Robot& robot) {
  std::vector<Column> columns;
  for (std::size_t place = 0; place < robot.axes.size(); ++place) {
    const Axis& axis = robot.axes[place];
    if (!axis.role.empty()) {
      columns.push_back({axis.name + " [" + std::string(unit_name(axis.unit)) + ']', true,
                         [place](MeasuredPose& pose, double number) { pose.positions[place] = number; }});
    }
  }
  for (const Eigen::Index place : {0, 1, 2}) {
    columns.push_back({std::string("tool_") + "xyz"[place] + " [mm]", true,
                       [place](MeasuredPose& pose, double number) { pose.point_mm[place] = number; }});
  }
  for (const Eigen::Index place : {0, 1, 2}) {
    columns.push_back({std::string("direction_") + "xyz"[place], false,
                       [place](MeasuredPose& pose, double number) { (*pose.direction)[place] = number; }});
  }
  columns.push_back({"sd [mm]", false, [](MeasuredPose& pose, double number) { pose.sd_mm = number; }});
  columns.push_back({"sd [rad]", false, [](MeasuredPose& pose, double number) { pose.sd_rad = number; }});
  return columns;
}

std::string names_of(const std::vector<Column>& columns) {
  std::string names;
  for (const Column& column : columns) {
    names += (names.empty() ? "" : ", ") + column.name;
  }
  return names;
}

std::vector<std::string> fields_of(std::string_view line) {
  std::vector<std::string> fields;
  boost::split(fields, line, [](char letter) { return letter == ','; });
  for (std::string& field : fields) {
    boost::trim(field);
  }
  return fields;
}

/** Reads the lines of one table. */
class Reader {
 public:
  Reader(std::string file, const Robot& robot)
      : file_(std::move(file)), robot_(robot), columns_(columns_of(robot)) {}

  tl::expected<void, RobotError> header(std::string_view line) {
    const std::vector<std::string> fields = fields_of(line);
    width_ = fields.size();
    for (std::size_t place = 0; place < fields.size(); ++place) {
      const auto column = std::ranges::find(columns_, fields[place], &Column::name);
      if (column == columns_.end()) {
        return refused(fields[place], "no such column", "some of " + names_of(columns_));
      }
      if (column->place) {
        return refused(fields[place], "a second column of that name", "each once");
      }
      column->place = place;
    }
    for (const Column& column : columns_) {
      if (column.needed && !column.place) {
        return refused(column.name, "the column is missing", "a column for each axis and for the tool");
      }
    }
    const auto directions = std::ranges::count_if(
        columns_, [](const Column& column) { return column.place && column.name.starts_with("direction_"); });
    directed_ = directions == 3;
    if (directions % 3 != 0) {
      return refused("direction_x", "a direction has three numbers", "direction_x, direction_y, direction_z");
    }
    return {};
  }

  tl::expected<MeasuredPose, RobotError> row(std::string_view line) {
    ++line_;
    const std::vector<std::string> fields = fields_of(line);
    if (fields.size() != width_) {
      return refused("", std::to_string(fields.size()) + " fields",
                     std::to_string(width_) + " as in the header");
    }
    const auto [before, is_new] = seen_.emplace(boost::join(fields, ","), line_);
    if (!is_new) {
      return refused("", "the row is that of line " + std::to_string(before->second) + " again",
                     "each measurement once; one that was made again has digits of its own");
    }
    MeasuredPose pose;
    pose.line = line_;
    pose.positions.resize(robot_.axes.size());
    if (directed_) {
      pose.direction = Vector3d::Zero();
    }
    for (const Column& column : columns_) {
      if (!column.place) {
        continue;
      }
      const std::string& field = fields[*column.place];
      double number = 0.0;
      const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), number);
      if (error != std::errc{} || end != field.data() + field.size() || !std::isfinite(number)) {
        return refused(column.name, '"' + field + "\" is given", "a finite number");
      }
      column.keep(pose, number);
    }
    return checked(std::move(pose));
  }

 private:
  [[nodiscard]] tl::unexpected<RobotError> refused(std::string column, std::string problem,
                                                   std::string expected) const {
    return tl::unexpected(
        RobotError{file_, line_, std::move(column), std::move(problem), std::move(expected)});
  }

  tl::expected<MeasuredPose, RobotError> checked(MeasuredPose pose) const {
    for (std::size_t place = 0; place < robot_.axes.size(); ++place) {
      const Axis& axis = robot_.axes[place];
      if (!axis.role.empty() && !axis.reaches(pose.positions[place])) {
        return refused(axis.name, text_of(pose.positions[place]) + " is beyond the soft limits",
                       text_of(axis.to_unit(axis.soft_limits.min_counts)) + " to " +
                           text_of(axis.to_unit(axis.soft_limits.max_counts)) + ' ' +
                           std::string(unit_name(axis.unit)));
      }
    }
    constexpr double farthest_mm = 100000.0;
    if (pose.point_mm.cwiseAbs().maxCoeff() > farthest_mm) {
      return refused("tool_x [mm]", "the point is farther than 100 m from the origin", "millimetres");
    }
    if (pose.direction) {
      if (std::abs(pose.direction->norm() - 1.0) > 1e-3) {
        return refused("direction_x", "the direction is of length " + text_of(pose.direction->norm()),
                       "a unit vector, to 0.001");
      }
      pose.direction->normalize();
    }
    if (const auto problem = deviation_problem(pose.sd_mm, pose.sd_rad)) {
      return refused("sd", *problem, "such a deviation, or no such column");
    }
    return pose;
  }

  std::string file_;
  const Robot& robot_;
  std::vector<Column> columns_;
  std::map<std::string, std::uint32_t> seen_; /**< rows, with their lines */
  std::uint32_t line_ = 1;
  std::size_t width_ = 0;
  bool directed_ = false;
};

}  // namespace

std::optional<std::string> deviation_problem(const std::optional<double>& sd_mm,
                                             const std::optional<double>& sd_rad) {
  const auto beyond = [](double value, double least, double most) {
    return !(value >= least && value <= most);
  };
  if (sd_mm && beyond(*sd_mm, 1e-4, 20.0)) {
    return "a standard deviation of " + text_of(*sd_mm) + " mm is not from 0.0001 to 20 mm";
  }
  if (sd_rad && beyond(*sd_rad, 1e-6, 0.5)) {
    return "a standard deviation of " + text_of(*sd_rad) + " rad is not from 0.000001 to 0.5 rad";
  }
  return std::nullopt;
}

tl::expected<std::vector<MeasuredPose>, RobotError> read_poses(std::string_view text, const std::string& file,
                                                               const Robot& robot) {
  if (text.starts_with("\xEF\xBB\xBF")) {
    text.remove_prefix(3);
  }
  std::vector<std::string> lines;
  boost::split(lines, text, [](char letter) { return letter == '\n'; });
  for (std::string& line : lines) {
    boost::trim_right_if(line, [](char letter) { return letter == '\r'; });
  }
  if (lines.back().empty()) {
    lines.pop_back();
  }
  if (lines.size() < 2 || lines.size() > most_measured_poses + 1) {
    return tl::unexpected(RobotError{file, 0, "", std::to_string(lines.size()) + " lines are given",
                                     "a header and 1 to 10000 poses: " + names_of(columns_of(robot))});
  }
  Reader reader(file, robot);
  std::vector<MeasuredPose> poses;
  if (const auto header = reader.header(lines.front()); !header) {
    return tl::unexpected(header.error());
  }
  for (const std::string& line : std::span(lines).subspan(1)) {
    const auto pose = reader.row(line);
    if (!pose) {
      return tl::unexpected(pose.error());
    }
    poses.push_back(*pose);
  }
  return poses;
}

}  // namespace interlock
