#include <nlohmann/json.hpp>

#include "proposals/checks.hpp"
#include "proposals/motion_kind.hpp"
#include "there_and_back/mode.hpp"

namespace interlock {
namespace {

using nlohmann::json;

class ThereAndBackKind final : public MotionKind {
 public:
  [[nodiscard]] std::string_view name() const override { return "there_and_back"; }
  [[nodiscard]] const std::type_info& tasks() const override { return typeid(ThereAndBackTask); }
  [[nodiscard]] std::unique_ptr<Mode> make_mode(const RobotPlan& plan) const override {
    return std::make_unique<ThereAndBackMode>(plan);
  }

  [[nodiscard]] std::vector<std::uint32_t> slots(const Robot& /*robot*/, const Work& work) const override {
    return {work.as<ThereAndBackTask>().slot};
  }

  void check(const Scene& scene, Proposal& proposal, CheckList& checks) const override {
    check_system(scene.config, scene.view, checks);
    check_axes(scene.robot, scene.view, 1u << proposal.slots.front(), checks);
  }

  [[nodiscard]] json asked(const Robot& robot, const Work& work) const override {
    const auto& [slot, by_counts] = work.as<ThereAndBackTask>();
    return {{"axis", robot.at_slot(slot)->name}, {"by_counts", by_counts}};
  }

  void add_fields(const Proposal& proposal, json& fields) const override {
    fields["target_counts"] = proposal.work<ThereAndBackTask>()->by_counts;
  }

  [[nodiscard]] TaskWords words(const Robot& /*robot*/, const Proposal& /*proposal*/,
                                const TaskStatus& /*status*/,
                                const BiopsyFindings& /*found*/) const override {
    return {"", "Goes there and back while the pedal is held", paused_words(""), "Back where it began.",
            "the axis"};
  }

  [[nodiscard]] Profile profile(const Robot& /*robot*/, const ilk_config_t& /*config*/,
                                const Proposal& /*proposal*/) const override {
    Profile profile;
    profile.why = "It begins where the axis is when the pedal is pressed.";
    return profile;
  }
};

}  // namespace

const MotionKind& there_and_back_kind();
const MotionKind& there_and_back_kind() {
  static const ThereAndBackKind kind;
  return kind;
}

}  // namespace interlock
