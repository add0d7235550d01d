#include "trajectory/trajectory_builder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "trajectory/trajectory_header.hpp"

namespace interlock {

namespace {

using Code = TrajectoryError::Code;

bool accepts(const Axis& axis, double position) {
  const std::optional<std::int32_t> counts = axis.to_counts(position);
  return counts && axis.accepts_setpoint(*counts);
}

std::string allowed_text(const Axis& axis) {
  const auto [lowest, highest] = std::minmax(
      {axis.to_unit(axis.lowest_setpoint_counts()), axis.to_unit(axis.highest_setpoint_counts())});
  return number_text(lowest) + " to " + number_text(highest) + ' ' + std::string(unit_name(axis.unit)) +
         ", its soft limits less coast";
}

std::string speed_text(double velocity, const Axis& axis) {
  return number_text(velocity) + ' ' + std::string(unit_name(axis.unit)) + "/s";
}

TrajectoryResult<void> check_limits(const VelocityLimits& limits, const Robot& robot) {
  TrajectoryResult<void> checked;
  for (auto limit = limits.begin(); checked && limit != limits.end(); ++limit) {
    const auto& [name, velocity] = *limit;
    if (robot.find(name) == nullptr) {
      return tl::unexpected(TrajectoryError{Code::unknown_axis, 0, name + " velocity limit",
                                            robot.name + " has no such axis", "an axis of the robot"});
    }
    checked = check_within(name + " velocity limit", velocity, smallest_rate, largest_rate);
  }
  return checked;
}

}  // namespace

TrajectoryError wrong_columns(std::size_t line, std::size_t fields, std::span<const std::string> columns) {
  const bool missing = fields < columns.size();
  return {Code::wrong_columns, line,
          missing ? columns[fields] : "column " + std::to_string(columns.size() + 1),
          std::to_string(fields) + (fields == 1 ? " field" : " fields"),
          std::to_string(columns.size()) + " as in the header"};
}

TrajectoryResult<TrajectoryBuilder> TrajectoryBuilder::create(std::vector<std::string> columns,
                                                              const Robot& robot,
                                                              const VelocityLimits& limits) {
  return check_limits(limits, robot)
      .and_then([&] { return read_header(columns, robot); })
      .map([&](const std::vector<AxisColumns>& axes) {
        TrajectoryBuilder builder;
        builder.trajectory_.row_size_ = columns.size();
        for (const auto& [axis, position, velocity] : axes) {
          const auto limit = limits.find(axis->name);
          builder.rules_.push_back({*axis, limit == limits.end() ? largest_rate : limit->second});
          builder.trajectory_.axes_.push_back(
              {axis->slot, axis->name, axis->unit, position, velocity, {}, 0.0});
        }
        builder.ways_.resize(axes.size());
        builder.columns_ = std::move(columns);
        return builder;
      });
}

TrajectoryResult<void> TrajectoryBuilder::add(std::span<const double> row) {
  Checked checked = check_numbers(row).and_then([&] { return check_time(row.front()); });
  for (std::size_t axis = 0; checked && axis < rules_.size(); ++axis) {
    checked = check_state(axis, row);
  }
  for (std::size_t axis = 0; checked && axis < rules_.size(); ++axis) {
    ways_[axis] = way_to(axis, row);
    checked = check_way(axis, ways_[axis]);
  }
  if (!checked) {
    return checked;
  }
  const bool first = trajectory_.rows() == 0;
  for (std::size_t place = 0; place < rules_.size(); ++place) {
    TrajectoryAxis& axis = trajectory_.axes_[place];
    const auto& [reach, top_speed] = ways_[place];
    axis.reach = first ? reach : axis.reach;
    widen(axis.reach, reach.lowest);
    widen(axis.reach, reach.highest);
    axis.top_speed = std::max(axis.top_speed, top_speed);
  }
  trajectory_.numbers_.insert(trajectory_.numbers_.end(), row.begin(), row.end());
  return {};
}

TrajectoryResult<TimedTrajectory> TrajectoryBuilder::finish() && {
  if (trajectory_.rows() == 0) {
    return tl::unexpected(TrajectoryError{Code::empty, line(), columns_.front(), "no row",
                                          "at least one row below the header"});
  }
  return std::move(trajectory_);
}

TrajectoryResult<void> TrajectoryBuilder::check_numbers(std::span<const double> row) const {
  if (row.size() != columns_.size()) {
    return tl::unexpected(wrong_columns(line(), row.size(), columns_));
  }
  const auto bad = std::ranges::find_if_not(row, [](double number) { return std::isfinite(number); });
  if (bad != row.end()) {
    return refused(Code::not_finite, static_cast<std::size_t>(bad - row.begin()), "not a finite number",
                   "a number");
  }
  if (trajectory_.rows() == most_trajectory_rows) {
    return tl::unexpected(TrajectoryError{Code::too_large, line(), "", "too many rows",
                                          std::to_string(most_trajectory_rows) + " at most"});
  }
  return {};
}

TrajectoryResult<void> TrajectoryBuilder::check_time(double time_s) const {
  if (time_s < 0 || time_s > latest_time_s) {
    return refused(Code::out_of_range, 0, number_text(time_s) + " is out of range",
                   "0 to " + number_text(latest_time_s));
  }
  if (trajectory_.rows() > 0 && time_s < trajectory_.end_s() + shortest_step_s) {
    return refused(Code::unsorted_times, 0,
                   number_text(time_s) + " does not follow " + number_text(trajectory_.end_s()),
                   "times that rise by a microsecond at least");
  }
  return {};
}

TrajectoryResult<void> TrajectoryBuilder::check_state(std::size_t axis, std::span<const double> row) const {
  const auto& [rules, max_velocity] = rules_[axis];
  const TrajectoryAxis& columns = trajectory_.axes_[axis];
  const double position = row[columns.position_place];
  if (!accepts(rules, position)) {
    return refused(Code::out_of_range, columns.position_place, number_text(position) + " is out of range",
                   allowed_text(rules));
  }
  if (columns.velocity_place &&
      std::abs(row[*columns.velocity_place]) > max_velocity * (1 + velocity_slack)) {
    return refused(Code::too_fast, *columns.velocity_place,
                   speed_text(row[*columns.velocity_place], rules) + " is too fast",
                   speed_text(max_velocity, rules) + " at most, either way");
  }
  return {};
}

TrajectoryBuilder::Way TrajectoryBuilder::way_to(std::size_t axis, std::span<const double> row) const {
  const TrajectoryAxis& columns = trajectory_.axes_[axis];
  const double position = row[columns.position_place];
  Way way{{position, position}, 0.0};
  if (const std::size_t rows = trajectory_.rows(); rows > 0) {
    const std::span<const double> last = trajectory_.row(rows - 1);
    const CubicSegment piece = piece_between(columns, last, row);
    const double duration_s = row.front() - last.front();
    piece.widen(way.reach, duration_s);
    way.top_speed = piece.top_speed(duration_s);
  }
  return way;
}

TrajectoryResult<void> TrajectoryBuilder::check_way(std::size_t axis, const Way& way) const {
  const auto& [rules, max_velocity] = rules_[axis];
  const std::size_t column = trajectory_.axes_[axis].position_place;
  for (const double position : {way.reach.lowest, way.reach.highest}) {
    if (!accepts(rules, position)) {
      return refused(Code::out_of_range, column,
                     number_text(position) + " on the way from the row before is out of range",
                     allowed_text(rules));
    }
  }
  if (way.top_speed > max_velocity * (1 + velocity_slack)) {
    return refused(Code::too_fast, column,
                   speed_text(way.top_speed, rules) + " on the way from the row before is too fast",
                   speed_text(max_velocity, rules) + " at most, either way");
  }
  return {};
}

tl::unexpected<TrajectoryError> TrajectoryBuilder::refused(Code code, std::size_t column, std::string problem,
                                                           std::string expected) const {
  return tl::unexpected(
      TrajectoryError{code, line(), columns_[column], std::move(problem), std::move(expected)});
}

}  // namespace interlock
