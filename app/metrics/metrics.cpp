#include "metrics/metrics.hpp"

#include <prometheus/text_serializer.h>

#include <array>
#include <charconv>
#include <cstdint>
#include <utility>
#include <vector>

#include "build_info/build_info.hpp"
#include "robot/catalog.hpp"
#include "robot/compile.hpp"

namespace interlock {
namespace {

using prometheus::ClientMetric;
using prometheus::MetricFamily;
using prometheus::MetricType;
using Labels = std::vector<ClientMetric::Label>;

constexpr std::array<const char*, ILK_PHASE_COUNT> phase_names{"wake", "bus", "step", "publish"};
constexpr double seconds_per_nanosecond = 1e-9;

/** Families in the order in which they are written. */
class Families {
 public:
  /** Starts a family; what is added next belongs to it. */
  void begin(MetricType type, const char* name, const char* help) {
    families_.push_back({.name = name, .help = help, .type = type, .metric = {}});
  }

  void add(double value, Labels labels = {}) {
    ClientMetric metric;
    metric.label = std::move(labels);
    switch (families_.back().type) {
      case MetricType::Counter:
        metric.counter.value = value;
        break;
      case MetricType::Untyped:
        metric.untyped.value = value;
        break;
      default:
        metric.gauge.value = value;
    }
    families_.back().metric.push_back(std::move(metric));
  }

  /** One series for each code of the family, 1 for the present one: a change of state ends none. */
  void add_state(catalog::Family codes, const char* label, std::uint32_t present, const Labels& labels = {}) {
    for (const catalog::Entry& code : catalog::entries(codes)) {
      Labels all = labels;
      all.push_back({label, std::string(code.name)});
      add(code.number == present ? 1.0 : 0.0, std::move(all));
    }
  }

  [[nodiscard]] std::string text() const { return prometheus::TextSerializer{}.Serialize(families_); }

 private:
  std::vector<MetricFamily> families_;
};

void add_system(Families& families, const ilk_snapshot_t& snapshot) {
  const ilk_state_t& state = snapshot.state;
  families.begin(MetricType::Gauge, "interlock_mode", "1 for the system's mode, 0 for every other.");
  families.add_state(catalog::Family::mode, "mode", state.system.mode);
  families.begin(MetricType::Gauge, "interlock_lock_cause",
                 "1 for each cause to lock that was seen since the last reset.");
  for (const catalog::Entry& cause : catalog::entries(catalog::Family::cause)) {
    families.add((state.system.causes_seen >> cause.number) & 1u, {{"cause", std::string(cause.name)}});
  }
  families.begin(MetricType::Gauge, "interlock_pedal", "1 for what the pedal's channels say together.");
  families.add_state(catalog::Family::pedal, "pedal", state.system.pedal);
  families.begin(MetricType::Gauge, "interlock_estop", "1 while the emergency stop is pressed.");
  families.add(state.system.estop != 0 ? 1.0 : 0.0);
  families.begin(MetricType::Gauge, "interlock_app_alive", "1 while the kernel counts the app as alive.");
  families.add(state.system.app_alive != 0 ? 1.0 : 0.0);
  families.begin(MetricType::Gauge, "interlock_degraded",
                 "1 when the real clock runs without the real-time measures that it needs.");
  families.add(snapshot.degraded != 0 ? 1.0 : 0.0);
}

void add_loop(Families& families, const ilk_snapshot_t& snapshot) {
  families.begin(MetricType::Counter, "interlock_ticks_total", "Ticks of the control loop.");
  families.add(snapshot.state.system.tick);
  families.begin(MetricType::Counter, "interlock_overruns_total",
                 "Ticks that began more than a period late.");
  families.add(snapshot.overruns);
  families.begin(MetricType::Counter, "interlock_host_late_seconds_total",
                 "Time that the paced clock waited for a late host.");
  families.add(snapshot.lateness.total_ms * 1e-3);
  families.begin(MetricType::Gauge, "interlock_host_late_worst_seconds",
                 "Longest that the paced clock waited for a late host.");
  families.add(snapshot.lateness.worst_us * 1e-6);
  families.begin(MetricType::Counter, "interlock_requests_dropped_total",
                 "Requests of the app that were lost because their ring was overrun.");
  families.add(snapshot.requests_dropped);
  families.begin(MetricType::Gauge, "interlock_period_seconds", "Period of the control loop.");
  families.add(snapshot.period_us * 1e-6);
  families.begin(MetricType::Gauge, "interlock_phase_max_seconds", "Longest that each part of a tick took.");
  for (std::size_t phase = 0; phase < phase_names.size(); ++phase) {
    families.add(snapshot.timing.max_ns[phase] * seconds_per_nanosecond, {{"phase", phase_names[phase]}});
  }
}

/** The end of a bucket as PromQL reads it; the last has none. */
std::string end_of(std::uint32_t bucket) {
  if (bucket + 1 == ILK_LINK_BUCKETS) {
    return "+Inf";
  }
  const double end_s = static_cast<double>(std::uint64_t{2} << bucket) * seconds_per_nanosecond;
  std::array<char, 32> digits{};
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), end_s).ptr};
}

/** No histogram, since the kernel keeps no sum of the durations; PromQL's histogram_quantile asks for none.
 */
