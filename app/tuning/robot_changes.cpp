#include "tuning/robot_changes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "control/frequency_map.hpp"
#include "robot/compile.hpp"
#include "robot/robot_file.hpp"

namespace interlock {
namespace {

constexpr double coast_margin = 1.25;
/** What differs by less is the same: of full speed, of the largest drive, of play in counts, of a resonance.
 */
constexpr double same_speed = 0.005;
constexpr double same_drive = 0.002;
constexpr double same_play = 0.75;
constexpr double same_resonance_hz = 5.0;
/** The kernel believes that homing is never slower: loaded and cold it is. */
constexpr double cold_share = 0.85;
/** Of full speed, and for the ratio of the directions. */
constexpr double worst_fit_percent = 2.0;
constexpr double compared_share = 0.2;
constexpr double longest_stall_s = 0.5;
/** Faster plans leave nothing for the controller to catch up with. */
constexpr double fastest_plan = 0.85;
constexpr double planned_share = 0.6;

std::uint32_t whole(double number) { return static_cast<std::uint32_t>(std::ceil(number)); }

void raise(std::uint32_t& number, double least) { number = std::max(number, whole(least)); }

void lower(std::uint32_t& number, double most) {
  number = std::min(number, std::max(1U, static_cast<std::uint32_t>(most)));
}

/** Speed of the slower direction, of that of the faster one, where it is the least at a strong drive. */
double slower_direction(const Identified& found) {
  double least = 1.0;
  for (const DriveSpeed& at : found.speeds) {
    const auto [slower, faster] = std::minmax(at.up_counts_per_s, at.down_counts_per_s);
    if (slower > compared_share * found.full_speed_counts_per_s) {
      least = std::min(least, slower / faster);
    }
  }
  return least;
}

/** What a motor that is driven by frequency makes of the published map. */
struct MovedMap {
  double resonance_hz = 0.0;
  double fit_percent = 0.0; /**< standard deviation of the speeds from the map moved there, of full speed */
};

/** The steeper the map at a speed, the better it shows the resonance. */
MovedMap moved_map(const Axis& axis, const Identified& found) {
  const double rpm_of = 60.0 / (2 * std::numbers::pi * axis.counts_per_unit);
  const auto each = [&](const auto& see) {
    for (const DriveSpeed& at : found.speeds) {
      for (const bool decreasing : {false, true}) {
        const double rpm = rpm_of * (decreasing ? at.down_counts_per_s : at.up_counts_per_s);
        see(frequency_map::word_of(at.drive), rpm,
            frequency_map::wave_of(axis.motor_direction != 0, decreasing));
      }
    }
  };
  double words = 0.0;
  double weights = 0.0;
  each([&](double driven, double rpm, frequency_map::Wave wave) {
    const std::uint32_t word = frequency_map::word_for(rpm, wave);
    const double slope = frequency_map::rpm_at(word - frequency_map::word_step / 2, wave) -
                         frequency_map::rpm_at(word + frequency_map::word_step / 2, wave);
    words += slope * slope * (driven - word);
    weights += slope * slope;
  });
  const double moved = words / weights;
  double squares = 0.0;
  each([&](double driven, double rpm, frequency_map::Wave wave) {
    squares += std::pow(rpm - frequency_map::rpm_at(static_cast<std::uint32_t>(driven - moved), wave), 2);
  });
  const double deviation = std::sqrt(squares / (2.0 * static_cast<double>(found.speeds.size())));
  return {moved / frequency_map::words_per_hz, 100 * deviation / (rpm_of * found.full_speed_counts_per_s)};
}

void take_mechanics(Axis& axis, const Identified& found, double period_s) {
  Mechanics& mechanics = axis.mechanics;
  const double full = mechanics.full_speed_counts_per_s;
  if (std::abs(found.full_speed_counts_per_s - full) > same_speed * full) {
    mechanics.full_speed_counts_per_s = whole(found.full_speed_counts_per_s);
  }
  raise(mechanics.noise_counts, found.noise_counts);
  if (found.backlash_counts > mechanics.backlash_counts + same_play) {
    mechanics.backlash_counts = whole(std::round(found.backlash_counts));
  }
  raise(mechanics.coast_counts,
        std::ceil(coast_margin * found.coast_counts.value_or(0)) + mechanics.noise_counts);
  raise(mechanics.max_delta_counts,
        mechanics.full_speed_counts_per_s * period_s + mechanics.noise_counts + 1);
}

void take_motor(Axis& axis, const Identified& found) {
  const bool is_same = std::abs(found.dead_zone_drive - axis.drive.dead_zone) <= same_drive * axis.drive.max;
  if (axis.card == ILK_CARD_HIGH_FREQUENCY) {
    const double resonance_hz = moved_map(axis, found).resonance_hz;
    if (std::abs(resonance_hz - axis.drive.resonance_hz) > same_resonance_hz) {
      axis.drive.resonance_hz = std::round(resonance_hz);
    }
  } else if (!is_same) {
    axis = with_dead_zone(axis, found.dead_zone_drive);
  }
}

void take_homing(Axis& axis, const Robot& robot, const Identified& found, double period_s) {
  Homing& homing = *axis.homing;
  const Mechanics& mechanics = axis.mechanics;
  const auto speed_at = [&](std::uint32_t drive) {
    return found.full_speed_counts_per_s * (drive - found.dead_zone_drive) /
           (axis.drive.max - found.dead_zone_drive);
  };
  // Against its load, in whichever direction that is, the axis has less than the speed of the other.
  const double slowest_share = cold_share * slower_direction(found);
  // So fast that the way that a stall asks for, and what the axis coasts after the faster approach, end in
  // the longest time that a stall may allow.
  const double coast = speed_at(homing.drive) * (found.lag_s + (ILK_LATENCY_TICKS + 1) * period_s);
  const double least =
      std::ceil((axis.stall.min_counts + mechanics.backlash_counts + mechanics.noise_counts + coast + 1.0) /
                (longest_stall_s - (ILK_LATENCY_TICKS + 1) * period_s));
  if (slowest_share * speed_at(homing.slow_drive) < least) {
    const double share = least / slowest_share / found.full_speed_counts_per_s;
    homing.slow_drive = whole(found.dead_zone_drive + share * (axis.drive.max - found.dead_zone_drive));
    homing.drive = std::max(homing.drive, homing.slow_drive);
  }
  lower(homing.speed_counts_per_s, slowest_share * speed_at(homing.drive));
  lower(homing.slow_speed_counts_per_s, slowest_share * speed_at(homing.slow_drive));
  raise(homing.slow_speed_counts_per_s,
        (axis.stall.min_counts + mechanics.backlash_counts + mechanics.noise_counts + 1.0) /
            (longest_stall_s - (ILK_LATENCY_TICKS + 1) * period_s));
  // A switch is read once a tick: what the axis goes meanwhile is no hysteresis.
  const double ways =
      (speed_at(homing.drive) + speed_at(homing.slow_drive)) * period_s + mechanics.noise_counts;
  raise(homing.hysteresis_counts, std::max(0.0, found.hysteresis_counts.value_or(0.0) - std::ceil(ways)));
  const double debounced_s = (robot.loop.switch_debounce_ticks + 2.0) * period_s;
  raise(homing.tolerance_counts,
        std::ceil(homing.speed_counts_per_s * debounced_s) + 2.0 * mechanics.noise_counts);
  raise(homing.clear_counts,
        homing.tolerance_counts + homing.hysteresis_counts + mechanics.coast_counts + 1.0);
  raise(homing.clear_counts,
        axis.stall.min_counts + mechanics.backlash_counts + mechanics.noise_counts + 1.0);
  const double range = axis.soft_limits.max_counts - axis.soft_limits.min_counts;
  const double back = 2.0 * (homing.clear_counts + homing.hysteresis_counts + 2.0 * mechanics.coast_counts +
                             mechanics.noise_counts);
  const double way = range + 2.0 * mechanics.coast_counts + 2 * back;
  raise(homing.travel_counts, way + mechanics.coast_counts + mechanics.noise_counts + 1);
  const double waits = 4.0 * mechanics.rest_ticks + 12.0 * robot.loop.switch_debounce_ticks;
  raise(homing.timeout_ticks,
        (way / homing.speed_counts_per_s + back / homing.slow_speed_counts_per_s) / period_s + waits + 1);
}

/** What the kernel asks of the watches over such mechanics (kernel/src/config.c, `watch_error`). */
void take_watches(Axis& axis, double period_s) {
  const Mechanics& mechanics = axis.mechanics;
  StallRule& stall = axis.stall;
  const double lost = mechanics.backlash_counts + mechanics.noise_counts;
  const double full = mechanics.full_speed_counts_per_s * period_s;
  const double slowest = axis.homing ? axis.homing->slow_speed_counts_per_s * period_s : full;
  const double reversal = 5.0 * mechanics.coast_counts + lost;
  raise(stall.min_counts, mechanics.noise_counts + 1);
  raise(stall.driven_ticks, (stall.min_counts + lost) / slowest + ILK_LATENCY_TICKS + 1);
  raise(stall.driven_ticks, (reversal + stall.min_counts) / full);
  if (stall.effort_ticks != 0) {
    raise(stall.effort_ticks, (reversal + 1) / full);
  }
  raise(axis.runaway.reverse_counts, mechanics.coast_counts + lost);
  raise(axis.runaway.drift_counts, mechanics.coast_counts + lost);
  raise(axis.unhomed_travel_counts, mechanics.coast_counts + mechanics.noise_counts + 1);
}

void take_rates(Axis& axis) {
  const double full = axis.mechanics.full_speed_counts_per_s;
  if (!axis.motion || axis.motion->velocity_counts_per_s <= fastest_plan * full) {
    return;
  }
  const double share = planned_share * full / axis.motion->velocity_counts_per_s;
  for (double MotionRates::* const rate :
       {&MotionRates::velocity_counts_per_s, &MotionRates::acceleration_counts_per_s2,
        &MotionRates::jerk_counts_per_s3}) {
    (*axis.motion).*rate = std::floor(share * ((*axis.motion).*rate));
  }
}

struct Key {
  const char* name;
  double (*get)(const Axis&, double period_ms);
};

constexpr std::array keys{
    Key{"drive.min", [](const Axis& a, double) -> double { return a.drive.min; }},
    Key{"drive.dead_zone", [](const Axis& a, double) -> double { return a.drive.dead_zone; }},
    Key{"drive.unhomed_max", [](const Axis& a, double) -> double { return a.drive.unhomed_max; }},
    Key{"mechanics.coast_counts", [](const Axis& a, double) -> double { return a.mechanics.coast_counts; }},
    Key{"mechanics.backlash_counts",
        [](const Axis& a, double) -> double { return a.mechanics.backlash_counts; }},
    Key{"mechanics.noise_counts", [](const Axis& a, double) -> double { return a.mechanics.noise_counts; }},
    Key{"mechanics.max_delta_counts",
        [](const Axis& a, double) -> double { return a.mechanics.max_delta_counts; }},
    Key{"mechanics.full_speed_counts_per_s",
        [](const Axis& a, double) -> double { return a.mechanics.full_speed_counts_per_s; }},
    Key{"stall.driven_ms", [](const Axis& a, double ms) { return a.stall.driven_ticks * ms; }},
    Key{"stall.effort_ms", [](const Axis& a, double ms) { return a.stall.effort_ticks * ms; }},
    Key{"stall.min_counts", [](const Axis& a, double) -> double { return a.stall.min_counts; }},
    Key{"runaway.reverse_counts", [](const Axis& a, double) -> double { return a.runaway.reverse_counts; }},
    Key{"runaway.drift_counts", [](const Axis& a, double) -> double { return a.runaway.drift_counts; }},
    Key{"unhomed_travel_counts", [](const Axis& a, double) -> double { return a.unhomed_travel_counts; }},
    Key{"motion.velocity_counts_per_s",
        [](const Axis& a, double) { return a.motion ? a.motion->velocity_counts_per_s : 0; }},
    Key{"motion.acceleration_counts_per_s2",
        [](const Axis& a, double) { return a.motion ? a.motion->acceleration_counts_per_s2 : 0; }},
    Key{"motion.jerk_counts_per_s3",
        [](const Axis& a, double) { return a.motion ? a.motion->jerk_counts_per_s3 : 0; }},
};

constexpr std::array homing_keys{
    std::pair{"homing.drive", &Homing::drive},
    std::pair{"homing.slow_drive", &Homing::slow_drive},
    std::pair{"homing.speed_counts_per_s", &Homing::speed_counts_per_s},
    std::pair{"homing.slow_speed_counts_per_s", &Homing::slow_speed_counts_per_s},
    std::pair{"homing.travel_counts", &Homing::travel_counts},
    std::pair{"homing.clear_counts", &Homing::clear_counts},
    std::pair{"homing.tolerance_counts", &Homing::tolerance_counts},
    std::pair{"homing.hysteresis_counts", &Homing::hysteresis_counts},
};

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

}  // namespace

Axis with_dead_zone(Axis axis, double dead_zone_drive) {
  DriveBounds& drive = axis.drive;
  const DriveBounds old = drive;
  drive.dead_zone = whole(dead_zone_drive);
  const auto move = [&](std::uint32_t& number) {
    const double share = (static_cast<double>(number) - old.dead_zone) / (old.max - old.dead_zone);
    number = static_cast<std::uint32_t>(drive.dead_zone + share * (drive.max - drive.dead_zone));
  };
  move(drive.unhomed_max);
  if (old.min > old.dead_zone) {
    move(drive.min);
  }
  if (axis.homing) {
    move(axis.homing->drive);
    move(axis.homing->slow_drive);
  }
  return axis;
}

std::vector<NumberChange> changes_of(const Robot& robot, const Axis& axis, const Identified& found) {
  const double period_s = robot.period_us * 1e-6;
  Axis is = axis;
  take_mechanics(is, found, period_s);
  take_motor(is, found);
  if (is.homing) {
    take_homing(is, robot, found, period_s);
  }
  take_watches(is, period_s);
  take_rates(is);
  std::vector<NumberChange> changes;
  const auto add = [&](const char* key, double old, double now) {
    if (old != now) {
      changes.push_back({{key, now}, old});
    }
  };
  constexpr const char* resonance = "drive.resonance_hz";
  add(resonance, axis.drive.resonance_hz, is.drive.resonance_hz);
  if (!changes.empty()) {
    changes.back().number.after = "drive.max_amplitude";
  }
  for (const Key& key : keys) {
    add(key.name, key.get(axis, period_s * 1000), key.get(is, period_s * 1000));
  }
  if (is.homing) {
    for (const auto& [key, field] : homing_keys) {
      add(key, (*axis.homing).*field, (*is.homing).*field);
    }
    add("homing.timeout_ms", axis.homing->timeout_ticks * period_s * 1000,
        is.homing->timeout_ticks * period_s * 1000);
  }
  return changes;
}

nlohmann::ordered_json to_json(const std::vector<NumberChange>& changes) {
  auto list = nlohmann::ordered_json::array();
  for (const NumberChange& change : changes) {
    list.push_back({{"key", change.number.key}, {"was", change.was}, {"is", change.number.value}});
  }
  return list;
}

nlohmann::ordered_json to_json(const Identified& found) {
  using Json = nlohmann::ordered_json;
  const auto or_null = [](const auto& value) { return value ? Json(*value) : Json(); };
  Json speeds = Json::array();
  for (const DriveSpeed& at : found.speeds) {
    speeds.push_back({{"drive", at.drive},
                      {"up_counts_per_s", at.up_counts_per_s},
                      {"down_counts_per_s", at.down_counts_per_s}});
  }
  return {{"homing_error", or_null(found.homing_error)},
          {"dead_zone_drive", found.dead_zone_drive},
          {"full_speed_counts_per_s", found.full_speed_counts_per_s},
          {"fit_percent", found.fit_percent},
          {"lag_ms", found.lag_s * 1000},
          {"coast_counts", or_null(found.coast_counts)},
          {"backlash_counts", found.backlash_counts},
          {"noise_counts", found.noise_counts},
          {"hysteresis_counts", or_null(found.hysteresis_counts)},
          {"speeds", std::move(speeds)}};
}

tl::expected<void, RobotError> believable(const Robot& robot, const std::string& axis,
                                          const Identified& found) {
  const Axis& is = *robot.find(axis);
  const bool by_frequency = is.card == ILK_CARD_HIGH_FREQUENCY;
  const double fit_percent = by_frequency ? moved_map(is, found).fit_percent : found.fit_percent;
  if (fit_percent <= worst_fit_percent) {
    return {};
  }
  return tl::unexpected(RobotError{robot.origin.file, 0, axis,
                                   std::string("the measured speeds lie off ") +
                                       (by_frequency ? "the published map, moved to the motor's resonance,"
                                                     : "a straight line over drive") +
                                       " by " + std::to_string(fit_percent) + " % of full speed",
                                   "2 % at most: let the motor cool, or warm, and measure again"});
}

tl::expected<std::string, RobotError> changed_file(const Robot& robot, const std::string& name,
                                                   const std::string& axis,
                                                   std::span<const NumberChange> changes) {
  std::vector<AxisNumber> numbers;
  for (const NumberChange& change : changes) {
    numbers.push_back(change.number);
  }
  return with_numbers(robot.text, robot.origin.file, axis, numbers).and_then([&](const std::string& edited) {
    return parse_robot(edited, name)
        .and_then([](const Robot& changed) { return compile(changed); })
        .map([&](const ilk_config_t&) { return edited; });
  });
}

std::string unified_diff(std::string_view was, std::string_view now, const std::string& name) {
  constexpr std::size_t around = 3;
  const std::vector<std::string_view> old_lines = lines_of(was);
  const std::vector<std::string_view> new_lines = lines_of(now);
  const std::size_t count = std::min(old_lines.size(), new_lines.size());
  std::vector<std::size_t> different;
  for (std::size_t line = 0; line < count; ++line) {
    if (old_lines[line] != new_lines[line]) {
      different.push_back(line);
    }
  }
  std::string diff = different.empty() ? "" : "--- a/" + name + "\n+++ b/" + name + "\n";
  for (std::size_t i = 0; i < different.size();) {
    const std::size_t first = different[i] - std::min(around, different[i]);
    std::size_t end = different[i] + 1;
    for (; i < different.size() && different[i] <= end + 2 * around; ++i) {
      end = different[i] + 1;
    }
    end = std::min(end + around, count);
    const std::string place = std::to_string(first + 1) + "," + std::to_string(end - first);
    diff += "@@ -" + place + " +" + place + " @@\n";
    for (std::size_t line = first; line < end;) {
      std::size_t same = line;
      while (same < end && old_lines[same] != new_lines[same]) {
        ++same;
      }
      for (std::size_t each = line; each < same; ++each) {
        diff += "-" + std::string(old_lines[each]) + "\n";
      }
      for (std::size_t each = line; each < same; ++each) {
        diff += "+" + std::string(new_lines[each]) + "\n";
      }
      if (same < end) {
        diff += " " + std::string(old_lines[same]) + "\n";
      }
      line = same + 1;
    }
  }
  return diff;
}

}  // namespace interlock
