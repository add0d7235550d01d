#include "tuning/identification.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "chart/time_chart.hpp"
#include "robot/compile.hpp"

namespace interlock {
namespace {

/** Of the largest drive, in this order: an axis that does not move at one is not asked to move at the next.
 */
constexpr std::array shares{1.0,  1.0,  1.0,  1.0,  0.5,  0.5,  0.5,  0.5,  0.7,   0.35,
                            0.25, 0.18, 0.15, 0.12, 0.09, 0.07, 0.05, 0.03, 0.015, 0.008};
/** At which the play is taken up and measured. */
constexpr double strong_share = 0.5;
/** What a move leaves out of its line: until then it gathers speed. */
constexpr double settling_share = 0.4;
constexpr std::size_t fewest_samples = 20;
constexpr double longest_move_s = 2.0;
constexpr double longest_way_s = 0.4; /**< at full speed */
constexpr double noise_s = 5.0;
constexpr std::int32_t shortest_way_counts = 60;
constexpr double loop_ticks = 2.0;
/** Of a stall: what a move that may stand uses up of it, and most, for one that has play to take up. */
constexpr double tried_stall_share = 0.5;
constexpr double strong_stall_share = 0.8;
/** Of the largest drive; the kernel accepts no wider one. */
constexpr double widest_dead_zone = 0.2;
constexpr double dead_zone_step = 0.02;

/** One move at a steady drive. */
struct Line {
  double speed_counts_per_s = 0.0; /**< 0: it stood */
  double delay_s = 0.0;            /**< T of the line */
  std::uint32_t coast_counts = 0;
};

struct Mean {
  double sum = 0.0;
  double weights = 0.0;

  void add(double value, double weight = 1.0) {
    sum += weight * value;
    weights += weight;
  }
  [[nodiscard]] double value() const { return weights == 0.0 ? 0.0 : sum / weights; }
};

class Identification {
 public:
  Identification(const Axis& axis, const ilk_config_t& config, const plant::Parameters& parameters,
                 std::uint64_t seed)
      : axis_(axis),
        config_(config),
        rules_(config_.axis[axis.slot]),
        period_s_(config.common.period_us * 1e-6),
        parameters_(parameters),
        seed_(seed) {
    found_.axis = axis.name;
  }

  RigResult<Identified> run() {
    return ready()
        .and_then([&] { return watch_noise(); })
        .and_then([&] { return go_to_the_start(); })
        .and_then([&] { return try_drives(); })
        .map([&] {
          fit();
          return found_;
        });
  }

 private:
  RigResult<void> ready();
  RigResult<void> home();
  RigResult<void> watch_noise();
  RigResult<void> go_to_the_start();
  RigResult<void> try_drives();
  RigResult<Line> move_strongly(int direction, std::int32_t way);
  RigResult<Line> move(int direction, std::uint32_t drive, std::int32_t way, double stall_share);
  RigResult<void> come_to_rest();
  void fit();
  [[nodiscard]] Line line_of(const std::vector<double>& ways) const;
  [[nodiscard]] std::uint32_t drive_of(double share) const {
    return std::max(1U, static_cast<std::uint32_t>(std::lround(share * rules_.max_drive)));
  }
  /** Ticks without progress after which an axis stands: that share of what the kernel calls a stall. */
  [[nodiscard]] std::uint32_t ticks_until_it_stands(std::uint32_t drive, double stall_share) const {
    const std::uint64_t effort = std::uint64_t{rules_.stall_effort_ticks} * rules_.max_drive / drive;
    return static_cast<std::uint32_t>(stall_share *
                                      static_cast<double>(std::min<std::uint64_t>(
                                          rules_.stall_ticks, effort == 0 ? rules_.stall_ticks : effort)));
  }
  [[nodiscard]] std::int32_t position() const { return rig_->axis().position_counts; }

