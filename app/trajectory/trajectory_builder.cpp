#include "trajectory/trajectory_builder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "trajectory/smooth_rows.hpp"
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
         ", what the kernel accepts of it";
}

}  // namespace

/** A rate as it is judged and as errors speak of it. */
struct TrajectoryBuilder::RateRule {
  Rate rate;
  double RateLimits::* of;
  Code code;
  std::string_view per_time;
  std::string_view verdict;

  [[nodiscard]] std::string text(double value, const Axis& axis) const {
    return number_text(value) + ' ' + std::string(unit_name(axis.unit)) + std::string(per_time);
  }
};

constexpr std::array<TrajectoryBuilder::RateRule, 3> TrajectoryBuilder::rate_rules{
    RateRule{Rate::velocity, &RateLimits::velocity, Code::too_fast, "/s", "too fast"},
    RateRule{Rate::acceleration, &RateLimits::acceleration, Code::too_much_acceleration, "/s^2",
             "too much acceleration"},
    RateRule{Rate::jerk, &RateLimits::jerk, Code::too_much_jerk, "/s^3", "too much jerk"}};

TrajectoryError wrong_columns(std::size_t line, std::size_t fields, std::span<const std::string> columns) {
  const bool missing = fields < columns.size();
  return {Code::wrong_columns, line,
          missing ? columns[fields] : "column " + std::to_string(columns.size() + 1),
          std::to_string(fields) + (fields == 1 ? " field" : " fields"),
          std::to_string(columns.size()) + " as in the header"};
}

TrajectoryResult<TrajectoryBuilder> TrajectoryBuilder::create(std::vector<std::string> columns,
                                                              const Robot& robot, Timing timing) {
  return read_header(columns, robot).map([&](const std::vector<AxisColumns>& axes) {
    TrajectoryBuilder builder;
    builder.timing_ = timing;
    for (const auto& [axis, position, velocity] : axes) {
      builder.rules_.push_back({*axis, axis->motion->in_units(axis->counts_per_unit), position, velocity});
      builder.trajectory_.axes_.push_back({axis->slot, axis->name, axis->unit, {}, {}});
    }
    builder.columns_ = std::move(columns);
    return builder;
  });
}

TrajectoryResult<void> TrajectoryBuilder::add(std::span<const double> row) {
  Checked checked = check_numbers(row).and_then([&] { return check_time(row.front()); });
  for (auto rules = rules_.begin(); checked && rules != rules_.end(); ++rules) {
    checked = check_state(*rules, row);
  }
  if (!checked) {
    return checked;
  }
  trajectory_.times_s_.push_back(row.front());
  for (const AxisRules& rules : rules_) {
    const auto velocity = rules.velocity_place;
    trajectory_.states_.push_back({row[rules.position_place], velocity ? row[*velocity] : 0.0, 0.0});
  }
  return {};
}

TrajectoryResult<TimedTrajectory> TrajectoryBuilder::finish() && {
  if (trajectory_.rows() == 0) {
    return tl::unexpected(TrajectoryError{Code::empty, line(), columns_.front(), "no row",
                                          "at least one row below the header"});
  }
  for (std::size_t axis = 0; axis < rules_.size(); ++axis) {
    smooth(axis);
  }
  look_between_rows();
  return judge().and_then([&] { return slow_down(); }).map([&] { return std::move(trajectory_); });
}

TrajectoryResult<void> TrajectoryBuilder::check_numbers(std::span<const double> row) const {
  if (row.size() != columns_.size()) {
    return tl::unexpected(wrong_columns(line(), row.size(), columns_));
  }
  const auto bad = std::ranges::find_if_not(row, [](double number) { return std::isfinite(number); });
  if (bad != row.end()) {
    return refused(Code::not_finite, trajectory_.rows(), static_cast<std::size_t>(bad - row.begin()),
                   "not a finite number", "a number");
  }
  if (trajectory_.rows() == most_trajectory_rows) {
    return tl::unexpected(TrajectoryError{Code::too_large, line(), "", "too many rows",
                                          std::to_string(most_trajectory_rows) + " at most"});
  }
  return {};
}

TrajectoryResult<void> TrajectoryBuilder::check_time(double time_s) const {
  const std::size_t row = trajectory_.rows();
  if (time_s < 0 || time_s > latest_time_s) {
    return refused(Code::out_of_range, row, 0, number_text(time_s) + " is out of range",
                   "0 to " + number_text(latest_time_s));
  }
  if (row > 0 && time_s - trajectory_.end_s() < shortest_step_s * time_slack) {
    return refused(Code::unsorted_times, row, 0,
                   number_text(time_s) + " does not follow " + number_text(trajectory_.end_s()),
                   "times that rise by a microsecond at least");
  }
  return {};
}

TrajectoryResult<void> TrajectoryBuilder::check_state(const AxisRules& rules,
                                                      std::span<const double> row) const {
  const double position = row[rules.position_place];
  if (!accepts(rules.axis, position)) {
    return refused(Code::out_of_range, trajectory_.rows(), rules.position_place,
                   number_text(position) + " is out of range", allowed_text(rules.axis));
  }
  if (rules.velocity_place && std::abs(row[*rules.velocity_place]) > largest_rate) {
    return refused(Code::out_of_range, trajectory_.rows(), *rules.velocity_place,
                   number_text(row[*rules.velocity_place]) + " is out of range",
                   number_text(-largest_rate) + " to " + number_text(largest_rate));
  }
  return {};
}

