#include "tuning/axis_measurement.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace interlock {
namespace {

/** At which the play is taken up and measured. */
constexpr double strong_share = 0.5;
/** What a move leaves out of its line: until then it gathers speed. */
constexpr double settling_share = 0.4;
constexpr std::uint32_t fewest_ticks = 20; /**< of a line */
constexpr double longest_move_s = 2.0;
constexpr double longest_way_s = 0.4; /**< at full speed */
constexpr double noise_s = 5.0;
constexpr double held_back_s = 0.5;
/** From the kernel's drive in a reading to the motor. */
constexpr double loop_ticks = 1.0;
/** Of a stall: what a move that may stand uses up of it, and most, for one that has play to take up. */
constexpr double tried_stall_share = 0.5;
constexpr double strong_stall_share = 0.8;
constexpr std::uint32_t most_retries = 10; /**< of a step */
/** With which a lease ends (motion/setpoint_lease.cpp): it moves nothing. */
constexpr std::uint32_t no_drive = 1;

}  // namespace

MeasuringRange measuring_range(const ilk_axis_config_t& rules, std::int32_t lowest_setpoint_counts,
                               std::int32_t highest_setpoint_counts) noexcept {
  const std::int64_t room = 2 * std::int64_t{rules.coast_counts};
  const std::int64_t low = lowest_setpoint_counts + room;
  const std::int64_t high = highest_setpoint_counts - room;
  if (high - low < 4 * MeasuringRange::shortest_way_counts) {
    return {lowest_setpoint_counts, highest_setpoint_counts,
            static_cast<std::int32_t>(std::max<std::int64_t>(0, (high - low) / 4))};
  }
  const double longest =
      std::max<double>(longest_way_s * rules.full_speed_counts_per_s, MeasuringRange::shortest_way_counts);
  const auto way = static_cast<std::int64_t>(std::min(longest, static_cast<double>(high - low) / 4.0));
  // Two moves to each side of the middle, and what the last of them coasts.
  const std::int64_t middle = low + (high - low) / 2;
  const auto lowest = std::max<std::int64_t>(lowest_setpoint_counts, middle - 2 * way - room);
  const auto highest = std::min<std::int64_t>(highest_setpoint_counts, middle + 2 * way + room);
  return {static_cast<std::int32_t>(lowest), static_cast<std::int32_t>(highest),
          static_cast<std::int32_t>(way)};
}

std::string too_short(const std::string& axis, const MeasuringRange& range) {
  return "the range of " + axis + " is too short to be measured in: moves of " +
         std::to_string(range.way_counts) + " counts; expected " +
         std::to_string(MeasuringRange::shortest_way_counts) + " at least";
}

std::string stands_words(const std::string& axis) {
  return axis +
         " stands at half of its largest drive for as long as its stall rule lets it: it moves nothing "
         "there, "
         "or has more play than its file says";
}

AxisMeasurement::AxisMeasurement(std::uint32_t period_us) : period_s_(period_us * 1e-6) {
  samples_.reserve(static_cast<std::size_t>(longest_move_s / period_s_) + 2);
}

void AxisMeasurement::begin(const ilk_axis_config_t& rules, const MeasuringRange& range) noexcept {
  rules_ = rules;
  range_ = range;
  state_ = State::measures;
  step_ = 0;
  retries_ = 0;
  noise_known_ = false;
  coast_counts_ = 0;
  fastest_seen_whole_ = false;
  strong_ = {};
  row_ = {};
  delay_after_reversal_ = {};
  delay_ = {};
  strong_speed_ = {};
  found_ = {};
  interrupt();
}

void AxisMeasurement::interrupt() noexcept {
  phase_ = Phase::rests;
  move_ = Move::none;
  direction_ = 0;
  begun_ = false;
}

MeasuringMove AxisMeasurement::see(const MeasuredTick& reading) noexcept {
  if (!begun_) {
    begun_ = true;
    wait_for_rest(reading);
  } else if (state_ == State::measures) {
    switch (phase_) {
      case Phase::rests:
        rest(reading);
        break;
      case Phase::watches_noise:
        watch_noise(reading);
        break;
      case Phase::drives:
        go_on(reading);
        break;
      case Phase::ends:
        end_move(reading);
        break;
    }
  }
  seen_tick_ = reading.tick;
  const bool drives = state_ == State::measures && phase_ == Phase::drives;
  return {target_, drives ? drive_ : 0};
}

void AxisMeasurement::wait_for_rest(const MeasuredTick& reading) noexcept {
  phase_ = Phase::rests;
  rest_at_ = reading.position_counts;
  rest_tick_ = reading.tick;
}

void AxisMeasurement::rest(const MeasuredTick& reading) noexcept {
  whole_ = whole_ && reading.tick - seen_tick_ == 1;
  if (std::abs(reading.position_counts - rest_at_) > static_cast<std::int32_t>(rules_.noise_counts)) {
    rest_at_ = reading.position_counts;
    rest_tick_ = reading.tick;
  } else if (reading.tick - rest_tick_ >= 2 * rules_.rest_ticks) {
    on_rest(reading);
  }
}