  const Axis& axis_;
  ilk_config_t config_;
  const ilk_axis_config_t& rules_;
  double period_s_;
  const plant::Parameters& parameters_;
  std::uint64_t seed_;
  std::optional<StepRig> rig_;
  Identified found_;
  std::int32_t way_counts_ = 0; /**< of each move */
  Mean delay_after_reversal_;   /**< at the strong drive */
  Mean delay_;                  /**< the play taken up; a count of error is less of it, the faster the move */
  Mean strong_speed_;
};

RigResult<void> Identification::ready() {
  const RigResult<void> homed = home();
  if (homed) {
    return homed;
  }
  found_.homing_error = homed.error();
  const ilk_config_t file = config_;
  for (double share = dead_zone_step; axis_.homing && share <= widest_dead_zone; share += dead_zone_step) {
    const double dead_zone = share * axis_.drive.max;
    if (dead_zone > axis_.drive.dead_zone) {
      config_ = file;
      config_.axis[axis_.slot] = compile_axis(with_dead_zone(axis_, dead_zone));
      config_.crc = ilk_config_crc(&config_);
      if (home()) {
        return {};
      }
    }
  }
  return tl::unexpected(homed.error() + ", before the first move");
}

/** From power on. The switch opens when homing backs off, and closes when it comes again, slowly. */
RigResult<void> Identification::home() {
  rig_.emplace(config_, parameters_, seed_, axis_.slot);
  std::uint32_t reading = 0;
  std::optional<std::uint32_t> opened;
  found_.hysteresis_counts.reset();
  return rig_->make_ready([&](const ilk_axis_t& axis) {
    const bool changed = axis.switch_reading != reading;
    reading = axis.switch_reading;
    if (changed && axis.homing_phase == ILK_HOMING_BACK_OFF && !opened) {
      opened = axis.raw;
    } else if (changed && axis.homing_phase >= ILK_HOMING_APPROACH && opened && !found_.hysteresis_counts) {
      found_.hysteresis_counts = std::abs(static_cast<double>(static_cast<std::int32_t>(axis.raw - *opened)));
    }
  });
}

RigResult<void> Identification::watch_noise() {
  std::int32_t lowest = position();
  std::int32_t highest = lowest;
  for (double time_s = 0.0; time_s < noise_s; time_s += period_s_) {
    if (const RigResult<void> ticked = rig_->tick(); !ticked) {
      return ticked;
    }
    lowest = std::min(lowest, position());
    highest = std::max(highest, position());
  }
  found_.noise_counts = static_cast<std::uint32_t>(highest - lowest);
  return {};
}

/** Moves go to and fro over less than two thirds of the range, clear of its ends. */
RigResult<void> Identification::go_to_the_start() {
  const auto room = static_cast<std::int32_t>(2 * rules_.coast_counts);
  const std::int32_t lowest = axis_.lowest_setpoint_counts() + room;
  const std::int32_t highest = axis_.highest_setpoint_counts() - room;
  const double longest =
      std::max<double>(longest_way_s * rules_.full_speed_counts_per_s, shortest_way_counts);
  way_counts_ = static_cast<std::int32_t>(std::min<double>(longest, (highest - lowest) / 4.0));
  if (way_counts_ < shortest_way_counts) {
    return tl::unexpected("the range of " + axis_.name + " is too short to be measured in: moves of " +
                          std::to_string(way_counts_) + " counts; expected " +
                          std::to_string(shortest_way_counts) + " at least");
  }
  const std::int32_t start = lowest + (highest - lowest - 2 * way_counts_) / 2;
  while (std::abs(start - position()) > way_counts_ / 4) {
    const int direction = start > position() ? 1 : -1;
    const auto moved = move_strongly(direction, std::abs(start - position()));
    if (!moved) {
      return tl::unexpected(moved.error());
    }
  }
  return {};
}

RigResult<void> Identification::try_drives() {
  for (const double share : shares) {
    DriveSpeed speed{.drive = drive_of(share)};
    for (const int direction : {1, -1}) {
      const auto strong = move_strongly(direction, way_counts_);
      const auto tried = strong.and_then(
          [&](const Line&) { return move(direction, speed.drive, way_counts_, tried_stall_share); });
      if (!tried) {
        return tl::unexpected(tried.error() + ", at drive " + std::to_string(speed.drive));
      }
      (direction > 0 ? speed.up_counts_per_s : speed.down_counts_per_s) = tried->speed_counts_per_s;
      delay_after_reversal_.add(strong->delay_s);
      strong_speed_.add(strong->speed_counts_per_s);
      delay_.add(tried->delay_s, tried->speed_counts_per_s);
      found_.coast_counts = std::max({found_.coast_counts, tried->coast_counts, strong->coast_counts});
    }
    found_.speeds.push_back(speed);
    if (speed.up_counts_per_s == 0.0 && speed.down_counts_per_s == 0.0) {
      break;
    }
  }
  return {};
}

/** At half of the largest drive, at which it has to move, and has to take up its play before it stalls. */
RigResult<Line> Identification::move_strongly(int direction, std::int32_t way) {
  return move(direction, drive_of(strong_share), way, strong_stall_share)
      .and_then([&](const Line& line) -> RigResult<Line> {
        if (line.speed_counts_per_s == 0.0) {
          return tl::unexpected(axis_.name +
                                " stands at half of its largest drive for as long as its stall rule lets it: "
                                "it moves nothing there, or has more play than its file says");
        }
        return line;
      });
}

/** From rest to rest. It ends when it has gone its way, when it has lasted, or where the axis stands: well
 * before the kernel would call it a stall. */
RigResult<Line> Identification::move(int direction, std::uint32_t drive, std::int32_t way,
                                     double stall_share) {
  const std::int32_t from = position();
  const std::int32_t target =
      std::clamp(from + direction * (way + static_cast<std::int32_t>(rules_.coast_counts)),
                 axis_.lowest_setpoint_counts(), axis_.highest_setpoint_counts());
  const std::uint32_t longest = ticks_until_it_stands(drive, stall_share);
  const auto progress = static_cast<std::int32_t>(rules_.stall_min_counts + rules_.noise_counts);
  std::vector<double> ways{0.0};
  std::int32_t mark = 0;
  std::uint32_t since_mark = 0;
  std::int32_t gone = 0;
  while (gone < way && since_mark < longest &&
         static_cast<double>(ways.size()) * period_s_ < longest_move_s) {
    rig_->move(target, drive);
    if (const RigResult<void> ticked = rig_->tick(); !ticked) {
      return tl::unexpected(ticked.error());
    }
    gone = direction * (position() - from);
    ways.push_back(gone);
    ++since_mark;
    if (gone - mark >= progress) {
      mark = gone;
      since_mark = 0;
    }
  }
  rig_->move(target, 0);
  std::int32_t last_driven = position();
  do {
    if (const RigResult<void> ticked = rig_->tick(); !ticked) {
      return tl::unexpected(ticked.error());
    }
    last_driven = rig_->drive() != 0 ? position() : last_driven;
  } while (rig_->drive() != 0);
  if (const RigResult<void> rested = come_to_rest(); !rested) {
    return tl::unexpected(rested.error());
  }
  Line line = since_mark < longest ? line_of(ways) : Line{};
  line.coast_counts = static_cast<std::uint32_t>(std::max(0, direction * (position() - last_driven)));
  return line;
}

RigResult<void> Identification::come_to_rest() {
  std::int32_t at = position();
  for (std::uint32_t still = 0; still < 2 * rules_.rest_ticks; ++still) {
    if (RigResult<void> ticked = rig_->tick(); !ticked) {
      return ticked;
    }
    if (std::abs(position() - at) > static_cast<std::int32_t>(rules_.noise_counts)) {
      at = position();
      still = 0;
    }
  }
  return {};
}

Line Identification::line_of(const std::vector<double>& ways) const {
  const auto first = static_cast<std::size_t>(settling_share * static_cast<double>(ways.size()));
  const std::size_t count = ways.size() - first;
  if (count < fewest_samples) {
    return {};
  }
  Mean tick;
  Mean way;
  for (std::size_t n = first; n < ways.size(); ++n) {
    tick.add(static_cast<double>(n));
    way.add(ways[n]);
  }
  double along = 0.0;
  double spread = 0.0;
  for (std::size_t n = first; n < ways.size(); ++n) {
    const double beside = static_cast<double>(n) - tick.value();
    along += beside * (ways[n] - way.value());
    spread += beside * beside;
  }
  const double per_tick = along / spread;
  if (per_tick <= 0.0) {
    return {};
  }
  return {.speed_counts_per_s = per_tick / period_s_,
          .delay_s = (tick.value() - way.value() / per_tick) * period_s_};
}

/** The line of speed over drive, by the mean of both directions, through the drives at which both moved. */
void Identification::fit() {
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

}  // namespace

RigResult<Identified> identify(const Robot& robot, const ilk_config_t& config,
                               const plant::Parameters& parameters, const std::string& axis,
                               std::uint64_t seed) {
  const Axis* const found = robot.find(axis);
  if (found == nullptr) {
    return tl::unexpected(robot.name + " has no axis \"" + axis + "\"");
  }
  return Identification(*found, config, parameters, seed).run();
}

std::string identified_svg(const Identified& found, const std::string& title) {
  TimeChart chart{title, {}, {}, "drive"};
  ChartSeries up{"up", "#0b62a4", {}};
  ChartSeries down{"down", "#9aa5b1", {}};
  ChartSeries line{"line", "#d1495b", {}};
  std::vector<DriveSpeed> rising = found.speeds;
  std::ranges::sort(rising, {}, &DriveSpeed::drive);
  const double largest = rising.back().drive;
  for (const DriveSpeed& at : rising) {
    chart.times_s.push_back(at.drive);
    up.values.emplace_back(at.up_counts_per_s);
    down.values.emplace_back(at.down_counts_per_s);
    line.values.emplace_back(
        std::max(0.0, (at.drive - found.dead_zone_drive) / (largest - found.dead_zone_drive) *
                          found.full_speed_counts_per_s));
  }
  chart.panels = {{"speed [counts/s]", {up, down, line}}};
  return svg_of(chart);
}

}  // namespace interlock
