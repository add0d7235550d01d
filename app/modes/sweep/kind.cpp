#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "control/axis_controller.hpp"
#include "modes/sweep/mode.hpp"
#include "proposals/checks.hpp"
#include "proposals/motion_kind.hpp"

namespace interlock {
namespace {

using nlohmann::json;

std::string hz_words(double lowest_hz, double highest_hz) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.1f to %.1f Hz", lowest_hz, highest_hz);
  return text.data();
}

/** The fastest and the slowest word whose drive the axis may have. */
struct WordBand {
  std::uint32_t fastest = 0;
  std::uint32_t slowest = 0;
};

WordBand words_of(const Axis& axis) noexcept {
  const std::uint32_t least = control_rules(axis, 1000, 1.0).drive.min_drive;
  return {frequency_map::word_of(axis.drive.max), frequency_map::word_of(least)};
}

}  // namespace

std::optional<FrequencyBand> frequency_band(const Axis& axis) noexcept {
  if (axis.card != ILK_CARD_HIGH_FREQUENCY) {
    return std::nullopt;
  }
  const WordBand words = words_of(axis);
  return FrequencyBand{frequency_map::hz_of(words.fastest), frequency_map::hz_of(words.slowest)};
}

std::optional<FrequencySteps> frequency_steps(double from_hz, double to_hz, double step_hz,
                                              std::uint32_t dwell_ticks) noexcept {
  const double step = std::round(step_hz * frequency_map::words_per_hz);
  const double first = std::round(from_hz * frequency_map::words_per_hz);
  const double last = std::round(to_hz * frequency_map::words_per_hz);
  const double count = std::floor(std::abs(last - first) / step) + 1.0;
  const bool fits = step >= 1.0 && step <= INT32_MAX && count <= FrequencySteps::most;
  if (!fits || !(first >= 0.0 && first <= UINT32_MAX && last >= 0.0 && last <= UINT32_MAX)) {
    return std::nullopt;
  }
  const auto words = static_cast<std::int32_t>(step);
  return FrequencySteps{static_cast<std::uint32_t>(first), last < first ? -words : words,
                        static_cast<std::uint32_t>(count), dwell_ticks};
}

std::optional<FrequencySteps> whole_band(const Axis& axis, std::uint32_t period_us) noexcept {
  const auto band = frequency_band(axis);
  if (!band) {
    return std::nullopt;
  }
  const auto dwell_ticks = static_cast<std::uint32_t>(published_sweep_dwell_s * 1e6 / period_us);
  return frequency_steps(band->highest_hz, band->lowest_hz, published_sweep_step_hz, dwell_ticks);
}

void check_sweep(const Robot& robot, const ilk_config_t& config, const ControlView& view,
                 const SweepTask& sweep, CheckList& checks) {
  const Axis& axis = *robot.at_slot(sweep.slot);
  check_system(config, view, checks);
  check_axes(robot, view, 1u << sweep.slot, checks);
  checks.make(CheckName::band, [&]() -> tl::expected<void, Refusal> {
    const WordBand band = words_of(axis);
    const std::uint32_t first = sweep.steps.word(0);
    const std::uint32_t last = sweep.steps.word(sweep.steps.count - 1);
    const auto [fastest, slowest] = std::minmax(first, last);
    if (fastest >= band.fastest && slowest <= band.slowest) {
      return {};
    }
    return tl::make_unexpected(verdict_refusal(
        ILK_VERDICT_DRIVE,
        axis.name + " " + hz_words(frequency_map::hz_of(fastest), frequency_map::hz_of(slowest)),
        "frequencies from " +
            hz_words(frequency_map::hz_of(band.fastest), frequency_map::hz_of(band.slowest)) +
            ", the axis' allowed band; the published sweep from " +
            hz_words(published_sweep.lowest_hz, published_sweep.highest_hz) + " leaves it"));
  });
}

namespace {

/** ", 52000.0 Hz, frequency 3 of 12" */
std::string frequency_words(const FrequencySteps& steps, std::uint32_t step) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), ", %.1f Hz, frequency %u of %u",
                frequency_map::hz_of(steps.word(step)), step + 1, steps.count);
  return text.data();
}

class SweepKind final : public MotionKind {
 public:
  [[nodiscard]] std::string_view name() const override { return "sweep"; }
  [[nodiscard]] const std::type_info& tasks() const override { return typeid(SweepTask); }
  [[nodiscard]] std::unique_ptr<Mode> make_mode(const RobotPlan& plan) const override {
    return std::make_unique<SweepMode>(plan);
  }

  [[nodiscard]] std::vector<std::uint32_t> slots(const Robot& /*robot*/, const Work& work) const override {
    return {work.as<SweepTask>().slot};
  }

  void check(const Scene& scene, Proposal& proposal, CheckList& checks) const override {
    check_sweep(scene.robot, scene.config, scene.view, *proposal.work<SweepTask>(), checks);
  }

  void follow(const Scene& scene, const TaskStatus& status, Proposal& proposal) const override {
    const auto first = scene.view.sweep_speeds.begin();
    proposal.speeds_counts_per_s.assign(first, first + status.step);
  }

  [[nodiscard]] json asked(const Robot& robot, const Work& work) const override {
    const auto& [slot, steps] = work.as<SweepTask>();
    return {{"axis", robot.at_slot(slot)->name},
            {"from_hz", frequency_map::hz_of(steps.word(0))},
            {"to_hz", frequency_map::hz_of(steps.word(steps.count - 1))},
            {"count", steps.count}};
  }

  void add_fields(const Proposal& proposal, json& fields) const override {
    const FrequencySteps& steps = proposal.work<SweepTask>()->steps;
    json frequencies = json::array();
    for (std::uint32_t step = 0; step < steps.count; ++step) {
      json row{{"hz", frequency_map::hz_of(steps.word(step))}, {"counts_per_s", nullptr}};
      if (step < proposal.speeds_counts_per_s.size() && proposal.speeds_counts_per_s[step] > 0.0F) {
        row["counts_per_s"] = proposal.speeds_counts_per_s[step];
      }
      frequencies.push_back(std::move(row));
    }
    fields["dwell_ticks"] = steps.dwell_ticks;
    fields["frequencies"] = std::move(frequencies);
  }

  [[nodiscard]] TaskWords words(const Robot& robot, const Proposal& proposal, const TaskStatus& status,
                                const BiopsyFindings& /*found*/) const override {
    const FrequencySteps& steps = proposal.work<SweepTask>()->steps;
    const std::string part = frequency_words(steps, std::min(status.step, steps.count - 1));
    return {"", "Turns " + listed(robot, proposal.slots) + " while the pedal is held" + part,
            paused_words(part),
            "Each of " + std::to_string(steps.count) + " frequencies was held for its time.",
            title_of(robot, status.slot)};
  }

  [[nodiscard]] Profile profile(const Robot& /*robot*/, const ilk_config_t& /*config*/,
                                const Proposal& /*proposal*/) const override {
    return no_profile(
        "A sweep turns to and fro within the range of its axis, as long as each frequency lasts.");
  }
};

}  // namespace

const MotionKind& sweep_kind();
const MotionKind& sweep_kind() {
  static const SweepKind kind;
  return kind;
}

}  // namespace interlock