void TrajectoryBuilder::smooth(std::size_t axis) {
  const std::size_t rows = trajectory_.rows();
  std::vector<MotionState> states(rows);
  for (std::size_t row = 0; row < rows; ++row) {
    states[row] = trajectory_.state(row, axis);
  }
  if (rows == 1) {
    states.front().velocity = 0.0;  // it stands
  }
  (rules_[axis].velocity_place ? smooth_velocities : smooth_positions)(trajectory_.times_s_, states);
  for (std::size_t row = 0; row < rows; ++row) {
    trajectory_.state(row, axis) = states[row];
  }
}

void TrajectoryBuilder::look_between_rows() {
  for (std::size_t axis = 0; axis < rules_.size(); ++axis) {
    const double first = trajectory_.state(0, axis).position;
    trajectory_.axes_[axis].reach = {first, first};
  }
  for (std::size_t row = 0; row + 1 < trajectory_.rows(); ++row) {
    for (std::size_t axis = 0; axis < rules_.size(); ++axis) {
      look_at_way(axis, row);
    }
  }
}

void TrajectoryBuilder::look_at_way(std::size_t axis, std::size_t row) {
  const AxisRules& rules = rules_[axis];
  PositionRange& reach = trajectory_.axes_[axis].reach;
  const MotionPiece piece = trajectory_.piece(axis, row);
  piece.widen(reach, trajectory_.step_s(row));
  for (const double position : {reach.lowest, reach.highest}) {
    if (!outside_ && !accepts(rules.axis, position)) {
      outside_ = refused(Code::out_of_range, row + 1, rules.position_place,
                         number_text(position) + " on the way from the row before is out of range",
                         allowed_text(rules.axis))
                     .value();
    }
  }
  for (const RateRule& rule : rate_rules) {
    look_at_rate(axis, row, rule, piece);
  }
}

/** The n-th derivative falls with the n-th power of the time that all of it takes. */
void TrajectoryBuilder::look_at_rate(std::size_t axis, std::size_t row, const RateRule& rule,
                                     const MotionPiece& piece) {
  const AxisRules& rules = rules_[axis];
  double& top = trajectory_.axes_[axis].top.*rule.of;
  Peak peak{top, 0.0};
  if (!piece.raise(peak, rule.rate, trajectory_.step_s(row))) {
    return;
  }
  top = peak.magnitude;
  const double limit = rules.limits.*rule.of;
  const double slowness = std::pow(top / limit, 1.0 / static_cast<double>(rule.rate));
  if (top <= limit * (1 + rate_slack) || slowness <= slowness_) {
    return;
  }
  slowness_ = slowness;
  const bool on_the_way = peak.time_s > 0.0;
  too_fast_ =
      refused(rule.code, on_the_way ? row + 1 : row, rules.position_place,
              rule.text(top, rules.axis) + " at " + number_text(trajectory_.times_s_[row] + peak.time_s) +
                  " s" + (on_the_way ? ", on the way from the row before," : "") + " is " +
                  std::string(rule.verdict),
              rule.text(limit, rules.axis) + " at most, either way")
          .value();
}

/** A rate first: where an axis is thrown about it may well leave its range. */
TrajectoryResult<void> TrajectoryBuilder::judge() {
  const bool refuses_speed = too_fast_ && timing_ == Timing::as_written;
  if (refuses_speed && !outside_) {
    const double to_a_percent = std::ceil(slowness_ * 100.0) / 100.0;
    too_fast_->expected +=
        "; slowed down to fit, it would take " + number_text(to_a_percent) + " times as long";
  }
  if (refuses_speed || outside_) {
    return tl::unexpected(refuses_speed ? *too_fast_ : *outside_);
  }
  return {};
}

TrajectoryResult<void> TrajectoryBuilder::slow_down() {
  if (!too_fast_) {
    return {};  // every time stays as it was written, to the last bit
  }
  const double begin_s = trajectory_.begin_s();
  const double end_s = begin_s + trajectory_.duration_s() * slowness_;
  if (end_s > latest_time_s) {
    return refused(Code::out_of_range, trajectory_.rows() - 1, 0,
                   number_text(end_s) + ", slowed down to fit, is out of range",
                   "0 to " + number_text(latest_time_s));
  }
  for (double& time_s : trajectory_.times_s_) {
    time_s = begin_s + (time_s - begin_s) * slowness_;
  }
  for (MotionState& state : trajectory_.states_) {
    state.velocity /= slowness_;
    state.acceleration /= slowness_ * slowness_;
  }
  for (TrajectoryAxis& axis : trajectory_.axes_) {
    for (const RateRule& rule : rate_rules) {
      axis.top.*rule.of /= std::pow(slowness_, static_cast<double>(rule.rate));
    }
  }
  trajectory_.slowed_by_ = slowness_;
  return {};
}

tl::unexpected<TrajectoryError> TrajectoryBuilder::refused(Code code, std::size_t row, std::size_t column,
                                                           std::string problem, std::string expected) const {
  return tl::unexpected(
      TrajectoryError{code, line_of(row), columns_[column], std::move(problem), std::move(expected)});
}

}  // namespace interlock
