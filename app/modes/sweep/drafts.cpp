#include "service/drafts.hpp"

#include <algorithm>
#include <cmath>

#include "proposals/checks.hpp"
#include "service/fields.hpp"
#include "service/reply.hpp"

namespace interlock {
namespace {

constexpr double highest_hz = 195000.0;
constexpr double shortest_sweep_dwell_s = 0.01;
constexpr double longest_sweep_dwell_s = 60.0;

constexpr RobotMode sweep_mode{"frequency_sweep"};

Task sweep_task(const SweepTask& sweep, const std::string& author) { return {sweep, author, sweep_mode}; }

DraftKind::Reading read_sweep(const Context& context, nlohmann::json body, std::string author) {
  co_return sweep_draft(context.robot, body, author);
}

DraftKind::Reading read_whole_sweep(const Context& context, nlohmann::json /*body*/, std::string author) {
  co_return whole_sweep_draft(context.robot, author);
}

/** An end of the band is shown with one decimal, and taken as it is shown. */
double within(const FrequencyBand& band, double hz) {
  constexpr double half_a_shown_digit = 0.0501;
  const double nearest = std::clamp(hz, band.lowest_hz, band.highest_hz);
  return std::abs(nearest - hz) <= half_a_shown_digit ? nearest : hz;
}

}  // namespace

std::span<const DraftKind> sweep_drafts();
std::span<const DraftKind> sweep_drafts() {
  static constexpr DraftKind drafts[] = {{"sweep", "", read_sweep},
                                         {"", "frequency_sweep", read_whole_sweep}};
  return drafts;
}

tl::expected<Task, Problem> sweep_draft(const Robot& robot, const nlohmann::json& body,
                                        const std::string& author) {
  if (!robot.has_mode(sweep_mode.name)) {
    return fail(not_found("axis for a sweep of frequency", "a robot with the mode frequency_sweep"));
  }
  Fields fields(body, {"kind", "axis", "from_hz", "to_hz", "step_hz", "dwell_s"});
  const auto name = fields.text("axis");
  const auto from_hz = fields.number("from_hz", 1.0, highest_hz);
  const auto to_hz = fields.number("to_hz", 1.0, highest_hz);
  const auto step_hz = fields.number("step_hz", 0.001, highest_hz);
  const auto dwell_s = fields.number("dwell_s", shortest_sweep_dwell_s, longest_sweep_dwell_s);
  fields.require({{"axis", "the name of a high-frequency axis"},
                  {"from_hz", "the first frequency"},
                  {"to_hz", "the last frequency"},
                  {"step_hz", "from each frequency to the next"},
                  {"dwell_s", "time at each, in seconds"}});
  if (fields.problem()) {
    return fail(*fields.problem());
  }
  const Axis* axis = robot.find(*name);
  const auto band = axis == nullptr ? std::nullopt : frequency_band(*axis);
  if (!band) {
    return fail(invalid("axis", *name + " is no high-frequency axis of the robot",
                        "the name of an axis whose card is HIGH_FREQUENCY in /api/motors"));
  }
  const auto dwell_ticks = static_cast<std::uint32_t>(*dwell_s * 1e6 / robot.period_us);
  const auto steps = frequency_steps(within(*band, *from_hz), within(*band, *to_hz), *step_hz, dwell_ticks);
  if (!steps) {
    return fail(invalid("step_hz", "so many frequencies are too many for a sweep",
                        "steps for at most " + std::to_string(FrequencySteps::most) + " frequencies"));
  }
  return sweep_task({axis->slot, *steps}, author);
}

tl::expected<Task, Problem> whole_sweep_draft(const Robot& robot, const std::string& author) {
  for (const Axis& axis : robot.axes) {
    if (const auto steps = whole_band(axis, robot.period_us)) {
      return sweep_task({axis.slot, *steps}, author);
    }
  }
  return fail(not_found("axis for a sweep of frequency", "a robot with a high-frequency axis"));
}

}  // namespace interlock