void add_durations(Families& families, const ilk_timing_t& timing) {
  families.begin(MetricType::Untyped, "interlock_phase_seconds_bucket",
                 "Ticks in which a part of the tick took less than le seconds.");
  for (std::size_t phase = 0; phase < phase_names.size(); ++phase) {
    std::uint64_t ticks = 0;
    for (std::uint32_t bucket = 0; bucket < ILK_LINK_BUCKETS; ++bucket) {
      ticks += timing.bucket[phase][bucket];
      families.add(static_cast<double>(ticks), {{"phase", phase_names[phase]}, {"le", end_of(bucket)}});
    }
  }
}

using AxisValue = double (*)(const Axis&, const ilk_snapshot_t&);

/** One series for each axis of the robot. */
void add_axes(Families& families, const Robot& robot, const ilk_snapshot_t& snapshot, AxisValue value) {
  for (const Axis& axis : robot.axes) {
    families.add(value(axis, snapshot), {{"axis", axis.name}});
  }
}

void add_cards(Families& families, const Robot& robot, const ilk_snapshot_t& snapshot) {
  families.begin(MetricType::Counter, "interlock_card_checksum_failures_total",
                 "Frames of the axis' card whose checksum was wrong.");
  add_axes(families, robot, snapshot, [](const Axis& axis, const ilk_snapshot_t& now) -> double {
    return now.state.axis[axis.slot].checksum_failures;
  });
  families.begin(MetricType::Gauge, "interlock_card_valid",
                 "1 when the newest frame of the axis' card was valid: its heartbeat advanced.");
  add_axes(families, robot, snapshot, [](const Axis& axis, const ilk_snapshot_t& now) -> double {
    return now.state.axis[axis.slot].card_valid != 0 ? 1.0 : 0.0;
  });
}

void add_motion(Families& families, const Robot& robot, const ilk_snapshot_t& snapshot) {
  families.begin(MetricType::Gauge, "interlock_axis_homed", "1 once the axis has a reference.");
  add_axes(families, robot, snapshot, [](const Axis& axis, const ilk_snapshot_t& now) -> double {
    return now.state.axis[axis.slot].homed != 0 ? 1.0 : 0.0;
  });
  families.begin(MetricType::Gauge, "interlock_axis_position_counts", "Position of the axis.");
  add_axes(families, robot, snapshot, [](const Axis& axis, const ilk_snapshot_t& now) -> double {
    return now.state.axis[axis.slot].position_counts;
  });
  families.begin(MetricType::Gauge, "interlock_axis_drive",
                 "What goes to the axis' card: frequency or voltage by its kind; 0 is no drive.");
  add_axes(families, robot, snapshot, [](const Axis& axis, const ilk_snapshot_t& now) -> double {
    return now.command[axis.slot].drive;
  });
  families.begin(MetricType::Gauge, "interlock_axis_state", "1 for the axis' state, 0 for every other.");
  for (const Axis& axis : robot.axes) {
    families.add_state(catalog::Family::axis_state, "state", snapshot.state.axis[axis.slot].state,
                       {{"axis", axis.name}});
  }
  families.begin(MetricType::Gauge, "interlock_axis_fault", "1 for the axis' fault, 0 for every other.");
  for (const Axis& axis : robot.axes) {
    families.add_state(catalog::Family::fault, "fault", snapshot.state.axis[axis.slot].fault,
                       {{"axis", axis.name}});
  }
}

/** What the app knows without a kernel. */
void add_app(Families& families, const Robot& robot, const ilk_config_t& config, bool attached,
             const AppCounts& counts) {
  families.begin(MetricType::Gauge, "interlock_info", "Always 1; what runs is in the labels.");
  families.add(1.0, {{"version", std::string(version())},
                     {"commit", std::string(commit())},
                     {"robot", robot.name},
                     {"config_crc", config_hash(config)}});
  families.begin(
      MetricType::Gauge, "interlock_kernel_connected",
      "1 while the app is attached to a kernel; without one, there is nothing below but the app's own.");
  families.add(attached ? 1.0 : 0.0);
  families.begin(MetricType::Gauge, "interlock_alarms", "Conditions that ask somebody to act, by priority.");
  constexpr std::array priorities{"low", "medium", "high"};
  for (std::size_t place = 0; place < priorities.size(); ++place) {
    families.add(static_cast<double>(counts.alarms[place]), {{"priority", priorities[place]}});
  }
  families.begin(MetricType::Gauge, "interlock_consoles", "Clients of the stream.");
  families.add(static_cast<double>(counts.consoles));
  families.begin(MetricType::Counter, "interlock_log_lines_lost_total",
                 "Lines that did not get to standard error or to the file of the log.");
  families.add(static_cast<double>(counts.log_lines_lost));
  families.begin(MetricType::Counter, "interlock_role_refusals_total",
                 "Requests that were refused because the user's role does not suffice.");
  families.add(static_cast<double>(counts.role_refusals));
}

}  // namespace

std::string metrics_text(const Robot& robot, const ilk_config_t& config, const ControlView& view,
                         const AppCounts& counts, std::chrono::steady_clock::time_point now) {
  Families families;
  add_app(families, robot, config, view.attached, counts);
  if (view.attached) {
    families.begin(MetricType::Gauge, "interlock_snapshot_age_seconds",
                   "How long ago the newest snapshot of the kernel was read.");
    families.add(std::chrono::duration<double>(now - view.received).count());
    families.begin(MetricType::Gauge, "interlock_simulated", "1 when the hardware is a simulator.");
    families.add(view.snapshot.simulated != 0 ? 1.0 : 0.0);
    add_system(families, view.snapshot);
    add_loop(families, view.snapshot);
    add_durations(families, view.snapshot.timing);
    add_cards(families, robot, view.snapshot);
    add_motion(families, robot, view.snapshot);
  }
  return families.text();
}

}  // namespace interlock
