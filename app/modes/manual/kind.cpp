#include <nlohmann/json.hpp>

#include "modes/manual/mode.hpp"
#include "motion/setpoint_range.hpp"
#include "proposals/checks.hpp"
#include "proposals/motion_kind.hpp"

namespace interlock {
namespace {

using nlohmann::json;

tl::expected<void, Refusal> check_drive(const Axis& axis, std::uint32_t bound, const MoveTask& move) {
  if (move.drive.value_or(0) > bound) {
    return tl::make_unexpected(verdict_refusal(ILK_VERDICT_DRIVE,
                                               axis.name + " drive " + std::to_string(*move.drive),
                                               "a drive from 1 to " + std::to_string(bound)));
  }
  return {};
}

tl::expected<void, Refusal> check_target(const Axis& axis, const SetpointRange& range,
                                         std::int32_t target_counts) {
  if (!range.contains(target_counts)) {
    return tl::make_unexpected(verdict_refusal(ILK_VERDICT_RANGE,
                                               axis.name + " " + counts_and_unit(axis, target_counts),
                                               "a target from " + counts_and_unit(axis, range.lowest_counts) +
                                                   " to " + counts_and_unit(axis, range.highest_counts)));
  }
  return {};
}

class MoveKind final : public MotionKind {
 public:
  [[nodiscard]] std::string_view name() const override { return "move"; }
  [[nodiscard]] const std::type_info& tasks() const override { return typeid(MoveTask); }
  [[nodiscard]] std::unique_ptr<Mode> make_mode(const RobotPlan& plan) const override {
    return std::make_unique<ManualMode>(plan);
  }

  [[nodiscard]] std::vector<std::uint32_t> slots(const Robot& /*robot*/, const Work& work) const override {
    return {work.as<MoveTask>().slot};
  }

  void check(const Scene& scene, Proposal& proposal, CheckList& checks) const override {
    const MoveTask& move = *proposal.work<MoveTask>();
    const Axis& axis = *scene.robot.at_slot(move.slot);
    const ilk_state_t& state = scene.view.snapshot.state;
    const ilk_axis_config_t& rules = scene.config.axis[axis.slot];
    check_system(scene.config, scene.view, checks);
    checks.make(CheckName::axes, [&] { return check_free_axis(axis, scene.view); });
    checks.make(CheckName::drive,
                [&] { return check_drive(axis, drive_bound(rules, state.axis[axis.slot]), move); });
    checks.make(CheckName::range, [&] {
      return check_target(axis, setpoint_range(rules, state.axis[axis.slot], state.system.mode),
                          move.target_counts);
    });
    if (linked_to(scene.robot, move.slot)) {
      checks.make(CheckName::separation, [&] {
        return check_separation(scene.robot, states_of(scene.view), scene.headed,
                                {move.slot, move.target_counts});
      });
    }
  }

  [[nodiscard]] bool yields() const override { return true; }

  void begin(const Robot& robot, Proposal& proposal) const override {
    const MoveTask& move = *proposal.work<MoveTask>();
    proposal.target = robot.at_slot(move.slot)->to_unit(move.target_counts);
  }

  [[nodiscard]] json asked(const Robot& robot, const Work& work) const override {
    const MoveTask& move = work.as<MoveTask>();
    json detail{{"axis", robot.at_slot(move.slot)->name}, {"target_counts", move.target_counts}};
    if (move.drive) {
      detail["drive"] = *move.drive;
    }
    return detail;
  }

  void add_fields(const Proposal& proposal, json& fields) const override {
    const MoveTask& move = *proposal.work<MoveTask>();
    fields["target_counts"] = move.target_counts;
    fields["target"] = proposal.target;
    if (move.drive) {
      fields["drive"] = *move.drive;
    }
  }

  [[nodiscard]] TaskWords words(const Robot& /*robot*/, const Proposal& /*proposal*/,
                                const TaskStatus& /*status*/,
                                const BiopsyFindings& /*found*/) const override {
    return {"", "Moves while the pedal is held", paused_words(""),
            "At rest within the deadband of the target.", "the axis"};
  }

  [[nodiscard]] Profile profile(const Robot& robot, const ilk_config_t& config,
                                const Proposal& proposal) const override {
    return profile_of_move(robot, config, proposal);
  }
};

}  // namespace

const MotionKind& manual_kind();
const MotionKind& manual_kind() {
  static const MoveKind kind;
  return kind;
}

}  // namespace interlock