void AxisMeasurement::watch_noise(const MeasuredTick& reading) noexcept {
  lowest_ = std::min(lowest_, reading.position_counts);
  highest_ = std::max(highest_, reading.position_counts);
  if (static_cast<double>(reading.tick - noise_from_) * period_s_ >= noise_s) {
    noise_known_ = true;
    found_.noise_counts = static_cast<std::uint32_t>(highest_ - lowest_);
    next(reading);
  }
}

/** A move ends when it has gone its way, when it has lasted, or where the axis stands: well before the kernel
 * would call it a stall. */
void AxisMeasurement::go_on(const MeasuredTick& reading) noexcept {
  if (!driven_since_) {
    if (reading.drive > no_drive) {
      // Readings may be missing since then.
      const auto waited = static_cast<std::int32_t>(reading.move_tick - asked_tick_);
      driven_since_ = waited > 0 ? reading.move_tick - 1 : reading.tick - 1;
      mark_tick_ = *driven_since_;
      samples_.push_back({reading.tick - *driven_since_, direction_ * (reading.position_counts - from_)});
    } else if (static_cast<double>(reading.tick - asked_tick_) * period_s_ >= held_back_s) {
      retry();
    }
    return;
  }
  if (reading.drive <= no_drive) {  // a lease ran out, or a limit is in the way
    retry();
    return;
  }
  const std::int32_t gone = direction_ * (reading.position_counts - from_);
  if (samples_.size() < samples_.capacity()) {
    samples_.push_back({reading.tick - *driven_since_, gone});
  }
  if (gone - mark_ >= static_cast<std::int32_t>(rules_.stall_min_counts + rules_.noise_counts)) {
    mark_ = gone;
    mark_tick_ = reading.tick;
  }
  stood_ = reading.tick - mark_tick_ >= longest_;
  const double lasted_s = static_cast<double>(reading.tick - *driven_since_ + 1) * period_s_;
  if (gone >= way_ || stood_ || lasted_s >= longest_move_s) {
    phase_ = Phase::ends;
    whole_ = true;
    last_driven_ = reading.position_counts;
  }
}

void AxisMeasurement::end_move(const MeasuredTick& reading) noexcept {
  whole_ = whole_ && reading.tick - seen_tick_ == 1;
  if (reading.drive != 0) {
    last_driven_ = reading.position_counts;
  } else {
    wait_for_rest(reading);
  }
}

void AxisMeasurement::on_rest(const MeasuredTick& reading) noexcept {
  const Move ended = move_;
  move_ = Move::none;
  if (ended == Move::strong || ended == Move::tried) {
    note_coast(ended == Move::tried && drive_ == drive_of(1.0), reading);
    const Line measured = stood_ ? Line{} : line();
    if (ended == Move::tried) {
      take(measured);
    } else if (measured.speed_counts_per_s > 0.0) {
      strong_ = measured;
      start(Move::tried, direction_, range_.way_counts, reading);
      return;
    }
  }
  if (stood_ && (ended == Move::strong || ended == Move::approach)) {
    state_ = State::stands;
  } else if (state_ == State::measures) {
    next(reading);
  }
}

/** The fastest moves coast farthest: without one of them nobody knows how far. */
void AxisMeasurement::note_coast(bool fastest, const MeasuredTick& reading) noexcept {
  if (!whole_) {
    return;
  }
  const std::int32_t coast = direction_ * (reading.position_counts - last_driven_);
  coast_counts_ = std::max(coast_counts_, static_cast<std::uint32_t>(std::max(0, coast)));
  fastest_seen_whole_ = fastest_seen_whole_ || fastest;
  if (fastest_seen_whole_) {
    found_.coast_counts = coast_counts_;
  }
}

/** The noise first. A step begins on the side of the middle that leaves room for two moves, and after a move
 * the other way, so that there is all of the play to take up. */
void AxisMeasurement::next(const MeasuredTick& reading) noexcept {
  if (!noise_known_) {
    phase_ = Phase::watches_noise;
    noise_from_ = reading.tick;
    lowest_ = reading.position_counts;
    highest_ = lowest_;
    return;
  }
  const int direction = step_direction();
  const std::int32_t before_middle = direction * (range_.middle_counts() - reading.position_counts);
  const std::int32_t to_start = before_middle - range_.way_counts;
  if (before_middle < 0 || to_start > range_.way_counts) {
    start(Move::approach, to_start > 0 ? direction : -direction, std::abs(to_start), reading);
  } else if (direction_ != -direction) {
    start(Move::approach, -direction, range_.way_counts / 4, reading);
  } else {
    start(Move::strong, direction, range_.way_counts, reading);
  }
}

