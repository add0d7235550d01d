#include <map>
#include <utility>

#include "proposals/programs.hpp"

namespace interlock {

PathProgram arriving_from_below(const Robot& robot, PathProgram program, bool inserted) {
  const auto has_role = [&](const Axis& axis, const char* role) { return &axis == robot.with_role(role); };
  // Out of the patient what goes in comes from below by itself; in it nothing goes aside for the sake of
  // play.
  const auto may_take_up = [&](const Axis& axis) {
    return inserted
               ? has_role(axis, "insertion") || has_role(axis, "rotation") || has_role(axis, "probe_rotation")
               : !has_role(axis, "insertion");
  };
  std::map<std::uint32_t, std::int32_t> known; /**< where earlier legs left the axes, by slot */
  PathProgram whole;
  for (PathLeg& leg : program.legs) {
    if (auto* move = std::get_if<MoveLeg>(&leg)) {
      MoveLeg below;
      below.takes_up_play = true;
      bool needed = false;
      for (const AxisCounts& target : move->targets) {
        const Axis& axis = *robot.at_slot(target.slot);
        const std::int32_t from =
            may_take_up(axis) ? axis.take_up_counts(target.counts).value_or(target.counts) : target.counts;
        const auto left = known.find(target.slot);
        needed |= from != target.counts && (left == known.end() || left->second > from);
        if (may_take_up(axis)) {
          below.targets.push_back({target.slot, from});
        }
        known[target.slot] = target.counts;
      }
      if (needed) {
        below.needs_confirmation = std::exchange(move->needs_confirmation, false);
        whole.legs.emplace_back(std::move(below));
      }
    }
    whole.legs.push_back(std::move(leg));
  }
  return whole;
}

}  // namespace interlock
