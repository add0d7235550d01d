#include "proposals/checks.hpp"

namespace interlock {
namespace {

constexpr std::uint32_t oldest_force_us = 20'000;
/** The tip has not begun to bend so far. */
constexpr double skin_tolerance_mm = 0.5;

using Checked = tl::expected<void, Refusal>;

Checked refused(Refusal refusal) { return tl::make_unexpected(std::move(refusal)); }

}  // namespace

void check_biopsy(const Robot& robot, const ilk_config_t& config, const ControlView& view,
                  const BiopsyTask& asked, CheckList& checks) {
  const Axis& insertion = *robot.with_role("insertion");
  const Axis& rotation = *robot.with_role("rotation");
  const ilk_state_t& state = view.snapshot.state;
  const double entry_mm = asked.run->entry_mm;
  check_system(config, view, checks);
  check_axes(robot, view, (1u << insertion.slot) | (1u << rotation.slot), checks);
  checks.make(CheckName::force, [&]() -> Checked {
    if (view.force.age_ticks(state.system.tick) > oldest_force_us / robot.period_us) {
      return refused({"FORCE_STALE", "The force sensor tells nothing new.", "a force of the last 20 ms",
                      "Look at the card of the force sensor."});
    }
    return {};
  });
  checks.make(CheckName::skin, [&]() -> Checked {
    const double inserted_mm = insertion.to_unit(state.axis[insertion.slot].position_counts);
    if (inserted_mm > entry_mm + skin_tolerance_mm) {
      return refused({"IN_TISSUE", "The needle is in the tissue already, so nobody knows where its tip is.",
                      "a tip at the skin or in front of it", "Withdraw the needle, then propose it again."});
    }
    return {};
  });
  checks.make(CheckName::depth, [&]() -> Checked {
    const double deepest_mm = insertion.to_unit(insertion.highest_setpoint_counts()) - entry_mm;
    if (asked.target_mm[2] > deepest_mm) {
      return refused(verdict_refusal(ILK_VERDICT_RANGE,
                                     "target " + std::to_string(asked.target_mm[2]) + " mm below the skin",
                                     "a depth up to " + std::to_string(deepest_mm) + " mm"));
    }
    return {};
  });
}

}  // namespace interlock
