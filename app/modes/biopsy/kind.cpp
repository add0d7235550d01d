#include <nlohmann/json.hpp>

#include "modes/biopsy/mode.hpp"
#include "motion/biopsy_run.hpp"
#include "proposals/checks.hpp"
#include "proposals/motion_kind.hpp"

namespace interlock {
namespace {

using nlohmann::json;

constexpr std::uint32_t oldest_force_us = 20'000;
/** The tip has not begun to bend so far. */
constexpr double skin_tolerance_mm = 0.5;

using Checked = tl::expected<void, Refusal>;

Checked refused(Refusal refusal) { return tl::make_unexpected(std::move(refusal)); }

}  // namespace

/**
 * Judges a biopsy against the newest view: CONFIG_MISMATCH, MODE, for insertion and rotation FAULTED,
 * DISABLED, BUSY while homing and NOT_HOMED, then FORCE_STALE when the force is older than 20 ms, IN_TISSUE
 * when the tip is past the skin already, so that nobody knows where it is, and RANGE when the insertion does
 * not reach the target's depth.
 */
static void check_biopsy(const Robot& robot, const ilk_config_t& config, const ControlView& view,
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

namespace {

class BiopsyKind final : public MotionKind {
 public:
  [[nodiscard]] std::string_view name() const override { return "biopsy"; }
  [[nodiscard]] const std::type_info& tasks() const override { return typeid(BiopsyTask); }
  [[nodiscard]] std::unique_ptr<Mode> make_mode(const RobotPlan& plan) const override {
    return std::make_unique<BiopsyMode>(plan);
  }

  [[nodiscard]] std::vector<std::uint32_t> slots(const Robot& robot, const Work& /*work*/) const override {
    return {robot.with_role("insertion")->slot, robot.with_role("rotation")->slot};
  }

  void check(const Scene& scene, Proposal& proposal, CheckList& checks) const override {
    check_biopsy(scene.robot, scene.config, scene.view, *proposal.work<BiopsyTask>(), checks);
  }

  /** The run is large; what the control thread may still use, the registry holds. */
  [[nodiscard]] std::optional<Work> remains(const Work& work) const override {
    BiopsyTask ended = work.as<BiopsyTask>();
    ended.run.reset();
    return ended;
  }

  [[nodiscard]] json asked(const Robot& /*robot*/, const Work& work) const override {
    return {{"target_mm", work.as<BiopsyTask>().target_mm}};
  }

  void add_fields(const Proposal& proposal, json& fields) const override {
    const BiopsyTask& insertion = *proposal.work<BiopsyTask>();
    fields["target_mm"] = insertion.target_mm;
    if (const auto& scanner_from_guide = insertion.scanner_from_guide) {
      const Eigen::Vector3d target = *scanner_from_guide * Eigen::Vector3d(insertion.target_mm.data());
      fields["target_point"] = {target.x(), target.y(), target.z()};
    }
  }

  [[nodiscard]] TaskWords words(const Robot& robot, const Proposal& /*proposal*/, const TaskStatus& status,
                                const BiopsyFindings& found) const override {
    const bool any = found.task == status.task && found.membranes != 0;
    const std::string passed = any ? "; membranes passed: " + std::to_string(found.membranes) : "";
    return {"; then the hand on the force sensor pushes the needle",
            "Follows the hand while the pedal is held" + passed, paused_words(passed),
            "The tip is at the depth of its target" + passed + ".", title_of(robot, status.slot)};
  }

  [[nodiscard]] Profile profile(const Robot& /*robot*/, const ilk_config_t& /*config*/,
                                const Proposal& /*proposal*/) const override {
    return no_profile("A biopsy follows the surgeon's hand; nothing is planned ahead.");
  }
};

}  // namespace

const MotionKind& biopsy_kind();
const MotionKind& biopsy_kind() {
  static const BiopsyKind kind;
  return kind;
}

}  // namespace interlock
