#include "plant/axis.hpp"

#include <algorithm>
#include <cmath>

namespace interlock::plant {
namespace {

/** Friction holds an undriven motor below this speed, so that it comes to rest. */
constexpr double kRestSpeedCountsPerS = 0.5;

double seconds(Microseconds time) { return static_cast<double>(time.count()) * 1e-6; }

double end_stop(const ilk_axis_config_t& axis, const AxisParameters& parameters, bool upper) {
  const double edge = axis.limit_side == ILK_LIMIT_NONE ? axis.min_counts : axis.home_offset_counts;
  return upper ? std::max<double>(axis.max_counts, edge) + parameters.end_margin_counts
               : std::min<double>(axis.min_counts, edge) - parameters.end_margin_counts;
}

}  // namespace

LimitSwitch::LimitSwitch(const ilk_axis_config_t& axis, const AxisParameters& parameters)
    : side_(static_cast<ilk_limit_side_t>(axis.limit_side)),
      edge_counts_(axis.home_offset_counts),
      hysteresis_counts_(parameters.switch_hysteresis_counts),
      contact_(side_ != ILK_LIMIT_NONE && past_edge(parameters.start_counts) >= 0, parameters.switch_bounce) {
}

double LimitSwitch::past_edge(double position_counts) const {
  return side_ == ILK_LIMIT_UPPER ? position_counts - edge_counts_ : edge_counts_ - position_counts;
}

void LimitSwitch::follow(double position_counts) {
  if (side_ == ILK_LIMIT_NONE) {
    return;
  }
  if (past_edge(position_counts) >= 0 && !contact_.closed()) {
    contact_.move(true);
  } else if (past_edge(position_counts) < -hysteresis_counts_ && contact_.closed()) {
    contact_.move(false);
  }
}

Axis::Axis(const ilk_axis_config_t& axis, const AxisParameters& parameters)
    : file_parameters_(parameters),
      parameters_(parameters),
      motor_(axis, parameters),
      switch_(axis, parameters),
      lag_s_(seconds(parameters.lag)),
      play_(parameters.backlash_counts / 2),
      lowest_(end_stop(axis, parameters, false)),
      highest_(end_stop(axis, parameters, true)),
      motor_position_(parameters.start_counts),
      load_(parameters.start_counts),
      tool_(parameters.start_counts) {}

void Axis::push(double counts, Microseconds duration) {
  push_left_ += counts;
  push_speed_ = std::abs(push_left_) / seconds(duration);
}

double Axis::push_step(double elapsed_s) {
  const double longest = push_speed_ * elapsed_s;
  const double step = std::clamp(push_left_, -longest, longest);
  push_left_ -= step;
  return step;
}

void Axis::advance(Microseconds elapsed) {
  const double elapsed_s = seconds(elapsed);
  const double pushed = push_step(elapsed_s);
  const double effort = supplied_ ? effort_ : 0.0;
  warmth_ += (effort - warmth_) * elapsed_s / (parameters_.heat_time_s + elapsed_s);
  switch_.advance(elapsed);
  if (jammed_) {
    speed_ = 0;
    return;
  }
  const double target_speed = supplied_ ? target_speed_ : 0.0;
  if (runaway_speed_ && supplied_) {
    speed_ = *runaway_speed_;
  } else {
    speed_ = (speed_ * lag_s_ + target_speed * elapsed_s) / (lag_s_ + elapsed_s);
    if (target_speed == 0 && std::abs(speed_) < kRestSpeedCountsPerS) {
      speed_ = 0;
    }
  }
  const double wanted = motor_position_ + speed_ * elapsed_s + pushed;
  motor_position_ = std::clamp(wanted, lowest_ - play_, highest_ + play_);
  if (motor_position_ != wanted) {
    speed_ = 0;
  }
  load_ = std::clamp(load_ + pushed, motor_position_ - play_, motor_position_ + play_);
  tool_ = std::clamp(tool_, load_, load_ + parameters_.tool_play_counts);
  switch_.follow(load_);
}

void Axis::take(const AxisParameters& parameters) {
  parameters_ = parameters;
  motor_.take(parameters);
  lag_s_ = seconds(parameters.lag);
  play_ = parameters.backlash_counts / 2;
}

void Axis::clear_faults() {
  jammed_ = false;
  push_left_ = 0;
  runaway_speed_.reset();
  motor_.reverse(false);
  switch_.stick(std::nullopt);
}

}  // namespace interlock::plant
