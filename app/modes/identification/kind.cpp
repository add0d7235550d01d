#include <nlohmann/json.hpp>

#include "modes/identification/mode.hpp"
#include "proposals/checks.hpp"
#include "proposals/motion_kind.hpp"
#include "tuning/robot_changes.hpp"

namespace interlock {
namespace {

using nlohmann::json;

/** Where what goes into the patient is not out as far as it goes. The axis that is measured itself moves in
 * and out. */
tl::expected<void, Refusal> check_out(const Robot& robot, const ilk_config_t& config, const ControlView& view,
                                      std::uint32_t measured) {
  const Axis* insertion = robot.with_role("insertion");
  if (insertion == nullptr || insertion->slot == measured) {
    return {};
  }
  const ilk_axis_t& axis = view.snapshot.state.axis[insertion->slot];
  const std::int64_t out =
      std::int64_t{insertion->lowest_setpoint_counts()} + rest_tolerance_counts(config.axis[insertion->slot]);
  if (axis.homed == 0) {
    return tl::make_unexpected(
        Refusal{"NOT_HOMED", insertion->title + " is not homed, so nobody knows whether the probe is out.",
                "a homed insertion", "Home " + insertion->name + " first."});
  }
  if (axis.position_counts > out) {
    return tl::make_unexpected(
        Refusal{"INSERTED",
                insertion->title + " stands at " + counts_and_unit(*insertion, axis.position_counts) + ".",
                "the probe out as far as it goes, at " +
                    counts_and_unit(*insertion, insertion->lowest_setpoint_counts()),
                "Take the probe out by a proposal of kind retraction, then propose it again."});
  }
  return {};
}

/** Both ends of what it moves in, from wherever in between. */
tl::expected<void, Refusal> check_ends(const Scene& scene, const IdentificationTask& task) {
  for (const std::int32_t end : {task.range.lowest_counts, task.range.highest_counts}) {
    if (auto stays = check_separation(scene.robot, states_of(scene.view), {}, AxisCounts{task.slot, end});
        !stays) {
      return stays;
    }
  }
  return {};
}

class IdentificationKind final : public MotionKind {
 public:
  [[nodiscard]] std::string_view name() const override { return "identify"; }
  [[nodiscard]] const std::type_info& tasks() const override { return typeid(IdentificationTask); }
  [[nodiscard]] std::unique_ptr<Mode> make_mode(const RobotPlan& plan) const override {
    return std::make_unique<IdentificationMode>(plan);
  }

  [[nodiscard]] std::vector<std::uint32_t> slots(const Robot& /*robot*/, const Work& work) const override {
    return {work.as<IdentificationTask>().slot};
  }

  void check(const Scene& scene, Proposal& proposal, CheckList& checks) const override {
    const auto& task = *proposal.work<IdentificationTask>();
    check_system(scene.config, scene.view, checks);
    check_axes(scene.robot, scene.view, 1u << task.slot, checks);
    checks.make(CheckName::instrument,
                [&] { return check_out(scene.robot, scene.config, scene.view, task.slot); });
    checks.make(CheckName::range, [&]() -> tl::expected<void, Refusal> {
      if (task.range.is_enough()) {
        return {};
      }
      return tl::make_unexpected(
          Refusal{"RANGE", capital(too_short(scene.robot.at_slot(task.slot)->title, task.range)) + ".",
                  "room for four moves between its soft limits, and its linkage where it has one",
                  "Move the slider that is linked to it so that there is room, or measure by hand "
                  "(docs/robots.md)."});
    });
    checks.make(CheckName::separation, [&] { return check_ends(scene, task); });
  }

  void follow(const Scene& scene, const TaskStatus& /*status*/, Proposal& proposal) const override {
    proposal.measured = scene.view.measured;
  }

  [[nodiscard]] json asked(const Robot& robot, const Work& work) const override {
    return {{"axis", robot.at_slot(work.as<IdentificationTask>().slot)->name}, {"cleared", true}};
  }

  void add_fields(const Proposal& proposal, json& fields) const override {
    const MeasuringRange& range = proposal.work<IdentificationTask>()->range;
    fields["lowest_counts"] = range.lowest_counts;
    fields["highest_counts"] = range.highest_counts;
    fields["measured"] = nullptr;
    if (proposal.measured) {
      fields["measured"] = to_json(Identified{*proposal.measured, proposal.axis});
    }
  }

  [[nodiscard]] TaskWords words(const Robot& robot, const Proposal& proposal, const TaskStatus& status,
                                const BiopsyFindings& /*found*/) const override {
    const std::string axis = listed(robot, proposal.slots);
    const std::string part = ", " + std::to_string(status.step) + " of " +
                             std::to_string(AxisMeasurement::most_steps) + " measurements made";
    return {"; then moves " + axis + " to and fro",
            "Moves " + axis + " to and fro while the pedal is held" + part, paused_words(part),
            capital(axis) + " was measured. The running robot's file is as it was.",
            title_of(robot, status.slot)};
  }

  [[nodiscard]] Profile profile(const Robot& /*robot*/, const ilk_config_t& /*config*/,
                                const Proposal& /*proposal*/) const override {
    return no_profile(
        "Some ninety moves to and fro in the middle of its range; how long each lasts is found on the way.");
  }
};

}  // namespace

const MotionKind& identification_kind();
const MotionKind& identification_kind() {
  static const IdentificationKind kind;
  return kind;
}

}  // namespace interlock
