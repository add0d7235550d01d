#include "tuning/identification.hpp"

#include <algorithm>
#include <cstdlib>
#include <optional>

#include "chart/time_chart.hpp"
#include "robot/compile.hpp"

namespace interlock {
namespace {

/** Of the largest drive; the kernel accepts no wider one. */
constexpr double widest_dead_zone = 0.2;
constexpr double dead_zone_step = 0.02;

/** The rig of one axis, and what its homing showed. */
class Identification {
 public:
  Identification(const Axis& axis, const ilk_config_t& config, const plant::Parameters& parameters,
                 std::uint64_t seed)
      : axis_(axis), config_(config), parameters_(parameters), seed_(seed) {
    found_.axis = axis.name;
  }

  RigResult<Identified> run() {
    return ready().and_then([&] { return measure(); });
  }

 private:
  RigResult<void> ready();
  RigResult<void> home();
  RigResult<Identified> measure();

  const Axis& axis_;
  ilk_config_t config_;
  const plant::Parameters& parameters_;
  std::uint64_t seed_;
  std::optional<StepRig> rig_;
  Identified found_;
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
  return tl::unexpected(
      homed.error() +
      ", before the first move, with dead zones up to a fifth of drive.max as well: more than that "
      "no file may state. Look at what holds the axis, at its motor's supply and its encoder, and at "
      "drive.max");
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

/** Each tick's reading to the program, and what that asks for to the kernel. */
RigResult<Identified> Identification::measure() {
  const MeasuringRange range = measuring_range(config_.axis[axis_.slot], axis_.lowest_setpoint_counts(),
                                               axis_.highest_setpoint_counts());
  if (!range.is_enough()) {
    return tl::unexpected(too_short(axis_.name, range));
  }
  AxisMeasurement program(config_.common.period_us);
  program.begin(config_.axis[axis_.slot], range);
  while (program.state() == AxisMeasurement::State::measures) {
    const std::uint32_t now = rig_->tick_count();
    const MeasuringMove move = program.see({now, rig_->axis().position_counts, rig_->drive(), now});
    rig_->move(move.target_counts, move.drive);
    if (const RigResult<void> ticked = rig_->tick(); !ticked) {
      return tl::unexpected(ticked.error() + ", at drive " + std::to_string(program.drive()));
    }
  }
  if (program.state() != AxisMeasurement::State::done) {
    return tl::unexpected(program.state() == AxisMeasurement::State::stands
                              ? stands_words(axis_.name)
                              : axis_.name + " is held back again and again");
  }
  static_cast<MeasuredAxis&>(found_) = program.found();
  return found_;
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
  auto rising = found.speeds;
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
