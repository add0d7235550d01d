#include "proposals/biopsy_check.hpp"

#include "proposals/path_check.hpp"

namespace interlock {
namespace {

constexpr std::uint32_t oldest_force_us = 20'000;
/** The tip has not begun to bend so far. */
constexpr double skin_tolerance_mm = 0.5;

using Checked = tl::expected<void, Refusal>;

Checked refused(Refusal refusal) { return tl::make_unexpected(std::move(refusal)); }

}  // namespace

tl::expected<void, Refusal> check_biopsy(const Robot& robot, const ilk_config_t& config,
                                         const ControlView& view, const BiopsyDraft& draft) {
  const Axis& insertion = *robot.with_role("insertion");
  const Axis& rotation = *robot.with_role("rotation");
  const ilk_state_t& state = view.snapshot.state;
  const double entry_mm = draft.run->entry_mm;
  const double inserted_mm = insertion.to_unit(state.axis[insertion.slot].position_counts);
  const double deepest_mm = insertion.to_unit(insertion.highest_setpoint_counts()) - entry_mm;
  return check_system(config, view)
      .and_then([&] { return check_axes(robot, view, (1u << insertion.slot) | (1u << rotation.slot)); })
      .and_then([&]() -> Checked {
        if (view.force.age_ticks(state.tick) > oldest_force_us / robot.period_us) {
          return refused({"FORCE_STALE", "The force sensor tells nothing new.", "a force of the last 20 ms",
                          "Look at the card of the force sensor."});
        }
        if (inserted_mm > entry_mm + skin_tolerance_mm) {
          return refused(
              {"IN_TISSUE", "The needle is in the tissue already, so nobody knows where its tip is.",
               "a tip at the skin or in front of it", "Withdraw the needle, then propose it again."});
        }
        if (draft.target_mm[2] > deepest_mm) {
          return refused(verdict_refusal(
              ILK_VERDICT_RANGE, "target " + std::to_string(draft.target_mm[2]) + " mm below the skin",
              "a depth up to " + std::to_string(deepest_mm) + " mm"));
        }
        return {};
      });
}

}  // namespace interlock
