#include <string_view>

#include "proposals/programs.hpp"
#include "robot/modes.hpp"

namespace interlock {
namespace {

constexpr std::string_view probe_insertion = "insertion";
constexpr std::string_view probe_rotation = "probe_rotation";

}  // namespace

bool can_ablate(const Robot& robot) {
  return robot.with_role(probe_rotation) != nullptr && robot.with_role(probe_insertion) != nullptr &&
         robot.has_mode(ablation_mode.name);
}

std::optional<MoveLeg> ablation_leg(const Robot& robot, const AblationStep& step) {
  const Axis& rotation = *robot.with_role(probe_rotation);
  const Axis& insertion = *robot.with_role(probe_insertion);
  const auto turned = rotation.to_counts(step.probe_rotation_rad);
  const auto inserted = insertion.to_counts(step.insertion_mm);
  if (!turned || !inserted) {
    return std::nullopt;
  }
  return MoveLeg{{{rotation.slot, *turned}, {insertion.slot, *inserted}}, 0.0, step.dwell_s};
}

}  // namespace interlock