void AxisMeasurement::start(Move move, int direction, std::int32_t way,
                            const MeasuredTick& reading) noexcept {
  move_ = move;
  phase_ = Phase::drives;
  direction_ = direction;
  drive_ = drive_of(move == Move::tried ? measured_shares[step_ / 2] : strong_share);
  from_ = reading.position_counts;
  way_ = way;
  target_ = std::clamp(from_ + direction * (way + static_cast<std::int32_t>(rules_.coast_counts)),
                       range_.lowest_counts, range_.highest_counts);
  longest_ = ticks_until_it_stands(move == Move::tried ? tried_stall_share : strong_stall_share);
  asked_tick_ = reading.tick;
  driven_since_.reset();
  mark_ = 0;
  stood_ = false;
  samples_.clear();
}

/** Well below what the kernel's stall rule allows. */
std::uint32_t AxisMeasurement::ticks_until_it_stands(double stall_share) const noexcept {
  const std::uint64_t effort = std::uint64_t{rules_.stall_effort_ticks} * rules_.max_drive / drive_;
  return static_cast<std::uint32_t>(stall_share *
                                    static_cast<double>(std::min<std::uint64_t>(
                                        rules_.stall_ticks, effort == 0 ? rules_.stall_ticks : effort)));
}

std::uint32_t AxisMeasurement::drive_of(double share) const noexcept {
  return std::max(no_drive + 1, static_cast<std::uint32_t>(std::lround(share * rules_.max_drive)));
}

/** What was under way was no whole move. */
void AxisMeasurement::retry() noexcept {
  if (++retries_ > most_retries) {
    state_ = State::held_back;
  } else {
    interrupt();
  }
}

void AxisMeasurement::take(const Line& tried) noexcept {
  delay_after_reversal_.add(strong_.delay_s);
  strong_speed_.add(strong_.speed_counts_per_s);
  delay_.add(tried.delay_s, tried.speed_counts_per_s);
  row_.drive = drive_;
  (direction_ > 0 ? row_.up_counts_per_s : row_.down_counts_per_s) = tried.speed_counts_per_s;
  retries_ = 0;
  ++step_;
  if (step_ % 2 != 0) {
    return;
  }
  found_.speeds.push_back(row_);
  const bool stands = row_.up_counts_per_s == 0.0 && row_.down_counts_per_s == 0.0;
  if (stands || step_ == most_steps) {
    fit();
    state_ = State::done;
  }
}

AxisMeasurement::Line AxisMeasurement::line() const noexcept {
  const auto first = static_cast<std::uint32_t>(
      settling_share * (samples_.empty() ? 0.0 : static_cast<double>(samples_.back().ticks + 1)));
  if (samples_.empty() || samples_.back().ticks + 1 - first < fewest_ticks) {
    return {};
  }
  Mean tick;
  Mean way;
  for (const Sample& each : samples_) {
    if (each.ticks >= first) {
      tick.add(each.ticks);
      way.add(each.gone);
    }
  }
  double along = 0.0;
  double spread = 0.0;
  for (const Sample& each : samples_) {
    if (each.ticks >= first) {
      const double beside = each.ticks - tick.value();
      along += beside * (each.gone - way.value());
      spread += beside * beside;
    }
  }
  if (along <= 0.0) {
    return {};
  }
  const double per_tick = along / spread;
  // The first tick with drive is number 1, and its reading was made before.
  return {.speed_counts_per_s = per_tick / period_s_,
          .delay_s = (tick.value() - 1.0 - way.value() / per_tick) * period_s_};
}

/** The line of speed over drive, by the mean of both directions, through the drives at which both moved. */
void AxisMeasurement::fit() noexcept {
  Mean drive;
  Mean speed;
  for (const DriveSpeed& at : found_.speeds) {
    found_.full_speed_counts_per_s =
        std::max({found_.full_speed_counts_per_s, at.up_counts_per_s, at.down_counts_per_s});
    if (at.up_counts_per_s > 0.0 && at.down_counts_per_s > 0.0) {
      drive.add(at.drive);
      speed.add((at.up_counts_per_s + at.down_counts_per_s) / 2);
    }
  }
  double along = 0.0;
  double spread = 0.0;
  const auto each_moved = [&](const auto& see) {
    for (const DriveSpeed& at : found_.speeds) {
      if (at.up_counts_per_s > 0.0 && at.down_counts_per_s > 0.0) {
        see(at.drive - drive.value(), (at.up_counts_per_s + at.down_counts_per_s) / 2 - speed.value());
      }
    }
  };
  each_moved([&](double beside, double above) {
    along += beside * above;
    spread += beside * beside;
  });
  const double slope = along / spread;
  double squares = 0.0;
  each_moved([&](double beside, double above) { squares += std::pow(above - slope * beside, 2); });
  found_.dead_zone_drive = std::max(0.0, drive.value() - speed.value() / slope);
  found_.fit_percent = 100 * std::sqrt(squares / drive.weights) / found_.full_speed_counts_per_s;
  found_.lag_s = std::max(0.0, delay_.value() - loop_ticks * period_s_);
  found_.backlash_counts =
      std::max(0.0, (delay_after_reversal_.value() - delay_.value()) * strong_speed_.value());
}

}  // namespace interlock
