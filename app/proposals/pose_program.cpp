#include <string_view>

#include "proposals/programs.hpp"

namespace interlock {
namespace {

constexpr std::string_view insertion_role = "insertion";

}  // namespace

PathProgram pose_program(const Robot& robot, const Alignment& alignment, bool insert) {
  const Axis* insertion = robot.with_role(insertion_role);
  MoveLeg out;
  MoveLeg align;
  MoveLeg in;
  for (const AxisSetpoint& setpoint : alignment.setpoints) {
    const AxisCounts target{setpoint.slot, setpoint.counts};
    if (insertion == nullptr || setpoint.slot != insertion->slot) {
      align.targets.push_back(target);
      continue;
    }
    out.targets.push_back({setpoint.slot, insertion->lowest_setpoint_counts()});
    if (insert) {
      in.targets.push_back(target);
      in.needs_confirmation = true;
    }
  }
  PathProgram program;
  for (MoveLeg* leg : {&out, &align, &in}) {
    if (!leg->targets.empty()) {
      program.legs.emplace_back(std::move(*leg));
    }
  }
  return program;
}

}  // namespace interlock
